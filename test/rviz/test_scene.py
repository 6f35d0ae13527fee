#!/usr/bin/env python3
"""Shows what rviz shows: the machine, the job's cutter and wheel where the axes have them, its flutes as they are planned,
ground and measured, the executed path, and where the view looks. By the markers and frames, in figures, and by pictures of rviz's
window ahead of a job, in its midst and after it, which are kept in build/screenshots."""

import functools
import io
import math
import os
import sys
import threading
import time
import unittest

import numpy
import rospy
import rostest
from flute_grinder.msg import Legend
from PIL import ImageGrab
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'node'))

import grinder_client as gc  # noqa: E402
import path_checks as checks  # noqa: E402
from grinder_client import A, DEG, MM, MM_MIN, STROKE, X, grinder  # noqa: E402

# Unequal teeth in two passes, over soon, with all that moves the wheel: cone, rake, wear.
TEETH = [0, 88 * DEG, 180 * DEG, 268 * DEG]
JOB = gc.paper(end_diameter=12 * MM, spiral_angle=38 * DEG, flute_length=26 * MM, tooth_angles=TEETH, feed=3000 * MM_MIN,
               infeed=0.3 * MM, wheel_width=4 * MM, shank_diameter=17 * MM, rake_tolerance=5 * DEG,
               setup_swivel=38 * DEG, setup_height=0,
               wheel_wear=0.02 * MM, wheel_wear_per_pass=0.001 * MM, even_step=1)
HELIX = checks.Helix(JOB)
DEPTHS = [0.3 * MM, 0.5 * MM]
FIELD_OF_VIEW = 0.7853981  # [rad]
HELD = 2  # the tooth in whose last pass the job is held
PICTURES = os.environ['SCREENSHOTS']
TOPICS = ['scene', 'ground_cutter', 'tool_path', 'executed_path', 'path_error']

class Rviz:
    """What rviz has got, and what it shows."""

    def __init__(self):
        self._lock = threading.Lock()
        self.messages = {topic: [] for topic in TOPICS}
        self.frames = {}
        self._subscribers = [rospy.Subscriber('/grinder/' + topic, MarkerArray, self.messages[topic].append)
                             for topic in TOPICS]
        self._subscribers += [rospy.Subscriber(topic, TFMessage, self._on_frames) for topic in ('/tf', '/tf_static')]
        self.legends = []
        self._subscribers.append(rospy.Subscriber('/grinder/legend', Legend, self.legends.append))
        rospy.wait_for_service('/rviz/report', gc.PATIENCE)
        self._report = rospy.ServiceProxy('/rviz/report', Trigger, persistent=True)
        self._look = rospy.ServiceProxy('/rviz/look', Trigger)

    def _on_frames(self, message):
        for transform in message.transforms:
            self.frames[transform.child_frame_id] = (transform.header.frame_id, matrix(transform.transform))

    def report(self):
        """What rviz says of itself: frames drawn, rectangles, its camera, and the displays' statuses that are not OK."""
        lines = self._report().message.splitlines()
        words = [line.split() for line in lines]
        report = {w[0]: [int(n) for n in w[1:]] for w in words if w[0] in ('screen', 'window', 'least', 'view')}
        report['title'] = next(line for line in lines if line.startswith('title '))[len('title '):]
        report['docks'] = [line[len('dock '):] for line in lines if line.startswith('dock ')]
        camera = next(w for w in words if w[0] == 'camera')
        report['camera'] = [round(float(word), 6) for word in camera[1:7]]
        report['target'] = camera[7]
        report['frames'] = int(words[0][1])
        statuses = [line for line in lines if line.startswith('status ')]
        report['statuses'] = len(statuses)
        report['not OK'] = [line for line in statuses if not line.startswith('status 0 ')]
        return report

    def look(self, frame, yaw, pitch, distance, *focal):
        """As an operator who turns the view."""
        rospy.set_param('/rviz/camera', [frame, *map(float, (yaw, pitch, distance, *focal))])
        assert self._look().success
        self.settle()

    def count_frames(self, seconds):
        """Frames drawn, and within which time."""
        frames, begin = self.report()['frames'], time.monotonic()
        rospy.sleep(seconds)
        return self.report()['frames'] - frames, time.monotonic() - begin

    def settle(self):
        """Waits until what was sent is shown: rviz takes messages before each frame."""
        frames = self.report()['frames']
        gc.poll(lambda: self.report()['frames'] >= frames + 10, 'frames of rviz')

    def picture(self, name, shows=lambda picture: True):
        """Takes a picture as soon as it shows what is wanted, and keeps it as a file."""
        self.settle()
        taken = Picture(name)
        try:
            gc.poll(lambda: taken.take() or shows(taken), 'a picture "%s" of what is wanted' % name)
        finally:
            taken.save()
        taken.report = self.report()
        return taken

    def last(self, topic):
        return list(self.messages[topic][-1].markers)

    def in_frame(self, frame):
        """The transform from a frame to `base`."""
        whole = numpy.identity(4)
        while frame != 'base':
            frame, step = self.frames[frame]
            whole = step @ whole
        return whole


