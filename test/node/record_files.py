"""Records of jobs, made without a grinder."""

import yaml

import grinder_client as gc


def wheel_of(process):
    """A wheel as records have it."""
    if 'file' not in process['wheel']:
        return process['wheel']
    with open(gc.package_file('jobs/' + process['wheel']['file'])) as text:
        wheel = yaml.safe_load(text)
    return dict({key: wheel[key] for key in wheel if key not in ('flange_mm', 'measured', 'dressed')}, wear_mm=0)


def job_of(path, operation=None):
    """A job file, or one of its operations, as records have it."""
    with open(gc.package_file(path)) as text:
        file = yaml.safe_load(text)
    for process in file.get('operations', [file.get('process')]):
        process['wheel'] = wheel_of(process)
    operations = file.get('operations', [])
    for before, relief in zip(operations, operations[1:]):
        for key in ('clearance_mm', 'spark_out', 'order', 'direction'):
            relief.setdefault(key, before[key])
    if operation is not None:
        file['process'] = file['operations'][operation]
        file['operation'] = file['process'].get('relief', file['process']['kind'])
    return file


def record_of(file, started, ended, outcome='done', complete=(True,), setpoints=0, name='job', wheel='wheel.yaml',
              dressed=''):
    """A record of a job whose figures are all as asked. @param complete of each stroke."""
    stroke = {'tooth': 1, 'pass': 1, 'depth_mm': 1, 'started_s': 0, 'duration_s': 1, 'feed_min_mm_min': 600,
              'feed_max_mm_min': 600, 'feed_min_x_mm': 0, 'deviation_um': 0, 'deviation_x_mm': 0,
              'following_error': {'x_um': 0, 'y_um': 0, 'z_um': 0, 'a_mdeg': 0}}
    return {'record': 1, 'machine': {'software': '0.1.0', 'period_ms': 1}, 'job': {'name': name, 'digest': '', 'file': file},
            'started': started, 'ended': ended, 'outcome': outcome, 'reason': '', 'first': {'tooth': 1, 'pass': 1},
            'passes': len(complete), 'wheel': {'name': wheel, 'dressed': dressed},
            'planned': {'feed_limits': []}, 'setpoints': {'written': setpoints, 'lost': 0},
            'late_cycles': {'count': 0, 'longest_ms': 1}, 'strokes': [dict(stroke, complete=whole) for whole in complete],
            'holds': [], 'overrides': []}
