"""Shows that tf knows where wheel, cutter and contact are: while a stroke runs, the wheel is found in the cutter's frame where
the setpoint has it, with swivel, height and work offsets; that the frames of the set-up are latched and follow its changes;
and that the joint states are those of the four axes alone."""

import functools
import math
import unittest

import numpy
import rospy
import tf2_ros
from tf2_msgs.msg import TFMessage

import grinder_client as gc
import path_checks as checks
from grinder_client import A, DEG, MM, MM_MIN, STROKE, UM, X, Y, Z, grinder

OFFSETS = [-0.0213, 0.0237, -0.0119, 1.25]
SWIVEL, HEIGHT, X_SHIFT = 20 * DEG, 3 * MM, -15 * MM
TEETH = [0.0, 100 * DEG]
# Its stroke takes some seconds.
JOB = gc.paper(end_diameter=12 * MM, feed=100 * MM_MIN, flute_length=3 * MM, clearance=1 * MM, tooth_angles=TEETH,
               setup_swivel=SWIVEL, setup_height=HEIGHT, setup_x_shift=X_SHIFT)
HELIX = checks.Helix(JOB)
# Of a cutter of 12 mm and a wheel of 100 mm.
BETWEEN_AXES = 56 * MM
# Positions are reported to the bit; what is left is rounding.
EXACT = 1e-9
# Farther from the cutter's axis are neither wheel nor contact.
REACH = 2 * BETWEEN_AXES


class Frames:
    """What tf knows from now on, and what was latched."""

    def __init__(self):
        self.buffer = tf2_ros.Buffer(rospy.Duration(gc.PATIENCE))
        self._listener = tf2_ros.TransformListener(self.buffer)

    def find(self, frame, within, stamp=rospy.Time()):
        """Origin and rotation matrix of a frame in another, at a time or at the latest."""
        # The buffer itself would look as seldom as a hundred times until the time is out.
        gc.poll(lambda: self.buffer.can_transform(within, frame, stamp), '%s in %s' % (frame, within))
        found = self.buffer.lookup_transform(within, frame, stamp).transform
        at, turned = found.translation, found.rotation
        return numpy.array([at.x, at.y, at.z]), rotation(turned.x, turned.y, turned.z, turned.w)


def rotation(x, y, z, w):
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def about_x(angle):
    c, s = math.cos(angle), math.sin(angle)
    return numpy.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def wheel_in_work(at):
    """Centre and axis of the wheel in work coordinates."""
    return (numpy.array([at[X], BETWEEN_AXES + at[Y], HEIGHT + at[Z]]),
            numpy.array([-math.sin(SWIVEL), 0, math.cos(SWIVEL)]))


class Story:
    """A job with what tf says of it."""

    def __init__(self):
        g = grinder()
        self.frames = Frames()
        self.before = {frame: self.frames.find(frame, within) for frame, within in (('wheel', 'cutter'), ('cutter', 'work'))}
        self.position_before = g.positions()
        # All that is reported of one time is here once the wheel is.
        self.contact_before = self.frames.buffer.can_transform('work', 'contact', rospy.Time())
        g.make_ready()
        for axis, offset in enumerate(OFFSETS):
            answer = g.set_offset(axis, offset)
            assert answer.success, answer.message
        self.of_axes = []
        subscriber = rospy.Subscriber('/tf', TFMessage, self.of_axes.append, queue_size=10000)
        self.run = g.run(JOB)
        self.seen = [self.look(batch) for batch in self.run.batches if self.in_stroke(batch.setpoints[-1])]
        subscriber.unregister()
        self.known = {t.header.stamp for message in self.of_axes for t in message.transforms if t.child_frame_id == 'table'}
        self.axes = {joint.header.stamp: numpy.array(gc.axes_of(joint)) for joint in grinder().joints}
        self.late = Frames()

    def interpolated(self, stamp):
        """How far the axes were at a time from where tf has them, which interpolates between the stamps it knows."""
        before, after = max(s for s in self.known if s <= stamp), min(s for s in self.known if s >= stamp)
        axes = self.axes
        share = 0 if before == after else (stamp - before) / (after - before)
        return abs(axes[stamp] - (1 - share) * axes[before] - share * axes[after])

    @staticmethod
    def in_stroke(setpoint):
        return (setpoint.tooth, setpoint.move) == (1, STROKE)

    def look(self, batch):
        """What tf has of the last setpoint of a batch, which was written with a joint state of the same stamp."""
        found = {(frame, within): self.frames.find(frame, within, batch.end_stamp)
                 for frame, within in (('wheel', 'cutter'), ('wheel', 'work'), ('contact', 'work'))}
        return dict(found, setpoint=batch.setpoints[-1], stamp=batch.end_stamp)


@functools.lru_cache(maxsize=None)
def story():
    return Story()


