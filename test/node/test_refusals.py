#!/usr/bin/env python3
"""Shows that whatever is not allowed is refused before anything moves, each with the code and with a text that names
what is wrong, its value and what is allowed; and that the grinder is as good as before."""

import math
import re
import unittest

import rospy
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks
from grinder_client import A, DEG, LIFT, MM, MM_MIN, STROKE, UM, X, Y, Z, grinder

# Long enough for something to happen meanwhile.
LONG = gc.paper(feed=300 * MM_MIN)

NAN, INF = math.nan, math.inf

# Of every number of a goal: the smallest and the largest value allowed, the unit, and whether it may be zero.
RANGES = {
    'cutter.end_diameter': (0.1 * MM, 100 * MM, 'm', False),
    'cutter.cone_angle': (-3 * DEG, 30 * DEG, 'rad', True),
    'cutter.spiral_angle': (-60 * DEG, 60 * DEG, 'rad', True),
    'cutter.rake_angle': (-45 * DEG, 45 * DEG, 'rad', True),
    'cutter.flute_length': (0.1 * MM, 500 * MM, 'm', False),
    'cutter.rake_tolerance': (0.001 * DEG, 180 * DEG, 'rad', False),
    'cutter.chordal_rake_tolerance': (0.001 * DEG, 180 * DEG, 'rad', False),
    'cutter.chordal_rake_depth': (0, 50 * MM, 'm', True),
    'cutter.spiral_tolerance': (0.001 * DEG, 180 * DEG, 'rad', False),
    'cutter.core_diameter': (0.001 * MM, 100 * MM, 'm', False),
    'cutter.core_diameter_end': (0.001 * MM, 100 * MM, 'm', False),
    'cutter.core_tolerance': (0.0001 * MM, 100 * MM, 'm', False),
    'cutter.shank_diameter': (0.1 * MM, 100 * MM, 'm', False),
    'cutter.neck_length': (0, 500 * MM, 'm', True),
    'process.depth_end': (0, 50 * MM, 'm', True),
    'process.wheel_angle': (0, 80 * DEG, 'rad', True),
    'process.wheel_corner_radius_lower': (0, 50 * MM, 'm', True),
    'process.wheel_corner_radius_upper': (0, 50 * MM, 'm', True),
    'process.setup_swivel': (-80 * DEG, 80 * DEG, 'rad', True),
    'process.setup_height': (-100 * MM, 100 * MM, 'm', True),
    'process.feed': (0.1 * MM_MIN, 10000 * MM_MIN, 'm/s', False),
    'process.depth': (0.001 * MM, 50 * MM, 'm', False),
    'process.infeed': (0.0001 * MM, 50 * MM, 'm', False),
    'process.finish_infeed': (0, 10 * MM, 'm', True),
    'process.clearance': (0.1 * MM, 100 * MM, 'm', False),
    'process.overtravel_end': (0, 100 * MM, 'm', True),
    'process.overtravel_shank': (0, 100 * MM, 'm', True),
    'process.wheel_diameter': (1 * MM, 500 * MM, 'm', False),
    'process.wheel_width': (0.1 * MM, 100 * MM, 'm', False),
    'process.wheel_wear': (0, 100 * MM, 'm', True),
    'process.wheel_wear_per_pass': (0, 1 * MM, 'm', True),
    'interpolation.tolerance': (1e-9 * UM, 1000 * UM, 'm', False),
    'interpolation.rotary_scale': (1e-3 * MM, 1000 * MM, 'm/rad', False),
}


def number_cases():
    """(name, changed fields, field to be named, its value, unit) of every number that is not allowed."""
    for field, (low, high, unit, zero) in RANGES.items():
        values = {'nan': NAN, 'plus_inf': INF, 'minus_inf': -INF, 'far_above': 1e6, 'far_below': -1e6,
                  'just_above': high * 1.001, 'just_below': low * 1.001 if low < 0 else low * 0.999 - 1e-12}
        if not zero:
            values['zero'] = 0.0
        if low >= 0:
            values['negative'] = -gc.MOTION[field] if gc.MOTION[field] else -1e-4
        for kind, value in values.items():
            yield '%s_%s' % (field.replace('.', '_'), kind), {field: value}, field, value, unit


