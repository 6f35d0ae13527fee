#!/usr/bin/env python3
"""How many frames a second rviz draws of the machine alone, and of a job of 10 teeth and 20 passes planned and running, and
what a frame costs on all cores together. `scripts/bench_rviz` runs it on a screen of its own, drawn by software."""

import math
import os
import sys
import time
import xmlrpc.client

import rosgraph
import rospkg
import rospy
from std_srvs.srv import Trigger

sys.path.insert(0, rospkg.RosPack().get_path('flute_grinder') + '/test/node')
import grinder_client as gc  # noqa: E402
from grinder_client import DEG, MM, STROKE  # noqa: E402

# A steep helix on a slender cutter, whose flutes take many points.
JOB = gc.paper(end_diameter=6 * MM, cone_angle=0, spiral_angle=45 * DEG, flute_length=40 * MM,
               tooth_angles=[i * 2 * math.pi / 10 for i in range(10)], depth=2 * MM, infeed=0.1 * MM, even_step=1)


def processor_time(pid):
    """Of a process with all its threads [s]."""
    with open('/proc/%d/stat' % pid) as text:
        fields = text.read().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10
    rospy.init_node('bench_rviz')
    rospy.wait_for_service('/rviz/report', gc.PATIENCE)
    report = rospy.ServiceProxy('/rviz/report', Trigger, persistent=True)

    node = rosgraph.Master(rospy.get_name()).lookupNode('/rviz')
    pid = xmlrpc.client.ServerProxy(node).getPid(rospy.get_name())[2]

    def now():
        return int(report().message.split()[1]), time.monotonic(), processor_time(pid)

    def measure(what):
        before = now()
        rospy.sleep(seconds)
        frames, wall, processor = [b - a for a, b in zip(before, now())]
        print('%-16s %5.1f frames/s %5.1f ms of processor time each' % (what, frames / wall, 1e3 * processor / frames),
              flush=True)

    grinder = gc.Grinder()
    grinder.make_ready()
    measure('machine alone')
    plan = grinder.send(JOB, dry_run=True).wait()
    assert plan.status == 'SUCCEEDED', plan.text
    measure('job planned')
    run = grinder.send(JOB)
    run.wait_past(lambda s: s.move == STROKE and s.pass_ == 1, 'the second pass')
    measure('job running')
    run.cancel()
    run.wait()


if __name__ == '__main__':
    main()
