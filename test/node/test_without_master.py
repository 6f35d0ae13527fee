#!/usr/bin/env python3
"""Shows that `grind run` stops its job when the master is gone, and what every command says where master, clock or grinder are missing;
and that the node outlives its master, and is found by everybody under the next one: topics, services and the action, without being
started anew. The masters are the test's own."""

import contextlib
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import unittest
import xmlrpc.client

import rosgraph
import rostest

import grinder_client as gc
from grind_command import PAPER_JOB, RunTest

sys.path.insert(0, gc.package_file('test'))

from free_port import free_port  # noqa: E402

NODE = '/grinder'
CALLER = '/test_without_master'
CANCEL = NODE + '/grind/cancel'


def wait_for(condition, what):
    """Waits until a condition holds; a master that does not answer yet counts as no."""

    def holds():
        with contextlib.suppress(OSError, rosgraph.MasterException):
            return condition()

    gc.poll(holds, what, interval=0.02)


class Master:
    """A ROS master of one's own, and programs under it."""

    def __init__(self, **parameters):
        self.port = free_port()
        self.environment = {'ROS_MASTER_URI': 'http://127.0.0.1:%d' % self.port}
        self.log = tempfile.TemporaryFile()
        self.api = rosgraph.Master(CALLER, self.environment['ROS_MASTER_URI'])
        self.process = None
        self.run()
        for name, value in parameters.items():
            self.api.setParam('/' + name, value)

    @classmethod
    def of_grinder(cls, folder, **parameters):
        """With the parameters of a grinder, which keeps its files in a folder."""
        files = {name: os.path.join(folder, name) for name in ('journal', 'offsets', 'history')}
        files['tolerances'] = gc.package_file('config/tolerances.yaml')
        with open(gc.package_file('urdf/grinder.urdf')) as urdf:
            return cls(grinder=dict(gc.machine(), **files), robot_description=urdf.read(), **parameters)

    def run(self):
        """Starts the master, again if it could not have the port, until it answers."""

        def answers():
            if self.process is None or self.process.poll() is not None:
                self.process = self.start(['rosmaster', '--core', '-p', str(self.port)])
            return self.api.getPid()

        wait_for(answers, 'master')

    def start(self, arguments):
        return subprocess.Popen(arguments, env=dict(os.environ, **self.environment), stdout=self.log,
                                stderr=subprocess.STDOUT)

    @staticmethod
    def end(process):
        process.kill()
        process.wait()

    def kill(self):
        self.end(self.process)

    def close(self):
        self.kill()
        self.log.close()

    def grind(self, *arguments):
        return gc.grind(*arguments, environment=self.environment)


