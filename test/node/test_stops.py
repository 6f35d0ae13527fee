"""Shows that nothing stands between a stop and the axes: not planning, disk, terminal, other clients or their goals, not the
end of the process; and that the wheel is not left in the work."""

import contextlib
import fcntl
import os
import random
import signal
import threading
import time

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from flute_grinder.msg import GrindActionResult, GrinderState, GrindResult, Stop

import grinder_client as gc
import path_checks as checks
from grinder_client import A, LIFT, MM, MM_MIN, STROKE, X, Y, Z

SEED = 20

HELD_AHEAD = 'the job will be held before it moves'
# Time enough to do something in a stroke.
SLOW = gc.paper(feed=60 * MM_MIN, clearance=1 * MM)
# Y at which the wheel is clear of its whole stroke: the cutter grows toward its shank.
CLEAR_HEIGHT = checks.Helix(SLOW).y(SLOW['cutter.flute_length'] + SLOW['process.overtravel_shank']) + 1 * MM

F_SETPIPE_SZ = 1031  # Python's fcntl has it from 3.10 on
ENDED_BY_CANCEL = ('PREEMPTED', 'RECALLED')


class NodeTest(gc.OwnNode):
    """With nodes that lose no time with their spindle, and plan whatever they are asked to."""

    def start(self, clean_up=None, **arguments):
        parameters = gc.machine(pace=5)
        parameters['hardware']['spindle_run_up_time'] = 0.0
        parameters['max_job_duration'] = 1e9
        return super().start(parameters, clean_up, **arguments)

    def send_planning(self, job=gc.ENDLESS, **fields):
        run = self.client.send(job, **fields)
        self.client.wait_for(lambda: run.feedback, 'the word that it is planned')
        self.assertEqual(run.feedback[0].state, 'planning')
        return run

    def send_into_stroke(self):
        return self.client.send(SLOW).wait_in_stroke(1 * MM)

    def check_stopped_and_lifted(self, run):
        """By its setpoints: the stroke is left radially, up to the clearance."""
        self.assertTrue(checks.is_gapless(run.setpoints))
        last_stroke = max(i for i, s in enumerate(run.setpoints) if s.move == STROKE)
        stop, *lift = run.setpoints[last_stroke:]
        self.assertEqual({s.move for s in lift}, {LIFT})
        for axis in (X, Z, A):
            self.assertEqual({s.position[axis] for s in lift}, {stop.position[axis]})
        heights = [s.position[Y] for s in [stop, *lift]]
        self.assertEqual(heights, sorted(heights))
        self.assertAlmostEqual(heights[-1], CLEAR_HEIGHT, delta=1e-12)


class TestStops(NodeTest):
    """One node for all tests."""

    @classmethod
    def setUpClass(cls):
        test = cls()
        cls.disk = gc.SlowDisk(gc.temp_folder(cls.addClassCleanup))
        test.start(cls.addClassCleanup, environment=cls.disk.environment)
        cls.node, cls.client = test.node, test.client

    def setUp(self):
        self.client.make_ready()

    def assert_rests(self):
        rest = self.client.wait_rest()
        self.assertEqual(set(self.client.positions_over(0.2)), {tuple(rest)})

    def test_a_job_that_takes_for_ever_to_be_planned_holds_up_nobody(self):
        batches = len(self.client.batches)
        first = self.send_planning()
        for fields in ({}, {'dry_run': True}):
            other = self.client.send(gc.SHORT, **fields).wait()
            self.assertEqual((other.status, other.code), ('REJECTED', GrindResult.BUSY))
        self.assertIn("'grind plan' plans without the grinder", other.text)
        self.assertFalse(first.done)
        self.client.wait_for(lambda: any(0 < f.planned < 1 for f in first.feedback), 'how far it is')
        self.assertEqual(self.client.hold().message, HELD_AHEAD)
        first.cancel()
        self.assertIn(first.wait().status, ENDED_BY_CANCEL)
        self.assert_rests()
        self.assertEqual(len(self.client.batches), batches)
        self.assertEqual(self.client.run(gc.SHORT).status, 'SUCCEEDED')

    def test_hold_of_a_job_that_is_planned_latches(self):
        # Until the disk has taken the answer the job is not planned, however late the hold is.
        self.disk.stop()
        self.addCleanup(self.disk.release)
        run = self.send_planning(SLOW, answers=['discard', 'confirm-wheel', 'ignore-offsets'])
        self.assertEqual(self.client.hold().message, HELD_AHEAD)
        self.disk.release()
        self.client.wait_state(GrinderState.HELD)
        self.assert_rests()
        run.cancel()
        self.assertEqual(run.wait().status, 'PREEMPTED')
        self.assertEqual(len({tuple(s.position) for s in run.setpoints}), 1)

    def test_no_cancel_is_lost_and_none_of_an_unknown_goal_stays(self):
        """Goals that are canceled at any moment, beside one that there is not; actionlib's clients send that without a stamp."""
        chance = random.Random(SEED)
        print('cancels with seed %d' % SEED)
        statuses = gc.received(self.addCleanup, self.node.name + '/grind/status', GoalStatusArray)
        gc.publisher(self.addCleanup, self.node.name + '/grind/cancel', GoalID).publish(GoalID(id='gone'))
        has_unknown = lambda: 'gone' in {status.goal_id.id for status in statuses[-1].status_list}
        gc.poll(lambda: statuses and has_unknown(), 'its status')
        # By the topic: actionlib's client waits for ever for the result of a goal that ended as it was canceled.
        results = gc.received(self.addCleanup, '/%s/grind/result' % self.node.name, GrindActionResult)
        for _ in range(15):
            run = self.client.send(SLOW)
            # No wait for anything: it is canceled at a moment that nothing decides.
            time.sleep(chance.uniform(0, 0.01))
            run.cancel()
            end, = gc.poll(lambda: [r for r in results if r.status.goal_id.id == run.id], 'the end of the goal')
            self.assertIn(end.status.status, (GoalStatus.PREEMPTED, GoalStatus.RECALLED))
            self.client.wait_state(GrinderState.READY)
        gc.poll(lambda: not has_unknown(), 'the end of its status')

    def publish_stop(self, request):
        gc.publisher(self.addCleanup, '/%s/stop' % self.node.name, Stop).publish(Stop(request=request))

    def test_stops_by_topic(self):
        run = self.send_into_stroke()
        self.publish_stop(Stop.HOLD)
        self.client.wait_state(GrinderState.HELD)
        self.assertTrue(self.client.resume().success)
        self.client.wait_state(GrinderState.RUNNING)
        self.publish_stop(Stop.CANCEL)
        self.assertEqual(run.wait_complete().status, 'PREEMPTED')
        self.check_stopped_and_lifted(run)
        self.client.wait_state(GrinderState.READY)
        self.publish_stop(Stop.DISABLE)
        self.client.wait_state(GrinderState.DISABLED)


