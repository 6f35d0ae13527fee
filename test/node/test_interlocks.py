#!/usr/bin/env python3
"""Shows that the wheel is at the work only while the axes know their reference, the spindle is at speed and coolant
flows: a job does not begin without them, and where one is lost the grinder lifts the wheel by itself, says why, and
goes on only when it is told to."""

import itertools
import re
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks
from grinder_client import A, DEG, INFEED, LIFT, MM, MM_MIN, POSITION, STROKE, X, Y, Z

# Every axis moves in the stroke, and there is time for something to be lost.
JOB = gc.paper(cone_angle=10 * DEG, flute_length=20 * MM, feed=1500 * MM_MIN)
HELIX = checks.Helix(JOB)
CLEAR = HELIX.y(21 * MM) + 5 * MM

RESOLUTION = (1e-7, 1e-7, 1e-7, 1e-6)

NOT_HOMED = 'the axes are not homed'
NO_SPINDLE = 'the spindle is not at speed'
NO_COOLANT = 'no coolant flows'


class OwnNode:
    """A node with equipment of its own for the tests of a class."""

    equipment = {}
    timeouts = {}
    axes = {}

    @classmethod
    def setUpClass(cls):
        parameters = gc.machine()
        parameters.update(cls.timeouts)
        parameters['hardware'].update(cls.equipment)
        for joint, values in cls.axes.items():
            parameters['hardware'][joint].update(values)
        cls.parameters = parameters
        cls.node = gc.NodeProcess('own_grinder', parameters)
        cls.addClassCleanup(cls.node.close)
        cls.client = cls.node.client()
        cls.addClassCleanup(cls.client.close)
        cls.go_through(cls.client)

    @classmethod
    def go_through(cls, g):
        pass


class LostMidStroke(OwnNode):
    """What holds of all that can be lost. It is lost once, and what came of it is kept for the tests."""

    equipment = {'spindle_run_up_time': 0.2}
    fault = reason = ''

    @classmethod
    def go_through(cls, g):
        g.make_ready()
        cls.limits, cls.period = g.limits(), g.period()
        first_state = len(g.states)
        cls.job_run = g.send(JOB).wait_in_stroke(4 * MM)
        cls.before = g.fresh_state()
        assert g.inject(cls.fault).success
        cls.state = g.wait_state(GrinderState.RETRACTED)
        cls.at = g.wait_rest()
        written = len(cls.job_run.setpoints)
        cls.lifted = cls.job_run.setpoints[-1]
        cls.resume = g.resume()
        cls.after_resume = g.fresh_state()
        assert g.inject('none').success
        cls.take_back(g)
        cls.positions = g.positions_over(0.3)
        cls.new = len(cls.job_run.setpoints) - written
        cls.after_return = g.fresh_state()
        cls.go_on(g)
        cls.states = [name for name, _ in itertools.groupby(s.state_name for s in g.states[first_state:])]
        cls.setpoints = cls.job_run.setpoints

    @classmethod
    def take_back(cls, g):
        gc.poll(lambda: (lambda s: s.spindle_at_speed and s.coolant_on)(g.fresh_state()), 'spindle and coolant')

    @classmethod
    def go_on(cls, g):
        cls.resume_when_well = g.resume()
        cls.job_run.wait_complete()
        cls.after = g.wait_state(GrinderState.READY)

    def test_it_was_lost_in_the_stroke(self):
        self.assertEqual((self.before.state_name, self.before.hold_reason), ('running', ''))
        first_stroke, *_ = [list(group) for move, group in itertools.groupby(self.setpoints, lambda s: s.move)
                            if move == STROKE]
        self.assertTrue(4 * MM < first_stroke[-1].position[X] < 20 * MM)

    def test_wheel_is_lifted_and_the_state_tells_why(self):
        self.assertEqual((self.state.state_name, self.state.hold_reason), ('retracted', self.reason))
        self.assertEqual((self.state.enabled, self.state.fault), (True, ''))
        self.assertEqual((self.before.wheel_in_work, self.state.wheel_in_work), (True, False))
        self.assertGreaterEqual(self.at[Y], CLEAR - RESOLUTION[Y])
        self.assertEqual(self.lifted.move, LIFT)
        lift = [s for s in self.setpoints if s.move == LIFT]
        for axis in (X, Z, A):
            self.assertEqual(len({s.position[axis] for s in lift}), 1)

    def test_resume_is_refused_with_the_reason(self):
        self.assertEqual((self.resume.success, self.resume.message), (False, 'resume refused: ' + self.reason))
        self.assertEqual((self.after_resume.state_name, self.after_resume.hold_reason), ('retracted', self.reason))

    def test_nothing_moves_by_itself_when_it_is_well_again(self):
        self.assertEqual({tuple(position) for position in self.positions}, {tuple(self.at)})
        self.assertEqual(self.new, 0)
        self.assertEqual(self.after_return.state_name, 'retracted')

    def test_no_axis_exceeds_a_limit(self):
        self.assertTrue(checks.is_gapless(self.setpoints))
        self.assertEqual(checks.excesses(self.setpoints, self.limits, self.period), [])

    def test_stroke_stays_on_its_path(self):
        self.assertEqual(checks.off_path(self.setpoints, HELIX), [])


