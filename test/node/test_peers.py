"""Shows what a mistake in another program costs: the node lives, is reached, and obeys each kind of stop. Prints how soon, and the
most memory that the node has had, in a row for each mistake."""

import contextlib
import os
import random
import resource
import socket
import struct
import time
import unittest
import urllib.parse
import xmlrpc.client

import genpy
import rosgraph
import roslib.message
import rospy
import rosservice
from actionlib_msgs.msg import GoalID
from flute_grinder.msg import GrindActionGoal, GrinderState, GrindResult, Stop
from roscpp.srv import GetLoggers, SetLoggerLevel

import grinder_client as gc
from grinder_client import MM, MM_MIN, X
from test_journal import quick_machine

CALLER = '/peer'
# The soft limit of a process that nobody has given another.
DESCRIPTORS = 1024
# What a mistake may cost: some copies of a message of 64 MB [MB].
MOST_MEMORY = 256
# The override in a stroke.
SLOW = 0.002

INTEGERS = {'bool': 'B', 'byte': 'b', 'char': 'B', 'int8': 'b', 'uint8': 'B', 'int16': 'h', 'uint16': 'H', 'int32': 'i',
            'uint32': 'I', 'int64': 'q', 'uint64': 'Q'}
FLOATS = {'float32': 'f', 'float64': 'd'}
LARGEST = {'float32': 3.4028234663852886e38, 'float64': 1.7976931348623157e308}
STRINGS = [b'', b'x', b'axis_x', b'a' * 300, b'\xff\xfe\x00\x1b[2J', b'\n' * 50, '\u00e4\U0001f600'.encode(), b'%s%n{}', b'z' * 20000]
MOST_SECONDS, MOST_NANOSECONDS = (1 << 32) - 1, (1 << 32) - 1

# Fields that are not replaced have these values, or the message's own.
ORDINARY = {'flute_grinder/GrindGoal': gc.goal_of(gc.SHORT)}


class Fuzzer:
    """Serialized messages of any type; each field is replaced by one at its extremes with a probability of its own."""

    def __init__(self, seed):
        self.chance = random.Random(seed)
        self.often = 0.0

    def message(self, kind):
        """Of a class of messages."""
        self.often = self.chance.choice((0.05, 0.3, 1.0))
        return self._fields(kind())

    def _fields(self, message):
        message = ORDINARY.get(message._type, message)
        return b''.join(self._field(kind, getattr(message, name)) for name, kind in
                        zip(message.__slots__, message._slot_types))

    def _field(self, kind, value):
        if kind.endswith(']'):
            item, size = kind[:-1].split('[')
            return self._array(item, int(size or 0), value)
        odd = self.chance.random() < self.often
        if kind in INTEGERS:
            return struct.pack('<' + INTEGERS[kind], self._integer(kind) if odd else int(value))
        if kind in FLOATS:
            return struct.pack('<' + FLOATS[kind], self._number(kind) if odd else value)
        if kind == 'string':
            text = self.chance.choice(STRINGS) if odd else value.encode()
            return struct.pack('<I', len(text)) + text
        if kind in ('time', 'duration'):
            return self._time(kind) if odd else struct.pack('<II', *divmod(time.time_ns(), 10 ** 9))
        return self._fields(value)

    def _array(self, kind, size, values):
        odd = self.chance.random() < self.often
        values = list(values) or [roslib.message.get_message_class(kind)() if '/' in kind else '' if kind == 'string' else 0]
        many = 3 if '/' in kind else 50 if kind == 'string' else 1000
        count = size or (self.chance.choice((0, 1, 2, many)) if odd else len(values))
        return (b'' if size else struct.pack('<I', count)) + b''.join(
            self._field(kind, values[i % len(values)]) for i in range(count))

    def _integer(self, kind):
        bits = 8 * struct.calcsize(INTEGERS[kind])
        if INTEGERS[kind].isupper():
            return self.chance.choice((0, 1, 2, 3, (1 << bits) - 1))
        return self.chance.choice((0, 1, -1, -(1 << (bits - 1)), (1 << (bits - 1)) - 1))

    def _number(self, kind):
        return self.chance.choice((float('nan'), float('inf'), -float('inf'), LARGEST[kind], -LARGEST[kind], 0.0, -0.0,
                                   1e-40, 1e-3, -1e-3, 1.0, -1.0, 1e9))

    def _time(self, kind):
        if kind == 'duration':
            return struct.pack('<ii', *(self.chance.choice((0, 1, -(1 << 31), (1 << 31) - 1)) for _ in range(2)))
        return struct.pack('<II', self.chance.choice((0, 1, 5, (1 << 31) - 1, 1 << 31, 4 * 10 ** 9, MOST_SECONDS, MOST_SECONDS)),
                           self.chance.choice((0, 1, 10 ** 9 - 1, 10 ** 9, MOST_NANOSECONDS)))