class TestOwnNodes(NodeTest):
    """Whatever does not answer, and however the process ends, the axes stop on the path, where the loop lives."""

    def test_full_pipe(self):
        read, write = os.pipe()
        self.addCleanup(os.close, read)
        fcntl.fcntl(write, F_SETPIPE_SZ, 4096)
        self.start(output=write).make_ready()
        os.close(write)
        # Each refusal is a line of the log of more than 100 bytes: more than the pipe holds.
        for _ in range(60):
            self.assertEqual(self.client.send(gc.paper(feed=-1, depth=-1, infeed=-1)).wait().status, 'REJECTED')
        run = self.send_into_stroke()
        self.client.fresh_state()
        self.assertTrue(self.client.hold().success)
        self.client.wait_state(GrinderState.HELD)
        self.assertFalse(self.client.home().success)
        run.cancel()
        self.assertEqual(run.wait_complete().status, 'PREEMPTED')
        self.check_stopped_and_lifted(run)

    @contextlib.contextmanager
    def goals_meanwhile(self):
        """Sends goals over and over beside the test."""
        ended, others = threading.Event(), []

        def run():
            while not ended.wait(0.001):
                others.append(self.client.send(gc.SHORT))

        thread = threading.Thread(target=run)
        thread.start()
        try:
            self.client.wait_for(lambda: len(others) > 10, 'some goals')
            yield
        finally:
            ended.set()
            thread.join()

    def test_signals_and_crashes(self):
        for number in (signal.SIGHUP, signal.SIGTERM, signal.SIGSEGV):
            is_crash = number == signal.SIGSEGV
            with self.subTest(number):
                self.start().make_ready()
                run = self.send_into_stroke()
                with self.goals_meanwhile() if number == signal.SIGTERM else contextlib.nullcontext():
                    self.assertEqual(self.node.end(number), -number if is_crash else 0)
                self.client.wait_end_of_connections()
                self.check_stopped_and_lifted(run)
                self.assertEqual({batch.goal_id for batch in self.client.batches}, {run.id}, 'goals that came meanwhile did not start')
                if not is_crash:
                    x = [s.position[X] for s in run.setpoints if s.move == STROKE][-1]
                    self.assertEqual((run.status, run.code, run.text), (
                        'PREEMPTED', GrindResult.CANCELED, 'canceled; stopped on the path (stroke, tooth 1, pass 1, X = %g mm)' % (x / MM)))

    def test_signal_while_a_job_is_planned_and_a_cancel_that_cancels_goals_to_come(self):
        self.start()
        cancels = gc.publisher(self.addCleanup, self.node.name + '/grind/cancel', GoalID)
        # By more, the stamp is that of its receipt.
        cancels.publish(GoalID(stamp=rospy.Time.from_sec(time.time() + 55)))
        runs = []
        # Cancels and goals come by connections of their own.
        gc.poll(lambda: runs.append(self.client.send(gc.paper(), confirm=False).wait()) or runs[-1].status == 'RECALLED', 'the cancel')
        self.assertEqual(runs[-1].code, GrindResult.CANCELED)
        self.assertRegex(runs[-1].text, r'^a cancel was stamped [1-5]\d?(\.\d+)? s in the future, and cancels every goal until then; '
                         'allowed: clients whose clocks agree$')
        self.start().make_ready()
        run = self.send_planning()
        self.assertEqual(self.node.end(signal.SIGINT), 0)
        self.client.wait_for(lambda: run.done, 'the end of the goal')
        self.assertIn(run.status, ENDED_BY_CANCEL)
