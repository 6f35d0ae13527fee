#!/usr/bin/env python3
"""Shows that rviz with the shipped configuration fits a small screen with the panel's stops and replies, that nothing in it takes the
panel from the screen while the grinder moves, and that it asks before it ends."""

import os
import sys
import unittest

import rospy
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from test_scene import JOB, Rviz, gc, grinder  # noqa: E402

STOPS = {'hold', 'cancel', 'disable'}
# What closes, folds, hides or replaces the panel. In a window of rviz's own the file dialogs would keep all clicks from it.
WAYS = ['click close_box', 'menu Grinder /grinder', 'menu Grinder', 'click fold', 'menu &Fullscreen', 'key F11', 'menu &Open Config',
        'key Ctrl+O', 'menu Add &New Panel', 'menu &Preferences']


class TestWindow(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.rviz = Rviz()
        grinder().make_ready_at_park()

    def dialogs(self):
        return set(self.rviz.report('dialog'))

    def expect_stops(self):
        gc.poll(lambda: STOPS <= {name for name, button in self.rviz.buttons().items() if button[0]}, 'the stops on the screen')

    def start(self):
        run = grinder().send(JOB)
        self.addCleanup(grinder().set_feed_override, 1)
        self.assertTrue(grinder().set_feed_override(0).success)
        self.expect_stops()
        return run

    def test_0_stops_are_on_a_small_screen_from_the_start(self):
        _, _, right, bottom = self.rviz.numbers('screen')
        self.assertEqual((right, bottom), (1024, 768))
        left, top, width, height = self.rviz.numbers('window')
        self.assertTrue(left >= 0 and top >= 0 and left + width <= right and top + height <= bottom)
        # With room for the title of a window, and a task bar.
        _, _, min_width, min_height = self.rviz.numbers('least')
        self.assertTrue(min_width <= 800 and min_height <= 760)
        self.assertEqual(self.rviz.report('title'), ['/grinder - grinder.rviz[*] - RViz'])
        self.assertIn('Grinder /grinder', self.rviz.report('dock'))
        places = []
        for tab in ['Job', 'Section', 'Jog', 'Zero', 'View']:
            self.rviz.operate('tab ' + tab)
            seen = self.rviz.buttons()
            places.append([seen[name] for name in sorted(STOPS | {'messages'})])
            for _, left, top, width, height in places[-1]:
                self.assertTrue(left >= 0 and top >= 0 and left + width <= right and top + height <= bottom)
            self.assertTrue(tab != 'Jog' or {'jog_y_plus', 'jog_y_minus', 'spindle_off', 'coolant_off'} <= set(seen))
        self.assertEqual(places, places[:1] * 5)

    def test_1_panel_stays_while_a_job_runs(self):
        run = self.start()
        for way in WAYS:
            with self.subTest(way):
                self.rviz.operate(way)
                self.expect_stops()
                self.assertEqual(self.dialogs(), set())
        self.rviz.operate('tab View')
        self.assertFalse(self.rviz.buttons()['choose_node'][0])
        # In the view, where the mouse has left the focus.
        self.rviz.operate('click view')
        self.rviz.operate('key Space')
        grinder().wait_for(lambda: grinder().states[-1].state_name == 'held', 'held by Space')
        run.cancel()
        run.wait_complete()
        gc.poll(lambda: self.rviz.buttons()['choose_node'][0], 'the choice of the node')
        for way in ['click fold', 'menu &Fullscreen', 'click close_box']:
            with self.subTest(way):
                self.rviz.operate(way)
                gc.poll(lambda: 'hold' not in self.rviz.buttons(), 'no panel')
                if way != 'click close_box':
                    self.rviz.operate(way)
                    gc.poll(lambda: 'hold' in self.rviz.buttons(), 'the panel')
        # It comes back by itself for what stops a job.
        again = self.start()
        again.cancel()
        again.wait_complete()

    def test_2_rviz_asks_before_it_ends(self):
        run = self.start()
        for way in ['key Ctrl+Q', 'menu &Quit']:
            self.rviz.operate(way)
            gc.poll(lambda: self.dialogs() == {'end_rviz_dialog'}, 'the question')
            self.expect_stops()
            gc.poll(lambda: self.rviz.buttons()['decline_end_rviz'][0], 'the answers')
            danger, stay = (self.rviz.buttons()[name] for name in ('end_rviz', 'decline_end_rviz'))
            self.assertLess(danger[3], stay[3])
            self.rviz.operate('key Return')
            self.rviz.operate('click decline_end_rviz')
            gc.poll(lambda: not self.dialogs(), 'no question')
        self.rviz.operate('key Ctrl+Q')
        gc.poll(lambda: self.rviz.buttons().get('end_rviz', [0])[0], 'the answers')
        before = self.rviz.numbers('frames')[0]
        self.rviz.operate('click end_rviz', ends=True)
        gc.poll(lambda: 0 < Rviz.frames() < before, 'another rviz')
        run.cancel()
        run.wait_complete()


if __name__ == '__main__':
    rospy.init_node('test_window')
    rostest.rosrun('flute_grinder', 'window', '__main__')
