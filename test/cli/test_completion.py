#!/usr/bin/env python3
"""Shows what the tab key offers in bash once `grind completion bash` is sourced, for grind and for rosrun."""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402

ROSBASH = '/usr/share/bash-completion/completions/rosbash'
# Completes the command line given as arguments, of which the last word is begun.
ASK = '''
ask() {
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  local function=$(complete -p "$1" | sed 's/.*-F \\([^ ]*\\).*/\\1/')
  $function "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD-1]}"
  [ ${#COMPREPLY[@]} = 0 ] || printf '%s\\n' "${COMPREPLY[@]}"
  echo .
}
'''


class TestCompletion(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.script = gc.grind('completion', 'bash').stdout
        cls.folder, cls.ros_home = gc.temp_folder(cls.addClassCleanup), gc.temp_folder(cls.addClassCleanup)
        os.mkdir(os.path.join(cls.folder, 'jobs'))
        for name in ('a.yaml', 'b job.yaml', 'grinder.urdf', 'notes.txt', 'jobs/c.yaml'):
            pathlib.Path(cls.folder, name).touch()

    def check(self, *rows, before=''):
        """@param rows of a line, of which the last word is begun or empty, and what is offered for it; in one shell."""
        asked = '\n'.join('ask ' + ' '.join(map(shlex.quote, line.split(' '))) for line, _ in rows)
        # rosbash takes the packages from a cache in ROS_HOME, however old it is.
        done = subprocess.run(['bash', '--norc', '-c', before + self.script + ASK + asked], cwd=self.folder,
                              env=dict(os.environ, ROS_HOME=self.ros_home), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=gc.PATIENCE)
        self.assertEqual(done.stderr, '')
        offered = [set(text.splitlines()) for text in re.split(r'(?m)^\.\n', done.stdout)[:-1]]
        self.assertEqual(list(zip((line for line, _ in rows), offered)), list(rows))

    def options(self, *command):
        return set(re.findall(r'(?m)^  (?:-\w,)?(--[\w-]+)', gc.grind(*command, '--help').stdout))

    def test_commands_and_options_are_those_of_the_help(self):
        listed = gc.grind('--help').stdout.split('Subcommands:\n')[1].split('\n\n')[0]
        commands = set(re.findall(r'(?m)^  ([\w-]+)', listed))
        self.assertGreater(len(commands), 10)
        options = {command: self.options(command) for command in commands}
        self.assertTrue(all('--help' in names for names in options.values()))
        self.check(*((line, commands) for line in ('grind ', 'rosrun flute_grinder grind ', 'grind --node other ', 'grind --node = other ')),
                   ('grind h', {'history', 'home', 'hold'}), ('rosrun flute_grinder grind ta', {'table'}),
                   ('grind --', {'--help', '--node', '--version'}), ('grind plan wheel --', options['plan']),
                   *(('grind %s --' % command, names) for command, names in options.items()))

    def test_commands_of_a_command(self):
        wheel = 'grind --node other wheel '
        self.check((wheel, {'show', 'measure', 'dress'}), ('rosrun flute_grinder %sm' % wheel, {'measure'}),
                   *((wheel + command + ' --', self.options('wheel', command)) for command in ('show', 'measure', 'dress')),
                   *((wheel + command + ' ', {'a.yaml', 'b job.yaml', 'jobs'}) for command in ('show', 'measure', 'dress')),
                   (wheel + 'measure a.yaml --diameter ', set()))

    def test_files_choices_and_numbers(self):
        jobs, rules = {'a.yaml', 'b job.yaml', 'jobs'}, {'published', 'third_order', 'exact'}
        self.check(*((line + words + ' ', jobs) for line in ('grind ', 'rosrun flute_grinder grind ') for words in (
                       'plan', 'run', 'run --dry-run', 'table --step-length 0.2', 'plan --machine', 'plan --machine =')),
                   ('grind run b', {'b job.yaml'}), ('grind run jobs/', {'jobs/c.yaml'}),
                   ('grind plan a.yaml --urdf ', {'grinder.urdf', 'jobs'}), ('grind plan a.yaml --csv n', {'notes.txt'}),
                   ('grind simulate record.bag --job ', jobs), ('grind simulate n', {'notes.txt'}),
                   ('grind history --from ', {'jobs'}), ('grind table a.yaml --even-step ', rules),
                   ('grind table a.yaml --even-step = th', {'third_order'}), ('grind table a.yaml --even-step =', rules),
                   ('grind jog ', {'x', 'y', 'z', 'a'}), ('grind completion ', {'bash'}),
                   *(('grind %s ' % words, set()) for words in ('history', 'table a.yaml --step-length', 'override', 'confirm-swivel',
                                                               'hold', 'jog --feed')))

    def test_rest_of_rosrun_stays(self):
        before = 'other() { COMPREPLY=("other of $2 after $3"); }\ncomplete -F other -o nospace rosrun\n'
        rows = (('rosrun fl', {'other of fl after rosrun'}), ('rosrun flute_grinder gr', {'other of gr after flute_grinder'}),
                ('rosrun rviz rviz ', {'other of  after rviz'}))
        self.check(*rows, before=before)
        # Sourced twice, as in a shell that is set up again.
        self.check(*rows, before=before + self.script)
        self.check(('rosrun fl', set()))

    @unittest.skipUnless(os.path.exists(ROSBASH), 'no rosbash')
    def test_rosbash_completes_the_package(self):
        self.check(('rosrun flute_gr', {'flute_grinder'}), before='source %s\n' % ROSBASH)


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'completion', '__main__')
