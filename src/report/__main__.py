"""Draws a report; `grind report` starts it and gives it the machine's limits, in SI units, for files without them."""

import argparse
import errno
import json
import os
import signal
import subprocess
import sys
import tempfile

from record import Record, SourceError
from verdict import read_tolerances

SECTIONS = 17  # of the tool
WORDS = ('note', 'operator', 'serial')  # of whoever asks for the report


def arguments():
    parser = argparse.ArgumentParser(prog='grind report')
    parser.add_argument('file')
    parser.add_argument('--output')
    parser.add_argument('--pdf')
    parser.add_argument('--json', action='store_true')
    for words in WORDS:
        parser.add_argument('--' + words, default='')
    parser.add_argument('--tolerances', required=True)
    parser.add_argument('--job', type=int, required=True)
    parser.add_argument('--grind', required=True, help='the program itself, which simulates the tool')
    for limit in ('velocity', 'acceleration', 'following-error'):
        parser.add_argument('--max-' + limit, type=float, nargs=4, required=True)
    return parser.parse_args()


class Simulation:
    """Runs `grind simulate` beside this program."""

    def __init__(self, grind, path, *more):
        self._path = path
        self._process = subprocess.Popen([grind, 'simulate', path, '--json', '--sections', str(SECTIONS), *more],
                                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)

    def result(self):
        """The tool, or None, and why there is none."""
        out, error = self._process.communicate()
        if out:
            return json.loads(out), ''
        # There, --job names a file.
        reason = error.strip().replace(self._path + ': ', '').replace('; give its job file with --job', '')
        return None, reason or 'grind simulate ended without an answer'

    def give_up(self):
        self._process.kill()
        self._process.communicate()


def head_of(path):
    with open(path, 'rb') as file:
        return file.read(8)


def read_bag_and_tool(given):
    from read_bag import read_bag
    simulation = Simulation(given.grind, given.file, *(['--run', str(given.job)] if given.job else []))
    try:
        record = read_bag(given.file, given.job)
    except BaseException:
        simulation.give_up()
        raise
    return record, *simulation.result()


def read_record_and_tool(given):
    from findings import read_record
    record = Record('record')
    record.head = read_record(given.file)
    # What JSON can express, YAML can: the job in the record is a job file.
    with tempfile.NamedTemporaryFile('w', suffix='.yaml') as job:
        json.dump(record.head['job']['file'], job)
        job.flush()
        return record, *Simulation(given.grind, job.name).result()


def read(given):
    """The record of a file, whose type is recognised by its first bytes; the tool, or None and why there is none."""
    head = head_of(given.file)
    # ROS and matplotlib are slow to load.
    if head == b'#ROSBAG ':
        return read_bag_and_tool(given)
    if given.job:
        raise SourceError('--job %d: only a bag has several jobs' % given.job)
    if head.lstrip().startswith(b'{'):
        return read_record_and_tool(given)
    from read_csv import read_csv
    return read_csv(given.file), None, ''


def survey(record, job_file, with_plots):
    """Figures and plots of the rows, which are gone through once."""
    from figures import Plots, TablePlots
    from motion import motions
    from strokes import Figures
    if record.kind == 'record':
        return None, None
    if record.kind == 'table':
        return None, TablePlots(record) if with_plots else None
    figures = Figures(record.period, job_file)
    plots = Plots(record) if with_plots else None
    for motion in motions(record):
        figures.add(motion)
        if plots:
            plots.add(motion)
    return figures, plots


def write(path, text):
    try:
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)
    except OSError as error:
        # A write does not name its file.
        raise OSError(error.errno, error.strerror, path)


def make(given, tolerances, record, tool, no_tool):
    """Writes what is asked for. @raise SourceError, OSError"""
    from findings import LIMITS, Findings
    job_file = tool['job'] if tool else record.head.get('job', {}).get('file')
    draws = given.output or given.pdf
    figures, plots = survey(record, job_file, draws)
    limits = dict(zip(LIMITS, (given.max_velocity, given.max_acceleration, given.max_following_error)))
    findings = Findings(os.path.basename(given.file), record, figures, tool, no_tool, job_file, limits, tolerances,
                        {key: getattr(given, key) for key in WORDS if getattr(given, key)})
    if draws:
        from page import page
        from pictures import draw
        text = page(findings.data, draw(plots, findings))
        if given.output:
            write(given.output, text)
        if given.pdf:
            from pdf import print_pdf
            print_pdf(text, given.pdf)
    if given.json:
        print(json.dumps(findings.data, indent=2, ensure_ascii=False))


class Failure(Exception):
    """What to print, and the exit status: 2 for a file that cannot be used, 1 for a write that failed."""

    def __init__(self, text, status):
        super().__init__(text)
        self.status = status


def run(given):
    """@raise Failure"""
    path = given.tolerances
    try:
        tolerances = read_tolerances(path)
        path = given.file
        record, tool, no_tool = read(given)
    except SourceError as error:
        raise Failure('%s: %s' % (path, error), 2)
    except OSError as error:
        raise Failure('%s: cannot be read: %s' % (path, error.strerror or error), 2)
    try:
        make(given, tolerances, record, tool, no_tool)
        sys.stdout.flush()
    except SourceError as error:
        raise Failure('%s: %s' % (given.file, error), 2)
    except BrokenPipeError:
        raise Failure('', 1)
    except OSError as error:
        name, reason = error.filename or 'standard output', error.strerror or error
        if error.errno == errno.ENOSPC:
            raise Failure('%s: write failed: %s' % (name, reason), 1)
        raise Failure('%s: cannot be written: %s' % (name, reason), 2)


def main():
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        run(arguments())
    except Failure as failure:
        if str(failure):
            print(failure, file=sys.stderr)
        # Not by sys.exit(), which would write what is left of the output once more.
        os._exit(failure.status)


if __name__ == '__main__':
    main()
