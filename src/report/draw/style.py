"""The style of the pictures. They are small, so that their text can be read on a phone. Shapes repeat the meaning of colours, so
that they can be read in grey."""

import io
from collections import namedtuple

import matplotlib
from matplotlib.figure import Figure

# With the SVG as part of a page, once it is drawn.
Picture = namedtuple('Picture', 'name title caption figure svg', defaults=[None])

WIDTH = 4.6  # width of a picture [in]
NARROW = 3.0  # width of one of three pictures side by side [in]

# Colours differ in lightness too. In a page each is a variable of its style sheet, with another value in dark mode.
INK, GRID, THEORY, CURVE = '#222222', '#dddddd', '#888888', '#1f4e8c'
LIMIT, ODD_COLOUR, METAL, HELD = '#c03020', '#d96c00', '#dfe5ec', '#c9c4b4'
TEETH = [CURVE, ODD_COLOUR, '#2b8a3e', '#8e3b8e', '#00808a', '#8a6d00', '#555555', '#c2185b']
# Faces of an end: in rising lightness from the flute to the primary flank; chamfer and blank differ in hue.
FLUTE, GASH, SECONDARY, PRIMARY, CHAMFER, BLANK = '#5c6b84', '#8d9bb0', '#b9c6d6', '#e6edf5', '#e0c978', '#a9a591'
VARIABLES = {FLUTE: 'flute', GASH: 'gash', SECONDARY: 'secondary', PRIMARY: 'primary', CHAMFER: 'chamfer', BLANK: 'blank',
             INK: 'ink', GRID: 'grid', THEORY: 'theory', LIMIT: 'limit', METAL: 'metal', HELD: 'held',
             **{colour: 'tooth%d' % i for i, colour in enumerate(TEETH)}}

ODD_STYLE = {'marker': 'o', 'color': ODD_COLOUR, 'markerfacecolor': 'none'}
EVEN_STYLE = {'marker': 's', 'color': CURVE}

matplotlib.rcParams.update({
    'axes.axisbelow': True, 'axes.edgecolor': INK, 'axes.facecolor': 'none', 'axes.grid': True, 'axes.labelcolor': INK,
    'axes.spines.right': False, 'axes.spines.top': False, 'axes.titlesize': 9, 'figure.facecolor': 'none', 'font.size': 9,
    'grid.color': GRID, 'grid.linewidth': 0.6, 'legend.frameon': False, 'lines.linewidth': 0.9, 'svg.fonttype': 'none',
    'svg.hashsalt': 'grind report', 'text.color': INK, 'xtick.color': INK, 'ytick.color': INK})


def new_figure(height, width=WIDTH):
    return Figure((width, height), constrained_layout=True)


def svg_of(figure):
    """The SVG of a figure, as a file of its own."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format='svg', metadata={'Date': None})
    return buffer.getvalue().decode()
