"""Reads the bags that `roslaunch flute_grinder grinder.launch record:=true` writes."""

import io
import struct
from datetime import datetime, timezone

import genpy
import numpy as np

from actionlib_msgs.msg import GoalStatus
from bag_file import BagFile
from diagnostic_msgs.msg import DiagnosticArray
from flute_grinder.msg import GrindActionGoal, GrindActionResult, GrinderState, MachineInfo, SetpointBatch, WorkOffsets
from record import BLOCK, DEG, MM, MS, ROW, STILL, UM, Record, SourceError

KINDS = {kind._type: kind for kind in (SetpointBatch, GrinderState, GrindActionGoal, GrindActionResult, MachineInfo, WorkOffsets, DiagnosticArray)}

OUTCOMES = {GoalStatus.SUCCEEDED: 'done', GoalStatus.PREEMPTED: 'canceled', GoalStatus.ABORTED: 'fault'}


def read_bag(path, job):
    """The record of one job of a bag. `job` counts from 1, 0 is the last. @raise SourceError, OSError"""
    try:
        with open(path, 'rb') as file:
            bag = BagFile(file)
            reader = BagReader(bag.kinds, job)
            for kind, data in bag.messages(reader.topics):
                reader.take[kind](data)
        return reader.finish()
    except (KeyError, genpy.DeserializationError, struct.error) as error:
        raise SourceError('the bag cannot be read: %s' % error)


def decoded(kind, data):
    message = kind()
    message.deserialize(data)
    return message


def stamp_of(data, offset):
    seconds, nanoseconds = struct.unpack_from('<II', data, offset)
    return seconds + 1e-9 * nanoseconds


def string_of(data, offset):
    """A string and the offset behind it."""
    length, = struct.unpack_from('<I', data, offset)
    return data[offset + 4:offset + 4 + length].decode(errors='replace'), offset + 4 + length


def behind_names(data):
    """Offsets in a GrinderState on the wire: of the state, and behind the state's name."""
    _, state = string_of(data, 12)
    return state, string_of(data, state + 1)[1]


def distance_of_override():
    """From behind the state's name, by the message's definition [bytes]."""
    mark, wire = 8 * b'\x01', io.BytesIO()
    GrinderState(override=struct.unpack('<d', mark)[0]).serialize(wire)
    data = wire.getvalue()
    return data.index(mark) - behind_names(data)[1]


OVERRIDE = distance_of_override()


def iso(seconds):
    """A point in time as text, in UTC."""
    return datetime.fromtimestamp(seconds, timezone.utc).isoformat(timespec='milliseconds').replace('+00:00', 'Z')


def by_axis(values, linear, rotary, units=(MM, DEG)):
    """The values of the axes by their names in a unit, e.g. x_mm ... a_deg."""
    names = ['%s_%s' % (axis, linear) for axis in 'xyz'] + ['a_' + rotary]
    return {name: float(value) / unit for name, value, unit in zip(names, values, [units[0]] * 3 + [units[1]])}


