#!/usr/bin/env python3
"""Shows what `grind table`, `grind plan` and wrong usage print, and the exit status: 0 done, 1 the job said no, 2 wrong usage or an
unreadable file."""

import io
import math
import os
import pathlib
import pty
import re
import shutil
import stat
import subprocess
import sys
import xml.etree.ElementTree

import flute_grinder.job
from flute_grinder.msg import GrindActionGoal, Process
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from grind_command import PAPER_JOB, CommandLine  # noqa: E402
from grinder_client import DEG  # noqa: E402


WHEEL = r'(?ms)^  wheel:.*?^(?=\S|  \w)'  # of a job file


class TestTable(CommandLine):
    """`grind table` gives the paper's figures."""

    def test_the_papers_figures_are_printed(self):
        printed = self.grind(0, 'table', PAPER_JOB, '--step-length', '0.2').stdout
        self.assertIn('\n152 points\n', printed)
        self.assertRegex(printed, r'maximum error +3\.9785e-05 rad')
        self.assertRegex(printed, r'maximum at even points +3\.5000e-07 rad')
        self.assertRegex(printed, r'(?m)^ *152 +30\.2684( +\S+){3}$')

    def test_json_has_every_bit(self):
        for arguments, rule in (([], 'published'), (['--even-step', 'third_order'], 'third_order')):
            reported, _ = self.json(0, 'table', PAPER_JOB, '--step-length', '0.2', '--csv', self.path('table.csv'), *arguments)
            self.assertEqual((reported['step_length_mm'], reported['even_step']), (0.2, rule))
            rows = [{key: float(value) for key, value in row.items()} for row in self.csv(self.path('table.csv'))]
            self.assertEqual(reported['points'], rows)
            odd = max(abs(row['error_rad']) for row in rows[1::2])
            even = max(abs(row['error_rad']) for row in rows[::2])
            self.assertEqual((reported['max_odd_error_rad'], reported['max_even_error_rad'], reported['max_error_rad']),
                             (odd, even, max(odd, even)))
            self.assertEqual(len(reported), 6)

    def test_steps_that_are_too_long_print_nothing(self):
        job = gc.job_file(self.path('back.yaml'), cone_angle_deg=-3, end_diameter_mm=10)
        done = self.grind(1, 'table', job, '--step-length', '100', '--json')
        self.assertEqual(done.stdout, '')
        self.assertRegex(done.stderr, r'^--step-length 100 mm is too long for this curve at X = 0 mm$')


