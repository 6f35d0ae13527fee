"""The command line for tests: run to its end, and in a process of its own for what it does while it waits."""

import contextlib
import fcntl
import json
import os
import pathlib
import pty
import resource
import signal
import struct
import subprocess
import termios
import threading
import unittest

import grinder_client as gc
from grinder_client import STROKE, X

PAPER_JOB = gc.package_file('test/jobs/paper.yaml')


def default_signals():
    """Whatever started the test may have had them ignored."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE, signal.SIGTSTP):
        signal.signal(number, signal.SIG_DFL)


def full_disk():
    """A file takes no more than 100 bytes."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))


class CommandLine(unittest.TestCase):
    """Runs commands to their end."""

    def setUp(self):
        self.folder = gc.temp_folder(self.addCleanup)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        pathlib.Path(self.path(name)).write_text(text)
        return self.path(name)

    def grind(self, status, *arguments):
        done = gc.grind(*arguments)
        self.assertEqual(done.returncode, status, '%s\n%s' % (done.stdout, done.stderr))
        if status != 0:
            self.assertNotEqual(done.stderr.strip(), '', 'no reason is given')
        return done

    def check_not_printed(self, *arguments):
        """That what cannot be printed is no success: to a disk that is full, and with no standard output."""
        for close in (None, lambda: os.close(1)):
            with open('/dev/full', 'w') as full:
                done = gc.grind(*arguments, stdout=full, preexec_fn=close)
            self.assertEqual(done.returncode, 1, arguments)
            self.assertTrue(done.stderr.endswith('standard output: write failed\n'), done.stderr)

    def json(self, status, *arguments):
        """What a command prints with --json, which must be nothing else."""
        done = self.grind(status, *arguments, '--json')
        return json.loads(done.stdout), done.stderr

    @staticmethod
    def csv(path):
        with open(path) as lines:
            header, *rows = [line.rstrip('\n').split(',') for line in lines]
        return [dict(zip(header, row)) for row in rows]


class Command:
    """The command line in a process of its own, with what it says on stderr as it comes: by a pipe, or as a terminal."""

    def __init__(self, *arguments, columns=None, typed=None, term='xterm', before=default_signals, environment=(), prefix=()):
        """`typed`: what the terminal's keyboard has typed before it starts; None: it has no keyboard. `prefix`: of a command that
        runs it, as `ip netns exec NAME`."""
        self.text = ''
        if columns is None:
            self.reader, writer = os.pipe()
        else:
            self.reader, writer = pty.openpty()
            self.resize(columns)
        if typed:
            self.type(typed)
        self.process = subprocess.Popen([*prefix, gc.program('grind'), *arguments], stdin=None if typed is None else writer,
                                        stdout=subprocess.PIPE, stderr=writer, env=dict(os.environ, TERM=term, **dict(environment)), preexec_fn=before)
        os.close(writer)
        self.thread = threading.Thread(target=self.read)
        self.thread.start()

    def resize(self, columns):
        fcntl.ioctl(self.reader, termios.TIOCSWINSZ, struct.pack('HHHH', 24, columns, 0, 0))

    def type(self, line):
        os.write(self.reader, line.encode() + b'\n')

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
        self.folder = gc.temp_folder(self.addCleanup)

    def grind(self, *arguments, **options):
        command = Command(*arguments, **options)
        self.addCleanup(command.close)
        return command

    def short_job(self, **changes):
        return gc.job_file(os.path.join(self.folder, 'short.yaml'), flute_length_mm=3, feed_mm_min=3000,
                           clearance_mm=1, **changes)

    @staticmethod
    def wait_in_stroke(client, seen):
        def past():
            new = client.batches[seen:]
            return new and new[-1].setpoints[-1].move == STROKE and new[-1].setpoints[-1].position[X] > 0

        client.wait_for(past, 'the stroke')
