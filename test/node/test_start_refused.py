"""Shows that a goal is refused until the machine is homed, and the swivel at the job's angle, as an operator has confirmed it or as
the drive measures it; how a client sees it, and that the machine homes. What the control loop makes of reference and angle, at
every moment of a job, is shown in test/control."""

import math

import rospy
from flute_grinder.msg import GrinderState, GrindResult, Reason, WorkOffsets

import grinder_client as gc
from grinder_client import DEG

TO_SET = 'set it to 31.769 deg and confirm it: grind confirm-swivel 31.769'


class TestHoming(gc.OwnNode):
    def test_machine_whose_encoders_do_not_know_where_it_is(self):
        parameters = gc.machine(pace=5)
        hardware = parameters['hardware']
        hardware.update(absolute_encoders=False, spindle_run_up_time=0)
        hardware['axis_x']['start_position'] = -0.045
        hardware['axis_a']['start_position'] = 3.0
        g = self.start(parameters)
        state = g.fresh_state()
        self.assertEqual((state.state_name, state.homed, state.enabled), ('disabled', False, False))
        self.assertTrue(g.enable().success)
        self.assertFalse(g.wait_state(GrinderState.READY).homed)
        run = g.send(gc.SHORT).wait()
        self.assertEqual((run.status, run.code, run.text),
                         ('ABORTED', GrindResult.NOT_READY, 'start refused: the axes are not homed'))
        self.assertEqual(run.setpoints, [])
        run = g.send(gc.SHORT, dry_run=True).wait()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertRegex(self.said('status'), r'(?m)^homed +no$')
        self.assertEqual(set(g.positions_over(0.2)), {(0, 0, 0, 0)}, 'it does not home by itself')

        self.assertEqual(self.said('home'), 'homed\n')
        self.assertTrue(g.fresh_state().homed)
        self.assertRegex(self.said('status'), r'(?m)^homed +yes$')
        for joint, position in zip(gc.JOINTS, g.wait_rest()):
            self.assertAlmostEqual(position, hardware[joint]['home_position'], delta=1e-6)
        run = g.run(gc.SHORT)
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)


class TestSwivel(gc.OwnNode):
    def start_ready(self, swivel=None):
        """A node of its own, ready, with nothing confirmed."""
        parameters = gc.machine(pace=5)
        if swivel is not None:
            parameters['hardware']['swivel'] = swivel * DEG
        g = self.start(parameters)
        gc.poll(lambda: g.enable().success, 'the power on')
        g.wait_state(GrinderState.READY)
        return g

    def send(self, **fields):
        return self.client.send(gc.SHORT, confirm=False, **fields)

    def check_refused(self, text):
        """The goal and the command line's job are refused at once, and nothing moves."""
        rest = self.client.wait_rest()
        run = self.send().wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY), run.text)
        self.assertEqual([reason.kind for reason in run.result.reasons], [Reason.SWIVEL])
        self.assertEqual([f.state for f in run.feedback], [], 'it was not even planned')
        done = self.grind(1, 'run', gc.package_file('test/jobs/paper.yaml'), '--answer', 'ignore-offsets')
        self.assertIn('process.setup.swivel_deg = 31.769 deg: ' + text, done.stderr)
        self.assertEqual(self.client.fresh_state().state, GrinderState.READY)
        self.assertEqual(self.client.wait_rest(), rest)

    def test_confirmed_by_an_operator(self):
        g = self.start_ready()
        self.check_refused('the swivel is not confirmed; ' + TO_SET)
        state = g.fresh_state()
        self.assertTrue(math.isnan(state.swivel))
        self.assertFalse(state.swivel_measured)
        self.assertRegex(self.said('status'), r'(?m)^swivel +not confirmed$')
        status = self.json('status')
        self.assertEqual((status['swivel_deg'], status['swivel_measured']), (None, False))
        self.assertEqual(self.send(dry_run=True).wait().status, 'SUCCEEDED')
        for angle in ('31.769', '-31.769'):
            self.grind(0, 'confirm-swivel', angle)
            self.assertAlmostEqual(g.fresh_state().swivel, float(angle) * DEG, delta=1e-15)
        self.assertRegex(self.said('status'), r'(?m)^swivel +-31\.769 deg, confirmed$')
        self.assertAlmostEqual(self.json('status')['swivel_deg'], -31.769, delta=1e-12)
        self.check_answers_to_what_was_shown()

    def check_answers_to_what_was_shown(self):
        """A goal is sent again with them."""
        rejected = self.send(answers=['discard']).wait()
        needs = rejected.result.plan.needs
        self.assertEqual([need.name for need in needs], ['wheel', 'offsets', 'swivel'])
        answers = ['discard'] + [need.answers[-1].id for need in needs]
        # Somebody else sets a zero point before it is answered: what was shown is no longer so.
        self.assertTrue(self.client.set_offset(gc.X, 0.001).success)
        again = self.send(answers=answers).wait()
        self.assertEqual([need.name for need in again.result.plan.needs], ['offsets'])
        offsets = rospy.wait_for_message('/%s/offsets' % self.node.name, WorkOffsets, gc.PATIENCE)
        self.assertEqual(offsets.wheel.diameter, 100 * gc.MM, 'that was answered')
        run = self.send(answers=answers + [again.result.plan.needs[0].answers[-1].id]).wait()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertAlmostEqual(self.client.fresh_state().swivel, gc.part_of(gc.goal_of(gc.SHORT), 'process').setup_swivel, delta=1e-12)

    def test_measured_by_the_drive(self):
        g = self.start_ready(31.8)
        state = g.fresh_state()
        self.assertAlmostEqual(state.swivel, 31.8 * DEG, delta=1e-15)
        self.assertTrue(state.swivel_measured)
        self.assertRegex(self.said('status'), r'(?m)^swivel +31\.8 deg, measured$')
        done = self.grind(1, 'confirm-swivel', '31.769')
        self.assertEqual(done.stderr, 'confirm-swivel refused: the drive measures the swivel, which is at 31.8 deg; '
                                      'nothing is to be confirmed\n')
