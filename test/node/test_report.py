"""Shows that `bag:=true` writes a bag of all setpoints, which Ctrl-C closes, and that `grind report` makes of it, and of
the records, one HTML file whose figures are the job's and whose pictures show its points."""

import datetime
import glob
import html.parser
import json
import os
import pathlib
import re
import signal
import subprocess
import unittest
import xml.etree.ElementTree as xml
import xmlrpc.client

import rosbag
import rosgraph
import rospy
from PIL import Image

import browser
import grinder_client as gc
from bag_files import Bag
from flute_grinder.msg import GrinderState
from grind_command import PAPER_JOB, CommandLine
from grinder_client import DEG, JOINTS, MM, ODD, STROKE, X

PICTURES = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'build', 'screenshots')
SVG = '{http://www.w3.org/2000/svg}'
HREF = '{http://www.w3.org/1999/xlink}href'
UNITS = [MM, MM, MM, DEG]

# Pictures of each kind of file, in order.
PATH = ['path', 'path-start', 'path-end', 'error']
TOOL = ['tool', 'section-1', 'section-2', 'section-3', 'rake', 'chordal-rake', 'core-diameter', 'land', 'spiral-angle']
COMMANDED = ['%s-%s' % (name, axis) for name in ('speed', 'acceleration') for axis in 'xyza']
FOLLOWING = ['following-%s' % axis for axis in 'xyza']

FILES = {}  # made once for all tests


