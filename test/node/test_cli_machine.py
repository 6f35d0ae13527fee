"""Shows what those commands of `grind` print that need the grinder, and their exit status: 0 done, 1 the machine or the job
said no, 2 an unreadable file."""

import os
import pathlib
import re
import shutil
import unittest.mock

import rospy
from flute_grinder.msg import GrinderState

import grinder_client as gc
from grind_command import PAPER_JOB, Command, CommandLine, RunTest
from grinder_client import MM_MIN, grinder


class TestMachine(CommandLine):
    """The calls that need the grinder."""

    def setUp(self):
        super().setUp()
        grinder().make_ready()

    def test_status_power_spindle_coolant_and_override(self):
        printed = self.grind(0, 'status').stdout
        self.assertTrue(printed.startswith('grinder         /grinder\n'), printed)
        for line in ('state +ready', 'enabled +yes', 'emergency stop +released', 'wheel in work +no'):
            self.assertRegex(printed, '(?m)^%s$' % line)
        self.assertNotIn('fault ', printed)
        self.assertEqual(self.grind(0, 'spindle', 'on').stdout, 'spindle on: done\n')
        self.assertEqual(self.grind(0, 'coolant', 'on').stdout, 'coolant on: done\n')
        grinder().wait_fresh(lambda s: s.spindle_at_speed and s.coolant_on, 'spindle and coolant')
        self.assertRegex(self.grind(0, 'status').stdout, r'spindle +at speed\ncoolant +on\n')
        self.grind(0, 'coolant', 'off')
        self.assertEqual((grinder().fresh_state().spindle_commanded, grinder().fresh_state().coolant_commanded), (True, False))
        self.grind(0, 'disable')
        self.assertEqual(grinder().fresh_state().state, GrinderState.DISABLED)
        self.assertFalse(grinder().fresh_state().spindle_commanded)
        self.assertRegex(self.grind(0, 'status').stdout, r'state +disabled\nenabled +no\n')
        self.assertRegex(self.grind(1, 'spindle', 'on').stderr, r'^spindle on refused: the machine is in state disabled; allowed: ')
        self.grind(0, 'spindle', 'off')
        self.assertEqual(self.grind(0, 'enable').stdout, 'the power is on\n')
        self.assertEqual(grinder().fresh_state().state, GrinderState.READY)
        self.assertFalse(grinder().fresh_state().spindle_commanded)
        self.addCleanup(grinder().set_feed_override, 1)
        for percent in ('0', '120', '12.5'):
            self.grind(0, 'override', percent)
            self.assertEqual(grinder().fresh_state().override, float(percent) / 100)
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^feed +0\.0 mm/min, override 1[23] %$')

    def test_reset(self):
        self.assertRegex(self.grind(1, 'reset').stderr, r'^reset refused: the machine is in state ready; allowed: ')
        grinder().inject('emergency_stop')
        grinder().wait_state(GrinderState.FAULT)
        printed = self.grind(0, 'status').stdout
        self.assertRegex(printed, r'state +fault\n')
        self.assertRegex(printed, r'emergency stop +pressed\n')
        self.assertRegex(printed, r'fault +emergency stop\n')
        reported, _ = self.json(0, 'status')
        self.assertEqual((reported['fault'], reported['emergency_stop'], reported['enabled']), ('emergency stop', True, False))
        self.assertRegex(self.grind(1, 'enable').stderr,
                         r'^enable refused: the machine is in state fault; allowed: disable, reset\n$')
        self.assertRegex(self.grind(1, 'reset').stderr, r'^reset refused: the emergency stop is pressed')
        grinder().inject('none')
        grinder().wait_fresh(lambda s: not s.emergency_stop, 'the emergency stop released')
        self.grind(0, 'reset')
        self.assertEqual(grinder().fresh_state().state, GrinderState.DISABLED)

    def test_run_streams_a_relief_as_planned(self):
        grinder().make_ready_at_park()
        job = gc.reamer_file(self.path('reamer.yaml'))
        missing = 'operation is missing; allowed: 1 or flute, 2 or primary, 3 or secondary; done by the records: '
        with unittest.mock.patch.dict(os.environ, ROS_HOME=self.path('ros')):
            self.assertIn(missing + 'none\n', self.grind(2, 'run', job).stderr)
        self.grind(0, 'confirm-swivel', '13.104')
        job_of = job, '--operation', 'secondary'
        self.grind(0, 'plan', *job_of, '--csv', self.path('plan.csv'))
        batches = len(grinder().batches)
        printed = self.grind(0, 'run', *job_of, '--answer', 'discard', '--answer', 'ignore-offsets', '--csv', self.path('run.csv'))
        with open(self.path('plan.csv')) as plan, open(self.path('run.csv')) as run:
            planned, streamed = plan.read().splitlines(), run.read().splitlines()
        # The run's file has four more columns, the positions that the drive read.
        self.assertEqual(streamed[0], planned[0] + ',actual_x_mm,actual_y_mm,actual_z_mm,actual_a_rad')
        self.assertTrue(planned == [line.rsplit(',', 4)[0] for line in streamed], 'the setpoints differ')
        # From the first setpoint to the last, by the clock of the grinder.
        new = grinder().batches_of_goal(batches)
        duration = '%.3f' % (new[-1].end_stamp - new[0].header.stamp).to_sec()
        self.assertRegex(printed.stdout, r'streamed +%d setpoints in %s s, 0 missed\n' % (len(planned) - 1, re.escape(duration)))
        self.assertRegex(printed.stderr, r'100 %')
        # The journal may be a little later than the end.
        last = gc.poll(lambda: (lambda last: last['finished'] and last)(self.json(0, 'status')[0]['last_job']), 'the end in the journal')
        self.assertEqual((last['name'], last['operation'], last['finished'], last['end']),
                         ('reamer.yaml', 'secondary relief', True, 'done'))
        kept = self.path('ros/flute_grinder/history/grinder')
        history = pathlib.Path(rospy.get_param('/grinder/history'))
        record = gc.poll(lambda: next((path for path in history.glob('**/*.json') if last['digest'] in path.read_text()), None),
                         'the record')
        shutil.copytree(record.parent, kept)
        with unittest.mock.patch.dict(os.environ, ROS_HOME=self.path('ros')):
            self.assertRegex(self.grind(2, 'run', job).stderr, re.escape(missing) + r'secondary \([-0-9]{10} [:0-9]{8}\)\n')

    def test_a_job_is_held_retracted_and_resumed_without_a_home_and_status_says_where_and_why(self):
        self.grind(0, 'override', '20')
        self.addCleanup(grinder().set_feed_override, 1)
        batches = len(grinder().batches)
        command = Command('run', PAPER_JOB, '--answer', 'discard', '--answer', 'ignore-offsets')
        self.addCleanup(command.close)
        RunTest.wait_in_stroke(grinder(), batches)
        reported, _ = self.json(0, 'status')
        self.assertEqual((reported['state'], reported['tooth'], reported['pass'], reported['last_job']['finished'], reported['coolant_on']),
                         ('running', 1, 1, False, True))
        command.wait_text('  running  ')
        grinder().fresh_state()
        self.assertIn(reported['feed_mm_min'], {s.feed / MM_MIN for batch in grinder().batches[batches:] for s in batch.setpoints})
        with unittest.mock.patch.dict(os.environ, HOME='/dev/null'):  # in which root makes no folder either
            self.grind(0, 'hold')
            grinder().wait_state(GrinderState.HELD)
            command.wait_text('  held  ')
            self.assertRegex(self.grind(0, 'status').stdout, r'(?ms)^state +held$.*^feed +0\.0 mm/min, override 20 %$')
            self.grind(0, 'resume')
            grinder().wait_state(GrinderState.RUNNING)
            if grinder().injects_faults():
                grinder().inject('coolant_lost')
                grinder().wait_state(GrinderState.RETRACTED)
                self.assertEqual(self.json(0, 'status')[0]['hold_reason'], 'no coolant flows')
                printed = self.grind(0, 'status').stdout
                for line in ('state +retracted', 'coolant +off', 'held because +no coolant flows'):
                    self.assertRegex(printed, '(?m)^%s$' % line)
                self.assertEqual(self.grind(1, 'resume').stderr, 'resume refused: no coolant flows\n')
                grinder().inject('none')
                grinder().wait_fresh(lambda s: s.coolant_on, 'the coolant')
                self.grind(0, 'resume')
                grinder().wait_state(GrinderState.RUNNING)
            self.grind(0, 'hold')
            grinder().wait_state(GrinderState.HELD)
            self.grind(0, 'retract')
            grinder().wait_state(GrinderState.RETRACTED)
            command.wait_text('  retracted  ')
            self.grind(0, 'cancel')
            self.assertIn('flutes complete', self.grind(0, 'plan', PAPER_JOB).stdout)
        self.assertEqual(command.end(), 1, command.text)
        for state in ('running', 'held', 'retracted'):
            self.assertIn('  %s  tooth 1/1  pass 1/1  X ' % state, command.text)
        self.assertRegex(self.grind(0, 'status').stdout, r'(?m)^it ended +canceled; stopped on the path \(stroke, tooth 1, pass 1,')

    def test_dry_run_reports_what_plan_reports_and_output_that_cannot_be_printed_is_no_success(self):
        grinder().make_ready_at_park()
        reported = self.grind(0, 'plan', PAPER_JOB).stdout
        self.assertRegex(reported, r'(?m)^setpoints +\d{4}')
        self.assertEqual(self.grind(0, 'run', PAPER_JOB, '--dry-run').stdout, reported)
        for arguments in (['status'], ['status', '--json'], ['run', PAPER_JOB, '--dry-run']):
            self.check_not_printed(*arguments)

    def test_probe_with_arguments_that_do_not_belong_together(self):
        for arguments in (['diameter', '--at', '10'], ['diameter', '--job', PAPER_JOB], ['tooth', '--job', PAPER_JOB]):
            self.grind(2, 'probe', *arguments)