class LostAndBack(LostMidStroke):
    def test_resume_is_taken_when_it_is_well_again(self):
        self.assertEqual((self.resume_when_well.success, self.resume_when_well.message), (True, ''))
        self.assertEqual((self.job_run.status, self.job_run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), self.job_run.text)
        self.assertEqual((self.after.state_name, self.after.hold_reason), ('ready', ''))

    def test_states_follow_one_another(self):
        # It is held for one cycle only, which may not be told.
        states = [s for s in self.states if s != 'held']
        if states[0] == 'ready':  # of before the goal
            del states[0]
        self.assertEqual(states, ['starting', 'running', 'holding', 'retracting', 'retracted', 'resuming', 'running',
                                  'ready'])

    def test_whole_stroke_is_ground(self):
        moves = [move for move, _ in itertools.groupby(s.move for s in self.setpoints)]
        at = moves.index(STROKE)
        self.assertEqual(moves[at:at + 5], [STROKE, LIFT, POSITION, INFEED, STROKE])
        strokes = [list(group) for move, group in itertools.groupby(self.setpoints, lambda s: s.move) if move == STROKE]
        self.assertLess(strokes[1][0].position[X], strokes[0][-1].position[X])
        self.assertAlmostEqual(strokes[1][-1].position[X], 21 * MM, delta=1e-9)


class TestSpindleLost(LostAndBack, unittest.TestCase):
    fault, reason = 'spindle_lost', NO_SPINDLE

    def test_state_tells_the_spindle(self):
        self.assertEqual([s.spindle_at_speed for s in (self.before, self.state, self.after_return)],
                         [True, False, True])


class TestCoolantLost(LostAndBack, unittest.TestCase):
    fault, reason = 'coolant_lost', NO_COOLANT

    def test_state_tells_the_coolant(self):
        self.assertEqual([s.coolant_on for s in (self.before, self.state, self.after_return)], [True, False, True])


