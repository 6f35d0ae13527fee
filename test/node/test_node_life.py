"""Shows how the node starts, listens, is used and ends: on loopback alone, not at all where its parameters leave a
doubt; and what it leaves behind."""

import functools
import glob
import os
import re
import signal
import socket
import subprocess
import unittest
import urllib.parse
import xmlrpc.client

import rosgraph
import rospy
from flute_grinder.msg import GrinderState
from flute_grinder.srv import JogStep
from visualization_msgs.msg import Marker, MarkerArray

import grinder_client as gc
from grinder_client import DEG, MM, STROKE, Y


class TestLoopback(unittest.TestCase):
    """Launched with the defaults; test/loopback.sh does it from a shell that says nothing of addresses."""

    def test_api_topics_and_services_listen_on_loopback_alone_with_the_parameters_of_the_launch(self):
        with socket.socket() as elsewhere:
            elsewhere.bind(('127.0.0.2', 0))
            elsewhere.listen()
            self.assertIn('%s:%d' % elsewhere.getsockname(), gc.listening(os.getpid()), 'other addresses would be seen')
        folder = gc.temp_folder(self.addCleanup)
        rospy.set_param('/listener/of_before', True)
        launch = subprocess.Popen(['roslaunch', '--wait', 'flute_grinder', 'grinder.launch', 'name:=listener',
                                   'journal:=' + os.path.join(folder, 'journal')],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(launch.wait, gc.PATIENCE)
        self.addCleanup(launch.send_signal, signal.SIGINT)
        gc.Grinder('listener').close()
        uri = rosgraph.Master('/test_node_life').lookupNode('/listener')
        api = urllib.parse.urlparse(uri)
        pid = xmlrpc.client.ServerProxy(uri).getPid('/test_node_life')[2]
        self.assertEqual(os.path.basename(os.readlink('/proc/%d/exe' % pid)), 'grinder')
        self.assertEqual(socket.gethostbyname(api.hostname), '127.0.0.1')
        listening = gc.listening(pid)
        self.assertIn('127.0.0.1:%d' % api.port, listening)
        self.assertGreater(len(listening), 1)
        self.assertEqual({address.rpartition(':')[0] for address in listening}, {'127.0.0.1'})
        parameters = rospy.get_param('/listener')
        self.assertNotIn('of_before', parameters)
        self.assertTrue({'control_rate', 'hardware', 'journal'} <= set(parameters))


# Parameter and its value (None: taken away), what the message must say beside the parameter's full name. Of a reader of the node, of the
# drives' loader, and of a drive's init(); test_parameters.cpp has all.
BAD_PARAMETERS = [
    ('jog_timeot', 0.2, " is not known; did you mean 'jog_timeout'?"),
    ('hardware/type', 'flute_grinder/NoSuchDrive',
     '= flute_grinder/NoSuchDrive; allowed: flute_grinder/HalHardware; flute_grinder/RosControlDrive; flute_grinder/SimulatedDrive'),
    ('hardware/axis_x/time_constant', None,
     'the drive flute_grinder/SimulatedDrive: parameter /doubtful/hardware/axis_x/time_constant is missing; allowed: a number'),
]


class TestStartFailsClosed(unittest.TestCase):
    def check(self, *expected, parameters, **options):
        node = gc.NodeProcess('doubtful', parameters, **options)
        self.addCleanup(node.close)
        self.assertEqual(node.end(), 1, node.output)
        for text in expected:
            self.assertIn(text, node.output)

    def test_bad_parameters(self):
        for path, value, text in BAD_PARAMETERS:
            with self.subTest(path):
                parameters = gc.machine()
                *groups, name = path.split('/')
                group = functools.reduce(dict.get, groups, parameters)
                group.pop(name, None)
                group.update({} if value is None else {name: value})
                self.check(text, 'parameter /doubtful/' + path, parameters=parameters)

    def test_rosrun_finds_the_program(self):
        done = subprocess.run(['rosrun', 'flute_grinder', 'grinder', '__name:=doubtful', 'robot_description:=/nothing_here'],
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              universal_newlines=True, timeout=gc.PATIENCE)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertIn('parameter /nothing_here is missing; allowed: a URDF', done.stdout)

    def test_drive_was_left_out_of_the_build(self):
        parameters = gc.machine()
        parameters['hardware']['type'] = 'flute_grinder/HalHardware'
        # Where the node finds no library of a drive, as none is built where LinuxCNC is not installed.
        self.check('parameter /doubtful/hardware/type = flute_grinder/HalHardware cannot be loaded: ',
                   'Built where linuxcnc-uspace-dev is installed.', parameters=parameters, environment={'CMAKE_PREFIX_PATH': '/usr'})


class TestMarkersDoNotOutliveTheNode(gc.OwnNode):
    """What was published of a job is taken back: at the node's end, or else when it is started again."""

    TOPICS = ['scene', 'ground_cutter', 'tool_path', 'executed_path', 'path_error']

    def markers(self, topic):
        """Those that the last message leaves; every message is complete."""
        messages = self.shown[topic]
        if not messages:
            return []
        self.assertEqual(messages[-1].markers[0].action, Marker.DELETEALL)
        return messages[-1].markers[1:]

    def show_job(self, client):
        client.make_ready(0.1)
        client.send(gc.paper(clearance=1 * MM)).wait_in_stroke(0)
        gc.poll(lambda: all(self.markers(topic) for topic in self.TOPICS), 'the job in rviz')

    def check_taken_back(self, *scene):
        """Nothing is left but these in the scene."""
        gc.poll(lambda: {m.ns for m in self.markers('scene')} == set(scene), 'the scene without a job')
        gc.poll(lambda: not any(self.markers(topic) for topic in self.TOPICS[1:]), 'nothing else in rviz')

    def test_restart_after_a_kill_and_an_orderly_end(self):
        self.start(gc.machine(pace=2))
        self.shown = {topic: gc.received(self.addCleanup, '/%s/%s' % (self.node.name, topic), MarkerArray) for topic in self.TOPICS}
        self.show_job(self.client)
        self.node.end(signal.SIGKILL)
        self.client.close()
        self.node.close()
        self.assertTrue(all(self.markers(topic) for topic in self.TOPICS))
        again = gc.NodeProcess(self.node.name, gc.machine(pace=2))
        self.addCleanup(again.close)
        self.check_taken_back('wheel', 'blank')  # the first view's
        client = again.client()
        self.addCleanup(client.close)
        self.show_job(client)
        self.assertEqual(again.end(signal.SIGTERM), 0, again.output)
        self.check_taken_back()


class TestFaults(gc.OwnNode):
    def test_are_logged_with_their_job_or_without_one_and_a_drive_that_hangs_does_not_keep_the_process(self):
        g = self.start(gc.machine(pace=5))
        g.make_ready()
        g.inject('emergency_stop')
        g.wait_state(GrinderState.FAULT)
        alone, of_job = 'fault without a job: emergency stop', 'goal aborted: emergency stop'
        gc.poll(lambda: alone in self.node.output, 'the fault in the log')
        g.make_ready(0.02)
        run = g.send(gc.paper(clearance=1 * MM)).wait_past(lambda s: s.move == STROKE, 'the stroke')
        g.inject('emergency_stop')
        run.wait_complete()
        gc.poll(lambda: of_job in self.node.output, 'the end of the job in the log')
        self.assertEqual([self.node.output.count(text) for text in (alone, of_job)], [1, 1])
        g.make_ready()
        g.inject('hang')
        g.wait_state(GrinderState.FAULT)
        self.assertEqual(self.node.end(signal.SIGTERM), 1)
        self.assertIn("the process ends without the return of the drive's read(), write() or wait()", self.node.output)


class TestMemory(gc.OwnNode):
    """All that the control loop touches is resident and locked, whatever the machine does; and it does not take much."""

    # 10 teeth in 20 passes, and one with which a test is over soon.
    TOOL = gc.paper(tooth_angles=[i * 36 * DEG for i in range(10)], infeed=0.025 * MM, clearance=1 * MM)
    SHORT_TOOL = gc.paper(tooth_angles=[0.0, 170 * DEG], flute_length=5 * MM, feed=1000 * gc.MM_MIN, clearance=1 * MM)

    def memory(self, kind):
        """In bytes."""
        with open('/proc/%d/status' % self.node.process.pid) as status:
            return 1024 * int(re.search(r'(?m)^%s:\s*(\d+) kB' % kind, status.read()).group(1))

    def page_faults(self):
        """Of the loop's thread: those served from memory, and those that waited for a disk."""
        for stat in glob.glob('/proc/%d/task/*/stat' % self.node.process.pid):
            with open(stat) as file:
                _, name, fields = re.split(r'\((.*)\)', file.read())
            if name == 'control_loop':
                return [int(fields.split()[i]) for i in (7, 9)]
        raise AssertionError('no thread control_loop')

    def test_loop_meets_no_page_fault_and_little_is_resident(self):
        g = self.start(gc.machine(pace=2))
        if not self.memory('VmLck'):
            self.skipTest('the system does not grant locked memory')
        before = self.page_faults()
        g.make_ready(0.2)
        run = g.send(self.TOOL).wait_in_stroke(1 * MM)
        self.assertLess(self.memory('VmHWM'), 110e6)
        run.cancel()
        run.wait_complete()
        g.wait_state(GrinderState.READY)
        self.assertTrue(g._call('jog_step', JogStep, Y, 1 * MM, 0.01).success)
        g.make_ready(0.03)
        self.assertEqual(g.send(self.TOOL, dry_run=True).wait().status, 'SUCCEEDED')
        run = g.send(self.SHORT_TOOL).wait_past(lambda s: s.move == STROKE, 'the stroke')
        self.assertTrue(g.hold().success)
        g.wait_state(GrinderState.HELD)
        self.assertTrue(g.retract().success)
        g.wait_state(GrinderState.RETRACTED)
        self.assertTrue(g.set_feed_override(1).success)
        self.assertTrue(g.resume().success)
        run.wait_complete()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        g.inject('emergency_stop')
        g.wait_state(GrinderState.FAULT)
        self.assertEqual(self.page_faults(), before)
