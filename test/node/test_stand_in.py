"""Shows the command line with a stand-in for the grinder, which reports what a good one hardly ever does: a job that takes
long to plan, setpoints that were lost, those of others' jobs amid one's own, a wheel that is left in the work."""

import copy
import json
import signal
import socketserver
import struct
import threading

import actionlib
import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatusArray
from flute_grinder.msg import (FeedLimit, GrindAction, GrinderState, GrindFeedback, GrindResult, Need, PathStatistics, PlanReport, SetpointBatch, Stop,
                               WorkOffsets, WrittenSetpoint)
from flute_grinder.srv import SetFeedOverride
from std_srvs.srv import Trigger, TriggerResponse

import grinder_client as gc
from grind_command import PAPER_JOB, RunTest, default_signals


class StandIn:
    """A node that says what a test has it say. Goals are accepted, and stay until the test ends them."""

    def __init__(self):
        self.lock = threading.Lock()
        self.state = GrinderState(state=GrinderState.READY, state_name='ready', enabled=True, homed=True, override=1)
        self.goals, self.canceled, self.stops, self.lifts = [], [], [], 0
        self.states = rospy.Publisher('grinder/state', GrinderState, queue_size=10, latch=True)
        self.offsets = rospy.Publisher('grinder/offsets', WorkOffsets, queue_size=1, latch=True)
        self.offsets.publish(WorkOffsets())
        self.setpoints = rospy.Publisher('grinder/setpoints', SetpointBatch, queue_size=1000)
        rospy.Subscriber('grinder/stop', Stop, lambda stop: self.stops.append(stop.request))
        rospy.Service('grinder/lift', Trigger, self.on_lift)
        self.server = actionlib.ActionServer('grinder/grind', GrindAction, self.on_goal, self.canceled.append, False)
        self.server.start()
        threading.Thread(target=self.publish, daemon=True).start()

    def publish(self):
        while not rospy.is_shutdown():
            self.publish_state()
            rospy.rostime.wallsleep(0.1)

    def publish_state(self):
        with self.lock:
            self.states.publish(copy.deepcopy(self.state))  # a subscriber that comes later gets it as it was

    def set(self, state, name, **fields):
        with self.lock:
            self.state.state, self.state.state_name = state, name
            for field, value in fields.items():
                setattr(self.state, field, value)

    def on_goal(self, goal):
        goal.set_accepted()
        self.goals.append(goal)

    def on_lift(self, _):
        self.lifts += 1
        self.set(GrinderState.LIFTING, 'lifting')
        return TriggerResponse(success=True)

    def await_goal(self):
        gc.poll(lambda: self.goals, 'a goal')
        client = self.goals[-1].get_goal_id().id.split('-')[0]
        for topic in (self.server.feedback_pub, self.server.result_pub, self.setpoints):
            # rospy sends its header before it publishes to a connection.
            gc.poll(lambda: client in [connection.endpoint_id for connection in topic.impl.connections], topic.name)
        return self.goals[-1]

    def batch(self, goal_id, cycles, lost=0):
        self.setpoints.publish(SetpointBatch(goal_id=goal_id, period=1e-3, lost=lost,
                                             setpoints=[WrittenSetpoint(cycle=cycle) for cycle in cycles]))


class FeedOverride(socketserver.BaseRequestHandler):
    """A connection to a `~set_feed_override` that sends header and answer as soon as it has the client's header."""

    headers = []

    def handle(self):
        length, = struct.unpack('<I', gc.receive(self.request, 4))
        header = gc.receive(self.request, length)
        kind = SetFeedOverride
        self.request.sendall(gc.tcpros_header({'md5sum': kind._md5sum, 'type': kind._type, 'callerid': rospy.get_name()}))
        if b'probe=1' not in header:
            self.headers.append(header)
            self.request.sendall(struct.pack('<BIBI', True, 5, True, 0))
        while self.request.recv(4096):
            pass


