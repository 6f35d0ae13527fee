#!/usr/bin/env python3
"""Shows that the grinder knows how far a job has come, whatever becomes of its process: after a kill at any moment the
journal is whole, and continuing grinds every pass that was not finished and none that was."""

import os
import random
import shutil
import signal
import tempfile
import time
import unittest

import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
from grinder_client import MM, STROKE, X, Y

KEYS = {'job_digest', 'finished', 'tooth', 'pass', 'x_m'}
KILLS = 20
SEED = 20

# The stroke's ends.
FROM, TO = -1 * MM, 3 * MM


def write_job(folder, **changes):
    """Three teeth in two passes, over soon."""
    values = dict(flute_length_mm=2, feed_mm_min=3000, clearance_mm=0.5, teeth=3, infeed_mm=0.3)
    values.update(changes)
    return gc.job_file(os.path.join(folder, 'job.yaml'), **values)


PASSES = [(tooth, pass_) for tooth in range(3) for pass_ in range(2)]
DEPTHS = (0.3 * MM, 0.5 * MM)


def quick_machine(journal):
    """A machine that loses no time with rapids and its spindle."""
    parameters = gc.machine()
    parameters['journal'] = journal
    parameters['hardware']['spindle_run_up_time'] = 0
    parameters['park_position'].update({'axis_x': -0.004, 'axis_y': 0.002})
    parameters['hardware']['axis_x']['start_position'] = -0.004
    parameters['hardware']['axis_y']['start_position'] = 0.002
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


class JournalTest(unittest.TestCase):
    """With a folder for the journal, and nodes that are started on it one after another."""

    started = 0

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.journal = os.path.join(self.folder, 'journal')
        self.job_path = write_job(self.folder)
        self.job = gc.job_from_file(self.job_path)
        self.node = None

    def start(self):
        """Starts a node; every one has a name of its own, since the master remembers those that were killed."""
        JournalTest.started += 1
        self.node = gc.NodeProcess('grinder_%d' % JournalTest.started, quick_machine(self.journal))
        self.addCleanup(self.node.close)
        self.client = self.node.client()
        self.addCleanup(self.client.close)
        return self.client

    def start_ready(self):
        self.start()
        self.assertTrue(self.client.enable().success)
        self.client.wait_state(GrinderState.READY)
        return self.client

    def kill(self):
        """Kills the node, and waits until all that it had sent is here."""
        self.node.end(signal.SIGKILL)
        self.client.wait_end_of_connections()
        self.client.close()

    def read_journal(self):
        with open(self.journal) as text:
            journal = yaml.safe_load(text)
        self.assertEqual(set(journal), KEYS)
        return journal

    def check_told(self, journal):
        """That the node tells the progress that is in the journal."""
        told = self.client.fresh_state().progress
        self.assertEqual((told.job_digest, told.finished, told.tooth, told.pass_, told.x),
                         tuple(journal[key] for key in ('job_digest', 'finished', 'tooth', 'pass', 'x_m')))

    def grind(self, status, *arguments):
        done = gc.grind('--node', self.node.name, *arguments)
        self.assertEqual(done.returncode, status, '%s\n%s' % (done.stdout, done.stderr))
        return done

    def hold_in_stroke_of(self, tooth, pass_):
        """Holds a job in the midst of a stroke. The feed is low so that it does not get away."""
        run = self.client.send(self.job)
        run.wait_past(lambda s: (s.tooth, s.pass_) == (tooth, pass_), 'the tooth')
        self.assertTrue(self.client.set_feed_override(0.05).success)
        run.wait_past(lambda s: s.move == STROKE and (s.tooth, s.pass_) == (tooth, pass_) and s.position[X] > FROM,
                      'the stroke')
        self.assertTrue(self.client.hold().success)
        self.client.wait_state(GrinderState.HELD)
        self.client.wait_rest()
        return run

    def check_depths(self, setpoints):
        helix = gc.Helix(self.job)
        for s in setpoints:
            if s.move == STROKE:
                self.assertAlmostEqual(s.position[Y], helix.y(s.position[X]) - DEPTHS[s.pass_], delta=1e-12)


