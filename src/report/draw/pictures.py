"""The pictures of a report."""

from drawing import tool_drawing
from figures import plot_pictures
from measured import measured_pictures
from style import drawn
from tool import tool_pictures


def draw_all(data):
    """Lists of pictures by the part of the report: 'asked', 'measured', 'tool', 'feed', the quantities of the axes, 'timing', 'curve'."""
    parts = {}
    if data.get('job'):
        parts['asked'] = [tool_drawing(data['job']['file']['cutter'])]
    if data.get('tool'):
        parts['tool'] = tool_pictures(data['tool'])
    parts['measured'] = measured_pictures(data.get('operations', []))
    if data.get('plots'):
        parts.update(plot_pictures(data))
    pictures = iter(drawn([picture for part in parts.values() for picture in part]))
    return {name: [next(pictures) for _ in part] for name, part in parts.items()}