class Picture:
    """rviz's window."""

    def __init__(self, name):
        self.name = name
        self.image = self.pixels = None

    def take(self):
        self.image = ImageGrab.grab(xdisplay=os.environ['DISPLAY'])
        self.pixels = numpy.asarray(self.image.convert('RGB')).astype(int)

    def save(self):
        os.makedirs(PICTURES, exist_ok=True)
        self.image.save(os.path.join(PICTURES, self.name + '.png'), optimize=True)

    def share(self, places, looks):
        """At which share of some places (column, row) something looks so, or next to them."""
        found = 0
        for i, (column, row) in enumerate(numpy.rint(places).astype(int)):
            near = self.pixels[row - 2:row + 3, column - 2:column + 3].reshape(-1, 3)
            found += any(looks(i, *pixel) for pixel in near)
        return found / len(places)


class Camera:
    """Where a point of the frame `work` is seen in the window."""

    def __init__(self, report):
        assert report['target'] == 'work'
        yaw, pitch, distance, *focal = report['camera']
        self.toward = numpy.array([math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), math.sin(pitch)])
        self.right = numpy.array([-math.sin(yaw), math.cos(yaw), 0])
        self.up = numpy.cross(self.toward, self.right)
        self.at = numpy.array(focal) + distance * self.toward
        left, top, width, height = report['view']
        self.centre = numpy.array([left + width / 2, top + height / 2])
        self.scale = height / 2 / math.tan(FIELD_OF_VIEW / 2)

    def see(self, points):
        """Columns and rows of points."""
        way = points - self.at
        depth = -way @ self.toward
        return self.centre + self.scale * numpy.stack([way @ self.right, -(way @ self.up)], axis=1) / depth[:, None]


# What a pixel may look like.
def light_grey(_, r, g, b):
    return min(r, g, b) > 120 and max(r, g, b) - min(r, g, b) < 40


def magenta(_, r, g, b):
    return r > g + 50 and b > g + 50


def matrix(transform):
    """Of a Transform, or of a Pose."""
    t = getattr(transform, 'translation', None) or transform.position
    q = getattr(transform, 'rotation', None) or transform.orientation
    x, y, z, w = q.x, q.y, q.z, q.w
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), t.x],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), t.y],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), t.z],
                        [0, 0, 0, 1]])


def points_of(marker):
    """In the marker's frame, one row each."""
    points = numpy.array([(p.x, p.y, p.z, 1) for p in marker.points])
    return (matrix(marker.pose) @ points.T).T[:, :3]


def of_namespace(markers, ns):
    return [m for m in markers if m.action == Marker.ADD and m.ns == ns]


def colours(marker):
    """Those of its points; of the whole marker if it has one."""
    return {(round(c.r, 3), round(c.g, 3), round(c.b, 3)) for c in marker.colors or [marker.color]}


