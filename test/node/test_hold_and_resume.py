#!/usr/bin/env python3
"""Shows that a job can be held, retracted, resumed, slowed down and cancelled anywhere, without leaving its path or a
limit, and that what the state does not allow is refused."""

import itertools
import math
import re
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks
from grinder_client import (A, DEG, INDEX, INFEED, LIFT, MM, MM_MIN, POSITION, RETRACT, RETURN, STROKE, UM, X, Y, Z,
                            grinder)

# Every axis moves in the stroke, and there is time to interfere.
JOB = gc.paper(cone_angle=10 * DEG, feed=2000 * MM_MIN)
HELIX = checks.Helix(JOB)
END = 31 * MM
CLEAR = HELIX.y(END) + 5 * MM

# Encoder counts, as in config/grinder.yaml.
RESOLUTION = (1e-7, 1e-7, 1e-7, 1e-6)


def runs_of(items):
    """The items without those that repeat the one before."""
    return [item for item, _ in itertools.groupby(items)]


def parts(setpoints, move):
    """The setpoints of a move, one list for each time that it was made."""
    return [list(group) for kind, group in itertools.groupby(setpoints, lambda s: s.move) if kind == move]


def speed(pair, period):
    """Along the cutting edge, over both steps of a pair."""
    return abs(pair[2].position[X] - pair[0].position[X]) / (2 * period) * HELIX.edge


class Interference:
    """What holds of a job however it was interfered with. Each is run once, and what came of it is kept."""

    job = JOB

    @classmethod
    def setUpClass(cls):
        g = grinder()
        g.make_ready_at_park()
        cls.limits, cls.period = g.limits(), g.period()
        cls.first_state = len(g.states)
        cls.job_run = g.send(cls.job)
        cls.interfere(g)
        cls.job_run.wait_complete()
        g.wait_state(GrinderState.READY)
        cls.states = runs_of(s.state_name for s in g.states[cls.first_state:])
        if cls.states[0] == 'ready':  # of before the goal
            del cls.states[0]
        cls.setpoints = cls.job_run.setpoints
        cls.rest = g.wait_rest()

    @classmethod
    def rest_at(cls, g, state):
        """Waits for a state in which the axes rest, and keeps what is told in it over a time."""
        told = g.wait_state(state)
        at_rest = g.wait_rest()
        before = len(cls.job_run.setpoints)
        positions = g.positions_over(0.3)
        return {'state': told, 'at': at_rest, 'positions': positions, 'last': cls.job_run.setpoints[-1],
                'new': len(cls.job_run.setpoints) - before}

    def check_rest(self, rest):
        self.assertEqual({tuple(position) for position in rest['positions']}, {tuple(rest['at'])})
        self.assertEqual(rest['new'], 0, 'setpoints while the axes rest')
        for position, commanded, resolution in zip(rest['at'], rest['last'].position, RESOLUTION):
            self.assertAlmostEqual(position, commanded, delta=1.01 * resolution)
        self.assertEqual(rest['state'].feed, 0)

    def test_goal_succeeds(self):
        self.assertEqual((self.job_run.status, self.job_run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), self.job_run.text)

    def test_no_cycle_is_missing(self):
        self.assertTrue(checks.is_gapless(self.setpoints))
        self.assertEqual(len(self.setpoints), self.job_run.result.setpoints_written)

    def test_no_axis_exceeds_a_limit(self):
        self.assertEqual(checks.excesses(self.setpoints, self.limits, self.period), [])

    def test_job_ends_at_the_park_position(self):
        self.assertEqual(list(self.setpoints[-1].position), grinder().park())

    def test_stroke_keeps_the_tolerance(self):
        self.assertEqual(checks.off_path(self.setpoints, HELIX), [])
        for s in self.setpoints:
            if s.move == STROKE:
                error = HELIX.a(s.position[X]) - s.position[A]
                self.assertLess(abs(error) * HELIX.radius(s.position[X]) * HELIX.normal, 1 * UM)
                self.assertAlmostEqual(s.path_error, error, delta=1e-12)

    def test_stroke_keeps_its_depth(self):
        for s in self.setpoints:
            if s.move == STROKE:
                x, y, z, _ = s.position
                self.assertAlmostEqual(y, HELIX.y(x) - 0.5 * MM, delta=1e-12)
                self.assertAlmostEqual(z, HELIX.z(x), delta=1e-12)

    def check_stroke_without_gap(self, stroke, from_x, to_x, feed):
        """It goes on and on, never faster than the feed, from one place to another."""
        xs = [s.position[X] for s in stroke]
        step = feed * self.period / HELIX.edge
        self.assertLess(xs[0] - from_x, step * (1 + 1e-3))
        self.assertAlmostEqual(xs[-1], to_x, delta=1e-9)
        for a, b in zip(xs, xs[1:]):
            self.assertTrue(0 < b - a < step * (1 + 1e-3), b - a)


