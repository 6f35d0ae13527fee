"""Shows that axes are jogged by a service in steps, and by a topic for as long as its message is repeated; that a jog ends by a stop,
and when its client dies. Limits, states and moments, and a job whose wheel was jogged off the work, are gone through in
test/control/test_jog.cpp."""

import signal
import statistics
import subprocess
import sys
import threading
import time
import unittest

import rospy
from flute_grinder.msg import GrinderState, Jog, Stop
from flute_grinder.srv import JogStep
from std_msgs.msg import String

import grinder_client as gc
from grind_command import Command, CommandLine
from grinder_client import A, DEG, MM, X, grinder

# Encoder counts, as in config/grinder.yaml.
RESOLUTION = (1e-7, 1e-7, 1e-7, 1e-6)

CLIENT = '''
import rospy
from flute_grinder.msg import Jog
rospy.init_node('jogger', anonymous=True)
publisher = rospy.Publisher('/grinder/jog', Jog, queue_size=1)
while True:
    jog = Jog(axis=Jog.X, velocity=0.005)
    jog.header.stamp = rospy.Time.now()
    publisher.publish(jog)
    rospy.sleep(0.02)
'''


def step(axis, distance, speed=0.0):
    return grinder()._call('jog_step', JogStep, axis, distance, speed)


def return_to_park():
    """Ready at the park position, but for what the encoders round."""
    g = grinder()
    for axis, at, park in zip(range(4), g.make_ready(), g.park()):
        if abs(park - at) > 1e-6:
            assert step(axis, park - at, 5.0 if axis == A else 0.1).success
            g.wait_state(GrinderState.READY)
    g.wait_rest()


class Button:
    """Repeats the message of a continuous jog while it is pressed."""

    def __init__(self, axis, velocity, publisher):
        self.message = Jog(axis=axis, velocity=velocity)
        self.publisher = publisher
        self.released = threading.Event()
        self.thread = threading.Thread(target=self.repeat)
        self.thread.start()

    def repeat(self):
        while not self.released.wait(0.02):
            self.message.header.stamp = rospy.Time.now()
            self.publisher.publish(self.message)

    def let_go(self):
        self.released.set()
        self.thread.join()
        self.message.velocity = 0
        self.publisher.publish(self.message)


class JogTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.publisher = gc.publisher(cls.addClassCleanup, '/grinder/jog', Jog)
        cls.stops = gc.publisher(cls.addClassCleanup, '/grinder/stop', Stop)

    def setUp(self):
        return_to_park()

    def press(self, axis, velocity):
        button = Button(axis, velocity, self.publisher)
        self.addCleanup(button.let_go)
        return button

    def check_at(self, expected):
        """That the axes come there, which takes longer with a drive that buffers, and rest there."""
        g = grinder()
        g.wait_for(lambda: all(abs(position - at) <= 1.01 * resolution
                               for position, at, resolution in zip(g.positions(), expected, RESOLUTION)),
                   'the axes at %s' % expected)
        for position, at, resolution in zip(g.wait_rest(), expected, RESOLUTION):
            self.assertAlmostEqual(position, at, delta=1.01 * resolution)


class TestStep(JogTest):
    def test_goes_its_distance_at_the_speed_of_the_machine_and_a_stop_ends_it(self):
        g = grinder()
        at = g.wait_rest()
        batches, first = len(g.batches), len(g.joints)
        reply = step(X, 15 * MM)
        self.assertEqual((reply.success, reply.message), (True, ''))
        g.wait_state(GrinderState.READY)
        speeds = [j.velocity[j.name.index('axis_x')] for j in g.joints[first:]]
        asked = rospy.get_param('/grinder/jog_velocity/axis_x')
        # Most of the way; the drive's own speed swings where its host stalls.
        self.assertAlmostEqual(statistics.median(speed for speed in speeds if speed > asked / 2), asked, delta=0.0005)
        self.assertTrue(step(A, -90 * DEG, 200 * DEG).success)
        g.wait_state(GrinderState.READY)
        at[X] += 15 * MM
        at[A] -= 90 * DEG
        self.check_at(at)
        self.assertEqual(len(g.batches), batches, 'setpoints of no job were published')

        self.assertTrue(step(X, 300 * MM, 10 * MM).success)
        g.wait_state(GrinderState.JOGGING)
        run = g.send(gc.SHORT).wait()
        self.assertEqual(run.status, 'REJECTED')
        self.assertRegex(run.text, 'state jogging; allowed: disable, hold, cancel, jog')
        self.stops.publish(Stop(request=Stop.CANCEL))
        g.wait_state(GrinderState.READY)
        self.assertLess(g.wait_rest()[X], 200 * MM)


