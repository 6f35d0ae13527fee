"""Shows how `grind run` behaves while it waits: what it draws on a terminal and writes into a file, that whatever ends it
stops the machine cleanly, and what it says when the grinder is gone. And the same of `grind home`."""

import contextlib
import itertools
import os
import re
import signal
import subprocess

from flute_grinder.msg import GrinderState

import grinder_client as gc
from grind_command import PAPER_JOB, RunTest, default_signals
from grinder_client import LIFT, MM, STROKE, X, grinder

# Whatever the test before has left in the journal is forgotten.
RUN = ['run', '--answer', 'discard', '--answer', 'ignore-offsets']

CLEAR_LINE = '\r\x1b[K'
# What the line shows where there is room for all.
LINE = re.compile(r'\[(#*\.*)\]   {,2}(\d+) %  (\w+)  tooth (\d+)/(\d+)  pass (\d+)/(\d+)  X +-?\d+\.\d{3} mm  \d+ mm/min  '
                  r'\d+:\d\d left')

# The overrides of what is ahead of a stroke, and in it, at which the paper's takes 20 s at pace 5.
AHEAD, SLOW = 0.1, 0.03


class SlowRun(RunTest):
    """With a job in its stroke, in which there is time to interfere."""

    def into_stroke(self, *arguments, client=None, **options):
        """The paper's job, whatever the journal keeps; with how many batches there were ahead of it."""
        client = client or grinder()
        client.make_ready(AHEAD)
        seen = len(client.batches)
        command = self.grind('--node', client.name, *RUN, PAPER_JOB, *arguments, **options)
        command.wait_text('the feed override is 10 %')  # before it is another
        self.slow_down(client, seen)
        return command, seen

    def slow_down(self, client, seen):
        self.wait_in_stroke(client, seen)
        self.assertTrue(client.set_feed_override(SLOW).success)

    def check_stopped(self, seen):
        """Whatever has ended it, the machine comes to rest."""
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        setpoints = [s for batch in grinder().batches_of_goal(seen) for s in batch.setpoints]
        stopped = [s for s in setpoints if s.move != LIFT][-1]
        self.assertEqual(stopped.move, STROKE)
        self.assertLess(stopped.position[X], 30 * MM)
        self.assertEqual(setpoints[-1].move, LIFT)
        self.assertFalse(grinder().fresh_state().wheel_in_work)
        self.assertEqual(len(set(grinder().positions_over(0.1))), 1)

    def check_file(self, lines, command):
        """That it has every setpoint."""
        cycles = [line.split(',')[0] for line in lines]
        self.assertEqual(cycles, ['cycle'] + [str(i) for i in range(len(cycles) - 1)])
        self.assertRegex(command.stdout, r'(?m)^streamed +%d setpoints in \S+ s, 0 missed$' % (len(cycles) - 1))


