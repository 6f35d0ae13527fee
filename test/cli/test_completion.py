#!/usr/bin/env python3
"""Shows what the tab key offers in bash once `grind completion bash` is sourced, for grind and for rosrun."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402

ROSBASH = '/usr/share/bash-completion/completions/rosbash'
# Completes the command line given as arguments, of which the last word is begun.
ASK = '''
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
function=$(complete -p "$1" | sed 's/.*-F \\([^ ]*\\).*/\\1/')
$function "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD-1]}"
[ ${#COMPREPLY[@]} = 0 ] || printf '%s\\n' "${COMPREPLY[@]}"
'''


class TestCompletion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.script = gc.grind('completion', 'bash').stdout
        cls.folder = tempfile.mkdtemp()
        cls.ros_home = tempfile.mkdtemp()
        for folder in (cls.folder, cls.ros_home):
            cls.addClassCleanup(shutil.rmtree, folder)
        for name in ('a.yaml', 'b job.yaml', 'grinder.urdf', 'notes.txt'):
            with open(os.path.join(cls.folder, name), 'w'):
                pass
        os.mkdir(os.path.join(cls.folder, 'jobs'))
        with open(os.path.join(cls.folder, 'jobs', 'c.yaml'), 'w'):
            pass

    def offered(self, *words, before=''):
        # rosbash takes the packages from a cache in ROS_HOME, however old it is.
        environment = dict(os.environ, ROS_HOME=self.ros_home)
        done = subprocess.run(['bash', '--norc', '-c', before + self.script + ASK, 'bash', *words], cwd=self.folder,
                              env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                              timeout=gc.PATIENCE)
        self.assertEqual(done.stderr, '')
        return set(done.stdout.splitlines())

    def commands(self):
        listed = gc.grind('--help').stdout.split('Subcommands:\n')[1].split('\n\n')[0]
        return set(re.findall(r'(?m)^  ([\w-]+)', listed))

    def test_commands(self):
        self.assertGreater(len(self.commands()), 10)
        for words in (['grind'], ['rosrun', 'flute_grinder', 'grind'], ['grind', '--node', 'other'],
                      ['grind', '--node', '=', 'other']):
            self.assertEqual(self.offered(*words, ''), self.commands())
        self.assertEqual(self.offered('grind', 'h'), {'history', 'home', 'hold'})
        self.assertEqual(self.offered('rosrun', 'flute_grinder', 'grind', 'ta'), {'table'})

    def test_options_are_those_of_the_help(self):
        for command in sorted(self.commands()):
            options = set(re.findall(r'(?m)^  (?:-\w,)?(--[\w-]+)', gc.grind(command, '--help').stdout))
            self.assertIn('--help', options)
            self.assertEqual(self.offered('grind', command, '--'), options)
        self.assertEqual(self.offered('grind', '--'), {'--help', '--node', '--version'})

    def test_commands_of_a_command(self):
        wheel = ['grind', '--node', 'other', 'wheel']
        self.assertEqual(self.offered(*wheel, ''), {'show', 'measure', 'dress'})
        self.assertEqual(self.offered('rosrun', 'flute_grinder', *wheel, 'm'), {'measure'})
        for command in ('show', 'measure', 'dress'):
            options = set(re.findall(r'(?m)^  (?:-\w,)?(--[\w-]+)', gc.grind('wheel', command, '--help').stdout))
            self.assertEqual(self.offered(*wheel, command, '--'), options)
            self.assertEqual(self.offered(*wheel, command, ''), {'a.yaml', 'b job.yaml', 'jobs'})
        self.assertEqual(self.offered(*wheel, 'measure', 'a.yaml', '--diameter', ''), set())
        self.assertEqual(self.offered('grind', 'plan', 'wheel', '--'), self.offered('grind', 'plan', '--'))

    def test_files(self):
        jobs = {'a.yaml', 'b job.yaml', 'jobs'}
        for words in (['plan'], ['run'], ['run', '--dry-run'], ['table', '--step-length', '0.2'], ['plan', '--machine'],
                      ['plan', '--machine', '=']):
            self.assertEqual(self.offered('grind', *words, ''), jobs, words)
            self.assertEqual(self.offered('rosrun', 'flute_grinder', 'grind', *words, ''), jobs, words)
        self.assertEqual(self.offered('grind', 'run', 'b'), {'b job.yaml'})
        self.assertEqual(self.offered('grind', 'run', 'jobs/'), {'jobs/c.yaml'})
        self.assertEqual(self.offered('grind', 'plan', 'a.yaml', '--urdf', ''), {'grinder.urdf', 'jobs'})
        self.assertEqual(self.offered('grind', 'plan', 'a.yaml', '--csv', 'n'), {'notes.txt'})
        self.assertEqual(self.offered('grind', 'simulate', 'record.bag', '--job', ''), jobs)
        self.assertEqual(self.offered('grind', 'simulate', 'n'), {'notes.txt'})
        self.assertEqual(self.offered('grind', 'history', '--from', ''), {'jobs'})
        self.assertEqual(self.offered('grind', 'history', ''), set())

    def test_choices_and_numbers(self):
        table = ['grind', 'table', 'a.yaml']
        self.assertEqual(self.offered(*table, '--even-step', ''), {'published', 'third_order', 'exact'})
        self.assertEqual(self.offered(*table, '--even-step', '=', 'th'), {'third_order'})
        self.assertEqual(self.offered(*table, '--even-step', '='), {'published', 'third_order', 'exact'})
        self.assertEqual(self.offered(*table, '--step-length', ''), set())
        self.assertEqual(self.offered('grind', 'override', ''), set())
        self.assertEqual(self.offered('grind', 'confirm-swivel', ''), set())
        self.assertEqual(self.offered('grind', 'hold', ''), set())
        self.assertEqual(self.offered('grind', 'jog', ''), {'x', 'y', 'z', 'a'})
        self.assertEqual(self.offered('grind', 'jog', '--feed', ''), set())
        self.assertEqual(self.offered('grind', 'completion', ''), {'bash'})

    def test_rest_of_rosrun_stays(self):
        before = 'other() { COMPREPLY=("other of $2 after $3"); }\ncomplete -F other -o nospace rosrun\n'
        self.assertEqual(self.offered('rosrun', 'fl', before=before), {'other of fl after rosrun'})
        self.assertEqual(self.offered('rosrun', 'flute_grinder', 'gr', before=before),
                         {'other of gr after flute_grinder'})
        self.assertEqual(self.offered('rosrun', 'rviz', 'rviz', '', before=before), {'other of  after rviz'})
        # Sourced twice, as in a shell that is set up again.
        self.assertEqual(self.offered('rosrun', 'fl', before=before + self.script), {'other of fl after rosrun'})
        self.assertEqual(self.offered('rosrun', 'fl'), set())

    @unittest.skipUnless(os.path.exists(ROSBASH), 'no rosbash')
    def test_rosbash_completes_the_package(self):
        self.assertIn('flute_grinder', self.offered('rosrun', 'flute_gr', before='source %s\n' % ROSBASH))


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'completion', '__main__')
