#!/usr/bin/env python3
"""Shows that `grind simulate` reports the figures of the cutter that a job grinds, and those of a recorded run."""

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
from bag_files import Bag  # noqa: E402
from grind_command import PAPER_JOB, CommandLine  # noqa: E402
from grinder_client import DEG  # noqa: E402

NULLABLE = {'edge_deg', 'rake_deg', 'chordal_rake_deg', 'normal_rake_deg', 'flute_deg', 'land_deg', 'land_mm', 'spiral_deg'}


class TestSimulate(CommandLine):
    def job(self, name, case):
        """Writes the paper's job with the changes of a case."""
        with open(PAPER_JOB) as file:
            job = yaml.safe_load(file)
        if 'cutter' in case:
            job['cutter'].update(dict(gc.ANY_TOOL, rake_tolerance_deg=0.5), **case['cutter'])
        job['process'].update(case.get('process', {}))
        job['process']['wheel'].update(case.get('wheel', {}))
        return self.write(name, yaml.safe_dump(job))


class TestOutput(TestSimulate):
    def test_figures_agree(self):
        reported, _ = self.json(0, 'simulate', gc.package_file('jobs/unequal_d12_t4.yaml'))
        for section in reported['sections']:
            radius = section['diameter_mm'] / 2
            self.assertAlmostEqual(radius, 6 + section['x_mm'] * math.tan(5 * DEG), delta=1e-9)
            self.assertAlmostEqual(section['core_diameter_mm'] / 2,
                                   radius - max(tooth['depth_mm'] for tooth in section['teeth']), delta=1e-9)
            for tooth in section['teeth']:
                for name in ('flute', 'land'):
                    self.assertAlmostEqual(tooth[name + '_mm'], tooth[name + '_deg'] * DEG * radius, delta=1e-9)
                self.assertAlmostEqual(math.tan(tooth['normal_rake_deg'] * DEG),
                                       math.tan(tooth['rake_deg'] * DEG) * math.cos(tooth['spiral_deg'] * DEG), delta=1e-9)

    def test_json_has_its_keys(self):
        reported, reasons = self.json(0, 'simulate', PAPER_JOB, '--at', '1,17.25')
        self.assertEqual(reasons, '')
        self.assertEqual((reported['teeth'], reported['complete_from_mm'], reported['complete_to_mm']), (1, 0, 30))
        self.assertEqual((reported['valid'], reported['strokes']), (True, None))
        self.assertEqual([section['x_mm'] for section in reported['sections']], [1, 17.25])
        for section in reported['sections']:
            for key in ('core_diameter_mm', 'area_removed_mm2'):
                self.assertGreater(section[key], 0)
            tooth, = section['teeth']
            self.assertEqual(tooth['tooth'], 0)
            for key in NULLABLE | {'depth_mm'}:
                self.assertIsInstance(tooth[key], float, key)

    def test_csv_has_every_bit_of_the_json(self):
        reported, _ = self.json(0, 'simulate', gc.package_file('jobs/left_hand_d8_t3.yaml'), '--sections', '3', '--csv',
                            self.path('tool.csv'))
        rows = iter(self.csv(self.path('tool.csv')))
        for section in reported['sections']:
            for tooth in section['teeth']:
                row = next(rows)
                for key, text in row.items():
                    self.assertEqual(float(text), {**section, **tooth}[key], key)
        self.assertIsNone(next(rows, None))

    def test_stl_is_written(self):
        self.grind(0, 'simulate', PAPER_JOB, '--at', '3', '--stl', self.path('tool.stl'))
        self.assertGreater(os.path.getsize(self.path('tool.stl')), 1000)

    def test_text_has_the_extremes_and_where_they_are(self):
        reported, _ = self.json(0, 'simulate', PAPER_JOB)
        printed = self.grind(0, 'simulate', PAPER_JOB).stdout
        rakes = [(section['teeth'][0]['rake_deg'], section['x_mm']) for section in reported['sections']]
        least, largest = min(rakes), max(rakes)
        line = 'rake, deg %.3f %.3f 1 %.3f %.3f 1 8.000 %+.3f to %+.3f' % (
            *least, *largest, least[0] - 8, largest[0] - 8)
        self.assertIn(line, re.sub(' +', ' ', printed).split('\n'))
        self.assertEqual(len(reported['sections']), 9)
        for section in reported['sections']:
            self.assertRegex(printed, r'(?m)^ +%.3f +1 +%.3f ' % (section['x_mm'], section['teeth'][0]['rake_deg']))
        self.assertRegex(printed, r'(?m)^volume removed +%.3f mm\^3' % reported['volume_mm3'])

    def test_svg_reports_ground_and_asked(self):
        reported, _ = self.json(0, 'simulate', gc.package_file('jobs/left_hand_d8_t3.yaml'), '--svg', self.path('tool.svg'))
        self.assertEqual(xml.parse(self.path('tool.svg')).getroot().tag, '{http://www.w3.org/2000/svg}svg')
        with open(self.path('tool.svg')) as file:
            text = file.read()
        # matplotlib writes each text as a comment beside its outlines.
        for section in (reported['sections'][0], reported['sections'][4], reported['sections'][-1]):
            tooth = section['teeth'][0]
            for line in ('X = %.3f mm' % section['x_mm'], 'rake %.3f deg, asked 6.000' % tooth['rake_deg'],
                         'land %.3f mm' % tooth['land_mm'],
                         'core Ø %.3f mm, asked %.3f' % (section['core_diameter_mm'], section['asked_core_diameter_mm'])):
                self.assertIn(line, text)

    def test_svg_of_a_relief_has_its_clearance_and_width(self):
        job = gc.package_file('jobs/taper_reamer_d6_t6.yaml')
        for operation, width in (('primary', 'none, heel at none'), ('secondary', '0.300 mm, heel at 1.4')):
            self.grind(0, 'simulate', job, '--operation', operation, '--svg', self.path('tool.svg'))
            with open(self.path('tool.svg')) as file:
                text = file.read()
            self.assertRegex(text, r'clearance (9\.99|10\.00)\d deg, asked 10\.000')
            self.assertIn('primary relief ' + width, text)
            self.assertIn('clearance [deg]', text)
            self.assertNotIn('land [mm]', text)

    def test_svg_of_what_is_hardly_a_tool(self):
        self.grind(1, 'simulate', self.job('dense.yaml', {'cutter': {'teeth': 12}}), '--svg', self.path('tool.svg'))
        self.assertGreater(os.path.getsize(self.path('tool.svg')), 1000)
        self.assertRegex(self.grind(2, 'simulate', PAPER_JOB, '--svg', self.path('no/tool.svg')).stderr,
                         'no/tool.svg: cannot be written')

    def test_lands_that_are_gone_and_flutes_that_are_not_complete_are_null(self):
        case = {'cutter': {'teeth': 12}}
        reported, reasons = self.json(1, 'simulate', self.job('dense.yaml', case), '--at', '10')
        self.assertRegex(reasons, 'land')
        self.assertEqual({tooth['land_deg'] for tooth in reported['sections'][0]['teeth']}, {None})
        self.assertEqual({tooth['land_mm'] for tooth in reported['sections'][0]['teeth']}, {None})
        short = self.job('short.yaml', {'process': {'overtravel_mm': [1, 0]}})
        reported, reasons = self.json(1, 'simulate', short, '--at', '10,30', '--csv', self.path('tool.csv'))
        self.assertRegex(reasons, 'complete')
        self.assertEqual(reported['reasons'], reasons.rstrip('\n').split('\n'))
        self.assertLess(reported['complete_to_mm'], 30)
        whole, short = (section['teeth'][0] for section in reported['sections'])
        self.assertIsNotNone(whole['rake_deg'])
        self.assertEqual((short['complete'], short['rake_deg'], short['normal_rake_deg']), (False, None, None))
        self.assertEqual(self.csv(self.path('tool.csv'))[1]['rake_deg'], '')

    def test_sections_that_are_not_on_the_cutter(self):
        for at in ('-1', '1,1000', 'nan'):
            self.assertRegex(self.grind(2, 'simulate', PAPER_JOB, '--at', at).stderr,
                             r'^--at %s mm is not on the cutter; allowed: 0 to 87 mm' % at.split(',')[-1])

    def test_numbers_that_are_refused_and_files_that_cannot_be_read(self):
        self.grind(2, 'simulate', self.job('corner.yaml', {'wheel': {'corner_radius_mm': [2, 2]}}))
        self.grind(2, 'simulate', gc.job_file(self.path('bad.yaml'), cone_angle_deg=50))
        self.grind(2, 'simulate', self.path('nothing.yaml'))
        self.grind(2, 'simulate', self.folder)


