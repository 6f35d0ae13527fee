"""Shows how the node starts on HAL: not at all, with the reason, where HAL, its FIFO, a signal or a permission is missing, and that a
start that fails leaves HAL as it was; and that it takes the swivel's encoder from HAL where there is one, and offers what HAL has a
signal for."""

import ctypes
import math
import os
import signal
import subprocess
import tempfile
import unittest

import rospy
from flute_grinder.msg import GrinderState, MachineInfo

import hal_bench
from hal_bench import gc

IN_HAL = hal_bench.ROOT + '/test/hal/in_hal'
IN_TEMPLATE = ('env', '-u', 'INSIDE_HAL', 'HAL_FILE=' + hal_bench.ROOT + '/hal/template.hal', IN_HAL)
NAMESPACE = ('unshare', '--ipc') if os.getuid() == 0 else ('unshare', '--user', '--map-current-user', '--ipc')


class HalStart(unittest.TestCase):
    def start(self, name, **options):
        """A node and its client, both closed after the test."""
        node = hal_bench.Node(name, **options)
        self.addCleanup(node.end, signal.SIGKILL)
        grinder = gc.Grinder(name)
        self.addCleanup(grinder.close)
        return node, grinder


class TestRefusals(HalStart):
    def check(self, text, prefix=(), **hardware):
        """The node ends by itself with status 1 and says why."""
        node = hal_bench.Node('refused', prefix=prefix, **hardware)
        self.assertEqual(node.end(None), 1, node.output)
        self.assertIn(text, node.output)

    def check_in_hal(self, old, new, text, **hardware):
        """The same on a HAL of its own, from the bench's file with another text in it."""
        with open(hal_bench.ROOT + '/hal/bench.hal') as bench:
            file = bench.read()
        self.assertIn(old, file)
        with tempfile.NamedTemporaryFile('w', suffix='.hal') as changed:
            changed.write(file.replace(old, new))
            changed.flush()
            os.chmod(changed.name, 0o644)
            self.check(text, prefix=('env', '-u', 'INSIDE_HAL', 'HAL_FILE=' + changed.name, IN_HAL), **hardware)

    def test_servo_thread_not_started(self):
        self.check_in_hal('\nstart\n', '\n', "HAL's servo thread runs at 0 Hz (0 if it was not started); allowed: "
                          'control_rate = 1000 Hz')

    def test_hal_that_lacks_something(self):
        signals = 'newsig probe-free bit\nsets probe-free true\n'
        for old, new, text, hardware in (
                ('depth=4096 cfg=ffffu\n', 'depth=4096,4096 cfg=ffffu,fffsu\n',
                 "HAL's streamer.1 has other columns; allowed: cfg=ffffu (X, Y, Z, A, number)", {'streamer': 1}),
                ('cfg=ffffu\n', 'cfg=ffffub\n', "HAL's streamer.0 has other columns; allowed: cfg=ffffu", {}),
                ('streamer    depth=4096', 'streamer    depth=90',
                 "HAL's streamer.0 has depth=90; allowed: 100 or more for this buffer", {'buffer': 0.05}),
                (signals, '', 'HAL lacks the signals probe-free;', {}),
                (signals, 'newsig probe-free float\n', "HAL's signal 'probe-free' is of type float; allowed: bit", {}),
                ('net heartbeat ', 'net heartbeat chain.fault-out\nnet heartbeat ',
                 "HAL's signal 'heartbeat' has a writer already; allowed: none beside flute-grinder.heartbeat", {}),
                ('period1=1000000', 'period1=2000000', "HAL's servo thread runs at 500 Hz", {})):
            with self.subTest(text):
                self.check_in_hal(old, new, text, **hardware)

    @unittest.skipUnless(os.getuid() == 0, 'only root may become somebody else')
    def test_no_permission(self):
        somebody = ('setpriv', '--reuid=65533', '--regid=65533', '--clear-groups')
        if subprocess.call([*somebody, 'test', '-r', gc.program('grinder')]) != 0:
            self.skipTest('others may not read this folder')
        with tempfile.TemporaryDirectory() as home:
            os.chmod(home, 0o777)
            self.check("no permission to use LinuxCNC's HAL as user 65533", prefix=('env', 'HOME=' + home, *somebody))

    def test_refused_on_this_hal_it_leaves_it_as_it_was(self):
        self.check("LinuxCNC's HAL is not there (No such file or directory); start it first: halcmd -f FILE.hal", prefix=NAMESPACE)
        self.check("HAL's streamer.1 is not there (No such file or directory); load it: loadrt streamer cfg=ffffu", streamer=1)
        hal = ctypes.CDLL('liblinuxcnchal.so.0')
        other = hal.hal_init(b'flute-grinder')
        self.assertGreater(other, 0)
        try:
            self.check("HAL has a component 'flute-grinder' already, and it is not a grinder's; allowed: another name")
        finally:
            hal.hal_exit(other)
        node, grinder = self.start('first')
        self.check("HAL has a component 'flute-grinder' already, of the running process %d" % node.process.pid)
        self.assertEqual(grinder.fresh_state().state, GrinderState.DISABLED)
        self.assertEqual(node.end(), 0, node.output)
        self.assertNotIn('flute-grinder ', hal_bench.halcmd('show', 'comp'))


class TestSignals(HalStart):
    def test_template_offers_what_it_has_signals_for(self):
        _, grinder = self.start('templated', prefix=IN_TEMPLATE)
        self.assertTrue(grinder.fresh_state().emergency_stop)
        machine = rospy.wait_for_message('/templated/machine', MachineInfo, gc.PATIENCE)
        self.assertEqual((machine.homing, machine.spindle, machine.coolant), (False, True, True))

    def test_swivel_is_measured_where_there_is_a_signal(self):
        node, grinder = self.start('unswivelled')
        state = grinder.fresh_state()
        self.assertTrue(math.isnan(state.swivel))
        self.assertFalse(state.swivel_measured)
        node.end()
        hal_bench.halcmd('newsig', 'swivel', 'float')
        self.addCleanup(hal_bench.halcmd, 'delsig', 'swivel')
        hal_bench.halcmd('sets', 'swivel', '0.25')
        _, grinder = self.start('swivelled')
        state = grinder.fresh_state()
        self.assertEqual((state.swivel, state.swivel_measured), (0.25, True))
        hal_bench.halcmd('sets', 'swivel', '-0.125')
        grinder.wait_fresh(lambda s: s.swivel == -0.125, 'the other angle')
