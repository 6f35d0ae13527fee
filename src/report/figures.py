"""The pictures of a record's rows, as SVG."""

import math

import numpy as np

from envelope import Envelope
from motion import LATE
from record import A, AXES, DEG, MM, MM_MIN, MS, ODD, ROW, X
from style import CURVE, EVEN_STYLE, HELD, LIMIT, ODD_STYLE, THEORY, new_figure, picture

ENLARGED = 10  # points at either end, like the rows of the paper's Table 1
SHOWN = 200  # points of the whole curve

# Of the axes: key in Motion and Figures, title, per, key of the limits, caption.
QUANTITIES = [
    ('following', 'Following error', '', 'max_following_error',
     'Command of the cycle before less the position read; dashed: where the machine stops.'),
    ('speed', 'Speed', '/s', 'max_velocity',
     'Commanded, from cycle to cycle; dashed: the limit.'),
    ('acceleration', 'Acceleration', '/s²', 'max_acceleration',
     'Commanded, between the ends of odd-even pairs, as the plan checks it; dashed: the limit.')]


def angle_unit(largest):
    """Scale and name of the unit that shows an angle [rad] in few digits."""
    for scale, name in ((1, 'rad'), (1e-3, 'mrad'), (1e-6, 'µrad'), (1e-9, 'nrad')):
        if largest >= scale:
            return scale, name
    return 1e-12, 'prad'


def axis_unit(axis, per='', largest=1.0):
    """Scale and name of the operator's unit for a value of an axis; a thousandth of it for small ones."""
    scale, unit, fine = (DEG, 'deg', 'mdeg') if axis == A else (MM, 'mm', 'µm')
    return (scale, unit + per) if largest >= 0.1 * scale else (scale / 1000, fine + per)


class Curve:
    """The curve and its errors. Of the stroke with the maximum error: `whole` (thinned to some hundred points), `start` and `end`
    (its first and last points), all in the order in which they are ground."""

    def __init__(self, record):
        self._record = record
        self._count = 0
        # An odd number, so that odd and even points alternate.
        self._every = 1
        self._whole = self._start = self._end = np.zeros(0, ROW)
        self._errors = [Envelope(record.low_x, record.high_x, record.count) for _ in range(2)]

    def add(self, rows):
        """@param rows with an odd or an even step."""
        odd = rows['step'] == ODD
        for envelope, part in zip(self._errors, (odd, ~odd)):
            envelope.add(rows['position'][part, X], rows['error'][part])
        tooth, pass_ = self._record.worst
        worst = rows[(rows['tooth'] == tooth) & (rows['pass'] == pass_)]
        if not len(worst):
            return
        # Thinned whenever there are too many, so that no more are kept of a long stroke.
        chosen = worst[(self._count + np.arange(len(worst))) % self._every == 0]
        self._count += len(worst)
        self._whole = np.concatenate([self._whole, chosen])
        while len(self._whole) > 3 * SHOWN:
            self._whole, self._every = self._whole[::3], 3 * self._every
        self._start = np.concatenate([self._start, worst])[:ENLARGED]
        self._end = np.concatenate([self._end, worst])[-ENLARGED:]

    def pictures(self):
        """As the paper's Figures 3 to 5, and of the error."""
        tooth, pass_ = self._record.worst
        is_table = self._record.kind == 'table'
        which = 'the table' if is_table else 'tooth %d, pass %d, the stroke with the maximum error' % (tooth + 1, pass_ + 1)
        whole = 'A in rad over X in mm for %s; the line is the theoretical curve, %s.' % (
            which, 'with all %d points' % self._count if self._every == 1
            else 'with one in %d of its %d points' % (self._every, self._count))
        enlarged = 'The %s %d points, A in rad over X in mm, in the order in which they are ground.'
        return [
            path_picture('path', 'The curve', whole, self._whole, 3),
            path_picture('path-start', 'Its start, enlarged', enlarged % ('first', len(self._start)), self._start, 6),
            path_picture('path-end', 'Its end, enlarged', enlarged % ('last', len(self._end)), self._end, 6),
            self._error_picture()]

    def _error_picture(self):
        figure = new_figure(4)
        panels = figure.subplots(2, sharex=True)
        for axes, name, envelope, style, largest in zip(panels, ('odd', 'even'), self._errors, (ODD_STYLE, EVEN_STYLE),
                                                        (self._record.odd_error, self._record.even_error)):
            scale, unit = angle_unit(largest)
            if envelope.is_exact:
                x, y = envelope.points()
                axes.plot(x / MM, y / scale, linestyle='', markersize=3, **style)
            else:
                x, y = envelope.line(0, columns=8)
                axes.plot(x / MM, y / scale, color=style['color'])
            axes.set_ylabel('error of A [%s]' % unit)
            axes.set_title('%s points: max %.4e rad' % (name, largest), loc='left')
        panels[1].set_xlabel('X [mm]')
        return picture('error', 'Error over X',
                       'Theory minus commanded position of A over X in mm, above at the odd points, below at the even points, '
                       'each with its own scale.', figure)


