"""Shows that work offsets are set as asked for, and refused with the reason; that they outlive the process, or are reported to be
unknown; and that nothing changes them while a job depends on them. That a job is ground where they say is shown in test_frames.py
and in test/control/test_work_offsets.cpp."""

import hashlib
import math
import os
import signal
import threading
import time

import rospy
from flute_grinder.msg import GrinderState, GrindResult, Legend, OffsetBasis, WorkOffsets

import grinder_client as gc
from grind_command import Command
from grinder_client import A, DEG, MM, MM_MIN, STROKE, X, Y, Z

# The job then stays within the machine's limits, and the cutter stands out of the collet, not in.
OFFSETS = [-0.0213, 0.0237, -0.0119, 1.25]
# Time enough to do something in a stroke.
SLOW = gc.paper(feed=60 * MM_MIN, clearance=1 * MM)


class OffsetsTest(gc.OwnNode):
    """With a ready node of its own for each test."""

    def setUp(self):
        self.folder = gc.temp_folder(self.addCleanup)
        self.file = os.path.join(self.folder, 'offsets')
        self.start()
        self.client.make_ready()

    def start(self, environment=(), **changes):
        """Starts a node on the folder."""
        parameters = gc.machine(pace=5)
        parameters.update(journal=os.path.join(self.folder, 'journal'), offsets=self.file)
        parameters['hardware']['spindle_run_up_time'] = 0.0
        parameters['hardware'].update(changes)
        super().start(parameters, environment=environment)

    def restart(self, **arguments):
        self.node.end(signal.SIGTERM)
        self.client.wait_end_of_connections()
        self.start(**arguments)

    def set_offsets(self, values):
        for axis, value in enumerate(values):
            answer = self.client.set_offset(axis, value)
            self.assertTrue(answer.success, answer.message)

    def offsets(self):
        return rospy.wait_for_message('/%s/offsets' % self.client.name, WorkOffsets, gc.PATIENCE)

    def grind_answering(self, answer, status, *arguments):
        """At a terminal, where each of its questions gets the answer, and nothing before the first; what it says there."""
        return self.grind_typed_ahead('', answer, status, *arguments)

    def grind_typed_ahead(self, typed, answer, status, *arguments):
        command = Command('--node', self.node.name, *arguments, columns=200, typed=typed)
        self.addCleanup(command.close)
        answered = []

        def ended():
            if command.text.count('Enter for none: ') > len(answered):
                answered.append(command.type(answer))
            return command.process.poll() is not None

        gc.poll(ended, 'its end')
        self.assertEqual(command.end(), status, command.text)
        return command.text

    def check_refused(self, answer, text):
        self.assertFalse(answer.success)
        self.assertIn(text, answer.message)


