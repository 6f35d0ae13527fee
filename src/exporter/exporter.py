#!@PYTHON_EXECUTABLE@
"""Shows one grinder to Prometheus; see docs/shop.md. It reads topics and files, and has no way to ask the grinder for anything.

It is not a ROS node. A node of rospy has two logging services and an XML-RPC server, even with disable_rosout, and hears nothing
more after a restart of the master. This program asks the master for the grinder's address, and the grinder for its topics, and
repeats this whenever a connection ends. It registers nothing, and listens only on the port for Prometheus."""

import argparse
import copy
import functools
import json
import math
import os
import pathlib
import re
import shutil
import socket
import stat
import struct
import subprocess
import sys
import tempfile
import threading
import time
import xmlrpc.client

import prometheus_client
import rosgraph
from diagnostic_msgs.msg import DiagnosticArray
from flute_grinder import job
from flute_grinder.msg import GrindActionFeedback, GrinderState, Reason
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, InfoMetricFamily

CALLER = '/flute_grinder_exporter'  # name given to the master and the grinder; not a node
SILENCE = 5  # [s] of silence after which a peer that sends ten times a second counts as lost
WINDOW = 60  # [s] over which the worst figure is shown: longer than the time between two scrapes
LONGEST = 1 << 18  # longest message [bytes]
LOOKED_BACK = 100  # records in which measured figures are looked for
RECORD = re.compile(r'\d{10}_\d{8}T\d{6}\.\d{3}Z\.json')


def constants(kind):
    """The names of a message's constants by their values; of several lists with the same values, the first list."""
    names = {}
    for name, value in vars(kind).items():
        if name.isupper():
            names.setdefault(value, name.lower())
    return names


STATES, REASONS = constants(GrinderState), constants(Reason)
FAULTS = [*range(Reason.POSITION, Reason.INTERLOCK + 1), Reason.SLOW]  # reasons for which the machine stops


def say(what, error):
    """Writes a line to stderr in one piece, because several threads do."""
    sys.stderr.write('%s: %s\n' % (what, error))


def read(stream):
    """The next message of a TCPROS connection, or its header, without the length ahead of it."""
    length = struct.unpack('<I', stream.read(4) or bytes(4))[0]
    if not 0 < length <= LONGEST:
        raise ConnectionError('the connection has ended, or announces %d bytes' % length)
    return stream.read(length)


def messages(node, topic, kind, silence):
    """The messages of a node's topic, until the connection ends. Raises exceptions of many kinds.

    `silence`: longest time without a message [s]; None for no limit."""
    with xmlrpc.client.ServerProxy(rosgraph.Master(CALLER).lookupNode(node)) as server:
        code, text, protocol = server.requestTopic(CALLER, topic, [['TCPROS']])
    if code != 1:
        raise ConnectionError(text)
    with socket.create_connection(tuple(protocol[1:])) as connection, connection.makefile('rb') as stream:
        rosgraph.network.write_ros_handshake_header(connection, {
            'callerid': CALLER, 'topic': topic, 'type': kind._type, 'md5sum': kind._md5sum, 'tcp_nodelay': '1'})
        header = read(stream)
        if b'error=' in header:
            raise ConnectionError(header.decode(errors='replace'))
        connection.settimeout(silence)
        while True:
            yield kind().deserialize(read(stream))


def listen(node, topic, kind, silence, hear):
    """Hands every message of a topic to `hear`, for ever; None whenever the connection has ended."""
    said = ''
    while True:
        try:
            for message in messages(node, topic, kind, silence):
                said = ''
                hear(message)
        # The loop goes on whatever has happened to the node, the master or the connection.
        except Exception as error:
            if str(error) != said:
                say(topic, error)
            said = str(error)
        hear(None)
        time.sleep(1)


def tool_text(cutter):
    """The tool in words, as in `grind history`."""
    teeth = len(cutter.tooth_angles)
    return 'D %g mm, cone %g deg, spiral %g deg, rake %g deg, %d %s' % (
        cutter.end_diameter * 1e3, *map(math.degrees, (cutter.cone_angle, cutter.spiral_angle, cutter.rake_angle)), teeth,
        'tooth' if teeth == 1 else 'teeth')


def like(value, model):
    """Whether a value from JSON is like a model: an instance of it if it is a type; else with the same keys and types of values.

    Numbers must be finite and not negative."""
    if isinstance(model, type):
        return isinstance(value, model)
    if isinstance(model, dict):
        return isinstance(value, dict) and value.keys() == model.keys() and all(like(value[key], model[key]) for key in model)
    if isinstance(model, str):
        return isinstance(value, str)
    return type(value) in (int, float) and 0 <= value <= sys.float_info.max


