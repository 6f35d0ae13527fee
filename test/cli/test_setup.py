#!/usr/bin/env python3
"""Shows that `grind setup` writes the set-up for the tool that a job asks for into its set-up file, which `grind plan` accepts, what
its sheet says, and that a refusal leaves the files as they were."""

import math
import os
import pathlib
import re
import sys

import rostest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'node'))

import grinder_client as gc  # noqa: E402
from grind_command import CommandLine, full_disk  # noqa: E402
from grinder_client import DEG  # noqa: E402

JOBS = gc.package_file('jobs')


class TestSetup(CommandLine):
    def job(self, **changes):
        """Writes the paper's job, to be solved, with other values as text, `None` to leave a key out; the keys are unique in it."""
        text = self.text(JOBS + '/paper.yaml').replace('../wheels', gc.package_file('wheels')).replace('paper.setup', 'job.setup')
        for key, value in changes.items():
            pattern = r'(?m)^( *)%s: *(\{.*?\}|\[.*?\]|[^ #\n]+)(.*)\n' % key
            self.assertEqual(len(re.findall(pattern, text)), 1, key)
            text = re.sub(pattern, '' if value is None else r'\g<1>%s: %s\g<3>\n' % (key, value), text)
        return self.write('job.yaml', text)

    def text(self, path):
        return pathlib.Path(path).read_text()

    def test_what_is_written_is_planned_and_on_the_sheet(self):
        job = self.job()
        self.assertRegex(self.grind(2, 'plan', job).stderr, "job.setup.yaml: cannot be read: .*; 'grind setup --write' solves it")
        found, said = self.json(0, 'setup', job, '--write')
        self.assertEqual((said, found['wheel_above_swivel_mm'], found['complete_from_mm'], found['complete_to_mm']), ('', None, 0, 30))
        self.grind(0, 'plan', job)
        written = self.text(self.path('job.setup.yaml'))
        done = gc.grind('setup', job, '--write', preexec_fn=full_disk)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, 'job.setup.yaml: cannot be written: File too large\n$')
        self.assertEqual(self.text(self.path('job.setup.yaml')), written)
        self.assertEqual(set(os.listdir(self.folder)), {'job.yaml', 'job.setup.yaml'})
        self.check_sheet(self.grind(0, 'setup', job).stdout, found)

    def check_sheet(self, sheet, found):
        swivel, height = found['swivel_deg'] * DEG, found['height_mm']
        lines = [r"swivel +%.3f deg; the machine's range is -90 to 90 deg" % found['swivel_deg'], 'height +%.3f mm' % height,
                 'shift in X +%.3f mm' % found['x_shift_mm'], 'upper face %.3f mm' % (height + 1.5 / math.cos(swivel)),
                 r"%.4f mm less per mm of the wheel's middle above the swivel's centre" % (1 - math.cos(swivel)),
                 r'reads D/2 - %.3f mm: %.3f mm for D = 10 mm' % (height - 1.5, 6.5 - height),
                 r'reads \(D - 10\)/2 mm: 0\.000 mm for D = 10 mm', r'flutes complete +X 0\.000 to 30\.000 mm',
                 r'core diameter +6\.80. to 12\.05. mm; asked 6\.8 to 12\.05 mm within 0\.02 mm']
        for name, key, asked in (('rake', 'rake', '8 deg within 0.5'), ('chordal rake', 'chordal_rake', '8 deg within 7'),
                                 ('spiral angle', 'spiral', '30 deg within 0.3')):
            ends = found['figures'][key]['ground_deg']
            lines.append(r'(?m)^  %s +%.3f to %.3f deg; asked %s deg$' % (name, *ends, asked))
        for line in lines:
            self.assertRegex(sheet, line)

    def test_what_a_plan_refuses_is_not_written(self):
        # Each tooth has a helix of its own, and the set-up is for the middle.
        job = self.job(teeth=2, spiral_angle_deg=None, cut='right_hand\n  spiral_angles_deg: [27, 33]')
        self.assertRegex(self.grind(1, 'setup', job, '--write').stderr, r'^(a plan would refuse this tool: .*\n)+.*job\.setup\.yaml: nothing was written\n$')
        self.assertEqual(os.listdir(self.folder), ['job.yaml'])

    def test_what_the_job_asks_for_is_kept_and_what_else_a_plan_refuses_said_beforehand(self):
        job = self.job(setup='{file: job.setup.yaml, swivel_deg: 32.5}', rake_tolerance_deg=2, core_tolerance_mm=0.2, shank_diameter_mm=40)
        found, said = self.json(0, 'setup', job, '--write')
        self.assertEqual(found['swivel_deg'], 32.5)
        self.assertRegex(said, r'(?m)^a plan of it is refused: collision_clearance = 1 mm: .* shank .*; change .*$')

    def test_wheel_above_the_swivel(self):
        machine = self.write('machine.yaml', self.text(gc.package_file('config/grinder.yaml')).replace(
            'flange: 0.0035 ', 'flange: 0.0235 '))
        higher, _ = self.json(0, 'setup', JOBS + '/unequal_d12_t4.yaml', '--machine', machine)
        self.assertAlmostEqual(higher['wheel_above_swivel_mm'], 20, delta=1e-9)
        lowered = 20 * (1 - math.cos(higher['swivel_deg'] * DEG))
        self.assertAlmostEqual(higher['touch_z_mm'], 1.5 - higher['height_mm'] - lowered, delta=1e-9)

    def test_a_relief_is_on_the_sheet(self):
        relief = 'setup', JOBS + '/end_mill_d10_t4.yaml', '--operation', 'primary'
        found, sheet = self.json(0, *relief)[0], self.grind(0, *relief).stdout
        # Of a wheel of 6 mm.
        self.assertAlmostEqual(found['upper_face_mm'], found['height_mm'] + 3 / math.cos(found['swivel_deg'] * DEG), delta=1e-6)
        for line in ('upper face %(upper_face_mm).3f mm, lower face %(lower_face_mm).3f mm', 'stays %(next_edge_deg).3f deg or more',
                     '%(rim_mm).3f of 6.000 mm of its width', 'X %(complete_from_mm).3f to %(complete_to_mm).3f mm'):
            self.assertIn(line % found, sheet)
        self.assertIn('clearance %.3f to %.3f deg there' % tuple(found['land_end_clearance_deg']), sheet)

    def end_mill(self):
        """Writes the shipped end mill, its flutes set up, with operations on its end instead of the reliefs."""
        name = 'end_mill_d10_t4'
        text, shown = self.text(JOBS + '/%s.yaml' % name).replace('../wheels', gc.package_file('wheels')), '  - kind: relief '
        flutes, rest = text[:text.index(shown)], text[text.index('interpolation:'):]
        process = ('    feed_mm_min: 400\n    infeed_mm: %s\n    finish_infeed_mm: 0.03\n    stock_mm: 0.1\n'
                   '    wheel: {file: %s.yaml}\n    setup: {file: %s.setup.yaml}\n')
        for kind, infeed, wheel in (('gash\n    angle_deg: 45\n    past_mm: 0.2', 2, 'angled_d100_w5_a45'),
                                    ('end\n    relief: primary', 0.2, 'straight_d100_w6'), ('chamfer', 0.1, 'straight_d100_w6')):
            flutes += '  - kind: %s\n' % kind + process % (infeed, gc.package_file('wheels/' + wheel), name)
        of_flutes = self.text(JOBS + '/%s.setup.yaml' % name)
        self.write(name + '.setup.yaml', of_flutes[:of_flutes.index('primary:')])
        return self.write(name + '.yaml', flutes + rest)

    def test_the_operations_on_the_end_are_set_up_in_turn(self):
        job = self.end_mill()
        self.assertRegex(self.grind(2, 'setup', job, '--operation', 'chamfer').stderr,
                         "no set-up of the gash; 'grind setup --operation gash --write' solves it")
        # Of a gash from the blank's circle to 0.2 mm past the axis, at 45 deg on a blank that is 0.1 mm longer.
        for operation, swivel, stock in (('gash', 3.0, 10 / 2 + 0.2 + 0.1), ('end_primary', 81.76, None), ('chamfer', None, None)):
            found, _ = self.json(0, 'setup', job, '--operation', operation, '--write')
            self.assertNotIn('limit', found)
            self.assertAlmostEqual(found['to_mm'][2], 0, delta=1e-5)
            for key, asked in (('swivel_deg', swivel), ('stock_mm', stock), ('travel_a_deg', 3 * 90)):
                if asked:
                    self.assertAlmostEqual(found[key], asked, delta=1e-4)
            self.assertIn('\n%s:\n  swivel_deg: %g\n  height_mm: %.8g\n' % (operation, found['swivel_deg'], found['height_mm']),
                          self.text(self.path('end_mill_d10_t4.setup.yaml')))
            sheet = self.grind(0, 'setup', job, '--operation', operation).stdout
            for line in ('first tooth +A %.3f deg' % found['a_deg'], 'passes +%d of each tooth, which remove %.3f mm .*' % (
                    found['passes'], found['stock_mm']), *('%s +X %.3f, Y %.3f, Z %.3f mm.*' % (
                        name, *(round(length, 3) + 0.0 for length in found[key])) for name, key in (
                        ('last stroke +from', 'from_mm'), (' +to', 'to_mm'), ('travel', 'travel_mm')))):
                self.assertRegex(sheet, '(?m)^  %s$' % line)
            if operation != 'gash':
                self.assertIn('reads %.3f mm for D = 10 mm, ' % found['touch_x_mm'], sheet)
        self.write('end_mill_d10_t4.yaml', self.text(job).replace('dish_deg: 2', 'dish_deg: 3'))
        self.assertRegex(self.grind(2, 'plan', job, '--operation', 'chamfer').stderr, 'solved for cutter.end.dish_deg = 2; the job now has cutter.end.dish_deg = 3')

    def test_an_end_is_refused_on_a_machine_that_swivels_less_and_keeps_nothing(self):
        job = self.end_mill()
        self.grind(0, 'setup', job, '--operation', 'gash', '--write')
        model = self.text(gc.package_file('urdf/grinder.urdf')).replace('lower="-1.5707963" upper="1.5707963"', 'lower="-1.0471976" upper="1.0471976"')
        said = self.grind(1, 'setup', job, '--operation', 'end_primary', '--write', '--urdf', self.write('grinder.urdf', model)).stderr
        self.assertEqual(said, 'the set-up takes a swivel of 81.76 deg; the machine swivels -60 to 60 deg; change cutter.end.clearance_deg\n')
        self.assertNotIn('end_primary', self.text(self.path('end_mill_d10_t4.setup.yaml')))
        self.write('end_mill_d10_t4.yaml', self.text(job).replace('setup.yaml}', 'setup.yaml, swivel_deg: 81}'))
        self.assertRegex(self.grind(2, 'setup', job, '--operation', 'end_primary').stderr,
                         r'operations\[1\]\.setup\.swivel_deg stands beside .*; allowed beside it: none')


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'setup', '__main__')
