#!/usr/bin/env python3
"""Draws docs/images/tooth.svg and docs/images/tool_end.svg for docs/glossary.md: the tool of jobs/end_mill_d10_t4.yaml, to scale.

The section is what the job's wheels take with its set-up, the end lies where the job's angles put it. Ends with an error if the section
is not what the job asks for: the job has then changed in a way that this drawing does not follow. Takes a minute."""

import pathlib

import matplotlib
matplotlib.use('svg')
import matplotlib.pyplot as plt
import numpy as np
import yaml
from matplotlib.patches import Arc, Circle, Polygon
from numpy import arctan2, cos, hypot, pi, radians, sin, tan

ROOT = pathlib.Path(__file__).resolve().parent.parent
CUTTER = yaml.safe_load((ROOT / 'jobs/end_mill_d10_t4.yaml').read_text())['cutter']
OPERATIONS = yaml.safe_load((ROOT / 'jobs/end_mill_d10_t4.yaml').read_text())['operations']
SETUP = yaml.safe_load((ROOT / 'jobs/end_mill_d10_t4.setup.yaml').read_text())
END, CHAMFER, GASH = CUTTER['end'], CUTTER['chamfer'], OPERATIONS[3]
R, TEETH, LAND = CUTTER['end_diameter_mm'] / 2, CUTTER['teeth'], CUTTER['land_mm']
PITCH = 2 * pi / TEETH
PER_MM = tan(radians(CUTTER['spiral_angle_deg'])) / R  # turn of the tool along its axis [rad/mm]
RIM = 50.0  # radius of the job's wheels [mm]
DISH = tan(radians(END['dish_deg']))

plt.rcParams.update({'svg.fonttype': 'none', 'svg.hashsalt': 'tooth', 'font.family': 'sans-serif', 'font.size': 10})
INK, ASIDE, ANGLE, BODY = '#111111', '#555555', '#8a3000', '#dfe6ee'
FACES = {'primary': '#e69f00', 'secondary': '#8fcdf0', 'chamfer': '#cc79a7', 'gash': '#7fcfb6'}  # Okabe and Ito's, two of them lighter


# Places of the tool are u along the radius through the first tooth's edge, v behind that edge, and x along the axis from the end [mm].

def turned(u, v, angle):
    return u * cos(angle) - v * sin(angle), u * sin(angle) + v * cos(angle)


def sweep(u, v, centre, width, swivel, a):
    """How deep a straight wheel was in places of the section X = 0 (less than 0: off them), with its centre at `centre`
    and A = a as it passes X = 0 [mm]."""
    radius, own = hypot(u, v), arctan2(v, u)
    deepest = np.full(u.shape, -np.inf)
    few = u.size == 1  # then all steps at once
    step = 0.0005 if few else min(0.02, np.ptp(u) / 160)
    for x in [np.arange(-5, 5, step)] if few else np.arange(-5, 5, step):
        angle = own - x * PER_MM - a
        dx, dy, dz = -x - centre[0], radius * cos(angle) - centre[1], radius * sin(angle) - centre[2]
        along = cos(swivel) * dz - sin(swivel) * dx
        across = np.sqrt(dx**2 + dy**2 + dz**2 - along**2)
        depth = np.minimum(width / 2 - abs(along), RIM - across)
        deepest = np.maximum(deepest, depth.max() if few else depth)
    return deepest


def flute(u, v):
    setup = SETUP['flute']
    return sweep(u, v, (0, R + RIM - setup['depth_mm'], setup['height_mm']), OPERATIONS[0]['wheel']['width_mm'],
                 radians(setup['swivel_deg']), 0)


def relief(u, v, name, clearance, start):
    """The relief that begins at a place (u, v) with a clearance: `Relief` in docs/algorithm.md."""
    swivel, part = radians(SETUP[name]['swivel_deg']), hypot(*start)
    phi = np.arcsin(-tan(swivel) * part * PER_MM * sin(clearance)) - clearance
    place = np.array([0, part * cos(phi), part * sin(phi)])
    spindle = np.array([-sin(swivel), 0, cos(swivel)])
    normal = np.cross([1, -PER_MM * place[2], PER_MM * place[1]], spindle)
    normal *= np.sign(normal[1]) / np.linalg.norm(normal)
    across = (place[2] + RIM * normal[2] - SETUP[name]['height_mm']) / spindle[2]
    return sweep(u, v, place + RIM * normal - across * spindle, 6, swivel, arctan2(start[1], start[0]) - phi)


def root(function, low, high):
    """Where a function of one number, negative at `low`, becomes positive."""
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if function(middle) < 0 else (low, middle)
    return low


