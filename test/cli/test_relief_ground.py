#!/usr/bin/env python3
"""Holds the setpoints of planned reliefs against what a wheel leaves that follows them: from the file of `grind plan --csv`, the wheel
and the set-up of the job file, and nothing of the package. A point of a section is kept if it is in the wheel at no setpoint, and at no
place between two of them."""

import csv
import math
import os
import pathlib
import sys
import tempfile
import unittest

import rostest
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402

JOB = gc.package_file('jobs/taper_reamer_d6_t6.yaml')


class Stroke:
    """The last stroke of a tooth in an operation."""

    def __init__(self, job, operation, rows, tooth):
        process = job['operations'][operation]
        wheel = process['wheel']
        if 'file' in wheel:
            with open(os.path.join(os.path.dirname(JOB), wheel['file']), encoding='utf-8') as file:
                wheel = yaml.safe_load(file)
        self.radius, self.width = wheel['diameter_mm'] / 2, wheel['width_mm']
        self.swivel = math.radians(process['setup']['swivel_deg'])
        last = max(int(row['pass']) for row in rows)
        self.poses = [
            (float(row['x_mm']), job['cutter']['end_diameter_mm'] / 2 + self.radius + float(row['y_mm']),
             process['setup']['height_mm'] + float(row['z_mm']), float(row['a_rad']))
            for row in rows if row['move'] == 'stroke' and int(row['tooth']) == tooth and int(row['pass']) == last]

    def ray(self, x, angle, pose):
        """Where a ray from the axis, at an angle of the cutter, first meets the wheel."""
        centre_x, centre_y, centre_z, a = pose
        w_x, w_z = -math.sin(self.swivel), math.cos(self.swivel)
        e_y, e_z, d_x = math.cos(angle - a), math.sin(angle - a), x - centre_x
        along0, along1 = w_x * d_x - w_z * centre_z, w_z * e_z
        found = []
        a2, a1 = 1 - along1 ** 2, -centre_y * e_y - centre_z * e_z - along0 * along1
        root = a1 ** 2 - a2 * (d_x ** 2 + centre_y ** 2 + centre_z ** 2 - along0 ** 2 - self.radius ** 2)
        if root >= 0:
            found.append((-a1 - math.sqrt(root)) / a2)
        found += [(side * self.width / 2 - along0) / along1 for side in (-1, 1) if along1]

        def in_wheel(r):
            along = along0 + r * along1
            square = d_x ** 2 + (r * e_y - centre_y) ** 2 + (r * e_z - centre_z) ** 2 - along ** 2
            return r > 0 and abs(along) < self.width / 2 + 1e-9 and square < self.radius ** 2 + 1e-6

        return min(filter(in_wheel, found), default=math.inf)

    def outside(self, x, angle, r, pose):
        """How far a point is outside the wheel; negative inside."""
        centre_x, centre_y, centre_z, a = pose
        d_x, d_y, d_z = x - centre_x, r * math.cos(angle - a) - centre_y, r * math.sin(angle - a) - centre_z
        along = -math.sin(self.swivel) * d_x + math.cos(self.swivel) * d_z
        radial = math.sqrt(max(0, d_x ** 2 + d_y ** 2 + d_z ** 2 - along ** 2))
        return max(abs(along) - self.width / 2, radial - self.radius)

    def least(self, function):
        """The least of a function of a pose, over the setpoints and in between."""
        step = 20
        best = min(range(0, len(self.poses), step), key=lambda i: function(self.poses[i]))
        best = min(range(max(best - step, 0), min(best + step + 1, len(self.poses))), key=lambda i: function(self.poses[i]))

        def at(place):
            i = min(max(int(place), 0), len(self.poses) - 2)
            return function([p + (place - i) * (q - p) for p, q in zip(self.poses[i], self.poses[i + 1])])

        low, high = max(best - 1, 0), min(best + 1, len(self.poses) - 1)
        for _ in range(40):
            third = (high - low) / 3
            if at(low + third) < at(high - third):
                high -= third
            else:
                low += third
        return min(at(best), at((low + high) / 2))

    def left(self, x, angle):
        """The radius that is left along a ray."""
        return self.least(lambda pose: self.ray(x, angle, pose))

    def cuts(self, x, angle, r):
        return self.least(lambda pose: self.outside(x, angle, r, pose)) < 0


