"""All that a report says, as data: what `--json` prints and what the page shows. In the keys of the grinder's own records of
jobs, with more."""

import json
from datetime import datetime

from record import AXES, DEG, MM, MS, STILL, SourceError
from verdict import all_teeth_ground, criteria, verdict

KINDS = {'table': 'points of a curve, from "grind table"', 'setpoints': 'setpoints, from "grind plan"',
         'run': 'setpoints, from "grind run"', 'bag': 'bag of the grinder', 'record': 'the grinder\'s own record'}

LIMITS = ('max_velocity', 'max_acceleration', 'max_following_error')


def time_of(stamp):
    return datetime.fromisoformat(stamp.replace('Z', '+00:00'))


def to_si(by_axis):
    """Values by axis, e.g. x_mm ... a_deg, as a list."""
    return [value * (DEG if name.startswith('a_') else MM) for name, value in by_axis.items()]


def holds(states, end):
    """From the states of a job: when it was held, for how long, and why."""
    found = []
    for (time, state, reason, tooth, pass_), (following, *_) in zip(states, states[1:] + [(end,)]):
        if state not in STILL:
            continue
        if found and abs(found[-1]['at_s'] + found[-1]['duration_s'] - time) < 1e-9:
            found[-1]['duration_s'] = following - found[-1]['at_s']
            found[-1]['reason'] = reason or found[-1]['reason']
        else:
            found.append({'at_s': time, 'duration_s': following - time, 'reason': reason, 'tooth': tooth + 1, 'pass': pass_ + 1})
    for hold in found:
        hold['reason'] = hold['reason'] or 'operator'
    return found


def overrides(changes):
    """Those of a job: its first, if it is not 100 %, and all changes."""
    found, last = [], 1.0
    for time, factor, tooth, pass_ in changes:
        if factor != last:
            found.append({'at_s': max(time, 0.0), 'percent': round(100 * factor, 6), 'tooth': tooth + 1, 'pass': pass_ + 1})
        last = factor
    return found


class Findings:
    """data: see above. words: by their keys. figures, limits: for the pictures; None and {} without rows. limits are in SI units."""

    def __init__(self, name, record, figures, tool, no_tool, job_file, given_limits, tolerances, words):
        self.figures = figures
        self.data = data = {'file': name, 'kind': record.kind, 'type': KINDS[record.kind]}
        data.update(words)
        data.update(record.head)
        if job_file:
            data.setdefault('job', {'name': data.pop('job_name', ''), 'file': job_file})
        if tool:
            data['tool'] = tool
        self.limits = {name: to_si(data['machine'][name]) for name in LIMITS} if 'machine' in data else given_limits
        if record.kind != 'record':
            data.update(self._points(record))
        if record.kind in ('setpoints', 'run', 'bag'):
            data.update(self._setpoints(record, tool))
        if record.kind == 'bag':
            data.update(self._loop(record))
        if record.kind == 'record':
            data['duration_s'] = (time_of(data['ended']) - time_of(data['started'])).total_seconds()
        if job_file:
            data['criteria'] = criteria(data, tolerances)
            data['verdict'], data['verdict_because'] = verdict(data)
        data['left_out'] = self._left_out(record, no_tool)

    @staticmethod
    def _points(record):
        # As `grind table` and the paper count them: point 0 is where the curve starts.
        return {'points': record.count - (record.kind == 'table'),
                'odd_error_rad': record.odd_error, 'even_error_rad': record.even_error}

    def _setpoints(self, record, tool):
        depths = tool['pass_depths_mm'] if tool else None
        return {'setpoints': {'written': record.count + record.missing, 'lost': record.missing},
                'period_ms': record.period / MS,
                'duration_s': record.end - record.begin,
                'strokes': [stroke.head(record.has_actual, depths) for stroke in self.figures.strokes.values()],
                'holds': holds(record.states, max([record.end] + [state[0] for state in record.states])),
                'overrides': overrides(record.overrides),
                'axes': [self._axis(record, axis) for axis in range(len(AXES))]}

    def _loop(self, record):
        figures = self.figures
        return {'late_cycles': {'count': figures.late_cycles, 'longest_ms': figures.longest_period / MS},
                'loop': {'mean_ms': figures.mean_period / MS, 'shortest_ms': figures.shortest_period / MS,
                         'longest_ms': figures.longest_period / MS},
                'states': [{'at_s': time, 'state': state, 'reason': reason} for time, state, reason, *_ in record.states],
                'diagnostics': [dict(zip(('name', 'level', 'message', 'count'), row)) for row in record.diagnostics]}

    def _axis(self, record, axis):
        """Maximum values in the strokes and between them, and the limits, in mm and deg."""
        unit = DEG if axis == len(AXES) - 1 else MM
        row = {'axis': AXES[axis]}
        for name, limit in zip(('speed', 'acceleration', 'following'), LIMITS):
            if name == 'following' and not record.has_actual:
                continue
            stroke, rapid = getattr(self.figures, name)
            row[name] = {'stroke': stroke.values[axis] / unit, 'rapid': rapid.values[axis] / unit,
                         'limit': self.limits[limit][axis] / unit}
        return row

    def _left_out(self, record, no_tool):
        """What is missing, and why."""
        reasons = []
        if record.kind == 'record':
            reasons.append('Pictures of the axes: a record of the grinder keeps each stroke\'s figures only; a bag of record:=true '
                           'has every setpoint. The tool is the one that the job asks for, not measured.')
        elif record.worst is None:
            reasons.append('Curve, error and feed: the job ended before its first stroke.')
        if record.kind == 'table':
            reasons.append('Feed, axis speeds and accelerations, following error, loop timing: the points of a table have no time.')
        if record.kind == 'setpoints':
            reasons.append('Following error and loop timing: the CSV file of a plan has only commanded values; a bag has more.')
        if record.kind == 'run':
            reasons.append('Loop timing: a CSV file does not have it; a bag does.')
        if record.kind in ('table', 'setpoints', 'run'):
            reasons.append('The tool and its tolerances: a CSV file does not have the job; a bag or a record of the grinder does.')
        elif no_tool:
            reasons.append('The ground tool: %s' % no_tool)
        elif record.kind == 'bag' and not all_teeth_ground(self.data['tool']):
            reasons.append('The tolerances of the ground tool: not all of its teeth were ground in this job; the others are not in '
                           'the file.')
        return reasons


def read_record(path):
    """A record that the grinder keeps of a job (JSON). @raise SourceError, OSError"""
    with open(path, encoding='utf-8') as file:
        try:
            head = json.load(file)
        except ValueError as error:
            raise SourceError('is no record of a job: %s' % error)
    if not isinstance(head, dict) or head.get('record') != 1:
        raise SourceError('is no record of a job that this program knows; allowed: "record": 1')
    for key in ('machine', 'job', 'started', 'ended', 'outcome', 'setpoints', 'late_cycles', 'strokes', 'holds', 'overrides'):
        if key not in head:
            raise SourceError('is no complete record of a job: %s is missing' % key)
    return head
