"""Shows that the grinder knows how far a job has come, whatever becomes of its process: after a kill at any moment the
journal is whole, and continuing grinds every pass that was not finished, and none that the grinder's state reported as
finished. The journal belongs to one node, and no job that is not finished is forgotten without a word."""

import hashlib
import os
import random
import signal
import time

import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from flute_grinder.msg import GrinderState, GrindResult, OffsetBasis

import grinder_client as gc
import path_checks as checks
from grinder_client import MM, STROKE, X, Y
from test_diagnostics import Reports

CUTTER = ['end_diameter', 'cone_angle', 'spiral_angle', 'rake_angle', 'flute_length', 'tooth_angles']
CUTTER_KEYS = ['end_diameter_m', 'cone_angle_rad', 'spiral_angle_rad', 'rake_angle_rad', 'flute_length_m',
               'tooth_angles_rad']
KEYS = {'job_digest', 'job_name', 'operation', 'finished', 'tooth', 'pass', 'x_m', 'wheel_in_work', 'clear_y_m', 'lift_m', 'clear_x_m', 'back_m',
        'y_doubted', 'offset_x_m', 'offset_y_m', 'offset_z_m', 'offset_a_rad', 'mounting', 'clamping', 'tool_digest', 'kind',
        'end', 'feed_override', 'checksum', *CUTTER_KEYS}
JOB_NAME = 'mill "10°".yaml'
KILLS = 6
SEED = 20

# The stroke's ends.
FROM, TO = -1 * MM, 3 * MM
PASSES = [(tooth, pass_) for tooth in range(3) for pass_ in range(2)]
DEPTHS = (0.3 * MM, 0.5 * MM)


def quick_machine(at=None, **changes):
    """A machine that loses no time with rapids and its spindle. Its axes stand at park, or at other positions."""
    parameters, park = dict(gc.machine(), **changes), (-0.004, 0.002)
    parameters['hardware']['spindle_run_up_time'] = 0
    parameters['park_position'].update(zip(gc.JOINTS, park))
    for joint, position in zip(gc.JOINTS, at or (*park, 0, 0)):
        parameters['hardware'][joint]['start_position'] = position
    for joint, (acceleration, jerk) in {'axis_x': (20.0, 4000.0), 'axis_y': (20.0, 4000.0), 'axis_z': (20.0, 4000.0),
                                        'axis_a': (1000.0, 100000.0)}.items():
        parameters['joint_limits'][joint].update({'max_acceleration': acceleration, 'max_jerk': jerk})
    return parameters


def strokes_of(setpoints):
    """The passes whose strokes there are setpoints of, in order, and those of them that came to their end."""
    begun, ended = [], []
    for s in setpoints:
        if s.move != STROKE:
            continue
        key = (s.tooth, s.pass_)
        if not begun or begun[-1] != key:
            begun.append(key)
        if abs(s.position[X] - TO) < 1e-9:
            ended.append(key)
    return begun, ended


