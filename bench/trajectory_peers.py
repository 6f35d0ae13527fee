"""Peers that follow a trajectory of states, compiled from their sources: Ruckig, and the joint trajectory controller of ros_control."""

import os
import pathlib
import re
import subprocess

import numpy

import peers

ROOT = pathlib.Path(__file__).resolve().parents[1]
FOLDER = ROOT / 'build/bench'


def of_ruckig(folder):
    """(name, program), compiled from the folder of its sources."""
    version = version_in(folder / 'CMakeLists.txt', r'ruckig VERSION ([\d.]+)')
    sources = [source for source in sorted((folder / 'src/ruckig').glob('*.cpp')) if source.stem != 'cloud_client']
    return 'Ruckig ' + version, compiled('ruckig', '-DRUCKIG', '-I', folder / 'include', *sources)


def of_ros_controllers(folder):
    """(name, program), compiled from the folder of its sources."""
    package = folder / 'joint_trajectory_controller'
    version = version_in(package / 'package.xml', r'<version>([\d.]+)')
    return 'joint trajectory controller ' + version, compiled('ros_controllers', '-I', package / 'include')


def version_in(path, pattern):
    found = re.search(pattern, path.read_text())
    if not found:
        raise RuntimeError('%s: names no version' % path)
    return found[1]


def compiled(name, *arguments):
    FOLDER.mkdir(parents=True, exist_ok=True)
    program = FOLDER / ('peer_' + name)
    compiler = [os.environ.get('CXX', 'c++'), '-std=c++20', '-O2', ROOT / 'bench/trajectory_peer.cpp', *arguments]
    subprocess.run([*compiler, '-o', program], check=True)
    return program


class Feed:
    """The speed of X of a stroke: up to the feed and down to rest by 3 u^2 - 2 u^3 of the time of a ramp. SI units."""

    def __init__(self, cutter, feed, ramp):
        self.cutter, self.speed, self.ramp = cutter, feed / cutter.edge(), ramp
        self.duration = peers.LENGTH / self.speed + ramp

    def x(self, time):
        """X, its speed and its acceleration."""
        last = time > self.duration / 2
        u = numpy.minimum(numpy.where(last, self.duration - time, time) / self.ramp, 1)
        past = numpy.where(last, self.duration - time, time) - u * self.ramp
        x = self.speed * (self.ramp * (u**3 - u**4 / 2) + past)
        return (numpy.where(last, peers.LENGTH - x, x), self.speed * (3 * u**2 - 2 * u**3),
                numpy.where(last, -1, 1) * self.speed / self.ramp * 6 * (u - u**2))

    def states(self, spacing):
        """(time, positions, velocities, accelerations) at points no farther apart than said, and at the ends of the ramps."""
        times = numpy.linspace(0, self.duration, 100000)
        points = self.cutter.points(spacing)
        time = numpy.unique(numpy.append(numpy.interp(points, self.x(times)[0], times), [self.ramp, self.duration - self.ramp]))
        time[0], time[-1] = 0, self.duration
        x, speed, acceleration = self.x(time)
        slope, bend = self.cutter.slopes(x)
        return numpy.column_stack((time, self.cutter.rows(x), slope * speed[:, None],
                                   slope * acceleration[:, None] + bend * speed[:, None]**2))


def timed(cutter, feed, acceleration, jerk):
    """The feed with the shortest ramp at which the axes keep their limits, to a hundredth."""
    def keeps(ramp):
        at = Feed(cutter, feed, ramp)
        time = numpy.minimum(numpy.arange(0, at.duration + peers.PERIOD, peers.PERIOD), at.duration)
        return all(peers.uses(cutter.rows(at.x(time)[0]), limits, order, 1) <= 1 for limits, order in ((acceleration, 2), (jerk, 3)))

    ramp, longest = peers.PERIOD, peers.LENGTH / feed * cutter.edge()
    while not keeps(ramp):
        ramp *= 1.01
        if ramp > longest:
            raise RuntimeError('no ramp up to a feed of %g m/s keeps the limits' % feed)
    return Feed(cutter, feed, ramp)


def goal_size(states):
    """Bytes of a trajectory_msgs/JointTrajectory of these states: a header, four names such as axis_x, and of each point three
    arrays of four numbers, an empty one, and its time."""
    return 16 + 4 + 4 * (4 + 6) + 4 + len(states) * (3 * (4 + 4 * 8) + 4 + 8)


def run(program, states, of_axes):
    """@return setpoints, and the processor time of one [s]."""
    text = '\n'.join(' '.join('%.17g' % value for value in row) for row in [*of_axes[:, 2:5].T, *states])
    done = subprocess.run([program], input=text, stdout=subprocess.PIPE, check=True, universal_newlines=True).stdout
    used, _, rows = done.partition('\n')
    return numpy.array([row.split() for row in rows.splitlines()], float), float(used)
