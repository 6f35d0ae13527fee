#!/usr/bin/env python3
"""Shows that a journal that is damaged, or cannot be kept, is told: the grinder starts all the same."""

import os
import signal

import rospy
import rostest
from flute_grinder.msg import GrinderState, GrindResult

import grinder_client as gc
from test_journal import JournalTest, sealed

# Name, what stands in the journal.
UNREADABLE = [
    ('empty', b''),
    ('not_yaml', b'job_digest: [1, 2\nfinished: }\n'),
    ('binary', bytes(range(256))),
    ('a_word', b'finished\n'),
    ('no_checksum', b'job_digest: "0123"\nfinished: false\ntooth: 0\npass: 0\nx_m: 0\n'),
    ('a_key_missing', sealed(b'job_digest: "0123"\nfinished: false\ntooth: 0\npass: 0\n')),
    ('a_wrong_type', sealed(b'job_digest: "0123"\nfinished: perhaps\ntooth: 0\npass: 0\nx_m: 0\n')),
    ('cut_off', b'job_digest: "0123"\nfinished: fal'),
    ('endless', b' ' * (1 << 20)),
]


class TestUnreadableJournal(JournalTest):
    """It is told, and the grinder works; the methods are made of the table."""

    def check(self, content):
        with open(self.journal, 'wb') as file:
            file.write(content)
        self.start()
        self.check_trouble_is_told()
        with open(self.journal, 'rb') as file:
            self.assertEqual(file.read(), content, 'it is left as it is until the next job')
        state = self.client.fresh_state()
        self.assertIn('journal ' + self.journal, state.journal_error)
        self.assertTrue(state.journal_damaged)
        self.assertRegex(gc.grind('--node', self.client.name, 'status').stdout, r'(?m)^wheel in work +not known$')

    def test_next_job_makes_a_new_one(self):
        self.check(b'nothing of a journal')
        self.assertTrue(self.client.enable().success)
        self.client.wait_state(GrinderState.READY)
        self.assertRegex(self.client.send(self.job, discard=False).wait().text, 'its checksum is missing; .*, or discard it$')
        self.assertEqual(self.client.run(self.job).status, 'SUCCEEDED')
        self.check_told(self.wait_finished())

    def test_a_flipped_bit_is_told(self):
        self.start_ready()
        self.assertEqual(self.client.run(self.job).status, 'SUCCEEDED')
        self.wait_finished()
        self.node.end(signal.SIGTERM)
        with open(self.journal, 'rb') as file:
            content = bytearray(file.read())
        content[content.index(b'pass: 1') + len('pass: ')] ^= 1
        self.check(bytes(content))
        self.assertIn('checksum is wrong', self.node.output)


def add_journals():
    for name, content in UNREADABLE:
        setattr(TestUnreadableJournal, 'test_' + name, lambda self, content=content: self.check(content))


add_journals()


def below_a_file(folder):
    with open(os.path.join(folder, 'file'), 'w'):
        pass
    return 'file/journal'


def a_folder(folder):
    os.mkdir(os.path.join(folder, 'folder'))
    return 'folder'


def a_fifo(folder):
    os.mkfifo(os.path.join(folder, 'fifo'))
    return 'fifo'


def a_loop_of_links(folder):
    os.symlink('loop', os.path.join(folder, 'loop'))
    return 'loop'


# How a path is made that no journal can be kept at, and the reason that is told.
UNUSABLE = [
    (below_a_file, 'Not a directory'),
    (a_folder, 'is not a regular file'),
    (a_fifo, 'is not a regular file'),
    (a_loop_of_links, 'Too many levels of symbolic links'),
    (lambda folder: 256 * 'n', 'File name too long'),
]


class TestUnusableJournal(JournalTest):
    """The grinder starts, tells it, and grinds nothing; the methods are made of the table."""

    def check(self, make, reason):
        self.journal = os.path.join(self.folder, make(self.folder))
        self.start_ready()
        self.check_trouble_is_told()
        rest = self.client.wait_rest()
        run = self.client.send(self.job).wait()
        self.assertEqual((run.status, run.code), ('ABORTED', GrindResult.NOT_READY))
        self.assertIn('journal ' + self.journal, run.text)
        self.assertIn(reason, run.text)
        state = self.client.fresh_state()
        self.assertEqual((state.state_name, state.progress.job_digest), ('ready', ''))
        self.assertEqual(set(self.client.positions_over(0.2)), {tuple(rest)})
        self.assertEqual(run.setpoints, [])
        self.assertEqual(self.client.send(self.job, dry_run=True).wait().status, 'SUCCEEDED')


def add_paths():
    for make, reason in UNUSABLE:
        name = 'test_' + make.__name__.replace('<lambda>', 'a_long_name')
        setattr(TestUnusableJournal, name, lambda self, make=make, reason=reason: self.check(make, reason))


add_paths()


if __name__ == '__main__':
    rospy.init_node('test_bad_journal')
    rostest.rosrun('flute_grinder', 'bad_journal', '__main__')
