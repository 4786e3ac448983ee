#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Domains: polygons, perfectly matched layers, periodic pairs, symmetry planes; and every fault of study and board in one run."""
import json
import math
import pathlib
import sys
import tempfile

from program import DATA, ROOT, SKIPPED, run

try:
    import gmsh
    import numpy
    from gmsh_reading import check_msh, close, expect, faults
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

MICROSTRIP = ROOT / "examples/microstrip.json"
# A plane with a slot, and lines that cross the board from side to side: one straight, one slanted by just one period.
CELL = {
    "pcbmesh_board": 1, "units": "mm", "materials": [{"name": "core", "eps_r": 4, "tan_delta": 0.02}],
    "stackup": [{"name": "top", "kind": "copper", "thickness": "35um"}, {"name": "core", "kind": "dielectric", "thickness": "0.5mm", "material": "core"},
                {"name": "bottom", "kind": "copper", "thickness": "35um"}],
    "nets": ["GND", "A", "B"], "outline": {"rect": [[-20, -20], [20, 20]]},
    "tracks": [{"layer": "top", "net": "A", "width": "0.7mm", "points": [[-15, 1], [15, 1]]},
               {"layer": "top", "net": "B", "width": "0.3mm", "points": [[-15, 3.1], [-1, 3.1], [1, 2.6], [3, 3.1], [15, 3.1]]}],
    "planes": [{"layer": "bottom", "net": "GND", "rect": [[-18, -18], [18, 18]], "holes": [{"circle": {"at": [2, 2], "diameter": 1.5}}]}],
}


def put(folder, name, what):
    file = folder / name
    file.write_text(json.dumps(what))
    return file


def study(folder, name, **fields):
    return put(folder, f"{name}.study.json", {"schema_version": 1, **fields})


def mesh(folder, board, name, *options):
    file = folder / f"{name}.msh"
    done = run("mesh", board, "-o", file, *options)
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    report = json.loads(file.with_suffix(".report.json").read_text())
    expect(report["check"]["passed"], f"{name}: its check does not pass")
    return file, json.loads(file.with_suffix(".tags.json").read_text())


def refused(folder, board, code, words, *options):
    done = run("mesh", board, "-o", folder / "refused.msh", *options)
    expect(done.returncode == code and not (folder / "refused.msh").exists(), f"{words}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    for word in words:
        expect(word in done.stderr, f"no word of '{word}' in {done.stderr}")
    return done.stderr


def face(tags, name):
    found = [f for f in tags["faces"] if f["name"] == name]
    expect(len(found) == 1, f"{len(found)} faces called {name} among {[f['name'] for f in tags['faces']]}")
    return found[0] if found else {"id": 0, "area_m2": 0, "condition": "", "partner": None}


def nodes_of(tags, name):
    _, xyz = gmsh.model.mesh.getNodesForPhysicalGroup(2, face(tags, name)["id"])
    return numpy.asarray(xyz).reshape(-1, 3) * tags["unit_m"]


def area_of(corners):
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, corners[1:] + corners[:1]))


