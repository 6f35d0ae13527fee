#!/usr/bin/env python3
"""Shows that whole tools are ground as their job files say: every tooth in every pass, at its angle, hand and depth, in
the order and direction asked for, with the wheel clear of the work in between. For every job in jobs/ by what
`grind plan` lists, and for a short tool by what is streamed."""

import glob
import itertools
import io
import json
import math
import os
import shutil
import tempfile
import unittest
from fractions import Fraction

import rospy
import rostest
import yaml
from flute_grinder.msg import GrindActionGoal, GrinderState, GrindResult, Process, Reason
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

import grinder_client as gc
import path_checks as checks
from grinder_client import A, DEG, MM, UM, X, Y, Z, grinder

# Two teeth at unequal angles in two passes, over soon.
SHORT_TOOL = """
cutter:
  end_diameter_mm: 10
  cone_angle_deg: 5
  spiral_angle_deg: 30
  rake_angle_deg: 8
  rake_tolerance_deg: 180
  chordal_rake_tolerance_deg: 180
  spiral_tolerance_deg: 180
  core_diameter_mm: 0.01
  core_diameter_end_mm: 0.01
  core_tolerance_mm: 100
  cut: right_hand
  flute_length_mm: 5
  shank_diameter_mm: 1
  tooth_angles_deg: [0, 170]
process:
  feed_mm_min: 3000
  depth_mm: 0.5
  infeed_mm: 0.3
  finish_infeed_mm: 0
  spark_out: 0
  clearance_mm: 1
  overtravel_mm: [1, 1]
  incomplete_ok: true
  order: tooth_major
  direction: from_end
  wheel: {profile: straight, diameter_mm: 100, width_mm: 3, corner_radius_mm: [0, 0], wear_mm: 0.01, wear_per_pass_mm: 0.0002}
  setup: {swivel_deg: 31.8, height_mm: 2.8}
interpolation:
  even_step: third_order
  tolerance_um: 1
  rotary_scale_mm_per_rad: 1
"""


class Segment:
    """The setpoints of one move, with the one before them."""

    def __init__(self, move, tooth, pass_, before):
        self.move, self.tooth, self.pass_ = move, tooth, pass_
        self.before = before
        self.points = []
        self.errors = []
        self.steps = []

    def all_points(self):
        return [self.before] + self.points


def read_setpoints(path):
    """The moves in a file of setpoints; linear axes in m."""
    segments = []
    with open(path) as lines:
        next(lines)
        for cycle, line in enumerate(lines):
            row = line.split(',')
            assert int(row[0]) == cycle, 'a gap at cycle %d' % cycle
            point = (float(row[6]) * MM, float(row[7]) * MM, float(row[8]) * MM, float(row[9]))
            if cycle == 0:
                last = point
                continue
            key = (row[2], int(row[3]), int(row[4]))
            if not segments or key != (segments[-1].move, segments[-1].tooth, segments[-1].pass_):
                segments.append(Segment(*key, last))
            segments[-1].points.append(point)
            segments[-1].errors.append(float(row[10]))
            segments[-1].steps.append(row[5])
            last = point
    return segments


def exact(number):
    """A number of a job file as it is written there."""
    return Fraction(str(number))


def depths_at_ends(process):
    """Of the finished flute, in mm."""
    return exact(process['depth_mm']), exact(process.get('depth_end_mm', process['depth_mm']))


def pass_depths(process):
    """The depth of every pass in mm, where the flute is deepest: as many infeeds as it takes, the finishing pass, the spark-out
    passes."""
    infeed, finish = (exact(process[key]) for key in ('infeed_mm', 'finish_infeed_mm'))
    depth = max(depths_at_ends(process))
    rough = depth - finish
    depths = [min(i * infeed, rough) for i in range(1, math.ceil(rough / infeed) + 1)]
    if finish > 0:
        depths.append(depth)
    return depths + [depth] * process['spark_out']


