#!/usr/bin/env python3
"""Shows that `grind setup` solves the set-up for the tool that a job asks for: what it writes is measured by
`grind simulate`, which knows nothing of the solver, and accepted by `grind plan`."""

import math
import os
import re
import resource
import signal
import subprocess

import rostest
import yaml

import grinder_client as gc
from grind_command import PAPER_JOB, CommandLine
from grinder_client import DEG

JOBS = gc.package_file('jobs')
URDF = gc.package_file('urdf/grinder.urdf')


class TestSetup(CommandLine):
    def job(self, name, source=PAPER_JOB, **changes):
        """Writes a shipped job with other values as text, `None` to leave a key out; the keys are unique in it."""
        with open(source) as file:
            text = file.read().replace('../wheels', gc.package_file('wheels'))
        for key, value in changes.items():
            pattern = r'(?m)^( *)%s: *(\{.*?\}|\[.*?\]|[^ #\n]+)(.*)\n' % key
            self.assertEqual(len(re.findall(pattern, text)), 1, key)
            text = re.sub(pattern, '' if value is None else r'\g<1>%s: %s\g<3>\n' % (key, value), text)
        return self.write(name, text)

    def text(self, path):
        with open(path, newline='') as file:
            return file.read()

    def setup(self, job, *arguments, status=0):
        return self.json(status, 'setup', job, *arguments)[0]

    def rakes(self, job, *at):
        sections = self.json(0, 'simulate', job, '--at', ','.join(str(x) for x in at))[0]['sections']
        return [tooth['rake_deg'] for section in sections for tooth in section['teeth']]

    def core(self, job):
        return self.json(0, 'simulate', job, '--at', '0')[0]['sections'][0]['core_diameter_mm']

    def check(self, job):
        """The written job is ground with the rake that it asks for, off by as much to one side as to the other over the flute,
        and a plan takes it."""
        with open(job) as file:
            cutter = yaml.safe_load(file)['cutter']
        errors = [rake - cutter['rake_angle_deg']
                  for rake in self.rakes(job, *(cutter['flute_length_mm'] * i / 8 for i in range(9)))]
        self.assertAlmostEqual(max(errors), -min(errors), delta=0.02)
        self.assertLess(max(errors), cutter['rake_tolerance_deg'])
        self.grind(0, 'plan', job)


