#!/usr/bin/env python3
"""Shows that `grind simulate` reports the figures of the cutter that a job grinds, as text, JSON, CSV, STL and SVG."""

import math
import os
import pathlib
import re
import sys
import xml.etree.ElementTree as xml

import rostest
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from grind_command import PAPER_JOB, CommandLine  # noqa: E402
from grinder_client import DEG  # noqa: E402


class TestSimulate(CommandLine):
    def job(self, cutter=(), process=(), wheel=()):
        """Writes the paper's job for any tool, with other values."""
        job = yaml.safe_load(pathlib.Path(PAPER_JOB).read_text())
        job['cutter'].update(dict(gc.ANY_TOOL, rake_tolerance_deg=0.5), **dict(cutter))
        job['process'].update(process)
        job['process']['wheel'].update(wheel)
        return self.write('job.yaml', yaml.safe_dump(job))

    def test_json_csv_and_stl(self):
        reported, reasons = self.json(0, 'simulate', gc.package_file('jobs/left_hand_d8_t3.yaml'), '--at', '1,17.25', '--csv',
                                      self.path('tool.csv'), '--stl', self.path('tool.stl'))
        self.assertEqual((reasons, reported['valid'], reported['reasons'], reported['strokes']), ('', True, [], None))
        self.assertEqual((reported['teeth'], reported['complete_from_mm']), (3, 0))
        self.assertIsNone(reported['end_view'])
        self.assertEqual([section['x_mm'] for section in reported['sections']], [1, 17.25])
        rows = iter(self.csv(self.path('tool.csv')))
        for section in reported['sections']:
            radius = section['diameter_mm'] / 2
            outline = section['outline_mm']
            area = abs(sum(x * v - u * y for (x, y), (u, v) in zip(outline, outline[1:] + outline[:1]))) / 2
            self.assertAlmostEqual(section['area_removed_mm2'], math.pi * radius ** 2 - area, delta=1e-4 * area)
            self.assertAlmostEqual(section['core_diameter_mm'] / 2,
                                   radius - max(tooth['depth_mm'] for tooth in section['teeth']), delta=1e-9)
            self.assertEqual([tooth['tooth'] for tooth in section['teeth']], [0, 1, 2])
            for tooth in section['teeth']:
                for key in ('edge_deg', 'chordal_rake_deg'):
                    self.assertIsInstance(tooth[key], float, key)
                for name in ('flute', 'land'):
                    self.assertAlmostEqual(tooth[name + '_mm'], tooth[name + '_deg'] * DEG * radius, delta=1e-9)
                self.assertAlmostEqual(math.tan(tooth['normal_rake_deg'] * DEG),
                                       math.tan(tooth['rake_deg'] * DEG) * math.cos(tooth['spiral_deg'] * DEG), delta=1e-9)
                for key, text in next(rows).items():
                    self.assertEqual(float(text), {**section, **tooth}[key], key)
        self.assertIsNone(next(rows, None))
        self.assertGreater(os.path.getsize(self.path('tool.stl')), 1000)

    def test_text_has_the_extremes_and_where_they_are(self):
        reported, _ = self.json(0, 'simulate', PAPER_JOB)
        printed = self.grind(0, 'simulate', PAPER_JOB).stdout
        rakes = [(section['teeth'][0]['rake_deg'], section['x_mm']) for section in reported['sections']]
        least, largest = min(rakes), max(rakes)
        line = 'rake, deg %.3f %.3f 1 %.3f %.3f 1 8.000 %+.3f to %+.3f' % (
            *least, *largest, least[0] - 8, largest[0] - 8)
        lines = re.sub(' +', ' ', printed).split('\n')
        for words in (line, ' min at X mm tooth max at X mm tooth asked difference', ' X mm tooth rake deg chordal deg normal deg core mm '
                      'depth mm flute deg flute mm land deg land mm spiral deg area mm^2'):
            self.assertIn(words, lines)
        self.assertEqual(len(reported['sections']), 9)
        for section in reported['sections']:
            self.assertAlmostEqual(section['diameter_mm'] / 2, 5 + section['x_mm'] * math.tan(5 * DEG), delta=1e-9)
            self.assertRegex(printed, r'(?m)^ +%.3f +1 +%.3f ' % (section['x_mm'], section['teeth'][0]['rake_deg']))
        self.assertRegex(printed, r'(?m)^volume removed +%.3f mm\^3' % reported['volume_mm3'])

    def test_lands_that_are_gone_and_flutes_that_are_not_complete_are_null(self):
        reported, reasons = self.json(1, 'simulate', self.job(cutter={'teeth': 12}), '--at', '10')
        self.assertRegex(reasons, 'land')
        section, = reported['sections']
        self.assertEqual({(tooth['land_deg'], tooth['land_mm']) for tooth in section['teeth']}, {(None, None)})
        reported, reasons = self.json(1, 'simulate', self.job(process={'overtravel_mm': [1, 0]}), '--at', '10,30', '--csv',
                                      self.path('tool.csv'))
        self.assertRegex(reasons, 'complete')
        self.assertEqual(reported['reasons'], reasons.rstrip('\n').split('\n'))
        self.assertLess(reported['complete_to_mm'], 30)
        whole, short = (section['teeth'][0] for section in reported['sections'])
        self.assertIsNotNone(whole['rake_deg'])
        self.assertEqual((short['complete'], short['rake_deg'], short['normal_rake_deg']), (False, None, None))
        self.assertEqual(self.csv(self.path('tool.csv'))[1]['rake_deg'], '')

    def test_view_of_the_end(self):
        job = gc.package_file('jobs/left_hand_end_mill_d8_t3.yaml')
        reported, _ = self.json(0, 'simulate', job, '--operation', 'chamfer', '--at', '1', '--svg', self.path('end.svg'))
        view, section = reported['end_view'], reported['sections'][0]
        # matplotlib writes each text as a comment beside its outlines.
        text = pathlib.Path(self.path('end.svg')).read_text()
        self.assertEqual(xml.fromstring(text).tag, '{http://www.w3.org/2000/svg}svg')
        for line in ('X = 1.000 mm', 'rake %.3f deg, asked 6.000' % section['teeth'][0]['rake_deg'],
                     'core Ø %.3f mm, asked 5.000' % section['core_diameter_mm']):
            self.assertTrue(line in text, line)
        self.assertEqual(({region['face'] for region in view['regions']}, len(view['edges'])), ({'gash', 'primary', 'secondary', 'chamfer'}, 3))
        self.assertLess(len(text), 3e5)
        shown = {name for name in ('gash', 'primary flank', 'secondary flank', 'chamfer', 'blank', 'cutting edge', 'uncut Ø 0.4')
                 if '>%s<' % name in text}
        self.assertEqual(shown, {'gash', 'primary flank', 'secondary flank', 'chamfer', 'cutting edge', 'uncut Ø 0.4'})
        self.assertNotIn('short edges', text)
        drill = gc.package_file('jobs/slot_drill_d8_t2.yaml')
        view = self.json(0, 'simulate', drill, '--operation', 'end_primary', '--at', '1', '--svg', self.path('end.svg'))[0]['end_view']
        self.assertEqual((view['uncut_diameter_mm'], view['short_from_mm'], len(view['edges'])), (0.15, 1.2, 2))
        text = pathlib.Path(self.path('end.svg')).read_text()
        self.assertTrue('>uncut Ø 0.15<' in text and '>short from Ø 2.4<' in text)

    def test_what_is_refused(self):
        for at in ('-1', '1,1000', 'nan'):
            self.assertRegex(self.grind(2, 'simulate', PAPER_JOB, '--at', at).stderr,
                             r'^--at %s mm is not on the cutter; allowed: 0 to 87 mm' % at.split(',')[-1])
        self.assertRegex(self.grind(2, 'simulate', PAPER_JOB, '--svg', self.path('no/tool.svg')).stderr, 'no/tool.svg: cannot be written')
        for wrong in (self.job(wheel={'corner_radius_mm': [2, 2]}), self.path('nothing.yaml'), self.folder):
            self.grind(2, 'simulate', wrong)


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'simulate', '__main__')
