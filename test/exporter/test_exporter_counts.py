#!/usr/bin/env python3
"""Shows what the exporter makes of records, states and diagnostics, without ROS: its counters are sums of the records, and do not
fall when records are removed; and that its metrics are those of docs/shop.md, and all that the alerts ask for."""

import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
from unittest import mock

import prometheus_client
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from flute_grinder import job
from flute_grinder.msg import GrindActionFeedback, GrinderState, Reason

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / 'test/node'), str(ROOT / 'src/exporter')]

import exporter  # noqa: E402
import grinder_client as gc  # noqa: E402
from record_files import head_of, text_of  # noqa: E402


def name_of(minute, number=None):
    """Of a record of a job that started at a minute; by default that is its number too."""
    return '%010d_20261122T17%02d00.000Z.json' % (minute if number is None else number, minute)


class Folder(unittest.TestCase):
    """A folder of records, and the exporter's program on it."""

    def setUp(self):
        self.folder = gc.temp_folder(self.addCleanup)
        self.start()

    def start(self):
        self.grinder = exporter.Grinder(exporter.Records(self.folder))
        self.registry = prometheus_client.CollectorRegistry()
        self.registry.register(self.grinder)

    def value(self, name, **labels):
        return self.registry.get_sample_value('flute_grinder_' + name, labels)

    def write(self, minute, outcome='done', number=None, seconds=1, file='test/jobs/paper.yaml', body=(), **fields):
        """A record of a job that started at a minute."""
        head = head_of(file, '2026-11-22T17:%02d:00.000Z' % minute, '2026-11-22T17:%02d:%06.3fZ' % (minute, seconds), outcome, **fields)
        with open(os.path.join(self.folder, name_of(minute, number)), 'w') as text:
            text.write(text_of(head, body))

    def remove(self, minute):
        os.remove(os.path.join(self.folder, name_of(minute)))