class TestHoldInTheStroke(Interference, unittest.TestCase):
    @classmethod
    def interfere(cls, g):
        cls.job_run.wait_in_stroke(5 * MM)
        cls.held = g.hold()
        cls.rest_held = cls.rest_at(g, GrinderState.HELD)
        cls.hold_again = g.hold()
        cls.resumed = g.resume()

    def test_requests_are_accepted(self):
        for reply in (self.held, self.hold_again, self.resumed):
            self.assertEqual((reply.success, reply.message), (True, ''))

    def test_states_follow_one_another(self):
        # On its path already it is resuming for one cycle only, which may not be told.
        states = [s for s in self.states if s != 'resuming']
        self.assertEqual(states, ['starting', 'running', 'holding', 'held', 'running', 'ready'])

    def test_axes_rest_while_held(self):
        self.check_rest(self.rest_held)
        self.assertEqual(self.rest_held['last'].move, STROKE)
        self.assertEqual(self.rest_held['state'].hold_reason, '')

    def test_path_has_neither_gap_nor_repeat(self):
        stroke, = parts(self.setpoints, STROKE)
        self.check_stroke_without_gap(stroke, -1 * MM, END, JOB['process.feed'])

    def test_moves_are_those_of_the_job(self):
        moves = runs_of(s.move for s in self.setpoints)
        self.assertEqual(moves, [move for move in range(8) if move != LIFT])

    def test_more_cycles_are_written_than_were_planned(self):
        self.assertGreater(len(self.setpoints), self.job_run.result.statistics.setpoints)


class TestHoldOffTheStroke(Interference, unittest.TestCase):
    @classmethod
    def interfere(cls, g):
        g.wait_for(lambda: any(s.velocity[X] > 0.05 for s in cls.job_run.setpoints), 'motion')
        cls.held = g.hold()
        cls.rest_held = cls.rest_at(g, GrinderState.HELD)
        cls.resumed = g.resume()

    def test_axes_rest_short_of_the_stroke(self):
        self.assertTrue(self.held.success and self.resumed.success)
        self.check_rest(self.rest_held)
        self.assertLess(self.rest_held['last'].move, STROKE)

    def test_moves_are_those_of_the_job(self):
        moves = runs_of(s.move for s in self.setpoints)
        self.assertEqual(moves, [move for move in range(8) if move != LIFT])


