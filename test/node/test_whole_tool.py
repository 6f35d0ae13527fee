#!/usr/bin/env python3
"""Shows that every job of one operation in jobs/ is planned by `grind plan`, by the service and as a dry run, and moves nothing then; that together
they show all that a job can ask for; and that the law of Z and a tool of many teeth reach the grinder with the goal."""

import glob
import io
import math
import os
import shutil
import tempfile
import unittest

import rospy
import rostest
import yaml
from flute_grinder.msg import GrindActionGoal, GrinderState, GrindResult, Process, Reason
from std_msgs.msg import Header

import grinder_client as gc
from grinder_client import grinder


def jobs():
    """The files of the folder that have a single operation."""
    paths = []
    for path in sorted(glob.glob(gc.package_file('jobs/*.yaml'))):
        with open(path) as text:
            if 'operations' not in yaml.safe_load(text):
                paths.append(path)
    return paths


class JobOfTheFolder:
    """A job of jobs/: planned on the command line, by the service and as a dry run."""

    job_path = None

    @classmethod
    def setUpClass(cls):
        cls.job = gc.job_from_file(cls.job_path)
        cls.plan = gc.grind('plan', cls.job_path)
        g = grinder()
        cls.rest = g.make_ready_at_park()
        cls.batches, joints = len(g.batches), len(g.joints)
        cls.service = g.plan(gc.goal_of(cls.job))
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

    def test_nothing_moves(self):
        self.assertEqual(self.state.state, GrinderState.READY)
        self.assertEqual(self.new_batches, 0)
        self.assertEqual(self.positions, {tuple(self.rest)})


def add_jobs():
    for path in jobs():
        words = os.path.splitext(os.path.basename(path))[0].split('_')
        name = 'Test' + ''.join(word.capitalize() for word in words)
        globals()[name] = type(name, (JobOfTheFolder, unittest.TestCase), {'job_path': path, '__module__': __name__})


add_jobs()


class TestJobsShowEverything(unittest.TestCase):
    """That the folder has a job for everything that a job can ask for."""

    def test_choices(self):
        files = []
        for path in jobs():
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
    """A job whose Z is corrected, as a goal."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        job_path = os.path.join(folder, 'job.yaml')
        with open(job_path, 'w') as file:
            file.write(STEEP_TOOL)
        cls.job = gc.job_from_file(job_path)

    def setUp(self):
        grinder().make_ready_at_park()

    def test_goal_is_planned_with_the_same_law(self):
        service = grinder().plan(gc.goal_of(self.job))
        self.assertEqual((service.valid, service.reasons), (True, []))
        dry_run = grinder().send(self.job, dry_run=True).wait()
        self.assertEqual((dry_run.status, dry_run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), dry_run.text)
        self.assertEqual(dry_run.result.statistics, service.statistics)
        # By the published law the cutter is not as asked.
        published = grinder().plan(gc.goal_of(dict(self.job, **{'process.z_law': Process.PUBLISHED})))
        self.assertEqual([reason.kind for reason in published.violations], [Reason.RAKE])


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


if __name__ == '__main__':
    rospy.init_node('test_whole_tool')
    rostest.rosrun('flute_grinder', 'whole_tool', '__main__')