class TestRecords(Folder):
    def check_four(self, done=2):
        self.assertEqual([self.value('jobs_total', outcome=o) for o in ('done', 'canceled', 'fault')], [done, 1, 1])
        self.assertEqual(sum(self.value('verdicts_total', verdict=v) for v in ('passed', 'incomplete', 'failed')), done + 2)
        self.assertEqual((self.value('setpoints_total'), self.value('strokes_total'), self.value('tools_total')),
                         (7012 + done, 4 + done, done))
        self.assertEqual(self.value('job_duration_seconds_total'), 13.5 + done)

    def test_are_added_up_and_still_count_when_they_are_removed(self):
        self.write(1, setpoints=1009, complete=3, seconds=2.5, wear_mm=0.25)
        self.write(2, 'canceled', setpoints=2003, complete=2, seconds=4)
        self.write(3, 'fault', setpoints=4001, complete=0, seconds=8, wear_mm=0.5)
        self.write(0, setpoints=1)
        self.check_four()
        # A job that was broken off has failed; a record says nothing of the ground tool, so that none has passed.
        self.assertGreaterEqual(self.value('verdicts_total', verdict='failed'), 2)
        self.assertEqual(self.value('verdicts_total', verdict='passed'), 0)
        self.assertEqual(self.value('wheel_wear_meters', wheel='wheel.yaml'), 0.5e-3)
        self.remove(2)
        self.check_four()
        self.remove(0)
        self.start()
        self.check_four()
        self.write(4, setpoints=1)
        self.check_four(done=3)
        self.start()
        self.check_four(done=3)

    def test_of_a_clock_that_was_set_back_count(self):
        self.write(9, setpoints=5)
        self.assertEqual(self.value('setpoints_total'), 5)
        self.write(8, setpoints=7, number=10)
        self.write(7, wear_mm=0.25, number=11)
        self.assertEqual((self.value('setpoints_total'), self.value('wheel_wear_meters', wheel='wheel.yaml')), (12, 0.25e-3))

    def test_that_are_none_do_not_count_and_are_said_once(self):
        self.write(1, setpoints=5)
        folder = pathlib.Path(self.folder)
        for name, text in ((name_of(2), '{"record": 1'), (name_of(3), '[]'), (name_of(4) + '.new', ''), ('notes.json', 'mine')):
            (folder / name).write_text(text)
        (folder / name_of(5)).mkdir()
        (folder / name_of(6)).symlink_to('nowhere')
        os.mkfifo(str(folder / name_of(7)))
        for minute, outcome, verdict in ((8, 'stopped', 'failed'), (9, 'done', 'good')):
            self.write(minute, outcome, setpoints=3, verdict=verdict)
        with mock.patch.object(exporter, 'say') as say:
            self.assertEqual((self.value('setpoints_total'), self.value('jobs_total', outcome='done')), (5, 1))
            self.write(10, setpoints=7)
            self.assertEqual(self.value('setpoints_total'), 12)
        said = {call[1][0].name: call[1][1] for call in say.mock_calls}
        self.assertEqual(len(said), len(say.mock_calls))
        self.assertEqual({name for name, text in said.items() if text == 'skipped: named like a record, but not a regular file'},
                         {name_of(minute) for minute in (5, 6, 7)})
        self.assertLessEqual({name_of(8), name_of(9)}, set(said))

    def damage(self, file, content):
        """Puts a text, or what a function makes, in the place of the sums."""
        if file.is_dir():
            file.rmdir()
        elif os.path.lexists(str(file)):
            file.unlink()
        if callable(content):
            content(str(file))
        else:
            file.write_text(content)

    def test_are_counted_anew_if_the_sums_are_damaged(self):
        self.write(1, setpoints=5)
        self.assertEqual(self.value('setpoints_total'), 5)
        file = pathlib.Path(self.folder) / 'exporter.json'
        good = json.loads(file.read_text())

        def other(**sums):
            return json.dumps(dict(good, sums=dict(good['sums'], **sums)))

        for content in (os.mkfifo, '{"sums": {"setpo', '[' * 100000, 'null', '{}', '{"sums": {}, "counted": []}',
                        json.dumps(dict(good, counted=[1, 'a'])), json.dumps(dict(good, counted='a')),
                        other(setpoints='5'), other(setpoints=True), other(setpoints=-1), other(setpoints=math.nan),
                        other(setpoints=10 ** 400), other(jobs={'done': 1}), other(wheels=[]),
                        other(wheels={'a': {'dressed': None, 'tools': 1, 'wear': 0}})):
            with self.subTest(content):
                self.damage(file, content)
                with mock.patch.object(exporter, 'say') as say:
                    self.start()
                said, = say.mock_calls
                self.assertEqual(said[1][0], file)
                self.assertIn('the counters begin with the records that are there: ', said[1][1])
                self.assertEqual((self.value('setpoints_total'), self.value('wheel_wear_meters', wheel='wheel.yaml')), (5, 0))

    def test_whose_sums_cannot_be_kept_count(self):
        new = pathlib.Path(self.folder) / 'exporter.new'
        foreign = pathlib.Path(self.folder) / 'notes.txt'
        foreign.write_text('mine')
        for minute, content in enumerate((os.mkfifo, lambda path: os.symlink('notes.txt', path), os.mkdir)):
            self.damage(new, content)
            self.write(minute, setpoints=1)
            with mock.patch.object(exporter, 'say') as say:
                self.assertEqual(self.value('setpoints_total'), minute + 1)
        self.assertIn('the counters may fall with the next start: ', say.mock_calls[0][1][1])
        self.assertEqual(foreign.read_text(), 'mine')

    def test_of_no_folder_are_none(self):
        os.rmdir(self.folder)
        self.assertEqual((self.value('jobs_total', outcome='done'), self.value('records_free_bytes')), (0, None))
        os.mkdir(self.folder)
        self.write(1)
        self.assertEqual(self.value('jobs_total', outcome='done'), 1)

    def test_tools_are_done_with_their_last_operation_and_count_for_a_wheel_since_it_was_dressed(self):
        for minute, (outcome, ends_tool, wheel, dressed, tools, of_wheel) in enumerate((
                ('done', False, 'a.yaml', '', 0, 1), ('done', True, 'a.yaml', '', 1, 2),
                ('done', True, 'b.yaml', '2026-11-20', 2, 1), ('canceled', True, 'a.yaml', '', 2, 2),
                ('done', True, 'a.yaml', '2026-11-22', 3, 1), ('done', True, 'b.yaml', '2026-11-20', 4, 2))):
            self.write(minute, outcome, ends_tool=ends_tool, wheel=wheel, dressed=dressed)
            self.start()  # kept over restarts
            self.assertEqual((self.value('tools_total'), self.value('wheel_tools_since_dressing', wheel=wheel)), (tools, of_wheel))

    def test_show_what_was_measured_last_of_each_figure_also_if_it_is_entered_later(self):
        def core(value, x=15):
            return {'figure': 'core_diameter', 'x_mm': x, 'value_mm': value}

        rake = {'figure': 'rake', 'x_mm': 2.5, 'value_deg': 9}
        self.write(1, body={'measured': [core(6.5), rake]})
        self.write(2)
        self.write(3, operation='flute', body={'measured': [core(5, 1)]})
        self.assertAlmostEqual(self.measured('core_diameter@15'), 6.5e-3, delta=1e-12)
        self.assertAlmostEqual(self.measured('rake@2.5'), math.pi / 20, delta=1e-12)
        self.assertAlmostEqual(self.measured('core_diameter@1', 'flute'), 5e-3, delta=1e-12)
        self.write(2, body={'measured': [core(7), core(6.75)]})
        self.assertAlmostEqual(self.measured('core_diameter@15'), 6.75e-3, delta=1e-12)
        for wrong in ({'measured': [{}]}, {'measured': [3]}, {'measured': 3}, {'measured': [dict(core(7), value_mm='7')]}):
            self.write(2, body=wrong)
            self.assertAlmostEqual(self.measured('core_diameter@15'), 6.5e-3, delta=1e-12, msg=wrong)

    def measured(self, figure, operation=''):
        return self.value('measured', job='job', operation=operation, figure=figure)

    def test_have_the_tool_that_a_state_has(self):
        self.write(1, file='jobs/unequal_d12_t4.yaml')
        entry, = json.loads(gc.grind('history', '--from', self.folder, '--json').stdout)
        self.assertEqual(exporter.tool_text(job.goal(gc.package_file('jobs/unequal_d12_t4.yaml')).cutter), entry['tool'])