def flutes(markers):
    """What each flute looks like: planned, active or measured."""
    looks = []
    for marker in of_namespace(markers, 'tool_path'):
        if marker.colors:
            looks.append('measured')
        else:
            looks.append({(0.72, 0.72, 0.72): 'planned', (1.0, 0.2, 0.9): 'active'}[colours(marker).pop()])
    return looks


def measured(setpoints):
    """The error of every setpoint of a stroke: X, and the distance from the helix on the cutter's surface."""
    return [(s.actual[X], abs(TEETH[s.tooth] + HELIX.a(s.actual[X]) - s.actual[A])
             * HELIX.radius(s.actual[X]) * HELIX.normal) for s in setpoints if s.move == STROKE and s.step]


class Story:
    """A job from before its plan to after its end, with what was published and what it showed."""

    def __init__(self):
        self.rviz, g = Rviz(), grinder()
        g.make_ready_at_park()
        gc.poll(lambda: of_namespace(self.rviz.last('scene'), 'blank'), 'the blank')
        self.before_plan = {topic: {marker.ns for message in messages for marker in message.markers
                                    if marker.action != Marker.DELETEALL}
                            for topic, messages in self.rviz.messages.items()}
        self.machine = self.rviz.picture('machine')
        self.at_rest = self.rviz.count_frames(5)
        self.take_other_views(g)
        self.planned = {}
        for path in ('left_hand_d8_t3', 'micro_d05_t2', 'finishing_d20_t8', 'roughing_d10_t4', 'unequal_d12_t4'):
            job = gc.job_from_file(gc.package_file('jobs/%s.yaml' % path))
            self.plan(g, job)
            self.planned[path] = self.rviz.picture('planned_' + path)
            self.planned[path].job = job
        self.plan_and_hold(g)
        g.resume()
        self.run.wait_complete()
        g.fresh_state()
        self.after = self.snapshot('after')
        self.cancel_and_continue(g)

    def plan(self, g, job):
        """Plans a job, and waits until it is shown."""
        legends = len(self.rviz.legends)
        assert g.send(job, dry_run=True).wait().status == 'SUCCEEDED'
        gc.poll(lambda: len(self.rviz.legends) > legends, 'the legend')
        self.rviz.settle()

    def take_other_views(self, g):
        """The views of an operator, and what comes of them."""
        self.rviz.look('base', 3.5, 0.5, 2, 0.05, 0.2, -0.3)
        self.machine_view = self.rviz.report()['camera']
        self.plan(g, JOB)
        self.machine_view_with_a_job = self.rviz.report()['camera']
        self.rviz.look('work', 3.5, 0.5, 0.05, 0.002, 0.001, 0)
        self.turned = self.rviz.report()['camera']
        self.plan(g, dict(JOB, **{'process.feed': 2000 * MM_MIN}))
        self.same_tool = self.rviz.report()['camera']
        self.plan(g, gc.PAPER)
        self.other_tool = self.rviz.report()['camera']
        self.rviz.look('work', *self.machine.report['camera'])

    def snapshot(self, name):
        """The picture with the markers, frames and positions that belong to it."""
        # It takes a moment longer than the others.
        ns = 'planned' if name == 'before' else 'ground'
        gc.poll(lambda: of_namespace(self.rviz.last('ground_cutter'), ns), 'the cutter')
        picture = self.rviz.picture(name)
        picture.job = JOB
        picture.legend = self.rviz.legends[-1]
        picture.markers = {topic: self.rviz.last(topic) for topic in TOPICS}
        picture.to_base = {frame: self.rviz.in_frame(frame) for frame in ('cutter', 'wheel', 'work')}
        picture.positions = grinder().positions()
        return picture

    def plan_and_hold(self, g):
        self.plan(g, JOB)
        self.before = self.snapshot('before')
        self.run = g.send(JOB)
        self.run.wait_past(lambda s: (s.tooth, s.pass_, s.move) == (HELD, 1, STROKE) and s.position[X] > 3 * MM,
                           'the third tooth')
        assert g.hold().success
        g.wait_for(lambda: g.states[-1].state_name == 'held', 'held')
        g.wait_rest()
        largest = max(error for _, error in measured(self.run.setpoints))
        gc.poll(lambda: self.rviz.legends[-1].max_error > 0.99 * largest, 'the legend of what is measured')
        self.during = self.snapshot('during')
        self.setpoints_when_held = self.run.setpoints
        scenes = len(self.rviz.messages['scene'])
        assert g.plan(gc.goal_of(gc.PAPER)).valid
        g.fresh_state()
        self.scenes_by_plan = len(self.rviz.messages['scene']) - scenes

    def cancel_and_continue(self, g):
        run = g.send(JOB)
        run.wait_past(lambda s: (s.tooth, s.pass_, s.move) == (1, 0, STROKE), 'the second tooth')
        # So that the third tooth lasts longer than a host stalls.
        assert g.set_feed_override(0.2).success
        run.wait_past(lambda s: (s.tooth, s.pass_, s.move) == (2, 0, STROKE), 'the third tooth')
        run.cancel()
        run.wait_complete()
        assert g.set_feed_override(1).success
        g.fresh_state()
        self.canceled = self.rviz.last('tool_path')
        assert g.send(JOB, first_tooth=2, dry_run=True).wait().status == 'SUCCEEDED'
        g.fresh_state()
        self.to_continue = self.rviz.last('tool_path')
        assert g.run(JOB, first_tooth=2).status == 'SUCCEEDED'
        g.fresh_state()
        self.continued = self.rviz.last('tool_path')
        assert g.send(JOB, dry_run=True).wait().status == 'SUCCEEDED'
        g.fresh_state()
        self.planned_again = self.rviz.last('tool_path')