class TestPlan(CommandLine):
    def test_json_of_a_good_job(self):
        reported, reasons = self.json(0, 'plan', PAPER_JOB, '--csv', self.path('plan.csv'))
        rows = self.csv(self.path('plan.csv'))
        self.assertEqual((reported['valid'], reported['reasons'], reasons, reported['feed_limits']), (True, [], '', []))
        self.assertEqual((reported['setpoints'], reported['duration_s']), (len(rows), (len(rows) - 1) * 1e-3))
        # A move has the cycles that end in it.
        cycles = {move: sum(row['move'] == move for row in rows[1:]) for move in gc.MOVES}
        self.assertEqual(sorted(reported['move_durations']), sorted(move + '_s' for move in gc.MOVES))
        for move, count in cycles.items():
            self.assertAlmostEqual(reported['move_durations'][move + '_s'], count * 1e-3, delta=1e-9)
        for step in ('odd', 'even'):
            self.assertEqual(reported['max_%s_error_rad' % step],
                             max(abs(float(row['error_rad'])) for row in rows if row['step'] == step))
        for key in ('min_feed_mm_min', 'max_feed_mm_min'):
            self.assertAlmostEqual(reported[key], 600, delta=600e-6)
        for axis, column, unit in (('x_mm', 'x_mm', 1), ('y_mm', 'y_mm', 1), ('z_mm', 'z_mm', 1), ('a_deg', 'a_rad', DEG)):
            positions = [float(row[column]) / unit for row in rows]
            fastest = max(abs(b - a) for a, b in zip(positions, positions[1:])) / 1e-3
            self.assertAlmostEqual(reported['max_velocity'][axis + '_s'], fastest, delta=1e-8 * max(1, fastest))
            ends = positions[:1] * 2 + positions[::2] + positions[-1:]
            bend = max(abs(a - 2 * b + c) for a, b, c in zip(ends, ends[1:], ends[2:])) / 2e-3 ** 2
            self.assertAlmostEqual(reported['max_acceleration'][axis + '_s2'], bend, delta=1e-5 * max(1, bend))
            self.assertGreater(reported['max_jerk'][axis + '_s3'], 0)
            ripple = max(abs(a - 2 * b + c) for a, b, c in zip(positions, positions[1:], positions[2:])) / 1e-3 ** 2
            self.assertAlmostEqual(reported['odd_even_ripple'][axis + '_s2'], ripple, delta=1e-5 * max(1, ripple))
        self.assertEqual((reported['complete_from_mm'], reported['complete_to_mm'], len(reported)), (0, 30, 21))
        printed = self.grind(0, 'plan', PAPER_JOB).stdout
        self.assertRegex(printed, r'setpoints +%d\nduration +%.3f s' % (len(rows), (len(rows) - 1) * 1e-3))
        for feed in re.search(r'feed constancy +(\S+) to (\S+) mm/min', printed).groups():
            self.assertAlmostEqual(float(feed), 600, delta=600e-6)
        closest = reported['closest']
        self.assertRegex(printed, r'closest +%s, %.3f mm at X \S+ mm' % (' and '.join(closest['bodies']), closest['distance_mm']))
        # The paper's cone ends with a radius of 5 + 30 tan 5 deg, in a shank of 16 mm.
        self.assertAlmostEqual(reported['shank_cut_mm'], 8 - 5 - 30 * math.tan(5 * DEG), delta=1e-9)
        self.assertRegex(printed, r"cut out of the shank 0\.375 mm more than the infeed, by the first pass beyond the flute's end")
        for number, removed in enumerate(reported['passes'], 1):
            self.assertIn('pass %-15d %.4f mm, %.4g mm^2, %.3g mm^3/s\n' % (
                number, removed['depth_mm'], removed['area_mm2'], removed['rate_mm3_s']), printed)
        self.assertEqual(number, 1)

    def test_what_is_asked_stands_beside_what_is_ground(self):
        with open(PAPER_JOB) as file:
            text = file.read()
        for key, value in (('core_diameter_mm', 7), ('core_diameter_end_mm', 12.3), ('chordal_rake_tolerance_deg', 5)):
            text, count = re.subn(r'(?m)^( +%s:).*$' % key, r'\g<1> %g' % value, text)
            self.assertEqual(count, 1, key)
        job = self.write('core.yaml', text)
        reported, printed = self.json(0, 'plan', job)[0], self.grind(0, 'plan', job).stdout
        sections = self.json(0, 'simulate', job, '--sections', '9')[0]['sections']
        figures = reported['figures']
        for name, asked, tolerance in (('rake', 8, 0.5), ('chordal_rake', 8, 5), ('spiral', 30, 4)):
            ground = [tooth[name + '_deg'] for section in sections for tooth in section['teeth']]
            self.assertEqual(figures[name]['ground_deg'], [min(ground), max(ground)])
            for asks in figures[name]['asked_deg']:
                self.assertAlmostEqual(asks, asked, delta=1e-9)
            self.assertAlmostEqual(figures[name]['tolerance_deg'], tolerance, delta=1e-9)
            self.assertRegex(printed, r'(?m)^%s.* %.3f to %.3f deg; asked %g deg within %g deg$' % (
                name.replace('_', ' '), min(ground), max(ground), asked, tolerance))
        ends = [sections[i]['core_diameter_mm'] for i in (0, -1)]
        core = figures['core_diameter']
        self.assertEqual((core['ground_mm'], core['x_mm']), (ends, [0, sections[-1]['x_mm']]))
        self.assertRegex(printed, r'(?m)^core diameter  .* %.3f to %.3f mm; asked 7 to 12\.3 mm within 0\.1 mm$' % tuple(ends))
        for found, asked in zip((*core['asked_mm'], core['tolerance_mm']), (7, 12.3, 0.1)):
            self.assertAlmostEqual(found, asked, delta=1e-9)

    def test_json_of_a_job_that_is_cut_and_one_that_is_refused(self):
        job = gc.job_file(self.path('fast.yaml'), feed_mm_min=10000)
        reported, _ = self.json(0, 'plan', job)
        self.assertTrue(reported['feed_limits'])
        lines = re.findall(r'(?m)^feed limited by +(.*), X (\S+) to (\S+) mm$', self.grind(0, 'plan', job).stdout)
        causes = [re.sub('axis_([xyza])', lambda axis: 'axis ' + axis.group(1).upper(), cut['cause'])
                  for cut in reported['feed_limits']]
        self.assertEqual([(cause, '%.3f' % cut['from_x_mm'], '%.3f' % cut['to_x_mm'])
                          for cause, cut in zip(causes, reported['feed_limits'])], lines)
        job = gc.job_file(self.path('long.yaml'), flute_length_mm=400)
        reported, reasons = self.json(1, 'plan', job)
        self.assertFalse(reported['valid'])
        self.assertEqual(reported['reasons'], reasons.rstrip('\n').split('\n'))
        self.assertEqual(len(reported['reasons']), 4)

    def test_fifo_is_no_file(self):
        fifo = self.path('fifo.yaml')
        os.mkfifo(fifo)
        wheel = self.write('wheel.yaml', re.sub(WHEEL, '  wheel:\n    file: fifo.yaml\n', pathlib.Path(PAPER_JOB).read_text()))
        said = fifo + ': cannot be read: not a regular file; allowed: a file on a disk, no FIFO and no device'
        for arguments in (['plan', fifo], ['plan', wheel], ['plan', PAPER_JOB, '--machine', fifo], ['wheel', 'show', fifo],
                          ['plan', PAPER_JOB, '--urdf', fifo], ['simulate', fifo], ['report', fifo, '--json'],
                          ['report', PAPER_JOB, '--json', '--tolerances', fifo], ['history', '--judge-again', '--tolerances', fifo]):
            self.assertIn(said, self.grind(2, *arguments).stderr, arguments)
        os.mkdir(self.path('history'))
        for make, name in ((os.mkfifo, '0000000001_20261122T170413.000Z.json'), (os.mkdir, '0000000002_20261122T170413.001Z.json')):
            make(self.path('history/' + name))
        done = self.grind(0, 'history', '--from', self.path('history'))
        self.assertRegex(done.stderr, r'(.*\d\d[01]Z\.json: skipped: named like a record, but not a regular file\n){2}$')
        self.assertIn('has no record', self.grind(2, 'report', '--last', '--from', self.path('history'), '--json').stderr)

    def test_environment_that_cannot_be(self):
        done = gc.grind('plan', PAPER_JOB, environment=dict(ROS_PACKAGE_PATH='', CMAKE_PREFIX_PATH=''))
        self.assertEqual(done.returncode, 2)
        self.assertTrue(done.stderr.endswith(
            'the package flute_grinder is not found, nor its config/grinder.yaml; source build/devel/setup.bash of the clone '
            'in this shell\n'), done.stderr)
        for uri in ('localhost:11311', 'http://localhost', '', 'http://:11311'):
            for program in ('grind', 'grinder'):
                done = subprocess.run([gc.program(program), '--version'], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                      env=dict(os.environ, ROS_MASTER_URI=uri), universal_newlines=True)
                self.assertEqual((done.returncode, done.stderr), (2, 'ROS_MASTER_URI = %s; allowed: http://HOST:PORT, as '
                                                                     'http://localhost:11311\n' % uri))