class TestSetting(OffsetsTest):
    def test_touch_off_where_the_axes_stand(self):
        rest = self.client.wait_rest()
        before = time.time()
        answer = self.client.touch_off(Y, 0.0125)
        self.assertTrue(answer.success, answer.message)
        self.assertAlmostEqual(answer.value, rest[Y] - 0.0125, delta=1e-12)
        offsets = self.offsets()
        self.assertEqual(tuple(offsets.values), (0, answer.value, 0, 0))
        self.assertEqual(offsets.set_by, ['', 'anna@grinder', '', ''])
        self.assertTrue(before - 1 <= offsets.set_at[Y].to_sec() <= time.time() + 1)
        self.assertTrue(offsets.set_at[X].is_zero())
        self.assertAlmostEqual(self.client.fresh_state().work_position[Y], 0.0125, delta=1e-12)

    def test_wrong_ones_are_refused(self):
        self.check_refused(self.client.set_offset(4, 0), 'axis = 4; allowed: 0 to 3 for X, Y, Z, A')
        self.check_refused(self.client.touch_off(255, 0), 'axis = 255; allowed: 0 to 3')
        self.check_refused(self.client.set_offset(X, 0.3001),
                           'work offset of axis X = 300.1 mm; allowed: -100 to 300 mm, the travel of the axis')
        self.check_refused(self.client.touch_off(A, math.nan), ' deg, the travel of the axis')
        for wrong, text in (({'method': 5}, 'basis.method = 5; allowed: 0 to 4'), ({'swivel': math.nan}, 'not finite'),
                            ({'wheel_digest': 'A' * 64}, 'allowed: 64 hexadecimal digits'),
                            ({'job_name': '\n'}, 'basis.job_name'), ({'wheel_name': 256 * 'w'}, 'basis.wheel_name')):
            self.check_refused(self.client.set_offset(X, 0, basis=OffsetBasis(**wrong)), text)
        self.check_refused(self.client.set_offset(X, 0, 256 * 'n'), 'set_by has 256 characters; allowed: up to 255')
        self.check_refused(self.client.set_offset(X, 0, 'an\nna'), 'none that controls a terminal')
        self.assertEqual(tuple(self.offsets().values), (0, 0, 0, 0))
        self.assertFalse(os.path.exists(self.file))

    def check_both_refused(self, text):
        self.check_refused(self.client.set_offset(Y, 0.01), text)
        self.check_refused(self.client.touch_off(Y, 0.01), text)
        self.assertEqual(tuple(self.offsets().values), (0, 0, 0, 0))

    def test_refused_while_a_job_needs_them(self):
        run = self.client.send(SLOW).wait_in_stroke(1 * MM)
        self.check_both_refused('the machine is in state running; allowed: ready, disabled')
        run.cancel()
        run.wait()
        # A plan of a second or more: no pass is like another.
        run = self.client.send(gc.paper(feed=1 * MM_MIN, infeed=0.2 * MM, depth_end=1.59 * MM))
        self.client.wait_for(lambda: run.feedback, 'feedback')
        self.check_both_refused('a job is being planned')
        run.cancel()
        run.wait()
        self.assertTrue(self.client.set_offset(Y, 0.01).success)

    def test_refused_without_the_reference_and_while_homing(self):
        # Y homes first, and needs a second.
        self.restart(absolute_encoders=False, axis_y=dict(gc.machine()['hardware']['axis_y'], start_position=0.03))
        self.check_both_refused('the axes are not homed')
        self.assertTrue(self.client.enable().success)
        self.client.wait_state(GrinderState.READY)
        self.check_both_refused('the axes are not homed')
        self.assertTrue(self.client.home().success)
        self.check_both_refused('the machine is in state homing')

    def test_nothing_waits_for_the_disk(self):
        disk = gc.SlowDisk(self.folder)
        self.restart(environment=disk.environment)
        self.client.make_ready()
        disk.stop()
        answers = []
        setting = threading.Thread(target=lambda: answers.append(self.client.set_offset(X, 0.01)))
        setting.start()
        try:
            gc.poll(lambda: os.path.exists(self.file + '.new'), 'the new file')
            run = self.client.send(gc.SHORT).wait()
            self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY))
            self.assertIn('a work offset is being set, or the machine probes', run.text)
            self.assertEqual(tuple(self.offsets().values), (0, 0, 0, 0))
            self.assertTrue(self.client.disable().success)
            self.client.wait_state(GrinderState.DISABLED)
            self.assertEqual(answers, [], 'not before it is on the disk')
        finally:
            disk.release()
            setting.join()
        self.assertTrue(answers[0].success, answers[0].message)
        self.assertEqual(tuple(self.offsets().values), (0.01, 0, 0, 0))


class TestUse(OffsetsTest):
    def test_damaged_ones_are_reported_and_no_job_starts_until_all_are_set(self):
        self.set_offsets(OFFSETS)
        self.node.end(signal.SIGTERM)
        with open(self.file) as file:
            text = file.read()
        with open(self.file, 'w') as file:
            file.write(text.replace('axis_x_m: -', 'axis_x_m: '))
        self.start()
        self.client.make_ready()
        reported = 'unknown work offsets of axis_x, axis_y, axis_z, axis_a: file of work offsets %s: its checksum is wrong' % self.file
        self.assertIn(reported, self.node.output)
        offsets = self.offsets()
        self.assertTrue(all(math.isnan(v) for v in offsets.values))
        self.assertIn(reported, offsets.error)
        self.assertTrue(all(math.isnan(v) for v in self.client.fresh_state().work_position))
        self.assertEqual(self.said('offsets').count(' cannot be read\n'), 4)
        for fields in ({}, {'dry_run': True}):
            run = self.client.send(gc.SHORT, **fields).wait()
            self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY))
            self.assertIn(reported, run.text)
        self.set_offsets(OFFSETS)
        self.assertEqual(self.offsets().error, '')
        self.assertEqual(self.client.send(gc.SHORT, dry_run=True).wait().status, 'SUCCEEDED')

    def test_a_job_is_continued_with_its_own_offsets_only(self):
        self.set_offsets(OFFSETS)
        job = gc.paper(flute_length=5 * MM, feed=120 * MM_MIN, clearance=1 * MM, tooth_angles=[0.0, 1.0])
        run = self.client.send(job).wait_past(lambda s: s.tooth == 1 and s.move == STROKE, 'the second tooth')
        run.cancel()
        run.wait()
        self.assertTrue(self.client.set_offset(Y, OFFSETS[Y] + 0.0001).success)
        # Nor does an answer help: what is discarded is not continued.
        for answers in (['ignore-offsets'], ['discard', 'ignore-offsets']):
            run = self.client.send(job, first_tooth=1, answers=answers).wait()
            self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY))
            self.assertIn('it began with other work offsets; that of axis Y was 23.7 mm and is 23.8 mm', run.text)
        self.assertTrue(self.client.set_offset(Y, OFFSETS[Y]).success)
        # Nobody has said what they were set for, but that they are right was said when it began.
        run = self.client.send(job, first_tooth=1, answers=[]).wait()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)


