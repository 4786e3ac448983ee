#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gmsh reads every MSH variant the program writes; counts, names and volumes agree with tags.json."""
import json
import pathlib
import sys
import tempfile

from program import ROOT, SKIPPED, run

BOARD = ROOT / "examples/serpentine.json"

try:
    import gmsh
    from gmsh_reading import check_msh, expect, faults
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)


def make(folder, name, *options):
    mesh = folder / name
    done = run("mesh", BOARD, "-o", mesh, "--no-check", *options)
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    return mesh, json.loads(mesh.with_suffix("").with_suffix(".tags.json").read_text())


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
    gmsh.finalize()
    for fault in faults:
        print("FAULT:", fault)
    return 1 if faults else 0


sys.exit(main())