def at(function, u, v):
    return float(function(np.array([u]), np.array([v]))[0])


EDGE = root(lambda a: -at(flute, R * cos(a), R * sin(a)), 0, 1)  # own angle of the flute's upper wall, the rake face, at the edge


def own_flute(u, v):
    return flute(*turned(u, v, EDGE))


def primary(u, v):
    return relief(u, v, 'primary', radians(CUTTER['clearance_deg']), (R, 0))


def surface(face, behind):
    """The place of a relief at a length behind the edge along the circle."""
    angle = behind / R
    radius = root(lambda r: at(face, r * cos(angle), r * sin(angle)), 0.6 * R, 1.01 * R)
    return np.array([radius * cos(angle), radius * sin(angle)])


SECOND = surface(primary, root(lambda b: hypot(*(surface(primary, b) - (R, 0))) - LAND, 0.01, 1))


def secondary(u, v):
    return relief(u, v, 'secondary', radians(CUTTER['second_clearance_deg']), SECOND)


def removed(u, v, near=range(TEETH)):
    """Depth below the surface of the section that is left of the blank, less than 0 in the tool."""
    depth = hypot(u, v) - R
    for tooth in near:
        place = turned(u, v, -tooth * PITCH)
        for face in (own_flute, primary, secondary):
            depth = np.maximum(depth, face(*place))
    return depth


def rake_face(depth):
    """The place of the rake face at a depth below the edge."""
    return np.array([R - depth, root(lambda v: -at(own_flute, R - depth, v), -0.2, 1)])


def label(ax, text, place, *to, ha='center'):
    """Words with lines to what they name."""
    for end in to:
        ax.annotate('', end, place, arrowprops={'arrowstyle': '-', 'color': ASIDE, 'lw': 0.8, 'shrinkA': 0, 'shrinkB': 0})
    gap = {'left': 0.04, 'right': -0.04}.get(ha, 0) * abs(ax.get_xlim()[1] - ax.get_xlim()[0]) / 4
    ax.text(place[0] + gap, place[1], text, color=INK, va='center', ha=ha, linespacing=1.25,
            bbox={'fc': 'white', 'ec': 'none', 'pad': 1} if ha == 'center' else None)


def axes_of(figure, box, across, up):
    ax = figure.add_axes(box)
    ax.set_xlim(*across), ax.set_ylim(*up)
    ax.set_aspect('equal')
    ax.axis('off')
    return ax


def angle(ax, centre, radius, from_deg, to_deg):
    ax.add_patch(Arc(centre, 2 * radius, 2 * radius, theta1=from_deg, theta2=to_deg, color=ANGLE, lw=1.6))


def line(ax, from_, to, **how):
    ax.plot(*zip(from_, to), **{'color': ANGLE, 'lw': 1.2, **how})


def save(figure, name):
    figure.savefig(ROOT / 'docs/images' / name, facecolor='white', metadata={'Date': None, 'Creator': None})
    plt.close(figure)


def thinned(line, off=0.003):
    """A line without the points that it hardly needs (Douglas and Peucker) [mm]."""
    way, rest = line[-1] - line[0], line - line[0]
    length = hypot(*way)
    distance = abs(rest[:, 0] * way[1] - rest[:, 1] * way[0]) / length if length > 0 else hypot(*rest.T)
    far = np.argmax(distance)
    if distance[far] <= off:
        return line[[0, -1]]
    return np.concatenate([thinned(line[:far + 1], off)[:-1], thinned(line[far:], off)])


def area(ax, across, up, inside, colour, width):
    """Where something is positive, with its outline."""
    filled, outline = ax.contourf(across, up, inside, [0, 99]), ax.contour(across, up, inside, [0])
    for part in filled.collections + outline.collections:
        part.remove()
    for line in filled.allsegs[0]:
        ax.add_patch(Polygon(thinned(line), fc=colour, ec='none'))
    for line in outline.allsegs[0]:
        ax.plot(*thinned(line).T, color=INK, lw=width)


def body(ax, u, v, near):
    """The section, seen from the shank: behind the edge is left."""
    depth = removed(u, v, near)
    area(ax, -v, u, -depth, BODY, 1.4)
    return depth


def from_edge(degrees, length):
    """A place at an angle to the radius through the edge, as drawn."""
    return -length * sin(radians(degrees)), R - length * cos(radians(degrees))


def drawn(place):
    return -place[1], place[0]


def heel():
    """Where the secondary relief of the first tooth meets the next flute."""
    return surface(secondary, root(lambda b: at(own_flute, *turned(*surface(secondary, b), -PITCH)), LAND, 4))


