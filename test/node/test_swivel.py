#!/usr/bin/env python3
"""Shows that a goal is refused until the swivel is at the job's angle, as an operator has confirmed it or as the drive measures it,
and how a client sees it. What the control loop makes of each angle is shown in test/control/test_swivel.cpp."""

import json
import math
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult, Reason

import grinder_client as gc
from grinder_client import DEG, MM_MIN

WANTED = 31.769
TO_SET = 'set it to 31.769 deg and confirm it: grind confirm-swivel 31.769'


class SwivelTest(unittest.TestCase):
    def start(self, swivel=None):
        """A node of its own, ready, with nothing confirmed."""
        parameters = gc.machine(pace=5)
        if swivel is not None:
            parameters['hardware']['swivel'] = swivel * DEG
        self.node = gc.NodeProcess('own_grinder', parameters)
        self.addCleanup(self.node.close)
        self.grinder = self.node.client()
        self.addCleanup(self.grinder.close)
        gc.poll(lambda: self.grinder.enable().success, 'the power on')
        self.grinder.wait_state(GrinderState.READY)
        return self.grinder

    def grind(self, status, *arguments):
        done = gc.grind('--node', self.node.name, *arguments)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def send(self, job=gc.SHORT, **fields):
        return self.grinder.send(job, confirm=False, **fields)

    def check_refused(self, detail, angle, text):
        """The goal and the command line's job are refused at once, and nothing moves."""
        rest = self.grinder.wait_rest()
        run = self.send().wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY), run.text)
        reason, = run.result.reasons
        self.assertEqual((reason.kind, reason.detail, reason.unit), (Reason.SWIVEL, detail, Reason.RADIAN))
        self.assertAlmostEqual(reason.limit, WANTED * DEG, delta=1e-12)
        self.assertAlmostEqual(reason.low, 0.05 * DEG, delta=1e-12)
        if angle is None:
            self.assertTrue(math.isnan(reason.value))
        else:
            self.assertAlmostEqual(reason.value, angle * DEG, delta=1e-12)
        self.assertEqual([f.state for f in run.feedback], [], 'it was not even planned')
        done = self.grind(1, 'run', gc.package_file('test/jobs/paper.yaml'), '--ignore-offset-check')
        self.assertIn('process.setup.swivel_deg = 31.769 deg: ' + text, done.stderr)
        self.assertEqual(self.grinder.fresh_state().state, GrinderState.READY)
        self.assertEqual(self.grinder.wait_rest(), rest)

    def check_runs(self, job=gc.SHORT, **fields):
        run = self.send(job, **fields).wait_complete()
        self.assertEqual((run.status, run.code), ('SUCCEEDED', GrindResult.SUCCESSFUL), run.text)

    def test_confirmed_by_an_operator(self):
        g = self.start()
        self.check_refused('', None, 'the swivel is not confirmed; ' + TO_SET)
        state = g.fresh_state()
        self.assertTrue(math.isnan(state.swivel))
        self.assertFalse(state.swivel_measured)
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^swivel +not confirmed$')
        status = json.loads(self.grind(0, 'status', '--json').stdout)
        self.assertEqual((status['swivel_deg'], status['swivel_measured']), (None, False))
        self.check_runs(dry_run=True)
        self.assertTrue(g.plan(gc.goal_of(gc.SHORT)).valid)
        for angle in (math.nan, math.inf, 90.01 * DEG):
            reply = g.confirm_swivel(angle)
            self.assertFalse(reply.success)
            self.assertRegex(reply.message, r'^confirm-swivel refused: \S+ deg; allowed: -90 deg to 90 deg$')
        for angle in (math.nan, 81 * DEG):
            run = self.send(gc.paper(setup_swivel=angle)).wait()
            self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL), run.text)
            self.assertRegex(run.text, r'process\.setup_swivel = \S+ rad; allowed: ')
        self.assertTrue(math.isnan(g.fresh_state().swivel))

        for angle in ('-31.769', '31.769'):
            self.grind(0, 'confirm-swivel', angle)
            self.assertAlmostEqual(g.fresh_state().swivel, float(angle) * DEG, delta=1e-15)
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^swivel +31\.769 deg, confirmed$')
        status = json.loads(self.grind(0, 'status', '--json').stdout)
        self.assertAlmostEqual(status['swivel_deg'], 31.769, delta=1e-12)
        self.check_runs()
        self.assertTrue(g.confirm_swivel(31.829 * DEG).success)
        self.check_refused('confirmed', 31.829,
                           'the swivel is confirmed at 31.829 deg; allowed: within 0.05 deg of that; ' + TO_SET)

    def test_turned_while_the_job_is_planned_it_does_not_start(self):
        g = self.start()
        self.assertTrue(g.confirm_swivel(WANTED * DEG).success)
        rest = g.wait_rest()
        # A stroke slow enough for the plan to take a while.
        run = self.send(gc.paper(feed=0.2 * MM_MIN))
        g.wait_for(lambda: any(f.state == 'planning' for f in run.feedback), 'planning')
        self.assertTrue(g.confirm_swivel(30 * DEG).success)
        run.wait()
        self.assertEqual((run.status, run.code), ('ABORTED', GrindResult.NOT_READY), run.text)
        self.assertIn('start refused: process.setup.swivel_deg = 31.769 deg: the swivel is confirmed at 30 deg; allowed: '
                      'within 0.05 deg of that; ' + TO_SET, run.text)
        self.assertEqual(g.wait_rest(), rest)

    def test_measured_by_the_drive(self):
        g = self.start(31.8)
        state = g.fresh_state()
        self.assertAlmostEqual(state.swivel, 31.8 * DEG, delta=1e-15)
        self.assertTrue(state.swivel_measured)
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^swivel +31\.8 deg, measured$')
        done = self.grind(1, 'confirm-swivel', '31.769')
        self.assertEqual(done.stderr, 'confirm-swivel refused: the drive measures the swivel, which stands at 31.8 deg; '
                                      'nothing is to be confirmed\n')

    def test_measured_elsewhere_the_job_is_refused(self):
        self.start(31.83)
        self.check_refused('measured', 31.83, 'the swivel stands at 31.83 deg; allowed: within 0.05 deg of that; set it to '
                                              '31.769 deg (code -7)')


if __name__ == '__main__':
    rospy.init_node('test_swivel')
    rostest.rosrun('flute_grinder', 'swivel', '__main__')
