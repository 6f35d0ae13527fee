#!/usr/bin/env python3
"""Runs every command that README.md and docs/*.md tell a reader to type, writes the files that they tell him to write, and
compares what is printed, and all tables of figures, with what stands there. How a page is read is in pages.py. With all pages,
links.py and messages.py check theirs too.

test/rviz/on_screen test/docs/test_docs.py [PAGE...]: all pages unless some are named."""

import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import traceback

import figures
import links
import messages
from links import PAGES
from pages import COMMAND, read_page, write_file
from session import ROOT, Failure, Session, missing_line

# What no test can run, and why. Each must stand in the documentation, and nothing else may be left out.
NOT_RUN = {
    'scripts/setup': 'installs packages; every test begins with it',
    'scripts/test': 'runs this test',
    'scripts/setup --run': 'installs packages; scripts/demo begins with it',
    'scripts/test_on 13': 'installs a system for an hour',
    'scripts/test_on 11 --gcc 9': 'installs a system for an hour',
    'source /opt/ros/noetic/setup.bash': 'is for Ubuntu; test/workspace.sh sources what there is',
    'cd ~/catkin_ws': 'is for a workspace; test/workspace.sh has one',
    'rosdep install --from-paths src --ignore-src -y': 'installs packages; test/rosdep.sh looks for their names',
    'catkin_make -DCMAKE_BUILD_TYPE=Release': 'builds for minutes; test/workspace.sh runs it',
    'source devel/setup.bash': 'is for a workspace; test/workspace.sh has one',
    'catkin_make -DCMAKE_BUILD_TYPE=Release -DPYTHON_EXECUTABLE=/usr/bin/python3': 'builds for minutes; test/workspace.sh runs it',
    'catkin_make run_tests_flute_grinder': 'runs all tests; test/workspace.sh runs one of each kind',
    'catkin_make install': 'test/workspace.sh runs it',
    'cmake --install build': 'writes to /opt; test/install_space.sh runs it',
    'cmake build && cmake --build build': 'configures anew, for packages that were installed later',
    'sudo apt-get install linux-image-rt-amd64': 'installs a kernel',
    'uname -v': 'tells of the kernel that was booted',
    'latency-histogram': 'is a window to look at for an hour',
    'scripts/bench': 'measures for minutes',
    'scripts/bench --json before.json': 'measures for minutes',
    'scripts/bench --json after.json --before before.json': 'measures for minutes',
    'scripts/bench_commands': 'measures for minutes',
    'scripts/bench_hal': 'measures for minutes',
    'scripts/bench_rviz': 'measures for minutes',
    'scripts/bench_stop': 'measures for minutes',
    'kill -STOP': 'lacks the number of a process; test/hal/test_hal_stops.py does it',
    'kill -KILL': 'lacks the number of a process; test/hal/test_hal_stops.py does it',
    'rostopic echo /joint_states': 'prints until it is ended',
    'halcmd show sig enabled': 'is read beside a machine; test/hal/test_hal_stops.py reads the signal',
    'rosbag reindex FILE.bag.active': 'lacks a bag that was not closed',
    'halcmd getp streamer.0.underruns': 'is read beside a machine; test/hal reads the pin',
    'halcmd start': 'starts the thread of a HAL that has been stopped',
    'rviz -d rviz/grinder.rviz': 'is open until it is closed; test/rviz opens it',
}
IN_HAL = {'docs/shop-floor-pc.md'}
# What a new user reads, so that nothing may have been typed before.
FROM_THE_BEGINNING = {'README.md', 'docs/first-cutter.md', 'docs/install.md'}


def run_commands(session, item):
    commands = [command for command in item.lines if command not in NOT_RUN]
    other = re.fullmatch('while (.*)', item.directive)
    broken_off = re.fullmatch('after Ctrl-C in (.*)', item.directive)
    status = re.fullmatch(r'exits (\d)', item.directive)
    if item.directive and not (other or broken_off or status or item.directive == 'after Ctrl-C'):
        raise Failure('line %d: what is "%s"?' % (item.line, item.directive))
    if other:
        return session.type_while(other.group(1), commands)
    if item.directive == 'after Ctrl-C':
        session.end_launched()
    if broken_off:
        session.type_while(broken_off.group(1), [], broken_off=True)
    for i, command in enumerate(commands):
        last = i == len(commands) - 1
        session.type(command, int(status.group(1)) if status and last else 0)


