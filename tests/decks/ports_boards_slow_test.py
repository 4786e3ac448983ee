#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Five real boards: for every solver `init` begins a study of some nets that meshes without an edit, with a port at both ends of every
line; `check` finds nothing wrong with the mesh by the rules of that solver, and Gmsh finds just the groups that tags.json promises,
each port a full face between its two nets. Meshes that are not MSH are counted by h5py or by their text, and Gmsh reads what `pcbmesh
convert` makes of them. One region of a board in the three conductor modes. The table of validation/cases/real_ports."""
import json
import math
import pathlib
import re
import resource
import sys
import tempfile

from program import DATA, ROOT, SKIPPED, require_data, run

try:
    import gmsh
    import h5py
    import jsonschema
    import numpy
    from gmsh_reading import check_msh, close, expect, faults
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

require_data()
BOARDS = (
    ("06_thunderscope_pcie_interposer_4L_v10", "PCIe pair", "/TX3_P,/TX3_N"),
    ("05_stickhub_2L_v9", "USB pair", "/U2D+,/U2D-"),
    ("13_antmicro_ddr5_testbed_6L_v6", "DDR5 line", "CA1"),
    ("11_hackrf_one_rf_4L_v6", "RF line", "/frontend/RX_AMP_OUT"),
    ("04_antmicro_si_test_4L_v6", "line through a farm of vias", "Net-(J15-Pad1)"),
)
SOLVERS = ("palace", "getdp", "elmer", "dolfinx", "mfem")
ENDINGS = {"mfem": ".mesh", "dolfinx": ".vtkhdf"}  # of the meshes that these solvers read
MOST_CELLS = 3_000_000  # that Gmsh is given; a larger mesh is made once more, coarsely, for the groups
SCHEMA = json.loads((ROOT / "docs/schema/study.schema.json").read_text())


def board_file(prefix):
    return next(p for p in sorted((DATA / "kicad").iterdir()) if p.name.startswith(prefix))


def must(done):
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def cpu_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def look_at_ports(what, tags, ports, nets):
    for port in tags["ports"]:
        faces = [f for f in tags["faces"] if f["port"] == port["name"]]
        expect(len(faces) == 1 and faces[0]["condition"] == "port", f"{what}: faces of {port['name']}: {faces}")
        expect(close(sum(f["area_m2"] for f in faces), port["length_m"] * port["width_m"], 2e-3), f"{what}: {port}: {faces}")
        expect(port["positive_net"] in nets.split(",") and port["negative_net"], f"{what}: {port}")
    expect(len(tags["ports"]) == len(ports) >= 2, f"{what}: {len(tags['ports'])} of {len(ports)} ports are in the mesh")
    box = tags["bounding_box_m"]
    length = max(high - low for low, high in zip(box["min"][:2], box["max"][:2])) - 1e-3  # less the margins
    for net in nets.split(","):
        places = [port["at_m"] for port in tags["ports"] if port["positive_net"] == net]
        expect(len(places) >= 2 and max(math.dist(a[:2], b[:2]) for a in places for b in places) > 0.5 * length, f"{what}: no ports at both ends of {net}: {places}")


def counted(numbers):
    return dict(zip(*(part.tolist() for part in numpy.unique(numbers, return_counts=True))))


def counts_by_h5py(mesh):
    """Number of cells and of faces of every tag, and their names."""
    with h5py.File(mesh) as file:
        faces = {}
        for name, tags in file["mesh"].items():
            if name.endswith("_face_tag"):
                for tag, number in counted(tags[:]).items():
                    faces[tag] = faces.get(tag, 0) + number
        names = [{int(tag): name.decode() for tag, name in zip(file[f"VTKHDF/FieldData/{kind}_tags"], file[f"VTKHDF/FieldData/{kind}_names"])} for kind in ("volume", "face")]
        return (counted(file["VTKHDF/CellData/volume_tag"][:]), names[0]), (faces, names[1])


def counts_in_text(mesh):
    """The same of an MFEM mesh: the attribute of each element stands first in its line, sets give them names."""
    lines = iter(mesh.read_text().splitlines())
    found = []
    for section, sets in (("elements", "attribute_sets"), ("boundary", "bdr_attribute_sets")):
        while next(lines) != section:
            pass
        attributes = [int(next(lines).split(" ", 1)[0]) for _ in range(int(next(lines)))]
        while next(lines) != sets:
            pass
        named = (re.fullmatch(r'"(.*)" 1 (\d+)', next(lines)) for _ in range(int(next(lines))))
        found.append((counted(attributes), {int(m[2]): m[1] for m in named}))
    return found


def look_at_groups(what, mesh, tags):
    """Just the groups of tags.json, by readers that are not ours."""
    if mesh.suffix == ".msh":
        check_msh(mesh, tags)
        return
    counts = {".vtkhdf": counts_by_h5py, ".mesh": counts_in_text}[mesh.suffix](mesh)
    for (found, names), groups, number in zip(counts, (tags["volumes"], tags["faces"]), ("num_cells", "num_faces")):
        expect(found == {g["id"]: g[number] for g in groups}, f"{what}: {found} in the file, {[(g['id'], g[number]) for g in groups]} in tags.json")
        expect(names == {g["id"]: g["name"] for g in groups}, f"{what}: names {names} in the file")
    twin = mesh.with_name("twin.msh")
    must(run("convert", mesh, twin))
    check_msh(twin, tags, 4 if mesh.suffix == ".vtkhdf" else 6)


def look_at(prefix, kind, nets, solver, folder, *options):
    """init, mesh and check as a user would, and nothing in between."""
    board, what = board_file(prefix), f"{kind} for {solver}"
    study, mesh = folder / f"{solver}.study.json", folder / f"{solver}{ENDINGS.get(solver, '.msh')}"
    begun = cpu_s()
    done = must(run("init", board, "--nets", nets, "--margin", "0.5mm", "--for", solver, *options, "-o", study))
    written = json.loads(study.read_text())
    jsonschema.Draft202012Validator(SCHEMA).validate(written)
    done = must(run("mesh", board, "--study", study, "-o", mesh))
    tags = json.loads(mesh.with_suffix(".tags.json").read_text())
    look_at_ports(what, tags, written["ports"], nets)
    done = run("check", mesh, "--profile", solver, "--json")
    report = json.loads(done.stdout)
    expect(done.returncode == 0 and not [f for f in report["findings"] if f["severity"] == "error"], f"{what}: check exits {done.returncode}: {[f['text'] for f in report['findings']][:6]}")
    if solver in ("palace", "getdp", "elmer"):
        expect(list(folder.glob({"palace": "*.palace.json", "getdp": "*.pro", "elmer": "*.sif"}[solver])), f"{what}: no deck")
    spent = cpu_s() - begun
    cells = sum(v["num_cells"] for v in tags["volumes"])
    if cells <= MOST_CELLS:
        look_at_groups(what, mesh, tags)
    else:
        coarse = folder / f"coarse{mesh.suffix}"
        must(run("mesh", board, "--study", study, "--policy", "none", "-o", coarse))
        fewer = json.loads(coarse.with_suffix(".tags.json").read_text())
        expect([(g["id"], g["name"]) for part in ("volumes", "faces") for g in fewer[part]] == [(g["id"], g["name"]) for part in ("volumes", "faces") for g in tags[part]], f"{what}: a coarser mesh has other groups")
        look_at_groups(f"{what}, coarsely", coarse, fewer)
    quality = json.loads(mesh.with_suffix(".report.json").read_text()).get("ports", [])
    return {"kind": kind, "board": prefix, "nets": nets, "solver": solver, "cells": cells, "ports": tags["ports"], "quality": quality, "cpu_s": spent,
            "groups": "as it is" if cells <= MOST_CELLS else f"coarsely, {sum(v['num_cells'] for v in fewer['volumes']):,} cells"}


def modes_agree(prefix, nets, folder):
    """sheet, hollow and solid of one region, and one net alone in another mode."""
    board, tags = board_file(prefix), {}
    study = folder / "modes.study.json"
    must(run("init", board, "--nets", nets, "--margin", "0.5mm", "-o", study))
    one = nets.split(",")[0]
    for name, options in {"solid": ("--conductors", "solid"), "hollow": ("--conductors", "hollow"), "sheet": ("--conductors", "sheet"),
                          "one_solid": ("--conductors", "hollow", "--solid", one), "one_sheet": ("--conductors", "hollow", "--sheet", one)}.items():
        mesh = folder / f"{name}.msh"
        must(run("mesh", board, "--study", study, *options, "-o", mesh))
        tags[name] = json.loads(mesh.with_suffix(".tags.json").read_text())
        done = run("check", mesh, "--json")
        expect(done.returncode == 0, f"{name}: check exits {done.returncode}: {done.stdout[:600]}")
    area = {name: next(f["area_m2"] for f in t["faces"] if f["name"] == "zmin") for name, t in tags.items()}
    box = {name: (t["bounding_box_m"]["min"][:2], t["bounding_box_m"]["max"][:2]) for name, t in tags.items()}
    for name in tags:
        expect(close(area[name], area["solid"], 1e-12) and box[name] == box["solid"], f"footprint of {name}: {area}, {box}")
    copper = {v["net"] for v in tags["solid"]["volumes"] if v["conductor"] and v["net"]}
    for mode, word in (("hollow", "surface|"), ("sheet", "sheet|")):
        skins = {f["name"].split("|")[1] for f in tags[mode]["faces"] if f["name"].startswith(word)}
        expect(copper == skins, f"nets of {mode}: {sorted(copper ^ skins)}")
        expect(not any(v["conductor"] and v["net"] for v in tags[mode]["volumes"]), f"{mode}: copper is meshed")

    def others(t):
        return {g["name"] for part in ("volumes", "faces") for g in t[part] if one not in g["name"].split("|")}
    for name in ("one_solid", "one_sheet"):
        expect(others(tags[name]) == others(tags["hollow"]), f"{name}: tags of others change: {sorted(others(tags[name]) ^ others(tags['hollow']))}")
        mine = {g["name"] for part in ("volumes", "faces") for g in tags[name][part] if one in g["name"].split("|")}
        expect(any(n.startswith("sheet|") for n in mine) if name == "one_sheet" else any("copper" in n for n in mine), f"{name}: {sorted(mine)}")


def coaxial_at_a_via(prefix, net, at, layer, reference, folder):
    """A ring in the antipad of a via of a real board, its radii those of the file."""
    mesh = folder / "coaxial.msh"
    x, y = at
    done = must(run("mesh", board_file(prefix), "--region", f"{x - 2}mm,{y - 2}mm,{x + 2}mm,{y + 2}mm", "--conductors", "hollow",
                    "--port", f"C,net={net},at={x}mm:{y}mm:{layer},shape=coaxial,reference={reference}", "-o", mesh))
    tags = json.loads(mesh.with_suffix(".tags.json").read_text())
    check_msh(mesh, tags)
    port, face = tags["ports"][0], next(f for f in tags["faces"] if f["name"] == "port|C")
    expect(port["kind"] == "coaxial" and port["direction"] is None and face["inner"], f"coaxial: {port} {face}")
    done = run("check", mesh, "--json")
    expect(done.returncode == 0, f"coaxial: {done.stdout[:600]}")
    inner, outer = radii(port)
    wide, begins = in_the_file(board_file(prefix), layer, x, -y)
    expect(close(inner, wide / 2, 0.01) and close(outer, begins, 0.01), f"coaxial: radii {inner} and {outer}, in the file {wide / 2} and {begins}")
    expect(close(face["area_m2"], math.pi * (outer**2 - inner**2), 1e-3), f"coaxial: {face}")


def in_the_file(board, layer, x, y):
    """Metres: width of the via at a place, and mean distance from there to the corners of the plane that lie nearest, read from
    the board file as text."""
    text = board.read_text()
    via = next(m for m in re.finditer(r"\(via\s+\(at ([-\d.]+) ([-\d.]+)\) \(size ([\d.]+)\) \(drill ([\d.]+)\)", text) if close(float(m[1]), x) and close(float(m[2]), y))
    apart = []
    for piece in text.split("(filled_polygon")[1:]:
        if f'(layer "{layer}")' in piece[:60]:
            apart += [math.hypot(float(px) - x, float(py) - y) for px, py in re.findall(r"\(xy ([-\d.]+) ([-\d.]+)\)", piece)]
    ring = [d for d in apart if d < 1.1 * min(apart)]
    return float(via[3]) * 1e-3, sum(ring) / len(ring) * 1e-3


def radii(port):
    """Of a coaxial port, from its length b - a and its width 2 pi (b - a) / ln(b / a)."""
    ratio = math.exp(2 * math.pi * port["length_m"] / port["width_m"])
    inner = port["length_m"] / (ratio - 1)
    return inner, inner * ratio


if __name__ == "__main__":
    only = sys.argv[1] if len(sys.argv) > 1 else ""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    for case in BOARDS:
        for solver in SOLVERS:
            # The large regions are meshed coarsely here; validation/cases/real_ports does all as they are.
            is_large = case[1] in ("PCIe pair", "DDR5 line")
            if not case[0].startswith(only):
                continue
            with tempfile.TemporaryDirectory() as scratch:
                row = look_at(*case, solver, pathlib.Path(scratch), *(("--policy", "none") if is_large else ()))
            print(f"  {row['kind']:<28} {solver:<8} {len(row['ports'])} ports {row['cells']:>9,} cells {row['cpu_s']:5.1f} s", flush=True)
    with tempfile.TemporaryDirectory() as scratch:
        modes_agree("11_hackrf_one_rf_4L_v6", "/frontend/RX_AMP_OUT", pathlib.Path(scratch))
        coaxial_at_a_via("04_antmicro_si_test_4L_v6", "Net-(J16-Pad1)", (126.6, -146), "In1.Cu", "GND", pathlib.Path(scratch))
    gmsh.finalize()
    for fault in faults:
        print("FAULT:", fault)
    sys.exit(1 if faults else 0)
