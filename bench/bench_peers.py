#!/usr/bin/env python3
"""What LinuxCNC makes of the strokes that flute_grinder grinds, on this computer. `scripts/bench_peers` runs it."""

import math
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

import numpy
import yaml

import figures
import linuxcnc_peer
import peers

ROOT = pathlib.Path(__file__).resolve().parents[1]
CUTTERS = {name: peers.Cutter(diameter, *map(math.radians, angles)) for name, diameter, angles in (
    ("the paper's", 0.01, (5, 30, 8)), ('cylinder', 0.01, (0, 30, 8)), ('steep cone', 0.002, (15, 45, 8)))}
FEEDS = (60, 600)  # along the edge [mm/min]
MODES = ('G64 P0.001', 'G61')
HEADER = ('cutter', 'feed mm/min', 'mode', 'spacing mm', 'A at points rad', 'between rad', 'feed least', 'most',
          'acceleration of limit, 1 cycle', '2 cycles', 'jerk of limit, 1 cycle', '2 cycles', 'bytes', 'to motion ms',
          '% of a core', 'MB')


def limits():
    """(lower, upper, velocity, acceleration, jerk) of X, Y, Z, A, as shipped."""
    joints = {joint.get('name'): joint.find('limit') for joint in xml.parse(ROOT / 'urdf/grinder.urdf').iter('joint')}
    more = yaml.safe_load((ROOT / 'config/grinder.yaml').read_text())['joint_limits']
    names = ['axis_' + axis.lower() for axis in linuxcnc_peer.AXES]
    return [[float(joints[name].get(key)) for key in ('lower', 'upper', 'velocity')] +
            [more[name]['max_acceleration'], more[name]['max_jerk']] for name in names]


def measure(cutters, feeds):
    """Yields the table's rows."""
    of_axes = numpy.array(limits())
    cases = [(name, feed, mode, cutters[name].points(spacing)) for name in cutters for feed in feeds
             for spacing in sorted({cutters[name].spacing(), 1e-5}, reverse=True) for mode in MODES]
    programs = [peers.g_code(cutters[name], points, feed / 6e4, mode) for name, feed, mode, points in cases]
    with tempfile.TemporaryDirectory() as folder:
        runs = linuxcnc_peer.run(pathlib.Path(folder), programs, of_axes[:, :4].tolist())
        for (name, feed, mode, points), program, run in zip(cases, programs, runs):
            found = peers.judge(cutters[name], numpy.array(run['rows']), of_axes[:, 3], of_axes[:, 4], points)
            values = [1e3 * points[1], found['at_points'], found['between'], *(6e4 * v for v in found['feed']),
                      *found['acceleration'], *found['jerk']]
            yield [name, str(feed), mode, *map(figures.number, values), str(len(program)),
                   *map(figures.number, (1e3 * run['motion'], 100 * run['processor'], run['memory'] / 1e6))]


def main():
    version = subprocess.run(['dpkg-query', '-W', 'linuxcnc-uspace'], check=True, stdout=subprocess.PIPE,
                             universal_newlines=True).stdout.split()[1]
    print('linuxcnc-uspace %s, %s, %d cores, load %.2f' % (version, platform.release(), os.cpu_count(), os.getloadavg()[0]))
    try:
        print(figures.aligned([HEADER, *measure(CUTTERS, FEEDS)]))
    except RuntimeError as error:
        sys.exit(str(error))


if __name__ == '__main__':
    main()
