#!/usr/bin/env python3
"""Shows that rviz with the shipped configuration has the machine, the job's flutes and the panel in its window, that the view looks
at the work, and that no display complains. What the markers are is shown in test/scene, where the frames are in
test/node/test_frames.py. The pictures are kept in build/screenshots."""

import os
import sys
import time
import unittest

import numpy
import rospy
import rostest
from flute_grinder.msg import Legend
from PIL import ImageGrab
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'node'))

import grinder_client as gc  # noqa: E402
from grinder_client import DEG, MM, MM_MIN, STROKE, X, grinder  # noqa: E402

JOB = gc.paper(end_diameter=12 * MM, spiral_angle=38 * DEG, flute_length=26 * MM, tooth_angles=[i * 90 * DEG for i in range(4)],
               feed=3000 * MM_MIN, infeed=0.3 * MM, shank_diameter=17 * MM, setup_swivel=38 * DEG, setup_height=0,
               wheel_wear=0.02 * MM)
HELD = 2  # the tooth in whose first pass the job is held
TOPICS = ['scene', 'ground_cutter', 'tool_path', 'executed_path', 'path_error']
CAMERA = [4.2, 0.9, 0.36, 0.01, 0, 0]  # of rviz/grinder.rviz
# Colours that are to be seen in the view, and of the state in the panel.
WHEEL, GUARD, PLANNED, ACTIVE, MEASURED = (134, 91, 61), (52, 78, 100), (184, 184, 184), (255, 51, 230), (60, 76, 137)
READY_STATE, HELD_STATE = (30, 125, 52), (154, 91, 0)


class Rviz:
    """What rviz has got, and what it shows."""

    def __init__(self):
        self.messages = {topic: [] for topic in TOPICS}
        self.legends = []
        for topic in TOPICS:
            rospy.Subscriber('/grinder/' + topic, MarkerArray, self.messages[topic].append)
        rospy.Subscriber('/grinder/legend', Legend, self.legends.append)
        # One that dies as it starts does so before, and another is started.
        gc.poll(lambda: self.frames() > 10, 'the first frames of rviz', interval=0.1)
        self._report = rospy.ServiceProxy('/rviz/report', Trigger, persistent=True)
        self._look = rospy.ServiceProxy('/rviz/look', Trigger)
        self._operate = rospy.ServiceProxy('/rviz/operate', Trigger)

    @staticmethod
    def frames():
        """How many frames the rviz of now has drawn: 0 while it starts or ends."""
        try:
            said = rospy.ServiceProxy('/rviz/report', Trigger)()
        except rospy.ServiceException:
            return 0
        return int(said.message.split()[1]) if said.success else 0

    def report(self, key):
        """What follows a key in the lines that rviz reports on itself."""
        return [line[len(key) + 1:] for line in self._report().message.splitlines() if line.startswith(key + ' ')]

    def numbers(self, key):
        return [int(number) for number in self.report(key)[0].split()]

    def camera(self):
        """Yaw, pitch, distance and the focal point's X, Y, Z."""
        return [round(float(word), 6) for word in self.report('camera')[0].split()[:6]]

    def look(self, frame, camera):
        """As an operator who turns the view."""
        rospy.set_param('/rviz/camera', [frame, *map(float, camera)])
        assert self._look().success

    def operate(self, operation, ends=False):
        """As an operator's hand: "key Ctrl+Q", "click hold", "tab Jog" or "menu &Quit". `ends`: rviz, by that."""
        rospy.set_param('/rviz/operation', operation)
        assert self._operate().success
        if not ends:
            self.wait_frames(2)

    def buttons(self):
        """Those that are seen as a whole, by name: whether enabled, x, y, width, height."""
        return {name: [int(number) for number in numbers] for name, *numbers in map(str.split, self.report('button'))}

    def wait_frames(self, number):
        """rviz takes messages before each frame. Returns how long the frames have taken [s]."""
        frames, begin = self.numbers('frames')[0], time.monotonic()
        gc.poll(lambda: self.numbers('frames')[0] >= frames + number, 'frames of rviz')
        return time.monotonic() - begin

    def plan(self, job, **fields):
        """Plans a job, waits until it is shown, and returns where the view looks."""
        legends = len(self.legends)
        assert grinder().send(job, dry_run=True, **fields).wait().status == 'SUCCEEDED'
        gc.poll(lambda: len(self.legends) > legends, 'the legend')
        grinder().fresh_state()
        self.wait_frames(10)
        return self.camera()

    def last(self, topic, ns):
        return [m for m in self.messages[topic][-1].markers if m.action == Marker.ADD and m.ns == ns]

    def flutes(self):
        """The colour of each, or those of its points."""
        return [m.colors or tuple(round(255 * c) for c in (m.color.r, m.color.g, m.color.b))
                for m in self.last('tool_path', 'tool_path')]

    def wait_flutes(self, expected, part=slice(None)):
        """Each topic has a connection of its own: another's message says nothing of when this one comes."""
        gc.poll(lambda: self.flutes()[part] == expected, 'the flutes %s' % expected)

    def take_picture(self, name, *colours):
        """Takes a picture whose view and panel show these colours, and keeps it as a file; gives the view's pixels."""
        left, top, width, height = self.numbers('view')

        def missing():
            nonlocal image, view
            image = ImageGrab.grab(xdisplay=os.environ['DISPLAY'])
            pixels = numpy.asarray(image.convert('RGB')).astype(int)
            view, panel = pixels[top:top + height, left:left + width], pixels[:, left + width:]
            return [c for c in colours if (abs((panel if c == colours[-1] else view) - c).max(axis=2) < 8).sum() < 100]

        image = view = None
        try:
            gc.poll(lambda: not missing(), 'a picture "%s" of what is wanted' % name)
        finally:
            os.makedirs(os.environ['SCREENSHOTS'], exist_ok=True)
            image.save(os.path.join(os.environ['SCREENSHOTS'], name + '.png'), optimize=True)
        return view