def measured_in(record):
    """What was measured of a record's tool [m] or [rad], by job, operation and figure. A record that cannot be read has nothing:
    `grind history` names it."""
    try:
        whole, figures = json.loads(record.read_text(encoding='utf-8')), {}
        head = whole['head']
        for one in whole['body'].get('measured', []):
            value = one['value_mm'] / 1e3 if 'value_mm' in one else math.radians(one['value_deg'])
            figures[str(head['job']), str(head['operation']), '%s@%g' % (one['figure'], one['x_mm'])] = value
        return figures
    except (OSError, ValueError, RecursionError, LookupError, TypeError, AttributeError, ArithmeticError):
        return {}


class Records:
    """The sums over all records of a folder, including records since removed.

    The node removes the oldest records. If the counters fell with them, Prometheus would count all others again. So the sums are
    kept in a file of the same folder, with the names of the records counted."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.file = self.folder / 'exporter.json'
        self.sums = {'jobs': {'done': 0, 'canceled': 0, 'fault': 0}, 'verdicts': {'passed': 0, 'incomplete': 0, 'failed': 0},
                     'tools': 0, 'strokes': 0, 'setpoints': 0, 'seconds': 0, 'wheels': {}}
        self.counted = set()
        self.skipped = set()
        self.bodies = {}  # by name: time of the last change, and what was measured
        try:
            self.sums, self.counted = self.kept()
        except FileNotFoundError:
            pass
        except (OSError, ValueError, RecursionError) as error:
            say(self.file, 'the counters begin with the records that are there: %s' % error)

    def kept(self):
        """The sums in the file, and the names of the records counted."""
        # A FIFO would block its reader.
        if not stat.S_ISREG(self.file.stat().st_mode):
            raise OSError('no regular file')
        kept = json.loads(self.file.read_bytes().decode())
        wheel = {'dressed': '', 'tools': 0, 'wear': 0}
        if not (like(kept, {'sums': dict(self.sums, wheels=dict), 'counted': list})
                and all(like(of_one, wheel) for of_one in kept['sums']['wheels'].values())
                and all(like(name, '') for name in kept['counted'])):
            raise ValueError('not the sums of records')
        return kept['sums'], set(kept['counted'])

    def update(self):
        """Adds the new records."""
        try:
            names = self.names()
        except FileNotFoundError:
            return  # no folder before the first job
        if names <= self.counted:
            return
        entries = list(self.judged(names - self.counted))
        # A record that cannot be read is not tried again.
        self.counted = names
        for entry in entries:
            before = copy.deepcopy(self.sums)
            try:
                self.add(entry)
            # A file with such a name may contain anything.
            except Exception as error:
                self.sums = before
                say(self.folder / entry['name'], 'not counted: %r' % error)
        self.save()

    def measured(self):
        """What was measured last of each figure, by job, operation and figure."""
        names = sorted(self.counted)[-LOOKED_BACK:]
        self.bodies = {name: body for name, body in self.bodies.items() if name in names}
        figures = {}
        for name in names:
            file = self.folder / name
            try:
                changed = file.stat().st_mtime_ns
            except OSError:
                continue
            # A figure is entered long after the record was counted.
            if self.bodies.get(name, [None])[0] != changed:
                self.bodies[name] = changed, measured_in(file)
            figures.update(self.bodies[name][1])
        return figures

    def names(self):
        """The names of the records. Reports each skipped file once."""
        named = [file for file in os.scandir(str(self.folder)) if RECORD.fullmatch(file.name)]
        names = {file.name for file in named if file.is_file(follow_symlinks=False)}
        others = {file.name for file in named} - names
        for name in sorted(others - self.skipped):
            say(self.folder / name, 'skipped: named like a record, but not a regular file')
        self.skipped = others
        return names

    def judged(self, names):
        """The entries of `grind history` for records, the oldest first."""
        with tempfile.TemporaryDirectory() as folder:
            for name in names:
                try:
                    shutil.copy(str(self.folder / name), folder)
                except OSError as error:
                    say(self.folder / name, 'not counted: %s' % error)
            listed = subprocess.run([str(job.GRIND), 'history', '--from', folder, '--json'], stdout=subprocess.PIPE)
            for entry in json.loads(listed.stdout.decode()):
                yield dict(entry, name=pathlib.Path(entry['file']).name)

    def add(self, entry):
        sums = self.sums
        sums['jobs'][entry['outcome']] += 1
        sums['verdicts'][entry['verdict']] += 1
        sums['tools'] += entry['outcome'] == 'done' and entry['ends_tool']
        sums['strokes'] += entry['strokes']
        sums['setpoints'] += entry['setpoints']
        sums['seconds'] += entry['duration_s']
        self.add_wheel(entry['wheel'], entry['dressed'], entry['wear_mm'] / 1e3, entry['outcome'] == 'done')

    def add_wheel(self, name, dressed, wear, done):
        wheels = self.sums['wheels']
        if wheels.get(name, {}).get('dressed') != dressed:
            wheels[name] = {'dressed': dressed, 'tools': 0}
        wheels[name]['tools'] += done
        wheels[name]['wear'] = wear

    def save(self):
        new = self.file.with_suffix('.new')
        try:
            # Removes a file that a power failure left, or anything else of this name, such as a FIFO, which must not be opened.
            if os.path.lexists(str(new)):
                new.unlink()
            with new.open('x') as file:
                json.dump({'sums': self.sums, 'counted': sorted(self.counted)}, file)
                file.flush()
                os.fsync(file.fileno())
            new.replace(self.file)
        except OSError as error:
            say(self.file, 'the counters may fall with the next start: %s' % error)


def metric(kind, name, text, values, label=None):
    """A metric of one value, or of one for each value of a label."""
    family = kind('flute_grinder_' + name, text, labels=[label] if label else [])
    for key, value in values.items() if label else [('', values)]:
        family.add_metric([key] if label else [], value)
    return family


gauge, counter = (functools.partial(metric, kind) for kind in (GaugeMetricFamily, CounterMetricFamily))


class Grinder:
    """The known state of a grinder; a collector of Prometheus' client."""

    def __init__(self, records):
        self.records = records
        self.scraping = threading.Lock()
        self.state = None
        self.progress = -SILENCE, 0  # time, and fraction of the job
        self.reports = ()  # time, and {(status, key): figure}; the key 'level' is the status itself
        self.cycles = self.late = 0
        self.measured = {}
        self.faults = {REASONS[kind]: 0 for kind in FAULTS}  # 0 first, or Prometheus would not count the first

    def hear_state(self, message):
        before, self.state = self.state, message
        if before and message and before.state != message.state == GrinderState.FAULT:
            reason = REASONS[message.fault_reason.kind]
            self.faults[reason] = self.faults.get(reason, 0) + 1

    def hear_feedback(self, message):
        if message:
            self.progress = time.monotonic(), message.feedback.job_fraction

    def hear_diagnostics(self, message):
        if not message:
            return
        now, report = time.monotonic(), {}
        for status in message.status:
            name = status.name.split(': ')[-1]  # name without the node's
            report[name, 'level'] = status.level
            report.update(((name, item.key), item.value) for item in status.values)
        self.reports = tuple(kept for kept in self.reports if kept[0] > now - WINDOW) + ((now, report),)
        self.cycles += int(report.get(('Control loop', 'Cycles'), 0))
        self.late += int(report.get(('Control loop', 'Late cycles'), 0))

    def collect(self):
        with self.scraping:
            try:
                self.records.update()
            except (OSError, ValueError) as error:
                say(self.records.folder, error)
            self.measured = self.records.measured()
        state = self.state
        yield gauge('up', 'Whether the grinder says its state', state is not None)
        if state:
            yield from self.of_state(state)
        yield from self.of_reports()
        yield from self.of_records()

    def of_state(self, state):
        yield gauge('state', 'What the grinder is doing', {name: value == state.state for value, name in STATES.items()}, 'state')
        progress = state.progress
        if progress.job_digest:
            yield InfoMetricFamily('flute_grinder_job', 'The running job, or the last one', value={
                'job': progress.job_name, 'operation': progress.operation, 'tool': tool_text(progress.cutter)})
        when, fraction = self.progress
        if time.monotonic() < when + SILENCE:
            yield gauge('job_progress_ratio', 'What is done of the running job, by time', fraction)
        yield gauge('feed_meters_per_second', 'Feed along the edge', state.feed)
        yield gauge('feed_override_ratio', 'Override of the feed', state.override)
        yield gauge('spindle_commanded', 'Whether the spindle is to turn', state.spindle_commanded)
        yield gauge('spindle_at_speed', 'Whether it does', state.spindle_at_speed)

    def of_reports(self):
        yield counter('faults', 'Changes to the state fault, since the start of the exporter', self.faults, 'reason')
        yield counter('cycles', 'Control cycles, since the start of the exporter', self.cycles)
        yield counter('late_cycles', 'Those after more than 1.5 periods', self.late)
        reports = [report for when, report in self.reports if when > time.monotonic() - WINDOW]
        if not reports:
            return

        def worst(status, key):
            figures = [float(report[status, key]) for report in reports if (status, key) in report]
            return max(figures) if figures and not any(map(math.isnan, figures)) else math.nan

        yield gauge('diagnostics_level', 'Worst level of a status in the last minute: 0 OK, 1 WARN, 2 ERROR',
                    {status.lower().replace(' ', '_'): worst(status, 'level') for status, _ in sorted(set().union(*reports))},
                    'status')
        yield gauge('cycle_period_nominal_seconds', 'Control period', worst('Control loop', 'Nominal period [s]'))
        yield gauge('cycle_period_max_seconds', 'Longest of the last minute', worst('Control loop', 'Longest period [s]'))
        yield gauge('wakeup_delay_max_seconds', 'Longest of the last minute', worst('Control loop', 'Longest wake-up delay [s]'))
        for axes, unit, name in (('xyz', 'm', 'meters'), ('a', 'rad', 'radians')):
            yield gauge('following_error_max_' + name, 'Largest of the last minute',
                        {axis: worst('Following error', 'axis_%s max [%s]' % (axis, unit)) for axis in axes}, 'axis')
        yield gauge('following_error_max_ratio', 'The same, of the allowed',
                    {axis: worst('Following error', 'axis_%s of the allowed [%%]' % axis) / 100 for axis in 'xyza'}, 'axis')

    def of_records(self):
        sums, folder = self.records.sums, self.records.folder
        yield counter('jobs', 'Jobs that moved, by how they ended', sums['jobs'], 'outcome')
        yield counter('verdicts', 'The same, by the verdict of `grind history`', sums['verdicts'], 'verdict')
        yield counter('tools', 'Tools whose last operation was ground to its end', sums['tools'])
        yield counter('strokes', 'Strokes ground to their end', sums['strokes'])
        yield counter('setpoints', 'Setpoints of jobs, written to the drive', sums['setpoints'])
        yield counter('job_duration_seconds', 'Duration of the jobs, holds included', sums['seconds'])
        wheels = sums['wheels']
        yield gauge('wheel_wear_meters', 'Wear of the radius with which the last job began',
                    {name: wheel['wear'] for name, wheel in wheels.items()}, 'wheel')
        yield gauge('wheel_tools_since_dressing', 'Tools ground to their end since the wheel was dressed, or first used',
                    {name: wheel['tools'] for name, wheel in wheels.items()}, 'wheel')
        measured = GaugeMetricFamily('flute_grinder_measured', 'Last measured of a tool: length [m] or angle [rad]',
                                     labels=['job', 'operation', 'figure'])
        for labels, value in self.measured.items():
            measured.add_metric(labels, value)
        yield measured
        if os.path.isdir(str(folder)):
            disk = os.statvfs(str(folder))
            yield gauge('records_free_bytes', 'Free on the disk of the records', disk.f_bavail * disk.f_frsize)


