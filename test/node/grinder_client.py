"""What the tests share: jobs, the package's programs and files, and a client of the grinder that records all it says."""

import contextlib
import copy
import json
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
import unittest
import urllib.parse
import xml.etree.ElementTree as xml
from functools import lru_cache, partialmethod

import actionlib
import rosgraph
import roslib.packages
import rospkg
import rospy
import rosservice
import rosunit.xmlrunner
import yaml
from actionlib_msgs.msg import GoalStatus
from flute_grinder.msg import (GrindAction, GrindActionResult, GrinderState, GrindGoal, OffsetBasis, ProbeAction,
                               ProbeActionFeedback, ProbeGoal, Process, SetpointBatch, WrittenSetpoint)
from flute_grinder.srv import ConfirmSwivel, ConfirmWheel, InjectFault, SetFeedOverride, SetOffsets, TouchOff
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
from std_srvs.srv import Trigger

MM = 1e-3
MM_MIN = 1e-3 / 60
UM = 1e-6
DEG = math.pi / 180

X, Y, Z, A = range(4)
JOINTS = ['axis_x', 'axis_y', 'axis_z', 'axis_a']
MOVES = ['lift', 'index', 'position', 'approach', 'infeed', 'stroke', 'retract', 'return']
STEPS = ['none', 'odd', 'even']
LIFT, STROKE = MOVES.index('lift'), MOVES.index('stroke')
ODD, EVEN = WrittenSetpoint.ODD, WrittenSetpoint.EVEN

# Much longer than anything takes, even on a host that stalls.
PATIENCE = 120

# Found once: it takes a search of the whole clone.
PACKAGE = rospkg.RosPack().get_path('flute_grinder')


def add_sub_test(result, _test, sub_test, error):
    """rosunit counts a sub-test that fails, and would write nothing of it."""
    if error:
        result.addFailure(sub_test, (AssertionError, AssertionError('%s: %s' % (sub_test.id(), error[1])), error[2]))


def add_error(result, test, error):
    """rosunit counts what fails in setUpClass or setUpModule, which is no test, and would write nothing of it."""
    unittest.TestResult.addError(result, test, error)
    result._error = error
    if isinstance(test, unittest.TestCase):
        return
    # 'setUpModule (test_x)', of which rosunit wants to know the class.
    name = re.fullmatch(r'(\w+) \((.*)\)', test.id())
    test.id = lambda: '%s.%s' % (name[2], name[1])
    result._tests.append(rosunit.xmlrunner._TestInfo.create_error(test, 0, error))


rosunit.xmlrunner._XMLTestResult.addSubTest = add_sub_test
rosunit.xmlrunner._XMLTestResult.addError = add_error


def goal_of(job, **fields):
    """The action's goal of a job; `fields` are the goal's own, as dry_run=True. Whatever the journal keeps is forgotten,
    and the work offsets are right, unless they say otherwise. The job may be a goal of a file, too."""
    goal = copy.copy(job) if isinstance(job, GrindGoal) else GrindGoal()
    for name, value in dict({'answers': ['discard', 'ignore-offsets']}, **fields).items():
        setattr(goal, name, value)
    for path, value in () if isinstance(job, GrindGoal) else job.items():
        part, name = path.split('.')
        setattr(part_of(goal, part), name, value)
    return goal


def part_of(goal, part):
    """Where a goal has the fields of a part of a job: 'cutter', 'process' or 'interpolation'."""
    return process_of(goal) if part == 'process' else getattr(goal, part)


def process_of(goal):
    """The operation of a goal; of a new goal the only one, which is new, too."""
    goal.operations = goal.operations or [Process()]
    return goal.operations[goal.operation]


@lru_cache(None)
def program(name):
    """The path of one of the package's programs."""
    return roslib.packages.find_node('flute_grinder', name)[0]


def package_file(path):
    return PACKAGE + '/' + path


def grind(*arguments, environment=(), **options):
    """Runs the command line to its end."""
    pipe = subprocess.PIPE
    options = dict({'stdin': subprocess.DEVNULL, 'stdout': pipe, 'stderr': pipe, 'timeout': PATIENCE}, **options)
    return subprocess.run([program('grind'), *arguments], universal_newlines=True, env=dict(os.environ, **dict(environment)),
                          **options)


