"""Shows that two grinders in two namespaces under one master have nothing to do with one another: they run two jobs at
once, each with the setpoints of its own plan, and have journals, transforms, faults and ends of their own."""

import atexit
import os
import pathlib
import re
import shutil
import signal
import subprocess
import unittest
import xmlrpc.client

import rosgraph
import rospy
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
import path_checks as checks

NAMES = ('left/grinder', 'right/grinder')

# The paper's cutter, and one of the other hand that is ground the other way.
CHANGES = {'left/grinder': {'feed_mm_min': 400},
           'right/grinder': {'feed_mm_min': 450, 'spiral_angle_deg': -40, 'direction': 'to_end', 'even_step': 'exact',
                             'clearance_mm': 3, 'flute_length_mm': 25}}
CLIENTS = {}


def clients():
    """The clients of both, ready at park."""
    if not CLIENTS:
        atexit.register(shutil.rmtree, rospy.get_param('/left/grinder/journal'), ignore_errors=True)
        CLIENTS.update({name: gc.Grinder(name) for name in NAMES})
    for client in CLIENTS.values():
        client.make_ready_at_park()
    return [CLIENTS[name] for name in NAMES]


def setpoints(path):
    """The columns that the files of a plan and of a run have in common."""
    with open(path) as file:
        return [line.rstrip().split(',')[:12] for line in file]


class TestTwoJobsAtOnce(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = gc.temp_folder(cls.addClassCleanup)
        cls.jobs = {name: gc.job_file(os.path.join(cls.folder, name.replace('/', '_') + '.yaml'), **changes)
                    for name, changes in CHANGES.items()}
        cls.clients = clients()
        runs = [subprocess.Popen([gc.program('grind'), '--node', name, 'run', cls.jobs[name], '--answer', 'discard',
                                  '--answer', 'ignore-offsets', '--csv', cls.csv(name)],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
                for name in NAMES]
        outputs = [run.communicate(timeout=2 * gc.PATIENCE) for run in runs]
        assert [run.returncode for run in runs] == [0, 0], outputs
        for client in cls.clients:
            client.wait_rest()

    @classmethod
    def csv(cls, name, kind='streamed'):
        return os.path.join(cls.folder, '%s_%s.csv' % (kind, name.replace('/', '_')))

    def test_each_got_the_setpoints_of_its_own_plan_to_the_last_bit_at_the_same_time(self):
        spans = []
        for client in self.clients:
            batches = [batch for batch in client.batches if batch.goal_id == client.batches[-1].goal_id]
            spans.append((batches[0].header.stamp.to_sec(), batches[-1].end_stamp.to_sec()))
        self.assertGreater(min(end for _, end in spans), max(begin for begin, _ in spans))
        for name in NAMES:
            plan = gc.grind('plan', self.jobs[name], '--csv', self.csv(name, 'planned'))
            self.assertEqual(plan.returncode, 0, plan.stderr)
            self.assertTrue(setpoints(self.csv(name)) == setpoints(self.csv(name, 'planned')), name)
        self.assertNotEqual(*(setpoints(self.csv(name)) for name in NAMES))

    def test_journals_are_apart(self):
        folder = rospy.get_param('/left/grinder/journal')
        self.assertEqual(rospy.get_param('/right/grinder/journal'), folder)
        digests = []
        for client in self.clients:
            # Both may be a little later than the job's end.
            path = pathlib.Path(folder + client.name + '.journal')
            journal = gc.poll(lambda: (lambda journal: journal['finished'] and journal)(yaml.safe_load(path.read_text())), 'its end')
            progress = client.wait_fresh(lambda s: s.progress.finished, 'the end of the job').progress
            self.assertEqual(progress.job_digest, journal['job_digest'])
            digests.append(journal['job_digest'])
        self.assertNotEqual(*digests)

    def test_topics_and_diagnostics_are_apart(self):
        published, _, _ = rosgraph.Master(rospy.get_name()).getSystemState()
        topics = {topic for topic, nodes in published}
        own = {'tf', 'tf_static', 'joint_states'}
        self.assertEqual(topics & {'/' + topic for topic in own}, set())
        self.assertLessEqual({'/%s/%s' % (side, topic) for side in ('left', 'right')
                              for topic in own | {'grinder/tool_path'}}, topics)
        with open(gc.package_file('rviz/grinder.rviz')) as file:
            shown = re.findall(r'(?m)^ *(?:\w+ )?Topic: *(.*)$', file.read())
        self.assertTrue(shown)
        self.assertEqual([topic for topic in shown if topic.startswith('/')], [])
        names = set()
        # One connection to each: a new one for every message may be reported by the same grinder each time.
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, lambda m: names.update(s.name for s in m.status))
        self.addCleanup(subscriber.unregister)
        both = {'left/grinder: Drive link', 'right/grinder: Drive link'}
        gc.poll(lambda: both <= names, 'diagnostics of both')


class TestTroubleOfOne(unittest.TestCase):
    def test_override_hold_emergency_stop_and_death_of_one_do_not_touch_the_other(self):
        left, right = clients()
        # Its stroke takes seven seconds, time to interfere in it even on a host that stalls.
        runs = [client.send(gc.paper(flute_length=10 * gc.MM, feed=100 * gc.MM_MIN, clearance=1 * gc.MM)) for client in (left, right)]
        for run in runs:
            run.wait_past(lambda s: s.move == gc.STROKE, 'the stroke')
        self.assertTrue(left.set_feed_override(0.5).success)
        self.assertTrue(left.hold().success)
        self.assertEqual(left.wait_state(GrinderState.HELD).override, 0.5)
        left.inject('emergency_stop')
        runs[0].wait()
        self.assertEqual((runs[0].status, runs[0].code), ('ABORTED', GrindResult.EMERGENCY_STOP))
        self.assertEqual(left.fresh_state().state, GrinderState.FAULT)
        self.assertFalse(runs[1].done)
        self.assertEqual(right.fresh_state().state, GrinderState.RUNNING)
        uri = rosgraph.Master(rospy.get_name()).lookupNode('/' + left.name)
        os.kill(xmlrpc.client.ServerProxy(uri).getPid(rospy.get_name())[2], signal.SIGKILL)
        left.wait_end_of_connections()
        runs[1].wait_complete()
        self.assertEqual((runs[1].status, runs[1].code), ('SUCCEEDED', 0), runs[1].text)
        self.assertTrue(checks.is_gapless(runs[1].setpoints))
        self.assertEqual(runs[1].result.setpoints_written, runs[1].result.plan.statistics.setpoints)
        self.assertEqual(right.fresh_state().state, GrinderState.READY)