def random_bytes(chance, length):
    # In Python 3.8 no bits are an error.
    return chance.getrandbits(8 * length).to_bytes(length, 'little') if length else b''


class Noise:
    """Messages of random bytes, of any length or of none."""

    def __init__(self, seed, longest):
        self.chance, self._longest = random.Random(seed), longest

    def message(self, _):
        return random_bytes(self.chance, self.chance.randint(0, self._longest))


class Topic:
    """A topic of the node, with what is published on it as bytes."""

    def __init__(self, name, kind):
        self.name, self._kind = name, kind
        self._message = type('Raw', (genpy.Message,), {
            '__slots__': ['text'], '_slot_types': ['string'], '_type': kind._type, '_md5sum': kind._md5sum,
            '_full_text': kind._full_text, '__init__': lambda self, text=b'': setattr(self, 'text', text),
            'serialize': lambda self, buff: buff.write(self.text)})
        # One after the other: the publisher waits until each is sent.
        self._publisher = rospy.Publisher(name, self._message, queue_size=None, tcp_nodelay=True)
        gc.poll(lambda: self._publisher.get_num_connections() > 0, 'a connection of ' + name)

    def send(self, maker):
        self._publisher.publish(self._message(maker.message(self._kind)))

    def close(self):
        self._publisher.unregister()


class Service:
    """A service of the node, with requests as bytes over one connection."""

    def __init__(self, name):
        self.name, self._kind = name, rosservice.get_service_class_by_name(name)
        self._connection = gc.connect_to_service(name, self._kind, CALLER)

    def send(self, maker):
        text = maker.message(self._kind._request_class)
        self._connection.sendall(struct.pack('<I', len(text)) + text)
        gc.receive(self._connection, 1)
        gc.receive(self._connection, *struct.unpack('<I', gc.receive(self._connection, 4)))

    def close(self):
        self._connection.close()


