#!/usr/bin/env python3
"""How long a command takes from its start to its end, with a grinder without power, which refuses most of them: the time
of the program and of its connections, without any motion. `scripts/bench_commands` runs it."""

import statistics
import subprocess
import sys
import time

import rospkg

sys.path.insert(0, rospkg.RosPack().get_path('flute_grinder') + '/test/node')
import grinder_client as gc  # noqa: E402

COMMANDS = ('--version', 'status', 'offsets', 'hold', 'resume', 'cancel', 'lift', 'jog x 1')


def seconds(command):
    begin = time.monotonic()
    subprocess.run([gc.program('grind'), *command.split()], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.monotonic() - begin


def main():
    runs = int(sys.argv[1])
    gc.poll(lambda: gc.grind('status').returncode == 0, 'the grinder')
    print('%-10s %8s %8s   s, of %d runs' % ('', 'median', 'longest', runs))
    for command in COMMANDS:
        times = [seconds(command) for _ in range(runs)]
        print('%-10s %8.3f %8.3f' % (command, statistics.median(times), max(times)))


if __name__ == '__main__':
    main()
