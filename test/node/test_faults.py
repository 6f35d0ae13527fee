#!/usr/bin/env python3
"""Shows what a fault of the drive in the middle of a stroke does, for every kind that the simulated drive can show: the
goal ends with the right code and words, nothing moves any more, and after reset, enable and lift the grinder is back in
use. And that a cancelled goal stops on the path and lifts the wheel off the work before it ends."""

import math
import re
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks
from grinder_client import A, DEG, LIFT, MM, MM_MIN, STROKE, X, Y, Z, grinder

# Steep enough for every axis to move by more than its following error may be.
STEEP = gc.paper(cone_angle=20 * DEG, rake_angle=40 * DEG, clearance=1 * MM)
STEEP_CLEAR = checks.Helix(STEEP).y(31 * MM) + 1 * MM
# The same cutter once more, and clear of all of its flute.
AGAIN = dict(STEEP, **{'cutter.flute_length': 5 * MM, 'process.feed': 3000 * MM_MIN, 'process.clearance': 12 * MM})

# Encoder counts, as in config/grinder.yaml.
RESOLUTION = (1e-7, 1e-7, 1e-7, 1e-6)


class FaultMidStroke:
    """What holds of every fault. The fault is shown once, and what came of it is kept for the tests."""

    fault, joint = '', ''
    code = None
    text = ''
    pressed = False

    @classmethod
    def setUpClass(cls):
        g = grinder()
        g.make_ready()
        cls.limits, cls.period = g.limits(), g.period()
        cls.goal_run = g.send(STEEP).wait_in_stroke(5 * MM)
        cls.injected = g.inject(cls.fault, cls.joint)
        cls.goal_run.wait()
        cls.state = g.wait_state(GrinderState.FAULT)
        g.fresh_state()
        cls.setpoints = cls.goal_run.setpoints
        cls.resting = g.positions_over(0.3)

        cls.enable_in_fault = g.enable()
        cls.disable_in_fault = g.disable()
        cls.goal_in_fault = g.send(gc.SHORT).wait()
        cls.reset_in_fault = g.reset() if cls.pressed else None
        cls.still_fault = g.fresh_state()

        g.inject('none')
        gc.poll(lambda: not g.fresh_state().emergency_stop, 'the emergency stop released')
        cls.released = g.fresh_state()
        cls.reset = g.reset()
        cls.after_reset = g.wait_state(GrinderState.DISABLED)
        cls.at_reset = g.wait_rest()
        cls.enable = g.enable()
        cls.after_enable = g.wait_state(GrinderState.READY)
        cls.at_enable = g.positions_over(0.3)
        cls.home_in_work = g.home()
        cls.goal_in_work = g.send(gc.SHORT).wait()
        cls.at_refusals = g.wait_rest()
        cls.lift = g.lift()
        gc.poll(lambda: not g.fresh_state().wheel_in_work, 'the wheel off the work')
        cls.after_lift = g.wait_state(GrinderState.READY)
        cls.at_lift = g.wait_rest()
        cls.late_setpoints = cls.goal_run.setpoints[len(cls.setpoints):]
        cls.next_run = g.run(AGAIN)

    def test_fault_was_injected_mid_stroke(self):
        self.assertTrue(self.injected.success, self.injected.message)
        last = self.setpoints[-1]
        self.assertEqual(last.move, STROKE)
        self.assertTrue(5 * MM < last.position[X] < 30 * MM, last.position[X])

    def test_goal_is_aborted_with_the_code(self):
        self.assertEqual((self.goal_run.status, self.goal_run.code), ('ABORTED', self.code))

    def test_text_names_what_and_where(self):
        self.assertRegex(self.goal_run.text, self.text)
        self.assertRegex(self.goal_run.text, r'stroke of tooth 1, pass 1, X = 0\.0[0-2]\d* m')

    def test_state_tells_the_fault(self):
        for state in (self.state, self.still_fault):
            self.assertEqual((state.state, state.state_name), (GrinderState.FAULT, 'fault'))
            self.assertRegex(state.fault, self.text)
            self.assertIn(state.fault, self.goal_run.text)

    def test_power_is_off(self):
        self.assertFalse(self.still_fault.enabled)

    def test_setpoints_end_without_a_gap_or_a_jump(self):
        self.assertTrue(checks.is_gapless(self.setpoints))
        self.assertEqual(checks.off_path(self.setpoints, checks.Helix(STEEP)), [])
        self.assertEqual(checks.excesses(self.setpoints, self.limits, self.period, rest_after=False), [])

    def test_no_setpoint_comes_after_the_end(self):
        self.assertEqual(self.late_setpoints, [])

    def test_axes_stand_still_after_the_fault(self):
        self.assertEqual(self.standing(self.resting), 1)

    @classmethod
    def standing(cls, positions):
        """Among how many places the axes were, of those that tell a number."""
        return len({tuple(p for p in position if not math.isnan(p)) for position in positions})

    def test_enable_is_refused(self):
        self.assertFalse(self.enable_in_fault.success)
        self.assertRegex(self.enable_in_fault.message,
                         r'refused: the machine is in state fault; allowed: disable, reset$')

    def test_disable_finds_the_power_off(self):
        self.assertEqual((self.disable_in_fault.success, self.disable_in_fault.message), (True, ''))
        self.assertEqual(self.still_fault.state, GrinderState.FAULT)

    def test_goal_is_refused(self):
        self.assertEqual((self.goal_in_fault.status, self.goal_in_fault.code), ('REJECTED', GrindResult.NOT_READY))
        self.assertRegex(self.goal_in_fault.text, r'state fault; allowed: disable, reset')
        self.assertEqual(self.goal_in_fault.setpoints, [])

    def test_fault_stays_until_reset(self):
        self.assertEqual(self.released.state, GrinderState.FAULT)
        self.assertTrue(self.reset.success, self.reset.message)
        self.assertEqual((self.after_reset.enabled, self.after_reset.fault), (False, ''))

    def test_nothing_moves_by_itself_after_reset_and_enable(self):
        self.assertTrue(self.enable.success, self.enable.message)
        self.assertEqual((self.after_enable.enabled, self.after_enable.fault), (True, ''))
        self.assertEqual({tuple(position) for position in self.at_enable}, {tuple(self.at_reset)})

    def test_state_tells_the_wheel_in_the_work_until_it_is_lifted(self):
        told = [s.wheel_in_work for s in (self.state, self.after_reset, self.after_enable, self.after_lift)]
        self.assertEqual(told, [True, True, True, False])

    def test_home_and_goals_are_refused_in_the_work(self):
        self.assertEqual((self.home_in_work.success, self.home_in_work.message),
                         (False, 'home refused: the wheel stands in the work; lift it first'))
        self.assertEqual((self.goal_in_work.status, self.goal_in_work.code), ('REJECTED', GrindResult.NOT_READY))
        self.assertEqual(self.goal_in_work.text, 'the wheel stands in the work of the last job; lift it first')
        self.assertEqual(self.at_refusals, self.at_reset)

    def test_lift_goes_radially_clear_of_the_work(self):
        self.assertTrue(self.lift.success, self.lift.message)
        self.assertEqual([self.at_lift[i] for i in (X, Z, A)], [self.at_reset[i] for i in (X, Z, A)])
        self.assertAlmostEqual(self.at_lift[Y], STEEP_CLEAR, delta=1.01 * RESOLUTION[Y])

    def test_next_goal_lifts_first_and_runs_to_its_end(self):
        self.assertEqual((self.next_run.status, self.next_run.code), ('SUCCEEDED', 0), self.next_run.text)
        self.assertTrue(checks.is_gapless(self.next_run.setpoints))
        check_lift(self, self.next_run.setpoints)
        self.assertEqual(checks.excesses(self.next_run.setpoints, self.limits, self.period), [])