def polygons(folder):
    corners = [[4, 2], [11, 2], [14, 5.5], [10, 7], [8, 4.5], [4, 7.5]]
    with_sides = study(folder, "polygon", region={"polygon": corners}, boundaries={"side_3": "pec", "side": "pmc"}, air={"above": 1, "below": 0.5})
    for name, ring in (("left", corners), ("right", corners[::-1])):
        options = with_sides if name == "left" else study(folder, "turned", region={"polygon": ring}, boundaries={"all": "pmc", "side_3": "pec"}, air={"above": 1, "below": 0.5})
        file, tags = mesh(folder, MICROSTRIP, name, "--study", options)
        check_msh(file, tags)
        height = tags["bounding_box_m"]["max"][2] - tags["bounding_box_m"]["min"][2]
        expect(close(sum(v["volume_m3"] for v in tags["volumes"]), abs(area_of(corners)) * 1e-6 * height, 1e-6), f"{name}: volume of the polygon")
        for i, (a, b) in enumerate(zip(ring, ring[1:] + ring[:1])):
            side = face(tags, f"side_{i + 1}")
            expect(close(side["area_m2"], math.dist(a, b) * 1e-3 * height, 1e-6), f"{name}: area of side_{i + 1}: {side['area_m2']}")
            expect(side["condition"] == ("pec" if i == 2 else "pmc"), f"{name}: side_{i + 1} is {side['condition']}")
        expect(not [f for f in tags["faces"] if f["name"] in ("xmin", "xmax", "ymin", "ymax", "side")], f"{name}: sides of a box on a polygon")
        resolved = json.loads((folder / f"{name}.resolved.json").read_text())
        expect(resolved["region"]["polygon"] and resolved["boundaries"]["side_3"] == "pec", f"{name}: resolved study")
    for words, region, more in ((["/region/polygon", "crosses itself near (2, 2)"], [[0, 0], [4, 4], [4, 0], [0, 4]], {}),
                                (["encloses nothing"], [[0, 0], [4, 4]], {}),
                                (["touches itself at its corner (2, 0) mm"], [[0, 0], [4, 0], [4, 4], [2, 0], [0, 4]], {}),
                                (["lies at (4, 0) mm as corner 2 does"], [[0, 0], [4, 0], [4, 0], [0, 4]], {}),
                                (["/boundaries/side_4", "side_1 to side_3"], [[0, 0], [8, 0], [8, 8]], {"boundaries": {"side_4": "pec"}}),
                                (["/boundaries/xmin", "has no side xmin"], [[0, 0], [8, 0], [8, 8]], {"boundaries": {"xmin": "pec"}}),
                                (["/boundaries/xmin", "above and below only"], [[0, 0], [8, 0], [8, 8]], {"boundaries": {"xmin": {"kind": "pml", "thickness": 1}}}),
                                (["/ports/0/at/side", "the region is a polygon"], [[0, 0], [8, 0], [8, 8]], {"ports": [{"name": "P", "net": "LINE", "at": {"side": "xmin"}}]})):
        refused(folder, MICROSTRIP, 2, words, "--study", study(folder, "bad", region={"polygon": region}, **more))
    refused(folder, MICROSTRIP, 3, ["beside the board"], "--study", study(folder, "away", region={"polygon": [[30, 30], [40, 30], [40, 40]]}))
    out = study(folder, "out", region={"polygon": [[4, 2], [11, 2], [11, 8], [7, 4], [4, 8]]}, ports=[{"name": "P", "net": "LINE", "at": {"point": [7, 5.2]}}])
    refused(folder, MICROSTRIP, 3, ["/ports/0", "outside the domain"], "--study", out)


