"""The pictures of a report, as SVG. Shapes repeat the meaning of colours, so that they can be read in grey."""

import io
import math
from collections import namedtuple

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from envelope import Envelope
from motion import LATE, motions
from record import A, AXES, DEG, MM, MM_MIN, EVEN, ODD, ROW, X

ENLARGED = 10  # points at either end, like the rows of the paper's Table 1
SHOWN = 200  # points of the whole curve

Picture = namedtuple('Picture', 'name title caption svg')

# Colours differ in lightness too.
THEORY, CURVE, LIMIT = '#888888', '#1f4e8c', '#c03020'
ODD_STYLE = {'marker': 'o', 'color': '#d96c00', 'markerfacecolor': 'none'}
EVEN_STYLE = {'marker': 's', 'color': CURVE}

matplotlib.rcParams.update({
    'axes.axisbelow': True, 'axes.grid': True, 'axes.spines.right': False, 'axes.spines.top': False, 'axes.titlesize': 9,
    'font.size': 9, 'grid.color': '#dddddd', 'grid.linewidth': 0.6, 'legend.frameon': False, 'lines.linewidth': 0.9,
    'svg.hashsalt': 'grind report'})


def picture(name, title, caption, figure):
    buffer = io.BytesIO()
    figure.savefig(buffer, format='svg', metadata={'Date': None})
    return Picture(name, title, caption, buffer.getvalue())


def angle_unit(largest):
    """Scale and name of the unit that shows an angle [rad] in few digits."""
    for scale, name in ((1, 'rad'), (1e-3, 'mrad'), (1e-6, 'µrad'), (1e-9, 'nrad')):
        if largest >= scale:
            return scale, name
    return 1e-12, 'prad'


def axis_units(per=''):
    """For each axis the scale and the name of the operator's unit."""
    return [(MM, 'mm' + per)] * 3 + [(DEG, 'deg' + per)]


class Stroke:
    """The stroke with the largest error: `whole` (thinned to some hundred points), `start` and `end` (its first and last
    points), all in the order in which they are ground."""

    def __init__(self, record):
        self._find_worst(record)
        self.count = sum(len(rows) for rows in self._parts(record))
        # An odd number, so that odd and even points alternate.
        self.every = math.ceil(self.count / SHOWN) // 2 * 2 + 1
        whole, seen = [], 0
        self.start = self.end = np.zeros(0, ROW)
        for rows in self._parts(record):
            whole.append(rows[(seen + np.arange(len(rows))) % self.every == 0])
            seen += len(rows)
            self.start = np.concatenate([self.start, rows])[:ENLARGED]
            self.end = np.concatenate([self.end, rows])[-ENLARGED:]
        self.whole = np.concatenate(whole)

    def _find_worst(self, record):
        largest = -1
        for rows in record.stroke_blocks():
            if len(rows) and np.abs(rows['error']).max() > largest:
                worst = rows[np.argmax(np.abs(rows['error']))]
                largest, self.tooth, self.pass_ = abs(worst['error']), worst['tooth'], worst['pass']

    def _parts(self, record):
        for rows in record.stroke_blocks():
            yield rows[(rows['tooth'] == self.tooth) & (rows['pass'] == self.pass_)]


def path_pictures(record):
    """The curve with its odd and even points, as the paper's Figures 3 to 5."""
    stroke = Stroke(record)
    which = 'the table' if record.kind == 'table' else 'tooth %d, pass %d' % (stroke.tooth + 1, stroke.pass_ + 1)
    whole = 'A in rad over X in mm for %s%s; the line is the theoretical curve, %s.' % (
        which, '' if record.kind == 'table' else ', the stroke with the largest error',
        'with all %d points' % stroke.count if stroke.every == 1
        else 'with one in %d of its %d points' % (stroke.every, stroke.count))
    enlarged = 'The %s %d points, A in rad over X in mm, in the order in which they are ground.'
    return [
        path_picture('path', 'The curve', whole, stroke.whole, (9, 4.2), 3),
        path_picture('path-start', 'Its start, enlarged', enlarged % ('first', len(stroke.start)), stroke.start,
                     (4.6, 3.8), 6),
        path_picture('path-end', 'Its end, enlarged', enlarged % ('last', len(stroke.end)), stroke.end, (4.6, 3.8), 6)]


def path_picture(name, title, caption, rows, size, marker):
    figure = Figure(size, layout='constrained')
    axes = figure.add_subplot(xlabel='X [mm]', ylabel='A [rad]')
    x, a = rows['position'][:, X] / MM, rows['position'][:, A]
    odd = rows['step'] == ODD
    axes.plot(x, a + rows['error'], color=THEORY, zorder=1, label='theoretical curve')
    axes.plot(x[odd], a[odd], linestyle='', markersize=marker, label='odd points', **ODD_STYLE)
    axes.plot(x[~odd], a[~odd], linestyle='', markersize=0.8 * marker, label='even points', **EVEN_STYLE)
    axes.ticklabel_format(useOffset=False)
    axes.locator_params('x', nbins=5 if size[0] < 6 else 9)
    axes.legend()
    return picture(name, title, caption, figure)


def plot_over_x(axes, envelope, scale, style):
    """Draws points as markers or, if there are many, as a line as wide as their scatter."""
    if envelope.is_exact:
        x, y = envelope.points()
        axes.plot(x / MM, y / scale, linestyle='', markersize=3, **style)
    else:
        x, y = envelope.line(0, columns=8)
        axes.plot(x / MM, y / scale, color=style['color'])


