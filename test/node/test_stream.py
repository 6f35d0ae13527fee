"""Shows that the paper's job is streamed in batches, with velocities, and that the feedback reports how far it is; and what rviz is
shown of it. That the setpoints are those of the plan, test_cli_machine shows."""

import unittest

import rospy
from flute_grinder.msg import GrinderState, Legend
from visualization_msgs.msg import Marker, MarkerArray

import grinder_client as gc
from grinder_client import STROKE, grinder


class TestStream(unittest.TestCase):
    """The paper's job, run once for all tests."""

    @classmethod
    def setUpClass(cls):
        grinder().make_ready_at_park()
        cls.job_run = grinder().send(gc.MOTION).wait_complete(timeout=120)

    def test_setpoints_come_in_batches_with_velocities(self):
        self.assertEqual(self.job_run.result.plan.passes, [], 'only a dry run says what they remove')
        batches, period = self.job_run.batches, grinder().period()
        self.assertTrue(all(batch.setpoints and batch.period == period for batch in batches))
        stamps = [batch.header.stamp.to_sec() for batch in batches]
        self.assertTrue(all(b > a for a, b in zip(stamps, stamps[1:])))
        setpoints = self.job_run.setpoints
        for before, setpoint in zip(setpoints, setpoints[1:]):
            for axis in range(4):
                difference = (setpoint.position[axis] - before.position[axis]) / period
                self.assertAlmostEqual(setpoint.velocity[axis], difference, delta=1e-12 / period)

    def test_feedback_goes_from_the_planning_to_the_end(self):
        planning = [f for f in self.job_run.feedback if f.state == 'planning']
        self.assertGreater(len(planning), 0)
        for f in planning:
            self.assertTrue(0 <= f.planned <= 1)
            self.assertEqual(f.job_fraction, 0)
        feedback = self.job_run.feedback[len(planning):]
        self.assertEqual({f.planned for f in feedback}, {1})
        self.assertGreater(len(feedback), 10)
        self.assertLess(feedback[0].job_fraction, 0.1)
        # The very last may be overtaken by the result, and is then not handed on.
        self.assertGreater(feedback[-1].job_fraction, 0.9)
        for f in feedback:
            left = (1 - f.job_fraction) * self.job_run.result.plan.statistics.duration
            self.assertAlmostEqual(f.remaining_time, left, delta=1e-9)
        for name, sign in (('job_fraction', 1), ('stroke_fraction', 1), ('remaining_time', -1)):
            values = [getattr(f, name) * sign for f in feedback]
            self.assertTrue(all(a <= b for a, b in zip(values, values[1:])), name)
        self.assertEqual(feedback[len(feedback) // 2].state, 'running')
        self.assertLessEqual({f.state for f in feedback}, {'ready', 'starting', 'running'})
        largest = max(f.path_error for f in feedback)
        self.assertAlmostEqual(largest, max(abs(s.path_error) for s in self.job_run.setpoints if s.move == STROKE), delta=1e-15)
        # It is the largest since the feedback before, and so never one from before the stroke.
        self.assertEqual(feedback[0].path_error, 0)

    def test_dry_run_moves_nothing_needs_no_power_and_is_shown_in_rviz(self):
        positions = grinder().make_ready_at_park()
        batches, joints = len(grinder().batches), len(grinder().joints)
        for state in (GrinderState.READY, GrinderState.DISABLED):
            run = grinder().send(gc.MOTION, dry_run=True).wait()
            self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
            self.assertEqual(run.result.plan.statistics, self.job_run.result.plan.statistics)
            self.assertTrue(run.result.plan.valid)
            pass_, = run.result.plan.passes
            self.assertEqual(pass_.depth, gc.MOTION['process.depth'])
            self.assertTrue(pass_.area > 0 and pass_.rate > 0 and pass_.volume > 0, pass_)
            self.assertEqual(run.result.reasons, [])
            self.assertEqual(grinder().fresh_state().state, state)
            self.assertEqual(len(grinder().batches), batches)
            if state == GrinderState.READY:
                self.assertEqual({gc.axes_of(joint) for joint in grinder().joints[joints:]}, {tuple(positions)})
                self.assertTrue(grinder().disable().success)
        # One that subscribes later gets it.
        path, error = (rospy.wait_for_message('/grinder/' + topic, MarkerArray, gc.PATIENCE).markers
                       for topic in ('tool_path', 'path_error'))
        for markers in (path, error):
            self.assertEqual([m.action for m in markers], [Marker.DELETEALL] + [Marker.ADD] * (len(markers) - 1))
            self.assertGreater(len(markers), 1)
            self.assertLessEqual(max(len(m.points) for m in markers), 16384, 'more than rviz stands')
        self.assertEqual({(m.header.frame_id, m.type, m.frame_locked) for m in path[1:]}, {('cutter', Marker.LINE_STRIP, True)})
        legend = rospy.wait_for_message('/grinder/legend', Legend, gc.PATIENCE)
        self.assertRegex(legend.shown, r'^Planned: a job without a name \(D 10 mm, .*, 1 tooth\)$')
        self.assertEqual((legend.cutter, legend.tolerance, legend.max_error),
                         (gc.goal_of(gc.MOTION).cutter, gc.MOTION['interpolation.tolerance'], 0))