class TestMachine(CommandLine):
    """`grind machine`, and the launch file, which has it judge what is launched."""

    FILES = [gc.package_file(file) for file in ('config/grinder.yaml', 'config/hal.yaml', 'urdf/grinder.urdf')]

    def test_machine_file(self):
        config, hal, urdf = self.FILES
        self.assertEqual(self.grind(0, 'machine', config, hal, '--urdf', urdf).stdout, ', '.join(self.FILES) + '\n')
        self.assertEqual(self.grind(2, 'machine', config, '--urdf', PAPER_JOB).stderr,
                         PAPER_JOB + ' is not a URDF, by line 1 (XML_ERROR_PARSING_TEXT); allowed: XML with the root <robot>\n')
        text = pathlib.Path(config).read_text()
        decimal = '; allowed: a decimal number, as 100, 0.002 or 2.0e-3, or a text in quotes'
        more = self.write('more.yaml', 'jog_timeout: 9\n')
        for old, new, said, *others in (
                ('control_rate: 1000', 'control_rate: 0100', '{0}:3: control_rate = 0100' + decimal),
                *(('feedback_timeout: 0.002', 'feedback_timeout: ' + wrong, '{0}:4: feedback_timeout = ' + wrong + decimal)
                  for wrong in ('2e-3', '1_000', '0x10', '1:30', '.5', '0o17')),
                ('history_limit: 1.0e+8', 'history_limit: 10000000000',
                 '{0}:14: history_limit = 10000000000; allowed: whole numbers up to 2147483647, or one with a point'),
                ('slow: 0.1 ', 'slow: 0.1\n  slow: 0.2 ', '{0}:26: probing/slow appears twice'),
                ('slow: 0.1 ', 'slow:  ', '{0}:25: probing/slow has no value'),
                ('homing_timeout: 60.0', 'homing_timeout: "60.0"', 'parameter {0}/homing_timeout = "60.0"; allowed: a number'),
                # Of a second file, a key overrides that of the first.
                ('jog_timeout', 'jog_timeout', 'parameter {0}, {1}/jog_timeout = 9; allowed: 0.05 to 1', more)):
            self.assertIn(old, text)
            files = [self.write('machine.yaml', text.replace(old, new)), *others]
            self.assertEqual(self.grind(2, 'machine', *files, '--urdf', urdf).stderr, said.format(*files) + '\n')

    def test_bag_that_is_there_is_not_written_over(self):
        for name in ('a bag.bag', 'b.bag.active'):
            self.write(name, 'mine')
        os.symlink('nowhere', self.path('c.bag'))
        taken = ': is already there; allowed: a bag of another name, or move this one elsewhere\n'
        for bag, said in ((self.path('a bag.bag'), self.path('a bag.bag') + taken), (self.path('b.bag'), self.path('b.bag.active') + taken),
                          (self.path('c.bag'), self.path('c.bag') + taken),
                          ('a.bag', 'bag = a.bag; allowed: an absolute path, or one that begins with ~/\n'),
                          (self.path('none/a.bag'), self.path('none/a.bag') + ': cannot be written: No such file or directory\n')):
            self.assertEqual(self.grind(2, 'machine', self.FILES[0], '--urdf', self.FILES[2], '--bag', bag).stderr, said)

    def launch(self, *arguments, **environment):
        done = subprocess.run(['roslaunch', '--dump-params', 'flute_grinder', 'grinder.launch', *arguments], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True, env=dict(os.environ, **environment))
        return done.stdout

    def test_launch_file_takes_what_it_declares_and_no_more(self):
        config, hal, urdf = self.FILES
        values = dict(config=config, hal_config=hal, urdf=urdf, name='other', hardware='hal', loopback_only='true',
                      rviz='false', required='false', bag='true',
                      bag_file=self.path('a bag'), **{name: '/tmp/' for name in ('journal', 'offsets', 'history')},
                      tolerances=gc.package_file('config/tolerances.yaml'))
        tree = xml.etree.ElementTree.parse(gc.package_file('launch/grinder.launch'))
        self.assertEqual({arg.get('name') for arg in tree.iter('arg') if 'default' in arg.keys()}, set(values))
        said = self.launch(*('%s:=%s' % item for item in values.items()))
        for parameter in ('/other/journal: /tmp/', '/other/recorder: other_bag'):
            self.assertIn(parameter, said)
        wrong = self.write('machine.yaml', 'control_rate: 1000\ncontrol_rate: 500\n')
        there = self.write('a bag.bag', 'mine')
        for argument, why in (('hardwear:=hal', "unknown arguments: ['hardwear']"),
                              ('config:=' + wrong, wrong + ':2: control_rate appears twice\n'),
                              ('bag_file:=' + there, there + ' without bag:=true; allowed: both, or none')):
            said = self.launch(argument)
            self.assertIn(why, said)
            self.assertNotIn('control_rate: 1000', said)
        # As rosbag names it.
        self.assertIn(there + ': is already there; ', self.launch('bag:=true', 'bag_file:=~/a bag', HOME=self.folder))


