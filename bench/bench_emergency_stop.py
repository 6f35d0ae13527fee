#!/usr/bin/env python3
"""How long after the emergency stop's signal in HAL a client of the node has read of it, in the midst of strokes: the goal's
end with EMERGENCY_STOP, and the state. With the cores idle and with all of them loaded; `scripts/bench_hal` runs it on a HAL
of its own."""

import ctypes
import os
import statistics
import sys
import time

import rospkg
import rospy

sys.path.insert(0, rospkg.RosPack().get_path('flute_grinder') + '/test/hal')
import hal_bench  # noqa: E402
from bench_underruns import load  # noqa: E402
from flute_grinder.msg import GrindResult  # noqa: E402
from hal_bench import gc  # noqa: E402


class Button:
    """The bench's emergency stop, pressed without the time that halcmd takes to start."""

    def __init__(self):
        hal = ctypes.CDLL('liblinuxcnchal.so.0')
        self._signal = ctypes.POINTER(ctypes.c_bool)()
        error = hal.hal_get_signal_value_by_name(b'emergency-stop', ctypes.byref(ctypes.c_int()),
                                                 ctypes.byref(self._signal), ctypes.byref(ctypes.c_bool()))
        assert error == 0, 'no signal emergency-stop'

    def press(self, pressed):
        self._signal.contents.value = pressed


def press_in_stroke(grinder, button):
    """Returns the times in s from pressing to the goal's end and to the state; none if a stall has ended the job before."""
    grinder.make_ready()
    run = grinder.send(gc.PAPER)
    grinder.wait_for(lambda: run.done or run.last and run.last.move == gc.STROKE, 'the stroke')
    times = {}

    def reported():
        seen = {'goal': run.done, 'state': grinder.states[-1].emergency_stop}
        for what in seen:
            if seen[what]:
                times.setdefault(what, time.monotonic() - pressed)
        return len(times) == len(seen)

    pressed = time.monotonic()
    button.press(True)
    try:
        grinder.wait_for(reported, 'the emergency stop')
    finally:
        button.press(False)
    return times if run.code == GrindResult.EMERGENCY_STOP else None


def press_often(grinder, button, presses):
    """Returns the times of as many presses, and how many jobs a stall has ended."""
    times, stalls = [], 0
    while len(times) < presses:
        one = press_in_stroke(grinder, button)
        if one:
            times.append(one)
        else:
            stalls += 1
    return times, stalls


def main():
    presses = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    # Holds HAL's memory for the button.
    recorder = hal_bench.Recorder()
    rospy.init_node('bench_emergency_stop')
    button = Button()
    node = hal_bench.Node(buffer=None)
    grinder = gc.Grinder()
    print('%-8s %-12s %8s %11s %11s %14s' % ('cores', 'emerg. stop', 'presses', 'median', 'max', 'ended before'))
    for cores in ('idle', 'loaded'):
        with load(os.cpu_count() if cores == 'loaded' else 0):
            times, stalls = press_often(grinder, button, presses)
        recorder.read()
        for what in times[0]:
            of = [t[what] * 1e3 for t in times]
            print('%-8s %-12s %8d %8.1f ms %8.1f ms %14d' % (cores, what, len(of), statistics.median(of), max(of), stalls),
                  flush=True)
    grinder.close()
    node.end()


if __name__ == '__main__':
    main()