def draw_tooth():
    figure = plt.figure(figsize=(10.4, 5.2))
    ax = axes_of(figure, [0, 0, 0.6, 1], (-4.2, 3.288), (0.6, 6.6))
    u, v = np.meshgrid(np.arange(0.9, 5.1, 0.03), np.arange(-2.4, 3.9, 0.03), indexing='ij')
    depth = body(ax, u, v, (-1, 0, 1))
    core = 2 * hypot(u, v)[depth > 0].min()
    asked = CUTTER['core_diameter_mm'], CUTTER['core_tolerance_mm'], CUTTER['rake_angle_deg'], CUTTER['rake_tolerance_deg']
    rake = np.degrees(arctan2(rake_face(0.01)[1], 0.01))
    if abs(core - asked[0]) > asked[1] + 0.01 or abs(rake - asked[2]) > asked[3]:
        raise SystemExit('core %.3f mm, rake %.2f deg: not what the job asks for' % (core, rake))
    for radius, style in ((R, ':'), (asked[0] / 2, '--')):
        ax.add_patch(Circle((0, 0), radius, fill=False, ls=style, ec=ASIDE, lw=1))
    end, second = drawn(heel()), drawn(SECOND)
    # The land is the flutes': along the circle, before reliefs.
    behind = np.degrees(root(lambda a: at(own_flute, *turned(R * cos(a), R * sin(a), -PITCH)), LAND / R, PITCH / 2))
    ax.add_patch(Arc((0, 0), 2 * R + 0.7, 2 * R + 0.7, theta1=90, theta2=90 + behind, color=ANGLE, lw=1.4))
    for degrees in (0, behind):
        way = -sin(radians(degrees)), cos(radians(degrees))
        line(ax, [R * c for c in way], [(R + 0.45) * c for c in way], lw=0.8)
    label(ax, 'land', (-1.7, 5.95), (-(R + 0.35) * sin(radians(behind / 2)), (R + 0.35) * cos(radians(behind / 2))), ha='right')
    label(ax, 'cutting edge', (0.45, 6.3), (0, R), ha='left')
    label(ax, 'rake face', (0.9, 5.25), drawn(rake_face(0.5)), ha='left')
    label(ax, 'primary relief', (-0.6, 6.3), (-0.2, (R + second[1]) / 2), ha='right')
    label(ax, 'secondary relief', (-2.6, 5.35), drawn(surface(secondary, 1.4)), ha='right')
    label(ax, 'heel', (-3.0, 4.7), end, ha='right')
    label(ax, 'flute', (1.75, 3.95))
    label(ax, 'flute', (-2.75, 3.35))
    label(ax, 'tooth', (-0.75, 4.0))
    ax.texts[-1].set_bbox(None)
    label(ax, 'core, or web: %.2f mm' % asked[0], (-0.6, 1.5), (0.8, np.sqrt(asked[0]**2 / 4 - 0.64)))
    ax.texts[-1].set_bbox({'fc': BODY, 'ec': 'none', 'pad': 1})
    label(ax, 'circle of the cutter: %g mm' % (2 * R), (2.1, 5.8), (2.6, np.sqrt(R * R - 2.6**2)))

    ax = axes_of(figure, [0.59, 0.05, 0.41, 0.9], (-0.7, 0.66), (4.1, 5.593))
    u, v = np.meshgrid(np.arange(4.2, 5.01, 0.004), np.arange(-0.2, 0.66, 0.004), indexing='ij')
    body(ax, u, v, (0,))
    ax.add_patch(Circle((0, 0), R, fill=False, ls=':', ec=ASIDE, lw=1))
    chord_depth = 0.3
    face = rake_face(chord_depth)
    chord = np.degrees(arctan2(face[1], chord_depth))
    line(ax, (0, R + 0.12), (0, R - 0.74), color=ASIDE, ls='--')
    line(ax, (0, R), from_edge(asked[2], 0.74))
    line(ax, (0, R), from_edge(chord, 0.74), ls='-.')
    ax.plot(*drawn(face), 'o', color=ANGLE, ms=5)
    angle(ax, (0, R), 0.69, 270 - asked[2], 270)
    angle(ax, (0, R), 0.5, 270 - chord, 270)
    label(ax, 'radius', (0.2, 5.2), (0, R + 0.08), ha='left')
    label(ax, 'rake %g°:\ntangent of the face' % asked[2], (0.1, 4.28), from_edge(asked[2] / 2, 0.69), ha='left')
    label(ax, 'chordal rake, here\n%.1f° over %g mm' % (chord, chord_depth), (0.14, 4.56), from_edge(chord / 2, 0.5), ha='left')
    line(ax, (0, R), (-0.56, R), color=ASIDE, ls='--')
    angle(ax, (0, R), 0.37, 180, 180 + CUTTER['clearance_deg'])
    label(ax, 'clearance %g°' % CUTTER['clearance_deg'], (-0.2, 5.2), from_edge(90 - CUTTER['clearance_deg'] / 2, 0.37))
    tilt = np.degrees(arctan2(SECOND[1], SECOND[0]))
    line(ax, second, (second[0] - 0.3 * cos(radians(tilt)), second[1] - 0.3 * sin(radians(tilt))), color=ASIDE, ls='--')
    angle(ax, second, 0.2, 180 + tilt, 180 + tilt + CUTTER['second_clearance_deg'])
    label(ax, 'second\nclearance %g°' % CUTTER['second_clearance_deg'], (-0.54, 5.2),
          (second[0] - 0.2 * cos(radians(tilt + 10)), second[1] - 0.2 * sin(radians(tilt + 10))))
    label(ax, 'width of the primary\nrelief (land_mm): %g mm' % LAND, (-0.36, 4.55), (-0.01, R), second)
    ax.texts[-1].set_bbox({'fc': BODY, 'ec': 'none', 'pad': 1})
    ax.text(-0.02, 5.42, 'the edge, larger', color=INK, ha='center', va='center', weight='bold')
    save(figure, 'tooth.svg')


