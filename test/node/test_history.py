"""Shows that the grinder keeps the record of a job that it breaks off or continues, that the disk
cannot hold up a job, and what `grind history` lists of the records; and that the node reports which machine it is."""

import datetime
import json
import os
import re
import signal
import subprocess
import time
import unittest

import rospkg
import rospy
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from flute_grinder.msg import MachineInfo

import grinder_client as gc
import record_files
from grinder_client import DEG, MM, MM_MIN, STROKE
from test_diagnostics import Reports

# Two unequal teeth of a cone in two passes; with time to interfere in a stroke, even on a host that stalls.
FEED = 80  # mm/min
JOB = gc.paper(flute_length=8 * MM, feed=FEED * MM_MIN, clearance=1 * MM, tooth_angles=[0.0, 2.0], infeed=0.3 * MM,
               cone_angle=8 * DEG)
NAME = r'\d{10}_\d{8}T\d{6}\.\d{3}Z\.json'


def seconds(utc):
    """Since the epoch."""
    return datetime.datetime.fromisoformat(utc.replace('Z', '+00:00')).timestamp()


class Kept(unittest.TestCase):
    """A node with a folder of records."""

    name = 'kept'

    @classmethod
    def setUpClass(cls):
        cls.home = gc.temp_folder(cls.addClassCleanup)
        # As by the launch file.
        cls.parameter = cls.home + '/.ros/flute_grinder/history/'
        cls.folder = cls.parameter + cls.name
        cls.start()
        cls.addClassCleanup(lambda: (cls.grinder.close(), cls.node.close()))

    @classmethod
    def start(cls):
        cls.node = gc.NodeProcess(cls.name, dict(gc.machine(pace=5), history=cls.parameter))
        cls.grinder = cls.node.client()

    @classmethod
    def files(cls):
        return sorted(os.listdir(cls.folder)) if os.path.isdir(cls.folder) else []

    @classmethod
    def record_of(cls, do):
        """What is new in the folder after a job, and what `do` returns."""
        before = cls.files()
        result = do()
        gc.poll(lambda: [f for f in cls.files() if f not in before and re.fullmatch(NAME, f)], 'the record')
        new, = [f for f in cls.files() if f not in before]
        return dict(record_files.read(os.path.join(cls.folder, new)), file=new), result


class TestRecords(Kept):
    """Of every end of a job, and of no other goal."""

    def setUp(self):
        self.grinder.make_ready()

    def restart(self, with_signal=signal.SIGTERM):
        self.assertIn(self.node.end(with_signal), (0, -signal.SIGKILL))
        self.grinder.close()
        self.node.close()
        type(self).start()

    def send_into_stroke(self, **fields):
        self.grinder.make_ready(0.2)
        return self.grinder.send(JOB, **fields).wait_in_stroke(0)

    def test_continued_job_reports_where_it_began(self):
        self.grinder.make_ready(0.2)
        run = self.grinder.send(JOB).wait_past(lambda s: (s.tooth, s.pass_, s.move) == (1, 1, STROKE), 'the last stroke')
        self.record_of(lambda: (run.cancel(), run.wait_complete())[1])
        self.grinder.make_ready()
        record, _ = self.record_of(lambda: self.grinder.run(JOB, first_tooth=1, first_pass=1))
        self.assertEqual(record['first'], {'tooth': 2, 'pass': 2})
        self.assertEqual([(s['tooth'], s['pass']) for s in record['strokes']], [(2, 2)])

    def test_machine(self):
        limits = self.grinder.limits()
        message = rospy.wait_for_message('/kept/machine', MachineInfo, gc.PATIENCE)
        version = rospkg.RosPack().get_manifest('flute_grinder').version
        self.assertEqual((message.name, message.version, message.drive, message.period),
                         ('flute_grinder', version, 'flute_grinder/SimulatedDrive', 0.001))
        self.assertEqual(list(message.max_velocity), limits['max_velocity'])
        self.assertEqual(list(message.max_acceleration), limits['max_acceleration'])
        self.assertEqual(list(message.max_following_error), [0.001, 0.001, 0.001, 0.05])

    def test_end_of_the_node_keeps_the_record_and_a_restart_the_folder(self):
        before = self.files()

        def end():
            run = self.send_into_stroke(job_name='broken off')
            self.restart()
            return run

        record, _ = self.record_of(end)
        self.assertEqual((record['outcome'], record['job']), ('canceled', 'broken off'))
        self.assertIn('canceled; stopped on the path', record['reason'])
        self.assertEqual(self.files()[:-1], before)
        self.assertEqual(self.files()[-1], record['file'])

    def test_kill_leaves_no_half_record(self):
        before = self.files()
        self.send_into_stroke()
        self.restart(signal.SIGKILL)
        self.assertEqual(self.files(), before)


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
        reports.wait('History', DiagnosticStatus.WARN, 'Not a directory')
        reports.wait('Journal', DiagnosticStatus.OK)
        self.assertRegex(self.node.output, r'(?s)WARN.*history %s/file/history: ' % folder)
        # Well again as soon as a record can be kept; of two the limit leaves one.
        os.remove(folder + '/file')
        self.assertEqual(grinder.run(gc.SHORT).status, 'SUCCEEDED')
        reports.wait('History', DiagnosticStatus.OK)
        kept = os.listdir(folder + '/file/history')
        self.assertEqual(grinder.run(gc.SHORT).status, 'SUCCEEDED')
        gc.poll(lambda: os.listdir(folder + '/file/history') not in (kept, []), 'another record')
        gc.poll(lambda: len(os.listdir(folder + '/file/history')) == 1, 'the oldest gone')