class TestKills(JournalTest):
    """The process is killed at random moments."""

    def test_no_pass_is_ground_twice_and_none_is_left_out(self):
        chance = random.Random(SEED)
        print('kills with seed %d' % SEED)
        planned = None
        begin = 0  # index of the pass at which the next run has to begin
        seen, unseen = [], []  # passes of this job that ended, by the setpoints, or only by the journal
        kills = finished_jobs = kills_in_strokes = 0
        self.start_ready()
        while kills < KILLS or begin > 0:
            tooth, pass_ = PASSES[begin]
            run = self.client.send(self.job, first_tooth=tooth, first_pass=pass_)
            if planned is None:
                planned = self.client.plan(gc.goal_of(self.job)).duration
            self.client.wait_for(lambda: run.done or run.setpoints, 'the first setpoints')
            if kills < KILLS:
                # No wait for anything: it is killed at a moment that nothing decides.
                time.sleep(chance.uniform(0, 0.5 * planned))
                kills += 1
                self.kill()
                self.start_ready()
            else:
                run.wait_complete()
                self.assertEqual(run.status, 'SUCCEEDED', run.text)

            journal = self.read_journal()
            self.check_told(journal)
            begun, ended = strokes_of(run.setpoints)
            self.assertTrue(gc.is_gapless(run.setpoints))
            self.assertEqual(begun, PASSES[begin:begin + len(begun)], 'strokes go on from where they were left')
            self.check_depths(run.setpoints)
            kills_in_strokes += run.setpoints[-1].move == STROKE
            if not journal['finished']:
                self.assertTrue(FROM - 1e-9 <= journal['x_m'] <= TO + 1e-9)

            end = PASSES.index((journal['tooth'], journal['pass'])) + journal['finished']
            self.assertGreaterEqual(end, begin)
            self.assertLessEqual(set(ended), set(PASSES[begin:end]), 'a pass that was seen to end is not finished')
            only_journal = [p for p in PASSES[begin:end] if p not in ended]
            # The end of a pass is in the journal before it is told, but no pass is ahead of its end.
            self.assertLessEqual(len(only_journal), 1)
            if only_journal:
                self.assertEqual(only_journal[0], PASSES[end - 1])
            seen += ended
            unseen += only_journal
            begin = end
            if journal['finished']:
                self.assertEqual(sorted(seen + unseen), PASSES, 'every pass was finished exactly once')
                finished_jobs += 1
                begin, seen, unseen = 0, [], []
        print('%d kills, %d of them in a stroke; %d jobs finished' % (kills, kills_in_strokes, finished_jobs))
        self.assertGreater(finished_jobs, 0)


class TestContinue(JournalTest):
    def test_killed_in_a_stroke_it_goes_on_with_that_pass(self):
        """From a stroke in which the axes rest, so that all setpoints were told."""
        self.start_ready()
        run = self.hold_in_stroke_of(1, 0)
        at = run.setpoints[-1]
        self.assertTrue(FROM < at.position[X] < TO)
        # What a pass has come to is written down from time to time.
        gc.poll(lambda: self.read_journal()['x_m'] == at.position[X], 'the place in the journal')
        self.kill()
        journal = self.read_journal()
        self.assertEqual((journal['finished'], journal['tooth'], journal['pass']), (False, 1, 0))

        self.start_ready()
        self.check_told(journal)
        self.assertRegex(self.grind(0, 'status').stdout,
                         r'(?m)^last job +without a name: D .*; tooth 2, pass 1 not finished, X %.3f mm \(%s\)$'
                         % (at.position[X] / MM, journal['job_digest'][:12]))
        self.assertEqual(self.client.batches, [])
        self.grind(0, 'run', self.job_path, '--continue')
        self.client.fresh_state()
        setpoints = [s for batch in self.client.batches for s in batch.setpoints]
        self.assertTrue(gc.is_gapless(setpoints))
        self.assertEqual({(s.tooth, s.pass_) for s in setpoints[:1]}, {(1, 0)})
        begun, ended = strokes_of(setpoints)
        self.assertEqual((begun, ended), (PASSES[2:], PASSES[2:]))
        self.check_depths(setpoints)

        self.assertTrue(self.read_journal()['finished'])
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^last job +%s, finished$' % journal['job_digest'][:12])
        self.assertRegex(self.grind(1, 'run', self.job_path, '--continue').stderr, r'^the job is finished: ')

    def test_cancelled_job_goes_on_with_the_pass_that_was_cancelled(self):
        self.start_ready()
        run = self.hold_in_stroke_of(0, 1)
        run.cancel()
        run.wait()
        self.client.wait_state(GrinderState.READY)
        journal = self.read_journal()
        self.check_told(journal)
        self.assertEqual((journal['finished'], journal['tooth'], journal['pass'], journal['x_m']),
                         (False, 0, 1, run.setpoints[-1].position[X]))
        self.assertTrue(self.client.set_feed_override(1).success)
        batches = len(self.client.batches)
        self.grind(0, 'run', self.job_path, '--continue')
        self.client.fresh_state()
        setpoints = [s for batch in self.client.batches[batches:] for s in batch.setpoints]
        self.assertEqual(strokes_of(setpoints)[0], PASSES[1:])

    def test_dry_run_leaves_the_journal_alone(self):
        self.start_ready()
        self.assertEqual(self.client.run(self.job).status, 'SUCCEEDED')
        journal = self.read_journal()
        self.assertEqual(self.client.send(gc.SHORT, dry_run=True).wait().status, 'SUCCEEDED')
        self.assertEqual(self.read_journal(), journal)
        self.check_told(journal)

    def test_nothing_is_continued_without_a_journal(self):
        self.journal = os.path.join(self.folder, 'folders', 'made', 'as needed', 'journal')
        self.start_ready()
        self.assertRegex(self.grind(1, 'run', self.job_path, '--continue').stderr, r'^there is no job to continue')
        self.assertNotIn('last job', self.grind(0, 'status').stdout)
        self.assertEqual(self.client.batches, [])
        self.grind(0, 'run', self.job_path)
        self.assertTrue(self.read_journal()['finished'])


