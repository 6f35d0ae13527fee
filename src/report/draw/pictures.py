"""The pictures of a report."""

import ctypes
import multiprocessing
import os
import re
import signal
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool

from document import Failure
from drawing import tool_drawing
from figures import plot_pictures
from measured import measured_pictures
from style import VARIABLES, svg_of
from tool import tool_pictures

PR_SET_PDEATHSIG = 1  # of prctl(2)


_pictures = []  # of a worker: a figure cannot be pickled, so that it inherits them all when it is forked


def _begin_work(pictures):
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    _pictures.extend(pictures)


def _page_svg(i):
    """The SVG of a worker's picture as part of a page: with unique ids, and with the page's variables for colours."""
    picture = _pictures[i]
    svg = svg_of(picture.figure)
    svg = re.sub(r'<metadata>.*?</metadata>', '', svg[svg.index('<svg'):], flags=re.DOTALL)
    svg = re.sub(r' (width|height)="[\d.]+pt"', '', svg, count=2)
    svg = re.sub(r'( id="|href="#|url\(#)', r'\g<1>%s-' % picture.name, svg)
    for colour, variable in VARIABLES.items():
        svg = svg.replace(colour, 'var(--%s)' % variable)
    return svg


def drawn(pictures):
    """The pictures with their SVG, drawn on all cores. @raise Failure"""
    workers = max(1, min(len(pictures), len(os.sched_getaffinity(0))))
    fork = multiprocessing.get_context('fork')
    try:
        with ProcessPoolExecutor(workers, fork, _begin_work, (pictures,)) as pool:
            return [picture._replace(figure=None, svg=svg) for picture, svg in zip(pictures, pool.map(_page_svg, range(len(pictures))))]
    except BrokenProcessPool:
        raise Failure('a process that draws pictures has died, as of too little memory', 1)


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