def check_lift(test, setpoints):
    """The first move lifts the wheel and does nothing else."""
    lift = [s for s in setpoints if s.move == LIFT]
    test.assertGreater(len(lift), 10)
    test.assertEqual([s.cycle for s in lift], list(range(len(lift))))
    for axis in (X, Z, A):
        test.assertEqual({s.position[axis] for s in lift}, {setpoints[0].position[axis]})
    heights = [s.position[Y] for s in lift]
    test.assertTrue(all(a <= b for a, b in zip(heights, heights[1:])))
    test.assertLess(heights[0], heights[1])


class TestEmergencyStop(FaultMidStroke, unittest.TestCase):
    fault, pressed = 'emergency_stop', True
    code = GrindResult.EMERGENCY_STOP
    text = r'^emergency stop'

    def test_reset_is_refused_while_it_is_pressed(self):
        self.assertFalse(self.reset_in_fault.success)
        self.assertRegex(self.reset_in_fault.message, r'^reset refused: .*emergency stop.*release')
        self.assertEqual(self.still_fault.state, GrinderState.FAULT)

    def test_state_tells_whether_it_is_pressed(self):
        self.assertEqual((self.still_fault.emergency_stop, self.released.emergency_stop), (True, False))


class TestDriveFault(FaultMidStroke, unittest.TestCase):
    fault = 'drive_fault'
    code = GrindResult.HARDWARE_FAULT
    text = r'^the drive reports a fault'