class TestZeroPoints(OffsetsTest):
    """An offset is known for what it was set."""

    def check_rejected(self, text, answers=('discard',)):
        run = self.client.send(gc.SHORT, answers=list(answers)).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY))
        self.assertIn(text, run.text)

    def check_reported(self, *texts):
        """As a need where nothing moves."""
        plan = self.client.plan(gc.goal_of(gc.SHORT, answers=[])).plan
        self.assertTrue(plan.valid)
        needs = [need for need in plan.needs if need.name in ('wheel', 'offsets')]
        self.assertEqual([need.text for need in needs], list(texts))

    def test_a_plan_is_shown_until_a_zero_point_is_another(self):
        legends = gc.received(self.addCleanup, '/%s/legend' % self.node.name, Legend)
        self.assertTrue(self.client.plan(gc.goal_of(gc.SHORT)).plan.valid)
        gc.poll(lambda: legends and legends[-1].shown.startswith('Planned: a job without a name (D 10 mm, '), 'the plan')
        self.assertTrue(self.client.set_offset(Y, 0.0001).success)
        gc.poll(lambda: legends[-1] == Legend(), 'the first view')

    def test_of_another_diameter(self):
        wheel = 'the wheel on the spindle is not confirmed; this job has straight, 3 mm wide, D 100 mm'
        never = 'X was never set; Y was never set; Z was never set'
        self.check_reported(wheel, never)
        self.check_rejected(wheel + '; answer: confirm-wheel; ' + never + '; answer: ignore-offsets')
        self.assertRegex(self.said('status'), r'(?m)^zero point Y    never set$')

        run = self.client.send(gc.SHORT, wheel_name='\x1b[2J').wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL))
        self.assertIn('wheel_name has 4 characters; allowed: up to 255, in UTF-8, and none that controls a terminal', run.text)

        d6 = gc.job_file(os.path.join(self.folder, 'd6.yaml'), end_diameter_mm=6)
        d10 = gc.job_file(os.path.join(self.folder, 'd10.yaml'))
        self.assertEqual(self.said('confirm-wheel', d6), 'the wheel on the spindle is straight, 3 mm wide, D 100 mm\n')
        self.grind(0, 'offsets', '--set', 'x=0', '--set', 'y=1', '--set', 'z=2', '--job', d6)
        reported = 'Y was set by hand for D 6 mm, wheel straight, 3 mm wide, D 100 mm (d6.yaml); this job has D 10 mm'
        self.check_reported(reported)
        self.check_rejected(reported)
        self.check_rejected('Y was set by hand', answers=())

        self.grind(0, 'run', d10, '--dry-run', '--answer', 'fit-offsets')
        self.assertRegex(self.said('offsets'),
                         r'(?m)^Y +3\.0000 .*; computed for D 10 mm, wheel straight, 3 mm wide, D 100 mm \(d10\.yaml\)$')
        for got, expected in zip(self.offsets().values, (0, 3 * MM, 2 * MM, 0)):
            self.assertAlmostEqual(got, expected, delta=1e-15)
        self.check_reported()
        run = self.client.send(gc.SHORT, answers=['discard']).wait()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertRegex(self.said('status'), r'(?m)^zero point Y    computed for D 10 mm, wheel')
        reported = self.json('status')['zero_points']
        self.assertEqual((reported['a'], reported['y']['method'], reported['y']['job']), (None, 'computed', 'd10.yaml'))

        # Once there is a place on the disk for it, another start without another blank grinds it a second time.
        self.check_rejected('A: operation flute is ground on this tool already; if another blank is clamped, say so: grind reclamped')
        clamping = self.offsets().tool.clamping
        self.grind(0, 'reclamped')
        self.assertEqual(self.offsets().tool.clamping, clamping + 1)
        self.check_reported()

    def test_computed_ones_fit_their_job(self):
        job = gc.package_file('test/jobs/paper.yaml')
        self.grind(0, 'confirm-wheel', job)
        self.said('zeros', job, '--stickout', '62', '--flange', '2', '--set')
        self.check_reported()
        self.assertEqual(self.json('offsets')['axes']['z']['set_for']['method'], 'computed')