@functools.lru_cache(maxsize=None)
def story():
    """The one story, for all tests; what went wrong with it is reported once more to each."""
    try:
        return Story()
    except Exception as error:
        return Failure(error)


class Failure:
    """A story that could not be told to its end."""

    def __init__(self, error):
        self._error = error

    def __getattr__(self, name):
        raise self._error


class TestFrames(unittest.TestCase):
    """Where things are, in figures, while the job is held in the midst of a stroke."""

    @classmethod
    def setUpClass(cls):
        cls.held = story().during
        cls.at = cls.held.positions
        cls.markers = cls.held.markers
        cls.wheel = of_namespace(cls.markers['scene'], 'wheel')
        rim = numpy.vstack([points_of(m) for m in cls.wheel])
        cls.wheel_radius = numpy.hypot(rim[:, 0], rim[:, 1]).max()
        cls.half_width = abs(rim[:, 2]).max()

    def in_wheel(self, points):
        """Points of the frame `cutter` in that of the wheel, whose Z is its axis."""
        to_wheel = numpy.linalg.inv(self.held.to_base['wheel']) @ self.held.to_base['cutter']
        return (to_wheel @ numpy.atleast_2d(points).T).T

    def test_held_in_the_stroke(self):
        self.assertTrue(3 * MM < self.at[X] < 20 * MM)

    def test_cutter_moves_with_x_and_turns_with_a(self):
        turned = self.held.to_base['cutter']
        c, s = math.cos(self.at[A]), math.sin(self.at[A])
        expected = [[1, 0, 0, -self.at[X]], [0, c, s, 0], [0, -s, c, 0], [0, 0, 0, 1]]
        self.assertLess(abs(turned - numpy.array(expected)).max(), 1e-6)

    def points_of_cutter(self, moment, ns):
        markers = of_namespace(moment.markers['ground_cutter'], ns)
        self.assertEqual({m.header.frame_id for m in markers}, {'cutter'})
        points = numpy.vstack([points_of(m) for m in markers])
        return points[:, 0], numpy.hypot(points[:, 1], points[:, 2])

    def test_cutter_has_the_true_size(self):
        for moment, ns in ((story().before, 'planned'), (self.held, 'ground'), (story().after, 'ground')):
            x, radii = self.points_of_cutter(moment, ns)
            self.assertEqual((x.min(), x.max()), (0, 66 * MM))
            on_cone = x < 27 * MM
            outer = HELIX.radius(x[on_cone])
            self.assertLess((radii[on_cone] - outer).max(), 1e-9)
            self.assertLess((outer - radii[on_cone]).min(), 1e-9)
            self.assertAlmostEqual(radii[~on_cone].max(), JOB['cutter.shank_diameter'] / 2, delta=1e-9)

    def test_cutter_is_ground_to_the_depth_of_the_passes_that_are_done(self):
        for moment, ns in ((story().before, 'planned'), (story().after, 'ground')):
            x, radii = self.points_of_cutter(moment, ns)
            within = (x > 5 * MM) & (x < 20 * MM) & (radii > 2 * MM)
            deepest = (HELIX.radius(x[within]) - radii[within]).max()
            self.assertGreater(deepest, 0.8 * DEPTHS[1])

    def test_wheel_has_the_true_size(self):
        self.assertEqual({m.header.frame_id for m in self.wheel}, {'wheel'})
        self.assertAlmostEqual(self.wheel_radius, 50 * MM - 0.02 * MM, delta=1e-9)
        self.assertAlmostEqual(self.half_width, JOB['process.wheel_width'] / 2, delta=1e-9)
        # Two faces, a straight rim and the hub's two faces: each point costs time in every frame.
        self.assertLess(sum(len(m.points) for m in self.wheel), 5000)

    def test_wheel_is_swivelled_along_the_helix(self):
        a = TEETH[HELD] + HELIX.a(self.at[X])
        tangent = numpy.array([1, HELIX.tan_cone * math.cos(a) - HELIX.tan_spiral * math.sin(a),
                               HELIX.tan_cone * math.sin(a) + HELIX.tan_spiral * math.cos(a), 0])
        direction = self.in_wheel(tangent / numpy.linalg.norm(tangent))[0]
        self.assertAlmostEqual(direction[2], 0, delta=1e-4)
        self.assertGreater(direction[0], 0.99)


