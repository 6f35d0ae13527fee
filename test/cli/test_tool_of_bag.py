#!/usr/bin/env python3
"""Shows that `grind simulate` and `grind report` measure what the runs in a bag ground: one of them, or a tool whose operations are in
one bag as they ground it together. The bags are made of the setpoints that `grind plan --csv` lists, as if a drive had followed them
with the errors that a test gives it."""

import math
import pathlib
import sys

import rostest
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from bag_files import Bag  # noqa: E402
from grind_command import PAPER_JOB, CommandLine  # noqa: E402


class BagTest(CommandLine):
    period = 0.005  # of the machine, so that a bag is short

    def plan(self, job, *arguments):
        """The rows of a job's setpoints."""
        machine = gc.machine_file(self.path('machine.yaml'), control_rate=1 / self.period)
        self.grind(0, 'plan', job, *arguments, '--machine', machine, '--csv', self.path('plan.csv'))
        return self.csv(self.path('plan.csv'))

    def bag(self, *runs):
        """@param runs of (job, operation, rows, arguments of Bag.add())."""
        bag = Bag(self.path('run.bag'), self.period)
        for job, operation, rows, arguments in runs:
            bag.add(job, operation, rows, **arguments)
        bag.close()
        return self.path('run.bag')


class TestRun(BagTest):
    period = 0.001

    def left_hand(self):
        """A job of three teeth, in one pass, one to finish and one to spark out."""
        with open(gc.package_file('jobs/left_hand_d8_t3.yaml')) as file:
            job = yaml.safe_load(file)
        setup = {'file': gc.package_file('jobs/left_hand_d8_t3.setup.yaml')}
        del job['process']['roughing_passes']
        job['process'].update(infeed_mm=2, feed_mm_min=1000, setup=setup)
        return self.write('left_hand.yaml', yaml.safe_dump(job))

    def check_planned(self, reported, job):
        """That the tool is as planned at '3,15,27'."""
        planned, _ = self.json(0, 'simulate', job, '--at', '3,15,27')
        for one, other in zip(reported['sections'], planned['sections']):
            self.assertAlmostEqual(one['core_diameter_mm'], other['core_diameter_mm'], delta=2e-5)
            for tooth, planned_tooth in zip(one['teeth'], other['teeth']):
                self.assertAlmostEqual(tooth['edge_deg'], planned_tooth['edge_deg'], delta=2e-4)
                self.assertAlmostEqual(tooth['rake_deg'], planned_tooth['rake_deg'], delta=2e-3)

    def test_last_run_counts_unless_another_is_asked_for_with_its_gouges_and_missing_teeth(self):
        job = self.left_hand()
        rows = self.plan(job)
        last = max(rows, key=lambda row: int(row['pass']))['pass']
        gouged = [dict(row, y_mm=str(float(row['y_mm']) - 0.1)) if (row['tooth'], row['pass'], row['move']) == ('1', last, 'stroke')
                  else row for row in rows if row['tooth'] != '2']
        bag = self.bag((job, '', rows, {}), (job, '', gouged, {}))
        exact, _ = self.json(0, 'simulate', bag, '--run', '1', '--at', '3,15,27')
        self.check_planned(exact, job)
        self.assertEqual([(stroke['tooth'], stroke['pass']) for stroke in exact['strokes']],
                         sorted({(int(row['tooth']), int(row['pass'])) for row in rows}))
        self.assertEqual(exact['gouges'], [])

        reported, reasons = self.json(1, 'simulate', bag, '--at', '15')
        self.assertEqual(reported['source'], 'run.bag, job 2 of 2')
        gouge, = reported['gouges']
        self.assertEqual((gouge['tooth'], gouge['pass'], gouge['move']), (1, int(last), 'stroke'))
        self.assertAlmostEqual(gouge['depth_mm'], 0.1, delta=1e-4)
        place = 'tooth 2, pass %d, stroke: ' % (int(last) + 1)
        self.assertRegex(reasons, r'(?m)^%sthe wheel went 0\.100 mm beyond the flute' % place)
        section, = reported['sections']
        self.assertLess(section['core_diameter_mm'], exact['sections'][1]['core_diameter_mm'] - 0.19)
        self.assertEqual({stroke['tooth'] for stroke in reported['strokes']}, {0, 1})
        self.assertEqual([tooth['edge_deg'] is None for tooth in section['teeth']], [False, False, True])
        self.assertEqual(section['teeth'][2]['depth_mm'], 0)
        printed = self.grind(1, 'simulate', bag, '--at', '15').stdout
        self.assertRegex(printed, r'(?m)^beyond the flute +%s0\.100 mm at X ' % place)
        strokes = [float(row['x_mm']) for row in rows if row['move'] == 'stroke']
        self.assertRegex(printed, r'(?m)^tooth 1 +pass 1-%d, X %.3f to %.3f mm\ntooth 2 .*\ntooth 3 +not in the record$' % (
            int(last) + 1, min(strokes), max(strokes)))

    def test_bag_without_its_goal_needs_the_job(self):
        bag = self.bag((None, '', self.plan(PAPER_JOB), {}))
        self.assertRegex(self.grind(2, 'simulate', bag).stderr, 'does not have the goal of job 1 of 1; .* --job')
        self.check_planned(self.json(0, 'simulate', bag, '--at', '3,15,27', '--job', PAPER_JOB)[0], PAPER_JOB)
        reported, _ = self.json(0, 'report', bag)
        self.assertNotIn('tool', reported)
        self.assertIn('The ground tool: ', ''.join(reported['left_out']))

    def test_records_that_cannot_be_used(self):
        rows = self.plan(PAPER_JOB)
        self.assertRegex(self.grind(1, 'simulate', self.bag((PAPER_JOB, '', [dict(rows[0], tooth='7'), *rows[1:3]], {}))).stderr,
                         'cycle 0 grinds tooth 8, pass 1; the job has 1 teeth')
        self.grind(2, 'simulate', self.write('cut.bag', '#ROSBAG V2.0\n'))
        self.assertRegex(self.grind(2, 'simulate').stderr, 'FILE is missing; allowed: a file, or --last')


