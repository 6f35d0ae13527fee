"""Shows that the grinder keeps the record of a job that it breaks off or continues, that a folder that cannot be is reported and
holds up no job, and what `grind history` lists of the records; and that the node reports which machine it is."""

import datetime
import json
import os
import re
import signal
import subprocess
import time
import xml.etree.ElementTree as xml

import rospy
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from flute_grinder.msg import MachineInfo

import grinder_client as gc
import record_files
from grinder_client import DEG, MM, MM_MIN, STROKE
from test_diagnostics import Reports

# Two unequal teeth of a cone in two passes.
JOB = gc.paper(flute_length=8 * MM, feed=400 * MM_MIN, clearance=1 * MM, tooth_angles=[0.0, 2.0], infeed=0.3 * MM,
               cone_angle=8 * DEG)
NAME = r'\d{10}_\d{8}T\d{6}\.\d{3}Z\.json'


def seconds(utc):
    """Since the epoch."""
    return datetime.datetime.fromisoformat(utc.replace('Z', '+00:00')).timestamp()


class TestRecords(gc.OwnNode):
    """A node with a folder of records, as by the launch file."""

    name = 'kept'

    def setUp(self):
        self.home = gc.temp_folder(self.addCleanup)
        folder = self.home + '/.ros/flute_grinder/history/'
        self.folder = folder + self.name
        self.node = gc.NodeProcess(self.name, dict(gc.machine(pace=5), history=folder))
        self.addCleanup(self.node.close)
        self.grinder = self.node.client()
        self.addCleanup(self.grinder.close)

    def files(self):
        return sorted(os.listdir(self.folder)) if os.path.isdir(self.folder) else []

    def record_of(self, do):
        """What is new in the folder after a job."""
        before = self.files()
        do()
        gc.poll(lambda: [f for f in self.files() if f not in before and re.fullmatch(NAME, f)], 'the record')
        self.assertEqual(self.files()[:-1], before)
        return dict(record_files.read(os.path.join(self.folder, self.files()[-1])), file=self.files()[-1])

    def send_into_stroke(self, **fields):
        self.grinder.make_ready(0.05)
        return self.grinder.send(JOB, **fields).wait_in_stroke(0)

    def test_of_every_end_of_a_job_and_what_grind_history_lists_of_them(self):
        self.check_machine()
        self.grinder.make_ready()
        done = self.record_of(lambda: self.grinder.run(JOB, job_name='two.yaml'))

        def cancel():
            self.grinder.make_ready(0.3)  # what is left then is to take seconds
            run = self.grinder.send(JOB)
            self.grinder.wait_for(lambda: any(s.move == STROKE and s.pass_ == 1 for s in run.setpoints), 'the second pass')
            run.cancel()
            run.wait_complete()

        canceled = self.record_of(cancel)
        self.check_command(done, canceled)
        self.grinder.make_ready()
        left = self.grinder.fresh_state().progress
        record = self.record_of(lambda: self.grinder.run(JOB, first_tooth=left.tooth, first_pass=left.pass_))
        self.assertEqual(record['first'], {'tooth': left.tooth + 1, 'pass': left.pass_ + 1})
        passes = [(1, 1), (1, 2), (2, 1), (2, 2)]
        self.assertEqual([(s['tooth'], s['pass']) for s in record['strokes']], passes[passes.index((left.tooth + 1, left.pass_ + 1)):])

        record = self.record_of(lambda: (self.send_into_stroke(job_name='broken off'), self.node.end(signal.SIGTERM)))
        self.assertEqual((record['outcome'], record['job']), ('canceled', 'broken off'))
        self.assertIn('canceled; stopped on the path', record['reason'])

    def check_machine(self):
        limits = self.grinder.limits()
        message = rospy.wait_for_message('/kept/machine', MachineInfo, gc.PATIENCE)
        version = xml.parse(gc.package_file('package.xml')).findtext('version')
        self.assertEqual((message.name, message.version, message.drive, message.period),
                         ('flute_grinder', version, 'flute_grinder/SimulatedDrive', 0.001))
        self.assertEqual(list(message.max_velocity), limits['max_velocity'])
        self.assertEqual(list(message.max_acceleration), limits['max_acceleration'])
        self.assertEqual(list(message.max_following_error), [0.001, 0.001, 0.001, 0.05])

    def grind(self, *arguments, node=('--node', 'kept'), **environment):
        """`grind history`, without a master."""
        return gc.grind(*node, 'history', *arguments, environment=dict(
            dict(HOME=self.home, ROS_HOME=self.home + '/.ros', ROS_MASTER_URI='http://localhost:1', TZ='UTC-1'), **environment))

    def check_command(self, first, second):
        """The newest is the last; the node's name is resolved."""
        done = self.grind()
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        head, *rows = [re.split('  +', line) for line in done.stdout.splitlines()]
        self.assertEqual(head, ['start', 'job', 'tool', 'outcome', 'strokes', 'duration', 'holds', 'verdict'])
        tool = 'D 10 mm, cone 8 deg, spiral 30 deg, rake 8 deg, 2 teeth'
        # A cancel comes when a client of a busy computer gets to it.
        complete = [sum(s['complete'] for s in record['strokes']) for record in (first, second)]
        self.assertEqual(complete[0], 4)
        self.assertIn(complete[1], (1, 2, 3))
        for row, record, name, strokes in zip(rows, (first, second), ('two.yaml', '-'), ('%d of 4' % count for count in complete)):
            local = time.strftime('%Y-%m-%d %H:%M:%S', time.gmtime(seconds(record['started']) + 3600))
            self.assertEqual(row[:5] + row[6:7], [local, name, tool, record['outcome'], strokes, '0'])
            self.assertAlmostEqual(float(row[5].split()[0]), seconds(record['ended']) - seconds(record['started']), delta=0.051)
        self.assertEqual(self.grind(node=('--node', '/kept')).stdout, done.stdout)
        other = self.grind(node=())
        self.assertEqual((other.returncode, other.stdout), (2, ''))
        self.assertIn('.ros/flute_grinder/history/grinder: cannot be read: No such file', other.stderr)
        self.assertIn('history/left/kept: cannot be read', self.grind(ROS_NAMESPACE='left').stderr)

        listed = json.loads(self.grind('--json').stdout)
        self.assertEqual(list(listed[0]), ['file', 'grinder', 'started', 'ended', 'job', 'digest', 'operation', 'tool', 'continues', 'ends_tool',
                                           'wheel', 'dressed', 'wear_mm', 'outcome', 'reason', 'strokes', 'passes', 'duration_s', 'holds',
                                           'setpoints', 'lost', 'verdict', 'verdict_because'])
        for entry, record, figures in zip(listed, (first, second), (('two.yaml', 'done', '', 4, 4, 0, first['verdict']),
                                                                    ('', 'canceled', second['reason'], complete[1], 4, 0, 'failed'))):
            self.assertEqual([entry[key] for key in ('file', 'started')], [os.path.join(self.folder, record['file']), record['started']])
            self.assertEqual(tuple(entry[key] for key in ('job', 'outcome', 'reason', 'strokes', 'passes', 'holds', 'verdict')), figures)
        self.check_judged_again()

    def check_judged_again(self):
        """The verdict is by the tolerances of the node until then, and is kept."""
        tolerances = os.path.join(self.home, 'tolerances.yaml')
        for most, failed in ((1e5, []), (0, ['feed constancy'])):
            with open(tolerances, 'w') as file:
                json.dump(dict(land_mm=0, edge_diameter_mm=most, following_error_um=most, feed_percent=most,
                               late_cycles_percent=most), file)
            again = json.loads(self.grind('--json', '--judge-again', '--tolerances', tolerances).stdout)
            self.assertEqual([reason for reason in again[0]['verdict_because'] if 'feed' in reason], failed)
            # The tool is measured by what the record has of its strokes.
            self.assertNotIn('rake: not measured', again[0]['verdict_because'])
            self.assertEqual(json.loads(self.grind('--json').stdout), again)
            self.assertRegex(re.split('  +', self.grind().stdout.splitlines()[2])[-1], '^FAILED: the job ended as canceled')

    def test_of_a_measured_tool_correct_the_zero_points(self):
        job = gc.package_file('test/jobs/paper.yaml')
        self.grinder.make_ready()
        self.client = self.grinder
        y, z = self.correctable('--set', 'x=0', '--set', 'y=0', '--set', 'z=0', '--answer', 'set-offset')
        self.assertEqual((y['found_at'], z['found_at']), (y['set_at'], z['set_at']))
        self.record_of(lambda: self.command(0, 'run', job, '--answer', 'confirm-wheel', '--answer', 'confirm-swivel'))
        self.assertIn('no tool has been measured', self.command(2, 'correct', job, '--apply').stderr)
        for off, said in ((0.2, '; OUT OF TOLERANCE'), (0.03, '')):  # the second corrects the first
            core = '%.4f' % (self.planned_core(job) + off)
            self.command(0, 'measured', job, 'core@15=' + core)
            self.assertRegex(self.command(0, 'history', '--figure', 'core@15', '--job', job).stdout,
                             r'(?m)^ +1  \d{4}-\d\d-\d\d \d\d:\d\d:\d\d +%s +0\.0000 .* found%s$' % (core, said))
        self.check_shown(job)
        said = json.loads(self.command(0, 'correct', job, '--json').stdout)
        self.assertLess(said['turn']['y_mm'], -0.002)
        self.assertEqual([axis['offset_mm'] for axis in self.correctable()], [0, 0])
        for _ in range(2):  # the second time it is as it should be
            self.assertIn('the work offsets of Y and Z are set', self.command(0, 'correct', job, '--apply').stdout)
            corrected = self.correctable()
            for axis, found, asked in zip(corrected, (y, z), ('y_mm', 'z_mm')):
                self.assertAlmostEqual(axis['offset_mm'], said['offsets'][asked], delta=1e-9)
                self.assertEqual((axis['set_for']['method'], axis['found_at']), ('correction', found['found_at']))
        self.command(0, 'confirm-wheel', job, '--again')
        self.assertIn('another wheel has been mounted since', self.command(1, 'correct', job, '--apply').stderr)
        y, corrected[1] = self.correctable('--set', 'y=0.001', '--set', 'z=%r' % corrected[1]['offset_mm'])
        self.assertEqual((y['set_for']['method'], y['found_at']), ('by_hand', y['set_at']))
        refused = self.command(1, 'correct', job, '--apply')
        self.assertIn('the zero point of Y is not the one of tool 1, the last one ground', refused.stderr)
        self.assertEqual(self.correctable(), [y, corrected[1]])

    def check_shown(self, job):
        """What was measured, over the tools and in the report; test_end.py has its page."""
        svg = os.path.join(self.home, 'chart.svg')
        said = json.loads(self.command(0, 'history', '--figure', 'core@15', '--job', job, '--svg', svg, '--json').stdout)
        self.assertEqual((said['figure'], said['x_mm'], said['unit'], said['tolerance']), ('core_diameter', 15, 'mm', 0.1))
        tool, = said['tools']
        self.assertAlmostEqual(tool['measured'], self.planned_core(job) + 0.03, delta=1e-4)
        self.assertEqual((tool['tool'], tool['y_mm'], tool['zero_points']), (1, 0, 'found'))
        picture, = (element.text for element in xml.parse(svg).iter() if (element.text or '').startswith('core diameter at'))
        self.assertEqual(picture, 'core diameter at X = 15 mm')
        report = json.loads(self.command(0, 'report', '--last', '--json').stdout)
        shown, = report['operations'][0]['measured']
        self.assertEqual(shown, dict(said, value=tool['measured']))

    def correctable(self, *arguments):
        """Y and Z of `grind offsets`."""
        job = ('--job', gc.package_file('test/jobs/paper.yaml')) if arguments else ()
        axes = json.loads(self.command(0, 'offsets', '--json', *arguments, *job).stdout)['axes']
        return [axes['y'], axes['z']]

    def planned_core(self, job):
        """In the middle: it is linear from end to end."""
        return sum(json.loads(self.command(0, 'plan', job, '--json').stdout)['figures']['core_diameter']['ground_mm']) / 2

    def command(self, status, *arguments):
        """A command for this grinder."""
        done = gc.grind('--node', self.name, *arguments, environment=dict(ROS_HOME=self.home + '/.ros'))
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def test_ros_home_moves_it_with_the_launch_file(self):
        for value, ros_home in ((self.home + '/ros', self.home + '/ros'), ('', self.home + '/.ros')):
            launch = subprocess.run(['roslaunch', '--dump-params', 'flute_grinder', 'grinder.launch'], check=True,
                                    stdout=subprocess.PIPE, env=dict(os.environ, HOME=self.home, ROS_HOME=value)).stdout
            parameters = yaml.safe_load(launch)
            self.assertEqual(parameters['/grinder/journal'], ros_home + '/flute_grinder/')
            self.assertEqual(parameters['/grinder/history'], ros_home + '/flute_grinder/history/')
            self.assertIn(ros_home + '/flute_grinder/history/grinder: cannot be read',
                          self.grind(node=(), ROS_HOME=value).stderr)
        done = self.grind('--from', self.home)
        self.assertEqual((done.returncode, done.stdout), (0, 'no records in %s\n' % self.home))
        self.assertEqual(json.loads(self.grind('--from', self.home, '--json').stdout), [])


