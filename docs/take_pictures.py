#!/usr/bin/env python3
"""Takes the pictures of rviz and its panel in docs/images, from a simulated grinder. After `source scripts/environment` and
`export port`, it is run by `test/rviz/on_screen docs/take_pictures.py`."""

import json
import os
import pathlib
import subprocess
import tempfile
import time

import rospy
from PIL import ImageGrab
from std_srvs.srv import Trigger

ROOT = pathlib.Path(__file__).resolve().parents[1]
IMAGES = ROOT / 'docs/images'
BINARIES = ROOT / 'build/devel/lib/flute_grinder'
PATIENCE = 300  # [s]
QUESTIONS = ['discard', 'ignore-offsets', 'confirm-swivel', 'confirm-wheel']


def poll(condition, what):
    due = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > due:
            raise TimeoutError('timed out waiting for ' + what)
        time.sleep(0.1)


def grind(*arguments):
    return subprocess.run([BINARIES / 'grind', *arguments], check=True, stdout=subprocess.PIPE).stdout.decode()


def status():
    return json.loads(grind('status', '--json'))


class Rviz:
    """rviz with a job file in its panel, until the end of a `with`."""

    def __init__(self, job):
        self._config = tempfile.NamedTemporaryFile('w', suffix='.rviz')
        self._config.write((ROOT / 'rviz/grinder.rviz').read_text().replace('Job: ""', 'Job: %s' % (ROOT / job)))
        self._config.flush()
        self._process = subprocess.Popen([BINARIES / 'rviz_with_report', '-d', self._config.name, '--disable-anti-aliasing',
                                          '__name:=rviz'], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self._services = {name: rospy.ServiceProxy('/rviz/' + name, Trigger) for name in ('report', 'operate', 'look')}

    def __enter__(self):
        self._services['report'].wait_for_service(PATIENCE)
        poll(lambda: self.report('frames') and int(self.report('frames')[0]) > 10, 'frames of rviz')
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait()
        self._config.close()

    def report(self, key):
        lines = self._services['report']().message.splitlines()
        return [line[len(key) + 1:] for line in lines if line.startswith(key + ' ')]

    def can_click(self, name):
        return any(words[:2] == [name, '1'] for words in map(str.split, self.report('button')))

    def operate(self, operation):
        rospy.set_param('/rviz/operation', operation)
        self._services['operate']()
        time.sleep(0.5)

    def click(self, name):
        poll(lambda: self.can_click(name), 'the button ' + name)
        self.operate('click ' + name)

    def start(self):
        """Plans and starts the panel's job, and answers what is asked."""
        self.click('plan')
        poll(lambda: self.can_click('start'), 'the plan')

        def runs():
            seen = {words.split()[0] for words in self.report('button')}
            for button in seen.intersection(QUESTIONS) or ['start']:
                if self.can_click(button):
                    self.operate('click ' + button)
            return status()['state'] == 'running'
        poll(runs, 'the start')

    def take(self, name, part):
        """Keeps a picture of the window, of the view in it, or of the panel."""
        time.sleep(3)  # until the ground cutter is drawn
        x, y, width, height = map(int, self.report('view')[0].split())
        _, _, right, bottom = map(int, self.report('window')[0].split())
        box = {'window': (0, 0, right, bottom), 'view': (x, y, x + width, y + height),
               'panel': (x + width + 25, y + 20, right, bottom - 30)}[part]
        ImageGrab.grab(xdisplay=os.environ['DISPLAY']).crop(box).save(IMAGES / (name + '.png'), optimize=True)


def hold_in(tooth, number, x):
    """Holds the running job in a pass of a tooth, where the wheel has come to X [mm] in the work."""
    def is_there():
        now = status()
        return (now['tooth'], now['pass']) == (tooth, number) and now['wheel_in_work'] and now['work']['x_mm'] > x
    poll(is_there, 'tooth %d, pass %d' % (tooth, number))
    grind('hold')


def take_all():
    with Rviz('jobs/paper.yaml') as rviz:
        rviz.start()
        hold_in(1, 1, 26)
        rviz.take('one_tooth', 'window')
        rviz.take('panel', 'panel')
        rviz.operate('tab Jog')
        rviz.take('panel_jog', 'panel')
        grind('cancel')
    with Rviz('jobs/unequal_d12_t4.yaml') as rviz:
        rviz.start()
        hold_in(4, 1, 5)
        rviz.operate('tab Section')
        rviz.take('panel_section', 'panel')
        rviz.operate('tab View')
        rviz.take('rviz', 'window')
        grind('cancel')
    mill = 'jobs/end_mill_d10_t4.yaml'
    answers = [word for question in QUESTIONS for word in ('--answer', question)]
    with Rviz(mill) as rviz:
        run = subprocess.Popen([BINARIES / 'grind', 'run', ROOT / mill, '--operation', 'secondary', *answers],
                               stdout=subprocess.DEVNULL)
        hold_in(4, 5, 10)
        rviz.take('mill', 'view')
        grind('cancel')
        run.wait()


def main():
    folder = tempfile.TemporaryDirectory()
    launch = subprocess.Popen(['roslaunch', '-p', os.environ['port'], 'flute_grinder', 'grinder.launch',
                               'journal:=%s/journal' % folder.name], stdout=subprocess.DEVNULL)
    try:
        poll(lambda: subprocess.run([BINARIES / 'grind', 'status'], stdout=subprocess.DEVNULL,
                                    stderr=subprocess.DEVNULL).returncode == 0, 'the grinder')
        rospy.init_node('pictures')
        grind('enable')
        take_all()
    finally:
        launch.terminate()
        launch.wait()
        folder.cleanup()


if __name__ == '__main__':
    main()
