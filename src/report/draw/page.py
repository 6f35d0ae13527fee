"""Writes the contents and pictures of a report into a self-contained HTML file."""

import html
import os
import re
from datetime import datetime

from cutter import operation_name, process_of, radius, spiral_angles, tooth_angles
from figures import QUANTITIES
from measured import title_of

PAGE = '''<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
{body}
</body>
</html>
'''

LEVELS = ['OK', 'WARN', 'ERROR', 'STALE']
MOST_ROWS = 1000  # most rows of a table; --json has all
MOST_PLACES = 6  # most places of missing strokes named
BAR = 24  # characters of the longest bar
ROUNDING = 1e-6  # deviation [um] below which it is rounding
PROFILES = {'straight': 'straight', 'angled': 'angled', 'full_radius': 'full radius', 'cup': 'cup', 'points': 'by points'}


def text(value):
    return html.escape(str(value))


def facts(rows):
    """A table of names and values, without values that are None."""
    lines = ['<tr><th scope="row">%s</th><td>%s</td></tr>' % (text(name), text(value)) for name, value in rows if value is not None]
    return '<table class="facts">\n%s\n</table>' % '\n'.join(lines)


class Table:
    """Rows under a head; on a narrow screen each row is a card. numbers: the columns with numbers, from 1."""

    def __init__(self, head, numbers=()):
        self._head, self._numbers, self._rows, self._more = head, numbers, [], 0

    def add(self, *cells, classes=None):
        """Adds a row. classes: classes of the cells, by column."""
        if len(self._rows) == MOST_ROWS:
            self._more += 1
            return
        row = ['<th scope="row">%s</th>' % text(cells[0])]
        for column, cell in enumerate(cells[1:], 1):
            names = [*(['number'] if column in self._numbers else []), *([classes[column]] if classes and column in classes else [])]
            row.append('<td%s data-label="%s">%s</td>' % (' class="%s"' % ' '.join(names) if names else '', text(self._head[column]),
                                                          '' if cell is None else text(cell)))
        self._rows.append('<tr>%s</tr>' % ''.join(row))

    def __bool__(self):
        return bool(self._rows)

    def html(self):
        head = ''.join('<th scope="col"%s>%s</th>' % (' class="number"' if column in self._numbers else '', text(name))
                       for column, name in enumerate(self._head))
        more = '\n<p>And %d more, which --json has.</p>' % self._more if self._more else ''
        return '<table class="cards">\n<thead><tr>%s</tr></thead>\n<tbody>\n%s\n</tbody>\n</table>%s' % (
            head, '\n'.join(self._rows), more)


def number(value, digits):
    return None if value is None else '%.*f' % (digits, value)


def three_digits(value):
    """A number with at least three digits; large ones without an exponent."""
    return None if value is None else '0' if abs(value) < ROUNDING else '%.3g' % value if abs(value) < 1000 else '%.0f' % value


def local(stamp):
    """A point in time as local time of this computer."""
    return datetime.fromisoformat(stamp.replace('Z', '+00:00')).astimezone().strftime('%Y-%m-%d %H:%M:%S %z')


def clock(seconds):
    minutes, rest = divmod(round(seconds, 1), 60)
    hours, minutes = divmod(int(minutes), 60)
    if not hours and not minutes:
        return '%g s' % (round(seconds) if seconds >= 1 else round(seconds, 1))
    return '%d:%02d:%04.1f h' % (hours, minutes, rest) if hours else '%d:%04.1f min' % (minutes, rest)


def figure(picture):
    return ('<figure id="%s"%s>\n%s\n<figcaption><b>%s.</b> %s</figcaption>\n</figure>'
            % (picture.name, ' class="third"' if picture.name.startswith('section') else '',
               picture.svg.replace('<svg', '<svg role="img" aria-label="%s"' % text(picture.title), 1),
               text(picture.title), text(picture.caption)))


def pictures(parts, name):
    return '<div class="pictures">\n%s\n</div>' % '\n'.join(map(figure, parts[name])) if parts.get(name) else ''


