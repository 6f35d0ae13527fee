#!/usr/bin/env python3
"""Write cutter.stl: the blank of the conical end mill, before its flutes are cut.

Binary STL in metres, in the frame `cutter` of urdf/grinder.urdf: the origin is
the centre of the small end face and +X points along the axis to the shank.
Run it after changing a dimension; it writes the mesh next to itself.
"""

import math
import os
import struct

END_DIAMETER = 0.010
CONE_HALF_ANGLE = math.radians(5.0)
FLUTE_LENGTH = 0.030
SHANK_DIAMETER = 0.016
SHANK_LENGTH = 0.048  # DIN 6535 for 16 mm; the collet grips the last 16 mm
SEGMENTS = 180  # 2 degrees each: no corners to be seen, and 72 kB


def profile():
    """The outline as (x, radius), from the axis at the small end to the axis at the shank's end."""
    end_radius = END_DIAMETER / 2
    large_radius = end_radius + FLUTE_LENGTH * math.tan(CONE_HALF_ANGLE)
    shank_radius = SHANK_DIAMETER / 2
    shank_end = FLUTE_LENGTH + SHANK_LENGTH
    return [
        (0.0, 0.0),
        (0.0, end_radius),
        (FLUTE_LENGTH, large_radius),
        (FLUTE_LENGTH, shank_radius),
        (shank_end, shank_radius),
        (shank_end, 0.0),
    ]


def revolve(outline):
    """Turn the outline about X into triangles that are counterclockwise seen from outside."""

    def point(x, radius, i):
        angle = 2 * math.pi * (i % SEGMENTS) / SEGMENTS
        return x, radius * math.cos(angle), radius * math.sin(angle)

    triangles = []
    for (x0, r0), (x1, r1) in zip(outline, outline[1:]):
        for i in range(SEGMENTS):
            a, b = point(x0, r0, i), point(x0, r0, i + 1)
            c, d = point(x1, r1, i), point(x1, r1, i + 1)
            # On the axis one edge of the quadrilateral shrinks to a point.
            if r0 > 0:
                triangles.append((a, b, c))
            if r1 > 0:
                triangles.append((b, d, c))
    return triangles


def normal(triangle):
    a, b, c = triangle
    u = [q - p for p, q in zip(a, b)]
    v = [q - p for p, q in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(k * k for k in n))
    return [k / length for k in n]


def main():
    triangles = revolve(profile())
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "cutter.stl")
    with open(path, "wb") as stl:
        # Readers take a file that begins with "solid" for ASCII.
        stl.write(b"blank of a conical end mill, metres".ljust(80))
        stl.write(struct.pack("<I", len(triangles)))
        for triangle in triangles:
            stl.write(struct.pack("<3f", *normal(triangle)))
            for vertex in triangle:
                stl.write(struct.pack("<3f", *vertex))
            stl.write(struct.pack("<H", 0))


if __name__ == "__main__":
    main()
