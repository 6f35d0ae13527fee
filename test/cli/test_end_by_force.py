#!/usr/bin/env python3
"""Holds the setpoints of the flutes, gashes, end teeth and chamfers of shipped end mills of both hands against what the wheels
leave that follow them: from the file of `grind plan --csv`, the wheels and the set-up of the job file. On rays parallel to the
axis, each position of a wheel takes away a range of X, of a cup with its recess two."""

import math
import pathlib
import shutil
import sys
import tempfile
import unittest

import numpy
import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from planned_strokes import plan, read_job  # noqa: E402

RATE = 200  # [Hz] of the setpoints; of the flutes', whose edges are off by more between them, it is five times as high
STEP = 0.01  # of differences [mm]


class Stroke:
    """The last stroke of a tooth in an operation. All lengths in mm."""

    def __init__(self, process, poses, tooth, every):
        wheel = process['wheel']
        self.kind, self.tooth = process['name'], tooth
        self.radius, self.half_width = wheel['diameter_mm'] / 2, wheel['width_mm'] / 2
        self.taper = math.tan(math.radians(wheel.get('angle_deg', 0)))
        self.larger = -1 if wheel.get('side') == 'lower' else 1  # the larger face, along the spindle
        self.recess = self.radius - wheel['rim_mm'] if 'rim_mm' in wheel else None
        swivel = math.radians(process['setup']['swivel_deg'])
        self.sine, self.cosine = math.sin(swivel), math.cos(swivel)
        if self.kind == 'flute':  # the rest of it is far from the end
            poses = poses[:, poses[0] < 12]
        self.poses = numpy.hstack([poses[:, ::every], poses[:, -1:]])

    def removed(self, r, angle):
        """The ranges of X on rays, for each position and ray; from infinity to there if there is none.
        @return the indices of the rays that are met at all, and the ranges on these."""
        # In a wheel, whose spindle is at right angles to Y, a place is not farther from the axis along -Y.
        near = r * numpy.cos(angle - self.poses[3][:, None]) > self.poses[1][:, None] - self.radius
        poses, rays = self.poses[:, near.any(axis=1), None], near.any(axis=0).nonzero()[0]
        return (rays, *self.on_rays(poses, r[rays], angle[rays]))

    def on_rays(self, poses, r, angle):
        centre_x, centre_y, centre_z, a = poses
        off_y, off_z = r * numpy.cos(angle - a) - centre_y, r * numpy.sin(angle - a) - centre_z
        # Over x from the centre: along the axis u - sine x; its square and the one of the distance from it are off ** 2 + x ** 2.
        u = self.cosine * off_z
        rim, rim_x = self.radius - self.taper * (self.half_width - self.larger * u), -self.larger * self.taper * self.sine

        def within(rim, rim_x):
            """Where a ray is in a cone about the spindle; no number if it is nowhere."""
            a2 = 1 - self.sine ** 2 - rim_x ** 2
            a1 = u * self.sine - rim * rim_x
            a0 = off_y ** 2 + off_z ** 2 - u ** 2 - rim ** 2
            with numpy.errstate(invalid='ignore'):
                reach = numpy.sqrt(a1 ** 2 - a2 * a0)
            return (-a1 - reach) / a2, (-a1 + reach) / a2

        half = math.copysign(self.half_width, self.sine)
        outer = within(rim, rim_x)
        low, high = numpy.maximum((u - half) / self.sine, outer[0]), numpy.minimum((u + half) / self.sine, outer[1])
        if self.recess is not None:
            inner = [numpy.where(numpy.isnan(x), at, x) for x, at in zip(within(self.recess, 0), (high, high))]
            low, high = (numpy.concatenate([low, numpy.maximum(low, inner[1])]),
                         numpy.concatenate([numpy.minimum(high, inner[0]), high]))
            centre_x = numpy.concatenate([centre_x, centre_x])
        met = low < high  # not for no number
        return numpy.where(met, low + centre_x, math.inf), numpy.where(met, high + centre_x, -math.inf)


