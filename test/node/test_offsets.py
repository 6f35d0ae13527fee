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
from grinder_client import A, DEG, MM, MM_MIN, X, Y, Z

# The job then stays within the machine's limits, and the cutter stands out of the collet, not in.
OFFSETS = [-0.0213, 0.0237, -0.0119, 1.25]
# Time enough to do something in a stroke.
SLOW = gc.paper(feed=60 * MM_MIN, clearance=1 * MM)


class OffsetsTest(gc.OwnNode):
    """With a folder for the files of its nodes."""

    pace = 5

    def setUp(self):
        self.folder = gc.temp_folder(self.addCleanup)
        self.file = os.path.join(self.folder, 'offsets')

    def start(self, environment=(), **changes):
        """Starts a node on the folder."""
        parameters = gc.machine(pace=self.pace)
        parameters.update(journal=os.path.join(self.folder, 'journal'), offsets=self.file, control_rate=5000.0 / self.pace,
                          max_job_duration=1e9, homing_timeout=3600.0)
        parameters['hardware']['spindle_run_up_time'] = 0.0
        parameters['hardware'].update(changes)
        super().start(parameters, environment=environment)

    def start_ready(self, **arguments):
        self.start(**arguments)
        self.client.make_ready()

    def offsets(self):
        return rospy.wait_for_message('/%s/offsets' % self.client.name, WorkOffsets, gc.PATIENCE)

    def grind_answering(self, answer, status, *arguments, typed=''):
        """At a terminal, where each of its questions gets the answer, and nothing before the first but `typed`; what it says there."""
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
    def check_touch_off_where_the_axes_stand(self):
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

    def check_both_refused(self, text):
        self.check_refused(self.client.set_offset(Y, 0.01), text)
        self.check_refused(self.client.touch_off(Y, 0.01), text)
        self.assertEqual(tuple(self.offsets().values), (0, 0, 0, 0))

    def test_wrong_ones_are_refused_any_while_a_job_needs_them_and_then_the_axis_is_touched_off(self):
        self.start_ready()
        self.check_refused(self.client.set_offset(4, 0), 'axis = 4; allowed: 0 to 3 for X, Y, Z, A')
        self.check_refused(self.client.touch_off(255, 0), 'axis = 255; allowed: 0 to 3')
        for axes, values in ([], []), ([X, Y], [0.01]), ([X], [0.01, 0.02]):
            self.check_refused(self.client.set_offsets(axes, values), 'axes has %d entries, values %d; allowed: ' % (len(axes), len(values)))
        self.check_refused(self.client.set_offsets([X, Y, X], [0.01, 0.01, 0.02]), 'axes has axis X twice; allowed: each axis once')
        self.check_refused(self.client.set_offsets([X, Y, Z], [0.01, 0.01, 0.3]), 'work offset of axis Z = 300 mm; allowed: ')
        self.check_refused(self.client.set_offset(X, 0.3001),
                           'work offset of axis X = 300.1 mm; allowed: -100 to 300 mm, the travel of the axis')
        self.check_refused(self.client.touch_off(A, math.nan), ' deg, the travel of the axis')
        for wrong, text in (({'method': 6}, 'basis.method = 6; allowed: 0 to 5'), ({'kind': 7}, 'basis.kind = 7; allowed: 0 to 6'),
                            ({'swivel': math.nan}, 'not finite'),
                            ({'wheel_digest': 'A' * 64}, 'allowed: 64 hexadecimal digits'),
                            ({'job_name': '\n'}, 'basis.job_name'), ({'wheel_name': 256 * 'w'}, 'basis.wheel_name')):
            self.check_refused(self.client.set_offset(X, 0, basis=OffsetBasis(**wrong)), text)
        self.check_refused(self.client.set_offset(X, 0, 256 * 'n'), 'set_by has 256 characters; allowed: up to 255')
        self.check_refused(self.client.set_offset(X, 0, 'an\nna'), 'none that controls a terminal')
        self.check_refused(self.client.set_offset(X, 0, basis=OffsetBasis(method=OffsetBasis.CORRECTION)), 'X was never set: it cannot be corrected')
        self.check_refused(self.client.set_offset(X, 0, answers=['yes']), 'answer = yes; allowed: ')
        run = self.client.send(gc.SHORT, answers=['yes']).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL))
        self.assertIn('answer = yes; allowed: discard, confirm-wheel,', run.text)
        self.assertEqual(tuple(self.offsets().values), (0, 0, 0, 0))
        self.assertFalse(os.path.exists(self.file))

        run = self.client.send(SLOW).wait_in_stroke(1 * MM)
        self.check_both_refused('the machine is in state running; allowed: ready, disabled')
        run.cancel()
        run.wait()
        run = self.client.send(gc.ENDLESS)
        self.client.wait_for(lambda: run.feedback, 'feedback')
        self.check_both_refused('a job is being planned')
        run.cancel()
        run.wait()
        self.check_touch_off_where_the_axes_stand()

    def test_several_are_set_at_once_or_none_also_where_one_changes_by_much(self):
        self.start_ready()
        heard = gc.received(self.addCleanup, '/%s/offsets' % self.node.name, WorkOffsets)
        gc.poll(lambda: heard, 'the offsets of the start')
        self.assertTrue(self.client.set_offsets([Z, Y], [-0.007, 0.0015]).success)
        correction = OffsetBasis(method=OffsetBasis.CORRECTION)
        # Each time Y could be set, and the other one not.
        with open(self.file) as file:
            before = file.read()
        far = self.client.set_offsets([Y, Z], [0.0014, 0.001], answers=())
        self.check_refused(far, 'work offset of axis Z would change by 8 mm')
        self.assertEqual([[figure.what for figure in need.figures] for need in far.needs], [['axis Z']])
        self.check_refused(self.client.set_offsets([Y, X], [0.0014, 0.001], basis=correction), 'X was never set: it cannot be corrected')
        self.check_refused(self.client.set_offsets([Y, A], [0.0014, math.nan]), ' deg, the travel of the axis')
        with open(self.file) as file:
            self.assertEqual(file.read(), before)
        self.assertTrue(self.client.set_offsets([Y, Z], [0.0014, 0.001], answers=[far.needs[0].answers[0].id]).success)
        # None was ever heard of that is set by half.
        gc.poll(lambda: heard[-1].values[Y] == 0.0014, 'the offsets as set')
        self.assertEqual([tuple(offsets.values[Y:A]) for offsets in heard], [(0, 0), (0.0015, -0.007), (0.0014, 0.001)])

    def test_refused_without_the_reference_and_while_homing(self):
        # Y homes first, and needs minutes.
        self.start(absolute_encoders=False, axis_y=dict(gc.machine()['hardware']['axis_y'], start_position=0.03, homing_velocity=1e-5))
        self.check_both_refused('the axes are not homed')
        self.assertTrue(self.client.enable().success)
        self.client.wait_state(GrinderState.READY)
        self.check_both_refused('the axes are not homed')
        self.assertTrue(self.client.home().success)
        self.check_both_refused('the machine is in state homing')

    def test_nothing_waits_for_the_disk(self):
        disk = gc.SlowDisk(self.folder)
        self.start_ready(environment=disk.environment)
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

    def test_damaged_ones_are_reported_and_no_job_starts_until_all_are_set(self):
        with open(self.file, 'w') as file:
            file.write('axis_x_m: 0\n')
        self.start_ready()
        reported = 'unknown work offsets of axis_x, axis_y, axis_z, axis_a: file of work offsets %s: its checksum is missing' % self.file
        self.assertIn(reported, self.node.output)
        offsets = self.offsets()
        self.assertTrue(all(math.isnan(v) for v in [*offsets.values, *self.client.fresh_state().work_position]))
        self.assertIn(reported, offsets.error)
        self.assertEqual(self.said('offsets').count(' cannot be read\n'), 4)
        for fields in ({}, {'dry_run': True}):
            run = self.client.send(gc.SHORT, **fields).wait()
            self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY))
            self.assertIn(reported, run.text)
        for axis, value in enumerate(OFFSETS):
            answer = self.client.set_offset(axis, value)
            self.assertTrue(answer.success, answer.message)
        self.assertEqual(self.offsets().error, '')
        self.assertEqual(self.client.send(gc.SHORT, dry_run=True).wait().status, 'SUCCEEDED')


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

    def test_of_another_diameter(self):
        self.start_ready()
        legends = gc.received(self.addCleanup, '/%s/legend' % self.node.name, Legend)
        wheel = 'the wheel on the spindle is not confirmed; this job has straight, 3 mm wide, D 100 mm'
        never = 'X was never set; Y was never set; Z was never set'
        self.check_reported(wheel, never)
        # The plan is shown until a zero point is another.
        gc.poll(lambda: legends and legends[-1].shown.startswith('Planned: a job without a name (D 10 mm, '), 'the plan')
        self.check_rejected(wheel + '; answer: confirm-wheel; ' + never + '; answer: ignore-offsets')
        self.assertRegex(self.said('status'), r'(?m)^zero point Y    never set$')

        run = self.client.send(gc.SHORT, wheel_name='\x1b[2J').wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL))
        self.assertIn('wheel_name has 4 characters; allowed: up to 255, in UTF-8, and none that controls a terminal', run.text)

        d6 = gc.job_file(os.path.join(self.folder, 'd6.yaml'), end_diameter_mm=6)
        d10 = gc.job_file(os.path.join(self.folder, 'd10.yaml'))
        self.assertEqual(self.said('confirm-wheel', d6), 'the wheel on the spindle is straight, 3 mm wide, D 100 mm\n')
        self.grind(0, 'offsets', '--set', 'x=0', '--set', 'y=1', '--set', 'z=2', '--job', d6)
        gc.poll(lambda: legends[-1] == Legend(), 'the first view')
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


