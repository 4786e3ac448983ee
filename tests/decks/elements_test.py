#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tetrahedral twins and elements of second order, as Gmsh sees them: Jacobians by its own shape functions, volumes by its quadrature."""
import json
import math
import pathlib
import sys
import tempfile

from program import SKIPPED, run

try:
    import gmsh
    import numpy
    from gmsh_reading import close, expect, faults
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

# A thick solid via in a board of one material: the barrel is a cylinder and nothing else has its tag.
DRILL, PAD = 0.8, 1.4
BOARD = {"pcbmesh_board": 1, "name": "round", "units": "mm", "nets": ["LINE", "GND"],
         "materials": [{"name": "FR4", "eps_r": 4.3, "tan_delta": 0.02}],
         "stackup": [{"name": "top", "kind": "copper", "thickness": 0.035}, {"name": "core", "kind": "dielectric", "thickness": 0.8, "material": "FR4"},
                     {"name": "bottom", "kind": "copper", "thickness": 0.035}],
         "outline": {"points": [[0, 0], [6, 0], [6, 5], [0, 5]]},
         "tracks": [{"layer": "top", "net": "LINE", "width": 0.4, "points": [[3, 2.5], [6, 2.5]]}],
         "vias": [{"at": [3, 2.5], "drill": DRILL, "pad": PAD, "net": "LINE"}],
         "planes": [{"layer": "bottom", "net": "GND"}]}
KINDS = {(1, "none", 18): {6}, (1, "tets", 18): {4}, (2, "none", 18): {13}, (2, "none", 15): {18}, (2, "tets", 18): {11}}


