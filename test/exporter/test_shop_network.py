#!/usr/bin/env python3
"""Shows a shop over a network: three grinders, each with a master and an exporter in a network namespace of its own, and one
Prometheus that scrapes them all. Its counters are those of the records; no job notices when exporter, link or master fails, and
the counters are right again afterwards, also after the end of the grinder's program. Without --listen, no other computer reaches
an exporter. The exit status is 77 where no namespace may be made, or without Prometheus."""

import datetime
import json
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import unittest
import urllib.parse
import urllib.request

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'test/node'))

import grinder_client as gc  # noqa: E402
import record_files  # noqa: E402
from grind_command import Command  # noqa: E402

PORT = 9840
SHORT, LONG = 3000, 100  # feeds [mm/min] of a job of 3 s, and of one of 11 s, in which things fail and come back
COUNTERS = '{__name__=~"flute_grinder_(jobs|tools|strokes|setpoints|job_duration_seconds)_total"}'


def ip(arguments):
    subprocess.run(['ip', *arguments.split()], check=True)


class Computer:
    """The PC of a grinder, in a network namespace, with a link to the shop's bridge."""

    def __init__(self, test, number):
        self.name = 'grinder%d' % number
        self.address = '10.213.8.%d' % number
        self.instance = '%s:%d' % (self.address, PORT)
        self.folder = test.folder / self.name
        self.history = self.folder / 'history'
        self.inside = ['ip', 'netns', 'exec', self.name]
        self.processes = {}
        test.addCleanup(self.end_all)
        for arguments in ('netns add {0}', 'link add {0} type veth peer name network netns {0}', 'link set {0} master shop up',
                          '-n {0} address add {1}/24 dev network', '-n {0} link set network up', '-n {0} link set lo up'):
            ip(arguments.format(self.name, self.address))
        self.folder.mkdir()
        with (self.folder / 'parameters.yaml').open('w') as file:
            yaml.safe_dump({'robot_description': (ROOT / 'urdf/grinder.urdf').read_text(), 'grinder': dict(gc.machine(), **{
                kept: str(self.folder / kept) for kept in ('journal', 'offsets', 'history')},
                tolerances=gc.package_file('config/tolerances.yaml'))}, file)

    def start(self, name, *command):
        with (self.folder / 'log').open('a') as log:
            self.processes[name] = subprocess.Popen([*self.inside, *command], stdout=log, stderr=subprocess.STDOUT)

    def kill(self, name):
        process = self.processes.pop(name)
        process.kill()
        process.wait()

    def end_all(self):
        for name in list(self.processes):
            self.kill(name)

    def call(self, *command):
        return subprocess.run([*self.inside, *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                              timeout=gc.PATIENCE)

    def succeeds(self, *command):
        return self.call(*command).returncode == 0

    def start_master(self):
        self.start('master', 'rosmaster', '--core')

    def start_grinder(self):
        gc.poll(lambda: self.succeeds('rosparam', 'load', str(self.folder / 'parameters.yaml')), 'the master')
        self.start('grinder', gc.program('grinder'))

    def start_exporter(self, *listen):
        self.start('exporter', gc.program('exporter'), '--history', str(self.history), *listen)

    def listen(self):
        self.start_exporter('--listen', self.instance)

    def run(self, job):
        """A job that moves."""
        for words in (['status'], ['enable'], ['confirm-swivel', '31.769']):
            gc.poll(lambda words=words: self.succeeds(gc.program('grind'), *words), '%s: %s' % (self.name, words))
        command = Command('run', job, '--answer', 'ignore-offsets', prefix=self.inside)
        command.wait_text('  running  ')
        return command

    def records(self):
        return [record_files.read(path) for path in sorted(self.history.glob('*Z.json'))]

    def counts(self):
        """What Prometheus is to have, but for zeros."""
        records = self.records()
        times = [[datetime.datetime.strptime(record[key], '%Y-%m-%dT%H:%M:%S.%fZ') for key in ('started', 'ended')] for record in records]
        counts = {'jobs done': len(records), 'tools': len(records), 'strokes': sum(len(record['strokes']) for record in records),
                  'setpoints': sum(record['setpoints'] for record in records),
                  'job_duration_seconds': round(sum((ended - started).total_seconds() for started, ended in times), 3)}
        return {name: count for name, count in counts.items() if count}


class TestShopNetwork(unittest.TestCase):
    maxDiff = None

    def setUp(self):
        self.folder = pathlib.Path(gc.temp_folder(self.addCleanup))
        # Each computer has a loopback of its own. What is killed leaves its files in the folder.
        os.environ.update(ROS_MASTER_URI='http://127.0.0.1:11311', ROS_IP='127.0.0.1', ROS_HOME=str(self.folder), TMPDIR=str(self.folder))
        # This process has a network and mounts of its own, which end with it, the names of the namespaces too.
        subprocess.run(['mount', '-t', 'tmpfs', 'names', '/run'], check=True)
        for arguments in ('link set lo up', 'link add shop type bridge', 'address add 10.213.8.100/24 dev shop', 'link set shop up'):
            ip(arguments)
        self.computers = [Computer(self, number) for number in (1, 2, 3)]
        for computer in self.computers:
            computer.start_master()
        for computer in self.computers:
            computer.start_grinder()

    def start_prometheus(self):
        config = yaml.safe_load((ROOT / 'monitoring/prometheus.yml').read_text())
        config['global'] = {'scrape_interval': '1s', 'evaluation_interval': '1s'}
        config['rule_files'] = [str(ROOT / 'monitoring/alerts.yml')]
        config['scrape_configs'][0]['static_configs'] = [{'targets': [computer.instance for computer in self.computers]}]
        file = self.folder / 'prometheus.yml'
        file.write_text(yaml.safe_dump(config))
        with (self.folder / 'prometheus.log').open('w') as log:
            prometheus = subprocess.Popen(['prometheus', '--config.file=%s' % file, '--storage.tsdb.path=%s' % (self.folder / 'data'),
                                           '--web.listen-address=127.0.0.1:9090'], stdout=log, stderr=subprocess.STDOUT)
        self.addCleanup(prometheus.wait)
        self.addCleanup(prometheus.kill)

    def query(self, text):
        """[(labels, value)]; empty while Prometheus starts."""
        try:
            with urllib.request.urlopen('http://127.0.0.1:9090/api/v1/query?' + urllib.parse.urlencode({'query': text}),
                                        timeout=gc.PATIENCE) as answer:
                return [(each['metric'], float(each['value'][1])) for each in json.load(answer)['data']['result']]
        except OSError:
            return []

    def wait(self, text, computers, value=1):
        instances = [(computer.instance, value) for computer in computers]
        gc.poll(lambda: sorted((labels['instance'], found) for labels, found in self.query(text)) == instances, text, interval=0.1)

    def counters(self):
        """Those of Prometheus, as Computer.counts has them."""
        found = {computer.instance: {} for computer in self.computers}
        for labels, value in self.query(COUNTERS + ' != 0'):
            name = labels['__name__'][len('flute_grinder_'):-len('_total')]
            found[labels['instance']][' '.join([name, *filter(None, [labels.get('outcome')])])] = round(value, 3)
        return found

    def start_jobs(self, feed, computers):
        """A job on each; returns what is to be checked."""
        job = gc.job_file(str(self.folder / 'job.yaml'), flute_length_mm=10, feed_mm_min=feed, clearance_mm=1)
        started = []
        for computer in computers:
            started.append((computer, len(computer.records()), computer.run(job)))
            self.addCleanup(started[-1][-1].close)
        return started

    def check_jobs(self, started):
        """That all have succeeded, each setpoint of the plan once, and Prometheus has them."""
        for computer, before, command in started:
            self.assertEqual(command.end(), 0, command.text)
            record = gc.poll(lambda: computer.records()[before:], computer.name + "'s record")[0]
            self.assertEqual((record['outcome'], record['holds'], record['overrides'], record['setpoints'], record['lost']),
                             ('done', [], [], record['planned']['setpoints'], 0))
        expected = {computer.instance: computer.counts() for computer in self.computers}
        gc.poll(lambda: self.counters() == expected, 'the counters %s' % expected, interval=0.1)
        # Nor did one fall meanwhile.
        self.assertEqual(self.query('resets(%s[1h]) > 0' % COUNTERS), [])

    def test_shop(self):
        first, second, third = self.computers
        first.start_exporter()
        own = 'import urllib.request; urllib.request.urlopen("http://127.0.0.1:%d/metrics")' % PORT
        gc.poll(lambda: first.succeeds('/usr/bin/python3', '-c', own), 'the exporter')
        with self.assertRaises(ConnectionRefusedError):
            socket.create_connection((first.address, PORT), timeout=gc.PATIENCE)
        first.kill('exporter')

        for computer in self.computers:
            computer.listen()
        self.start_prometheus()
        self.wait('flute_grinder_up', self.computers)
        self.check_jobs(self.start_jobs(SHORT, [first]))

        jobs = self.start_jobs(LONG, self.computers)
        first.kill('exporter')
        ip('link set %s down' % second.name)
        third.kill('master')
        self.wait('up == 0', [first, second], 0)
        self.wait('ALERTS{alertname="GrinderNotReached", alertstate="pending"}', [first, second])
        third.start_master()
        ip('link set %s up' % second.name)
        first.listen()
        self.wait('up', self.computers)
        self.check_jobs(jobs)

        first.kill('grinder')
        self.wait('flute_grinder_up == 0', [first], 0)
        first.start_grinder()
        self.check_jobs(self.start_jobs(SHORT, [first]))


if __name__ == '__main__':
    if sys.argv[1:] != ['inside']:
        if not shutil.which('prometheus'):
            print('prometheus is not installed')
            sys.exit(77)
        unshare = ['unshare', '--net', '--mount'] + ([] if os.getuid() == 0 else ['--map-root-user'])
        if subprocess.run([*unshare, 'true'], stderr=subprocess.STDOUT).returncode != 0:
            sys.exit(77)
        os.execvp('unshare', [*unshare, __file__, 'inside'])
    # By which the test fails, and cleans up.
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: sys.exit(1))
    unittest.main(argv=sys.argv[:1])
