# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes of elements, by numpy alone."""
import numpy


def close(a, b, tolerance=1e-9):
    return abs(a - b) <= tolerance * max(abs(a), abs(b))


def signed_volumes(corners, points):
    """Volumes of tetrahedra, and of wedges with straight vertical edges: area of the bottom triangle times height, signed."""
    a, b, c, d = (points[corners[:, i]] for i in (0, 1, 2, 3))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / (6 if corners.shape[1] == 4 else 2)


def areas(corners, points):
    a, b, c = (points[corners[:, i]] for i in (0, 1, 2))
    area = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1)
    return area if corners.shape[1] == 4 else area / 2
