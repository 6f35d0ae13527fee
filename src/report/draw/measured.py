"""The picture of a figure measured of a job's tools, from the output of `grind history --figure --json`. As a program, draws it into
an SVG file: measured.py FILE.svg < JSON."""

import sys

from document import Output, run
from style import CURVE, INK, LIMIT, METAL, THEORY, Picture, new_figure, svg_of


def title_of(history):
    return history['words'] + ('' if history['x_mm'] is None else ' at X = %g mm' % history['x_mm'])


def draw(history):
    """The measured values over the tools: asked dashed, tolerance shaded, changes of the zero points as vertical lines."""
    figure = new_figure(3)
    axes = figure.add_subplot(xlabel='tool', ylabel='%s [%s]' % (history['words'], history['unit']))
    asked, tolerance = history['asked'], history['tolerance']
    if asked is not None:
        axes.axhspan(asked - tolerance, asked + tolerance, color=METAL, linewidth=0, zorder=0)
        axes.axhline(asked, color=THEORY, linestyle='--')
    # Numbers of records also count other jobs; a place for each tool of this one.
    for change, colour, style, label in (('corrected', CURVE, ':', 'Y, Z corrected'), ('found', INK, '-', 'Y, Z found anew')):
        for place in [place for place, tool in enumerate(history['tools']) if place > 0 and tool['zero_points'] == change]:
            axes.axvline(place - 0.5, color=colour, linestyle=style, label=label)
            label = None
    measured = [(place, tool['measured']) for place, tool in enumerate(history['tools']) if tool['measured'] is not None]
    if measured:
        axes.plot(*zip(*measured), color=THEORY, linewidth=0.5)
    for out, marker, colour, label in ((False, 'o', CURVE, 'measured'), (True, 'X', LIMIT, 'out of tolerance')):
        points = [(x, y) for x, y in measured if (asked is not None and abs(y - asked) > tolerance) == out]
        if points:
            axes.plot(*zip(*points), linestyle='', marker=marker, color=colour, label=label)
    numbers = [tool['tool'] for tool in history['tools']]
    step = -(-len(numbers) // 12)
    axes.set_xticks(range(0, len(numbers), step))
    axes.set_xticklabels(numbers[::step])
    axes.set_xlim(-0.7, len(numbers) - 0.3)
    axes.ticklabel_format(axis='y', useOffset=False)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(loc='lower left', bbox_to_anchor=(0, 1), ncol=2, fontsize=8, borderaxespad=0)
    return figure


CAPTION = 'By gauge, over the numbers of the records of the tools%s.'


def measured_picture(name, history):
    return Picture(name, title_of(history), CAPTION % (
        '' if history['asked'] is None else '; dashed: as asked; shaded: the tolerance'), draw(history))


def measured_pictures(operations):
    return [measured_picture('measured-%d-%d' % (i, k), history)
            for i, operation in enumerate(operations) for k, history in enumerate(operation.get('measured', []))]


def draw_file(history):
    figure = draw(history)
    figure.set_facecolor('white')
    figure.suptitle(title_of(history), fontsize=10)
    return svg_of(figure)


if __name__ == '__main__':
    run(lambda history: Output(sys.argv[1]).write(draw_file(history).encode()))
