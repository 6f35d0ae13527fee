"""Shows on the real HAL that each servo cycle plays exactly one setpoint: a job, recorded by a HAL sampler, is to the last bit what the
node says that it wrote."""

import unittest

from flute_grinder.msg import GrinderState

import hal_bench
from hal_bench import gc
import path_checks as checks

RECORDER = hal_bench.recorder()
# Long, so that a host that stalls does not decide the test.
BUFFER = 1.0


def bits(position):
    return tuple(value.hex() for value in position)


class TestStream(unittest.TestCase):
    def test_job_is_played_to_the_last_bit_and_the_axes_follow_it(self):
        hal_bench.patience(2 * BUFFER)
        node = hal_bench.Node(buffer=BUFFER)
        self.addCleanup(node.end)
        grinder = gc.Grinder()
        self.addCleanup(grinder.close)
        grinder.make_ready()
        first = RECORDER.now()
        run = grinder.run(gc.SHORT)
        self.assertEqual((run.status, run.text), ('SUCCEEDED', ''))
        RECORDER.over(10)
        rows = RECORDER.read()[first:]
        setpoints = [bits(s.position) for s in run.setpoints]
        self.assertTrue(checks.is_gapless(run.setpoints))
        # The first setpoints are where the axes stand; the first that is not shows where they begin.
        start = setpoints[0]
        standing = next(i for i, s in enumerate(setpoints) if s != start)
        moving = next(i for i, row in enumerate(rows) if bits(row.command) != start)
        rows = rows[moving - standing:]
        played = [bits(row.command) for row in rows]
        self.assertEqual(played[:len(setpoints)], setpoints)
        self.assertEqual(set(played[len(setpoints):]), {setpoints[-1]})
        # One more in each row: neither HAL nor its recorder has left a cycle out.
        self.assertEqual({(b.played - a.played) % 2 ** 32 for a, b in zip(rows, rows[1:])}, {1})
        self.assertEqual({row.underruns for row in rows}, {rows[0].underruns})
        self.assertTrue(all(row.enabled for row in rows))
        row = RECORDER.over(1)[0]
        self.assertEqual(bits(row.position), bits(row.command))
        self.assertEqual(grinder.wait_rest(), list(row.position))
        self.assertEqual(grinder.fresh_state().state, GrinderState.READY)
