#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Nastran, UNV, Abaqus and Exodus files as Gmsh's and meshio's own readers see them: nodes, counts, tags, names, volumes.
README's table of formats is the one the program prints."""
import contextlib
import io
import json
import pathlib
import sys
import tempfile

from program import ROOT, SKIPPED, run

try:
    import gmsh
    import meshio
    import numpy
    from gmsh_reading import close, expect, faults, signed_volumes
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

BOARD = ROOT / "examples/via.json"


def done(*arguments):
    result = run(*arguments)
    expect(result.returncode == 0, f"{arguments}: exit {result.returncode}\n{result.stdout}{result.stderr}")
    return result


def tetrahedron_volumes(corners, points):
    a, b, c, d = (points[corners[:, i]] for i in range(4))
    return numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6


def compare(what, reference, points, blocks, tolerance):
    """blocks: (tag, corners) of cells; the reference is what Gmsh reads of the MSH."""
    expect(len(points) == len(reference["points"]), f"{what}: {len(points)} nodes")
    off = numpy.abs(points - reference["points"]).max() if len(points) == len(reference["points"]) else numpy.inf
    expect(off <= tolerance * numpy.abs(reference["points"]).max(), f"{what}: nodes are off by {off}")
    volumes, counts = {}, {}
    for tag, corners in blocks:
        sizes = (signed_volumes if corners.shape[1] in (6, 15, 18) else tetrahedron_volumes)(corners, points)
        expect((sizes > 0).all(), f"{what}: group {tag} has elements turned inside out")
        volumes[tag] = volumes.get(tag, 0.0) + float(sizes.sum())
        counts[tag] = counts.get(tag, 0) + len(corners)
    expect(counts == reference["counts"], f"{what}: counts {counts}, expected {reference['counts']}")
    for tag, size in volumes.items():
        expect(close(size, reference["volumes"].get(tag, 0), max(tolerance, 1e-12)), f"{what}: volume of {tag} is {size}")
    print(f"{what}: {len(points)} nodes off by {off:.1e}, {sum(counts.values())} cells in {len(counts)} groups")


def gmsh_cells(kind):
    """Nodes by ascending number, (entity, corners) of cells, {entity: number of faces}."""
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    numbers = numpy.asarray(numbers, dtype=numpy.int64)
    index = numpy.full(numbers.max() + 1, -1, dtype=numpy.int64)
    order = numpy.argsort(numbers)
    index[numbers[order]] = numpy.arange(len(numbers))
    points = numpy.asarray(coordinates).reshape(-1, 3)[order]
    blocks, faces = [], {}
    for dimension, entity in gmsh.model.getEntities():
        found, elements, nodes = gmsh.model.mesh.getElements(dimension, entity)
        for one, tags, corners in zip(found, elements, nodes):
            if dimension == 3:
                expect(one == kind, f"element type {one}")
                width = gmsh.model.mesh.getElementProperties(one)[3]
                blocks.append((entity, index[numpy.asarray(corners, dtype=numpy.int64)].reshape(-1, width)))
            elif dimension == 2:
                faces[entity] = faces.get(entity, 0) + len(tags)
    return points, blocks, faces


def open_quietly(path):
    gmsh.clear()
    with contextlib.redirect_stdout(io.StringIO()):
        gmsh.open(str(path))


def reference_of(mesh, tags, kind):
    open_quietly(mesh)
    points, blocks, faces = gmsh_cells(kind)
    expect(faces == {f["id"]: f["num_faces"] for f in tags["faces"]}, f"{mesh.name}: faces {faces}")
    out = {"points": points, "counts": {}, "volumes": {}, "faces": faces, "tags": tags}
    for tag, corners in blocks:
        out["counts"][tag] = len(corners)
        out["volumes"][tag] = float((signed_volumes if kind == 6 else tetrahedron_volumes)(corners, points).sum())
    return out


def check_nastran(path, reference, kind):
    open_quietly(path)
    points, blocks, faces = gmsh_cells(kind)
    expect(faces == reference["faces"], f"{path.name}: Gmsh finds faces {faces}")
    # Sixteen characters hold ten digits of the smallest coordinates.
    compare(f"{path.name} by Gmsh", reference, points, blocks, 1e-10)


def check_unv(path, reference, kind):
    open_quietly(path)
    points, blocks, faces = gmsh_cells(kind)
    expect(faces == reference["faces"], f"{path.name}: Gmsh finds faces {faces}")
    # Gmsh reads the groups of data set 2467 without their names: these are read from the text.
    sets = path.read_text().split("    -1\n")
    groups = next(s for s in sets if s.startswith("  2467")).splitlines()[1:]
    found, at = {}, 0
    while at < len(groups):
        size = int(groups[at].split()[7])
        found[groups[at + 1]] = size
        at += 2 + (size + 1) // 2
    wanted = {g["name"][:40]: g["num_cells"] for g in reference["tags"]["volumes"]} | {g["name"][:40]: g["num_faces"] for g in reference["tags"]["faces"]}
    expect(found == wanted, f"{path.name}: groups {found}, expected {wanted}")
    compare(f"{path.name} by Gmsh", reference, points, blocks, 0)


