"""Shows on the real HAL that a probing move stops at the probe's contact, though commands wait in a buffer, and where it was."""

import unittest

import rospy

import hal_bench
from hal_bench import gc
from grinder_client import MM, X

RECORDER = hal_bench.recorder()
SPEED = 2 * MM  # of the first touch, per second, as shipped


class TestProbe(unittest.TestCase):
    def test_it_stops_at_the_contact_and_says_where(self):
        hal_bench.patience(1000)
        node = hal_bench.Node()
        self.addCleanup(node.end)
        grinder = gc.Grinder()
        self.addCleanup(grinder.close)
        wall = grinder.make_ready()[X] + 3 * MM
        hal_bench.halcmd('setp', 'wall.in0', repr(wall))
        self.addCleanup(hal_bench.halcmd, 'setp', 'wall.in0', '1000')
        first = RECORDER.now()
        answers = []

        def agree():
            # A host that stalls sees a contact late; the touches then disagree, and it says so.
            answers.append(grinder.probe(10 * MM))
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