class JournalTest(gc.OwnNode):
    """With a folder for the journal, and nodes that are started on it one after another."""

    at = None  # where the axes stand when a node is started

    def setUp(self):
        self.folder = gc.temp_folder(self.addCleanup)
        self.journal = os.path.join(self.folder, 'journal')
        # Three teeth in two passes, over soon.
        self.job_path = gc.job_file(os.path.join(self.folder, 'job.yaml'), flute_length_mm=2, feed_mm_min=3000, clearance_mm=0.5,
                                    teeth=3, infeed_mm=0.3)
        self.job = gc.job_from_file(self.job_path)

    def start(self, **arguments):
        super().start(quick_machine(self.at, journal=self.journal, offsets=os.path.join(self.folder, 'offsets')), **arguments)
        self.client.confirm_swivel(gc.PAPER['process.setup_swivel'])

    def start_ready(self, **arguments):
        self.start(**arguments)
        self.assertTrue(self.client.enable().success)
        self.client.wait_state(GrinderState.READY)
        if self.client.fresh_state().wheel_in_work:
            self.lift()

    def lift(self):
        self.assertTrue(self.client.lift().success)
        self.client.wait_for(lambda: not self.client.states[-1].wheel_in_work, 'the wheel lifted')
        self.client.wait_state(GrinderState.READY)

    def kill(self):
        """Kills the node, and waits until all that it had sent is here. The axes stay where they are."""
        self.node.end(signal.SIGKILL)
        self.client.wait_end_of_connections()
        self.at = self.client.positions()
        self.client.close()

    def read_journal(self):
        with open(self.journal, 'rb') as file:
            content = file.read()
        body = content[:content.rindex(b'checksum: ')]
        self.assertEqual(content, body + b'checksum: %s\n' % hashlib.sha256(body).hexdigest().encode())
        journal = yaml.safe_load(content)
        self.assertEqual(set(journal), KEYS)
        return journal

    def wait_lifted(self):
        """The journal, which may be a little later than the wheel."""
        gc.poll(lambda: not self.read_journal()['wheel_in_work'], 'the wheel lifted in the journal')
        return self.read_journal()

    def wait_finished(self):
        """The journal, which may be a little later than the job's end."""
        gc.poll(lambda: self.read_journal()['finished'], 'the end in the journal')
        return self.read_journal()

    def wait_left(self, run):
        """The journal of a run that has stopped in a stroke."""
        x = [s.position[X] for s in run.setpoints if s.move == STROKE][-1]
        gc.poll(lambda: self.read_journal()['x_m'] == x, 'the place in the journal')
        return self.read_journal()

    def check_reported(self, journal):
        """That the node reports the progress that is in the journal, a little later than the entry."""
        reported = self.client.wait_fresh(lambda s: bool(s.progress.finished) == journal['finished'], 'the progress').progress
        self.assertEqual((reported.job_digest, reported.job_name, reported.tooth, reported.pass_, reported.x),
                         tuple(journal[key] for key in ('job_digest', 'job_name', 'tooth', 'pass', 'x_m')))
        self.assertEqual([getattr(reported.cutter, name) for name in CUTTER[:-1]],
                         [journal[key] for key in CUTTER_KEYS[:-1]])
        self.assertEqual(list(reported.cutter.tooth_angles), journal['tooth_angles_rad'])

    def hold_in_stroke(self, pass_):
        """Holds a job in the midst of a stroke of the first tooth. The feed is low so that it does not get away."""
        self.assertTrue(self.client.set_feed_override(0.02).success)
        run = self.client.send(self.job, job_name=JOB_NAME)
        run.wait_past(lambda s: s.move == STROKE and s.pass_ == pass_ and s.position[X] > FROM, 'the stroke')
        self.assertTrue(self.client.hold().success)
        self.client.wait_state(GrinderState.HELD)
        self.client.wait_rest()
        return run

    def check_depths(self, setpoints):
        helix = checks.Helix(self.job)
        for s in setpoints:
            if s.move == STROKE:
                self.assertAlmostEqual(s.position[Y], helix.y(s.position[X]) - DEPTHS[s.pass_], delta=1e-12)


class TestKills(JournalTest):
    """The process is killed at random moments."""

    def check_progress(self, run, states, begin):
        """What a run that was killed, or came to its end, has left; returns how many passes are finished."""
        journal = self.read_journal()
        self.check_reported(journal)
        begun, ended = strokes_of(run.setpoints)
        self.assertTrue(checks.is_gapless(run.setpoints))
        self.assertEqual(begun, PASSES[begin:begin + len(begun)], 'strokes go on from where they were left')
        self.assertEqual(ended, PASSES[begin:begin + len(ended)])
        self.check_depths(run.setpoints)
        if not journal['finished']:
            self.assertTrue(FROM - 1e-9 <= journal['x_m'] <= TO + 1e-9)

        end = PASSES.index((journal['tooth'], journal['pass'])) + journal['finished']
        # One that ended just now may not be in the journal yet; of two that are, the last setpoints may not have been sent.
        self.assertTrue(begin <= end <= begin + len(ended) + 2, 'the journal is ahead of the strokes')
        for state in states:
            if state.header.stamp > run.batches[0].header.stamp:
                reported = PASSES.index((state.progress.tooth, state.progress.pass_)) + state.progress.finished
                self.assertLessEqual(reported, end, 'a pass that was reported as finished is not')
        return end

    def test_no_pass_reported_as_finished_is_ground_again_and_none_is_left_out(self):
        chance = random.Random(SEED)
        print('kills with seed %d' % SEED)
        begin = 0  # index of the pass at which the next run has to begin
        kills = finished_jobs = 0
        self.start_ready()
        planned = self.client.plan(gc.goal_of(self.job)).plan.statistics.duration
        while kills < KILLS or begin > 0:
            tooth, pass_ = PASSES[begin]
            run = self.client.send(self.job, first_tooth=tooth, first_pass=pass_)
            self.client.wait_for(lambda: run.done or run.setpoints, 'the first setpoints')
            states = self.client.states
            if kills < KILLS:
                # No wait for anything: it is killed at a moment that nothing decides.
                time.sleep(chance.uniform(0, 0.5 * planned))
                kills += 1
                self.kill()
                self.start_ready()
            else:
                run.wait_complete()
                self.assertEqual(run.status, 'SUCCEEDED', run.text)
                self.assertEqual(strokes_of(run.setpoints)[1], PASSES[begin:])
                self.wait_finished()
            end = self.check_progress(run, states, begin)
            finished_jobs += end == len(PASSES)
            begin = end % len(PASSES)
        self.assertGreater(finished_jobs, 0)