class TestTool(BagTest):
    rows = {}  # of the operations, planned once

    def setUp(self):
        super().setUp()
        text = pathlib.Path(gc.package_file('jobs/taper_reamer_d6_t6.yaml')).read_text()
        # In two passes, and fast.
        for old, new in (('feed_mm_min: 700', 'feed_mm_min: 2000'), ('feed_mm_min: 300', 'feed_mm_min: 1000'),
                         (' infeed_mm: 0.1', ' infeed_mm: 2'), (' roughing_passes: 6', ' infeed_mm: 2'), (' roughing_passes: 3', ' infeed_mm: 2'),
                         ('../wheels', gc.package_file('wheels')), ('file: taper', 'file: ' + gc.package_file('jobs/taper'))):
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.job = self.write('reamer.yaml', text)
        for operation in ('flute', 'primary', 'secondary'):
            if operation not in self.rows:
                self.rows[operation] = self.plan(self.job, '--operation', operation)

    def bag_of(self, *runs):
        """@param runs of (operation, arguments of Bag.add()), each with all of its rows unless they are among these."""
        return self.bag(*((self.job, operation, arguments.pop('rows', self.rows[operation]), arguments) for operation, arguments in runs))

    def check_taken(self, tool, radius, delta):
        """Of the edges, in the middle of the flute [mm]."""
        section = tool['sections'][len(tool['sections']) // 2]
        for tooth in section['teeth']:
            self.assertAlmostEqual((tooth['asked_edge_diameter_mm'] - tooth['edge_diameter_mm']) / 2, radius, delta=delta)

    def test_whole_tool_passes(self):
        page = self.path('tool.html')
        data, _ = self.json(0, 'report', self.bag_of(*((operation, {}) for operation in self.rows)), '-o', page)
        self.assertEqual((data['verdict'], data['verdict_because']), ('passed', []))
        self.assertIn('job 3 of 3, what is ahead of it by job 1, 2', data['tool']['source'])
        printed = pathlib.Path(page).read_text()
        for text in (data['tool']['source'], '<figure id="section-1"', '<figure id="rake"', '10 ± 0.5 deg, 0.3 mm wide, then 22 deg',
                     'clearance [deg]'):
            self.assertIn(text, printed)
        self.assertRegex(printed, r'clearance (9\.99|10\.00)\d deg, asked 10\.000')
        self.assertRegex(printed, r'primary relief 0\.(299|300|301) mm, heel at 1\.\d')
        self.assertNotIn('land [mm]', printed)
        off = {criterion['name']: criterion['measured'] - criterion['asked'] for criterion in data['criteria']}
        self.assertAlmostEqual(off['clearance'], 0, delta=0.02)
        self.assertAlmostEqual(off['primary relief'], 0, delta=0.005)
        self.assertAlmostEqual(off['edge diameter'], 0, delta=0.002)

    def test_without_its_flutes_they_are_planned_and_not_judged(self):
        data, _ = self.json(0, 'report', self.bag_of(('flute', {'ahead': 2e-3, 'rake_angle': 0.1}), ('primary', {})))
        self.assertTrue(data['tool']['on_planned'])
        self.assertIn('what is ahead of it as planned', data['tool']['source'])
        self.assertEqual(data['verdict'], 'incomplete')
        self.assertIn('rake: not measured', data['verdict_because'])
        self.check_taken(data['tool'], 0, 0.5e-3)

    def test_texts_are_escaped_and_teeth_that_are_not_in_the_bag_reported(self):
        two = [row for row in self.rows['flute'] if int(row['tooth']) < 2]
        data, _ = self.json(0, 'report', self.bag_of(('flute', {'text': 'a\x1b[2J', 'rows': two})))
        self.assertEqual((data['job']['name'], data['reason']), ('a\\x1b[2J',) * 2)
        self.assertIn('not all of its teeth were ground in this job', ' '.join(data['left_out']))

    def test_of_several_tools_the_last_begun_counts_with_what_continued_it(self):
        """The flutes of the first are turned, so that the relief takes their edge, as a plane of the clearance does over so short a way."""
        flutes, ahead = self.rows['flute'], 2e-3
        cut = next(i for i, row in enumerate(flutes) if row['tooth'] == '3')
        path = self.bag_of(('flute', {'ahead': ahead}), ('primary', {}), ('flute', {'rows': flutes[:cut]}),
                           ('flute', {'rows': flutes[cut:], 'first': (3, 0)}), ('primary', {}))
        tool, _ = self.json(0, 'simulate', path, '--at', '8')
        self.assertIn('job 5 of 5, what is ahead of it by job 3, 4', tool['source'])
        self.check_taken(tool, 0, 0.5e-3)
        first, _ = self.json(0, 'simulate', path, '--at', '8', '--run', '2')
        self.assertIn('job 2 of 5, what is ahead of it by job 1', first['source'])
        self.check_taken(first, (6 / 2 + 8 * math.tan(math.radians(2))) * ahead * math.tan(math.radians(10)), 0.1e-3)
        self.assertFalse(first['on_planned'])


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'test_tool_of_bag', '__main__')
