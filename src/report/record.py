"""The data of a report: rows of setpoints, or of the points of a table. Kept in a temporary file, since a day's job has
millions of them."""

import tempfile

import numpy as np

from flute_grinder.msg import WrittenSetpoint

MM = 1e-3
MM_MIN = 1e-3 / 60
UM = 1e-6
MS = 1e-3
DEG = np.pi / 180

AXES = 'XYZA'
X, Y, Z, A = range(4)


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

# A setpoint, as in a SetpointBatch on the wire, since that is what there are millions of. SI units: m, A in rad; m/s. Values
# missing in the source are 0.
ROW = np.dtype([('cycle', '<u8'), ('position', '<f8', 4), ('velocity', '<f8', 4), ('actual', '<f8', 4), ('cycle_period', '<f8'),
                ('error', '<f8'), ('feed', '<f8'), ('move', 'u1'), ('step', 'u1'), ('tooth', '<u2'), ('pass', '<u2')])

STILL = ('holding', 'held', 'retracting', 'retracted', 'jogging_retracted')  # states of a job that is held

BLOCK = 1 << 17  # rows processed at once


class SourceError(Exception):
    """The reason why no report can be drawn from a file."""


class Record:
    """The rows of a file, with what else the file contains.

    kind: 'table', 'setpoints' (CSV of a plan), 'run' (CSV) or 'bag'; `actual` is in the latter two, `cycle_period` in a bag
    alone; or 'record' of the grinder, which has no rows. period: of the control cycle [s], 0 for a table. head: what the file says of the job as a whole, in the keys of
    the grinder's own records of jobs (docs/ros-interface.md). states: (time [s], state, reason, tooth, pass), overrides:
    (time [s], fraction, tooth, pass), teeth and passes from 0. diagnostics: (name, level, message, count). missing: number of
    setpoints that the file lacks. odd_error, even_error: largest at the points of the curve [rad]. worst: tooth and pass of the
    maximum error, None without a point of the curve. low_x, high_x: of those points [m]."""

    def __init__(self, kind):
        self.kind = kind
        self.period = 0.0
        self.head = {}
        self.states = []
        self.overrides = []
        self.diagnostics = []
        self._rows, self._times = tempfile.TemporaryFile(), tempfile.TemporaryFile()
        self.restart()

    @property
    def has_actual(self):
        return self.kind in ('run', 'bag')

    def restart(self):
        """Deletes the rows."""
        for file in (self._rows, self._times):
            file.seek(0)
            file.truncate()
        self._last_cycle = -1  # cycle 0 is the start position of a job
        self.missing = 0
        self.odd_error = self.even_error = 0.0
        self.worst = None
        self.low_x, self.high_x = np.inf, -np.inf

    def append(self, rows, times):
        """Adds rows, whose cycles must ascend. times: since the start of the job [s]. @raise SourceError"""
        cycles = rows['cycle'].astype('i8')
        steps = np.diff(cycles, prepend=self._last_cycle)
        if not (steps > 0).all():
            bad = np.argmax(steps <= 0)
            raise SourceError('cycle %d follows cycle %d; allowed: ascending cycles'
                              % (cycles[bad], cycles[bad] - steps[bad]))
        # A faulty drive may read NaN: the report of its job is wanted most.
        for name in ('position', 'error', 'feed', 'cycle_period'):
            finite = np.isfinite(rows[name])
            if not finite.all():
                bad = np.argmin(finite.reshape(len(rows), -1).all(axis=1))
                raise SourceError('cycle %d: %s is not a finite number' % (cycles[bad], name))
        self.missing += int((steps - 1).sum())
        self._last_cycle = int(cycles[-1])
        self._add_errors(rows[rows['step'] != 0])
        self._rows.write(rows)
        self._times.write(times)

    def _add_errors(self, rows):
        if not len(rows):
            return
        size, odd = np.abs(rows['error']), rows['step'] == ODD
        largest = max(self.odd_error, self.even_error)
        self.odd_error = max(self.odd_error, float(size[odd].max(initial=0)))
        self.even_error = max(self.even_error, float(size[~odd].max(initial=0)))
        if self.worst is None or max(self.odd_error, self.even_error) > largest:
            row = rows[np.argmax(size)]
            self.worst = int(row['tooth']), int(row['pass'])
        x = rows['position'][:, X]
        self.low_x, self.high_x = min(self.low_x, float(x.min())), max(self.high_x, float(x.max()))

    def finish(self):
        """Completes the rows and sets `count`, `first` (the first row), `begin` and `end` (times of the first row and of the
        last). @raise SourceError if there are too few."""
        self.count = self._rows.tell() // ROW.itemsize
        if self.count < 3:
            raise SourceError('has %s; a report needs 3 or more points'
                              % ('no points' if self.count == 0 else '%d point(s)' % self.count))
        rows, begin = self._read(0, 1)
        self.first, self.begin, self.end = rows[0], float(begin[0]), float(self._read(self.count - 1, 1)[1][0])

    def _read(self, start, count):
        self._rows.seek(start * ROW.itemsize)
        self._times.seek(start * 8)
        return np.fromfile(self._rows, ROW, count), np.fromfile(self._times, 'f8', count)

    def blocks(self):
        """The rows and their times, part by part."""
        for start in range(0, self.count, BLOCK):
            yield self._read(start, BLOCK)