class WholeTool:
    """What holds of the setpoints of every job; `job_path` and `csv` are its files."""

    job_path = csv = None

    @classmethod
    def read(cls):
        cls.file = gc.read_job(cls.job_path)
        cls.job = gc.job_from_file(cls.job_path)
        cls.helix = checks.Helix(cls.job)
        cls.segments = read_setpoints(cls.csv)
        cls.strokes = [s for s in cls.segments if s.move == 'stroke']
        process = cls.file['process']
        cutter = cls.file['cutter']
        cls.angles_deg = cutter.get('tooth_angles_deg') or [
            360 * i / cutter['teeth'] for i in range(cutter['teeth'])]
        cls.depths = pass_depths(process)
        teeth, passes = range(len(cls.angles_deg)), range(len(cls.depths))
        cls.order = list(itertools.product(teeth, passes))
        if process['order'] == 'pass_major':
            cls.order = [(tooth, pass_) for pass_, tooth in itertools.product(passes, teeth)]
        ends = [-process['overtravel_mm'][0] * MM, (cutter['flute_length_mm'] + process['overtravel_mm'][1]) * MM]
        cls.stroke_from, cls.stroke_to = ends if process['direction'] == 'from_end' else ends[::-1]
        cls.clear = max(cls.helix.y(end) for end in ends) + process['clearance_mm'] * MM

    @classmethod
    def tearDownClass(cls):
        del cls.segments, cls.strokes

    def moves(self, *kinds):
        found = [s for s in self.segments if s.move in kinds]
        self.assertTrue(found)
        return found

    def test_every_tooth_is_ground_in_every_pass_in_order(self):
        self.assertEqual(len(self.strokes), len(self.angles_deg) * len(self.depths))
        self.assertEqual([(s.tooth, s.pass_) for s in self.strokes], self.order)

    def test_every_pass_has_its_moves_in_order(self):
        expected = []
        height = grinder().park()[Y]
        for tooth, pass_ in self.order:
            above_start = self.helix.y(self.stroke_from) + self.job['process.clearance']
            moves = ['index', 'position', 'approach', 'infeed', 'stroke', 'retract']
            # From where the wheel stands after the stroke before there may be nothing left to go.
            if abs(height - above_start) < 1e-12:
                moves.remove('approach')
            height = self.clear
            expected += [(move, tooth, pass_) for move in moves]
        expected.append(('return', *self.order[-1]))
        self.assertEqual([(s.move, s.tooth, s.pass_) for s in self.segments], expected)

    def test_job_goes_from_park_to_park(self):
        for told, park in zip((self.segments[0].before, self.segments[-1].points[-1]), [grinder().park()] * 2):
            for axis in range(4):
                self.assertAlmostEqual(told[axis], park[axis], delta=1e-15)

    def test_strokes_go_over_the_whole_flute_in_their_direction(self):
        sign = math.copysign(1, self.stroke_to - self.stroke_from)
        for stroke in self.strokes:
            xs = [p[X] for p in stroke.all_points()]
            self.assertAlmostEqual(xs[0], self.stroke_from, delta=1e-9)
            self.assertAlmostEqual(xs[-1], self.stroke_to, delta=1e-9)
            self.assertTrue(all(sign * (b - a) > 0 for a, b in zip(xs, xs[1:])))

    def test_strokes_are_as_deep_as_the_pass_and_the_wear_ask(self):
        wheel = self.file['process']['wheel']
        for i, stroke in enumerate(self.strokes):
            wear = exact(wheel['wear_mm']) + i * exact(wheel.get('wear_per_pass_mm', 0))
            ends = depths_at_ends(self.file['process'])
            part = self.depths[self.order[i][1]] / max(ends)  # every pass has the same part of its depth everywhere
            first, last = (float(part * end + wear) * MM for end in ends)
            taper = (last - first) / self.job['cutter.flute_length']
            off = max(abs(p[Y] - (self.helix.y(p[X]) - first - taper * p[X])) for p in stroke.all_points())
            self.assertLess(off, 1e-12, 'stroke %d' % i)

    def test_z_keeps_the_rake(self):
        for stroke in self.strokes:
            self.assertLess(max(abs(p[Z] - self.helix.z(p[X])) for p in stroke.all_points()), 1e-12)

    def test_strokes_turn_the_way_of_their_hand(self):
        turning = self.file['cutter']['spiral_angle_deg']
        for stroke in self.strokes:
            points = stroke.all_points()
            for p, q in zip(points, points[1:]):
                self.assertGreater((q[A] - p[A]) * (q[X] - p[X]) * turning, 0)

    def test_strokes_start_at_the_angle_of_their_tooth(self):
        for stroke in self.strokes:
            angle = self.angles_deg[stroke.tooth] * DEG + self.helix.a(self.stroke_from)
            self.assertAlmostEqual(stroke.before[A], angle, delta=1e-12)

    def test_strokes_keep_the_tolerance(self):
        tolerance = self.job['interpolation.tolerance']
        for stroke in self.strokes:
            angle = self.angles_deg[stroke.tooth] * DEG
            worst = max(abs(angle + self.helix.a(p[X]) - p[A]) * self.helix.radius(p[X] - self.helix.lead) for p in stroke.points)
            self.assertLessEqual(worst * self.helix.normal, tolerance)

    def test_path_error_is_theory_minus_commanded(self):
        for segment in self.segments:
            if segment.move != 'stroke':
                self.assertEqual(set(segment.errors), {0})
                continue
            angle = self.angles_deg[segment.tooth] * DEG
            for p, error in zip(segment.points, segment.errors):
                # Beside the rounding of A over several turns.
                self.assertAlmostEqual(error, angle + self.helix.a(p[X]) - p[A], delta=1e-13)

    def test_each_move_moves_only_its_axes(self):
        allowed = {'index': {A}, 'position': {X, Z}, 'approach': {Y}, 'infeed': {Y}, 'retract': {Y}}
        for segment in self.moves(*allowed):
            still = [1e-12] * 4
            if segment.move == 'retract':
                # A takes back what the last pair's error has left.
                radius = self.helix.radius(self.stroke_to - self.helix.lead)
                still[A] += self.job['interpolation.tolerance'] / (radius * self.helix.normal)
            ways = [max(values) - min(values) for values in zip(*segment.all_points())]
            moved = {axis for axis in range(4) if ways[axis] > still[axis]}
            self.assertLessEqual(moved, allowed[segment.move], segment.move)
            self.assertTrue(moved)

    def test_wheel_is_clear_of_the_work_while_it_goes_to_the_next_tooth(self):
        for segment in self.moves('index', 'position'):
            self.assertGreaterEqual(min(p[Y] for p in segment.all_points()), self.clear - 1e-15)

    def test_wheel_keeps_the_clearance_until_the_infeed(self):
        above_start = self.helix.y(self.stroke_from) + self.job['process.clearance']
        for segment in self.moves('infeed'):
            self.assertAlmostEqual(segment.before[Y], above_start, delta=1e-12)

    def test_wheel_leaves_the_work_radially(self):
        for segment in self.moves('retract'):
            ys = [p[Y] for p in segment.all_points()]
            self.assertTrue(all(a <= b for a, b in zip(ys, ys[1:])))
            self.assertAlmostEqual(ys[-1], self.clear, delta=1e-12)

    def check_statistics(self, statistics):
        """What the statistics say, by the setpoints."""
        period = 1e-3
        counts = {move: sum(len(s.points) for s in self.segments if s.move == move) for move in gc.MOVES}
        self.assertEqual(statistics.setpoints, sum(counts.values()) + 1)
        self.assertAlmostEqual(statistics.duration, sum(counts.values()) * period, delta=1e-9)
        for move, duration in zip(gc.MOVES, statistics.move_duration):
            self.assertAlmostEqual(duration, counts[move] * period, delta=1e-9, msg=move)
        for step, told in (('odd', statistics.max_odd_error), ('even', statistics.max_even_error)):
            largest = max(abs(error) for s in self.strokes for error, kind in zip(s.errors, s.steps) if kind == step)
            self.assertAlmostEqual(told, largest, delta=1e-15)

    def check_feed(self, limits):
        """That the feed asked for is held all along the first stroke, but for what the limits tell and the ramps."""
        points = self.strokes[0].all_points()[::2]
        feeds = [abs(b[X] - a[X]) / 2e-3 * self.helix.edge for a, b in zip(points, points[1:])]
        asked = self.job['process.feed']
        self.assertLessEqual(max(feeds), asked * (1 + 1e-6))
        outside = []
        for start, end, feed in zip(points, points[1:], feeds):
            limited = [min(l.from_x, l.to_x) < min(start[X], end[X]) and max(start[X], end[X]) < max(l.from_x, l.to_x)
                       for l in limits]
            if any(limited):
                self.assertLess(feed, asked * (1 - 1e-6), 'X = %g m' % start[X])
            else:
                outside.append(feed)
        reached = [i for i, feed in enumerate(outside) if feed >= asked * (1 - 1e-6)]
        self.assertGreater(len(reached), 0.5 * len(outside))
        self.assertEqual(reached, list(range(reached[0], reached[-1] + 1)))


