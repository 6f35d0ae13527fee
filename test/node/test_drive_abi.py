#!/usr/bin/env python3
"""Shows that the node refuses a drive plugin of another version of the drive interface, before it makes the drive."""

import os
import re
import shutil
import tempfile
import unittest

import rospy
import rostest

import grinder_client as gc

PACKAGE = """<package format="2">
  <name>refused</name>
  <version>0.1.0</version>
  <description>Drives that are refused.</description>
  <maintainer email="me@example.org">Me</maintainer>
  <license>BSD-3-Clause</license>
  <depend>flute_grinder</depend>
  <export>
    <flute_grinder plugin="${prefix}/plugins.xml"/>
  </export>
</package>
"""
PLUGINS = """<library path="lib/libflute_grinder_drive_of_%s_version">
  <class name="refused/Drive" type="RefusedDrive" base_class_type="grinder::RobotHW">
    <description>A drive.</description>
  </class>
</library>
"""


class TestDriveAbi(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def refusal(self, version):
        """What the node says of a plugin, and ends."""
        for name, text in (('package.xml', PACKAGE), ('plugins.xml', PLUGINS % version)):
            with open(os.path.join(self.folder, name), 'w') as file:
                file.write(text)
        parameters = gc.machine()
        parameters['hardware']['type'] = 'refused/Drive'
        node = gc.NodeProcess('doubtful', parameters, environment={
            'ROS_PACKAGE_PATH': self.folder + ':' + os.environ['ROS_PACKAGE_PATH']})
        self.addCleanup(node.close)
        self.assertEqual(node.end(), 1, node.output)
        return node.output

    def test_other_version(self):
        text = self.refusal('other')
        pattern = (r'parameter /doubtful/hardware/type = refused/Drive was built against version (\d+) of the drive interface; '
                   r'allowed: version (\d+)\. Build it again: \S+/libflute_grinder_drive_of_other_version\.so')
        self.assertRegex(text, pattern)
        built, allowed = re.search(pattern, text).groups()
        self.assertEqual(int(built), int(allowed) + 41)

    def test_no_version(self):
        """Though the libraries that it is linked with, and the node itself, may have one."""
        self.assertRegex(self.refusal('no'), r'parameter /doubtful/hardware/type = refused/Drive states no version of the drive '
                         r'interface; allowed: version \d+\. Build it again: \S+/libflute_grinder_drive_of_no_version\.so')


if __name__ == '__main__':
    rospy.init_node('test_drive_abi')
    rostest.rosrun('flute_grinder', 'drive_abi', '__main__')