class TestToolOfSeveralOperations(OffsetsTest):
    """Flutes and reliefs of one tool, with two wheels."""

    pace = 20

    def mount(self, operation):
        self.grind(0, 'confirm-wheel', self.job, '--operation', operation)

    def set_zeros(self, operation):
        self.grind(0, 'zeros', self.job, '--operation', operation, '--stickout', '62', '--flange', '2', '--set', '--answer', 'set-offset')

    def dry_run(self, operation, *arguments):
        """What it says of a start."""
        return self.grind(0, 'run', self.job, '--operation', operation, '--dry-run', *arguments).stderr

    def check_refused(self, operation, text):
        self.assertIn(text, self.grind(1, 'run', self.job, '--operation', operation).stderr)

    def grind_flutes(self):
        self.mount('flute')
        self.set_zeros('flute')
        self.grind(0, 'run', self.job, '--operation', 'flute')
        self.assertRegex(self.said('status'), r'(?m)^tool            reamer\.yaml with flute$')

    def check_place_unknown(self, why):
        """Of the teeth, for a relief."""
        self.mount('primary')
        self.set_zeros('primary')
        self.check_refused('primary', 'A: where the teeth of this tool are is not known: %s; probe a tooth: grind probe tooth' % why)

    def test_each_wants_its_wheel_its_zero_points_and_the_a_of_its_flutes(self):
        self.start_ready()
        self.job = gc.reamer_file(os.path.join(self.folder, 'reamer.yaml'))
        text = open(self.job).read().replace('feed_mm_min: 700', 'feed_mm_min: 7000').replace('roughing_passes: 3', 'infeed_mm: 2')
        with open(self.job, 'w') as file:
            file.write(text)
        self.grind(0, 'confirm-swivel', '13.104')
        self.check_place_unknown('no flutes were ground')
        self.mount('flute')
        self.assertIn('the wheel on the spindle is straight, 1 mm wide, D 100 mm; allowed: for straight_d100_w6.yaml, D 100 mm once it is mounted',
                      self.grind(1, 'touch-off', 'z', '--job', self.job, '--operation', 'primary').stderr)
        # Flutes that go on after a homing.
        self.set_zeros('flute')
        self.assertTrue(self.client.set_feed_override(0.02).success)
        run = threading.Thread(target=gc.grind, args=('--node', self.node.name, 'run', self.job, '--operation', 'flute'))
        run.start()
        self.client.wait_for(lambda: any(s.tooth == 1 for batch in self.client.batches for s in batch.setpoints), 'the second tooth')
        self.assertTrue(self.client.hold().success)
        self.grind(0, 'cancel')
        run.join()
        self.assertTrue(self.client.set_feed_override(1).success)
        self.client.wait_state(GrinderState.READY)
        self.grind(0, 'home')
        self.grind(0, 'run', self.job, '--operation', 'flute', '--continue')
        self.check_place_unknown('the axes were homed after the flutes')
        self.grind_flutes()
        self.grind(0, 'touch-off', 'a', '--at', '20')
        self.check_place_unknown('the zero point of A was set after the flutes')
        self.grind_flutes()
        self.check_kept_by_the_journal()
        self.grind(0, 'reclamped')
        self.check_place_unknown('the tool was clamped anew')

        self.grind_flutes()
        self.check_refused('primary', 'the wheel on the spindle is straight, 1 mm wide, D 100 mm; this job has straight_d100_w6.yaml, D 100 mm')
        self.mount('primary')
        self.check_refused('primary', 'another wheel has been mounted since; Y was computed for')
        self.set_zeros('primary')
        self.check_refused('secondary', 'A: operation primary relief is not ground on this tool')
        self.grind(0, 'run', self.job, '--operation', 'primary')
        self.check_refused('primary', 'A: operation primary relief is ground on this tool already')
        # The wheel is the same, and only the height is another.
        self.dry_run('secondary', '--answer', 'fit-offsets')
        self.grind(0, 'run', self.job, '--operation', 'secondary')
        self.assertRegex(self.said('offsets'), r'(?m)^tool in the collet: reamer\.yaml with flute, primary relief, secondary relief$')
        # It was dressed on another machine.
        self.mount('secondary')
        self.assertNotIn('another wheel', self.dry_run('secondary'))
        self.grind(0, 'confirm-wheel', self.job, '--operation', 'secondary', '--again')
        self.check_refused('secondary', 'another wheel has been mounted since; Z was computed for')

    def check_kept_by_the_journal(self):
        """What a kill kept from the file."""
        self.assertEqual(self.node.end(signal.SIGKILL), -signal.SIGKILL)
        body = open(self.file).read().split('checksum: ')[0].replace('tool_ground: 1', 'tool_ground: 0')
        with open(self.file, 'w') as file:
            file.write(body + 'checksum: %s\n' % hashlib.sha256(body.encode()).hexdigest())
        self.client.wait_end_of_connections()
        self.start()
        self.assertRegex(self.said('status'), r'(?m)^tool            reamer\.yaml with flute$')
        gc.poll(lambda: 'tool_ground: 1' in open(self.file).read(), 'the note')
        self.client.make_ready()
        self.grind(0, 'confirm-swivel', '13.104')