def matched_layers(folder):
    """Volumes of the shell are known: what lies at its inner face goes straight on."""
    layer = {"kind": "pml", "thickness": 2, "layers": 3}
    options = study(folder, "shell", region={"box": {"min": [6, 3.5], "max": [14, 8.5]}}, air={"above": 1, "below": 1}, conductors={"mode": "solid"},
                    boundaries={"all": "none", "xmin": layer, "xmax": layer, "ymax": {**layer, "thickness": 1, "layers": 2, "backing": "pmc"}, "zmax": layer})
    file, tags = mesh(folder, MICROSTRIP, "shell", "--study", options)
    check_msh(file, tags)
    shell = tags["shell"]
    board_height, line = 0.578e-3, 1.1e-3
    expect(numpy.allclose(shell["inner_m"]["min"], [6e-3, 3.5e-3, -1e-3]) and numpy.allclose(shell["outer_m"]["max"], [16e-3, 9.5e-3, board_height + 3e-3]), f"shell: {shell}")
    expect(shell["order"] == 2, f"shell: order {shell['order']}")
    volumes = {}
    for v in tags["volumes"]:
        volumes[v["stretched"]] = volumes.get(v["stretched"], 0) + v["volume_m3"]
        expect(v["name"].endswith(f"|pml {v['stretched']}") == (v["stretched"] is not None), f"shell: name {v['name']}")
    height, x, y = board_height + 2e-3, 8e-3, 5e-3
    wanted = {None: x * y * height, "x": 4e-3 * y * height, "y": x * 1e-3 * height, "xy": 4e-6 * height, "z": x * y * 2e-3, "xz": 4e-3 * y * 2e-3, "yz": x * 1e-3 * 2e-3, "xyz": 4e-6 * 2e-3}
    expect(volumes.keys() == wanted.keys() and all(close(volumes[k], wanted[k], 1e-6) for k in wanted), f"shell: volumes {volumes}, not {wanted}")
    # The line and the plane go on to the outer faces.
    for net, width, layer_name in (("LINE", line, "top"), ("GND", y, "bottom")):
        v = [v for v in tags["volumes"] if v["layer"] == layer_name and v["net"] == net and v["stretched"] == "x"]
        expect(len(v) == 1 and close(v[0]["volume_m3"], 4e-3 * width * 35e-6, 1e-4), f"shell: {net} in it: {v}")
    for name, condition in (("xmin", "pec"), ("ymax", "pmc"), ("ymin", "none"), ("zmax", "pec"), ("zmin", "none")):
        expect(face(tags, name)["condition"] == condition, f"shell: {name} is {face(tags, name)['condition']}")
    # At least so many elements across: levels above, lines of the plan beside.
    levels = next(l["levels_m"] for l in tags["layers"] if l["name"] == "pml above")
    expect(len(levels) >= 4, f"shell: levels {levels}")
    gmsh.clear()
    gmsh.open(str(file))
    xyz = gmsh.model.mesh.getNodes()[1].reshape(-1, 3) * tags["unit_m"]
    for at in (16e-3 - 2e-3 / 3, 16e-3 - 4e-3 / 3, 4e-3 + 2e-3 / 3):
        expect((abs(xyz[:, 0] - at) < 2e-9).sum() > 10, f"shell: no line at x = {at}")
    native = folder / "shell.pcbmesh"
    mesh_native = run("mesh", MICROSTRIP, "--study", options, "-o", native)
    expect(mesh_native.returncode == 0 and run("check", native).returncode == 0, f"shell: native {mesh_native.stderr}")
    for words, fields in ((["/boundaries/zmax", "/air/above"], {"air": {"above": 0}, "boundaries": {"zmax": layer}}),
                          (["/boundaries/xmin", "/air/around"], {"boundaries": {"xmin": layer}}),
                          (["/boundaries/side", "cut-outs"], {"boundaries": {"side": layer}}),
                          (["/boundaries/zmax/layers", "1 to 50"], {"boundaries": {"zmax": {**layer, "layers": 0}}}),
                          (["/boundaries/zmax/order", "one order"], {"boundaries": {"zmax": layer, "zmin": {**layer, "order": 3}}}),
                          (["/boundaries/zmax/backing"], {"boundaries": {"zmax": {**layer, "backing": "periodic"}}}),
                          (["/ports/0/at/side", "which is pml"], {"region": {"box": {"min": [6, 3.5], "max": [14, 8.5]}}, "boundaries": {"xmin": layer}, "ports": [{"name": "P", "net": "LINE", "at": {"side": "xmin"}}]})):
        refused(folder, MICROSTRIP, 2, words, "--study", study(folder, "bad", **fields))
    for solver in ("palace", "getdp", "elmer"):
        refused(folder, MICROSTRIP, 2, [f"the deck of {solver} has no perfectly matched layers", "absorbing"], "--problem", "eigenmode", "--for", solver, "--study", study(folder, "deck", boundaries={"zmax": layer}))
    done = run("mesh", MICROSTRIP, "--boundary", "zmax=pml", "-o", folder / "refused.msh")
    expect(done.returncode == 2 and "thickness" in done.stderr, f"shell without thickness: {done.stderr}")


def links_in_gmsh(file, tags, pairs, what):
    """Gmsh knows each side of a pair, its partner, and every node's partner, which lies one period away."""
    gmsh.clear()
    gmsh.open(str(file))
    for side, partner in pairs:
        master, nodes, masters, affine = gmsh.model.mesh.getPeriodicNodes(2, face(tags, side)["id"])
        expect(master == face(tags, partner)["id"] and set(nodes) == set(gmsh.model.mesh.getNodesForPhysicalGroup(2, face(tags, side)["id"])[0]), f"{what}: {side} has {len(nodes)} links to {master}")
        place = {n: numpy.array(gmsh.model.mesh.getNode(n)[0]) for n in (*nodes, *masters)}
        axis = "xy".index(side[0])
        period = numpy.eye(3)[axis] * (tags["bounding_box_m"]["max"][axis] - tags["bounding_box_m"]["min"][axis]) / tags["unit_m"]
        expect(len(nodes) > 20 and len(set(masters)) == len(nodes) and all(numpy.abs(place[n] - place[m] - period).max() < 1e-12 for n, m in zip(nodes, masters)), f"{what}: partners of {side} lie elsewhere")
        expect(len(affine) == 16 and numpy.allclose(numpy.reshape(affine, (4, 4)), [[*row, p] for row, p in zip(numpy.eye(3), period)] + [[0, 0, 0, 1]], atol=1e-12), f"{what}: transformation of {side} is {affine}")


