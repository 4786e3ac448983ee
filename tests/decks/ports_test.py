#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Ports, sheets and outer conditions, from the command line to what Gmsh finds in the mesh."""
import json
import math
import pathlib
import sys
import tempfile

from program import ROOT, SKIPPED, run

try:
    import gmsh
    import numpy
    from gmsh_reading import check_msh, close, expect, faults
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

BOARD = ROOT / "examples/microstrip.json"
PORTS = ("--port", "P1,net=LINE,at=J1.1", "--port", "P2,net=LINE,at=J2.1,z=75,passive")


def mesh(folder, name, *options, expected=0, board=BOARD):
    file = folder / name
    done = run("mesh", board, "-o", file, *options)
    if done.returncode != expected:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    return file, json.loads(file.with_suffix(".tags.json").read_text())


def face(tags, name):
    found = [f for f in tags["faces"] if f["name"] == name]
    expect(len(found) == 1, f"{len(found)} faces called {name} among {[f['name'] for f in tags['faces']]}")
    return found[0] if found else {"id": 0, "area_m2": 0, "num_faces": 0}


def points_of(tags, name):
    """Coordinates in metres of the nodes of a face group, as Gmsh has them."""
    _, coordinates = gmsh.model.mesh.getNodesForPhysicalGroup(2, face(tags, name)["id"])
    return numpy.asarray(coordinates).reshape(-1, 3) * tags["unit_m"]


def expect_rectangle(tags, port, low, high):
    """The port's faces fill the upright or flat rectangle between two corners, in metres."""
    points = points_of(tags, port)
    expect(len(points) > 0 and numpy.allclose(points.min(axis=0), low, atol=5e-9), f"{port}: begins at {points.min(axis=0)}, not {low}")
    expect(len(points) > 0 and numpy.allclose(points.max(axis=0), high, atol=5e-9), f"{port}: ends at {points.max(axis=0)}, not {high}")
    sides = sorted(numpy.asarray(high) - numpy.asarray(low))
    expect(close(face(tags, port)["area_m2"], sides[1] * sides[2], 1e-6), f"{port}: area {face(tags, port)['area_m2']}")