def address(text):
    host, _, port = text.rpartition(':')
    if not host or not port.isdigit() or not 0 < int(port) < 65536:
        raise argparse.ArgumentTypeError('%r; allowed: ADDRESS:PORT, such as 127.0.0.1:9840' % text)
    return host.strip('[]'), int(port)


def arguments():
    parser = argparse.ArgumentParser(prog='exporter', description='Shows one grinder to Prometheus.')
    parser.add_argument('--listen', metavar='ADDRESS:PORT', type=address, default='127.0.0.1:9840',
                        help='where Prometheus finds it; default: %(default)s, for this computer alone')
    parser.add_argument('--node', metavar='NAME', default='grinder', help="the grinder's node; default: %(default)s")
    parser.add_argument('--history', metavar='DIR', help='the folder of its records; default: as `grind history` has it')
    return parser.parse_args()


def main():
    given = arguments()
    os.nice(10)  # the grinder's own programs come first
    # Timeout of all requests, and of a client of Prometheus' port that sends nothing.
    socket.setdefaulttimeout(SILENCE)
    node = rosgraph.names.script_resolve_name('exporter', given.node)
    home = os.environ.get('ROS_HOME') or os.path.expanduser('~/.ros')
    grinder = Grinder(Records(given.history or home + '/flute_grinder/history' + node))
    for topic, kind, silence, hear in ((node + '/state', GrinderState, SILENCE, grinder.hear_state),
                                       (node + '/grind/feedback', GrindActionFeedback, None, grinder.hear_feedback),
                                       ('/diagnostics', DiagnosticArray, None, grinder.hear_diagnostics)):
        threading.Thread(target=listen, args=(node, topic, kind, silence, hear), daemon=True).start()
    registry = prometheus_client.CollectorRegistry()
    registry.register(grinder)
    # The first look at a full folder takes longer than Prometheus waits.
    prometheus_client.generate_latest(registry)
    try:
        prometheus_client.start_http_server(given.listen[1], given.listen[0], registry)
    except OSError as error:
        sys.exit('listen = %s:%d: %s; allowed: an address of this computer and a free port' % (*given.listen, error.strerror))
    try:
        threading.Event().wait()
    except KeyboardInterrupt:
        pass


if __name__ == '__main__':
    main()
