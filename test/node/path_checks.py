"""Checks of streamed setpoints: the axes' limits; and the cutter's mathematics, independent of the grinder's own."""

import math

from flute_grinder.msg import Cutter

from grinder_client import JOINTS

EPSILON = 2.0 ** -52


class Helix:
    """The cutter's theory: A(X) = (tan S / tan C) ln(1 + 2 (X - shift) tan C / D1), k (X - shift) for a cylinder."""

    def __init__(self, job):
        self.diameter = job['cutter.end_diameter']
        self.tan_cone = math.tan(job['cutter.cone_angle'])
        self.tan_spiral = math.tan(job['cutter.spiral_angle'])
        self.z_per_y = math.sin(job['cutter.rake_angle']) * (-1 if job['cutter.cut'] == Cutter.LEFT_HAND else 1)
        self.x_shift = job.get('process.setup_x_shift', 0)
        self.b = 2 * self.tan_cone / self.diameter
        self.k = 2 * self.tan_spiral / self.diameter
        # The part of a deviation around the axis that is normal to the helix.
        self.normal = math.cos(math.atan(self.tan_spiral * math.cos(job['cutter.cone_angle'])))

    def radius(self, x):
        return self.diameter / 2 + x * self.tan_cone

    def a(self, x):
        x -= self.x_shift
        return self.k * x if self.b == 0 else self.k / self.b * math.log1p(self.b * x)

    def y(self, x):
        return x * self.tan_cone

    def z(self, x):
        return x * self.tan_cone * self.z_per_y


def excesses(setpoints, limits, period):
    """What exceeds a limit by more than rounding, one text each: positions and velocities at every setpoint,
    accelerations and jerks at the pair ends by differences over two cycles, with rest before the first and after the last."""
    found = []

    def check(name, axis, cycle, value, limit, rounding):
        if not abs(value) <= limit * (1 + 1e-9) + rounding:
            found.append('%s %s %.9g of %.9g at cycle %d' % (JOINTS[axis], name, value, limit, cycle))

    for axis in range(4):
        positions = [s.position[axis] for s in setpoints]
        low, high = limits['min_position'][axis], limits['max_position'][axis]
        found += ['%s position %.9g at cycle %d' % (JOINTS[axis], p, i) for i, p in enumerate(positions)
                  if not low <= p <= high]
        largest = max(abs(p) for p in positions)
        # Each position is rounded to half an epsilon, as is each of the few numbers that it is the sum of.
        noise = 4 * EPSILON * largest
        for i in range(1, len(positions)):
            check('velocity', axis, i, (positions[i] - positions[i - 1]) / period, limits['max_velocity'][axis],
                  noise / period)
        pair = 2 * period
        ends = positions[::2]
        ends = [ends[0]] * 3 + ends + [ends[-1]] * 3
        for i in range(3, len(ends)):
            p3, p2, p1, p0 = ends[i - 3:i + 1]
            check('acceleration', axis, 2 * (i - 3), (p0 - 2 * p1 + p2) / pair ** 2, limits['max_acceleration'][axis],
                  2 * noise / pair ** 2)
            check('jerk', axis, 2 * (i - 3), (p0 - 3 * p1 + 3 * p2 - p3) / pair ** 3, limits['max_jerk'][axis],
                  4 * noise / pair ** 3)
    return found


def is_gapless(setpoints):
    """Whether the cycles go from 0 up by one."""
    return len(setpoints) > 0 and [s.cycle for s in setpoints] == list(range(len(setpoints)))