def check_abaqus(path, reference, meshio_kind):
    with contextlib.redirect_stdout(io.StringIO()):
        read = meshio.read(str(path))
    expect({b.type for b in read.cells} == {meshio_kind}, f"{path.name}: kinds {[b.type for b in read.cells]}")
    names = [name for name in read.cell_sets if name.upper().startswith("V")]
    corners = numpy.concatenate([b.data for b in read.cells])
    blocks, sizes, first = [], [len(b.data) for b in read.cells], 0
    tag_of = {int(name.split("_")[0][1:]) for name in names}
    expect(tag_of == set(reference["counts"]), f"{path.name}: sets {sorted(names)}")
    # One element block per group, in the order of the tags.
    for tag, size in zip(sorted(tag_of), sizes):
        blocks.append((tag, corners[first:first + size]))
        first += size
    compare(f"{path.name} by meshio", reference, read.points, blocks, 1e-12)
    text = path.read_text()
    for face in reference["tags"]["faces"]:
        start = text.index(f"*SURFACE, NAME=S{face['id']}_")
        lines = text[start:].split("*", 2)[1].splitlines()[1:]
        expect(len(lines) == face["num_faces"], f"{path.name}: surface {face['name']} has {len(lines)} sides")


def check_exodus(path, reference, meshio_kind):
    try:
        import netCDF4
    except ImportError:
        print("python3-netcdf4 is absent: meshio does not read the Exodus file")
        return
    with netCDF4.Dataset(str(path)) as file:
        ids = [int(i) for i in file.variables["eb_prop1"][:]]
        names = [str(netCDF4.chartostring(row)) for row in file.variables["eb_names"][:]]
        sides = {int(i): len(file.dimensions[f"num_side_ss{k + 1}"]) for k, i in enumerate(file.variables["ss_prop1"][:])}
    expect(dict(zip(ids, names)) == {v["id"]: v["name"] for v in reference["tags"]["volumes"]}, f"{path.name}: names {names}")
    expect(sides == reference["faces"], f"{path.name}: side sets {sides}")
    read = meshio.read(str(path))
    expect({b.type for b in read.cells} == {meshio_kind}, f"{path.name}: kinds {[b.type for b in read.cells]}")
    compare(f"{path.name} by meshio", reference, read.points, list(zip(ids, (b.data for b in read.cells))), 0)


def check_readme():
    table = done("formats", "--markdown").stdout.strip()
    expect(table in (ROOT / "README.md").read_text(), "README's table of formats is not what 'pcbmesh formats --markdown' prints")
    known = {f["name"]: f for f in json.loads(done("formats", "--json").stdout)["meshes"]}
    expect(known["exodus"]["write"] and "wedge18" in known["exodus"]["kinds_written"], f"formats --json: {known['exodus']}")


def main():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.Verbosity", 0)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for stem, options, kind, meshio_kind in (("prisms", ["--conductors", "hollow", "--unit", "mm"], 6, "wedge"),
                                                 ("tets", ["--split", "tets"], 4, "tetra")):
            mesh = folder / f"{stem}.msh"
            done("mesh", BOARD, "-o", mesh, *options)
            tags = json.loads((folder / f"{stem}.tags.json").read_text())
            reference = reference_of(mesh, tags, kind)
            for ending, check, what in ((".bdf", check_nastran, kind), (".unv", check_unv, kind), (".inp", check_abaqus, meshio_kind),
                                        (".exo", check_exodus, meshio_kind)):
                done("convert", mesh, mesh.with_suffix(ending))
                check(mesh.with_suffix(ending), reference, what)
            # MFEM: no reader of it is packaged; ours, which shares no code with the writer, and the checker judge it.
            done("convert", mesh, mesh.with_suffix(".mesh"))
            expect("PASSED" in done("check", mesh.with_suffix(".mesh")).stdout, f"{stem}.mesh: the checker does not pass it")
            done("convert", mesh.with_suffix(".mesh"), folder / f"{stem}_again.msh")
            again = reference_of(folder / f"{stem}_again.msh", tags, kind)
            expect(again["counts"] == reference["counts"] and numpy.array_equal(again["points"], reference["points"]), f"{stem}: MFEM and back")
        check_readme()
    gmsh.finalize()
    for fault in faults:
        print("FAULT:", fault)
    return 1 if faults else 0


sys.exit(main())