# Name, changed fields, goal's own fields, code, patterns that the text must match.
CASES = [
    ('no_teeth', {'cutter.tooth_angles': []}, {}, 'INVALID_GOAL', [r'cutter\.teeth = 0; allowed: 1 to 64']),
    ('too_many_teeth', {'cutter.tooth_angles': [i * 0.09 for i in range(65)]}, {}, 'INVALID_GOAL',
     [r'cutter\.teeth = 65; allowed: 1 to 64']),
    ('first_tooth_not_at_zero', {'cutter.tooth_angles': [0.25, 1.0]}, {}, 'INVALID_GOAL',
     [r'cutter\.tooth_angles = 0\.25 rad; allowed: 0 first, then ascending']),
    ('teeth_unsorted', {'cutter.tooth_angles': [0.0, 2.5, 1.5]}, {}, 'INVALID_GOAL',
     [r'cutter\.tooth_angles = 1\.5 rad; allowed: .*ascending']),
    ('teeth_twice_the_same', {'cutter.tooth_angles': [0.0, 1.5, 1.5]}, {}, 'INVALID_GOAL',
     [r'cutter\.tooth_angles = 1\.5 rad; allowed: .*ascending']),
    ('tooth_at_a_full_turn', {'cutter.tooth_angles': [0.0, 2 * math.pi]}, {}, 'INVALID_GOAL',
     [r'cutter\.tooth_angles = 6\.283\d* rad; allowed: .*below 6\.283185307 rad']),
    ('tooth_nan', {'cutter.tooth_angles': [0.0, NAN]}, {}, 'INVALID_GOAL',
     [r'cutter\.tooth_angles = -?nan rad; allowed: .*ascending']),
    ('first_tooth_nan', {'cutter.tooth_angles': [NAN]}, {}, 'INVALID_GOAL',
     [r'cutter\.tooth_angles = -?nan rad; allowed: 0 first']),
    ('tooth_inf', {'cutter.tooth_angles': [0.0, INF]}, {}, 'INVALID_GOAL',
     [r'cutter\.tooth_angles = inf rad; allowed: .*below 6\.283185307 rad']),
    ('order', {'process.order': 2}, {}, 'INVALID_GOAL', [r'process\.order = 2; allowed: 0 to 1']),
    ('order_far', {'process.order': 255}, {}, 'INVALID_GOAL', [r'process\.order = 255; allowed: 0 to 1']),
    ('direction', {'process.direction': 2}, {}, 'INVALID_GOAL', [r'process\.direction = 2; allowed: 0 to 1']),
    ('even_step', {'interpolation.even_step': 3}, {}, 'INVALID_GOAL',
     [r'interpolation\.even_step = 3; allowed: 0 to 2']),
    ('spark_out', {'process.spark_out': 101}, {}, 'INVALID_GOAL', [r'process\.spark_out = 101; allowed: 0 to 100']),
    ('finish_infeed_above_depth', {'process.finish_infeed': 0.75 * MM}, {}, 'INVALID_GOAL',
     [r'process\.finish_infeed = 0\.00075 m; allowed: up to the depth, 0\.0005 m']),
    ('infeed_for_too_many_passes', {'process.infeed': 0.0001 * MM, 'process.depth': 1.5 * MM}, {}, 'INVALID_GOAL',
     [r'process\.infeed = 1e-07 m; allowed: .*10000 passes']),
    ('depth_beyond_the_axis', {'process.depth': 5 * MM, 'process.infeed': 5 * MM}, {}, 'INVALID_GOAL',
     [r'process\.depth = 0\.005 m; allowed: less than 0\.005 m']),
    ('wear_of_the_whole_wheel', {'process.wheel_wear': 50 * MM}, {}, 'INVALID_GOAL',
     [r'process\.wheel_wear = 0\.05 m; allowed: less than 0\.05 m']),
    # tan 3 deg = 0.052408: a radius of 0.5 mm is gone after 9.5406 mm.
    ('cone_closes_before_the_flute_ends',
     {'cutter.cone_angle': -3 * DEG, 'cutter.end_diameter': 1 * MM, 'process.depth': 0.01 * MM}, {}, 'INVALID_GOAL',
     [r'cutter\.flute_length = 0\.03 m; allowed: less than 0\.009540\d* m.*cone closes']),
    ('cone_closes_in_the_overtravel',
     {'cutter.cone_angle': -3 * DEG, 'cutter.end_diameter': 1 * MM, 'cutter.flute_length': 9 * MM,
      'process.depth': 0.01 * MM}, {}, 'INVALID_GOAL',
     [r'process\.overtravel_shank = 0\.001 m; allowed: less than 0\.000540\d* m.*cone closes']),
    # tan 30 deg = 0.57735: a radius of 0.5 mm is gone 0.8660 mm before the end.
    ('cone_closes_beyond_the_small_end',
     {'cutter.cone_angle': 30 * DEG, 'cutter.end_diameter': 1 * MM, 'process.depth': 0.01 * MM}, {}, 'INVALID_GOAL',
     [r'process\.overtravel_end = 0\.001 m; allowed: less than 0\.000866\d* m.*cone closes']),
    ('cut', {'cutter.cut': 2}, {}, 'INVALID_GOAL', [r'cutter\.cut = 2; allowed: 0 to 1']),
    ('wheel_profile', {'process.wheel_profile': 5}, {}, 'INVALID_GOAL', [r'process\.wheel_profile = 5; allowed: 0 to 4']),
    ('wheel_point_without_a_radius',
     {'process.wheel_profile': 4, 'process.wheel_points': [-1.5 * MM, 50 * MM, 1.5 * MM]}, {}, 'INVALID_GOAL',
     [r'process\.wheel_points = nan m; allowed: 5e-05 to 0\.25 m']),
    ('spirals_of_too_many_teeth', {'cutter.spiral_angles': [30 * DEG, 31 * DEG]}, {}, 'INVALID_GOAL',
     [r'cutter\.spiral_angles = 2; allowed: as many as teeth, 1']),
    ('first_spiral_of_another_angle', {'cutter.spiral_angles': [0.25]}, {}, 'INVALID_GOAL',
     [r'cutter\.spiral_angles = 0\.25 rad; allowed: first cutter\.spiral_angle, 0\.523598']),
    # Tools that nobody would want.
    ('wheel_swivelled_to_the_spiral_angle',
     {'cutter.rake_tolerance': 0.5 * DEG, 'process.setup_swivel': 30 * DEG}, {}, 'INVALID_GOAL',
     [r'cutter\.rake_angle = 0\.139626 rad: tooth 1 is ground with -?[\d.]+ rad at X = [\d.]+ m; allowed: within 0\.00872665 rad']),
    ('no_land_between_32_teeth', {'cutter.tooth_angles': [i * math.pi / 16 for i in range(32)]}, {}, 'INVALID_GOAL',
     [r'no land is left on tooth \d+ at X = [\d.]+ m: its flute takes [\d.]+ rad, its pitch is 0\.19635 rad']),
    ('flute_not_complete', {'process.incomplete_ok': False}, {}, 'INVALID_GOAL',
     [r'overtravel_shank: the flutes are complete from X = [\d.e-]+ m to 0\.02\d+ m; allowed: .*0 to 0\.03 m']),
    ('first_tooth', {}, {'first_tooth': 1}, 'INVALID_GOAL', [r'first_tooth = 1.*allowed: 0 to 0']),
    ('first_pass', {}, {'first_pass': 1}, 'INVALID_GOAL', [r'first_pass = 1.*allowed: .*0 to 0']),
    ('first_pass_far', {}, {'first_pass': 65535}, 'INVALID_GOAL', [r'first_pass = 65535.*allowed: .*0 to 0']),
    # At this tip |k b| = 100 / mm^2, and so an error of 1e-15 m asks for steps of 6e-7 mm, 0.08 mm/min.
    ('tolerance_no_feed_can_meet',
     {'interpolation.tolerance': 1e-15, 'cutter.end_diameter': 0.2 * MM, 'cutter.cone_angle': 30 * DEG,
      'cutter.spiral_angle': 60 * DEG, 'cutter.flute_length': 5 * MM, 'process.overtravel_end': 0.0,
      'process.depth': 0.01 * MM}, {}, 'INVALID_GOAL',
     [r'process\.feed: interpolation tolerance allows [\d.e-]+ m/s', r'slowest feed is 1\.66667e-06 m/s']),
    ('flute_beyond_the_end_of_x', {'cutter.flute_length': 400 * MM}, {}, 'LIMIT_VIOLATED',
     [r'axis_x position 0\.401 m is 0\.101 m beyond its limit 0\.3 m \(stroke, cycle \d+, X = 0\.401 m\)']),
    # 120 mm of a 2 mm cutter at 60 deg take tan 60 deg 121 mm / 1 mm = 209.58 rad of axis_a's 125.664 rad.
    ('flute_beyond_the_turns_of_a',
     {'cutter.flute_length': 120 * MM, 'cutter.end_diameter': 2 * MM, 'cutter.cone_angle': 0.0,
      'cutter.spiral_angle': 60 * DEG}, {}, 'LIMIT_VIOLATED',
     [r'axis_a position 209\.578 rad is 83\.914\d* rad beyond its limit 125\.664 rad '
      r'\(stroke, cycle \d+, X = 0\.121 m\)']),
    ('depth_below_the_end_of_y',
     {'cutter.end_diameter': 60 * MM, 'process.depth': 25 * MM, 'process.infeed': 25 * MM}, {}, 'LIMIT_VIOLATED',
     [r'axis_y position', r'beyond its limit -0\.02 m', r'infeed, cycle \d+, X = -0\.001 m']),
    ('clearance_above_the_park_position', {'process.clearance': 60 * MM}, {}, 'INVALID_GOAL',
     [r'park position axis_y = 0\.05 m; allowed for this job: at least 0\.0627']),
]


