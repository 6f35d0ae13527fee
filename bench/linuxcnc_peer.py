#!/usr/bin/env python3
"""LinuxCNC without a screen: `run()` starts it with simulated axes in a folder, on a HAL of its own, and gives what its servo
thread commands in programs. LinuxCNC starts this file for that, as its display."""

import json
import math
import os
import pathlib
import subprocess
import sys
import time

import bench_rest

AXES = 'XYZA'
PATIENCE = 600  # [s]
PROCESSES = ('rtapi_app', 'milltask', 'io', 'linuxcncsvr')
UNITS = (1e-3, 1e-3, 1e-3, math.pi / 180)

INI = """[EMC]
VERSION = 1.1
MACHINE = peer
[DISPLAY]
DISPLAY = {display}
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = peer.var
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 1.0
SERVO_PERIOD = 1000000
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = peer.tbl
[HAL]
HALFILE = peer.hal
[KINS]
KINEMATICS = trivkins coordinates=XYZA
JOINTS = 4
[TRAJ]
COORDINATES = XYZA
LINEAR_UNITS = mm
ANGULAR_UNITS = degree
MAX_LINEAR_VELOCITY = {velocity[0]}
MAX_LINEAR_ACCELERATION = {acceleration[0]}
MAX_ANGULAR_VELOCITY = {velocity[3]}
MAX_ANGULAR_ACCELERATION = {acceleration[3]}
"""

AXIS = """[AXIS_{axis}]
{limits}[JOINT_{joint}]
TYPE = {type}
HOME = 0
HOME_SEQUENCE = 0
HOME_SEARCH_VEL = 0
HOME_LATCH_VEL = 0
FERROR = 1
{limits}"""

LIMITS = """MIN_LIMIT = {0}
MAX_LIMIT = {1}
MAX_VELOCITY = {2}
MAX_ACCELERATION = {3}
"""

HAL = """loadrt [KINS]KINEMATICS
loadrt motmod servo_period_nsec=1000000 num_joints=4
loadrt sampler depth=65536 cfg=ffff
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
net enable iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in
""" + ''.join('net {0} joint.{1}.motor-pos-cmd => joint.{1}.motor-pos-fb sampler.0.pin.{1}\n'.format(axis.lower(), i)
              for i, axis in enumerate(AXES))


def write_machine(folder, limits):
    """@param limits (lower, upper, velocity, acceleration) of X, Y, Z, A in SI units."""
    limits = [[value / unit for value in of_axis] for of_axis, unit in zip(limits, UNITS)]
    ini = INI.format(display=pathlib.Path(__file__).resolve(), velocity=[axis[2] for axis in limits],
                     acceleration=[axis[3] for axis in limits])
    ini += ''.join(AXIS.format(axis=axis, joint=i, type='ANGULAR' if axis == 'A' else 'LINEAR', limits=LIMITS.format(*limits[i]))
                   for i, axis in enumerate(AXES))
    for name, text in (('peer.ini', ini), ('peer.hal', HAL), ('peer.tbl', ''), ('peer.var', '')):
        (folder / name).write_text(text)