class TestRetractInTheStroke(Interference, unittest.TestCase):
    @classmethod
    def interfere(cls, g):
        cls.job_run.wait_in_stroke(8 * MM)
        cls.held = g.hold()
        cls.rest_held = cls.rest_at(g, GrinderState.HELD)
        cls.retracted = g.retract()
        cls.rest_retracted = cls.rest_at(g, GrinderState.RETRACTED)
        cls.resumed = g.resume()

    def test_requests_are_accepted(self):
        for reply in (self.held, self.retracted, self.resumed):
            self.assertEqual((reply.success, reply.message), (True, ''))

    def test_states_follow_one_another(self):
        self.assertEqual(self.states, ['starting', 'running', 'holding', 'held', 'retracting', 'retracted', 'resuming',
                                       'running', 'ready'])

    def test_axes_rest_while_held_and_retracted(self):
        self.check_rest(self.rest_held)
        self.check_rest(self.rest_retracted)

    def test_wheel_is_lifted_radially_clear_of_the_work(self):
        held, lifted = self.rest_held['at'], self.rest_retracted['at']
        for axis in (X, Z, A):
            self.assertEqual(lifted[axis], held[axis])
        self.assertGreaterEqual(lifted[Y], CLEAR - RESOLUTION[Y])

    def test_moves_go_off_the_work_and_back(self):
        moves = runs_of(s.move for s in self.setpoints)
        self.assertEqual(moves, [INDEX, POSITION, gc.APPROACH, INFEED, STROKE, LIFT, POSITION, INFEED, STROKE, RETRACT,
                                 RETURN])

    def test_way_back_is_above_the_work_and_down_at_feed(self):
        lift, = parts(self.setpoints, LIFT)
        back = parts(self.setpoints, POSITION)[1]
        plunge = parts(self.setpoints, INFEED)[1]
        for axis in (X, Z, A):
            self.assertEqual(len({s.position[axis] for s in lift}), 1)
            self.assertEqual({s.position[axis] for s in plunge}, {back[-1].position[axis]})
        self.assertEqual({s.position[Y] for s in back}, {lift[-1].position[Y]})
        self.assertGreaterEqual(back[0].position[Y], CLEAR - 1e-15)
        fastest = max(abs(s.velocity[Y]) for s in plunge)
        self.assertLessEqual(fastest, JOB['process.feed'] * (1 + 1e-9))
        x, y, z, a = plunge[-1].position
        self.assertAlmostEqual(y, HELIX.y(x) - 0.5 * MM, delta=1e-12)
        self.assertAlmostEqual(z, HELIX.z(x), delta=1e-12)
        self.assertAlmostEqual(a, HELIX.a(x), delta=1e-12)

    def test_stroke_is_entered_again_ahead_of_where_it_was_left(self):
        first, second = parts(self.setpoints, STROKE)
        left = first[-1].position[X]
        entered = parts(self.setpoints, INFEED)[1][-1].position[X]
        self.assertTrue(-1 * MM <= entered < left)
        self.check_stroke_without_gap(first, -1 * MM, left, JOB['process.feed'])
        self.check_stroke_without_gap(second, entered, END, JOB['process.feed'])

    def test_feed_is_reached_where_the_stroke_was_left(self):
        left = parts(self.setpoints, STROKE)[0][-1].position[X]
        feeds = [(pair[0].position[X], speed(pair, self.period)) for pair in checks.stroke_pairs(self.setpoints)]
        second = [i for i, (x, _) in enumerate(feeds) if i and x < feeds[i - 1][0]]
        self.assertEqual(len(second), 1)
        feed = next(feed for x, feed in feeds[second[0]:] if x >= left)
        self.assertAlmostEqual(feed / JOB['process.feed'], 1, delta=1e-6)


