"""The pictures of a ground cutter, from the output of `grind simulate --json`. As a program, draws them into one SVG file:
tool.py FILE.svg < JSON."""

import math
import sys

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch
from matplotlib.path import Path

from document import Output, run
from style import (BLANK, CHAMFER, CURVE, FLUTE, GASH, INK, LIMIT, METAL, NARROW, PRIMARY, SECONDARY, TEETH, THEORY, Picture,
                   new_figure, svg_of)

FACES = {'primary': ('primary flank', PRIMARY), 'secondary': ('secondary flank', SECONDARY), 'chamfer': ('chamfer', CHAMFER),
         'gash': ('gash', GASH), 'blank': ('blank', BLANK)}
LEAST_SPAN = 0.002  # least span of a picture's figures; a smaller one is rounding


def is_relieved(tool):
    return 'clearance_deg' in tool['sections'][0]['teeth'][0]


def number(value):
    return math.nan if value is None else value


def text(value, unit, asked=None):
    ground = 'none' if value is None else '%.3f %s' % (value, unit)
    return ground if asked is None else '%s, asked %.3f' % (ground, asked)


def point(radius, degrees):
    return radius * math.cos(math.radians(degrees)), radius * math.sin(math.radians(degrees))


def draw_section(axes, tool, section):
    """Draws a section, Y to the right and Z up, turned until the first tooth's edge is on top."""
    tooth = section['teeth'][0]
    radius, core = section['diameter_mm'] / 2, section['core_diameter_mm'] / 2
    turn = 90 - number(tooth['edge_deg'])
    if math.isnan(turn):
        turn = 0
    if section['outline_mm'] is not None:
        y, z = np.array(section['outline_mm']).T
        angle, r = np.arctan2(z, y) + math.radians(turn), np.hypot(y, z)
        axes.fill(r * np.cos(angle), r * np.sin(angle), facecolor=METAL, edgecolor=CURVE)
    circle = np.linspace(0, 2 * np.pi, 181)
    for size, style in ((radius, {'color': THEORY, 'linestyle': ':'}), (core, {'color': CURVE, 'linestyle': ':'}),
                        (section['asked_core_diameter_mm'] / 2, {'color': LIMIT, 'linestyle': '--'})):
        axes.plot(size * np.cos(circle), size * np.sin(circle), **style)
    axes.annotate('', point(core, 225), point(core, 45), arrowprops={'arrowstyle': '<->', 'color': CURVE, 'lw': 0.8})
    axes.text(0, 0, 'Ø %.3f' % (2 * core), rotation=45, ha='center', va='bottom', rotation_mode='anchor')
    sign = 1 if tool['cut'] == 'right_hand' else -1
    if tooth['edge_deg'] is not None:
        draw_rake(axes, radius, tooth, sign)
        if is_relieved(tool):
            draw_relief(axes, radius, tooth, sign)
        else:
            draw_land(axes, radius, tooth['land_mm'], tooth['land_deg'], sign)
    axes.set_title('X = %.3f mm\nrake %s\ncore Ø %s\n%s' % (
        section['x_mm'], text(tooth['rake_deg'], 'deg', tooth['asked_rake_deg']),
        text(section['core_diameter_mm'], 'mm', section['asked_core_diameter_mm']), land_text(tool, tooth)), loc='left')
    axes.set(aspect='equal', anchor='S', xlim=(-1.32 * radius, 1.32 * radius), ylim=(-1.15 * radius, 1.32 * radius))
    axes.set_axis_off()


