#!/usr/bin/env python3
"""Shows what /diagnostics tells of a running node: the figures of a job as they follow from its setpoints, warnings and
errors from the thresholds on that the parameters state, and the faults of the drive."""

import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from flute_grinder.msg import GrinderState

import grinder_client as gc
from grinder_client import MM

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
NAMES = ['Control loop', 'Drive link', 'Following error', 'Limit margin', 'Buffer', 'Journal', 'History']


class Reports:
    """All that a node tells on /diagnostics."""

    def __init__(self, node):
        self.node = node
        self.statuses = {name: [] for name in NAMES}
        self.subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self.on_message, queue_size=1000)

    def on_message(self, message):
        for status in message.status:
            node, name = status.name.split(': ')
            if node.strip('/') == self.node and name in self.statuses:
                self.statuses[name].append(status)

    def mark(self):
        """How many there are of each, for `since`; of what is under way nothing comes after it."""
        seen = len(self.statuses[NAMES[-1]])
        gc.poll(lambda: len(self.statuses[NAMES[-1]]) > seen, 'a report')
        return {name: len(statuses) for name, statuses in self.statuses.items()}

    def since(self, mark, name):
        return self.statuses[name][mark[name]:]

    def wait(self, name, level, text=''):
        """Waits for a report of a level, from now on."""
        mark = self.mark()

        def found():
            return [s for s in self.since(mark, name) if s.level == level and text in s.message]

        gc.poll(found, '%s at level %d with "%s"' % (name, level, text))
        return found()[0]


def values(status):
    return {v.key: v.value for v in status.values}


def figures(statuses, key):
    return [float(values(s)[key]) for s in statuses if key in values(s)]