def path_picture(name, title, caption, rows, marker):
    figure = new_figure(3.2)
    axes = figure.add_subplot(xlabel='X [mm]', ylabel='A [rad]')
    x, a = rows['position'][:, X] / MM, rows['position'][:, A]
    odd = rows['step'] == ODD
    axes.plot(x, a + rows['error'], color=THEORY, zorder=1, label='theoretical curve')
    axes.plot(x[odd], a[odd], linestyle='', markersize=marker, label='odd points', **ODD_STYLE)
    axes.plot(x[~odd], a[~odd], linestyle='', markersize=0.8 * marker, label='even points', **EVEN_STYLE)
    axes.ticklabel_format(useOffset=False)
    axes.locator_params('x', nbins=5)
    axes.legend()
    return picture(name, title, caption, figure)


class Clock:
    """The time axis of all pictures, with the holds shaded."""

    def __init__(self, record):
        self.range = record.begin, record.end
        self.holds = []
        self.gap = 2.5 * record.period

    def finish(self, axes):
        for hold in self.holds:
            axes.axvspan(hold['at_s'], hold['at_s'] + hold['duration_s'], color=HELD, alpha=0.5, linewidth=0)
        axes.set_xlim(*self.range)


class Feed:
    """The feed of the strokes, and the override."""

    def __init__(self, record, clock):
        self._clock = clock
        self._envelope = Envelope(*clock.range, record.count)

    def add(self, motion):
        self._envelope.add(motion.time[motion.stroke], motion.rows['feed'][motion.stroke])

    def picture(self, asked, overrides):
        figure = new_figure(3)
        axes = figure.add_subplot(xlabel='time since the start [s]', ylabel='feed [mm/min]')
        time, feed = self._envelope.line(self._clock.gap)
        axes.plot(time, feed / MM_MIN, color=CURVE)
        if asked is not None:
            times, factors = [self._clock.range[0]], [1.0]
            for override in overrides:
                times.append(max(override['at_s'], times[0]))
                factors.append(override['percent'] / 100)
            axes.step(times + [self._clock.range[1]], [asked * f for f in factors + factors[-1:]], where='post', color=LIMIT,
                      linestyle='--')
        axes.set_ylim(bottom=0)
        self._clock.finish(axes)
        return picture('feed', 'Feed', 'Along the cutting edge in the strokes, in mm/min over the time in s%s; shaded: held.'
                       % ('; dashed: asked, with the override' if asked is not None else ''), figure)


