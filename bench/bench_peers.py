#!/usr/bin/env python3
"""The strokes that flute_grinder grinds, and what LinuxCNC and others make of the same ones, on this computer. `scripts/bench_peers` runs it."""

import argparse
import io
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as xml

import flute_grinder.job
import numpy
import rospy
import yaml

import bench_all
import bench_rest
import figures
import linuxcnc_peer
import peers
import trajectory_peers
from bench_all import gc

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / 'docs/comparison.md'
CUTTERS = {name: peers.Cutter(diameter, *map(math.radians, angles)) for name, diameter, angles in (
    ("the paper's", 0.01, (5, 30, 8)), ('cylinder', 0.01, (0, 30, 8)), ('steep cone', 0.002, (15, 45, 8)))}
FEEDS = (60, 600)  # along the edge [mm/min]
MODES = ('G64 P0.001', 'G61')
HEADER = ['cutter', 'feed mm/min', 'by', 'spacing mm', 'A at points rad', 'between rad', 'feed reached mm/min',
          'acceleration / limit', 'jerk / limit', 'bytes', 'to motion ms', '% of a core', 'MB']


def limits():
    """(lower, upper, velocity, acceleration, jerk) of X, Y, Z, A, as shipped."""
    joints = {joint.get('name'): joint.find('limit') for joint in xml.parse(ROOT / 'urdf/grinder.urdf').iter('joint')}
    more = yaml.safe_load((ROOT / 'config/grinder.yaml').read_text())['joint_limits']
    names = ['axis_' + axis.lower() for axis in linuxcnc_peer.AXES]
    return [[float(joints[name].get(key)) for key in ('lower', 'upper', 'velocity')] +
            [more[name]['max_acceleration'], more[name]['max_jerk']] for name in names]


def row(name, feed, by, spacing, found, size, more):
    """Of the table. @param spacing of the goal's points [m]. @param found by peers.judge(). @param size of the goal [bytes].
    @param more time to motion [ms], processor [% of a core], memory [MB]."""
    least, most = (figures.number(6e4 * value) for value in found['feed'])
    used = (' and '.join(map(figures.number, found[what])) for what in ('acceleration', 'jerk'))
    return [name, str(feed), by, figures.number(spacing and 1e3 * spacing), figures.number(found['at_points']),
            figures.number(found['between']), '%s to %s' % (least, most), *used, str(size), *map(figures.number, more)]


def job_file(folder, cutter, feed):
    """A job with a flute of this law, 1 mm beyond either end. Whatever tool it grinds is good enough."""
    job = yaml.safe_load((ROOT / 'test/jobs/paper.yaml').read_text())
    diameter = 1e3 * cutter.diameter
    job['cutter'].update({key + '_deg': math.degrees(angle) for key, angle in (
        ('cone_angle', cutter.cone), ('spiral_angle', cutter.spiral), ('rake_angle', cutter.rake))},
        end_diameter_mm=diameter, shank_diameter_mm=2e3 * cutter.radius(peers.LENGTH), core_diameter_mm=0.7 * diameter,
        core_diameter_end_mm=0.7 * diameter, core_tolerance_mm=100, rake_tolerance_deg=90, chordal_rake_tolerance_deg=90,
        spiral_tolerance_deg=90)
    job['process'].update(feed_mm_min=feed, depth_mm=0.15 * diameter, infeed_mm=0.15 * diameter, overtravel_mm=[1, 1],
                          incomplete_ok=True)
    path = pathlib.Path(folder) / 'job.yaml'
    path.write_text(yaml.safe_dump(job))
    return path


def measure_own(cutters, feeds, of_axes):
    """Yields the table's rows of flute_grinder, as its node streams them to the simulated drive."""
    with bench_all.grinder(), tempfile.TemporaryDirectory() as folder:
        rospy.init_node('bench_peers', disable_signals=True)
        client, node = gc.Grinder(), [bench_rest.process_of(bench_all.NODE)]
        for name, cutter in cutters.items():
            for feed in feeds:
                client.make_ready()
                goal, packed = flute_grinder.job.goal(str(job_file(folder, cutter, feed))), io.BytesIO()
                goal.serialize(packed)
                used, begin = linuxcnc_peer.processor(node), time.monotonic()
                run = client.send(goal).wait_complete(linuxcnc_peer.PATIENCE)
                share = (linuxcnc_peer.processor(node) - used) / (time.monotonic() - begin)
                if run.status != 'SUCCEEDED':
                    raise RuntimeError('%s at %d mm/min: %s' % (name, feed, run.text))
                stroke = numpy.array([s.position for s in run.setpoints if s.move == gc.STROKE])
                yield row(name, feed, 'flute_grinder', None, peers.judge(cutter, stroke, of_axes[:, 3], of_axes[:, 4]),
                          len(packed.getvalue()),
                          (1e3 * (first_motion(run) - run.sent), 100 * share, bench_rest.memory(node[0])['resident'] / 1e6))


