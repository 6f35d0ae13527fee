"""The strokes of `scripts/bench_peers`, the G-code of them, and what is said of the setpoints that come of it. SI units; a row is a
setpoint (X, Y, Z, A) of a control cycle."""

import math

import numpy

LENGTH = 0.03
TOLERANCE = 1e-6  # at the cutter's surface
PERIOD = 0.001
ENDS = 0.001  # of the stroke, where axes speed up and slow down: there the feed is not judged


class Cutter:
    """Of an end diameter [m] and of cone, spiral and rake angle [rad]."""

    def __init__(self, diameter, cone, spiral, rake):
        self.diameter, self.cone, self.spiral, self.rake = diameter, cone, spiral, rake
        self.b, self.k = (2 * math.tan(angle) / diameter for angle in (cone, spiral))

    def angle(self, x):
        """A of the law."""
        return self.k * x if self.b == 0 else self.k / self.b * numpy.log1p(self.b * x)

    def radius(self, x):
        return self.diameter / 2 + x * math.tan(self.cone)

    def rows(self, x):
        """On the path of the law."""
        y = x * math.tan(self.cone)
        return numpy.column_stack((x, y, y * math.sin(self.rake), self.angle(x)))

    def slopes(self, x):
        """First and second derivatives of the rows by X."""
        rise = math.tan(self.cone)
        slope = self.k / (1 + self.b * x)
        one, none = numpy.ones_like(x), numpy.zeros_like(x)
        return (numpy.column_stack((one, rise * one, rise * math.sin(self.rake) * one, slope)),
                numpy.column_stack((none, none, none, -self.b / (1 + self.b * x) * slope)))

    def edge(self):
        """Length of the edge for one of X."""
        return math.sqrt(1 + math.tan(self.cone)**2 + math.tan(self.spiral)**2)

    def spacing(self):
        """The longest of X between points on the path whose chords stay within the tolerance. It is R |A''| X^2/8 across the
        generatrix, greatest at the small end, and the cosine of the helix against that across the helix."""
        helix = math.atan2(math.tan(self.spiral), 1 / math.cos(self.cone))
        curvature = self.diameter / 2 * self.k * self.b * math.cos(helix)
        return LENGTH if curvature == 0 else min(LENGTH, math.sqrt(8 * TOLERANCE / curvature))

    def points(self, spacing):
        """X of a stroke's points, equally spaced, no wider than said."""
        return numpy.linspace(0, LENGTH, math.ceil(LENGTH / spacing - 1e-9) + 1)


def g_code(cutter, points, feed, mode):
    """A program of straight segments in inverse time; in mm and deg, from the first point, where the axes stand."""
    rate = 60 * feed / (cutter.edge() * (points[1] - points[0]))
    rows = cutter.rows(points) * (1e3, 1e3, 1e3, 180 / math.pi)
    lines = ['G1 X%.6f Y%.6f Z%.6f A%.6f F%.6f' % (*row, rate) for row in rows[1:]]
    return '\n'.join(['G21 G90 G93 ' + mode, *lines, 'M2', ''])


def uses(rows, limits, order, stride):
    """The largest difference of this order over so many cycles, as a part of each axis' limit; at rest before and after."""
    rows = numpy.pad(rows, ((order * stride, order * stride), (0, 0)), 'edge')
    return max(numpy.max(numpy.abs(numpy.diff(rows[i::stride], order, axis=0)) / (stride * PERIOD)**order / limits)
               for i in range(stride))


def judge(cutter, rows, acceleration, jerk, points=None):
    """What is said of a stroke from rest to rest, given the axes' limits. The points are X of those in the goal; without any,
    the setpoints are meant. Between setpoints the axes are taken to move straight."""
    x, a = rows[:, 0], rows[:, 3]
    middle = (rows[1:] + rows[:-1]) / 2
    at = numpy.abs(numpy.interp(points, x, a) - cutter.angle(points) if points is not None else a - cutter.angle(x))
    between = max(numpy.max(numpy.abs(r[:, 3] - cutter.angle(r[:, 0]))) for r in (rows, middle))
    step = numpy.diff(rows, axis=0)
    speed = numpy.sqrt(step[:, 0]**2 + step[:, 1]**2 + (cutter.radius(middle[:, 0]) * step[:, 3])**2) / PERIOD
    inner = speed[(x[:-1] >= ENDS) & (x[1:] <= LENGTH - ENDS)]
    return {'at_points': float(at.max()), 'between': float(between), 'feed': [float(inner.min()), float(inner.max())],
            'acceleration': [float(uses(rows, acceleration, 2, stride)) for stride in (1, 2)],
            'jerk': [float(uses(rows, jerk, 3, stride)) for stride in (1, 2)]}