class TestFigures(TestSetup):
    def test_the_papers_cutter_without_a_setup(self):
        job = self.job('job.yaml', setup=None)
        self.assertIn("'grind setup --write' finds it", self.grind(2, 'plan', job).stderr)
        found = self.setup(job, '--write')
        self.assertAlmostEqual(found['swivel_deg'], 31.769, delta=0.01)
        self.assertAlmostEqual(found['height_mm'], 2.788, delta=0.01)
        self.assertAlmostEqual(found['upper_face_mm'], 4.552, delta=0.01)
        self.assertEqual(found['depth_mm'], 1.6)
        self.assertAlmostEqual(found['rake_min_deg'], 7.989, delta=0.003)
        self.assertAlmostEqual(found['rake_max_deg'], 8.011, delta=0.003)
        # Printed in the design for X = 1, 17 and 29 mm, where its program makes it right at X = 2 and 28 mm; here the error is
        # shared out.
        for rake, printed in zip(self.rakes(job, 1, 17, 29), (7.999, 8.019, 7.999)):
            self.assertAlmostEqual(rake, printed - 0.0085, delta=0.003)
        self.check(job)
        self.assertEqual(self.setup(job), found)

    def test_every_shipped_job(self):
        for name in sorted(os.listdir(JOBS)):
            with self.subTest(name):
                job = self.job(name, os.path.join(JOBS, name))
                before = self.text(job)
                used = resource.getrusage(resource.RUSAGE_CHILDREN)
                found = self.setup(job, '--write')
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                print('%s: %.2f s of CPU' % (name, after.ru_utime + after.ru_stime - used.ru_utime - used.ru_stime))
                self.check(job)
                self.assertEqual(found['complete_from_mm'], 0)
                # Comments, order and layout stay: only numbers differ.
                number = r'-?\d+\.?\d*'
                self.assertEqual(re.sub(number, '#', self.text(job)), re.sub(number, '#', before))

    def test_core_together_with_the_rake(self):
        for core in (7.3, 6.8):
            job = self.job('job.yaml', depth_mm=None, setup=None, infeed_mm=2.5,
                           spiral_angle_deg='30\n  core_diameter_mm: %g' % core)
            found = self.setup(job, '--write')
            self.assertAlmostEqual(found['core_diameter_mm'], core, delta=0.001)
            self.assertAlmostEqual(self.core(job), core, delta=0.001)
            self.check(job)
            # In the place of a depth, too.
            beside = self.job('beside.yaml', setup=None, infeed_mm=2.5, spiral_angle_deg='30\n  core_diameter_mm: %g' % core)
            self.assertEqual(self.setup(beside), found)

    def test_cylinder_keeps_what_it_shall(self):
        source = os.path.join(JOBS, 'roughing_d10_t4.yaml')
        for keep, setup in (('swivel', '{swivel_deg: 41}'), ('height', '{height_mm: -1.1}'), ('depth', None)):
            with self.subTest(keep):
                job = self.job('job.yaml', source, setup=setup)
                found = self.setup(job, '--keep', keep, '--write')
                kept = {'swivel': ('swivel_deg', 41), 'height': ('height_mm', -1.1), 'depth': ('depth_mm', 1.6)}[keep]
                self.assertEqual(found[kept[0]], kept[1])
                self.check(job)
        # The rake face passes at R sin r if nothing is kept.
        found = self.setup(self.job('job.yaml', source, setup=None))
        self.assertAlmostEqual(found['upper_face_mm'], 5 * math.sin(8 * DEG), delta=0.001)

    def test_all_three_kept_on_a_cylinder_with_a_core(self):
        source = os.path.join(JOBS, 'roughing_d10_t4.yaml')
        for keep, setup in (('swivel', '{swivel_deg: 41}'), ('height', '{height_mm: -1.1}'), ('depth', None)):
            with self.subTest(keep):
                job = self.job('job.yaml', source, setup=setup, core_diameter_mm=6.82, core_diameter_end_mm=6.82)
                self.setup(job, '--keep', keep, '--write')
                self.assertAlmostEqual(self.core(job), 6.82, delta=0.001)
                self.check(job)

    def test_mirrored_tool_has_the_mirrored_setup(self):
        for source, spiral in ((PAPER_JOB, 30), (os.path.join(JOBS, 'roughing_d10_t4.yaml'), 35)):
            right = self.setup(self.job('right.yaml', source, setup=None))
            left = self.job('left.yaml', source, setup=None, spiral_angle_deg=-spiral, cut='left_hand')
            found = self.setup(left, '--write')
            self.assertAlmostEqual(found['swivel_deg'], -right['swivel_deg'], delta=0.001)
            self.assertAlmostEqual(found['height_mm'], -right['height_mm'], delta=0.001)
            self.check(left)

    def test_overtravel_is_lengthened_where_it_is_too_short(self):
        job = self.job('job.yaml', overtravel_mm='[1, 2]')
        needed = self.setup(job, '--write')['overtravel_mm']
        self.assertGreater(needed[1], 2)
        self.assertLess(needed[0], 1)
        with open(job) as file:
            end, shank = yaml.safe_load(file)['process']['overtravel_mm']
        self.assertEqual(end, 1)
        self.assertTrue(needed[1] <= shank <= needed[1] + 0.01, shank)
        self.check(job)

    def test_sheet(self):
        sheet = self.grind(0, 'setup', PAPER_JOB).stdout
        for line in (r'swivel +31\.76\d deg; the machine.s range is -60 to 60 deg', r'height +2\.788 mm', r'0\.1498 mm less per mm of the wheel.s middle above the swivel.s centre', r'upper face 4\.55[23] mm',
                     r'reads D/2 - 1\.288 mm: 3\.712 mm for D = 10 mm', r'reads \(D - 10\)/2 mm: 0\.000 mm for D = 10 mm',
                     r'rake +7\.989 to 8\.011 deg; asked 8 deg within 0\.5 deg', r'flutes complete X 0\.000 to 30\.000 mm'):
            self.assertRegex(sheet, line)