class AxisPictures:
    """A quantity of the axes over time, in the strokes and apart from them."""

    def __init__(self, record, clock, key, title, per, caption):
        self._clock, self._key, self._title, self._per, self._caption = clock, key, title, per, caption
        self._envelopes = [Envelope(*clock.range, record.count, len(AXES)) for _ in range(2)]

    def add(self, motion):
        known, values = getattr(motion, self._key)
        for envelope, part in zip(self._envelopes, (motion.stroke, ~motion.stroke)):
            chosen = known & part
            envelope.add(motion.time[chosen], values[chosen])

    def pictures(self, largest, limits):
        """largest: of strokes and rapids; limits: of the axes, or None."""
        return [self._picture(axis, [l.values[axis] for l in largest], limits[axis] if limits is not None else None)
                for axis in range(len(AXES))]

    def _picture(self, axis, largest, limit):
        figure = new_figure(3.4)
        panels = figure.subplots(2, sharex=True)
        for axes, envelope, top, where in zip(panels, self._envelopes, largest, ('in the strokes', 'between them')):
            scale, unit = axis_unit(axis, self._per, top)
            time, values = envelope.line(self._clock.gap)
            axes.plot(time, values[:, axis] / scale, color=CURVE)
            share = ''
            if limit is not None:
                share = ', %.3g %% of the limit' % (100 * top / limit)
                for sign in (-1, 1):
                    axes.axhline(sign * limit / scale, color=LIMIT, linestyle='--')
            # Following errors in a stroke are a small part of the limit, which would hide them.
            span = 1.1 * top / scale or 1.0
            axes.set(ylim=(-span, span), ylabel=unit)
            axes.set_title('%s: max %.4g %s%s' % (where, top / scale, unit, share), loc='left')
            self._clock.finish(axes)
        panels[1].set_xlabel('time since the start [s]')
        return picture('%s-%s' % (self._key, AXES[axis].lower()), '%s of %s' % (self._title, AXES[axis]),
                       '%s Time in s, each part with its own scale in %s.' % (self._caption, 'deg' if axis == A else 'mm'), figure)


class Timing:
    """A histogram of the periods of the control loop."""

    COLUMNS = 200

    def __init__(self, period):
        self._period = period
        # Far beyond what the picture shows: how late a cycle can be is not known before all are read.
        self._width = period / 50
        self._counts = np.zeros(1 << 16, 'i8')

    def add(self, motion):
        column = np.minimum(motion.rows['cycle_period'] / self._width, len(self._counts) - 1).astype('i8')
        self._counts += np.bincount(column, minlength=len(self._counts))

    def picture(self, longest):
        figure = new_figure(3)
        axes = figure.add_subplot(xlabel='control cycle [ms]', ylabel='number of cycles', yscale='log')
        shown = int(max(2 * self._period, longest) / self._width) + 1
        each = -(-shown // self.COLUMNS)
        columns = -(-shown // each)
        counts = np.zeros(columns * each, 'i8')
        known = min(len(counts), len(self._counts))
        counts[:known] = self._counts[:known]
        counts = counts.reshape(columns, each).sum(axis=1)
        edges = np.arange(columns + 1) * each * self._width / MS
        axes.fill_between(edges, np.append(counts, 0), step='post', color=CURVE, linewidth=0)
        axes.axvline(self._period / MS, color=THEORY, linestyle=':', label='nominal')
        axes.axvline(LATE * self._period / MS, color=LIMIT, linestyle='--', label='late from here on')
        axes.set_ylim(bottom=0.5)
        axes.legend()
        return picture('timing', 'Loop timing',
                       'Number of control cycles by their measured length in ms, on a logarithmic scale.', figure)


class Plots:
    """All pictures of a record."""

    def __init__(self, record):
        self._clock = Clock(record)
        self._axes = {key: AxisPictures(record, self._clock, key, title, per, caption)
                      for key, title, per, _, caption in QUANTITIES if key != 'following' or record.has_actual}
        self._feed, self._curve = (Feed(record, self._clock), Curve(record)) if record.worst else (None, None)
        self._timing = Timing(record.period) if record.kind == 'bag' else None

    def add(self, motion):
        for pictures in self._axes.values():
            pictures.add(motion)
        if self._curve:
            self._feed.add(motion)
            self._curve.add(motion.rows[motion.stroke])
        if self._timing:
            self._timing.add(motion)

    def pictures(self, figures, data, limits):
        """Lists by the part of the report."""
        self._clock.holds = data['holds']
        found = {key: self._axes[key].pictures(getattr(figures, key), limits.get(limit)) for key, _, _, limit, _ in QUANTITIES
                 if key in self._axes}
        if self._timing:
            found['timing'] = [self._timing.picture(figures.longest_period)]
        if self._curve:
            asked = data['job']['file']['process']['feed_mm_min'] if data.get('job') else None
            found['feed'] = [self._feed.picture(asked, data['overrides'])]
            found['curve'] = self._curve.pictures()
        return found


class TablePlots:
    """All pictures of a table's points."""

    def __init__(self, record):
        self._curve = Curve(record)
        for rows, _ in record.blocks():
            self._curve.add(rows[rows['step'] != 0])

    def pictures(self, *_):
        return {'curve': self._curve.pictures()}
