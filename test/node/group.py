#!/usr/bin/env python3
"""group.py MODULE...: runs modules of tests one after another, with the node that the launch file has started; for rostest, which
starts the master and the node anew for each <test>."""

import sys

import rospy
import rostest

MODULES = [argument for argument in sys.argv[1:] if argument.startswith('test_')]


def load_tests(loader, _tests, _pattern):
    return loader.loadTestsFromNames(MODULES)


if __name__ == '__main__':
    rospy.init_node('tests')
    rostest.rosrun('flute_grinder', 'group', '__main__')