class TestMessages(Folder):
    def report(self, level=0, **figures):
        """A report of a status, of which figures are `late`, `cycles` or axes."""
        values = {'late': ('Control loop', 'Late cycles'), 'cycles': ('Control loop', 'Cycles'),
                  'x': ('Following error', 'axis_x max [m]')}
        self.grinder.hear_diagnostics(DiagnosticArray(status=[
            DiagnosticStatus(name='left/grinder: ' + values[name][0], level=level, values=[KeyValue(values[name][1], str(value))])
            for name, value in figures.items()]))

    def test_the_worst_of_a_minute_is_shown_and_late_cycles_are_added_up(self):
        self.report(x=1e-6, cycles=1000, late=3)
        self.report(level=1, x=4e-6, cycles=1000, late=2)
        self.report(x=2e-6, cycles=1000, late=0)
        self.assertEqual(self.value('following_error_max_meters', axis='x'), 4e-6)
        self.assertEqual(self.value('diagnostics_level', status='following_error'), 1)
        self.assertEqual((self.value('cycles_total'), self.value('late_cycles_total')), (3000, 5))
        self.report(x='nan')
        self.assertTrue(math.isnan(self.value('following_error_max_meters', axis='x')))

    def test_a_fault_counts_once_and_by_its_reason(self):
        reason = Reason(kind=Reason.FOLLOWING_ERROR)
        fault, ready = GrinderState(state=GrinderState.FAULT, fault_reason=reason), GrinderState(state=GrinderState.READY)
        # One that was there before the exporter heard of the grinder is not counted again.
        for message in (None, fault, fault, ready, fault, fault, None, fault, ready, fault):
            self.grinder.hear_state(message)
        self.assertEqual(self.value('faults_total', reason='following_error'), 2)
        self.assertEqual(self.value('faults_total', reason='late'), 0)

    def test_a_state_is_shown_until_the_connection_ends(self):
        state = GrinderState(state=GrinderState.HELD, feed=0.01, override=0.75, spindle_commanded=True)
        state.progress.job_digest, state.progress.job_name, state.progress.operation = '0', 'mill.yaml', 'primary relief'
        self.grinder.hear_state(state)
        self.assertEqual([self.value('state', state=name) for name in ('held', 'ready', 'jogging_retracted')], [1, 0, 0])
        self.assertEqual([self.value(name) for name in ('up', 'feed_meters_per_second', 'feed_override_ratio', 'spindle_commanded',
                                                        'spindle_at_speed')], [1, 0.01, 0.75, 1, 0])
        self.assertEqual(self.value('job_info', job='mill.yaml', operation='primary relief',
                                    tool=exporter.tool_text(state.progress.cutter)), 1)
        self.grinder.hear_state(None)
        self.assertEqual((self.value('up'), self.value('state', state='held')), (0, None))

    def say_all(self):
        """All that is shown at any time."""
        state = GrinderState()
        state.progress.job_digest = '0'
        self.grinder.hear_state(state)
        self.grinder.hear_feedback(GrindActionFeedback())
        self.report(x=0, late=0)
        self.write(1, body={'measured': [{'figure': 'land', 'x_mm': 2, 'value_mm': 1}]})
        return prometheus_client.generate_latest(self.registry).decode()

    def test_metrics_are_those_of_the_page_and_all_that_alerts_ask_for(self):
        shown = set(re.findall(r'(?m)^(flute_grinder_\w+)', self.say_all()))
        page = (ROOT / 'docs/shop.md').read_text()
        self.assertEqual(set(re.findall(r'(?m)^\| `(flute_grinder_\w+)', page)), shown)
        asked = set(re.findall(r'flute_grinder_\w+', ''.join(re.findall(r'expr: (.*)', (ROOT / 'monitoring/alerts.yml').read_text()))))
        self.assertEqual(asked - shown - {'flute_grinder'}, set())

    @unittest.skipUnless(shutil.which('promtool'), 'promtool is not installed')
    def test_promtool_has_nothing_against_the_names(self):
        checked = subprocess.run(['promtool', 'check', 'metrics'], input=self.say_all().encode(), stdout=subprocess.PIPE,
                                 stderr=subprocess.STDOUT)
        self.assertEqual((checked.returncode, checked.stdout), (0, b''))


if __name__ == '__main__':
    rostest.rosrun('flute_grinder', 'exporter_counts', '__main__')
