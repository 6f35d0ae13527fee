"""Shows what the node does with drive plugins from a package of their own: those of another version of the drive interface it
refuses before it makes the drive, those that cannot do what the machine needs before they get power, and it waits for slow ones."""

import contextlib
import re
import signal
import unittest

import rosgraph
import rospy
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

from flute_grinder.msg import GrinderState

import grinder_client as gc


class TestDrivePlugin(unittest.TestCase):
    started = 0

    def setUp(self):
        self.folder = gc.temp_folder(self.addCleanup)

    def start(self, library, plugin, **hardware):
        environment = gc.plugin_package(self.folder, 'flute_grinder', library, plugin, 'grinder::Drive')
        parameters = gc.machine()
        parameters['hardware'] = dict(hardware, type='tested/Plugin')
        TestDrivePlugin.started += 1
        node = gc.NodeProcess('doubtful%d' % self.started, parameters, environment=environment)
        self.addCleanup(node.close)
        return node

    def refusal(self, *plugin, **hardware):
        """What the node says of a plugin, and ends."""
        node = self.start(*plugin, **hardware)
        self.assertEqual(node.end(), 1, node.output)
        return node.output

    def test_other_version(self):
        text = self.refusal('drive_of_other_version', 'RefusedDrive')
        pattern = (r'parameter /doubtful\d+/hardware/type = tested/Plugin was built against version (\d+) of the drive interface; '
                   r'allowed: version (\d+)\. Build it again: \S+/libflute_grinder_drive_of_other_version\.so')
        self.assertRegex(text, pattern)
        built, allowed = re.search(pattern, text).groups()
        self.assertEqual(int(built), int(allowed) + 41)

    def test_no_version(self):
        """Though the libraries that it is linked with, and the node itself, may have one."""
        self.assertRegex(self.refusal('drive_of_no_version', 'RefusedDrive'),
                         r'parameter /doubtful\d+/hardware/type = tested/Plugin states no version of the drive interface; '
                         r'allowed: version \d+\. Build it again: \S+/libflute_grinder_drive_of_no_version\.so')

    def awkward(self, how):
        return self.start('awkward_drive', 'AwkwardDrive', awkward=how)

    def test_period(self):
        """One that the drive cannot hold."""
        self.assertRegex(self.refusal('awkward_drive', 'AwkwardDrive', awkward='slow bus'),
                         r'parameter /doubtful\d+/control_rate = 1000; allowed: up to 500, which the drive tested/Plugin can hold')

        self.assertRegex(self.refusal('awkward_drive', 'AwkwardDrive', awkward='slightly slow bus'),
                         r'control_rate = 1000; allowed: up to 999\.9999\d*, which the drive')

    def test_period_that_is_no_figure(self):
        for how, figure in ('no figure', 'nan'), ('negative', '-0.001'):
            self.assertRegex(self.refusal('awkward_drive', 'AwkwardDrive', awkward=how),
                             r'the drive tested/Plugin states a shortest_period of %s s; allowed: 0 or more' % figure)

    def test_exception_without_a_text(self):
        self.assertIn('the drive tested/Plugin: no text',
                      self.refusal('awkward_drive', 'AwkwardDrive', awkward='throws no text in init'))

    def test_buffer(self):
        self.assertIn('the drive tested/Plugin buffers 5000 commands; allowed: up to 4095',
                      self.refusal('awkward_drive', 'AwkwardDrive', awkward='long buffer'))

    def test_callbacks_during_init(self):
        """One that waits for a message in init() gets it."""
        node = self.awkward('waits')
        gc.publisher(self.addCleanup, '/%s/hardware/go' % node.name, Empty).publish()
        grinder = node.client()
        self.addCleanup(grinder.close)
        grinder.wait_state(GrinderState.DISABLED)
        self.assertEqual(node.end(signal.SIGTERM), 0, node.output)

    def test_signal_during_init(self):
        """It ends a drive that waits for ever, and leaves nothing at the master."""
        for with_signal in signal.SIGINT, signal.SIGTERM:
            node = self.awkward('waits')
            with contextlib.ExitStack() as stack:
                gc.publisher(stack.callback, '/%s/hardware/go' % node.name, Empty)
                self.assertEqual(node.end(with_signal), 0, node.output)
            self.assertIn('ended by a signal before the return of the init() of the drive tested/Plugin', node.output)
            self.assertNotIn(node.name, str(rosgraph.Master(rospy.get_name()).getSystemState()))

    def test_signal_during_prepare(self):
        """A prepare() that hangs delays the end, and does not prevent it."""
        node = self.awkward('hangs in prepare')
        grinder = node.client()
        self.addCleanup(grinder.close)
        grinder.wait_state(GrinderState.DISABLED)
        self.assertIn('the drive has not become ready in time',
                      rospy.ServiceProxy('/%s/enable' % node.name, Trigger)().message)
        self.assertEqual(node.end(signal.SIGTERM), 1, node.output)
        self.assertIn("the process ends without the return of the drive's prepare()", node.output)

    def test_signal_during_a_call(self):
        """Of what is called outside the control loop."""
        for function, shown in ('constructor', 'constructor'), ('capabilities', 'capabilities()'):
            with self.subTest(function=function):
                node = self.awkward('hangs in ' + function)
                gc.poll(lambda: 'hangs now' in node.output, 'the call')
                self.assertEqual(node.end(signal.SIGTERM), 0, node.output)
                self.assertIn('ended by a signal before the return of the %s of the drive tested/Plugin' % shown, node.output)

    def test_destructor_that_hangs(self):
        """After a signal, and after an error, which is said first."""
        end = 'the process ends without the return of the destructor of the drive tested/Plugin'
        node = self.awkward('hangs in destructor')
        grinder = node.client()
        self.addCleanup(grinder.close)
        grinder.wait_state(GrinderState.DISABLED)
        self.assertEqual(node.end(signal.SIGTERM), 1, node.output)
        self.assertIn(end, node.output)
        self.assertRegex(self.refusal('awkward_drive', 'AwkwardDrive', awkward='throws in init, hangs in destructor'),
                         '(?s)init.. has thrown .*' + end)

    def test_exceptions_of_other_types(self):
        for function, shown in ('constructor', 'constructor'), ('init', 'init()'), ('capabilities', 'capabilities()'):
            self.assertIn('the drive tested/Plugin: its %s has thrown what is no std::exception' % shown,
                          self.refusal('awkward_drive', 'AwkwardDrive', awkward='throws in ' + function))

    def test_power_off_that_hangs(self):
        """It hides neither that the drive hangs, nor the end."""
        node = self.awkward('hangs in read, hangs in powerOff')
        grinder = node.client()
        self.addCleanup(grinder.close)
        state = grinder.wait_state(GrinderState.FAULT)
        self.assertIn('it does not return to the control loop; its powerOff() has not returned either', state.fault)
        self.assertEqual(node.end(signal.SIGTERM), 1, node.output)
        self.assertIn("the process ends without the return of the drive's powerOff()", node.output)