class TestRecord(TestSimulate):
    """Records are made of a plan's setpoints: what the drive reads is what was commanded one cycle before."""

    def plan(self, job):
        self.grind(0, 'plan', job, '--csv', self.path('plan.csv'))
        return self.csv(self.path('plan.csv'))

    def left_hand(self):
        """A job of three teeth, in one pass, one to finish and one to spark out."""
        with open(gc.package_file('jobs/left_hand_d8_t3.yaml')) as file:
            job = yaml.safe_load(file)
        setup = {'file': gc.package_file('jobs/left_hand_d8_t3.setup.yaml')}
        job['process'].update(infeed_mm=2, feed_mm_min=1000, setup=setup)
        return self.write('left_hand.yaml', yaml.safe_dump(job))

    def record(self, rows, job=PAPER_JOB):
        """A bag; without its goal if there is no job."""
        bag = Bag(self.path('run.bag'), 1e-3)
        bag.add(job, '', rows)
        bag.close()
        return self.path('run.bag')

    def sections(self, status, path, *arguments):
        return self.json(status, 'simulate', path, '--at', '3,15,27', *arguments)[0]['sections']

    def planned(self, job=PAPER_JOB):
        return self.json(0, 'simulate', job, '--at', '3,15,27')[0]['sections']

    def check_same(self, sections, planned):
        for one, other in zip(sections, planned):
            self.assertAlmostEqual(one['core_diameter_mm'], other['core_diameter_mm'], delta=2e-5)
            for tooth, planned_tooth in zip(one['teeth'], other['teeth']):
                self.assertAlmostEqual(tooth['edge_deg'], planned_tooth['edge_deg'], delta=2e-4)
                self.assertAlmostEqual(tooth['rake_deg'], planned_tooth['rake_deg'], delta=2e-3)

    def test_exact_record_of_many_passes_is_the_plan(self):
        job = self.left_hand()
        rows = self.plan(job)
        record = self.record(rows, job)
        self.check_same(self.sections(0, record), self.planned(job))
        reported, _ = self.json(0, 'simulate', record, '--at', '5')
        self.assertEqual([(stroke['tooth'], stroke['pass']) for stroke in reported['strokes']],
                         sorted({(int(row['tooth']), int(row['pass'])) for row in rows}))
        self.assertEqual(reported['gouges'], [])

    def test_gouge_of_a_spark_out_is_in_tool_and_verdict(self):
        job = self.left_hand()
        rows = self.plan(job)
        last = max(rows, key=lambda row: int(row['pass']))['pass']
        gouged = [dict(row, y_mm=str(float(row['y_mm']) - 0.1)) if (row['tooth'], row['pass'], row['move']) == ('1', last, 'stroke')
                  else row for row in rows]
        reported, reasons = self.json(1, 'simulate', self.record(gouged, job), '--at', '5')
        gouge, = reported['gouges']
        self.assertEqual((gouge['tooth'], gouge['pass'], gouge['move']), (1, int(last), 'stroke'))
        self.assertAlmostEqual(gouge['depth_mm'], 0.1, delta=1e-4)
        place = 'tooth 2, pass %d, stroke: ' % (int(last) + 1)
        self.assertRegex(reasons, r'(?m)^%sthe wheel went 0\.100 mm beyond the flute' % place)
        planned, = self.json(0, 'simulate', job, '--at', '5')[0]['sections']
        self.assertLess(reported['sections'][0]['core_diameter_mm'], planned['core_diameter_mm'] - 0.19)
        self.assertRegex(self.grind(1, 'simulate', self.path('run.bag'), '--at', '5').stdout,
                         r'(?m)^beyond the flute +%s0\.100 mm at X ' % place)

    def test_interrupted_stroke_grinds_no_further(self):
        rows = self.plan(PAPER_JOB)
        rows = [row for row in rows if row['move'] != 'stroke' or float(row['x_mm']) < 10]
        end = max(i for i, row in enumerate(rows) if row['move'] == 'stroke')
        reported, reasons = self.json(1, 'simulate', self.record(rows[:end + 1]), '--at', '2,29')
        self.assertRegex(reasons, 'complete')
        stroke, = reported['strokes']
        self.assertAlmostEqual(stroke['to_x_mm'], 10, delta=0.02)
        near, far = reported['sections']
        planned = self.json(0, 'simulate', PAPER_JOB, '--at', '2')[0]['sections'][0]
        self.assertAlmostEqual(near['core_diameter_mm'], planned['core_diameter_mm'], delta=1e-4)
        self.assertEqual((far['area_removed_mm2'], far['core_diameter_mm']), (0, far['diameter_mm']))
        self.assertIsNone(far['teeth'][0]['edge_deg'])

    def test_teeth_that_are_not_in_the_record_are_not_ground(self):
        job = self.left_hand()
        rows = [row for row in self.plan(job) if row['tooth'] != '1']
        reported, _ = self.json(1, 'simulate', self.record(rows, job), '--at', '5')
        self.assertEqual({stroke['tooth'] for stroke in reported['strokes']}, {0, 2})
        teeth = reported['sections'][0]['teeth']
        self.assertEqual([tooth['edge_deg'] is None for tooth in teeth], [False, True, False])
        self.assertEqual(teeth[1]['depth_mm'], 0)
        self.assertRegex(self.grind(1, 'simulate', self.path('run.bag'), '--at', '5').stdout,
                         r'(?m)^tooth 2 +not in the record$')

    def test_of_several_runs_the_last_counts_unless_another_is_asked_for(self):
        rows = self.plan(PAPER_JOB)
        bag = Bag(self.path('two.bag'), 1e-3)
        bag.add(PAPER_JOB, '', rows[:500])
        bag.add(PAPER_JOB, '', rows)
        bag.close()
        reported, _ = self.json(0, 'simulate', self.path('two.bag'), '--at', '3,15,27')
        self.check_same(reported['sections'], self.planned())
        self.assertEqual(reported['source'], 'two.bag, job 2 of 2')
        self.json(1, 'simulate', self.path('two.bag'), '--run', '1')

    def test_bag_without_its_goal_needs_the_job(self):
        bag = self.record(self.plan(PAPER_JOB), job=None)
        self.assertRegex(self.grind(2, 'simulate', bag).stderr, 'does not have the goal of job 1 of 1; .* --job')
        self.check_same(self.sections(0, bag, '--job', PAPER_JOB), self.planned())
        reported, _ = self.json(0, 'report', bag)
        self.assertNotIn('tool', reported)
        self.assertIn('The ground tool: ', ''.join(reported['left_out']))

    def test_records_that_cannot_be_used(self):
        rows = self.plan(PAPER_JOB)
        self.assertRegex(self.grind(1, 'simulate', self.record([dict(rows[0], tooth='7'), *rows[1:3]])).stderr,
                         'cycle 0 grinds tooth 8, pass 1; the job has 1 teeth')
        self.write('cut.bag', '#ROSBAG V2.0\n')
        self.grind(2, 'simulate', self.path('cut.bag'))
        self.assertRegex(self.grind(2, 'simulate').stderr, 'FILE is missing; allowed: a file, or --last')


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'simulate', '__main__')