class TestDiagnostics(unittest.TestCase):
    name = 'diagnosed'

    @classmethod
    def setUpClass(cls):
        parameters = gc.machine()
        parameters['diagnostics']['following_error'] = {'warn': 0.2, 'error': 0.9}
        parameters['diagnostics']['limit_use'] = {'warn': 0.9, 'error': 1.000001}
        cls.node = gc.NodeProcess(cls.name, parameters)
        cls.addClassCleanup(cls.node.close)
        cls.grinder = cls.node.client()
        cls.addClassCleanup(cls.grinder.close)
        cls.reports = Reports(cls.name)
        cls.addClassCleanup(cls.reports.subscriber.unregister)

    def setUp(self):
        self.grinder.make_ready()

    def test_at_rest_all_is_well(self):
        for name, text in (('Drive link', 'enabled'), ('Following error', 'within'), ('Limit margin', 'no setpoints'),
                           ('Buffer', 'the drive does not buffer'), ('Journal', 'kept'),
                           ('History', 'kept')):
            self.assertEqual(self.reports.wait(name, OK, text).hardware_id, 'flute_grinder/SimulatedDrive')

    def test_control_loop_warns_where_it_must(self):
        """What this host grants and how late it is cannot be known, but what follows from it."""
        mark = self.reports.mark()
        gc.poll(lambda: len(self.reports.since(mark, 'Control loop')) > 5, 'reports')
        for status in self.reports.since(mark, 'Control loop'):
            told = values(status)
            self.assertEqual((told['State'], told['Nominal period [s]'], told['Records lost']), ('ready', '0.001', '0'))
            cycles, late = int(told['Cycles']), int(told['Late cycles'])
            granted = {told['Real-time scheduling'], told['Memory locked']} == {'True'}
            expected = ERROR if late > 0.05 * cycles else WARN if late or not granted else OK
            self.assertEqual(status.level, expected, status)
            self.assertLessEqual(float(told['Mean period [s]']), float(told['Longest period [s]']))

    def test_figures_of_a_job_are_those_of_its_setpoints(self):
        mark = self.reports.mark()
        run = self.grinder.run(gc.SHORT)
        self.assertEqual(run.status, 'SUCCEEDED', run.text)
        self.reports.mark()
        setpoints, period, limits = run.setpoints, self.grinder.period(), self.grinder.limits()
        allowed = [rospy.get_param('/%s/constraints/%s/trajectory' % (self.name, joint)) for joint in gc.JOINTS]
        following, margins = self.reports.since(mark, 'Following error'), self.reports.since(mark, 'Limit margin')
        self.assertEqual(sum(figures(margins, 'Setpoints')), len(setpoints))
        for axis, joint in enumerate(gc.JOINTS):
            positions = [s.position[axis] for s in setpoints]
            # `actual` is of the cycle before the axes get the setpoint; they are to be at the one before.
            largest = max(abs(p - s.actual[axis]) for p, s in zip(positions, setpoints[1:])) / allowed[axis]
            told = max(figures(following, joint + ' of the allowed [%]')) / 100
            self.assertAlmostEqual(told, largest, delta=1e-5 * largest)
            fastest = max(abs(b - a) for a, b in zip(positions, positions[1:])) / period
            told = 1 - min(figures(margins, joint + ' velocity margin [%]')) / 100
            self.assertAlmostEqual(told, fastest / limits['max_velocity'][axis], delta=1e-5)
            ends = positions[:1] * 2 + positions[::2]
            bends = [abs(a - 2 * b + c) for a, b, c in zip(ends, ends[1:], ends[2:])]
            told = 1 - min(figures(margins, joint + ' acceleration margin [%]')) / 100
            self.assertAlmostEqual(told, max(bends) / (2 * period) ** 2 / limits['max_acceleration'][axis], delta=1e-5)
            low, high = limits['min_position'][axis], limits['max_position'][axis]
            nearest = min(min(p - low, high - p) for p in positions)
            told = min(figures(margins, joint + ' position margin [%]')) / 100
            self.assertAlmostEqual(told, nearest / ((high - low) / 2), delta=1e-5)
        # Rapids use all of a limit, and lag by their speed times 2 ms.
        self.assertEqual(max(s.level for s in margins), WARN)
        self.assertEqual(max(s.level for s in following), WARN)

    def test_stuck_axis(self):
        run = self.grinder.send(gc.PAPER).wait_in_stroke(2 * MM)
        mark = self.reports.mark()
        self.grinder.inject('stuck_axis', 'axis_x')
        run.wait()
        self.reports.wait('Drive link', ERROR, 'axis_x following error')
        errors = [s for s in self.reports.since(mark, 'Following error') if s.level == ERROR]
        self.assertTrue(errors)
        self.assertGreater(max(figures(errors, 'axis_x of the allowed [%]')), 100)
        self.grinder.make_ready()
        self.reports.wait('Following error', OK)
        self.reports.wait('Drive link', OK)

    def test_emergency_stop(self):
        self.grinder.inject('emergency_stop')
        status = self.reports.wait('Drive link', ERROR, 'emergency stop')
        self.assertEqual(values(status)['Emergency stop'], 'True')
        self.grinder.inject('none')
        gc.poll(lambda: self.grinder.reset().success, 'the reset')
        self.assertEqual(values(self.reports.wait('Drive link', OK, 'disabled'))['Emergency stop'], 'False')

    def test_drive_fault_and_stale_feedback_without_power(self):
        self.assertTrue(self.grinder.disable().success)
        for fault, text in (('drive_fault', 'the drive reports a fault'), ('stale_feedback', 'no fresh positions for'),
                            ('nan_feedback', 'axis_y position is ')):
            self.grinder.inject(fault, 'axis_y' if fault == 'nan_feedback' else '')
            self.reports.wait('Drive link', ERROR, text)
        self.grinder.take_faults_back()
        gc.poll(lambda: self.grinder.reset().success, 'the reset')
        self.reports.wait('Drive link', OK, 'disabled')

    def test_reference_lost_is_a_warning(self):
        self.grinder.inject('reference_lost')
        self.reports.wait('Drive link', WARN, 'not homed')
        self.grinder.inject('none')
        self.assertTrue(self.grinder.home().success)
        self.grinder.wait_state(GrinderState.READY)
        self.reports.wait('Drive link', OK)


if __name__ == '__main__':
    rospy.init_node('test_diagnostics')
    rostest.rosrun('flute_grinder', 'diagnostics', '__main__')
