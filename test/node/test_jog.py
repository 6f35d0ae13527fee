#!/usr/bin/env python3
"""Shows that axes can be jogged by steps, and for as long as a message is repeated; that a jog ends at the limits, by a stop,
and when its client dies; and that a job whose wheel was jogged off the work is ground to its end on the same path."""

import signal
import statistics
import subprocess
import sys
import threading
import time
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, Jog, Stop
from flute_grinder.srv import JogStep
from std_msgs.msg import String

import grinder_client as gc
import path_checks as checks
from grind_command import CommandLine, RunTest
from grinder_client import A, APPROACH, DEG, INFEED, LIFT, MM, MM_MIN, POSITION, STROKE, X, Y, Z, grinder

# Every axis moves in the stroke.
JOB = gc.paper(cone_angle=10 * DEG, feed=2000 * MM_MIN)
HELIX = checks.Helix(JOB)
CLEAR = HELIX.y(31 * MM) + 5 * MM

# Encoder counts, as in config/grinder.yaml.
RESOLUTION = (1e-7, 1e-7, 1e-7, 1e-6)

CLIENT = '''
import rospy
from flute_grinder.msg import Jog
rospy.init_node('jogger', anonymous=True)
publisher = rospy.Publisher('/grinder/jog', Jog, queue_size=1)
while True:
    jog = Jog(axis=Jog.X, velocity=0.002)
    jog.header.stamp = rospy.Time.now()
    publisher.publish(jog)
    rospy.sleep(0.02)
'''


def step(axis, distance, speed=0.0):
    return grinder()._call('jog_step', JogStep, axis, distance, speed)


def send_slowly():
    """The job with time to interfere in the stroke, even on a host that stalls."""
    assert grinder().set_feed_override(0.2).success
    return grinder().send(JOB)


class Button:
    """Repeats the message of a continuous jog while it is pressed."""

    def __init__(self, axis, velocity, publisher):
        self.message = Jog(axis=axis, velocity=velocity)
        self.publisher = publisher
        self.pressed = True
        self.sent = 0
        self.longest_gap = 0.0
        self.thread = threading.Thread(target=self.repeat)
        self.thread.start()

    def repeat(self):
        last = time.monotonic()
        while self.pressed:
            self.message.header.stamp = rospy.Time.now()
            self.publisher.publish(self.message)
            now = time.monotonic()
            self.longest_gap = max(self.longest_gap, now - last)
            last = now
            self.sent += 1
            time.sleep(0.02)

    def change(self, velocity):
        """Returns when messages with this velocity were sent: the publisher may drop one."""
        self.message.velocity = velocity
        sent = self.sent
        gc.poll(lambda: self.sent > sent + 5, 'messages')

    def let_go(self):
        """Without a last message that stops."""
        self.pressed = False
        self.thread.join()


class JogTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.publisher = rospy.Publisher('/grinder/jog', Jog, queue_size=1, tcp_nodelay=True)
        cls.stops = rospy.Publisher('/grinder/stop', Stop, queue_size=1, tcp_nodelay=True)
        for publisher in (cls.publisher, cls.stops):
            gc.poll(lambda p=publisher: p.get_num_connections() > 0, 'a connection')

    def setUp(self):
        grinder().make_ready_at_park()

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
    def test_every_axis_goes_its_distance_and_no_further(self):
        g = grinder()
        at = g.wait_rest()
        batches = len(g.batches)
        for axis, distance in ((X, 10 * MM), (Y, -2 * MM), (Z, 0.001 * MM), (A, -90 * DEG), (X, -3 * MM)):
            seen = len(g.states)
            reply = step(axis, distance, 20 * DEG * 10 if axis == A else 50 * MM)
            self.assertEqual((reply.success, reply.message), (True, ''))
            g.wait_state(GrinderState.READY)
            at[axis] += distance
            self.check_at(at)
            states = {s.state_name for s in g.states[seen:]}
            self.assertLessEqual(states, {'ready', 'jogging'})
        self.assertEqual(len(g.batches), batches, 'setpoints of no job were published')

    def test_without_a_speed_it_goes_at_that_of_the_machine(self):
        g = grinder()
        first = len(g.joints)
        self.assertTrue(step(X, 5 * MM).success)
        g.wait_state(GrinderState.READY)
        self.check_at([g.park()[X] + 5 * MM] + g.park()[1:])
        speeds = [j.velocity[j.name.index('axis_x')] for j in g.joints[first:]]
        # Most of the way; the drive's own speed swings where its host stalls.
        self.assertAlmostEqual(statistics.median(speed for speed in speeds if speed > 0),
                               rospy.get_param('/grinder/jog_velocity/axis_x'), delta=0.0005)

    def test_beyond_a_limit_it_is_refused(self):
        reply = step(X, 400 * MM)
        self.assertFalse(reply.success)
        self.assertEqual(reply.message, 'jog refused: it would lead axis X to 350 mm; allowed: up to 300 mm')
        self.assertEqual(step(Y, -80 * MM).message,
                         'jog refused: it would lead axis Y to -30 mm; allowed: down to -20 mm')
        self.assertRegex(step(X, float('nan')).message, 'jog refused: it would lead axis X to nan')
        self.assertEqual(step(7, 1 * MM).message, 'jog refused: axis = 7; allowed: 0 to 3 for X, Y, Z, A')
        self.assertRegex(step(X, 1 * MM, 1.0).message, 'jog refused: speed of axis X = 60000 mm/min; allowed: ')
        self.check_at(grinder().park())

    def test_where_the_state_does_not_allow_it_is_refused(self):
        g = grinder()
        self.assertTrue(g.disable().success)
        self.assertEqual(step(X, 1 * MM).message,
                         'jog refused: the machine is in state disabled; allowed: enable, disable, reset')
        g.make_ready_at_park()
        run = send_slowly().wait_in_stroke(2 * MM)
        self.assertRegex(step(X, 1 * MM).message, 'jog refused: the machine is in state running; ')
        self.assertTrue(g.hold().success)
        g.wait_state(GrinderState.HELD)
        self.assertRegex(step(Y, 1 * MM).message, 'jog refused: the machine is in state held; ')
        self.assertTrue(g.set_feed_override(1).success)
        self.assertTrue(g.resume().success)
        self.assertEqual(run.wait().status, 'SUCCEEDED')

    def test_without_the_reference_it_is_refused(self):
        g = grinder()
        g.inject('reference_lost')
        g.wait_for(lambda: not g.states[-1].homed, 'the loss of the reference')
        self.assertEqual(step(X, 1 * MM).message, 'jog refused: the axes are not homed')

    def test_a_hold_stops_it(self):
        g = grinder()
        self.assertTrue(step(X, 300 * MM, 10 * MM).success)
        g.wait_state(GrinderState.JOGGING)
        self.assertTrue(g.hold().success)
        g.wait_state(GrinderState.READY)
        self.assertLess(g.wait_rest()[X], 200 * MM)

    def test_a_goal_is_rejected_meanwhile(self):
        g = grinder()
        self.assertTrue(step(X, 300 * MM, 10 * MM).success)
        g.wait_state(GrinderState.JOGGING)
        run = g.send(JOB).wait()
        self.assertEqual(run.status, 'REJECTED')
        self.assertRegex(run.text, 'state jogging; allowed: disable, hold, cancel, jog')
        self.stops.publish(Stop(request=Stop.CANCEL))
        g.wait_state(GrinderState.READY)