class TestBadGoals(unittest.TestCase):
    """One case each; the methods are made of the tables."""

    @classmethod
    def setUpClass(cls):
        cls.rest = grinder().make_ready()
        cls.batches = len(grinder().batches)
        cls.joints = len(grinder().joints)

    def check(self, changes, fields, code, patterns):
        goal = gc.goal_of(dict(gc.MOTION, **changes), **fields)
        run = gc.Run(grinder(), goal).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', getattr(GrindResult, code)), run.text)
        for pattern in patterns:
            self.assertRegex(run.text, pattern)
        plan = grinder().plan(goal)
        self.assertFalse(plan.valid)
        for pattern in patterns:
            self.assertRegex('; '.join(plan.reasons), pattern)
        self.assertEqual(grinder().states[-1].state, GrinderState.READY)
        self.assertEqual(run.setpoints, [])

    def test_nothing_moved_of_any_of_them(self):
        for _, changes, fields, _, _ in CASES:
            gc.Run(grinder(), gc.goal_of(dict(gc.MOTION, **changes), **fields)).wait()
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertEqual(len(grinder().batches), self.batches)
        self.assertEqual({gc.axes_of(joint) for joint in grinder().joints[self.joints:]}, {tuple(self.rest)})

    def test_all_that_is_wrong_is_told_at_once(self):
        run = grinder().send(gc.paper(feed=NAN, flute_length=-1.0, tooth_angles=[], order=9)).wait()
        for field in ('process.feed', 'cutter.flute_length', 'cutter.teeth', 'process.order'):
            self.assertIn(field + ' = ', run.text)

    def test_dry_run_is_refused_just_so(self):
        run = grinder().send(gc.paper(feed=NAN), dry_run=True).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.INVALID_GOAL))

    def test_amount_beyond_a_position_limit_is_told(self):
        run = grinder().send(gc.paper(flute_length=400 * MM)).wait()
        value, excess, limit, x = map(float, re.search(
            r'axis_x position (\S+) m is (\S+) m beyond its limit (\S+) m \(stroke, cycle \d+, X = (\S+) m\)',
            run.text).groups())
        # The worst is the end of the stroke, the flute and the overtravel.
        self.assertEqual((value, excess, limit, x), (0.401, 0.101, 0.3, 0.401))


