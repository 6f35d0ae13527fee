"""Shows that what another program sends to the node's ports by mistake costs neither the stroke nor more than a little memory."""

import contextlib
import io
import os
import random
import re
import socket
import struct
import time
import unittest
import urllib.parse
import xmlrpc.client

import rosgraph
import roslib.message
from actionlib_msgs.msg import GoalID, GoalStatus
from flute_grinder.msg import GrindActionGoal, GrinderState, GrindResult
from flute_grinder.srv import SetOffset, SetOffsetRequest

import grinder_client as gc
from grinder_client import MM, MM_MIN, X

CALLER = '/peer'
MEGABYTE = 1 << 20
# What the node may take while it is attacked: the buffers of some connections, stacks of threads that it starts anyway.
FEW_MEGABYTES = 24 * MEGABYTE
# As in the source.
LONGEST_MESSAGE = 256 << 10
MEGABYTES_OF_TEETH = 64
EMPTY_MESSAGES = 3000


class Attacked(unittest.TestCase):
    """A node, with the wheel in a stroke that outlasts all attacks of the class."""

    @classmethod
    def setUpClass(cls):
        parameters = gc.machine()
        parameters['hardware'].update({'spindle_run_up_time': 0, 'absolute_encoders': True})
        cls.node = gc.NodeProcess('attacked', parameters)
        cls.addClassCleanup(cls.node.close)
        cls.grinder = cls.node.client()
        cls.addClassCleanup(cls.grinder.close)
        cls.run_ = None
        cls.into_stroke()
        cls.api = urllib.parse.urlparse(rosgraph.Master(CALLER).lookupNode('/attacked'))
        state = cls.proxy().requestTopic(CALLER, '/attacked/state', [['TCPROS']])
        cls.tcpros_port = state[2][2]
        # Reset, so that it reports the most since now.
        with open('/proc/%d/clear_refs' % cls.node.process.pid, 'w') as references:
            references.write('5')
        cls.before = cls.memory()

    def setUp(self):
        self.into_stroke()

    @classmethod
    def into_stroke(cls):
        """Unless it is in one; the stroke takes eight minutes."""
        if cls.run_ is None or cls.run_.done:
            cls.grinder.make_ready()
            cls.run_ = cls.grinder.send(gc.paper(feed=4 * MM_MIN, clearance=0.2 * MM, depth=0.1 * MM, infeed=0.1 * MM))
            cls.run_.wait_in_stroke(-0.99 * MM)

    @classmethod
    def proxy(cls):
        return xmlrpc.client.ServerProxy(cls.api.geturl())

    @classmethod
    def memory(cls):
        """What the node has: the most resident at a time, and all that it may write to, in bytes."""
        with open('/proc/%d/status' % cls.node.process.pid) as status:
            fields = dict(line.split(':', 1) for line in status)
        return {name: int(fields[name].split()[0]) << 10 for name in ('VmHWM', 'VmData')}

    def connect(self, port):
        connection = socket.create_connection(('127.0.0.1', port), timeout=gc.PATIENCE)
        self.addCleanup(connection.close)
        return connection

    def connect_to_service(self):
        connection = gc.connect_to_service('/attacked/set_offset', SetOffset, CALLER)
        self.addCleanup(connection.close)
        return connection

    def is_answered(self):
        """Calls a service over a connection of its own; during a job it refuses."""
        text = io.BytesIO()
        SetOffsetRequest().serialize(text)
        connection = self.connect_to_service()
        connection.sendall(struct.pack('<I', text.tell()) + text.getvalue())
        return gc.receive(connection, 1) == b'\x01'

    def check(self):
        """The stroke goes on, whoever asks anew is answered, and memory is about as before."""
        self.assertEqual(self.proxy().getPid(CALLER)[2], self.node.process.pid)
        self.assertTrue(self.is_answered())
        self.assertEqual(self.grinder.fresh_state().state, GrinderState.RUNNING)
        x = self.run_.last.position[X]
        self.run_.wait_past(lambda s: s.position[X] > x, 'the stroke to go on')
        self.check_memory()

    def check_memory(self):
        after = self.memory()
        for name in after:
            self.assertLess(after[name] - self.before[name], FEW_MEGABYTES, name)