class TestCommandLine(OffsetsTest):
    def test_offsets_and_touch_off(self):
        self.start_ready()
        rest = self.client.wait_rest()
        said = self.said('offsets', '--set', 'x=12.5', '--set', 'a=-90')
        self.assertRegex(said, r'(?m)^X +12\.5000 +-50\.0000 +-62\.5000 mm +set by \S+@\S+, \d{4}-\d\d-\d\d ')
        self.assertRegex(said, r'(?m)^Y +0\.0000 +50\.0000 +50\.0000 mm +never set$')
        self.assertRegex(said, r'(?m)^A +-90\.0000 +-?0\.0000 +90\.0000 deg +set by ')
        self.check_values(X=12.5 * MM, A=-90 * DEG)
        self.assertEqual(said.splitlines()[0], 'work offsets of /%s' % self.client.name)
        reported = self.json('offsets')
        self.assertEqual((reported['grinder'], reported['homed'], reported['error']), ('/' + self.client.name, True, ''))
        axes = reported['axes']
        self.assertAlmostEqual(axes['x']['work_mm'], -62.5, delta=0.001)
        self.assertAlmostEqual(axes['x']['offset_mm'], 12.5, delta=1e-9)
        self.assertAlmostEqual(axes['a']['offset_deg'], -90, delta=1e-9)
        self.assertEqual((axes['y']['set_by'], axes['y']['set_at'], axes['x']['set_for']['method']), (None, None, 'by_hand'))
        self.assertRegex(axes['x']['set_at'], r'^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$')
        status = self.json('status')
        self.assertAlmostEqual(status['machine']['x_mm'], -50, delta=0.001)
        self.assertAlmostEqual(status['work']['x_mm'], -62.5, delta=0.001)
        self.assertRegex(self.said('status'), r'(?m)^work position +X -62\.500, Y 50\.000, .*\nof the machine +X -50\.000, Y 50\.000, ')

        self.assertEqual(self.said('touch-off', 'x', '--at', '1.5', '--answer', 'set-offset'),
                         'axis X: work offset -51.5 mm; it is at 1.5 mm of the work\n')
        self.grind(0, 'touch-off', 'a', '--at', '30', '--answer', 'set-offset')
        self.grind(0, 'touch-off', 'z', '--job', gc.package_file('test/jobs/paper.yaml'))
        self.check_values(X=rest[X] - 1.5 * MM, Z=rest[Z], A=rest[A] - 30 * DEG)

        # The wheel's centre is at (blank + worn wheel) / 2 from the axis, and Y = 0 is at (D1 + new wheel) / 2.
        job = gc.job_file(os.path.join(self.folder, 'job.yaml'), end_diameter_mm=10, wear_mm=0.025)
        touch_off = 'touch-off', 'y', '--at', '12.02', '--job', job
        self.assertIn("the wheel's centre is 2.788 mm above the cutter's axis", self.grind(1, *touch_off).stderr)
        self.grind(0, 'touch-off', 'z', '--at', '-2.788', '--job', job)
        self.said(*touch_off)
        self.check_values(Y=rest[Y] - ((12.02 * MM + 2 * (50 - 0.025) * MM) / 2 - (5 + 50) * MM))
        for arguments, status, text in (
                ('touch-off y --at 12', 2, 'touch-off y needs --job JOB'),
                ('touch-off z', 2, 'touch-off z needs --job JOB'),
                ('touch-off y --job test/jobs/paper.yaml', 2, 'touch-off y needs --at DIAMETER'),
                ('offsets --set x=1 --set z=1', 2, '--set z=1 needs --job JOB'),
                ('offsets --set x=2e6', 1, 'work offset of axis X = 2000000 mm; allowed: -100 to 300 mm')):
            self.assertIn(text, self.grind(status, *arguments.split()).stderr)

    def check_values(self, **expected):
        for axis, value in expected.items():
            self.assertAlmostEqual(self.offsets().values['XYZA'.index(axis)], value, delta=1e-12)

    def test_terminal_is_asked_for_a_large_change_and_typed_ahead_is_no_answer(self):
        self.start_ready()
        job = gc.package_file('test/jobs/paper.yaml')
        zeros = ('zeros', job, '--stickout', '62', '--flange', '2', '--set')
        self.grind(0, 'offsets', '--set', 'x=0', '--set', 'y=4', '--set', 'z=0', '--job', job)
        for command in (('offsets', '--set', 'x=12.3'), ('touch-off', 'x', '--at', '30'), zeros):
            before = self.offsets()
            self.assertIn('would change by ', self.grind(1, *command).stderr)
            for answer in ('2', '', 'yes'):
                said = self.grind_answering(answer, 1, *command)
                self.assertRegex(said, r'  axis X; asked: .* mm; set: .* mm; off by: .* mm\r?\n  1  Set it: ')
            # Whichever it takes first decides.
            self.grind_answering('2', 1, *command, typed='1')
            self.assertEqual(self.offsets().values, before.values)
            self.grind_answering('1', 0, *command, typed='2')
            self.assertNotEqual(self.offsets().values[X], before.values[X], command)
        self.grind(0, 'offsets', '--set', 'x=-40', '--answer', 'set-offset')
        self.grind(0, *zeros, '--answer', 'set-offset')
        self.grind(2, 'zeros', job, '--stickout', '62', '--flange', '2', '--answer', 'set-offset')
