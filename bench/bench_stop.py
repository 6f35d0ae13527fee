#!/usr/bin/env python3
"""From the moment in which a client sends a stop to the first setpoint that is slower for it, by the loop's own times,
alone and under load; beside it, how late this computer wakes a thread that sleeps.

The load is all of it at once: a disk whose fsync takes 5 s, a pipe for the log that nobody reads, 1000 goals and
calls a second that are refused, a client that takes every marker and one that is stopped, and a
process that computes. `scripts/bench_stop` runs it."""

import contextlib
import multiprocessing
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import rospkg
import rospy
from actionlib_msgs.msg import GoalID

sys.path.insert(0, rospkg.RosPack().get_path('flute_grinder') + '/test/node')
import grinder_client as gc  # noqa: E402
from flute_grinder.msg import GrindActionGoal, GrinderState, Stop  # noqa: E402
from grinder_client import MM, MM_MIN, STROKE, X  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

NODE = 'stopped'
CALLS_PER_SECOND = 500  # and as many goals
# A minute of stroke and more, at a steady speed.
LONG = gc.paper(feed=30 * MM_MIN, clearance=1 * MM)


def send_goals():
    rospy.init_node('goals')
    publisher = rospy.Publisher('/%s/grind/goal' % NODE, GrindActionGoal, queue_size=1000)
    message = GrindActionGoal(goal=gc.goal_of(gc.SHORT))
    rate = rospy.Rate(CALLS_PER_SECOND)
    for number in range(1 << 30):
        message.goal_id = GoalID(id='load-%d' % number)
        publisher.publish(message)
        rate.sleep()


def call_services():
    rospy.init_node('calls')
    call = rospy.ServiceProxy('/%s/enable' % NODE, Trigger, persistent=True)
    rate = rospy.Rate(CALLS_PER_SECOND)
    while True:
        call()
        rate.sleep()


def compute():
    while True:
        pass


@contextlib.contextmanager
def load(disk):
    disk.stop(seconds=5)
    stopped = subprocess.Popen(['rostopic', 'echo', '/%s/setpoints' % NODE], stdout=subprocess.DEVNULL)
    markers = subprocess.Popen(['rostopic', 'echo', '/%s/tool_path' % NODE], stdout=subprocess.DEVNULL)
    tasks = [send_goals, call_services, compute]
    workers = [multiprocessing.get_context('spawn').Process(target=task) for task in tasks]
    for worker in workers:
        worker.start()
    time.sleep(3)  # until all are at it
    stopped.send_signal(signal.SIGSTOP)
    try:
        yield
    finally:
        for worker in workers:
            worker.kill()
            worker.join()
        for process in (stopped, markers):
            process.kill()
            process.wait()
        disk.release()


def setpoint_times(run):
    """Every setpoint reported, with the time of the cycle that wrote it."""
    for batch in run.batches:
        at = batch.header.stamp.to_sec()
        for i, setpoint in enumerate(batch.setpoints):
            at += setpoint.cycle_period if i else 0
            yield at, setpoint


def first_slower(run, sent, speed):
    """When the first setpoint was written after the stop that is slower than the stroke's speed; None for none yet."""
    return next((at for at, s in setpoint_times(run)
                 if at > sent and s.move == STROKE and abs(s.velocity[X]) < 0.999 * speed), None)


class Stops:
    """Stops a job in a long stroke, and has it go on, over and over."""

    def __init__(self, grinder):
        self.grinder = grinder
        self.topic = rospy.Publisher('/%s/stop' % NODE, Stop, queue_size=1, tcp_nodelay=True)
        gc.poll(lambda: self.topic.get_num_connections() > 0, 'a subscriber of the stop')
        self.service = rospy.ServiceProxy('/%s/hold' % NODE, Trigger, persistent=True)
        self.run = None

    def time(self, stop):
        if self.run is None or self.run.done or self.run.last.position[X] > 25 * MM:
            self.begin()
        grinder, run = self.grinder, self.run
        grinder.batches[:-2] = []  # what has been looked at
        speed = abs(run.last.velocity[X])
        sent = time.time()
        stop()
        grinder.wait_for(lambda: run.done or first_slower(run, sent, speed), 'the stop')
        taken = first_slower(run, sent, speed) - sent
        grinder.wait_for(lambda: grinder.states[-1].state == GrinderState.HELD, 'the rest')
        del grinder.states[:-1]
        assert grinder.resume().success
        run.wait_past(lambda s: s.move == STROKE and abs(s.velocity[X]) > 0.9999 * speed, 'the speed')
        return taken

    def begin(self):
        self.grinder.make_ready()
        self.run = self.grinder.send(LONG).wait_in_stroke(1 * MM)


def wake_ups(count=2000):
    """How late a thread is woken that sleeps for a millisecond."""
    late = []
    for _ in range(count):
        due = time.monotonic() + 1e-3
        time.sleep(1e-3)
        late.append(time.monotonic() - due)
    return late


def show(load_name, what, times):
    milliseconds = sorted(t * 1e3 for t in times)
    print('%-8s %-38s %5d  median %7.2f ms  p99 %7.2f ms  worst %7.2f ms' % (
        load_name, what, len(times), statistics.median(milliseconds), milliseconds[int(0.99 * (len(times) - 1))],
        milliseconds[-1]), flush=True)


def measure(name, stops, count):
    show(name, 'hold by the topic ~stop', [stops.time(lambda: stops.topic.publish(Stop(request=Stop.HOLD)))
                                          for _ in range(count)])
    show(name, 'hold by the service ~hold', [stops.time(stops.service) for _ in range(count)])
    show(name, "the computer's own wake-up", wake_ups())


def main():
    count = int(sys.argv[1])
    rospy.init_node('bench_stop')
    disk = gc.SlowDisk(tempfile.mkdtemp())
    parameters = gc.machine()
    parameters['hardware']['spindle_run_up_time'] = 0.0
    _, log = os.pipe()
    node = gc.NodeProcess(NODE, parameters, output=log, environment=disk.environment)
    stops = Stops(node.client())
    try:
        measure('idle', stops, count)
        with load(disk):
            measure('loaded', stops, count)
    finally:
        node.close()


if __name__ == '__main__':
    main()