class TestContinuous(JogTest):
    def test_goes_on_while_it_is_repeated_and_stops_without(self):
        g = grinder()
        button = self.press(Z, 0.01)
        g.wait_for(lambda: g.positions()[Z] > 15 * MM, 'more than a time-out of motion')
        self.assertEqual(g.fresh_state().state, GrinderState.JOGGING)
        button.let_go()
        g.wait_state(GrinderState.READY)
        at = g.wait_rest()
        self.assertLess(at[Z], 100 * MM, 'it went on to the limit')

    def test_rests_when_its_client_is_killed(self):
        g = grinder()
        client = subprocess.Popen([sys.executable, '-c', CLIENT])
        self.addCleanup(client.wait)
        self.addCleanup(client.kill)
        start = g.positions()[X]
        g.wait_for(lambda: g.positions()[X] > start + 5 * MM, 'motion')
        client.send_signal(signal.SIGKILL)
        client.wait()
        g.wait_state(GrinderState.READY)
        # To the limit it would take two minutes.
        self.assertLess(g.wait_rest()[X], 100 * MM)

    def test_velocity_zero_stops_it_at_once(self):
        g = grinder()
        button = self.press(Y, -0.01)
        g.wait_state(GrinderState.JOGGING)
        button.message.velocity = 0
        g.wait_state(GrinderState.READY)
        at = g.wait_rest()
        self.assertEqual(set(map(tuple, g.positions_over(0.3))), {tuple(at)})
        button.let_go()

    def test_rests_at_the_limit(self):
        g = grinder()
        button = self.press(Z, -0.05)
        g.wait_for(lambda: g.positions()[Z] < -49.999 * MM, 'the limit')
        g.wait_state(GrinderState.READY)
        self.check_at(g.park()[:Z] + [-50 * MM] + g.park()[A:])
        button.let_go()

    def test_after_a_stop_a_button_that_stays_pressed_moves_nothing(self):
        g = grinder()
        stalled = True
        # A host that stalls for as long as jog_timeout releases the button.
        while stalled:
            button = self.press(X, 0.005)
            g.wait_state(GrinderState.JOGGING)
            self.stops.publish(Stop(request=Stop.HOLD))
            g.wait_state(GrinderState.READY)
            at = g.wait_rest()
            positions = g.positions_over(1.5)
            stalled = button.longest_gap > 0.5
            if stalled:
                button.let_go()
                g.positions_over(1.5)
                g.wait_state(GrinderState.READY)
        self.assertEqual(set(map(tuple, positions)), {tuple(at)})
        button.change(0)
        button.change(0.005)
        g.wait_state(GrinderState.JOGGING)

    def test_a_refusal_is_told_once_until_the_button_is_released(self):
        g = grinder()
        refusals = []
        topic = rospy.Subscriber('/grinder/jog_refusal', String, lambda message: refusals.append(message.data))
        self.addCleanup(topic.unregister)
        gc.poll(lambda: topic.get_num_connections() > 0, 'a connection')
        button = self.press(Z, -0.05)
        gc.poll(lambda: refusals, 'a refusal')
        self.assertEqual(refusals, ['jog refused: axis Z stands at -50 mm, the end of its way'])
        g.positions_over(0.5)  # the button stays pressed
        self.assertEqual(len(refusals), 1)
        button.let_go()
        g.positions_over(1.5)  # longer than jog_timeout
        self.press(X, 1.0)
        gc.poll(lambda: len(refusals) > 1, 'another refusal')
        self.assertRegex(refusals[1], '^jog refused: speed of axis X = 60000 mm/min; allowed: ')

    def test_a_message_from_long_ago_moves_nothing(self):
        g = grinder()
        at = g.wait_rest()
        for age in (2, -2, rospy.get_time()):  # the last without a stamp
            for _ in range(5):
                jog = Jog(axis=X, velocity=0.05)
                jog.header.stamp = rospy.Time.from_sec(rospy.get_time() - age)
                self.publisher.publish(jog)
                time.sleep(0.02)
        self.assertEqual(set(map(tuple, g.positions_over(0.3))), {tuple(at)})


