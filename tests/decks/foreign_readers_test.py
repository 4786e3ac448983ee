#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""VTK, meshio, h5py and h5dump read what the program writes in the VTK and HDF5 family: counts, volumes, tags, wedges the right
way round, VTK's own cell validator."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from program import ROOT, SKIPPED, run

BOARD = ROOT / "examples/serpentine.json"

try:
    import h5py
    import meshio
    import numpy
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy
    from mesh_sizes import areas, close, signed_volumes
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)

LEGACY = [0, 2, 1, 3, 5, 4]
faults = []


def expect(condition, text):
    if not condition:
        faults.append(text)


def make(folder, *options):
    done = run("mesh", BOARD, "--no-check", *options, cwd=folder)
    if done.returncode != 0:
        raise SystemExit(f"{done.args}\nexit {done.returncode}\n{done.stdout}{done.stderr}")


def read_tags(folder, stem):
    return json.loads((folder / f"{stem}.tags.json").read_text())


def check_cells(name, tags, volumes, volume_tags, arrays):
    """One wedge per entry: volume of either sign, its volume_tag, arrays layer, material, net, quality."""
    expect((volumes > 0).all(), f"{name}: {(volumes <= 0).sum()} wedges turned inside out")
    layers, materials = [l["name"] for l in tags["layers"]], [m["name"] for m in tags["materials"]]
    for volume in tags["volumes"]:
        here = volume_tags == volume["id"]
        expect(here.sum() == volume["num_cells"], f"{name}: count of {volume['name']} is {here.sum()}")
        expect(close(volumes[here].sum() * tags["unit_m"] ** 3, volume["volume_m3"]), f"{name}: volume of {volume['name']}")
        if "material" in arrays and here.any():
            found = {materials[m] for m in numpy.unique(arrays["material"][here])}
            expect(found == {volume["material"]}, f"{name}: materials of {volume['name']} are {found}")
        if "net" in arrays:
            expect(((arrays["net"][here] >= 0) == (volume["net"] is not None)).all(), f"{name}: nets of {volume['name']}")
    for array in ("layer", "material", "net", "region", "quality"):
        expect(array in arrays and len(arrays[array]) == len(volume_tags), f"{name}: array {array}")
    quality = arrays["quality"]
    expect((quality > 0).all() and (quality <= 1.0264005).all(), f"{name}: quality from {quality.min()} to {quality.max()}")


def check_faces(name, tags, triangles, quads):
    """(areas, tags) of both kinds."""
    for face in tags["faces"]:
        count = sum((t == face["id"]).sum() for _, t in (triangles, quads))
        size = sum(a[t == face["id"]].sum() for a, t in (triangles, quads))
        expect(count == face["num_faces"], f"{name}: count of {face['name']} is {count}")
        expect(close(size * tags["unit_m"] ** 2, face["area_m2"]), f"{name}: area of {face['name']}")


class Grid:
    """A VTK grid as arrays; wedges in Gmsh order whatever the file's order was."""

    def __init__(self, grid, order=LEGACY):
        self.points = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
        types = vtk_to_numpy(grid.GetCellTypesArray())
        corners, ends = vtk_to_numpy(grid.GetCells().GetConnectivityArray()), vtk_to_numpy(grid.GetCells().GetOffsetsArray())
        data = grid.GetCellData()
        arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
        self.of_type, self.arrays = {}, {}
        for kind, width in ((13, 6), (5, 3), (9, 4)):
            here = numpy.flatnonzero(types == kind)
            self.of_type[kind] = corners[ends[:-1][here][:, None] + numpy.arange(width)]
            self.arrays[kind] = {key: values[here] for key, values in arrays.items()}
        self.of_type[13] = self.of_type[13][:, order]
        self.num_cells = len(types)


def read_vtk(reader, path):
    reader.SetFileName(str(path))
    messages = []
    reader.AddObserver("ErrorEvent", lambda *_: messages.append("error"))
    reader.Update()
    expect(not messages, f"{path.name}: VTK reports {len(messages)} errors")
    return reader.GetOutput()