class TestRefusals(TestSetup):
    def narrow(self):
        with open(URDF) as file:
            text = file.read()
        old = 'lower="-1.0471976" upper="1.0471976"'
        self.assertEqual(text.count(old), 1)
        return self.write('narrow.urdf', text.replace(old, 'lower="-0.5" upper="0.5"'))

    def test_machine_that_does_not_swivel_so_far(self):
        job, urdf = self.job('job.yaml'), self.narrow()
        before = self.text(job)
        said = self.grind(1, 'setup', job, '--write', '--urdf', urdf).stderr
        self.assertRegex(said, r'^the set-up takes a swivel of 31\.7\d* deg; the machine swivels -28\.648 to 28\.648 deg; '
                               r'change cutter\.spiral_angle_deg\n$')
        self.assertEqual(self.text(job), before)
        said = self.grind(1, 'plan', job, '--urdf', urdf).stderr
        self.assertIn('process.setup.swivel_deg = 31.769 deg; allowed: -28.64788976 to 28.64788976 deg', said)

    def test_no_room_for_the_teeth(self):
        said = self.grind(1, 'setup', self.job('job.yaml', teeth=8)).stderr
        self.assertRegex(said, r'^no land is left: the flutes overlap by 0\.\d+ mm along the circle; change '
                               r'process\.wheel\.width_mm\n$')

    def test_what_is_kept_must_be_there(self):
        for keep, key in (('swivel', 'process.setup.swivel_deg'), ('height', 'process.setup.height_mm')):
            said = self.grind(2, 'setup', self.job('job.yaml', setup=None), '--keep', keep).stderr
            self.assertRegex(said, r'job\.yaml:1: %s is missing' % re.escape(key))
        self.assertRegex(self.grind(2, 'setup', self.job('job.yaml', depth_mm=None)).stderr, 'depth_mm is missing')
        self.assertRegex(self.grind(2, 'setup', PAPER_JOB, '--keep', 'rake').stderr, 'rake')

    def test_urdf_without_a_swivel(self):
        urdf = self.write('none.urdf', self.text(URDF).replace('"wheel_swivel"', '"other"'))
        self.assertIn('no joint wheel_swivel', self.grind(2, 'setup', PAPER_JOB, '--urdf', urdf).stderr)


    def test_what_a_plan_refuses_is_not_written(self):
        # Each tooth has a helix of its own, and the set-up is for the middle.
        job = self.job('job.yaml', teeth=2, spiral_angle_deg=None, cut='right_hand\n  spiral_angles_deg: [27, 33]')
        before = self.text(job)
        said = self.grind(1, 'setup', job, '--write').stderr
        self.assertRegex(said, r'^a plan would refuse this tool: cutter\.rake_angle_deg = 8 deg: tooth \d is ground with .*, or set '
                               r'process\.z_law: constant_rake\n.*job\.yaml: nothing was written\n$')
        self.assertEqual(self.text(job), before)
        self.assertIn('a plan would refuse this tool', self.grind(1, 'setup', job).stderr)
        job = self.job('job.yaml', rake_tolerance_deg='0.01', depth_mm='1.6\n  z_law: constant_rake')
        self.setup(job, '--write')
        self.grind(0, 'plan', job)

    def test_depth_beyond_the_axis_is_none(self):
        # Solved with a depth of 3.6 mm, which the job then refused.
        job = self.job('job.yaml', end_diameter_mm=4.957, cone_angle_deg=1.44, rake_angle_deg=13.02, flute_length_mm=14.26,
                       spiral_angle_deg='19.45\n  core_diameter_mm: 2.088', diameter_mm=88.5, width_mm=0.77)
        self.assertRegex(self.grind(1, 'setup', job).stderr, r'^no set-up gives all that is asked within its tolerance;')


class TestTouchOff(TestSetup):
    def test_wheel_above_the_swivel(self):
        """The sheet of Z counts by how much turning the swivel lowers the wheel."""
        source = os.path.join(JOBS, 'unequal_d12_t4.yaml')
        found = self.setup(source)
        self.assertAlmostEqual(found['wheel_above_swivel_mm'], 0, delta=1e-9)
        self.assertAlmostEqual(found['touch_z_mm'], 1.5 - found['height_mm'], delta=1e-9)
        machine = self.write('machine.yaml', self.text(gc.package_file('config/grinder.yaml')).replace(
            'flange: 0.0035 ', 'flange: 0.0235 '))
        higher = self.setup(source, '--machine', machine)
        self.assertAlmostEqual(higher['wheel_above_swivel_mm'], 20, delta=1e-9)
        lowered = 20 * (1 - math.cos(found['swivel_deg'] * DEG))
        self.assertAlmostEqual(found['touch_z_mm'] - higher['touch_z_mm'], lowered, delta=1e-9)
        self.assertIn('with the wheel\'s middle 20.000 mm above', self.grind(0, 'setup', source, '--machine', machine).stdout)
        self.assertIsNone(self.setup(PAPER_JOB)['wheel_above_swivel_mm'])


class TestFile(TestSetup):
    def test_file_that_cannot_be_edited_stays_and_the_figures_are_told(self):
        job = self.job('job.yaml', setup='{swivel_deg: !!float 30, height_mm: 2}')
        before = self.text(job)
        said = self.grind(2, 'setup', job, '--write').stderr
        self.assertRegex(said, r'job\.yaml:28: has a value that is not written as a plain number; nothing was written, '
                               r'write by hand:\n'
                               r'  process\.setup\.swivel_deg: 31\.76\d*\n  process\.setup\.height_mm: 2\.78\d*\n')
        self.assertEqual(self.text(job), before)
        self.assertEqual(os.listdir(self.folder), ['job.yaml'])

    def test_full_disk_leaves_the_old_file(self):
        job = self.job('job.yaml')
        before = self.text(job)

        def full_disk():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))

        done = subprocess.run([gc.program('grind'), 'setup', job, '--write'], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=gc.PATIENCE, preexec_fn=full_disk)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, 'job.yaml: cannot be written: File too large; nothing was written')
        self.assertEqual(self.text(job), before)
        self.assertEqual(os.listdir(self.folder), ['job.yaml'])


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'setup', '__main__')
