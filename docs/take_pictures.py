#!/usr/bin/env python3
"""Takes the pictures of rviz and its panel in docs/images, from a simulated grinder. After `source scripts/environment` and
`export port`, it is run by `test/rviz/on_screen docs/take_pictures.py`."""

import contextlib
import functools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import rospy
from PIL import ImageGrab

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / 'test/rviz'))

from test_scene import Rviz, gc  # noqa: E402

QUESTIONS = ['discard', 'ignore-offsets', 'confirm-swivel', 'confirm-wheel']
LONGEST = 300  # [s] until a job is where its picture is taken
grind = functools.partial(gc.grind, check=True)


def status():
    return json.loads(grind('status', '--json').stdout)


@contextlib.contextmanager
def launched(*command):
    """A process, until the end of a `with`."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


@contextlib.contextmanager
def rviz_with(job):
    """rviz with a job file in its panel."""
    with tempfile.NamedTemporaryFile('w', suffix='.rviz') as config:
        config.write((ROOT / 'rviz/grinder.rviz').read_text().replace('Job: ""', 'Job: %s' % (ROOT / job)))
        config.flush()
        with launched(gc.program('rviz_with_report'), '-d', config.name, '--disable-anti-aliasing', '__name:=rviz'):
            yield Rviz()
            gc.grind('cancel')  # unless it has ended with its command


def start(rviz):
    """Plans and starts the panel's job, and answers what is asked."""
    def can_click(name):
        return rviz.buttons().get(name, [0])[0]

    gc.poll(lambda: can_click('plan'), 'the job')
    rviz.operate('click plan')
    gc.poll(lambda: can_click('start'), 'the plan')

    def runs():
        for button in rviz.buttons().keys() & set(QUESTIONS) or ['start']:
            if can_click(button):
                rviz.operate('click ' + button)
        return status()['state'] == 'running'

    gc.poll(runs, 'the start')


def hold_in(tooth, number, x):
    """Holds the running job in a pass of a tooth, where the wheel has come to X [mm] in the work."""
    def is_there():
        now = status()
        return (now['tooth'], now['pass']) == (tooth, number) and now['wheel_in_work'] and now['work']['x_mm'] > x

    gc.poll(is_there, 'tooth %d, pass %d' % (tooth, number), timeout=LONGEST)
    grind('hold')


def take(rviz, name, part):
    """Keeps a picture of the window, of the view in it, or of the panel."""
    rviz.wait_frames(30)  # until the cutter is as it is ground: it is shown once in some seconds
    x, y, width, height = rviz.numbers('view')
    _, _, right, bottom = rviz.numbers('window')
    box = {'window': (0, 0, right, bottom), 'view': (x, y, x + width, y + height),
           'panel': (x + width + 25, y + 20, right, bottom - 30)}[part]
    ImageGrab.grab(xdisplay=os.environ['DISPLAY']).crop(box).save(ROOT / 'docs/images' / (name + '.png'), optimize=True)


def take_all():
    with rviz_with('jobs/paper.yaml') as rviz:
        start(rviz)
        hold_in(1, 1, 26)
        take(rviz, 'one_tooth', 'window')
        take(rviz, 'panel', 'panel')
        rviz.operate('tab Jog')
        take(rviz, 'panel_jog', 'panel')
    with rviz_with('jobs/unequal_d12_t4.yaml') as rviz:
        start(rviz)
        hold_in(4, 1, 5)
        rviz.operate('tab Section')
        take(rviz, 'panel_section', 'panel')
        rviz.operate('tab View')
        take(rviz, 'rviz', 'window')
    mill, answers = 'jobs/end_mill_d10_t4.yaml', [word for question in QUESTIONS for word in ('--answer', question)]
    with rviz_with(mill) as rviz, launched(gc.program('grind'), 'run', str(ROOT / mill), '--operation', 'secondary', *answers):
        hold_in(4, 5, 10)
        take(rviz, 'mill', 'view')


def main():
    with tempfile.TemporaryDirectory() as folder, launched('roslaunch', '-p', os.environ['port'], 'flute_grinder', 'grinder.launch',
                                                           'journal:=%s/journal' % folder):
        gc.poll(lambda: gc.grind('status').returncode == 0, 'the grinder')
        rospy.init_node('pictures')
        grind('enable')
        take_all()


if __name__ == '__main__':
    main()