class TestStaleFeedback(FaultMidStroke, unittest.TestCase):
    fault = 'stale_feedback'
    code = GrindResult.LINK_LOST
    text = r'^no fresh positions from the drive for 0\.\d+ s, allowed 0\.002 s'

    def test_text_tells_a_time_beyond_what_is_allowed(self):
        age, allowed = map(float, re.search(r'for (\S+) s, allowed (\S+) s', self.goal_run.text).groups())
        self.assertEqual(allowed, rospy.get_param('/grinder/feedback_timeout'))
        self.assertGreaterEqual(age, allowed)  # to the digits printed

    def test_no_more_is_commanded_than_the_timeout_lets_pass(self):
        # `actual` no longer changes from where the feedback became stale.
        actual = [tuple(s.actual) for s in self.setpoints]
        stale = actual.count(actual[-1]) - 1
        allowed = rospy.get_param('/grinder/feedback_timeout') / self.period
        # Cycles that a stalled host made shorter than the period cannot be told from here: one for rounding, one more.
        self.assertLessEqual(stale, allowed + 2)


class TestNanFeedback(FaultMidStroke, unittest.TestCase):
    fault, joint = 'nan_feedback', 'axis_y'
    code = GrindResult.HARDWARE_FAULT
    text = r'^axis_y position from the drive is -?nan'


class StuckAxis(FaultMidStroke):
    fault = 'stuck_axis'
    code = GrindResult.PATH_TOLERANCE_VIOLATED

    def test_text_tells_amount_and_limit(self):
        amount, limit = map(float, re.search(r'following error (\S+) \S+ is beyond its limit (\S+) ',
                                             self.goal_run.text).groups())
        self.assertEqual(limit, rospy.get_param('/grinder/constraints/%s/trajectory' % self.joint))
        self.assertGreaterEqual(amount, limit)
        # Found in the first cycle in which it is: beyond by no more than one cycle's way.
        axis = gc.JOINTS.index(self.joint)
        way = max(abs(s.velocity[axis]) for s in self.setpoints if s.move == STROKE) * self.period
        self.assertLessEqual(amount, limit + way + 1e-5 * limit)


class TestStuckX(StuckAxis, unittest.TestCase):
    joint = 'axis_x'
    text = r'^axis_x following error 0\.001\d* m is beyond its limit 0\.001 m'


class TestStuckY(StuckAxis, unittest.TestCase):
    joint = 'axis_y'
    text = r'^axis_y following error 0\.001\d* m is beyond its limit 0\.001 m'


class TestStuckZ(StuckAxis, unittest.TestCase):
    joint = 'axis_z'
    text = r'^axis_z following error 0\.001\d* m is beyond its limit 0\.001 m'


class TestStuckA(StuckAxis, unittest.TestCase):
    joint = 'axis_a'
    text = r'^axis_a following error 0\.05\d* rad is beyond its limit 0\.05 rad'


class TestFaultAtRest(unittest.TestCase):
    """A fault while ready, without a job."""

    def test_machine_is_in_fault_and_comes_back(self):
        g = grinder()
        rest = g.make_ready()
        g.inject('emergency_stop')
        state = g.wait_state(GrinderState.FAULT)
        self.assertEqual((state.fault, state.emergency_stop), ('emergency stop', True))
        self.assertEqual(g.make_ready(), rest)

    def test_power_is_refused_while_the_emergency_stop_is_pressed(self):
        g = grinder()
        g.make_ready()
        self.assertTrue(g.disable().success)
        g.inject('emergency_stop')
        gc.poll(lambda: g.fresh_state().emergency_stop, 'the emergency stop')
        reply = g.enable()
        self.assertFalse(reply.success)
        self.assertRegex(reply.message, r'^enable refused: the emergency stop is pressed')
        self.assertEqual(g.fresh_state().state, GrinderState.DISABLED)

    def tearDown(self):
        grinder().make_ready()


