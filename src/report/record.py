"""The data of a report: rows of setpoints, or of the points of a table. Kept in a temporary file, since a day's job has
millions of them."""

import tempfile

import numpy as np

from flute_grinder.msg import WrittenSetpoint

MM = 1e-3
MM_MIN = 1e-3 / 60
UM = 1e-6
DEG = np.pi / 180

AXES = 'XYZA'
X, A = 0, 3


def names_of_constants(message):
    """The constants of a message in small letters, in a list for each field: the values of one field count from 0."""
    lists = []
    for name, value in vars(message).items():
        if name.isupper():
            lists += [[]] if value == 0 else []
            lists[-1].append(name.lower())
    return lists


MOVES, STEPS = names_of_constants(WrittenSetpoint)
ODD, EVEN = WrittenSetpoint.ODD, WrittenSetpoint.EVEN

# SI units: m, A in rad; m/s. Values missing in the source are 0.
ROW = np.dtype([('cycle', 'i8'), ('position', 'f8', 4), ('error', 'f8'), ('feed', 'f8'), ('move', 'u1'), ('step', 'u1'),
                ('tooth', 'u2'), ('pass', 'u2'), ('actual', 'f8', 4), ('cycle_period', 'f8')])

BLOCK = 1 << 17  # rows processed at once


class SourceError(Exception):
    """The reason why no report can be drawn from a file."""


class Record:
    """The rows of a file, with what else the file contains.

    kind: 'table', 'setpoints' (CSV of a plan), 'run' (CSV) or 'bag'; `actual` is in the latter two, `cycle_period` in a bag
    alone. period: of the control
    cycle [s], 0 for a table. facts: (name, text) pairs for the reader. max_deviation: [m], or None if unknown.
    tool: of `grind simulate`, or None; no_tool: the
    reason why not. states: (time since the first cycle [s], state, reason). diagnostics: (name, level, message, count)."""

    def __init__(self, kind):
        self.kind = kind
        self.period = 0.0
        self.facts = []
        self.max_deviation = None
        self.tool = None
        self.no_tool = ''
        self.states = []
        self.diagnostics = []
        self._file = tempfile.TemporaryFile()
        self._last_cycle = None
        self.missing = 0

    @property
    def has_actual(self):
        return self.kind in ('run', 'bag')

    def restart(self):
        """Deletes the rows."""
        self._file.seek(0)
        self._file.truncate()
        self._last_cycle = None
        self.missing = 0

    def append(self, rows):
        """Adds rows, whose cycles must ascend. @raise SourceError"""
        cycles = rows['cycle']
        if self._last_cycle is None:
            # Cycle 0 is the start position of a job.
            self._last_cycle = -1
        steps = np.diff(cycles, prepend=self._last_cycle)
        if not (steps > 0).all():
            bad = np.argmax(steps <= 0)
            raise SourceError('cycle %d follows cycle %d; allowed: ascending cycles'
                              % (cycles[bad], cycles[bad] - steps[bad]))
        for name in ('position', 'error', 'feed', 'actual', 'cycle_period'):
            finite = np.isfinite(rows[name]).reshape(len(rows), -1).all(axis=1)
            if not finite.all():
                raise SourceError('cycle %d: %s is not a finite number' % (cycles[np.argmin(finite)], name))
        self.missing += int((steps - 1).sum())
        self._last_cycle = int(cycles[-1])
        rows.tofile(self._file)

    def finish(self):
        """Completes the rows and sets `count`, `first` and `last`. @raise SourceError if there are too few."""
        count = self._file.tell() // ROW.itemsize
        if count < 3:
            raise SourceError('has %s; a report needs 3 or more points'
                              % ('no points' if count == 0 else '%d point(s)' % count))
        self.count = count
        self.first, self.last = self._read(0, 1)[0], self._read(count - 1, 1)[0]

    def _read(self, start, count):
        self._file.seek(start * ROW.itemsize)
        return np.fromfile(self._file, ROW, count)

    def blocks(self):
        """The rows, part by part."""
        for start in range(0, self.count, BLOCK):
            yield self._read(start, BLOCK)

    def stroke_blocks(self):
        """The points of the curve, part by part: rows with an odd or an even step."""
        for rows in self.blocks():
            yield rows[rows['step'] != 0]
