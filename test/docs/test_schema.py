#!/usr/bin/env python3
"""Holds docs/schema.yaml against the programs: each key and parameter is refused where it is missing, of the wrong type or
beyond its range, in the very words that the schema's figures make; each end of a range is taken; and there is no key that
the schema does not know."""

import contextlib
import copy
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ROOT / 'build/devel/lib/flute_grinder'
JOINTS = ['axis_x', 'axis_y', 'axis_z', 'axis_a']
MISSING = object()

SCHEMA = yaml.safe_load((ROOT / 'docs/schema.yaml').read_text())


def steps(path):
    """The way to a key: 'process.overtravel_mm[0]' or 'joint_limits/axis_x/max_jerk' as a list."""
    return [int(step) if step.isdigit() else step for step in re.findall(r'[^./\[\]]+', path)]


def value_at(tree, path):
    for step in steps(path):
        tree = tree[step]
    return tree


def changed(tree, path, new):
    """A copy of a tree of keys with another value at one, or without it."""
    tree = copy.deepcopy(tree)
    *parents, last = steps(path)
    at = tree
    for parent in parents:
        at = at.setdefault(parent, {}) if isinstance(at, dict) else at[parent]
    if new is MISSING:
        del at[last]
    else:
        at[last] = new
    return tree


def beyond(low, high):
    """A number below a range and one above it, short ones, since they are read again in the refusal."""
    return (low / 2 if low > 0 else low * 2 if low < 0 else -1), high * 2


def grind_plan(*arguments):
    done = subprocess.run([PROGRAMS / 'grind', 'plan', *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, timeout=60)
    return done.returncode, done.stderr.splitlines()


def wrong(entry):
    """What is said of a word in the place of a value; nothing where it might be a choice or a date."""
    if 'range' in entry:
        return ' is not a whole number' if entry.get('integer') else ' is not a number'
    return ' is neither true nor false' if entry.get('choices') == ['true', 'false'] else ''


class TestJobFile(unittest.TestCase):
    job = yaml.safe_load((ROOT / 'jobs/paper.yaml').read_text())
    # With every key but the lists.
    job['process']['wheel'].update(profile='angled', angle_deg=20, side='upper', wear_per_pass_mm=0)
    job['process'].update(depth_end_mm=1.6, incomplete_ok=False)
    LISTS = {'cutter.tooth_angles_deg', 'cutter.spiral_angles_deg', 'process.wheel.points_mm'}

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, 'job.yaml')

    def refusal(self, job):
        """What is said of a job that is not taken, without file and line."""
        with open(self.file, 'w') as file:
            yaml.safe_dump(job, file)
        status, lines = grind_plan(self.file)
        self.assertEqual(status, 2, lines)
        return [re.sub(r'^%s:\d+: ' % re.escape(self.file), '', line) for line in lines]

    def numbers(self):
        return [(key, entry) for key, entry in SCHEMA['job'].items() if 'range' in entry]

    def allowed(self, entry):
        if 'choices' in entry:
            return ', '.join(entry['choices'])
        return ('%.10g to %.10g %s' % (*entry['range'], entry.get('unit', ''))).rstrip()

    def test_every_key_but_the_optional_is_missed(self):
        for key, entry in SCHEMA['job'].items():
            if 'default' in entry or entry.get('type') == 'list':
                continue
            with self.subTest(key):
                # A list is shorter then, so that of its keys the last is missed.
                key = key.replace('[0]', '[1]')
                remedy = '; ' + entry['remedy'] if 'remedy' in entry else ''
                self.assertEqual(self.refusal(changed(self.job, key, MISSING)),
                                 ['%s is missing; allowed: %s%s' % (key, self.allowed(entry), remedy)])

    def test_no_word_is_taken_for_a_number_or_a_choice(self):
        for key, entry in SCHEMA['job'].items():
            if entry.get('type') in ('list', 'text'):
                continue
            with self.subTest(key):
                self.assertEqual(self.refusal(changed(self.job, key, 'fast')),
                                 ['%s = fast%s; allowed: %s' % (key, wrong(entry), self.allowed(entry))])

    def test_numbers_beyond_the_range_are_refused(self):
        for key, entry in self.numbers():
            for value in beyond(*entry['range']):
                value = int(value) if entry.get('integer') else value
                with self.subTest(key, value=value):
                    shown = ('%.10g %s' % (value, entry.get('unit', ''))).rstrip()
                    self.assertIn('%s = %s; allowed: %s' % (key, shown, self.allowed(entry)),
                                  self.refusal(changed(self.job, key, value)))

    def test_the_ends_of_the_range_are_taken(self):
        # Another key is beyond its range, so that nothing is planned.
        for key, entry in self.numbers():
            wrong = 'process.wheel.width_mm' if key != 'process.wheel.width_mm' else 'process.depth_mm'
            for value in entry['range']:
                with self.subTest(key, value=value):
                    lines = self.refusal(changed(changed(self.job, key, value), wrong, -1))
                    self.assertEqual([line.split(' = ')[0] for line in lines], [wrong])

    def test_choices_are_taken(self):
        for key, entry in SCHEMA['job'].items():
            for choice in entry.get('choices', []):
                with self.subTest(key, choice=choice):
                    job = changed(changed(self.job, key, choice), 'process.depth_mm', -1)
                    if key == 'process.wheel.profile' and choice not in ('angled', 'cup'):
                        job = changed(job, 'process.wheel.side', MISSING)
                    if choice == 'points':
                        job = changed(job, 'process.wheel.points_mm', [[-1.5, 50], [1.5, 49]])
                    lines = self.refusal(job)
                    self.assertEqual([line.split(' = ')[0] for line in lines], ['process.depth_mm'])

    def test_tooth_angles(self):
        entry = SCHEMA['job']['cutter.tooth_angles_deg']
        without = changed(self.job, 'cutter.teeth', MISSING)
        for angles, wrong in (([1, 180], '1'), ([0, 90, 90], '90'), ([0, 360], '360')):
            with self.subTest(angles=angles):
                self.assertEqual(self.refusal(changed(without, 'cutter.tooth_angles_deg', angles)),
                                 ['cutter.tooth_angles_deg = %s deg; allowed: %s %s' % (wrong, entry['allowed'], entry['unit'])])

    def test_there_are_no_other_keys(self):
        line, = self.refusal(changed(self.job, 'strange', 1))
        refused, allowed = line.split(' is not a key of a job file; allowed: ')
        self.assertEqual(refused, 'strange')
        self.assertEqual(sorted(allowed.split(', ')), sorted(set(SCHEMA['job']) - self.LISTS))


