#!/usr/bin/env python3
"""How often HAL finds no setpoint: the paper's job with buffers of 20, 50, 100 and 200 ms, with the cores idle and with all of
them loaded. `scripts/bench_hal` runs it on a HAL of its own."""

import contextlib
import os
import subprocess
import sys

import rospkg
import rospy

sys.path.insert(0, rospkg.RosPack().get_path('flute_grinder') + '/test/hal')
import hal_bench  # noqa: E402
from hal_bench import gc  # noqa: E402

BUFFERS = (0.02, 0.05, 0.1, 0.2)
LOAD = 'while :; do :; done'


@contextlib.contextmanager
def load(cores):
    """Keeps cores busy."""
    burners = [subprocess.Popen(['sh', '-c', LOAD]) for _ in range(cores)]
    try:
        yield
    finally:
        for burner in burners:
            burner.kill()
            burner.wait()


def measure(recorder, buffer, seconds):
    """Runs jobs for a time; returns (servo cycles with power, underruns, why jobs failed)."""
    node = hal_bench.Node(buffer=buffer, feedback_timeout=None)
    grinder = gc.Grinder()
    first, failed = recorder.now(), []
    while recorder.now() - first < seconds * 1000:
        grinder.make_ready()
        run = grinder.send(gc.PAPER).wait()
        failed += [run.text] if run.status != 'SUCCEEDED' else []
    rows = recorder.read()[first:]
    grinder.close()
    node.end()
    return sum(row.enabled for row in rows), rows[-1].underruns - rows[0].underruns, failed


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 30
    recorder = hal_bench.Recorder()
    rospy.init_node('bench_underruns')
    print('%-8s %-8s %14s %10s %12s' % ('cores', 'buffer', 'servo cycles', 'underruns', 'jobs failed'))
    for cores in ('idle', 'loaded'):
        with load(os.cpu_count() if cores == 'loaded' else 0):
            for buffer in BUFFERS:
                cycles, underruns, failed = measure(recorder, buffer, seconds)
                print('%-8s %5.0f ms %14d %10d %12d' % (cores, buffer * 1000, cycles, underruns, len(failed)), flush=True)
                for reason in failed:
                    print('    ' + reason, flush=True)


if __name__ == '__main__':
    main()