class JobOfTheFolder(WholeTool):
    """A job of jobs/: planned on the command line, by the service and as a dry run."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.csv = os.path.join(folder, 'plan.csv')
        cls.plan = gc.grind('plan', cls.job_path, '--csv', cls.csv)
        cls.read()
        g = grinder()
        cls.rest = g.make_ready_at_park()
        cls.batches, joints = len(g.batches), len(g.joints)
        goal = gc.goal_of(cls.job)
        cls.service = g.plan(goal)
        cls.dry_run = g.send(cls.job, dry_run=True).wait()
        cls.state = g.fresh_state()
        cls.positions = {gc.axes_of(joint) for joint in g.joints[joints:]}
        cls.new_batches = len(g.batches) - cls.batches

    def test_plan_says_yes(self):
        self.assertEqual((self.plan.returncode, self.plan.stderr), (0, ''))

    def test_dry_run_succeeds_with_the_statistics_of_the_plan_service(self):
        self.assertEqual((self.dry_run.status, self.dry_run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), self.dry_run.text)
        self.assertEqual((self.service.valid, self.service.reasons), (True, []))
        self.assertEqual(self.dry_run.result.statistics, self.service.statistics)
        self.assertEqual(self.service.duration, self.service.statistics.duration)
        self.assertEqual(self.dry_run.result.setpoints_written, 0)

    def test_statistics_are_those_of_the_setpoints_listed(self):
        self.check_statistics(self.service.statistics)

    def test_feed_is_held_but_where_the_statistics_tell_why_not(self):
        self.check_feed(self.service.statistics.feed_limits)

    def test_nothing_moves(self):
        self.assertEqual(self.state.state, GrinderState.READY)
        self.assertEqual(self.new_batches, 0)
        self.assertEqual(self.positions, {tuple(self.rest)})


def add_jobs():
    for path in sorted(glob.glob(gc.package_file('jobs/*.yaml'))):
        words = os.path.splitext(os.path.basename(path))[0].split('_')
        name = 'Test' + ''.join(word.capitalize() for word in words)
        globals()[name] = type(name, (JobOfTheFolder, unittest.TestCase), {'job_path': path, '__module__': __name__})


add_jobs()


class TestJobsShowEverything(unittest.TestCase):
    """That the folder has a job for everything that a job can ask for."""

    def test_choices(self):
        files = []
        for path in glob.glob(gc.package_file('jobs/*.yaml')):
            with open(path) as text:
                files.append(yaml.safe_load(text))
        self.assertGreaterEqual(len(files), 8)
        self.assertEqual({'file' in f['process']['wheel'] for f in files}, {True, False})
        self.assertEqual({f['process']['order'] for f in files}, {'tooth_major', 'pass_major'})
        self.assertEqual({f['process']['direction'] for f in files}, {'from_end', 'to_end'})
        self.assertEqual({f['interpolation']['even_step'] for f in files}, {'published', 'third_order', 'exact'})
        self.assertEqual({f['cutter']['spiral_angle_deg'] > 0 for f in files}, {True, False})
        self.assertEqual({f['cutter']['cone_angle_deg'] > 0 for f in files}, {True, False})
        self.assertEqual({'tooth_angles_deg' in f['cutter'] for f in files}, {True, False})


class TestShortTool(WholeTool, unittest.TestCase):
    """A whole tool from its job file to the drive, by the command line."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.job_path, cls.csv = os.path.join(folder, 'job.yaml'), os.path.join(folder, 'run.csv')
        planned = os.path.join(folder, 'plan.csv')
        with open(cls.job_path, 'w') as file:
            file.write(SHORT_TOOL)
        g = grinder()
        g.make_ready_at_park()
        batches = len(g.batches)
        cls.plan = gc.grind('plan', cls.job_path, '--csv', planned)
        cls.grind_run = gc.grind('run', cls.job_path, '--ignore-offset-check', '--csv', cls.csv)
        with open(planned) as plan, open(cls.csv) as run:
            # The run's file has four more columns, the positions that the drive read.
            cls.planned = plan.read().splitlines()
            cls.streamed = [line.rsplit(',', 4)[0] for line in run.read().splitlines()]
        cls.count = len(cls.planned) - 1
        g.wait_for(lambda: sum(len(batch.setpoints) for batch in g.batches[batches:]) >= cls.count, 'all setpoints')
        cls.state = g.fresh_state()
        cls.setpoints = [s for batch in g.batches[batches:] for s in batch.setpoints]
        with open(rospy.get_param('/grinder/journal')) as text:
            cls.journal = yaml.safe_load(text)
        batches = len(g.batches)
        cls.again = gc.grind('run', cls.job_path, '--continue')
        g.fresh_state()
        cls.batches_of_again = len(g.batches) - batches
        cls.read()

    def test_run_succeeds(self):
        self.assertEqual(self.grind_run.returncode, 0, self.grind_run.stderr)
        self.assertEqual(self.state.state, GrinderState.READY)

    def test_streamed_setpoints_are_the_planned_ones_to_the_last_bit(self):
        self.assertEqual(self.plan.returncode, 0)
        self.assertTrue(self.planned == self.streamed, 'the files differ')

    def test_none_is_missed(self):
        self.assertRegex(self.grind_run.stdout, r'streamed +%d setpoints in \S+ s, 0 missed\n' % self.count)
        self.assertEqual(len(self.setpoints), self.count)
        self.assertTrue(checks.is_gapless(self.setpoints))

    def test_topic_tells_what_the_file_has(self):
        points = [self.segments[0].before] + [p for s in self.segments for p in s.points]
        for setpoint, point in zip(self.setpoints, points):
            for axis in range(4):
                self.assertAlmostEqual(setpoint.position[axis], point[axis], delta=1e-15)

    def test_no_axis_exceeds_a_limit(self):
        self.assertEqual(checks.excesses(self.setpoints, grinder().limits(), grinder().period()), [])

    def test_journal_says_finished(self):
        self.assertIs(self.journal['finished'], True)
        self.assertEqual((self.journal['tooth'], self.journal['pass']), (1, 1))
        self.assertAlmostEqual(self.journal['x_m'], 6 * MM, delta=1e-12)
        self.assertRegex(self.journal['job_digest'], r'^[0-9a-f]{64}$')

    def test_state_tells_the_same_progress(self):
        progress = self.state.progress
        self.assertEqual((progress.job_digest, progress.finished, progress.tooth, progress.pass_, progress.x),
                         tuple(self.journal[key] for key in ('job_digest', 'finished', 'tooth', 'pass', 'x_m')))

    def test_finished_job_is_not_continued(self):
        self.assertEqual(self.again.returncode, 1)
        self.assertRegex(self.again.stderr, r'^the job is finished: ')
        self.assertEqual(self.batches_of_again, 0)


