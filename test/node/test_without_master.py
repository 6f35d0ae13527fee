#!/usr/bin/env python3
"""Shows that `grind run` stops its job when the master is gone, and what every command says where master, clock or grinder
are missing."""

import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

import rosgraph
import rostest

import grinder_client as gc
from grind_command import PAPER_JOB, RunTest

sys.path.insert(0, gc.package_file('test'))

from free_port import free_port  # noqa: E402


class Master:
    """A ROS master of one's own, with a grinder."""

    def __init__(self, **parameters):
        port = free_port()
        self.environment = {'ROS_MASTER_URI': 'http://127.0.0.1:%d' % port}
        self.log = tempfile.TemporaryFile()
        self.process = self.start(['rosmaster', '--core', '-p', str(port)])
        master = rosgraph.Master('/test_run', self.environment['ROS_MASTER_URI'])
        gc.poll(master.is_online, 'the master')
        for name, value in parameters.items():
            master.setParam('/' + name, value)

    def start(self, arguments):
        return subprocess.Popen(arguments, env=dict(os.environ, **self.environment), stdout=self.log,
                                stderr=subprocess.STDOUT)

    @staticmethod
    def end(process):
        process.kill()
        process.wait()

    def grind(self, *arguments):
        return subprocess.run([gc.program('grind'), *arguments], env=dict(os.environ, **self.environment),
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                              timeout=gc.PATIENCE)


class TestNodeWithoutMaster(unittest.TestCase):
    """The node waits for its master, and a signal ends that."""

    def setUp(self):
        self.port = free_port()
        self.environment = dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:%d' % self.port)
        # Several write to it, each at its end, while it is read.
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.log = open(os.path.join(folder.name, 'log'), 'a+')
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

    def end(self, node, number):
        node.send_signal(number)
        self.assertEqual(node.wait(gc.PATIENCE), 0, self.output())

    def check_signals(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                self.end(self.start_waiting(), number)
            self.log.truncate(0)

    def test_signals_where_nothing_listens(self):
        self.check_signals()

    def test_signals_where_nothing_answers(self):
        with socket.socket() as silent:
            silent.bind(('127.0.0.1', self.port))
            silent.listen()
            self.check_signals()

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
    def start_master(self, **parameters):
        self.master = Master(**parameters)
        self.addCleanup(self.master.log.close)
        self.addCleanup(self.master.end, self.master.process)

    def start_grinder(self, **parameters):
        with open(gc.package_file('urdf/grinder.urdf')) as urdf:
            self.start_master(grinder=dict(gc.machine(), journal=os.path.join(self.folder, 'journal'),
                                           offsets=os.path.join(self.folder, 'offsets'),
                                           history=os.path.join(self.folder, 'history')),
                              robot_description=urdf.read(), **parameters)
        node = self.master.start([gc.program('grinder')])
        self.addCleanup(self.master.end, node)
        gc.poll(lambda: self.master.grind('status').returncode == 0, 'the grinder')

    def start_run(self):
        self.start_grinder()
        for words in (['enable'], ['confirm-swivel', '31.769']):
            done = self.master.grind(*words)
            self.assertEqual(done.returncode, 0, done.stderr)
        command = self.grind('run', PAPER_JOB, '--ignore-offset-check', environment=self.master.environment)
        command.wait_text('  running  ')
        self.master.end(self.master.process)
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
        self.start_master()
        self.master.end(self.master.process)
        missing = 'no ROS master answers at %s; ' % re.escape(self.master.environment['ROS_MASTER_URI'])
        self.check_all_say('^%swaiting for one\n%slaunch the grinder, or correct ROS_MASTER_URI\n$' % (missing, missing))

    def test_commands_say_that_the_grinder_is_missing(self):
        self.start_master()
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
        command = self.grind('run', '--dry-run', PAPER_JOB, environment=self.master.environment)
        self.assertEqual(command.end(), 0, command.text)
        self.assertRegex(self.master.grind('status').stdout, r'(?m)^state +ready$')
        self.assertEqual(self.master.grind('disable').returncode, 0)


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'without_master', '__main__')
