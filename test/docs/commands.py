#!/usr/bin/env python3
"""Looks through README.md and docs/*.md for commands that test_docs.py neither runs nor leaves out for a reason, and for reasons of
commands that are not there. Prints them; exits with 1 if there are some."""

import os
import re
import sys

from links import PAGES, ROOT
from pages import COMMAND, read_page

# What no test can run, and why. Each must stand in the documentation, and nothing else may be left out.
NOT_RUN = {
    'scripts/setup': 'installs packages; every test begins with it',
    'scripts/test': 'runs this test',
    'scripts/setup --run': 'installs packages; scripts/demo begins with a part of it',
    'scripts/test_on 13': 'installs a system for an hour',
    'scripts/test_on 11': 'installs a system for an hour',
    'scripts/test_on 11 --gcc 9': 'installs a system for an hour',
    'source /opt/ros/noetic/setup.bash': 'is for Ubuntu; test/workspace.sh sources what there is',
    'cd ~/catkin_ws': 'is for a workspace; test/workspace.sh has one',
    'rosdep install --from-paths src --ignore-src -y': 'installs packages; test/rosdep.sh looks for their names',
    'catkin_make -DCMAKE_BUILD_TYPE=Release': 'builds for minutes; test/workspace.sh runs it',
    'source devel/setup.bash': 'is for a workspace; test/workspace.sh has one',
    'catkin_make -DCMAKE_BUILD_TYPE=Release -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3':
        'builds for minutes; test/workspace.sh runs it',
    'catkin_make run_tests_flute_grinder': 'runs all tests; test/workspace.sh runs one of each kind',
    'catkin_make install': 'test/workspace.sh runs it',
    'cmake --install build': 'writes to /opt; test/install_space.sh runs it',
    'cmake build && cmake --build build': 'configures anew, for packages that were installed later',
    'sudo apt-get install linux-image-rt-amd64': 'installs a kernel',
    'uname -v': 'reports the kernel that was booted',
    'latency-histogram': 'is a window to look at for an hour',
    'scripts/bench': 'measures for minutes',
    'scripts/bench --json before.json': 'measures for minutes',
    'scripts/bench --json after.json --before before.json': 'measures for minutes',
    'scripts/bench_hal': 'measures for minutes',
    'scripts/bench_peers': 'measures for minutes',
    'scripts/bench_peers --docs': 'measures for minutes',
    'scripts/bench_peers --docs --ros-controllers DIR --ruckig DIR': 'needs sources from elsewhere',
    'scripts/bench_rviz': 'measures for minutes',
    'scripts/bench_stop': 'measures for minutes',
    'kill -STOP': 'lacks the number of a process; test/hal/test_hal_stops.py does it',
    'kill -KILL': 'lacks the number of a process; test/hal/test_hal_stops.py does it',
    'rostopic echo /joint_states': 'prints until it is ended',
    'halcmd show sig enabled': 'is read beside a machine; test/hal/test_hal_stops.py reads the signal',
    'rosrun flute_grinder exporter --listen 192.168.1.5:9840': 'answers until it is ended; test/node/test_exporter.py asks it',
    'rosbag reindex FILE.bag.active': 'lacks a bag that was not closed',
    'halcmd getp streamer.0.underruns': 'is read beside a machine; test/hal reads the pin',
    'halcmd start': 'starts the thread of a HAL that has been stopped',
    'rviz -d rviz/grinder.rviz': 'is open until it is closed; test/rviz opens it',
}


def subcommand(command):
    """Of a call of grind; None of another command."""
    found = re.match(r'(?:rosrun flute_grinder )?grind(?: --node \S+)?(?: ([\w-]+))?', command)
    return found and (found.group(1) or '')


def wrong():
    """One text for each thing that is wrong."""
    found, run, seen = [], set(), set()
    items = [(page, item) for page in PAGES for item in read_page((ROOT / page).read_text())]
    for _, item in items:
        if item.kind == 'commands':
            run |= set(item.lines)
    subcommands = {subcommand(command) for command in run - set(NOT_RUN)} | {''}
    for page, item in items:
        place = '%s:%d: ' % (page, item.line)
        if item.kind == 'commands':
            seen |= set(item.lines)
            found += [place + 'not a command: ' + line for line in item.lines if not COMMAND.match(line)]
        if item.kind in ('text', 'output'):
            found += [place + 'a command among what is not: ' + line for line in item.lines if COMMAND.match(line)]
        if item.kind == 'mention':
            command = item.lines[0]
            seen.add(command)
            known = subcommand(command) in subcommands if subcommand(command) is not None else any(
                line.startswith(command) for line in run)
            # A program may be named without being called, and so may a file of the package.
            file = ROOT / command
            known = known or re.fullmatch('[a-z]+', command) or file.exists() and not os.access(file, os.X_OK)
            if not known and command not in NOT_RUN:
                found.append(place + '`%s` is run by no page' % command)
    return found + ['NOT_RUN: %s is not in the documentation' % command for command in NOT_RUN if command not in seen]


if __name__ == '__main__':
    problems = wrong()
    print('\n'.join(problems) or 'every command is run')
    sys.exit(bool(problems))