def check_output(session, item, last):
    command = item.directive[len('output of '):] if item.directive.startswith('output of ') else last
    if command not in session.outputs:
        raise Failure('line %d: no output of %s' % (item.line, command))
    line = missing_line(item.lines, session.outputs[command])
    if line:
        raise Failure('line %d: "%s" is not in the output of %s:\n%s'
                      % (item.line, line.strip(), command, session.outputs[command]))


def grind_job(command, job, *arguments):
    """What a subcommand of grind says of a job that is given as text."""
    with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
        file.write(job)
        file.flush()
        return subprocess.run([ROOT / 'build/devel/lib/flute_grinder/grind', command, file.name, *arguments], check=True,
                              env=dict(os.environ, ROS_PACKAGE_PATH=str(ROOT)), stdout=subprocess.PIPE,
                              universal_newlines=True).stdout


def do(session, item, last):
    """Does what an item asks of the reader."""
    if item.kind == 'file':
        write_file(session.clone / item.path.replace('~', str(session.home)), item.lines)
    elif item.kind == 'commands':
        run_commands(session, item)
    elif item.kind == 'output' and last not in NOT_RUN:
        check_output(session, item, last)
    elif item.kind == 'figures':
        found = figures.wrong(item, lambda path: (ROOT / path).read_text(), grind_job)
        if found:
            raise Failure('line %d: %s' % (item.line, '; '.join(found)))


def run_page(page):
    """Types a page from its begin to its end. @return what is wrong, empty if nothing is."""
    if page in IN_HAL and 'INSIDE_HAL' not in os.environ:
        done = subprocess.run([ROOT / 'test/hal/in_hal', sys.executable, __file__, page], stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        return '' if done.returncode == 0 else done.stdout
    session = Session()
    try:
        if page not in FROM_THE_BEGINNING:
            session.type('source build/devel/setup.bash')
        if page in IN_HAL:
            session.type('halcmd stop; halrun -U')
        last = ''
        for item in read_page((ROOT / page).read_text()):
            do(session, item, last)
            last = item.lines[-1] if item.kind == 'commands' else last
        session.end_launched()
    except Failure as failure:
        return textwrap.indent(str(failure), page + ': ')
    except Exception:
        return textwrap.indent(traceback.format_exc(), page + ': ')
    finally:
        session.close()
    return ''


def subcommand(command):
    """Of a call of grind; None of another command."""
    found = re.match(r'(?:rosrun flute_grinder )?grind(?: --node \S+)?(?: ([\w-]+))?', command)
    return found and (found.group(1) or '')


def check_coverage():
    """What is neither run nor left out for a reason, and what is left out in vain. @return one text each."""
    wrong, run, seen = [], set(), set()
    items = [(page, item) for page in PAGES for item in read_page((ROOT / page).read_text())]
    for _, item in items:
        if item.kind == 'commands':
            run |= set(item.lines)
    subcommands = {subcommand(command) for command in run - set(NOT_RUN)} | {''}
    for page, item in items:
        place = '%s:%d: ' % (page, item.line)
        if item.kind == 'commands':
            seen |= set(item.lines)
            wrong += [place + 'not a command: ' + line for line in item.lines if not COMMAND.match(line)]
        if item.kind in ('text', 'output'):
            wrong += [place + 'a command among what is not: ' + line for line in item.lines if COMMAND.match(line)]
        if item.kind == 'mention':
            command = item.lines[0]
            seen.add(command)
            known = subcommand(command) in subcommands if subcommand(command) is not None else any(
                line.startswith(command) for line in run)
            # A program may be named without being called, and so may a file of the package.
            known = known or re.fullmatch('[a-z]+', command) or (ROOT / command).exists() and not os.access(ROOT / command, os.X_OK) or command in NOT_RUN
            if not known:
                wrong.append(place + '`%s` is run by no page' % command)
    return wrong + ['NOT_RUN: %s is not in the documentation' % command for command in NOT_RUN if command not in seen]


def main():
    pages = sys.argv[1:] or PAGES
    wrong = [] if sys.argv[1:] else check_coverage() + links.wrong() + messages.wrong()
    with concurrent.futures.ThreadPoolExecutor(3) as pool:
        wrong += filter(None, pool.map(run_page, pages))
    print('\n'.join(wrong))
    print('%d pages, %d things wrong' % (len(pages), len(wrong)))
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
