"""Motion of the axes and timing of the grinder, from the rows of a record."""

import numpy as np

from record import ODD, ROW, X

LATE = 1.5  # periods after which a cycle counts as late, as in /diagnostics


class Motion:
    """Part of a record: for each of `speed`, `acceleration` and `following` the times [s] and the values, a column for
    each axis [m, A rad; per s, per s^2].

    Speeds are differences from cycle to cycle. Accelerations are differences between the ends of odd-even pairs, over two
    cycles each, as the plan checks them: within a pair the steps themselves alternate. Where cycles are missing there is
    none of either."""

    def __init__(self, rows, period, has_actual):
        cycle, position = rows['cycle'], rows['position']
        self._period = period
        self.speed = self._at(cycle[1:], (position[1:] - position[:-1]) / period, cycle[1:] - cycle[:-1] == 1)
        bend = (position[4:] - 2 * position[2:-2] + position[:-4]) / (2 * period) ** 2
        self.acceleration = self._at(cycle[4:], bend, (cycle[4:] % 2 == 0) & (cycle[4:] - cycle[:-4] == 4))
        # `actual` is one cycle older than its setpoint.
        lag = position[:-1] - rows['actual'][1:] if has_actual else position[1:] * 0
        self.following = self._at(cycle[1:], lag, cycle[1:] - cycle[:-1] == 1)

    def _at(self, cycle, values, valid):
        # Before cycle 0 the axes are at rest.
        valid &= cycle >= 0
        return cycle[valid] * self._period, values[valid]


def motions(record):
    """The motion of a record, part by part."""
    lead = np.repeat(record.first, 4)
    # A job starts at rest; if its beginning was not recorded, the motion before is unknown.
    lead['cycle'] = np.arange(-4, 0)
    lead['actual'] = lead['position']
    if record.first['cycle'] != 0:
        lead = np.zeros(0, ROW)
    for block in record.blocks():
        rows = np.concatenate([lead, block])
        yield Motion(rows, record.period, record.has_actual)
        lead = rows[-4:]


class Largest:
    """The largest absolute value, by column."""

    def __init__(self, columns=4):
        self.values = np.zeros(columns)

    def add(self, values):
        if len(values):
            self.values = np.maximum(self.values, np.abs(values).max(axis=0))


class KeyFigures:
    """Statistics of all rows; largest absolute values, in SI units."""

    def __init__(self, record):
        self.points = record.count
        self.odd_error = self.even_error = self.feed = 0.0
        self.low_x, self.high_x = np.inf, -np.inf
        self._find_errors(record)
        self.speed, self.acceleration, self.following = Largest(), Largest(), Largest()
        if record.kind == 'table':
            return
        self.duration = float(record.last['cycle'] - record.first['cycle']) * record.period
        for motion in motions(record):
            self.speed.add(motion.speed[1])
            self.acceleration.add(motion.acceleration[1])
            self.following.add(motion.following[1])
        if record.kind == 'bag':
            self._find_timing(record)

    def _find_errors(self, record):
        strokes = set()
        for rows in record.stroke_blocks():
            odd = rows['step'] == ODD
            self.odd_error = max(self.odd_error, np.abs(rows['error'][odd]).max(initial=0))
            self.even_error = max(self.even_error, np.abs(rows['error'][~odd]).max(initial=0))
            self.feed = max(self.feed, rows['feed'].max(initial=0))
            self.low_x = min(self.low_x, rows['position'][:, X].min(initial=np.inf))
            self.high_x = max(self.high_x, rows['position'][:, X].max(initial=-np.inf))
            strokes.update(np.unique(rows['tooth'].astype(int) << 16 | rows['pass']))
        self.strokes = len(strokes)

    def _find_timing(self, record):
        self.shortest_period, self.longest_period = np.inf, 0.0
        total = self.late_cycles = 0
        for rows in record.blocks():
            periods = rows['cycle_period']
            self.shortest_period = min(self.shortest_period, periods.min())
            self.longest_period = max(self.longest_period, periods.max())
            self.late_cycles += int((periods > LATE * record.period).sum())
            total += periods.sum()
        self.mean_period = total / self.points
