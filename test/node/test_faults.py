"""Shows what a client learns of a fault of the drive in the middle of a stroke, for every kind that the simulated drive can inject:
the goal ends with the right code and words, requests are refused with a reason, and after reset, enable and lift the grinder is
back in use. What the control loop does, cycle by cycle, is shown in test/control."""

import unittest

from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks
from grinder_client import DEG, MM, MM_MIN, STROKE, X, Y, grinder

# Steep enough for every axis to move by more than its following error may be.
STEEP = gc.paper(cone_angle=20 * DEG, rake_angle=40 * DEG, clearance=1 * MM, feed=400 * MM_MIN)

# fault, axis: code and text of the result
FAULTS = {
    ('drive_fault', X): (GrindResult.HARDWARE_FAULT, r'^the drive reports a fault: injected'),
    ('stale_feedback', X): (GrindResult.LINK_LOST, r'^no fresh positions from the drive for 0\.\d+ s, allowed 0\.002 s'),
    ('nan_feedback', Y): (GrindResult.HARDWARE_FAULT, r'^axis Y position from the drive is -?nan'),
    ('stuck_axis', X): (GrindResult.PATH_TOLERANCE_VIOLATED,
                               r'^axis X following error 1\.?\d* mm is beyond its limit 1 mm'),
}
WHERE = r'\(stroke, tooth 1, pass 1, X = [12]?\d(\.\d+)? mm\)'


class TestFaultInTheStroke(unittest.TestCase):
    def run_with(self, fault, axis=X):
        """A run in whose stroke there is a fault, and the state."""
        g = grinder()
        g.make_ready(0.1)
        run = g.send(STEEP).wait_in_stroke(0)
        reply = g.inject(fault, axis)
        self.assertTrue(reply.success, reply.message)
        return run, g.wait_state(GrinderState.FAULT)

    def check_end(self, run, state, code, text):
        run.wait_complete()
        self.assertEqual((run.status, run.code), ('ABORTED', code))
        self.assertRegex(run.text, text)
        self.assertRegex(run.text, WHERE)
        self.assertEqual((state.state_name, state.wheel_in_work), ('fault', True))
        self.assertRegex(state.fault, text)
        self.assertIn(state.fault, run.text)
        self.assertEqual(run.setpoints[-1].move, STROKE)
        self.assertTrue(checks.is_gapless(run.setpoints))

    def test_code_and_text_of_every_fault(self):
        for (fault, axis), (code, text) in FAULTS.items():
            with self.subTest(fault=fault, axis=axis):
                self.check_end(*self.run_with(fault, axis), code, text)

    def test_drive_that_hangs(self):
        """Nothing can be asked of the loop; its watchdog switches the power off, and the drive's return ends the job."""
        run, state = self.run_with('hang')
        self.assertRegex(state.fault, r'the drive reports a fault: it does not return to the control loop; its power is switched off')
        self.assertFalse(state.enabled)
        grinder().inject('none')
        run.wait_complete()
        self.assertEqual((run.status, run.code), ('ABORTED', GrindResult.HARDWARE_FAULT))
        self.assertRegex(run.text, 'it has returned to the control loop too late')
        grinder().wait_fresh(lambda s: s.fault == run.text.split(' (')[0], 'the fault of the state')

    def test_way_back_from_an_emergency_stop(self):
        g = grinder()
        self.check_end(*self.run_with('emergency_stop'), GrindResult.EMERGENCY_STOP, r'^emergency stop')
        state = g.fresh_state()
        self.assertEqual((state.enabled, state.emergency_stop), (False, True))
        refused = g.send(gc.SHORT).wait()
        self.assertEqual((refused.status, refused.code), ('REJECTED', GrindResult.NOT_READY))
        self.assertRegex(refused.text, r'state fault; allowed: disable, reset')
        g.inject('none')
        g.wait_fresh(lambda s: not s.emergency_stop, 'the emergency stop released')
        self.assertTrue(g.reset().success)
        self.assertEqual(g.wait_state(GrinderState.DISABLED).fault, '')
        at_reset = g.wait_rest()
        self.assertTrue(g.enable().success)
        self.assertTrue(g.wait_state(GrinderState.READY).wheel_in_work)
        refused = g.send(gc.SHORT).wait()
        self.assertEqual((refused.status, refused.code, refused.text), (
            'REJECTED', GrindResult.NOT_READY, 'the wheel is in the work of the last job; lift it first'))
        self.assertEqual(g.wait_rest(), at_reset)

        self.assertTrue(g.lift().success)
        g.wait_fresh(lambda s: not s.wheel_in_work, 'the wheel off the work')
        g.wait_state(GrinderState.READY)
        self.assertGreater(g.wait_rest()[Y], at_reset[Y])
        run = g.run(gc.SHORT)
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