class TestPeers(Attacked):
    def test_datagram_that_nobody_reads(self):
        """roscpp has a port for datagrams, of topics that are not spoken that way."""
        address, = gc.listening(self.node.process.pid, 'udp')
        host, port = address.split(':')
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'x', (host, int(port)))
        begin, used = time.monotonic(), self.processor_time()
        for _ in range(10):
            self.grinder.fresh_state()
        # Of one that watches what it does not read, it is all.
        self.assertLess(self.processor_time() - used, 0.5 * (time.monotonic() - begin))
        self.check()

    def processor_time(self):
        """What all threads of the node have had of a processor [s]."""
        with open('/proc/%d/stat' % self.node.process.pid) as stat:
            fields = stat.read().rpartition(')')[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')

    def test_header_and_request_that_claim_much(self):
        for connect in (lambda: self.connect(self.tcpros_port), self.connect_to_service):
            for size in (300000000, 1000000000, 0xffffffff):
                connect().sendall(struct.pack('<I', size))
            self.check()

    def test_what_follows_a_message_that_is_too_long_arrives(self):
        cancels = gc.publisher(self.addCleanup, '/attacked/grind/cancel', GoalID)
        goals = gc.publisher(self.addCleanup, '/attacked/grind/goal', GrindActionGoal)
        reported = len(self.node.output)
        too_long = 'x' * (LONGEST_MESSAGE + 1)
        cancels.publish(GoalID(id=too_long))
        goals.publish(GrindActionGoal(goal_id=GoalID(id=too_long), goal=gc.goal_of(gc.paper())))
        goal = GrindActionGoal(goal_id=GoalID(id='next'), goal=gc.goal_of(gc.paper()))
        goals.publish(goal)
        self.grinder.wait_for(lambda: [r.result.error_code for r in self.grinder.results if r.status.goal_id.id == 'next'] ==
                              [GrindResult.BUSY], 'the answer to the next goal')
        # Too many teeth, under an id as clients make them.
        many = gc.goal_of(gc.paper(tooth_angles=[i * 1e-7 for i in range(MEGABYTES_OF_TEETH * MEGABYTE // 8)]))
        goals.publish(GrindActionGoal(goal_id=GoalID(id='many'), goal=many))
        answers = lambda: [r for r in self.grinder.results if r.status.goal_id.id == 'many']
        self.grinder.wait_for(answers, 'the answer to a goal that is too long')
        answer, = answers()
        self.assertEqual((answer.status.status, answer.result.error_code), (GoalStatus.REJECTED, GrindResult.INVALID_GOAL))
        self.assertRegex(answer.status.text, r'^a goal of 67\d{6} bytes; allowed: 262144; give fewer teeth$')
        cancels.publish(GoalID())
        self.assertEqual(self.run_.wait().status, 'PREEMPTED')
        self.assertEqual([publisher.get_num_connections() for publisher in (cancels, goals)], [1, 1])
        self.assertEqual(len(re.findall(r'a message of \d+ bytes on /attacked/grind/(?:cancel|goal) is dropped; allowed: 262144',
                                        self.node.output[reported:])), 3)
        self.check_memory()

    def test_messages_of_no_bytes(self):
        """roscpp reads one from freed memory for the second subscription to a topic in a process."""
        master = rosgraph.Master(CALLER)
        types = dict(master.getTopicTypes())
        topics = [topic for topic, nodes in master.getSystemState()[1] if '/attacked' in nodes]
        self.assertLessEqual({'/attacked/' + topic for topic in ('stop', 'jog', 'grind/goal', 'grind/cancel', 'probe/goal', 'probe/cancel',
                                                                 'probe_alive')}, set(topics))
        refused = 'Exception thrown when deserializing message of length [0]'
        for topic in topics:
            empty = type('Empty', (roslib.message.get_message_class(types[topic]),), {'serialize': lambda self, buffer: None})
            publisher = gc.publisher(self.addCleanup, topic, empty, queue_size=EMPTY_MESSAGES)
            before = self.node.output.count(refused)
            for _ in range(EMPTY_MESSAGES):
                publisher.publish(empty())
            gc.poll(lambda: self.node.output.count(refused) > before, 'an empty message to arrive on ' + topic)
            self.check()

    def test_random_bytes(self):
        chance = random.Random(9)
        heads = {self.api.port: [b'', b'POST / HTTP/1.1\r\nContent-length: 200\r\n\r\n',
                                 b'POST / HTTP/1.1\r\nContent-length: 200\r\n\r\n<?xml version="1.0"?><methodCall>'
                                 b'<methodName>requestTopic</methodName><params><param><value><array><data>'],
                 self.tcpros_port: [b'', struct.pack('<I', 200), struct.pack('<II', 200, 20)]}
        for i in range(200):
            port = (self.api.port, self.tcpros_port)[i % 2]
            connection = self.connect(port)
            with contextlib.suppress(ConnectionError):
                connection.sendall(chance.choice(heads[port]) + bytes(chance.choices(range(256), k=chance.randrange(600))))
            connection.close()
        self.check()


class TestManyConnections(Attacked):
    def test_client_that_leaks_connections(self):
        connections = [self.connect(self.tcpros_port) for _ in range(600)]
        for connection in connections:
            connection.setblocking(False)

        def refused(connection):
            try:
                return connection.recv(1) == b''
            except BlockingIOError:
                return False
            except ConnectionError:
                return True

        gc.poll(lambda: sum(map(refused, connections)) > 80, 'connections that are refused', interval=0.1)
        # Whoever is connected is served, and the node can open its files.
        self.run_.cancel()
        self.assertEqual(self.run_.wait().status, 'PREEMPTED')
        for connection in connections:
            connection.close()
        gc.poll(lambda: self.descriptors() < 100, 'the end of the connections', interval=0.1)
        self.into_stroke()
        self.check()
        for consequence in ('Too many open files', 'no ROS master answers'):
            self.assertNotIn(consequence, self.node.output)

    def descriptors(self):
        return len(os.listdir('/proc/%d/fd' % self.node.process.pid))