def end_faces(u, v):
    """How far from the end each face of a tooth is on rays along the axis; 0 where it is not."""
    first, second, land = tan(radians(END['clearance_deg'])), tan(radians(END['second_clearance_deg'])), END['land_mm']
    hollow = DISH * (R - u)
    faces = {'primary': hollow + first * v, 'secondary': hollow + first * land + second * (v - land)}
    beside_next = (u - 0.05 - RIM)**2 + v**2 < RIM**2
    for face in faces.values():
        face[~beside_next] = 0
    # The gash: the rake face, and the cone of the wheel's other side, which falls off by 45 deg.
    slope, rake = radians(GASH['angle_deg']), radians(END['rake_deg'])
    depth = ((u + GASH['past_mm']) * cos(slope) + sin(rake) * hollow + cos(rake) * v) / (sin(slope) + sin(rake))
    chip = sin(rake) * (depth - hollow) - cos(rake) * v
    faces['gash'] = np.where((chip >= 0) & (v <= 0.0), depth, 0)
    normal, through = chamfer()
    plane = through[0] - (normal[1] * (u - through[1]) + normal[2] * (v - through[2])) / normal[0]
    faces['chamfer'] = np.where((u > 0) & (v > -0.5), plane, 0)
    return faces


def chamfer():
    """Outward normal of the first tooth's chamfer, and where its edge meets the periphery, along (x, u, v)."""
    lean, clearance = radians(CHAMFER['angle_deg']), radians(CHAMFER['clearance_deg'])
    helix, hook = PER_MM * R, tan(radians(CUTTER['rake_angle_deg']))
    hollow = DISH + hook * tan(radians(END['clearance_deg']))  # the flute's hook lifts the edge within the primary flank
    spiral = np.arctan((cos(lean) + sin(lean) * hollow) * helix - sin(lean) * hook)
    outward = np.array([-sin(lean), cos(lean), 0])
    generatrix = np.array([cos(lean), sin(lean), 0])
    normal = cos(clearance) * outward + sin(clearance) * (cos(spiral) * np.array([0, 0, 1]) - sin(spiral) * generatrix)
    x = CHAMFER['width_mm'] * (hollow + 1 / tan(lean))
    return normal, np.array([x, R * cos(x * PER_MM), R * sin(x * PER_MM)])