def shipped_jobs():
    return sorted(path for path in pathlib.Path(gc.package_file('jobs')).glob('*.yaml') if '.setup.' not in path.name)


class TestGoal(CommandLine):
    """`grind goal`, and the module for clients in Python that runs it."""

    def test_goals_of_the_shipped_jobs(self):
        jobs = shipped_jobs()
        self.assertGreater(len(jobs), 5)
        for path in jobs:
            if 'operations:' in path.read_text():
                kinds = [gc.process_of(flute_grinder.job.goal(path, number)).kind for number in (1, 2, 3)]
                self.assertEqual(kinds, [Process.FLUTE, Process.PRIMARY, Process.SECONDARY])
                self.assertEqual(flute_grinder.job.goal(path, 'primary').operation, 1)
                continue
            goal = flute_grinder.job.goal(path)
            self.assertEqual(goal.job_name, path.name)
            self.assertEqual((goal.dry_run, goal.answers, goal.first_tooth, goal.first_pass), (False, [], 0, 0))
            for field, value in gc.job_from_file(str(path)).items():
                part, name = field.split('.')
                self.assert_close(getattr(gc.part_of(goal, part), name), value, '%s: %s' % (path, field))

    def assert_close(self, value, expected, text):
        if isinstance(expected, (list, tuple)):
            self.assertEqual(len(value), len(expected), text)
            for pair in zip(value, expected):
                self.assert_close(*pair, text)
        else:
            self.assertTrue(math.isclose(value, expected, rel_tol=1e-12), '%s = %r, not %r' % (text, value, expected))

    def test_goal_of_64_teeth_is_short(self):
        message = GrindActionGoal(goal=gc.goal_of(gc.paper(tooth_angles=[i * math.pi / 32 for i in range(64)]), answers=[]))
        message.goal_id.id = '/' + 'n' * 40 + '-12345-1700000000.123456789'
        written = io.BytesIO()
        message.serialize(written)
        self.assertLess(len(written.getvalue()), 1200)

    def test_what_is_refused_is_said_as_by_plan(self):
        bad = gc.job_file(self.path('bad.yaml'), cone_angle_deg=90)
        for path in (bad, self.path('none.yaml'), '--json'):
            with self.assertRaises(ValueError) as raised:
                flute_grinder.job.goal(path)
            self.assertEqual(str(raised.exception), self.grind(2, 'plan', '--', path).stderr.strip())

    def test_terminal_is_refused(self):
        reader, writer = pty.openpty()
        self.addCleanup(os.close, reader)
        done = subprocess.run([gc.program('grind'), 'goal', PAPER_JOB], stdout=writer, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=gc.PATIENCE)
        os.close(writer)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, '^standard output is a terminal, .*; allowed: a file or a pipe')