class TestReferenceLost(LostMidStroke, unittest.TestCase):
    """Only homing brings the reference back, and that needs the job to be given up."""

    fault, reason = 'reference_lost', NOT_HOMED
    # Home is not far, so that it does not take long.
    axes = {joint: {'homing_velocity': 0.5} for joint in gc.JOINTS[:3]}

    @classmethod
    def take_back(cls, g):
        g.fresh_state()

    @classmethod
    def go_on(cls, g):
        cls.resume_again = g.resume()
        cls.home_in_job = g.home()
        cls.job_run.cancel()
        cls.job_run.wait()
        cls.ready = g.wait_state(GrinderState.READY)
        cls.positions_when_ready = g.positions_over(0.3)
        cls.start = g.send(gc.SHORT).wait()
        cls.after_start = g.fresh_state()
        cls.home = g.home()
        cls.homed = g.wait_state(GrinderState.READY)
        cls.at_home = g.wait_rest()
        cls.next_run = g.run(gc.SHORT)

    def test_it_is_not_back_by_itself(self):
        self.assertEqual([s.homed for s in (self.before, self.state, self.after_return)], [True, False, False])
        self.assertFalse(self.resume_again.success)
        self.assertEqual(self.resume_again.message, 'resume refused: ' + NOT_HOMED)

    def test_homing_needs_the_job_to_be_given_up(self):
        self.assertFalse(self.home_in_job.success)
        self.assertEqual(self.home_in_job.message,
                         'home refused: the machine is in state retracted; allowed: disable, resume, cancel, jog')

    def test_cancel_ends_the_job_where_it_is(self):
        self.assertEqual((self.job_run.status, self.job_run.code), ('PREEMPTED', GrindResult.CANCELED))
        self.assertEqual((self.ready.state_name, self.ready.homed, self.ready.hold_reason), ('ready', False, ''))
        self.assertEqual({tuple(position) for position in self.positions_when_ready}, {tuple(self.at)})

    def test_no_job_begins_without_it(self):
        self.assertEqual((self.start.status, self.start.code), ('ABORTED', GrindResult.NOT_READY))
        self.assertEqual(self.start.text, 'start refused: ' + NOT_HOMED)
        self.assertEqual(self.start.setpoints, [])
        self.assertEqual(self.after_start.state_name, 'ready')

    def test_after_homing_a_job_is_ground(self):
        self.assertTrue(self.home.success, self.home.message)
        self.assertTrue(self.homed.homed)
        for joint, position, resolution in zip(gc.JOINTS, self.at_home, RESOLUTION):
            self.assertAlmostEqual(position, self.parameters['hardware'][joint]['home_position'], delta=resolution)
        self.assertEqual(self.next_run.status, 'SUCCEEDED', self.next_run.text)


