#!/usr/bin/env python3
"""Shows that nothing moves until the swivel stands where the job needs it: as an operator has confirmed since the node's start,
or as the drive measures it, also while the job runs."""

import json
import math
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult, Reason

import grinder_client as gc
from grinder_client import DEG, MM, MM_MIN

ASKED = 31.769
# Long enough for something to happen meanwhile.
LONG = gc.paper(feed=1500 * MM_MIN)
TO_SET = 'set it to 31.769 deg and confirm it: grind confirm-swivel 31.769'


class OwnNode(unittest.TestCase):
    """A node for each test, ready, with nothing confirmed."""

    swivel = None

    def setUp(self):
        self.parameters = gc.machine()
        if self.swivel is not None:
            self.parameters['hardware']['swivel'] = self.swivel * DEG
        self.start_node()

    def start_node(self):
        self.node = gc.NodeProcess('own_grinder', self.parameters)
        self.addCleanup(self.node.close)
        self.grinder = self.node.client()
        self.addCleanup(self.grinder.close)
        gc.poll(lambda: self.grinder.enable().success, 'the power on')
        self.grinder.wait_state(GrinderState.READY)

    def grind(self, status, *arguments):
        done = gc.grind('--node', self.node.name, *arguments)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def send(self, job=gc.SHORT, **fields):
        return self.grinder.send(job, confirm=False, **fields)

    def check_refused(self, detail, angle):
        """The goal is refused at once, and nothing moves."""
        rest = self.grinder.wait_rest()
        run = self.send().wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY), run.text)
        reason, = run.result.reasons
        self.assertEqual((reason.kind, reason.detail, reason.unit), (Reason.SWIVEL, detail, Reason.RADIAN))
        self.assertAlmostEqual(reason.limit, ASKED * DEG, delta=1e-12)
        self.assertAlmostEqual(reason.low, 0.05 * DEG, delta=1e-12)
        if angle is None:
            self.assertTrue(math.isnan(reason.value))
        else:
            self.assertAlmostEqual(reason.value, angle * DEG, delta=1e-12)
        self.assertEqual([f.state for f in run.feedback], [], 'it was not even planned')
        self.assertEqual(self.grinder.fresh_state().state, GrinderState.READY)
        self.assertEqual(self.grinder.wait_rest(), rest)
        return run

    def check_runs(self, job=gc.SHORT, **fields):
        run = self.send(job, **fields).wait_complete()
        self.assertEqual((run.status, run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), run.text)
        return run