def tool_facts(cutter):
    angles = cutter.get('tooth_angles_deg')
    teeth = len(tooth_angles(cutter))
    cores = dict.fromkeys((cutter['core_diameter_mm'], cutter['core_diameter_end_mm']))
    return [('end diameter', '%g mm' % cutter['end_diameter_mm']), ('flute length', '%g mm' % cutter['flute_length_mm']),
            ('cone', '%g deg' % cutter['cone_angle_deg']),
            ('spiral angle', '%s ± %g deg' % (', '.join('%g' % s for s in spiral_angles(cutter)), cutter['spiral_tolerance_deg'])),
            ('rake', '%g ± %g deg' % (cutter['rake_angle_deg'], cutter['rake_tolerance_deg'])),
            ('core', '%s ± %g mm' % (' to '.join('%g' % d for d in cores), cutter['core_tolerance_mm'])),
            ('clearance', clearances(cutter)),
            ('teeth', '%d%s' % (teeth, ' at ' + ', '.join('%g' % a for a in angles) + ' deg' if angles else '')),
            ('cut', cutter['cut'].replace('_', ' ')), ('shank', '%g mm' % cutter['shank_diameter_mm'])]


def clearances(cutter):
    """The clearances asked for; None without reliefs."""
    if not cutter.get('clearance_deg'):
        return None
    asked = '%g ± %g deg' % (cutter['clearance_deg'], cutter['clearance_tolerance_deg'])
    if not cutter.get('land_mm'):
        return asked
    return '%s, %g mm wide, then %g deg' % (asked, cutter['land_mm'], cutter['second_clearance_deg'])


def wheel_text(wheel):
    corners = wheel.get('corner_radius_mm') or [0, 0]
    return '%s, Ø %g mm, %g mm wide, corners %g and %g mm%s' % (
        PROFILES.get(wheel['profile'], wheel['profile']), wheel['diameter_mm'], wheel['width_mm'], *corners,
        ', %g deg at the %s face' % (wheel['angle_deg'], wheel['side']) if wheel.get('side') else '')


def roughing_text(process):
    """How deep the roughing passes are; records of older versions have infeeds alone."""
    if process.get('roughing_passes'):
        return '%d equal roughing passes' % process['roughing_passes']
    if process.get('removal_mm3_s'):
        return 'up to %g mm^3/s' % process['removal_mm3_s']
    return 'infeed %g mm' % process['infeed_mm']


def process_facts(process):
    setup = process['setup']
    return [('wheel', wheel_text(process['wheel'])), ('wear', '%g mm of the radius' % process['wheel']['wear_mm']),
            ('set-up', 'swivel %g deg, height %g mm%s' % (
                setup['swivel_deg'], setup['height_mm'], ', shift in X %g mm' % setup['x_shift_mm'] if setup.get('x_shift_mm') else '')),
            ('depth' if 'depth_mm' in process else 'operation', '%s%s, %s' % (
                '%g mm' % process['depth_mm'] if 'depth_mm' in process else operation_name(process),
                ', %g mm at the shank' % process['depth_end_mm'] if process.get('depth_end_mm') else '', roughing_text(process))),
            ('feed', '%g mm/min' % process['feed_mm_min'])]


def operations_of(data):
    """The operations with their runs, from the records, or with the single run of a bag."""
    if 'operations' in data or not data.get('job'):
        return data.get('operations', [])
    file = data['job']['file']
    return [{'operation': file['operation'], 'process': process_of(file), 'runs': [data], 'missing': [], 'removal': data.get('removal')}]


def who_and_when(data):
    runs = [run for operation in operations_of(data) for run in operation['runs']] or [data]
    times = ' to '.join(local(run[key]) for run, key in ((runs[0], 'started'), (runs[-1], 'ended')) if key in run)
    return [('operator', data.get('operator')), ('serial number', data.get('serial')), ('ground', times or None),
            ('machine', ', '.join(filter(None, (data.get('machine', {}).get('name'), data.get('grinder')))) or None),
            ('outcome', outcome(data) if data.get('reason') or len(runs) == 1 else None)]


