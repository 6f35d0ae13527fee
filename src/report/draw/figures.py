"""The pictures of a record's rows, from the key "plots" of the document, which is in SI units: m, A in rad."""

import numpy as np

from cutter import process_of
from style import CURVE, EVEN_STYLE, HELD, LIMIT, ODD_STYLE, THEORY, Picture, new_figure

MM = 1e-3
MM_MIN = 1e-3 / 60
MS = 1e-3
DEG = np.pi / 180

LATE = 1.5  # periods after which a cycle counts as late, as in /diagnostics
TIMING_COLUMNS = 200

# Quantities of the axes: key in the document, title, suffix of the unit, caption.
QUANTITIES = [
    ('following', 'Following error', '',
     'Command of the cycle before less the position read; dashed: where the machine stops.'),
    ('speed', 'Speed', '/s',
     'Commanded, from cycle to cycle; dashed: the limit.'),
    ('acceleration', 'Acceleration', '/s²',
     'Commanded, between the ends of odd-even pairs, as the plan checks it; dashed: the limit.')]


def points(line, curve=0):
    """x and y of one curve of `line`: its points, or the minimum and maximum in each column of the picture."""
    return np.array(line['x'], 'f8'), np.array([row[curve] for row in line['y']], 'f8')


def broken(line, gap, curve=0, columns=1.5):
    """As points(), with the curve broken where x has a gap larger than `gap` and than `columns` columns."""
    x, y = points(line, curve)
    breaks = np.flatnonzero(np.diff(x) > max(gap, 0 if line['exact'] else columns * line['width'])) + 1
    return np.insert(x, breaks, np.nan), np.insert(y, breaks, np.nan)


def angle_unit(largest):
    """Scale and name of the unit that shows an angle [rad] in few digits."""
    for scale, name in ((1, 'rad'), (1e-3, 'mrad'), (1e-6, 'µrad'), (1e-9, 'nrad')):
        if largest >= scale:
            return scale, name
    return 1e-12, 'prad'


def axis_unit(axis, per, largest):
    """Number per mm or deg, and name, of an axis' unit: the operator's, or a thousandth for a small maximum [mm or deg]."""
    unit, fine = ('deg', 'mdeg') if axis == 'A' else ('mm', 'µm')
    return (1, unit + per) if largest >= 0.1 else (1000, fine + per)


def curve_pictures(data):
    """Pictures like the paper's Figures 3 to 5, and of the error, for the stroke with the maximum error."""
    curve, every = data['plots']['curve'], data['plots']['curve']['every']
    which = 'tooth %d, pass %d, the stroke with the maximum error' % (curve['tooth'] + 1, curve['pass'] + 1)
    whole = 'A in rad over X in mm for %s; the line is the theoretical curve, %s.' % (
        which, 'with all %d points' % curve['count'] if every == 1
        else 'with one in %d of its %d points' % (every, curve['count']))
    enlarged = 'The %s %d points, A in rad over X in mm, in the order in which they are ground.'
    start, end = curve['start'], curve['end']
    return [
        path_picture('path', 'The curve', whole, curve['whole'], 3),
        path_picture('path-start', 'Its start, enlarged', enlarged % ('first', len(start['x'])), start, 6),
        path_picture('path-end', 'Its end, enlarged', enlarged % ('last', len(end['x'])), end, 6),
        error_picture(data)]


def path_picture(name, title, caption, path, marker):
    figure = new_figure(3.2)
    axes = figure.add_subplot(xlabel='X [mm]', ylabel='A [rad]')
    x, a, error, odd = (np.array(path[key]) for key in ('x', 'a', 'error', 'odd'))
    x = x / MM
    axes.plot(x, a + error, color=THEORY, zorder=1, label='theoretical curve')
    axes.plot(x[odd], a[odd], linestyle='', markersize=marker, label='odd points', **ODD_STYLE)
    axes.plot(x[~odd], a[~odd], linestyle='', markersize=0.8 * marker, label='even points', **EVEN_STYLE)
    axes.ticklabel_format(useOffset=False)
    axes.locator_params('x', nbins=5)
    axes.legend()
    return Picture(name, title, caption, figure)


def error_picture(data):
    figure = new_figure(4)
    panels = figure.subplots(2, sharex=True)
    for axes, name, style in zip(panels, ('odd', 'even'), (ODD_STYLE, EVEN_STYLE)):
        line, largest = data['plots']['curve'][name], data[name + '_error_rad']
        scale, unit = angle_unit(largest)
        if line['exact']:
            x, y = points(line)
            axes.plot(x / MM, y / scale, linestyle='', markersize=3, **style)
        else:
            x, y = broken(line, 0, columns=8)
            axes.plot(x / MM, y / scale, color=style['color'])
        axes.set_ylabel('error of A [%s]' % unit)
        axes.set_title('%s points: max %.4e rad' % (name, largest), loc='left')
    panels[1].set_xlabel('X [mm]')
    return Picture('error', 'Error over X',
                   'Theory minus commanded position of A over X in mm, above at the odd points, below at the even points, '
                   'each with its own scale.', figure)


