#!/usr/bin/env python3
"""Shows how the node starts on HAL: not at all, with the reason, where HAL, its FIFO, a signal or a permission is missing; and
that a start that fails leaves HAL as it was; and that it takes the swivel's encoder from HAL where there is one, and offers
what HAL has a signal for."""

import ctypes
import math
import os
import signal
import subprocess
import tempfile
import unittest

import rospy
import rostest
from flute_grinder.msg import GrinderState, MachineInfo

import hal_bench
from hal_bench import gc

IN_HAL = hal_bench.ROOT + '/test/hal/in_hal'
IN_TEMPLATE = ('env', '-u', 'INSIDE_HAL', 'HAL_FILE=' + hal_bench.ROOT + '/hal/template.hal', IN_HAL)
NAMESPACE = ('unshare', '--ipc') if os.getuid() == 0 else ('unshare', '--user', '--map-current-user', '--ipc')


class TestRefusals(unittest.TestCase):
    def check(self, *texts, prefix=(), **hardware):
        """The node ends by itself with status 1 and says why."""
        node = hal_bench.Node('refused', prefix=prefix, **hardware)
        self.assertEqual(node.end(None), 1, node.output)
        for text in texts:
            self.assertIn(text, node.output)

    def check_in_hal(self, old, new, *texts, **hardware):
        """The same on a HAL of its own, from the bench's file with another text in it."""
        with open(hal_bench.ROOT + '/hal/bench.hal') as bench:
            file = bench.read()
        self.assertIn(old, file)
        with tempfile.NamedTemporaryFile('w', suffix='.hal') as changed:
            changed.write(file.replace(old, new))
            changed.flush()
            os.chmod(changed.name, 0o644)
            self.check(*texts, prefix=('env', '-u', 'INSIDE_HAL', 'HAL_FILE=' + changed.name, IN_HAL), **hardware)

    def tearDown(self):
        """A node can start after all of them."""
        node = hal_bench.Node('well')
        try:
            grinder = gc.Grinder('well')
            self.assertEqual(grinder.fresh_state().state, GrinderState.DISABLED)
            grinder.close()
        finally:
            status = node.end()
        self.assertEqual(status, 0, node.output)

    def test_hal_absent(self):
        self.check("LinuxCNC's HAL is not there (No such file or directory); start it first: halcmd -f FILE.hal",
                   prefix=NAMESPACE)

    @unittest.skipUnless(os.getuid() == 0, 'only root may become somebody else')
    def test_no_permission(self):
        somebody = ('setpriv', '--reuid=65533', '--regid=65533', '--clear-groups')
        if subprocess.call([*somebody, 'test', '-r', gc.program('grinder')]) != 0:
            self.skipTest('others may not read this folder')
        with tempfile.TemporaryDirectory() as home:
            os.chmod(home, 0o777)
            self.check("no permission to use LinuxCNC's HAL as user 65533", prefix=('env', 'HOME=' + home, *somebody))

    def test_no_streamer_of_that_number(self):
        self.check("HAL's streamer.1 is not there (No such file or directory); load it: loadrt streamer cfg=ffffu",
                   streamer=1)

    def test_fifo_of_another_type(self):
        self.check_in_hal('depth=4096 cfg=ffffu\n', 'depth=4096,4096 cfg=ffffu,fffsu\n',
                          "HAL's streamer.1 has other columns; allowed: cfg=ffffu (X, Y, Z, A, number)", streamer=1)

    def test_fifo_with_one_column_more(self):
        self.check_in_hal('cfg=ffffu\n', 'cfg=ffffub\n', "HAL's streamer.0 has other columns; allowed: cfg=ffffu")

    def test_fifo_not_deep_enough(self):
        self.check_in_hal('streamer    depth=4096', 'streamer    depth=90',
                          "HAL's streamer.0 has depth=90; allowed: 100 or more for this buffer", buffer=0.05)

    def test_signals_missing(self):
        self.check_in_hal('newsig probe-free bit\nsets probe-free true\n', '', 'HAL lacks the signals probe-free;')

    def test_signal_of_another_type(self):
        self.check_in_hal('newsig probe-free bit\nsets probe-free true\n', 'newsig probe-free float\n',
                          "HAL's signal 'probe-free' is of type float; allowed: bit")

    def test_signal_with_another_writer(self):
        self.check_in_hal('net heartbeat ', 'net heartbeat chain.fault-out\nnet heartbeat ',
                          "HAL's signal 'heartbeat' has a writer already; allowed: none beside flute-grinder.heartbeat")

    def test_servo_thread_not_started(self):
        self.check_in_hal('\nstart\n', '\n', "HAL's servo thread runs at 0 Hz (0 if it was not started); allowed: "
                          'control_rate = 1000 Hz')

    def test_servo_thread_of_another_rate(self):
        self.check_in_hal('period1=1000000', 'period1=2000000', "HAL's servo thread runs at 500 Hz")

    def test_component_of_a_running_node(self):
        node = hal_bench.Node('first')
        grinder = gc.Grinder('first')
        self.check("HAL has a component 'flute-grinder' already, of the running process %d" % node.process.pid)
        self.assertEqual(grinder.fresh_state().state, GrinderState.DISABLED)
        grinder.close()
        self.assertEqual(node.end(), 0)

    def test_component_of_another_program(self):
        hal = ctypes.CDLL('liblinuxcnchal.so.0')
        other = hal.hal_init(b'flute-grinder')
        self.assertGreater(other, 0)
        try:
            self.check("HAL has a component 'flute-grinder' already, and it is not a grinder's; allowed: another name")
        finally:
            hal.hal_exit(other)