class TestConfirmed(OwnNode):
    def test_unconfirmed_is_refused(self):
        self.check_refused('', None)
        state = self.grinder.fresh_state()
        self.assertTrue(math.isnan(state.swivel))
        self.assertFalse(state.swivel_measured)
        done = self.grind(1, 'run', gc.package_file('jobs/paper.yaml'), '--offsets-are-right')
        self.assertIn('process.setup.swivel_deg = 31.769 deg: the swivel is not confirmed; ' + TO_SET, done.stderr)

    def test_dry_run_needs_none(self):
        self.check_runs(dry_run=True)
        self.assertTrue(math.isnan(self.grinder.fresh_state().swivel))

    def test_plan_needs_none(self):
        self.assertTrue(self.grinder.plan(gc.goal_of(gc.SHORT)).valid)

    def test_within_the_tolerance_it_runs(self):
        for off in (-0.04, 0.04):
            self.assertTrue(self.grinder.confirm_swivel((ASKED + off) * DEG).success)
            self.check_runs()

    def test_beyond_the_tolerance_it_is_refused(self):
        for off in (-0.06, 0.06):
            self.assertTrue(self.grinder.confirm_swivel((ASKED + off) * DEG).success)
            self.check_refused('confirmed', ASKED + off)
        done = self.grind(1, 'run', gc.package_file('jobs/paper.yaml'), '--offsets-are-right')
        self.assertIn('the swivel is confirmed at 31.829 deg; allowed: within 0.05 deg of that; ' + TO_SET, done.stderr)

    def test_command_line_confirms_it(self):
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^swivel +not confirmed$')
        told = json.loads(self.grind(0, 'status', '--json').stdout)
        self.assertEqual((told['swivel_deg'], told['swivel_measured']), (None, False))
        for angle in ('-31.769', '0', '31.769'):
            self.grind(0, 'confirm-swivel', angle)
            self.assertAlmostEqual(self.grinder.fresh_state().swivel, float(angle) * DEG, delta=1e-15)
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^swivel +31\.769 deg, confirmed$')
        told = json.loads(self.grind(0, 'status', '--json').stdout)
        self.assertAlmostEqual(told['swivel_deg'], 31.769, delta=1e-12)
        self.assertFalse(told['swivel_measured'])
        self.check_runs()

    def test_wrong_angles_are_refused(self):
        for angle in (math.nan, math.inf, -math.inf, 90.01 * DEG, -2.0):
            reply = self.grinder.confirm_swivel(angle)
            self.assertFalse(reply.success)
            self.assertRegex(reply.message, r'^confirm-swivel refused: \S+ deg; allowed: -90 deg to 90 deg$')
        self.assertTrue(math.isnan(self.grinder.fresh_state().swivel))

    def test_restart_forgets_it(self):
        self.assertTrue(self.grinder.confirm_swivel(ASKED * DEG).success)
        self.check_runs()
        self.grinder.close()
        self.node.close()
        self.start_node()
        self.check_refused('', None)

    def test_it_must_not_be_turned_during_a_job(self):
        self.assertTrue(self.grinder.confirm_swivel(ASKED * DEG).success)
        run = self.send(LONG).wait_in_stroke(2 * MM)
        reply = self.grinder.confirm_swivel(30 * DEG)
        self.assertFalse(reply.success)
        self.assertEqual(reply.message, 'confirm-swivel refused: a job is in progress that needs 31.769 deg; '
                                        'allowed: that angle, or to end the job first')
        self.assertTrue(self.grinder.confirm_swivel(ASKED * DEG).success)
        run.wait_complete()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertTrue(self.grinder.confirm_swivel(30 * DEG).success)
        self.check_refused('confirmed', 30)

    def test_turned_while_the_job_is_planned_it_does_not_start(self):
        # A stroke slow enough for the plan to take a while.
        self.assertTrue(self.grinder.confirm_swivel(ASKED * DEG).success)
        rest = self.grinder.wait_rest()
        run = self.send(gc.paper(feed=0.2 * MM_MIN))
        self.grinder.wait_for(lambda: any(f.state == 'planning' for f in run.feedback), 'planning')
        self.assertTrue(self.grinder.confirm_swivel(30 * DEG).success)
        run.wait()
        self.assertEqual((run.status, run.code), ('ABORTED', GrindResult.NOT_READY), run.text)
        self.assertIn('start refused: process.setup.swivel_deg = 31.769 deg: the swivel is confirmed at 30 deg; allowed: '
                      'within 0.05 deg of that; ' + TO_SET, run.text)
        self.assertEqual(self.grinder.wait_rest(), rest)

    def test_what_is_wrong_with_a_job_comes_first(self):
        for angle in (math.nan, 81 * DEG):
            run = self.send(gc.paper(setup_swivel=angle)).wait()
            self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL), run.text)
            self.assertRegex(run.text, r'process\.setup_swivel = \S+ rad; allowed: ')


class TestMeasured(OwnNode):
    """A drive with an encoder answers by itself."""

    swivel = 31.8

    def test_job_runs_without_a_confirmation(self):
        state = self.grinder.fresh_state()
        self.assertAlmostEqual(state.swivel, 31.8 * DEG, delta=1e-15)
        self.assertTrue(state.swivel_measured)
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^swivel +31\.8 deg, measured$')
        self.check_runs()

    def test_confirmation_is_not_accepted(self):
        done = self.grind(1, 'confirm-swivel', '31.769')
        self.assertEqual(done.stderr, 'confirm-swivel refused: the drive measures the swivel, which stands at 31.8 deg; '
                                      'nothing is to be confirmed\n')
        self.assertAlmostEqual(self.grinder.fresh_state().swivel, 31.8 * DEG, delta=1e-15)

    def test_swivel_that_slips_lifts_the_wheel(self):
        run = self.send(LONG).wait_in_stroke(2 * MM)
        self.assertTrue(self.grinder.inject('swivel_slipped').success)
        state = self.grinder.wait_state(GrinderState.RETRACTED)
        self.assertEqual(state.hold_reason, "the swivel is not at the job's angle")
        self.assertFalse(state.wheel_in_work)
        # 0.002 rad
        self.assertAlmostEqual(state.swivel, 31.8 * DEG + 0.002, delta=1e-12)
        reply = self.grinder.resume()
        self.assertEqual((reply.success, reply.message), (False, "resume refused: the swivel is not at the job's angle"))
        self.assertTrue(self.grinder.inject('none').success)
        gc.poll(lambda: abs(self.grinder.fresh_state().swivel - 31.8 * DEG) < 1e-12, 'the swivel back')
        self.assertTrue(self.grinder.resume().success)
        run.wait_complete()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)


class TestMeasuredElsewhere(OwnNode):
    swivel = 31.83

    def test_job_is_refused(self):
        run = self.check_refused('measured', 31.83)
        self.assertIn('the swivel stands at ', run.text)
        done = self.grind(1, 'run', gc.package_file('jobs/paper.yaml'), '--offsets-are-right')
        self.assertIn('process.setup.swivel_deg = 31.769 deg: the swivel stands at 31.83 deg; allowed: within 0.05 deg of '
                      'that; set it to 31.769 deg (code -7)', done.stderr)


if __name__ == '__main__':
    rospy.init_node('test_swivel')
    rostest.rosrun('flute_grinder', 'swivel', '__main__')