class TestContinue(JournalTest):
    def test_killed_in_a_stroke_it_goes_on_with_that_pass(self):
        """From a stroke in which the axes rest, so that all setpoints were reported."""
        self.start_ready()
        run = self.hold_in_stroke(1)
        at = run.setpoints[-1]
        self.assertTrue(FROM < at.position[X] < TO)
        # What a pass has come to is written down from time to time.
        journal = self.wait_left(run)
        self.kill()
        self.assertEqual([journal[key] for key in ('finished', 'tooth', 'pass', 'wheel_in_work', 'job_name', *CUTTER_KEYS)],
                         [False, 0, 1, True, JOB_NAME, *(self.job['cutter.' + name] for name in CUTTER)])

        self.start()
        self.check_reported(journal)
        state = self.client.fresh_state()
        self.assertEqual((bool(state.wheel_in_work), state.override), (True, 0.02))
        self.assertTrue(self.client.set_feed_override(1).success)
        status = self.said('status')
        self.assertRegex(status, r'(?m)^last job .*tooth 1, pass 2 not finished, X %.3f mm' % (at.position[X] / MM))
        self.assertIn(JOB_NAME, status)
        self.assertTrue(self.client.enable().success)
        self.client.wait_state(GrinderState.READY)
        self.lift()
        self.wait_lifted()
        # Another job is refused, and a dry run of it forgets nothing.
        run = self.client.send(gc.SHORT, answers=['ignore-offsets']).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY))
        for word in (JOB_NAME, 'continue', 'discard'):
            self.assertIn(word, run.text)
        self.assertEqual(self.client.send(gc.SHORT, dry_run=True).wait().status, 'SUCCEEDED')
        other = self.grind(1, 'run', gc.package_file('test/jobs/paper.yaml'), '--continue')
        self.assertIn("the grinder's last job was another one", other.stderr)
        self.assertEqual(self.client.batches, [])
        self.grind(0, 'run', self.job_path, '--continue')
        self.client.fresh_state()
        setpoints = [s for batch in self.client.batches for s in batch.setpoints]
        self.assertTrue(checks.is_gapless(setpoints))
        self.assertEqual((setpoints[0].tooth, setpoints[0].pass_), (0, 1))
        self.assertEqual(strokes_of(setpoints), (PASSES[1:], PASSES[1:]))
        self.check_depths(setpoints)

        self.check_reported(self.wait_finished())
        self.assertRegex(self.said('status'), r'(?m)^last job .*finished')
        self.assertRegex(self.grind(1, 'run', self.job_path, '--continue').stderr, r'^the job is finished: ')


