"""Shows what /diagnostics reports of a running node at rest. Faults, figures and thresholds are gone through in test_diagnostics.cpp."""

import os
import signal
import subprocess

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

import grinder_client as gc

OK, ERROR = DiagnosticStatus.OK, DiagnosticStatus.ERROR
NAMES = ['Control loop', 'Drive link', 'Following error', 'Limit margin', 'Buffer', 'Journal', 'Recorder', 'History']


class Reports:
    """All that a node reports on /diagnostics."""

    def __init__(self, clean_up, node):
        self.node = node
        self.statuses = {name: [] for name in NAMES}
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self.on_message, queue_size=1000)
        clean_up(subscriber.unregister)

    def on_message(self, message):
        for status in message.status:
            node, name = status.name.split(': ')
            if node.strip('/') == self.node and name in self.statuses:
                self.statuses[name].append(status)

    def mark(self):
        """How many there are of each, for `wait`; of what is under way nothing comes after it."""
        seen = len(self.statuses[NAMES[-1]])
        gc.poll(lambda: len(self.statuses[NAMES[-1]]) > seen, 'a report')
        return {name: len(statuses) for name, statuses in self.statuses.items()}

    def wait(self, name, level, text='', mark=None):
        """Waits for a report of a level, from a mark or from now on."""
        mark = mark or self.mark()

        def found():
            return [s for s in self.statuses[name][mark[name]:] if s.level == level and text in s.message]

        gc.poll(found, '%s at level %d with "%s"' % (name, level, text))
        return found()[0]


class TestDiagnostics(gc.OwnNode):
    def test_at_rest_all_is_well_but_a_recorder_that_dies(self):
        grinder = self.start(dict(gc.machine(), recorder='bag'))
        grinder.make_ready()
        reports = Reports(self.addCleanup, self.node.name)
        mark = reports.mark()
        for name, text in (('Drive link', 'enabled'), ('Following error', 'within'), ('Limit margin', 'no setpoints'),
                           ('Buffer', 'the drive does not buffer'), ('Journal', 'kept'), ('History', 'kept')):
            self.assertEqual(reports.wait(name, OK, text, mark).hardware_id, 'flute_grinder/SimulatedDrive')
        bag = os.path.join(gc.temp_folder(self.addCleanup), 'x.bag')
        recorder = subprocess.Popen(['rosrun', 'rosbag', 'record', '-O', bag, self.node.name + '/setpoints', '__name:=bag'],
                                    stdout=subprocess.DEVNULL, start_new_session=True)
        self.addCleanup(recorder.wait)
        reports.wait('Recorder', OK, 'recording')
        os.killpg(recorder.pid, signal.SIGKILL)
        said = 'the recorder /bag takes no setpoints: no bag has what the grinder does'
        reports.wait('Recorder', ERROR, said)
        gc.poll(lambda: said in self.node.output, 'the log')
        # The grinder does not mind.
        grinder.make_ready()
