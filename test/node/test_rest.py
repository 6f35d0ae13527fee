"""Shows how often the node reports positions and state: seldom while nothing changes, at the full rate while an axis moves, and at
once when the rest ends. All times are the messages' stamps, by the loop's clock."""

import itertools
import statistics
import unittest

from flute_grinder.msg import GrinderState
from flute_grinder.srv import JogStep

import grinder_client as gc
from grinder_client import MM, MM_MIN, Y, grinder

REST = 0.1  # between messages [s]
TICK = 0.02  # between looks for a change [s]


def intervals(messages):
    stamps = [message.header.stamp.to_sec() for message in messages]
    return [b - a for a, b in zip(stamps, stamps[1:])]


def wait_for_fewer(messages):
    """Waits until messages come as seldom as at rest."""
    seen = len(messages)
    grinder().wait_for(lambda: len(messages) > seen + 2 and min(intervals(messages[-3:])) > REST - TICK, 'the rest')


def change_emergency_stop(pressed):
    """Presses or releases it, and returns how long after the state before it the first one reports it."""
    g = grinder()
    wait_for_fewer(g.states)
    seen = len(g.states)
    g.inject('emergency_stop' if pressed else 'none')
    g.wait_for(lambda: g.states[-1].emergency_stop == pressed, 'the emergency stop')
    first = next(i for i in range(seen, len(g.states)) if g.states[i].emergency_stop == pressed)
    return intervals(g.states[first - 1:first + 1])[0]


class TestRest(unittest.TestCase):
    def setUp(self):
        self.addCleanup(grinder().take_faults_back)
        self.at = grinder().make_ready()

    def test_nothing_changes(self):
        g = grinder()
        for messages in (g.joints, g.states):
            wait_for_fewer(messages)
            seen = len(messages)
            g.wait_for(lambda: len(messages) >= seen + 10, 'what is reported at rest')
            # A message may come late, and the next one in time.
            self.assertGreater(statistics.mean(intervals(messages[seen:])), REST - TICK / 2)
        self.assertEqual(g.positions(), self.at)

    def test_a_change_is_reported_at_once(self):
        self.assertTrue(grinder().disable().success)
        # By the next looks, and not with the next message that is due, which a host that stalls may hide for a while.
        pressed = itertools.cycle((True, False))
        gc.poll(lambda: change_emergency_stop(next(pressed)) < REST / 2, 'a change that is reported at once')

    def test_axis_moves_and_a_goal_is_worked_on(self):
        g = grinder()
        wait_for_fewer(g.joints)
        seen = len(g.joints)
        step = g._call('jog_step', JogStep, Y, 2 * MM, 60 * MM_MIN)
        self.assertTrue(step.success, step.message)
        g.wait_state(GrinderState.READY)
        moving = [j for j in g.joints[seen:] if j.velocity[Y] != 0]
        self.assertLess(statistics.median(intervals(moving)), REST / 2)
        states = [s for s in g.states if s.state == GrinderState.JOGGING]
        self.assertLess(statistics.median(intervals(states)), 3 * REST / 4)
        # Though the axes do not move yet, as while the spindle runs up.
        wait_for_fewer(g.joints)
        seen = len(g.joints)
        run = g.send(gc.SHORT).wait_complete()
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.assertLess(statistics.median(intervals(g.joints[seen:])), REST / 2)