def temp_folder(clean_up):
    """A folder that goes with the test, the class or the module whose `clean_up` is given."""
    folder = tempfile.mkdtemp()
    clean_up(shutil.rmtree, folder)
    return folder


def reamer_file(path):
    """Writes jobs/taper_reamer_d6_t6.yaml to `path`, with reliefs that are over soon: in one pass each, at ten times the feed."""
    text = pathlib.Path(package_file('jobs/taper_reamer_d6_t6.yaml')).read_text()
    for old, new in (('feed_mm_min: 300', 'feed_mm_min: 3000'), (' infeed_mm: 0.1', ' infeed_mm: 2'), (' roughing_passes: 6', ' infeed_mm: 2'),
                     ('finish_infeed_mm: 0.01', 'finish_infeed_mm: 0'), ('../wheels', package_file('wheels')),
                     ('file: taper', 'file: ' + package_file('jobs/taper'))):
        assert old in text, old
        text = text.replace(old, new)
    pathlib.Path(path).write_text(text)
    return path


def end_file(path, name):
    """Writes a job of jobs/ to `path` without reliefs of the periphery, and with operations that are over soon: in one pass each."""
    jobs = package_file('jobs/')
    with open(jobs + name + '.yaml') as text:
        mill = yaml.safe_load(text)
    mill['operations'] = [operation for operation in mill['operations'] if operation['kind'] != 'relief']
    for operation in mill['operations']:
        operation.pop('roughing_passes', None)
        operation.update(feed_mm_min=1000, infeed_mm=6, finish_infeed_mm=0, spark_out=0, clearance_mm=1)
        for part in ('wheel', 'setup'):
            if 'file' in operation[part]:
                operation[part]['file'] = jobs + operation[part]['file']
    with open(path, 'w') as file:
        yaml.safe_dump(mill, file)
    return path


# The units by the endings of a file's keys, the numbers of its choices, and the fields of its pairs.
UNITS = {'mm_per_rad': MM, 'mm_min': MM_MIN, 'mm': MM, 'um': UM, 'deg': DEG}
CHOICES = {'cut': ['right_hand', 'left_hand'], 'order': ['tooth_major', 'pass_major'], 'direction': ['from_end', 'to_end'],
           'z_law': ['published', 'constant_rake'], 'wheel_side': ['upper', 'lower'],
           'wheel_profile': ['straight', 'angled', 'full_radius', 'cup', 'points'],
           'even_step': ['published', 'third_order', 'exact']}
PAIRS = {'overtravel': ('overtravel_end', 'overtravel_shank'),
         'wheel_corner_radius': ('wheel_corner_radius_lower', 'wheel_corner_radius_upper')}


def job_from_file(path):
    """What a job file says, with the names and in the units of the goal's fields, of which it has all."""
    with open(path) as text:
        file = yaml.safe_load(text)
    cutter, process = file['cutter'], file['process']
    wheel = process.pop('wheel')
    if 'file' in wheel:
        with open(os.path.join(os.path.dirname(path), wheel.pop('file'))) as text:
            wheel.update(yaml.safe_load(text))
        wheel.pop('flange_mm', None)  # for `grind zeros` alone
        measured = wheel.pop('measured', {})
        wheel['wear_mm'] = round((wheel['diameter_mm'] - measured.get('diameter_mm', wheel['diameter_mm'])) / 2, 9)
        wheel['width_mm'] = measured.get('width_mm', wheel['width_mm'])
    setup = process.pop('setup')
    if 'file' in setup:
        with open(os.path.join(os.path.dirname(path), setup['file'])) as text:
            setup = yaml.safe_load(text)['flute']
        setup.pop('solved_for')
        process.update((key, setup.pop(key)) for key in ('depth_mm', 'depth_end_mm', 'overtravel_mm'))
    teeth = cutter.pop('teeth', 0)
    cutter.setdefault('tooth_angles_deg', [i * 360.0 / teeth for i in range(teeth)])
    for part, values in (('wheel_', wheel), ('setup_', setup)):
        process.update((part + key, value) for key, value in values.items())

    goal = GrindGoal()
    job = {part + '.' + name: getattr(part_of(goal, part), name) for part in file for name in part_of(goal, part).__slots__}
    for part, values in file.items():
        for key, value in values.items():
            name, unit = re.fullmatch('(.*?)(?:_(%s))?' % '|'.join(UNITS), key).groups()
            if name in CHOICES:
                value = CHOICES[name].index(value)
            elif unit:
                value = [v * UNITS[unit] for v in value] if isinstance(value, list) else value * UNITS[unit]
            for field, of_field in zip(PAIRS[name], value) if name in PAIRS else [(name, value)]:
                assert part + '.' + field in job, key
                job[part + '.' + field] = of_field
    return job