class TestFlutes(unittest.TestCase):
    """How the flutes look in the course of the job."""

    def test_planned_ahead_of_the_job(self):
        self.assertEqual(flutes(story().before.markers['tool_path']), ['planned'] * 4)

    def test_finished_active_and_planned_within_it(self):
        self.assertEqual(flutes(story().during.markers['tool_path']), ['measured', 'measured', 'active', 'planned'])

    def test_all_finished_after_it(self):
        self.assertEqual(flutes(story().after.markers['tool_path']), ['measured'] * 4)

    def test_canceled_job_keeps_what_was_finished(self):
        self.assertEqual(flutes(story().canceled), ['measured', 'measured', 'planned', 'planned'])

    def test_continued_job_keeps_it_too(self):
        self.assertEqual(flutes(story().to_continue), ['measured', 'measured', 'planned', 'planned'])
        self.assertEqual(flutes(story().continued), ['measured'] * 4)
        first, again = [of_namespace(markers, 'tool_path')[0] for markers in (story().canceled, story().to_continue)]
        self.assertEqual(first.colors, again.colors)

    def test_job_planned_from_its_begin_is_all_planned(self):
        self.assertEqual(flutes(story().planned_again), ['planned'] * 4)

    def test_plan_of_another_job_does_not_change_what_is_shown_of_the_running_one(self):
        self.assertEqual(story().scenes_by_plan, 0)

    def max_of(self, setpoints, tooth):
        """The maximum error of a tooth's last pass, and where it was."""
        return max((error, x) for x, error in measured([s for s in setpoints if (s.tooth, s.pass_) == (tooth, 1)]))

    def test_colours_are_those_of_the_measured_errors(self):
        markers = story().after.markers['tool_path']
        largest = [self.max_of(story().run.setpoints, tooth) for tooth in range(4)]
        end = story().after.legend.tolerance
        for marker, (error, x) in zip(of_namespace(markers, 'tool_path'), largest):
            self.assertEqual(len(marker.colors), len(marker.points))
            colour = marker.colors[abs(points_of(marker)[:, 0] - x).argmin()]
            # Blue, green, yellow, red at the tolerance and beyond.
            fraction = min(error / end, 1)
            self.assertAlmostEqual(colour.r, max(0.1, min(4 * fraction - 1.5, 1)), delta=0.01)
            self.assertAlmostEqual(colour.g, max(0.1, min(1.6 - abs(4 * fraction - 2), 1)), delta=0.01)

    def test_legend_reports_the_cutter_and_where_the_colours_end(self):
        for legend in (story().before.legend, story().during.legend, story().after.legend):
            self.assertEqual(legend.cutter, gc.goal_of(JOB).cutter)
            self.assertEqual(legend.tolerance, JOB['interpolation.tolerance'])

    def test_legend_reports_the_max_error(self):
        self.assertEqual(story().before.legend.max_error, 0)
        for moment, setpoints in ((story().during, story().setpoints_when_held), (story().after, story().run.setpoints)):
            largest = max(error for _, error in measured(setpoints))
            self.assertAlmostEqual(moment.legend.max_error, largest, delta=0.01 * largest)