def run_facts(run):
    """The facts of a run, for a developer."""
    machine, offsets, setpoints = run.get('machine', {}), run.get('work_offsets'), run.get('setpoints', {})
    return [('drive', machine.get('drive')), ('software', 'flute_grinder ' + machine['software'] if machine else None),
            ('duration', clock(run['duration_s']) if run.get('duration_s') is not None else None),
            ('work offsets', ', '.join('%s %.4f %s' % (name[0].upper(), value, name[2:]) for name, value in offsets.items())
             if offsets else None),
            ('setpoints', setpoints.get('written')),
            ('missing', '%d setpoints are not in the file' % setpoints['lost'] if setpoints.get('lost') else None)]


def sources(data):
    """The sources of the report."""
    files = [name for operation in data.get('operations', []) for name in operation['files']] or [data['file']]
    return [('file', '%s (%s)' % (', '.join(files), data['type'])), ('job in the bag', data.get('in_bag')),
            ('ground tool', data['tool']['source'] if 'operation' in data.get('tool', {}).get('job', {}) else None)]


def operation_table(data):
    """The operations, with their wheels and outcomes."""
    table = Table(['operation', 'wheel', 'Ø mm', 'wear mm', 'dressed', 'ground', 'strokes', 'outcome'], (2, 3))
    for operation in operations_of(data):
        wheel, runs = operation['process']['wheel'], operation['runs']
        first = runs[0] if runs else {}
        table.add(operation['operation'], first.get('wheel') or wheel['profile'], '%g' % wheel['diameter_mm'], '%g' % wheel['wear_mm'],
                  first.get('dressed'), local(first['started'])[:16] if 'started' in first else None, strokes_text(operation),
                  '; '.join(run['outcome'] for run in runs if 'outcome' in run) if runs else 'not in the records',
                  classes=None if runs else {7: 'not-measured'})
    return table.html()


def strokes_text(operation):
    runs = operation['runs']
    if not any('passes' in run for run in runs):
        return None
    done = '%d of %d' % (runs[0]['passes'] - len(operation['missing']), runs[0]['passes'])
    places = ', '.join('tooth %d pass %d' % (place['tooth'], place['pass']) for place in operation['missing'][:MOST_PLACES])
    more = ' and %d more' % (len(operation['missing']) - MOST_PLACES) if len(operation['missing']) > MOST_PLACES else ''
    return done + ('; missing: %s%s' % (places, more) if places else '')


def zero_points(data):
    """The zero points of each run that has them: when, by whom and how they were set."""
    ignored, table = [], Table(['zero points', 'X', 'Y', 'Z', 'A', 'for'])
    for operation in operations_of(data):
        for run in operation['runs']:
            points = dict(run.get('zero_points', {}))
            if points.pop('said_right', False):
                ignored.append(operation['operation'])
            if not points:
                continue
            bases = dict.fromkeys(', '.join(filter(None, (point['set_for']['job'], point['set_for']['wheel'])))
                                  for point in points.values() if point['set_at'])
            table.add(operation['operation'], *map(zero_point, points.values()), '; '.join(filter(None, bases)),
                      classes={i: 'not-measured' for i, point in enumerate(points.values(), 1) if not point['set_at']})
    note = '<p class="failed">Ground without the check of the zero points (--answer ignore-offsets): %s.</p>' % text(', '.join(ignored))
    return ([note] if ignored else []) + ([table.html()] if table else [])


def zero_point(point):
    if not point['set_at']:
        return 'never set'
    return '%s, %s, %s' % (local(point['set_at'])[:16], point['set_by'], point['set_for']['method'].replace('_', ' '))


def outcome(data):
    if 'outcome' not in data:
        return None
    return data['outcome'] + (': ' + data['reason'] if data.get('reason') else '')


