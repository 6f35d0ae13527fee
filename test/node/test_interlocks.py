#!/usr/bin/env python3
"""Shows how a client sees that reference, spindle or coolant is missing: what is lost in a stroke, homing, and a job that is not
begun. What the control loop does about each of them, at every moment of a job, is shown in test/control."""

import itertools
import re
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks
from grinder_client import DEG, MM, MM_MIN

# Every axis moves in the stroke, and there is time for something to be lost.
JOB = gc.paper(cone_angle=10 * DEG, flute_length=20 * MM, feed=300 * MM_MIN)

NOT_HOMED = 'the axes are not homed'
NO_SPINDLE = 'the spindle is not at speed'
NO_COOLANT = 'no coolant flows'


class InterlockTest(unittest.TestCase):
    def start(self, equipment, axes=(), pace=1, **parameters):
        """A node of its own with this equipment."""
        parameters = dict(gc.machine(pace), **parameters)
        parameters['hardware'].update(equipment)
        for joint, values in dict(axes).items():
            parameters['hardware'][joint].update(values)
        self.parameters = parameters
        self.node = gc.NodeProcess('own_grinder', parameters)
        self.addCleanup(self.node.close)
        client = self.node.client()
        self.addCleanup(client.close)
        return client

    def grind(self, *arguments):
        return gc.grind('--node', self.node.name, *arguments)

    def check_not_started(self, run, text):
        self.assertEqual((run.status, run.code), ('ABORTED', GrindResult.NOT_READY))
        self.assertRegex(run.text, text)
        self.assertEqual(run.setpoints, [])


class TestLostInTheStroke(InterlockTest):
    def lose(self, fault, reason):
        """The state once the wheel is lifted."""
        g = self.client
        self.assertTrue(g.inject(fault).success)
        state = g.wait_state(GrinderState.RETRACTED)
        self.assertEqual((state.hold_reason, state.fault, state.wheel_in_work, state.enabled), (reason, '', False, True))
        reply = g.resume()
        self.assertEqual((reply.success, reply.message), (False, 'resume refused: ' + reason))
        return state

    def resume(self):
        g = self.client
        self.assertTrue(g.inject('none').success)
        gc.poll(lambda: (lambda s: s.spindle_at_speed and s.coolant_on)(g.fresh_state()), 'spindle and coolant')
        at = g.wait_rest()
        self.assertEqual(set(g.positions_over(0.2)), {tuple(at)}, 'nothing moves by itself')
        reply = g.resume()
        self.assertTrue(reply.success, reply.message)
        g.wait_state(GrinderState.RUNNING)

    def test_job_goes_on_after_spindle_and_coolant_and_not_after_the_reference(self):
        # Home is not far, so that it does not take long.
        axes = {joint: {'homing_velocity': 0.5} for joint in gc.JOINTS[:3]}
        self.client = g = self.start({'spindle_run_up_time': 0.2}, axes, pace=5)
        g.make_ready()
        run = g.send(JOB).wait_in_stroke(4 * MM)
        state = self.lose('spindle_lost', NO_SPINDLE)
        self.assertFalse(state.spindle_at_speed)
        self.resume()
        run.wait_in_stroke(8 * MM)
        state = self.lose('coolant_lost', NO_COOLANT)
        self.assertFalse(state.coolant_on)
        self.resume()
        self.assertEqual(run.wait_complete().status, 'SUCCEEDED', run.text)
        self.assertTrue(checks.is_gapless(run.setpoints))
        self.assertEqual(checks.excesses(run.setpoints, g.limits(), g.period()), [])
        self.assertEqual(checks.off_path(run.setpoints, checks.Helix(JOB)), [])

        run = g.send(JOB).wait_in_stroke(4 * MM)
        self.assertFalse(self.lose('reference_lost', NOT_HOMED).homed)
        self.assertTrue(g.inject('none').success)
        self.assertEqual(g.resume().message, 'resume refused: ' + NOT_HOMED)
        self.assertEqual(g.home().message,
                         'home refused: the machine is in state retracted; allowed: disable, resume, cancel, jog')
        run.cancel()
        self.assertEqual((run.wait().status, run.code), ('PREEMPTED', GrindResult.CANCELED))
        g.wait_state(GrinderState.READY)
        self.check_not_started(g.send(gc.SHORT).wait(), '^start refused: %s$' % NOT_HOMED)
        self.assertTrue(g.home().success)
        self.assertTrue(g.wait_state(GrinderState.READY).homed)
        run = g.run(gc.SHORT)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)