class TestOutput(CommandLine):
    """What is written and printed: into files, onto a terminal, onto a disk that is full, and into a pipe that nobody reads."""

    def shown(self, kind, *arguments, status=0):
        """What a command that ends with a status draws on a terminal of this kind."""
        reader, writer = pty.openpty()
        self.addCleanup(os.close, reader)
        done = subprocess.run([gc.program('grind'), *arguments], env=dict(os.environ, TERM=kind), stdout=subprocess.DEVNULL,
                              stderr=writer, timeout=gc.PATIENCE)
        end, shown = b'\x04', b''
        os.write(writer, end)
        while not shown.endswith(end):
            shown += os.read(reader, 1000)
        os.close(writer)
        self.assertEqual(done.returncode, status)
        return shown[:-1].decode()

    def test_terminal_shows_what_takes_long_and_then_nothing_of_it(self):
        simulate = 'simulate', PAPER_JOB, '--stl', self.path('tool.stl')
        shown = self.shown('xterm', *simulate)
        for what in ('computing the ground tool ...', 'computing the solid ...'):
            self.assertIn('\r\x1b[K' + what, shown)
        self.assertTrue(shown.endswith('\r\x1b[K'), shown)
        self.assertEqual(self.shown('dumb', *simulate), '')
        record = self.write('0000000001_20261122T170413.123Z.json', '')
        shown = self.shown('xterm', 'history', '--from', self.folder, '--judge-again', status=2)
        self.assertRegex(shown, r'^\r\x1b\[Kmeasuring and judging tools \.\.\.')
        self.assertIn('\r\x1b[K%s: is no record of a job' % record, shown)

    def test_no_file_that_a_command_reads_is_written(self):
        job, table = self.job_with_wheel(), self.path('table.csv')
        self.grind(0, 'table', job, '--step-length', '0.2', '--csv', table)
        wheel, linked, machine = self.path('wheel.yaml'), self.path('linked'), self.path('machine.yaml')
        os.link(job, linked)
        shutil.copy(gc.package_file('config/grinder.yaml'), machine)
        before = self.contents()
        for output, *arguments in ((job, 'plan', job, '--csv', job), (linked, 'plan', job, '--csv', linked),
                                   (wheel, 'plan', job, '--csv', wheel),
                                   (machine, 'plan', job, '--machine', machine, '--csv', machine),
                                   (job, 'table', job, '--step-length', '0.2', '--csv', job),
                                   (job, 'simulate', job, '--stl', job), (wheel, 'simulate', job, '--svg', wheel),
                                   (table, 'report', table, '-o', table), (table, 'report', table, '--pdf', table)):
            self.assertEqual(self.grind(2, *arguments).stderr,
                             output + ': cannot be written: the command reads it; allowed: a file that it does not read\n')
        both = self.path('both')
        self.assertEqual(self.grind(2, 'simulate', job, '--csv', both, '--stl', both).stderr,
                         both + ': cannot be written: another option writes it; allowed: a file of its own for each\n')
        self.assertEqual(self.contents(), before)

    def job_with_wheel(self):
        """A job in the test's folder, with a wheel file beside it."""
        shutil.copy(gc.package_file('wheels/straight_d125_w2.yaml'), self.path('wheel.yaml'))
        text = pathlib.Path(PAPER_JOB).read_text()
        return self.write('job.yaml', re.sub(WHEEL, '  wheel:\n    file: wheel.yaml\n', text))

    def contents(self):
        return {path.name: path.read_bytes() for path in pathlib.Path(self.folder).iterdir()}

    def test_file_is_replaced_in_one_step(self):
        """Where a link leads, with the rights that it had; a drawing that ends early leaves it."""
        real, link = pathlib.Path(self.path('real.csv')), self.path('link.csv')
        os.symlink('real.csv', link)
        for mode in (0o644, 0o640):
            self.grind(0, 'plan', PAPER_JOB, '--csv', link)
            self.assertTrue(os.path.islink(link))
            self.assertEqual((stat.S_IMODE(real.stat().st_mode), self.csv(link)[0]['cycle']), (mode, '0'))
            real.chmod(0o640)
        before = self.contents()
        broken = gc.temp_folder(self.addCleanup)
        pathlib.Path(broken, 'matplotlib.py').write_text('raise SystemExit(3)')
        self.assertEqual(gc.grind('simulate', PAPER_JOB, '--svg', link, environment={'PYTHONPATH': broken}).returncode, 3)
        self.assertEqual(self.contents(), before)

    def test_file_of_the_standard_output(self):
        printed = self.grind(0, 'plan', PAPER_JOB).stdout
        self.grind(0, 'plan', PAPER_JOB, '--csv', self.path('plan.csv'))
        with open(self.path('all'), 'w') as output:
            gc.grind('plan', PAPER_JOB, '--csv', '/dev/stdout', stdout=output)
        self.assertEqual(pathlib.Path(self.path('all')).read_text(), pathlib.Path(self.path('plan.csv')).read_text() + printed)

    def test_file_on_a_full_disk(self):
        for arguments in (['table', PAPER_JOB, '--step-length', '0.2', '--csv'], ['plan', PAPER_JOB, '--csv'],
                          ['simulate', PAPER_JOB, '--at', '10', '--csv'], ['simulate', PAPER_JOB, '--at', '10', '--stl']):
            self.assertEqual(self.grind(1, *arguments, '/dev/full').stderr,
                             '/dev/full: write failed: No space left on device\n')

    def test_pipe_that_is_left(self):
        # More than a pipe holds; nobody reads it from the beginning.
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run([gc.program('grind'), 'table', PAPER_JOB, '--step-length', '0.01'], stdout=writer,
                              stderr=subprocess.PIPE, timeout=gc.PATIENCE)
        os.close(writer)
        self.assertEqual((done.returncode, done.stderr), (1, b''))


