#!/usr/bin/env python3
"""Shows how a client sees that the reference is missing, and that the machine homes. What the control loop does about reference,
spindle and coolant, at every moment of a job, is shown in test/control."""

import itertools
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc

NOT_HOMED = 'the axes are not homed'


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


if __name__ == '__main__':
    rospy.init_node('test_interlocks')
    rostest.rosrun('flute_grinder', 'interlocks', '__main__')