class TestBar(SlowRun):
    def check_lines(self, text, terminal, teeth, passes):
        """A line for each tenth and each state."""
        lines = [line for line in text.split(terminal) if 'tooth' in line]
        found = [LINE.fullmatch(line) for line in lines]
        self.assertNotIn(None, found, lines)
        self.assertEqual({(m.group(5), m.group(7)) for m in found}, {(str(teeth), str(passes))})
        self.assertEqual({int(m.group(4)) for m in found}, set(range(1, teeth + 1)))
        self.assertEqual({int(m.group(6)) for m in found}, set(range(1, passes + 1)))
        self.assertEqual(found[-1].group(2), '100')
        changes = [(int(m.group(2)) // 10, m.group(3)) for m in found]
        self.assertTrue(all(a != b for a, b in zip(changes, changes[1:])), changes)
        self.assertGreater(len(changes), 1)  # the others are skipped where the computer is busy
        self.assertLess(len(changes), 20)
        for m in found:
            # Of thirty, as many as are done.
            self.assertEqual(len(m.group(1)), 30)
            self.assertAlmostEqual(len(m.group(1).rstrip('.')) / 30, int(m.group(2)) / 100, delta=1 / 30 + 0.01)

    def test_file_and_dumb_terminal_get_lines_without_control_characters(self):
        grinder().make_ready(SLOW)
        # The newlines are the terminal's, whose keyboard is not asked whether to go on.
        for newline, of_two, options in (('\n', dict(teeth=2, depth_mm=0.4, infeed_mm=0.2), {}),
                                         ('\r\n', {}, dict(columns=80, term='dumb', typed=''))):
            command = self.grind(*RUN, self.short_job(**of_two), **options)
            self.assertEqual(command.end(), 0, command.text)
            self.assertNotRegex(command.text.replace(newline, '\n'), '[^\n -~]')
            self.assertTrue(command.text.endswith(newline))
            self.assertRegex(command.stdout, r'(?m)^streamed +\d+ setpoints in \S+ s, 0 missed$')
            self.check_lines(command.text, newline, *((2, 2) if of_two else (1, 1)))

    def drawn(self, command):
        """The lines as they stood on the terminal one after the other, torn nowhere."""
        text = command.text
        self.assertTrue(text.endswith('\r\n'))
        self.assertFalse(text.endswith('\r\n\r\n'))
        lines = [line for part in text.split(CLEAR_LINE) for line in part.rstrip('\r\n').split('\r\n')]
        for line in lines:
            self.assertNotRegex(line, '[^ -~]')
        return [line for line in lines if line]

    def test_line_fits_a_terminal_that_gets_narrow(self):
        def from_first(fits, begin):
            """The lines, each complete, from the first that fits: others may have been drawn before the change was seen."""
            return list(itertools.dropwhile(lambda line: not fits(line), command.text[begin:].split(CLEAR_LINE)[1:-1]))

        grinder().make_ready(SLOW)
        command = self.grind(*RUN, PAPER_JOB, columns=200)
        command.wait_text('tooth 1/1')
        wide = len(command.text)
        command.resize(80)
        at_80 = gc.poll(lambda: (lambda lines: len(lines) > 7 and lines)(from_first(lambda line: len(line) == 79, wide)), 'more of it')
        middle = len(command.text)
        command.resize(30)
        gc.poll(lambda: len(from_first(lambda line: len(line) < 30, middle)) > 3, 'some short ones')
        self.assertTrue(grinder().set_feed_override(1).success)
        self.assertEqual(command.end(), 0, command.text)
        drawn = self.drawn(command)
        self.assertIn('the feed override is 3 %', drawn)
        first = next(line for line in drawn if 'tooth' in line)
        self.assertTrue(LINE.fullmatch(first), first)
        self.assertTrue(all(len(line) == 79 for line in at_80), at_80)
        self.assertTrue(all(re.match(r'\[#*\.*\]  [ \d]{2}\d %  \w+  tooth 1/1  pass 1/1  ', s) for s in at_80), at_80)
        for line in from_first(lambda line: len(line) < 30, middle):
            self.assertLess(len(line), 30)
            self.assertRegex(line, r'^[ \d]{2}\d %  \w+')
        self.assertRegex(drawn[-1], r'^100 %')

    def test_ctrl_z_holds_on_the_path_and_messages_do_not_tear_the_line(self):
        command, _ = self.into_stroke(columns=200)
        command.send(signal.SIGTSTP)
        grinder().wait_state(GrinderState.HELD)
        command.wait_text('  held  ')
        self.assertLess(grinder().wait_rest()[X], 30 * MM)
        self.assertEqual(gc.grind('resume').returncode, 0)
        grinder().wait_state(GrinderState.RUNNING)
        grinder().inject('coolant_lost')
        command.wait_text('  retracted  ')
        command.send(signal.SIGINT)
        self.assertEqual(command.end(), 1)
        lines = self.drawn(command)
        others = [line for line in lines if not LINE.fullmatch(line) and not re.search('  planning \\d+ %$', line)]
        self.assertEqual(others[:-1], ['the feed override is 10 %', "holding: 'grind resume' goes on, Ctrl-C cancels",
                                       "held: no coolant flows; once cleared, 'grind resume' continues", 'canceling: waiting for the stop'])
        self.assertRegex(others[-1], r'^canceled; stopped on the path')


class TestEnd(SlowRun):
    def start_with(self, stdout, stderr):
        grinder().make_ready(AHEAD)
        seen = len(grinder().batches)
        process = subprocess.Popen([gc.program('grind'), *RUN, PAPER_JOB], stdout=stdout, stderr=stderr, preexec_fn=default_signals)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.slow_down(grinder(), seen)
        return process, seen

    def test_reader_of_its_words_that_has_ended(self):
        """As `grind run JOB 2>&1 | tee log`, where Ctrl-C ends tee too."""
        process, seen = self.start_with(subprocess.PIPE, subprocess.STDOUT)
        process.stdout.close()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=gc.PATIENCE), 1)
        self.check_stopped(seen)

    def test_terminal_that_stands_still_holds_up_no_stop(self):
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        with contextlib.suppress(BlockingIOError):
            while True:
                os.write(writer, b'.')
        os.set_blocking(writer, True)
        process, seen = self.start_with(subprocess.DEVNULL, writer)
        os.close(writer)
        process.send_signal(signal.SIGINT)
        grinder().wait_state(GrinderState.READY)
        with open(reader, 'rb') as pipe:
            text = pipe.read().decode().lstrip('.')
        self.assertEqual(process.wait(gc.PATIENCE), 1)
        self.assertRegex(text, r'\ncanceling: waiting for the stop\n(.*\n)*canceled; stopped on the path ')
        self.check_stopped(seen)

    def test_killed_it_leaves_the_job_to_others(self):
        command, seen = self.into_stroke()
        command.send(signal.SIGKILL)
        command.end()
        self.assertEqual(grinder().fresh_state().state, GrinderState.RUNNING)
        done = gc.grind('cancel')
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        self.check_stopped(seen)
        done = gc.grind('cancel')
        self.assertEqual((done.returncode, done.stderr), (
            1, 'cancel refused: the machine is in state ready; allowed: enable, disable, home, start (grind run), lift, jog; '
            'a job that was being planned is canceled\n'))