class TestWheelFile(unittest.TestCase):
    """As `grind wheel show` reads it."""

    wheel = yaml.safe_load((ROOT / 'wheels/angled_d100_w10.yaml').read_text())
    wheel['measured'] = {'date': '2026-11-20', 'diameter_mm': 99, 'width_mm': 9, 'by': 'anna'}

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, 'wheel.yaml')

    def show(self, wheel):
        """The exit status, and what is said of a wheel without file and line."""
        with open(self.file, 'w') as file:
            yaml.safe_dump(wheel, file)
        done = subprocess.run([PROGRAMS / 'grind', 'wheel', 'show', self.file], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=60)
        return done.returncode, [re.sub(r'^%s:\d+: ' % re.escape(self.file), '', line) for line in done.stderr.splitlines()]

    def allowed(self, key, entry):
        if key == 'measured.diameter_mm':
            return '1 to 100 mm, the diameter to which Y = 0 is set'
        if 'choices' in entry:
            return ', '.join(entry['choices'])
        return ('%.10g to %.10g %s' % (*entry['range'], entry['unit'])) if 'range' in entry else entry['allowed']

    def test_every_key_but_the_optional_is_missed(self):
        for key, entry in SCHEMA['wheel'].items():
            if 'default' in entry or entry.get('type') == 'list':
                continue
            with self.subTest(key):
                self.assertEqual(self.show(changed(self.wheel, key, MISSING)),
                                 (2, ['%s is missing; allowed: %s' % (key, self.allowed(key, entry))]))

    def test_no_word_is_taken_for_a_number_or_a_choice(self):
        for key, entry in SCHEMA['wheel'].items():
            if key == 'measured.by' or entry.get('type') == 'list':
                continue
            with self.subTest(key):
                self.assertEqual(self.show(changed(self.wheel, key, 'fast')),
                                 (2, ['%s = fast%s; allowed: %s' % (key, wrong(entry), self.allowed(key, entry))]))

    def test_numbers_beyond_the_range_are_refused(self):
        for key, entry in SCHEMA['wheel'].items():
            ends = [self.wheel[end] if isinstance(end, str) else end for end in entry.get('range', [])]
            for value in beyond(*ends) if ends else []:
                with self.subTest(key, value=value):
                    status, lines = self.show(changed(self.wheel, key, value))
                    self.assertEqual(status, 2)
                    self.assertIn('%s = %.10g %s; allowed: %s' % (key, value, entry['unit'], self.allowed(key, entry)), lines)

    def test_there_are_no_other_keys(self):
        status, (line,) = self.show(changed(self.wheel, 'strange', 1))
        self.assertEqual(status, 2)
        refused, allowed = line.split(' is not a key of a wheel file; allowed: ')
        self.assertEqual(refused, 'strange')
        self.assertEqual(sorted(allowed.split(', ')), sorted(set(SCHEMA['wheel']) - {'points_mm'}))