class TestPictures(unittest.TestCase):
    """What is to be seen in rviz's window, and that nothing is amiss with it."""

    def all_pictures(self):
        return [story().machine, *story().planned.values(), story().before, story().during, story().after]

    def test_no_display_has_anything_to_complain_of(self):
        for picture in self.all_pictures():
            self.assertGreater(picture.report['statuses'], 10)
            self.assertEqual(picture.report['not OK'], [], picture.name)

    def test_window_fits_the_screen(self):
        for picture in self.all_pictures():
            left, top, width, height = picture.report['window']
            self.assertEqual(picture.report['screen'], [0, 0, 1280, 800])
            self.assertEqual(picture.image.size, (1280, 800))
            self.assertTrue(left >= 0 and top >= 0 and left + width <= 1280 and top + height <= 800)
            # With room for the title of a window, and a task bar.
            _, _, min_width, min_height = picture.report['least']
            self.assertTrue(min_width <= 800 and min_height <= 760, picture.report['least'])

    def test_nothing_is_shown_of_a_job_before_a_plan(self):
        self.assertEqual(story().before_plan, dict(dict.fromkeys(TOPICS, set()), scene={'wheel', 'blank'}))
        self.assertEqual(story().rviz.legends[0], Legend())

    def test_the_blank_is_seen_before_a_plan(self):
        camera = Camera(story().machine.report)
        up = camera.toward[1:] / numpy.linalg.norm(camera.toward[1:])
        places = camera.see(numpy.array([(x * MM, *(5 * MM * up)) for x in range(2, 31)]))
        self.assertGreater(story().machine.share(places, light_grey), 0.9)

    def seen(self, moment, points, front_only=True):
        """Columns and rows of points of the frame `cutter`, and which of them are meant: those on the near side."""
        camera = Camera(moment.report)
        to_work = numpy.linalg.inv(moment.to_base['work']) @ moment.to_base['cutter']
        points = (to_work @ numpy.column_stack([points, numpy.ones(len(points))]).T).T[:, :3]
        near = (points[:, 1:] @ camera.toward[1:] > 2 * MM) & (points[:, 0] < 26 * MM) & (points[:, 0] > 0)
        chosen = numpy.nonzero(near | (not front_only))[0]
        return camera.see(points[chosen]), chosen

    def share_of_flutes(self, moment, teeth, looks):
        markers = of_namespace(moment.markers['tool_path'], 'tool_path')
        places = numpy.vstack([self.seen(moment, points_of(markers[tooth]))[0] for tooth in teeth])
        self.assertGreater(len(places), 30)
        return moment.share(places, looks)

    def test_planned_flutes_are_seen_grey_on_the_cutter(self):
        self.assertGreater(self.share_of_flutes(story().before, range(4), light_grey), 0.9)
        self.assertLess(self.share_of_flutes(story().before, range(4), magenta), 0.05)

    def test_flute_being_ground_is_seen_bright(self):
        self.assertGreater(self.share_of_flutes(story().during, [HELD], magenta), 0.9)
        self.assertGreater(self.share_of_flutes(story().during, [3], light_grey), 0.9)
        self.assertLess(self.share_of_flutes(story().during, [3], magenta), 0.1)

    def test_finished_flutes_are_seen_in_the_colours_of_their_errors(self):
        seen = 0
        for marker in of_namespace(story().after.markers['tool_path'], 'tool_path'):
            places, chosen = self.seen(story().after, points_of(marker))
            # One may be all on the far side.
            if len(places) == 0:
                continue
            colours = [255 * numpy.array([marker.colors[i].r, marker.colors[i].g, marker.colors[i].b]) for i in chosen]

            def like_its_colour(i, *pixel):
                return abs(colours[i] - pixel).max() < 90

            self.assertGreater(story().after.share(places, like_its_colour), 0.7)
            seen += len(places)
        self.assertGreater(seen, 100)

    def test_tool_is_in_the_view(self):
        for picture in self.all_pictures()[1:]:
            left, top, width, height = picture.report['view']
            length = picture.job['cutter.flute_length']
            radius = picture.job['cutter.end_diameter'] / 2 + length * math.tan(picture.job['cutter.cone_angle'])
            corners = [(x, side * radius, up * radius) for x in (0, length) for side in (-1, 1) for up in (-1, 1)]
            places = Camera(picture.report).see(numpy.array(corners))
            for column, row in places:
                self.assertTrue(left < column < left + width and top < row < top + height, picture.name)
            # Neither is it a needle.
            self.assertGreater(max(places[:, 0]) - min(places[:, 0]), width / 5, picture.name)

    def test_view_looks_at_the_side_where_the_wheel_cuts(self):
        camera = Camera(story().machine.report)
        # The wheel is at +Y of the work: seen from above, and from before the end face.
        self.assertGreater(camera.toward[2], 0.7)
        self.assertLess(camera.toward[0], 0)

    def test_view_of_the_operator_stays_until_another_tool_comes(self):
        self.assertEqual(story().turned, [3.5, 0.5, 0.05, 0.002, 0.001, 0.0])
        self.assertEqual(story().same_tool, story().turned)
        yaw, pitch, *rest = story().other_tool
        self.assertEqual([yaw, pitch], story().turned[:2])
        length = gc.PAPER['cutter.flute_length']
        for value, expected in zip(rest, [4 * length, length / 2, 0, 0]):
            self.assertAlmostEqual(value, expected, delta=1e-6)

    def test_view_of_the_machine_stays(self):
        self.assertEqual(story().machine_view, story().machine_view_with_a_job)

    def test_few_frames_are_drawn_while_nothing_moves(self):
        frames, seconds = story().at_rest
        self.assertLessEqual(frames, 11 * seconds)

    def test_window_is_named_after_the_grinder(self):
        self.assertEqual(story().machine.report['title'], '/grinder - grinder.rviz[*] - RViz')
        self.assertIn('Grinder /grinder', story().machine.report['docks'])

    def test_no_text_is_in_the_scene(self):
        for messages in story().rviz.messages.values():
            for message in messages:
                self.assertEqual([m.text for m in message.markers if m.type == Marker.TEXT_VIEW_FACING], [])

    def test_no_message_is_larger_than_3_mb(self):
        for messages in story().rviz.messages.values():
            for message in messages:
                buffer = io.BytesIO()
                message.serialize(buffer)
                self.assertLess(len(buffer.getvalue()), 3e6)

    def test_no_line_has_more_points_than_rviz_stands(self):
        for messages in story().rviz.messages.values():
            for message in messages:
                for marker in message.markers:
                    if marker.type != Marker.TRIANGLE_LIST:
                        self.assertLessEqual(len(marker.points), 16384)


if __name__ == '__main__':
    rospy.init_node('test_scene')
    rostest.rosrun('flute_grinder', 'scene', '__main__')
