#!/usr/bin/env python3
"""Shows that a tool whose operations are in one bag is measured as they ground it together. The bag is made of the setpoints that
`grind plan --csv` lists, as if a drive had followed them with the errors that a test gives it."""

import csv
import json
import math
import os
import pathlib
import sys
import tempfile
import unittest

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from bag_files import Bag  # noqa: E402

PERIOD = 0.005  # of the machine, so that a bag is short
OPERATIONS = ('flute', 'primary', 'secondary')


class TestToolOfBag(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.job = os.path.join(cls.folder, 'reamer.yaml')
        with open(gc.package_file('jobs/taper_reamer_d6_t6.yaml'), encoding='utf-8') as file:
            text = file.read().replace('../wheels', gc.package_file('wheels')).replace('file: taper', 'file: ' + gc.package_file('jobs/taper'))
        # In two passes, and fast.
        for slow, fast in (('feed_mm_min: 700', 'feed_mm_min: 2000'), ('feed_mm_min: 300', 'feed_mm_min: 1000'),
                           (' infeed_mm: 0.05', ' infeed_mm: 2'), (' infeed_mm: 0.4', ' infeed_mm: 2')):
            assert slow in text
            text = text.replace(slow, fast)
        with open(cls.job, 'w', encoding='utf-8') as file:
            file.write(text)
        cls.machine = gc.machine_file(os.path.join(cls.folder, 'machine.yaml'), control_rate=1 / PERIOD)
        cls.rows = {}
        for operation in OPERATIONS:
            path = os.path.join(cls.folder, operation + '.csv')
            planned = gc.grind('plan', cls.job, '--operation', operation, '--machine', cls.machine, '--csv', path)
            assert planned.returncode == 0, planned.stderr
            with open(path, encoding='utf-8') as file:
                cls.rows[operation] = list(csv.DictReader(file))

    def bag(self, *runs):
        """@param runs of (operation, arguments of Bag.add())."""
        path = os.path.join(self.folder, self.id() + '.bag')
        bag = Bag(path, PERIOD)
        for operation, arguments in runs:
            bag.add(self.job, operation, arguments.pop('rows', self.rows[operation]), **arguments)
        bag.close()
        return path

    def report(self, path, *arguments):
        printed = gc.grind('report', path, '--json', *arguments)
        self.assertEqual(printed.returncode, 0, printed.stderr)
        return json.loads(printed.stdout)

    def simulate(self, path, *arguments):
        """The tool, in the middle of its flute."""
        return json.loads(gc.grind('simulate', path, '--at', '8', '--json', *arguments).stdout)

    def radius_taken(self, tool):
        """Of the edges, in the middle of the flute [mm]."""
        section = tool['sections'][len(tool['sections']) // 2]
        return [(tooth['asked_edge_diameter_mm'] - tooth['edge_diameter_mm']) / 2 for tooth in section['teeth']]

    def test_whole_tool_passes(self):
        page = os.path.join(self.folder, 'tool.html')
        data = self.report(self.bag(*((operation, {}) for operation in OPERATIONS)), '-o', page)
        self.assertEqual((data['verdict'], data['verdict_because']), ('passed', []))
        self.assertIn('job 3 of 3, what is ahead of it by job 1, 2', data['tool']['source'])
        with open(page, encoding='utf-8') as file:
            printed = file.read()
        for text in (data['tool']['source'], '<figure id="section-1"', '<figure id="rake"', '10 ± 0.5 deg, 0.3 mm wide, then 22 deg'):
            self.assertIn(text, printed)
        off = {criterion['name']: criterion['measured'] - criterion['asked'] for criterion in data['criteria']}
        self.assertAlmostEqual(off['clearance'], 0, delta=0.02)
        self.assertAlmostEqual(off['primary relief'], 0, delta=0.005)
        self.assertAlmostEqual(off['edge diameter'], 0, delta=0.002)

    def test_relief_is_on_the_edge_as_ground(self):
        """A flute that is turned lets the relief take its edge: as a plane of the clearance does, over so short a way."""
        ahead = 2e-3
        tool = self.simulate(self.bag(('flute', {'ahead': ahead}), ('primary', {}), ('secondary', {})))
        radius = (6 / 2 + 8 * math.tan(math.radians(2)))
        for taken in self.radius_taken(tool):
            self.assertAlmostEqual(taken, radius * ahead * math.tan(math.radians(10)), delta=0.1e-3)
        self.assertFalse(tool['on_planned'])

    def test_without_its_flutes_they_are_planned_and_not_judged(self):
        data = self.report(self.bag(('flute', {'ahead': 2e-3, 'rake_angle': 0.1}), ('primary', {})))
        self.assertTrue(data['tool']['on_planned'])
        self.assertIn('what is ahead of it as planned', data['tool']['source'])
        self.assertEqual(data['verdict'], 'incomplete')
        self.assertIn('rake: not measured', data['verdict_because'])
        for taken in self.radius_taken(data['tool']):
            self.assertAlmostEqual(taken, 0, delta=0.5e-3)

    def test_texts_are_escaped(self):
        data = self.report(self.bag(('flute', {'text': 'a\x1b[2J'})))
        self.assertEqual((data['job']['name'], data['reason']), ('a\\x1b[2J',) * 2)

    def test_teeth_that_are_not_in_the_bag_are_reported(self):
        data = self.report(self.bag(('flute', {'rows': [row for row in self.rows['flute'] if int(row['tooth']) < 2]})))
        self.assertIn('not all of its teeth were ground in this job', ' '.join(data['left_out']))

    def test_of_several_tools_the_last_begun_counts_with_what_continued_it(self):
        flutes = self.rows['flute']
        cut = next(i for i, row in enumerate(flutes) if row['tooth'] == '3')
        path = self.bag(('flute', {'ahead': 2e-3}), ('primary', {}), ('flute', {'rows': flutes[:cut]}),
                        ('flute', {'rows': flutes[cut:], 'first': (3, 0)}), ('primary', {}))
        tool = self.simulate(path)
        self.assertIn('job 5 of 5, what is ahead of it by job 3, 4', tool['source'])
        for taken in self.radius_taken(tool):
            self.assertAlmostEqual(taken, 0, delta=0.5e-3)
        self.assertIn('job 2 of 5, what is ahead of it by job 1', self.simulate(path, '--run', '2')['source'])


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'test_tool_of_bag', '__main__')
