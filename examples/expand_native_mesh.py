#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Expands a native mesh (.pcbmesh) into nodes, prisms and their tags: docs/native-mesh.md in numpy.

    python3 expand_native_mesh.py board.pcbmesh
"""
import sys

import h5py
import numpy as np


def expand(path):
    """nodes (n, 3) in metres; prisms (m, 6) in Gmsh order, bottom then top; tags (m,), as in tags.json."""
    with h5py.File(path) as f:
        points, triangles, regions = f["plane/points"][:], f["plane/triangles"][:], f["plane/regions"][:]
        z, slab, labels, volume_tags = f["levels/z"][:], f["levels/slab"][:], f["labels"][:], f["volumes/tag"][:]
    # Prism over triangle t in sub-layer k: there unless its region has no label in the slab.
    label = labels[regions][:, slab].T                       # (sub-layers, triangles)
    present = label >= 0
    # Node of point v at level k: there if a prism below or above uses it. Numbered level by level, point by point.
    used = np.zeros((len(z), len(points)), dtype=bool)
    for k in range(len(slab)):
        used[k:k + 2, triangles[present[k]].ravel()] = True
    number = np.cumsum(used).reshape(used.shape) - 1
    level, point = np.nonzero(used)
    nodes = np.column_stack([points[point], z[level]])
    k, t = np.nonzero(present)
    prisms = np.hstack([number[k[:, None], triangles[t]], number[k[:, None] + 1, triangles[t]]])
    return nodes, prisms, volume_tags[label[present]]


if __name__ == "__main__":
    nodes, prisms, tags = expand(sys.argv[1])
    a, b, c, d = (nodes[prisms[:, i]] for i in (0, 1, 2, 3))
    volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 2
    print(f"{len(nodes)} nodes, {len(prisms)} prisms, {volumes.sum() * 1e9:.6f} mm^3")
    for tag in np.unique(tags):
        print(f"  volume {tag}: {(tags == tag).sum()} prisms, {volumes[tags == tag].sum() * 1e9:.6f} mm^3")