VERDICTS = {'passed': 'PASSED', 'failed': 'FAILED', 'unfinished': 'NOT SHOWN TO BE FINISHED',
            'incomplete': 'PASSED AS FAR AS MEASURED'}


def verdict_line(data):
    said, because = data['verdict'], '; '.join(data['verdict_because'])
    return '<p><span class="verdict %s">%s</span> %s</p>' % (said, VERDICTS[said], text(because))


def shown(value, criterion):
    if value is None:
        return None
    digits = criterion['digits']
    return '%s %s' % (three_digits(value) if digits is None else '%.*f' % (digits, value), criterion['unit'])


def limits(criterion):
    """What is asked, and the tolerance. No length and no share is below 0: one of 0 is asked to be small."""
    asked, tolerance = (shown(criterion[key], criterion) for key in ('asked', 'tolerance'))
    if tolerance is None:
        return asked and '≥ ' + asked, None
    if criterion['asked'] == 0 and criterion['unit'] != 'deg':
        return '≤ ' + tolerance, None
    return asked, '± ' + tolerance


def criteria_table(data, of_tool):
    table = Table(['', 'asked', 'computed' if of_tool else 'measured', 'tolerance', 'result', 'place'], (1, 2, 3))
    for c in data['criteria']:
        if c['of_tool'] != of_tool:
            continue
        asked, tolerance = limits(c)
        table.add(c['name'], asked, c['remark'] or shown(c['measured'], c), tolerance, c['result'], c['place'],
                  classes={4: c['result'].replace(' ', '-')})
    return table.html()


def by_hand(data, cutter):
    """What was measured of the tool itself, and a form for the figures that only such a measurement can show."""
    table = Table(['', 'asked', 'measured', 'instrument'], (1, 2))
    for operation in data.get('operations', []):
        for history in operation.get('measured', []):
            asked = None if history['asked'] is None else '%g ± %g %s' % (history['asked'], history['tolerance'], history['unit'])
            table.add(title_of(history), asked, '%g %s' % (history['value'], history['unit']), '', classes={3: 'blank'})
    figures = [('diameter at the small end', '%g mm' % cutter['end_diameter_mm'])]
    if cutter['cone_angle_deg']:
        figures.append(('diameter at X = %g mm' % cutter['flute_length_mm'], '%.3f mm' % (2 * radius(cutter, cutter['flute_length_mm']))))
    for name, asked in figures + [('run-out', None)]:
        table.add(name, asked, '', '', classes={2: 'blank', 3: 'blank'})
    return table.html()


SIGNED = '<table class="signed"><tr>%s</tr></table>' % ''.join('<td>%s</td>' % what for what in ('operator', 'date', 'signature'))
MODEL = ('Computed from the encoders of the axes through a model of the wheel: this shows the errors of the machine, and none of the '
         "wheel's shape, its dressing or the clamping. The reader's own measurement decides.")


def events_of(data, stroke):
    """The holds and overrides during a stroke."""
    begin, end = stroke['started_s'], stroke['started_s'] + stroke['duration_s']
    events = ['held %.1f s at %.1f s (%s)' % (hold['duration_s'], hold['at_s'], hold['reason']) for hold in data['holds']
              if begin <= hold['at_s'] <= end]
    events += ['override %g %% at %.1f s' % (change['percent'], change['at_s']) for change in data['overrides']
               if begin <= change['at_s'] <= end]
    return '; '.join(events)


def stroke_table(data):
    table = Table(['tooth, pass', 'depth mm', 'begun s', 'time s', 'feed mm/min', 'deviation µm', 'following X, Y, Z µm', 'A mdeg',
                   'holds, overrides'], range(1, 8))
    for stroke in data['strokes']:
        low, high = (number(stroke['feed_%s_mm_min' % which], 1) for which in ('min', 'max'))
        cells = ['%d, %d' % (stroke['tooth'], stroke['pass']), number(stroke['depth_mm'], 4), number(stroke['started_s'], 1),
                 number(stroke['duration_s'], 1), None if low is None else '%s to %s' % (low, high),
                 three_digits(stroke['deviation_um'])]
        errors = stroke['following_error']
        cells += [', '.join(number(errors[key], 2) or '-' for key in ('x_um', 'y_um', 'z_um')), number(errors['a_mdeg'], 2)]
        table.add(*cells, events_of(data, stroke))
    return table.html()


