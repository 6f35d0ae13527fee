"""The figures of a run of `scripts/bench`: what is said of samples, tables as text and for the documentation, and the
comparison of two runs. A run is what its JSON file holds:

    {"commit": ..., "date": ..., "cpu": ..., "cores": ..., "kernel": ..., "realtime": true,
     "figures": {NAME: {"label": ..., "unit": ..., "median": ..., "p99": ..., "count": ..., "floor": NAME}}}

`p99` and `floor` are missing where there is none; `count` is of the samples."""

import math
import re
import statistics

FACTORS = {'s': 1, 'ms': 1e3, 'us': 1e6, 'ns': 1e9}
MACHINE = ('cpu', 'cores', 'kernel', 'realtime')
MARKS = ('<!-- begin: %s -->', '<!-- end: %s -->')


def percentile(samples, fraction):
    """The smallest sample that is not exceeded by at least this fraction of all."""
    return sorted(samples)[max(0, math.ceil(fraction * len(samples)) - 1)]


def of_value(label, unit, value, floor=None):
    """The figure of a single value, or of the median of what is not reported in samples."""
    return dict({'label': label, 'unit': unit, 'median': value}, **({'floor': floor} if floor else {}))


def of_times(label, unit, seconds, floor=None):
    """The figure of samples in s, reported in a unit of time."""
    factor = FACTORS[unit]
    return dict(of_value(label, unit, factor * statistics.median(seconds), floor),
                p99=factor * percentile(seconds, 0.99), count=len(seconds))


def of_diagnostics(values, floors):
    """The times that a node reports on /diagnostics as "Median ... [s]" and "99 % ... [s]", each the median of what it has reported.
    @param values lists of texts, by key. @param floors names of figures, by the time's name."""
    found = {}
    for key, reported in values.items():
        parts = re.fullmatch(r'(Median|99 %) (.*) \[s\]', key)
        if not parts:
            continue
        name = parts.group(2)
        figure = found.setdefault('loop/' + name, of_value(name + ', live', 'us', None, floors.get(name)))
        value = 1e6 * statistics.median(map(float, reported))
        figure.update({'median': value, 'count': len(reported)} if parts.group(1) == 'Median' else {'p99': value})
    return found


def ratio(figures, name):
    """A figure's median over that of its floor; None without one."""
    figure = figures[name]
    floor = figures.get(figure.get('floor'))
    if floor is None:
        return None
    return figure['median'] / floor['median'] * FACTORS.get(floor['unit'], 1) / FACTORS.get(figure['unit'], 1)


def number(value):
    """With three digits; '-' for None."""
    if value is None:
        return '-'
    if value != 0 and not 1e-3 <= abs(value) < 1e6:
        return '%.2e' % value
    digits = 2 - math.floor(math.log10(abs(value))) if value != 0 else 0
    return '%.*f' % (max(0, digits), value)


def rows(run):
    """Of the table of one run."""
    figures = run['figures']
    yield ['', 'unit', 'median', 'p99', 'samples', 'floor', 'ratio']
    for name, figure in figures.items():
        floor = figures.get(figure.get('floor'))
        yield [figure['label'], figure['unit'], number(figure['median']), number(figure.get('p99')),
               str(figure.get('count', '-')), floor['label'] if floor else '-', number(ratio(figures, name))]


def rows_of_both(before, now):
    """Of the table of two runs. The last columns are the second run's figures over the first's."""
    none = {'median': None, 'p99': None}
    yield ['', 'unit', 'median before', 'now', 'p99 before', 'now', 'median now/before', 'p99 now/before']
    for name in list(now['figures']) + [name for name in before['figures'] if name not in now['figures']]:
        old, new = (run['figures'].get(name, none) for run in (before, now))
        figure = new if new is not none else old
        cells, ratios = [], []
        for part in ('median', 'p99'):
            a, b = (value.get(part) if value.get('unit') == figure['unit'] else None for value in (old, new))
            cells += [number(a), number(b)]
            ratios.append(number(b / a if a and b is not None else None))
        yield [figure['label'], figure['unit']] + cells + ratios


def origin(run):
    """Where a run was taken, in a line."""
    return '%s of %s, %s, %d cores, %s, %s' % (
        run['commit'], run['date'], run['cpu'], run['cores'], run['kernel'],
        'real-time scheduling' if run['realtime'] else 'no real-time scheduling')


def aligned(table):
    table = list(table)
    widths = [max(len(row[i]) for row in table) for i in range(len(table[0]))]
    # Texts to the left, numbers to the right.
    left = [not any(c.isdigit() for c in table[1][i]) if len(table) > 1 else True for i in range(len(widths))]
    left[0] = left[1] = True
    return '\n'.join('  '.join(cell.ljust(w) if l else cell.rjust(w) for cell, w, l in zip(row, widths, left)).rstrip()
                     for row in table)


def text(run, before=None):
    """The table for a terminal, of one run or of two."""
    if before is None:
        return origin(run) + '\n\n' + aligned(rows(run))
    lines = ['before: ' + origin(before), 'now:    ' + origin(run)]
    lines += ['not the same %s: %s, then %s' % (key, before[key], run[key])
              for key in MACHINE if before[key] != run[key]]
    return '\n'.join(lines) + '\n\n' + aligned(rows_of_both(before, run))


def with_lines(page, program, lines):
    """A page of the documentation with what a program has measured between its marks. @raise ValueError without the marks."""
    first, last = (mark % program for mark in MARKS)
    head, begin, rest = page.partition(first)
    _, end, tail = rest.partition(last)
    if not begin or not end:
        raise ValueError('a page without the lines %s and %s' % (first, last))
    return head + '\n'.join([begin, *lines, end]) + tail


def markdown(table, aligns):
    """Lines of a table, whose first row is its head. @param aligns of the columns, as '---' or '---:'."""
    first, *others = table
    return ['| %s |' % ' | '.join(row) for row in [first, aligns, *others]]


def with_table(page, run):
    """A page of the documentation with a run's table."""
    table = markdown(rows(run), ['---'] * 2 + ['---:'] * 3 + ['---', '---:'])
    return with_lines(page, 'scripts/bench', ['Commit ' + origin(run) + '.', '', *table])