class Parameters:
    """What holds of the parameters of a section, however the programs are told them."""

    section = None
    joints = JOINTS
    # With every limit stated.
    machine = yaml.safe_load((ROOT / 'config/grinder.yaml').read_text())
    for joint in JOINTS:
        machine['joint_limits'][joint].update(has_position_limits=True, min_position=-2.0, max_position=2.0,
                                              has_velocity_limits=True, max_velocity=1.0)

    def refusal(self, machine):
        """What is said of a machine that is not taken, with parameters' names as in the schema."""
        raise NotImplementedError

    def parameters(self):
        """Name, where a joint is one of an axis, and entry."""
        for name, entry in SCHEMA[self.section].items():
            for joint in self.joints if '<joint>' in name else ['']:
                yield name.replace('<joint>', joint), entry

    def range(self, name, entry):
        """The ends of a parameter's range, some of which are other parameters."""
        joint = next((step for step in name.split('/') if step in JOINTS), '')
        return [value_at(self.machine, end.replace('<joint>', joint)) if isinstance(end, str) else end
                for end in entry['range']]

    def test_every_one_is_missed(self):
        for name, entry in self.parameters():
            if 'default' in entry or name.split('/')[-1] in ('max_acceleration', 'max_jerk'):
                continue
            with self.subTest(name):
                self.assertRegex(self.refusal(changed(self.machine, name, MISSING)),
                                 '^parameter %s is missing' % re.escape(name))

    def test_wrong_type_is_refused(self):
        kinds = {None: ('fast', 'a number'), 'text': (7, 'a text'), 'flag': (7, 'true or false')}
        for name, entry in self.parameters():
            wrong, allowed = kinds[entry.get('type')]
            with self.subTest(name):
                self.assertRegex(self.refusal(changed(self.machine, name, wrong)),
                                 r'^parameter %s = .*%s.*; allowed: %s$' % (re.escape(name), wrong, allowed))

    def test_numbers_beyond_the_range_are_refused(self):
        for name, entry in self.parameters():
            for value in beyond(*self.range(name, entry)) if 'range' in entry else []:
                with self.subTest(name, value=value):
                    self.assertEqual(self.refusal(changed(self.machine, name, float(value))),
                                     'parameter %s = %g; allowed: %g to %g' % (name, value, *self.range(name, entry)))


class TestMachine(Parameters, unittest.TestCase):
    """As `grind plan` reads it."""

    section = 'machine'

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, 'machine.yaml')

    def refusal(self, machine):
        with open(self.file, 'w') as file:
            yaml.safe_dump(machine, file)
        status, lines = grind_plan(ROOT / 'jobs/paper.yaml', '--machine', self.file)
        self.assertEqual((status, len(lines)), (2, 1), lines)
        return lines[0].replace(self.file + '/', '')

    def test_the_ends_of_the_range_are_taken(self):
        # What is read last is wrong, so that nothing is planned.
        for name, entry in self.parameters():
            if 'range' not in entry or name == 'park_position/axis_a' or 'max_position' in name or 'min_position' in name:
                continue
            for value in self.range(name, entry):
                with self.subTest(name, value=value):
                    machine = changed(changed(self.machine, name, value), 'park_position/axis_a', 1e12)
                    if name.endswith('/max_velocity'):  # the end of another range
                        for speed in ('jog_velocity/', 'probing/velocity/'):
                            machine = changed(machine, speed + name.split('/')[1], value)
                    self.assertRegex(self.refusal(machine), '^parameter park_position/axis_a = ')

    def test_half_a_limit_is_refused(self):
        for name, entry in self.parameters():
            if not name.startswith('joint_limits'):
                continue
            with self.subTest(name):
                self.assertRegex(self.refusal(changed(self.machine, name, MISSING)),
                                 '^parameter %s is missing' % re.escape(name))

    def test_flags_are_true(self):
        for name, entry in self.parameters():
            if entry.get('type') == 'flag':
                with self.subTest(name):
                    self.assertEqual(entry['allowed'], 'true')
                    self.assertRegex(self.refusal(changed(self.machine, name, False)),
                                     '^parameter %s = false; allowed: true' % re.escape(name))