# Name, what is changed in the job file.
CHANGES = [
    ('feed', {'feed_mm_min': 3000.0001}),
    ('depth', {'depth_mm': 0.49}),
    ('tooth', {'teeth': 4}),
    ('direction', {'direction': 'to_end'}),
    ('interpolation', {'even_step': 'exact'}),
]


class TestChangedJob(unittest.TestCase):
    """A job file that was changed after its job was left; the methods are made of the table."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.node = gc.NodeProcess('left_grinder', quick_machine(os.path.join(cls.folder, 'journal')))
        cls.addClassCleanup(cls.node.close)
        cls.client = cls.node.client()
        cls.addClassCleanup(cls.client.close)
        cls.client.make_ready()
        run = cls.client.send(gc.job_from_file(write_job(cls.folder)))
        run.wait_past(lambda s: s.move == STROKE, 'a stroke')
        run.cancel()
        run.wait()
        cls.client.wait_state(GrinderState.READY)

    def check(self, changes):
        batches = len(self.client.batches)
        done = gc.grind('--node', self.node.name, 'run', write_job(self.folder, **changes), '--continue')
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, r'^the grinder.s last job was another one, or its file has changed since')
        self.client.fresh_state()
        self.assertEqual(len(self.client.batches), batches)


def add_changes():
    for name, changes in CHANGES:
        setattr(TestChangedJob, 'test_another_%s_is_not_continued' % name,
                lambda self, changes=changes: self.check(changes))


add_changes()

# Name, what stands in the journal.
UNREADABLE = [
    ('empty', b''),
    ('not_yaml', b'job_digest: [1, 2\nfinished: }\n'),
    ('binary', bytes(range(256))),
    ('a_word', b'finished\n'),
    ('a_key_missing', b'job_digest: "0123"\nfinished: false\ntooth: 0\npass: 0\n'),
    ('a_wrong_type', b'job_digest: "0123"\nfinished: perhaps\ntooth: 0\npass: 0\nx_m: 0\n'),
    ('cut_off', b'job_digest: "0123"\nfinished: fal'),
]


class TestUnreadableJournal(JournalTest):
    """It is told, and the grinder works; the methods are made of the table."""

    def check(self, content):
        with open(self.journal, 'wb') as file:
            file.write(content)
        self.start()
        self.assertIn('journal ' + self.journal, self.node.output)
        state = self.client.fresh_state()
        self.assertEqual((state.state_name, state.progress.job_digest), ('disabled', ''))
        self.assertFalse(state.progress.finished)
        with open(self.journal, 'rb') as file:
            self.assertEqual(file.read(), content, 'it is left as it is until the next job')

    def test_next_job_makes_a_new_one(self):
        self.check(b'nothing of a journal')
        self.assertTrue(self.client.enable().success)
        self.client.wait_state(GrinderState.READY)
        self.assertRegex(self.grind(1, 'run', self.job_path, '--continue').stderr, r'^there is no job to continue')
        self.assertEqual(self.client.run(self.job).status, 'SUCCEEDED')
        self.assertTrue(self.read_journal()['finished'])
        self.check_told(self.read_journal())

    def test_diagnostics_tell_it(self):
        self.check(b'nothing of a journal')
        reports = []

        def on_report(message):
            reports.extend(s for s in message.status if self.node.name in s.name and 'Journal' in s.name)

        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, on_report)
        self.addCleanup(subscriber.unregister)
        gc.poll(lambda: reports, 'diagnostics')
        self.assertEqual(reports[-1].level, DiagnosticStatus.ERROR)
        self.assertIn('journal ' + self.journal, reports[-1].message)


def add_journals():
    for name, content in UNREADABLE:
        setattr(TestUnreadableJournal, 'test_' + name, lambda self, content=content: self.check(content))


add_journals()


class TestUnwritableJournal(JournalTest):
    def test_job_is_refused(self):
        with open(os.path.join(self.folder, 'file'), 'w'):
            pass
        self.journal = os.path.join(self.folder, 'file', 'journal')
        self.start_ready()
        rest = self.client.wait_rest()
        run = self.client.send(self.job).wait()
        self.assertEqual((run.status, run.code), ('ABORTED', GrindResult.NOT_READY))
        self.assertRegex(run.text, r'^(?s:.*)%s.*Not a directory' % self.journal)
        state = self.client.fresh_state()
        self.assertEqual((state.state_name, state.progress.job_digest), ('ready', ''))
        self.assertEqual(set(self.client.positions_over(0.2)), {tuple(rest)})
        self.assertEqual(run.setpoints, [])
        self.assertEqual(self.client.send(self.job, dry_run=True).wait().status, 'SUCCEEDED')


if __name__ == '__main__':
    rospy.init_node('test_journal')
    rostest.rosrun('flute_grinder', 'journal', '__main__')