def add_cases():
    def method(*arguments):
        return lambda self: self.check(*arguments)

    for name, changes, field, value, unit in number_cases():
        text = '-?nan' if math.isnan(value) else re.escape('%.10g' % value)
        low, high = RANGES[field][:2]
        pattern = r'%s = %s %s; allowed: (\S+) to (\S+) %s' % (re.escape(field), text, unit, unit)

        def check(self, changes=changes, pattern=pattern, low=low, high=high):
            self.check(changes, {}, 'INVALID_GOAL', [pattern])
            reasons = '; '.join(grinder().plan(gc.goal_of(dict(gc.MOTION, **changes))).reasons)
            told = [float(limit) for limit in re.search(pattern, reasons).groups()]
            self.assertAlmostEqual(told[0], low, delta=1e-9 * abs(low))
            self.assertAlmostEqual(told[1], high, delta=1e-9 * abs(high))

        setattr(TestBadGoals, 'test_' + name, check)
    for name, *arguments in CASES:
        setattr(TestBadGoals, 'test_' + name, method(*arguments))


add_cases()


class TestZeroIsAllowed(unittest.TestCase):
    """Where zero means something: a cylinder, a straight flute, no finishing pass."""

    def test_plan_is_valid(self):
        # Short, so that a wheel without swivel stays clear of the collet.
        for field in sorted(f for f in RANGES if RANGES[f][3]) + ['process.spark_out']:
            plan = grinder().plan(gc.goal_of(dict(gc.MOTION, **{'cutter.flute_length': 20 * MM, field: 0})))
            self.assertTrue(plan.valid, '%s: %s' % (field, plan.reasons))


