#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gmsh reads every MSH variant the program writes, and meshio its VTU; counts, names and volumes agree with tags.json."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SKIP = 77
ROOT = pathlib.Path(os.environ.get("PCBMESH_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PROGRAM = os.environ.get("PCBMESH_PROGRAM", str(ROOT / "build/bin/pcbmesh"))
BOARD = ROOT / "examples/serpentine.json"

try:
    import gmsh
    import numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIP)
if not pathlib.Path(PROGRAM).exists() or not BOARD.exists():
    print(f"skipped: {PROGRAM} or {BOARD} is absent")
    sys.exit(SKIP)

faults = []


def expect(condition, text):
    if not condition:
        faults.append(text)


def close(a, b, tolerance=1e-9):
    return abs(a - b) <= tolerance * max(abs(a), abs(b))


def make(folder, name, *options):
    mesh = folder / name
    done = subprocess.run([PROGRAM, "mesh", str(BOARD), "-o", str(mesh), "--no-check", *options], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    return mesh, json.loads(mesh.with_suffix("").with_suffix(".tags.json").read_text())


def signed_volumes(corners, points):
    """Volumes of wedges with straight vertical edges: area of the bottom triangle times height, signed."""
    a, b, c, d = (points[corners[:, i]] for i in (0, 1, 2, 3))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 2


def areas(corners, points):
    a, b, c = (points[corners[:, i]] for i in (0, 1, 2))
    area = numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1)
    return area if corners.shape[1] == 4 else area / 2


def read_group(dimension, tag, index, points):
    """Number of elements and total size of one physical group; orientation is checked on the way."""
    count, size = 0, 0.0
    for entity in gmsh.model.getEntitiesForPhysicalGroup(dimension, tag):
        kinds, _, nodes = gmsh.model.mesh.getElements(dimension, entity)
        for kind, corners in zip(kinds, nodes):
            expect(kind in ((6,) if dimension == 3 else (2, 3)), f"element type {kind} in group {dimension} {tag}")
            corners = index[numpy.asarray(corners, dtype=numpy.int64)].reshape(-1, {2: 3, 3: 4, 6: 6}[kind])
            sizes = signed_volumes(corners, points) if dimension == 3 else areas(corners, points)
            expect((sizes > 0).all(), f"group {dimension} {tag} has elements turned inside out")
            count, size = count + len(corners), size + float(sizes.sum())
    return count, size


def outward_flux(index, points):
    """Volume by the divergence theorem over all faces: right only if every face is there, once, oriented outwards."""
    total = 0.0
    for kind, _, nodes in zip(*gmsh.model.mesh.getElements(2)):
        corners = index[numpy.asarray(nodes, dtype=numpy.int64)].reshape(-1, {2: 3, 3: 4}[kind])
        a, b, c = (points[corners[:, i]] for i in (0, 1, 2))
        centre = points[corners].mean(axis=1)
        normal = numpy.cross(b - a, c - a) * (1 if kind == 3 else 0.5)
        total += float(numpy.einsum("ij,ij->", centre - points.mean(axis=0), normal)) / 3
    return total


def check_msh(mesh, tags):
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
            count, size = read_group(dimension, group["id"], index, points)
            size *= unit**dimension
            expect(count == group[count_key], f"{mesh.name}: {group['name']}: {count} elements, tags.json says {group[count_key]}")
            expect(close(size, group[size_key]), f"{mesh.name}: {group['name']}: size {size}, tags.json says {group[size_key]}")
    for kind, corners in ((2, 3), (3, 4), (6, 6)):
        elements = numpy.sort(numpy.asarray(gmsh.model.mesh.getElementsByType(kind)[1]).reshape(-1, corners), axis=1)
        expect(len(numpy.unique(elements, axis=0)) == len(elements), f"{mesh.name}: elements of type {kind} twice")
    for dimension in (0, 1):
        expect(len(gmsh.model.mesh.getElements(dimension)[0]) == 0, f"{mesh.name}: elements of dimension {dimension}")
    total = sum(v["volume_m3"] for v in tags["volumes"])
    expect(close(outward_flux(index, points) * unit**3, total, 1e-7), f"{mesh.name}: faces don't enclose the volume")
    print(f"{mesh.name}: {len(points)} nodes, {sum(v['num_cells'] for v in tags['volumes'])} prisms, "
          f"{sum(f['num_faces'] for f in tags['faces'])} faces")


def check_vtu(mesh, tags):
    try:
        import meshio
    except ImportError:
        print("meshio is absent: the VTU is not read")
        return
    read = meshio.read(str(mesh))
    expect([block.type for block in read.cells] == ["wedge"], f"{mesh.name}: cells {[block.type for block in read.cells]}")
    volumes = signed_volumes(read.cells[0].data, read.points) * tags["unit_m"] ** 3
    expect((volumes > 0).all(), f"{mesh.name}: wedges turned inside out")
    tag = read.cell_data["volume_tag"][0]
    for volume in tags["volumes"]:
        expect((tag == volume["id"]).sum() == volume["num_cells"], f"{mesh.name}: count of {volume['name']}")
        expect(close(volumes[tag == volume["id"]].sum(), volume["volume_m3"]), f"{mesh.name}: volume of {volume['name']}")
    for name in ("layer_id", "material_id", "net_id"):
        expect(len(read.cell_data[name][0]) == len(tag), f"{mesh.name}: {name}")
    print(f"{mesh.name}: {len(tag)} wedges by meshio")


def main():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for mesh, options in (("b41.msh", []), ("a41.msh", ["--ascii"]), ("b22.msh", ["--msh-version", "2.2"]),
                              ("a22.msh", ["--msh-version", "2.2", "--ascii"]),
                              ("hollow41.msh", ["--conductors", "hollow", "--unit", "mm"]),
                              ("hollow22.msh", ["--conductors", "hollow", "--unit", "um", "--msh-version", "2.2"])):
            written, tags = make(folder, mesh, *options)
            check_msh(written, tags)
            is_hollow = any(face["kind"] == "conductor" for face in tags["faces"])
            expect(is_hollow == mesh.startswith("hollow"), f"{mesh}: conductor faces where none belong, or none where some do")
        check_vtu(*make(folder, "a.vtu"))
        check_vtu(*make(folder, "hollow.vtu", "--conductors", "hollow", "--unit", "mm"))
    gmsh.finalize()
    for fault in faults:
        print("FAULT:", fault)
    return 1 if faults else 0


sys.exit(main())