class TestHoming(OwnNode, unittest.TestCase):
    """A machine whose encoders do not know where it stands when it is switched on: they start at 0."""

    equipment = {'absolute_encoders': False, 'spindle_run_up_time': 0}
    # Homing takes longer than all that is to happen meanwhile.
    axes = {'axis_x': {'start_position': -0.045}, 'axis_a': {'start_position': 3.0}}

    @classmethod
    def go_through(cls, g):
        cls.positions_at_first = g.positions_over(0.3)
        cls.at_first = g.fresh_state()
        cls.home_while_disabled = g.home()
        assert g.enable().success
        cls.enabled = g.wait_state(GrinderState.READY)
        cls.positions_when_enabled = g.positions_over(0.3)
        cls.start = g.send(gc.SHORT).wait()
        cls.after_start = g.fresh_state()
        cls.positions_after_start = g.positions_over(0.2)
        cls.dry_run = g.send(gc.SHORT, dry_run=True).wait()
        cls.status = gc.grind('--node', cls.node.name, 'status')

        # Broken off, it is not homed.
        first_state = len(g.states)
        cls.begin_homing(g)
        cls.goal_while_homing = g.send(gc.SHORT).wait()
        services = ('enable', 'home', 'resume', 'retract', 'lift', 'reset')
        cls.refused = {service: getattr(g, service)() for service in services}
        cls.disable = g.disable()
        cls.broken_off = [cls.off_when_broken_off(g)]
        cls.begin_homing(g)
        cls.hold = g.hold()
        cls.broken_off.append(cls.off_when_broken_off(g))
        cls.begin_homing(g)
        g.client.cancel_all_goals()
        cls.broken_off.append(cls.off_when_broken_off(g))
        cls.start_when_broken_off = g.send(gc.SHORT).wait()

        cls.home = gc.grind('--node', cls.node.name, 'home')
        cls.homed = g.fresh_state()
        cls.at_home = g.wait_rest()
        cls.positions_at_home = g.positions_over(0.2)
        cls.states = [name for name, _ in itertools.groupby(s.state_name for s in g.states[first_state:])]
        if cls.states[0] == 'ready':  # of before
            del cls.states[0]
        cls.job_run = g.run(gc.SHORT)

    @classmethod
    def begin_homing(cls, g):
        assert g.home().success
        g.wait_for(lambda: g.states[-1].state == GrinderState.HOMING, 'homing')

    @classmethod
    def off_when_broken_off(cls, g):
        """Waits for the end of the power, switches it on again, and returns the state and the positions in between."""
        state = g.wait_power_off()
        rest = g.wait_rest()
        positions = g.positions_over(0.2)
        assert g.enable().success
        g.wait_state(GrinderState.READY)
        return state, rest, positions

    def test_nothing_moves_after_the_start(self):
        self.assertEqual((self.at_first.state_name, self.at_first.homed, self.at_first.enabled),
                         ('disabled', False, False))
        self.assertEqual(set(self.positions_at_first), {(0, 0, 0, 0)})

    def test_homing_needs_power(self):
        self.assertEqual(self.home_while_disabled.message,
                         'home refused: the machine is in state disabled; allowed: enable, disable, reset')

    def test_it_does_not_home_by_itself(self):
        self.assertFalse(self.enabled.homed)
        self.assertEqual(set(self.positions_when_enabled), {(0, 0, 0, 0)})

    def test_no_job_begins_before(self):
        for run in (self.start, self.start_when_broken_off):
            self.assertEqual((run.status, run.code), ('ABORTED', GrindResult.NOT_READY))
            self.assertEqual(run.text, 'start refused: ' + NOT_HOMED)
            self.assertEqual(run.setpoints, [])
        self.assertEqual(self.after_start.state_name, 'ready')
        self.assertEqual(set(self.positions_after_start), {(0, 0, 0, 0)})

    def test_dry_run_does_not_need_it(self):
        self.assertEqual(self.dry_run.status, 'SUCCEEDED', self.dry_run.text)

    def test_status_tells_it(self):
        self.assertRegex(self.status.stdout, r'(?m)^homed +no$')

    def test_only_stops_are_allowed_meanwhile(self):
        for service, reply in self.refused.items():
            self.assertEqual((reply.success, reply.message), (
                False, '%s refused: the machine is in state homing; allowed: disable, hold, cancel' % service))
        self.assertEqual((self.goal_while_homing.status, self.goal_while_homing.code),
                         ('REJECTED', GrindResult.NOT_READY))
        self.assertRegex(self.goal_while_homing.text, r'state homing; allowed: disable, hold, cancel')

    def test_disable_hold_and_cancel_break_it_off_by_the_power(self):
        for reply in (self.disable, self.hold):
            self.assertEqual((reply.success, reply.message), (True, ''))
        for state, rest, positions in self.broken_off:
            self.assertEqual((state.homed, state.fault), (False, ''))
            self.assertEqual(set(positions), {tuple(rest)})

    def test_homing_goes_to_the_reference(self):
        self.assertEqual((self.home.returncode, self.home.stderr), (0, ''))
        self.assertEqual((self.homed.state_name, self.homed.homed), ('ready', True))
        for joint, position, resolution in zip(gc.JOINTS, self.at_home, RESOLUTION):
            self.assertAlmostEqual(position, self.parameters['hardware'][joint]['home_position'], delta=resolution)
        self.assertEqual(set(self.positions_at_home), {tuple(self.at_home)})
        self.assertEqual(self.states, ['homing', 'disabled', 'ready'] * 3 + ['homing', 'ready'])

    def test_job_works_afterwards(self):
        self.assertEqual((self.job_run.status, self.job_run.code), ('SUCCEEDED', 0), self.job_run.text)
        for position, park in zip(self.job_run.setpoints[-1].position, self.client.park()):
            self.assertAlmostEqual(position, park, delta=1e-15)


class TestHomingThatNeverEnds(OwnNode, unittest.TestCase):
    equipment = {'absolute_encoders': False}
    timeouts = {'homing_timeout': 0.3}
    axes = {'axis_x': {'start_position': 0.0, 'homing_velocity': 1e-4}}

    @classmethod
    def go_through(cls, g):
        assert g.enable().success
        g.wait_state(GrinderState.READY)
        cls.home = gc.grind('--node', cls.node.name, 'home')
        cls.state = g.wait_state(GrinderState.FAULT)
        cls.at = g.wait_rest()
        cls.positions = g.positions_over(0.3)
        cls.reset = g.reset()
        assert g.enable().success
        cls.ready = g.wait_state(GrinderState.READY)
        cls.positions_when_ready = g.positions_over(0.3)

    def test_it_is_a_fault_that_tells_the_time(self):
        self.assertFalse(self.state.enabled)
        told = re.match(r'the drive has not found its reference after (\S+) s, allowed 0\.3 s$', self.state.fault)
        self.assertTrue(told, self.state.fault)
        self.assertGreaterEqual(float(told.group(1)), 0.3)  # to the digits printed

    def test_command_line_tells_it(self):
        self.assertEqual(self.home.returncode, 1)
        self.assertEqual(self.home.stderr.strip(), self.state.fault)

    def test_nothing_moves_after_the_fault_and_the_reset(self):
        self.assertEqual(set(self.positions), {tuple(self.at)})
        self.assertTrue(self.reset.success)
        self.assertEqual((self.ready.fault, self.ready.homed), ('', False))
        self.assertEqual(set(self.positions_when_ready), {tuple(self.at)})