def draw_end(axes, view, legend_place):
    """Draws the view of the end: Z up and Y to the left, turned until the first tooth is on top."""
    turn = math.radians(view['edge_deg'] - 90)
    cos, sin = math.cos(turn), math.sin(turn)

    def turned(line):
        y, z = np.array(line).T
        return np.column_stack([-y * cos - z * sin, -y * sin + z * cos])

    radius = view['diameter_mm'] / 2
    circle = np.linspace(0, 2 * np.pi, 181)
    axes.fill(radius * np.cos(circle), radius * np.sin(circle), facecolor=FLUTE, edgecolor=INK, linewidth=0.6)
    for region in view['regions']:
        path = Path.make_compound_path(*(Path(turned(line), closed=True) for line in region['outlines_mm']))
        axes.add_patch(PathPatch(path, facecolor=FACES[region['face']][1], edgecolor=INK, linewidth=0.3))
    for edge in view['edges']:
        axes.plot(*turned(edge['line_mm']).T, color=INK, linewidth=2, solid_capstyle='round')
    shown = {region['face'] for region in view['regions']}
    legend = [Patch(facecolor=colour, edgecolor=INK, linewidth=0.3, label=words)
              for face, (words, colour) in FACES.items() if face in shown]
    legend.append(Patch(facecolor=FLUTE, edgecolor=INK, linewidth=0.3, label='flute'))
    if view['edges']:
        legend.append(Line2D([], [], color=INK, linewidth=2, label='cutting edge'))
    for diameter, style, words in ((view['uncut_diameter_mm'], '--', 'uncut Ø %g'),
                                   (2 * view['short_from_mm'], ':', 'short from Ø %g')):
        if diameter > 0:
            axes.plot(diameter / 2 * np.cos(circle), diameter / 2 * np.sin(circle), color=INK, linestyle=style)
            legend.append(Line2D([], [], color=INK, linestyle=style, label=words % diameter))
    axes.legend(handles=legend, fontsize=8, title='The end, Ø %g mm' % (2 * radius), title_fontsize=8, **legend_place)
    axes.set(aspect='equal', anchor='S', xlim=(-1.05 * radius, 1.05 * radius), ylim=(-1.05 * radius, 1.05 * radius))
    axes.set_axis_off()


def draw_rake(axes, radius, tooth, sign):
    """Draws the rake asked for and the ground rake, against the radius to the edge on top."""
    axes.plot([0, 0], [0, 1.25 * radius], color=THEORY, linewidth=0.6)
    for rake, style in ((tooth['asked_rake_deg'], {'color': LIMIT, 'linestyle': '--'}), (tooth['rake_deg'], {'color': INK})):
        if rake is not None:
            # With a positive rake, the face falls back behind the radius on its way to the core.
            x, y = point(1, 90 - sign * rake)
            for part in (-0.55 * radius, 0.22 * radius):
                axes.plot([0, part * x], [radius, radius + part * y], **style)
    if tooth['rake_deg'] is not None:
        axes.text(sign * 0.1 * radius, 1.2 * radius, '%.2f°' % tooth['rake_deg'], ha='left' if sign > 0 else 'right')


def land_text(tool, tooth):
    if not is_relieved(tool):
        return 'land ' + text(tooth['land_mm'], 'mm')
    return 'clearance %s\nprimary relief %s, heel at %s' % (
        text(tooth['clearance_deg'], 'deg', tooth['asked_clearance_deg']), text(tooth['primary_mm'], 'mm'),
        text(tooth['heel_mm'], 'mm'))


def draw_relief(axes, radius, tooth, sign):
    """Draws the clearance asked for and the ground clearance, against the circle's tangent behind the edge."""
    axes.plot([0, -sign * 0.9 * radius], [radius, radius], color=THEORY, linewidth=0.6)
    for clearance, style in ((tooth['asked_clearance_deg'], {'color': LIMIT, 'linestyle': '--'}),
                             (tooth['clearance_deg'], {'color': INK})):
        if clearance is not None:
            x, y = point(0.9 * radius, 180 + clearance)
            axes.plot([0, sign * x], [radius, radius + y], **style)
    if tooth['clearance_deg'] is not None:
        axes.text(-sign * 0.92 * radius, 0.95 * radius, '%.2f°' % tooth['clearance_deg'],
                  ha='right' if sign > 0 else 'left', va='center')
    if tooth['primary_mm'] is not None:
        draw_land(axes, radius, tooth['primary_mm'], math.degrees(tooth['primary_mm'] / radius), sign)


def draw_land(axes, radius, length, degrees, sign):
    if degrees is None:
        return
    # An arc behind the edge, with its length.
    angles = np.radians(90 + sign * np.linspace(0, degrees, 60))
    axes.plot(1.08 * radius * np.cos(angles), 1.08 * radius * np.sin(angles), color=INK)
    for end in (90, 90 + sign * degrees):
        axes.plot(*np.transpose([point(1.02 * radius, end), point(1.12 * radius, end)]), color=INK)
    middle = 90 + sign * min(degrees / 2, 60)
    axes.text(*point(1.15 * radius, middle), '%.2f' % length, ha='right' if sign > 0 else 'left')


