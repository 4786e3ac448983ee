#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gmsh reads every MSH variant the program writes, and meshio its VTU; counts, names and volumes agree with tags.json."""
import json
import pathlib
import sys
import tempfile

from program import ROOT, SKIPPED, run

BOARD = ROOT / "examples/serpentine.json"

try:
    import gmsh
    from gmsh_reading import check_msh, close, expect, faults, signed_volumes
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)


def make(folder, name, *options):
    mesh = folder / name
    done = run("mesh", BOARD, "-o", mesh, "--no-check", *options)
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    return mesh, json.loads(mesh.with_suffix("").with_suffix(".tags.json").read_text())


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
