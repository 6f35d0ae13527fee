#!/usr/bin/env python3
"""Holds the setpoints of planned reliefs against what a wheel leaves that follows them: from the file of `grind plan --csv`, the wheel
and the set-up of the job file, and nothing of the package. A point of a section is kept if it is in the wheel at no setpoint, and at no
place between two of them. Besides the shipped reamer, random cutters are set up by `grind setup`; what that refuses is counted. Their
number is scaled as RapidCheck's by RC_PARAMS."""

import collections
import functools
import math
import os
import pathlib
import random
import re
import sys
import unittest

import numpy
import rostest
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from planned_strokes import Refused, grind, plan, read_job  # noqa: E402

REAMER = gc.package_file('jobs/taper_reamer_d6_t6.yaml')
KINDS = ('flute', 'primary', 'secondary')
USUAL_CASES = 5  # with RapidCheck's 100
RATE, SLOW = 1000, 200  # [Hz] of the setpoints; with SLOW they are as close together at the reamer's feeds


def random_cases():
    more = re.search(r'max_success=(\d+)', os.environ.get('RC_PARAMS', ''))
    return USUAL_CASES * int(more.group(1)) // 100 if more else USUAL_CASES


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


# What is measured of a tooth in a section: how far its first relief takes the edge's radius or leaves it [mm], where the reliefs begin
# behind the edge and with what clearance [rad], and the width of the first [mm].
Measured = collections.namedtuple('Measured', 'edge begins clearance second_clearance land')


class Tool:
    """The file of a job whose operations are all planned. Angles behind an edge are positive."""

    def __init__(self, path, rate, folder):
        job = read_job(path)
        self.cutter, self.operations = job['cutter'], job['operations']
        self.hand = -1 if self.cutter['cut'] == 'left_hand' else 1
        self.asked = [math.radians(self.cutter.get(key, 0)) for key in ('clearance_deg', 'second_clearance_deg')]
        # What is asked again and again, for as long as there is the tool.
        self.edge = functools.lru_cache(None)(self.edge)
        # Of all operations, for each tooth.
        self.strokes = list(zip(*([Stroke(process, poses) for poses in plan(path, job, process, rate, folder)[1]]
                                  for process in self.operations)))

    def radius(self, x):
        return self.cutter['end_diameter_mm'] / 2 + x * math.tan(math.radians(self.cutter['cone_angle_deg']))

    def margin(self):
        """The angle in front of the first relief."""
        return self.operations[1].get('behind_mm', 0) / self.radius(0)

    def sections(self):
        length = self.cutter['flute_length_mm']
        return (0.0, length / 2, length)

    def edge(self, x, tooth):
        """The angle at which the flute's rake face meets the cone."""
        # What is cut by less than the way between two setpoints shows, is found in between.
        flute, r = self.strokes[tooth][0], self.radius(x)
        step = math.radians(2)
        inside = flute.outside(x, step * numpy.arange(180)[:, None], r, flute.poses).min(axis=1) < 0
        last, = (i for i in range(180) if inside[i] and not inside[(i + self.hand) % 180])
        return boundary(last * step, (last + 2 * self.hand) * step, lambda a: flute.cuts(x, a, r))

    def clearance(self, stroke, x, angle):
        """Of a surface behind an angle, from differences to the second order."""
        step = math.radians(0.1)
        r0, r1, r2 = (stroke.left(x, angle + self.hand * i * step) for i in range(3))
        return math.atan((3 * r0 - 4 * r1 + r2) / (2 * step * r0))

    def measure(self, x, tooth):
        edge, radius, (_, primary, *more) = self.edge(x, tooth), self.radius(x), self.strokes[tooth]

        def at(behind):
            return edge + self.hand * behind

        margin = self.margin()
        begins = boundary(margin - 0.01, margin + 0.01, lambda b: primary.left(x, at(b)) > radius)
        clearance, second_clearance, land = self.clearance(primary, x, at(begins)), None, None
        if more:
            end = boundary(begins, begins + 0.6, lambda b: more[0].left(x, at(b)) > primary.left(x, at(b)))
            r = primary.left(x, at(end))
            land = math.hypot(r * math.cos(end - begins) - radius, r * math.sin(end - begins))
            second_clearance = self.clearance(more[0], x, at(end + 1e-5))
        return Measured(primary.left(x, at(margin)) - radius, begins, clearance, second_clearance, land)


def wheel(diameter, width):
    return {'profile': 'straight', 'diameter_mm': diameter, 'width_mm': width, 'corner_radius_mm': [0, 0], 'wear_mm': 0}