class TestOverride(Interference, unittest.TestCase):
    job = gc.paper(cone_angle=10 * DEG, feed=1000 * MM_MIN)
    levels = (0.5, 1.2, 1)

    @classmethod
    def interfere(cls, g):
        cls.job_run.wait_in_stroke(2 * MM)
        feed = cls.job['process.feed']
        cls.replies = []

        def told(level):
            state = g.states[-1]
            return state.override == level and abs(state.feed - level * feed) <= 1e-6 * level * feed

        for level in cls.levels[:2]:
            cls.replies.append(g.set_feed_override(level))
            g.wait_for(lambda level=level: told(level), 'the feed at %g' % level)
        cls.replies.append(g.set_feed_override(0))
        g.wait_for(lambda: told(0), 'the feed at 0')
        cls.rest_at_zero = cls.rest_at(g, GrinderState.RUNNING)
        cls.done_at_zero = cls.job_run.done
        cls.replies.append(g.set_feed_override(1))
        g.wait_for(lambda: told(1), 'the feed at 1')

    def test_requests_are_accepted(self):
        self.assertEqual({(reply.success, reply.message) for reply in self.replies}, {(True, '')})

    def test_axes_rest_at_zero_and_the_job_is_still_running(self):
        self.check_rest(self.rest_at_zero)
        self.assertFalse(self.done_at_zero)
        self.assertEqual(self.states, ['starting', 'running', 'ready'])

    def test_feed_of_the_setpoints_is_the_one_asked_for(self):
        feeds = [speed(pair, self.period) / self.job['process.feed'] for pair in checks.stroke_pairs(self.setpoints)]
        for level in self.levels:
            self.assertTrue(any(abs(feed - level) < 1e-6 for feed in feeds), level)
        self.assertLess(max(feeds), 1.2 * (1 + 1e-6))
        levels = runs_of(level for feed in feeds for level in self.levels if abs(feed - level) < 1e-6)
        self.assertEqual([level for level in levels if level != 1], [0.5, 1.2])

    def test_path_has_neither_gap_nor_repeat(self):
        stroke, = parts(self.setpoints, STROKE)
        self.check_stroke_without_gap(stroke, -1 * MM, END, 1.2 * self.job['process.feed'])


class TestOverrideBeforeTheJob(unittest.TestCase):
    """It is kept while there is no job, and rapids keep their speed."""

    def setUp(self):
        self.addCleanup(grinder().set_feed_override, 1)

    def test_feed_is_halved_and_rapids_are_not(self):
        g = grinder()
        g.make_ready_at_park()
        planned = g.plan(gc.goal_of(gc.SHORT)).statistics
        self.assertTrue(g.set_feed_override(0.5).success)
        gc.poll(lambda: g.fresh_state().override == 0.5, 'the override told')
        run = g.run(gc.SHORT)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        feed = 0.5 * gc.SHORT['process.feed']
        helix = checks.Helix(gc.SHORT)
        infeed = max(abs(s.velocity[Y]) for s in run.setpoints if s.move == INFEED)
        self.assertLessEqual(infeed, feed * (1 + 1e-9))
        stroke = max(abs(e.position[X] - s.position[X]) / (2 * g.period()) * helix.edge
                     for s, _, e in checks.stroke_pairs(run.setpoints))
        self.assertAlmostEqual(stroke, feed, delta=1e-6 * feed)
        for move in (INDEX, POSITION, gc.APPROACH, RETRACT, RETURN):
            cycles = sum(s.move == move for s in run.setpoints[1:])
            self.assertAlmostEqual(cycles * g.period(), planned.move_duration[move], delta=1e-9)

    def check_refused(self, fraction, text):
        g = grinder()
        self.assertTrue(g.set_feed_override(0.75).success)
        reply = g.set_feed_override(fraction)
        self.assertFalse(reply.success)
        self.assertRegex(reply.message, r'^feed override = %s; allowed: 0 to 1\.2$' % text)
        self.assertEqual(g.fresh_state().override, 0.75)

    def test_above_the_largest_is_refused(self):
        self.check_refused(1.21, r'1\.21')

    def test_below_zero_is_refused(self):
        self.check_refused(-0.01, r'-0\.01')

    def test_nan_is_refused(self):
        self.check_refused(math.nan, r'-?nan')

    def test_infinity_is_refused(self):
        self.check_refused(math.inf, 'inf')


# What each state allows, in the order in which it is told.
ALLOWED = {
    'disabled': 'enable, disable, reset',
    'ready': 'enable, disable, home, start (grind run), lift, jog',
    'running': 'disable, hold, cancel',
    'held': 'disable, hold, resume, retract, cancel',
    'retracted': 'disable, resume, cancel, jog',
    'fault': 'disable, reset',
}

