#!/usr/bin/env python3
"""Runs the node with flute_grinder/RosControlDrive and a RobotHW made for that (recorder.cpp): what it gets is the job bit for bit,
and however it fails the machine stops and says why."""

import os
import struct
import sys
import threading
import unittest

import rospy
import rostest
from std_msgs.msg import Bool, String
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse

from flute_grinder.msg import GrinderState, GrindResult
try:
    from industrial_msgs.msg import RobotStatus
except ImportError:
    RobotStatus = None

sys.path.insert(0, os.path.join(os.path.dirname(__file__), os.pardir, 'node'))
import grinder_client as gc  # noqa: E402

JOINTS = {'axis_x': 'x_slide', 'axis_y': 'y_slide', 'axis_z': 'z_slide', 'axis_a': 'work_head'}


class TestRosControl(unittest.TestCase):
    started = 0

    def setUp(self):
        self.folder = gc.temp_folder(self.addCleanup)
        self.environment = gc.plugin_package(self.folder, 'hardware_interface', 'recorder', 'Recorder',
                                             'hardware_interface::RobotHW')
        self.record = os.path.join(self.folder, 'record')

    def node_with(self, signals=(), commands=(), clock='monotonic', **robot_hw):
        parameters = gc.machine()
        parameters['hardware'] = {
            'type': 'flute_grinder/RosControlDrive', 'joints': JOINTS, 'clock': clock, 'signal_timeout': 0,
            'robot_hw': dict(robot_hw, type='tested/Plugin', record=self.record),
            'signals': dict({'emergency_stop': 'never', 'homed': 'always', 'spindle_at_speed': 'always',
                             'coolant_on': 'always'}, **dict(signals)),
            'commands': dict({'power': 'none'}, **dict(commands))}
        TestRosControl.started += 1
        self.node = gc.NodeProcess('recorded%d' % self.started, parameters, environment=self.environment)
        self.addCleanup(self.node.close)
        return self.node

    def start(self, *arguments, **options):
        """@return a client of the node."""
        self.node_with(*arguments, **options)
        self.now = rospy.Publisher('/%s/hardware/robot_hw/now' % self.node.name, String, queue_size=1, latch=True)
        client = self.node.client()
        self.addCleanup(client.close)
        gc.poll(lambda: self.now.get_num_connections() > 0, 'the RobotHW to listen')
        client.wait_state(GrinderState.DISABLED)
        return client

    def call(self, service):
        return rospy.ServiceProxy('/%s/%s' % (self.node.name, service), Trigger)()

    def enable(self):
        reply = self.call('enable')
        self.assertTrue(reply.success, reply.message)

    def recorded(self):
        """What the RobotHW says, and the rows of positions and velocities that it was commanded."""
        reply = self.call('hardware/robot_hw/write_record')
        self.assertTrue(reply.success, 'another period, or another switch than one of one controller')
        with open(self.record, 'rb') as file:
            return reply.message.split(), list(struct.iter_unpack('<8d', file.read()))

    def run_job(self, client):
        self.enable()
        self.assertFalse(client.fresh_state().spindle_at_speed, 'always, if it is commanded')
        run = client.run(gc.paper())
        run.wait_complete()
        self.assertEqual(run.code, GrindResult.SUCCESSFUL, run.text)
        return [tuple(setpoint.position) for setpoint in run.setpoints]

    def test_job_bit_for_bit(self):
        client = self.start()
        setpoints = self.run_job(client)
        (root, own, interface, switches), rows = self.recorded()
        self.assertEqual((root, own), ('/', '/%s/hardware/robot_hw' % self.node.name))
        self.assertEqual((interface, switches), ('hardware_interface::PositionJointInterface', '1'))
        commands = [row[:4] for row in rows]
        first = commands.index(setpoints[0])
        # The first one stands where the axes rest already.
        while commands[first + 1] == setpoints[0]:
            first += 1
        self.assertEqual(commands[first:first + len(setpoints)], setpoints)
        self.assertGreater(len(setpoints), 7000)
        self.assertEqual(commands[0], (-0.05, 0.05, 0, 0), 'the first command is the position')
        self.assertTrue(self.call('disable').success)
        client.wait_power_off()
        gc.poll(lambda: self.recorded()[0][3] == '3', 'the second switch off, which has been prepared')

    def test_velocities_where_they_are_taken(self):
        client = self.start(with_velocity=True)
        setpoints = self.run_job(client)
        (_, _, interface, _), rows = self.recorded()
        self.assertEqual(interface, 'hardware_interface::PosVelJointInterface')
        for before, row in zip(rows, rows[1:]):
            for axis in range(4):
                self.assertAlmostEqual(row[4 + axis], (row[axis] - before[axis]) / 0.001, delta=1e-9)
        self.assertGreater(max(abs(row[7]) for row in rows), 0.01)
        self.assertIn(setpoints[-1], [row[:4] for row in rows])

    def test_what_does_not_start(self):
        for fails, why in (('joint', 'work_head'),
                           ('interface', 'the RobotHW offers no hardware_interface::PositionJointInterface'),
                           ('init', 'robot_hw/type = tested/Plugin: its init() has returned false'),
                           ('conflict', 'the RobotHW finds its four joints in conflict with one another')):
            with self.subTest(fails):
                node = self.node_with(fails=fails)
                self.assertEqual(node.end(), 1, node.output)
                self.assertIn(why, node.output)

    def test_what_does_not_get_power(self):
        for fails, why in (('prepare', "the drive is not ready: the RobotHW refuses to switch to the grinder's commands"),
                           ('switch', 'the drive reports a fault')):
            with self.subTest(fails):
                client = self.start(fails=fails)
                self.assertIn(why, self.call('enable').message)
                self.assertFalse(client.fresh_state().enabled)

    def test_clock_of_the_bus(self):
        """With read() as the clock, one that blocks paces the loop, and one that does not is found and paced."""
        client = self.start(clock='read', blocks=True)
        self.enable()
        begin = client.fresh_state().header.stamp
        # Longer than the average of the cycles is taken over.
        client.wait_for(lambda: (client.states[-1].header.stamp - begin).to_sec() > 2.5, 'cycles')
        self.assertEqual(client.states[-1].state, GrinderState.READY, client.states[-1].fault)
        self.start(clock='read')
        self.assertIn('read() returns sooner than control_rate allows', self.call('enable').message)

    def test_switch_that_takes_its_time(self):
        client = self.start(fails='late switch')
        self.enable()
        self.assertTrue(client.fresh_state().enabled)

    def test_failures_in_a_job(self):
        """One after the other, with one node."""
        client = self.start()
        for now, why in (('read', 'E17: encoder (thrown by its read())'), ('limit', 'the RobotHW has changed the command of axis_x'),
                         ('hang', '')):
            with self.subTest(now):
                self.enable()
                run = client.send(gc.paper()).wait_in_stroke(2 * gc.MM)
                self.now.publish(now)
                if now == 'hang':
                    client.wait_for(lambda: 'does not return to the control loop' in client.states[-1].fault, 'the watchdog')
                    self.now.publish('')
                run.wait()
                self.assertEqual(run.code, GrindResult.HARDWARE_FAULT, run.text)
                self.assertIn(why, run.text)
                client.wait_for(lambda: not client.states[-1].enabled, 'the end of the power')
                self.now.publish('')
                gc.poll(lambda: self.call('reset_fault').success, 'the reset')
                client.wait_state(GrinderState.DISABLED)
                gc.poll(lambda: self.call('enable').success, 'the power')
                self.assertTrue(self.call('lift').success)
                client.wait_state(GrinderState.READY)
                self.assertTrue(self.call('disable').success)
                client.wait_power_off()

    @unittest.skipUnless(RobotStatus, 'industrial_msgs is not installed')
    def test_robot_status(self):
        client = self.start(signals={'emergency_stop': '/cell/pressed'})
        statuses = []
        rospy.Subscriber('/robot_status', RobotStatus, statuses.append)

        def shown():
            s = statuses[-1]
            return [t.val for t in (s.e_stopped, s.drives_powered, s.motion_possible, s.in_motion, s.in_error)]

        client.wait_for(lambda: statuses and shown() == [1, 0, 0, 0, 0], 'the emergency stop')
        pressed = self.publisher('pressed')
        pressed.publish(False)
        client.wait_for(lambda: shown() == [0, 0, 0, 0, 0], 'its end')
        self.enable()
        client.wait_for(lambda: shown() == [0, 1, 1, 0, 0], 'the power')
        self.now.publish('hang')
        client.wait_for(lambda: shown() == [0, 1, 0, 0, 1], 'a drive that does not return')
        self.now.publish('')
        pressed.publish(True)
        client.wait_for(lambda: shown() == [1, 0, 0, 0, 1], 'the fault')

    def publisher(self, topic):
        made = rospy.Publisher('/cell/' + topic, Bool, queue_size=1, latch=True)
        self.addCleanup(made.unregister)
        return made

    def service(self, name, kind, answer):
        self.addCleanup(rospy.Service('/cell/' + name, kind, answer).shutdown)

    def test_emergency_stop_and_reference_of_other_programs(self):
        emergency, homed = self.publisher('emergency_stop'), self.publisher('homed')
        client = self.start(signals={'emergency_stop': '/cell/emergency_stop', 'homed': '/cell/homed'})
        self.assertIn('the emergency stop is pressed', self.call('enable').message, 'before it is known')
        emergency.publish(False)
        client.wait_for(lambda: not client.states[-1].emergency_stop, 'the end of the emergency stop')
        self.enable()
        self.assertFalse(client.fresh_state().homed)
        homed.publish(True)
        client.wait_for(lambda: client.states[-1].homed, 'the reference')
        emergency.publish(True)
        client.wait_state(GrinderState.FAULT)
        gc.poll(lambda: self.recorded()[0][3] == '3', 'off, and once more when that was prepared')

    def test_reference_that_comes_after_the_answer_and_moves_nothing(self):
        answer, homed = threading.Event(), self.publisher('homed')
        self.service('home', Trigger, lambda _: TriggerResponse(answer.wait(gc.PATIENCE), ''))
        client = self.start(with_velocity=True, signals={'homed': '/cell/homed'}, commands={'home': {'service': '/cell/home'}})
        self.enable()
        self.assertTrue(self.call('home').success)
        self.now.publish('drift')
        client.wait_for(lambda: client.states[-1].position[0] > -0.049, 'another place')
        self.now.publish('')
        answer.set()
        for _ in range(5):
            self.assertEqual(client.fresh_state().state, GrinderState.HOMING, client.states[-1].fault)
        homed.publish(True)
        client.wait_state(GrinderState.READY)
        self.assertEqual({row[4:] for row in self.recorded()[1]}, {(0, 0, 0, 0)}, 'velocities')

    def test_power_home_spindle_by_services(self):
        calls, refuse = [], threading.Event()

        def switch(name):
            def on_call(request):
                calls.append((name, request.data))
                return SetBoolResponse(not (refuse.is_set() and request.data), 'the guard is open')
            self.service(name, SetBool, on_call)

        def on_home(_):
            calls.append(('home', True))
            return TriggerResponse(not refuse.is_set(), 'an axis stands on its switch')

        switch('power')
        switch('spindle')
        self.service('home', Trigger, on_home)
        client = self.start(commands={name: {'service': '/cell/' + name} for name in ('power', 'spindle', 'home')})
        refuse.set()
        self.assertIn('the drive reports a fault', self.call('enable').message)
        self.assertFalse(client.fresh_state().enabled)
        refuse.clear()
        gc.poll(lambda: ('power', False) in calls, 'the power to be taken back')
        gc.poll(lambda: self.call('enable').success, 'the power')
        self.assertTrue(self.call('home').success)
        client.wait_state(GrinderState.READY)
        self.assertIn(('home', True), calls)
        self.assertTrue(self.call('spindle_on').success)
        gc.poll(lambda: calls[-1] == ('spindle', True), 'the spindle')
        self.assertIn('the drive does not switch the coolant', self.call('coolant_on').message)
        self.assertTrue(self.call('disable').success)
        gc.poll(lambda: {('spindle', False), ('power', False)} <= set(calls[-2:]), 'the end of spindle and power')
        gc.poll(lambda: self.call('enable').success, 'the power')
        refuse.set()
        self.call('home')
        client.wait_state(GrinderState.FAULT)
        self.assertIn('the homing service has failed', client.states[-1].fault)


if __name__ == '__main__':
    rospy.init_node('test_ros_control')
    rostest.rosrun('flute_grinder', 'ros_control', '__main__')