# The paper's conical end mill; the names are those of the goal's fields.
PAPER = job_from_file(package_file('test/jobs/paper.yaml'))

# What any tool has.
ANY_TOOL = {'rake_tolerance_deg': 180, 'chordal_rake_tolerance_deg': 180, 'spiral_tolerance_deg': 180, 'core_diameter_mm': 0.01,
            'core_diameter_end_mm': 0.01, 'core_tolerance_mm': 100}

# The same for tests of the motion: shallow and with a short stroke, whatever tool comes out will do, and the shank is out of
# the wheel's way.
MOTION = dict(PAPER, **{
    'cutter.shank_diameter': 1 * MM,
    'cutter.rake_tolerance': 180 * DEG,
    'cutter.chordal_rake_tolerance': 180 * DEG,
    'cutter.spiral_tolerance': 180 * DEG,
    'cutter.core_diameter': 0.01 * MM,
    'cutter.core_diameter_end': 0.01 * MM,
    'cutter.core_tolerance': 100 * MM,
    'process.depth': 0.5 * MM,
    'process.infeed': 0.5 * MM,
    'process.overtravel_shank': 1 * MM,
    'process.incomplete_ok': True,
})


def paper(**changes):
    """The paper's job for tests of the motion, with other values: paper(feed=..., flute_length=...). A name of two is the process'."""
    job = dict(MOTION)
    for name, value in changes.items():
        paths = sorted((p for p in PAPER if p.endswith('.' + name)), key=lambda p: not p.startswith('process.'))
        job[paths[0]] = value
    return job


# Over soon.
SHORT = paper(flute_length=5 * MM, feed=3000 * MM_MIN, clearance=1 * MM)
# With a depth that changes along the flute, no pass is like another: it takes longer to plan than any test waits, of a node whose
# max_job_duration allows it.
ENDLESS = paper(feed=0.1 * MM_MIN, infeed=0.001 * MM, depth_end=1.59 * MM)


def job_file(path, **changes):
    """Writes test/jobs/paper.yaml to `path`; with other values, as feed_mm_min=60, for tests of the motion, like MOTION."""
    text = pathlib.Path(package_file('test/jobs/paper.yaml')).read_text()
    if changes:
        motion = dict(ANY_TOOL, shank_diameter_mm=1, depth_mm=0.5, infeed_mm=0.5, overtravel_mm='[1, 1]')
        changes = dict(motion, **changes)
        text = text.replace('  direction:', '  incomplete_ok: true\n  direction:')
    for key, value in changes.items():
        text, count = re.subn(r'(?m)^( +%s:) *(\[.*?\]|\{.*?\}|[^ #\n]+)' % key, r'\g<1> %s' % value, text)
        assert count == 1, key
    pathlib.Path(path).write_text(text)
    return path


def tcpros_header(fields):
    """A header of a connection between nodes, ahead of it its length."""
    lines = [('%s=%s' % item).encode() for item in fields.items()]
    body = b''.join(struct.pack('<I', len(line)) + line for line in lines)
    return struct.pack('<I', len(body)) + body


def receive(connection, length):
    """So many bytes, of a connection with a time-out too, for which MSG_WAITALL does not wait."""
    text = b''
    while len(text) < length:
        more = connection.recv(length - len(text))
        if not more:
            raise ConnectionError('the node has closed the connection')
        text += more
    return text


