#!/usr/bin/env python3
"""Shows on the real HAL that each servo cycle plays exactly one setpoint: a stroke of 30 s and short jobs, recorded by a HAL
sampler, are to the last bit what the node says that it wrote."""

import csv
import tempfile
import unittest

import flute_grinder.job
import rospy
import rostest
from flute_grinder.msg import GrinderState

import hal_bench
from hal_bench import gc
import path_checks as checks

RECORDER = hal_bench.recorder()
# Long, so that a host that stalls does not decide the test.
BUFFER = 1.0


def bits(position):
    return tuple(value.hex() for value in position)


class TestStream(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        hal_bench.patience(2 * BUFFER)
        node = hal_bench.Node(buffer=BUFFER)
        cls.addClassCleanup(node.end)
        cls.grinder = gc.Grinder()
        cls.addClassCleanup(cls.grinder.close)
        cls.grinder.make_ready()

    def record(self, job):
        """Runs a job; returns its setpoints, and the rows from the first setpoint to where HAL goes on at rest."""
        first = RECORDER.now()
        run = self.grinder.send(job).wait_complete(timeout=120)
        self.assertEqual((run.status, run.text), ('SUCCEEDED', ''))
        RECORDER.over(10)
        rows = RECORDER.read()[first:]
        setpoints = [bits(s.position) for s in run.setpoints]
        self.assertTrue(checks.is_gapless(run.setpoints))
        # The first setpoints are where the axes stand; the first that is not shows where they begin.
        start = setpoints[0]
        standing = next(i for i, s in enumerate(setpoints) if s != start)
        moving = next(i for i, row in enumerate(rows) if bits(row.command) != start)
        return setpoints, rows[moving - standing:]

    def check(self, job):
        setpoints, rows = self.record(job)
        played = [bits(row.command) for row in rows]
        self.assertEqual(played[:len(setpoints)], setpoints)
        self.assertEqual(set(played[len(setpoints):]), {setpoints[-1]})
        # One more in each row: neither HAL nor its recorder has left a cycle out.
        self.assertEqual({(b.played - a.played) % 2 ** 32 for a, b in zip(rows, rows[1:])}, {1})
        self.assertEqual({row.underruns for row in rows}, {rows[0].underruns})
        self.assertTrue(all(row.enabled for row in rows))
        return setpoints

    def test_last_setpoint_is_played_wherever_it_lies_in_the_fifo(self):
        for _ in range(3):
            self.check(gc.SHORT)

    def test_axes_follow_to_the_last_bit_at_rest(self):
        self.check(gc.SHORT)
        row = RECORDER.over(1)[0]
        self.assertEqual(bits(row.position), bits(row.command))
        self.assertEqual(self.grinder.wait_rest(), list(row.position))
        self.assertEqual(self.grinder.fresh_state().state, GrinderState.READY)

    def test_relief_is_played_to_the_last_bit_as_planned(self):
        with tempfile.TemporaryDirectory() as folder:
            path, plan = gc.reamer_file(folder + '/reamer.yaml'), folder + '/plan.csv'
            gc.grind('plan', path, '--operation', 'primary', '--csv', plan).check_returncode()
            with open(plan) as file:
                planned = [tuple(float(row[key]) for key in ('x_mm', 'y_mm', 'z_mm', 'a_rad')) for row in csv.DictReader(file)]
            goal = flute_grinder.job.goal(path, 'primary')
        self.grinder.make_ready_at_park()
        played = [tuple(map(float.fromhex, position)) for position in self.check(goal)]
        self.assertTrue([(x / gc.MM, y / gc.MM, z / gc.MM, a) for x, y, z, a in played] == planned, 'the setpoints differ')


if __name__ == '__main__':
    rospy.init_node('test_hal_stream')
    rostest.rosrun('flute_grinder', 'hal_stream', '__main__')
