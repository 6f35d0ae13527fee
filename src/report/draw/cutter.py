"""The cutter of a job file."""

import math


def process_of(file):
    """The operation of a job's file that was ground."""
    return next(each for each in file['operations'] if operation_name(each) == file['operation'])


def operation_name(operation):
    """The name of an operation on the command line."""
    if operation['kind'] == 'end':
        return 'end_' + operation['relief']
    return operation.get('relief', operation['kind'])


def spiral_angles(cutter):
    """The spiral angles of the teeth, or the one of all teeth [deg]."""
    return cutter.get('spiral_angles_deg') or [cutter['spiral_angle_deg']]


def tooth_angles(cutter):
    """The angles of the teeth [deg]."""
    return cutter.get('tooth_angles_deg') or [360 / cutter['teeth'] * i for i in range(cutter['teeth'])]


def radius(cutter, x_mm):
    """The radius of the cone at X [mm]."""
    return cutter['end_diameter_mm'] / 2 + x_mm * math.tan(math.radians(cutter['cone_angle_deg']))


def max_radius(cutter):
    """The largest radius of the flutes [mm]."""
    return max(radius(cutter, 0), radius(cutter, cutter['flute_length_mm']))
