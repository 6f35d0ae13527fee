#!/usr/bin/env python3
"""All figures of speed and size in one run, each beside its floor on this computer, with a node and a simulated drive of its
own. `scripts/bench` runs it."""

import argparse
import collections
import contextlib
import datetime
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import tempfile
import time
import urllib.parse

import rospy
import yaml
from diagnostic_msgs.msg import DiagnosticArray

import figures
from figures import of_times, of_value

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'test/node'))
import grinder_client as gc  # noqa: E402

BUILD = ROOT / 'build/bench'
PAGE = ROOT / 'docs/performance.md'
NODE = '/grinder'
SIMULATE = 'simulate --operation chamfer jobs/end_mill_d10_t4.yaml'
COMMANDS = ('--version', 'status', 'offsets', 'hold', 'resume', 'cancel', 'lift', 'jog x 1', SIMULATE)
COMMAND_RUNS = 10

REPETITIONS = 9
BENCHMARKS = (r'^(setpointFloor|step/[0-9]|next/[0-9]|cycle|plan/0/real_time|planTool/real_time|checkCutter/[02]|collision|'
              r'planEnd/[0-9]/real_time)$')


def origin():
    """Where the figures are from."""
    def git(*arguments):
        return subprocess.run(['git', '-C', ROOT, *arguments], check=True, stdout=subprocess.PIPE,
                              universal_newlines=True).stdout.strip()

    with open('/proc/cpuinfo') as text:
        cpu = re.search(r'(?m)^model name\s*: (.*)$', text.read())
    return {'commit': git('rev-parse', '--short', 'HEAD') + (' with changes' if git('status', '--porcelain') else ''),
            'date': datetime.datetime.now(datetime.timezone.utc).strftime('%Y-%m-%d %H:%M UTC'),
            'cpu': cpu.group(1) if cpu else platform.machine(), 'cores': os.cpu_count(),
            'kernel': platform.release()}


def run_benchmarks():
    """Those of Google Benchmark, by name; times in s, each the median of some repetitions."""
    with tempfile.NamedTemporaryFile(suffix='.json') as out, open(ROOT / 'build/bench_grinder.log', 'w') as log:
        subprocess.run([BUILD / 'bench_grinder', '--benchmark_filter=' + BENCHMARKS, '--benchmark_min_time=0.1',
                        '--benchmark_repetitions=%d' % REPETITIONS, '--benchmark_report_aggregates_only=true',
                        # What else the computer does comes to the floor and to what stands on it alike.
                        '--benchmark_enable_random_interleaving=true',
                        '--benchmark_out=' + out.name, '--benchmark_out_format=json'],
                       check=True, stdout=log, stderr=log)
        found = json.load(out)['benchmarks']
    return {b['run_name']: b for b in found if b.get('aggregate_name') == 'median'}


