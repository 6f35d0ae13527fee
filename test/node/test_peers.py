#!/usr/bin/env python3
"""Shows that whatever a peer sends to the node's ports, or answers when the node asks it, costs neither the stroke nor
more than a little memory."""

import contextlib
import glob
import http.server
import io
import os
import random
import re
import resource
import socket
import struct
import threading
import time
import unittest
import urllib.parse
import xmlrpc.client

import rosgraph
import rospy
import rostest
from actionlib_msgs.msg import GoalID, GoalStatus
from flute_grinder.msg import GrindActionGoal, GrinderState, GrindResult
from flute_grinder.srv import Plan, PlanRequest

import grinder_client as gc
from grinder_client import MM, MM_MIN, X

CALLER = '/peer'
MEGABYTE = 1 << 20
# What the node may take while it is attacked: the buffers of some connections, stacks of threads that it starts anyway.
FEW_MEGABYTES = 24 * MEGABYTE
# As in the source.
LONGEST_MESSAGE = 256 << 10


NEST = '<value><array><data>'


def response(value):
    return '<?xml version="1.0"?><methodResponse><params><param>%s</param></params></methodResponse>' % value


def call(method, *values):
    return '<?xml version="1.0"?><methodCall><methodName>%s</methodName><params>%s</params></methodCall>' % (
        method, ''.join('<param>%s</param>' % value for value in values))


def value(of):
    """XML of a Python value."""
    return xmlrpc.client.dumps((of,)).split('<param>')[1].split('</param>')[0].replace('\n', '')


class FakePublisher:
    """Registered at the master for a topic; answers whatever it is asked with the same text."""

    def __init__(self, topic, body):
        self.asked = threading.Event()
        publisher = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self):
                self.rfile.read(int(self.headers['Content-length']))
                with contextlib.suppress(OSError):
                    self.send_response(200)
                    self.send_header('Content-length', str(len(body)))
                    self.end_headers()
                    self.wfile.write(body.encode())
                publisher.asked.set()

            def log_message(self, *_):
                pass

        self._server = http.server.ThreadingHTTPServer(('127.0.0.1', 0), Handler)
        self._server.daemon_threads = True
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        self._topic = topic
        self._uri = 'http://127.0.0.1:%d/' % self._server.server_port
        self._master = rosgraph.Master('/fake_publisher_%d' % self._server.server_port)
        self._master.registerPublisher(topic, GoalID._type, self._uri)

    def close(self):
        self._master.unregisterPublisher(self._topic, self._uri)
        self._server.shutdown()
        self._server.server_close()


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

    def until_closed(self, connection):
        """Reads until the node closes the connection."""
        with contextlib.suppress(ConnectionError):
            while connection.recv(1 << 16):
                pass

    def post(self, body, length=None, close=True):
        """Sends a request, as much of it as the node takes, and waits for the end of the connection."""
        connection = self.connect(self.api.port)
        head = 'POST / HTTP/1.1\r\nHost: grinder\r\n%sContent-length: %s\r\n\r\n' % (
            'Connection: close\r\n' if close else '', len(body) if length is None else length)
        with contextlib.suppress(ConnectionError):
            connection.sendall(head.encode() + body.encode())
        self.until_closed(connection)

    def let_the_api_turn(self):
        """Returns when the thread that serves the API has done all that it had to do before."""
        publisher = FakePublisher('/attacked/grind/cancel', response(value([0, '', 0])))
        self.addCleanup(publisher.close)
        gc.poll(lambda: publisher.asked.is_set() or self.node.process.poll() is not None, 'the node to ask a publisher')
        self.assertIsNone(self.node.process.poll(), self.node.output[-2000:])

    def answer(self, body):
        """Lets a publisher answer the node."""
        publisher = FakePublisher('/attacked/grind/cancel', body)
        self.addCleanup(publisher.close)
        gc.poll(publisher.asked.is_set, 'the node to ask the publisher')

    def service(self, name, kind):
        connection = self.connect(self.tcpros_port)
        connection.sendall(gc.tcpros_header({'service': '/attacked/' + name, 'md5sum': kind._md5sum, 'type': kind._type,
                                             'callerid': CALLER, 'persistent': '1'}))
        length, = struct.unpack('<I', gc.receive(connection, 4))
        gc.receive(connection, length)
        return connection

    def plan(self, teeth):
        """Calls ~plan with one tooth and a claim of so many; returns whether it was taken, and the reply."""
        request = PlanRequest(gc.goal_of(gc.paper()))
        text = io.BytesIO()
        request.serialize(text)
        # The claim is behind fourteen numbers and a choice of the cutter.
        at = 14 * 8 + 1
        text = bytearray(text.getvalue())
        self.assertEqual(struct.unpack_from('<Id', text, at), (1, 0.0))
        struct.pack_into('<I', text, at, teeth)
        connection = self.service('plan', Plan)
        connection.sendall(struct.pack('<I', len(text)) + text)
        good = gc.receive(connection, 1)
        length, = struct.unpack('<I', gc.receive(connection, 4))
        return good == b'\x01', gc.receive(connection, length)

    def check(self, bound=FEW_MEGABYTES):
        """The node has done with what was sent, the stroke goes on, and memory is about as before."""
        self.let_the_api_turn()
        self.check_stroke(bound)

    def check_stroke(self, bound=FEW_MEGABYTES):
        """The stroke goes on, whoever asks anew is answered, and memory is about as before."""
        self.assertEqual(self.proxy().getPid(CALLER)[2], self.node.process.pid)
        self.assertTrue(self.plan(1)[0])
        self.assertEqual(self.grinder.fresh_state().state, GrinderState.RUNNING)
        x = self.run_.last.position[X]
        self.run_.wait_past(lambda s: s.position[X] > x, 'the stroke to go on')
        after = self.memory()
        for name in after:
            self.assertLess(after[name] - self.before[name], bound, name)


