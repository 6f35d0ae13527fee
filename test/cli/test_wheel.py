#!/usr/bin/env python3
"""Shows that `grind wheel` prints a wheel file, and changes in it what was measured or dressed and nothing else; and that
`grind zeros` computes with it."""

import datetime
import math
import os
import pathlib
import pwd
import re
import socket
import sys

import rostest
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from grind_command import CommandLine, full_disk  # noqa: E402

WORN = gc.package_file('wheels/straight_d125_w2.yaml')
NEW = gc.package_file('wheels/straight_d100_w3.yaml')
ANGLED = gc.package_file('wheels/angled_d100_w10.yaml')


def text_of(path):
    with open(path, newline='') as file:
        return file.read()


class WheelTest(CommandLine):
    def copy(self, path, name='wheel.yaml'):
        return self.write(name, text_of(path))

    def wheel(self, path):
        with open(path) as file:
            return yaml.safe_load(file)

    def check_stamp(self, measured):
        """Date and name of who wrote."""
        date = measured['date']
        if isinstance(date, datetime.datetime):
            date = date.replace(tzinfo=datetime.timezone.utc)
        else:
            date = datetime.datetime.strptime(date, '%Y-%m-%dT%H:%M:%S%z')
        age = datetime.datetime.now(datetime.timezone.utc) - date
        self.assertLess(abs(age.total_seconds()), gc.PATIENCE)
        self.assertEqual(measured['by'], '%s@%s' % (pwd.getpwuid(os.geteuid()).pw_name, socket.gethostname()))


class TestShow(WheelTest):
    def test_text_and_json(self):
        printed = self.grind(0, 'wheel', 'show', WORN).stdout
        self.assertIn('diameter         124.76 mm, Y = 0 is set to 125 mm: wear 0.12 mm\n', printed)
        self.assertIn('measured         2026-11-20 by tool room\n', printed)
        reported, _ = self.json(0, 'wheel', 'show', WORN)
        self.assertEqual(reported, {'profile': 'straight', 'diameter_mm': 124.76, 'set_diameter_mm': 125, 'wear_mm': 0.12,
                                'width_mm': 2, 'new_width_mm': 2, 'angle_deg': None, 'side': None,
                                'rim_mm': None, 'corner_radius_mm': [0, 0], 'points_mm': None, 'flange_mm': 2.5, 'dressed': None,
                                'measured': {'date': '2026-11-20', 'by': 'tool room'}})
        reported, _ = self.json(0, 'wheel', 'show', ANGLED)
        self.assertAlmostEqual(reported.pop('angle_deg'), 20, delta=1e-12)
        self.assertEqual((reported['profile'], reported['side'], reported['wear_mm'], reported['measured']), ('angled', 'upper', 0, None))


class TestMeasure(WheelTest):
    def test_figures_are_written_and_all_else_stays(self):
        for wheel, diameter, width in ((WORN, 124.7, 1.95), (NEW, 99.9, 2.98)):
            path = self.copy(wheel)
            printed = self.grind(0, 'wheel', 'measure', path, '--diameter', str(diameter), '--width', str(width)).stdout
            measured = self.wheel(path)['measured']
            self.assertEqual((measured['diameter_mm'], measured['width_mm']), (diameter, width))
            self.check_stamp(measured)
            self.assertTrue(text_of(path).startswith(text_of(wheel).partition('measured:\n')[0]))
            self.assertEqual(set(self.wheel(path)), set(self.wheel(wheel)) | {'measured'})
            if wheel == WORN:
                self.assertIn('wear 0.15 mm\n', printed)
                self.assertIn('set X and Z anew', printed)
            before = text_of(path)
            done = gc.grind('wheel', 'measure', path, '--diameter', '90', preexec_fn=full_disk)
            self.assertEqual((done.returncode, done.stderr), (2, path + ': cannot be written: File too large\n'))
            self.assertEqual((text_of(path), os.listdir(self.folder)), (before, ['wheel.yaml']))

    def test_larger_wheel_is_refused_unless_forced(self):
        path = self.copy(WORN)
        said = self.grind(1, 'wheel', 'measure', path, '--diameter', '124.8').stderr
        self.assertRegex(said, r'^--diameter = 124\.8 mm; allowed: up to 124\.76 mm, .* a new wheel is a new file\n$')
        said = self.grind(1, 'wheel', 'measure', path, '--diameter', '124.7', '--width', '2.1').stderr
        self.assertRegex(said, r'^--width = 2\.1 mm; allowed: up to 2 mm, ')
        self.assertEqual(text_of(path), text_of(WORN))
        self.grind(0, 'wheel', 'measure', path, '--diameter', '124.8', '--width', '2.1', '--force')
        self.assertEqual(self.wheel(path)['measured']['diameter_mm'], 124.8)