class TestHoming(InterlockTest):
    def test_machine_whose_encoders_do_not_know_where_it_is(self):
        # Homing takes longer than all that is to happen meanwhile.
        g = self.start({'absolute_encoders': False, 'spindle_run_up_time': 0},
                       {'axis_x': {'start_position': -0.045}, 'axis_a': {'start_position': 3.0}})
        state = g.fresh_state()
        self.assertEqual((state.state_name, state.homed, state.enabled), ('disabled', False, False))
        self.assertTrue(g.enable().success)
        self.assertFalse(g.wait_state(GrinderState.READY).homed)
        self.check_not_started(g.send(gc.SHORT).wait(), '^start refused: %s$' % NOT_HOMED)
        run = g.send(gc.SHORT, dry_run=True).wait()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertRegex(self.grind('status').stdout, r'(?m)^homed +no$')
        self.assertEqual(set(g.positions_over(0.2)), {(0, 0, 0, 0)}, 'it does not home by itself')

        # Canceled, it is not homed.
        first_state = len(g.states)
        self.assertTrue(g.home().success)
        g.wait_for(lambda: g.states[-1].state == GrinderState.HOMING, 'homing')
        run = g.send(gc.SHORT).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY))
        self.assertRegex(run.text, 'state homing; allowed: disable, hold, cancel')
        self.assertEqual(g.home().message,
                         'home refused: the machine is in state homing; allowed: disable, hold, cancel')
        g.client.cancel_all_goals()
        self.assertFalse(g.wait_power_off().homed)
        self.assertTrue(g.enable().success)
        g.wait_state(GrinderState.READY)

        home = self.grind('home')
        self.assertEqual((home.returncode, home.stderr), (0, ''))
        self.assertTrue(g.fresh_state().homed)
        for joint, position in zip(gc.JOINTS, g.wait_rest()):
            self.assertAlmostEqual(position, self.parameters['hardware'][joint]['home_position'], delta=1e-6)
        states = [name for name, _ in itertools.groupby(s.state_name for s in g.states[first_state:])]
        if states[0] == 'ready':  # of before
            del states[0]
        self.assertEqual(states, ['homing', 'disabled', 'ready', 'homing', 'ready'])
        run = g.run(gc.SHORT)
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)

    def test_homing_that_never_ends_is_a_fault(self):
        g = self.start({'absolute_encoders': False}, {'axis_x': {'start_position': 0.0, 'homing_velocity': 1e-4}},
                       homing_timeout=0.3)
        self.assertTrue(g.enable().success)
        g.wait_state(GrinderState.READY)
        home = self.grind('home')
        state = g.wait_state(GrinderState.FAULT)
        self.assertFalse(state.enabled)
        found = re.match(r'the drive has not found its reference after (\S+) s, allowed 0\.3 s$', state.fault)
        self.assertTrue(found, state.fault)
        self.assertGreaterEqual(float(found.group(1)), 0.3)  # to the digits printed
        self.assertEqual((home.returncode, home.stderr.strip()), (1, state.fault))


class TestNeverReady(InterlockTest):
    def test_job_whose_spindle_never_comes_is_not_begun(self):
        g = self.start({'spindle_run_up_time': 60}, spindle_timeout=0.3)
        g.make_ready()
        at = g.wait_rest()
        run = g.send(gc.SHORT).wait()
        self.check_not_started(run, r'^%s \S+ s after the job was started, allowed 0\.3 s' % NO_SPINDLE)
        self.assertEqual(run.result.setpoints_written, 0)
        state = g.wait_state(GrinderState.READY)
        self.assertTrue(state.fault.startswith(NO_SPINDLE), state.fault)
        self.assertIn('starting', [s.state_name for s in g.states])
        self.assertEqual(g.wait_rest(), at)


if __name__ == '__main__':
    rospy.init_node('test_interlocks')
    rostest.rosrun('flute_grinder', 'interlocks', '__main__')
