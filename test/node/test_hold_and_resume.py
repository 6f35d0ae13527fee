"""Shows that the services that hold, retract, resume and slow down a job reach it, that states, feedback and setpoints show what
comes of it, and that a service refuses what the state does not allow. Every moment and state is gone through in test/control and
test/motion."""

import itertools
import unittest

from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks
from grinder_client import DEG, MM, MM_MIN, X, grinder

# Every axis moves in the stroke, and there is time to interfere, even on a host that stalls for seconds.
JOB = gc.paper(cone_angle=10 * DEG, feed=100 * MM_MIN)
END = 31 * MM

# Encoder counts, as in config/grinder.yaml.
RESOLUTION = (1e-7, 1e-7, 1e-7, 1e-6)


def runs_of(items):
    """The items without those that repeat the one before."""
    return [item for item, _ in itertools.groupby(items)]


class TestInterference(unittest.TestCase):
    """One job that is held, retracted, resumed and slowed down in its stroke; what came of it is kept for the tests."""

    @classmethod
    def setUpClass(cls):
        g = grinder()
        g.make_ready_at_park()
        cls.replies = [g.set_feed_override(0.1)]
        first_state = len(g.states)
        cls.job_run = run = g.send(JOB).wait_in_stroke(3 * MM)
        cls.replies.append(g.hold())
        cls.held = cls.rest_at(g, GrinderState.HELD)
        cls.others = [g.send(gc.SHORT).wait(), g.send(gc.SHORT, dry_run=True).wait()]
        cls.replies += [g.hold(), g.retract()]
        cls.retracted = cls.rest_at(g, GrinderState.RETRACTED)
        cls.replies += [g.resume(), g.set_feed_override(0.2)]
        # Without feed it would not come back to the path.
        g.wait_for(lambda: run.done or g.states[-1].state == GrinderState.RUNNING and cls.feed_is(g, 0.2),
                   'a fifth of the feed in the stroke')
        cls.replies.append(g.set_feed_override(0))
        g.wait_for(lambda: cls.feed_is(g, 0), 'no feed')
        cls.stopped = cls.rest_at(g, GrinderState.RUNNING)
        cls.replies.append(g.set_feed_override(1))
        run.wait_complete()
        g.wait_state(GrinderState.READY)
        cls.states = runs_of(s.state_name for s in g.states[first_state:])
        cls.setpoints = run.setpoints

    @classmethod
    def feed_is(cls, g, override):
        state = g.states[-1]
        return state.override == override and abs(state.feed - override * JOB['process.feed']) <= 1e-6 * JOB['process.feed']

    @classmethod
    def rest_at(cls, g, state):
        """Waits for a state in which the axes rest, and keeps what is published in it. The setpoints come by a connection of
        their own, on a busy host later than the positions."""
        shown = g.wait_state(state)
        at = g.wait_rest()
        cls.job_run.wait_past(lambda s: all(abs(p - c) <= 1.01 * r for p, c, r in zip(at, s.position, RESOLUTION)),
                              'the setpoint at which the axes rest')
        setpoints, feedback = len(cls.job_run.setpoints), len(cls.job_run.feedback)
        positions = g.positions_over(1)
        g.wait_for(lambda: len(cls.job_run.feedback) > feedback + 2, 'feedback')
        return {'feedback': len(cls.job_run.feedback), 'state': shown, 'at': at, 'positions': positions, 'last': cls.job_run.last,
                'new': len(cls.job_run.setpoints) - setpoints, 'fraction': cls.job_run.feedback[-1].stroke_fraction}

    def test_requests_are_accepted(self):
        self.assertEqual({(reply.success, reply.message) for reply in self.replies}, {(True, '')})

    def test_states_follow_one_another(self):
        states = self.states[1:] if self.states[0] == 'ready' else self.states
        # One that passes by itself may not be published on a host that stalls.
        passing = ('starting', 'holding', 'retracting', 'resuming')
        self.assertEqual([s for s in states if s not in passing], ['running', 'held', 'retracted', 'running', 'ready'])

    def test_axes_rest_while_held_retracted_and_without_feed(self):
        for rest in (self.held, self.retracted, self.stopped):
            self.assertEqual({tuple(position) for position in rest['positions']}, {tuple(rest['at'])})
            self.assertEqual((rest['new'], rest['state'].feed), (0, 0))

    def test_fraction_of_the_stroke_stays_while_the_wheel_is_lifted(self):
        reached = (self.held['last'].position[X] + 1 * MM) / (END + 1 * MM)
        for rest in (self.held, self.retracted):
            self.assertAlmostEqual(rest['fraction'], reached, delta=1e-4)
        # On the way back, of which a host that stalls may publish nothing.
        back = {f.stroke_fraction for f in self.job_run.feedback[self.stopped['feedback']:] if f.x < self.held['last'].position[X]}
        self.assertLessEqual(back, {1})

    def test_another_goal_is_busy(self):
        for run in self.others:
            self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.BUSY))

    def test_goal_succeeds_with_every_setpoint(self):
        self.assertEqual((self.job_run.status, self.job_run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), self.job_run.text)
        self.assertTrue(checks.is_gapless(self.setpoints))
        self.assertEqual(len(self.setpoints), self.job_run.result.setpoints_written)
        self.assertGreater(len(self.setpoints), self.job_run.result.statistics.setpoints)
        self.assertEqual(list(self.setpoints[-1].position), grinder().park())


class TestRefusals(unittest.TestCase):
    def test_feed_override_out_of_its_range(self):
        g = grinder()
        self.addCleanup(g.set_feed_override, 1)
        self.assertTrue(g.set_feed_override(0.75).success)
        reply = g.set_feed_override(1.21)
        self.assertEqual((reply.success, reply.message), (False, 'feed override = 1.21; allowed: 0 to 1.2'))
        self.assertEqual(g.fresh_state().override, 0.75)

    def check_refused(self, services, state, allowed):
        for service in services:
            reply = getattr(grinder(), service)()
            self.assertEqual((reply.success, reply.message), (
                False, '%s refused: the machine is in state %s; allowed: %s' % (service, state, allowed)))
        self.assertEqual(grinder().fresh_state().state_name, state)

    def test_every_service_refuses_with_the_state_and_what_it_allows(self):
        g = grinder()
        g.make_ready()
        self.addCleanup(g.make_ready)
        self.check_refused(('hold', 'resume', 'retract', 'reset'), 'ready',
                           'enable, disable, home, start (grind run), lift, jog')
        self.assertTrue(g.disable().success)
        self.check_refused(('home', 'lift'), 'disabled', 'enable, disable, reset')
        self.assertTrue(g.enable().success)
        # So slow that it is under way for as long as it takes.
        g.send(gc.paper(feed=20 * MM_MIN, clearance=0.5 * MM)).wait_in_stroke(-1 * MM)
        self.check_refused(('enable',), 'running', 'disable, hold, cancel')