class TestUsage(CommandLine):
    def test_number_is_named_with_what_is_allowed(self):
        wheel = gc.package_file('wheels/straight_d125_w2.yaml')
        for arguments, said in ((['wheel', 'measure', wheel, '--diameter', '124,7'], '--diameter = 124,7'),
                                (['simulate', PAPER_JOB, '--at', '1.5,b'], '--at = 1.5,b'),
                                (['simulate', PAPER_JOB, '--sections', '3.5'], '--sections = 3.5'),
                                (['jog', 'x', '1,5\x1b[2J'], 'DISTANCE = 1,5\\x1b[2J')):
            self.assertEqual(self.grind(2, *arguments).stderr.splitlines()[0], said +
                             '; allowed: a number, with a point as in 124.7, or a whole one where it counts')

    def test_probe_looks_as_far_as_its_documentation_says(self):
        for cycle, within in (('end-face', 'MM=5 '), ('diameter', 'MM=5 '), ('tooth', r'DEG:.*=90\n')):
            self.assertRegex(self.grind(0, 'probe', cycle, '--help').stdout, '--within ' + within)

    def test_texts_of_files_control_no_terminal(self):
        bad = self.write('bad.yaml', 'cutter: "\\\x1b[2J"\n')
        self.assertEqual(self.grind(2, 'plan', bad).stderr, bad + ':1: unknown escape character: \\x1b\n')

    def test_output_that_cannot_be_printed_is_no_success(self):
        for arguments in (['table', PAPER_JOB, '--step-length', '0.2'], ['plan', PAPER_JOB, '--json'], ['completion', 'bash'],
                          ['goal', PAPER_JOB], ['--help']):
            self.check_not_printed(*arguments)


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'cli', '__main__')
