#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes peg.stl and hole.stl to this folder: two solids of revolution in millimetres, axis z.

The peg's polygon is inside its circle and the hole's outside of its own, so the flats do not reduce the clearance:
the peg has 50 to 55 um of play in every direction.
"""
import math
import pathlib
import struct

SEGMENTS = 128
PEG_D, HOLE_D = 8.0, 8.05  # diametral clearance 50 um
PEG_LENGTH, HOLE_DEPTH = 30.0, 15.0
BLOCK_D, BLOCK_HEIGHT = 24.0, 20.0
CHAMFER = 1.0  # at 45 degrees, on the peg's lower end and the hole's mouth

# Closed outlines (radius, z), from axis to axis with the solid on the left.
PEG = [(0, 0), (PEG_D / 2 - CHAMFER, 0), (PEG_D / 2, CHAMFER), (PEG_D / 2, PEG_LENGTH), (0, PEG_LENGTH)]
HOLE = [(0, -BLOCK_HEIGHT), (BLOCK_D / 2, -BLOCK_HEIGHT), (BLOCK_D / 2, 0), (HOLE_D / 2 + CHAMFER, 0),
        (HOLE_D / 2, -CHAMFER), (HOLE_D / 2, -HOLE_DEPTH), (0, -HOLE_DEPTH)]


def lathe(outline, scale):
    """Triangles of the outline rotated about z, counter-clockwise from outside; radii times scale."""
    def ring(r, z):
        turns = [2 * math.pi * i / SEGMENTS for i in range(SEGMENTS)]
        # Adding 0.0 turns -0.0 on the axis into 0.0, so that equal vertices are equal to the bit.
        return [(scale * r * math.cos(a) + 0.0, scale * r * math.sin(a) + 0.0, z) for a in turns]

    triangles = []
    for (r0, z0), (r1, z1) in zip(outline, outline[1:]):
        a, b = ring(r0, z0), ring(r1, z1)
        for i in range(SEGMENTS):
            j = (i + 1) % SEGMENTS
            if r0 > 0:
                triangles.append((a[i], a[j], b[i]))
            if r1 > 0:
                triangles.append((a[j], b[j], b[i]))
    return triangles


def write_stl(path, triangles):
    """Binary STL. Normals are zero, since readers compute them from the winding."""
    with open(path, "wb") as out:
        out.write(b"bullet-vps sample, mm".ljust(80, b" ") + struct.pack("<I", len(triangles)))
        for corners in triangles:
            out.write(struct.pack("<12fH", 0, 0, 0, *(x for corner in corners for x in corner), 0))


folder = pathlib.Path(__file__).resolve().parent
write_stl(folder / "peg.stl", lathe(PEG, 1))
write_stl(folder / "hole.stl", lathe(HOLE, 1 / math.cos(math.pi / SEGMENTS)))