class TestTakeover(unittest.TestCase):
    def test_node_takes_over_from_a_killed_one_again_and_again(self):
        for _ in range(3):
            node = hal_bench.Node('killed')
            grinder = gc.Grinder('killed')
            grinder.make_ready()
            grinder.close()
            node.end(signal.SIGKILL)
        node = hal_bench.Node('killed')
        grinder = gc.Grinder('killed')
        grinder.make_ready()
        grinder.close()
        self.assertEqual(node.end(), 0, node.output)
        self.assertNotIn('flute-grinder ', hal_bench.halcmd('show', 'comp'))


class TestTemplate(unittest.TestCase):
    def test_node_starts_and_offers_what_it_has_signals_for(self):
        node = hal_bench.Node('templated', prefix=IN_TEMPLATE)
        self.addCleanup(node.end, signal.SIGKILL)
        grinder = gc.Grinder('templated')
        self.addCleanup(grinder.close)
        self.assertTrue(grinder.fresh_state().emergency_stop)
        machine = rospy.wait_for_message('/templated/machine', MachineInfo, gc.PATIENCE)
        self.assertEqual((machine.homing, machine.spindle, machine.coolant), (False, True, True))


class TestSwivel(unittest.TestCase):
    def start(self):
        node = hal_bench.Node('swivelled')
        self.addCleanup(node.end)
        grinder = gc.Grinder('swivelled')
        self.addCleanup(grinder.close)
        return grinder

    def test_without_a_signal_it_is_not_measured(self):
        state = self.start().fresh_state()
        self.assertTrue(math.isnan(state.swivel))
        self.assertFalse(state.swivel_measured)

    def test_signal_is_its_encoder(self):
        hal_bench.halcmd('newsig', 'swivel', 'float')
        self.addCleanup(hal_bench.halcmd, 'delsig', 'swivel')
        hal_bench.halcmd('sets', 'swivel', '0.25')
        grinder = self.start()
        state = grinder.fresh_state()
        self.assertEqual((state.swivel, state.swivel_measured), (0.25, True))
        hal_bench.halcmd('sets', 'swivel', '-0.125')
        gc.poll(lambda: grinder.fresh_state().swivel == -0.125, 'the other angle')


if __name__ == '__main__':
    rospy.init_node('test_hal_start')
    rostest.rosrun('flute_grinder', 'hal_start', '__main__')
