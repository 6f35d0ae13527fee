#!/usr/bin/env python3
"""Shows that `record:=true` writes a bag of all setpoints, which Ctrl-C closes, and that `grind report` makes of it, and of
the CSV files, one HTML file whose figures are the job's and whose pictures show its points."""

import base64
import html.parser
import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as xml
import xmlrpc.client

import rosbag
import rosgraph
import rospy
import rostest

import grinder_client as gc
import path_checks as checks
from grinder_client import DEG, JOINTS, MM, ODD, STROKE, UM, X

PAPER_JOB = gc.package_file('jobs/paper.yaml')
SVG = '{http://www.w3.org/2000/svg}'
HREF = '{http://www.w3.org/1999/xlink}href'
UNITS = [MM, MM, MM, DEG]

# Pictures of each kind of file, in order.
PATH = ['path', 'path-start', 'path-end', 'error']
MOTION = ['feed', 'speed', 'acceleration']
MEASURED = ['following', 'timing']
TOOL = ['tool-sections', 'tool-figures']

FILES = {}  # made once for all tests


class Recording:
    """A launched grinder with record:=true: one job run to its end, and one in whose stroke Ctrl-C ends it all."""

    def __init__(self, folder):
        self.folder = folder
        self.bag = os.path.join(folder, 'record.bag')
        self.csv = os.path.join(folder, 'run.csv')
        launch = subprocess.Popen(['roslaunch', '--wait', 'flute_grinder', 'grinder.launch', 'name:=recorded', 'record:=true',
                                   'bag:=' + self.bag, 'journal:=' + os.path.join(folder, 'journal'),
                                   'config:=' + gc.machine_file(os.path.join(folder, 'machine.yaml'))],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            self.node = gc.Grinder('recorded')
            self.wait_for_recorder()
            self.node.make_ready()
            self.run = gc.grind('--node', 'recorded', 'run', PAPER_JOB, '--csv', self.csv)
            assert self.run.returncode == 0, self.run.stderr
            self.report_while_recording = gc.grind('report', self.bag + '.active', '-o', os.path.join(folder, 'no.html'))
            self.node.send(gc.PAPER).wait_in_stroke(10 * MM)
        finally:
            launch.send_signal(signal.SIGINT)
            launch.wait(timeout=gc.PATIENCE)
        self.node.wait_end_of_connections()
        self.node.close()
        ids = list(dict.fromkeys(batch.goal_id for batch in self.node.batches))
        self.jobs = [[b for b in self.node.batches if b.goal_id == goal] for goal in ids]

    def wait_for_recorder(self):
        """Waits until the recorder is connected to all that the grinder publishes."""
        api = xmlrpc.client.ServerProxy(rosgraph.Master('/test_report').lookupNode('/recorded'))
        wanted = {'/recorded/setpoints', '/recorded/state', '/recorded/machine', '/recorded/offsets', '/recorded/grind/result',
                  '/joint_states', '/diagnostics'}
        gc.poll(lambda: wanted <= {bus[4] for bus in api.getBusInfo('/test_report')[2] if bus[1] == '/recorded_record'},
                'the recorder')


def setUpModule():
    folder = tempfile.mkdtemp()
    unittest.addModuleCleanup(shutil.rmtree, folder)
    FILES['folder'] = folder
    FILES['recording'] = Recording(folder)
    FILES['plan'] = os.path.join(folder, 'plan.csv')
    FILES['printed'] = gc.grind('plan', PAPER_JOB, '--csv', FILES['plan']).stdout
    for length in ('0.2', '0.5'):
        FILES['table ' + length] = os.path.join(folder, 'table%s.csv' % length)
        gc.grind('table', PAPER_JOB, '--step-length', length, '--csv', FILES['table ' + length])


class Page(html.parser.HTMLParser):
    """A report: `rows` are its tables' rows by their first column, `pictures` the SVG trees by the figures' ids."""

    EMPTY = ('meta', 'img')

    def __init__(self, path):
        super().__init__()
        self.open, self.tags, self.links, self.text = [], [], [], ''
        self.rows, self.pictures, self.captions = {}, {}, {}
        self._row, self._figure = [], None
        with open(path, encoding='utf-8') as file:
            self.source = file.read()
        self.feed(self.source)
        self.close()

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append(tag)
        self.links += [attributes[name] for name in ('src', 'href', 'srcset', 'data', 'action') if name in attributes]
        if tag == 'figure':
            self._figure = attributes['id']
            assert self._figure not in self.captions, 'twice the figure ' + self._figure
            self.captions[self._figure] = ''
        if tag == 'img':
            assert attributes['alt']
            kind, data = attributes['src'].split(',')
            assert kind == 'data:image/svg+xml;base64', kind
            self.pictures[self._figure] = Picture(base64.b64decode(data, validate=True))
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

    def handle_data(self, data):
        self.text += data
        if self.open and self.open[-1] in ('td', 'th'):
            self._row[-1] += data
        if 'figcaption' in self.open:
            self.captions[self._figure] += data


class Picture:
    """An SVG that was drawn."""

    def __init__(self, data):
        self.root = xml.fromstring(data)
        self.size = tuple(float(self.root.get(name).rstrip('pt')) for name in ('width', 'height'))

    def panel(self, number):
        return self.root.find(".//%sg[@id='axes_%d']" % (SVG, number))

    def marks(self, number=1):
        """The marker points of each plot in a panel, in drawing order."""
        found = []
        for group in self.panel(number).findall(SVG + 'g'):
            uses = group.findall('.//%suse' % SVG) if group.get('id').startswith('line2d') else []
            if uses:
                found.append([(float(use.get('x')), float(use.get('y'))) for use in uses])
        return found

    def lines(self, number=1, dashed=False):
        """The vertices of each line in a panel."""
        found = []
        for group in self.panel(number).findall(SVG + 'g'):
            path = group.find(SVG + 'path')
            if group.get('id').startswith('line2d') and path is not None:
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
        output = self.path('report.html')
        done = gc.grind('report', source, '-o', output, *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ''))
        page = Page(output)
        os.remove(output)
        return page

    def figure(self, page, name):
        """The number that a row begins with."""
        return float(page.rows[name][0].split()[0])

    def assert_page(self, page, pictures):
        """It is whole, needs no other file, and has these pictures, each with something in it."""
        self.assertEqual(page.open, [])
        self.assertTrue(page.source.startswith('<!DOCTYPE html>'))
        self.assertEqual([link for link in page.links if not link.startswith('data:image/svg+xml;base64,')], [])
        self.assertEqual({'script', 'link', 'iframe', 'object', 'embed', 'base'} & set(page.tags), set())
        self.assertNotRegex(page.source, r'@import|url\(|https?://')
        self.assertEqual(list(page.pictures), pictures)
        for name, picture in page.pictures.items():
            self.assertGreater(min(picture.size), 200, name)
            self.assertLess(picture.vertices(), 30000, name)
            self.assertTrue(sum(len(m) for m in picture.marks()) > 5 or picture.vertices() > 200, name + ' is blank')
            self.assertRegex(page.captions[name], r'\b(mm|ms)\b', name)
            self.assert_nothing_outside(picture)
            for element in picture.root.iter():
                self.assertTrue(element.get(HREF, '#').startswith('#'), name)

    def assert_nothing_outside(self, picture):
        for number in range(1, 5):
            if picture.panel(number) is None:
                continue
            for x, y in sum(picture.marks(number) + picture.lines(number), []):
                self.assertTrue(0 <= x <= picture.size[0] and 0 <= y <= picture.size[1], (x, y))

    def assert_drawn(self, marks, data):
        """Points stand in a picture as the data do: X to the right, values upward, each on one linear scale."""
        self.assertEqual(len(marks), len(data))
        for axis, sign in ((0, 1), (1, -1)):
            low, high = (min(data, key=lambda d: d[axis]), max(data, key=lambda d: d[axis]))
            drawn_low, drawn_high = (marks[data.index(d)][axis] for d in (low, high))
            scale = (drawn_high - drawn_low) / (high[axis] - low[axis])
            self.assertGreater(sign * (drawn_high - drawn_low), 100)
            for mark, point in zip(marks, data):
                self.assertAlmostEqual(mark[axis], drawn_low + scale * (point[axis] - low[axis]), delta=0.01)


