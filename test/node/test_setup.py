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
from grind_command import CommandLine
from grinder_client import DEG

JOBS = gc.package_file('jobs')
PAPER_JOB = os.path.join(JOBS, 'paper.yaml')
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

    def cores(self, job):
        """At both ends of the flute."""
        return [section['core_diameter_mm'] for section in self.json(0, 'simulate', job, '--sections', '2')[0]['sections']]

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
        # Of another program, which is good to 0.02 deg and 0.02 mm.
        for key, figure in (('swivel_deg', 32.350), ('height_mm', 5.880), ('lead_mm', 11.847), ('depth_mm', 2.656),
                            ('depth_end_mm', 2.616)):
            self.assertAlmostEqual(found[key], figure, delta=0.02, msg=key)
        self.assertAlmostEqual(found['upper_face_mm'], found['height_mm'] + 1.5 / math.cos(found['swivel_deg'] * DEG), delta=1e-6)
        for core, asked in zip(self.cores(job), (6.8, 12.05)):
            self.assertAlmostEqual(core, asked, delta=0.001)
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
        for asked in ((7.3, 12.5), (6.8, 12.05)):
            changes = dict(setup=None, infeed_mm=3, overtravel_mm='[1, 8]', core_diameter_mm=asked[0], core_diameter_end_mm=asked[1])
            job = self.job('job.yaml', depth_mm=None, **changes)
            found = self.setup(job, '--write')
            told = found['core_diameter_mm'], found['core_diameter_end_mm']
            for core, measured, wanted in zip(told, self.cores(job), asked):
                self.assertAlmostEqual(core, wanted, delta=0.001)
                self.assertAlmostEqual(measured, wanted, delta=0.001)
            self.check(job)
            # In the place of a depth, too.
            self.assertEqual(self.setup(self.job('beside.yaml', **changes)), found)

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
                for core in self.cores(job):
                    self.assertAlmostEqual(core, 6.82, delta=0.001)
                self.check(job)

    def test_cone_keeps_what_it_shall(self):
        for keep, key, figure in (('swivel', 'swivel_deg', 32.34), ('height', 'height_mm', 5.882), ('depth', 'depth_mm', 2.6575)):
            with self.subTest(keep):
                job = self.job('job.yaml')
                self.assertEqual(self.setup(job, '--keep', keep, '--write')[key], figure)
                self.grind(0, 'plan', job)

    def test_mirrored_tool_has_the_mirrored_setup(self):
        for source, spiral in ((PAPER_JOB, 30), (os.path.join(JOBS, 'roughing_d10_t4.yaml'), 35)):
            right = self.setup(self.job('right.yaml', source, setup=None))
            left = self.job('left.yaml', source, setup=None, spiral_angle_deg=-spiral, cut='left_hand')
            found = self.setup(left, '--write')
            self.assertAlmostEqual(found['swivel_deg'], -right['swivel_deg'], delta=0.001)
            self.assertAlmostEqual(found['height_mm'], -right['height_mm'], delta=0.001)
            self.assertAlmostEqual(found['lead_mm'], right['lead_mm'], delta=0.001)
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
        sheet, found = self.grind(0, 'setup', PAPER_JOB).stdout, self.setup(PAPER_JOB)
        swivel, height = found['swivel_deg'] * DEG, found['height_mm']
        lines = [r"swivel +%.3f deg; the machine's range is -60 to 60 deg" % found['swivel_deg'], 'height +%.3f mm' % height,
                 'lead +%.3f mm' % found['lead_mm'], 'upper face %.3f mm' % (height + 1.5 / math.cos(swivel)),
                 r"%.4f mm less per mm of the wheel's middle above the swivel's centre" % (1 - math.cos(swivel)),
                 r'reads D/2 - %.3f mm: %.3f mm for D = 10 mm' % (height - 1.5, 6.5 - height),
                 r'reads \(D - 10\)/2 mm: 0\.000 mm for D = 10 mm', r'flutes complete X 0\.000 to 30\.000 mm',
                 r"core +6\.800 mm at X = 0, 12\.050 mm at the flute's end; asked 6\.8 mm and 12\.05 mm within 0\.02 mm"]
        for name, key, asked in (('rake', 'rake', '8 deg within 0.5'), ('chordal rake', 'chordal_rake', '8 deg within 7'),
                                 ('spiral angle', 'spiral', '30 deg within 0.3')):
            ends = found[key + '_min_deg'], found[key + '_max_deg']
            lines.append(r'(?m)^  %s +%.3f to %.3f deg; asked %s deg$' % (name, *ends, asked))
        for line in lines:
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
        self.assertRegex(said, r'^the set-up takes a swivel of 32\.3\d* deg; the machine swivels -28\.648 to 28\.648 deg; '
                               r'change cutter\.spiral_angle_deg\n$')
        self.assertEqual(self.text(job), before)
        said = self.grind(1, 'plan', job, '--urdf', urdf).stderr
        self.assertIn('process.setup.swivel_deg = 32.34 deg; allowed: -28.64788976 to 28.64788976 deg', said)

    def test_no_room_for_the_teeth(self):
        said = self.grind(1, 'setup', self.job('job.yaml', teeth=8)).stderr
        self.assertRegex(said, r'^no land is left: the flutes overlap by 0\.\d+ mm along the circle; change '
                               r'process\.wheel\.width_mm\n$')

    def test_what_is_kept_must_be_there(self):
        for keep, key in (('swivel', 'process.setup.swivel_deg'), ('height', 'process.setup.height_mm')):
            said = self.grind(2, 'setup', self.job('job.yaml', setup=None), '--keep', keep).stderr
            self.assertRegex(said, r'job\.yaml:1: %s is missing' % re.escape(key))
        said = self.grind(2, 'setup', self.job('job.yaml', depth_mm=None), '--keep', 'depth').stderr
        self.assertRegex(said, 'depth_mm is missing')
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
                               r'process\.z_law: constant_rake\n(a plan would refuse this tool: .*\n)*.*job\.yaml: nothing was written\n$')
        self.assertEqual(self.text(job), before)
        self.assertIn('a plan would refuse this tool', self.grind(1, 'setup', job).stderr)
        job = self.job('job.yaml', rake_tolerance_deg='0.01', depth_mm='2.6575\n  z_law: constant_rake')
        self.setup(job, '--write')
        self.grind(0, 'plan', job)

    def test_depth_beyond_the_axis_is_none(self):
        # Solved with a depth of 3.6 mm, which the job then refused.
        job = self.job('job.yaml', end_diameter_mm=4.957, cone_angle_deg=1.44, rake_angle_deg=13.02, flute_length_mm=14.26,
                       spiral_angle_deg=19.45, core_diameter_mm=2.088, core_diameter_end_mm=2.805, depth_mm=None,
                       depth_end_mm=1.6, diameter_mm=88.5, width_mm=0.77, infeed_mm=1.6, setup=None)
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
        self.assertRegex(said, r'job\.yaml:35: has a value that is not written as a plain number; nothing was written, '
                               r'write by hand:\n(  process\.[a-z_.]+: [\d.]+\n)+$')
        told = {key: float(figure) for key, figure in re.findall(r'process\.(?:setup\.)?(\w+): (\S+)\n', said)}
        figures = self.setup(PAPER_JOB)
        self.assertEqual(told, {key: figures[key] for key in ('swivel_deg', 'height_mm', 'lead_mm', 'depth_mm', 'depth_end_mm')})
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
