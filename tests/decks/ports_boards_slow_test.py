#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Five real boards: for every solver `init` begins a study of some nets that meshes without an edit, `check` finds nothing wrong
with the mesh by the rules of that solver, and Gmsh finds just the groups that tags.json promises, each port a full face between
its two nets. One region of a board in the three conductor modes. The table of validation/cases/real_ports."""
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
    import jsonschema
    from gmsh_reading import check_msh, close, expect, faults
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

require_data()
BOARDS = (
    ("06_thunderscope_pcie_interposer_4L_v10", "PCIe pair", "/TX3_P,/TX3_N"),
    ("05_stickhub_2L_v9", "USB pair", "/U1D+,/U1D-"),
    ("13_antmicro_ddr5_testbed_6L_v6", "DDR5 line", "CA1"),
    ("11_hackrf_one_rf_4L_v6", "RF line", "/frontend/RX_AMP_OUT"),
    ("04_antmicro_si_test_4L_v6", "line through a farm of vias", "Net-(J15-Pad1)"),
)
SOLVERS = ("palace", "getdp", "elmer", "dolfinx", "mfem")
ENDINGS = {"mfem": ".mesh", "dolfinx": ".vtkhdf"}  # of the meshes that these solvers read
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
    if cells < 1e6 and mesh.suffix == ".msh":
        check_msh(mesh, tags)
    quality = json.loads(mesh.with_suffix(".report.json").read_text()).get("ports", [])
    return {"kind": kind, "board": prefix, "nets": nets, "solver": solver, "cells": cells, "ports": tags["ports"], "quality": quality, "cpu_s": spent}


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
            # The large regions are meshed coarsely here, and for one solver; validation/cases/real_ports does all as they are.
            is_large = case[1] in ("PCIe pair", "DDR5 line")
            if not case[0].startswith(only) or (is_large and solver != "palace"):
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