def read_csv(path):
    with open(path) as lines:
        names = next(lines).strip().split(',')
        return [dict(zip(names, line.strip().split(','))) for line in lines]


class TestTable(ReportCase):
    """The paper's figures, and its Figures 3 to 5."""

    def check_figures(self, length, points, odd, even):
        page = self.report(FILES['table ' + length])
        self.assert_page(page, PATH)
        self.assertEqual(page.rows['points'], [str(points)])
        self.assertEqual(page.rows['largest odd error'], [odd + ' rad'])
        if even:
            self.assertEqual(page.rows['largest even error'], [even + ' rad'])
        self.assertIn('the points of a table have no time', page.text)

    def test_papers_figures_at_02(self):
        self.check_figures('0.2', 152, '3.9785e-05', '3.5000e-07')

    def test_papers_figures_at_05(self):
        self.check_figures('0.5', 62, '2.4780e-04', None)

    def test_pictures_show_the_points(self):
        page = self.report(FILES['table 0.2'])
        helix = checks.Helix(gc.PAPER)
        points = [(float(row['x_mm']), float(row['a_rad'])) for row in read_csv(FILES['table 0.2'])]
        self.assertEqual(len(points), 153)
        for name, first, last in (('path', 0, 152), ('path-start', 0, 9), ('path-end', 143, 152)):
            shown = list(enumerate(points))[first:last + 1]
            odd, even = page.pictures[name].marks()[:2]
            self.assertEqual(len(odd), sum(i % 2 for i, _ in shown))
            self.assert_drawn(odd + even, [p for i, p in shown if i % 2 == 1] + [p for i, p in shown if i % 2 == 0])
        for panel, parity in ((1, 1), (2, 0)):
            errors = [(x, helix.a(x * MM) - a) for i, (x, a) in enumerate(points) if i % 2 == parity]
            self.assert_drawn(page.pictures['error'].marks(panel)[0], errors)