class TestStroke(unittest.TestCase):
    def check(self, found, expected, delta):
        self.assertLess(abs(found - numpy.array(expected)).max(), delta)

    def test_wheel_contact_and_cutter_are_where_the_axes_and_the_setpoint_are(self):
        self.assertEqual(story().run.status, 'SUCCEEDED', story().run.text)
        strokes = story().seen
        self.assertGreater(len(strokes), 5)
        ends = [seen['setpoint'].position[X] for seen in (strokes[0], strokes[-1])]
        self.assertGreater(abs(ends[1] - ends[0]), 1 * MM, 'it moves along the cutter')
        self.assertLessEqual({seen['stamp'] for seen in strokes}, {joint.header.stamp for joint in grinder().joints})
        tolerance = [rospy.get_param('/grinder/constraints/%s/trajectory' % joint) for joint in gc.JOINTS]
        touching = 0
        for seen in strokes:
            off = story().interpolated(seen['stamp'])
            # The tolerance for directions and that for lengths.
            turn = off[A] + EXACT
            delta = sum(off[:3]) + REACH * turn
            actual, setpoint = seen['setpoint'].actual, seen['setpoint'].position
            centre, axis = wheel_in_work(actual)
            at, turned = seen['wheel', 'work']
            self.check(at, centre, delta)
            self.check(turned[:, 2], axis, turn)

            at, turned = seen['wheel', 'cutter']
            # A point of the cutter at the angle phi is in the machine at phi - A.
            to_cutter = about_x(actual[A])
            self.check(at, to_cutter @ centre, delta)
            self.check(turned[:, 2], to_cutter @ axis, turn)
            self.check(turned[:, 1], to_cutter @ [0, 1, 0], turn)
            # The axes follow the setpoint as closely as the machine asks.
            asked, asked_axis = wheel_in_work(setpoint)
            self.check(at, about_x(setpoint[A]) @ asked, sum(tolerance[:3]) + tolerance[A] * numpy.linalg.norm(asked))
            self.check(turned[:, 2], about_x(setpoint[A]) @ asked_axis, tolerance[A])

            # The wheel touches the cutter's surface there.
            at, turned = seen['contact', 'work']
            self.assertAlmostEqual(math.hypot(at[1], at[2]), HELIX.radius(at[0]), delta=delta)
            beside = abs((at - centre) @ axis) - JOB['process.wheel_width'] / 2
            beyond = numpy.linalg.norm(numpy.cross(at - centre, axis)) - JOB['process.wheel_diameter'] / 2
            # Beyond the ends of the cutter the wheel touches no edge.
            if 1 * UM < at[0] < JOB['cutter.flute_length'] - 1 * UM:
                self.assertAlmostEqual(max(beside, beyond), 0, delta=5 * UM + delta)
                touching += 1
            around = about_x(math.atan2(at[2], at[1]))
            for column, direction in ((0, [1, HELIX.tan_cone, HELIX.tan_spiral]), (1, [-HELIX.tan_cone, 1, 0])):
                direction = around @ direction
                self.check(turned[:, column], direction / numpy.linalg.norm(direction), turn + 1e-9)
        self.assertGreater(touching, 2)


class TestSetUp(unittest.TestCase):
    def check_frame(self, frames, frame, within, at, turned):
        found = frames.find(frame, within)
        self.assertLess(abs(found[0] - numpy.array(at)).max(), EXACT, frame)
        self.assertLess(abs(found[1] - turned).max(), EXACT, frame)

    def test_ahead_of_a_job_and_for_a_late_listener_and_after_a_change(self):
        self.addCleanup(lambda: [grinder().set_offset(axis, 0) for axis in range(4)])  # other tests may follow
        # Ahead of a job they are those of a plain one.
        at = story().position_before
        centre, turned = story().before['wheel']
        self.assertLess(abs(centre - about_x(at[A]) @ [at[X], 0.055 + at[Y], at[Z]]).max(), EXACT)
        self.assertLess(abs(turned - about_x(at[A])).max(), EXACT)
        self.assertFalse(story().contact_before)

        swivel = numpy.array([[math.cos(SWIVEL), 0, -math.sin(SWIVEL)], [0, 1, 0], [math.sin(SWIVEL), 0, math.cos(SWIVEL)]])
        unturned = numpy.identity(3)
        late = story().late
        self.check_frame(late, 'work', 'table', [OFFSETS[X], 0, 0], unturned)
        self.check_frame(late, 'cutter', 'chuck', [OFFSETS[X], 0, 0], about_x(OFFSETS[A]))
        self.check_frame(late, 'y_datum', 'base', [0, BETWEEN_AXES - OFFSETS[Y], 0], unturned)
        self.check_frame(late, 'z_datum', 'column', [0, 0, HEIGHT - OFFSETS[Z]], unturned)
        self.check_frame(late, 'wheel', 'wheel_head', [0, 0, 0], swivel)

        self.assertTrue(grinder().set_offset(X, -0.03).success)
        for frame, within in (('work', 'table'), ('cutter', 'chuck')):
            gc.poll(lambda: abs(late.find(frame, within)[0][0] + 0.03) < EXACT, 'the new place of ' + frame)

    def test_joint_states_are_those_of_the_axes_alone(self):
        story()
        for joint in grinder().joints:
            self.assertEqual(joint.name, gc.JOINTS)
            self.assertEqual((len(joint.position), len(joint.velocity)), (4, 4))