class ReliefGround(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(JOB, encoding='utf-8') as file:
            cls.job = yaml.safe_load(file)
        cls.cutter = cls.job['cutter']
        cls.strokes = []
        with tempfile.TemporaryDirectory() as folder:
            for number in range(3):
                path = os.path.join(folder, 'setpoints.csv')
                gc.grind('plan', JOB, '--operation', str(number + 1), '--csv', path).check_returncode()
                with open(path, encoding='utf-8') as file:
                    rows = list(csv.DictReader(file))
                cls.strokes.append([Stroke(cls.job, number, rows, tooth) for tooth in (0, 1)])

    def radius(self, x):
        return self.cutter['end_diameter_mm'] / 2 + x * math.tan(math.radians(self.cutter['cone_angle_deg']))

    def edge(self, x, tooth):
        """The angle at which the flute's rake face meets the cone."""
        flute = self.strokes[0][tooth]
        radius = self.radius(x)
        low = next(a for a in self.angles(x, tooth) if flute.cuts(x, a, radius))
        high = low + 1
        for _ in range(40):
            angle = (low + high) / 2
            if flute.cuts(x, angle, radius):
                low = angle
            else:
                high = angle
        return low

    def angles(self, x, tooth):
        turned = self.strokes[0][tooth].poses[0][3]
        return (turned + math.radians(i) for i in range(-180, 540, 4))

    def sections(self):
        length = self.cutter['flute_length_mm']
        return (0.0, length / 2, length)

    def test_the_edge_keeps_its_radius_and_gets_its_clearance(self):
        for tooth in (0, 1):
            for x in self.sections():
                edge, primary = self.edge(x, tooth), self.strokes[1][tooth]
                self.assertAlmostEqual(min(primary.left(x, edge), self.radius(x)), self.radius(x), delta=0.5e-3)
                # The relief's own start may lie some micrometres beside the edge.
                near, far = edge + math.radians(0.25), edge + math.radians(0.75)
                fall = primary.left(x, near) - primary.left(x, far)
                # The clearance falls by less than a degree for each degree behind the edge.
                clearance = math.degrees(math.atan(fall / (self.radius(x) * (far - near))))
                self.assertAlmostEqual(clearance, self.cutter['clearance_deg'], delta=0.5)

    def test_the_primary_is_as_wide_as_asked_at_the_small_end(self):
        edge, radius = self.edge(0, 0), self.radius(0)
        primary, secondary = self.strokes[1][0], self.strokes[2][0]
        low, high = edge, edge + math.radians(25)
        for _ in range(40):
            angle = (low + high) / 2
            if secondary.left(0, angle) > primary.left(0, angle):
                low = angle
            else:
                high = angle
        r = primary.left(0, low)
        width = math.hypot(r * math.cos(low - edge) - radius, r * math.sin(low - edge))
        self.assertAlmostEqual(width, self.cutter['land_mm'], delta=0.02)
        begins = secondary.left(0, low + math.radians(0.2)) - secondary.left(0, low + math.radians(0.7))
        clearance = math.degrees(math.atan(begins / (r * math.radians(0.5))))
        self.assertAlmostEqual(clearance, self.cutter['second_clearance_deg'], delta=0.6)

    def test_the_whole_land_falls_away_and_the_next_edge_is_kept(self):
        for x in self.sections():
            edge, following = self.edge(x, 0), self.edge(x, 1)
            for part in range(1, 40):
                angle = edge + (following - edge) * part / 40
                left = min(stroke[tooth].left(x, angle) for stroke in self.strokes for tooth in (0, 1))
                self.assertLess(left, self.radius(x) - 1e-3, (x, part))
            for stroke in self.strokes[1:]:
                self.assertGreater(stroke[0].left(x, following), self.radius(x))


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'relief_ground', '__main__')
