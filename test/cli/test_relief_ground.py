#!/usr/bin/env python3
"""Holds the setpoints of planned reliefs of either hand against what a wheel leaves that follows them: from the file of `grind plan
--csv`, the wheel and the set-up of the job file. A point of a section is kept if it is in the wheel at no setpoint, and at no place
between two of them."""

import math
import pathlib
import sys
import unittest

import numpy
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from planned_strokes import plan, read_job  # noqa: E402

RATE = 200  # [Hz] of the setpoints


class Stroke:
    """The last stroke of a tooth in an operation."""

    def __init__(self, process, poses):
        wheel = process['wheel']
        self.radius, self.half_width = wheel['diameter_mm'] / 2, wheel['width_mm'] / 2
        swivel = math.radians(process['setup']['swivel_deg'])
        self.sine, self.cosine = math.sin(swivel), math.cos(swivel)
        self.poses = poses

    def ray(self, x, angle, poses):
        """Where a ray from the axis, at an angle of the cutter, first meets the wheel."""
        centre_x, centre_y, centre_z, a = poses
        e_y, e_z, d_x = numpy.cos(angle - a), numpy.sin(angle - a), x - centre_x
        along0, along1 = -self.sine * d_x - self.cosine * centre_z, self.cosine * e_z
        a2, a1 = 1 - along1 ** 2, -centre_y * e_y - centre_z * e_z - along0 * along1
        root = a1 ** 2 - a2 * (d_x ** 2 + centre_y ** 2 + centre_z ** 2 - along0 ** 2 - self.radius ** 2)
        with numpy.errstate(all='ignore'):  # what is not met, is not in the wheel
            found = numpy.array([(-a1 - numpy.sqrt(root)) / a2,
                                 (-self.half_width - along0) / along1, (self.half_width - along0) / along1])
            along = along0 + found * along1
            square = d_x ** 2 + (found * e_y - centre_y) ** 2 + (found * e_z - centre_z) ** 2 - along ** 2
            in_wheel = (found > 0) & (abs(along) < self.half_width + 1e-9) & (square < self.radius ** 2 + 1e-6)
            return numpy.where(in_wheel, found, math.inf).min(axis=0)

    def outside(self, x, angle, r, poses):
        """How far a point is outside the wheel; negative inside."""
        centre_x, centre_y, centre_z, a = poses
        d_x, d_y, d_z = x - centre_x, r * numpy.cos(angle - a) - centre_y, r * numpy.sin(angle - a) - centre_z
        along = -self.sine * d_x + self.cosine * d_z
        radial = numpy.sqrt(numpy.maximum(0, d_x ** 2 + d_y ** 2 + d_z ** 2 - along ** 2))
        return numpy.maximum(abs(along) - self.half_width, radial - self.radius)

    def least(self, function):
        """The least of a function of the poses, over the setpoints and in between."""
        count = self.poses.shape[1]
        values = function(self.poses)
        best, reach = values.argmin(), 1.0
        least = values[best]
        for _ in range(4):
            places = numpy.clip(numpy.linspace(best - reach, best + reach, 33), 0, count - 1)
            before = numpy.minimum(places.astype(int), count - 2)
            part = places - before
            values = function(self.poses[:, before] * (1 - part) + self.poses[:, before + 1] * part)
            best, reach = places[values.argmin()], reach / 16
            least = min(least, values.min())
        return least

    def left(self, x, angle):
        """The radius that is left along a ray."""
        return self.least(lambda poses: self.ray(x, angle, poses))

    def cuts(self, x, angle, r):
        return self.least(lambda poses: self.outside(x, angle, r, poses)) < 0


def boundary(low, high, is_low):
    """Where what holds at `low` ends, on the way to `high`."""
    for _ in range(30):
        middle = (low + high) / 2
        if is_low(middle):
            low = middle
        else:
            high = middle
    return (low + high) / 2


class ReliefGround(unittest.TestCase):
    def near(self, name, off, allowed):
        self.assertLessEqual(abs(off), allowed, name)

    def edge(self, flute, x, radius):
        """The angle at which the flute's rake face meets the cone."""
        # What is cut by less than the way between two setpoints shows, is found in between.
        step = math.radians(2)
        inside = flute.outside(x, step * numpy.arange(180)[:, None], radius, flute.poses).min(axis=1) < 0
        last, = (i for i in range(180) if inside[i] and not inside[(i + self.hand) % 180])
        return boundary(last * step, (last + 2 * self.hand) * step, lambda a: flute.cuts(x, a, radius))

    def check_section(self, cutter, x, radius, strokes):
        flute, primary, secondary = strokes
        edge = self.edge(flute, x, radius)

        def left(stroke, behind):
            return stroke.left(x, edge + self.hand * behind)

        def clearance(stroke, behind):
            """From differences to the second order [deg]."""
            step = math.radians(0.1)
            r0, r1, r2 = (left(stroke, behind + i * step) for i in range(3))
            return math.degrees(math.atan((3 * r0 - 4 * r1 + r2) / (2 * step * r0)))

        begins = boundary(-0.01, 0.01, lambda b: left(primary, b) > radius)
        end = boundary(begins, begins + 0.6, lambda b: left(secondary, b) > left(primary, b))
        self.near('edge [um]', 1e3 * (left(primary, 0) - radius), 1.5 if cutter['cone_angle_deg'] else 0.5)
        self.near('start of the relief [mm]', radius * begins, 0.02)
        self.near('clearance [deg]', clearance(primary, begins) - cutter['clearance_deg'], 0.02)
        self.near('second clearance [deg]', clearance(secondary, end + 1e-5) - cutter['second_clearance_deg'], 0.05)
        if x == 0:
            r, behind = left(primary, end), end - begins
            land = math.hypot(r * math.cos(behind) - radius, r * math.sin(behind))
            self.near('land [mm]', land - cutter['land_mm'], 0.02)

    def check(self, name, teeth):
        path, folder = gc.package_file('jobs/%s.yaml' % name), gc.temp_folder(self.addCleanup)
        job = read_job(path)
        cutter = job['cutter']
        self.hand = -1 if cutter['cut'] == 'left_hand' else 1
        strokes = [[Stroke(process, poses) for poses in plan(path, job, process, RATE, folder)[1]] for process in job['operations'][:3]]
        for tooth in teeth:
            for part in (0, 0.5, 1):
                x = part * cutter['flute_length_mm']
                radius = cutter['end_diameter_mm'] / 2 + x * math.tan(math.radians(cutter['cone_angle_deg']))
                self.check_section(cutter, x, radius, [of_teeth[tooth] for of_teeth in strokes])

    def test_reamer(self):
        self.check('taper_reamer_d6_t6', (0, 5))

    def test_left_hand_end_mill(self):
        self.check('left_hand_end_mill_d8_t3', (1,))


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'relief_ground', '__main__')