def of_benchmarks():
    """What steps, setpoints, plans and cycles cost by themselves, each as fast as it goes."""
    found = run_benchmarks()

    def time(name):
        benchmark = found[name]
        if benchmark.get('error_occurred'):
            raise RuntimeError('%s: %s' % (name, benchmark['error_message']))
        clock = 'real_time' if name.endswith('real_time') else 'cpu_time'
        return benchmark[clock] / figures.FACTORS[benchmark['time_unit']]

    def per_item(name):
        return 1e9 / found[name]['items_per_second']

    yield 'setpoint_floor', of_value('log1p + sqrt + division, dependent', 'ns', 1e9 * time('setpointFloor'))
    for kind, label in ('step', 'odd or even step'), ('next', 'setpoint of the stream'):
        for i in range(3):
            name = '%s/%d' % (kind, i)
            yield name, of_value('%s, %s' % (label, found[name]['label']), 'ns', per_item(name), 'setpoint_floor')
    yield 'cycle', of_value('control cycle, hot', 'ns', per_item('cycle'), 'setpoint_floor')
    yield 'plan/paper', of_value("plan, the paper's job", 'ms', 1e3 * time('plan/0/real_time'))
    tool = 'planTool/real_time'
    yield 'plan/tool', of_value('plan, whole tool of %.1f M setpoints' % (found[tool]['setpoints'] / 1e6), 'ms',
                                1e3 * time(tool))
    yield 'plan/setpoint', of_value('plan, whole tool, per setpoint', 'ns', per_item(tool), 'setpoint_floor')
    yield 'check_cutter', of_value("check of the ground cutter, the paper's job", 'ms', 1e3 * time('checkCutter/0'))
    yield 'check_reliefs', of_value("check of the ground cutter, the reamer's with both reliefs", 'ms', 1e3 * time('checkCutter/2'))
    yield 'collision', of_value("check for collisions, the paper's job", 'ms', 1e3 * time('collision'))
    for i in range(4):
        name = 'planEnd/%d/real_time' % i
        yield 'plan/' + found[name]['label'], of_value("plan with all checks, the end mill's %s" % found[name]['label'], 'ms',
                                                       1e3 * time(name))


@contextlib.contextmanager
def process(command, log):
    """Runs a program meanwhile."""
    with open(ROOT / 'build' / log, 'w') as output:
        running = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT)
    try:
        yield
    finally:
        running.terminate()
        running.wait()


@contextlib.contextmanager
def grinder():
    """A master and a node with the simulated drive, as shipped but for two things: no spindle that has to run up, and stalls
    of this computer are no fault."""
    port = urllib.parse.urlparse(os.environ['ROS_MASTER_URI']).port
    parameters = gc.machine()
    parameters['hardware']['spindle_run_up_time'] = 0.0
    with tempfile.TemporaryDirectory(dir=ROOT / 'build') as folder:
        config = os.path.join(folder, 'machine.yaml')
        with open(config, 'w') as file:
            yaml.safe_dump(parameters, file)
        with process(['roslaunch', '-p', str(port), 'flute_grinder', 'grinder.launch', 'config:=' + config,
                      'journal:=' + folder + '/'], 'roslaunch.log'):
            yield


def seconds(command):
    begin = time.monotonic()
    subprocess.run([gc.program('grind'), *command.split()], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.monotonic() - begin


def of_commands():
    """How long a command of `grind` takes, of a grinder without power, which refuses most."""
    seconds('status')  # waits for the grinder
    for command in COMMANDS:
        times = [seconds(command) for _ in range(COMMAND_RUNS)]
        floor = 'command/--version' if command != '--version' else None
        yield 'command/' + command, of_times('`grind %s`' % command, 'ms', times, floor)


def of_rest():
    """What the node takes of the computer at rest."""
    found = json.loads(subprocess.run([sys.executable, ROOT / 'bench/bench_rest.py', NODE, '--json'], check=True,
                                      stdout=subprocess.PIPE).stdout)
    for key, name in (('resident', 'resident memory'), ('locked', 'address space marked as locked')):
        yield 'rest/' + key, of_value('node at rest, ' + name, 'MB', found[key] / 1e6)
    yield 'rest/wake_ups', of_value("the loop's wake-ups alone", '% of a core', 100 * found['wake_ups_alone']['processor'])
    shares = [found[threads]['processor'] for threads in ('loop', 'rest')]
    yield 'rest/processor', of_value('node at rest, all threads', '% of a core', 100 * sum(shares), 'rest/wake_ups')


class LoopDiagnostics:
    """What the node says of its control loop meanwhile, once a second."""

    def __init__(self):
        rospy.init_node('bench', anonymous=True, disable_signals=True)
        self._values = collections.defaultdict(list)
        self._subscriber = rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_message)

    def _on_message(self, message):
        for status in message.status:
            if status.name.endswith(': Control loop'):
                for value in status.values:
                    self._values[value.key].append(value.value)

    def figures(self):
        return figures.of_diagnostics(dict(self._values), {'wake-up delay': 'wake_up', 'cycle duration': 'cycle'})