class TestContinuous(JogTest):
    def test_rests_when_its_client_is_killed(self):
        g = grinder()
        client = subprocess.Popen([sys.executable, '-c', CLIENT])
        self.addCleanup(client.wait)
        self.addCleanup(client.kill)
        start = g.positions()[X]
        g.wait_for(lambda: g.positions()[X] > start + 5 * MM, 'more than a time-out of motion')
        self.assertEqual(g.fresh_state().state, GrinderState.JOGGING)
        client.send_signal(signal.SIGKILL)
        client.wait()
        g.wait_state(GrinderState.READY)
        # To the limit it would take a minute.
        self.assertLess(g.wait_rest()[X], 100 * MM)
        # What it has not released moves nothing, whoever goes on; the refusal is published once until the button is released.
        refusals = gc.received(self.addCleanup, '/grinder/jog_refusal', String)
        button = self.press(X, 0.005)
        gc.poll(lambda: refusals, 'a refusal')
        g.positions_over(0.5)  # the button stays pressed
        self.assertEqual(refusals, [String('jog refused: it was not repeated within jog_timeout; release the button first')])
        self.assertEqual(g.fresh_state().state, GrinderState.READY)
        button.let_go()
        g.positions_over(0.5)
        button = self.press(X, 0.005)
        g.wait_state(GrinderState.JOGGING)
        button.let_go()
        g.positions_over(0.5)
        self.press(X, 1.0)
        gc.poll(lambda: len(refusals) > 1, 'another refusal')
        self.assertRegex(refusals[1].data, '^jog refused: speed of axis X = 60000 mm/min; allowed: ')

    def test_a_message_from_long_ago_moves_nothing(self):
        g = grinder()
        at = g.wait_rest()
        for age in (2, -200, rospy.get_time()):  # the last without a stamp
            for _ in range(5):
                jog = Jog(axis=X, velocity=0.05)
                jog.header.stamp = rospy.Time.from_sec(rospy.get_time() - age)
                self.publisher.publish(jog)
                time.sleep(0.02)
        self.assertEqual(set(map(tuple, g.positions_over(0.3))), {tuple(at)})


class TestCommandLine(CommandLine):
    def test_moves_an_axis_prints_where_it_stands_and_says_why_it_does_not(self):
        return_to_park()
        self.assertEqual(self.grind(0, 'jog', 'x', '1.5', '--feed', '1200').stdout, 'X -48.5000 mm\n')
        self.assertEqual(self.grind(0, 'jog', 'x', '-1.25').stdout, 'X -49.7500 mm\n')
        self.assertRegex(self.grind(0, 'jog', 'a', '-90', '--feed', '10000').stdout, r'^A -(90\.000|89\.999)\d deg\n$')
        self.assertEqual(self.grind(1, 'jog', 'y', '200').stderr,
                         'jog refused: it would lead axis Y to machine position 250 mm; allowed: up to 150 mm\n')
        self.assertRegex(self.grind(1, 'jog', 'y', '1', '--feed', '6001').stderr, 'speed of axis Y = 6001 mm/min')
        command = Command('jog', 'x', '100', '--feed', '300')
        self.addCleanup(command.close)
        grinder().wait_state(GrinderState.JOGGING)
        command.send(signal.SIGINT)
        self.assertEqual(command.end(), 1)
        self.assertEqual(command.text, 'the jog was stopped before its end\n')
        self.assertRegex(command.stdout, r'^X -?\d+\.\d{4} mm\n$')
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertLess(grinder().positions()[X], 40 * MM)