class TestDress(WheelTest):
    def test_figures_are_written(self):
        path = self.copy(WORN)
        for arguments, figures in ((['--radial', '0.02', '--face', '0.1'], (124.72, 1.9)), (['--radial', '0.02'], (124.68, 1.9))):
            self.grind(0, 'wheel', 'dress', path, *arguments)
            measured = self.wheel(path)['measured']
            self.assertEqual((measured['diameter_mm'], measured['width_mm']), figures)
            self.assertEqual(self.wheel(path)['dressed'], measured['date'])
            self.check_stamp(measured)
        path = self.copy(NEW)
        self.grind(0, 'wheel', 'dress', path, '--face', '0.25')
        measured = self.wheel(path)['measured']
        self.assertEqual((measured['diameter_mm'], measured['width_mm']), (100, 2.75))

    def test_nothing_to_dress_and_nothing_left(self):
        path = self.copy(WORN)
        for status, arguments, reason in ((2, [], ''), (2, ['--radial', '0', '--face', '0'], ''),
                                          (1, ['--face', '2'], 'measured.width_mm = 0 mm; allowed: 0.1 to 100 mm'),
                                          (1, ['--radial', '100'], 'measured.diameter_mm = -75.24 mm')):
            self.assertIn(reason, self.grind(status, 'wheel', 'dress', path, *arguments).stderr)
            self.assertEqual(text_of(path), text_of(WORN))


class TestZeros(WheelTest):
    """`grind zeros` against the formulas of the documentation, in mm."""

    def machine(self, **geometry):
        machine = gc.shipped_machine()
        machine['geometry'] = geometry
        return self.write('machine.yaml', yaml.safe_dump(machine))

    def test_of_a_machine_in_which_everything_counts(self):
        machine = self.machine(work_axis={'y': 0.011, 'z': -0.022}, collet_face={'x': 0.133},
                               swivel_centre={'x': 0.0044, 'y': 0.0555, 'z': 0.0066}, flange=0.077)
        job = gc.package_file('jobs/finishing_d20_t8.yaml')
        swivel, height = math.radians(46.588), 0.281
        for flange, arguments in ((2.5, []), (-4, ['--flange', '-4'])):
            reported, _ = self.json(0, 'zeros', job, '--stickout', '71.5', '--machine', machine, *arguments)
            # The wheel is 2 mm wide, and Y is set to 125 mm, whatever it has worn.
            along = 77 - flange - 2 / 2
            self.assertEqual(set(reported), {'x_mm', 'y_mm', 'z_mm'})
            self.assertAlmostEqual(reported['x_mm'], 133 - 71.5 - 4.4 + along * math.sin(swivel), delta=1e-9)
            self.assertAlmostEqual(reported['y_mm'], 11 + 20 / 2 + 125 / 2 - 55.5, delta=1e-9)
            self.assertAlmostEqual(reported['z_mm'], -22 + height - 6.6 - along * math.cos(swivel), delta=1e-9)
            printed = self.grind(0, 'zeros', job, '--stickout', '71.5', '--machine', machine, *arguments).stdout
            self.assertEqual(printed.split(), ['work', 'zero', 'X', '%.4f' % reported['x_mm'], 'Y', '%.4f' % reported['y_mm'], 'Z',
                                               '%.4f' % reported['z_mm'], 'mm'])

    def test_refusals(self):
        job = gc.package_file('test/jobs/paper.yaml')
        said = self.grind(2, 'zeros', job, '--stickout', '62').stderr
        self.assertEqual(said, '--flange is missing, and %s names no wheel file\n' % job)
        said = self.grind(1, 'zeros', job, '--stickout', '29', '--flange', '2').stderr
        self.assertEqual(said, "--stickout = 29 mm; allowed: the flutes' length or more, 30 mm\n")
        wheel = self.write('wheel.yaml', re.sub('flange_mm.*', '', text_of(NEW)))
        job = self.write('job.yaml', text_of(gc.package_file('jobs/unequal_d12_t4.yaml')).replace(
            '../wheels/straight_d100_w3.yaml', 'wheel.yaml').replace('file: unequal', 'file: ' + gc.package_file('jobs/unequal')))
        self.assertEqual(self.grind(2, 'zeros', job, '--stickout', '62').stderr,
                         '--flange is missing, and %s has no flange_mm\n' % wheel)


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'wheel', '__main__')
