"""The strokes of a job's operations, for tests that hold them against a geometry of their own: from the file of `grind plan --csv`,
and the wheels and set-ups of the job's files. All lengths in mm."""

import functools
import json
import os

import numpy
import yaml

import grinder_client as gc


class Refused(Exception):
    """What a program does not do, and why."""


def grind(*arguments):
    """What a command prints."""
    done = gc.grind(*arguments)
    if done.returncode != 0:
        raise Refused('%s: %s' % (' '.join(a for a in arguments if '/' not in a), done.stderr or done.stdout))
    return done.stdout


def read_job(path):
    """A job's file with those of its wheels and set-ups in their places; each operation has its name."""
    @functools.lru_cache(None)
    def read(name):
        with open(os.path.join(os.path.dirname(path), name), encoding='utf-8') as file:
            return yaml.safe_load(file)

    job = read(os.path.basename(path))
    for process in job['operations']:
        process['name'] = {'relief': '', 'end': 'end_'}.get(process['kind'], process['kind']) + process.get('relief', '')
        process['setup'] = read(process['setup']['file'])[process['name']]
        if 'file' in process['wheel']:
            process['wheel'] = read(process['wheel']['file'])
    return job


def plan(path, job, process, rate, folder):
    """@param rate of the setpoints [Hz]. @return what the plan of an operation says, and of the last stroke of each tooth the poses,
    in columns: X, Y and Z of the wheel's centre, and A."""
    machine, setpoints = gc.machine_file(os.path.join(folder, 'machine.yaml'), control_rate=rate), os.path.join(folder, 'setpoints.csv')
    printed = grind('plan', path, '--operation', process['name'], '--machine', machine, '--json', '--csv', setpoints)
    with open(setpoints, encoding='utf-8') as file:
        names, lines = next(file).strip().split(','), [line for line in file if ',stroke,' in line]
    first, last = names.index('x_mm'), lines[-1].split(',')[names.index('pass')]
    strokes = [[line.split(',')[first:first + 4] for line in lines if ',stroke,%d,%s,' % (tooth, last) in line]
               for tooth in range(job['cutter'].get('teeth') or len(job['cutter']['tooth_angles_deg']))]
    off = [[0], [(job['cutter']['end_diameter_mm'] + process['wheel']['diameter_mm']) / 2], [process['setup']['height_mm']], [0]]
    return json.loads(printed), [numpy.array(rows, float).T + off for rows in strokes]
