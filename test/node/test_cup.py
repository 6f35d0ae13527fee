"""Shows on any drive that a cup grinds the flanks of a left-hand end as planned, and that it leaves the tooth that its rim is round
only as it came: retracted, and lifted after a fault, it backs off along X before it rises."""

import rospy
import yaml
from flute_grinder import job as job_file
from flute_grinder.msg import GrinderState

import grinder_client as gc
import path_checks as checks
from grind_command import CommandLine
from grinder_client import LIFT, MM, STROKE, A, X, Y, Z, grinder

CLEARANCE = 1 * MM
NEAR = 1e-6  # an increment of the drive, and more than the first and the last setpoint of a stroke are from its ends


class TestCup(CommandLine):
    """In one stroke on each tooth."""

    def setUp(self):
        super().setUp()
        grinder().make_ready_at_park()
        self.job = gc.end_file(self.path('mill.yaml'), 'left_hand_end_mill_d8_t3')
        self.goal = job_file.goal(self.job, 'end_primary')
        self.grind(0, 'plan', self.job, '--operation', 'end_primary', '--csv', self.path('plan.csv'))
        strokes = [row for row in self.csv(self.path('plan.csv')) if row['move'] == 'stroke']
        self.start, self.end = (float(row['x_mm']) * MM for row in (strokes[0], strokes[-1]))
        self.bottom = float(strokes[0]['y_mm']) * MM

    def begin_stroke(self):
        """A run that creeps, deeper than 0.5 mm into the first tooth."""
        self.assertTrue(grinder().set_feed_override(0.02).success)
        return grinder().send(self.goal).wait_in_stroke(self.start + 0.5 * MM)

    def check_way(self, places):
        """That the rim was nowhere round a tooth but at the depth of the strokes."""
        for place in places:
            self.assertTrue(place[X] <= self.start + NEAR or place[Y] >= CLEARANCE - NEAR or
                            abs(place[Y] - self.bottom) <= NEAR, place)

    def test_streamed_as_planned(self):
        self.grind(0, 'confirm-swivel', '81.76')
        self.grind(0, 'run', self.job, '--operation', 'end_primary', '--answer', 'discard', '--answer', 'ignore-offsets',
                   '--csv', self.path('run.csv'))
        planned, streamed = (self.csv(self.path(name + '.csv')) for name in ('plan', 'run'))
        # What the drive read beside it is the run's alone.
        self.assertTrue(planned == [{key: row[key] for key in planned[0]} for row in streamed], 'the setpoints differ')

    def test_retracted_along_x_and_resumed_to_the_end(self):
        run = self.begin_stroke()
        for service, state in (('hold', GrinderState.HELD), ('retract', GrinderState.RETRACTED), ('resume', GrinderState.RUNNING)):
            self.assertTrue(getattr(grinder(), service)().success)
            grinder().wait_state(state)
        self.assertTrue(grinder().set_feed_override(1).success)
        run.wait_complete()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertTrue(checks.is_gapless(run.setpoints))
        self.check_way(s.position for s in run.setpoints)
        left = next(i for i, s in enumerate(run.setpoints) if s.move == LIFT and run.setpoints[i - 1].move == STROKE)
        self.assertEqual({(s.position[Z], s.position[A]) for s in run.setpoints[left:] if s.move == LIFT},
                         {(run.setpoints[left - 1].position[Z], run.setpoints[left - 1].position[A])})
        first, again = (next(s for s in setpoints if s.move == STROKE) for setpoints in (run.setpoints, run.setpoints[left:]))
        self.assertEqual((again.tooth, again.position), (first.tooth, first.position))

    def test_lifted_along_x_after_a_fault(self):
        run = self.begin_stroke()
        grinder().inject('drive_fault')
        grinder().wait_state(GrinderState.FAULT)
        self.assertEqual(run.wait().status, 'ABORTED')
        with open(rospy.get_param('/grinder/journal')) as file:
            journal = yaml.safe_load(file)
        self.assertAlmostEqual(journal['clear_x_m'], self.start, delta=NEAR)
        self.assertAlmostEqual(journal['back_m'], self.end - self.start, delta=NEAR)
        seen = len(grinder().joints)
        x, y, _, _ = grinder().make_ready()
        self.check_way(gc.axes_of(joint) for joint in grinder().joints[seen:])
        self.assertAlmostEqual(x, self.start, delta=NEAR)
        self.assertAlmostEqual(y, CLEARANCE, delta=NEAR)
