#!/usr/bin/env python3
"""Shows that the paper's job is streamed as it was planned: every setpoint arrives once and in order, on the
theoretical curve within the bound of the odd-even steps, at a constant surface feed, within the axes' limits, and bit
for bit the same as `grind plan` lists and as the same goal gives again."""

import math
import os
import shutil
import tempfile
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, Legend
from visualization_msgs.msg import Marker, MarkerArray

import grinder_client as gc
import path_checks as checks
from grinder_client import (A, APPROACH, EVEN, INDEX, INFEED, MM, MM_MIN, MOVES, ODD, POSITION, RETRACT, RETURN, STEPS,
                            STROKE, X, Y, Z, grinder)

RUNS = {}

COLUMNS = 'cycle,time_s,move,tooth,pass,step,x_mm,y_mm,z_mm,a_rad,error_rad,feed_mm_min'.split(',')


def stream(feed_mm_min):
    """The paper's job at a feed, run once for all tests."""
    if feed_mm_min not in RUNS:
        grinder().make_ready_at_park()
        RUNS[feed_mm_min] = grinder().send(gc.paper(feed=feed_mm_min * MM_MIN)).wait_complete(timeout=120)
    return RUNS[feed_mm_min]


class PaperJob:
    """All that holds of the paper's job at any feed."""

    feed_mm_min = None

    @classmethod
    def setUpClass(cls):
        cls.job = gc.paper(feed=cls.feed_mm_min * MM_MIN)
        cls.helix = checks.Helix(cls.job)
        cls.job_run = stream(cls.feed_mm_min)
        cls.setpoints = cls.job_run.setpoints
        cls.stroke = [s for s in cls.setpoints if s.move == STROKE]
        cls.pairs = checks.stroke_pairs(cls.setpoints)
        cls.period = grinder().period()
        cls.statistics = cls.job_run.result.statistics
        cls.feed = cls.feed_mm_min * MM_MIN
        cls.planning = [f for f in cls.job_run.feedback if f.state == 'planning']
        cls.feedback = cls.job_run.feedback[len(cls.planning):]

    def pair_feeds(self):
        return [(even.position[X] - start.position[X]) / (2 * self.period) * self.helix.edge
                for start, _, even in self.pairs]

    def pairs_at_feed(self):
        """The pairs from the first to the last that reach the feed but for a millionth."""
        feeds = self.pair_feeds()
        reached = [i for i, feed in enumerate(feeds) if feed >= 0.999999 * self.feed]
        self.assertTrue(reached, 'the feed is never reached')
        return self.pairs[reached[0]:reached[-1] + 1], feeds[reached[0]:reached[-1] + 1]

    def test_goal_succeeds(self):
        self.assertEqual((self.job_run.status, self.job_run.code, self.job_run.text), ('SUCCEEDED', 0, ''))

    def test_no_setpoint_is_missing(self):
        self.assertTrue(checks.is_gapless(self.setpoints))

    def test_statistics_count_the_setpoints(self):
        self.assertEqual(self.statistics.setpoints, len(self.setpoints))
        self.assertAlmostEqual(self.statistics.duration, (len(self.setpoints) - 1) * self.period, delta=1e-9)

    def test_statistics_time_the_moves(self):
        for move, duration in enumerate(self.statistics.move_duration):
            count = sum(s.move == move for s in self.setpoints[1:])
            self.assertAlmostEqual(duration, count * self.period, delta=1e-9, msg=MOVES[move])

    def test_batches_follow_one_another(self):
        batches = self.job_run.batches
        self.assertTrue(all(batch.setpoints for batch in batches))
        self.assertTrue(all(batch.period == self.period for batch in batches))
        stamps = [batch.header.stamp.to_sec() for batch in batches]
        self.assertTrue(all(b > a for a, b in zip(stamps, stamps[1:])))

    def test_moves_come_in_order(self):
        order = [self.setpoints[0].move]
        for setpoint in self.setpoints:
            if setpoint.move != order[-1]:
                order.append(setpoint.move)
        self.assertEqual(order, [INDEX, POSITION, APPROACH, INFEED, STROKE, RETRACT, RETURN])
        self.assertEqual({(s.tooth, s.pass_) for s in self.setpoints}, {(0, 0)})

    def test_even_cycles_end_the_pairs(self):
        for setpoint in self.setpoints:
            expected = STEPS.index('none')
            if setpoint.move == STROKE:
                expected = EVEN if setpoint.cycle % 2 == 0 else ODD
            self.assertEqual(setpoint.step, expected, 'cycle %d' % setpoint.cycle)

    def test_job_goes_from_park_to_park(self):
        park = grinder().park()
        self.assertEqual(list(self.setpoints[0].position), park)
        self.assertEqual(list(self.setpoints[-1].position), park)

    def test_stroke_starts_at_the_overtravel(self):
        self.assertAlmostEqual(self.pairs[0][0].position[X], -1 * MM, delta=1e-12)

    def test_stroke_ends_on_its_end_point(self):
        self.assertAlmostEqual(self.stroke[-1].position[X], 31 * MM, delta=1e-9)

    def test_y_and_z_follow_x(self):
        depth = self.job['process.depth']
        for setpoint in self.stroke:
            x, y, z, _ = setpoint.position
            self.assertAlmostEqual(y, self.helix.y(x) - depth, delta=1e-12)
            self.assertAlmostEqual(z, self.helix.z(x), delta=1e-12)

    def test_path_error_is_theory_minus_commanded(self):
        for setpoint in self.setpoints:
            error = 0
            if setpoint.move == STROKE:
                error = self.helix.a(setpoint.position[X]) - setpoint.position[A]
            self.assertAlmostEqual(setpoint.path_error, error, delta=1e-12)

    def test_odd_error_is_that_of_the_tangent(self):
        for start, odd, _ in self.pairs:
            x = start.position[X]
            dx = odd.position[X] - x
            grown = odd.path_error - (start.path_error if start.move == STROKE else 0)
            self.assertAlmostEqual(grown, self.helix.tangent_error(x, dx), delta=1e-14)

    def test_odd_error_stays_under_its_bound(self):
        largest_even = max(abs(even.path_error) for _, _, even in self.pairs)
        for start, odd, _ in self.pairs:
            x = start.position[X]
            bound = self.helix.tangent_bound(x, odd.position[X] - x) * (1 + 1e-3) + largest_even
            self.assertLessEqual(abs(odd.path_error), bound)

    def test_even_error_falls_with_the_step_squared(self):
        # From the paper's figure for a step length of 0.2, with room for the stroke beyond the paper's 30 mm.
        step = max(math.hypot(odd.position[X] - start.position[X],
                              self.helix.scale * (odd.position[A] - start.position[A])) for start, odd, _ in self.pairs)
        bound = 3.5e-7 * (step / (0.2 * MM)) ** 2 * 1.1 + 1e-12
        self.assertLess(max(abs(even.path_error) for _, _, even in self.pairs), bound)

    def test_statistics_tell_the_errors(self):
        odd = [abs(s.path_error) for s in self.stroke if s.step == ODD]
        even = [abs(s.path_error) for s in self.stroke if s.step == EVEN]
        deviation = max(abs(s.path_error) * self.helix.radius(s.position[X]) for s in self.stroke) * self.helix.normal
        self.assertAlmostEqual(self.statistics.max_odd_error, max(odd), delta=1e-12)
        self.assertAlmostEqual(self.statistics.max_even_error, max(even), delta=1e-12)
        self.assertAlmostEqual(self.statistics.max_deviation, deviation, delta=1e-6 * deviation)

    def test_deviation_keeps_the_tolerance(self):
        tolerance = self.job['interpolation.tolerance']
        for setpoint in self.stroke:
            deviation = abs(self.helix.a(setpoint.position[X]) - setpoint.position[A]) * self.helix.radius(
                setpoint.position[X]) * self.helix.normal
            self.assertLessEqual(deviation, tolerance)

    def test_surface_feed_is_constant_pair_by_pair(self):
        _, feeds = self.pairs_at_feed()
        self.assertGreater(len(feeds), 0.9 * len(self.pairs), 'most of the stroke is not ramp')
        for feed in feeds:
            self.assertAlmostEqual(feed / self.feed, 1, delta=1e-6)

    def test_surface_feed_step_by_step_is_the_algorithms_own(self):
        pairs, _ = self.pairs_at_feed()
        for start, odd, even in pairs:
            x = start.position[X]
            dx1 = odd.position[X] - x
            dx2 = even.position[X] - odd.position[X]
            length = math.hypot(dx1, self.helix.scale * (odd.position[A] - start.position[A]))
            allowed = self.helix.pair_unevenness(x, length) * (1 + 1e-3) + 1e-10
            self.assertLessEqual(abs(dx2 / dx1 - 1), allowed)
            for dx in (dx1, dx2):
                self.assertLessEqual(abs(dx / self.period * self.helix.edge / self.feed - 1), allowed + 1e-6)

    def test_statistics_tell_the_feed(self):
        self.assertAlmostEqual(self.statistics.min_feed / self.feed, 1, delta=1e-6)
        self.assertAlmostEqual(self.statistics.max_feed / self.feed, 1, delta=1e-6)
        self.assertLessEqual(self.statistics.min_feed, self.statistics.max_feed)
        self.assertEqual(self.statistics.feed_limits, [])

    def test_infeed_keeps_the_feed(self):
        infeed = [s for s in self.setpoints if s.move == INFEED]
        speeds = [abs(s.velocity[Y]) for s in infeed]
        self.assertLessEqual(max(speeds), self.feed * (1 + 1e-9))
        self.assertGreater(max(speeds), 0.5 * self.feed)
        self.assertEqual({(s.position[X], s.position[Z], s.position[A]) for s in infeed},
                         {(infeed[0].position[X], infeed[0].position[Z], infeed[0].position[A])})

    def test_no_axis_exceeds_a_limit(self):
        self.assertEqual(checks.excesses(self.setpoints, grinder().limits(), self.period), [])

    def test_statistics_tell_the_largest_velocities(self):
        for axis in range(4):
            positions = [s.position[axis] for s in self.setpoints]
            largest = max(abs(b - a) for a, b in zip(positions, positions[1:])) / self.period
            self.assertAlmostEqual(self.statistics.max_velocity[axis], largest, delta=1e-6 * largest)

    def test_statistics_tell_the_largest_accelerations(self):
        for axis in range(4):
            ends = [s.position[axis] for s in self.setpoints[::2]]
            largest = max(abs(c - 2 * b + a) for a, b, c in zip([ends[0]] + ends, ends, ends[1:]))
            largest /= (2 * self.period) ** 2
            self.assertAlmostEqual(self.statistics.max_acceleration[axis], largest, delta=1e-6 * largest)

    def test_statistics_tell_the_ripple_of_the_single_cycles(self):
        for axis in range(4):
            positions = [s.position[axis] for s in self.setpoints]
            largest = max(abs(c - 2 * b + a) for a, b, c in zip([positions[0]] + positions, positions, positions[1:]))
            largest /= self.period ** 2
            self.assertAlmostEqual(self.statistics.ripple_acceleration[axis], largest, delta=1e-5 * largest)

    def test_velocity_is_the_difference_of_positions(self):
        for before, setpoint in zip(self.setpoints, self.setpoints[1:]):
            for axis in range(4):
                difference = (setpoint.position[axis] - before.position[axis]) / self.period
                self.assertAlmostEqual(setpoint.velocity[axis], difference, delta=1e-12 / self.period)

    def test_drive_follows_the_setpoints(self):
        allowed = [rospy.get_param('/grinder/constraints/%s/trajectory' % joint) for joint in gc.JOINTS]
        # A node that the host stalls reads the positions of a buffered drive once for several setpoints: they are of the last.
        read = [(before, setpoint) for before, setpoint, after in zip(self.setpoints, self.setpoints[1:], self.setpoints[2:])
                if setpoint.actual != after.actual]
        self.assertGreater(len(read), len(self.setpoints) / 3)
        for before, setpoint in read:
            for axis in range(4):
                self.assertLessEqual(abs(before.position[axis] - setpoint.actual[axis]), allowed[axis])

    def test_feedback_tells_the_planning_ahead_of_all_else(self):
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
            left = (1 - f.job_fraction) * self.statistics.duration
            self.assertAlmostEqual(f.remaining_time, left, delta=1e-9)
        for name, sign in (('job_fraction', 1), ('stroke_fraction', 1), ('remaining_time', -1)):
            values = [getattr(f, name) * sign for f in feedback]
            self.assertTrue(all(a <= b for a, b in zip(values, values[1:])), name)
        self.assertEqual(feedback[len(feedback) // 2].state, 'running')
        self.assertLessEqual({f.state for f in feedback}, {'ready', 'starting', 'running'})

    def test_feedback_tells_the_largest_path_error(self):
        largest = max(f.path_error for f in self.feedback)
        self.assertAlmostEqual(largest, max(abs(s.path_error) for s in self.stroke), delta=1e-15)
        # It is the largest since the feedback before, and so never one from before the stroke.
        self.assertEqual(self.feedback[0].path_error, 0)

    def test_plan_lists_the_very_same_values(self):
        folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, folder)
        csv = os.path.join(folder, 'plan.csv')
        job = gc.job_file(os.path.join(folder, 'job.yaml'), feed_mm_min=self.feed_mm_min)
        plan = gc.grind('plan', job, '--csv', csv)
        self.assertEqual(plan.returncode, 0, plan.stderr)
        with open(csv) as lines:
            rows = [line.rstrip('\n').split(',') for line in lines]
        self.assertEqual(rows[0], COLUMNS)
        self.assertEqual(len(rows) - 1, len(self.setpoints))
        for row, s in zip(rows[1:], self.setpoints):
            p = s.position
            words = [str(s.cycle), MOVES[s.move], str(s.tooth), str(s.pass_), STEPS[s.step]]
            self.assertEqual([row[0], row[2], row[3], row[4], row[5]], words)
            numbers = [s.cycle * self.period, p[X] / 1e-3, p[Y] / 1e-3, p[Z] / 1e-3, p[A], s.path_error,
                       s.feed / MM_MIN]
            self.assertEqual([float(text).hex() for text in [row[1]] + row[6:]], [float(n).hex() for n in numbers])


class TestPaperJobAt600(PaperJob, unittest.TestCase):
    feed_mm_min = 600


class TestPaperJobAt60(PaperJob, unittest.TestCase):
    feed_mm_min = 60

    def test_error_stays_under_the_issues_figure(self):
        # |k b| dX^2 / 2 at X = 0 and 60 mm/min is 7.54e-10 rad; with the even error and no more than 7.6e-10.
        for setpoint in self.stroke:
            if 0 <= setpoint.position[X] <= 30 * MM:
                self.assertLess(abs(setpoint.path_error), 7.6e-10)


class TestRepetition(unittest.TestCase):
    def test_same_goal_gives_the_same_bits(self):
        first = stream(600).setpoints
        grinder().make_ready_at_park()
        again = grinder().run(gc.MOTION)
        self.assertEqual(again.status, 'SUCCEEDED', again.text)
        bits = [[[p.hex() for p in s.position] + [s.path_error.hex()] for s in setpoints]
                for setpoints in (first, again.setpoints)]
        self.assertEqual(len(bits[0]), len(bits[1]))
        self.assertTrue(bits[0] == bits[1])

    def test_machine_rests_at_park_and_is_ready(self):
        grinder().make_ready()
        run = grinder().run(gc.SHORT)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        for position, park in zip(grinder().wait_rest(), grinder().park()):
            self.assertAlmostEqual(position, park, delta=1e-6)

    def test_every_tooth_and_pass_is_ground(self):
        grinder().make_ready()
        angles = [0.0, 1.5, math.pi, 4.7]
        job = dict(gc.SHORT)
        job.update({'cutter.tooth_angles': angles, 'cutter.flute_length': 2 * MM, 'process.infeed': 0.3 * MM})
        run = grinder().run(job)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        helix = checks.Helix(job)
        strokes = []
        for s in run.setpoints:
            if s.move != STROKE:
                continue
            x, y, _, a = s.position
            key = (s.tooth, s.pass_)
            if not strokes or strokes[-1] != key:
                strokes.append(key)
            self.assertAlmostEqual(a, angles[s.tooth] + helix.a(x), delta=1e-5)
            self.assertAlmostEqual(y, helix.y(x) - (0.3 * MM, 0.5 * MM)[s.pass_], delta=1e-12)
        self.assertEqual(strokes, [(tooth, i) for tooth in range(4) for i in range(2)])
        self.assertEqual(checks.excesses(run.setpoints, grinder().limits(), grinder().period()), [])

    def test_stroke_toward_the_end_is_the_same_curve(self):
        grinder().make_ready()
        job = dict(gc.SHORT)
        job['process.direction'] = 1
        run = grinder().run(job)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        pairs = checks.stroke_pairs(run.setpoints)
        self.assertAlmostEqual(pairs[0][0].position[X], 6 * MM, delta=1e-12)
        self.assertAlmostEqual(pairs[-1][2].position[X], -1 * MM, delta=1e-9)
        self.assertEqual(checks.off_path(run.setpoints, checks.Helix(job)), [])
        self.assertEqual(checks.excesses(run.setpoints, grinder().limits(), grinder().period()), [])


class TestDryRun(unittest.TestCase):
    def test_nothing_moves_and_the_statistics_are_those_of_the_run(self):
        planned = stream(600).result.statistics
        positions = grinder().make_ready_at_park()
        batches, joints = len(grinder().batches), len(grinder().joints)
        run = grinder().send(gc.MOTION, dry_run=True).wait()
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
        self.assertEqual(run.result.statistics, planned)
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertEqual(len(grinder().batches), batches)
        self.assertEqual({gc.axes_of(joint) for joint in grinder().joints[joints:]}, {tuple(positions)})

    def test_needs_no_power(self):
        grinder().make_ready()
        self.assertTrue(grinder().disable().success)
        run = grinder().send(gc.MOTION, dry_run=True).wait()
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
        self.assertEqual(grinder().fresh_state().state, GrinderState.DISABLED)

    def test_plan_service_tells_the_same(self):
        planned = stream(600).result.statistics
        grinder().make_ready_at_park()
        plan = grinder().plan(gc.goal_of(gc.MOTION))
        self.assertTrue(plan.valid)
        self.assertEqual(plan.reasons, [])
        self.assertEqual(plan.statistics, planned)
        self.assertEqual(plan.duration, planned.duration)


class TestMarkers(unittest.TestCase):
    """What rviz is shown, as one gets it that subscribes only afterwards."""

    @classmethod
    def setUpClass(cls):
        grinder().make_ready_at_park()
        # The one shown last may be of another test's job.
        grinder().send(gc.MOTION, dry_run=True).wait()
        cls.path = rospy.wait_for_message('/grinder/tool_path', MarkerArray, gc.PATIENCE).markers
        cls.error = rospy.wait_for_message('/grinder/path_error', MarkerArray, gc.PATIENCE).markers
        cls.legend = rospy.wait_for_message('/grinder/legend', Legend, gc.PATIENCE)

    def test_what_was_shown_before_is_deleted_first(self):
        for markers in (self.path, self.error):
            self.assertEqual([m.action for m in markers], [Marker.DELETEALL] + [Marker.ADD] * (len(markers) - 1))
            self.assertGreater(len(markers), 1)

    def test_no_marker_has_more_points_than_rviz_stands(self):
        for marker in self.path + self.error:
            self.assertLessEqual(len(marker.points), 16384)

    def test_tool_path_turns_with_the_cutter(self):
        self.assertEqual({(m.header.frame_id, m.type) for m in self.path[1:]}, {('cutter', Marker.LINE_STRIP)})
        self.assertTrue(all(m.frame_locked for m in self.path[1:]))

    def test_legend_is_that_of_the_job(self):
        self.assertEqual(self.legend.cutter, gc.goal_of(gc.MOTION).cutter)
        self.assertEqual(self.legend.tolerance, gc.MOTION['interpolation.tolerance'])
        self.assertEqual(self.legend.largest_error, 0)


if __name__ == '__main__':
    rospy.init_node('test_stream')
    rostest.rosrun('flute_grinder', 'stream', '__main__')
