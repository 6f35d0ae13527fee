"""Figures of a record: of the whole and of each stroke."""

import math

import numpy as np

from cutter import radius, spiral_angles
from motion import LATE
from record import AXES, DEG, MM, MM_MIN, UM, X

MDEG = DEG / 1000


def deviation(job_file, tooth, x, error):
    """Of the path at the surface, normal to the helix [m]: the arc, by the cosine of its angle against the generatrix. With
    a lead, the edge is at X - lead."""
    cutter = job_file['cutter']
    edge_x = x / MM - job_file['process']['setup'].get('lead_mm', 0)
    spirals = spiral_angles(cutter)
    to_generatrix = math.atan(math.tan(spirals[tooth % len(spirals)] * DEG) * math.cos(cutter['cone_angle_deg'] * DEG))
    return np.abs(error) * radius(cutter, edge_x) * MM * math.cos(to_generatrix)


class Largest:
    """The maximum absolute value of each axis."""

    def __init__(self):
        self.values = np.zeros(len(AXES))

    def add(self, known, values):
        if known.any():
            self.values = np.maximum(self.values, np.abs(values[known]).max(axis=0))


class Stroke:
    """Figures of one stroke [SI]; a stroke that went on after a hold is one. Feed off the overtravel."""

    def __init__(self, tooth, pass_):
        self.tooth, self.pass_ = tooth, pass_
        self.begin = self.end = None
        self.min_feed, self.min_feed_x, self.max_feed = math.inf, None, 0.0
        self.deviation, self.deviation_x = 0.0, None
        self.following = Largest()

    def add(self, rows, time, known, following, job_file):
        if self.begin is None:
            self.begin = float(time[0])
        self.end = float(time[-1])
        x = rows['position'][:, X]
        in_flute = (x >= 0) & (x <= job_file['cutter']['flute_length_mm'] * MM) if job_file else np.ones(len(x), bool)
        if in_flute.any():
            feed = rows['feed'][in_flute]
            if feed.min() < self.min_feed:
                self.min_feed, self.min_feed_x = float(feed.min()), float(x[in_flute][np.argmin(feed)])
            self.max_feed = max(self.max_feed, float(feed.max()))
        if job_file:
            off = deviation(job_file, self.tooth, x, rows['error'])
            if off.max() >= self.deviation:
                self.deviation, self.deviation_x = float(off.max()), float(x[np.argmax(off)])
        self.following.add(known, following)

    def head(self, has_actual, depths):
        """In the keys of the grinder's own records of jobs."""
        known = self.min_feed_x is not None
        head = {'tooth': self.tooth + 1, 'pass': self.pass_ + 1,
                'depth_mm': depths[self.pass_] if depths else None,
                'started_s': self.begin, 'duration_s': self.end - self.begin,
                'feed_min_mm_min': self.min_feed / MM_MIN if known else None,
                'feed_min_x_mm': self.min_feed_x / MM if known else None,
                'feed_max_mm_min': self.max_feed / MM_MIN if known else None,
                'deviation_um': None if self.deviation_x is None else self.deviation / UM,
                'deviation_x_mm': None if self.deviation_x is None else self.deviation_x / MM}
        if has_actual:
            x, y, z, a = self.following.values
            head['following_error'] = {'x_um': x / UM, 'y_um': y / UM, 'z_um': z / UM, 'a_mdeg': a / MDEG}
        return head


class Figures:
    """Of all rows of a record; maximum absolute values, SI units. `speed`, `acceleration`, `following`: of the strokes, and
    of the rapids and infeeds between them."""

    def __init__(self, period, job_file=None):
        self.strokes = {}
        self.speed, self.acceleration, self.following = ((Largest(), Largest()) for _ in range(3))
        self.shortest_period, self.longest_period, self.late_cycles = math.inf, 0.0, 0
        self._period, self._job_file = period, job_file
        self._sum, self._count = 0.0, 0

    def add(self, motion):
        for name in ('speed', 'acceleration', 'following'):
            known, values = getattr(motion, name)
            for largest, part in zip(getattr(self, name), (motion.stroke, ~motion.stroke)):
                largest.add(known & part, values)
        self._add_strokes(motion, np.flatnonzero(motion.stroke))
        periods = motion.rows['cycle_period']
        self.shortest_period = min(self.shortest_period, float(periods.min()))
        self.longest_period = max(self.longest_period, float(periods.max()))
        self.late_cycles += int((periods > LATE * self._period).sum())
        self._sum, self._count = self._sum + float(periods.sum()), self._count + len(periods)

    @property
    def mean_period(self):
        return self._sum / self._count

    def _add_strokes(self, motion, points):
        if not len(points):
            return
        rows = motion.rows
        key = rows['tooth'][points].astype('i8') << 16 | rows['pass'][points]
        ends = np.flatnonzero((np.diff(points) != 1) | (np.diff(key) != 0)) + 1
        known, following = motion.following
        for part in np.split(points, ends):
            piece = slice(part[0], part[-1] + 1)
            tooth, pass_ = int(rows['tooth'][part[0]]), int(rows['pass'][part[0]])
            stroke = self.strokes.setdefault((tooth, pass_), Stroke(tooth, pass_))
            stroke.add(rows[piece], motion.time[piece], known[piece], following[piece], self._job_file)