class Tool:
    """The strokes of the job's operations on the end."""

    def __init__(self, file, folder):
        job = read_job(file)
        self.cutter, self.printed, self.strokes = job['cutter'], {}, []
        self.radius = self.cutter['end_diameter_mm'] / 2
        self.turns = numpy.radians(self.cutter.get('tooth_angles_deg') or numpy.arange(self.cutter['teeth']) * 360 / self.cutter['teeth'])
        self.teeth = len(self.turns)
        # Those of which no two are alike, the first ones: the pitches of two halves are the same.
        self.distinct = range(self.teeth // self.cutter['end'].get('center_teeth', self.teeth))
        self.hand = -1 if self.cutter['cut'] == 'left_hand' else 1  # of the way behind an edge, in the sense of A
        for process in job['operations']:
            name = process['name']
            if process['kind'] == 'relief':
                continue
            self.printed[name], poses = plan(file, job, process, 5 * RATE if name == 'flute' else RATE, folder)
            # Between some, about 1 um is left by a rim.
            strokes, every = ([Stroke(process, own, tooth, step) for tooth, own in enumerate(poses)]
                              for step in (4 if name == 'flute' else 20, 1))
            self.strokes += strokes
            self.flutes = every if name == 'flute' else self.flutes
        self.angles = list(self.turns)
        self.angles = [angle + self.helix(tooth, 0) for tooth, angle in zip(self.distinct, self.angles)]

    def of(self, tooth, *kinds):
        return [s for s in self.strokes if s.tooth == tooth and (not kinds or s.kind in kinds)]

    def ray(self, tooth, r, behind):
        """At a distance along the tooth's radius, and one at right angles to it."""
        return numpy.hypot(r, behind), self.angles[tooth] + self.hand * numpy.arctan2(behind, r)

    def helix(self, tooth, x):
        """The angle from a tooth's to its flute's edge on the periphery, at X."""
        low, high = -1.0, 2.0
        for _ in range(5):
            behind = numpy.linspace(low, high, 41)
            ray = numpy.full(41, self.radius), self.angles[tooth] + self.hand * behind
            last = self.is_removed([self.flutes[tooth]], ray, x).nonzero()[0][-1]
            low, high = behind[last], behind[last + 1]
        return self.hand * high

    @staticmethod
    def is_removed(strokes, ray, x):
        """At X on each ray."""
        taken = numpy.zeros(len(ray[0]), bool)
        for stroke in strokes:
            met, low, high = stroke.removed(*ray)
            at = numpy.broadcast_to(x, taken.shape)[met]
            taken[met] |= ((low <= at) & (at <= high)).any(axis=0)
        return taken

    def surface(self, strokes, tooth, r, behind):
        """X of what is left on rays into a blank that ends at X = 0, and the index of the stroke that left it."""
        ray = self.ray(tooth, r, behind)
        ranges = [stroke.removed(*ray) for stroke in strokes]
        x, by = numpy.zeros(len(ray[0])), numpy.full(len(ray[0]), -1)
        while True:
            before = x.copy()
            for i, (met, low, high) in enumerate(ranges):
                reached = numpy.where(low <= x[met] + 1e-12, high, -math.inf).max(axis=0, initial=-math.inf)
                farther = reached > x[met]
                by[met[farther]], x[met[farther]] = i, reached[farther]
            if (x == before).all():
                return x, by

    def edges(self, strokes, tooth, rs, kind, first, last):
        """At each distance from the axis, where behind the radius a flank begins, and its X there; NaN where there is none."""
        flank = next(i for i, s in enumerate(strokes) if s.tooth == tooth and s.kind == kind)
        low, high = numpy.full(len(rs), first), numpy.full(len(rs), last)
        for count in (41, 21, 21, 21):
            places = low + (high - low) * numpy.linspace(0, 1, count)[:, None]
            x, by = self.surface(strokes, tooth, numpy.tile(rs, count), places.ravel())
            is_flank = (by == flank).reshape(count, -1)
            at = is_flank.argmax(axis=0)
            found = is_flank.any(axis=0) & (at > 0)
            column = numpy.arange(len(rs))
            low, high = places[at - 1, column], places[at, column]
        x = x.reshape(count, -1)[at, column]
        return numpy.where(found, high, math.nan), numpy.where(found, x, math.nan)


class RightHandEndByForce(unittest.TestCase):
    FILE = 'jobs/end_mill_d12_t6.yaml'
    PARTS = [0.2, 0.3, 0.6, 0.9]  # of the radius, at which the flanks are measured: farther in, the next gash takes the secondary one
    KEPT = 1e-4  # by which another tooth's stroke may set an edge back [mm]

    @classmethod
    def setUpClass(cls):
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.tool = Tool(gc.package_file(cls.FILE), folder)
        cls.end, cls.chamfer = cls.tool.cutter['end'], cls.tool.cutter['chamfer']
        cls.dish, cls.clearance = (math.tan(math.radians(cls.end[key])) for key in ('dish_deg', 'clearance_deg'))
        cls.corner = cls.tool.radius - cls.chamfer['width_mm']
        cls.rs = numpy.array(cls.PARTS) * cls.corner

    def near(self, tooth, name, values, asked, allowed):
        self.assertLessEqual(numpy.abs(values - asked).max(), allowed, '%s of tooth %d: %s' % (name, tooth + 1, values))

    def x(self, tooth, r, behind):
        return self.tool.surface(self.tool.strokes, tooth, r, behind)[0]

    def flank(self, tooth, kind, first, last):
        """Where a flank begins, and its clearance and dish there in deg."""
        behind = self.tool.edges(self.tool.strokes, tooth, self.rs, kind, first, last)[0]
        x, inside, along = (self.x(tooth, self.rs - off, behind + way) for off, way in ((0, STEP), (STEP, STEP), (0, 2 * STEP)))
        return behind, numpy.degrees(numpy.arctan((along - x) / STEP)), numpy.degrees(numpy.arctan((inside - x) / STEP))

    def test_the_other_teeth_are_ground_in_the_same_way(self):
        for stroke in self.tool.strokes:
            first = stroke.tooth % len(self.tool.distinct)
            like, = self.tool.of(first, stroke.kind)
            turned = stroke.poses - [[0], [0], [0], [self.tool.turns[stroke.tooth] - self.tool.turns[first]]]
            way = numpy.ptp(stroke.poses[:3], axis=1).argmax()
            order = like.poses[way].argsort()
            for row, of_like in zip(turned, like.poses):
                self.near(stroke.tooth, stroke.kind, row, numpy.interp(turned[way], like.poses[way][order], of_like[order]), 1e-5)

    def test_flanks(self):
        for tooth in self.tool.distinct:
            for kind, key, first, last, begins in (('end_primary', 'clearance_deg', -0.02, 0.1, 0),
                                                   ('end_secondary', 'second_clearance_deg', 0.2, 0.6, self.end['land_mm'])):
                behind, clearance, dish = self.flank(tooth, kind, first, last)
                self.near(tooth, key, clearance, self.end[key], 0.01)
                self.near(tooth, 'dish', dish, self.end['dish_deg'], 0.01)
                # Of the primary one the flute's hook has taken a little outside.
                self.near(tooth, kind, behind, begins, 0.002 if begins else 0.03)

    def test_rake_of_the_gash(self):
        for tooth in self.tool.distinct:
            x, faces = (self.tool.radius - self.rs) * self.dish, []
            for depth in (0.02, 0.06):
                low, high = numpy.full(len(x), -0.02), numpy.full(len(x), 0.1)
                for _ in range(25):
                    middle = (low + high) / 2
                    gone = self.tool.is_removed(self.tool.of(tooth, 'gash'), self.tool.ray(tooth, self.rs, middle), x + depth)
                    low, high = numpy.where(gone, middle, low), numpy.where(gone, high, middle)
                faces.append(low)
            self.near(tooth, 'rake', numpy.degrees(numpy.arctan((faces[1] - faces[0]) / 0.04)), self.end['rake_deg'], 0.01)

    def test_gashes_go_into_the_core_as_printed(self):
        turn = numpy.linspace(0, 2 * math.pi, 20000, endpoint=False)
        core = numpy.full(len(turn), self.tool.cutter['core_diameter_mm'] / 2)  # at both ends
        deepest = [max(high.max() for stroke in self.tool.of(tooth, 'gash') for _, _, high in [stroke.removed(core, turn)])
                   for tooth in self.tool.distinct]
        self.assertGreater(min(deepest), 1)
        printed = self.tool.printed['chamfer']['figures']['gash_in_core']
        self.assertNotIn('asked_mm', printed)
        for got, by_force in zip(printed['ground_mm'], (min(deepest), max(deepest))):
            self.assertAlmostEqual(got, by_force, delta=0.005)

    def is_whole(self, tooth, rs):
        """Whether an edge is where the tooth's own strokes leave it, in the plane that is asked, so that no other touches it."""
        all_strokes, own = (self.tool.edges(strokes, tooth, rs, 'end_primary', -0.02, 0.1)
                            for strokes in (self.tool.strokes, self.tool.of(tooth)))
        plane = (self.tool.radius - rs) * self.dish + all_strokes[0] * self.clearance
        return ((abs(all_strokes[0] - own[0]) < self.KEPT) & (abs(all_strokes[1] - own[1]) < self.KEPT) &
                (abs(all_strokes[1] - plane) < 1e-3))

    def printed_beginning(self, tooth):
        """Where a tooth's edge begins by the plan, which is within what is asked."""
        is_short = tooth % (self.tool.teeth // self.end.get('center_teeth', self.tool.teeth)) > 0
        key, asked, part = ('short_from', 'short_from_mm', 1) if is_short else ('uncut_diameter', 'uncut_diameter_mm', 2)
        printed = self.tool.printed['chamfer']['figures'][key]['ground_mm'][1]
        self.assertLess(printed, self.end[asked])
        return printed / part

    def test_edges_are_whole_from_where_they_begin(self):
        for tooth in self.tool.distinct:
            printed = self.printed_beginning(tooth)
            near = printed + numpy.arange(-0.04, 0.05, 0.01)
            rs = numpy.concatenate([near[near > 0], numpy.linspace(printed + 0.05, self.corner - 0.02, 6)])
            whole = self.is_whole(tooth, rs)
            self.assertTrue(whole.any())
            self.near(tooth, 'whole from', rs[~whole].max(initial=0), printed, 0.02)

    def test_the_edges_of_the_periphery_are_untouched(self):
        strokes = [s for s in self.tool.strokes if s.kind != 'flute']
        for tooth in self.tool.distinct:
            # Behind the chamfer; in front of that it has taken them.
            x = numpy.concatenate([[0.1], numpy.linspace(0.23, self.tool.radius, 8)])
            angles = numpy.array([self.tool.angles[tooth] + self.tool.helix(tooth, at) for at in x])
            behind = self.tool.hand * 0.005 / self.tool.radius
            ray = numpy.full(len(x), self.tool.radius - 1e-5), angles + behind
            self.assertEqual(self.tool.is_removed(strokes, ray, x).tolist(), [True] + 8 * [False])

    def test_chamfer(self):
        radius = self.tool.radius
        for tooth in self.tool.distinct:
            def edge(kind, rs, tooth=tooth):
                return self.tool.edges(self.tool.strokes, tooth, numpy.array(rs), kind, -0.02, 0.2)

            rs = self.corner + numpy.linspace(-0.04, 0.04, 17)
            with numpy.errstate(invalid='ignore'):  # a place that is no number is not less
                before = ~(edge('chamfer', rs)[0] <= numpy.nan_to_num(edge('end_primary', rs)[0], nan=math.inf))
            self.near(tooth, 'width', radius - rs[before].max(), self.chamfer['width_mm'], 0.02)
            rs = numpy.array([self.corner + 0.02, radius - 0.02])
            behind, x = edge('chamfer', rs)
            rise = (x[1] - x[0]) / (rs[1] - rs[0])
            self.near(tooth, 'angle', math.degrees(math.atan2(1, rise)), self.chamfer['angle_deg'], 0.3)
            along = numpy.array([x[1] - x[0], rs[1] - rs[0], behind[1] - behind[0]])
            fall = (self.x(tooth, rs, behind + 2 * STEP) - self.x(tooth, rs, behind + STEP))[0] / STEP
            normal, of_surface = numpy.cross(along, [fall, 0, 1]), numpy.array([-1, rise, 0])
            cosine = abs(normal @ of_surface) / numpy.linalg.norm(normal) / numpy.linalg.norm(of_surface)
            self.near(tooth, 'clearance', math.degrees(math.acos(cosine)), self.chamfer['clearance_deg'], 0.3)


class LeftHandEndByForce(RightHandEndByForce):
    FILE = 'jobs/left_hand_end_mill_d8_t3.yaml'
    PARTS = [0.1, 0.3, 0.6, 0.9]


class CentreCuttingByForce(RightHandEndByForce):
    FILE = 'jobs/center_cutting_d10_t4.yaml'
    PARTS = [0.35, 0.5, 0.7, 0.9]  # where the short teeth are, too
    KEPT = 0.01  # rims end across edges, at a narrow angle; the plan allows as much

    NEAR = 1e-6, 0.01, 0.03, 0.06, 0.1, 0.3, 0.6, 1, 1.4  # up to where the short teeth are

    def test_nothing_stands_in_front_of_the_edges_over_the_centre(self):
        turn = numpy.linspace(0, 2 * math.pi, 720, endpoint=False)
        for r in self.NEAR:
            x = self.x(0, r * numpy.cos(turn), r * numpy.sin(turn))
            self.assertGreaterEqual(x.min(), (self.tool.radius - r) * self.dish - 0.005, r)


class SlotDrillByForce(CentreCuttingByForce):
    FILE = 'jobs/slot_drill_d8_t2.yaml'
    NEAR = 1e-6, 0.01, 0.06, 0.1, 0.3, 0.6, 0.9, 1.1


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'end_by_force', '__main__')