class BagReader:
    def __init__(self, kinds, job):
        batches = [topic for topic, (kind, _) in kinds.items() if kind == SetpointBatch._type]
        if len(batches) != 1:
            raise SourceError('the bag has setpoints (%s) on %s; allowed: one topic'
                              % (SetpointBatch._type, ', '.join(sorted(batches)) or 'no topic'))
        self._node = batches[0][:-len('setpoints')]
        self.topics = {topic for topic, (kind, _) in kinds.items()
                       if kind in KINDS and topic.startswith(self._node) or kind == DiagnosticArray._type}
        for topic in self.topics:
            kind, digest = kinds[topic]
            if digest != KINDS[kind]._md5sum:
                raise SourceError('%s has another definition of %s than this program' % (topic, kind))
        self._job = job
        self._jobs = []  # goal ids
        self._batches, self._count = [], 0  # (first, last stamp, data, offset of the setpoints, number of them), their number
        self._start = self._end = None  # when cycle 0 and the last one were [s]
        self._states, self._overrides, self._offsets = [], [], []
        self._last_names, self._goal = b'?', ''  # frame and goal of the last batch, as on the wire
        self._last_state = None
        self._machine = None
        self._names, self._results = {}, {}  # of jobs by goal id
        self._diagnostics = {}
        self._record = Record('bag')
        self.take = {SetpointBatch._type: self._take_batch, GrinderState._type: self._take_state,
                     GrindActionGoal._type: self._take_goal,
                     GrindActionResult._type: self._take_result, MachineInfo._type: self._take_machine,
                     WorkOffsets._type: self._take_offsets, DiagnosticArray._type: self._take_diagnostics}

    def _take_batch(self, data):
        if not data.startswith(self._last_names, 12):
            _, offset = string_of(data, 12)
            self._goal, offset = string_of(data, offset)
            self._last_names = data[12:offset]
        goal, offset = self._goal, 12 + len(self._last_names)
        seconds, nanoseconds, period, _, count = struct.unpack_from('<IIdQI', data, offset)
        begin, end = stamp_of(data, 4), seconds + 1e-9 * nanoseconds
        if not self._jobs or goal != self._jobs[-1]:
            self._jobs.append(goal)
            if self._job in (0, len(self._jobs)):
                self._batches, self._count = [], 0
                self._record.restart()
                self._record.period = period
                self._start = begin - struct.unpack_from('<Q', data, offset + 28)[0] * period
        if self._job not in (0, len(self._jobs)):
            return
        self._end = end
        self._batches.append((begin, end, data, offset + 28, count))
        self._count += count
        if self._count >= BLOCK:
            self._append()

    def _append(self):
        """Hands the batches collected to the record."""
        if not self._count:
            return
        begin, end, data, offsets, counts = zip(*self._batches)
        # Decoded by numpy: genpy takes a hundred times as long.
        rows = np.frombuffer(b''.join(d[o:o + n * ROW.itemsize] for d, o, n in zip(data, offsets, counts)), ROW)
        begin, counts = np.array(begin), np.array(counts)
        # A batch is a few hundredths of a second: between its ends the cycles are evenly spaced.
        step = (np.array(end) - begin) / np.maximum(counts - 1, 1)
        place = np.arange(self._count) - np.repeat(np.cumsum(counts) - counts, counts)
        self._batches, self._count = [], 0
        self._record.append(rows, np.repeat(begin - self._start, counts) + place * np.repeat(step, counts))

    def _take_state(self, data):
        state, behind = behind_names(data)
        # Decoded only where one of these has changed: genpy takes its time.
        key = data[state], data[behind + OVERRIDE:behind + OVERRIDE + 8]
        if key == self._last_state:
            return
        self._last_state = key
        message = decoded(GrinderState, data)
        at = message.header.stamp.to_sec(), message.tooth, message.pass_
        state = message.state_name, message.fault or message.hold_reason
        if not self._states or state != self._states[-1][1:3]:
            self._states.append((at[0], *state, *at[1:]))
        if not self._overrides or message.override != self._overrides[-1][1]:
            self._overrides.append((at[0], message.override, *at[1:]))

    def _take_goal(self, data):
        message = decoded(GrindActionGoal, data)
        self._names[message.goal_id.id] = message.goal.job_name

    def _take_result(self, data):
        message = decoded(GrindActionResult, data)
        self._results[message.status.goal_id.id] = message

    def _take_machine(self, data):
        self._machine = decoded(MachineInfo, data)

    def _take_offsets(self, data):
        message = decoded(WorkOffsets, data)
        self._offsets.append((message.header.stamp.to_sec(), message.values))

    def _take_diagnostics(self, data):
        offset = 16 + struct.unpack_from('<I', data, 12)[0]
        statuses, = struct.unpack_from('<I', data, offset)
        offset += 4
        for _ in range(statuses):
            level = data[offset]
            name, offset = string_of(data, offset + 1)
            message, offset = string_of(data, offset)
            offset += 4 + struct.unpack_from('<I', data, offset)[0]  # hardware id
            values, = struct.unpack_from('<I', data, offset)
            offset += 4
            for _ in range(2 * values):
                offset += 4 + struct.unpack_from('<I', data, offset)[0]
            worst, text, count = self._diagnostics.get(name, (-1, '', 0))
            if level > worst:
                worst, text, count = level, message, 0
            self._diagnostics[name] = (worst, text, count + (level == worst))

    def finish(self):
        record, jobs = self._record, self._jobs
        if not jobs:
            raise SourceError('the bag has no setpoints: no job ran while it was recorded')
        if self._job > len(jobs):
            raise SourceError('--job %d: the bag has %d job(s)' % (self._job, len(jobs)))
        self._append()
        record.finish()
        number = self._job or len(jobs)
        record.head = self._head(number)
        record.states = [(stamp - self._start, *rest) for stamp, *rest in self._span(self._states)]
        record.overrides = [(stamp - self._start, *rest) for stamp, *rest in self._span(self._overrides) if stamp < self._end]
        record.diagnostics = [(name, *self._diagnostics[name]) for name in sorted(self._diagnostics)]
        return record

    def _head(self, number):
        goal = self._jobs[number - 1]
        head = {'grinder': self._node.rstrip('/') if self._node.startswith('/') else '/' + self._node.rstrip('/'),
                'job_name': self._names.get(goal, ''), 'in_bag': '%d of %d, goal %s' % (number, len(self._jobs), goal),
                'started': iso(self._start), 'ended': iso(self._end)}
        if self._machine:
            head['machine'] = machine_head(self._machine)
        offsets = [values for stamp, values in self._offsets if stamp <= self._start]
        if offsets:
            head['work_offsets'] = by_axis(offsets[-1], 'mm', 'deg')
        result = self._results.get(goal)
        if result:
            statistics = result.result.statistics
            head['outcome'] = OUTCOMES.get(result.status.status, 'rejected')
            head['reason'] = result.result.error_string
            head['planned'] = {'setpoints': statistics.setpoints, 'duration_s': statistics.duration,
                               'max_deviation_um': statistics.max_deviation / UM,
                               'feed_limits': [{'cause': l.cause, 'from_x_mm': l.from_x / MM, 'to_x_mm': l.to_x / MM}
                                               for l in statistics.feed_limits]}
        return head

    def _span(self, events):
        """The events from that which was in force when the job began to the first after its end, and of states to the first in
        which it is not held any more."""
        before = [e for e in events if e[0] <= self._start]
        during = [e for e in events if self._start < e[0] < self._end]
        after = [e for e in events if e[0] >= self._end]
        still = next((i for i, e in enumerate(after) if e[1] not in STILL), len(after))
        return before[-1:] + during + after[:still + 1]


def machine_head(machine):
    return {'name': machine.name, 'software': machine.version, 'drive': machine.drive, 'period_ms': machine.period / MS,
            'max_velocity': by_axis(machine.max_velocity, 'mm_s', 'deg_s'),
            'max_acceleration': by_axis(machine.max_acceleration, 'mm_s2', 'deg_s2'),
            'max_following_error': by_axis(machine.max_following_error, 'mm', 'deg')}
