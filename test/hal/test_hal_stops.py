"""Shows on the real HAL what stops the axes in the midst of a stroke: the emergency stop, a node that no longer lives, a node
that is late, a motor that does not follow. HAL does it by itself, the node reports it, nothing that was still to come is
played later, and the axes start again from where they stand."""

import re
import signal
import unittest

from flute_grinder.msg import GrinderState, GrindResult

import hal_bench
from hal_bench import gc
import path_checks as checks
from grinder_client import A, DEG, MM, STROKE, X, Y, Z

RECORDER = hal_bench.recorder()
# Longer than any host stalls.
NEVER = 1000
HEARTBEAT = 0.3
STEEP = gc.paper(cone_angle=20 * DEG, rake_angle=40 * DEG, clearance=1 * MM)
AGAIN = dict(STEEP, **{'cutter.flute_length': 5 * MM, 'process.feed': 3000 * gc.MM_MIN, 'process.clearance': 12 * MM})


class Stop:
    """What holds of every stop. Each test runs into the stop anew."""

    buffer = hal_bench.BUFFER

    def setUp(self):
        hal_bench.press_emergency_stop(False)
        hal_bench.patience(NEVER)
        self.start()
        self.grinder.make_ready(0.2)
        self.limits, self.period = self.grinder.limits(), self.grinder.period()
        self.goal_run = self.grinder.send(STEEP).wait_in_stroke(1 * MM)
        self.first = RECORDER.now()

    def start(self):
        self.node = hal_bench.Node(buffer=self.buffer)
        self.addCleanup(self.node.end)
        self.addCleanup(self.node.send, signal.SIGCONT)
        self.grinder = gc.Grinder()
        self.addCleanup(self.grinder.close)

    def wait_power_off(self):
        gc.poll(lambda: not RECORDER.over(1)[-1].enabled, 'the power off')

    def rows_from_stop(self):
        """From the first servo cycle without power after setUp()."""
        rows = RECORDER.read()
        return rows[next(i for i in range(self.first, len(rows)) if not rows[i].enabled):]

    def check_standing(self):
        """From the stop on, not one command is played, and the axes come to rest without a jump."""
        RECORDER.over(300)
        rows = RECORDER.read()[self.first:]
        self.assertEqual({row.command for row in self.rows_from_stop() if not row.enabled},
                         {self.rows_from_stop()[0].command})
        self.assertEqual({row.played for row in self.rows_from_stop() if not row.enabled},
                         {self.rows_from_stop()[0].played})
        self.assertEqual(len({row.position for row in RECORDER.over(100)}), 1)
        self.check_steps(rows)

    def check_steps(self, rows):
        for step, velocity in zip(hal_bench.max_steps(rows), self.limits['max_velocity']):
            self.assertLessEqual(step, velocity * self.period * (1 + 1e-9))

    def check_goal(self, code, text):
        self.goal_run.wait()
        self.assertEqual((self.goal_run.status, self.goal_run.code), ('ABORTED', code), self.goal_run.text)
        self.assertRegex(self.goal_run.text, text)
        self.assertRegex(self.goal_run.text, r'\(stroke, tooth 1, pass 1, X = [1-3]?\d(\.\d+)? mm\)')

    def check_start_from_standing(self):
        """Reset, power, the wheel lifted where it is in the work, and a new goal: the axes start from where they stand."""
        first = RECORDER.now()
        standing = RECORDER.over(1)[0].position
        self.grinder.make_ready()
        powered = next(row for row in RECORDER.read()[first:] if row.enabled)
        self.assertEqual(powered.command, standing)
        lifted = RECORDER.over(1)[0].position
        self.assertEqual([lifted[axis] for axis in (X, Z, A)], [standing[axis] for axis in (X, Z, A)])
        self.assertGreaterEqual(lifted[Y], standing[Y])
        run = self.grinder.run(AGAIN)
        self.assertEqual((run.status, run.text), ('SUCCEEDED', ''))
        self.assertEqual(tuple(run.setpoints[0].position), lifted)
        self.check_steps(RECORDER.read()[first:])


class TestEmergencyStop(Stop, unittest.TestCase):
    # So much that it cannot be its end that stops the axes.
    buffer = 1.0

    def test_hal_stops_without_the_node_which_reports_it(self):
        self.node.send(signal.SIGSTOP)
        hal_bench.press_emergency_stop(True)
        self.wait_power_off()
        self.check_standing()
        # In the very servo cycle, or the next.
        rows = RECORDER.read()
        pressed = next(i for i in range(self.first, len(rows)) if rows[i].emergency_stop)
        self.assertTrue(rows[pressed - 1].enabled)
        self.assertFalse(rows[pressed + 1].enabled)
        self.assertEqual(len({row.command for row in rows[pressed + 1:]}), 1)
        self.node.send(signal.SIGCONT)
        self.check_goal(GrindResult.EMERGENCY_STOP, r'^emergency stop')
        self.assertTrue(self.grinder.wait_state(GrinderState.FAULT).emergency_stop)
        self.assertFalse(self.grinder.reset().success)
        hal_bench.press_emergency_stop(False)
        self.check_standing()
        self.check_start_from_standing()


