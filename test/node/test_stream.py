"""Shows that the paper's job is streamed in batches, with velocities, and that the feedback reports how far it is; and what rviz is
shown of it. That the setpoints are those of the plan, test_cli_machine shows."""

import functools
import unittest

import rospy
from flute_grinder.msg import GrinderState, Legend
from visualization_msgs.msg import Marker, MarkerArray

import grinder_client as gc
from grinder_client import STROKE, grinder


@functools.lru_cache()
def stream():
    """The paper's job, run once for all tests."""
    grinder().make_ready_at_park()
    return grinder().send(gc.MOTION).wait_complete(timeout=120)


class TestPaperJob(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.job_run = stream()
        cls.setpoints = cls.job_run.setpoints
        cls.period = grinder().period()
        cls.planning = [f for f in cls.job_run.feedback if f.state == 'planning']
        cls.feedback = cls.job_run.feedback[len(cls.planning):]

    def test_batches_follow_one_another(self):
        batches = self.job_run.batches
        self.assertTrue(all(batch.setpoints for batch in batches))
        self.assertTrue(all(batch.period == self.period for batch in batches))
        stamps = [batch.header.stamp.to_sec() for batch in batches]
        self.assertTrue(all(b > a for a, b in zip(stamps, stamps[1:])))

    def test_velocity_is_the_difference_of_positions(self):
        for before, setpoint in zip(self.setpoints, self.setpoints[1:]):
            for axis in range(4):
                difference = (setpoint.position[axis] - before.position[axis]) / self.period
                self.assertAlmostEqual(setpoint.velocity[axis], difference, delta=1e-12 / self.period)

    def test_feedback_reports_the_planning_ahead_of_all_else(self):
        self.assertGreater(len(self.planning), 0)
        for f in self.planning:
            self.assertTrue(0 <= f.planned <= 1)
            self.assertEqual(f.job_fraction, 0)
        self.assertEqual({f.planned for f in self.feedback}, {1})

    def test_feedback_goes_from_start_to_end(self):
        feedback = self.feedback
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

    def test_feedback_reports_the_max_path_error(self):
        largest = max(f.path_error for f in self.feedback)
        self.assertAlmostEqual(largest, max(abs(s.path_error) for s in self.setpoints if s.move == STROKE), delta=1e-15)
        # It is the largest since the feedback before, and so never one from before the stroke.
        self.assertEqual(self.feedback[0].path_error, 0)


class TestDryRun(unittest.TestCase):
    def test_nothing_moves_and_the_statistics_are_those_of_the_run(self):
        planned = stream().result.plan.statistics
        positions = grinder().make_ready_at_park()
        batches, joints = len(grinder().batches), len(grinder().joints)
        run = grinder().send(gc.MOTION, dry_run=True).wait()
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
        self.assertEqual(run.result.plan.statistics, planned)
        self.assertTrue(run.result.plan.valid)
        self.assertEqual(run.result.reasons, [])
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertEqual(len(grinder().batches), batches)
        self.assertEqual({gc.axes_of(joint) for joint in grinder().joints[joints:]}, {tuple(positions)})

    def test_needs_no_power(self):
        grinder().make_ready()
        self.assertTrue(grinder().disable().success)
        run = grinder().send(gc.MOTION, dry_run=True).wait()
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
        self.assertEqual(grinder().fresh_state().state, GrinderState.DISABLED)


class TestMarkers(unittest.TestCase):
    def test_one_that_subscribes_later_gets_what_rviz_is_shown(self):
        grinder().make_ready_at_park()
        # The one shown last may be of another test's job.
        grinder().send(gc.MOTION, dry_run=True).wait()
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