def links_22(file):
    """(side, partner) -> (transformation, pairs of nodes) of $Periodic in MSH 2.2, which is text in binary files too."""
    rows = iter(file.read_bytes().split(b"$Periodic\n")[1].split(b"$EndPeriodic")[0].decode().splitlines())
    found = {}
    for _ in range(int(next(rows))):
        dimension, side, partner = map(int, next(rows).split())
        word, *affine = next(rows).split()
        expect(word == "Affine", f"{file.name}: {word}")
        pairs = {tuple(map(int, next(rows).split())) for _ in range(int(next(rows)))}
        if dimension == 2:
            found[side, partner] = (tuple(map(float, affine)), pairs)
    return found


def links_as_gmsh_writes_them(file, newer, folder):
    """Gmsh 4.8 passes over $Periodic of version 2.2, its own as well; so ours is held against what Gmsh writes for the same mesh in 4.1."""
    gmsh.clear()
    gmsh.open(str(newer))
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    gmsh.write(str(folder / "gmsh.msh"))
    ours, theirs = links_22(file), links_22(folder / "gmsh.msh")
    expect(ours == theirs and len(ours) > 0, f"{file.name}: {list(ours)}, Gmsh writes {list(theirs)}")


def periodic_pairs(folder):
    board = put(folder, "cell.json", CELL)
    sides = {"xmin": "periodic", "xmax": "periodic"}
    cell = {"box": {"min": [-4, -1], "max": [5, 4.5]}}
    for name, fields in (("cell", {}), ("hex", {"mesh": {"seed": "hex", "smooth": True}}), ("fine", {"mesh": {"edge_at_copper": 0.1, "longest_edge": 1}}), ("hollow", {"conductors": {"mode": "hollow"}}),
                         ("sheet", {"conductors": {"mode": "sheet"}}), ("tets", {"output": {"split": "tets"}})):
        file, tags = mesh(folder, board, name, "--study", study(folder, name, region=cell, boundaries=sides, **fields))
        low, high = face(tags, "xmin"), face(tags, "xmax")
        expect(low["condition"] == high["condition"] == "periodic" and low["partner"] == "xmax" and high["partner"] == "xmin", f"{name}: {low} {high}")
        gmsh.clear()
        gmsh.open(str(file))
        one, other = (numpy.array(sorted(map(tuple, numpy.round(nodes_of(tags, side)[:, 1:] * 1e9)))) for side in ("xmin", "xmax"))
        if name != "tets":
            links_in_gmsh(file, tags, (("xmax", "xmin"),), name)
        expect(len(one) > 20 and one.shape == other.shape and (one == other).all(), f"{name}: nodes of the two sides differ")
        verdict = json.loads(run("check", file, "--json").stdout)
        expect(verdict["passed"] and not [f for f in verdict["findings"] if f["code"].startswith("periodic")], f"{name}: {verdict['findings']}")
    # Both pairs at once, and layers above: the cell of an endless array.
    both = study(folder, "both", region={"box": {"min": [-4, -8], "max": [5, 0]}}, boundaries={"all": "periodic", "side": "none", "zmin": {"kind": "pml", "thickness": 1}, "zmax": {"kind": "pml", "thickness": 1}})
    for options in ((), ("--ascii",), ("--msh-version", "2.2"), ("--msh-version", "2.2", "--ascii"), ("--unit", "mm")):
        file, tags = mesh(folder, board, "both", "--study", both, *options)
        if "2.2" in options:
            links_as_gmsh_writes_them(file, folder / "newest.msh", folder)
        else:
            links_in_gmsh(file, tags, (("xmax", "xmin"), ("ymax", "ymin")), f"both pairs {options}")
            (folder / "newest.msh").write_bytes(file.read_bytes())
        verdict = json.loads(run("check", file, "--json").stdout)
        expect(verdict["passed"] and not verdict["findings"], f"both pairs {options}: {verdict['findings']}")
    file, tags = mesh(folder, board, "deck", "--study", study(folder, "deck", region=cell, boundaries={"all": "pec", **sides}), "--problem", "eigenmode", "--for", "getdp")
    expect(list(links_22(file)) == [(face(tags, "xmax")["id"], face(tags, "xmin")["id"])], f"GetDP's numbers: {list(links_22(file))}")
    expect(face(tags, "ymin")["partner"] is None, "one pair")
    _, tags = mesh(folder, board, "both", "--study", both)
    expect(face(tags, "ymin")["partner"] == "ymax" and face(tags, "zmax")["condition"] == "pec", "both pairs")
    words = refused(folder, board, 2, ["/boundaries/xmin", "layer top", "copper of B", "across from it", "whole number of periods"], "--study",
                    study(folder, "cut", region={"box": {"min": [1, -1], "max": [8, 4.5]}}, boundaries=sides))
    expect("at (1, " in words, f"place of the mismatch: {words}")
    refused(folder, board, 2, ["/boundaries/xmin", "needs its partner"], "--study", study(folder, "one", region=cell, boundaries={"xmin": "periodic"}))
    refused(folder, board, 2, ["/boundaries/zmin", "can't be periodic"], "--study", study(folder, "up", region=cell, boundaries={"zmin": "periodic", "zmax": "periodic"}))
    refused(folder, board, 2, ["/ports/0/at/side", "which is periodic"], "--study", study(folder, "port", region=cell, boundaries=sides, ports=[{"name": "P", "net": "A", "at": {"side": "xmin"}}]))