# A steep cone, whose rake is half a degree off amid the flute by the published law of Z.
STEEP_TOOL = """
cutter: {end_diameter_mm: 5, cone_angle_deg: 10, spiral_angle_deg: 20, rake_angle_deg: 14, rake_tolerance_deg: 0.1, cut: right_hand,
  chordal_rake_tolerance_deg: 180, spiral_tolerance_deg: 180, core_diameter_mm: 0.01, core_diameter_end_mm: 0.01, core_tolerance_mm: 100,
  flute_length_mm: 15, shank_diameter_mm: 12, teeth: 2}
process:
  feed_mm_min: 1200
  depth_mm: 0.7
  infeed_mm: 0.7
  finish_infeed_mm: 0
  spark_out: 0
  clearance_mm: 1
  overtravel_mm: [6, 6]
  order: tooth_major
  direction: from_end
  z_law: constant_rake
  wheel: {profile: straight, diameter_mm: 75, width_mm: 1.5, wear_mm: 0}
  setup: {swivel_deg: 23.28, height_mm: 0.603}
interpolation: {even_step: third_order, tolerance_um: 1, rotary_scale_mm_per_rad: 1}
"""


class TestConstantRake(unittest.TestCase):
    """A job whose Z is corrected, from its file to the drive and back to the cutter; and as a goal."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.job_path, cls.plan_csv, cls.run_csv = (os.path.join(folder, name) for name in ('job.yaml', 'plan.csv', 'run.csv'))
        with open(cls.job_path, 'w') as file:
            file.write(STEEP_TOOL)
        cls.job = dict(gc.job_from_file(cls.job_path), **{'process.z_law': Process.CONSTANT_RAKE})

    def setUp(self):
        grinder().make_ready_at_park()

    def test_drive_grinds_the_rake_that_is_planned(self):
        plan = gc.grind('plan', self.job_path, '--csv', self.plan_csv)
        self.assertEqual(plan.returncode, 0, plan.stderr)
        self.assertTrue(grinder().confirm_swivel(self.job['process.setup_swivel']).success)
        run = gc.grind('run', self.job_path, '--ignore-offset-check', '--csv', self.run_csv)
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(self.plan_csv) as planned, open(self.run_csv) as streamed:
            self.assertEqual(planned.read().splitlines(), [line.rsplit(',', 4)[0] for line in streamed.read().splitlines()])
        if rospy.get_param('/grinder/hardware/type') != 'flute_grinder/SimulatedDrive':
            return  # HAL's pins are not all read in the same servo cycle, so that its record shows them apart
        told = gc.grind('simulate', self.run_csv, '--job', self.job_path, '--sections', '26', '--json')
        self.assertEqual(told.returncode, 0, told.stderr)
        rakes = [tooth['rake_deg'] for section in json.loads(told.stdout)['sections'] for tooth in section['teeth']]
        self.assertEqual(len(rakes), 52)
        self.assertLess(max(abs(rake - 14) for rake in rakes), 0.1)

    def test_goal_is_planned_with_the_same_law(self):
        service = grinder().plan(gc.goal_of(self.job))
        self.assertEqual((service.valid, service.reasons), (True, []))
        dry_run = grinder().send(self.job, dry_run=True).wait()
        self.assertEqual((dry_run.status, dry_run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), dry_run.text)
        self.assertEqual(dry_run.result.statistics, service.statistics)
        # By the published law the cutter is not as asked.
        published = grinder().plan(gc.goal_of(dict(self.job, **{'process.z_law': Process.PUBLISHED})))
        self.assertEqual([reason.kind for reason in published.violations], [Reason.RAKE])

    def test_goal_whose_rake_cannot_be_kept_is_rejected(self):
        far_off = dict(self.job, **{'process.setup_swivel': 50 * DEG})
        service = grinder().plan(gc.goal_of(far_off))
        self.assertFalse(service.valid)
        reason, = service.violations
        self.assertEqual((reason.kind, reason.field, reason.unit), (Reason.UNEVEN_RAKE, 'process.z_law', Reason.RADIAN))
        self.assertAlmostEqual(reason.limit, 14 * DEG, delta=1e-12)
        self.assertLess(reason.low, reason.value)
        self.assertRegex(service.reasons[0], r'^process.z_law = constant_rake: tooth 1 is ground with .* rad to .* rad at best')
        run = grinder().send(far_off).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL))
        unknown = grinder().plan(gc.goal_of(dict(self.job, **{'process.z_law': 2})))
        self.assertEqual([reason.field for reason in unknown.violations], ['process.z_law'])


class TestSizes(unittest.TestCase):
    """Of messages, for tools of many teeth."""

    def test_goal_of_64_teeth_is_short(self):
        job = gc.paper(tooth_angles=[i * 2 * math.pi / 64 for i in range(64)])
        message = GrindActionGoal(header=Header(), goal=gc.goal_of(job))
        message.goal_id.id = '/' + 'n' * 40 + '-12345-1700000000.123456789'
        written = io.BytesIO()
        message.serialize(written)
        self.assertLess(len(written.getvalue()), 1000)
        self.assertEqual(len(message.goal.cutter.tooth_angles), 64)


class ToolPath:
    """The markers of a tool of ten teeth."""

    cone = spiral = None

    @classmethod
    def setUpClass(cls):
        cls.angles = [i * 2 * math.pi / 10 for i in range(10)]
        cls.job = gc.paper(end_diameter=6 * MM, cone_angle=cls.cone * DEG, spiral_angle=cls.spiral * DEG,
                           flute_length=30 * MM, tooth_angles=cls.angles, depth=0.2 * MM, infeed=0.2 * MM, wheel_width=0.5 * MM)
        cls.helix = checks.Helix(cls.job)
        grinder().make_ready()
        run = grinder().send(cls.job, dry_run=True).wait()
        assert run.status == 'SUCCEEDED', run.text
        # The markers follow within a few ticks.
        grinder().fresh_state()
        grinder().fresh_state()
        message = rospy.wait_for_message('/grinder/tool_path', MarkerArray, gc.PATIENCE)
        written = io.BytesIO()
        message.serialize(written)
        cls.size = len(written.getvalue())
        cls.markers = [m for m in message.markers if m.action == Marker.ADD]

    def test_message_is_short(self):
        self.assertLess(self.size, 2e6)

    def test_no_marker_has_more_points_than_rviz_stands(self):
        self.assertLessEqual(max(len(m.points) for m in self.markers), 16384)

    def teeth(self):
        """The points of every tooth, each with the angle of its tooth."""
        self.assertEqual(len(self.markers), len(self.angles))
        return [(marker.points, angle) for marker, angle in zip(self.markers, self.angles)]

    def test_every_tooth_is_shown_over_the_whole_stroke(self):
        for points, _ in self.teeth():
            xs = [p.x for p in points]
            self.assertAlmostEqual(xs[0], -1 * MM, delta=1e-12)
            self.assertAlmostEqual(xs[-1], 31 * MM, delta=1e-12)
            self.assertTrue(all(a < b for a, b in zip(xs, xs[1:])))

    def test_points_are_on_the_helix(self):
        for points, angle in self.teeth():
            for p in points:
                a, r = angle + self.helix.a(p.x), self.helix.radius(p.x)
                self.assertLess(math.hypot(p.y - r * math.cos(a), p.z - r * math.sin(a)), 1e-12)

    def test_chords_are_close_to_the_helix(self):
        worst = 0
        for points, angle in self.teeth():
            for p, q in zip(points, points[1:]):
                x = (p.x + q.x) / 2
                a, r = angle + self.helix.a(x), self.helix.radius(x)
                # As far as this from the point of the helix beside it, and so no farther from the helix.
                worst = max(worst, math.hypot((p.y + q.y) / 2 - r * math.cos(a), (p.z + q.z) / 2 - r * math.sin(a)))
        self.assertLess(worst, 0.1 * UM)


class TestPathOfACylinder(ToolPath, unittest.TestCase):
    cone, spiral = 0, 45


class TestPathOfASteepHelix(ToolPath, unittest.TestCase):
    cone, spiral = 5, -60


class TestPathOfASteepCone(ToolPath, unittest.TestCase):
    cone, spiral = 20, 8


if __name__ == '__main__':
    rospy.init_node('test_whole_tool')
    rostest.rosrun('flute_grinder', 'whole_tool', '__main__')