class TestHeartbeat(Stop, unittest.TestCase):
    # The heartbeat's time is over ahead of the buffer, whatever the host does meanwhile.
    buffer = 1.0

    def expect_heartbeat(self):
        hal_bench.patience(HEARTBEAT)
        # The watchdog takes the new time with the next beat.
        self.assertTrue(RECORDER.over(5)[-1].enabled)

    def test_stopped_node_loses_power_and_plays_nothing_later(self):
        self.expect_heartbeat()
        self.node.send(signal.SIGSTOP)
        self.wait_power_off()
        self.check_standing()
        # HAL has opened the chain ahead of the end of the FIFO, because no heartbeat came.
        self.assertEqual({row.underruns for row in RECORDER.read()[self.first:]}, {RECORDER.rows[self.first].underruns})
        hal_bench.patience(NEVER)
        self.node.send(signal.SIGCONT)
        self.check_goal(GrindResult.HARDWARE_FAULT, r'^the drive has switched its power off')
        self.check_standing()
        self.check_start_from_standing()

    def test_killed_node_loses_power_and_a_new_one_takes_over(self):
        hal_bench.wait_signal('spindle-at-speed', 'TRUE')
        self.expect_heartbeat()
        self.node.end(signal.SIGKILL)
        self.wait_power_off()
        hal_bench.wait_signal('spindle-at-speed', 'FALSE')
        hal_bench.wait_signal('coolant-on', 'FALSE')
        hal_bench.patience(NEVER)
        self.assertEqual({row.underruns for row in RECORDER.read()[self.first:]}, {RECORDER.rows[self.first].underruns})
        self.check_standing()
        standing = RECORDER.over(1)[0].position
        self.grinder.close()
        self.start()
        self.assertEqual(self.grinder.fresh_state().state, GrinderState.DISABLED)
        self.assertEqual(tuple(self.grinder.wait_rest()), standing)
        self.check_standing()
        self.check_start_from_standing()


class TestUnderrun(Stop, unittest.TestCase):
    def test_late_node_is_reported_with_count_and_setpoint(self):
        before = RECORDER.rows[self.first - 1].underruns
        self.node.send(signal.SIGSTOP)
        self.wait_power_off()
        self.check_standing()
        counted = RECORDER.over(1)[0].underruns - before
        self.assertGreaterEqual(counted, 1)
        self.node.send(signal.SIGCONT)
        self.check_goal(GrindResult.HARDWARE_FAULT, r'^the axes found no setpoint in \d+ servo cycles, after setpoint \d+ ')
        count, last = map(int, re.findall(r'\d+', self.goal_run.text)[:2])
        self.assertEqual(count, counted)
        self.grinder.fresh_state()
        setpoints = self.goal_run.setpoints
        self.assertEqual(setpoints[-1].cycle, last)
        self.assertTrue(checks.is_gapless(setpoints))
        # All of them were played, and the axes stand at the last one.
        self.assertEqual(self.rows_from_stop()[0].command, tuple(setpoints[-1].position))
        self.check_standing()
        self.check_start_from_standing()


class TestFollowingError(Stop, unittest.TestCase):
    def test_hal_trips_where_a_motor_does_not_follow(self):
        # Less than the node allows, so that HAL is first.
        hal_bench.halcmd('setp', 'window-x.max', '0.0005')
        self.addCleanup(hal_bench.halcmd, 'setp', 'window-x.max', '0.002')
        hal_bench.halcmd('setp', 'motor-x.maxv', '0.0001')
        self.addCleanup(hal_bench.halcmd, 'setp', 'motor-x.maxv', '0.25')
        self.check_goal(GrindResult.HARDWARE_FAULT, r'^the drive reports a fault')
        self.check_standing()
        hal_bench.halcmd('setp', 'motor-x.maxv', '0.25')
        self.assertTrue(self.grinder.reset().success)
        self.check_start_from_standing()


class TestHold(Stop, unittest.TestCase):
    def test_it_takes_the_buffer_and_a_cancel_then_lifts(self):
        self.assertTrue(self.grinder.hold().success)
        self.grinder.wait_state(GrinderState.HELD)
        # Held is reported when the axes have got the last setpoint.
        row = RECORDER.over(1)[0]
        self.assertEqual(row.command, row.position)
        self.assertEqual({r.command for r in RECORDER.over(300)}, {row.command})
        self.assertTrue(all(r.enabled for r in RECORDER.read()[self.first:]))
        self.goal_run.cancel()
        self.goal_run.wait()
        self.assertEqual((self.goal_run.status, self.goal_run.code), ('PREEMPTED', GrindResult.CANCELED))
        row = RECORDER.over(1)[0]
        self.assertEqual(row.command, row.position)
        self.assertEqual({r.command for r in RECORDER.over(300)}, {row.command})
        self.grinder.fresh_state()
        self.assertEqual(row.command, tuple(self.goal_run.setpoints[-1].position))
        setpoints = self.goal_run.setpoints
        stroke_end = max(i for i, s in enumerate(setpoints) if s.move == STROKE)
        self.assertGreater(len(setpoints) - stroke_end, 2, 'the wheel was lifted')
        for axis in (X, Z, A):
            self.assertEqual(len({s.position[axis] for s in setpoints[stroke_end:]}), 1)
        self.assertEqual(checks.excesses(self.goal_run.setpoints, self.limits, self.period), [])
