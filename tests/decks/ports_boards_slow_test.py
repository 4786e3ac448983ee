#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Five real boards: `init` begins a study of some nets that meshes without an edit, passes its check, and Gmsh finds just the
groups that tags.json promises, each port a full rectangle between its two nets."""
import json
import pathlib
import sys
import tempfile
import time

from program import DATA, SKIPPED, require_data, run

try:
    import gmsh
    from gmsh_reading import check_msh, close, expect, faults
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

require_data()
BOARDS = (
    ("06_thunderscope_pcie_interposer_4L_v10", "PCIe pair", "/TX3_P,/TX3_N", "hollow"),
    ("05_stickhub_2L_v9", "USB pair", "/U1D+,/U1D-", "sheet"),
    ("13_antmicro_ddr5_testbed_6L_v6", "DDR5 line", "CA1", "hollow"),
    ("11_hackrf_one_rf_4L_v6", "RF line", "/frontend/RX_AMP_OUT", "solid"),
    ("04_antmicro_si_test_4L_v6", "line through a farm of vias", "Net-(J15-Pad1)", "sheet"),
)


def look_at(prefix, what, nets, mode, folder):
    board = next(p for p in sorted((DATA / "kicad").iterdir()) if p.name.startswith(prefix))
    study, mesh = folder / f"{prefix}.study.json", folder / f"{prefix}.msh"
    start = time.process_time()
    done = run("init", board, "--nets", nets, "--margin", "1mm", "--conductors", mode, "-o", study, *(() if mode == "solid" else ("--for", "palace")))
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    ports = json.loads(study.read_text())["ports"]
    expect(len(ports) >= 2, f"{prefix}: {len(ports)} ports\n{done.stderr}")
    done = run("mesh", board, "--study", study, "-o", mesh)
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    tags = json.loads(mesh.with_suffix(".tags.json").read_text())
    check_msh(mesh, tags)
    names = {f["name"] for f in tags["faces"]}
    for port in tags["ports"]:
        faces = [f for f in tags["faces"] if f["port"] == port["name"]]
        expect(len(faces) == 1 and faces[0]["condition"] == "port", f"{prefix}: faces of {port['name']}: {faces}")
        expect(close(sum(f["area_m2"] for f in faces), port["length_m"] * port["width_m"], 2e-3), f"{prefix}: {port}: {faces}")
        expect(port["positive_net"] in nets.split(",") and port["negative_net"], f"{prefix}: {port}")
        expect({"sheet": "sheet|", "hollow": "surface|"}.get(mode, "port|") + (port["positive_net"] if mode != "solid" else port["name"]) in names, f"{prefix}: {port} in {sorted(names)}")
    expect(len(tags["ports"]) == len(ports), f"{prefix}: {len(tags['ports'])} of {len(ports)} ports are in the mesh")
    print(f"  {what}: {len(ports)} ports, nets {nets}, {mode}: " + ", ".join(f"{p['name']} {1e6 * p['width_m']:.0f} x {1e6 * p['length_m']:.0f} um against {p['negative_net']}" for p in tags["ports"]), flush=True)


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
only = sys.argv[1] if len(sys.argv) > 1 else ""
with tempfile.TemporaryDirectory() as scratch:
    for case in BOARDS:
        if case[0].startswith(only):
            look_at(*case, pathlib.Path(scratch))
gmsh.finalize()
for fault in faults:
    print("FAULT:", fault)
sys.exit(1 if faults else 0)
