"""Shows what the node does with drive plugins from a package of their own: those of another version of the drive interface it
refuses before it makes the drive, those that cannot do what the machine needs before they get power, and it waits for slow ones."""

import re
import signal
import unittest

import rosgraph
import rospy
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc


DESTRUCTOR = 'the process ends without the return of the destructor of the drive tested/Plugin'


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

    def awkward(self, how):
        return self.start('awkward_drive', 'AwkwardDrive', awkward=how)

    def refusal(self, node):
        """What the node says of a plugin, and ends."""
        self.assertEqual(node.end(), 1, node.output)
        return node.output

    def test_other_version_and_none(self):
        """Though the libraries that it is linked with, and the node itself, may have one."""
        said = r'parameter /doubtful\d+/hardware/type = tested/Plugin %s; allowed: version (\d+)\. Build it again: \S+/libflute_grinder_drive_of_%s\.so'
        pattern = said % (r'was built against version (\d+) of the drive interface', 'other_version')
        text = self.refusal(self.start('drive_of_other_version', 'RefusedDrive'))
        self.assertRegex(text, pattern)
        built, allowed = re.search(pattern, text).groups()
        self.assertEqual(int(built), int(allowed) + 41)
        self.assertRegex(self.refusal(self.start('drive_of_no_version', 'RefusedDrive')),
                         said % ('states no version of the drive interface', 'no_version'))

    def test_what_it_cannot_do_and_exceptions_are_refused(self):
        for how, said in (('slow bus', r'parameter /doubtful\d+/control_rate = 1000; allowed: up to 500, which the drive tested/Plugin can hold'),
                          ('no figure', r'the drive tested/Plugin states a shortest_period of nan s; allowed: 0 or more'),
                          ('long buffer', 'the drive tested/Plugin buffers 5000 commands; allowed: up to 4095'),
                          ('throws no text in init', 'the drive tested/Plugin: no text'),
                          ('throws in constructor', 'the drive tested/Plugin: its constructor has thrown what is no std::exception'),
                          ('throws in init, hangs in destructor', r'(?s)its init\(\) has thrown what is no std::exception.*' + DESTRUCTOR),
                          ('throws in capabilities', r'the drive tested/Plugin: its capabilities\(\) has thrown what is no std::exception')):
            with self.subTest(how):
                self.assertRegex(self.refusal(self.awkward(how)), said)

    def test_callbacks_during_init(self):
        """One that waits for a message in init() gets it."""
        node = self.awkward('waits')
        gc.publisher(self.addCleanup, '/%s/hardware/go' % node.name, Empty).publish()
        grinder = node.client()
        self.addCleanup(grinder.close)
        grinder.wait_state(GrinderState.DISABLED)
        self.assertEqual(node.end(signal.SIGTERM), 0, node.output)

    def test_signal_during_a_call_outside_the_loop(self):
        """It ends a drive that waits for ever, and leaves nothing at the master."""
        for how, function, with_signal in (('init', 'init()', signal.SIGINT), ('constructor', 'constructor', signal.SIGTERM),
                                           ('capabilities', 'capabilities()', signal.SIGTERM)):
            with self.subTest(function=function):
                node = self.awkward('hangs in ' + how)
                gc.poll(lambda: 'hangs now' in node.output, 'the call')
                self.assertEqual(node.end(with_signal), 0, node.output)
                self.assertIn('ended by a signal before the return of the %s of the drive tested/Plugin' % function, node.output)
                self.assertNotIn(node.name, str(rosgraph.Master(rospy.get_name()).getSystemState()))

    def running(self, how, state=GrinderState.DISABLED):
        node = self.awkward(how)
        grinder = node.client()
        self.addCleanup(grinder.close)
        grinder.wait_state(state)
        return node, grinder

    def test_what_hangs_delays_the_end_and_does_not_prevent_it(self):
        node, _ = self.running('hangs in prepare')
        self.assertIn('the drive has not become ready in time',
                      rospy.ServiceProxy('/%s/enable' % node.name, Trigger)().message)
        self.check_end(node, "the process ends without the return of the drive's prepare()")
        node, grinder = self.running('hangs in read, hangs in powerOff', GrinderState.FAULT)
        self.assertIn('it does not return to the control loop; its powerOff() has not returned either', grinder.states[-1].fault)
        refused = grinder.send(gc.SHORT).wait()
        self.assertEqual((refused.status, refused.code, refused.text),
                         ('REJECTED', GrindResult.NOT_READY, 'the control loop does not answer'))
        self.check_end(node, "the process ends without the return of the drive's powerOff()")
        self.check_end(self.running('hangs in destructor')[0], DESTRUCTOR)

    def check_end(self, node, said):
        self.assertEqual(node.end(signal.SIGTERM), 1, node.output)
        self.assertIn(said, node.output)
