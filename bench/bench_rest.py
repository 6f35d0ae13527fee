#!/usr/bin/env python3
"""What a running node takes while nothing happens: memory, resident and locked, and the share of a core, of the control loop
and of all other threads; beside it what a thread takes that is woken as often as the loop and does nothing. The grinder is
left as it is: bench_rest.py [NODE] [--seconds S] [--json]"""

import argparse
import contextlib
import ctypes
import json
import os
import time
import xmlrpc.client

import rosgraph

LOOP = 'control_loop'
CLOCK_MONOTONIC, TIMER_ABSTIME = 1, 1
PRIORITY = 80  # the loop's


class Timespec(ctypes.Structure):
    _fields_ = [('seconds', ctypes.c_long), ('nanoseconds', ctypes.c_long)]


def process_of(node):
    uri = rosgraph.Master('/bench_rest').lookupNode(node)
    return xmlrpc.client.ServerProxy(uri).getPid('/bench_rest')[2]


def read(path):
    with open(path) as file:
        return file.read()


def memory(pid):
    """As the kernel counts it [bytes]."""
    status = dict(line.split(':', 1) for line in read('/proc/%d/status' % pid).splitlines())
    return {'resident': int(status['VmRSS'].split()[0]) * 1024, 'locked': int(status['VmLck'].split()[0]) * 1024}


def threads(pid):
    """Of each thread its name, its processor time [s] and how often it was woken."""
    found = {}
    for task in os.listdir('/proc/%d/task' % pid):
        folder = '/proc/%d/task/%s/' % (pid, task)
        with contextlib.suppress(FileNotFoundError):  # a thread that has ended
            status = dict(line.split(':\t', 1) for line in read(folder + 'status').splitlines())
            found[task] = (status['Name'], int(read(folder + 'schedstat').split()[0]) / 1e9,
                           int(status['voluntary_ctxt_switches']))
    return found


def usage(pid, seconds):
    """Shares of a core and wake-ups a second, of the loop and of the other threads."""
    before, begin = threads(pid), time.monotonic()
    time.sleep(seconds)
    after, taken = threads(pid), time.monotonic() - begin
    groups = {group: {'processor': 0.0, 'wake_ups': 0.0} for group in ('loop', 'rest')}
    for task in before.keys() & after.keys():
        group = groups['loop' if after[task][0] == LOOP else 'rest']
        group['processor'] += (after[task][1] - before[task][1]) / taken
        group['wake_ups'] += (after[task][2] - before[task][2]) / taken
    return groups


def wake_ups_alone(rate, seconds):
    """The share of a core of a thread that is woken at a rate, as the loop is, and does nothing."""
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    sleep = ctypes.CDLL('libc.so.6').clock_nanosleep
    count, period = int(rate * seconds), int(1e9 / rate)
    begin, used = time.monotonic_ns(), time.thread_time()
    for i in range(count):
        due = Timespec(*divmod(begin + (i + 1) * period, 10**9))
        sleep(CLOCK_MONOTONIC, TIMER_ABSTIME, ctypes.byref(due), None)
    return (time.thread_time() - used) / (count * period / 1e9)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('node', nargs='?', default='/grinder', help='default: /grinder')
    parser.add_argument('--seconds', type=float, default=10, help='how long each figure is taken; default: 10')
    parser.add_argument('--json', action='store_true', help='shares as fractions, memory in bytes')
    arguments = parser.parse_args()
    node = rosgraph.names.resolve_name(arguments.node, '/')
    pid = process_of(node)
    rate = rosgraph.Master('/bench_rest').getParam(node + '/control_rate')
    figures = dict(memory(pid), **usage(pid, arguments.seconds))
    figures['wake_ups_alone'] = {'processor': wake_ups_alone(rate, arguments.seconds), 'wake_ups': float(rate)}
    if arguments.json:
        print(json.dumps(figures))
        return
    for name in ('resident', 'locked'):
        print('%-30s %8.1f MB' % (name + ' memory', figures[name] / 1e6))
    for group, name in (('loop', 'control loop'), ('wake_ups_alone', 'its wake-ups alone'), ('rest', 'all other threads')):
        print('%-30s %8.2f %% of a core, woken %4.0f times a second'
              % (name, 100 * figures[group]['processor'], figures[group]['wake_ups']))


if __name__ == '__main__':
    main()