class NodeParameters(Parameters):
    """As the node reads them."""

    drive = 'flute_grinder/SimulatedDrive'

    @classmethod
    def setUpClass(cls):
        port = os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1]
        master = subprocess.Popen(['rosmaster', '--core', '-p', port], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        cls.addClassCleanup(master.wait)
        cls.addClassCleanup(master.terminate)
        cls.master = xmlrpc.client.ServerProxy(os.environ['ROS_MASTER_URI'])
        deadline = time.monotonic() + 60
        while True:
            with contextlib.suppress(OSError):
                cls.master.setParam('/test', '/robot_description', (ROOT / 'urdf/grinder.urdf').read_text())
                break
            assert time.monotonic() < deadline, 'no master'
            time.sleep(0.01)
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.machine = copy.deepcopy(Parameters.machine)
        cls.machine['journal'] = cls.folder.name + '/journal'
        cls.machine['offsets'] = cls.folder.name + '/offsets'
        cls.machine['history'] = cls.folder.name + '/history'
        cls.machine['hardware']['type'] = cls.drive

    def refusal(self, machine):
        if self.master.hasParam('/test', '/grinder')[2]:
            self.master.deleteParam('/test', '/grinder')
        self.master.setParam('/test', '/grinder', machine)
        done = subprocess.run([PROGRAMS / 'grinder', '__name:=grinder'], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True, timeout=60)
        self.assertEqual(done.returncode, 1, done.stdout)
        text, = re.findall(r'(?m)^.*\[FATAL\] \[[\d.]+\]: (.*?)(?:\x1b\[0m)?$', done.stdout)
        return text.replace('/grinder/', '', 1)


class TestNode(NodeParameters, unittest.TestCase):
    section = 'node'


class TestSimulatedDrive(NodeParameters, unittest.TestCase):
    section = 'simulated_drive'
    # All are read alike, and each start of the node takes its time.
    joints = ['axis_y']

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.machine['hardware']['blank'] = {'end_face': 0.0, 'diameter': 0.01, 'run_out': 0.0,
                                            'rake_face': {'height': 0.0, 'angle': 0.0}}


@unittest.skipUnless((PROGRAMS.parent / 'libflute_grinder_hal_hardware.so').exists(), 'the HAL drive is left out')
class TestHal(NodeParameters, unittest.TestCase):
    section = 'hal'
    drive = 'flute_grinder/HalHardware'

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.machine['hardware'].update(yaml.safe_load((ROOT / 'config/hal.yaml').read_text())['hardware'])


class TestConfig(unittest.TestCase):
    def leaves(self, tree, path=''):
        for name, value in tree.items():
            if isinstance(value, dict):
                yield from self.leaves(value, path + name + '/')
            else:
                yield re.sub('/axis_[xyza]/', '/<joint>/', re.sub('/axis_[xyza]$', '/<joint>', path + name))

    def test_schema_knows_every_parameter_of_the_shipped_files(self):
        known = {name for section in SCHEMA.values() for name in section}
        for file in ('config/grinder.yaml', 'config/hal.yaml'):
            self.assertLessEqual(set(self.leaves(yaml.safe_load((ROOT / file).read_text()))), known)

    def test_shipped_files_have_every_parameter_that_must_be_there(self):
        shipped = {name for file in ('config/grinder.yaml', 'config/hal.yaml')
                   for name in self.leaves(yaml.safe_load((ROOT / file).read_text()))}
        needed = {name for section in ('machine', 'node', 'simulated_drive', 'hal')
                  for name, entry in SCHEMA[section].items() if 'default' not in entry}
        self.assertEqual(needed - shipped, {'journal', 'offsets', 'history'})


if __name__ == '__main__':
    unittest.main(argv=sys.argv)
