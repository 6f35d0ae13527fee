"""Goals of job files, for clients of the grinder; see docs/ros-interface.md."""

import pathlib
import subprocess

from flute_grinder.msg import GrindGoal

# The program in lib/flute_grinder of the workspace whose lib/python3/dist-packages/flute_grinder has this module.
GRIND = pathlib.Path(__file__).absolute().parents[3] / 'flute_grinder' / 'grind'


def goal(path, operation=None):
    """The goal that `grind run` sends for a job file, to the last bit; `operation` chooses one of several. Needs no ROS master.

    Raises ValueError, with the message of `grind`, if the file cannot be read or is refused."""
    which = ['--operation', str(operation)] if operation else []
    done = subprocess.run([str(GRIND), 'goal', *which, '--', str(path)], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE)
    if done.returncode == 2:
        raise ValueError(done.stderr.decode(errors='replace').strip())
    done.check_returncode()
    return GrindGoal().deserialize(done.stdout)