class TestCommand(Kept):
    """`grind history`, without a master."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.grinder.make_ready()
        cls.first, _ = cls.record_of(lambda: cls.grinder.run(JOB, job_name='two.yaml'))

        def cancel():
            run = cls.grinder.send(JOB).wait_past(lambda s: s.move == STROKE and s.pass_ == 1, 'the second pass')
            run.cancel()
            return run.wait_complete()

        cls.second, _ = cls.record_of(cancel)

    def grind(self, *arguments, node=('--node', 'kept'), **environment):
        return gc.grind(*node, 'history', *arguments, environment=dict(
            HOME=self.home, ROS_MASTER_URI='http://localhost:1', TZ='UTC-1', **environment))

    def test_lists_the_newest_last(self):
        done = self.grind()
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        head, *rows = [re.split('  +', line) for line in done.stdout.splitlines()]
        self.assertEqual(head, ['start', 'job', 'tool', 'outcome', 'strokes', 'duration', 'holds', 'verdict'])
        tool = 'D 10 mm, cone 8 deg, spiral 30 deg, rake 8 deg, 2 teeth'
        for row, record, name, strokes in zip(rows, (self.first, self.second), ('two.yaml', '-'), ('4 of 4', '1 of 4')):
            local = time.strftime('%Y-%m-%d %H:%M:%S', time.gmtime(seconds(record['started']) + 3600))
            lasted = seconds(record['ended']) - seconds(record['started'])
            self.assertEqual(row[:3] + row[4:5] + row[6:7], [local, name, tool, strokes, '0'])
            self.assertAlmostEqual(float(row[5].split()[0]), lasted, delta=0.051)
            self.assertEqual(row[3], record['outcome'])

    def test_node_name_is_resolved(self):
        self.assertEqual(self.grind(node=('--node', '/kept')).stdout, self.grind().stdout)
        other = self.grind(node=())
        self.assertEqual((other.returncode, other.stdout), (2, ''))
        self.assertIn('.ros/flute_grinder/history/grinder: cannot be read: No such file', other.stderr)
        self.assertIn('history/left/kept: cannot be read', self.grind(ROS_NAMESPACE='left').stderr)

    def test_ros_home_moves_it_with_the_launch_file(self):
        for value, ros_home in ((self.home + '/ros', self.home + '/ros'), ('', self.home + '/.ros')):
            launch = subprocess.run(['roslaunch', '--dump-params', 'flute_grinder', 'grinder.launch'], check=True,
                                    stdout=subprocess.PIPE, env=dict(os.environ, HOME=self.home, ROS_HOME=value)).stdout
            parameters = yaml.safe_load(launch)
            self.assertEqual(parameters['/grinder/journal'], ros_home + '/flute_grinder/')
            self.assertEqual(parameters['/grinder/history'], ros_home + '/flute_grinder/history/')
            self.assertIn(ros_home + '/flute_grinder/history/grinder: cannot be read',
                          self.grind(node=(), ROS_HOME=value).stderr)

    def test_json(self):
        done = self.grind('--json')
        first, second = json.loads(done.stdout)
        self.assertEqual(list(first), ['file', 'grinder', 'started', 'ended', 'job', 'digest', 'operation', 'tool', 'continues', 'ends_tool', 'wheel', 'dressed',
                                       'wear_mm', 'outcome', 'reason', 'strokes', 'passes', 'duration_s', 'holds', 'setpoints', 'lost',
                                       'verdict', 'verdict_because'])
        self.assertEqual(first['file'], os.path.join(self.folder, self.first['file']))
        self.assertEqual([first[key] for key in ('started', 'job', 'outcome', 'reason', 'strokes', 'passes', 'holds')],
                         [self.first['started'], 'two.yaml', 'done', '', 4, 4, 0])
        self.assertEqual([second['outcome'], second['reason'], second['strokes']], ['canceled', self.second['reason'], 1])

    def test_verdict_is_by_the_tolerances_of_the_node_until_it_is_judged_again(self):
        listed = json.loads(self.grind('--json').stdout)
        self.assertEqual([entry['verdict'] for entry in listed], [self.first['verdict'], 'failed'])
        tolerances = os.path.join(self.home, 'tolerances.yaml')
        for most, failed in ((1e5, []), (0, ['feed constancy'])):
            with open(tolerances, 'w') as file:
                json.dump(dict(land_mm=0, edge_diameter_mm=most, following_error_um=most, feed_percent=most,
                               late_cycles_percent=most), file)
            again = json.loads(self.grind('--json', '--judge-again', '--tolerances', tolerances).stdout)
            self.assertEqual([reason for reason in again[0]['verdict_because'] if 'feed' in reason], failed)
            # The tool is measured by what the record has of its strokes, and the verdicts are kept.
            self.assertNotIn('rake: not measured', again[0]['verdict_because'])
            self.assertEqual(json.loads(self.grind('--json').stdout), again)
            rows = [re.split('  +', line)[-1] for line in self.grind().stdout.splitlines()]
            self.assertRegex(rows[2], '^FAILED: the job ended as canceled')

    def test_empty_folder(self):
        folder = gc.temp_folder(self.addCleanup)
        done = self.grind('--from', folder)
        self.assertEqual((done.returncode, done.stdout), (0, 'no records in %s\n' % folder))
        self.assertEqual(json.loads(self.grind('--from', folder, '--json').stdout), [])
