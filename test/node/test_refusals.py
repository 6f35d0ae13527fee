"""Shows that whatever is not allowed is refused before anything moves, each with the code and with a text that names
what is wrong, its value and what is allowed; and that the grinder is as good as before."""

import unittest

from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
from grinder_client import DEG, MM, X, grinder

# Of what only a message can ask for, and of each kind of refusal one: name, changed fields, goal's own fields, code, patterns that
# the text must match.
CASES = [
    ('cut', {'cutter.cut': 2}, {}, 'INVALID_GOAL', [r'cutter\.cut = 2; allowed: 0 to 1']),
    ('wheel_point_without_a_radius',
     {'process.wheel_profile': 4, 'process.wheel_points': [-1.5 * MM, 50 * MM, 1.5 * MM]}, {}, 'INVALID_GOAL',
     [r'process\.wheel\.points_mm = nan mm; allowed: 0\.05 to 250 mm']),
    ('first_spiral_of_another_angle', {'cutter.spiral_angles': [0.25]}, {}, 'INVALID_GOAL',
     [r'cutter\.spiral_angles_deg = 14\.3239\d* deg; allowed: first cutter\.spiral_angle_deg, 30 deg']),
    ('wheel_swivelled_to_the_spiral_angle',
     {'cutter.rake_tolerance': 0.5 * DEG, 'process.setup_swivel': 30 * DEG}, {}, 'INVALID_GOAL',
     [r'cutter\.rake_angle_deg = 8 deg: tooth 1 is ground with -?[\d.]+ deg at X = [\d.]+ mm; allowed: within 0\.5 deg']),
    ('first_tooth', {}, {'first_tooth': 1, 'dry_run': True}, 'INVALID_GOAL', [r'first_tooth = 1.*allowed: 0 to 0']),
    ('flute_beyond_the_end_of_x', {'cutter.flute_length': 400 * MM}, {}, 'LIMIT_VIOLATED',
     [r'axis X machine position 401 mm is 101 mm beyond its limit 300 mm \(stroke, tooth 1, pass 1, X = 401 mm\)']),
    ('clearance_above_the_park_position', {'process.clearance': 60 * MM}, {}, 'INVALID_GOAL',
     [r'park position axis Y = 50 mm; allowed for this job: at least 62\.7']),
]


class TestRefusals(unittest.TestCase):
    def test_each_is_refused_nothing_moves_and_the_next_good_goal_runs(self):
        g = grinder()
        rest = g.make_ready()
        batches, joints = len(g.batches), len(g.joints)
        for name, changes, fields, code, patterns in CASES:
            with self.subTest(name):
                goal = gc.goal_of(dict(gc.MOTION, **changes), **fields)
                run = gc.Run(g, goal).wait()
                self.assertEqual((run.status, run.code), ('REJECTED', getattr(GrindResult, code)), run.text)
                plan = g.plan(goal)
                self.assertFalse(plan.plan.valid)
                self.assertEqual(plan.error_string, run.text)
                self.assertEqual('; '.join(reason.text for reason in plan.reasons), run.text)
                for pattern in patterns:
                    self.assertRegex(run.text, pattern)
        # Every number is refused by the name of its field.
        for field, value in gc.PAPER.items():
            wrong = {float: 1e6, int: 200}.get(type(value))
            if wrong is not None:
                plan = g.plan(gc.goal_of(dict(gc.MOTION, **{field: wrong})))
                self.assertIn((field, wrong), [(reason.field, reason.value) for reason in plan.reasons])
        # Faults that there are not cannot be injected.
        for fault, axis, named in (('earthquake', X, 'fault = earthquake; allowed: none, emergency_stop'),
                                   ('stuck_axis', 4, 'axis = 4; allowed: 0 to 3 for X, Y, Z, A')):
            reply = g.inject(fault, axis)
            self.assertFalse(reply.success)
            self.assertIn(named, reply.message)
        self.assertEqual(g.fresh_state().state, GrinderState.READY)
        self.assertEqual(len(g.batches), batches)
        self.assertEqual({gc.axes_of(joint) for joint in g.joints[joints:]}, {tuple(rest)})
        run = g.run(gc.SHORT)
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
