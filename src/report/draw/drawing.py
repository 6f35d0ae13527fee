"""The drawing of the tool asked for, with the dimensions of its job file."""

import math
from itertools import cycle

import numpy as np

from cutter import max_radius, radius, spiral_angles, tooth_angles
from style import CURVE, INK, METAL, THEORY, Picture, new_figure

SHANK_SHOWN = 0.9  # length of shank shown, as a fraction of its diameter


class Outline:
    """Half of the tool from the small end to the shank, X to the right [mm]."""

    def __init__(self, cutter):
        self.end = cutter['end_diameter_mm'] / 2
        self.length = cutter['flute_length_mm']
        self.slope = math.tan(math.radians(cutter['cone_angle_deg']))
        self.large = radius(cutter, self.length)
        self.neck = cutter.get('neck_length_mm') or 0
        self.shank = cutter['shank_diameter_mm'] / 2
        # Without a known length of the neck, a shoulder of 45 deg, as in the machine's model.
        self.shoulder = self.length + self.neck
        self.shank_at = self.shoulder + (0 if self.neck else abs(self.shank - self.large))
        self.total = self.shank_at + max(2 * self.shank * SHANK_SHOWN, 0.15 * self.length)

    def points(self):
        return [(0, self.end), (self.length, self.large), (self.shoulder, self.large), (self.shank_at, self.shank),
                (self.total, self.shank)]


def edges(cutter, outline):
    """The cutting edges on the near side, as lines of X and height."""
    x = np.linspace(0, outline.length, 400)
    angles, r = tooth_angles(cutter), radius(cutter, x)
    for degrees, spiral in zip(angles, cycle(spiral_angles(cutter))):
        if abs(outline.slope) > 1e-9:
            turn = math.tan(math.radians(spiral)) / outline.slope * np.log(r / outline.end)
        else:
            turn = math.tan(math.radians(spiral)) * x / outline.end
        angle = math.radians(degrees) + turn
        yield x, np.where(np.sin(angle) >= 0, r * np.cos(angle), np.nan)


def dimension(axes, begin, end, text, offset=(0, 0), **how):
    axes.annotate('', end, begin, arrowprops={'arrowstyle': '<->', 'color': INK, 'lw': 0.7, 'shrinkA': 0, 'shrinkB': 0})
    middle = (begin[0] + end[0]) / 2 + offset[0], (begin[1] + end[1]) / 2 + offset[1]
    axes.text(*middle, text, **{'ha': 'center', 'va': 'bottom', **how})


def tool_drawing(cutter):
    """The picture of the tool. @param cutter cutter of a job file."""
    outline = Outline(cutter)
    half = max(max_radius(cutter), outline.shank)
    x, r = np.array(outline.points()).T
    figure = new_figure(2.7)
    axes = figure.add_subplot()
    axes.fill(np.concatenate([x, x[::-1]]), np.concatenate([r, -r[::-1]]), facecolor=METAL, edgecolor=INK, linewidth=0.9)
    for line in edges(cutter, outline):
        axes.plot(*line, color=CURVE)
    step = 0.16 * max(half, outline.total / 4)
    axes.plot([-step, outline.total + step], [0, 0], color=THEORY, linestyle='-.', linewidth=0.7)
    below = -half - 2 * step
    for at, radius in ((0, outline.end), (outline.length, outline.large)):
        axes.plot([at, at], [-radius, below - 0.4 * step], color=THEORY, linewidth=0.6)
    dimension(axes, (0, below), (outline.length, below), '%g' % cutter['flute_length_mm'])
    left = -1.5 * step
    for sign in (-1, 1):
        axes.plot([0, left - 0.4 * step], [sign * outline.end] * 2, color=THEORY, linewidth=0.6)
    dimension(axes, (left, -outline.end), (left, outline.end), 'Ø %g' % cutter['end_diameter_mm'], (-0.4 * step, 0), ha='right',
              va='center')
    right = outline.total + 1.5 * step
    for sign in (-1, 1):
        axes.plot([outline.total, right + 0.4 * step], [sign * outline.shank] * 2, color=THEORY, linewidth=0.6)
    dimension(axes, (right, -outline.shank), (right, outline.shank), 'Ø %g' % cutter['shank_diameter_mm'], (0.4 * step, 0), ha='left',
              va='center')
    above = half + 0.6 * step
    spirals = sorted(set(spiral_angles(cutter)))
    count = len(tooth_angles(cutter))
    axes.text(0, above, 'cone %g°, spiral %s, rake %g°, %d %s' % (
        cutter['cone_angle_deg'], ', '.join('%g°' % s for s in spirals), cutter['rake_angle_deg'], count,
        'tooth' if count == 1 else 'teeth'), va='bottom')
    axes.set(aspect='equal', xlim=(left - 3.2 * step, right + 3.2 * step), ylim=(below - 0.6 * step, above + 1.6 * step))
    axes.set_axis_off()
    return Picture('tool', 'The tool', 'As asked, seen from the side, with the cutting edges on the near side; dimensions in mm.',
                   figure)
