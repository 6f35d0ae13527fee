"""Draws a report; `grind report` starts it and gives it the limits, in SI units. Exit status 2 for a file that cannot be
read or written."""

import argparse
import json
import os
import signal
import subprocess
import sys
from collections import namedtuple

from record import SourceError

SECTIONS = 17  # of the tool

Limits = namedtuple('Limits', 'speed acceleration following')


def arguments():
    parser = argparse.ArgumentParser(prog='grind report')
    parser.add_argument('file')
    parser.add_argument('--output', required=True)
    parser.add_argument('--job', type=int, required=True)
    parser.add_argument('--grind', required=True, help='the program itself, which simulates the tool')
    for limit in ('velocity', 'acceleration', 'following-error'):
        parser.add_argument('--max-' + limit, type=float, nargs=4, required=True)
    return parser.parse_args()


def simulate(record, path, job, grind):
    """Gives a record its tool, if its job is known."""
    which = ['--run', str(job)] if job else []
    done = subprocess.run([grind, 'simulate', path, '--json', '--sections', str(SECTIONS), *which], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True)
    if done.stdout:
        record.tool = json.loads(done.stdout)
    else:
        record.no_tool = done.stderr.strip()


def read(path, job, grind):
    """The record of a file, whose type is recognised by its first bytes."""
    with open(path, 'rb') as file:
        is_bag = file.read(8) == b'#ROSBAG '
    # ROS and matplotlib are slow to load.
    if is_bag:
        from read_bag import read_bag
        record = read_bag(path, job)
        simulate(record, path, job, grind)
        return record
    from read_csv import read_csv
    return read_csv(path)


def main():
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    given = arguments()
    try:
        record = read(given.file, given.job, given.grind)
    except SourceError as error:
        return '%s: %s' % (given.file, error)
    except OSError as error:
        return '%s: cannot be read: %s' % (given.file, error.strerror or error)
    from figures import draw
    from motion import KeyFigures
    from page import page
    from tool import tool_pictures
    limits = Limits(given.max_velocity, given.max_acceleration, given.max_following_error)
    key = KeyFigures(record)
    pictures = draw(record, key, limits) + (tool_pictures(record.tool) if record.tool else [])
    text = page(os.path.basename(given.file), record, key, limits, pictures)
    try:
        with open(given.output, 'w', encoding='utf-8') as file:
            file.write(text)
    except OSError as error:
        return '%s: cannot be written: %s' % (given.output, error.strerror or error)
    return None


if __name__ == '__main__':
    reason = main()
    if reason:
        print(reason, file=sys.stderr)
        sys.exit(2)
