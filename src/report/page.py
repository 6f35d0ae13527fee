"""Writes key figures and pictures into a self-contained HTML file."""

import base64
import html

from figures import axis_units
from record import AXES, MM_MIN, UM

PAGE = '''<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>{title}</title>
<style>
body {{ font: 15px/1.45 sans-serif; color: #222; background: #fff; max-width: 62em; margin: 2em auto; padding: 0 1em; }}
h1 {{ font-size: 1.5em; }} h2 {{ font-size: 1.15em; margin-top: 2em; }}
table {{ border-collapse: collapse; margin: .6em 0; }}
th, td {{ border-bottom: 1px solid #ddd; padding: .2em 1.2em .2em 0; text-align: left; vertical-align: top; }}
tr.figures :not(:first-child) {{ text-align: right; font-variant-numeric: tabular-nums; }}
figure {{ margin: 1.5em 0; break-inside: avoid; }} figure.half {{ display: inline-block; width: 49%; margin: 0; }}
figure img {{ width: 100%; }} figcaption {{ color: #444; font-size: .93em; }} figcaption b {{ color: #222; }}
@media print {{ body {{ max-width: none; margin: 0; font-size: 10pt; }} }}
</style>
</head>
<body>
<h1>{title}</h1>
{body}
</body>
</html>
'''

KINDS = {'table': 'points of a curve, from "grind table"', 'setpoints': 'setpoints, from "grind plan"',
         'run': 'setpoints, from "grind run"', 'bag': 'record of the grinder (bag)'}
LEVELS = ['OK', 'WARN', 'ERROR', 'STALE']
MOST_STATES = 100


def table(rows, head=()):
    """Rows of text; with a head, all but the first column are numbers."""
    row = '<tr class="figures">%s</tr>' if head else '<tr>%s</tr>'
    lines = [row % ''.join('<th>%s</th>' % html.escape(text) for text in head)] if head else []
    for first, *others in rows:
        cells = ''.join('<td>%s</td>' % html.escape(text) for text in others)
        lines.append(row % ('<th>%s</th>%s' % (html.escape(first), cells)))
    return '<table>\n%s\n</table>' % '\n'.join(lines)


def key_figures(record, key):
    # As `grind table` and the paper count them: point 0 is where the curve starts.
    rows = [('points', str(key.points - (record.kind == 'table')))]
    if record.kind != 'table':
        rows += [('duration', '%.3f s' % key.duration), ('control cycle', '%.6g ms' % (record.period / 1e-3)),
                 ('strokes', str(key.strokes))]
    if record.missing:
        rows.append(('missing', '%d setpoints are not in the file' % record.missing))
    if key.strokes > 0:
        rows += [('largest odd error', '%.4e rad' % key.odd_error), ('largest even error', '%.4e rad' % key.even_error)]
    if record.max_deviation is not None:
        rows.append(('largest deviation', '%.3g µm at the cutter\'s surface, as planned' % (record.max_deviation / UM)))
    if key.strokes > 0 and record.kind != 'table':
        rows.append(('largest feed', '%.6f mm/min along the cutting edge' % (key.feed / MM_MIN)))
    if record.kind == 'bag':
        rows += [('mean loop period', '%.6f ms' % (key.mean_period / 1e-3)),
                 ('loop period', '%.3f to %.3f ms' % (key.shortest_period / 1e-3, key.longest_period / 1e-3)),
                 ('late cycles', '%d over 1.5 periods' % key.late_cycles)]
    return table(rows)


def axis_table(record, key, limits):
    columns = [('speed', '/s', key.speed, limits.speed), ('acceleration', '/s²', key.acceleration, limits.acceleration)]
    if record.has_actual:
        columns.append(('following error', '', key.following, limits.following))
    rows = []
    for axis, name in enumerate(AXES):
        row = [name]
        for _, per, largest, limit in columns:
            scale, unit = axis_units(per)[axis]
            row += ['%.5g %s' % (largest.values[axis] / scale, unit), '%.5g %s' % (limit[axis] / scale, unit)]
        rows.append(row)
    return table(rows, ['axis'] + [text for name, *_ in columns for text in ('largest ' + name, 'limit')])


def state_table(record):
    rows = [('%.3f s' % time, state, reason) for time, state, reason in record.states[:MOST_STATES]]
    if len(record.states) > MOST_STATES:
        rows.append(('', 'and %d more' % (len(record.states) - MOST_STATES), ''))
    return table(rows)


def diagnostics_table(record):
    rows = []
    for name, level, message, count in record.diagnostics:
        word = LEVELS[level] if level < len(LEVELS) else str(level)
        rows.append((name, word, message, '× %d' % count))
    return table(rows)


def left_out(record, key):
    """Lists missing data, and why it is missing."""
    reasons = []
    if key.strokes == 0:
        reasons.append('Curve, error and feed: the job ended before its first stroke.')
    if record.kind == 'table':
        reasons.append('Feed, axis speeds and accelerations, following error, loop timing: the points of a table have no time.')
    if record.kind == 'setpoints':
        reasons.append('Following error and loop timing: the CSV file of a plan has only commanded values; a bag has more.')
    if record.kind == 'run':
        reasons.append('Loop timing: a CSV file does not have it; a bag does.')
    if record.max_deviation is None:
        reasons.append('Deviation at the cutter\'s surface: it depends on the cutter\'s radius, which %s.' % (
            'is in the job result, which is not in the bag' if record.kind == 'bag' else 'a CSV file does not have'))
    if record.no_tool:
        reasons.append('The ground tool: %s' % record.no_tool)
    return '<ul>\n%s\n</ul>' % '\n'.join('<li>%s</li>' % html.escape(reason) for reason in reasons) if reasons else ''


def figure(picture):
    data = base64.b64encode(picture.svg).decode()
    return ('<figure id="%s"%s>\n<img alt="%s" src="data:image/svg+xml;base64,%s">\n<figcaption><b>%s.</b> %s</figcaption>\n'
            '</figure>') % (picture.name, ' class="half"' if picture.name.startswith('path-') else '',
                            html.escape(picture.title), data, html.escape(picture.title), html.escape(picture.caption))


def page(name, record, key, limits, pictures):
    """The report of a file of this name."""
    parts = [table([('file', name), ('type', KINDS[record.kind]), *record.facts]), '<h2>Key figures</h2>',
             key_figures(record, key)]
    if record.kind != 'table':
        parts.append(axis_table(record, key, limits))
    parts += ['<h2>Pictures</h2>', *map(figure, pictures)]
    if record.states:
        parts += ['<h2>States</h2>', '<p>Time since the start of the job.</p>', state_table(record)]
    if record.diagnostics:
        parts += ['<h2>Diagnostics</h2>', '<p>The worst status of each in the whole bag.</p>', diagnostics_table(record)]
    missing = left_out(record, key)
    if missing:
        parts += ['<h2>Left out</h2>', missing]
    return PAGE.format(title=html.escape('Report: ' + name), body='\n'.join(parts))
