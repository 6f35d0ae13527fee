#!/usr/bin/env python3
"""Shows what bench/figures.py makes of samples and of runs: medians, p99, ratios against floors, tables, and the comparison of
two runs. Nothing is measured here."""

import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'bench'))
import figures  # noqa: E402

BEGIN, END = (mark % 'scripts/bench' for mark in figures.MARKS)

RUN = {
    'commit': 'abc1234', 'date': '2020-01-02 03:04 UTC', 'cpu': 'Some CPU', 'cores': 4, 'kernel': '6.1', 'realtime': True,
    'figures': {
        'wake_up': {'label': 'wake-up', 'unit': 'us', 'median': 50.0, 'p99': 80.0, 'count': 1000},
        'motion': {'label': 'goal to motion', 'unit': 'ms', 'median': 2.0, 'p99': 3.25, 'count': 100, 'floor': 'wake_up'},
        'memory': {'label': 'memory', 'unit': 'MB', 'median': 159.0},
    },
}


def cells(line):
    return re.split(r'  +', line.strip())


class FiguresTest(unittest.TestCase):
    def test_median_and_p99_of_times_are_in_the_unit_asked_for(self):
        figure = figures.of_times('x', 'us', [i * 1e-6 for i in range(100, 0, -1)])
        self.assertAlmostEqual(figure['median'], 50.5)
        self.assertAlmostEqual(figure['p99'], 99)
        self.assertEqual((figure['count'], figure['unit']), (100, 'us'))
        # It leaves out no more than a hundredth.
        for values, p99 in ((range(1000), 989), (range(101), 99), ([3, 1, 2], 3), ([7], 7)):
            with self.subTest(values):
                self.assertEqual(figures.of_times('x', 's', values)['p99'], p99)

    def test_times_that_the_node_reports(self):
        values = {'State': ['ready', 'running'], 'Longest cycle duration [s]': ['1', '1', '1'], 'Mean period [s]': ['0.001'],
                  '99 % cycle duration [s]': ['9e-06', '7e-06', '8e-06'], 'Median cycle duration [s]': ['2e-06', '3e-06', '4e-06'],
                  'Median wake-up delay [s]': ['5e-05']}
        found = figures.of_diagnostics(values, {'wake-up delay': 'wake_up'})
        self.assertEqual(set(found), {'loop/cycle duration', 'loop/wake-up delay'})
        cycle, delay = found['loop/cycle duration'], found['loop/wake-up delay']
        self.assertAlmostEqual(cycle['median'], 3)
        self.assertAlmostEqual(cycle['p99'], 8)
        self.assertEqual((cycle['unit'], cycle['count']), ('us', 3))
        self.assertNotIn('floor', cycle)
        self.assertAlmostEqual(delay['median'], 50)
        self.assertNotIn('p99', delay)
        self.assertEqual(delay['floor'], 'wake_up')
        self.assertEqual(figures.of_diagnostics({}, {}), {})

    def test_there_is_no_ratio_to_a_floor_that_was_not_measured(self):
        self.assertIsNone(figures.ratio({'a': {'unit': 'ms', 'median': 1, 'floor': 'not measured'}}, 'a'))

    def test_numbers_have_three_digits(self):
        shown = {0: '0', 0.0123456: '0.0123', 1.23456: '1.23', 12.3456: '12.3', 123.456: '123', 1234.56: '1235', 7.735e-8: '7.74e-08',
                 None: '-'}
        self.assertEqual({value: figures.number(value) for value in shown}, shown)

    def test_table_of_a_run(self):
        lines = figures.text(RUN).splitlines()
        self.assertEqual(lines[0], 'abc1234 of 2020-01-02 03:04 UTC, Some CPU, 4 cores, 6.1, real-time scheduling')
        self.assertEqual([cells(line) for line in lines[2:]], [
            ['unit', 'median', 'p99', 'samples', 'floor', 'ratio'],
            ['wake-up', 'us', '50.0', '80.0', '1000', '-', '-'],
            ['goal to motion', 'ms', '2.00', '3.25', '100', 'wake-up', '40.0'],
            ['memory', 'MB', '159', '-', '-', '-', '-'],
        ])

    def test_table_of_two_runs(self):
        before = dict(RUN, commit='0000000', figures={
            'motion': dict(RUN['figures']['motion'], median=8.0, p99=13.0),
            'memory': dict(RUN['figures']['memory'], unit='kB', median=159e3),
            'gone': {'label': 'what is no more', 'unit': 'ns', 'median': 5.0},
        })
        self.assertNotIn('not the same', figures.text(RUN, before))
        for what, wrong in ('cpu', 'Another'), ('realtime', False):
            self.assertIn('not the same %s: %s, then %s' % (what, wrong, RUN[what]), figures.text(RUN, dict(before, **{what: wrong})))
        lines = figures.text(RUN, before).splitlines()
        self.assertTrue(lines[0].startswith('before: 0000000 of '))
        self.assertTrue(lines[1].startswith('now:    abc1234 of '))
        self.assertEqual([cells(line) for line in lines[4:]], [
            ['wake-up', 'us', '-', '50.0', '-', '80.0', '-', '-'],
            ['goal to motion', 'ms', '8.00', '2.00', '13.0', '3.25', '0.250', '0.250'],
            ['memory', 'MB', '-', '159', '-', '-', '-', '-'],  # in another unit
            ['what is no more', 'ns', '5.00', '-', '-', '-', '-', '-'],
        ])

    def test_page_gets_the_table_between_its_marks(self):
        page = 'above\n\n%s\nold\n%s\n\nbelow\n' % (BEGIN, END)
        written = figures.with_table(page, RUN)
        self.assertTrue(written.startswith('above\n\n' + BEGIN + '\n'))
        self.assertTrue(written.endswith('\n' + END + '\n\nbelow\n'))
        self.assertNotIn('old', written)
        self.assertIn('\n| goal to motion | ms | 2.00 | 3.25 | 100 | wake-up | 40.0 |\n', written)
        self.assertEqual(figures.with_table(written, RUN), written)
        for page in '', BEGIN, END + BEGIN:
            with self.assertRaises(ValueError):
                figures.with_table(page, RUN)

    def test_documentation_has_a_table_of_all_columns(self):
        page = (ROOT / 'docs/performance.md').read_text()
        table = page.partition(BEGIN)[2].partition(END)[0]
        heads = [line for line in table.splitlines() if line.startswith('|')]
        self.assertEqual(heads[0], '| %s |' % ' | '.join(next(figures.rows(RUN))))
        self.assertGreater(len(heads), 3)


if __name__ == '__main__':
    unittest.main()