def chords(tags, name):
    """Edges inside a flat face group with both ends on its rim: Palace's rule."""
    entities = gmsh.model.getEntitiesForPhysicalGroup(2, face(tags, name)["id"])
    triangles = numpy.concatenate([numpy.asarray(n, dtype=numpy.int64).reshape(-1, 3) for e in entities for n in gmsh.model.mesh.getElements(2, e)[2]])
    edges = numpy.sort(numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    edges, counts = numpy.unique(edges, axis=0, return_counts=True)
    rim = numpy.unique(edges[counts == 1])
    return int((numpy.isin(edges[counts == 2], rim).all(axis=1)).sum())


def modes_agree(folder):
    tags = {}
    for mode, bottom in (("sheet", 0.0), ("solid", 35e-6), ("hollow", 35e-6)):
        file, tags[mode] = mesh(folder, f"{mode}.msh", "--conductors", mode, *PORTS, "--msh-version", "2.2" if mode == "sheet" else "4.1")
        check_msh(file, tags[mode])
        expect_rectangle(tags[mode], "port|P1", (2e-3, 5e-3 - 495e-6, bottom), (2e-3, 5e-3 + 495e-6, bottom + 508e-6))
        ports = {p["name"]: p for p in tags[mode]["ports"]}
        expect(ports["P1"]["direction"] == [0, 0, 1] and ports["P1"]["positive_net"] == "LINE" and ports["P1"]["negative_net"] == "GND", f"{mode}: {ports}")
        expect(close(ports["P1"]["length_m"], 508e-6) and close(ports["P1"]["width_m"], 990e-6), f"{mode}: size of {ports['P1']}")
        expect(ports["P2"]["impedance_ohm"] == 75 and not ports["P2"]["excited"] and ports["P1"]["excited"], f"{mode}: {ports}")
        expect(all(f["condition"] == "absorbing" for f in tags[mode]["faces"] if f["kind"] == "outer"), f"{mode}: outer faces are not absorbing")
    boxes = [(t["bounding_box_m"]["min"][:2], t["bounding_box_m"]["max"][:2]) for t in tags.values()]
    expect(boxes[0] == boxes[1] == boxes[2], f"footprints differ: {boxes}")
    area = {m: face(t, "zmin")["area_m2"] for m, t in tags.items()}
    expect(close(area["sheet"], area["solid"], 1e-12) and close(area["solid"], area["hollow"], 1e-12), f"footprints differ: {area}")
    copper = next(v for v in tags["solid"]["volumes"] if v["name"] == "top|copper|LINE")
    expect(close(face(tags["sheet"], "sheet|LINE")["area_m2"], copper["volume_m3"] / 35e-6, 1e-9), "sheet and solid copper cover different areas")
    line = face(tags["sheet"], "sheet|LINE")
    expect(line["inner"] and line["kind"] == "sheet" and line["condition"] == "conductor" and line["material"] == "copper" and close(line["thickness_m"], 35e-6), f"sheet: {line}")
    expect(not any(v["name"].startswith(("top|", "bottom|")) for v in tags["sheet"]["volumes"]), "a layer of sheets alone has no volume")


def one_mode_alone(folder):
    """Another mode of one net changes nobody else's tags."""
    names = {}
    for mode in ("sheet", "solid", "hollow"):
        _, tags = mesh(folder, "one.msh", f"--{mode}", "LINE", *PORTS)
        names[mode] = {g["name"] for kind in ("volumes", "faces") for g in tags[kind] if "LINE" not in g["name"]}
    expect(names["sheet"] == names["solid"] == names["hollow"], f"other tags change with the mode of LINE: {names}")
    _, tags = mesh(folder, "one.msh", "--sheet", "LINE", *PORTS)
    expect(face(tags, "sheet|LINE")["inner"] and "top|copper|GND" in {v["name"] for v in tags["volumes"]}, "sheet beside solid copper on one layer")


def sheets_on_the_hull(folder):
    file, tags = mesh(folder, "bare.msh", "--conductors", "sheet", "--air", "0", "--policy", "none")
    check_msh(file, tags)
    expect(not face(tags, "sheet|LINE|outer")["inner"] and not face(tags, "sheet|GND|outer")["inner"], "sheets on the hull")
    expect("sheet|LINE" not in {f["name"] for f in tags["faces"]}, "a sheet on the hull is not inside too")


def ports_on_sides(folder):
    """Guarantee E3 of extrude: a lumped port is its rectangle, recomputed from the file."""
    region = ("--region", "5mm,1mm,15mm,9mm", "--conductors", "hollow")
    file, tags = mesh(folder, "sides.msh", *region, "--port", "L,net=LINE,at=xmin", "--port", "W,net=LINE,at=xmax,kind=wave,width=4mm",
                      "--boundary", "zmin=pec", "--boundary", "ymin=impedance:377")
    check_msh(file, tags)
    expect_rectangle(tags, "port|L", (5e-3, 4.45e-3, 35e-6), (5e-3, 5.55e-3, 543e-6))
    points = points_of(tags, "waveport|W")
    expect(numpy.allclose(points[:, 0], 15e-3, atol=1e-12), "a wave port leaves its side")
    expect(close(face(tags, "waveport|W")["area_m2"], 4e-3 * (508e-6 + 35e-6 + 1e-3) - 1.1e-3 * 35e-6, 1e-9), f"wave port: {face(tags, 'waveport|W')}")
    expect(not face(tags, "port|L")["inner"] and not face(tags, "waveport|W")["inner"], "ports of the hull are outside")
    expect(face(tags, "zmin")["condition"] == "pec" and face(tags, "ymin")["condition"] == "impedance" and face(tags, "ymin")["impedance_ohm"] == 377, "outer conditions")


def palace_gets_no_chords(folder):
    """Guarantee T5 of triangulate, on the mesh that was written."""
    region = ("--conductors", "sheet", *PORTS, "--sweep", "1GHz:10GHz:10")
    file, tags = mesh(folder, "plain.msh", *region)
    check_msh(file, tags)
    before = chords(tags, "sheet|LINE")
    file, tags = mesh(folder, "palace.msh", *region, "--for", "palace")
    check_msh(file, tags)
    after = {name: chords(tags, name) for name in ("sheet|LINE", "sheet|GND")}
    expect(before > 0 and after == {"sheet|LINE": 0, "sheet|GND": 0}, f"edges across sheets: {before} before, {after} for Palace")
    expect(file.read_bytes().startswith(b"$MeshFormat\n2.2"), "Palace reads MSH 2.2")


def a_ring_in_an_antipad(folder):
    """The example of a coaxial connector: radii, faces, default of the side behind the ring, and each deck's word about it."""
    board, study = ROOT / "examples/launch.json", ROOT / "examples/launch.study.json"
    file = folder / "launch.msh"
    done = run("mesh", board, "--study", study, "-o", file)
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    tags = json.loads(file.with_suffix(".tags.json").read_text())
    check_msh(file, tags)
    port = next(p for p in tags["ports"] if p["name"] == "coax")
    ratio = math.exp(2 * math.pi * port["length_m"] / port["width_m"])
    expect(port["kind"] == "coaxial" and port["direction"] is None and close(port["length_m"], 0.6e-3, 0.01) and close(ratio, 1.7 / 0.5, 0.02), f"ring: {port} ratio {ratio}")
    points = points_of(tags, "port|coax") - numpy.asarray(port["at_m"])
    radii = numpy.hypot(points[:, 0], points[:, 1])
    expect(numpy.abs(points[:, 2]).max() < 1e-12 and radii.min() > 0.24e-3 and radii.max() < 0.8501e-3, f"ring: from {radii.min()} to {radii.max()}")
    expect(face(tags, "port|coax")["inner"] and face(tags, "zmin")["condition"] == "none" and face(tags, "zmax")["condition"] == "absorbing", "sides about the ring")
    report = json.loads(file.with_suffix(".report.json").read_text())
    expect(all(p["elements_along"] >= 2 for p in report["ports"]) and "ports " in done.stdout, f"ports of the report: {report['ports']}")
    done = run("mesh", board, "--study", study, "--for", "palace", "-o", folder / "palace/")
    deck = json.loads((folder / "palace/launch.palace.json").read_text())
    expect({p.get("Direction") for p in deck["Boundaries"]["LumpedPort"]} == {"-R", "+Z"}, f"Palace: {deck['Boundaries']['LumpedPort']}")
    done = run("mesh", board, "--study", study, "--for", "elmer", "-o", folder / "elmer/")
    expect(done.returncode != 0 and "coaxial port 'coax'" in done.stderr and not list((folder / "elmer").glob("*.msh")), f"Elmer: {done.stderr}")


WRONG = {
    "schema_version": 1,
    "region": {"kind": "box", "box": {"min": [5, 1], "max": [15, 9]}, "nets": ["LINE"]},
    "ports": [
        {"name": "no_pin", "net": "LINE", "at": {"pin": "J9.1"}},
        {"name": "outside", "net": "LINE", "at": {"pin": "J1.1"}},
        {"name": "no_copper", "net": "LINE", "at": {"point": [10, 2]}},
        {"name": "too_wide", "net": "LINE", "at": {"point": [10, 5]}, "width": "3mm"},
        {"name": "not_cut", "net": "LINE", "at": {"side": "ymin"}, "kind": "wave"},
        {"name": "no_reference", "net": "GND", "at": {"point": [10, 2], "layer": "bottom"}, "shape": "vertical", "width": "0.5mm"},
        {"name": "over_the_edge", "net": "LINE", "at": {"point": [5.0, 5]}, "width": "2.5mm"},
        {"name": "first", "net": "LINE", "at": {"point": [8, 5]}},
        {"name": "again", "net": "LINE", "at": {"point": [8, 5.1]}},
    ],
}


def wrong_ports_are_named(folder):
    study = folder / "wrong.study.json"
    study.write_text(json.dumps(WRONG))
    done = run("mesh", BOARD, "--study", study, "-o", folder / "wrong.msh")
    expect(done.returncode == 3 and not (folder / "wrong.msh").exists(), f"wrong ports: exit {done.returncode}\n{done.stderr}")
    for number, port in enumerate(WRONG["ports"]):
        wanted = port["name"] != "first"
        expect((f"/ports/{number}: port '{port['name']}'" in done.stderr) == wanted, f"wrong ports, {port['name']}: {done.stderr}")
    for word in ("no pin 'J9.1'", "outside the domain", "no copper at", "leaves the copper", "not cut at ymin", "no reference was found", "share faces"):
        expect(word in done.stderr, f"wrong ports: no word of '{word}' in {done.stderr}")
    bad = {"schema_version": 1, "ports": [{"name": "a", "net": "LINE", "reference": "LINE", "at": {"pin": "J1.1"}}, {"name": "a", "net": "LINE", "at": {"pin": "J1.1"}, "kind": "wave"}],
           "sweep": {"from": 2e9, "to": 1e9, "points": 0}, "mesh": {"frequency": 1e15}, "boundaries": {"xmin": "periodic"}}
    study.write_text(json.dumps(bad))
    done = run("mesh", BOARD, "--study", study, "-o", folder / "wrong.msh")
    expect(done.returncode == 2, f"wrong study: exit {done.returncode}\n{done.stderr}")
    for pointer in ("/ports/0/reference", "/ports/1/name", "/ports/1/at", "/sweep/points", "/sweep/to", "/mesh/frequency", "/boundaries/xmin"):
        expect(pointer in done.stderr, f"wrong study: no word of {pointer} in {done.stderr}")
    for options, words in ((("--for", "getdp"), "needs a port"), (("--for", "dolfinx", "--split", "none"), "no edge elements"),
                           (("--for", "palace", "--msh-version", "4.1", *PORTS, "--sweep", "1GHz:2GHz:2"), "reads version 2.2")):
        done = run("mesh", BOARD, *options, "-o", folder / ("wrong.vtkhdf" if "dolfinx" in options else "wrong.msh"))
        expect(done.returncode == 2 and words in done.stderr, f"{options}: exit {done.returncode} {done.stderr}")


def init_needs_no_edit(folder):
    study = folder / "line.study.json"
    done = run("init", BOARD, "--nets", "LINE", "--for", "palace", "-o", study)
    expect(done.returncode == 0 and "2 ports" in done.stdout, f"init: {done.stdout}{done.stderr}")
    text = json.loads(study.read_text())
    expect([p["at"] for p in text["ports"]] == [{"pin": "J1.1"}, {"pin": "J2.1"}] and text["ports"][0]["reference"] == "GND", f"init: {text['ports']}")
    expect((folder / text["$schema"]).is_file(), "init: no schema beside the study")
    try:
        import jsonschema
        jsonschema.Draft202012Validator(json.loads((folder / text["$schema"]).read_text())).validate(text)
    except ImportError:
        print("jsonschema is absent: the study is not held against its schema")
    file, tags = mesh(folder, "line.msh", "--study", study)
    check_msh(file, tags)
    expect(len(tags["ports"]) == 2, f"init: {tags['ports']}")
    expect(run("init", BOARD, "--nets", "LINE", "-o", study).returncode == 5, "init overwrites a study")
    done = run("ports", BOARD, "--nets", "LINE", "--region", "5mm,1mm,15mm,9mm", "--quiet")
    proposed = json.loads("{" + done.stdout + "}")["ports"]
    expect([p["at"] for p in proposed] == [{"side": "xmin"}, {"side": "xmax"}], f"ports: {done.stdout}{done.stderr}")


def vias_are_proposed(folder):
    """The antipad that a via passes is proposed as a coaxial port, told apart in text and JSON, and what is proposed meshes."""
    board = ROOT / "examples/launch.json"
    done = run("ports", board, "--nets", "LINE")
    proposed = json.loads("{" + done.stdout + "}")["ports"]
    shapes = {p["name"]: (p["shape"], p["note"].split(",")[0]) for p in proposed}
    expect({n[0] for n in shapes} == {"P", "C"} and all(s == (("coaxial", "coaxial") if n[0] == "C" else ("auto", "vertical")) for n, s in shapes.items()), f"ports of the launch: {proposed}")
    expect("C1     net LINE against GND: coaxial, the via at" in done.stderr, f"ports of the launch in words: {done.stderr}")
    study = folder / "proposed.study.json"
    study.write_text(json.dumps({"schema_version": 1, "ports": proposed}))
    _, tags = mesh(folder, "proposed.msh", "--study", study, board=board)
    expect({p["name"]: p["kind"] for p in tags["ports"]} == {n: "coaxial" if n[0] == "C" else "lumped" for n in shapes}, f"what was proposed: {tags['ports']}")
    begun = folder / "begun.study.json"
    done = run("init", board, "--nets", "LINE", "-o", begun)
    expect(not [p for p in json.loads(begun.read_text())["ports"] if p["shape"] == "coaxial"], "init puts no port in the middle of a line")


def a_polygon_by_flag(folder):
    corners = "5mm,1mm,15mm,1mm,15mm,9mm,10mm,9.5mm,5mm,9mm"
    _, tags = mesh(folder, "polygon.msh", "--polygon", corners, "--conductors", "hollow")
    area = sum(f["area_m2"] for f in tags["faces"] if f["name"] == "zmin")
    expect(close(area, 82.5e-6, 1e-9), f"polygon: {area} m2")
    resolved = json.loads((folder / "polygon.resolved.json").read_text())["region"]
    expect(resolved["kind"] == "polygon" and len(resolved["polygon"]) == 5, f"polygon: {resolved}")
    for wrong, word in (("5mm,1mm,15mm,1mm", "at least three corners"), ("5mm,1mm,15mm,1mm,15mm,9mm,2mm", "7 lengths were given"), ("5mm,1mm,15mm,9mm,15mm,1mm,5mm,9mm", "crosses itself near (10, 5) mm")):
        done = run("mesh", BOARD, "--polygon", wrong, "-o", folder / "crossed.msh")
        expect(done.returncode == 2 and word in done.stderr, f"--polygon {wrong}: exit {done.returncode} {done.stderr}")
    done = run("mesh", BOARD, "--polygon", corners, "--region", "5mm,1mm,15mm,9mm", "-o", folder / "crossed.msh")
    expect(done.returncode == 2 and "excludes" in done.stderr, f"two regions: {done.stderr}")


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
with tempfile.TemporaryDirectory() as scratch:
    for step in (modes_agree, one_mode_alone, sheets_on_the_hull, ports_on_sides, palace_gets_no_chords, a_ring_in_an_antipad, wrong_ports_are_named, init_needs_no_edit, vias_are_proposed, a_polygon_by_flag):
        step(pathlib.Path(scratch))
gmsh.finalize()
for fault in faults:
    print("FAULT:", fault)
sys.exit(1 if faults else 0)