class NeverReady(OwnNode):
    """A job waits in vain for its equipment."""

    timeouts = {'spindle_timeout': 0.3}
    fault = 'none'
    reason = ''

    @classmethod
    def go_through(cls, g):
        g.make_ready()
        assert g.inject(cls.fault).success
        cls.at = g.wait_rest()
        cls.job_run = g.send(gc.SHORT).wait()
        cls.state = g.wait_state(GrinderState.READY)
        cls.positions = g.positions_over(0.3)
        cls.later = g.fresh_state()
        cls.states = [s.state_name for s in g.states]

    def test_goal_is_aborted_with_the_reason(self):
        self.assertEqual((self.job_run.status, self.job_run.code), ('ABORTED', GrindResult.NOT_READY))
        told = re.match(re.escape(self.reason) + r' (\S+) s after the job was started, allowed 0\.3 s',
                        self.job_run.text)
        self.assertTrue(told, self.job_run.text)
        self.assertGreaterEqual(float(told.group(1)), 0.3)  # to the digits printed
        self.assertEqual(self.job_run.result.setpoints_written, 0)

    def test_machine_is_ready_and_tells_the_reason(self):
        self.assertIn('starting', self.states)
        self.assertNotIn('running', self.states)
        self.assertEqual((self.state.state_name, self.state.enabled), ('ready', True))
        self.assertTrue(self.state.fault.startswith(self.reason), self.state.fault)
        self.assertFalse(self.later.spindle_at_speed and self.later.coolant_on)

    def test_nothing_moves(self):
        self.assertEqual({tuple(position) for position in self.positions}, {tuple(self.at)})
        self.assertEqual(self.job_run.setpoints, [])


class TestSpindleThatNeverComes(NeverReady, unittest.TestCase):
    equipment = {'spindle_run_up_time': 60}
    reason = NO_SPINDLE


class TestCoolantThatNeverComes(NeverReady, unittest.TestCase):
    equipment = {'spindle_run_up_time': 0}
    fault, reason = 'coolant_lost', NO_COOLANT

    def test_next_job_is_ground_when_it_is_back(self):
        self.assertTrue(self.client.inject('none').success)
        run = self.client.run(gc.SHORT)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertEqual(self.client.fresh_state().fault, '')