class TestPlan(ReportCase):
    @classmethod
    def setUpClass(cls):
        cls.page = cls.report(cls(), FILES['plan'])
        cls.rows = read_csv(FILES['plan'])

    def test_page(self):
        self.assert_page(self.page, PATH + MOTION)
        self.assertIn('Following error and loop timing: the CSV file of a plan has', self.page.text)
        self.assertIn('Deviation at the cutter\'s surface: it depends', self.page.text)

    def test_figures_are_those_that_plan_prints(self):
        printed = FILES['printed']
        for name, row in (('setpoints', 'points'), ('duration', 'duration'), ('largest odd error', 'largest odd error'),
                          ('largest even error', 'largest even error')):
            self.assertEqual(self.page.rows[row][0].split()[0], re.search(r'(?m)^%s +(\S+)' % name, printed).group(1), name)
        for column, name in ((0, 'largest velocity'), (2, 'largest acceleration')):
            line = re.search(r'(?m)^%s +X (\S+) +Y (\S+) +Z (\S+) \S+ +A (\S+) ' % name, printed)
            self.assertEqual([self.page.rows[axis][column].split()[0] for axis in 'XYZA'], list(line.groups()), name)

    def test_largest_feed_is_the_jobs(self):
        self.assertAlmostEqual(self.figure(self.page, 'largest feed'), 600, delta=600e-6)

    def test_limits_are_the_machines(self):
        machine = gc.machine()['joint_limits']
        for axis, joint, unit in zip('XYZA', JOINTS, UNITS):
            self.assertEqual(self.page.rows[axis][3].split()[0], '%.5g' % (machine[joint]['max_acceleration'] / unit))

    def test_limits_are_those_of_another_machine(self):
        with open(gc.package_file('config/grinder.yaml')) as file:
            text = file.read().replace('max_acceleration: 0.5,', 'max_acceleration: 0.75,')
        with open(self.path('machine.yaml'), 'w') as file:
            file.write(text)
        page = self.report(FILES['plan'], '--machine', self.path('machine.yaml'))
        self.assertEqual([page.rows[axis][3] for axis in 'XYZ'], ['750 mm/s²'] * 3)

    def test_speeds_are_drawn_between_their_limits(self):
        for panel in range(1, 5):
            for name in ('speed', 'acceleration'):
                line, = self.page.pictures[name].lines(panel)
                low, high = sorted(l[0][1] for l in self.page.pictures[name].lines(panel, dashed=True))
                ys = [y for _, y in line]
                self.assertTrue(low - 0.1 <= min(ys) <= max(ys) <= high + 0.1, (name, panel))
                # How near it comes to a limit, which is above and below alike.
                column = 0 if name == 'speed' else 2
                largest, limit = (float(self.page.rows['XYZA'[panel - 1]][c].split()[0]) for c in (column, column + 1))
                middle = (low + high) / 2
                self.assertAlmostEqual(max(abs(y - middle) for y in ys) / (high - middle), largest / limit, delta=2e-3)

    def test_enlarged_points_are_the_strokes_first_and_last(self):
        stroke = [(float(r['x_mm']), float(r['a_rad']), r['step']) for r in self.rows if r['step'] != 'none']
        for name, rows in (('path-start', stroke[:10]), ('path-end', stroke[-10:])):
            odd, even = self.page.pictures[name].marks()[:2]
            self.assertEqual(len(odd), 5)
            self.assert_drawn(odd + even, [r[:2] for step in ('odd', 'even') for r in rows if r[2] == step])

    def long_plan(self, spikes):
        """The plan many times over, as so many passes; some odd points of it with errors like no other."""
        with open(FILES['plan']) as file:
            header, *lines = file.read().splitlines()
        rows = [line.split(',') for line in lines]
        path = self.path('long.csv')
        with open(path, 'w') as file:
            file.write(header + '\n')
            for i in range(30 * (len(rows) - 1)):
                row = list(rows[i % (len(rows) - 1)])
                # Pair ends stay on even cycles: the plan has an odd number of setpoints, of which the last is left out.
                row[:2] = [str(i), '%.17g' % (i * 1e-3)]
                row[4] = str(i // (len(rows) - 1))
                if row[5] == 'odd' and spikes and i % 50000 > 40000 and float(row[6]) > 15:
                    row[10] = repr(spikes.pop())
                file.write(','.join(row) + '\n')
        return path

    def test_no_point_is_lost_where_there_are_too_many_to_draw(self):
        self.assertEqual(len(self.rows) % 2, 1)
        page = self.report(self.long_plan(spikes=[1e-3, -0.9e-3]))
        self.assert_page(page, PATH + MOTION)
        self.assertEqual(page.rows['points'], [str(30 * (len(self.rows) - 1))])
        self.assertEqual(page.rows['strokes'], ['30'])
        self.assertEqual(page.rows['largest odd error'], ['1.0000e-03 rad'])
        for axis in 'XYZA':
            self.assertEqual(page.rows[axis], self.page.rows[axis])
        line, = page.pictures['error'].lines(1)
        heights = sorted(y for _, y in line)
        # The spikes stand out by much of the panel, upward and downward.
        self.assertGreater(heights[1] - heights[0], 30)
        self.assertGreater(heights[-1] - heights[-2], 30)


class TestBag(ReportCase):
    """Of the job that was run to its end; the figures are computed from the messages that the test received itself."""

    @classmethod
    def setUpClass(cls):
        cls.recording = FILES['recording']
        cls.batches = cls.recording.jobs[0]
        cls.setpoints = [s for b in cls.batches for s in b.setpoints]
        cls.page = cls.report(cls(), cls.recording.bag, '--job', '1')

    def test_bag_has_all_topics(self):
        with rosbag.Bag(self.recording.bag) as bag:
            topics = bag.get_type_and_topic_info().topics
        self.assertEqual(sorted(topics), ['/diagnostics', 'joint_states', 'recorded/grind/goal', 'recorded/grind/result',
                                          'recorded/machine', 'recorded/offsets', 'recorded/setpoints', 'recorded/state'])
        self.assertTrue(all(topic.message_count > 0 for topic in topics.values()))

    def test_bag_has_every_setpoint(self):
        with rosbag.Bag(self.recording.bag) as bag:
            cycles = [s.cycle for _, batch, _ in bag.read_messages('recorded/setpoints')
                      if batch.goal_id == self.batches[0].goal_id for s in batch.setpoints]
        self.assertEqual(cycles, list(range(len(self.setpoints))))

    def test_page(self):
        self.assert_page(self.page, PATH + MOTION + MEASURED + TOOL)
        self.assertRegex(self.page.rows['job'][0], r'^1 of 2 in the bag')
        self.assertEqual(self.page.rows['outcome'], ['done'])
        self.assertNotIn('missing', self.page.rows)
        self.assertNotIn('Left out', self.page.text)

    def test_figures_are_those_of_the_streamed_csv(self):
        of_csv = self.report(self.recording.csv)
        for name in ('points', 'duration', 'strokes', 'largest odd error', 'largest even error', 'largest feed'):
            self.assertEqual(self.page.rows[name], of_csv.rows[name], name)
        for axis in 'XYZA':
            self.assertEqual(self.page.rows[axis], of_csv.rows[axis])

    def test_errors_are_the_setpoints(self):
        stroke = [s for s in self.setpoints if s.move == STROKE]
        for name, is_odd in (('odd', True), ('even', False)):
            largest = max(abs(s.path_error) for s in stroke if (s.step == ODD) == is_odd)
            self.assertEqual(self.page.rows['largest %s error' % name], ['%.4e rad' % largest])

    def test_deviation_is_that_at_the_surface(self):
        helix = checks.Helix(gc.PAPER)
        largest = max(abs(s.path_error) * helix.radius(s.position[X]) * helix.normal for s in self.setpoints)
        self.assertAlmostEqual(self.figure(self.page, 'largest deviation'), largest / UM, delta=0.01 * largest / UM)

    def test_following_error_is_that_to_the_command_of_the_cycle_before(self):
        for axis, unit in enumerate(UNITS):
            errors = [before.position[axis] - s.actual[axis] for before, s in zip(self.setpoints, self.setpoints[1:])]
            largest = max(abs(e) for e in errors)
            self.assertEqual(self.page.rows['XYZA'[axis]][4].split()[0], '%.5g' % (largest / unit))
        limit = gc.machine()['constraints']['axis_x']['trajectory']
        self.assertEqual(self.page.rows['X'][5], '%.5g mm' % (limit / MM))

    def test_cycle_periods_add_up_to_the_time_that_went_by(self):
        periods = [s.cycle_period for s in self.setpoints]
        went_by = (self.batches[-1].end_stamp - self.batches[0].header.stamp).to_sec()
        self.assertAlmostEqual(sum(periods[1:]), went_by, delta=1e-5)

    def test_loop_timing(self):
        periods = [s.cycle_period for s in self.setpoints]
        self.assertEqual(self.page.rows['loop period'], ['%.3f to %.3f ms' % (min(periods) / 1e-3, max(periods) / 1e-3)])
        self.assertAlmostEqual(self.figure(self.page, 'mean loop period'), sum(periods) / len(periods) / 1e-3, delta=2e-6)
        late = sum(period > 1.5 * self.batches[0].period for period in periods)
        self.assertEqual(self.page.rows['late cycles'], ['%d over 1.5 periods' % late])

    def test_states_of_the_job(self):
        states = re.findall(r'(?m)^(-?\d+\.\d+) s(\w+)$', self.page.text)
        self.assertEqual([name for _, name in states], ['starting', 'running', 'ready'])
        times = [float(time) for time, _ in states]
        self.assertLess(times[0], times[1])
        # A loop that was late catches up, so that a job takes a few cycles more or less than it has.
        self.assertLessEqual((self.batches[-1].end_stamp - self.batches[0].header.stamp).to_sec() - 0.001, times[2])

    def test_diagnostics(self):
        self.assertEqual(self.page.rows['recorded: Drive link'][0], 'OK')
        # What a host that stalls makes of it is not the report's matter.
        self.assertIn(self.page.rows['recorded: Control loop'][0], ('OK', 'WARN', 'ERROR'))


class TestInterruptedJob(ReportCase):
    """The job in whose stroke Ctrl-C ended roslaunch: its bag is whole, and the report shows how far it came."""

    def test_last_job_is_reported_where_none_is_asked_for(self):
        page = self.report(FILES['recording'].bag)
        self.assert_page(page, PATH + MOTION + MEASURED + TOOL)
        self.assertRegex(page.rows['job'][0], r'^2 of 2 in the bag')
        received = [s for b in FILES['recording'].jobs[1] for s in b.setpoints]
        # The recorder was ended together with the grinder, and need not have got its last setpoints.
        count = int(page.rows['points'][0])
        self.assertTrue(1 < count <= len(received))
        stroke = [s for s in received[:count] if s.move == STROKE]
        self.assertGreater(stroke[-1].position[X], 5 * MM)
        largest = max(abs(s.path_error) for s in stroke if s.step == ODD)
        self.assertEqual(page.rows['largest odd error'], ['%.4e rad' % largest])


class TestMissingSetpoints(ReportCase):
    def test_gap_is_told_and_not_taken_for_motion(self):
        with open(FILES['plan']) as file:
            lines = file.readlines()
        # In a rapid: the difference over the gap would be far beyond the limit.
        with open(self.path('gap.csv'), 'w') as file:
            file.writelines(lines[:401] + lines[501:])
        page = self.report(self.path('gap.csv'))
        self.assertEqual(page.rows['missing'], ['100 setpoints are not in the file'])
        for axis in 'XYZA':
            speed, limit = (float(text.split()[0]) for text in page.rows[axis][:2])
            self.assertLessEqual(speed, limit * (1 + 1e-4))
            acceleration, limit = (float(text.split()[0]) for text in page.rows[axis][2:4])
            self.assertLessEqual(acceleration, limit * (1 + 1e-4))

    def test_job_that_ended_ahead_of_its_stroke(self):
        with open(FILES['plan']) as file:
            lines = file.readlines()
        with open(self.path('early.csv'), 'w') as file:
            file.writelines(lines[:601])
        page = self.report(self.path('early.csv'))
        self.assertEqual(list(page.pictures), ['speed', 'acceleration'])
        self.assertIn('the job ended before its first stroke', page.text)
        self.assertNotIn('largest odd error', page.rows)


class TestBadFiles(ReportCase):
    """Exit status 2, and the file with the reason; a report that was there before stays."""

    def check(self, source, reason, *arguments):
        output = self.path('kept.html')
        with open(output, 'w') as file:
            file.write('kept')
        done = gc.grind('report', source, '-o', output, *arguments)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stdout, '')
        self.assertRegex(done.stderr.rstrip('\n'), r'^%s: %s$' % (re.escape(source), reason))
        with open(output) as file:
            self.assertEqual(file.read(), 'kept')

    def changed(self, name, change):
        """A plan's CSV with other lines."""
        with open(FILES['plan']) as file:
            lines = file.read().splitlines()[:50]
        with open(self.path(name), 'w') as file:
            file.write('\n'.join(change(lines)))
        return self.path(name)

    def cut_bag(self, size):
        path = self.path('cut.bag')
        with open(FILES['recording'].bag, 'rb') as whole, open(path, 'wb') as cut:
            cut.write(whole.read()[:size])
        return path

    def replace(self, lines, line, column, value):
        row = lines[line - 1].split(',')
        row[column] = value
        return lines[:line - 1] + [','.join(row)] + lines[line:]

    def test_missing(self):
        self.check(self.path('nothing.csv'), 'cannot be read: No such file or directory')

    def test_folder(self):
        self.check(FILES['folder'], 'cannot be read: Is a directory')

    def test_empty(self):
        self.check(self.changed('empty.csv', lambda lines: []), 'is empty')

    def test_header_alone(self):
        self.check(self.changed('header.csv', lambda lines: lines[:1]), 'has no points; .*')

    def test_wrong_columns(self):
        self.check(self.changed('wrong.csv', lambda lines: ['t,x,y'] + lines[1:]),
                   'its first line is \'t,x,y\'; allowed: "point,.*", "cycle,.*", or a bag')

    def test_line_that_is_cut_off(self):
        self.check(self.changed('cut.csv', lambda lines: lines[:-1] + [lines[-1][:40]]), 'line 50: .*columns.*')

    def test_empty_line(self):
        self.check(self.changed('line.csv', lambda lines: lines[:9] + [''] + lines[9:]), 'line 10: is empty')

    def test_text_in_place_of_a_number(self):
        self.check(self.changed('text.csv', lambda lines: self.replace(lines, 20, 6, 'far')), 'line 20: .*far.*')

    def test_nan(self):
        self.check(self.changed('nan.csv', lambda lines: self.replace(lines, 20, 9, 'nan')),
                   'cycle 18: position is not a finite number')

    def test_unknown_move(self):
        self.check(self.changed('move.csv', lambda lines: self.replace(lines, 20, 2, 'polish')),
                   'cycle 18: move "polish"; allowed: lift, .*')

    def test_negative_tooth(self):
        self.check(self.changed('tooth.csv', lambda lines: self.replace(lines, 20, 3, '-1')),
                   'cycle 18: tooth = -1; allowed: 0 to 65535')

    def test_cycles_that_do_not_ascend(self):
        self.check(self.changed('order.csv', lambda lines: lines[:30] + lines[20:]),
                   'cycle 19 follows cycle 28; allowed: ascending cycles')

    def test_bag_that_is_cut_off(self):
        size = os.path.getsize(FILES['recording'].bag)
        for cut in (20, 5000, size // 2, size - 1):
            self.check(self.cut_bag(cut), 'the bag was not closed, or is cut off; .*')

    def test_bag_that_is_being_written(self):
        done = FILES['recording'].report_while_recording
        self.assertEqual(done.returncode, 2)
        self.assertIn('record.bag.active: the bag was not closed', done.stderr)

    def test_bag_without_setpoints(self):
        with rosbag.Bag(FILES['recording'].bag) as whole, rosbag.Bag(self.path('none.bag'), 'w') as bag:
            for topic, message, stamp in whole.read_messages('/diagnostics'):
                bag.write(topic, message, stamp)
        self.check(self.path('none.bag'), r'the bag has setpoints \(.*\) on no topic; allowed: one topic')

    def test_job_that_the_bag_does_not_have(self):
        self.check(FILES['recording'].bag, r'--job 3: the bag has 2 job\(s\)', '--job', '3')

    def test_output_that_cannot_be_written(self):
        output = self.path('no/such/folder.html')
        done = gc.grind('report', FILES['plan'], '-o', output)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stderr, output + ': cannot be written: No such file or directory\n')

    def test_machine_that_cannot_be_read(self):
        done = gc.grind('report', FILES['plan'], '-o', self.path('no.html'), '--machine', self.path('nothing.yaml'))
        self.assertEqual(done.returncode, 2)
        self.assertIn(self.path('nothing.yaml') + ': cannot be read', done.stderr)


if __name__ == '__main__':
    rospy.init_node('test_report')
    rostest.rosrun('flute_grinder', 'report', '__main__')