class TestDamagedJournal(JournalTest):
    def test_it_is_reported_and_the_next_job_makes_a_new_one(self):
        with open(self.journal, 'wb') as file:
            file.write(b'nothing of a journal')
        self.start()
        self.assertIn('journal ' + self.journal, self.node.output)
        state = self.client.fresh_state()
        self.assertEqual((state.progress.job_digest, state.progress.finished, state.journal_damaged), ('', False, True))
        self.assertIn('journal ' + self.journal, state.journal_error)
        Reports(self.addCleanup, self.node.name).wait('Journal', DiagnosticStatus.ERROR, 'journal ' + self.journal)
        self.assertRegex(self.said('status'), r'(?m)^wheel in work +not known$')
        self.assertRegex(self.grind(1, 'run', self.job_path, '--continue').stderr, r'^there is no job to continue')
        self.assertTrue(self.client.enable().success)
        self.client.wait_state(GrinderState.READY)
        unknown = 'it is not known whether the wheel is in the work; lift it first'
        self.assertEqual(self.client.send(self.job).wait().text, unknown)
        self.assertEqual(self.grind(1, 'home').stderr, 'home refused: %s\n' % unknown)
        self.grind(0, 'lift')
        self.assertRegex(self.said('status'), r'(?m)^wheel in work +no$')
        with open(self.journal, 'rb') as file:
            self.assertEqual(file.read(), b'nothing of a journal', 'it is left as it is until the next job')
        self.assertRegex(self.client.send(self.job, answers=['ignore-offsets']).wait().text,
                         'its checksum is missing; .*, or discard it; answer: discard$')
        self.assertEqual(self.client.run(gc.SHORT).status, 'SUCCEEDED')
        self.check_reported(self.wait_finished())

    def test_a_cup_on_the_spindle_then_leads_out_along_x(self):
        self.start()
        cup = OffsetBasis(job_name='mill.yaml', wheel_name='cup.yaml', wheel_digest='c' * 64, wheel_diameter=100 * MM, wheel_rim=6 * MM)
        self.assertTrue(self.client.confirm_wheel(cup, False, 'anna@grinder').success)
        self.kill()
        with open(self.journal, 'wb') as file:
            file.write(b'nothing of a journal')
        self.start()
        self.assertEqual(self.client.fresh_state().wheel_backs_off, True)
        self.assertRegex(self.said('status'), r'(?m)^wheel in work +not known; off along X first$')


class TestDisk(JournalTest):
    """The axes wait for the first entry, and what cannot be entered is not ground. The journal belongs to one node."""

    def check_second_node_is_refused(self):
        # By the same name it is refused before it registers, which would end this one.
        for name, text in ((self.node.name, 'a node /%s runs already, at http://[^ ]+; allowed: one by each name' % self.node.name),
                           ('second', 'journal %s is in use by node /%s, process %d' % (self.journal, self.node.name, self.node.process.pid))):
            node = gc.NodeProcess(name, quick_machine(journal=self.journal))
            self.addCleanup(node.close)
            self.assertEqual(node.end(), 1)
            self.assertRegex(node.output, text)

    def test_slow_and_then_failing_and_of_another_node(self):
        disk = gc.SlowDisk(self.folder)
        self.addCleanup(disk.release)
        self.start_ready(environment=disk.environment)
        self.check_second_node_is_refused()
        rest = self.client.wait_rest()
        # Without the folder a power failure in the stroke could leave the entry before.
        disk.stop('folders')
        run = self.client.send(self.job)
        self.client.wait_for(lambda: self.client.states[-1].spindle_at_speed, 'the spindle at speed')
        gc.poll(lambda: os.path.exists(self.journal), 'the entry in its folder')
        self.assertEqual(self.client.fresh_state().state, GrinderState.STARTING)
        self.assertEqual(set(self.client.positions_over(0.2)), {tuple(rest)})
        run.cancel()
        self.client.wait_state(GrinderState.READY)
        disk.release()
        run.wait()
        self.assertEqual((run.status, run.setpoints), ('PREEMPTED', []))

        self.assertEqual(self.client.run(gc.SHORT).status, 'SUCCEEDED')
        before = self.wait_finished()
        rest = self.client.wait_rest()
        os.mkdir(self.journal + '.new')  # where an entry is written first
        run = self.client.send(gc.SHORT).wait()
        self.assertEqual((run.status, run.code, run.setpoints), ('ABORTED', GrindResult.NOT_READY, []))
        self.assertIn(self.journal, run.text)
        self.client.wait_state(GrinderState.READY)
        self.assertEqual(set(self.client.positions_over(0.2)), {tuple(rest)})
        self.client.wait_fresh(lambda s: not s.spindle_at_speed, 'the spindle stopped')
        self.check_reported(before)
        os.rmdir(self.journal + '.new')
        self.assertEqual(self.client.run(gc.SHORT).status, 'SUCCEEDED')
        self.check_reported(self.wait_finished())