class TestRetracted(JogTest):
    """A job that is held and retracted, and whose wheel is jogged away."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        g = grinder()
        g.make_ready_at_park()
        cls.first_state = len(g.states)
        run = send_slowly().wait_in_stroke(8 * MM)
        assert g.hold().success
        g.wait_state(GrinderState.HELD)
        assert g.retract().success
        g.wait_state(GrinderState.RETRACTED)
        cls.lifted = g.wait_rest()
        cls.down = step(Y, -1 * MM)
        cls.replies = []
        for axis, distance, speed in ((Y, 30 * MM, 0.1), (X, -60 * MM, 0.2), (A, 1.0, 5.0), (Z, 10 * MM, 0.1)):
            cls.replies.append(step(axis, distance, speed))
            g.wait_state(GrinderState.RETRACTED)
        cls.jogged = g.wait_rest()
        assert g.set_feed_override(1).success
        cls.resumed = g.resume()
        cls.job_run = run.wait_complete()
        g.wait_state(GrinderState.READY)
        cls.setpoints = run.setpoints
        cls.states = [s.state_name for s in g.states[cls.first_state:]]
        cls.back = 1 + max(i for i, s in enumerate(cls.setpoints)
                           if all(abs(a - b) < 1e-6 for a, b in zip(s.position, cls.jogged)))

    def setUp(self):
        pass

    def test_jogs_are_accepted_but_not_down_to_the_work(self):
        for reply in self.replies:
            self.assertEqual((reply.success, reply.message), (True, ''))
        self.assertRegex(self.down.message, 'jog refused: it would lead axis Y to .*; allowed: down to ')
        self.assertIn('jogging_retracted', self.states)
        for axis, distance in ((X, -60 * MM), (Y, 30 * MM), (Z, 10 * MM), (A, 1.0)):
            self.assertAlmostEqual(self.jogged[axis], self.lifted[axis] + distance, delta=1.01 * RESOLUTION[axis])

    def test_job_succeeds_without_a_missing_cycle(self):
        self.assertEqual(self.job_run.status, 'SUCCEEDED', self.job_run.text)
        self.assertTrue(checks.is_gapless(self.setpoints))
        self.assertEqual(len(self.setpoints), self.job_run.result.setpoints_written)
        self.assertEqual(list(self.setpoints[-1].position), grinder().park())

    def test_no_axis_exceeds_a_limit(self):
        self.assertEqual(checks.excesses(self.setpoints, grinder().limits(), grinder().period()), [])

    def test_way_back_is_across_then_down_to_where_it_was_lifted(self):
        end = next(i for i in range(self.back, len(self.setpoints))
                   if all(abs(a - b) <= 1e-7 + 1e-6 * (axis == A) for axis, (a, b) in
                          enumerate(zip(self.setpoints[i].position, self.lifted))))
        way = self.setpoints[self.back:end + 1]
        self.assertEqual({s.move for s in way}, {POSITION, APPROACH})
        for s in way:
            above = all(abs(s.position[axis] - self.lifted[axis]) < 2e-6 for axis in (X, Z, A))
            if s.move == POSITION:
                self.assertAlmostEqual(s.position[Y], self.jogged[Y], delta=1e-6)
            else:
                self.assertTrue(above)

    def test_it_is_never_lower_than_the_clearance_but_to_plunge(self):
        for s in self.setpoints[self.back:]:
            if s.move in (POSITION, APPROACH):
                self.assertGreaterEqual(s.position[Y], CLEAR - 1e-12)

    def test_path_is_that_of_the_job(self):
        self.assertEqual(checks.off_path(self.setpoints, HELIX), [])
        strokes = [s for s in self.setpoints if s.move == STROKE]
        for s in strokes:
            x, y, z, _ = s.position
            self.assertAlmostEqual(y, HELIX.y(x) - 0.5 * MM, delta=1e-12)
            self.assertAlmostEqual(z, HELIX.z(x), delta=1e-12)
        self.assertAlmostEqual(strokes[-1].position[X], 31 * MM, delta=1e-9)


class TestRetractedCancel(JogTest):
    def test_a_cancel_stops_the_jog_and_ends_the_job(self):
        g = grinder()
        run = send_slowly().wait_in_stroke(8 * MM)
        self.assertTrue(g.hold().success)
        g.wait_state(GrinderState.HELD)
        self.assertTrue(g.retract().success)
        g.wait_state(GrinderState.RETRACTED)
        self.assertTrue(step(X, 200 * MM, 10 * MM).success)
        g.wait_state(GrinderState.JOGGING_RETRACTED)
        run.cancel()
        self.assertEqual(run.wait().status, 'PREEMPTED')
        g.wait_state(GrinderState.READY)
        self.assertLess(g.wait_rest()[X], 150 * MM)
        self.assertFalse(g.fresh_state().wheel_in_work)


class TestCommandLine(CommandLine):
    def setUp(self):
        super().setUp()
        grinder().make_ready_at_park()

    def test_moves_an_axis_and_prints_where_it_stands(self):
        self.assertEqual(self.grind(0, 'jog', 'x', '1.5', '--feed', '1200').stdout, 'X -48.5000 mm\n')
        self.assertEqual(self.grind(0, 'jog', 'x', '-0.25').stdout, 'X -48.7500 mm\n')
        self.assertEqual(self.grind(0, 'jog', 'x', '-1').stdout, 'X -49.7500 mm\n')
        self.assertRegex(self.grind(0, 'jog', 'a', '-90', '--feed', '10000').stdout, r'^A -(90\.000|89\.999)\d deg\n$')

    def test_says_why_it_does_not(self):
        self.assertEqual(self.grind(1, 'jog', 'y', '200').stderr,
                         'jog refused: it would lead axis Y to 250 mm; allowed: up to 150 mm\n')
        self.assertRegex(self.grind(1, 'jog', 'y', '1', '--feed', '6001').stderr, 'speed of axis Y = 6001 mm/min')

    def test_wrong_usage(self):
        for arguments in (('b', '1'), ('x',), ('x', 'far'), ('x', '1', '--feed', '0'), ('x', '1', '--feed', '-5')):
            self.grind(2, 'jog', *arguments)


class TestCtrlC(RunTest):
    def test_stops_the_axis(self):
        grinder().make_ready_at_park()
        command = self.grind('jog', 'x', '100', '--feed', '300')
        grinder().wait_state(GrinderState.JOGGING)
        command.send(signal.SIGINT)
        self.assertEqual(command.end(), 1)
        self.assertEqual(command.text, 'the jog was stopped before its end\n')
        self.assertRegex(command.stdout, r'^X -?\d+\.\d{4} mm\n$')
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertLess(grinder().positions()[X], 40 * MM)


if __name__ == '__main__':
    rospy.init_node('test_jog')
    rostest.rosrun('flute_grinder', 'jog', __name__)