def removal_table(removal):
    """What each pass takes from a tooth, as computed."""
    table = Table(['pass', 'depth mm', 'mm²', 'mm³/s', ''], (1, 2, 3))
    most = max(row['area_mm2'] for row in removal)
    for i, row in enumerate(removal):
        spark_out = i > 0 and row['depth_mm'] == removal[i - 1]['depth_mm']
        bar = '█' * round(BAR * row['area_mm2'] / most) if most > 0 else ''
        table.add(i + 1, number(row['depth_mm'], 4), three_digits(row['area_mm2']), three_digits(row['rate_mm3_s']),
                  bar or ('spark-out' if spark_out else '' if row['area_mm2'] > 0 else 'removes nothing'))
    return '<div class="keep"><p>What each pass removes from a section of a tooth, as computed:</p>\n%s</div>' % table.html()


def events_between(data):
    """The holds and overrides outside the strokes."""
    inside = ' '.join(events_of(data, stroke) for stroke in data['strokes'])
    events = ['Held for %.1f s at %.1f s (%s).' % (h['duration_s'], h['at_s'], h['reason']) for h in data['holds']
              if 'held %.1f s at %.1f s' % (h['duration_s'], h['at_s']) not in inside]
    events += ['Override %g %% at %.1f s.' % (o['percent'], o['at_s']) for o in data['overrides']
               if 'override %g %% at %.1f s' % (o['percent'], o['at_s']) not in inside]
    return '<p>Apart from the strokes: %s</p>' % text(' '.join(events)) if events else ''


def axis_table(data, name):
    per = {'speed': '/s', 'acceleration': '/s²', 'following': ''}[name]
    table = Table(['axis', 'in the strokes', 'between them', 'limit'], (1, 2, 3))
    for row in data['axes']:
        unit = ('deg' if row['axis'] == 'A' else 'mm') + per
        figures = (row[name][key] for key in ('stroke', 'rapid', 'limit'))
        table.add(row['axis'], *('not known' if figure is None else '%.5g %s' % (figure, unit) for figure in figures))
    return table.html()


def state_table(data):
    table = Table(['state', 'from s', 'reason'], (1,))
    for state in data['states']:
        table.add(state['state'], number(state['at_s'], 3), state['reason'])
    return table.html()


def diagnostics_table(data):
    table = Table(['status', 'worst', 'message', 'times'], (3,))
    for status in data['diagnostics']:
        level = status['level']
        table.add(status['name'], LEVELS[level] if level < len(LEVELS) else level, status['message'], status['count'])
    return table.html()


def loop_facts(data):
    loop, late = data['loop'], data['late_cycles']
    return facts([('control cycle', '%.6g ms' % data['period_ms']), ('mean', '%.6f ms' % loop['mean_ms']),
                  ('shortest, longest', '%.3f to %.3f ms' % (loop['shortest_ms'], loop['longest_ms'])),
                  ('late cycles', '%d over 1.5 periods' % late['count'])])


def name_of(data):
    return data.get('job', {}).get('name') or data['file']


def css_string(words):
    return '"%s"' % re.sub(r'[^\w .,·:/-]', lambda found: '\\%06x ' % ord(found.group()), words)


def margins(data):
    """The texts in the margins of every printed page."""
    left = [name_of(data), data.get('tool', {}).get('tool')]
    right = ['No. ' + data['serial'] if 'serial' in data else None, local(data['started'])[:16] if 'started' in data else None]
    return '@page { @top-left { content: %s } @top-right { content: %s } @bottom-left { content: %s } }' % tuple(
        css_string(' · '.join(filter(None, parts))) for parts in (left, right, [data.get('operator')]))


