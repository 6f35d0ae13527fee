"""Shows that no message ends the node: every topic that it subscribes to and every service that it serves, as the master
lists them, gets messages with each field at its extremes; afterwards a job runs."""

import contextlib
import random
import re
import socket
import struct
import time
import unittest

import genpy
import rosgraph
import roslib.message
import rospy
import rosservice

import grinder_client as gc

MESSAGES = 20000
SEED = 23
CALLER = '/fuzz'

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
        return self._fields(ORDINARY.get(kind._type, kind()))

    def _fields(self, message):
        message = ORDINARY.get(message._type, message)
        return b''.join(self._field(kind, getattr(message, name)) for name, kind in
                        zip(message.__slots__, message._slot_types))

    def _field(self, kind, value):
        array = re.fullmatch(r'(.*)\[(\d*)\]', kind)
        if array:
            return self._array(array.group(1), int(array.group(2) or 0), value)
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
        count = size or (self.chance.choice((0, 1, 2, 3 if '/' in kind else 1000)) if odd else len(values))
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


class Topic:
    """A topic of the node, with what is published on it as bytes."""

    def __init__(self, name, kind, fuzzer):
        self.name, self._kind, self._fuzzer = name, kind, fuzzer
        raw = type('Raw', (genpy.Message,), {
            '__slots__': ['text'], '_slot_types': ['string'], '_type': kind._type, '_md5sum': kind._md5sum,
            '_full_text': kind._full_text, '__init__': lambda self, text=b'': setattr(self, 'text', text),
            'serialize': lambda self, buff: buff.write(self.text)})
        # One after the other: the publisher waits until each is sent.
        self._publisher = rospy.Publisher(name, raw, queue_size=None, tcp_nodelay=True)
        self._message = raw

    def connected(self):
        return self._publisher.get_num_connections() > 0

    def send(self):
        self._publisher.publish(self._message(self._fuzzer.message(self._kind)))

    def close(self):
        self._publisher.unregister()


class Service:
    """A service of the node, with requests as bytes over one connection."""

    def __init__(self, name, kind, fuzzer):
        self.name, self._kind, self._fuzzer = name, kind, fuzzer
        self._connection = gc.connect_to_service(name, kind, CALLER)

    def send(self):
        text = self._fuzzer.message(self._kind._request_class)
        self._connection.sendall(struct.pack('<I', len(text)) + text)
        gc.receive(self._connection, 1)
        gc.receive(self._connection, *struct.unpack('<I', gc.receive(self._connection, 4)))

    def close(self):
        self._connection.close()


class TestFuzz(unittest.TestCase):
    def setUp(self):
        self.node = gc.NodeProcess('fuzzed', gc.machine())
        self.addCleanup(self.node.close)
        self.client = self.node.client()
        self.addCleanup(self.client.close)
        self.client.make_ready()

    def targets(self, fuzzer):
        """All topics and services of the node, as the master lists them."""
        master = rosgraph.Master(CALLER)
        _, subscribers, services = master.getSystemState()
        types = dict(master.getTopicTypes())
        found = [Topic(name, roslib.message.get_message_class(types[name]), fuzzer)
                 for name, nodes in sorted(subscribers) if '/fuzzed' in nodes]
        found += [Service(name, rosservice.get_service_class_by_name(name), fuzzer)
                  for name, nodes in sorted(services) if '/fuzzed' in nodes]
        for target in found:
            self.addCleanup(target.close)
        return found

    def test_no_message_ends_the_node(self):
        fuzzer = Fuzzer(SEED)
        targets = self.targets(fuzzer)
        topics = [target for target in targets if isinstance(target, Topic)]
        names = {target.name for target in targets}
        self.assertLessEqual({'/fuzzed/jog', '/fuzzed/grind/goal', '/fuzzed/grind/cancel', '/fuzzed/stop',
                              '/fuzzed/jog_step', '/fuzzed/set_offset'}, names)
        gc.poll(lambda: all(topic.connected() for topic in topics), 'connections of the topics')
        for i in range(MESSAGES):
            target = fuzzer.chance.choice(targets)
            try:
                target.send()
            except (ConnectionError, socket.timeout, rospy.ROSException) as error:
                self.fail('message %d, to %s: %s: %s' % (i, target.name, error, self.end_of_node()))
        self.assertIsNone(self.node.process.poll(), self.end_of_node())
        self.check_job()

    def end_of_node(self):
        with contextlib.suppress(Exception):
            self.node.process.wait(5)
        return 'exit status %s: %s' % (self.node.process.poll(), self.node.output[-1500:])

    def check_job(self):
        self.client.make_ready()
        for axis in range(4):
            self.assertTrue(self.client.set_offset(axis, 0.0).success)
        run = self.client.run(gc.SHORT)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