class TestNodeWithoutMaster(unittest.TestCase):
    """The node waits for its master, and a signal ends that."""

    def setUp(self):
        self.port = free_port()
        self.environment = dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:%d' % self.port)
        # Several write to it, each at its end, while it is read.
        self.log = open(os.path.join(gc.temp_folder(self.addCleanup), 'log'), 'a+')
        self.addCleanup(self.log.close)

    def start(self, arguments):
        process = subprocess.Popen(arguments, env=self.environment, stdout=self.log, stderr=subprocess.STDOUT)
        self.addCleanup(Master.end, process)
        return process

    def start_waiting(self):
        node = self.start([gc.program('grinder')])
        text = 'no ROS master answers at %s; waiting for one' % self.environment['ROS_MASTER_URI']
        gc.poll(lambda: text in self.output(), 'the message')
        return node

    def output(self):
        self.log.seek(0)
        return self.log.read()

    def check_signal(self, number):
        node = self.start_waiting()
        node.send_signal(number)
        self.assertEqual(node.wait(gc.PATIENCE), 0, self.output())
        self.log.truncate(0)

    def test_signals_where_nothing_listens_and_where_nothing_answers(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                self.check_signal(number)
        with socket.socket() as silent:
            silent.bind(('127.0.0.1', self.port))
            silent.listen()
            self.check_signal(signal.SIGTERM)

    def test_address_that_would_open_all_ports_is_refused(self):
        self.environment['ROS_HOSTNAME'] = '0.0.0.0'
        self.assertEqual(self.start([gc.program('grinder')]).wait(gc.PATIENCE), 1)
        self.assertIn('ROS_HOSTNAME = 0.0.0.0 is every address; allowed: ', self.output())

    def test_goes_on_with_the_master(self):
        node = self.start_waiting()
        self.start(['rosmaster', '--core', '-p', str(self.port)])
        # It has no parameters, which is as far as it comes without.
        self.assertEqual(node.wait(gc.PATIENCE), 1)
        self.assertIn('parameter /robot_description is missing', self.output())


class TestWithoutMaster(RunTest):
    def use(self, master):
        self.master = master
        self.addCleanup(master.close)

    def start_grinder(self, **parameters):
        self.use(Master.of_grinder(self.folder, **parameters))
        node = self.master.start([gc.program('grinder')])
        self.addCleanup(self.master.end, node)
        gc.poll(lambda: self.master.grind('status').returncode == 0, 'the grinder')

    def start_run(self):
        self.start_grinder()
        for words in (['enable'], ['confirm-swivel', '31.769']):
            done = self.master.grind(*words)
            self.assertEqual(done.returncode, 0, done.stderr)
        command = self.grind('run', PAPER_JOB, '--answer', 'ignore-offsets', environment=self.master.environment)
        command.wait_text('  running  ')
        self.master.kill()
        return command

    def test_ctrl_z_holds_and_ctrl_c_stops_the_job_when_the_master_is_gone(self):
        command = self.start_run()
        command.send(signal.SIGTSTP)
        command.wait_text('  held  ')
        command.send(signal.SIGINT)
        self.assertEqual(command.end(), 1)
        self.assertRegex(command.text, r'canceled; stopped on the path \(.*\(code -11\)\n$')
        self.assertRegex(command.stdout, r'(?m)^streamed +\d+ setpoints in \S+ s, 0 missed$')

    def test_commands_say_that_the_master_is_missing(self):
        self.use(Master())
        self.master.kill()
        missing = 'no ROS master answers at %s; ' % re.escape(self.master.environment['ROS_MASTER_URI'])
        self.check_all_say('^%swaiting for one\n%slaunch the grinder, or correct ROS_MASTER_URI\n$' % (missing, missing))

    def test_commands_say_that_the_grinder_is_missing(self):
        self.use(Master())
        left = rosgraph.Master('/left/grinder', self.master.environment['ROS_MASTER_URI'])
        for topic, kind in (('state', 'GrinderState'), ('offsets', 'WorkOffsets')):
            left.registerPublisher('/left/grinder/' + topic, 'flute_grinder/' + kind, 'http://127.0.0.1:1')
        hung = self.grind('--node', 'left/grinder', 'status', environment=self.master.environment)
        self.check_all_say('^no grinder answers as /grinder; the ROS master knows /left/grinder: name one with --node\n$')
        self.assertIsNone(hung.process.poll(), 'only a grinder that the master knows is waited for')
        self.assertEqual(hung.end(), 1)
        self.assertEqual(hung.text, 'no grinder answers as /left/grinder\n')

    def check_all_say(self, text):
        commands = [self.grind(*words.split(), environment=self.master.environment)
                    for words in ('status', 'hold', 'cancel', 'disable', 'home', 'lift', 'override 50', 'confirm-swivel 5',
                                  'run ' + PAPER_JOB)]
        for command in commands:
            self.assertEqual(command.end(), 1)
            self.assertRegex(command.text, text)

    def test_a_simulation_without_a_clock_changes_nothing(self):
        self.start_grinder(use_sim_time=True)
        self.assertEqual(self.master.grind('enable').returncode, 0)
        dry_run = self.master.grind('run', '--dry-run', PAPER_JOB)
        self.assertEqual(dry_run.returncode, 0, dry_run.stderr)


class TestMasterWatch(unittest.TestCase):
    """The node outlives its master, and is found under the next one."""

    def setUp(self):
        folder = gc.temp_folder(self.addCleanup)
        self.master = Master.of_grinder(folder)
        self.addCleanup(self.master.close)
        self.api = self.master.api
        self.node = self.start(gc.program('grinder'), '__name:=' + NODE[1:])
        # The action's goals and then its cancels are what it registers last.
        wait_for(lambda: {NODE + '/grind/goal', NODE + '/grind/cancel'} <= self.registered()['subscribers'] and
                 self.api.lookupService(NODE + '/set_offsets'), 'node as it is once it has started')
        self.node_api = xmlrpc.client.ServerProxy(self.api.lookupNode(NODE))

    def start(self, *command):
        process = self.master.start(command)
        self.addCleanup(Master.end, process)
        return process

    def registered(self):
        """What the master says that the node publishes, subscribes to and serves."""
        kinds = zip(('publishers', 'subscribers', 'services'), self.api.getSystemState())
        return {kind: {name for name, nodes in entries if NODE in nodes} for kind, entries in kinds}

    def publishers_at_node(self):
        """URIs of the publishers of cancels from which the node has a connection."""
        return [c[1] for c in self.node_api.getBusInfo(CALLER)[2] if c[2] == 'i' and c[4] == CANCEL]

    def grind(self, *arguments):
        call = self.master.grind(*arguments)
        self.assertEqual(call.returncode, 0, call.stdout + call.stderr)
        return call.stdout

    def test_everything_is_found_under_the_next_master(self):
        before = self.registered()
        self.assertIn(NODE + '/state', before['publishers'])
        self.assertIn(NODE + '/grind/goal', before['subscribers'])
        self.assertIn(NODE + '/hold', before['services'])
        self.master.kill()
        self.master.run()
        # The node looks for another master once a second.
        self.grind('disable')
        wait_for(lambda: self.registered() == before, 'node as it was under the master before')
        self.assertIn('disabled', self.grind('status'))
        self.grind('enable')
        # A client whose goals the node gets by a connection that it makes now.
        self.grind('run', '--dry-run', PAPER_JOB)

    def test_publishers_of_the_old_master_and_of_the_next_are_heard(self):
        def publish():
            self.start('rostopic', 'pub', CANCEL, 'actionlib_msgs/GoalID', '{}')

        publish()
        wait_for(lambda: len(self.publishers_at_node()) == 1, 'publisher')
        old = self.publishers_at_node()
        # The other publisher is there before the node has found the next master. The old one will not look for it.
        self.node.send_signal(signal.SIGSTOP)
        self.master.kill()
        self.master.run()
        publish()
        wait_for(lambda: CANCEL in dict(self.api.getSystemState()[0]), 'second publisher')
        self.node.send_signal(signal.SIGCONT)
        wait_for(lambda: len(self.publishers_at_node()) == 2, 'second connection beside the first')
        self.assertLess(set(old), set(self.publishers_at_node()))

    def test_a_node_that_the_master_has_forgotten_comes_back_and_ends_without_one(self):
        before = self.registered()
        uri = self.api.lookupNode(NODE)
        own = rosgraph.Master(NODE, self.master.environment['ROS_MASTER_URI'])
        for topic in before['publishers']:
            own.unregisterPublisher(topic, uri)
        for topic in before['subscribers']:
            own.unregisterSubscriber(topic, uri)
        service_uri = self.api.lookupService(NODE + '/set_offsets')
        for service in before['services']:
            own.unregisterService(service, service_uri)
        wait_for(lambda: self.registered() == before, 'node as it was')
        # And ends without a master as ever.
        self.master.kill()
        self.node.send_signal(signal.SIGTERM)
        self.assertEqual(self.node.wait(timeout=gc.PATIENCE), 0)


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'without_master', '__main__')