class TestScene(unittest.TestCase):
    """The cases go in the order of their names."""

    @classmethod
    def setUpClass(cls):
        cls.rviz = Rviz()
        grinder().make_ready_at_park()
        gc.poll(lambda: cls.rviz.last('scene', 'blank'), 'the blank')
        cls.before_plan = {topic: {m.ns for message in messages for m in message.markers if m.action == Marker.ADD}
                           for topic, messages in cls.rviz.messages.items()}

    def tearDown(self):
        self.assertGreater(len(self.rviz.report('status 0')), 10)
        self.assertEqual(self.rviz.report('status 1') + self.rviz.report('status 2'), [])

    def test_1_before_a_plan(self):
        self.assertEqual(self.before_plan, dict(dict.fromkeys(TOPICS, set()), scene={'wheel', 'blank'}))
        self.assertEqual(self.rviz.legends[0], Legend())
        view = self.rviz.take_picture('machine', WHEEL, GUARD, READY_STATE)
        # In the midst is the blank: it alone is round.
        row, column = (n // 2 for n in view.shape[:2])
        self.assertGreater(len(numpy.unique(view[row - 10:row + 10, column])), 10)
        self.assertEqual(self.rviz.camera(), CAMERA)
        # Without a graphics card each frame costs: at rest there are ten in a second, not thirty.
        gc.poll(lambda: self.rviz.wait_frames(22) > 2, 'the slow pace at rest')

    def test_2_view_of_the_operator_stays_until_another_tool_comes(self):
        turned = [3.5, 0.5, 0.05, 0.002, 0.001, 0]
        self.rviz.look('base', turned)
        self.assertEqual(self.rviz.plan(JOB), turned)
        self.rviz.look('work', turned)
        self.assertEqual(self.rviz.plan(dict(JOB, **{'process.feed': 2000 * MM_MIN})), turned)
        length = gc.PAPER['cutter.flute_length']
        self.assertEqual(self.rviz.plan(gc.PAPER), turned[:2] + [round(v, 6) for v in (4 * length, length / 2, 0, 0)])

    def test_3_job(self):
        g, rviz = grinder(), self.rviz
        rviz.look('work', CAMERA)
        rviz.plan(JOB)
        rviz.wait_flutes([PLANNED] * 4)
        rviz.take_picture('planned', GUARD, PLANNED, READY_STATE)
        run = g.send(JOB)
        # Slowly, so that the hold comes where most of the stroke is left, however long it takes.
        self.addCleanup(g.set_feed_override, 1)
        run.wait_past(lambda s: s.tooth == HELD, 'the third tooth')
        self.assertTrue(g.set_feed_override(0.05).success)
        run.wait_past(lambda s: s.move == STROKE and s.position[X] > 3 * MM, 'its stroke')
        self.assertTrue(g.hold().success)
        g.wait_for(lambda: g.states[-1].state_name == 'held', 'held')
        rviz.take_picture('held', WHEEL, GUARD, ACTIVE, MEASURED, HELD_STATE)
        gc.poll(lambda: rviz.legends[-1].max_error > 0, 'the legend of what is measured')
        rim = [p for m in rviz.last('scene', 'wheel') for p in m.points]
        self.assertAlmostEqual(max(numpy.hypot(p.y, p.z) for p in rim), 50 * MM - JOB['process.wheel_wear'], delta=1e-9)
        # A dry run of another job is refused, and does not change what is shown of this one.
        scenes = len(rviz.messages['scene'])
        self.assertFalse(g.plan(gc.goal_of(gc.PAPER)).plan.valid)
        g.fresh_state()
        self.assertEqual(len(rviz.messages['scene']), scenes)
        # A canceled job keeps what was ground, as long as it is continued.
        self.assertTrue(g.set_feed_override(1).success)
        run.cancel()
        run.wait_complete()
        rviz.wait_flutes([PLANNED, PLANNED], slice(HELD, None))
        canceled = rviz.flutes()
        self.assertGreater(min(map(len, canceled[:HELD])), 100)
        shown = len(rviz.messages['tool_path'])
        rviz.plan(JOB, first_tooth=HELD)
        gc.poll(lambda: len(rviz.messages['tool_path']) > shown, 'what is shown of the plan')
        self.assertEqual(rviz.flutes(), canceled)
        rviz.plan(JOB)
        rviz.wait_flutes([PLANNED] * 4)

    def test_4_reset_of_rviz_brings_wheel_and_tool_back(self):
        rviz = self.rviz
        rviz.plan(JOB)
        rviz.look('work', CAMERA)
        rviz.operate('tab View')
        gc.poll(lambda: rviz.buttons()['cut_open'][0], 'the cutter')
        rviz.operate('click reset_of_rviz')
        rviz.take_picture('after_reset', WHEEL, PLANNED, READY_STATE)
        gc.poll(lambda: rviz.buttons()['cut_open'][0], 'the cutter after the reset')

    def test_5_the_cutter_is_whole_until_it_is_cut_open(self):
        rviz = self.rviz
        grinder().make_ready_at_park()  # where the section faces the view
        rviz.plan(JOB)
        rviz.look('work', [4.2, 0.9, 0.08, 0.01, 0, 0])
        rviz.operate('tab View')
        gc.poll(lambda: rviz.buttons()['cut_open'][0], 'the cutter')

        def section():
            red, green, blue = numpy.moveaxis(rviz.take_picture('cut_open', PLANNED, READY_STATE), 2, 0)
            return ((red > 80) & (abs(red - green) < 22) & (red - blue > 25)).sum()

        self.assertEqual(section(), 0)
        rviz.operate('click cut_open')
        gc.poll(lambda: section() > 1000, 'the section')
        rviz.operate('click cut_open')
        gc.poll(lambda: section() == 0, 'the whole cutter')


if __name__ == '__main__':
    rospy.init_node('test_scene')
    rostest.rosrun('flute_grinder', 'scene', '__main__')