class Clock:
    """The time axis of all pictures, with the holds shaded."""

    def __init__(self, data):
        clock = data['plots']['clock']
        self.period = clock['period']
        self.gap = 2.5 * self.period
        self.range = clock['from'], clock['to']
        self._holds = data['holds']

    def finish(self, axes):
        for hold in self._holds:
            axes.axvspan(hold['at_s'], hold['at_s'] + hold['duration_s'], color=HELD, alpha=0.5, linewidth=0)
        axes.set_xlim(*self.range)


def feed_picture(data, clock):
    """The feed of the strokes, and the override."""
    asked = process_of(data['job']['file'])['feed_mm_min'] if data.get('job') else None
    figure = new_figure(3)
    axes = figure.add_subplot(xlabel='time since the start [s]', ylabel='feed [mm/min]')
    time, feed = broken(data['plots']['feed'], clock.gap)
    axes.plot(time, feed / MM_MIN, color=CURVE)
    if asked is not None:
        times, factors = [clock.range[0]], [1.0]
        for override in data['overrides']:
            times.append(max(override['at_s'], times[0]))
            factors.append(override['percent'] / 100)
        axes.step(times + [clock.range[1]], [asked * f for f in factors + factors[-1:]], where='post', color=LIMIT,
                  linestyle='--')
    axes.set_ylim(bottom=0)
    clock.finish(axes)
    return Picture('feed', 'Feed', 'Along the cutting edge in the strokes, in mm/min over the time in s%s; shaded: held.'
                   % ('; dashed: asked, with the override' if asked is not None else ''), figure)


def axis_picture(data, clock, quantity, curve):
    """A quantity of an axis over time, in the strokes and outside them."""
    key, title, per, caption = quantity
    row = data['axes'][curve]
    axis, maxima = row['axis'], row[key]
    scale, name = (DEG, 'deg') if axis == 'A' else (MM, 'mm')
    figure = new_figure(3.4)
    panels = figure.subplots(2, sharex=True)
    for axes, part, where in zip(panels, ('stroke', 'rapid'), ('in the strokes', 'between them')):
        top, limit = maxima[part], maxima['limit']
        many, unit = axis_unit(axis, per, top)
        time, values = broken(data['plots'][key][part], clock.gap, curve)
        axes.plot(time, values / scale * many, color=CURVE)
        for sign in (-1, 1) if limit is not None else ():
            axes.axhline(sign * limit * many, color=LIMIT, linestyle='--')
        # Scaled by the maximum: a following error in a stroke is a small part of the limit.
        span = 1.1 * top * many or 1.0
        axes.set(ylim=(-span, span), ylabel=unit)
        of_limit = '' if limit is None else ', %.3g %% of the limit' % (100 * top / limit)
        axes.set_title('%s: max %.4g %s%s' % (where, top * many, unit, of_limit), loc='left')
        clock.finish(axes)
    panels[1].set_xlabel('time since the start [s]')
    return Picture('%s-%s' % (key, axis.lower()), '%s of %s' % (title, axis),
                   '%s Time in s, each part with its own scale in %s.' % (caption, name), figure)


def timing_picture(data, clock):
    """A histogram of the periods of the control loop."""
    width, given = data['plots']['timing']['width'], data['plots']['timing']['counts']
    figure = new_figure(3)
    axes = figure.add_subplot(xlabel='control cycle [ms]', ylabel='number of cycles', yscale='log')
    shown = int(max(2 * clock.period, data['loop']['longest_ms'] * MS) / width) + 1
    each = -(-shown // TIMING_COLUMNS)
    columns = -(-shown // each)
    counts = np.zeros(columns * each, 'i8')
    known = min(len(counts), len(given))
    counts[:known] = given[:known]
    counts = counts.reshape(columns, each).sum(axis=1)
    edges = np.arange(columns + 1) * each * width / MS
    axes.fill_between(edges, np.append(counts, 0), step='post', color=CURVE, linewidth=0)
    axes.axvline(clock.period / MS, color=THEORY, linestyle=':', label='nominal')
    axes.axvline(LATE * clock.period / MS, color=LIMIT, linestyle='--', label='late from here on')
    axes.set_ylim(bottom=0.5)
    axes.legend()
    return Picture('timing', 'Loop timing',
                   'Number of control cycles by their measured length in ms, on a logarithmic scale.', figure)


def plot_pictures(data):
    """Lists of pictures by the part of the report."""
    plots, clock = data['plots'], Clock(data)
    found = {quantity[0]: [axis_picture(data, clock, quantity, curve) for curve in range(len(data['axes']))] for quantity in QUANTITIES}
    found['timing'] = [timing_picture(data, clock)]
    if 'feed' in plots:
        found['feed'] = [feed_picture(data, clock)]
    if 'curve' in plots:
        found['curve'] = curve_pictures(data)
    return found
