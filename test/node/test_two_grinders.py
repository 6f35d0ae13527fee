"""Shows that two grinders in two namespaces under one master have nothing to do with one another: they run two jobs at
once, each with the setpoints of its own plan, and have journals, transforms, faults and ends of their own."""

import atexit
import os
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


def read(path):
    with open(path, 'rb') as file:
        return file.read()


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
        cls.left, cls.right = clients()
        runs = [subprocess.Popen([gc.program('grind'), '--node', name, 'run', cls.jobs[name], '--answer', 'discard',
                                  '--answer', 'ignore-offsets', '--csv',
                                  cls.csv(name)],
                                 stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
                for name in NAMES]
        cls.outputs = [run.communicate(timeout=2 * gc.PATIENCE) for run in runs]
        cls.statuses = [run.returncode for run in runs]
        for client in (cls.left, cls.right):
            client.wait_rest()

    @classmethod
    def csv(cls, name, kind='streamed'):
        return os.path.join(cls.folder, '%s_%s.csv' % (kind, name.replace('/', '_')))

    def batches(self, client):
        """Of the job run last."""
        return [batch for batch in client.batches if batch.goal_id == client.batches[-1].goal_id]

    def test_both_are_done(self):
        self.assertEqual(self.statuses, [0, 0], self.outputs)

    def test_they_ran_at_the_same_time(self):
        spans = [(batches[0].header.stamp.to_sec(), batches[-1].end_stamp.to_sec())
                 for batches in (self.batches(self.left), self.batches(self.right))]
        together = min(end for _, end in spans) - max(begin for begin, _ in spans)
        self.assertGreater(together, 0.5 * min(end - begin for begin, end in spans))

    def test_each_got_the_setpoints_of_its_own_plan_to_the_last_bit(self):
        for name in NAMES:
            plan = gc.grind('plan', self.jobs[name], '--csv', self.csv(name, 'planned'))
            self.assertEqual(plan.returncode, 0, plan.stderr)
            self.assertTrue(setpoints(self.csv(name)) == setpoints(self.csv(name, 'planned')), name)
        self.assertNotEqual(setpoints(self.csv('left/grinder')), setpoints(self.csv('right/grinder')))

    def test_journals_are_apart(self):
        folder = rospy.get_param('/left/grinder/journal')
        self.assertEqual(rospy.get_param('/right/grinder/journal'), folder)
        digests = []
        for client in (self.left, self.right):
            with open(folder + client.name + '.journal') as text:
                journal = yaml.safe_load(text)
            self.assertTrue(journal['finished'])
            progress = client.fresh_state().progress
            self.assertEqual((progress.job_digest, progress.finished), (journal['job_digest'], True))
            digests.append(journal['job_digest'])
        self.assertNotEqual(*digests)

    def test_nobody_publishes_transforms_or_joint_states_for_all(self):
        published, _, _ = rosgraph.Master(rospy.get_name()).getSystemState()
        topics = {topic for topic, nodes in published}
        own = {'tf', 'tf_static', 'joint_states'}
        self.assertEqual(topics & {'/' + topic for topic in own}, set())
        self.assertLessEqual({'/%s/%s' % (side, topic) for side in ('left', 'right')
                              for topic in own | {'grinder/tool_path'}}, topics)

    def test_rviz_shows_topics_of_its_own_namespace(self):
        topics = re.findall(r'(?m)^ *(?:\w+ )?Topic: *(.*)$', read(gc.package_file('rviz/grinder.rviz')).decode())
        self.assertTrue(topics)
        self.assertEqual([topic for topic in topics if topic.startswith('/')], [])

    def test_diagnostics_tell_them_apart(self):
        names = set()
        # One connection to each: a new one for every message may be reported by the same grinder each time.
        subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, lambda m: names.update(s.name for s in m.status))
        self.addCleanup(subscriber.unregister)
        both = {'left/grinder: Drive link', 'right/grinder: Drive link'}
        gc.poll(lambda: both <= names, 'diagnostics of both')


# Its stroke takes 20 s, time to interfere in it even on a host that stalls.
LONG = gc.paper(feed=100 * gc.MM_MIN)


class TestFaultOfOne(unittest.TestCase):
    def test_override_hold_and_emergency_stop_of_one_do_not_touch_the_other(self):
        left, right = clients()
        runs = [client.send(LONG) for client in (left, right)]
        for run in runs:
            run.wait_past(lambda s: s.move == gc.STROKE, 'the stroke')
        self.assertTrue(left.set_feed_override(0.5).success)
        self.assertTrue(left.hold().success)
        self.assertEqual(left.wait_state(GrinderState.HELD).override, 0.5)
        left.inject('emergency_stop')
        runs[0].wait()
        self.assertEqual((runs[0].status, runs[0].code), ('ABORTED', GrindResult.EMERGENCY_STOP))
        self.assertFalse(runs[1].done)
        self.assertEqual(right.fresh_state().state, GrinderState.RUNNING)
        runs[1].wait_complete()
        self.assertEqual((runs[1].status, runs[1].code), ('SUCCEEDED', 0), runs[1].text)
        self.assertTrue(checks.is_gapless(runs[1].setpoints))
        self.assertEqual(runs[1].result.setpoints_written, runs[1].result.plan.statistics.setpoints)
        self.assertEqual(right.fresh_state().state, GrinderState.READY)
        self.assertEqual(left.fresh_state().state, GrinderState.FAULT)


class TestEndOfOne(unittest.TestCase):
    """With the same launch once more, in a namespace above."""

    def setUp(self):
        folder = gc.temp_folder(self.addCleanup)
        launch = subprocess.Popen(['roslaunch', '--wait', gc.package_file('test/node/two_grinders.test'), '__ns:=shop'],
                                  env=dict(os.environ, TMPDIR=folder), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(launch.wait, gc.PATIENCE)
        self.addCleanup(launch.send_signal, signal.SIGINT)

    def test_one_that_dies_does_not_end_the_other(self):
        left, right = (gc.Grinder('shop/' + name) for name in NAMES)
        for client in (left, right):
            self.addCleanup(client.close)
            client.make_ready()
        run = right.send(LONG)
        run.wait_past(lambda s: s.move == gc.STROKE, 'the stroke')
        uri = rosgraph.Master(rospy.get_name()).lookupNode('/' + left.name)
        os.kill(xmlrpc.client.ServerProxy(uri).getPid(rospy.get_name())[2], signal.SIGKILL)
        left.wait_end_of_connections()
        run.wait_complete()
        self.assertEqual((run.status, run.code), ('SUCCEEDED', 0), run.text)
        self.assertEqual(right.fresh_state().state, GrinderState.READY)