class TestBadFolder(gc.OwnNode):
    """It is reported, and the job does not mind."""

    def test_is_reported_and_the_job_is_ground(self):
        folder = gc.temp_folder(self.addCleanup)
        with open(os.path.join(folder, 'file'), 'w'):
            pass
        grinder = self.start(dict(gc.machine(pace=5), history=folder + '/file/history', history_limit=1.0))
        reports = Reports(self.addCleanup, self.node.name)
        reported = reports.wait('History', DiagnosticStatus.WARN, 'history %s/file/history: ' % folder)
        self.assertIn('Not a directory', reported.message)
        grinder.make_ready()
        self.assertEqual(grinder.run(gc.SHORT).status, 'SUCCEEDED')
        self.assertEqual(reports.statuses['Recorder'], [], 'there is none')
        self.assertRegex(self.node.output, r'(?s)WARN.*history %s/file/history: ' % folder)
        # Well again as soon as a record can be kept; of two the limit leaves one.
        os.remove(folder + '/file')
        self.assertEqual(grinder.run(gc.SHORT).status, 'SUCCEEDED')
        reports.wait('History', DiagnosticStatus.OK)
        kept = os.listdir(folder + '/file/history')
        self.assertEqual(grinder.run(gc.SHORT).status, 'SUCCEEDED')
        gc.poll(lambda: len(os.listdir(folder + '/file/history')) == 1 and os.listdir(folder + '/file/history') != kept, 'the newest alone')