def error_picture(record, key):
    """The error over X, of odd and of even points."""
    figure = Figure((9, 5), layout='constrained')
    panels = figure.subplots(2, sharex=True)
    for axes, name, step, style, largest in ((panels[0], 'odd', ODD, ODD_STYLE, key.odd_error),
                                             (panels[1], 'even', EVEN, EVEN_STYLE, key.even_error)):
        scale, unit = angle_unit(largest)
        envelope = Envelope(key.low_x, key.high_x, key.points)
        for rows in record.stroke_blocks():
            rows = rows[rows['step'] == step]
            envelope.add(rows['position'][:, X], rows['error'])
        plot_over_x(axes, envelope, scale, style)
        axes.set_ylabel('error of A [%s]' % unit)
        axes.set_title('%s points: largest %.4e rad' % (name, largest), loc='left')
    panels[1].set_xlabel('X [mm]')
    return picture('error', 'Error over X',
                   'Theory minus commanded position of A over X in mm, above at the odd points, below at the even points, '
                   'each with its own scale.', figure)


def feed_picture(record, key):
    figure = Figure((9, 3), layout='constrained')
    axes = figure.add_subplot(xlabel='X [mm]', ylabel='feed [mm/min]')
    envelope = Envelope(key.low_x, key.high_x, key.points)
    for rows in record.stroke_blocks():
        envelope.add(rows['position'][:, X], rows['feed'])
    plot_over_x(axes, envelope, MM_MIN, EVEN_STYLE)
    axes.set_ylim(bottom=0)
    return picture('feed', 'Feed', 'Feed along the cutting edge in mm/min over X in mm, of all strokes.', figure)


def time_range(record):
    return record.first['cycle'] * record.period, record.last['cycle'] * record.period


def motion_pictures(record, key, limits):
    """Speeds, accelerations and, where the source has positions read from the drive, following errors of the axes."""
    wanted = [
        ('speed', 'Axis speeds', 'largest speed', '/s', limits.speed, key.speed,
         'Differences of the commanded positions from cycle to cycle, in mm/s, A in deg/s, over time in s; dashed: the limits.'),
        ('acceleration', 'Axis accelerations', 'largest acceleration', '/s²', limits.acceleration, key.acceleration,
         'Second differences of the commanded positions between the ends of odd-even pairs, as the plan checks them, in mm/s², '
         'A in deg/s², over time in s; dashed: the limits.')]
    if record.has_actual:
        wanted.append(('following', 'Following error', 'largest following error', '', limits.following, key.following,
                       'Commanded position of the previous cycle minus measured position, in mm, A in deg, over time in s; '
                       'dashed: the limit at which the machine stops.'))
    envelopes = {name: Envelope(*time_range(record), key.points, 4) for name, *_ in wanted}
    for motion in motions(record):
        for name, envelope in envelopes.items():
            envelope.add(*getattr(motion, name))
    return [motion_picture(envelopes[name], name, title, what, axis_units(per), limit, largest.values, caption, record.period)
            for name, title, what, per, limit, largest, caption in wanted]


def motion_picture(envelope, name, title, what, units, limits, largest, caption, period):
    figure = Figure((9, 7.5), layout='constrained')
    time, values = envelope.line(2.5 * period)
    for axis, axes in enumerate(figure.subplots(4, sharex=True)):
        scale, unit = units[axis]
        axes.plot(time, values[:, axis] / scale, color=CURVE)
        for sign in (-1, 1):
            axes.axhline(sign * limits[axis] / scale, color=LIMIT, linestyle='--')
        top = 1.1 * max(limits[axis], largest[axis]) / scale
        axes.set(ylim=(-top, top), ylabel=unit)
        axes.set_title('%s: %s %.4g %s, %.0f %% of the limit' % (
            AXES[axis], what, largest[axis] / scale, unit, 100 * largest[axis] / limits[axis]), loc='left')
    axes.set_xlabel('time since the start of the job [s]')
    return picture(name, title, caption, figure)


def timing_picture(record, key):
    """A histogram of the periods of the control loop."""
    figure = Figure((9, 3), layout='constrained')
    axes = figure.add_subplot(xlabel='control cycle [ms]', ylabel='number of cycles', yscale='log')
    edges = np.linspace(0, max(2 * record.period, key.longest_period), 201)
    counts = sum(np.histogram(rows['cycle_period'], edges)[0] for rows in record.blocks())
    axes.stairs(counts, edges / 1e-3, fill=True, color=CURVE)
    axes.axvline(record.period / 1e-3, color='black', linestyle=':', label='nominal')
    axes.axvline(LATE * record.period / 1e-3, color=LIMIT, linestyle='--', label='late from here on')
    axes.set_ylim(bottom=0.5)
    axes.legend()
    return picture('timing', 'Loop timing',
                   'Number of control cycles by their measured length in ms, on a logarithmic scale.', figure)


def draw(record, key, limits):
    """All pictures for which the record has data, in the order of the report."""
    pictures = []
    if key.strokes > 0:
        pictures += path_pictures(record) + [error_picture(record, key)]
    if key.strokes > 0 and record.kind != 'table':
        pictures.append(feed_picture(record, key))
    if record.kind != 'table':
        pictures += motion_pictures(record, key, limits)
    if record.kind == 'bag':
        pictures.append(timing_picture(record, key))
    return pictures
