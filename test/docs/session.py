"""A reader at the keyboard: types a page's commands in a scratch copy of the clone, with a home and a master of their own, before
the screen that DISPLAY names."""

import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'test'))

from free_port import free_port  # noqa: E402

# Much longer than any command takes, even on a host that stalls.
PATIENCE = 600
TYPED = 'rosrun flute_grinder grind '
GRIND = str(ROOT / 'build/devel/lib/flute_grinder/grind') + ' '
# States that pass by themselves.
PASSING = {'starting', 'holding', 'retracting', 'resuming', 'canceling', 'homing', 'lifting'}


class Failure(Exception):
    pass


def poll(condition, what, interval=0.1):
    deadline = time.monotonic() + PATIENCE
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            raise Failure('timed out waiting for: ' + what)
        time.sleep(interval)


def stem(name):
    """Of a node's name, without what roslaunch adds to an anonymous one: computer, process and a random number."""
    return re.sub(r'_[A-Za-z0-9_]+_\d+_\d+$', '', name)


class Session:
    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.clone, self.home = self.folder / 'clone', self.folder / 'home'
        self.home.mkdir()
        self.clone.mkdir()
        for entry in ROOT.iterdir():
            if not entry.name.startswith('.'):
                (self.clone / entry.name).symlink_to(entry)
        (self.folder / 'cwd').write_text(str(self.clone))
        (self.folder / 'env').write_text('')
        self.master = 'http://127.0.0.1:%d' % free_port()
        kept = {name: value for name, value in os.environ.items() if name.startswith('RTAPI_')}
        self.environment = dict(kept, HOME=str(self.home), PATH='/usr/bin:/bin:/usr/sbin:/sbin', LANG='C.UTF-8',
                                DISPLAY=os.environ['DISPLAY'], LIBGL_ALWAYS_SOFTWARE='1', LP_NUM_THREADS='1',
                                ROS_MASTER_URI=self.master, ROS_IP='127.0.0.1')
        self.in_hal = 'INSIDE_HAL' in os.environ
        self.launched = []
        self.outputs = {}
        self.found = False  # whether rosrun has been asked for grind

    def _start(self, command, log, keep=False):
        """A command in a shell that knows what those before it have set and, with `keep`, hands it on. Where rosrun has found grind
        once, it looks no more, which takes seconds."""
        if self.found:
            command = command.replace(TYPED, GRIND)
        self.found |= TYPED in command
        script = 'cd "$(cat %(f)s/cwd)"; . %(f)s/env; %(c)s\n' % {'f': self.folder, 'c': command}
        if keep:
            script += 'status=$?; declare -px >%(f)s/env; pwd >%(f)s/cwd; exit $status\n' % {'f': self.folder}
        else:
            script = script.replace('; %s\n' % command, '; exec %s\n' % command)
        with open(log, 'w') as output:
            return subprocess.Popen(['bash', '-c', script], env=self.environment, stdin=subprocess.DEVNULL, stdout=output,
                                    stderr=subprocess.STDOUT, start_new_session=True)

    def _end(self, process, log, command, status):
        try:
            process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            raise Failure('%s: does not end\n%s' % (command, log.read_text()))
        if process.returncode != status:
            raise Failure('%s: status %d, not %d\n%s' % (command, process.returncode, status, log.read_text()))

    def type(self, command, status=0):
        """Types a command and waits for its end; what is launched goes on, and is waited for until its nodes are there."""
        if re.match(r'roslaunch (?!--)', command):
            return self.launch(command)
        log = self.folder / 'output'
        self._end(self._start(command, log, keep=True), log, command, status)
        self.outputs[command] = log.read_text()
        if self.in_hal and command.startswith('halcmd -f'):
            # A host that stalls is not to end a test.
            self.type('halcmd setp watchdog.timeout-0 1000')
        pressed = re.fullmatch('halcmd sets emergency-stop (true|false)', command)
        if pressed:
            # The node sees it with its next cycle.
            seen = 'emergency stop +' + {'true': 'pressed', 'false': 'released'}[pressed.group(1)]
            poll(lambda: re.search(seen, self.grind('status')), seen)

    def grind(self, arguments, node=''):
        """What a command prints that no page asks for."""
        command = GRIND + ' '.join([node, arguments])
        self.type(command)
        return self.outputs[command]

    def state(self, node=''):
        return re.search(r'(?m)^state +(\w+)', self.grind('status', node)).group(1)

    def patient(self, command):
        """A launch with its machine, be it as shipped or the page's own, on a host that may stall."""
        own = re.search(r' config:=(\S+)', command)
        config = pathlib.Path(own.group(1).replace('$HOME', str(self.home))) if own else ROOT / 'config/grinder.yaml'
        path = self.folder / ('machine_%d.yaml' % len(self.launched))
        path.write_text(re.sub(r'(?m)^(late_cycle|jog_timeout):.*', '', config.read_text()) + (ROOT / 'test/patient.yaml').read_text())
        command = command.replace(own.group(), '') if own else command
        if self.in_hal:
            command += ' hal_config:=%s' % (ROOT / 'test/hal/patient.yaml')
        return command + ' config:=%s' % path

    def launch(self, command):
        self.type(command.replace('roslaunch', 'roslaunch --nodes', 1))
        nodes = self.outputs[command.replace('roslaunch', 'roslaunch --nodes', 1)].split()
        grinders = [node for node in nodes if node.endswith('/grinder')]
        command = self.patient(command)
        log = self.folder / ('launched_%d' % len(self.launched))
        process = self._start(command, log)
        self.launched.append((command, process, log))

        def there():
            if process.poll() is not None:
                raise Failure('%s: has ended\n%s' % (command, log.read_text()))
            try:
                master = xmlrpc.client.ServerProxy(self.master)
                known = {stem(name) for kind in master.getSystemState('/test')[2] for _, names in kind for name in names}
                return ({stem(node) for node in nodes} <= known and
                        all(master.lookupService('/test', node + '/set_offsets')[0] == 1 for node in grinders))
            except OSError:
                return False

        poll(there, 'nodes of ' + command)

    def type_while(self, other, commands, broken_off=False):
        """Types commands while another runs: once its job is under way, and each when the state before has passed. Then waits
        for its end, or breaks it off."""
        node = ' '.join(re.findall(r'--node \S+', other))
        log = self.folder / 'other'

        def under_way():
            if process.poll() is not None:
                raise Failure('%s: has ended too early\n%s' % (other, log.read_text()))
            return self.state(node) == 'running'

        canceled = broken_off or commands[-1:] and commands[-1].endswith(' cancel')
        # The job is to last as long as the typing takes, however slow the host is.
        self.grind('override 4', node)
        process = self._start(other, log)
        try:
            poll(under_way, 'the job of ' + other)
            for command in commands:
                self.type(command)
                if ' override ' in command:
                    self.grind('override 4', node)
                poll(lambda: self.state(node) not in PASSING, 'the end of a passing state')
            if broken_off:
                process.send_signal(signal.SIGINT)
            self.grind('override 100', node)
            self._end(process, log, other, 1 if canceled else 0)
            self.outputs[other] = log.read_text()
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                process.wait()

    def end_launched(self):
        """Ctrl-C wherever something was launched, the last first."""
        while self.launched:
            command, process, log = self.launched.pop()
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
            self._end(process, log, command, 0)

    def close(self):
        for _, process, _ in self.launched:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
                process.wait()
        shutil.rmtree(self.folder)


def missing_line(expected, output):
    """The first line that is expected and does not come in the output, in order; None if all do."""
    lines = iter([' '.join(line.split()) for line in output.splitlines()])
    for line in expected:
        pattern = '.*'.join(re.escape(' '.join(part.split())) for part in line.split('...'))
        if line.strip() != '...' and not any(re.fullmatch(pattern.replace('.*', r'\s?.*'), found) for found in lines):
            return line
    return None