def first_motion(run):
    """When the first setpoint was written that moves [s]."""
    return next(batch.header.stamp.to_sec() + i * batch.period
                for batch in run.batches for i, s in enumerate(batch.setpoints) if any(s.velocity))


def measure_linuxcnc(cutters, feeds, of_axes):
    """Yields the table's rows of LinuxCNC."""
    cases = [(name, feed, mode, cutters[name].points(spacing)) for name in cutters for feed in feeds
             for spacing in sorted({cutters[name].spacing(), 1e-5}, reverse=True) for mode in MODES]
    programs = [peers.g_code(cutters[name], points, feed / 6e4, mode) for name, feed, mode, points in cases]
    with tempfile.TemporaryDirectory() as folder:
        runs = linuxcnc_peer.run(pathlib.Path(folder), programs, of_axes[:, :4].tolist())
        for (name, feed, mode, points), program, run in zip(cases, programs, runs):
            found = peers.judge(cutters[name], numpy.array(run['rows']), of_axes[:, 3], of_axes[:, 4], points)
            yield row(name, feed, 'LinuxCNC, ' + mode, points[1], found, len(program),
                      (1e3 * run['motion'], 100 * run['processor'], run['memory'] / 1e6))


def measure_trajectories(cutters, feeds, of_axes, name, program):
    """Yields the table's rows of a peer that follows states of the path."""
    for cutter_name, cutter in cutters.items():
        for feed in feeds:
            timed = trajectory_peers.timed(cutter, feed / 6e4, of_axes[:, 3], of_axes[:, 4])
            for spacing in sorted({cutter.spacing(), 1e-5}, reverse=True):
                states = timed.states(spacing)
                rows, used = trajectory_peers.run(program, states, of_axes)
                found = peers.judge(cutter, rows, of_axes[:, 3], of_axes[:, 4], states[:, 1])
                yield row(cutter_name, feed, name, cutter.points(spacing)[1], found, trajectory_peers.goal_size(states),
                          (None, 100 * used / peers.PERIOD, None))


def linuxcnc():
    """LinuxCNC with its version."""
    return ' '.join(subprocess.run(['dpkg-query', '-W', 'linuxcnc-uspace'], check=True, stdout=subprocess.PIPE,
                                   universal_newlines=True).stdout.split())


def origin(load, *peer):
    """Where the table is from, in a line."""
    run = bench_all.origin()
    return ', '.join(['Commit %s of %s' % (run['commit'], run['date']), *peer, run['cpu'], '%d cores' % run['cores'], run['kernel'],
                      'load %.2f at the start.' % load])


def main():
    parser = argparse.ArgumentParser(prog='scripts/bench_peers', description=__doc__)
    parser.add_argument('--docs', action='store_true', help='write the table into docs/comparison.md')
    parser.add_argument('--ros-controllers', metavar='DIR', type=pathlib.Path,
                        help="only ros_control's joint trajectory controller, compiled from the sources of ros_controllers in DIR")
    parser.add_argument('--ruckig', metavar='DIR', type=pathlib.Path, help='only Ruckig, compiled from its sources in DIR')
    arguments = parser.parse_args()
    of_axes = numpy.array(limits())
    from_sources = [(by, folder) for by, folder in ((trajectory_peers.of_ros_controllers, arguments.ros_controllers),
                                                    (trajectory_peers.of_ruckig, arguments.ruckig)) if folder]
    load = os.getloadavg()[0]
    try:
        if from_sources:
            block, head = 'scripts/bench_peers --ros-controllers DIR --ruckig DIR', origin(load)
            found = [each for by, folder in from_sources for each in measure_trajectories(CUTTERS, FEEDS, of_axes, *by(folder))]
        else:
            block, head = 'scripts/bench_peers', origin(load, linuxcnc())
            found = [*measure_own(CUTTERS, FEEDS, of_axes), *measure_linuxcnc(CUTTERS, FEEDS, of_axes)]
    except (OSError, RuntimeError, subprocess.CalledProcessError) as error:
        sys.exit(str(error))
    table = [HEADER] + [found_row for name in CUTTERS for feed in FEEDS
                        for found_row in found if found_row[:2] == [name, str(feed)]]
    if arguments.docs:
        lines = figures.markdown(table, ['---', '---:', '---'] + ['---:'] * 10)
        PAGE.write_text(figures.with_lines(PAGE.read_text(), block, [head, '', *lines]))
    print(head + '\n\n' + figures.aligned(table))


if __name__ == '__main__':
    main()