def run(folder, programs, limits):
    """Has programs run, one after the other, each from X, Y, Z, A = 0. Yields of each a dict: `rows` of the servo cycles, time
    to the first motion [s], share of a core, resident memory [bytes]. @raise RuntimeError if LinuxCNC fails."""
    folder.chmod(0o777)  # LinuxCNC refuses to run as root, and is somebody else then
    write_machine(folder, limits)
    for i, program in enumerate(programs):
        (folder / ('%d.ngc' % i)).write_text(program)
    environment = dict(os.environ, HOME=str(folder), RTAPI_FIFO_PATH=str(folder / 'fifo'))
    environment.pop('DISPLAY', None)
    user = ['--user', '--map-current-user']
    if os.getuid() == 0:
        environment['RTAPI_UID'], user = '65534', []
    with open(folder / 'linuxcnc.log', 'w') as log:
        subprocess.run(['unshare', *user, '--ipc', '--pid', '--fork', '--mount-proc', '--kill-child', 'linuxcnc', 'peer.ini'],
                       cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
    for i in range(len(programs)):
        found = folder / ('%d.json' % i)
        if not found.exists():
            raise RuntimeError('LinuxCNC failed: ' + ''.join(p.read_text()[-2000:] for p in sorted(folder.glob('*.log'))))
        yield json.loads(found.read_text())


class Display:
    """LinuxCNC's side."""

    def __init__(self):
        import hal
        import linuxcnc
        self._linuxcnc = linuxcnc
        self.command, self.status, self._errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
        component = hal.component('bench')
        component.ready()
        self._component, self._stream = component, hal.stream(component, hal.sampler_base, 'ffff')
        self.command.state(linuxcnc.STATE_ESTOP_RESET)
        self.command.wait_complete()
        self.command.state(linuxcnc.STATE_ON)
        self.command.wait_complete()
        self.command.mode(linuxcnc.MODE_MANUAL)
        self.command.wait_complete()
        self.command.home(-1)
        self.wait(lambda _: all(self.status.homed[:len(AXES)]), 'homing')

    def wait(self, condition, what):
        """@return the rows sampled meanwhile."""
        rows, deadline = [], time.monotonic() + PATIENCE
        while True:
            while self._stream.readable:
                rows.append(self._stream.read())
            self.status.poll()
            error = self._errors.poll()
            if error or time.monotonic() > deadline:
                raise RuntimeError('%s: %s' % (what, error or 'timed out'))
            if condition(rows):
                return rows
            time.sleep(0.005)

    def idle(self, _):
        return self.status.interp_state == self._linuxcnc.INTERP_IDLE and self.status.inpos and not self.status.queue

    def to_zero(self):
        self.command.mode(self._linuxcnc.MODE_MDI)
        self.command.wait_complete()
        self.command.mdi('G21 G90 G94 G0 X0 Y0 Z0 A0')
        self.command.wait_complete(PATIENCE)
        self.wait(self.idle, 'way back')
        self.command.mode(self._linuxcnc.MODE_AUTO)
        self.command.wait_complete()

    def measure(self, program):
        self.to_zero()
        processes = pids()
        self.wait(lambda _: True, 'samples')  # all of them are older than the program
        used, begin = processor(processes), time.monotonic()
        self.command.program_open(program)
        self.command.auto(self._linuxcnc.AUTO_RUN, 0)
        rows = self.wait(lambda rows: rows and rows[-1] != rows[0] and self.idle(rows), 'end')
        taken = time.monotonic() - begin
        used = processor(processes) - used
        moving = [i for i in range(1, len(rows)) if rows[i] != rows[i - 1]]
        return {'rows': [[v * u for v, u in zip(row, UNITS)] for row in rows[moving[0] - 1:moving[-1] + 1]],
                'motion': moving[0] * 0.001, 'processor': used / taken,
                'memory': sum(bench_rest.memory(pid)['resident'] for pid in processes)}


def pids():
    """Of LinuxCNC: this namespace has no others of these names."""
    found = [int(p.name) for p in pathlib.Path('/proc').glob('[0-9]*')]
    return [pid for pid in found if pathlib.Path('/proc/%d/comm' % pid).read_text().split(':')[0].strip() in PROCESSES]


def processor(processes):
    """Time [s] of all threads."""
    return sum(thread[1] for pid in processes for thread in bench_rest.threads(pid).values())


def main():
    """As LinuxCNC's display, in the folder of its INI file."""
    with open('display.log', 'w', 1) as log:
        sys.stdout = sys.stderr = log
        display = Display()
        for program in sorted(pathlib.Path.cwd().glob('*.ngc'), key=lambda path: int(path.stem)):
            found = display.measure(str(program))
            program.with_suffix('.json').write_text(json.dumps(found))


if __name__ == '__main__':
    main()