class TestToolOfSeveralOperations(OffsetsTest):
    """Flutes and reliefs of one tool, with two wheels."""

    def setUp(self):
        super().setUp()
        self.job = gc.reamer_file(os.path.join(self.folder, 'reamer.yaml'))
        text = open(self.job).read().replace('feed_mm_min: 700', 'feed_mm_min: 7000').replace('infeed_mm: 0.4', 'infeed_mm: 2')
        with open(self.job, 'w') as file:
            file.write(text)
        self.grind(0, 'confirm-swivel', '13.104')

    def mount(self, operation):
        self.grind(0, 'confirm-wheel', self.job, '--operation', operation)

    def set_zeros(self, operation):
        self.grind(0, 'zeros', self.job, '--operation', operation, '--stickout', '62', '--flange', '2', '--set', '--answer', 'set-offset')

    def run_operation(self, operation, status=0):
        return self.grind(status, 'run', self.job, '--operation', operation).stderr

    def check_refused(self, operation, text):
        self.assertIn(text, self.run_operation(operation, 1))
        self.assertIn(text, self.grind(0, 'run', self.job, '--operation', operation, '--dry-run').stderr)

    def grind_flutes(self):
        self.mount('flute')
        self.set_zeros('flute')
        self.run_operation('flute')
        self.assertRegex(self.said('status'), r'(?m)^tool            reamer\.yaml with flute$')

    def test_each_wants_its_wheel_and_its_zero_points(self):
        self.mount('flute')
        self.assertIn('the wheel on the spindle is straight, 1 mm wide, D 100 mm; allowed: for straight_d100_w6.yaml, D 100 mm once it is mounted',
                      self.grind(1, 'touch-off', 'z', '--job', self.job, '--operation', 'primary').stderr)
        self.grind_flutes()
        self.check_refused('primary', 'the wheel on the spindle is straight, 1 mm wide, D 100 mm; this job has straight_d100_w6.yaml, D 100 mm')
        self.mount('primary')
        self.check_refused('primary', 'another wheel has been mounted since; Y was computed for')
        self.set_zeros('primary')
        self.check_refused('secondary', 'A: operation primary relief is not ground on this tool')
        self.run_operation('primary')
        self.check_refused('primary', 'A: operation primary relief is ground on this tool already')
        # The wheel is the same, and only the height is another.
        self.grind(0, 'run', self.job, '--operation', 'secondary', '--dry-run', '--answer', 'fit-offsets')
        self.run_operation('secondary')
        self.assertRegex(self.said('offsets'), r'(?m)^tool in the collet: reamer\.yaml with flute, primary relief, secondary relief$')
        # It was dressed on another machine.
        self.mount('secondary')
        self.assertNotIn('another wheel', self.grind(0, 'run', self.job, '--operation', 'secondary', '--dry-run').stderr)
        self.grind(0, 'confirm-wheel', self.job, '--operation', 'secondary', '--again')
        self.check_refused('secondary', 'another wheel has been mounted since; Z was computed for')

    def test_a_relief_wants_the_a_of_its_flutes(self):
        unknown = 'A: where the teeth of this tool are is not known: %s; probe a tooth: grind probe tooth'
        self.mount('primary')
        self.set_zeros('primary')
        self.check_refused('primary', unknown % 'no flutes were ground')
        for act, why in ((lambda: self.grind(0, 'touch-off', 'a', '--at', '20'), 'the zero point of A was set after the flutes'),
                         (lambda: self.grind(0, 'home'), 'the axes were homed after the flutes'),
                         (lambda: self.grind(0, 'reclamped'), 'the tool was clamped anew')):
            self.grind_flutes()
            self.mount('primary')
            self.set_zeros('primary')
            self.assertNotIn('A: ', self.grind(0, 'run', self.job, '--operation', 'primary', '--dry-run').stderr)
            act()
            self.check_refused('primary', unknown % why)
        self.restart()
        self.client.make_ready()
        self.grind(0, 'confirm-swivel', '13.104')
        self.check_refused('primary', unknown % 'the tool was clamped anew')

    def test_what_a_kill_kept_from_the_file_is_in_the_journal(self):
        self.grind_flutes()
        self.assertEqual(self.node.end(signal.SIGKILL), -signal.SIGKILL)
        body = open(self.file).read().split('checksum: ')[0].replace('tool_ground: 1', 'tool_ground: 0')
        with open(self.file, 'w') as file:
            file.write(body + 'checksum: %s\n' % hashlib.sha256(body.encode()).hexdigest())
        self.client.wait_end_of_connections()
        self.start()
        self.assertRegex(self.said('status'), r'(?m)^tool            reamer\.yaml with flute$')
        gc.poll(lambda: 'tool_ground: 1' in open(self.file).read(), 'the note')

    def test_flutes_that_go_on_after_a_homing_are_no_place_for_a_relief(self):
        self.mount('flute')
        self.set_zeros('flute')
        run = threading.Thread(target=gc.grind, args=('--node', self.node.name, 'run', self.job, '--operation', 'flute'))
        run.start()
        gc.poll(lambda: self.client.batches and self.client.batches[-1].setpoints[-1].tooth == 2, 'the third tooth')
        self.grind(0, 'cancel')
        run.join()
        self.client.wait_state(GrinderState.READY)
        self.grind(0, 'home')
        self.grind(0, 'run', self.job, '--operation', 'flute', '--continue')
        self.mount('primary')
        self.set_zeros('primary')
        self.check_refused('primary', 'A: where the teeth of this tool are is not known: the axes were homed after the flutes')


