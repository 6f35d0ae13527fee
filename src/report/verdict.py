"""Passes or fails a ground tool: what was asked, measured and allowed."""

import math

import yaml

from cutter import max_radius
from record import DEG, SourceError

ALLOWED = {
    'land_mm': 'minimum land',
    'following_error_um': 'following error in the strokes, of A at the maximum radius',
    'feed_percent': 'difference of the feed from the job\'s, between the ends of the flute',
    'late_cycles_percent': 'late control cycles'}


def read_tolerances(path):
    """@raise SourceError, OSError"""
    with open(path, encoding='utf-8') as file:
        try:
            given = yaml.safe_load(file)
        except yaml.YAMLError as error:
            raise SourceError(' '.join(str(error).split()))
    if not isinstance(given, dict):
        raise SourceError('has no keys; allowed: %s' % ', '.join(ALLOWED))
    for key, value in given.items():
        if key not in ALLOWED:
            raise SourceError('%s: not known; allowed: %s' % (key, ', '.join(ALLOWED)))
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < math.inf:
            raise SourceError('%s = %s; allowed: a number from 0' % (key, value))
    for key in ALLOWED:
        if key not in given:
            raise SourceError('%s is missing' % key)
    return given


class Criterion:
    """One line of the verdict. All in `unit`; asked, measured and place may be None. tolerance: maximum difference from what
    is asked; None: `asked` is the minimum allowed. digits: behind the point, or None: three in all."""

    def __init__(self, name, unit, digits, asked, tolerance):
        self.name, self.unit, self.digits, self.asked, self.tolerance = name, unit, digits, asked, tolerance
        self.measured, self.place, self.remark = None, '', ''
        self._worst = -math.inf

    def add(self, value, place, asked=None):
        """A measured value; the one that is farthest off remains. None: there is nothing to measure where there should be."""
        asked = self.asked if asked is None else asked
        off = math.inf if value is None else asked - value if self.tolerance is None else abs(value - asked)
        if off > self._worst:
            self._worst, self.asked, self.measured, self.place = off, asked, value, place
            self.remark = 'there is none' if value is None else ''

    @property
    def result(self):
        if self._worst == -math.inf:
            return 'not measured'
        return 'passed' if self._worst <= (self.tolerance or 0) else 'failed'

    def head(self):
        return {'name': self.name, 'unit': self.unit, 'digits': self.digits, 'asked': self.asked, 'measured': self.measured,
                'tolerance': self.tolerance, 'place': self.place, 'result': self.result, 'remark': self.remark}


def place_of(stroke, x=None):
    return 'tooth %d, pass %d' % (stroke['tooth'], stroke['pass']) + ('' if x is None else ', X = %.3f mm' % x)


def pass_of(gouge):
    return 'tooth %d, pass %d, %s' % (gouge['tooth'] + 1, gouge['pass'] + 1, gouge['move'])


def of_strokes(job_file, strokes, feed_limits, tolerances):
    deviation = Criterion('path deviation', 'µm', None, 0, job_file['interpolation']['tolerance_um'])
    following = Criterion('following error in strokes', 'µm', 2, 0, tolerances['following_error_um'])
    asked = job_file['process']['feed_mm_min']
    feed = Criterion('feed constancy', 'mm/min', 1, asked, asked * tolerances['feed_percent'] / 100)
    cutter = job_file['cutter']
    slowed = [limit for limit in feed_limits if limit['from_x_mm'] < cutter['flute_length_mm'] and limit['to_x_mm'] > 0
              or limit['to_x_mm'] < cutter['flute_length_mm'] and limit['from_x_mm'] > 0]
    for limit in slowed[:1]:
        feed.remark = 'the plan slows down: %(cause)s, X %(from_x_mm).3f to %(to_x_mm).3f mm' % limit
    for stroke in strokes:
        if stroke['deviation_um'] is not None:
            deviation.add(stroke['deviation_um'], place_of(stroke, stroke.get('deviation_x_mm')))
        for name, value in stroke.get('following_error', {}).items():
            if value is None:  # a faulty drive read NaN
                continue
            at_surface = value * DEG * max_radius(cutter) if name == 'a_mdeg' else value  # thousandths of deg and of mm
            following.add(at_surface, '%s, %s' % (name[0].upper(), place_of(stroke)))
        if stroke['feed_min_mm_min'] is not None and not slowed:
            feed.add(stroke['feed_min_mm_min'], place_of(stroke, stroke.get('feed_min_x_mm')))
            feed.add(stroke['feed_max_mm_min'], place_of(stroke))
    return deviation, following, feed


