#!/usr/bin/env python3
"""How many frames a second rviz draws of the machine alone, and of a tool of 8 teeth planned and being ground, and what
they cost on all cores together. `scripts/bench_rviz` runs it on a screen of its own, drawn by software."""

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
from grinder_client import STROKE  # noqa: E402

JOB = gc.job_from_file(gc.package_file('jobs/finishing_d20_t8.yaml'))


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
        print('%-16s %5.1f frames/s, %3.0f %% of a core, %5.1f ms each'
              % (what, frames / wall, 100 * processor / wall, 1e3 * processor / frames), flush=True)

    grinder = gc.Grinder()
    grinder.make_ready()
    measure('machine alone')
    plan = grinder.send(JOB, dry_run=True).wait()
    assert plan.status == 'SUCCEEDED', plan.text
    measure('job planned')
    run = grinder.send(JOB)
    run.wait_past(lambda s: s.move == STROKE, 'the first stroke')
    measure('job running')
    run.cancel()
    run.wait()


if __name__ == '__main__':
    main()
