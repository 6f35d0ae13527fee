"""Which pictures a report has."""

from drawing import tool_drawing
from tool import tool_pictures


def draw(plots, findings):
    """Lists of pictures by the part of the report: 'asked', 'tool', 'feed', the quantities of the axes, 'timing', 'curve'.
    plots: of the rows, or None."""
    data, parts = findings.data, {}
    if data.get('job'):
        parts['asked'] = [tool_drawing(data['job']['file']['cutter'])]
    if data.get('tool'):
        parts['tool'] = tool_pictures(data['tool'])
    if plots:
        parts.update(plots.pictures(findings.figures, data, findings.limits))
    return parts
