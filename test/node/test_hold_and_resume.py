"""Shows that the services that hold, retract, resume and slow down a job reach it, and that states, feedback and setpoints show what
comes of it. Every moment and state is gone through in test/control and test/motion."""

import unittest

from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks
from grinder_client import DEG, MM, MM_MIN, X, grinder

# Every axis moves in the stroke, and there is time to interfere, even on a host that stalls for seconds.
JOB = gc.paper(cone_angle=10 * DEG, flute_length=8 * MM, feed=400 * MM_MIN, clearance=1 * MM)
END = 9 * MM


class TestInterference(unittest.TestCase):
    def accept(self, service, *arguments):
        reply = getattr(grinder(), service)(*arguments)
        self.assertEqual((reply.success, reply.message), (True, ''))

    def test_job_that_is_held_retracted_resumed_and_slowed_down(self):
        g = grinder()
        g.make_ready_at_park()
        self.accept('set_feed_override', 0.05)
        reply = g.set_feed_override(1.21)
        self.assertEqual((reply.success, reply.message), (False, 'feed override = 1.21; allowed: 0 to 1.2'))
        run = g.send(JOB).wait_in_stroke(1 * MM)
        for service, state in (('hold', GrinderState.HELD), ('retract', GrinderState.RETRACTED)):
            self.accept(service)
            held = g.wait_state(state)
            self.assertEqual((held.feed, held.override), (0, 0.05))
            g.wait_rest()
            seen = len(run.feedback)
            g.wait_for(lambda: len(run.feedback) > seen + 2, 'feedback')
            on_path = max(s.position[X] for s in run.setpoints)
            self.assertAlmostEqual(run.feedback[-1].stroke_fraction, (on_path + 1 * MM) / (END + 1 * MM), delta=1e-4)
            for fields in ({}, {'dry_run': True}):
                other = g.send(gc.SHORT, **fields).wait()
                self.assertEqual((other.status, other.code), ('REJECTED', GrindResult.BUSY))
        self.accept('spindle_off')
        g.wait_fresh(lambda s: not s.spindle_at_speed, 'the wheel at rest')
        reply = g.resume()
        self.assertEqual((reply.success, reply.message), (False, 'resume refused: the spindle is not at speed'))
        self.assertEqual((g.fresh_state().state, g.fresh_state().hold_reason), (GrinderState.RETRACTED, ''))
        self.accept('spindle_on')
        g.wait_fresh(lambda s: s.spindle_at_speed, 'the wheel at its speed')
        self.accept('resume')
        g.wait_state(GrinderState.RUNNING)
        self.assertFalse(run.done)
        self.accept('set_feed_override', 1)
        run.wait_complete()
        self.assertEqual((run.status, run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), run.text)
        self.assertTrue(checks.is_gapless(run.setpoints))
        self.assertEqual(len(run.setpoints), run.result.setpoints_written)
        self.assertGreater(len(run.setpoints), run.result.plan.statistics.setpoints)
        self.assertEqual(list(run.setpoints[-1].position), g.park())