def job_of(cutter, teeth, flute_wheel, reliefs, **first_relief):
    """Of a cutter whose operations have no set-up yet, in one pass each so that they are over soon.
    @param cutter diameter, cone, spiral and length. @param reliefs clearance and wheel of each."""
    diameter, cone, spiral, length = cutter
    growth = 2 * length * math.tan(math.radians(cone))
    passes = {'feed_mm_min': 3000, 'infeed_mm': 20, 'finish_infeed_mm': 0}
    keys = {
        'end_diameter_mm': diameter, 'cone_angle_deg': cone, 'spiral_angle_deg': spiral, 'flute_length_mm': length,
        'rake_angle_deg': 6, 'rake_tolerance_deg': 0.5, 'chordal_rake_tolerance_deg': 40, 'spiral_tolerance_deg': 0.2,
        'core_diameter_mm': 0.7 * diameter, 'core_diameter_end_mm': 0.7 * (diameter + growth), 'core_tolerance_mm': 0.02 * diameter,
        'clearance_deg': reliefs[0][0], 'clearance_tolerance_deg': 0.5, 'cut': 'right_hand' if spiral >= 0 else 'left_hand',
        'shank_diameter_mm': diameter, 'teeth': teeth}
    if len(reliefs) > 1:
        keys.update(land_mm=0.05 * diameter, second_clearance_deg=reliefs[1][0])
    flute = dict(passes, kind='flute', spark_out=0, clearance_mm=3, order='tooth_major', direction='from_end',
                 wheel=flute_wheel)
    operations = [flute] + [dict(passes, kind='relief', relief=kind, wheel=its) for kind, (_, its) in zip(KINDS[1:], reliefs)]
    for operation in operations:
        operation['setup'] = {'file': 'tool.setup.yaml'}
    operations[1].update(first_relief)
    return {'cutter': keys, 'operations': operations,
            'interpolation': {'even_step': 'exact', 'tolerance_um': 0.5, 'rotary_scale_mm_per_rad': 1}}


def drawn(number):
    """A random cutter of either hand, with one relief or two, now and then with a margin."""
    draw = random.Random(number)
    diameter, teeth = draw.uniform(3, 15), draw.randint(4, 8)
    cutter = diameter, draw.choice([0, draw.uniform(-1, 8)]), draw.choice([-1, 1]) * draw.uniform(0, 40), draw.uniform(1, 1.5) * diameter
    clearance = draw.uniform(6, 14)
    reliefs = [(clearance, wheel(draw.uniform(60, 125), draw.uniform(4, 10))),
               (clearance + draw.uniform(8, 16), wheel(draw.uniform(60, 125), draw.uniform(4, 10)))][:draw.choice([1, 2, 2])]
    margin = draw.choice([{}, {'behind_mm': 0.02 * diameter}])
    return job_of(cutter, teeth, wheel(draw.uniform(60, 125), draw.uniform(0.3, 1) * diameter / teeth), reliefs, **margin)


def set_up(job, path):
    """Writes the file of a job, with the set-ups that are found."""
    with open(path, 'w', encoding='utf-8') as file:
        yaml.safe_dump(job, file)
    for kind, _ in zip(KINDS, job['operations']):
        grind('setup', path, '--operation', kind, '--write')
    return Tool(path, RATE, os.path.dirname(path))


class ReliefGround(unittest.TestCase):
    def near(self, name, off, allowed):
        self.assertLessEqual(abs(off), allowed, name)

    def check(self, tool, teeth=(0,)):
        even = tool.cutter['cone_angle_deg'] == 0
        for tooth in teeth:
            for x in tool.sections():
                radius, found = tool.radius(x), tool.measure(x, tooth)
                self.near('edge on a cylinder [um]' if even else 'edge on a cone [um]', 1e3 * found.edge, 0.5 if even else 1.5)
                self.near('start of the relief [mm]', radius * (found.begins - tool.margin()), 0.02)
                self.near('clearance [deg]', math.degrees(found.clearance - tool.asked[0]), 0.02)
                if found.land:
                    self.near('second clearance [deg]', math.degrees(found.second_clearance - tool.asked[1]), 0.05)
                if found.land and x == 0:
                    self.near('land [mm]', found.land - tool.cutter['land_mm'], 0.02)
                for part in (0.1, 0.5, 0.9) if tool.margin() else ():
                    angle = tool.edge(x, tooth) + part * tool.margin() * tool.hand
                    self.assertGreater(tool.strokes[tooth][1].left(x, angle), radius)

    def test_the_shipped_reamer(self):
        self.check(Tool(REAMER, SLOW, gc.temp_folder(self.addCleanup)), teeth=(0, 5))

    def test_random_cutters(self):
        cases, refused = random_cases(), []
        path = os.path.join(gc.temp_folder(self.addCleanup), 'job.yaml')
        for number in range(cases):
            try:
                tool = set_up(drawn(number), path)
            except Refused as refusal:
                refused.append('%d: %s' % (number, refusal))
                continue
            with self.subTest('%d: %s' % (number, pathlib.Path(path).read_text())):
                self.check(tool)
        self.assertGreaterEqual(cases - len(refused), max(1, cases // 3), refused)


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'relief_ground', '__main__')
