#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Real boards: every one meshes and passes its check, and Gmsh finds in ten of the meshes just what tags.json promises."""
import json
import pathlib
import sys
import tempfile

from program import ROOT, require_data, run

sys.path.insert(0, str(ROOT / "validation/cases/boards"))
import run as boards_case  # noqa: E402

IN_GMSH = ("00_padne_castellated", "00_padne_degenerate", "00_padne_tht", "00_padne_via_tht", "01_kibot_circle", "01_kibot_drill", "01_kibot_vias_blind_micro_6L_v9",
           "02_custom_pads_v9", "03_ecc83", "05_stickhub_2L_v6")


def gmsh_agrees():
    """Number of boards looked at; faults go to the list of gmsh_reading."""
    import gmsh
    from gmsh_reading import check_msh
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    looked_at = 0
    for board in boards_case.boards():
        if not board.name.startswith(IN_GMSH):
            continue
        with tempfile.TemporaryDirectory() as scratch:
            mesh = pathlib.Path(scratch) / "board.msh"
            done = run("mesh", board, "-o", mesh, "--policy", "none", "--sublayers", "none", "--no-check", "--msh-version", "2.2" if looked_at % 2 else "4.1")
            if done.returncode != 0:
                raise SystemExit(f"{board.name}: exit {done.returncode}\n{done.stderr}")
            check_msh(mesh, json.loads(mesh.with_suffix(".tags.json").read_text()))
            looked_at += 1
    gmsh.finalize()
    return looked_at


def resolved_study_repeats():
    """Does the resolved study give the same bytes for a board whose first tolerance did not hold?"""
    board = next(b for b in boards_case.boards() if b.name.startswith("06_thunderscope") and "_v9" in b.name)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for arguments in (["--policy", "none", "--sublayers", "none", "-o", folder / "a.msh"], ["--study", folder / "a.resolved.json", "-o", folder / "b.msh"]):
            done = run("mesh", board, "--no-check", *arguments)
            if done.returncode != 0:
                raise SystemExit(f"{board.name}: exit {done.returncode}\n{done.stderr}")
        attempts = json.loads((folder / "a.report.json").read_text())["overlay"]["attempts"]
        same = (folder / "a.msh").read_bytes() == (folder / "b.msh").read_bytes()
    print(f"{board.name}: {attempts} attempts, resolved study repeats the mesh: {same}")
    return attempts > 1 and same


require_data()
failures = boards_case.main(sys.argv[1:])
if not resolved_study_repeats():
    failures = 1
try:
    from gmsh_reading import faults
    looked_at = gmsh_agrees()
except ImportError as missing:
    print(f"Gmsh's part skipped: {missing}")
else:
    for fault in faults:
        print("FAULT:", fault)
    if faults or looked_at < len(IN_GMSH):
        print(f"Gmsh: {looked_at} boards looked at, {len(faults)} faults")
        failures = 1
sys.exit(failures)