def shown_sections(tool):
    """The sections at both ends and in the middle."""
    sections = tool['sections']
    return [sections[i] for i in sorted({0, len(sections) // 2, len(sections) - 1})]


def draw_curve(axes, tool, curve):
    """Draws a figure over X, of each tooth or of the section; the value asked for is dashed, its tolerance shaded."""
    sections, key, tolerance = tool['sections'], curve['key'], curve['tolerance']
    x = [section['x_mm'] for section in sections]
    for i in range(1 if curve['of_section'] else tool['teeth']):
        rows = sections if curve['of_section'] else [section['teeth'][i] for section in sections]
        style = {'color': TEETH[i % len(TEETH)], 'marker': '.', 'markersize': 4}
        axes.plot(x, [number(row[key]) for row in rows], label=None if curve['of_section'] else 'tooth %d' % (i + 1), **style)
        if tolerance is not None:
            asked = np.array([row['asked_' + key] for row in rows])
            axes.plot(x, asked, color=LIMIT, linestyle='--')
            if i == 0:
                axes.fill_between(x, asked - tolerance, asked + tolerance, color=LIMIT, alpha=0.08, linewidth=0)
    axes.set_title('%s [%s]' % (curve['words'], curve['unit']), loc='left')
    axes.ticklabel_format(useOffset=False)
    low, high = axes.get_ylim()
    if high - low < LEAST_SPAN:
        axes.set_ylim((low + high - LEAST_SPAN) / 2, (low + high + LEAST_SPAN) / 2)
    if key == 'rake_deg' and tool['teeth'] > 1:
        axes.legend(ncol=min(tool['teeth'], 4), fontsize=7)


def tool_pictures(tool):
    """The pictures of a tool for a report."""
    pictures = []
    for i, section in enumerate(shown_sections(tool), 1):
        figure = new_figure(3.6, NARROW)
        draw_section(figure.add_subplot(), tool, section)
        pictures.append(Picture('section-%d' % i, 'Section at X = %.3f mm' % section['x_mm'],
                                'The first tooth on top, in mm; dotted: blank and core; dashed: the core and the %s asked. The '
                                '%s is dimensioned along the outer circle.' %
                                (('rake and clearance', 'primary relief') if is_relieved(tool) else ('rake', 'land')), figure))
    if tool['end_view']:
        figure = new_figure(2.8)
        draw_end(figure.add_subplot(), tool['end_view'], {'loc': 'center left', 'bbox_to_anchor': (1, 0.5)})
        pictures.append(Picture('end', 'The end', 'Seen along the axis from the end, the first tooth on top; '
                                'dashed: the diameter in which edges may be missing.', figure))
    for curve in tool['curves']:
        figure = new_figure(2.6)
        axes = figure.add_subplot(xlabel='X [mm]')
        draw_curve(axes, tool, curve)
        words = curve['words']
        pictures.append(Picture(words.replace(' ', '-'), words[0].upper() + words[1:], 'Over X in mm%s.' % (
            '' if curve['tolerance'] is None else '; dashed: as asked; shaded: the tolerance'), figure))
    return pictures


def draw_file(tool):
    """All pictures of a tool in one SVG."""
    curves = tool['curves']
    heights = 4.1, 1.5 * len(curves)
    figure = Figure((12 if tool['end_view'] else 9, sum(heights) + 0.1), constrained_layout=True, facecolor='white')
    above, below = figure.add_gridspec(2, 1, height_ratios=heights)
    figure.suptitle('%s: %s' % (tool['source'], tool['tool']), fontsize=10)
    shown = shown_sections(tool)
    places = list(above.subgridspec(1, len(shown) + (1 if tool['end_view'] else 0)))
    for place, section in zip(places, shown):
        draw_section(figure.add_subplot(place), tool, section)
    if tool['end_view']:
        draw_end(figure.add_subplot(places[-1]), tool['end_view'], {'loc': 'lower center', 'bbox_to_anchor': (0.5, 1), 'ncol': 2})
    panels = []
    for place, curve in zip(below.subgridspec(len(curves), 1), curves):
        panels.append(figure.add_subplot(place, sharex=panels[0] if panels else None))
        draw_curve(panels[-1], tool, curve)
        panels[-1].label_outer()
    panels[-1].set_xlabel('X [mm]')
    return svg_of(figure)


if __name__ == '__main__':
    run(lambda tool: Output(sys.argv[1]).write(draw_file(tool).encode()))