class TestStandIn(RunTest):
    @classmethod
    def setUpClass(cls):
        cls.node = StandIn()

    def setUp(self):
        super().setUp()
        for kept in (self.node.goals, self.node.canceled, self.node.stops):
            kept.clear()
        self.node.set(GrinderState.READY, 'ready', wheel_in_work=False, fault='', progress=type(self.node.state.progress)())

    def status(self):
        done = gc.grind('status')
        reported = gc.grind('status', '--json')
        self.assertEqual((done.returncode, reported.returncode), (0, 0), done.stderr + reported.stderr)
        return done.stdout, json.loads(reported.stdout)

    def start_run(self, *arguments, **options):
        command = self.grind('run', PAPER_JOB, *arguments, **options)
        return command, self.node.await_goal()

    @staticmethod
    def show(command, goal, text, **feedback):
        """Repeats a feedback until its text is there: the command forgets it where no state comes for a second."""
        gc.poll(lambda: goal.publish_feedback(GrindFeedback(**feedback)) or text in command.text, text, interval=0.1)

    def test_planning_is_shown_and_canceled_by_signals_but_by_no_hangup_under_nohup(self):
        def nohup():
            default_signals()
            signal.signal(signal.SIGHUP, signal.SIG_IGN)

        for before, signals in ((default_signals, [signal.SIGINT]), (default_signals, [signal.SIGHUP]), (nohup, [signal.SIGHUP, signal.SIGTERM])):
            self.node.goals.clear()
            self.node.canceled.clear()
            command, goal = self.start_run(before=before)
            self.show(command, goal, 'planning 43 %\n', state='planning', planned=0.43)
            self.assertRegex(command.text, r'(?m)^\[#{12}\.{18}\]  planning 43 %$')
            for number in signals:
                command.send(number)
            gc.poll(lambda: self.node.canceled, 'the cancel')
            self.assertEqual(self.node.canceled[0].get_goal_id().id, goal.get_goal_id().id)
            goal.set_canceled(GrindResult(error_code=GrindResult.CANCELED, error_string='canceled while it was planned'))
            self.assertEqual(command.end(), 1)
            # The hang-up was none of them.
            self.assertTrue(command.text.endswith('%\ncanceling: waiting for the stop\ncanceled while it was planned (code -11)\n'), command.text)
            self.assertEqual(command.stdout, '')

    def test_grinder_that_no_longer_knows_the_job(self):
        command, goal = self.start_run()
        statuses = gc.publisher(self.addCleanup, '/grinder/grind/status', GoalStatusArray)
        # As of a new process.
        gc.poll(lambda: statuses.publish(GoalStatusArray()) or command.process.poll() is not None, 'its end')
        self.assertEqual(command.end(), 1)
        self.assertTrue(command.text.endswith('the grinder no longer knows the job: it has been restarted\n'), command.text)
        goal.set_aborted()

    def test_texts_of_a_peer_are_shown_escaped(self):
        bad, shown = 'a\x1b[2J', 'a\\x1b[2J'
        progress = type(self.node.state.progress)(job_digest='0', job_name=bad)
        self.node.offsets.publish(WorkOffsets(set_by=[bad] * 4, set_at=[rospy.Time(1)] * 4, error=bad))
        self.addCleanup(self.node.offsets.publish, WorkOffsets())
        self.addCleanup(self.node.set, GrinderState.READY, 'ready', hold_reason='', journal_error='')
        self.node.set(GrinderState.READY, bad, fault=bad, hold_reason=bad, journal_error=bad, progress=progress)
        gc.poll(lambda: shown in gc.grind('status').stdout, 'the state')
        for words, times in (('status', 5), ('offsets', 5)):
            done = gc.grind(words)
            self.assertNotIn('\x1b', done.stdout + done.stderr)
            self.assertGreaterEqual(done.stdout.count(shown), times, done.stdout)
        command, goal = self.start_run()
        self.show(command, goal, '  ' + shown, state=bad)
        command.wait_text('held: ' + shown)
        statistics = PathStatistics(setpoints=1, feed_limits=[FeedLimit(cause=bad)])
        goal.set_succeeded(GrindResult(plan=PlanReport(statistics=statistics, closest_bodies=[bad] * 2, needs=[Need(text=bad)])))
        self.assertEqual(command.end(), 0, command.text)
        self.assertIn('to start it: ' + shown, command.text)
        self.assertNotIn('\x1b', command.text)

    def test_planning_on_a_terminal(self):
        command, goal = self.start_run('--dry-run', columns=30)
        self.show(command, goal, 'planning 50 %', state='planning', planned=0.5)
        goal.set_succeeded(GrindResult(plan=PlanReport(statistics=PathStatistics(setpoints=1), complete=[0, 0.03])))
        self.assertEqual(command.end(), 0, command.text)
        self.assertRegex(command.text, r'\r\x1b\[K\[#{6}\.{6}\]  planning 50 %\r\n$')
        self.assertIn('flutes complete      X 0.000 to 30.000 mm\n', command.stdout)

    def test_hold_while_a_job_is_planned_holds_its_start(self):
        command, goal = self.start_run()
        self.show(command, goal, 'planning 10 %', state='planning', planned=0.1)
        command.send(signal.SIGTSTP)
        gc.poll(lambda: self.node.stops == [Stop.HOLD], 'the hold')
        self.node.set(GrinderState.STARTING, 'starting')
        gc.poll(lambda: self.node.stops == [Stop.HOLD] * 2, 'the hold of the start')
        self.node.set(GrinderState.HELD, 'held')
        self.assertEqual(gc.grind('status').returncode, 0)
        self.assertEqual(self.node.stops, [Stop.HOLD] * 2)
        goal.set_aborted(GrindResult(error_code=-8, error_string='enough'))
        self.assertEqual(command.end(), 1)

    def test_setpoints_that_were_lost_are_reported_and_those_of_others_not_taken(self):
        csv = self.folder + '/streamed.csv'
        command, goal = self.start_run('--csv', csv)
        own, other = goal.get_goal_id().id, '/someone_else-1-1.0'
        # Reported: 0 to 9 and 15 to 19. Lost: 10 to 12. On the way: 13 and 14, and 20 at the end.
        for batch in ((other, range(500, 700)), (own, range(10)), (other, range(700, 900), 4), (own, range(15, 20), 3)):
            self.node.batch(*batch)
        goal.set_succeeded(GrindResult(setpoints_written=21))
        self.assertEqual(command.end(), 0, command.text)
        self.assertRegex(command.stdout, r'(?m)^streamed +15 setpoints in 0\.000 s, 3 missed, 3 written but not published$')
        with open(csv) as lines:
            self.assertEqual([line.split(',')[0] for line in lines],
                             ['cycle'] + [str(i) for i in [*range(10), *range(15, 20)]])

    def test_setpoints_of_which_none_could_be_reported(self):
        command, goal = self.start_run()
        self.node.batch(goal.get_goal_id().id, [], 7)
        goal.set_succeeded(GrindResult(setpoints_written=7))
        self.assertEqual(command.end(), 0, command.text)
        self.assertRegex(command.stdout, r'(?m)^streamed +0 setpoints in 0\.000 s, 0 missed, 7 written but not published$')

    def test_goal_has_the_files_name_and_the_answers(self):
        for arguments, answers in (([], []), (['--answer', 'discard', '--answer', 'fit-offsets'], ['discard', 'fit-offsets'])):
            self.node.goals.clear()
            command, goal = self.start_run(*arguments)
            self.assertEqual((goal.get_goal().job_name, goal.get_goal().answers), ('paper.yaml', answers))
            goal.set_succeeded(GrindResult())
            self.assertEqual(command.end(), 0)

    def test_status_is_the_present_one(self):
        class Listener(rospy.SubscribeListener):
            def peer_subscribe(_, topic, publish, peer_publish):
                self.node.set(GrinderState.HELD, 'held')

        listener = Listener()
        self.node.states.impl.add_subscriber_listener(listener)
        self.addCleanup(self.node.states.impl.subscriber_listeners.remove, listener)

        def is_held():
            self.node.set(GrinderState.READY, 'ready')
            self.node.publish_state()
            return '\nstate           held\n' in gc.grind('status').stdout

        # It waits a second for the one after the first.
        gc.poll(is_held, 'the state held')

    def test_lift_waits_until_the_wheel_is_off_the_work(self):
        self.node.set(GrinderState.READY, 'ready', wheel_in_work=True)
        self.node.publish_state()
        text, reported = self.status()
        self.assertRegex(text, r'(?m)^wheel in work   yes$')
        self.assertIs(reported['wheel_in_work'], True)
        command = self.grind('lift')
        gc.poll(lambda: self.node.state.state == GrinderState.LIFTING, 'the lift')
        self.node.publish_state()
        self.assertRegex(self.status()[0], r'(?m)^state           lifting$')
        self.assertIsNone(command.process.poll())
        self.node.set(GrinderState.READY, 'ready', wheel_in_work=False)
        self.assertEqual((command.end(), command.text), (0, ''))

    def start_lift(self):
        self.node.set(GrinderState.READY, 'ready', wheel_in_work=True)
        lifts = self.node.lifts
        command = self.grind('lift')
        gc.poll(lambda: self.node.lifts > lifts, 'the lift')
        return command

    def test_lift_is_held_by_ctrl_c_and_ctrl_z(self):
        for key in (signal.SIGINT, signal.SIGTSTP):
            self.node.stops.clear()
            command = self.start_lift()
            command.send(key)
            gc.poll(lambda: self.node.stops == [Stop.HOLD], 'the hold')
            self.node.set(GrinderState.READY, 'ready')
            self.assertEqual(command.end(), 1)
            self.assertEqual(command.text, "the lift was stopped: the wheel is still in the work; 'grind lift' lifts it\n")

    def test_connection_to_a_service_is_the_clients_to_close(self):
        # Where the server closes it after its answer, roscpp may see the end before it reads the answer.
        server = socketserver.ThreadingTCPServer(('127.0.0.1', 0), FeedOverride)
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        threading.Thread(target=server.serve_forever).start()
        master = rosgraph.Master(rospy.get_name())
        registered = '/grinder/set_feed_override', 'rosrpc://127.0.0.1:%d' % server.server_address[1]
        master.registerService(*registered, rospy.get_node_uri())
        self.addCleanup(master.unregisterService, *registered)
        done = gc.grind('override', '50')
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        self.assertEqual([b'persistent=1' in header for header in FeedOverride.headers], [True])

    def test_fault_amid_a_lift(self):
        command = self.start_lift()
        self.node.set(GrinderState.FAULT, 'fault', fault='emergency stop')
        self.assertEqual((command.end(), command.text), (1, 'emergency stop\n'))
