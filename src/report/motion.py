"""Motion of the axes, from the rows of a record."""

import numpy as np

from record import ROW

LATE = 1.5  # periods after which a cycle counts as late, as in /diagnostics
UNKNOWN = np.uint64(1 << 62)  # cycle of a row that is not there
LEAD = 4  # rows before


class Motion:
    """A part of a record.

    rows, time: the rows, and when they were [s]. stroke: which of them are points of a stroke. speed, acceleration, following:
    for each row whether it is known, and its value, a column for each axis [m, A rad; per s, per s^2].

    Speeds are differences from cycle to cycle. Accelerations are differences between the ends of odd-even pairs, over two
    cycles each, as the plan checks them: within a pair the steps themselves alternate. Where cycles are missing there is
    none of either."""

    def __init__(self, rows, time, period):
        cycle, position = rows['cycle'].astype('i8'), rows['position']
        self.rows, self.time = rows[LEAD:], time
        self.stroke = self.rows['step'] != 0
        follows = cycle[4:] - cycle[3:-1] == 1
        self.speed = follows, (position[4:] - position[3:-1]) / period
        pairs = (cycle[4:] % 2 == 0) & (cycle[4:] - cycle[:-4] == 4)
        self.acceleration = pairs, (position[4:] - 2 * position[2:-2] + position[:-4]) / (2 * period) ** 2
        # `actual` is one cycle older than its setpoint.
        self.following = follows & np.isfinite(self.rows['actual']).all(axis=1), position[3:-1] - self.rows['actual']


def motions(record):
    """The motion of a record, part by part."""
    lead = np.repeat(record.first, LEAD)
    # A job starts at rest; if its beginning was not recorded, the motion before is unknown.
    lead['cycle'] = np.arange(-LEAD, 0).astype('u8') if record.first['cycle'] == 0 else UNKNOWN
    for block, time in record.blocks():
        rows = np.concatenate([lead, block])
        yield Motion(rows, time, record.period)
        lead = rows[-LEAD:]
