#!/usr/bin/env python3
"""Shows that the node outlives its ROS master, and is found by everybody under the next one: topics, services and the
action, without being started anew. The masters are the test's own."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client

import rosgraph
import rostest

import grinder_client as gc

sys.path.insert(0, gc.package_file('test'))

from free_port import free_port  # noqa: E402

NODE = '/grinder'
CALLER = '/test_master_watch'
CANCEL = NODE + '/grind/cancel'


def wait_for(condition, what):
    """Waits until a condition holds; a master that does not answer yet counts as no."""
    deadline = time.monotonic() + gc.PATIENCE
    while True:
        try:
            if condition():
                return
        except (OSError, rosgraph.MasterException):
            pass
        if time.monotonic() > deadline:
            raise AssertionError('no ' + what)
        time.sleep(0.02)


class TestMasterWatch(unittest.TestCase):

    def setUp(self):
        self.port = free_port()
        self.environment = dict(os.environ, ROS_MASTER_URI='http://127.0.0.1:%d' % self.port)
        self.api = rosgraph.Master(CALLER, self.environment['ROS_MASTER_URI'])
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.master = None
        self.start_master()
        self.addCleanup(lambda: self.master.poll() is not None or self.kill_master())
        parameters = dict(gc.machine(), journal=os.path.join(self.folder, 'journal'),
                          offsets=os.path.join(self.folder, 'offsets'),
                          history=os.path.join(self.folder, 'history'))
        self.api.setParam(NODE, parameters)
        with open(gc.package_file('urdf/grinder.urdf')) as urdf:
            self.api.setParam('/robot_description', urdf.read())
        self.node = self.start(gc.program('grinder'), '__name:=' + NODE[1:])
        # The action's goals are what it registers last.
        wait_for(lambda: NODE + '/grind/goal' in self.registered()['subscribers'] and self.api.lookupService(NODE + '/plan'),
                 'node as it is once it has started')
        self.node_api = xmlrpc.client.ServerProxy(self.api.lookupNode(NODE))

    def start(self, *command):
        process = subprocess.Popen(command, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(lambda: process.poll() is not None or process.kill() or process.wait())
        return process

    def start_master(self):
        """Starts a master, again if it could not have the port, until it answers."""

        def answers():
            if self.master is None or self.master.poll() is not None:
                self.master = subprocess.Popen(['rosmaster', '--core', '-p', str(self.port)], env=self.environment,
                                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            return self.api.getPid()

        wait_for(answers, 'master')

    def kill_master(self):
        self.master.kill()
        self.master.wait()

    def registered(self):
        """What the master says that the node publishes, subscribes to and serves."""
        kinds = zip(('publishers', 'subscribers', 'services'), self.api.getSystemState())
        return {kind: {name for name, nodes in entries if NODE in nodes} for kind, entries in kinds}

    def publishers_at_node(self):
        """URIs of the publishers of cancels from which the node has a connection."""
        return [c[1] for c in self.node_api.getBusInfo(CALLER)[2] if c[2] == 'i' and c[4] == CANCEL]

    def grind(self, *arguments):
        call = subprocess.run([gc.program('grind'), *arguments], env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, universal_newlines=True, timeout=gc.PATIENCE)
        self.assertEqual(call.returncode, 0, call.stdout)
        return call.stdout

    def test_everything_is_found_under_the_next_master(self):
        before = self.registered()
        self.assertIn(NODE + '/state', before['publishers'])
        self.assertIn(NODE + '/grind/goal', before['subscribers'])
        self.assertIn(NODE + '/hold', before['services'])
        self.kill_master()
        self.start_master()
        # The node looks for another master once a second.
        self.grind('disable')
        wait_for(lambda: self.registered() == before, 'node as it was under the master before')
        self.assertIn('disabled', self.grind('status'))
        self.grind('enable')
        # A client whose goals the node gets by a connection that it makes now.
        self.grind('run', '--dry-run', gc.package_file('test/jobs/paper.yaml'))

    def test_publishers_of_the_old_master_and_of_the_next_are_heard(self):
        def publish():
            self.start('rostopic', 'pub', CANCEL, 'actionlib_msgs/GoalID', '{}')

        publish()
        wait_for(lambda: len(self.publishers_at_node()) == 1, 'publisher')
        old = self.publishers_at_node()
        # The other publisher is there before the node has found the next master. The old one will not look for it.
        self.node.send_signal(signal.SIGSTOP)
        self.kill_master()
        self.start_master()
        publish()
        wait_for(lambda: CANCEL in dict(self.api.getSystemState()[0]), 'second publisher')
        self.node.send_signal(signal.SIGCONT)
        wait_for(lambda: len(self.publishers_at_node()) == 2, 'second connection beside the first')
        self.assertLess(set(old), set(self.publishers_at_node()))

    def test_a_node_that_the_master_has_forgotten_comes_back(self):
        before = self.registered()
        uri = self.api.lookupNode(NODE)
        own = rosgraph.Master(NODE, self.environment['ROS_MASTER_URI'])
        for topic in before['publishers']:
            own.unregisterPublisher(topic, uri)
        for topic in before['subscribers']:
            own.unregisterSubscriber(topic, uri)
        service_uri = self.api.lookupService(NODE + '/plan')
        for service in before['services']:
            own.unregisterService(service, service_uri)
        wait_for(lambda: self.registered() == before, 'node as it was')

    def test_without_a_master_the_node_ends_as_ever(self):
        self.kill_master()
        self.node.send_signal(signal.SIGTERM)
        self.assertEqual(self.node.wait(timeout=gc.PATIENCE), 0)


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'master_watch', TestMasterWatch, sys.argv)