def check_grid(name, tags, grid, order=LEGACY):
    g = Grid(grid, order)
    wedges = g.of_type[13]
    expect(g.num_cells == len(wedges) + len(g.of_type[5]) + len(g.of_type[9]), f"{name}: other cells than wedges and faces")
    check_cells(name, tags, signed_volumes(wedges, g.points), g.arrays[13]["volume_tag"], g.arrays[13])
    if len(g.of_type[5]) + len(g.of_type[9]) > 0:
        check_faces(name, tags, *((areas(g.of_type[t], g.points), g.arrays[t]["face_tag"]) for t in (5, 9)))
    if order == LEGACY:
        sizes = vtk.vtkCellSizeFilter()
        sizes.SetInputData(grid)
        sizes.Update()
        volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
        total = sum(v["volume_m3"] for v in tags["volumes"]) / tags["unit_m"] ** 3
        expect(close(volumes.sum(), total, 1e-6) and volumes.min() >= 0, f"{name}: VTK's own volume is {volumes.sum()}, not {total}")
        if tags["unit_m"] < 1e-4:  # in metres the validator's own tolerance finds faults in all small cells
            check_validity(name, grid)
    print(f"{name}: {len(wedges)} wedges, {len(g.of_type[5])} triangles, {len(g.of_type[9])} quads by VTK")
    return g


def check_validity(name, grid):
    """Bit 0x20 of VTK's cell validator, faces inside out, at each hundredth wedge. Its convexity bit is not asked: it is set for
    some prisms over skinny triangles that are convex."""
    types = vtk_to_numpy(grid.GetCellTypesArray())
    states = numpy.array([int(vtk.vtkCellValidator.Check(grid.GetCell(int(i)), 1e-6)) for i in numpy.flatnonzero(types == 13)[::100]])
    turned = (states & 0x20 != 0).sum()
    expect(len(states) > 10 and turned == 0, f"{name}: the cell validator finds {turned} of {len(states)} wedges inside out")


def check_meshio(path, tags, has_wedges=True):
    read = meshio.read(str(path))
    # A file in groups becomes many blocks of a kind.
    kinds = {block.type for block in read.cells}
    cells = {kind: numpy.vstack([block.data for block in read.cells if block.type == kind]) for kind in kinds}
    arrays = {key: {kind: numpy.concatenate([v for v, block in zip(values, read.cells) if block.type == kind]) for kind in kinds}
              for key, values in read.cell_data.items()}
    if has_wedges:
        check_cells(f"{path.name} by meshio", tags, signed_volumes(cells["wedge"], read.points), arrays["volume_tag"]["wedge"],
                    {key: values["wedge"] for key, values in arrays.items()})
    if "triangle" in cells:
        check_faces(f"{path.name} by meshio", tags, *((areas(cells[t], read.points), arrays["face_tag"][t]) for t in ("triangle", "quad")))
    print(f"{path.name}: {', '.join(f'{len(data)} {kind}' for kind, data in cells.items())} by meshio")


