#!/usr/bin/env python3
"""Shows that bench/peers.py finds the errors that strokes are given, and that its law and chords are right. Nothing is run here."""

import math
import pathlib
import sys
import unittest

import numpy

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'bench'))
import peers  # noqa: E402
import trajectory_peers  # noqa: E402

LIMITS = numpy.array([0.5, 0.5, 0.5, 62.83]), numpy.array([10, 10, 10, 1257])
CYLINDER = peers.Cutter(0.01, 0, math.radians(30), 0)
CONE = peers.Cutter(0.01, math.radians(5), math.radians(30), math.radians(8))


def smooth(x_of, duration):
    """X of the cycles of a stroke that begins and ends at rest."""
    return x_of(numpy.arange(round(duration / peers.PERIOD) + 1) * peers.PERIOD / duration)


class PeersTest(unittest.TestCase):
    def test_states_of_a_trajectory_are_the_law_s_with_its_derivatives(self):
        timed = trajectory_peers.timed(CONE, 0.01, *LIMITS)
        states, h = timed.states(1e-3), 1e-5
        time = states[:, 0]
        self.assertTrue((numpy.diff(time) > 0).all())
        self.assertLessEqual(numpy.diff(states[:, 1]).max(), 1.0001e-3)
        numpy.testing.assert_allclose(states[[0, -1], 1], [0, peers.LENGTH], atol=1e-12)
        self.assertAlmostEqual(states[len(time) // 2, 5] * CONE.edge(), 0.01)  # the feed along the edge
        before, at, after = (CONE.rows(timed.x(numpy.clip(time + s * h, 0, timed.duration))[0]) for s in (-1, 0, 1))
        numpy.testing.assert_allclose(states[:, 1:5], at)
        inner = slice(1, -1)
        numpy.testing.assert_allclose(states[inner, 5:9], ((after - before) / 2 / h)[inner], rtol=1e-4, atol=1e-5)
        # At the ends of the ramps the acceleration has a corner.
        smooth = (numpy.abs(time - timed.ramp) > h) & (numpy.abs(time - timed.duration + timed.ramp) > h)
        smooth[[0, -1]] = False
        numpy.testing.assert_allclose(states[smooth, 9:13], ((after - 2 * at + before) / h**2)[smooth], rtol=1e-3, atol=2e-2)

    def test_an_error_of_a_is_found_where_it_is(self):
        rows = CONE.rows(peers.LENGTH * smooth(lambda t: 3 * t**2 - 2 * t**3, 4))
        rows[:, 3] += 1e-5 * numpy.sin(math.pi * rows[:, 0] / 0.01)  # none at each 10 mm, most between them
        found = peers.judge(CONE, rows, *LIMITS, points=numpy.array([0, 0.01, 0.02, 0.03]))
        self.assertLess(found['at_points'], 4e-8)  # of the chords between setpoints
        self.assertAlmostEqual(found['between'], 1e-5, delta=4e-8)

    def test_without_points_the_setpoints_are_meant(self):
        rows = CONE.rows(numpy.linspace(0, peers.LENGTH, 31))  # chords of 1 mm: a b dX^2/8 at the small end
        found = peers.judge(CONE, rows, *LIMITS)
        self.assertLess(found['at_points'], 1e-12)
        self.assertAlmostEqual(found['between'], CONE.k * CONE.b * 1e-6 / 8, delta=2e-2 * found['between'])

    def test_chords_of_the_coarsest_spacing_use_the_tolerance(self):
        ends = CONE.rows(numpy.array([0, CONE.spacing()]))
        x, y, _, a = ends.mean(axis=0)
        radius = 0.005 + y
        off = abs(a - math.tan(math.radians(30)) / math.tan(math.radians(5)) * math.log(radius / 0.005))
        across = radius * off * math.cos(math.atan2(math.tan(math.radians(30)), 1 / math.cos(math.radians(5))))
        self.assertAlmostEqual(across, peers.TOLERANCE, delta=0.03 * peers.TOLERANCE)

    def test_feed_acceleration_and_jerk_of_a_cubic_on_a_cylinder(self):
        x = peers.LENGTH * smooth(lambda t: 3 * t**2 - 2 * t**3, 4)
        found = peers.judge(CYLINDER, CYLINDER.rows(x), *LIMITS)
        # Speed 6 L t (1 - t)/T, most amid the stroke; X over A is everywhere 1 to k, and so are their accelerations.
        self.assertAlmostEqual(found['feed'][1], 1.5 * peers.LENGTH / 4 / math.cos(math.radians(30)), delta=1e-6)
        per_limit = max(1 / 0.5, CYLINDER.k / 62.83)
        for use in found['acceleration']:
            self.assertAlmostEqual(use, 6 * peers.LENGTH / 16 * per_limit, delta=0.01 * use)
        # The acceleration steps from nothing to 6 L/T^2: by 3 in the first cycle, by 4.5 at most in two.
        for use, part in zip(found['jerk'], (3, 4.5 / 2)):
            self.assertAlmostEqual(use, part * peers.LENGTH / 16 / peers.PERIOD / 10, delta=0.01 * use)

    def test_inverse_time_gives_the_feed(self):
        program = peers.g_code(CYLINDER, numpy.array([0, 0.03]), 0.01, 'G61').splitlines()
        turned, minutes = 6 / math.sqrt(3), 0.03 / math.cos(math.radians(30)) / 0.01 / 60
        self.assertEqual(program[1], 'G1 X30.000000 Y0.000000 Z0.000000 A%.6f F%.6f' % (math.degrees(turned), 1 / minutes))


if __name__ == '__main__':
    unittest.main()