def symmetry_planes(folder):
    """Half a line beside its plane of symmetry has half its volumes, and half its capacitance wherever a solver is there."""
    half = {}
    for name, box in (("whole", [[6, 2], [14, 8]]), ("half", [[6, 5], [14, 8]])):
        file, tags = mesh(folder, MICROSTRIP, name, "--region", ",".join(f"{v}mm" for corner in box for v in corner), "--boundary", "all=none", "--boundary", "ymin=pmc", "--conductors", "solid")
        check_msh(file, tags)
        half[name] = {v["name"]: v["volume_m3"] for v in tags["volumes"]}
        expect(face(tags, "ymin")["condition"] == "pmc", f"{name}: ymin")
    for name, volume in half["half"].items():
        expect(close(volume, half["whole"][name] / 2, 1e-6), f"half: {name} {volume}")
    # A port stands on the half of the line that is left, up to the plane itself.
    _, tags = mesh(folder, MICROSTRIP, "port", "--region", "6mm,5mm,14mm,8mm", "--boundary", "ymin=pmc", "--conductors", "hollow", "--port", "P1,net=LINE,at=xmin")
    expect(close(tags["ports"][0]["width_m"], 0.55e-3, 1e-6), f"port on half a line: {tags['ports']}")


def all_faults_in_one_run(folder):
    """Ten wrong things, of the study by itself and of the study on this board."""
    board = json.loads(MICROSTRIP.read_text())
    wrong = study(folder, "wrong", solver="getdp", sweep={"from": 2e9, "to": 1e9, "points": 0}, mesh={"frequency": 1e15, "min_angle_deg": 50}, modes={"number": 0},
                  limits={"max_prisms": 0}, conductors={"mode": "hollow", "rules": [{"net": "GRND", "mode": "solid"}, {"layer": "tpo", "mode": "solid"}]},
                  backdrill=[{"net": "", "from": "top", "to": "bottom"}], materials={"use": [{"board": "RO4350", "take": "FR-4"}]},
                  ports=[{"name": "a", "net": "LINE", "reference": "LINE", "at": {"pin": "J1.1"}}, {"name": "b", "net": "LINE", "at": {"pin": "J9.1"}}])
    told = refused(folder, MICROSTRIP, 2, ["/sweep/points", "/sweep/to", "/mesh/frequency", "/mesh/min_angle_deg", "/modes/number", "/limits/max_prisms", "/ports/0/reference", "/backdrill/0",
                                           "'GRND'", "did you mean 'GND'", "'tpo'", "/materials/use", "RO4350B", "wrong.study.json:"], "--study", wrong)
    expect(told.count("\n") >= 10, f"not one line a fault: {told}")
    # Where names are right, ports are looked at too, each fault with its line in the study.
    wrong = study(folder, "ports", solver="getdp", sweep={"from": 1e9, "to": 2e9, "points": 0}, mesh={"frequency": 1e15}, ports=[
        {"name": "a", "net": "LINE", "at": {"pin": "J9.1"}}, {"name": "b", "net": "LINE", "at": {"point": [12, 7]}}, {"name": "c", "net": "LINE", "reference": "LINE", "at": {"pin": "J1.1"}},
        {"name": "d", "net": "NONE", "at": {"pin": "J1.1"}}])
    told = refused(folder, MICROSTRIP, 2, ["/sweep/points", "/mesh/frequency", "/ports/2/reference", "no pin 'J9.1'", "no copper at (12, 7)", "'NONE'"], "--study", wrong)
    expect(told.count("/ports/2") == 1, f"port c is told twice: {told}")
    # A layer without permittivity: fine for looking, not for a field solver.
    kicad = folder / "nameless.kicad_pcb"
    kicad.write_text("""(kicad_pcb (version 20240108) (generator "pcbnew") (general (thickness 1.6)) (layers (0 "F.Cu" signal) (31 "B.Cu" signal) (44 "Edge.Cuts" user))
 (setup (stackup (layer "F.Cu" (type "copper") (thickness 0.035)) (layer "dielectric 1" (type "core") (thickness 1.51) (material "Unobtainium 9000")) (layer "B.Cu" (type "copper") (thickness 0.035))))
 (net 0 "") (net 1 "A") (net 2 "GND") (gr_rect (start 0 0) (end 10 10) (stroke (width 0.1) (type solid)) (fill none) (layer "Edge.Cuts"))
 (segment (start 2 5) (end 8 5) (width 1) (layer "F.Cu") (net 1)) (segment (start 2 5) (end 8 5) (width 5) (layer "B.Cu") (net 2)))
""")
    done = run("mesh", kicad, "-o", folder / "nameless.msh")
    expect(done.returncode == 0 and "Unobtainium" in done.stderr, f"nameless: {done.returncode} {done.stderr}")
    solve = ("--problem", "electrostatic", "--for", "getdp")
    refused(folder, kicad, 3, ["layer 'dielectric 1' has no permittivity", "Unobtainium 9000", '"take": "FR-4"'], *solve)
    named = study(folder, "named", materials={"use": [{"board": "Unobtainium 9000", "take": "Megtron 6"}]})
    done = run("mesh", kicad, "--study", named, *solve, "-o", folder / "named.msh")
    expect(done.returncode == 0, f"named: {done.returncode} {done.stderr}")
    expect(board["materials"], "the example has materials")


