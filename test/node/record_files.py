"""Records of jobs, made without a grinder."""

import datetime
import hashlib
import json

import yaml

import grinder_client as gc


def head_of(path, started, ended, outcome='done', complete=1, passes=1, **fields):
    """The head of a record of a job file, all of whose figures are as asked. @param complete of the strokes that were begun."""
    with open(gc.package_file(path)) as text:
        cutter = yaml.safe_load(text)['cutter']
    teeth = cutter.get('teeth') or len(cutter['tooth_angles_deg'])
    tool = 'D %g mm, cone %g deg, spiral %g deg, rake %g deg, %d %s' % (
        cutter['end_diameter_mm'], cutter['cone_angle_deg'], (cutter.get('spiral_angles_deg') or [cutter['spiral_angle_deg']])[0],
        cutter['rake_angle_deg'], teeth, 'tooth' if teeth == 1 else 'teeth')
    times = [datetime.datetime.fromisoformat(time.replace('Z', '+00:00')).timestamp() for time in (started, ended)]
    head = {'grinder': '/grinder', 'started': started, 'ended': ended, 'job': 'job', 'digest': '', 'operation': '', 'tool': tool,
            'continues': False, 'ends_tool': True, 'wheel': 'wheel.yaml', 'dressed': '', 'wear_mm': 0, 'outcome': outcome, 'reason': '',
            'strokes': complete, 'passes': passes, 'duration_s': round(times[1] - times[0], 3), 'holds': 0, 'setpoints': 0,
            'lost': 0, 'verdict': 'incomplete' if outcome == 'done' else 'failed',
            'verdict_because': ['rake: not measured'] if outcome == 'done' else ['the job ended as ' + outcome]}
    assert fields.keys() <= head.keys()
    return dict(head, **fields)


def text_of(head, body=()):
    """A record as the grinder writes it, sealed."""
    lines = '{"record":2,"head":%s,\n"body":%s,\n' % (json.dumps(head), json.dumps(dict({'criteria': []}, **dict(body))))
    return '%s"seal":"%s"}\n' % (lines, hashlib.sha256(lines.encode()).hexdigest())


def read(path):
    """The head and the body of a record, in one."""
    with open(path) as file:
        record = json.load(file)
    return dict(record['head'], **record['body'])
