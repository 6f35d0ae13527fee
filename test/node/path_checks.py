"""Checks of streamed setpoints: the axes' limits, the lift, and the path by an evaluation of the cutter's mathematics that is
independent of the grinder's own."""

import math

from flute_grinder.msg import Cutter

from grinder_client import A, EVEN, JOINTS, LIFT, STROKE, X, Y, Z

EPSILON = 2.0 ** -52


class Helix:
    """The cutter's theory: A(X) = (tan S / tan C) ln(1 + 2 (X - lead) tan C / D1), k (X - lead) for a cylinder."""

    def __init__(self, job):
        self.diameter = job['cutter.end_diameter']
        self.tan_cone = math.tan(job['cutter.cone_angle'])
        self.tan_spiral = math.tan(job['cutter.spiral_angle'])
        self.z_per_y = math.sin(job['cutter.rake_angle']) * (-1 if job['cutter.cut'] == Cutter.LEFT_HAND else 1)
        self.lead = job.get('process.setup_lead', 0)
        self.b = 2 * self.tan_cone / self.diameter
        self.k = 2 * self.tan_spiral / self.diameter
        # The part of a deviation around the axis that is normal to the helix.
        self.normal = math.cos(math.atan(self.tan_spiral * math.cos(job['cutter.cone_angle'])))

    def radius(self, x):
        return self.diameter / 2 + x * self.tan_cone

    def a(self, x):
        x -= self.lead
        return self.k * x if self.b == 0 else self.k / self.b * math.log1p(self.b * x)

    def y(self, x):
        return x * self.tan_cone

    def z(self, x):
        return x * self.tan_cone * self.z_per_y

    def tangent_bound(self, x, dx):
        """Of theory - commanded of A at the end of a step along the tangent that starts on the curve at x, the leading order in
        size: |k b| dX^2 / (2 u^2)."""
        return abs(self.k * self.b) * dx ** 2 / (2 * (1 + self.b * (x - self.lead)) ** 2)


def stroke_pairs(setpoints):
    """The stroke's odd-even pairs as (start, odd, even) setpoints."""
    pairs = []
    for i, setpoint in enumerate(setpoints):
        if setpoint.move == STROKE and setpoint.step == EVEN:
            pairs.append(tuple(setpoints[i - 2:i + 1]))
    return pairs


def excesses(setpoints, limits, period, rest_after=True):
    """What exceeds a limit by more than rounding, one text each: positions and velocities at every setpoint,
    accelerations and jerks at the pair ends by differences over two cycles, with rest before the first and, unless
    said otherwise, after the last."""
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
        ends = [ends[0]] * 3 + ends + ([ends[-1]] * 3 if rest_after else [])
        for i in range(3, len(ends)):
            p3, p2, p1, p0 = ends[i - 3:i + 1]
            check('acceleration', axis, 2 * (i - 3), (p0 - 2 * p1 + p2) / pair ** 2, limits['max_acceleration'][axis],
                  2 * noise / pair ** 2)
            check('jerk', axis, 2 * (i - 3), (p0 - 3 * p1 + 3 * p2 - p3) / pair ** 3, limits['max_jerk'][axis],
                  4 * noise / pair ** 3)
    return found


def off_path(setpoints, helix, tooth_angle=0.0):
    """What leaves the theoretical path by more than the odd-even steps may, one text each."""
    found = []
    for start, odd, even in stroke_pairs(setpoints):
        error = {s.cycle: helix.a(s.position[X]) - (s.position[A] - tooth_angle) for s in (start, odd, even)}
        dx = odd.position[X] - start.position[X]
        bound = helix.tangent_bound(start.position[X], dx) * (1 + 1e-3) + 1e-14
        if not abs(error[odd.cycle] - error[start.cycle]) <= bound:
            found.append('odd error %g at cycle %d, bound %g' % (error[odd.cycle], odd.cycle, bound))
        # One pair's even error is third order: a small part of the odd error.
        if not abs(error[even.cycle] - error[start.cycle]) <= 0.05 * bound + 1e-14:
            found.append('even error grew by %g at cycle %d' % (error[even.cycle] - error[start.cycle], even.cycle))
    return found


def is_gapless(setpoints):
    """Whether the cycles go from 0 up by one."""
    return len(setpoints) > 0 and [s.cycle for s in setpoints] == list(range(len(setpoints)))


def check_lifted(test, stop, lift, height):
    """The setpoints after a stop lift the wheel and do nothing else: radially, never back, up to a height."""
    test.assertEqual({s.move for s in lift}, {LIFT})
    for axis in (X, Z, A):
        test.assertEqual({s.position[axis] for s in lift}, {stop.position[axis]})
    heights = [s.position[Y] for s in [stop, *lift]]
    test.assertEqual(heights, sorted(heights))
    test.assertAlmostEqual(heights[-1], height, delta=1e-12)