def check_vtu_family(folder):
    variants = {"raw": [], "zlib": ["--compress", "zlib"], "lz4": ["--compress", "lz4"], "base64": ["--base64"],
                "base64zlib": ["--base64", "--compress", "zlib"], "text": ["--ascii"], "wide": ["--index-bits", "64"],
                "faces": ["--faces", "--unit", "um"], "hollow": ["--conductors", "hollow", "--unit", "um", "--faces", "--compress", "zlib"]}
    for stem, options in variants.items():
        make(folder, "-o", f"{stem}.vtu", *options)
        tags = read_tags(folder, stem)
        grid = read_vtk(vtk.vtkXMLUnstructuredGridReader(), folder / f"{stem}.vtu")
        check_grid(f"{stem}.vtu", tags, grid)
        codes = grid.GetFieldData().GetArray("volume_names")
        names = bytes(int(codes.GetValue(i)) for i in range(codes.GetNumberOfValues())).decode().split("\0")[:-1]
        expect(names == [v["name"] for v in tags["volumes"]], f"{stem}.vtu: names of volumes are {names}")
        if stem != "lz4":  # meshio knows no LZ4
            check_meshio(folder / f"{stem}.vtu", tags)
            codes = meshio.read(str(folder / f"{stem}.vtu")).field_data["volume_names"]
            expect(bytes(codes.tolist()).decode().split("\0")[:-1] == names, f"{stem}.vtu: names by meshio")
    make(folder, "-o", "parametric.vtu", "--vtk-wedge", "parametric")
    check_grid("parametric.vtu", read_tags(folder, "parametric"),
               read_vtk(vtk.vtkXMLUnstructuredGridReader(), folder / "parametric.vtu"), [0, 1, 2, 3, 4, 5])

    make(folder, "-o", "parts.pvtu", "--parts", "3", "--faces", "--compress", "zlib")
    check_grid("parts.pvtu", read_tags(folder, "parts"), read_vtk(vtk.vtkXMLPUnstructuredGridReader(), folder / "parts.pvtu"))

    make(folder, "-o", "blocks.vtm")
    tags = read_tags(folder, "blocks")
    blocks = read_vtk(vtk.vtkXMLMultiBlockDataReader(), folder / "blocks.vtm")
    for index, (kind, groups, count_key) in enumerate((("volumes", tags["volumes"], "num_cells"), ("faces", tags["faces"], "num_faces"))):
        expect(blocks.GetMetaData(index).Get(vtk.vtkCompositeDataSet.NAME()) == kind, f"blocks.vtm: block {index} is not '{kind}'")
        inside = blocks.GetBlock(index)
        found = {inside.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME()): inside.GetBlock(i).GetNumberOfCells()
                 for i in range(inside.GetNumberOfBlocks())}
        wanted = {group["name"]: group[count_key] for group in groups if group[count_key] > 0}
        expect(found == wanted, f"blocks.vtm: {kind} are {found}, not {wanted}")
    print(f"blocks.vtm: {len(tags['volumes'])} volumes and {len(tags['faces'])} faces by VTK")


def check_hdf5_family(folder):
    for stem, options in (("plain", ["--unit", "um"]), ("packed", ["--compress", "zlib", "--conductors", "hollow"]),
                          ("wide", ["--index-bits", "64"])):
        make(folder, "-o", f"{stem}.xdmf", *options)
        tags = read_tags(folder, stem)
        heavy = read_vtk(vtk.vtkHDFReader(), folder / f"{stem}.vtkhdf")
        check_grid(f"{stem}.vtkhdf", tags, heavy)
        found = names_without_h5py(folder / f"{stem}.vtkhdf")
        expect(found == [v["name"] for v in tags["volumes"]], f"{stem}.vtkhdf: names of volumes are {found}")
        check_meshio(folder / f"{stem}.xdmf", tags)
        check_meshio(folder / f"{stem}_faces.xdmf", tags, has_wedges=False)
        check_paraview(folder / f"{stem}_paraview.xdmf", tags)
        with h5py.File(folder / f"{stem}.vtkhdf") as f:
            expect(f["mesh/points"].id.get_offset() == f["VTKHDF/Points"].id.get_offset() if stem == "plain" else True, f"{stem}.vtkhdf: points twice")
            packed = f["mesh/wedge"].compression == "gzip"
            expect(packed == (stem == "packed"), f"{stem}.vtkhdf: compression {f['mesh/wedge'].compression}")
            check_cells(f"{stem}.vtkhdf by h5py", tags, signed_volumes(f["mesh/wedge"][:], f["mesh/points"][:]),
                        f["mesh/wedge_volume_tag"][:], {a: f[f"mesh/wedge_{a}"][:] for a in ("layer", "material", "net", "region", "quality")})
    make(folder, "-o", "wedge.vtkhdf", "--vtk-wedge", "parametric")
    check_grid("wedge.vtkhdf", read_tags(folder, "wedge"), read_vtk(vtk.vtkHDFReader(), folder / "wedge.vtkhdf"), [0, 1, 2, 3, 4, 5])


