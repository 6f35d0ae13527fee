"""Reads the bags that `roslaunch flute_grinder grinder.launch record:=true` writes. Decodes messages by
the definitions stored in the bag."""

import struct

import genpy
import numpy as np
import rosbag

from record import ROW, Record, SourceError

BATCH = 'flute_grinder/SetpointBatch'
STATE = 'flute_grinder/GrinderState'
RESULT = 'flute_grinder/GrindActionResult'
DIAGNOSTICS = 'diagnostic_msgs/DiagnosticArray'


def read_bag(path, job):
    """The record of one job of a bag. `job` counts from 1, 0 is the last. @raise SourceError, OSError"""
    try:
        with rosbag.Bag(path) as bag:
            reader = BagReader(bag, job)
            for _, message, _ in bag.read_messages(topics=reader.topics):
                reader.take(message)
        return reader.finish()
    except rosbag.ROSBagUnindexedException:
        raise SourceError('the bag was not closed, or is cut off; "rosbag reindex" saves what is in it')
    except (rosbag.ROSBagException, genpy.DeserializationError, struct.error) as error:
        raise SourceError('the bag cannot be read: %s' % error)


class BagReader:
    def __init__(self, bag, job):
        topics = {name: info.msg_type for name, info in bag.get_type_and_topic_info().topics.items()}
        batches = [name for name, kind in topics.items() if kind == BATCH]
        if len(batches) != 1:
            raise SourceError('the bag has setpoints (%s) on %s; allowed: one topic'
                              % (BATCH, ', '.join(sorted(batches)) or 'no topic'))
        node = batches[0][:-len('setpoints')]
        self.topics = [name for name, kind in topics.items()
                       if kind in (BATCH, STATE, RESULT) and name.startswith(node) or kind == DIAGNOSTICS]
        self._job = job
        self._jobs = []  # goal ids
        self._start = self._end = None  # when cycle 0 and the last one were [s]
        self._states = []
        self._results = {}
        self._diagnostics = {}
        self._record = Record('bag')
        self._take = {BATCH: self._take_batch, STATE: self._take_state, RESULT: self._take_result,
                      DIAGNOSTICS: self._take_diagnostics}

    def take(self, message):
        self._take[message._type](message)

    def _take_batch(self, batch):
        if not self._jobs or batch.goal_id != self._jobs[-1]:
            self._jobs.append(batch.goal_id)
            if self._job in (0, len(self._jobs)):
                self._record.restart()
                self._record.period = batch.period
                self._start = batch.header.stamp.to_sec() - batch.setpoints[0].cycle * batch.period
        if self._job not in (0, len(self._jobs)):
            return
        self._end = batch.end_stamp.to_sec()
        self._record.append(np.array(
            [(s.cycle, s.position, s.path_error, s.feed, s.move, s.step, s.tooth, s.pass_, s.actual, s.cycle_period)
             for s in batch.setpoints], ROW))

    def _take_state(self, message):
        state = (message.state_name, message.fault or message.hold_reason)
        if not self._states or state != self._states[-1][1:]:
            self._states.append((message.header.stamp.to_sec(), *state))

    def _take_result(self, message):
        self._results[message.status.goal_id.id] = message.result

    def _take_diagnostics(self, message):
        for status in message.status:
            level, text, count = self._diagnostics.get(status.name, (-1, '', 0))
            if status.level > level:
                level, text, count = status.level, status.message, 0
            self._diagnostics[status.name] = (level, text, count + (status.level == level))

    def finish(self):
        record, jobs = self._record, self._jobs
        if not jobs:
            raise SourceError('the bag has no setpoints: no job ran while it was recorded')
        if self._job > len(jobs):
            raise SourceError('--job %d: the bag has %d job(s)' % (self._job, len(jobs)))
        number = self._job or len(jobs)
        record.finish()
        record.facts.append(('job', '%d of %d in the bag, goal %s' % (number, len(jobs), jobs[number - 1])))
        result = self._results.get(jobs[number - 1])
        if result:
            record.facts.append(('outcome', result.error_string or 'done'))
            record.max_deviation = result.statistics.max_deviation
        record.states = [(stamp - self._start, state, reason) for stamp, state, reason in self._span()]
        record.diagnostics = [(name, *self._diagnostics[name]) for name in sorted(self._diagnostics)]
        return record

    def _span(self):
        """The states from that in which the job began to that after its end."""
        before = [s for s in self._states if s[0] <= self._start]
        during = [s for s in self._states if self._start < s[0] < self._end]
        after = [s for s in self._states if s[0] >= self._end]
        return before[-1:] + during + after[:1]