def make(folder, order, split, nodes):
    mesh = folder / f"{order}{split}{nodes}.msh"
    options = ["--order", order, "--split", split, "--tolerance", "5um"] + (["--wedge15"] if nodes == 15 else [])
    board = folder / "round.json"
    board.write_text(json.dumps(BOARD))
    done = run("mesh", board, "-o", mesh, *options)
    expect(done.returncode == 0, f"{mesh.name}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    report = json.loads(mesh.with_suffix("").with_suffix(".report.json").read_text())
    return mesh, json.loads(mesh.with_suffix("").with_suffix(".tags.json").read_text()), report


def read(mesh, tags, kinds):
    """Volume of each group by Gauss quadrature, nodes, and the least Jacobian over the points of two rules."""
    gmsh.clear()
    gmsh.open(str(mesh))
    numbers, coordinates, _ = gmsh.model.mesh.getNodes()
    volumes, least = {}, math.inf
    for group in tags["volumes"]:
        expect(gmsh.model.getPhysicalName(3, group["id"]) == group["name"], f"{mesh.name}: name of {group['id']}")
        count, size = 0, 0.0
        for entity in gmsh.model.getEntitiesForPhysicalGroup(3, group["id"]):
            found, elements, _ = gmsh.model.mesh.getElements(3, entity)
            expect(set(found) == kinds, f"{mesh.name}: elements of types {set(found)}")
            for kind, numbers_of_kind in zip(found, elements):
                count += len(numbers_of_kind)
                for rule in ("Gauss6", "Gauss2"):
                    points, weights = gmsh.model.mesh.getIntegrationPoints(kind, rule)
                    _, jacobians, _ = gmsh.model.mesh.getJacobians(kind, points, entity)
                    jacobians = numpy.asarray(jacobians).reshape(-1, len(weights))
                    # Relative to the element's own size: copper is a hundred times flatter than air.
                    least = min(least, float((jacobians / jacobians.mean(axis=1, keepdims=True)).min()))
                    if rule == "Gauss6":
                        size += float((jacobians @ numpy.asarray(weights)).sum())
        expect(count == group["num_cells"], f"{mesh.name}: {group['name']} has {count} cells, tags.json says {group['num_cells']}")
        volumes[group["id"]] = size
    return volumes, least, numpy.asarray(coordinates).reshape(-1, 3), numpy.asarray(numbers)


def main():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    with tempfile.TemporaryDirectory() as name:
        made = {key: make(pathlib.Path(name), *key) for key in KINDS}
        if faults:
            return 1
        found = {key: read(mesh, tags, KINDS[key]) for key, (mesh, tags, _) in made.items()}
        plain, least, points, _ = found[1, "none", 18]
        for key, (volumes, worst, nodes, _) in found.items():
            expect(worst > 0.1, f"{key}: least Jacobian {worst} of the mean")
            expect(close(sum(volumes.values()), sum(plain.values()), 1e-12), f"{key}: total volume {sum(volumes.values())}")
            expect(numpy.array_equal(nodes[:len(points)], points), f"{key}: corners moved")
            expect(len(numpy.unique(nodes, axis=0)) == len(nodes), f"{key}: duplicate nodes")
            print(f"{key}: {len(nodes)} nodes, least Jacobian {worst:.3f} of the mean")
        twin = found[1, "tets", 18][0]
        expect(all(close(twin[tag], plain[tag], 1e-12) for tag in plain), "volumes of the tetrahedral twin")
        expect(len(found[1, "tets", 18][2]) == len(points), "the twin has the same nodes")
        expect(made[1, "tets", 18][1]["volumes"][0]["num_cells"] == 3 * made[1, "none", 18][1]["volumes"][0]["num_cells"], "three per prism")
        curved = made[2, "none", 18][2]["second_order"]
        expect(curved["curved_edges"] > 50 and curved["folded_triangles"] == 0, f"arcs: {curved}")
        for key in ((2, "none", 15), (2, "tets", 18)):
            expect(all(close(found[key][0][tag], found[2, "none", 18][0][tag], 1e-12) for tag in plain), f"{key}: volumes differ")
        check_barrel(found, made)
        again = pathlib.Path(name) / "again.msh"
        run("mesh", pathlib.Path(name) / "round.json", "--study", made[2, "none", 15][0].with_suffix(".resolved.json"), "-o", again)
        expect(again.read_bytes() == made[2, "none", 15][0].read_bytes(), "the resolved study repeats order and kind of wedges")
        check_refusals(pathlib.Path(name))
        check_circles(found[2, "none", 18][2], points)
    gmsh.finalize()
    for fault in faults:
        print("FAULT:", fault)
    return 1 if faults else 0


def check_refusals(folder):
    for options, word in ((["--order", "3"], "order 3"), (["--split", "hexes"], "unknown split"), (["--order", "2", "--split", "tets", "--wedge15"], "18 nodes")):
        done = run("mesh", folder / "round.json", "-o", folder / "no.msh", *options)
        expect(done.returncode in (2, 3) and word in done.stderr, f"{options}: exit {done.returncode}, {done.stderr}")
        expect(not (folder / "no.msh").exists(), f"{options}: a mesh was written")


def check_barrel(found, made):
    """The part of the via in the core is a cylinder: straight chords miss its volume by far more than curved ones."""
    barrel, = [v["id"] for v in made[1, "none", 18][1]["volumes"] if v["name"].startswith("core|") and v["name"].endswith("|LINE")]
    exact = math.pi * (DRILL * 1e-3) ** 2 / 4 * 0.8e-3
    straight, curved = (abs(found[key][0][barrel] / exact - 1) for key in ((1, "none", 18), (2, "none", 18)))
    print(f"volume of the barrel: {straight:.2e} off with straight chords, {curved:.2e} with curved ones")
    expect(straight > 5e-3, f"the chords are too fine to prove anything: {straight}")
    expect(curved < 2e-5, f"the barrel is {curved} off its cylinder")


def check_circles(nodes, corners):
    """Middles of chords lie on the circles of drill and pad to a nanometre where the corners do."""
    for diameter in (DRILL, PAD):
        off = numpy.hypot(nodes[:, 0] - 3e-3, nodes[:, 1] - 2.5e-3) - diameter * 0.5e-3
        on_circle = numpy.abs(off[len(corners):]) < 1e-9
        expect(on_circle.sum() > 100, f"only {on_circle.sum()} middles on the circle of {diameter} mm")
        # None is left on a chord: those would be a sagitta inside.
        near = (off[len(corners):] < -1e-9) & (off[len(corners):] > -6e-6)
        print(f"circle of {diameter} mm: {on_circle.sum()} middles on it, {near.sum()} on chords")


sys.exit(main())