class TestState(unittest.TestCase):
    """What the machine's state does not allow."""

    def setUp(self):
        grinder().make_ready()

    def test_goal_while_disabled(self):
        self.assertTrue(grinder().disable().success)
        rest = grinder().wait_rest()
        run = grinder().send(gc.MOTION).wait()
        self.assertEqual((run.status, run.code), ('REJECTED', GrindResult.NOT_READY))
        self.assertRegex(run.text, r'state disabled; allowed: .*enable')
        state = grinder().fresh_state()
        self.assertEqual((state.state, state.enabled), (GrinderState.DISABLED, False))
        self.assertEqual(run.setpoints, [])
        self.assertEqual(grinder().positions(), rest)

    def test_second_goal_is_busy_and_the_first_goes_on(self):
        first = grinder().send(LONG).wait_in_stroke(2 * MM)
        second = grinder().send(gc.SHORT).wait()
        self.assertEqual((second.status, second.code), ('REJECTED', GrindResult.BUSY))
        self.assertRegex(second.text, r'running; allowed: .*cancel')
        self.assertFalse(first.done)
        first.wait_complete()
        self.assertEqual((first.status, first.code), ('SUCCEEDED', 0), first.text)
        self.assertTrue(checks.is_gapless(first.setpoints))
        self.assertEqual(len(first.setpoints), first.result.statistics.setpoints)
        self.assertEqual(second.setpoints, [])
        self.assertEqual(checks.excesses(first.setpoints, grinder().limits(), grinder().period()), [])

    def test_bad_goal_and_dry_run_are_busy_too(self):
        first = grinder().send(LONG).wait_in_stroke(0)
        for job, fields in ((gc.paper(feed=NAN), {}), (gc.MOTION, {'dry_run': True})):
            other = grinder().send(job, **fields).wait()
            self.assertEqual((other.status, other.code), ('REJECTED', GrindResult.BUSY))
        self.assertFalse(first.done)
        first.cancel()
        first.wait()

    def test_enable_twice_changes_nothing(self):
        rest = grinder().positions()
        self.assertTrue(grinder().enable().success)
        self.assertTrue(grinder().enable().success)
        state = grinder().fresh_state()
        self.assertEqual((state.state, state.enabled), (GrinderState.READY, True))
        self.assertEqual(grinder().positions(), rest)

    def test_disable_twice_is_no_error(self):
        self.assertTrue(grinder().disable().success)
        self.assertTrue(grinder().disable().success)
        self.assertEqual(grinder().fresh_state().state, GrinderState.DISABLED)

    def test_enable_home_lift_and_reset_while_running(self):
        run = grinder().send(LONG).wait_in_stroke(2 * MM)
        for service in (grinder().enable, grinder().home, grinder().lift, grinder().reset):
            reply = service()
            self.assertFalse(reply.success)
            self.assertRegex(reply.message,
                             r'refused: the machine is in state running; allowed: disable, hold, cancel$')
        run.wait_complete()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertTrue(checks.is_gapless(run.setpoints))

    def test_disable_while_running_cancels_first(self):
        run = grinder().send(LONG).wait_in_stroke(2 * MM)
        reply = grinder().disable()
        self.assertEqual((reply.success, reply.message), (True, ''))
        run.wait_complete()
        self.assertEqual((run.status, run.code), ('PREEMPTED', GrindResult.CANCELED))
        state = grinder().wait_power_off()
        self.assertEqual((state.wheel_in_work, state.fault), (False, ''))
        self.assertTrue(checks.is_gapless(run.setpoints))
        self.assertEqual(checks.excesses(run.setpoints, grinder().limits(), grinder().period()), [])
        self.assertEqual(checks.off_path(run.setpoints, checks.Helix(LONG)), [])
        stop = [s for s in run.setpoints if s.move == STROKE][-1]
        lifted = run.setpoints[-1]
        self.assertEqual(lifted.move, LIFT)
        self.assertEqual([lifted.position[i] for i in (X, Z, A)], [stop.position[i] for i in (X, Z, A)])
        self.assertAlmostEqual(lifted.position[Y], checks.Helix(LONG).y(31 * MM) + 5 * MM, delta=1e-12)

    def test_lift_off_the_work(self):
        rest = grinder().wait_rest()
        reply = grinder().lift()
        self.assertEqual((reply.success, reply.message),
                         (False, 'lift refused: the wheel does not stand in the work'))
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertEqual(grinder().positions(), rest)

    def test_reset_without_a_fault(self):
        reply = grinder().reset()
        self.assertFalse(reply.success)
        self.assertRegex(reply.message, r'^reset refused: the machine is in state ready; allowed: .*disable')
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertTrue(grinder().disable().success)
        # The drive may have a fault of its own by now, which nothing else takes back.
        self.assertTrue(grinder().reset().success)
        self.assertEqual(grinder().fresh_state().state, GrinderState.DISABLED)

    def test_unknown_fault_cannot_be_injected(self):
        for fault, joint, named in (('earthquake', '', 'fault = earthquake; allowed: none, emergency_stop'),
                                    ('stuck_axis', 'axis_q', 'joint = axis_q; allowed: axis_x, axis_y')):
            reply = grinder().inject(fault, joint)
            self.assertFalse(reply.success)
            self.assertIn(named, reply.message)
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)

    def test_plan_while_running_does_not_disturb(self):
        run = grinder().send(LONG).wait_in_stroke(0)
        self.assertTrue(grinder().plan(gc.goal_of(gc.SHORT)).valid)
        self.assertFalse(grinder().plan(gc.goal_of(gc.paper(feed=NAN))).valid)
        self.assertFalse(run.done)
        run.wait_complete()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertTrue(checks.is_gapless(run.setpoints))


class TestAfterwards(unittest.TestCase):
    def test_next_good_goal_runs(self):
        grinder().make_ready()
        for _, changes, fields, _, _ in CASES:
            gc.Run(grinder(), gc.goal_of(dict(gc.MOTION, **changes), **fields)).wait()
        run = grinder().run(gc.SHORT)
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
        self.assertTrue(checks.is_gapless(run.setpoints))
        self.assertAlmostEqual(max(s.position[X] for s in run.setpoints if s.move == STROKE), 6 * MM, delta=1e-9)
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
