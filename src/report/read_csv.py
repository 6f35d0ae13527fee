"""Reads the CSV files of `grind table`, `grind plan` and `grind run`."""

import re

import numpy as np

from record import EVEN, MM, MM_MIN, MOVES, ODD, ROW, STEPS, BLOCK, Record, SourceError

TABLE = [('point', 'i8'), ('x_mm', 'f8'), ('a_rad', 'f8'), ('a_theory_rad', 'f8'), ('error_rad', 'f8')]
SETPOINTS = [('cycle', 'i8'), ('time_s', 'f8'), ('move', 'S8'), ('tooth', 'i4'), ('pass', 'i4'), ('step', 'S8'),
             ('x_mm', 'f8'), ('y_mm', 'f8'), ('z_mm', 'f8'), ('a_rad', 'f8'), ('error_rad', 'f8'), ('feed_mm_min', 'f8')]
ACTUAL = [('actual_x_mm', 'f8'), ('actual_y_mm', 'f8'), ('actual_z_mm', 'f8'), ('actual_a_rad', 'f8')]


def header(columns):
    return ','.join(name for name, _ in columns)


def read_csv(path):
    """The record of a CSV file. @raise SourceError, OSError"""
    with open(path, encoding='ascii', errors='replace') as file:
        first = file.readline().rstrip('\r\n')
        if first == header(TABLE):
            return read_rows(file, Record('table'), TABLE, from_table)
        if first == header(SETPOINTS):
            return read_rows(file, Record('setpoints'), SETPOINTS, from_setpoints)
        if first == header(SETPOINTS + ACTUAL):
            return read_rows(file, Record('run'), SETPOINTS + ACTUAL, from_run)
    if not first:
        raise SourceError('is empty')
    raise SourceError('its first line is %s; allowed: "%s", "%s", or a bag'
                      % (ascii(first[:80]), header(TABLE), header(SETPOINTS)))


def read_rows(file, record, columns, convert):
    line = 2
    while True:
        # Line by line, since numpy would read ahead.
        lines = [text for _, text in zip(range(BLOCK), file)]
        if not lines:
            break
        record.append(*convert(parse(lines, line, columns), record))
        line += len(lines)
    record.finish()
    return record


def parse(lines, first, columns):
    try:
        table = np.loadtxt(lines, np.dtype(columns), delimiter=',', comments=None, ndmin=1)
    except ValueError as error:
        # numpy counts from 0 or from 1, depending on what is wrong.
        bad = next(n for n, line in enumerate(lines) if not is_good(line, columns))
        reason = re.sub(r' at row \d+', '', str(error)).split(';')[0]
        raise SourceError('line %d: %s' % (first + bad, reason))
    if len(table) != len(lines):
        raise SourceError('line %d: is empty' % (first + next(n for n, line in enumerate(lines) if not line.strip())))
    return table


def is_good(line, columns):
    try:
        return len(np.loadtxt([line], np.dtype(columns), delimiter=',', comments=None, ndmin=1)) == 1
    except ValueError:
        return False


def from_table(table, _):
    rows = np.zeros(len(table), ROW)
    rows['cycle'] = table['point']
    rows['position'][:, 0] = table['x_mm'] * MM
    rows['position'][:, 3] = table['a_rad']
    rows['error'] = table['error_rad']
    rows['move'] = MOVES.index('stroke')
    rows['step'] = np.where(table['point'] % 2 == 1, ODD, EVEN)
    return rows, np.zeros(len(rows))


def from_setpoints(table, record):
    rows = np.zeros(len(table), ROW)
    rows['cycle'] = table['cycle']
    for name in ('tooth', 'pass'):
        rows[name] = in_range(table, name, np.iinfo('u2').max)
    for axis, name in enumerate(('x_mm', 'y_mm', 'z_mm')):
        rows['position'][:, axis] = table[name] * MM
    rows['position'][:, 3] = table['a_rad']
    rows['error'] = table['error_rad']
    rows['feed'] = table['feed_mm_min'] * MM_MIN
    rows['move'] = indices(table, 'move', MOVES)
    rows['step'] = indices(table, 'step', STEPS)
    # The times are whole cycles.
    if table['cycle'][-1] > 0:
        record.period = float(table['time_s'][-1] / table['cycle'][-1])
    return rows, table['time_s'].copy()


def from_run(table, record):
    rows, times = from_setpoints(table, record)
    for axis, (name, _) in enumerate(ACTUAL):
        rows['actual'][:, axis] = table[name] * (MM if name.endswith('_mm') else 1)
    return rows, times


def in_range(table, column, max_value):
    good = (table[column] >= 0) & (table[column] <= max_value)
    if not good.all():
        bad = np.argmin(good)
        raise SourceError('cycle %d: %s = %d; allowed: 0 to %d' % (table['cycle'][bad], column, table[column][bad], max_value))
    return table[column]


def indices(table, column, words):
    found = np.full(len(table), len(words), 'u1')
    for index, word in enumerate(words):
        found[table[column] == word.encode()] = index
    if (found == len(words)).any():
        bad = np.argmax(found)
        raise SourceError('cycle %d: %s "%s"; allowed: %s'
                          % (table['cycle'][bad], column, table[column][bad].decode(), ', '.join(words)))
    return found
