"""Shows what a mistake in another program costs: the node lives, is reached, and obeys each kind of stop. Prints how soon, and the
most memory that the node has had, in a row for each mistake."""

import contextlib
import os
import random
import resource
import socket
import time
import unittest
import urllib.parse
import xmlrpc.client

import rosgraph
import roslib.message
import rospy
from actionlib_msgs.msg import GoalID
from flute_grinder.msg import GrindActionGoal, GrinderState, GrindResult, Stop
from roscpp.srv import GetLoggers, SetLoggerLevel

import grinder_client as gc
import test_fuzz
from grinder_client import MM, MM_MIN, X

CALLER = '/peer'
MESSAGES = 20000
# The soft limit of a process that nobody has given another.
DESCRIPTORS = 1024
# What a mistake may cost: some copies of a message of 64 MB [MB].
MOST_MEMORY = 256


class Noise:
    """Messages of random bytes, of any length or of none."""

    def __init__(self, seed, longest):
        self.chance, self._longest = random.Random(seed), longest

    def message(self, _):
        return bytes(self.chance.choices(range(256), k=self.chance.randint(0, self._longest)))


class TestPeers(unittest.TestCase):
    """A node, with the wheel in a stroke that outlasts what is tried in it."""

    @classmethod
    def setUpClass(cls):
        parameters = gc.machine()
        parameters['hardware'].update({'spindle_run_up_time': 0, 'absolute_encoders': True})
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        resource.setrlimit(resource.RLIMIT_NOFILE, (DESCRIPTORS, hard))
        cls.node = gc.NodeProcess('attacked', parameters)
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
        cls.stops = {'~hold': cls.grinder.hold, '~grind/cancel': lambda: cancels.publish(GoalID()),
                     '~stop': lambda: stops.publish(Stop(request=Stop.HOLD))}

    @classmethod
    def into_stroke(cls):
        """Unless it is in one; the stroke takes eight minutes."""
        if cls.run_ and not cls.run_.done:
            if cls.grinder.fresh_state().state == GrinderState.HELD:
                assert cls.grinder.resume().success
                cls.grinder.wait_state(GrinderState.RUNNING)
            if cls.grinder.fresh_state().state == GrinderState.RUNNING:
                return
        cls.grinder.make_ready()
        cls.run_ = cls.grinder.send(gc.paper(feed=4 * MM_MIN, clearance=0.2 * MM, depth=0.1 * MM, infeed=0.1 * MM))
        cls.run_.wait_in_stroke(-0.99 * MM)

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

    def time_to(self, stop):
        """Until the state says that it is obeyed [s]."""
        begin, seen = time.monotonic(), len(self.grinder.states)
        stop()
        self.grinder.wait_for(lambda: any(s.state != GrinderState.RUNNING for s in self.grinder.states[seen:]), 'the stop')
        return time.monotonic() - begin

    def check(self, mistake, what, goes_on=True):
        """The mistake, made in a stroke ahead of each kind of stop, harms neither."""
        before, took = self.memory(), []
        for name, stop in self.stops.items():
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

    def topics(self, maker):
        """All topics to which the node subscribes, with publishers of bytes."""
        master = rosgraph.Master(CALLER)
        types = dict(master.getTopicTypes())
        found = [test_fuzz.Topic(name, roslib.message.get_message_class(types[name]), maker)
                 for name, nodes in master.getSystemState()[1] if '/attacked' in nodes]
        self.assertLessEqual({'/attacked/' + topic for topic in ('stop', 'jog', 'grind/goal', 'grind/cancel', 'probe/goal', 'probe/cancel',
                                                                 'probe_alive')}, {topic.name for topic in found})
        for topic in found:
            self.addCleanup(topic.close)
            gc.poll(topic.connected, 'a connection of ' + topic.name)
        return found

    def send_to_all(self, maker):
        topics = self.topics(maker)

        def send():
            for _ in range(MESSAGES // len(self.stops)):
                maker.chance.choice(topics).send()

        return send

    def test_messages_with_fields_at_their_extremes(self):
        """Among them are stops."""
        self.check(self.send_to_all(test_fuzz.Fuzzer(9)), '20,000 messages with fields at random', goes_on=False)

    def test_messages_of_random_bytes(self):
        """The shortest may be stops."""
        self.check(self.send_to_all(Noise(9, 600)), '20,000 messages of random bytes', goes_on=False)

    def test_messages_of_no_bytes(self):
        """roscpp reads one from freed memory for the second subscription to a topic in a process."""
        self.check(self.send_to_all(Noise(9, 0)), '20,000 empty messages')

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
            for _ in range(2000):
                goals.publish(GrindActionGoal(goal_id=GoalID(id=str(time.monotonic_ns()), stamp=rospy.Time.now()), goal=goal))

        self.check(flood, '2000 goals')

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

    def test_strange_bytes(self):
        """What a port scan or a browser sends."""
        chance = random.Random(9)

        def scan():
            for i in range(200):
                connection = self.connect((self.api_port, self.tcpros_port)[i % 2])
                with contextlib.suppress(ConnectionError):
                    connection.sendall(chance.choice((b'', b'GET / HTTP/1.1\r\n\r\n', b'POST / HTTP/1.1\r\nContent-length: 200\r\n\r\n')) +
                                       bytes(chance.choices(range(256), k=chance.randrange(600))))
                connection.close()

        self.check(scan, '600 connections of a port scan')

    def test_loggers(self):
        """What rqt_logger_level asks for."""
        def ask():
            for _ in range(5):
                loggers = rospy.ServiceProxy('/attacked/get_loggers', GetLoggers)().loggers
                self.assertIn('ros.flute_grinder', {logger.name for logger in loggers})
                for logger in ('ros.flute_grinder', 'ros'):
                    rospy.ServiceProxy('/attacked/set_logger_level', SetLoggerLevel)(logger, 'info')

        self.check(ask, 'questions for the loggers')