def names_without_h5py(path):
    """h5py teaches the HDF5 library of its process conversions of texts that VTK and ParaView alone do not have."""
    script = ("import json, sys, vtk\nreader = vtk.vtkHDFReader()\nreader.SetFileName(sys.argv[1])\nreader.Update()\n"
              "names = reader.GetOutputDataObject(0).GetFieldData().GetAbstractArray('volume_names')\n"
              "print(json.dumps([names.GetValue(i) for i in range(names.GetNumberOfValues())]))")
    done = subprocess.run([sys.executable, "-c", script, path], capture_output=True, text=True)
    expect("ERR" not in done.stderr and "HDF5-DIAG" not in done.stderr, f"{path.name}: VTK complains: {done.stderr[:300]}")
    return json.loads(done.stdout or "null")


def check_paraview(path, tags):
    if not hasattr(vtk, "vtkXdmfReader"):
        return print(f"{path.name}: this VTK has no XDMF reader; that of python3-paraview has")
    reader = vtk.vtkXdmfReader()
    reader.SetFileName(str(path))
    reader.Update()
    output = reader.GetOutputDataObject(0)
    found = {output.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME()): output.GetBlock(i) for i in range(output.GetNumberOfBlocks())}
    expect(set(found) == {"cells", "faces"}, f"{path.name}: grids {set(found)}")
    check_grid(path.name, tags, found["cells"])
    expect(found["faces"].GetNumberOfCells() == sum(f["num_faces"] for f in tags["faces"]), f"{path.name}: faces")
    print(f"{path.name}: {found['cells'].GetNumberOfCells()} cells, {found['faces'].GetNumberOfCells()} faces by VTK's XDMF reader")


def check_opening_in_paraview(folder):
    """ParaView itself chooses its reader by the file's name, and computes volumes."""
    if not shutil.which("pvpython"):
        return print("ParaView is not installed: nothing was opened in it")
    # ParaView 5.11 knows VTKHDF by the name .hdf only.
    files = ["open.vtu", "open.pvtu", "open.vtm", "open.hdf", "open.exo", "light_paraview.xdmf"]
    make(folder, *(part for name in files[:-1] for part in ("-o", name)))
    make(folder, "-o", "light.xdmf")
    tags = read_tags(folder, "open")
    (folder / "open.py").write_text(
        "import json, sys\n"
        "from paraview import servermanager, simple\n"
        "from vtkmodules.util.numpy_support import vtk_to_numpy\n"
        "source = simple.OpenDataFile(sys.argv[1])\n"
        "sizes = servermanager.Fetch(simple.MergeBlocks(Input=simple.CellSize(Input=source, ComputeVolume=1)))\n"
        "volumes = vtk_to_numpy(sizes.GetCellData().GetArray('Volume'))\n"
        "print(json.dumps([int((volumes > 0).sum()), float(volumes.min()), float(volumes.sum())]))\n")
    for name in files:
        done = subprocess.run(["pvpython", folder / "open.py", folder / name], capture_output=True, text=True)
        if done.returncode != 0 or not done.stdout.strip():
            faults.append(f"{name}: ParaView says {done.stderr[-300:]}")
            continue
        num_cells, least, total = json.loads(done.stdout.splitlines()[-1])
        expect(num_cells == sum(v["num_cells"] for v in tags["volumes"]) and least >= 0, f"{name}: {num_cells} cells, least volume {least}")
        expect(close(total * tags["unit_m"] ** 3, sum(v["volume_m3"] for v in tags["volumes"]), 1e-6), f"{name}: volume {total} in ParaView")
        print(f"{name}: {num_cells} cells opened in ParaView")


