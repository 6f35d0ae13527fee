#!/usr/bin/env python3
"""Shows on the real HAL that homing gives the axes a new reference without moving them: no job begins before, HAL homes
when the node asks it to, and commands count again only when they have the new reference. The encoders are those of
incremental.hal; the test plays the machine's part."""

import tempfile
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult

import hal_bench
from hal_bench import gc, wait_signal
import path_checks as checks
from grinder_client import MM, MM_MIN

RECORDER = hal_bench.recorder()
# Longer than any host stalls.
NEVER = 1000
AXES = 'xyza'
NOT_HOMED = 'the axes are not homed'
# What the axes read once they are homed, in m and rad: far more than a cycle's way from what they read before.
FIRST = (-1 / 32, 1 / 32, 1 / 128, 0.5)
SECOND = (1 / 64, 1 / 16, -1 / 256, -2.5)
JOB = gc.paper(flute_length=5 * MM, feed=3000 * MM_MIN, clearance=1 * MM)


def set_homed(homed):
    for axis in AXES:
        hal_bench.halcmd('sets', 'axis-%s-homed' % axis, str(homed))


def set_reference(motors, reading):
    """Lets the encoders of motors that stand somewhere read something."""
    for axis, motor, value in zip(AXES, motors, reading):
        hal_bench.halcmd('sets', 'reference-' + axis, repr(motor - value))


class TestHoming(unittest.TestCase):
    def setUp(self):
        hal_bench.patience(NEVER)
        set_homed(False)
        hal_bench.halcmd('sets', 'homing', 'false')
        node = hal_bench.Node()
        self.addCleanup(node.end)
        self.grinder = gc.Grinder()
        self.addCleanup(self.grinder.close)
        self.assertTrue(self.grinder.enable().success)
        self.grinder.wait_state(GrinderState.READY)
        self.limits, self.period = self.grinder.limits(), self.grinder.period()

    def machine_homes(self, reading):
        """Returns the rows until the machine is ready, and some in which the new commands count."""
        first = RECORDER.now()
        self.assertTrue(self.grinder.home().success)
        wait_signal('home', 'TRUE')
        hal_bench.halcmd('sets', 'homing', 'true')
        set_reference(RECORDER.over(1)[0].position, reading)
        # More than the FIFO holds, so that some of it has the old reference and some of it the new one.
        RECORDER.over(int(hal_bench.BUFFER / self.period / 2))
        set_homed(True)
        hal_bench.halcmd('sets', 'homing', 'false')
        self.grinder.wait_state(GrinderState.READY)
        wait_signal('home', 'FALSE')
        RECORDER.over(int(2 * hal_bench.BUFFER / self.period))
        return RECORDER.read()[first:]

    def check_still(self, rows):
        """Power is there all the time, and neither a motor nor its target moves but by rounding."""
        self.assertTrue(all(row.enabled for row in rows))
        self.assertEqual({row.underruns for row in rows}, {rows[0].underruns})
        for places in ([row.command for row in rows], [row.position for row in rows]):
            for values in zip(*places):
                self.assertLess(max(values) - min(values), 1e-12)

    def check_steps(self, rows):
        """Of the motors' targets while there is power."""
        for a, b in zip(rows, rows[1:]):
            for axis, velocity in enumerate(self.limits['max_velocity']):
                self.assertLessEqual(abs(b.command[axis] - a.command[axis]), velocity * self.period * (1 + 1e-9))

    def check_reading(self, reading):
        for position, expected in zip(self.grinder.wait_rest(), reading):
            self.assertAlmostEqual(position, expected, delta=1e-12)

    def check_not_homed(self):
        state = self.grinder.fresh_state()
        self.assertEqual((state.state, state.homed), (GrinderState.READY, False))
        first = RECORDER.now()
        run = self.grinder.run(JOB)
        self.assertEqual((run.status, run.code, run.text),
                         ('ABORTED', GrindResult.NOT_READY, 'start refused: ' + NOT_HOMED))
        self.assertEqual(run.setpoints, [])
        self.check_still(RECORDER.read()[first:])

    def check_job(self, reading):
        """A job starts from where the axes stand by the new reference."""
        first = RECORDER.now()
        run = self.grinder.run(JOB)
        self.assertEqual((run.status, run.text), ('SUCCEEDED', ''))
        for reported, expected in zip(run.setpoints[0].position, reading):
            self.assertAlmostEqual(reported, expected, delta=1e-12)
        self.assertTrue(checks.is_gapless(run.setpoints))
        self.assertEqual(checks.excesses(run.setpoints, self.limits, self.period), [])
        self.check_reading(self.grinder.park())
        self.check_steps(RECORDER.read()[first:])

    def test_new_reference_makes_no_step(self):
        first = RECORDER.now()
        self.check_not_homed()
        for reading in (FIRST, SECOND):
            self.check_still(self.machine_homes(reading))
            state = self.grinder.fresh_state()
            self.assertEqual((state.state, state.homed), (GrinderState.READY, True))
            self.check_reading(reading)
            self.check_job(reading)
        self.check_steps(RECORDER.read()[first:])


def load_encoders():
    with open(hal_bench.ROOT + '/test/hal/incremental.hal') as file, tempfile.NamedTemporaryFile('w', suffix='.hal') as expanded:
        expanded.writelines(line.replace('@', axis) for line in file for axis in (AXES if '@' in line else 'x'))
        expanded.flush()
        hal_bench.halcmd('-f', expanded.name)


if __name__ == '__main__':
    load_encoders()
    rospy.init_node('test_hal_homing')
    rostest.rosrun('flute_grinder', 'hal_homing', '__main__')