class Recording:
    """A launched grinder with bag:=true: one job run to its end, and one in whose stroke Ctrl-C ends it all."""

    def __init__(self, folder):
        self.folder = folder
        self.bag = os.path.join(folder, 'a record.bag')
        self.csv = os.path.join(folder, 'run.csv')
        launch = subprocess.Popen(['roslaunch', '--wait', 'flute_grinder', 'grinder.launch', 'name:=recorded', 'bag:=true',
                                   'bag_file:=' + self.bag, 'journal:=' + os.path.join(folder, 'journal'),
                                   'history:=' + os.path.join(folder, '.ros/flute_grinder/history/'),
                                   'config:=' + gc.machine_file(os.path.join(folder, 'machine.yaml'))],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            self.node = gc.Grinder('recorded')
            self.wait_for_recorder()
            self.node.make_ready()
            self.grind_with_hold_and_override()
            self.node.make_ready(0.2)
            self.node.send(gc.PAPER).wait_in_stroke(2 * MM)
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(timeout=gc.PATIENCE)
        self.node.wait_end_of_connections()
        self.node.close()
        ids = list(dict.fromkeys(batch.goal_id for batch in self.node.batches))
        self.jobs = [[b for b in self.node.batches if b.goal_id == goal] for goal in ids]
        records = glob.glob(os.path.join(folder, '.ros/flute_grinder/history/*/*.json'))
        self.record = min(records)

    def grind_with_hold_and_override(self):
        """The job by the command line; in its stroke it is held, and then ground at half the feed. Slow before, so that a
        busy computer comes in time."""
        self.node.set_feed_override(0.4)
        run = subprocess.Popen([gc.program('grind'), '--node', 'recorded', 'run', PAPER_JOB, '--answer', 'ignore-offsets', '--csv',
                                self.csv],
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)
        try:
            self.wait_beyond(4 * MM)
            self.node.hold()
            self.node.wait_state(GrinderState.HELD)
            self.node.set_feed_override(0.5)
            self.node.resume()
            self.wait_beyond(12 * MM)
            self.node.set_feed_override(1)
            error = run.communicate(timeout=gc.PATIENCE)[1]
        finally:
            run.kill()
        assert run.returncode == 0, error

    def wait_beyond(self, x):
        self.node.wait_for(lambda: self.node.batches and self.node.batches[-1].setpoints[-1].position[X] > x, 'X %g m' % x)

    def wait_for_recorder(self):
        """Waits until the recorder is connected to all that the grinder publishes."""
        api = xmlrpc.client.ServerProxy(rosgraph.Master('/test_report').lookupNode('/recorded'))
        wanted = {'/joint_states', '/diagnostics'} | {'/recorded/' + name for name in (
            'setpoints', 'state', 'machine', 'offsets', 'job', 'grind/result')}
        recorder = '/' + rospy.get_param('/recorded/recorder')
        gc.poll(lambda: wanted <= {bus[4] for bus in api.getBusInfo('/test_report')[2] if bus[1] == recorder},
                'the recorder')


def setUpModule():
    folder = FILES['folder'] = gc.temp_folder(unittest.addModuleCleanup)
    FILES['recording'] = Recording(folder)
    FILES['csv'] = os.path.join(folder, 'plan.csv')
    gc.grind('plan', PAPER_JOB, '--csv', FILES['csv'])
    FILES['rows'] = CommandLine.csv(FILES['csv'])
    FILES['short'] = bag_of('short.bag', FILES['rows'][:50])
    # Of the job that was run to its end, on paper too.
    numbered = browser.version() >= browser.NUMBERS_PAGES
    FILES['pdf'] = os.path.join(folder, 'report.pdf') if numbered else None
    FILES['page'], FILES['found'] = ReportCase().report(
        FILES['recording'].bag, '--job', '1', '--note', 'Blank 7 <of 9>', '--operator', 'Shift "B"', '--serial', '4711-03',
        *(['--pdf', FILES['pdf']] if numbered else []))


def bag_of(name, rows, job=None):
    """A bag whose drive followed the setpoints without an error."""
    path = os.path.join(FILES['folder'], name)
    bag = Bag(path, 1e-3)
    bag.add(job, '', rows)
    bag.close()
    return path


class Page(html.parser.HTMLParser):
    """A report: `rows` are its tables' rows by their first column, `tables` the same by the heading before, `pictures` the SVG
    trees by the figures' ids."""

    EMPTY = ('meta',)

    def __init__(self, path):
        super().__init__()
        self.open, self.tags, self.links, self.text = [], [], [], ''
        self.rows, self.tables, self.pictures, self.captions, self.headings = {}, {}, {}, {}, []
        self._row, self._figure = [], None
        with open(path, encoding='utf-8') as file:
            self.source = file.read()
        self.feed(re.sub(r'<figure id="([a-z0-9-]+)"[^>]*>\n(<svg.*?</svg>)', self._take_picture, self.source, flags=re.DOTALL))
        self.close()

    def _take_picture(self, match):
        name, svg = match.groups()
        assert name not in self.pictures, 'twice the figure ' + name
        self.pictures[name] = Picture(name, svg)
        return '<figure id="%s">' % name

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append(tag)
        self.links += [attributes[name] for name in ('src', 'href', 'srcset', 'data', 'action') if name in attributes]
        if tag == 'figure':
            self._figure = attributes['id']
            self.captions[self._figure] = ''
        if tag in ('h1', 'h2', 'summary'):
            self.headings.append('')
        if tag == 'tr':
            self._row = []
        if tag in ('td', 'th'):
            self._row.append('')
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, 'not nested: ' + tag
        if tag == 'tr':
            self.rows.setdefault(self._row[0], self._row[1:])
            self.tables.setdefault(self.headings[-1], []).append(self._row)

    def handle_data(self, data):
        self.text += data
        if self.open and self.open[-1] in ('td', 'th'):
            self._row[-1] += data
        if self.open and self.open[-1] in ('h1', 'h2', 'summary'):
            self.headings[-1] += data
        if 'figcaption' in self.open:
            self.captions[self._figure] += data


class Picture:
    """An SVG that was drawn."""

    def __init__(self, name, svg):
        self._name = name
        self.root = xml.fromstring(svg)
        self.label = self.root.get('aria-label')
        self.size = tuple(float(size) for size in self.root.get('viewBox').split()[2:])
        self.text = ' '.join(''.join(text.itertext()) for text in self.root.iter(SVG + 'text'))

    def panel(self, number):
        return self.root.find(".//%sg[@id='%s-axes_%d']" % (SVG, self._name, number))

    def marks(self, number=1):
        """The marker points of each plot in a panel, in drawing order."""
        found = []
        for group in self.panel(number).findall(SVG + 'g'):
            uses = group.findall('.//%suse' % SVG) if group.get('id').startswith(self._name + '-line2d') else []
            if uses:
                found.append([(float(use.get('x')), float(use.get('y'))) for use in uses])
        return found

    def ticks(self, number, along='y'):
        """The labels of a panel's axis, and where they stand."""
        found = []
        for group in self.panel(number).iter(SVG + 'g'):
            if not re.search(r'-%stick_\d+$' % along, group.get('id', '')):
                continue
            use, text = group.find('.//%suse' % SVG), group.find('.//%stext' % SVG)
            found.append((''.join(text.itertext()).strip(), float(use.get(along))))
        return found

    def title(self, number):
        """Its last text."""
        return ''.join(list(self.panel(number).iter(SVG + 'text'))[-1].itertext())

    def lines(self, number=1, dashed=False):
        """The vertices of each line in a panel."""
        found = []
        for group in self.panel(number).findall(SVG + 'g'):
            path = group.find(SVG + 'path')
            if group.get('id').startswith(self._name + '-line2d') and path is not None:
                if ('stroke-dasharray' in path.get('style')) == dashed:
                    numbers = [float(n) for n in re.findall(r'-?[\d.]+', path.get('d'))]
                    found.append(list(zip(numbers[::2], numbers[1::2])))
        return found

    def vertices(self):
        return sum(len(re.findall(r'[ML]', p.get('d', ''))) for p in self.root.iter(SVG + 'path'))


class ReportCase(unittest.TestCase):
    def path(self, name):
        return os.path.join(FILES['folder'], name)

    def report(self, source, *arguments):
        """The page and the data, which one reading of the file gives."""
        output = self.path('report.html')
        data = self.data(source, '-o', output, *arguments)
        page = Page(output)
        os.remove(output)
        return page, data

    def data(self, source, *arguments):
        done = gc.grind('report', source, '--json', *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        return json.loads(done.stdout)

    def rewritten(self, name, change):
        """The bag with every message through a function, which says whether it is left in."""
        with rosbag.Bag(FILES['recording'].bag) as whole, rosbag.Bag(self.path(name), 'w') as bag:
            for topic, message, stamp in whole.read_messages():
                if change(topic, message):
                    bag.write(topic, message, stamp)
        return self.path(name)

    def assert_page(self, page, pictures):
        """It is whole, needs no other file, and has these pictures, each with something in it."""
        self.assertEqual(page.open, [])
        self.assertTrue(page.source.startswith('<!DOCTYPE html>'))
        self.assertEqual(page.links, [])
        self.assertEqual({'script', 'link', 'iframe', 'object', 'embed', 'base', 'img'} & set(page.tags), set())
        self.assertNotRegex(re.sub(r' xmlns(:xlink)?="[^"]+"', '', page.source), r'@import|url\((?!#)|https?://')
        ids = re.findall(r'\bid="([^"]+)"', page.source)
        self.assertEqual(len(ids), len(set(ids)))
        self.assertEqual(list(page.pictures), pictures)
        for name, picture in page.pictures.items():
            self.assertTrue(picture.label, name)
            self.assertGreater(min(picture.size), 150, name)
            self.assertLess(picture.vertices(), 30000, name)
            self.assertTrue(sum(len(m) for m in picture.marks()) > 5 or picture.vertices() > 8, name + ' is blank')
            self.assertRegex(page.captions[name], r'\b(mm|ms|deg)\b', name)
            # A line beyond what a panel shows, such as a limit, is cut off by its clip path.
            for number in (1, 2):
                for x, y in sum(picture.marks(number), []) if picture.panel(number) is not None else ():
                    self.assertTrue(0 <= x <= picture.size[0] and 0 <= y <= picture.size[1], (x, y))
            for element in picture.root.iter():
                self.assertTrue(element.get(HREF, '#' + name).startswith('#' + name), name)

    def assert_drawn(self, marks, data):
        """Points stand in a picture as the data do: X to the right, values upward, each on one linear scale."""
        self.assertEqual(len(marks), len(data))
        for axis, sign in ((0, 1), (1, -1)):
            low, high = (min(data, key=lambda d: d[axis]), max(data, key=lambda d: d[axis]))
            drawn_low, drawn_high = (marks[data.index(d)][axis] for d in (low, high))
            scale = (drawn_high - drawn_low) / (high[axis] - low[axis])
            self.assertGreater(sign * (drawn_high - drawn_low), 60)
            for mark, point in zip(marks, data):
                self.assertAlmostEqual(mark[axis], drawn_low + scale * (point[axis] - low[axis]), delta=0.01)


def timestamp(utc):
    return datetime.datetime.fromisoformat(utc.replace('Z', '+00:00')).timestamp()


class TestPlan(ReportCase):
    """A run without errors: the pictures show what the plan's setpoints are. It is the plan several times over, as so many passes, more than
    can be drawn; some odd points of it have errors like no other."""

    PASSES = 7


    @classmethod
    def setUpClass(cls):
        # Pair ends stay on even cycles: the plan has an odd number of setpoints, of which the last is left out.
        count, rows, spikes = len(FILES['rows']) - 1, [], {1: 1e-3, 4: -0.9e-3}
        assert count % 2 == 0
        for i in range(cls.PASSES * count):
            row = dict(FILES['rows'][i % count], cycle=i)
            row['pass'] = i // count
            if row['step'] == 'odd' and float(row['x_mm']) > 15:
                row['error_rad'] = spikes.pop(row['pass'], row['error_rad'])
            rows.append(row)
        path = bag_of('long.bag', rows)
        cls.page, cls.found = cls.report(cls(), path)
        cls.rows = FILES['rows'][:-1]

    def test_no_point_is_lost_where_there_are_too_many_to_draw(self):
        self.assert_page(self.page, ['feed'] + FOLLOWING + COMMANDED + ['timing'] + PATH)
        self.assertEqual(self.found['points'], self.PASSES * len(self.rows))
        self.assertEqual([(s['tooth'], s['pass']) for s in self.found['strokes']], [(1, n) for n in range(1, self.PASSES + 1)])
        self.assertEqual(self.found['odd_error_rad'], 1e-3)
        line, = self.page.pictures['error'].lines(1)
        heights = sorted(y for _, y in line)
        # The spikes stand out by much of the panel, upward and downward.
        self.assertGreater(heights[1] - heights[0], 30)
        self.assertGreater(heights[-1] - heights[-2], 30)

    def test_strokes_and_what_is_between_them_are_apart(self):
        # The fastest cycle with and without an odd or even step.
        for axis, column, scale in zip(self.found['axes'], ('x_mm', 'y_mm', 'z_mm', 'a_rad'), (1, 1, 1, 1 / DEG)):
            largest = {'stroke': 0.0, 'rapid': 0.0}
            for before, row in zip(self.rows[-1:] + self.rows, self.rows):
                part = 'rapid' if row['step'] == 'none' else 'stroke'
                largest[part] = max(largest[part], abs(float(row[column]) - float(before[column])) / 1e-3)
            for part, speed in largest.items():
                self.assertAlmostEqual(axis['speed'][part], speed * scale, delta=1e-6 * scale)

    def test_line_is_as_high_as_the_max_value(self):
        for axis in 'xyza':
            for name in ('speed', 'acceleration'):
                picture = self.page.pictures['%s-%s' % (name, axis)]
                for panel in (1, 2):
                    ticks = {float(t.replace('−', '-')): y for t, y in picture.ticks(panel)}
                    scale = (ticks[max(ticks)] - ticks[min(ticks)]) / (max(ticks) - min(ticks))
                    ys = [y for line in picture.lines(panel) for _, y in line]
                    reported = float(re.search(r'max (\S+) ', picture.title(panel)).group(1))
                    self.assertAlmostEqual(max(abs(y - ticks[min(ticks)] + scale * min(ticks)) for y in ys) / abs(scale), reported,
                                           delta=0.01 * reported + 1e-9, msg=(name, axis, panel))

    def test_enlarged_points_are_the_strokes_first_and_last(self):
        stroke = [(float(r['x_mm']), float(r['a_rad']), r['step']) for r in self.rows if r['step'] != 'none']
        for name, rows in (('path-start', stroke[:10]), ('path-end', stroke[-10:])):
            odd, even = self.page.pictures[name].marks()[:2]
            self.assertEqual(len(odd), 5)
            self.assert_drawn(odd + even, [r[:2] for step in ('odd', 'even') for r in rows if r[2] == step])


class TestBag(ReportCase):
    """Of the job that was run to its end; the figures are computed from the messages that the test received itself."""

    @classmethod
    def setUpClass(cls):
        cls.recording, cls.page, cls.found = FILES['recording'], FILES['page'], FILES['found']
        cls.batches = cls.recording.jobs[0]
        cls.setpoints = [s for b in cls.batches for s in b.setpoints]
        cls.start, cls.end = cls.batches[0].header.stamp.to_sec(), cls.batches[-1].end_stamp.to_sec()

    def test_bag_has_all_topics_and_the_worst_diagnostics_are_reported(self):
        worst = {}
        with rosbag.Bag(self.recording.bag) as bag:
            topics = bag.get_type_and_topic_info().topics
            for _, message, _ in bag.read_messages('/diagnostics'):
                for status in message.status:
                    level, _ = worst.get(status.name, (-1, ''))
                    if status.level > level:
                        worst[status.name] = status.level, status.message
        self.assertEqual(sorted(topics), ['/diagnostics', 'joint_states'] + ['recorded/' + name for name in (
            'grind/result', 'job', 'machine', 'offsets', 'setpoints', 'state')])
        self.assertTrue(all(topic.message_count > 0 for topic in topics.values()))
        self.assertEqual({s['name']: (s['level'], s['message']) for s in self.found['diagnostics']}, worst)

    def test_page_reports_job_wheel_setup_machine_and_software(self):
        self.assert_page(self.page, TOOL + ['feed'] + FOLLOWING + COMMANDED + ['timing'] + PATH)
        self.assertRegex(self.page.rows['job in the bag'][0], r'^1 of 2, ')
        self.assertIn('Note: Blank 7 <of 9>', self.page.text)
        self.assertNotIn('missing', self.page.rows)
        self.assertNotIn('Left out', self.page.text)
        package = xml.parse(gc.package_file('package.xml'))
        machine = xml.parse(gc.package_file('urdf/grinder.urdf')).getroot().get('name')
        for row, reported in (('outcome', 'done'), ('end diameter', '10 mm'), ('flute length', '30 mm'), ('cone', '5 deg'), ('rake', '8 ± 0.5 deg'),
                              ('spiral angle', '30 ± 4 deg'), ('core', '7.1 to 12.4 ± 0.1 mm'),
                              ('shank', '16 mm'), ('set-up', 'swivel 31.769 deg, height 2.788 mm'), ('feed', '600 mm/min'),
                              ('wheel', 'straight, Ø 100 mm, 3 mm wide, corners 0 and 0 mm'), ('operator', 'Shift "B"'), ('serial number', '4711-03'),
                              ('machine', machine + ', /recorded'), ('software', 'flute_grinder ' + package.findtext('version'))):
            self.assertEqual(self.page.rows[row], [reported])
        self.assertEqual(self.page.headings[0], 'paper.yaml')
        for dimension in ('Ø 10', 'Ø 16', '30', 'cone 5°'):
            self.assertIn(dimension, self.page.pictures['tool'].text)

    def test_errors_are_those_of_the_setpoints(self):
        stroke = [s for s in self.setpoints if s.move == STROKE]
        for name, is_odd in (('odd', True), ('even', False)):
            largest = max(abs(s.path_error) for s in stroke if (s.step == ODD) == is_odd)
            self.assertEqual(self.page.rows['maximum %s error' % name], ['%.4e rad' % largest])
        # The following error is that to the command of the cycle before.
        for axis, unit in enumerate(UNITS):
            errors = {'rapid': 0.0, 'stroke': 0.0, 'limit': gc.machine()['constraints'][JOINTS[axis]]['trajectory']}
            for before, s in zip(self.setpoints, self.setpoints[1:]):
                part = 'stroke' if s.move == STROKE else 'rapid'
                errors[part] = max(errors[part], abs(before.position[axis] - s.actual[axis]))
            for part, error in errors.items():
                self.assertAlmostEqual(self.found['axes'][axis]['following'][part], error / unit, delta=1e-9)

    def test_times_of_job_stroke_hold_and_overrides(self):
        self.assertAlmostEqual(timestamp(self.found['started']), self.start, delta=1.1e-3)
        self.assertAlmostEqual(self.found['duration_s'], self.end - self.start, delta=1e-3)
        stroke, = self.found['strokes']
        points = [(s, b) for b in self.batches for s in b.setpoints if s.move == STROKE]
        # A stamp is of a batch as a whole, which takes longer than its cycles if the host stalls.
        for at, (_, batch) in ((stroke['started_s'], points[0]), (stroke['started_s'] + stroke['duration_s'], points[-1])):
            self.assertGreaterEqual(self.start + at, batch.header.stamp.to_sec() - batch.period)
            self.assertLessEqual(self.start + at, batch.end_stamp.to_sec() + batch.period)
        hold, = self.found['holds']
        self.assertEqual((hold['tooth'], hold['pass'], hold['reason']), (1, 1, 'operator'))
        # Between two batches there is a gap as long as the hold, within the 50 ms between messages.
        amid = self.start + hold['at_s'] + hold['duration_s'] / 2
        gap, = [(b.header.stamp - a.end_stamp).to_sec() for a, b in zip(self.batches, self.batches[1:])
                if a.end_stamp.to_sec() <= amid <= b.header.stamp.to_sec()]
        self.assertAlmostEqual(hold['duration_s'], gap, delta=0.5)
        self.assertEqual([o['percent'] for o in self.found['overrides']], [40, 50, 100])
        self.assertRegex(self.page.rows['1, 1'][-1], r'^held .* \(operator\); override 50 % at .*; override 100 % at ')
        names, times = zip(*((s['state'], s['at_s']) for s in self.found['states']))
        # The first may pass between two messages of the state.
        self.assertIn(names[0], ('starting', 'running'))
        self.assertEqual(names[-2:], ('running', 'ready'))
        self.assertIn('held', names)
        self.assertEqual(list(times), sorted(times))
        # A loop that was late catches up, so that a job takes a few cycles more or less than it has.
        self.assertLessEqual(self.end - self.start - 0.001, times[-1])
        # All pictures have the one axis of time.
        for name in ['feed'] + FOLLOWING + COMMANDED:
            picture = self.page.pictures[name]
            lines = [x for panel in (1, 2) if picture.panel(panel) for line in picture.lines(panel) for x, _ in line]
            ticks = picture.ticks(2 if picture.panel(2) else 1, along='x')
            (first, at_first), (second, at_second) = [(float(t), x) for t, x in ticks][:2]
            reported = first + (max(lines) - at_first) * (second - first) / (at_second - at_first)
            self.assertLessEqual(reported, self.end - self.start + 0.1, name)
            self.assertGreater(reported, self.end - self.start - 6, name)

    def test_every_change_of_the_override_on_a_cylinder(self):
        # There the axes that rest have no distance to go, and nothing else in a state need change with the override.
        factors, asked, last = (1.0, 0.0, 0.3, 0.0, 1.2), [], 1.0

        def change(topic, message):
            nonlocal last
            if topic.endswith('/state'):
                at = message.header.stamp.to_sec()
                message.override = factors[int((at - self.start) / 0.5) % 5] if at > self.start else 1.0
                message.distance_to_go = [0, 0, 0, 0]
                if self.start < at < self.end and message.override != last:
                    asked.append((100 * message.override, at - self.start))
                    last = message.override
            return True

        data = self.data(self.rewritten('cylinder.bag', change), '--job', '1')
        found = [(o['percent'], o['at_s']) for o in data['overrides']]
        self.assertGreater(len(asked), 8)
        self.assertEqual([percent for percent, _ in found], [round(percent, 6) for percent, _ in asked])
        for (_, at), (_, asked_at) in zip(found, asked):
            self.assertAlmostEqual(at, asked_at, delta=1.1e-3)

    def test_loop_timing(self):
        periods = [s.cycle_period for s in self.setpoints]
        loop = self.found['loop']
        for name, period in (('shortest', min(periods)), ('longest', max(periods)), ('mean', sum(periods) / len(periods))):
            self.assertAlmostEqual(loop[name + '_ms'], period / 1e-3, delta=2e-6 if name == 'mean' else 1e-9)
        late = sum(period > 1.5 * self.batches[0].period for period in periods)
        self.assertEqual(self.found['late_cycles']['count'], late)

    def judged(self, source):
        """What is asked, measured and allowed."""
        with open(self.path('tolerances.yaml'), 'w') as file:
            json.dump({'land_mm': 0.05, 'edge_diameter_mm': 1, 'following_error_um': 1000, 'feed_percent': 100,
                       'late_cycles_percent': 100}, file)
        return self.data(source, '--job', '1', '--tolerances', self.path('tolerances.yaml'))

    def test_verdict(self):
        data = self.judged(self.recording.bag)
        self.assertEqual((data['verdict'], data['verdict_because']), ('passed', []))
        self.assertEqual([(c['name'], c['result']) for c in data['criteria']], [
            (name, 'passed') for name in ('rake', 'chordal rake', 'spiral angle', 'core diameter', 'land', 'gouge', 'path deviation',
                                          'following error in strokes', 'feed constancy', 'late cycles')])
        done = gc.grind('simulate', self.recording.bag, '--run', '1', '--json', '--sections', '17')
        self.assertEqual(data['tool']['sections'], json.loads(done.stdout)['sections'])
        # Without the result, which the recorder may have got or not before it was ended itself.
        data = self.judged(self.rewritten('cut.bag', lambda topic, _: not topic.endswith('grind/result')))
        self.assertEqual((data['verdict'], data['verdict_because']), ('unfinished', ['the end of the job is not in the file']))

    def test_job_in_whose_stroke_ctrl_c_ended_roslaunch(self):
        """Its bag is whole, and it is the one that is reported where none is asked for, as far as it came."""
        found = self.data(self.recording.bag)
        received = [s for b in self.recording.jobs[1] for s in b.setpoints]
        # The recorder was ended together with the grinder, and need not have got its last setpoints.
        self.assertTrue(1 < found['points'] <= len(received))
        stroke = [s for s in received[:found['points']] if s.move == STROKE]
        self.assertEqual(found['odd_error_rad'], max(abs(s.path_error) for s in stroke if s.step == ODD))


class TestRecordOfTheGrinder(ReportCase):
    """What the grinder keeps by itself, with the same figures as the bag."""

    def test_same_figures_as_from_the_bag_and_on_the_page(self):
        (page, record), bag = self.report(FILES['recording'].record), FILES['found']
        mine, theirs = record['strokes'][0], bag['strokes'][0]
        for key in ('tooth', 'pass', 'depth_mm', 'feed_min_mm_min', 'feed_max_mm_min', 'deviation_um'):
            self.assertAlmostEqual(mine[key], theirs[key], delta=1e-6, msg=key)
        # The record begins with the start of the job, the bag with the first setpoint, once the spindle turns.
        begun = [timestamp(data['started']) + data['strokes'][0]['started_s'] for data in (record, bag)]
        # Within a batch, which takes longer than its cycles if the host stalls.
        batches = [b for b in FILES['recording'].jobs[0] if any(s.move == STROKE for s in b.setpoints)]
        first, last = ((b.end_stamp - b.header.stamp).to_sec() for b in (batches[0], batches[-1]))
        self.assertAlmostEqual(*begun, delta=0.5 + first)
        self.assertAlmostEqual(mine['duration_s'], theirs['duration_s'], delta=0.5 + first + last)
        for key, value in theirs['following_error'].items():
            self.assertAlmostEqual(mine['following_error'][key], value, delta=1e-6, msg=key)
        self.assertEqual([o['percent'] for o in record['overrides']], [40, 50, 100])
        self.assertEqual([h['reason'] for h in record['holds']], ['operator'])
        self.assertEqual((record['outcome'], record['setpoints']['written']), ('done', bag['points']))
        # The tool is measured by what the record has of its strokes.
        for mine, theirs in zip(record['criteria'], bag['criteria']):
            self.assertEqual((mine['name'], mine['result']), (theirs['name'], theirs['result']))
            if mine['of_tool']:
                self.assertAlmostEqual(mine['measured'], theirs['measured'], delta=1e-3, msg=mine['name'])
        self.assertEqual(record['machine'], bag['machine'])
        self.assertEqual(record['job']['file'], bag['job']['file'])
        self.check_removal(page, record['operations'][0]['removal'], bag)
        self.check_page(page)

    def check_removal(self, page, removal, bag):
        """The single pass of the one tooth took what the tool lacks."""
        self.assertEqual(removal, bag['removal'])
        one, = removal
        largest = max(bag['tool']['sections'][i]['area_removed_mm2'] for i in (0, 8, 16))
        self.assertAlmostEqual(one['area_mm2'], largest, delta=0.002 * largest)
        self.assertIn(['1', '%.4f' % one['depth_mm'], '%.3g' % one['area_mm2'], '%.3g' % one['rate_mm3_s'], '█' * 24],
                      page.tables['Teeth and passes: flute'])

    def check_page(self, page):
        self.assert_page(page, TOOL)
        self.assertEqual(page.headings[0], 'paper.yaml')
        self.assertEqual(page.rows['rake'], ['8 ± 0.5 deg'])
        judged = {row[0]: row[4] for row in page.tables['The tool: asked and computed'] + page.tables['The run'] if row[0]}
        self.assertEqual((judged['rake'], judged['feed constancy']), ('passed', 'failed'))
        # Nothing was touched off, and the check was ignored.
        self.assertEqual(page.rows['flute'][:3], ['straight', '100', '0'])
        self.assertIn(['flute', *['never set'] * 4, ''], page.tables['Operations'])
        self.assertIn('Ground without the check of the zero points (--answer ignore-offsets): flute.', page.text)

    def test_last_is_the_newest(self):
        done = gc.grind('--node', 'recorded', 'report', '--last', '--json', environment={'ROS_HOME': self.path('.ros')})
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        self.assertEqual(json.loads(done.stdout)['outcome'], 'canceled')
        done = gc.grind('--node', 'another', 'report', '--last', '--json')
        self.assertEqual(done.returncode, 2)
        self.assertIn('/another', done.stderr)


class TestLayout(ReportCase):
    """On a phone, on a screen, in the dark and on paper."""

    @classmethod
    def setUpClass(cls):
        if not FILES['pdf']:
            raise unittest.SkipTest('no Chromium here that numbers pages')
        cls.page = FILES['page']
        # A form feed ends each sheet.
        cls.sheets = [cls.flat(sheet) for sheet in subprocess.check_output(
            ['pdftotext', FILES['pdf'], '-'], universal_newlines=True).split('\f')[:-1]]

    @staticmethod
    def flat(text):
        return re.sub(r'\s+', '', text)

    def test_on_a_phone_and_a_screen_in_the_dark_and_in_the_light(self):
        light, dark, phone = (browser.look_at(self.page.source, width, dark=dark)
                              for width, dark in ((1280, False), (1280, True), (390, False)))
        for reported, width in ((light, 1280), (phone, 390)):
            # Nothing sticks out, and pictures can be read.
            self.assertEqual((reported['width'], reported['out']), (width, []))
            self.assertLessEqual(reported['scroll'], width)
            self.assertGreater(reported['smallest'], 6.5)  # px
        for reported, is_dark in ((dark, True), (light, False)):
            ink, paper = browser.lightness(reported['ink']), browser.lightness(reported['background'])
            self.assertGreater((ink - paper) * (1 if is_dark else -1), 0.6)
            # Text in the pictures too.
            for fill in reported['inks']:
                self.assertGreater(abs(browser.lightness(fill) - paper), 0.35)

    def test_paper_is_a4_and_every_sheet_says_whose_it_is(self):
        reported = subprocess.check_output(['pdfinfo', '-l', '-1', FILES['pdf']], universal_newlines=True)
        sizes = re.findall(r'^Page +\d+ size: +([\d.]+) x ([\d.]+) pts', reported, re.MULTILINE)
        for width, height in sizes:
            self.assertAlmostEqual(float(width), 595, delta=1)
            self.assertAlmostEqual(float(height), 842, delta=1)
        self.assertEqual(len(sizes), len(self.sheets))
        self.assertEqual(len(self.sheets), int(re.search(r'1/(\d+)$', self.sheets[0]).group(1)))
        begun = self.page.rows['ground'][0][:len('2000-01-01 00:00')]
        for sheet in self.sheets:
            for text in ('paper.yaml · D 10 mm, cone 5 deg', 'No. 4711-03 · ' + begun, 'Shift "B"'):
                self.assertIn(self.flat(text), sheet)
        for text in ('paper.yaml', 'FAILED', 'spiral angle', 'core diameter', 'own measurement decides', 'run-out', 'signature', 'Ø 10'):
            self.assertIn(self.flat(text), self.sheets[0])

    def test_labels_of_sections_can_be_read_on_paper(self):
        # Three share the sheet's width.
        for name in ('section-1', 'section-2', 'section-3'):
            width = float(self.page.pictures[name].root.get('viewBox').split()[2])
            for text in self.page.pictures[name].root.iter(SVG + 'text'):
                size = float(re.search(r'([\d.]+)px', text.get('style')).group(1))
                self.assertGreater(size * 0.31 * (595 - 2 * 14 / 25.4 * 72) / width, 6, ''.join(text.itertext()))  # pt

    def test_picture_for_the_documentation(self):
        picture = os.path.join(PICTURES, 'report.png')
        os.makedirs(PICTURES, exist_ok=True)
        browser.take_picture(self.page.source, picture, 1000, 1130)
        with Image.open(picture) as image:
            self.assertEqual(image.size, (1000, 1130))
            self.assertGreater(len(set(image.convert('L').getdata())), 50)

    def test_a_picture_is_on_one_sheet_with_its_caption_and_no_heading_is_the_last(self):
        for name, picture in self.page.pictures.items():
            # The rest of a caption may stand beside that of the next picture.
            sheets = [sheet for sheet in self.sheets if self.flat(picture.label + '.') in sheet]
            self.assertTrue(sheets, name)
            longest = self.flat(max((''.join(text.itertext()) for text in picture.root.iter(SVG + 'text')), key=len))
            # Other pictures may have the same text.
            self.assertTrue(any(longest in sheet for sheet in sheets), name)
        for heading in map(self.flat, self.page.headings):
            behind = next(sheet for sheet in self.sheets if heading in sheet).rpartition(heading)[2]
            self.assertGreater(len(re.sub(r'\d+/\d+$', '', behind)), 20, heading)

    def test_without_a_browser(self):
        done = gc.grind('report', FILES['short'], '--pdf', self.path('none.pdf'), environment={'PATH': self.path('nothing')})
        self.assertEqual(done.returncode, 2)
        self.assertIn('cannot be printed without a browser; install chromium', done.stderr)
        self.assertFalse(os.path.exists(self.path('none.pdf')))


class TestBadFiles(ReportCase):
    """Exit status 2, and the file with the reason; a report that was there before stays."""

    def test_job_with_a_gap_that_ended_ahead_of_its_stroke(self):
        # In a rapid: the difference over the gap would be far beyond the limit.
        path = bag_of('gap.bag', FILES['rows'][:400] + FILES['rows'][500:1500])
        page, found = self.report(path)
        self.assertEqual(page.rows['missing'], ['100 setpoints are not in the file'])
        whole = self.data(bag_of('plan.bag', FILES['rows'], PAPER_JOB))
        for axis, other in zip(found['axes'], whole['axes']):
            for key in ('speed', 'acceleration'):
                self.assertLessEqual(axis[key]['rapid'], other[key]['rapid'])
        self.assertEqual(list(page.pictures), FOLLOWING + COMMANDED + ['timing'])
        self.assertIn('the job ended before its first stroke', page.text)
        self.assertNotIn('maximum odd error', page.rows)

    def check(self, source, reason, *arguments):
        output = self.path('kept.html')
        pathlib.Path(output).write_text('kept')
        done = gc.grind('report', source, '-o', output, *arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, '')
        self.assertRegex(done.stderr.rstrip('\n'), r'^%s: %s$' % (re.escape(source), reason))
        self.assertEqual(pathlib.Path(output).read_text(), 'kept')

    def test_files_that_cannot_be_used(self):
        rows = FILES['rows'][:50]
        whole = pathlib.Path(FILES['recording'].bag).read_bytes()
        cases = [(bag_of('nan.bag', rows[:20] + [dict(rows[20], a_rad='nan')] + rows[21:]), 'cycle 20: position is not a finite number'),
                 (bag_of('order.bag', rows[:30] + rows[20:]), 'cycle 20 follows cycle 29; allowed: ascending cycles'),
                 (bag_of('few.bag', rows[:2]), r'has 2 point\(s\); allowed: 3 or more'),
                 (self.path('nothing.csv'), 'cannot be read: No such file or directory'),
                 (FILES['folder'], 'cannot be read: Is a directory'),
                 (FILES['csv'], 'is no record of a job: .*'),
                 (FILES['recording'].record, 'job 3: only a bag has several jobs', '--job', '3'),
                 (FILES['recording'].bag, r'job 3: the bag has 2 job\(s\)', '--job', '3'),
                 (self.rewritten('none.bag', lambda topic, _: topic == '/diagnostics'),
                  r'the bag has setpoints \(.*\) on no topic; allowed: one topic')]
        for cut in (20, 5000, len(whole) // 2, len(whole) - 1):
            cases.append((self.path('cut_%d.bag' % cut), 'the bag was not closed, or is cut off; .*'))
            pathlib.Path(cases[-1][0]).write_bytes(whole[:cut])
        for source, reason, *arguments in cases:
            with self.subTest(reason, source=source):
                self.check(source, reason, *arguments)

    def test_output_that_cannot_be_written(self):
        output = self.path('no/such/folder')
        for arguments, status, said in ((['-o', output], 2, output + ': cannot be written: No such file or directory\n'),
                                        (['--pdf', output], 2, output + ': cannot be written: No such file or directory\n'),
                                        ([], 2, 'nothing to write; allowed: --output, --pdf, --json\n')):
            done = gc.grind('report', FILES['short'], *arguments)
            self.assertEqual((done.returncode, done.stderr), (status, said))
        done = gc.grind('report', '-o', self.path('none.html'))
        self.assertEqual((done.returncode, done.stderr), (2, 'FILE is missing; allowed: a file, or --last\n'))
        with open('/dev/full', 'w') as full:
            done = gc.grind('report', FILES['short'], '--json', stdout=full)
        self.assertEqual((done.returncode, done.stderr), (1, 'standard output: write failed\n'))

    def test_reader_of_the_data_that_has_ended(self):
        run = subprocess.Popen([gc.program('grind'), 'report', FILES['short'], '--json'], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE)
        run.stdout.close()
        self.assertEqual((run.stderr.read(), run.wait(gc.PATIENCE)), (b'', 1))
        run.stderr.close()