SERVICES = ['enable', 'disable', 'home', 'hold', 'resume', 'retract', 'lift', 'reset']


class TestRefusedRequests(unittest.TestCase):
    """Every service in every state that does not allow it; the methods are made of the table."""

    run_of_state = None

    def reach(self, state):
        """Takes the machine to a state, if it is not there already."""
        g = grinder()
        # Nothing but these tests changes it, so that it need not be fresh.
        if g.states[-1].state_name == state:
            return
        g.make_ready()
        if state in ('running', 'held', 'retracted'):
            # So slow that it is under way for as long as it takes.
            type(self).run_of_state = g.send(gc.paper(feed=100 * MM_MIN, clearance=0.5 * MM))
            self.run_of_state.wait_in_stroke(-1 * MM)
        if state in ('held', 'retracted'):
            self.assertTrue(g.hold().success)
            g.wait_state(GrinderState.HELD)
        if state == 'retracted':
            self.assertTrue(g.retract().success)
            g.wait_state(GrinderState.RETRACTED)
        if state == 'disabled':
            self.assertTrue(g.disable().success)
        if state == 'fault':
            g.inject('emergency_stop')
            g.wait_state(GrinderState.FAULT)
        self.assertEqual(g.fresh_state().state_name, state)

    def check(self, state, service):
        self.reach(state)
        reply = getattr(grinder(), service)()
        self.assertFalse(reply.success)
        self.assertEqual(reply.message, '%s refused: the machine is in state %s; allowed: %s'
                         % (service, state, ALLOWED[state]))
        self.assertEqual(grinder().fresh_state().state_name, state)

    @classmethod
    def tearDownClass(cls):
        grinder().make_ready()


def add_requests():
    for state, allowed in ALLOWED.items():
        for service in SERVICES:
            if service not in re.split(', ', allowed):
                setattr(TestRefusedRequests, 'test_%s_refuses_%s' % (state, service),
                        lambda self, state=state, service=service: self.check(state, service))


add_requests()


class TestFeedbackOfARetraction(unittest.TestCase):
    """A wheel that is lifted off in the middle of a stroke has come as far in it as before."""

    def test_fraction_of_the_stroke_stays(self):
        g = grinder()
        g.make_ready()
        run = g.send(JOB).wait_in_stroke(10 * MM)
        assert g.hold().success
        g.wait_state(GrinderState.HELD)
        g.wait_rest()
        held = len(run.feedback)
        g.wait_for(lambda: len(run.feedback) > held + 2, 'feedback')
        reached = run.feedback[-1].stroke_fraction
        self.assertAlmostEqual(reached, (run.setpoints[-1].position[X] + 1 * MM) / (END + 1 * MM), delta=1e-9)
        assert g.retract().success
        g.wait_state(GrinderState.RETRACTED)
        lifted = len(run.feedback)
        g.wait_for(lambda: len(run.feedback) > lifted + 2, 'feedback')
        assert g.resume().success
        g.wait_state(GrinderState.RUNNING)
        after = [f.stroke_fraction for f in run.feedback[held + 2:] if f.state not in ('running', 'resuming')]
        self.assertGreater(len(after), 3)
        for fraction in after:
            self.assertAlmostEqual(fraction, reached, delta=1e-4)
        # On the way back it is never less than what is ground again after the re-entry.
        self.assertGreater(min(f.stroke_fraction for f in run.feedback[held:]), reached - 0.2)
        run.wait_complete()
        self.assertEqual((run.status, run.feedback[-1].stroke_fraction), ('SUCCEEDED', 1), run.text)