class CancelledGoal:
    """What holds of a goal that is cancelled; once, as above."""

    job = STEEP

    @classmethod
    def setUpClass(cls):
        g = grinder()
        g.make_ready()
        cls.limits, cls.period = g.limits(), g.period()
        cls.goal_run = g.send(cls.job)
        cls.wait_for_the_moment()
        first_state = len(g.states)
        cls.goal_run.cancel()
        # Twice, as impatient people do.
        cls.goal_run.cancel()
        cls.goal_run.wait_complete()
        cls.state = g.wait_state(GrinderState.READY)
        cls.canceling = [s for s in g.states[first_state:] if s.state == GrinderState.CANCELING]
        g.fresh_state()
        cls.setpoints = cls.goal_run.setpoints
        cls.rest = g.wait_rest()
        cls.next_run = g.run(AGAIN)

    def test_goal_is_preempted(self):
        self.assertEqual((self.goal_run.status, self.goal_run.code), ('PREEMPTED', GrindResult.CANCELED))
        self.assertRegex(self.goal_run.text, r'^canceled; stopped on the path \(at \w+ of tooth 1, pass 1, X = ')

    def test_machine_is_ready(self):
        self.assertEqual((self.state.state, self.state.enabled, self.state.fault), (GrinderState.READY, True, ''))
        self.assertFalse(self.state.wheel_in_work)

    def test_stop_is_short_of_the_end(self):
        self.assertTrue(checks.is_gapless(self.setpoints))
        self.assertLess(len(self.setpoints), self.goal_run.result.statistics.setpoints)

    def test_axes_come_to_rest_within_their_limits(self):
        self.assertEqual(checks.excesses(self.setpoints, self.limits, self.period, rest_after=True), [])
        self.assertEqual(len(self.setpoints) % 2, 1, 'the last ends a pair')

    def test_stop_is_on_the_path(self):
        self.assertEqual(checks.off_path(self.setpoints, checks.Helix(self.job)), [])

    def test_axes_rest_at_the_last_setpoint(self):
        for position, commanded, resolution in zip(self.rest, self.setpoints[-1].position, RESOLUTION):
            self.assertAlmostEqual(position, commanded, delta=1.01 * resolution)

    def test_next_goal_goes_on_from_there(self):
        self.assertEqual((self.next_run.status, self.next_run.code), ('SUCCEEDED', 0), self.next_run.text)
        self.assertTrue(checks.is_gapless(self.next_run.setpoints))
        self.assertEqual(list(self.next_run.setpoints[0].position), list(self.setpoints[-1].position))


class TestCancelMidStroke(CancelledGoal, unittest.TestCase):
    @classmethod
    def wait_for_the_moment(cls):
        cls.goal_run.wait_in_stroke(5 * MM)

    @property
    def ground(self):
        """The setpoints to the stop."""
        return self.setpoints[:max(i for i, s in enumerate(self.setpoints) if s.move == STROKE) + 1]

    def test_text_tells_where_the_stroke_was_left(self):
        self.assertIn('(at stroke of tooth 1, pass 1, X = %g m)' % self.ground[-1].position[X], self.goal_run.text)

    def test_axes_rest_on_the_stroke_first(self):
        self.assertEqual(len(self.ground) % 2, 1, 'the last ends a pair')
        self.assertEqual(checks.excesses(self.ground, self.limits, self.period, rest_after=True), [])

    def test_wheel_is_lifted_before_the_goal_ends(self):
        checks.check_lifted(self, self.ground[-1], self.setpoints[len(self.ground):], STEEP_CLEAR)

    def test_wheel_turns_and_coolant_flows_until_it_is_lifted(self):
        self.assertTrue(self.canceling)
        self.assertTrue(all(s.spindle_at_speed and s.coolant_on for s in self.canceling))

    def test_next_goal_lifts_first(self):
        check_lift(self, self.next_run.setpoints)


class TestCancelOffTheStroke(CancelledGoal, unittest.TestCase):
    @classmethod
    def wait_for_the_moment(cls):
        # The axes are on their way, but not yet at work.
        grinder().wait_for(lambda: any(s.velocity[X] > 0.05 for s in cls.goal_run.setpoints), 'motion')

    def test_it_ends_where_it_stops(self):
        self.assertNotIn(self.setpoints[-1].move, (STROKE, LIFT))
        self.assertGreaterEqual(self.setpoints[-1].position[Y], STEEP_CLEAR - 1e-15)


if __name__ == '__main__':
    rospy.init_node('test_faults')
    rostest.rosrun('flute_grinder', 'faults', '__main__')