class TestPeers(Attacked):
    # The API of the node, XML-RPC.

    def test_call_of_calls(self):
        inner = {'methodName': 'system.multicall', 'params': []}
        self.post(call('system.multicall', value([inner])))
        self.check()

    def test_header_without_end_and_body_of_300_megabytes(self):
        for head in (b'POST / HTTP/1.1\r\n', b'POST / HTTP/1.1\r\nContent-length: 300000000\r\n\r\n'):
            connection = self.connect(self.api.port)
            with contextlib.suppress(ConnectionError):
                connection.sendall(head)
                for _ in range(300):
                    connection.sendall(b'X' * MEGABYTE)
            self.until_closed(connection)
            self.check()

    def test_lengths_that_are_none(self):
        for length in ('300000000', '3000000000', '9223372036854775808', '-1', '-2147483648', 'long', ''):
            connection = self.connect(self.api.port)
            connection.sendall(('POST / HTTP/1.1\r\nContent-length: %s\r\n\r\n' % length).encode())
        self.check()

    def test_datagrams_are_not_spoken(self):
        fields = {'topic': '/attacked/state', 'md5sum': GrinderState._md5sum, 'type': GrinderState._type, 'callerid': CALLER}
        for size in (8, 0, -1, -2147483648, 1 << 30):
            offer = ['UDPROS', xmlrpc.client.Binary(gc.tcpros_header(fields)[4:]), '127.0.0.1', 9, size]
            with contextlib.suppress(OSError, xmlrpc.client.Error):
                self.assertNotEqual(self.proxy().requestTopic(CALLER, '/attacked/state', [offer])[0], 1)
        self.check()

    def test_datagram_that_nobody_reads(self):
        """roscpp has a port for datagrams, of topics that are not spoken that way."""
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'x', ('127.0.0.1', self.datagram_port()))
        begin, used = time.monotonic(), self.processor_time()
        for _ in range(10):
            self.grinder.fresh_state()
        # Of one that watches what it does not read, it is all.
        self.assertLess(self.processor_time() - used, 0.5 * (time.monotonic() - begin))
        self.check()

    def datagram_port(self):
        inodes = set()
        for link in glob.glob('/proc/%d/fd/*' % self.node.process.pid):
            with contextlib.suppress(FileNotFoundError):  # closed meanwhile
                inodes.add(os.readlink(link)[len('socket:['):-1])
        with open('/proc/net/udp') as table:
            lines = [line.split() for line in list(table)[1:]]
        port, = [int(fields[1].split(':')[1], 16) for fields in lines if fields[9] in inodes]
        return port

    def processor_time(self):
        """What all threads of the node have had of a processor [s]."""
        with open('/proc/%d/stat' % self.node.process.pid) as stat:
            fields = stat.read().rpartition(')')[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')

    # Publishers that the node asks, because the master told it to.

    def test_publisher_that_answers_300_megabytes(self):
        self.answer(300 * MEGABYTE * ' ')
        self.check()

    def test_publisher_that_answers_what_is_no_address(self):
        datagrams = ['UDPROS', '127.0.0.1', 9, 1, 1500, xmlrpc.client.Binary(gc.tcpros_header({'topic': '/x'})[4:])]
        for protocol in (0, 'TCPROS', {}, [], [7], ['TCPROS'], ['TCPROS', 1, 2], ['TCPROS', '127.0.0.1', -1],
                         ['UDPROS'], datagrams):
            with self.subTest(protocol=protocol):
                self.answer(response(value([1, '', protocol])))
                self.check()

    # Topics and services, TCPROS.

    def test_header_and_request_that_claim_much(self):
        for connect in (lambda: self.connect(self.tcpros_port), lambda: self.service('plan', Plan)):
            for size in (300000000, 1000000000, 0xffffffff):
                connect().sendall(struct.pack('<I', size))
            self.check()

    def test_request_that_claims_many_teeth(self):
        self.assertTrue(self.plan(1)[0])
        # The last two are no bytes at all, counted in 32 bits, and 8.
        for teeth in (1 << 25, 1 << 28, 1 << 29, (1 << 29) + 1):
            good, reply = self.plan(teeth)
            self.assertFalse(good)
            self.assertIn(b'Buffer Overrun', reply)
        self.check()

    def test_message_that_claims_much(self):
        """From a publisher: goals that claim many teeth, then one that claims to be long itself."""
        claims = (300000000, 1000000000, 0xffffffff)
        listener = socket.create_server(('127.0.0.1', 0))
        self.addCleanup(listener.close)
        publisher = FakePublisher('/attacked/grind/cancel',
                                  response(value([1, '', ['TCPROS', '127.0.0.1', listener.getsockname()[1]]])))
        self.addCleanup(publisher.close)
        listener.settimeout(gc.PATIENCE)
        connection, _ = listener.accept()
        self.addCleanup(connection.close)
        length, = struct.unpack('<I', gc.receive(connection, 4))
        gc.receive(connection, length)
        connection.sendall(gc.tcpros_header({'md5sum': GoalID._md5sum, 'type': GoalID._type, 'callerid': '/fake',
                                             'topic': '/attacked/grind/cancel', 'latching': '0'}))
        connection.sendall(struct.pack('<I', claims[0]))
        connection.settimeout(2)
        with contextlib.suppress(socket.timeout):
            self.assertEqual(connection.recv(1), b'', 'the connection is still open')
        self.check()

    def test_what_follows_a_message_that_is_too_long_arrives(self):
        cancels, goals = (self.publisher('/attacked/grind/' + name, kind) for name, kind in
                          (('cancel', GoalID), ('goal', GrindActionGoal)))
        reported = len(self.node.output)
        too_long = 'x' * (LONGEST_MESSAGE + 1)
        cancels.publish(GoalID(id=too_long))
        goals.publish(GrindActionGoal(goal_id=GoalID(id=too_long), goal=gc.goal_of(gc.paper())))
        goal = GrindActionGoal(goal_id=GoalID(id='next'), goal=gc.goal_of(gc.paper()))
        goals.publish(goal)
        self.grinder.wait_for(lambda: [r.result.error_code for r in self.grinder.results if r.status.goal_id.id == 'next'] ==
                              [GrindResult.BUSY], 'the answer to the next goal')
        # Too many teeth, under an id as clients make them.
        many = gc.goal_of(gc.paper(tooth_angles=[i * 1e-5 for i in range(LONGEST_MESSAGE // 8 + 1)]))
        goals.publish(GrindActionGoal(goal_id=GoalID(id='many'), goal=many))
        answers = lambda: [r for r in self.grinder.results if r.status.goal_id.id == 'many']
        self.grinder.wait_for(answers, 'the answer to a goal that is too long')
        answer, = answers()
        self.assertEqual((answer.status.status, answer.result.error_code), (GoalStatus.REJECTED, GrindResult.INVALID_GOAL))
        self.assertRegex(answer.status.text, r'^a goal of 26\d{4} bytes; allowed: 262144; give fewer teeth$')
        cancels.publish(GoalID())
        self.assertEqual(self.run_.wait().status, 'PREEMPTED')
        self.assertEqual([publisher.get_num_connections() for publisher in (cancels, goals)], [1, 1])
        self.assertEqual(len(re.findall(r'a message of \d+ bytes on /attacked/grind/(?:cancel|goal) is dropped; allowed: 262144',
                                        self.node.output[reported:])), 3)

    def publisher(self, topic, kind):
        publisher = rospy.Publisher(topic, kind, queue_size=10, tcp_nodelay=True)
        self.addCleanup(publisher.unregister)
        gc.poll(lambda: publisher.get_num_connections() > 0, 'a connection')
        return publisher

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
    """Each claims as much as it may: more memory than other attacks."""

    def test_more_connections_than_allowed(self):
        connections = [self.connect(self.tcpros_port) for _ in range(600)]
        for connection in connections:
            with contextlib.suppress(ConnectionError):
                connection.sendall(struct.pack('<I', LONGEST_MESSAGE))
            connection.setblocking(False)

        def refused(connection):
            try:
                return connection.recv(1) == b''
            except BlockingIOError:
                return False
            except ConnectionError:
                return True

        gc.poll(lambda: sum(map(refused, connections)) > 80, 'connections that are refused', interval=0.1)
        for connection in connections:
            connection.close()
        self.check(LONGEST_MESSAGE * 512)


class TestManyPublishers(Attacked):
    """Each is asked over a connection of its own, and none answers: the node has these left to ask."""

    def test_more_publishers_than_connections(self):
        silent = socket.create_server(('127.0.0.1', 0), backlog=4096)
        self.addCleanup(silent.close)
        uris = ['http://127.0.0.1:%d/%d' % (silent.getsockname()[1], i) for i in range(600)]
        self.proxy().publisherUpdate(CALLER, '/attacked/grind/cancel', uris)
        self.assertLess(len(os.listdir('/proc/%d/fd' % self.node.process.pid)), 300)
        self.check_stroke()


class TestNesting(Attacked):
    """A text that is not too long, on threads with a stack that it would not fit on."""

    @classmethod
    def setUpClass(cls):
        # The size that the node's threads get.
        soft, hard = resource.getrlimit(resource.RLIMIT_STACK)
        resource.setrlimit(resource.RLIMIT_STACK, (MEGABYTE, hard))
        cls.addClassCleanup(resource.setrlimit, resource.RLIMIT_STACK, (soft, hard))
        super().setUpClass()

    def test_request(self):
        self.post(call('getPid', NEST * (LONGEST_MESSAGE // len(NEST) - 10)))
        self.check()

    def test_answer(self):
        self.answer(response(NEST * (LONGEST_MESSAGE // len(NEST) - 10)))
        self.check()


if __name__ == '__main__':
    rospy.init_node('test_peers')
    rostest.rosrun('flute_grinder', 'peers', '__main__')
