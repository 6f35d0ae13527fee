"""Reads the document, and writes files: for the programs of this folder."""

import errno
import json
import signal
import sys
from contextlib import contextmanager


class Failure(Exception):
    """An error with its message, if any, and the exit status: 2 for a file that cannot be made, 1 for a write that failed."""

    def __init__(self, text, status=2):
        super().__init__(text)
        self.status = status


@contextmanager
def writing(path):
    """Turns an error of writing into a Failure that names the file. @raise Failure"""
    try:
        yield
    except BrokenPipeError:
        raise Failure('', 1)
    except OSError as error:
        reason = error.strerror or error
        if error.errno == errno.ENOSPC:
            raise Failure('%s: write failed: %s' % (path, reason), 1)
        raise Failure('%s: cannot be written: %s' % (path, reason))


class Output:
    """A file opened by `grind`, which names it once all is written; given as 'DESCRIPTOR:PATH'."""

    def __init__(self, word):
        descriptor, self.path = word.split(':', 1)
        self.descriptor = int(descriptor)

    def write(self, content):
        """Writes the whole file. @raise Failure"""
        with writing(self.path), open(self.descriptor, 'wb') as file:
            file.write(content)


def run(draw):
    """Hands the JSON document on standard input to draw(), and ends the program if that raises Failure."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        draw(json.load(sys.stdin.buffer))
    except Failure as failure:
        if str(failure):
            print(failure, file=sys.stderr)
        sys.exit(failure.status)