def draw_end():
    """Seen from the end: behind the edge is right. Beside it the plane through axis and edge."""
    swivel = np.degrees(np.arcsin(-chamfer()[0][0]))
    if abs(swivel - SETUP['chamfer']['swivel_deg']) > 0.01:
        raise SystemExit('the chamfer is at a swivel of %.4f deg, not as the set-up says' % swivel)
    figure = plt.figure(figsize=(10.4, 5.6))
    ax = axes_of(figure, [0, 0, 0.6, 1], (-7.1, 7.1), (-6.37, 6.37))
    u, v = np.meshgrid(np.arange(-5.1, 5.1, 0.04), np.arange(-5.1, 5.1, 0.04), indexing='ij')
    faces = {name: np.zeros(u.shape) for name in FACES}
    for tooth in range(TEETH):
        for name, depth in end_faces(*turned(u, v, -tooth * PITCH)).items():
            faces[name] = np.maximum(faces[name], depth)
    last = np.max(list(faces.values()), axis=0)
    material = -removed(*turned(u, v, -last * PER_MM))
    for name, face in faces.items():
        others = np.max([other for key, other in faces.items() if key != name], axis=0)
        seen = np.minimum(np.minimum(face - others, face - 1e-6), material)
        area(ax, v, u, seen, FACES[name], 0.8)
    for radius, style in ((R, ':'), (END['uncut_diameter_mm'] / 2, '-')):
        ax.add_patch(Circle((0, 0), radius, fill=False, ls=style, ec=ANGLE if style == '-' else ASIDE, lw=1.2, zorder=5))
    label(ax, 'corner chamfer', (1.6, 5.9), (0.25, 4.9), ha='left')
    label(ax, 'primary flank of the end tooth', (1.6, 5.3), (0.2, 3.8), ha='left')
    label(ax, 'its secondary flank', (3.5, 4.2), (1.5, 3.4), ha='left')
    label(ax, 'cutting edge', (-1.2, 5.6), (0, 4.4), ha='right')
    label(ax, 'gash', (-2.6, 4.9), (-0.6, 2.6), ha='right')
    label(ax, 'flute', (-3.4, 4.2), (-1.6, 3.7), ha='right')
    label(ax, 'uncut diameter: %g mm' % END['uncut_diameter_mm'], (2.4, -5.6), (0.1, -0.11))
    label(ax, 'turns so\nwhen it cuts', (-5.9, -2.3))
    ax.annotate('', (-5.55, -1.5), (-5.75, 0.2), arrowprops={'arrowstyle': '->', 'color': ANGLE, 'lw': 1.6})
    draw_corner(axes_of(figure, [0.6, 0.04, 0.39, 0.92], (-1.2, 4.5), (-1.0, 6.24)))
    save(figure, 'tool_end.svg')


def draw_corner(ax):
    """The plane through the axis and the edge of an end tooth, the end on the left."""
    floor, slope, past, width = CUTTER['core_diameter_mm'] / 2, tan(radians(GASH['angle_deg'])), GASH['past_mm'], CHAMFER['width_mm']
    corner, periphery, shank = (DISH * width, R - width), (chamfer()[1][0], R), 4.3
    tip = (DISH * (R + past)) / (1 + DISH * slope)  # where the gash's bottom leaves the edge's line
    tip = tip, tip * slope - past
    ax.add_patch(Polygon([tip, corner, periphery, (shank, R), (shank, -0.6), (tip[0], -0.6)], fc=BODY, ec='none'))
    ax.add_patch(Polygon([tip, (DISH * (R - floor), floor), ((floor + past) / slope, floor)], fc=FACES['gash'], ec='none'))
    for ends in ((tip, corner), (corner, periphery), (periphery, (shank, R)), (tip, ((floor + past) / slope, floor))):
        line(ax, *ends, color=INK, lw=1.6)
    line(ax, tip, (tip[0], -0.6), color=INK, lw=1.6)
    line(ax, (-0.5, 0), (shank, 0), color=ASIDE, ls='-.')
    line(ax, (0, -0.6), (0, R + 0.3), color=ASIDE, ls='--')
    angle(ax, (0, R), 4.0, 270, 270 + END['dish_deg'])
    label(ax, 'dish %g°' % END['dish_deg'], (-0.35, 1.7), (0.07, 1.02), ha='right')
    foot = (past / slope, 0)
    angle(ax, foot, 1.3, 0, GASH['angle_deg'])
    label(ax, 'gash %g°' % GASH['angle_deg'], (2.2, 0.7), (foot[0] + 1.2, 0.5), ha='left')
    label(ax, 'rake face of the gash', (1.35, 2.4))
    label(ax, 'rake face of the flute', (2.2, 4.3))
    for text, colour in zip(ax.texts[-2:], (FACES['gash'], BODY)):
        text.set_bbox({'fc': colour, 'ec': 'none', 'pad': 1})
    label(ax, 'edge of the end tooth', (0.4, 5.9), (DISH * (R - 4.3), 4.3), ha='left')
    label(ax, 'chamfer %g mm, %g°' % (width, CHAMFER['angle_deg']), (0.9, 5.5), ((corner[0] + periphery[0]) / 2, R - width / 2), ha='left')
    label(ax, 'axis', (3.6, -0.45), (3.3, 0))


if __name__ == '__main__':
    draw_tooth()
    draw_end()