def real_board(folder):
    """A routed pair: a piece of it as the cell of an endless line, a shell round a part, a polygon."""
    board = DATA / "kicad/04_antmicro_si_test_4L_v6.kicad_pcb"
    if not board.is_file():
        print(f"not looked at: {board} is absent")
        return
    hollow = {"conductors": {"mode": "hollow"}, "mesh": {"height_policy": "none"}}
    for name, region, boundaries in (("pair", {"box": {"min": [104.3, -111.9], "max": [109.1, -109.6]}}, {"xmin": "periodic", "xmax": "periodic"}),
                                     ("part", {"box": {"min": [100, -120], "max": [115, -105]}}, {"all": {"kind": "pml", "thickness": 2}, "side": "none"}),
                                     ("cut", {"polygon": [[100, -120], [115, -118], [118, -105], [108, -109], [101, -100]]}, {"side_2": "pmc"})):
        file, tags = mesh(folder, board, name, "--study", study(folder, name, region=region, boundaries=boundaries, **hollow))
        check_msh(file, tags)
    refused(folder, board, 2, ["/boundaries/xmin", "layer In1.Cu", "copper of GND"], "--study",
            study(folder, "off", region={"box": {"min": [100, -120], "max": [115, -105]}}, boundaries={"xmin": "periodic", "xmax": "periodic"}, **hollow))


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
with tempfile.TemporaryDirectory() as scratch:
    for step in (polygons, matched_layers, periodic_pairs, symmetry_planes, all_faults_in_one_run, real_board):
        if len(sys.argv) < 2 or step.__name__ in sys.argv[1:]:
            step(pathlib.Path(scratch))
gmsh.finalize()
for fault in faults:
    print("FAULT:", fault)
sys.exit(1 if faults else 0)