class TestWaitForTheSpindle(OwnNode, unittest.TestCase):
    equipment = {'spindle_run_up_time': 600}
    timeouts = {'spindle_timeout': 600}

    @classmethod
    def go_through(cls, g):
        g.make_ready()
        cls.at = g.wait_rest()
        cls.job_run = g.send(gc.SHORT)
        g.wait_state(GrinderState.STARTING)
        cls.positions = g.positions_over(0.3)
        # The first state told may be of the cycle before the coolant runs.
        cls.starting = g.fresh_state()
        services = ('enable', 'home', 'retract', 'lift', 'reset')
        cls.refused = {service: getattr(g, service)() for service in services}
        cls.busy = g.send(gc.SHORT).wait()
        cls.hold = g.hold()
        cls.held = g.fresh_state()
        cls.resume = g.resume()
        cls.resumed = g.fresh_state()
        cls.job_run.cancel()
        cls.job_run.wait()
        cls.state = g.wait_state(GrinderState.READY)
        cls.positions_when_ready = g.positions_over(0.3)
        cls.disabled_run = g.send(gc.SHORT)
        g.wait_state(GrinderState.STARTING)
        cls.disable = g.disable()
        cls.disabled_run.wait()
        g.wait_state(GrinderState.DISABLED)
        # The first state told may be of the cycle before the drive is without power.
        cls.disabled = g.fresh_state()
        cls.positions_when_disabled = g.positions_over(0.3)

    def test_nothing_moves_meanwhile(self):
        self.assertEqual(self.starting.state, GrinderState.STARTING)
        self.assertEqual((self.starting.spindle_at_speed, self.starting.coolant_on), (False, True))
        self.assertEqual({tuple(position) for position in self.positions}, {tuple(self.at)})

    def test_only_stops_and_resume_are_allowed_meanwhile(self):
        for service, reply in self.refused.items():
            self.assertEqual((reply.success, reply.message), (
                False, service + ' refused: the machine is in state starting; allowed: disable, hold, resume, cancel'))
        self.assertEqual((self.busy.status, self.busy.code), ('REJECTED', GrindResult.BUSY))

    def test_hold_and_resume_wait_for_the_spindle(self):
        for reply in (self.hold, self.resume):
            self.assertEqual((reply.success, reply.message), (True, ''))
        self.assertEqual([s.state_name for s in (self.held, self.resumed)], ['starting', 'starting'])

    def test_cancel_ends_the_job_before_it_moved(self):
        self.assertEqual((self.job_run.status, self.job_run.code), ('PREEMPTED', GrindResult.CANCELED))
        self.assertEqual((self.state.state_name, self.state.fault), ('ready', ''))
        self.assertFalse(self.state.wheel_in_work)
        self.assertEqual({tuple(position) for position in self.positions_when_ready}, {tuple(self.at)})

    def test_disable_ends_the_job_before_it_moved(self):
        self.assertTrue(self.disable.success)
        self.assertEqual((self.disabled_run.status, self.disabled_run.code), ('PREEMPTED', GrindResult.CANCELED))
        self.assertEqual((self.disabled.enabled, self.disabled.fault, self.disabled.wheel_in_work), (False, '', False))
        self.assertEqual({tuple(position) for position in self.positions_when_disabled}, {tuple(self.at)})


class TestEmergencyStopWhileRetracted(OwnNode, unittest.TestCase):
    """A fault on top of what was lost: the job is over, and nothing moves by itself ever after."""

    equipment = {'spindle_run_up_time': 0}

    @classmethod
    def go_through(cls, g):
        g.make_ready()
        cls.job_run = g.send(JOB).wait_in_stroke(4 * MM)
        assert g.inject('coolant_lost').success
        g.wait_state(GrinderState.RETRACTED)
        cls.at = g.wait_rest()
        assert g.inject('emergency_stop').success
        cls.fault = g.wait_state(GrinderState.FAULT)
        cls.job_run.wait()
        cls.in_fault = g.positions_over(0.2)
        assert g.inject('none').success
        gc.poll(lambda: not g.fresh_state().emergency_stop, 'the emergency stop released')
        cls.released = g.positions_over(0.2)
        assert g.reset().success
        g.wait_state(GrinderState.DISABLED)
        cls.after_reset = g.positions_over(0.2)
        assert g.enable().success
        cls.ready = g.wait_state(GrinderState.READY)
        cls.after_enable = g.positions_over(0.2)
        cls.resume = g.resume()
        cls.next_run = g.run(gc.SHORT)

    def test_goal_is_aborted(self):
        self.assertEqual((self.job_run.status, self.job_run.code), ('ABORTED', GrindResult.EMERGENCY_STOP))
        self.assertEqual((self.fault.enabled, self.fault.hold_reason), (False, ''))

    def test_nothing_moves_by_itself(self):
        for positions in (self.in_fault, self.released, self.after_reset, self.after_enable):
            self.assertEqual({tuple(position) for position in positions}, {tuple(self.at)})

    def test_job_is_over(self):
        self.assertEqual((self.ready.fault, self.ready.hold_reason), ('', ''))
        self.assertFalse(self.ready.wheel_in_work, 'it was lifted ahead of the fault')
        self.assertFalse(self.resume.success)
        self.assertEqual(self.next_run.status, 'SUCCEEDED', self.next_run.text)


if __name__ == '__main__':
    rospy.init_node('test_interlocks')
    rostest.rosrun('flute_grinder', 'interlocks', '__main__')
