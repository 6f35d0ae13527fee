"""Compares tables of figures in the documentation with what `grind` says."""

import re


def change(text, changes):
    """A job file with other values."""
    for key, value in changes.items():
        text, count = re.subn(r'(?m)^( +%s:) *[^ #\n]+' % key, r'\g<1> %s' % value, text)
        assert count == 1, key
    return text


def plain(cell):
    return cell.strip('`')


def of_plan(output):
    """What the columns of a table of plans are called, with what a plan's output says of them."""
    feed = re.search(r'(?m)^feed constancy +(.*)$', output).group(1)
    return {
        'stroke s': re.search(r' stroke ([\d.]+)', output).group(1),
        'maximum deviation um': re.search(r'(?m)^maximum deviation +(\S+) um', output).group(1),
        'feed constancy mm/min': re.sub(r'^(\S+) to \1 mm/min$', r'\1', feed),
        'limited by': ', '.join(re.findall(r'(?m)^feed limited by +(.*?), X', output)),
    }


def wrong_plans(table, job, grind):
    """Cells that a plan of the job, changed as the row says, contradicts. Columns in code are keys of the job."""
    head, *rows = table
    found = []
    for row in rows:
        keys = {plain(name): plain(cell) for name, cell in zip(head, row) if name.startswith('`')}
        said = of_plan(grind('plan', change(job, keys)))
        found += ['%s: %s = %s, not %s' % (keys, name, said[name], cell)
                  for name, cell in zip(head, row) if not name.startswith('`') and said[name] != cell]
    return found


def rounded_as(cell, value):
    """A number with as many digits as the cell has."""
    mantissa = cell.split('e')[0]
    return '%.*e' % (len(mantissa.partition('.')[2]), value)


def wrong_steps(table, job, grind):
    """Cells that `grind table` contradicts: a row for each step length, a column for each rule's even points, and one for the odd
    points of all."""
    head, *rows = table
    found = []
    for step, *cells in rows:
        for name, cell in zip(head[1:], cells):
            point, rules = ('even', [plain(name)]) if name.startswith('`') else ('odd', [plain(n) for n in head[2:]])
            for rule in rules:
                output = grind('table', job, '--step-length', step, '--even-step', rule)
                value = float(re.search(r'maximum at %s points +(\S+)' % point, output).group(1))
                if rounded_as(cell, value) != cell:
                    found.append('step %s mm, %s points, %s: %g, not %s' % (step, point, rule, value, cell))
    return found


def wrong(item, read, grind):
    """What is wrong in a table, one text each.
    @param read gives the text of a file of the package.
    @param grind runs a subcommand on a job's text, with arguments, and returns what it prints."""
    kind, path, *changes = item.directive.split()
    job = change(read(path), dict(c.split('=') for c in changes))
    return {'plan': wrong_plans, 'table': wrong_steps}[kind](item.lines, job, grind)