def of_tool(job_file, tool, tolerances):
    """tool: as ground, or None if it was not measured."""
    cutter = job_file['cutter']
    rake = Criterion('rake', 'deg', 3, cutter['rake_angle_deg'], cutter['rake_tolerance_deg'])
    chord = Criterion('chordal rake', 'deg', 3, cutter['rake_angle_deg'], cutter['chordal_rake_tolerance_deg'])
    core = Criterion('core diameter', 'mm', 3, None, cutter['core_tolerance_mm'])
    land = Criterion('land', 'mm', 3, tolerances['land_mm'], None)
    spiral = Criterion('spiral angle', 'deg', 3, None, cutter['spiral_tolerance_deg'])
    sections = tool['sections'] if tool else []
    for section in sections:
        core.add(section['core_diameter_mm'], 'X = %.3f mm' % section['x_mm'], section['asked_core_diameter_mm'])
        for i, tooth in enumerate(section['teeth'], 1):
            place = 'tooth %d, X = %.3f mm' % (i, section['x_mm'])
            # A job may allow an incomplete flute, which has no rake face at its end.
            if tooth['complete'] or not job_file['process'].get('incomplete_ok'):
                rake.add(tooth['rake_deg'], place)
                chord.add(tooth['chordal_rake_deg'], place)
            land.add(tooth['land_mm'], place)
            spiral.add(tooth['spiral_deg'], place, tooth['asked_spiral_deg'])
    return rake, chord, core, land, spiral


def of_gouges(job_file, tool):
    """tool: of a record, as far as it was ground; or None."""
    # The core's tolerance, which is of a diameter, holds for the whole flute.
    gouge = Criterion('gouge', 'mm', 3, 0, job_file['cutter']['core_tolerance_mm'] / 2)
    if not tool or tool['gouges'] is None:
        return gouge
    gouge.add(0, '')
    for found in tool['gouges']:
        gouge.add(found['depth_mm'], '%s, X = %.3f mm' % (pass_of(found), found['x_mm']))
    others = [pass_of(found) for found in tool['gouges']
              if found['depth_mm'] > gouge.tolerance and not gouge.place.startswith(pass_of(found))]
    if others:
        gouge.place += '; also ' + '; '.join(others)
    return gouge


def all_teeth_ground(tool):
    """Whether the record has a stroke of each tooth: of a job that was continued it has not."""
    return len({stroke['tooth'] for stroke in tool['strokes'] or []}) == tool['teeth']


def cycles_of(data):
    """Control cycles in which late ones were counted: in a record of the grinder also those in which the job was held."""
    if data['kind'] == 'record':
        return round(1000 * data['duration_s'] / data['machine']['period_ms'])
    return data.get('setpoints', {}).get('written')


def criteria(data, tolerances):
    """The lines of the verdict, in the order of the report."""
    job_file = data['job']['file']
    deviation, following, feed = of_strokes(job_file, data['strokes'], data.get('planned', {}).get('feed_limits', []), tolerances)
    late = Criterion('late cycles', '%', 3, 0, tolerances['late_cycles_percent'])
    cycles = cycles_of(data)
    if 'late_cycles' in data and cycles:
        count, longest = data['late_cycles']['count'], data['late_cycles']['longest_ms']
        late.add(100 * count / cycles, '%d of %d cycles%s' % (count, cycles, ', the longest %.3f ms' % longest if longest else ''))
    # A record of the grinder has no positions of which a tool could be computed: its tool is the one that the job asks for.
    recorded = None if data['kind'] == 'record' else data.get('tool')
    ground = recorded if recorded and all_teeth_ground(recorded) else None
    return [c.head() for c in (deviation, *of_tool(job_file, ground, tolerances), of_gouges(job_file, recorded), following,
                               feed, late)]


def verdict(data):
    """passed, failed, unfinished or incomplete; and why."""
    failed = [c['name'] for c in data['criteria'] if c['result'] == 'failed']
    if data.get('outcome') not in (None, 'done'):
        failed.insert(0, 'the job ended as %s' % data['outcome'])
    if failed:
        return 'failed', failed
    unknown = ['%s: not measured' % c['name'] for c in data['criteria'] if c['result'] == 'not measured']
    if data.get('outcome') is None:
        return 'unfinished', ['the end of the job is not in the file', *unknown]
    if data.get('setpoints', {}).get('lost'):
        unknown.insert(0, '%d setpoints are not in the file' % data['setpoints']['lost'])
    return ('incomplete', unknown) if unknown else ('passed', [])