class TestRecord(SlowRun):
    """The file of `--csv`, and the figures that stand for it."""

    def test_disk_that_stands_still_loses_no_setpoint(self):
        grinder().make_ready()
        path = os.path.join(self.folder, 'fifo')
        os.mkfifo(path)
        reader = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
        command = self.grind(*RUN, PAPER_JOB, '--csv', path)
        # The job ends while the disk takes nothing.
        command.wait_text('100 %  ')  # and not 'planning 100 %'
        grinder().wait_state(GrinderState.READY)
        os.set_blocking(reader, True)
        with open(reader) as file:
            lines = list(file)
        self.assertEqual(command.end(), 0, command.text)
        self.check_file(lines, command)

    def test_second_run_leaves_the_first_and_its_file_alone(self):
        csv = os.path.join(self.folder, 'streamed.csv')
        first, _ = self.into_stroke('--csv', csv)
        second = self.grind(*RUN, PAPER_JOB, '--csv', csv)
        self.assertEqual(second.end(), 1)
        self.assertRegex(second.text, r'\(code -12\)\n$')
        self.assertEqual(second.stdout, '')
        self.assertTrue(grinder().set_feed_override(1).success)
        self.assertEqual(os.listdir(self.folder), [])
        self.assertEqual(first.end(), 0, first.text)
        with open(csv) as lines:
            self.check_file(lines, first)

    def test_full_disk_is_no_success_and_hides_no_emergency_stop(self):
        grinder().make_ready()
        full = '/dev/full: write failed: No space left on device\n'
        command = self.grind(*RUN, self.short_job(), '--csv', '/dev/full')
        self.assertEqual(command.end(), 1)
        self.assertTrue(command.text.endswith('\n' + full), command.text)
        command, _ = self.into_stroke('--csv', '/dev/full')
        grinder().inject('emergency_stop')
        self.assertEqual(command.end(), 1)
        self.assertRegex(command.text, r'emergency stop \(stroke, .* mm\) \(code -9\)\n' + full + '$')
        self.assertRegex(command.stdout, r'(?m)^streamed +\d+ setpoints in \S+ s, 0 missed$')
        self.assertNotIn('setpoints written to', command.stdout)

    def test_file_that_cannot_be_made_is_refused_before_anything_moves(self):
        grinder().make_ready()
        seen = len(grinder().batches)
        for path in (os.path.join(self.folder, 'no/such/folder.csv'), self.folder):
            command = self.grind(*RUN, PAPER_JOB, '--csv', path)
            self.assertEqual(command.end(), 2)
            self.assertRegex(command.text, '^%s: cannot be written: ' % re.escape(path))
        job = self.short_job()
        self.assertEqual(self.grind(*RUN, job, '--csv', job).end(), 2)
        self.assertGreater(os.stat(job).st_size, 0)
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertEqual(len(grinder().batches), seen)


class TestOwnNode(SlowRun, gc.OwnNode):
    """With a grinder of its own, which is ill-treated."""

    def check_lost(self, command):
        self.assertEqual(command.end(), 1)
        self.assertRegex(command.text, r'(?m)^the connection to the grinder is lost: ')

    def test_grinder_that_hangs_while_it_is_to_stop_and_one_that_was_killed(self):
        self.start(gc.machine(pace=5))
        command, _ = self.into_stroke(client=self.client)
        self.node.process.send_signal(signal.SIGSTOP)
        try:
            command.send(signal.SIGINT)
            command.wait_text('\ncanceling: waiting for the stop\n')
            command.send(signal.SIGINT)
            command.wait_text('\ncanceling: still waiting for the stop; the machine is running\n')
            self.check_lost(command)
        finally:
            self.node.process.send_signal(signal.SIGCONT)
        command, _ = self.into_stroke(client=self.client)
        self.node.process.kill()
        self.check_lost(command)

    def test_interrupt_breaks_homing_off(self):
        parameters = gc.machine()
        parameters['hardware']['absolute_encoders'] = False
        parameters['hardware']['axis_x'].update(homing_velocity=1e-3, home_position=0.02)
        self.start(parameters)
        self.assertTrue(self.client.enable().success)
        command = self.grind('--node', self.node.name, 'home')
        self.client.wait_state(GrinderState.HOMING)
        command.send(signal.SIGINT)
        self.assertEqual(command.end(), 1)
        self.assertEqual(command.text, 'homing was aborted; the power is off\n')
        state = self.client.fresh_state()
        self.assertEqual((state.state, state.homed), (GrinderState.DISABLED, False))
        self.assertEqual(len(set(self.client.positions_over(0.1))), 1)

        self.assertTrue(self.client.enable().success)
        command = self.grind('--node', self.node.name, 'home')
        self.client.wait_state(GrinderState.HOMING)
        self.node.process.kill()
        self.check_lost(command)