def listening(pid, protocol='tcp'):
    """The local addresses, as 127.0.0.1:11311, of all sockets on which a process listens."""
    sockets = subprocess.run(['ss', '-Hlnp', '--' + protocol], check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout
    return {line.split()[3] for line in sockets.splitlines() if 'pid=%d,' % pid in line}


def connect_to_service(name, kind, caller):
    """A connection for any number of requests, as bytes."""
    address = urllib.parse.urlparse(rosservice.get_service_uri(name))
    connection = socket.create_connection((address.hostname, address.port), timeout=PATIENCE)
    connection.sendall(tcpros_header({'service': name, 'md5sum': kind._md5sum, 'type': kind._type, 'callerid': caller,
                                      'persistent': '1'}))
    receive(connection, *struct.unpack('<I', receive(connection, 4)))
    return connection


def poll(condition, what, timeout=PATIENCE, interval=0.005):
    """Waits for a condition that nothing announces, and returns its value."""
    deadline = time.monotonic() + timeout
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            raise AssertionError('timed out waiting for: ' + what)
        time.sleep(interval)


def axes_of(joint_state):
    """The positions of the axes, X, Y, Z, A."""
    return tuple(joint_state.position[joint_state.name.index(name)] for name in JOINTS)


def publisher(clean_up, topic, kind, queue_size=10):
    """To somebody who listens."""
    made = rospy.Publisher(topic, kind, queue_size=queue_size, tcp_nodelay=True)
    clean_up(made.unregister)
    poll(lambda: made.get_num_connections() > 0, 'a subscriber of ' + topic)
    return made


def received(clean_up, topic, kind):
    """A list, to which is added what somebody publishes from now on."""
    messages = []
    subscriber = rospy.Subscriber(topic, kind, messages.append, queue_size=10000)
    clean_up(subscriber.unregister)
    poll(lambda: subscriber.get_num_connections() > 0, 'a publisher of ' + topic)
    return messages


class Run:
    """One goal, from sending it to its end, with all that came of it. The swivel is confirmed for it first, if it is to move
    and unless the test confirms it itself."""

    def __init__(self, grinder, goal, confirm=True):
        self._grinder = grinder
        if confirm and not goal.dry_run:
            # Refused during another job or if the drive measures it: then the goal's answer says so.
            grinder.confirm_swivel(process_of(goal).setup_swivel)
        self.feedback = []
        self.sent = time.time()
        self._handle = grinder.client.send_goal(goal, self._on_transition, self._on_feedback)
        self.id = self._handle.comm_state_machine.action_goal.goal_id.id

    def _on_transition(self, _):
        self._grinder.notify()

    def _on_feedback(self, _, feedback):
        self.feedback.append(feedback)
        self._grinder.notify()

    @property
    def batches(self):
        return [batch for batch in list(self._grinder.batches) if batch.goal_id == self.id]

    @property
    def setpoints(self):
        return [setpoint for batch in self.batches for setpoint in batch.setpoints]

    @property
    def done(self):
        return self._handle.get_comm_state() == actionlib.CommState.DONE

    @property
    def status(self):
        return GoalStatus.to_string(self._handle.get_terminal_state()) if self.done else 'not done'

    @property
    def result(self):
        return self._handle.get_result()

    @property
    def code(self):
        return self.result.error_code

    @property
    def text(self):
        return self.result.error_string

    def cancel(self):
        self._handle.cancel()

    def wait(self, timeout=PATIENCE):
        self._grinder.wait_for(lambda: self.done, 'the end of the goal', timeout)
        return self

    def wait_complete(self, timeout=PATIENCE):
        """Waits for the end and for all setpoints, which come by another connection."""
        self.wait(timeout)
        self._grinder.wait_for(lambda: len(self.setpoints) >= self.result.setpoints_written, 'all setpoints')
        return self

    @property
    def last(self):
        """The setpoint reported last, if there is one."""
        return next((batch.setpoints[-1] for batch in reversed(self._grinder.batches) if batch.goal_id == self.id), None)

    def wait_past(self, past, what):
        """Waits until the setpoint reported last is one that is wanted."""
        self._grinder.wait_for(lambda: self.done or self.last is not None and past(self.last), what)
        assert not self.done, 'the goal ended ahead of %s: %s %s' % (what, self.status, self.text)
        return self

    def wait_in_stroke(self, x):
        """Waits until the stroke is past x."""
        return self.wait_past(lambda s: s.move == STROKE and s.position[X] > x, 'the stroke at X = %g m' % x)


class Grinder:
    """A client of the grinder's node that records all it publishes."""

    def __init__(self, name='grinder', joint_states=None):
        self.name = name
        # What stands beside the node, in the same namespace.
        self.namespace = ('/' + name).rpartition('/')[0]
        self._changed = threading.Condition()
        self.states, self.batches, self.joints, self.results = [], [], [], []
        self.arrivals = []  # the times of the states
        self._subscribers = [
            self._record('/%s/state' % name, GrinderState, self.states, self.arrivals),
            self._record('/%s/setpoints' % name, SetpointBatch, self.batches),
            self._record(joint_states or self.namespace + '/joint_states', JointState, self.joints),
            self._record('/%s/grind/result' % name, GrindActionResult, self.results),
        ]
        self.client = actionlib.ActionClient('/%s/grind' % name, GrindAction)
        assert self.client.wait_for_server(rospy.Duration(PATIENCE)), 'no action server'
        self.wait_for(lambda: self.states and self.joints, 'state and joint states')
        poll(lambda: all(s.get_num_connections() > 0 for s in self._subscribers), 'connections')

    def _record(self, topic, kind, messages, arrivals=None):
        def on_message(message):
            with self._changed:
                messages.append(message)
                if arrivals is not None:
                    arrivals.append(time.monotonic())
                self._changed.notify_all()

        return rospy.Subscriber(topic, kind, on_message, queue_size=10000, buff_size=1 << 22, tcp_nodelay=True)

    def close(self):
        """Stops listening."""
        for subscriber in self._subscribers:
            subscriber.unregister()
        self.client.stop()

    def wait_end_of_connections(self):
        """Waits until all is here that a node had sent that has ended."""
        poll(lambda: all(s.get_num_connections() == 0 for s in self._subscribers), 'the end of the connections')

    def notify(self):
        with self._changed:
            self._changed.notify_all()

    def wait_for(self, condition, what, timeout=PATIENCE):
        """Waits for a condition of what is recorded, and returns its value."""
        deadline = time.monotonic() + timeout
        with self._changed:
            while True:
                value = condition()
                if value:
                    return value
                left = deadline - time.monotonic()
                if left <= 0:
                    raise AssertionError('timed out waiting for: ' + what)
                self._changed.wait(min(left, 0.1))

    def _call(self, service, kind, *arguments):
        name = '/%s/%s' % (self.name, service)
        rospy.wait_for_service(name, PATIENCE)
        return rospy.ServiceProxy(name, kind)(*arguments)

    def set_offset(self, axis, value, by='anna@grinder', basis=None, answers=('set-offset',)):
        return self.set_offsets([axis], [value], by, basis, answers)

    def set_offsets(self, axes, values, by='anna@grinder', basis=None, answers=('set-offset',)):
        return self._call('set_offsets', SetOffsets, axes, values, by, basis or OffsetBasis(), list(answers))

    def touch_off(self, axis, position, by='anna@grinder', basis=None, answers=('set-offset',)):
        return self._call('touch_off', TouchOff, axis, position, by, basis or OffsetBasis(), list(answers))

    enable = partialmethod(_call, 'enable', Trigger)
    disable = partialmethod(_call, 'disable', Trigger)
    home = partialmethod(_call, 'home', Trigger)
    hold = partialmethod(_call, 'hold', Trigger)
    resume = partialmethod(_call, 'resume', Trigger)
    retract = partialmethod(_call, 'retract', Trigger)
    lift = partialmethod(_call, 'lift', Trigger)
    spindle_on = partialmethod(_call, 'spindle_on', Trigger)
    spindle_off = partialmethod(_call, 'spindle_off', Trigger)
    reset = partialmethod(_call, 'reset_fault', Trigger)
    set_feed_override = partialmethod(_call, 'set_feed_override', SetFeedOverride)
    confirm_swivel = partialmethod(_call, 'confirm_swivel', ConfirmSwivel)
    confirm_wheel = partialmethod(_call, 'confirm_wheel', ConfirmWheel)

    def plan(self, goal):
        """The result of a dry run of a goal."""
        goal = copy.copy(goal)
        goal.dry_run = True
        return Run(self, goal).wait().result

    @contextlib.contextmanager
    def probing(self, within, cycle=ProbeGoal.END_FACE, **fields):
        """Has a probing cycle run for a client that repeats that it is alive. Gives the action's client, with its `feedback`."""
        client = actionlib.SimpleActionClient('/%s/probe' % self.name, ProbeAction)
        assert client.wait_for_server(rospy.Duration(PATIENCE)), 'no action server'
        with contextlib.ExitStack() as stack:
            alive = publisher(stack.callback, '/%s/probe_alive' % self.name, Header)
            stack.callback(rospy.Timer(rospy.Duration(0.05), lambda _: alive.publish(Header(stamp=rospy.Time.now()))).shutdown)
            # actionlib's client drops what comes after the result, which has a connection of its own.
            client.feedback = received(stack.callback, '/%s/probe/feedback' % self.name, ProbeActionFeedback)
            client.send_goal(ProbeGoal(cycle=cycle, within=within, **fields))
            yield client

    def probe(self, within, cycle=ProbeGoal.END_FACE, **fields):
        """The result of a probing cycle."""
        with self.probing(within, cycle, **fields) as client:
            assert client.wait_for_result(rospy.Duration(PATIENCE)), 'no result'
            return client.get_result()

    def injects_faults(self):
        """Whether the drive lets a test inject faults: only the simulated one does."""
        return rospy.get_param('/%s/hardware/type' % self.name) == 'flute_grinder/SimulatedDrive'

    def take_faults_back(self):
        """Ends what a test has injected."""
        if self.injects_faults():
            self.inject('none')

    def inject(self, fault, axis=X):
        """Injects a fault; skips the test on a drive that does not let it."""
        if not self.injects_faults():
            raise unittest.SkipTest('only the simulated drive lets a fault be injected')
        return self._call('hardware/inject_fault', InjectFault, fault, axis)

    def send(self, job, confirm=True, **fields):
        return Run(self, goal_of(job, **fields), confirm)

    def run(self, job, **fields):
        """Sends a job and waits for its end and all of its setpoints."""
        return self.send(job, **fields).wait_complete()

    def batches_of_goal(self, seen):
        """All setpoints of the goal that was the first to begin after `seen` batches, once it has ended and they are here:
        each client gets them by a connection of its own, and later than the result as may be."""

        def batches():
            before = {batch.goal_id for batch in self.batches[:seen]}  # of which some may still come
            new = [batch for batch in self.batches[seen:] if batch.goal_id not in before]
            return [batch for batch in new if batch.goal_id == new[0].goal_id]

        def complete():
            known = batches()
            results = [r.result for r in self.results if known and r.status.goal_id.id == known[0].goal_id]
            return results and sum(len(batch.setpoints) for batch in known) >= results[0].setpoints_written

        self.wait_for(complete, 'all setpoints')
        return batches()

    def limits(self):
        """What the axes may do, from the robot description and the parameters; each a list in axis order."""
        robot = xml.fromstring(rospy.get_param(self.namespace + '/robot_description'))
        parameters = rospy.get_param('/%s/joint_limits' % self.name)
        limits = {'min_position': [], 'max_position': [], 'max_velocity': [], 'max_acceleration': [], 'max_jerk': []}
        for joint in JOINTS:
            described = robot.find("joint[@name='%s']/limit" % joint)
            values = {'min_position': described.get('lower'), 'max_position': described.get('upper'),
                      'max_velocity': described.get('velocity')}
            values.update(parameters[joint])
            for name, of_axes in limits.items():
                of_axes.append(float(values[name]))
        return limits

    def period(self):
        return 1 / rospy.get_param('/%s/control_rate' % self.name)

    def park(self):
        park = rospy.get_param('/%s/park_position' % self.name)
        return [park[joint] for joint in JOINTS]

    def wait_fresh(self, condition, what):
        """Waits for a condition of the state, and returns that state: of one that has been waited for, after three others.
        Those that were under way at the call, on a busy host more than three, come without a gap."""
        seen = len(self.states)
        is_fresh = lambda: len(self.states) >= seen + 3 and self.arrivals[-1] - self.arrivals[-2] > 0.02
        return self.wait_for(lambda: is_fresh() and condition(self.states[-1]) and self.states[-1], what)

    def fresh_state(self):
        """The state as of now."""
        return self.wait_fresh(lambda _: True, 'messages of the state')

    def wait_state(self, state):
        """Waits for a state that lasts, and returns it."""
        return self.wait_fresh(lambda s: s.state == state, 'state %d' % state)

    def wait_power_off(self):
        """Waits for the state disabled with the power off, which the drive reports a cycle later."""
        return self.wait_fresh(lambda s: s.state == GrinderState.DISABLED and not s.enabled, 'the end of the power')

    def positions(self):
        """Of all axes, as reported last."""
        return list(axes_of(self.joints[-1]))

    def wait_rest(self):
        """Waits until the positions reported no longer change, and returns them."""

        seen = len(self.joints)

        def resting():
            new = self.joints[seen:]
            moved = [i for i, joint in enumerate(new) if joint.position != new[-1].position]
            still = new[moved[-1] + 1 if moved else 0:]
            return len(still) > 1 and (still[-1].header.stamp - still[0].header.stamp).to_sec() >= 0.1

        self.wait_for(resting, 'the axes at rest')
        return self.positions()

    def positions_over(self, seconds):
        """All positions reported from now on over a time, by the messages' own stamps."""
        first = len(self.joints)
        self.wait_for(lambda: len(self.joints) > first + 1 and
                      (self.joints[-1].header.stamp - self.joints[first].header.stamp).to_sec() >= seconds,
                      'joint states')
        return [axes_of(joint) for joint in self.joints[first:]]

    def make_ready(self, override=1):
        """Takes the machine from any state to ready, homed and at rest, with the swivel set for the paper's job. With a low
        feed override, which holds for strokes alone, there is time to interfere in a stroke, even on a host that stalls."""
        self.client.cancel_all_goals()
        self.take_faults_back()
        assert self.set_feed_override(override).success

        def ready():
            """Whether it is; otherwise requests the next step, if there is one to request in this state."""
            state = self.fresh_state()
            if state.state == GrinderState.FAULT:
                self.reset()
            elif state.state == GrinderState.DISABLED:
                self.enable()
            elif state.state == GrinderState.READY and state.wheel_in_work:
                self.lift()
            elif state.state == GrinderState.READY and not state.homed:
                self.home()
            else:
                return state.state == GrinderState.READY
            return False

        poll(ready, 'the machine ready')
        self.wait_for(self.has_last_setpoints, 'the last setpoints of the goal before')
        self.confirm_swivel(PAPER['process.setup_swivel'])
        return self.wait_rest()

    def has_last_setpoints(self):
        """Whether all setpoints are here of the goal that ended last: on a busy host they come later than its result."""
        last = next((r for r in reversed(self.results) if r.result.setpoints_written > 0), None)
        return last is None or any(batch.goal_id == last.status.goal_id.id and
                                   batch.setpoints[-1].cycle == last.result.setpoints_written - 1
                                   for batch in reversed(self.batches))

    def make_ready_at_park(self):
        """The same, where a job ends, as `grind plan` takes it to start."""
        if any(abs(p - park) > 1e-6 for p, park in zip(self.make_ready(), self.park())):
            assert self.run(SHORT).status == 'SUCCEEDED'
        return self.wait_rest()


@lru_cache(None)
def grinder():
    """The client of the grinder that the launch file has started, one for all tests."""
    return Grinder()


@lru_cache(None)
def yaml_file(path):
    """What a file of the package says, not to be changed."""
    with open(package_file(path)) as text:
        return yaml.safe_load(text)


def shipped_machine():
    """The machine's parameters as shipped."""
    return copy.deepcopy(yaml_file('config/grinder.yaml'))


def machine(pace=1):
    """The same on a host that may stall, without a blank that a jog would touch. Simulated time runs `pace` times as fast as the
    clock; what a test interferes with in a stroke is then to have a feed that is as much lower."""
    parameters = dict(shipped_machine(), **copy.deepcopy(yaml_file('test/patient.yaml')))
    del parameters['hardware']['blank']
    if pace != 1:
        parameters['hardware']['pace'] = pace
    return parameters


def machine_file(path, **changes):
    """Writes machine(), with some other values, for the launch file's `config`."""
    with open(path, 'w') as file:
        yaml.safe_dump(dict(machine(), **changes), file)
    return path


def plugin_package(folder, of, library, plugin, base):
    """Makes of a folder a ROS package with a plugin of the package `of`, and gives the environment in which it is found: the
    class `plugin` of this build's `library` under the name tested/Plugin."""
    pathlib.Path(folder, 'package.xml').write_text("""<package format="2">
  <name>tested</name>
  <version>0.1.0</version>
  <description>A plugin of tests.</description>
  <maintainer email="me@example.org">Me</maintainer>
  <license>BSD-3-Clause</license>
  <depend>%s</depend>
  <export>
    <%s plugin="${prefix}/plugins.xml"/>
  </export>
</package>
""" % (of, of))
    pathlib.Path(folder, 'plugins.xml').write_text("""<library path="lib/libflute_grinder_%s">
  <class name="tested/Plugin" type="%s" base_class_type="%s">
    <description>Of tests.</description>
  </class>
</library>
""" % (library, plugin, base))
    return {'ROS_PACKAGE_PATH': folder + ':' + os.environ['ROS_PACKAGE_PATH']}


class NodeProcess:
    """A grinder's node with parameters of its own, and with files of its own unless the parameters name them."""

    def __init__(self, name, parameters, arguments=(), environment=(), output=None):
        """`output`: a file for what it prints, in place of one of its own."""
        self.name = name
        self.folder = tempfile.mkdtemp()
        if rospy.has_param('/' + name):
            rospy.delete_param('/' + name)
        if parameters:
            parameters = dict({'journal': os.path.join(self.folder, 'journal'),
                               'offsets': os.path.join(self.folder, 'offsets'),
                               'history': os.path.join(self.folder, 'history'),
                               'tolerances': package_file('config/tolerances.yaml')}, **parameters)
            parameters = {key: value for key, value in parameters.items() if value is not None}
            rosgraph.Master(rospy.get_name()).setParam('/' + name, parameters)
        # Not a pipe, which would have to be emptied.
        self.log = tempfile.TemporaryFile('w+')
        self.process = subprocess.Popen([program('grinder'), '__name:=' + name,
                                         'joint_states:=/%s/joint_states' % name, *arguments],
                                        env=dict(os.environ, **dict(environment)),
                                        stdout=self.log if output is None else output, stderr=subprocess.STDOUT)

    def client(self):
        return Grinder(self.name, '/%s/joint_states' % self.name)

    @property
    def output(self):
        self.log.seek(0)
        return self.log.read()

    def end(self, with_signal=None):
        """Waits for the end of the process, after a signal or by itself, and returns its exit status."""
        if with_signal:
            self.process.send_signal(with_signal)
        try:
            return self.process.wait(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise

    def close(self):
        """Ends the process and forgets it; once more does nothing."""
        if self.log.closed:
            return
        if self.process.poll() is None:
            self.end(signal.SIGTERM)
        self.log.close()
        shutil.rmtree(self.folder)
        if rospy.has_param('/' + self.name):
            rospy.delete_param('/' + self.name)


class OwnNode(unittest.TestCase):
    """Tests with nodes of their own, each of another name, since the master remembers those that were killed."""

    started = 0

    def start(self, parameters, clean_up=None, **arguments):
        """Starts a node, and gives its client; both are closed after the test, or by another way to clean up."""
        OwnNode.started += 1
        self.node = NodeProcess('own_%d' % OwnNode.started, parameters, **arguments)
        (clean_up or self.addCleanup)(self.node.close)
        self.client = self.node.client()
        (clean_up or self.addCleanup)(self.client.close)
        return self.client

    def grind(self, status, *arguments, **options):
        done = grind('--node', self.node.name, *arguments, **options)
        self.assertEqual(done.returncode, status, '%s: %s\n%s' % (arguments, done.stdout, done.stderr))
        return done

    def said(self, *arguments):
        """What a command prints that succeeds and has nothing to warn of."""
        done = self.grind(0, *arguments)
        self.assertEqual(done.stderr, '', arguments)
        return done.stdout

    def json(self, *arguments):
        return json.loads(self.said(*arguments, '--json'))


class SlowDisk:
    """A disk that can be stopped, for a node that is started with its `environment`; see slow_fsync.c."""

    def __init__(self, folder):
        self._seconds = os.path.join(folder, 'seconds')
        library = os.path.join(os.path.dirname(os.path.dirname(program('grinder'))), 'libflute_grinder_slow_fsync.so')
        self.environment = {'LD_PRELOAD': library, 'SLOW_FSYNC': self._seconds}

    def stop(self, what='', seconds=1e6):
        """`what`: all that is synchronized, or `folders` alone. `seconds` that each takes."""
        with open(self._seconds, 'w') as file:
            file.write('%g %s' % (seconds, what))

    def release(self):
        """Once more does nothing."""
        with contextlib.suppress(FileNotFoundError):
            os.remove(self._seconds)
