"""Shows that the client on the page docs/ros-interface.md runs a job, with the goal that `grind run` sends for its file, and says what
came of it."""

import io
import pathlib
import re
import subprocess
import sys

import rospy
from flute_grinder.msg import GrindActionGoal

import grinder_client as gc
from grind_command import CommandLine
from grinder_client import grinder

sys.path.append(gc.package_file('test/docs'))

from pages import read_page, write_file  # noqa: E402


class TestClient(CommandLine):
    def run_client(self, job):
        return subprocess.run([sys.executable, self.path('client.py'), job], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=gc.PATIENCE)

    def bits_of_job(self, **fields):
        """Of the goal whose job was the last to start, with other values."""
        goal = rospy.wait_for_message('/grinder/job', GrindActionGoal, gc.PATIENCE).goal
        for name, value in fields.items():
            setattr(goal, name, value)
        bits = io.BytesIO()
        goal.serialize(bits)
        return bits.getvalue()

    def test_client_grinds_a_job_with_the_goal_of_grind_run_and_says_why_one_is_refused(self):
        page = pathlib.Path(gc.package_file('docs/ros-interface.md')).read_text()
        client, = [item for item in read_page(page) if item.kind == 'file']
        write_file(pathlib.Path(self.path('client.py')), client.lines)
        grinder().make_ready()
        job = gc.job_file(self.path('short.yaml'), flute_length_mm=3, feed_mm_min=3000, clearance_mm=1, teeth=2)
        self.grind(0, 'run', job, '--answer', 'discard', '--answer', 'ignore-offsets')
        of_run = self.bits_of_job(answers=['ignore-offsets'], sent_by='')
        seen = len(grinder().batches)
        self.assertTrue(grinder().set_feed_override(0.05).success)  # before it is over, something is to be heard of it
        done = self.run_client(job)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.bits_of_job(), of_run)
        setpoints = sum(len(batch.setpoints) for batch in grinder().batches_of_goal(seen))
        *shown, last = done.stdout.splitlines()
        self.assertEqual(last, 'done: %d setpoints' % setpoints)
        self.assertTrue([line for line in shown if re.fullmatch(r'running, tooth [12], pass 1: \d+ %', line)], done.stdout)
        done = self.run_client(gc.job_file(self.path('long.yaml'), flute_length_mm=400))
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn('axis X machine position 401 mm is 101 mm beyond its limit', done.stdout.splitlines()[-1])