def measure_goals(goals, seconds):
    server = [BUILD / 'bench_goal', '--server', '__name:=bench_floor']
    with process(server, 'bench_floor.log'):
        return json.loads(subprocess.run([BUILD / 'bench_goal', NODE, str(goals), str(seconds)], check=True,
                                         stdout=subprocess.PIPE).stdout)


def of_goals(found):
    """What a client waits for, and the goal's size and error."""
    samples, values = found['samples'], found['values']
    yield 'wake_up', of_times('wake-up of a thread that sleeps 1 ms', 'us', samples['wake_up'])
    yield 'loop_deviation', of_times('control cycle, off its period', 'us', samples['loop_deviation'], 'wake_up')
    yield 'empty_action', of_times('empty action, goal to accepted', 'ms', samples['empty_action'])
    for job, label in ('paper', "the paper's job"), ('tool', 'whole tool'):
        for kind in 'new', 'repeated':
            for part, to in ('accepted', 'accepted'), ('motion', 'first motion'):
                name = '%s/%s/%s' % (job, kind, part)
                yield name, of_times('goal to %s, %s, %s' % (to, label, kind), 'ms', samples[name], 'empty_action')
        yield job + '/goal_bytes', of_value('goal, ' + label, 'bytes', values[job + '/goal_bytes'])
        yield job + '/max_odd_error', of_value('maximum error of A, ' + label, 'rad', values[job + '/max_odd_error'])


def measure(goals, seconds):
    """A run. The benchmarks come first, alone; then the node at rest, with commands, and with goals."""
    found = dict(of_benchmarks())
    with grinder():
        commands = dict(of_commands())
        rest = dict(of_rest())
        diagnostics = LoopDiagnostics()
        of_node = measure_goals(goals, seconds)
        found.update(of_goals(of_node))
        found.update(diagnostics.figures())
    found.update(rest)
    found.update(commands)
    return dict(origin(), realtime=of_node['realtime'], figures=found)


def read(path):
    """A run from a file; ends the program if it has none."""
    try:
        with open(path) as file:
            run = json.load(file)
    except (OSError, ValueError) as error:
        sys.exit('%s: %s' % (path, error))
    if not isinstance(run, dict) or 'figures' not in run:
        sys.exit('%s: not written by scripts/bench --json' % path)
    return run


def main():
    parser = argparse.ArgumentParser(prog='scripts/bench', description='Measures what the documentation states of speed and '
                                     'size, each figure beside its floor on this computer.')
    parser.add_argument('--json', metavar='FILE', help='write the figures to a file')
    parser.add_argument('--before', metavar='FILE', help='print them beside those of an earlier --json FILE')
    parser.add_argument('--from', metavar='FILE', dest='source', help='take them from a file instead of measuring')
    parser.add_argument('--docs', action='store_true', help='write the table into docs/performance.md')
    parser.add_argument('--goals', metavar='N', type=int, default=100, help='of each kind (default 100)')
    parser.add_argument('--seconds', metavar='S', type=float, default=30, help='longest time for them (default 30)')
    arguments = parser.parse_args()
    before = read(arguments.before) if arguments.before else None
    try:
        if arguments.json:
            open(arguments.json, 'a').close()  # minutes later it would be too late to say that it cannot be written
        run = read(arguments.source) if arguments.source else measure(arguments.goals, arguments.seconds)
        if arguments.json:
            pathlib.Path(arguments.json).write_text(json.dumps(run, indent=2) + '\n')
    except (OSError, RuntimeError, subprocess.CalledProcessError) as error:
        sys.exit(str(error))
    if arguments.docs:
        PAGE.write_text(figures.with_table(PAGE.read_text(), run))
    print(figures.text(run, before))


if __name__ == '__main__':
    main()
