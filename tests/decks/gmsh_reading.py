# SPDX-License-Identifier: GPL-3.0-or-later
"""What Gmsh finds in a mesh file, compared with its tags.json. Faults are collected, so that one run tells all of them."""
import numpy
import gmsh

from mesh_sizes import areas, close, signed_volumes

faults = []


def expect(condition, text):
    if not condition:
        faults.append(text)


def read_group(dimension, tag, index, points, cell=6):
    """Number of elements and total size of one physical group; orientation is checked on the way."""
    count, size = 0, 0.0
    for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
        kinds, _, nodes = gmsh.model.mesh.getElements(dimension, entity)
        for kind, corners in zip(kinds, nodes):
            expect(kind in ((cell,) if dimension == 3 else (2, 3)), f"element type {kind} in group {dimension} {tag}")
            corners = index[numpy.asarray(corners, dtype=numpy.int64)].reshape(-1, {2: 3, 3: 4, 4: 4, 6: 6}[kind])
            sizes = signed_volumes(corners, points) if dimension == 3 else areas(corners, points)
            expect((sizes > 0).all(), f"group {dimension} {tag} has elements turned inside out")
            count, size = count + len(corners), size + float(sizes.sum())
    return count, size


def outward_flux(index, points, outer):
    """Volume by the divergence theorem over the outer faces: right only if every face is there, once, oriented outwards."""
    total = 0.0
    blocks = [block for group in outer for entity in gmsh.model.getEntitiesForPhysicalGroup(2, group) for block in zip(*gmsh.model.mesh.getElements(2, entity))]
    for kind, _, nodes in blocks:
        corners = index[numpy.asarray(nodes, dtype=numpy.int64)].reshape(-1, {2: 3, 3: 4}[kind])
        a, b, c = (points[corners[:, i]] for i in (0, 1, 2))
        centre = points[corners].mean(axis=1)
        normal = numpy.cross(b - a, c - a) * (1 if kind == 3 else 0.5)
        total += float(numpy.einsum("ij,ij->", centre - points.mean(axis=0), normal)) / 3
    return total


def check_msh(mesh, tags, cell=6):
    gmsh.clear()
    gmsh.open(str(mesh))
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    numbers = numpy.asarray(numbers, dtype=numpy.int64)
    points = numpy.asarray(coordinates).reshape(-1, 3)
    index = numpy.full(numbers.max() + 1, -1, dtype=numpy.int64)
    index[numbers] = numpy.arange(len(numbers))
    unit = tags["unit_m"]
    expect(len(numpy.unique(points, axis=0)) == len(points), f"{mesh.name}: duplicate nodes")
    used = numpy.concatenate([numpy.unique(index[numpy.asarray(n, dtype=numpy.int64)]) for n in gmsh.model.mesh.getElements(3)[2]])
    expect(len(numpy.unique(used)) == len(points), f"{mesh.name}: nodes that no prism uses")
    for dimension, groups, count_key, size_key in ((3, tags["volumes"], "num_cells", "volume_m3"), (2, tags["faces"], "num_faces", "area_m2")):
        found = {tag for _, tag in gmsh.model.getPhysicalGroups(dimension)}
        expect(found == {g["id"] for g in groups}, f"{mesh.name}: physical groups of dimension {dimension} are {sorted(found)}")
        for group in groups:
            name = gmsh.model.getPhysicalName(dimension, group["id"])
            expect(name == group["name"], f"{mesh.name}: group {dimension} {group['id']} is named '{name}', not '{group['name']}'")
            count, size = read_group(dimension, group["id"], index, points, cell)
            size *= unit**dimension
            expect(count == group[count_key], f"{mesh.name}: {group['name']}: {count} elements, tags.json says {group[count_key]}")
            expect(close(size, group[size_key]), f"{mesh.name}: {group['name']}: size {size}, tags.json says {group[size_key]}")
    for kind, corners in ((2, 3), (3, 4), (4, 4), (6, 6)):
        elements = numpy.sort(numpy.asarray(gmsh.model.mesh.getElementsByType(kind)[1]).reshape(-1, corners), axis=1)
        expect(len(numpy.unique(elements, axis=0)) == len(elements), f"{mesh.name}: elements of type {kind} twice")
    for dimension in (0, 1):
        expect(len(gmsh.model.mesh.getElements(dimension)[0]) == 0, f"{mesh.name}: elements of dimension {dimension}")
    total = sum(v["volume_m3"] for v in tags["volumes"])
    expect(close(outward_flux(index, points, [f["id"] for f in tags["faces"] if not f.get("inner")]) * unit**3, total, 1e-7), f"{mesh.name}: faces don't enclose the volume")
    print(f"{mesh.name}: {len(points)} nodes, {sum(v['num_cells'] for v in tags['volumes'])} prisms, "
          f"{sum(f['num_faces'] for f in tags['faces'])} faces")