class TestCommandLine(OffsetsTest):
    def setUp(self):
        super().setUp()
        self.rest = self.client.wait_rest()

    def test_offsets(self):
        said = self.said('offsets', '--set', 'x=12.5', '--set', 'a=-90')
        self.assertRegex(said, r'(?m)^X +12\.5000 +-50\.0000 +-62\.5000 mm +set by \S+@\S+, \d{4}-\d\d-\d\d ')
        self.assertRegex(said, r'(?m)^Y +0\.0000 +50\.0000 +50\.0000 mm +never set$')
        self.assertRegex(said, r'(?m)^A +-90\.0000 +-?0\.0000 +90\.0000 deg +set by ')
        values = self.offsets().values
        self.assertAlmostEqual(values[X], 12.5 * MM, delta=1e-15)
        self.assertAlmostEqual(values[A], -90 * DEG, delta=1e-15)
        reported = self.json('offsets')
        self.assertEqual(said.splitlines()[0], 'work offsets of /%s' % self.client.name)
        self.assertEqual((reported['grinder'], reported['homed'], reported['error']), ('/' + self.client.name, True, ''))
        self.assertAlmostEqual(reported['axes']['x']['work_mm'], -62.5, delta=0.001)
        self.assertAlmostEqual(reported['axes']['x']['offset_mm'], 12.5, delta=1e-9)
        self.assertAlmostEqual(reported['axes']['a']['offset_deg'], -90, delta=1e-9)
        self.assertEqual((reported['axes']['y']['set_by'], reported['axes']['y']['set_at']), (None, None))
        self.assertRegex(reported['axes']['x']['set_at'], r'^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$')
        status = self.json('status')
        self.assertAlmostEqual(status['machine']['x_mm'], -50, delta=0.001)
        self.assertAlmostEqual(status['work']['x_mm'], -62.5, delta=0.001)
        self.assertRegex(self.said('status'), r'(?m)^work position +X -62\.500, Y 50\.000')

    def test_an_answer_that_there_is_not_is_refused(self):
        run = self.client.send(gc.SHORT, answers=['yes']).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL))
        self.assertIn('answer = yes; allowed: discard, confirm-wheel,', run.text)
        self.assertIn('answer = yes; allowed: ', self.client.set_offset(X, 0, answers=['yes']).message)

    def test_touch_off(self):
        self.assertEqual(self.said('touch-off', 'x', '--at', '1.5'),
                         'axis X: work offset -51.5 mm; it is at 1.5 mm of the work\n')
        self.grind(0, 'touch-off', 'a', '--at', '30')
        self.grind(0, 'touch-off', 'z', '--job', gc.package_file('test/jobs/paper.yaml'))
        self.assertIn('would change by 28.5 mm', self.grind(1, 'touch-off', 'x', '--at', '30').stderr)
        self.grind(0, 'touch-off', 'x', '--at', '30', '--answer', 'set-offset')
        values = self.offsets().values
        self.assertAlmostEqual(values[X], self.rest[X] - 30 * MM, delta=1e-12)
        self.assertAlmostEqual(values[A], self.rest[A] - 30 * DEG, delta=1e-12)
        self.assertAlmostEqual(values[Z], self.rest[Z], delta=1e-12)

    def test_terminal_is_asked_for_a_large_change(self):
        job = gc.package_file('test/jobs/paper.yaml')
        zeros = ('zeros', job, '--stickout', '62', '--flange', '2', '--set')
        self.grind(0, 'offsets', '--set', 'x=0', '--set', 'y=4', '--set', 'z=0', '--job', job)
        for command in (('offsets', '--set', 'x=12.3'), ('touch-off', 'x', '--at', '30'), zeros):
            before = self.offsets()
            self.assertIn('would change by ', self.grind(1, *command).stderr)
            for answer in ('2', '', 'yes'):
                said = self.grind_answering(answer, 1, *command)
                self.assertRegex(said, r'  axis X; asked: .* mm; set: .* mm; off by: .* mm\r?\n  1  Set it: ')
            self.assertEqual(self.offsets().values, before.values)
            self.grind_answering('1', 0, *command)
            self.assertNotEqual(self.offsets().values[X], before.values[X], command)
        self.grind(0, 'offsets', '--set', 'x=-40', '--answer', 'set-offset')
        self.grind(0, *zeros, '--answer', 'set-offset')
        self.grind(2, 'zeros', job, '--stickout', '62', '--flange', '2', '--answer', 'set-offset')

    def test_typed_ahead_is_no_answer(self):
        self.grind(0, 'offsets', '--set', 'x=0')
        change = 'offsets', '--set', 'x=12.3'
        # Whichever it takes first decides.
        self.grind_typed_ahead('1', '2', 1, *change)
        self.assertEqual(self.offsets().values[X], 0)
        self.grind_typed_ahead('2', '1', 0, *change)
        self.assertAlmostEqual(self.offsets().values[X], 12.3 * MM, delta=1e-12)

    def test_touch_off_y_on_a_blank(self):
        """The wheel's centre is then at (blank + worn wheel) / 2 from the axis, and Y = 0 is at (D1 + new wheel) / 2."""
        job = gc.job_file(os.path.join(self.folder, 'job.yaml'), end_diameter_mm=10, wear_mm=0.025)
        touch_off = 'touch-off', 'y', '--at', '12.02', '--job', job
        self.assertIn("the wheel's centre is 2.788 mm above the cutter's axis", self.grind(1, *touch_off).stderr)
        self.grind(0, 'touch-off', 'z', '--at', '-2.788', '--job', job)
        self.said(*touch_off)
        centre = (12.02 * MM + 2 * (50 - 0.025) * MM) / 2
        self.assertAlmostEqual(self.offsets().values[Y], self.rest[Y] - (centre - (5 + 50) * MM), delta=1e-12)

    def test_wrong_usage(self):
        for arguments, status, text in (
                ('touch-off y --at 12', 2, 'touch-off y needs --job JOB'),
                ('touch-off z', 2, 'touch-off z needs --job JOB'),
                ('touch-off y --job test/jobs/paper.yaml', 2, 'touch-off y needs --at DIAMETER'),
                ('offsets --set x=1 --set z=1', 2, '--set z=1 needs --job JOB'),
                ('offsets --set x=2e6', 1, 'work offset of axis X = 2000000 mm; allowed: -100 to 300 mm')):
            self.assertIn(text, self.grind(status, *arguments.split()).stderr)
