"""Bags of jobs, made without a grinder: of the setpoints that `grind plan --csv` lists, as if a drive had followed them with the errors
that a test gives it."""

import rosbag
import rospy
from actionlib_msgs.msg import GoalStatus
from flute_grinder import job as job_file
from flute_grinder.msg import GrindActionGoal, GrindActionResult, SetpointBatch, WrittenSetpoint

import grinder_client as gc


class Bag:
    """A bag of a grinder, to which jobs are added, one after another in time."""

    def __init__(self, path, period):
        self.bag, self.period, self.now, self.goals = rosbag.Bag(path, 'w'), period, 1000.0, 0

    def close(self):
        self.bag.close()

    def write(self, topic, message):
        self.bag.write('/grinder/' + topic, message, rospy.Time.from_sec(self.now))

    def add(self, job, operation, rows, ahead=0.0, first=(0, 0), text=None, **cutter):
        """A run of an operation from its rows, all of them or those from a pass `first` on, with A `ahead` of its setpoints.

        @param job a file; None: the goal is not in the bag. @param text in place of the job's name, and of what the result says."""
        self.goals += 1
        name = 'goal %d' % self.goals
        if job:
            self.write_goal(GrindActionGoal(goal=job_file.goal(job, operation)), name, first, text, cutter)
        last = [float(rows[0][key]) for key in ('x_mm', 'y_mm', 'z_mm', 'a_rad')]
        for begin in range(0, len(rows), 50):
            batch = SetpointBatch(goal_id=name, period=self.period)
            for row in rows[begin:begin + 50]:
                point = [float(row[key]) for key in ('x_mm', 'y_mm', 'z_mm', 'a_rad')]
                batch.setpoints.append(WrittenSetpoint(
                    cycle=int(row['cycle']), position=self.si(point), actual=self.si(last[:3] + [last[3] + ahead]), cycle_period=self.period,
                    path_error=float(row['error_rad']), feed=float(row['feed_mm_min']) * gc.MM_MIN,
                    move=gc.MOVES.index(row['move']), step=gc.STEPS.index(row['step']), tooth=int(row['tooth']),
                    pass_=int(row['pass'])))
                last = point
            batch.header.stamp = rospy.Time.from_sec(self.now)
            self.now += self.period * len(batch.setpoints)
            batch.end_stamp = rospy.Time.from_sec(self.now - self.period)
            self.write('setpoints', batch)
        result = GrindActionResult()
        result.status.goal_id.id, result.status.status = name, GoalStatus.SUCCEEDED
        result.result.error_string = text or ''
        self.write('grind/result', result)

    def write_goal(self, goal, name, first, text, cutter):
        goal.goal_id.id = name
        goal.goal.first_tooth, goal.goal.first_pass = first
        goal.goal.job_name = text or goal.goal.job_name
        for key, value in cutter.items():
            setattr(goal.goal.cutter, key, value)
        self.write('grind/goal', goal)
        self.write('job', goal)

    @staticmethod
    def si(point):
        return [value * gc.MM for value in point[:3]] + [point[3]]
