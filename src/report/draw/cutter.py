"""The cutter of a job file."""

import math


def spiral_angles(cutter):
    """Of every tooth, or one for all [deg]."""
    return cutter.get('spiral_angles_deg') or [cutter['spiral_angle_deg']]


def tooth_angles(cutter):
    """[deg]"""
    return cutter.get('tooth_angles_deg') or [360 / cutter['teeth'] * i for i in range(cutter['teeth'])]


def radius(cutter, x_mm):
    """Of the cone [mm]."""
    return cutter['end_diameter_mm'] / 2 + x_mm * math.tan(math.radians(cutter['cone_angle_deg']))


def max_radius(cutter):
    """[mm]"""
    return max(radius(cutter, 0), radius(cutter, cutter['flute_length_mm']))
