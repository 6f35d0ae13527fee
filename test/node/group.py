#!/usr/bin/env python3
"""group.py NAME...: runs modules of tests, or single cases of them, one after another, with the node that the launch file has
started; for rostest, which starts the master and the node anew for each <test>. The <test>'s name is that of this program's own
node, and no test's grinder may have it."""

import pathlib
import sys

import rospy
import rostest

NAMES = [argument for argument in sys.argv[1:] if argument.startswith('test_')]
sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / 'hal'))


def load_tests(loader, _tests, _pattern):
    return loader.loadTestsFromNames(NAMES)


if __name__ == '__main__':
    rospy.init_node('tests')
    rostest.rosrun('flute_grinder', 'group', '__main__')
