"""The bench's side of HAL for the tests: what a HAL sampler has recorded of every servo cycle, signals to set, and a node of
the grinder that a test may stop, kill and start anew."""

import collections
import ctypes
import functools
import os
import signal
import subprocess
import sys
import tempfile

import rospkg
import rosgraph
import yaml

ROOT = rospkg.RosPack().get_path('flute_grinder')
sys.path.insert(0, ROOT + '/test/node')
import grinder_client as gc  # noqa: E402

SAMPLER_KEY = 0x48534130
COLUMNS = b'ffffffffbbus'
COMMAND, POSITION = slice(0, 4), slice(4, 8)

Row = collections.namedtuple('Row', 'command position enabled emergency_stop played underruns')


class Datum(ctypes.Union):
    _fields_ = [('f', ctypes.c_double), ('b', ctypes.c_bool), ('s', ctypes.c_int32), ('u', ctypes.c_uint32)]


class Stream(ctypes.Structure):
    _fields_ = [('component', ctypes.c_int), ('memory', ctypes.c_int), ('fifo', ctypes.c_void_p)]


# Of the drive [s]: longer than a host stalls.
BUFFER = 0.5


class Recorder:
    """Reads the bench's sampler. To be made before there are threads: HAL keeps an address that another's mmap may take."""

    def __init__(self):
        self.rows = []
        self._hal = ctypes.CDLL('liblinuxcnchal.so.0')
        self._hal.hal_stream_readable.restype = ctypes.c_bool
        self._stream = Stream()
        self._component = self._hal.hal_init(b'recorder-%d' % os.getpid())
        assert self._component >= 0, 'no HAL'
        error = self._hal.hal_stream_attach(ctypes.byref(self._stream), self._component, SAMPLER_KEY, COLUMNS)
        assert error == 0, 'no sampler: %d' % error
        self._hal.hal_ready(self._component)

    def read(self):
        """Takes what was recorded since the last call, and returns all rows so far."""
        data = (Datum * 21)()
        while self._hal.hal_stream_readable(ctypes.byref(self._stream)):
            assert self._hal.hal_stream_read(ctypes.byref(self._stream), data, None) >= 0
            values = [getattr(d, chr(c)) for d, c in zip(data, COLUMNS)]
            self.rows.append(Row(tuple(values[COMMAND]), tuple(values[POSITION]), *values[8:]))
        return self.rows

    def now(self):
        """How many rows there are so far: those from here on are of later servo cycles."""
        return len(self.read())

    def over(self, cycles):
        """The rows of the next servo cycles."""
        first = self.now()
        gc.poll(lambda: len(self.read()) >= first + cycles, '%d servo cycles' % cycles)
        return self.rows[first:first + cycles]


@functools.lru_cache(None)
def recorder():
    """That of the process, since a row is read but once."""
    return Recorder()


def halcmd(*words):
    """Runs a command of HAL and returns what it says. No pipe: a program that halcmd starts would keep it open."""
    with tempfile.TemporaryFile('w+') as output:
        status = subprocess.call(['halcmd', *words], stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
        output.seek(0)
        text = output.read()
    assert status == 0, text
    return text


def wait_signal(name, value):
    gc.poll(lambda: halcmd('gets', name).split()[-1] == value, 'HAL signal %s %s' % (name, value))


def press_emergency_stop(pressed):
    halcmd('sets', 'emergency-stop', str(pressed))


def patience(seconds):
    """How long HAL waits for the node's heartbeat."""
    halcmd('setp', 'watchdog.timeout-0', str(seconds))


def merge(base, over):
    for key, value in over.items():
        if isinstance(value, dict) and isinstance(base.get(key), dict):
            merge(base[key], value)
        else:
            base[key] = value
    return base


def parameters(**hardware):
    """The machine's parameters with the HAL drive, as shipped but for those of the drive that are named."""
    machine = {}
    for name in ('grinder', 'hal'):
        with open('%s/config/%s.yaml' % (ROOT, name)) as text:
            merge(machine, yaml.safe_load(text))
    merge(machine, {'hardware': hardware})
    return machine


class Node:
    """A grinder's node on HAL. Longer than shipped (None), buffer and time-outs let a host that stalls not end a test."""

    def __init__(self, name='grinder', prefix=(), feedback_timeout=10, buffer=BUFFER, **hardware):
        self.name = name
        machine = parameters(**hardware)
        if buffer:
            machine['hardware']['buffer'] = buffer
        if feedback_timeout:
            machine.update(feedback_timeout=feedback_timeout, jog_timeout=1)
        folder = tempfile.mkdtemp()
        # For a test that starts the node as somebody else.
        os.chmod(folder, 0o777)
        machine['journal'] = folder + '/journal'
        machine['offsets'] = folder + '/offsets'
        machine['history'] = folder + '/history'
        machine['tolerances'] = gc.package_file('config/tolerances.yaml')
        rosgraph.Master('/hal_bench').setParam('/' + name, machine)
        self.log = tempfile.TemporaryFile('w+')
        self.process = subprocess.Popen([*prefix, gc.program('grinder'), '__name:=' + name], stdin=subprocess.DEVNULL,
                                        stdout=self.log, stderr=subprocess.STDOUT)

    @property
    def output(self):
        self.log.seek(0)
        return self.log.read()

    def send(self, number):
        self.process.send_signal(number)

    def end(self, number=signal.SIGTERM):
        """Ends the node by a signal, or waits for its end (None); returns its exit status."""
        if number and self.process.poll() is None:
            self.process.send_signal(number)
        try:
            return self.process.wait(timeout=gc.PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise


def max_steps(rows):
    """Of each axis' position, from one servo cycle to the next."""
    return [max(abs(b.position[axis] - a.position[axis]) for a, b in zip(rows, rows[1:])) for axis in range(4)]
