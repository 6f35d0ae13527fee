"""Shows that the exporter follows a grinder over HTTP: its states, a job whose counters are those of its record, a fault, the
exporter's restart, the grinder's end and its return; and that nothing knows of the exporter, which listens on loopback alone."""

import os
import signal
import subprocess
import sys
import unittest
import urllib.request

import rosgraph
import rospy
from flute_grinder.msg import GrinderState
from prometheus_client.parser import text_string_to_metric_families

import grinder_client as gc
import record_files
from grinder_client import MM, MM_MIN

sys.path.insert(0, gc.package_file('test'))

from free_port import free_port  # noqa: E402

JOB = gc.paper(flute_length=8 * MM, feed=80 * MM_MIN, clearance=1 * MM, tooth_angles=[0.0, 2.0], infeed=0.3 * MM)


class TestExporter(unittest.TestCase):
    def setUp(self):
        self.parameters = dict(gc.machine(pace=5), history=os.path.join(gc.temp_folder(self.addCleanup), 'history'))
        self.addCleanup(self.close_node)
        self.port = free_port()
        self.start_exporter()
        self.addCleanup(self.end_exporter)
        self.start_node()

    def start_node(self):
        self.node = gc.NodeProcess('shown', self.parameters)
        self.grinder = self.node.client()

    def close_node(self):
        self.grinder.close()
        self.node.close()

    def start_exporter(self):
        self.exporter = subprocess.Popen([gc.program('exporter'), '--listen', '127.0.0.1:%d' % self.port, '--node', 'shown',
                                          '--history', self.parameters['history']], stderr=subprocess.DEVNULL)

    def end_exporter(self):
        self.exporter.terminate()
        self.exporter.wait(gc.PATIENCE)

    def scrape(self):
        """The values by the names, which have their labels' values behind them; empty while the exporter starts."""
        try:
            with urllib.request.urlopen('http://127.0.0.1:%d/metrics' % self.port, timeout=gc.PATIENCE) as answer:
                text = answer.read().decode()
        except OSError:
            return {}
        return {' '.join([sample.name[len('flute_grinder_'):], *sample.labels.values()]): sample.value
                for family in text_string_to_metric_families(text) for sample in family.samples}

    def wait(self, what, value=1):
        return gc.poll(lambda: [metrics for metrics in [self.scrape()] if metrics.get(what) == value], what)[0]

    def counters(self):
        kinds = ('jobs_total', 'verdicts_total', 'tools_total', 'strokes_total', 'setpoints_total', 'job_duration_seconds_total')
        return {name: value for name, value in self.scrape().items() if name.split()[0] in kinds}

    def check_nobody_knows(self):
        """The master's books name no node but the others, and what listens of the exporter is one port on loopback."""
        books = rosgraph.Master(rospy.get_name()).getSystemState()
        self.assertEqual({node for book in books for _, nodes in book for node in nodes} - {'/rosout'}, {'/shown', rospy.get_name()})
        self.assertEqual(gc.listening(self.exporter.pid), {'127.0.0.1:%d' % self.port})

    def test_follows_the_grinder(self):
        metrics = self.wait('state disabled')
        self.assertEqual((metrics['up'], metrics['state ready'], metrics['jobs_total done']), (1, 0, 0))
        self.check_nobody_knows()
        self.grinder.make_ready(0.2)
        self.wait('state ready')

        run = self.grinder.send(JOB, job_name='two.yaml').wait_in_stroke(1 * MM)
        # In whichever order their connections bring them.
        metrics = gc.poll(lambda: [m for m in [self.scrape()] if m.get('state running') and m.get('job_progress_ratio', 0) > 0],
                          'the running job')[0]
        self.assertLess(metrics['job_progress_ratio'], 1)
        self.assertEqual((metrics['spindle_commanded'], metrics['spindle_at_speed'], metrics['feed_override_ratio']), (1, 1, 0.2))
        self.assertTrue(self.grinder.set_feed_override(1).success)
        self.assertEqual([name for name in metrics if name.startswith('job_info two.yaml')],
                         ['job_info two.yaml  D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 2 teeth'])
        self.assertEqual(run.wait_complete().status, 'SUCCEEDED', run.text)
        metrics = self.wait('jobs_total done')
        name, = [name for name in os.listdir(self.parameters['history']) if name != 'exporter.json']
        record = record_files.read(os.path.join(self.parameters['history'], name))
        self.assertEqual(metrics['setpoints_total'], record['setpoints'])
        self.assertEqual(metrics['strokes_total'], len(record['strokes']))
        self.assertEqual((metrics['tools_total'], metrics['jobs_total fault'], metrics['jobs_total canceled']), (1, 0, 0))
        # Figures of the diagnostics, each after the next report.
        self.wait('cycle_period_nominal_seconds', 0.001)
        gc.poll(lambda: self.scrape()['cycles_total'] > 0 and self.scrape()['following_error_max_ratio x'] > 0, 'diagnostics')

        counters = self.counters()
        self.end_exporter()
        self.start_exporter()
        self.wait('up')
        self.assertEqual(self.counters(), counters)

        self.grinder.inject('drive_fault')
        self.grinder.wait_state(GrinderState.FAULT)
        self.assertEqual(self.wait('state fault')['faults_total drive_fault'], 1)

        self.node.end(signal.SIGKILL)
        metrics = self.wait('up', 0)
        self.assertNotIn('state fault', metrics)
        self.assertEqual(self.counters(), counters)
        self.close_node()
        self.start_node()
        self.wait('state disabled')
        self.assertEqual(self.counters(), counters)
        self.assertIsNone(self.exporter.poll())