class CancelAtRest:
    """A cancel while the axes rest in the midst of a stroke: it leaves the wheel clear of the work."""

    @classmethod
    def setUpClass(cls):
        g = grinder()
        g.make_ready()
        cls.job_run = g.send(JOB).wait_in_stroke(5 * MM)
        assert g.hold().success
        g.wait_state(GrinderState.HELD)
        cls.rest_there(g)
        cls.at = g.wait_rest()
        cls.other = g.send(gc.SHORT).wait()
        cls.dry_run = g.send(gc.SHORT, dry_run=True).wait()
        cls.state_after_others = g.fresh_state()
        written, first_state = len(cls.job_run.setpoints), len(g.states)
        cls.job_run.cancel()
        cls.job_run.wait_complete()
        cls.state = g.wait_state(GrinderState.READY)
        cls.canceling = [s for s in g.states[first_state:] if s.state == GrinderState.CANCELING]
        cls.end = g.wait_rest()
        cls.positions = g.positions_over(0.3)
        cls.setpoints = cls.job_run.setpoints
        cls.new = cls.setpoints[written:]
        cls.resume = g.resume()
        cls.next_run = g.run(gc.SHORT)

    def test_another_goal_is_busy(self):
        for run in (self.other, self.dry_run):
            self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.BUSY))
        self.assertEqual(self.state_after_others.state_name, self.at_rest_in)

    def test_goal_is_preempted(self):
        self.assertEqual((self.job_run.status, self.job_run.code), ('PREEMPTED', GrindResult.CANCELED))
        self.assertEqual(self.job_run.result.setpoints_written, len(self.job_run.setpoints))

    def test_machine_is_ready_and_the_equipment_off(self):
        self.assertEqual((self.state.state_name, self.state.fault, self.state.hold_reason), ('ready', '', ''))
        self.assertFalse(self.state.wheel_in_work)
        gc.poll(lambda: not (grinder().fresh_state().coolant_on or grinder().fresh_state().spindle_at_speed),
                'spindle and coolant off')

    def test_axes_rest_clear_of_the_work(self):
        self.assertEqual({tuple(position) for position in self.positions}, {tuple(self.end)})
        for axis in (X, Z, A):
            self.assertEqual(self.end[axis], self.at[axis])
        self.assertGreaterEqual(self.end[Y], CLEAR - RESOLUTION[Y])

    def test_no_axis_exceeds_a_limit(self):
        self.assertTrue(checks.is_gapless(self.setpoints))
        self.assertEqual(checks.excesses(self.setpoints, grinder().limits(), grinder().period()), [])

    def test_job_cannot_be_resumed(self):
        self.assertFalse(self.resume.success)

    def test_next_goal_lifts_first_and_succeeds(self):
        self.assertEqual(self.next_run.status, 'SUCCEEDED', self.next_run.text)
        self.assertEqual(list(self.next_run.setpoints[0].position), list(self.setpoints[-1].position))
        self.assertEqual(self.next_run.setpoints[1].move, LIFT)


class TestCancelWhileHeld(CancelAtRest, unittest.TestCase):
    at_rest_in = 'held'

    @classmethod
    def rest_there(cls, g):
        pass

    def test_wheel_is_lifted_before_the_goal_ends(self):
        checks.check_lifted(self, self.setpoints[-len(self.new) - 1], self.new, CLEAR)

    def test_wheel_turns_and_coolant_flows_until_it_is_lifted(self):
        self.assertTrue(self.canceling)
        self.assertTrue(all(s.spindle_at_speed and s.coolant_on for s in self.canceling))


class TestCancelWhileRetracted(CancelAtRest, unittest.TestCase):
    at_rest_in = 'retracted'

    @classmethod
    def rest_there(cls, g):
        assert g.retract().success
        g.wait_state(GrinderState.RETRACTED)

    def test_nothing_moves(self):
        self.assertEqual(self.end, self.at)
        self.assertEqual(self.new, [])


if __name__ == '__main__':
    rospy.init_node('test_hold_and_resume')
    rostest.rosrun('flute_grinder', 'hold_and_resume', '__main__')
