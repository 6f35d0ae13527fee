#!/usr/bin/env python3
"""Shows how `grind run` behaves while it waits: what it draws on a terminal and writes into a file, that whatever ends it
stops the machine cleanly, and what it says when the grinder is gone. And the same of `grind home`."""

import contextlib
import fcntl
import os
import pty
import re
import shutil
import signal
import struct
import subprocess
import tempfile
import termios
import threading
import time
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState

import grinder_client as gc
from grinder_client import MM, STROKE, X, grinder

PAPER_JOB = gc.package_file('jobs/paper.yaml')
CLEAR_LINE = '\r\x1b[K'
# What the line shows where there is room for all.
LINE = re.compile(r'\[(#*\.*)\]   {,2}(\d+) %  (\w+)  tooth (\d+)/(\d+)  pass (\d+)/(\d+)  X +-?\d+\.\d{3} mm  \d+ mm/min  '
                  r'\d+:\d\d left')


def default_signals():
    """Whatever started the test may have had them ignored."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)


class Command:
    """The command line in a process of its own, with what it says on stderr as it comes: by a pipe, or as a terminal."""

    def __init__(self, *arguments, columns=None, term='xterm', before=default_signals):
        self.text = ''
        if columns is None:
            self.reader, writer = os.pipe()
        else:
            self.reader, writer = pty.openpty()
            self.resize(columns)
        self.process = subprocess.Popen([gc.program('grind'), *arguments], stdout=subprocess.PIPE, stderr=writer,
                                        env=dict(os.environ, TERM=term), preexec_fn=before)
        os.close(writer)
        self.thread = threading.Thread(target=self.read)
        self.thread.start()

    def resize(self, columns):
        fcntl.ioctl(self.reader, termios.TIOCSWINSZ, struct.pack('HHHH', 24, columns, 0, 0))

    def read(self):
        # A terminal whose other side is closed gives an error in place of the end.
        with contextlib.suppress(OSError):
            while True:
                data = os.read(self.reader, 4096)
                if not data:
                    break
                self.text += data.decode()
        os.close(self.reader)

    def wait_text(self, text):
        gc.poll(lambda: text in self.text, text)

    def send(self, with_signal):
        self.process.send_signal(with_signal)

    def end(self):
        """Its exit status."""
        self.stdout = self.process.communicate(timeout=gc.PATIENCE)[0].decode()
        self.thread.join(gc.PATIENCE)
        return self.process.returncode

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.end()


class RunTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def grind(self, *arguments, **options):
        command = Command(*arguments, **options)
        self.addCleanup(command.close)
        return command

    def short_job(self, **changes):
        return gc.job_file(os.path.join(self.folder, 'short.yaml'), flute_length_mm=3, feed_mm_min=3000,
                           clearance_mm=1, **changes)

    def wait_in_stroke(self, client, seen):
        def past():
            new = client.batches[seen:]
            return new and new[-1].setpoints[-1].move == STROKE and new[-1].setpoints[-1].position[X] > 2 * MM

        client.wait_for(past, 'the stroke')


class TestBar(RunTest):
    def setUp(self):
        super().setUp()
        grinder().make_ready()

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
        self.assertGreater(len(changes), 5)
        self.assertLess(len(changes), 20)
        for m in found:
            # Of thirty, as many as are done.
            self.assertEqual(len(m.group(1)), 30)
            self.assertAlmostEqual(len(m.group(1).rstrip('.')) / 30, int(m.group(2)) / 100, delta=1 / 30 + 0.01)

    def test_file_gets_lines_without_control_characters(self):
        command = self.grind('run', self.short_job(teeth=2, depth_mm=0.4, infeed_mm=0.2))
        self.assertEqual(command.end(), 0, command.text)
        self.assertNotRegex(command.text, '[^\n -~]')
        self.assertTrue(command.text.endswith('\n'))
        self.check_lines(command.text, '\n', 2, 2)

    def test_dumb_terminal_counts_as_a_file(self):
        command = self.grind('run', self.short_job(), columns=80, term='dumb')
        self.assertEqual(command.end(), 0, command.text)
        # The newlines are the terminal's.
        self.assertNotRegex(command.text.replace('\r\n', '\n'), '[^\n -~]')
        self.check_lines(command.text, '\r\n', 1, 1)

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
        command = self.grind('run', self.short_job(), columns=200)
        command.wait_text('tooth 1/1')
        wide = len(command.text)
        command.resize(80)
        gc.poll(lambda: command.text.count(CLEAR_LINE, wide) > 10, 'more of it')
        middle = len(command.text)
        command.resize(30)
        self.assertEqual(command.end(), 0, command.text)
        lines = self.drawn(command)
        self.assertTrue(LINE.fullmatch(lines[0]), lines[0])
        self.assertEqual(max(len(line) for line in command.text[:wide].split(CLEAR_LINE)), len(lines[0]))
        # The first two after each change may have been drawn before it was seen.
        at_80 = command.text[wide:middle].split(CLEAR_LINE)[3:-1]
        self.assertTrue(all(len(line) == 79 for line in at_80), at_80)
        self.assertTrue(all(re.match(r'\[#*\.*\]  [ \d]{2}\d %  \w+  tooth 1/1  pass 1/1  ', s) for s in at_80), at_80)
        at_30 = command.text[middle:].rstrip('\r\n').split(CLEAR_LINE)[3:]
        self.assertGreater(len(at_30), 3)
        for line in at_30:
            self.assertLess(len(line), 30)
            self.assertRegex(line, r'^[ \d]{2}\d %  \w+')
        self.assertRegex(lines[-1], r'^100 %')

    def test_messages_do_not_tear_the_line(self):
        seen = len(grinder().batches)
        command = self.grind('run', PAPER_JOB, columns=200)
        self.wait_in_stroke(grinder(), seen)
        grinder().inject('coolant_lost')
        command.wait_text('  retracted  ')
        command.send(signal.SIGINT)
        self.assertEqual(command.end(), 1)
        lines = self.drawn(command)
        others = [line for line in lines if not LINE.fullmatch(line)]
        self.assertEqual(others[:2], ["held: no coolant flows; when it is well again, 'grind resume' goes on",
                                      'canceling: waiting for the stop'])
        self.assertRegex(others[2], r'^canceled; stopped on the path')
        self.assertEqual(len(others), 3)


class TestEnd(RunTest):
    """Whatever ends it, the machine comes to rest."""

    def setUp(self):
        super().setUp()
        grinder().make_ready()

    def start(self, **options):
        seen = len(grinder().batches)
        command = self.grind('run', PAPER_JOB, **options)
        self.wait_in_stroke(grinder(), seen)
        return command, seen

    def check_stopped(self, seen):
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        setpoints = [s for batch in grinder().batches[seen:] for s in batch.setpoints]
        self.assertEqual(setpoints[-1].move, STROKE)
        self.assertLess(setpoints[-1].position[X], 30 * MM)
        self.assertEqual(gc.excesses(setpoints, grinder().limits(), grinder().period()), [])
        self.assertEqual(len(set(grinder().positions_over(0.1))), 1)

    def test_terminal_that_goes_away(self):
        command, seen = self.start(columns=80)
        command.send(signal.SIGHUP)
        self.assertEqual(command.end(), 1)
        self.assertRegex(command.text, r'canceled; stopped on the path \(at stroke .*\(code -11\)')
        self.check_stopped(seen)

    def test_nohup_is_heeded(self):
        def nohup():
            default_signals()
            signal.signal(signal.SIGHUP, signal.SIG_IGN)

        command, seen = self.start(before=nohup)
        command.send(signal.SIGHUP)
        self.assertEqual(grinder().fresh_state().state, GrinderState.RUNNING)
        command.send(signal.SIGTERM)
        self.assertEqual(command.end(), 1)
        self.check_stopped(seen)

    def test_reader_of_its_words_that_has_ended(self):
        """As `grind run JOB 2>&1 | tee log`, where Ctrl-C ends tee too."""
        seen = len(grinder().batches)
        process = subprocess.Popen([gc.program('grind'), 'run', PAPER_JOB], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, preexec_fn=default_signals)
        self.wait_in_stroke(grinder(), seen)
        process.stdout.close()
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=gc.PATIENCE), 1)
        self.check_stopped(seen)

    def test_killed_it_leaves_the_job_to_others(self):
        command, seen = self.start()
        command.send(signal.SIGKILL)
        command.end()
        self.assertEqual(grinder().fresh_state().state, GrinderState.RUNNING)
        done = gc.grind('cancel')
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        self.check_stopped(seen)
        done = gc.grind('cancel')
        self.assertEqual(done.returncode, 1)
        self.assertEqual(done.stderr,
                         'cancel refused: the machine is in state ready; allowed: enable, disable, home, start\n')


class TestOwnNode(RunTest):
    """With a grinder of its own, which is ill-treated."""

    def start_node(self, **hardware):
        parameters = gc.machine()
        for key, value in hardware.items():
            if isinstance(value, dict):
                parameters['hardware'][key].update(value)
            else:
                parameters['hardware'][key] = value
        self.node = gc.NodeProcess('ill_treated', parameters)
        self.addCleanup(self.node.close)
        self.addCleanup(self.node.process.send_signal, signal.SIGCONT)
        self.client = self.node.client()
        self.addCleanup(self.client.close)

    def start_run(self):
        self.client.make_ready()
        seen = len(self.client.batches)
        command = self.grind('--node', 'ill_treated', 'run', PAPER_JOB)
        self.wait_in_stroke(self.client, seen)
        return command

    def check_lost(self, command):
        began = time.monotonic()
        self.assertEqual(command.end(), 1)
        self.assertRegex(command.text, r'(?m)^the link to the grinder is lost: ')
        # Seconds, on a host that stalls too.
        self.assertLess(time.monotonic() - began, 20)

    def test_grinder_that_hangs_while_it_is_to_stop(self):
        self.start_node()
        command = self.start_run()
        self.node.process.send_signal(signal.SIGSTOP)
        command.send(signal.SIGINT)
        command.wait_text('\ncanceling: waiting for the stop\n')
        command.send(signal.SIGINT)
        command.wait_text('\ncanceling: still waiting for the stop; the machine is running\n')
        self.check_lost(command)

    def test_grinder_that_was_killed(self):
        self.start_node()
        command = self.start_run()
        self.node.process.kill()
        self.check_lost(command)

    def test_interrupt_breaks_homing_off(self):
        slow = {'homing_velocity': 1e-3, 'home_position': 0.02}
        self.start_node(absolute_encoders=False, axis_x=slow)
        self.assertTrue(self.client.enable().success)
        command = self.grind('--node', 'ill_treated', 'home')
        self.client.wait_state(GrinderState.HOMING)
        command.send(signal.SIGINT)
        self.assertEqual(command.end(), 1)
        self.assertEqual(command.text, 'homing was broken off; the power is off\n')
        state = self.client.fresh_state()
        self.assertEqual((state.state, state.homed), (GrinderState.DISABLED, False))
        self.assertEqual(len(set(self.client.positions_over(0.1))), 1)

        self.assertTrue(self.client.enable().success)
        command = self.grind('--node', 'ill_treated', 'home')
        self.client.wait_state(GrinderState.HOMING)
        self.node.process.kill()
        self.check_lost(command)


if __name__ == '__main__':
    rospy.init_node('test_run')
    rostest.rosrun('flute_grinder', 'run', '__main__')