def first_page(data, parts):
    job = data.get('job')
    body = ['<h1>%s</h1>' % text(name_of(data))]
    if 'tool' in data:
        body.append('<p class="quiet">%s</p>' % text(data['tool']['tool']))
    if 'verdict' in data:
        body.append(verdict_line(data))
    if 'note' in data:
        body.append('<p><b>Note:</b> %s</p>' % text(data['note']))
    columns = [facts(who_and_when(data))]
    if job:
        columns = [pictures(parts, 'asked'), facts(tool_facts(job['file']['cutter']) + who_and_when(data))]
    body.append('<div class="columns">\n%s\n</div>' % '\n'.join(columns))
    if 'criteria' in data:
        body += ['<h2>The tool: asked and computed</h2>', criteria_table(data, True), '<p>%s</p>' % MODEL,
                 '<div class="columns"><div><h2>Measured by hand or probe</h2>', by_hand(data, job['file']['cutter']),
                 '</div><div>%s</div></div>' % SIGNED]
    if operations_of(data):
        body += ['<h2>Operations</h2>', operation_table(data), *zero_points(data)]
    return body


def runs(data):
    """The runs: for each operation, its set-up and strokes."""
    body = ['<h2>The run</h2>', criteria_table(data, False)] if 'criteria' in data else []
    for operation in operations_of(data) or [{'operation': '', 'process': None, 'runs': [data]}]:
        for run in operation['runs']:
            if run.get('strokes') or run.get('holds') or run.get('overrides'):
                body.append('<h2>Teeth and passes%s</h2>' % text(': ' + operation['operation'] if operation['operation'] else ''))
            if operation['process']:
                body.append(facts(process_facts(operation['process']) + run_facts(run)))
                body += [removal_table(operation['removal'])] if operation.get('removal') else []
            elif 'setpoints' in run:
                body.append(facts(run_facts(run)))
            body += [stroke_table(run) if run.get('strokes') else '', events_between(run)]
    return body


def for_developers(data, parts):
    """The folded appendix, which is not needed to judge the tool."""
    body = [facts(sources(data))]
    for name, title, *_ in QUANTITIES:
        if parts.get(name):
            body += ['<div class="keep"><h2>%s of the axes</h2>' % title, axis_table(data, name), '</div>', pictures(parts, name)]
    if 'loop' in data:
        body += ['<div class="keep"><h2>Control loop</h2>', loop_facts(data), '</div>', pictures(parts, 'timing')]
    if data.get('states'):
        body += ['<h2>States</h2>', state_table(data)]
    if data.get('diagnostics'):
        body += ['<h2>Diagnostics</h2>', '<p>The worst status of each in the whole bag.</p>', diagnostics_table(data)]
    if parts.get('curve'):
        body += ['<h2>The interpolation, in radians</h2>',
                 facts([('maximum odd error', '%.4e rad' % data['odd_error_rad']),
                        ('maximum even error', '%.4e rad' % data['even_error_rad'])]), pictures(parts, 'curve')]
    return ['<details>\n<summary>Appendix: for developers</summary>', *body, '</details>']


def page(data, parts):
    """The page of a report. @param data the document. @param parts result of draw_all()."""
    body = first_page(data, parts)
    if parts.get('measured'):
        body += ['<h2>Measured, with the tools before it</h2>', pictures(parts, 'measured')]
    if parts.get('tool'):
        body += ['<h2>The ground tool</h2>', pictures(parts, 'tool')]
    body += runs(data)
    if parts.get('feed'):
        body += ['<h2>Feed</h2>', pictures(parts, 'feed')]
    body += for_developers(data, parts)
    if data['left_out']:
        body += ['<h2>Left out</h2>', '<ul>%s</ul>' % ''.join('<li>%s</li>' % text(reason) for reason in data['left_out'])]
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'page.css'), encoding='utf-8') as file:
        style = file.read()
    return PAGE.format(title=text('Report: ' + name_of(data)), style=style + margins(data) + '\n',
                       body='\n'.join(part for part in body if part))
