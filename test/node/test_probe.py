"""Shows that the measuring probe finds what stands in the simulated machine: end face, diameter and run-out, and the first tooth;
that the work offsets follow; and that a stop ends it."""

import contextlib
import math
import os
import re
import signal
import subprocess
import threading

import rospy
import yaml
from actionlib_msgs.msg import GoalStatus
from flute_grinder.msg import GrinderState, GrindResult
from flute_grinder.srv import JogStep

import grinder_client as gc
from grinder_client import A, MM, X, Y, Z

BLANK = {'end_face': 17 * MM, 'diameter': 10 * MM, 'run_out': 0.02 * MM}
BALL = 1 * MM
# Where the ball's centre stands with the axes at zero, as in config/grinder.yaml.
BALL_X, BALL_Y, BALL_Z = 60 * MM, -20 * MM, 30 * MM
JOB = gc.package_file('jobs/unequal_d12_t4.yaml')
# The last touches move by 1.6 um in a cycle; a stalled host may make it some more.
TOUCH = 5e-6


class ProbeTest(gc.OwnNode):
    def setUp(self):
        self.folder = gc.temp_folder(self.addCleanup)

    def start(self, x=0.0, y=0.0, blank=BLANK, **changes):
        """Starts a node, ready, with the probe's ball at X in machine coordinates and a distance from the axis, at the axis' height."""
        parameters = gc.machine()
        # A client that a busy host leaves without a processor is not to count as gone.
        parameters['jog_timeout'] = 1.0
        parameters['probing'].update(velocity=dict(parameters['probing']['velocity'], axis_x=4 * MM, axis_y=4 * MM), slow=0.4)
        parameters.update(changes)
        hardware = parameters['hardware']
        if blank:
            hardware['blank'] = blank
        for joint, position in zip(gc.JOINTS, (x - BALL_X, y - BALL_Y, -BALL_Z)):
            hardware[joint]['start_position'] = position
        self.disk = gc.SlowDisk(self.folder)
        super().start(parameters, environment=self.disk.environment).make_ready()
        self.addCleanup(self.disk.release)

    def jog(self, axis, distance):
        reply = self.client._call('jog_step', JogStep, axis, distance, 5.0 if axis == A else 100 * MM)
        self.assertTrue(reply.success, reply.message)
        self.client.wait_state(GrinderState.READY)
        self.client.wait_rest()

    def cycle(self, *arguments):
        """Runs `grind probe`; what it printed, by its names."""
        return dict(re.split(r'  +', line, maxsplit=1) for line in self.said('probe', *arguments).splitlines())

    def command(self, *arguments):
        process = subprocess.Popen([gc.program('grind'), '--node', self.client.name, 'probe', *arguments],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def offset(self, axis):
        return self.json('offsets')['axes']['xyza'[axis]]


def number(text):
    return float(re.match(r'[-0-9.e]+', text).group())


class TestCycles(ProbeTest):
    def test_the_end_face_gives_the_stick_out_and_the_offset(self):
        self.start(14 * MM)
        self.check_goals()
        self.check_touches()
        said = self.cycle('end-face', '--job', JOB)
        for figure in ('end face', 'stick-out'):
            self.assertRegex(said[figure], r'^\d+\.\d{4} mm(, spread 0\.\d{4} mm)?$')
        self.assertAlmostEqual(number(said['end face']), 17, delta=TOUCH / MM)
        self.assertAlmostEqual(number(said['stick-out']), 45, delta=TOUCH / MM)
        zeros = self.json('zeros', JOB, '--stickout', '45')
        self.assertAlmostEqual(self.offset(X)['offset_mm'], zeros['x_mm'], delta=TOUCH / MM)
        self.assertIn('@', self.offset(X)['set_by'])
        # Off the surface again.
        self.assertAlmostEqual(self.client.wait_rest()[X] + BALL_X + BALL / 2, (17 - 0.5) * MM, delta=5e-6)
        # A flange mistyped.
        before = self.offset(X)['offset_mm']
        self.assertRegex(self.grind(1, 'probe', 'end-face', '--job', JOB, '--flange', '50').stderr,
                         'work offset of axis X would change by .* allowed without an answer: 5 mm')
        self.assertEqual(self.offset(X)['offset_mm'], before)
        self.grind(0, 'probe', 'end-face', '--job', JOB, '--flange', '50', '--answer', 'set-offset')
        self.assertGreater(abs(self.offset(X)['offset_mm'] - before), 5)

    def check_goals(self):
        self.assertIn('; allowed: up to 300 mm', self.client.probe(1.0).message)
        self.client.disable()
        self.assertIn('state disabled; allowed: ready', self.client.probe(1 * MM).message)
        self.client.make_ready()

    def check_touches(self):
        """They agree and are published; without a job no offset is set."""
        with self.client.probing(8 * MM) as cycle:
            self.assertTrue(cycle.wait_for_result(rospy.Duration(gc.PATIENCE)))
            result = cycle.get_result()
            self.assertEqual((cycle.get_state(), result.message), (GoalStatus.SUCCEEDED, ''))
            self.client.wait_for(lambda: len(cycle.feedback) == 4, 'the last feedback')
            self.assertEqual([(m.feedback.place, m.feedback.touch) for m in cycle.feedback], [(0, 0), (0, 1), (0, 2), (0, 3)])
        self.assertEqual([figure.name for figure in result.figures], ['end face', 'stick-out'])
        self.assertFalse(result.offset_set)
        self.assertEqual(self.offset(X)['set_by'], None)

    def test_a_machine_without_a_probe_and_zeros_by_the_grinders_own_geometry(self):
        geometry = gc.machine()['geometry']
        geometry['collet_face']['x'] += 1 * MM
        del geometry['probe']
        self.start(blank=None, geometry=geometry)
        self.assertEqual(self.grind(1, 'probe', 'diameter').stderr,
                         'probing refused: the machine has no parameter geometry/probe\n')
        reported = self.json('zeros', JOB, '--stickout', '45')
        self.said('zeros', JOB, '--stickout', '45', '--set')
        for axis, value in ((X, reported['x_mm'] + 1), (Y, reported['y_mm']), (Z, reported['z_mm'])):
            self.assertAlmostEqual(self.offset(axis)['offset_mm'], value, delta=1e-9)
        self.assertIsNone(self.offset(A)['set_by'])
        self.assertIn('--stickout = 20 mm; allowed: ', self.grind(1, 'zeros', JOB, '--stickout', '20', '--set').stderr)

    def test_a_blank_clamped_too_short_gives_its_figures_and_no_offset(self):
        self.start(39 * MM, blank=dict(BLANK, end_face=42 * MM))
        done = self.grind(1, 'probe', 'end-face', '--job', JOB)
        found = re.match(r"probing ended: stick-out = (\S+) mm; allowed: the flutes' length or more, ", done.stderr).group(1)
        self.assertIn('stick-out       %s mm\n' % found, done.stdout)
        self.assertAlmostEqual(float(found), 20, delta=TOUCH / MM)
        self.assertEqual(self.offset(X)['set_by'], None)

    def test_the_first_tooth_gives_the_offset_of_a(self):
        """A straight flute: its rake face is a plane, at the height of the wheel's upper face."""
        job = yaml.safe_load(open(JOB))
        job['cutter'].update(end_diameter_mm=10, cone_angle_deg=0, spiral_angle_deg=0, shank_diameter_mm=16,
                             rake_angle_deg=math.degrees(math.asin(1.2 / 5)), tooth_angles_deg=[0, 180])
        job['cutter'].update(gc.ANY_TOOL)
        job['process']['wheel'] = {'file': gc.package_file('wheels/straight_d100_w3.yaml')}
        job['process'].update(depth_mm=3.1, overtravel_mm=[1, 9], setup={'swivel_deg': 0, 'height_mm': 1.2 - 1.5})
        path = os.path.join(self.folder, 'straight.yaml')
        with open(path, 'w') as file:
            yaml.safe_dump(job, file)
        angle = 0.7
        self.start(14 * MM, 3 * MM, dict(BLANK, run_out=0.0, rake_face={'height': 1.2 * MM, 'angle': angle}))
        self.assertIn('probe the end face first', self.grind(1, 'probe', 'tooth', '--job', path).stderr)
        self.jog(A, angle + math.pi / 2)  # what is left of the end face comes before the ball
        self.cycle('end-face', '--job', path)
        self.jog(A, -1.7)  # not far from the tooth
        self.jog(Y, 7 * MM)
        self.jog(X, 12 * MM)
        self.jog(Y, -5.5 * MM)
        self.check_x_set_meanwhile(path)
        self.cycle('tooth', '--job', path)
        # The blank's rake face is horizontal at this angle of the machine, the job's at A = 0.
        self.assertAlmostEqual(self.offset(A)['offset_deg'], math.degrees(angle), delta=0.01)

    def check_x_set_meanwhile(self, path):
        """That A is not set by an X that another client changes during the cycle."""
        x = self.offset(X)['offset_mm'] * MM
        self.disk.stop()
        setting = threading.Thread(target=self.client.set_offset, args=(X, x + 1 * MM))
        setting.start()
        gc.poll(lambda: os.path.exists(self.node.folder + '/offsets.new'), 'the disk being written')
        seen = len(self.client.states)
        probe = self.command('tooth', '--job', path)
        self.client.wait_for(lambda: any(s.state == GrinderState.JOGGING for s in self.client.states[seen:]), 'the search')
        self.disk.release()
        setting.join()
        self.assertEqual(probe.communicate(timeout=gc.PATIENCE)[1],
                         'probing ended: the work offset of X was changed meanwhile; probe again\n')
        self.assertIsNone(self.offset(A)['set_by'])
        self.assertTrue(self.client.set_offset(X, x).success)


class TestStop(ProbeTest):
    @contextlib.contextmanager
    def begun(self):
        """While a search is under way, of 45 mm into nothing; gives the action's client."""
        self.jog(X, -95 * MM - self.client.wait_rest()[X])
        with self.client.probing(45 * MM) as cycle:
            self.client.wait_state(GrinderState.JOGGING)
            yield cycle

    def assert_stopped(self, cycle, state):
        self.assertTrue(cycle.wait_for_result(rospy.Duration(gc.PATIENCE)))
        self.assertEqual((cycle.get_state(), cycle.get_result().message), (state, 'probing ended: stopped'))
        self.assertLess(self.client.wait_rest()[X], 0)

    def test_stops_and_the_end_of_its_client_and_of_the_node(self):
        self.start(-30 * MM)
        with self.begun() as cycle:
            self.assertIn('probing refused: another probing cycle is in progress; ', self.client.probe(1 * MM).message)
            run = self.client.send(gc.SHORT).wait()
            # Between two touches the machine is ready, and the goal refused all the same.
            self.assertEqual(run.status, 'REJECTED')
            self.assertIn(run.code, (GrindResult.NOT_READY, GrindResult.BUSY))
            cycle.cancel_goal()
            self.assert_stopped(cycle, GoalStatus.PREEMPTED)
        for stop, state in ((self.client.hold, GrinderState.READY), (self.client.disable, GrinderState.DISABLED)):
            self.assertEqual(self.client.fresh_state().state, GrinderState.READY)
            with self.begun() as cycle:
                self.assertTrue(stop().success)
                self.assert_stopped(cycle, GoalStatus.ABORTED)
            self.assertEqual(self.client.fresh_state().state, state)
        self.client.make_ready()
        self.check_killed_client()
        with self.begun():
            self.node.process.terminate()
            self.assertEqual(self.node.process.wait(timeout=gc.PATIENCE), 0)

    def check_killed_client(self):
        self.jog(X, -95 * MM - self.client.wait_rest()[X])
        before = self.client.wait_rest()[X]
        client = self.command('end-face', '--job', JOB, '--within', '45')
        # For longer than a client that is gone may move the axis.
        self.client.wait_for(lambda: self.client.joints[-1].position[X] > before + 3 * MM, 'the search')
        client.send_signal(signal.SIGKILL)
        client.wait()
        self.client.wait_state(GrinderState.READY)
        # It would end at 45 mm; the host may stall.
        self.assertLess(self.client.wait_rest()[X], before + 44 * MM)
        self.assertIn('probing ended: its client was silent for 1 s; ~probe_alive is to be repeated', self.node.output)

    def test_ctrl_c_ends_a_cycle_between_its_touches_too(self):
        self.start(30 * MM, 7 * MM)
        before = self.client.wait_rest()[A]
        cycle = self.command('diameter')
        self.client.wait_for(lambda: abs(self.client.joints[-1].position[A] - before) > 0.1, 'the turn')
        cycle.send_signal(signal.SIGINT)
        self.assertEqual((cycle.wait(gc.PATIENCE), cycle.stderr.read()), (1, 'probing ended: stopped\n'))
        at = self.client.wait_rest()
        self.assertLess(at[A], before + math.pi - 0.1)
        self.assertEqual(self.client.fresh_state().state, GrinderState.READY)
