#!/usr/bin/env python3
"""Shows on the real HAL that a probing move stops at the probe's contact, though commands wait in a buffer, and where it was."""

import unittest

import rospy
import rostest

import hal_bench
from hal_bench import gc
from grinder_client import MM, X

RECORDER = hal_bench.recorder()
WAY = 3 * MM
WITHIN = 10 * MM
SPEED = 2 * MM  # of the first touch, per second, as shipped


class TestProbe(unittest.TestCase):
    def setUp(self):
        hal_bench.patience(1000)
        node = hal_bench.Node()
        self.addCleanup(node.end)
        self.grinder = gc.Grinder()
        self.addCleanup(self.grinder.close)
        self.at = self.grinder.make_ready()[X]

    def probe(self):
        return self.grinder.probe(WITHIN)

    def test_it_stops_at_the_contact_and_says_where(self):
        wall = self.at + WAY
        hal_bench.halcmd('setp', 'wall.in0', repr(wall))
        self.addCleanup(hal_bench.halcmd, 'setp', 'wall.in0', '1000')
        first = RECORDER.now()
        answers = []

        def agree():
            # A host that stalls sees a contact late; the touches then disagree, and it says so.
            answers.append(self.probe())
            if answers[-1].message:
                self.assertIn('the touches spread over', answers[-1].message)
            return not answers[-1].message

        gc.poll(agree, 'touches that agree')
        ball = rospy.get_param('/grinder/geometry/probe')
        self.assertAlmostEqual(answers[-1].figures[0].value - ball['x'] - ball['diameter'] / 2, wall, delta=5e-6)
        largest = max(row.position[X] for row in RECORDER.read()[first:])
        # What was in the buffer is played; then the axis comes to rest.
        self.assertGreater(largest, wall)
        self.assertLess(largest, wall + SPEED * hal_bench.BUFFER + 1 * MM)

    def test_a_contact_that_does_not_last_is_no_touch(self):
        """It ends while the buffer is played, long before the axis rests."""
        with self.grinder.probing(WITHIN) as cycle:
            self.grinder.wait_for(lambda: self.grinder.joints[-1].position[X] > self.at + 1 * MM, 'the way to the surface')
            hal_bench.halcmd('setp', 'wall.in0', '-1000')
            hal_bench.halcmd('setp', 'wall.in0', '1000')
            self.assertTrue(cycle.wait_for_result(rospy.Duration(gc.PATIENCE)))
            message = cycle.get_result().message
        self.assertEqual(message, 'probing ended: the contact was lost again before the axis came to rest')
        self.assertLess(self.grinder.wait_rest()[X], self.at + 9 * MM)

    def test_without_a_contact_it_goes_all_the_way_and_back(self):
        begin = len(self.grinder.joints)
        self.assertEqual(self.probe().message, 'probing ended: nothing was touched over 10 mm')
        self.assertAlmostEqual(self.grinder.wait_rest()[X], self.at, delta=1e-6)
        farthest = max(joint.position[X] for joint in self.grinder.joints[begin:])
        self.assertAlmostEqual(farthest, self.at + 10 * MM, delta=1e-6)


if __name__ == '__main__':
    rospy.init_node('test_hal_probe')
    rostest.rosrun('flute_grinder', 'hal_probe', '__main__')