class TestPeers(unittest.TestCase):
    """A node, with the wheel in a stroke that outlasts what is tried in it."""

    @classmethod
    def setUpClass(cls):
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (DESCRIPTORS, hard))
        cls.node = gc.NodeProcess('attacked', quick_machine())
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
        cls.addClassCleanup(resource.setrlimit, resource.RLIMIT_NOFILE, (soft, hard))
        cls.addClassCleanup(cls.node.close)
        cls.grinder = cls.node.client()
        cls.addClassCleanup(cls.grinder.close)
        cls.run_ = None
        cls.into_stroke()
        address = rosgraph.Master(CALLER).lookupNode('/attacked')
        cls.api, cls.api_port = xmlrpc.client.ServerProxy(address), urllib.parse.urlparse(address).port
        cls.tcpros_port = cls.api.requestTopic(CALLER, '/attacked/state', [['TCPROS']])[2][2]
        cancels = gc.publisher(cls.addClassCleanup, '/attacked/grind/cancel', GoalID)
        stops = gc.publisher(cls.addClassCleanup, '/attacked/stop', Stop)
        cls.stops = {'~hold': cls.grinder.hold, '~stop': lambda: stops.publish(Stop(request=Stop.HOLD)),
                     '~grind/cancel': lambda: cancels.publish(GoalID())}

    @classmethod
    def into_stroke(cls):
        """Unless it is in one; the stroke takes five minutes, and the infeed ahead of it a second."""
        if cls.run_ and not cls.run_.done:
            if cls.grinder.fresh_state().state == GrinderState.HELD:
                assert cls.grinder.resume().success
                cls.grinder.wait_state(GrinderState.RUNNING)
            if cls.grinder.fresh_state().state == GrinderState.RUNNING:
                assert cls.grinder.set_feed_override(SLOW).success
                return
        rest = cls.grinder.make_ready(0.05)
        for axis, work in enumerate(cls.grinder.fresh_state().work_position):
            assert work == rest[axis] or cls.grinder.set_offset(axis, 0.0).success
        cls.run_ = cls.grinder.send(gc.paper(flute_length=2 * MM, feed=400 * MM_MIN, clearance=0.2 * MM, depth=0.1 * MM, infeed=0.1 * MM))
        cls.run_.wait_in_stroke(-0.9 * MM)
        assert cls.grinder.set_feed_override(SLOW).success

    def setUp(self):
        self.into_stroke()
        # Reset, so that it reports the most since now.
        with open('/proc/%d/clear_refs' % self.node.process.pid, 'w') as references:
            references.write('5')

    def memory(self):
        """The most that was resident at a time [MB]."""
        with open('/proc/%d/status' % self.node.process.pid) as status:
            return next(int(line.split()[1]) / 1024 for line in status if line.startswith('VmHWM'))

    def connect(self, port):
        connection = socket.create_connection(('127.0.0.1', port), timeout=gc.PATIENCE)
        self.addCleanup(connection.close)
        return connection

    def end_of_node(self):
        with contextlib.suppress(Exception):
            self.node.process.wait(5)
        return 'exit status %s: %s' % (self.node.process.poll(), self.node.output[-1500:])

    def time_to(self, stop):
        """Until the state says that it is obeyed [s]."""
        begin, seen = time.monotonic(), len(self.grinder.states)
        stop()
        self.grinder.wait_for(lambda: any(s.state != GrinderState.RUNNING for s in self.grinder.states[seen:]), 'the stop')
        return time.monotonic() - begin

    def check(self, mistake, what, goes_on=True):
        """The mistake, made in a stroke ahead of each kind of stop, or of one if it may end the stroke, harms neither."""
        before, took = self.memory(), []
        for name, stop in list(self.stops.items())[:None if goes_on else 1]:
            self.into_stroke()
            x = self.run_.last.position[X]
            mistake()
            self.assertIsNone(self.node.process.poll(), self.node.output[-1500:])
            if goes_on:
                self.run_.wait_past(lambda s, x=x: s.position[X] > x, 'the stroke to go on')
            else:
                self.into_stroke()
            took.append('%s %.2f s' % (name, self.time_to(stop)))
        self.assertEqual(self.api.getPid(CALLER)[2], self.node.process.pid)
        self.assertLess(self.memory() - before, MOST_MEMORY)
        print('%-44s | %3.0f MB, from %3.0f | %s' % (what, self.memory(), before, ', '.join(took)))

    def targets(self):
        """All topics to which the node subscribes, and all services that it serves, as the master lists them."""
        master = rosgraph.Master(CALLER)
        _, subscribers, services = ([name for name, nodes in sorted(book) if '/attacked' in nodes] for book in master.getSystemState())
        types = dict(master.getTopicTypes())
        topics = [Topic(name, roslib.message.get_message_class(types[name])) for name in subscribers]
        found = topics, [Service(name) for name in services]
        for target in sum(found, []):
            self.addCleanup(target.close)
        self.assertLessEqual({'/attacked/' + name for name in ('stop', 'jog', 'grind/goal', 'grind/cancel', 'probe/goal', 'probe/cancel', 'probe_alive',
                                                               'jog_step', 'set_offsets')}, {target.name for target in sum(found, [])})
        return found

    def send(self, maker, targets, messages):
        for i in range(messages):
            target = maker.chance.choice(targets)
            try:
                target.send(maker)
            except (ConnectionError, socket.timeout, rospy.ROSException) as error:
                self.fail('message %d, to %s: %s: %s' % (i, target.name, error, self.end_of_node()))

    def test_messages_of_fields_at_their_extremes_of_random_bytes_and_of_none(self):
        topics, services = self.targets()
        # Among the first two may be stops. Of no bytes, roscpp reads one from freed memory for the second subscription to a topic in a process.
        for maker, targets, messages, what, goes_on in (
                (Fuzzer(23), topics + services, 3000, 'messages and requests with fields at random', False),
                (Noise(9, 600), topics, 2000, 'messages of random bytes', False), (Noise(9, 0), topics, 300, 'empty messages', True)):
            self.check(lambda: self.send(maker, targets, messages), '%d %s' % (messages, what), goes_on)
        self.grinder.make_ready()
        run = self.grinder.run(gc.SHORT)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)

    def test_long_cancel(self):
        cancels = gc.publisher(self.addCleanup, '/attacked/grind/cancel', GoalID)
        self.check(lambda: cancels.publish(GoalID(id='x' * (64 << 20))), 'a cancel of 64 MiB')

    def test_goal_of_too_many_teeth(self):
        goals = gc.publisher(self.addCleanup, '/attacked/grind/goal', GrindActionGoal)
        goal = gc.goal_of(gc.paper(tooth_angles=[i * 1e-7 for i in range(8000000)]))
        self.check(lambda: goals.publish(GrindActionGoal(goal_id=GoalID(id='many'), goal=goal)), 'a goal of 8 million teeth')
        self.grinder.make_ready()
        run = self.grinder.send(goal).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL))
        self.assertRegex(run.text, '^cutter.teeth = 8000000; allowed: ')

    def test_flood_of_goals(self):
        goals = gc.publisher(self.addCleanup, '/attacked/grind/goal', GrindActionGoal, queue_size=None)
        goal = gc.goal_of(gc.paper())

        def flood():
            for _ in range(700):
                goals.publish(GrindActionGoal(goal_id=GoalID(id=str(time.monotonic_ns()), stamp=rospy.Time.now()), goal=goal))

        self.check(flood, '2100 goals')

    def test_connections_left_open(self):
        left = []
        self.check(lambda: left or left.extend(self.connect(self.tcpros_port) for _ in range(1100)), '1100 connections left open')
        for consequence in ('Too many open files', 'no ROS master answers'):
            self.assertNotIn(consequence, self.node.output)

    def test_stray_datagram(self):
        """roscpp has a port for datagrams, of topics that are not spoken that way."""
        address, = gc.listening(self.node.process.pid, 'udp')
        host, port = address.split(':')
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(sender.close)
        self.check(lambda: sender.sendto(b'x', (host, int(port))), 'a stray datagram')
        begin, used = time.monotonic(), self.processor_time()
        for _ in range(10):
            self.grinder.fresh_state()
        share = (self.processor_time() - used) / (time.monotonic() - begin)
        print('of a processor: %.2f' % share)
        # Of one that watches what it does not read, it is all.
        self.assertLess(share, 0.5)

    def processor_time(self):
        """What all threads of the node have had of a processor [s]."""
        with open('/proc/%d/stat' % self.node.process.pid) as stat:
            fields = stat.read().rpartition(')')[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')

    def test_port_scan_and_questions_for_the_loggers(self):
        """What a port scan or a browser sends, and what rqt_logger_level asks for."""
        chance = random.Random(9)

        def scan():
            for i in range(200):
                connection = self.connect((self.api_port, self.tcpros_port)[i % 2])
                with contextlib.suppress(ConnectionError):
                    connection.sendall(chance.choice((b'', b'GET / HTTP/1.1\r\n\r\n', b'POST / HTTP/1.1\r\nContent-length: 200\r\n\r\n')) +
                                       random_bytes(chance, chance.randrange(600)))
                connection.close()
            loggers = rospy.ServiceProxy('/attacked/get_loggers', GetLoggers)().loggers
            self.assertIn('ros.flute_grinder', {logger.name for logger in loggers})
            for logger in ('ros.flute_grinder', 'ros'):
                rospy.ServiceProxy('/attacked/set_logger_level', SetLoggerLevel)(logger, 'info')

        self.check(scan, '600 connections of a port scan, and loggers')