def check_native(folder):
    sys.path.insert(0, str(ROOT / "examples"))
    from expand_native_mesh import expand
    for stem, options in (("solid", []), ("hollow", ["--conductors", "hollow"])):
        make(folder, "-o", f"{stem}.pcbmesh", "-o", f"{stem}.vtkhdf", *options)
        tags = read_tags(folder, stem)
        nodes, prisms, volume_tags = expand(folder / f"{stem}.pcbmesh")
        volumes = signed_volumes(prisms, nodes)
        expect((volumes > 0).all(), f"{stem}.pcbmesh: prisms inside out")
        for volume in tags["volumes"]:
            here = volume_tags == volume["id"]
            expect(here.sum() == volume["num_cells"] and close(volumes[here].sum(), volume["volume_m3"]), f"{stem}.pcbmesh: {volume['name']}")
        with h5py.File(folder / f"{stem}.vtkhdf") as f:
            wedges = f["mesh/wedge"][:]
            expect(numpy.array_equal(f["mesh/points"][:], nodes), f"{stem}.pcbmesh: nodes differ from those of the VTKHDF file")
            expect({tuple(w) for w in wedges} == {tuple(p) for p in prisms}, f"{stem}.pcbmesh: prisms differ from those of the VTKHDF file")
        size = (folder / f"{stem}.pcbmesh").stat().st_size
        print(f"{stem}.pcbmesh: {len(prisms)} prisms by h5py, {size / len(prisms):.2f} bytes each")
        if shutil.which("h5dump"):
            done = subprocess.run(["h5dump", "-H", folder / f"{stem}.pcbmesh"], capture_output=True, text=True)
            expect(done.returncode == 0 and "DATASET \"triangles\"" in done.stdout, f"{stem}.pcbmesh: h5dump says {done.stderr}")


def without_times(text):
    def strip(value):
        if isinstance(value, dict):
            return {k: strip(v) for k, v in value.items() if k != "cpu_s"}
        return [strip(v) for v in value] if isinstance(value, list) else value
    return strip(json.loads(text))


def check_reading_meshio(folder):
    """What meshio writes, the program reads: the same verdict as on its own file."""
    make(folder, "-o", "own.vtu", "--unit", "um", "--faces")
    own = folder / "own.vtu"
    own.write_bytes(re.sub(rb"  <FieldData>.*?</FieldData>\n", b"", own.read_bytes(), flags=re.DOTALL))  # meshio writes no names
    mesh = meshio.read(str(folder / "own.vtu"))
    tags = numpy.concatenate([numpy.where(v > 0, v, f) for v, f in zip(mesh.cell_data["volume_tag"], mesh.cell_data["face_tag"])])
    counts = numpy.cumsum([len(block.data) for block in mesh.cells])[:-1]
    mesh.cell_data = {"gmsh:physical": numpy.split(tags.astype("int32"), counts)}
    writers = {"meshio_zlib.vtu": {}, "meshio_plain.vtu": {"compression": None}, "meshio_text.vtu": {"binary": False},
               "meshio_lzma.vtu": {"compression": "lzma"}, "meshio.xdmf": {}, "meshio_text.xdmf": {"data_format": "XML"}}
    verdict = without_times(run("check", folder / "own.vtu", "--json", "--no-tags").stdout)
    expect(verdict["num_cells"] > 1000 and verdict["passed"], "own.vtu does not pass")
    for name, options in writers.items():
        meshio.write(str(folder / name), mesh, **options)
        done = run("check", folder / name, "--json", "--no-tags")
        found = without_times(done.stdout or "{}")
        if name == "meshio_text.vtu":  # its coordinates have twelve digits
            found, wanted = ({k: report.get(k) for k in ("passed", "num_nodes", "num_cells", "num_faces")} for report in (found, verdict))
        else:
            wanted = verdict
        expect(found == wanted, f"{name}: another verdict than on our own file: {done.stderr[:300]}")
        print(f"{name}: read, exit {done.returncode}")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check_vtu_family(folder)
        check_reading_meshio(folder)
        if "has no HDF5" in run("mesh", BOARD, "--no-check", "-o", folder / "try.vtkhdf").stderr:
            print("this build has no HDF5: its formats are not checked")
        else:
            check_hdf5_family(folder)
            check_native(folder)
            check_opening_in_paraview(folder)
    for fault in faults:
        print("FAULT:", fault)
    return 1 if faults else 0


sys.exit(main())
