#!/usr/bin/env python3
"""Shows what `grind history --from` lists of the records of several grinders: one table of all, filtered, as JSON and as CSV; what
cannot be read is named, and does not keep the rest from it."""

import csv
import json
import os
import pathlib
import sys

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

from grind_command import CommandLine  # noqa: E402
from record_files import head_of, text_of  # noqa: E402

NAME = '00000000{0:02}_20261122T{0:02}0000.000Z.json'


class TestShop(CommandLine):
    """Three grinders: `left` and `right` grind in turn, `old` has a broken record beside a good one."""

    def setUp(self):
        super().setUp()
        for grinder, hour, name, file, outcome in (
                ('left/grinder', 8, 'mill, "short".yaml', 'test/jobs/paper.yaml', 'done'),
                ('right/grinder', 9, 'four.yaml', 'jobs/unequal_d12_t4.yaml', 'canceled'),
                ('left/grinder', 10, 'four.yaml', 'jobs/unequal_d12_t4.yaml', 'fault'),
                ('old', 7, 'mill.yaml', 'test/jobs/paper.yaml', 'done')):
            self.keep(grinder, hour, text_of(head_of(
                file, '2026-11-22T%02d:00:00.000Z' % hour, '2026-11-22T%02d:00:01.500Z' % hour, outcome, job=name)))
        self.keep('old', 6, '{"record":2,"head":{')
        self.folders = [self.path(folder) for folder in ('left/grinder', 'right/grinder/', 'old')]

    def keep(self, grinder, hour, text):
        os.makedirs(self.path(grinder), exist_ok=True)
        self.write('%s/%s' % (grinder, NAME.format(hour)), text)

    def hours(self, status, *arguments):
        """Of the records that are listed."""
        listed, said = self.json(status, 'history', '--from', *self.folders, *arguments)
        return [int(entry['started'][11:13]) for entry in listed], said

    def test_all_are_in_one_list_by_time_and_what_is_broken_is_named(self):
        self.folders.append(self.path('none'))
        self.write('old/notes.json', 'not ours')
        hours, said = self.hours(2)
        self.assertEqual(hours, [7, 8, 9, 10])
        broken, missing = sorted(said.splitlines(), reverse=True)
        self.assertIn(self.path('old/' + NAME.format(6)) + ': is no record of a job: it is cut off', broken)
        self.assertIn(self.path('none') + ': cannot be read: No such file or directory', missing)
        lines = self.grind(2, 'history', '--from', *self.folders).stdout.splitlines()
        self.assertRegex(lines[0], '^start +grinder +job +tool +outcome')
        good, bad = '  passed as far as measured', '  FAILED: the job ended as '
        for line, grinder, verdict in zip(lines[1:], ('old', 'left/grinder', 'right/grinder', 'left/grinder'),
                                          (good, good, bad + 'canceled', bad + 'fault')):
            self.assertRegex(line, r'  %s/?  .*%s$' % (self.path(grinder), verdict))
        self.assertNotIn('grinder ', self.grind(0, 'history', '--from', self.folders[0]).stdout.splitlines()[0])

    def test_those_of_a_grinder_are_in_its_order_whatever_its_clock_was(self):
        for number, hour in ((11, 20), (12, 1), (13, 11)):  # ahead, then not set
            head = head_of('test/jobs/paper.yaml', '2026-11-22T%02d:00:00.000Z' % hour, '2026-11-22T23:00:00.000Z')
            self.write('left/grinder/00000000%d_20261122T%02d0000.000Z.json' % (number, hour), text_of(head))
        self.assertEqual(self.hours(0, '--grinder', 'left')[0], [8, 10, 20, 1, 11])
        hours, _ = self.hours(2)
        self.assertEqual(sorted(hours), [1, 7, 8, 9, 10, 11, 20])
        self.assertEqual([hour for hour in hours if hour not in (7, 9)], [8, 10, 20, 1, 11])
        self.assertEqual(self.hours(0, '--since', '2026-11-22T10:00Z')[0], [10, 20, 11])

    def test_filters(self):
        for arguments, hours in ((['--tool', 'SHORT'], [8]), (['--tool', '4 teeth'], [9, 10]), (['--tool', 'drill'], []),
                                 (['--verdict', 'failed'], [9, 10]), (['--verdict', 'passed'], []),
                                 (['--since', '2026-11-22T08:00Z', '--until', '2026-11-22T09:00:00.000Z'], [8, 9]),
                                 (['--since', '2026-11-22T08:00Z', '--until', '2026-11-22Z'], [8, 9, 10]),
                                 (['--grinder', 'left'], [8, 10]), (['--grinder', 'right', '--verdict', 'incomplete'], [])):
            with self.subTest(arguments):
                # The broken record is of 6 o'clock, in the folder of `old`.
                good = arguments[0] in ('--since', '--grinder')
                self.assertEqual(self.hours(0 if good else 2, *arguments)[0], hours)
        self.assertIn('no such records in ', self.grind(0, 'history', '--from', *self.folders, '--since', '2027-01-01').stdout)
        for arguments, said in ((['--grinder', 'middle'], '--grinder middle: no folder of --from has it in its path; allowed: of '),
                                (['--until', '2026-11-22Z', '--since', '2026-11-22T09Z'], '2026-11-22T09Z; allowed: YYYY-MM-DD'),
                                (['--since', '2026-11-23', '--until', '2026-11-22'],
                                 '--until 2026-11-22 is before --since 2026-11-23; allowed: the same or later')):
            self.assertIn(said, self.grind(2, 'history', '--from', *self.folders, *arguments).stderr)

    def test_csv_has_what_the_json_has_and_is_written_over_no_record(self):
        record = self.path('left/grinder/' + NAME.format(8))
        before = pathlib.Path(record).read_bytes()
        self.assertIn(record + ': cannot be written: the command reads it',
                      self.grind(2, 'history', '--from', self.folders[0], '--csv', record).stderr)
        self.assertEqual(pathlib.Path(record).read_bytes(), before)
        listed, _ = self.json(2, 'history', '--from', *self.folders, '--csv', self.path('list.csv'))
        with open(self.path('list.csv'), newline='') as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([list(row) for row in rows], [list(entry) for entry in listed])

        def text(value):
            return '; '.join(value) if isinstance(value, list) else value if isinstance(value, str) else json.dumps(value)

        texts = [{key: text(value) for key, value in entry.items()} for entry in listed]
        self.assertEqual([dict(row) for row in rows], texts)
        self.assertEqual([row['grinder'] for row in rows],
                         [self.path(folder) for folder in ('old', 'left/grinder', 'right/grinder', 'left/grinder')])
        self.assertEqual((rows[1]['job'], rows[1]['duration_s']), ('mill, "short".yaml', '1.5'))


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'shop', '__main__')
