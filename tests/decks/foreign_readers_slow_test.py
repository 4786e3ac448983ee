#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What solvers and their readers make of the meshes: two fields whose capacitance is known exactly (GetDP, CalculiX), and the
validity checks of VTK, PETSc, Netgen and OpenFOAM. Readers that are not installed are skipped, each with a word."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from program import SKIPPED, run

faults, ran = [], []

# A plate capacitor of two dielectrics: the field is known exactly and elements of any order hold it.
CAPACITOR = {"pcbmesh_board": 1, "name": "capacitor", "units": "mm",
             "materials": [{"name": "a", "eps_r": 3}, {"name": "b", "eps_r": 6}],
             "stackup": [{"name": "low", "kind": "dielectric", "thickness": 0.5, "material": "a"},
                         {"name": "foil", "kind": "copper", "thickness": 0.02},  # bare: filled by its neighbour
                         {"name": "high", "kind": "dielectric", "thickness": 0.3, "material": "b"}],
             "outline": {"points": [[0, 0], [8, 0], [8, 5], [0, 5]]}}
AREA_M2, EPS = 40e-6, {"a": 3, "b": 6}


def exact_capacitance(tags):
    """C / eps_0 of the layers in series; 0.820 mm of dielectric in all."""
    thickness = {material: sum(v["volume_m3"] for v in tags["volumes"] if v["material"] == material) / AREA_M2 for material in EPS}
    expect(abs(sum(thickness.values()) - 0.82e-3) < 1e-12, f"thickness {thickness}")
    return AREA_M2 / sum(t / EPS[material] for material, t in thickness.items())


# Curved things, hollow copper, inner steps: what readers stumble over.
ROUND = {"pcbmesh_board": 1, "name": "round", "units": "mm", "nets": ["LINE", "GND"],
         "materials": [{"name": "FR4", "eps_r": 4.3, "tan_delta": 0.02}],
         "stackup": [{"name": "top", "kind": "copper", "thickness": 0.035}, {"name": "core", "kind": "dielectric", "thickness": 0.8, "material": "FR4"},
                     {"name": "bottom", "kind": "copper", "thickness": 0.035}],
         "outline": {"points": [[0, 0], [6, 0], [6, 5], [0, 5]]},
         "tracks": [{"layer": "top", "net": "LINE", "width": 0.4, "points": [[3, 2.5], [6, 2.5]]}],
         "vias": [{"at": [3, 2.5], "drill": 0.8, "pad": 1.4, "net": "LINE"}],
         "planes": [{"layer": "bottom", "net": "GND"}]}


def expect(condition, text):
    if not condition:
        faults.append(text)
        print("FAULT:", text)


def skip(what, why):
    print(f"{what}: skipped, {why}")


def program(*arguments):
    done = run(*arguments)
    expect(done.returncode == 0, f"{arguments}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def make(folder, board, stem, *options):
    source = folder / f"{board['name']}.json"
    source.write_text(json.dumps(board))
    mesh = folder / f"{stem}.msh"
    program("mesh", source, "-o", mesh, *options)
    return mesh, json.loads(mesh.with_suffix(".tags.json").read_text())


def shell(arguments, folder, timeout=600):
    return subprocess.run(list(map(str, arguments)), cwd=folder, capture_output=True, text=True, timeout=timeout,
                          env={"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ, "OMP_NUM_THREADS": "1"})


def face(tags, name):
    return next(f["id"] for f in tags["faces"] if f["name"] == name)


def volumes(tags, material):
    return [v["id"] for v in tags["volumes"] if v["material"] == material]


LIFT = 1000


def lift_face_tags(mesh):
    """GetDP's regions know no dimension: Region[1] is volume 1 and surface 1. Here surfaces get numbers of their own."""
    text = mesh.read_text()
    head, elements = text.split("$Elements\n")
    rows = [row.split() for row in elements.splitlines()]
    for row in rows:
        if len(row) > 5 and row[1] in ("2", "3"):
            row[3] = row[4] = str(LIFT + int(row[3]))
    mesh.write_text(head + "$Elements\n" + "\n".join(" ".join(row) for row in rows) + "\n")


def check_getdp(folder):
    """Laplace's equation: twice the energy at one volt is the capacitance."""
    if not shutil.which("getdp"):
        return skip("GetDP", "getdp is not installed")
    for stem, options, points in (("prisms", [], "Prism; NumberOfPoints 21"), ("tets", ["--split", "tets"], "Tetrahedron; NumberOfPoints 4")):
        mesh, tags = make(folder, CAPACITOR, f"getdp_{stem}", "--air", "0", "--msh-version", "2.2", "--ascii", *options)
        lift_face_tags(mesh)
        low, high = (",".join(map(str, volumes(tags, material))) for material in "ab")
        exact = exact_capacitance(tags)
        (folder / "cap.pro").write_text(f"""
Group {{ Vol_Low = Region[{{{low}}}]; Vol_High = Region[{{{high}}}]; Vol_All = Region[{{{low},{high}}}];
  Sur_Down = Region[{LIFT + face(tags, "zmin")}]; Sur_Up = Region[{LIFT + face(tags, "zmax")}]; }}
Function {{ eps[Vol_Low] = 3; eps[Vol_High] = 6; }}
Constraint {{ {{ Name Volts; Case {{ {{ Region Sur_Down; Value 0; }} {{ Region Sur_Up; Value 1; }} }} }} }}
FunctionSpace {{ {{ Name H1; Type Form0; BasisFunction {{ {{ Name sn; NameOfCoef vn; Function BF_Node; Support Vol_All; Entity NodesOf[All]; }} }}
  Constraint {{ {{ NameOfCoef vn; EntityType NodesOf; NameOfConstraint Volts; }} }} }} }}
Jacobian {{ {{ Name JVol; Case {{ {{ Region All; Jacobian Vol; }} }} }} }}
Integration {{ {{ Name Int; Case {{ {{ Type Gauss; Case {{ {{ GeoElement {points}; }} }} }} }} }} }}
Formulation {{ {{ Name Static; Type FemEquation; Quantity {{ {{ Name v; Type Local; NameOfSpace H1; }} }}
  Equation {{ Galerkin {{ [ eps[] * Dof{{d v}}, {{d v}} ]; In Vol_All; Jacobian JVol; Integration Int; }} }} }} }}
Resolution {{ {{ Name Solve; System {{ {{ Name A; NameOfFormulation Static; }} }} Operation {{ Generate[A]; Solve[A]; SaveSolution[A]; }} }} }}
PostProcessing {{ {{ Name Energy; NameOfFormulation Static; Quantity {{
  {{ Name twice; Value {{ Integral {{ [ eps[] * SquNorm[{{d v}}] ]; In Vol_All; Jacobian JVol; Integration Int; }} }} }} }} }} }}
PostOperation {{ {{ Name Table_C; NameOfPostProcessing Energy; Operation {{ Print[ twice[Vol_All], OnGlobal, Format Table, File "c.txt" ]; }} }} }}
""")
        done = shell(["getdp", "cap.pro", "-msh", mesh.name, "-solve", "Solve", "-pos", "Table_C"], folder)
        expect(done.returncode == 0 and (folder / "c.txt").exists(), f"getdp {stem}: {done.stdout[-500:]}{done.stderr[-500:]}")
        if (folder / "c.txt").exists():
            value = float((folder / "c.txt").read_text().split()[-1])
            expect(abs(value / exact - 1) < 1e-9, f"getdp {stem}: C / eps_0 = {value}, exactly {exact}")
            ran.append(f"GetDP, {stem}: C / eps_0 = {value:.9f} m, exactly {exact:.9f}")
            (folder / "c.txt").unlink()


def check_calculix(folder):
    """Steady heat flow is Laplace's equation: the flux between plates one kelvin apart is the capacitance."""
    if not shutil.which("ccx"):
        return skip("CalculiX", "ccx is not installed")
    for stem, options in (("c3d6", []), ("c3d4", ["--split", "tets"]), ("c3d15", ["--order", "2", "--wedge15"]),
                          ("c3d10", ["--order", "2", "--split", "tets"])):
        mesh, tags = make(folder, CAPACITOR, f"ccx_{stem}", "--air", "0", "--unit", "mm", *options)
        program("convert", mesh, folder / f"{stem}_mesh.inp")
        names = dict(re.findall(r"(?:ELSET=|NSET=)((?:V|N)(\d+)_\S*)", (folder / f"{stem}_mesh.inp").read_text()))
        by_tag = {name[0] + tag: name for name, tag in names.items()}
        down, up = by_tag[f"N{face(tags, 'zmin')}"], by_tag[f"N{face(tags, 'zmax')}"]
        materials = "".join(f"*MATERIAL, NAME=M{eps}\n*CONDUCTIVITY\n{eps}.\n" for eps in EPS.values())
        materials += "".join(f"*SOLID SECTION, ELSET={by_tag[f'V{tag}']}, MATERIAL=M{eps}\n" for name, eps in EPS.items() for tag in volumes(tags, name))
        exact = exact_capacitance(tags)
        (folder / f"{stem}.inp").write_text(
            f"*INCLUDE, INPUT={stem}_mesh.inp\n{materials}*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL_NODES, 0.\n*STEP\n"
            f"*HEAT TRANSFER, STEADY STATE\n*BOUNDARY\n{down}, 11, 11, 0.\n{up}, 11, 11, 1.\n"
            f"*NODE PRINT, NSET={up}, TOTALS=ONLY\nRFL\n*END STEP\n")
        done = shell(["ccx", stem], folder)
        result = folder / f"{stem}.dat"
        numbers = re.findall(r"^\s+(-?\d\.\d+E[+-]\d+)\s*$", result.read_text(), re.M) if result.exists() else []
        expect(numbers, f"ccx {stem}: no flux\n{done.stdout[-800:]}")
        if numbers:
            value = abs(float(numbers[-1])) * 1e-3  # millimetres
            expect(abs(value / exact - 1) < 2e-6, f"ccx {stem}: C / eps_0 = {value}, exactly {exact}")  # six digits are printed
            ran.append(f"CalculiX, {stem.upper()}: C / eps_0 = {value:.7f} m, exactly {exact:.7f}")


def check_vtk(folder):
    try:
        from vtkmodules.vtkIOExodus import vtkExodusIIReader
        from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
        from vtkmodules.util.numpy_support import vtk_to_numpy
    except ImportError as missing:
        return skip("VTK", missing)
    for stem, options in (("prisms", []), ("tets", ["--split", "tets"]), ("wedge18", ["--order", "2"]), ("wedge15", ["--order", "2", "--wedge15"])):
        mesh, tags = make(folder, ROUND, f"vtk_{stem}", *options)
        program("convert", mesh, mesh.with_suffix(".exo"))
        reader = vtkExodusIIReader()
        reader.SetFileName(str(mesh.with_suffix(".exo")))
        reader.UpdateInformation()
        blocks, sides = vtkExodusIIReader.ELEM_BLOCK, vtkExodusIIReader.SIDE_SET
        names = {reader.GetObjectId(blocks, i): reader.GetObjectName(blocks, i) for i in range(reader.GetNumberOfObjects(blocks))}
        side_names = {reader.GetObjectId(sides, i): reader.GetObjectName(sides, i) for i in range(reader.GetNumberOfObjects(sides))}
        # VTK 9.1 puts "Unnamed block ID: 1" where a name is absent, and else the name, perhaps with the id behind it.
        expect(all(v["name"] in names.get(v["id"], "") for v in tags["volumes"]), f"vtk {stem}: blocks {names}")
        expect(all(f["name"] in side_names.get(f["id"], "") for f in tags["faces"]), f"vtk {stem}: side sets {side_names}")
        for i in range(reader.GetNumberOfObjects(sides)):
            reader.SetObjectStatus(sides, i, 1)
        reader.Update()
        output = reader.GetOutput()
        cells, total = {}, 0.0
        element_blocks = output.GetBlock(0)
        for i in range(element_blocks.GetNumberOfBlocks()):
            grid = element_blocks.GetBlock(i)
            cells[reader.GetObjectId(blocks, i)] = grid.GetNumberOfCells()
            if stem == "tets":
                size = vtkCellSizeFilter()
                size.SetInputData(grid)
                size.Update()
                total += vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Volume")).sum()
        expect(cells == {v["id"]: v["num_cells"] for v in tags["volumes"]}, f"vtk {stem}: cells {cells}")
        if stem == "tets":
            exact = sum(v["volume_m3"] for v in tags["volumes"])
            # VTK 9.1 hands points of Exodus files out in single precision.
            expect(abs(total / exact - 1) < 1e-6, f"vtk {stem}: volume {total}, expected {exact}")
        sets = output.GetBlock(4)
        found, boxes = {}, {}
        for i in range(sets.GetNumberOfBlocks()):
            part = sets.GetBlock(i)
            found[reader.GetObjectId(sides, i)] = part.GetNumberOfCells()
            boxes[reader.GetObjectId(sides, i)] = part.GetBounds()
        expect(found == {f["id"]: f["num_faces"] for f in tags["faces"]}, f"vtk {stem}: sides {found}")
        # The right sides of the right cells: every outer set lies in its plane.
        low, high = tags["bounding_box_m"]["min"], tags["bounding_box_m"]["max"]
        for name, axis, value in (("xmin", 0, low[0]), ("xmax", 0, high[0]), ("ymin", 1, low[1]), ("zmin", 2, low[2]), ("zmax", 2, high[2])):
            box = boxes[face(tags, name)]
            expect(max(abs(box[2 * axis] - value), abs(box[2 * axis + 1] - value)) < 1e-9, f"vtk {stem}: {name} lies at {box}")
        ran.append(f"VTK's Exodus reader, {stem}: {sum(cells.values())} cells in {len(cells)} blocks, {sum(found.values())} sides in {len(found)} sets")


def check_petsc(folder):
    # Debian keeps the module beside the PETSc it belongs to.
    sys.path.extend(map(str, sorted(pathlib.Path("/usr/lib/petscdir").glob("*/*-real/lib/python3/dist-packages"))))
    try:
        import petsc4py
        petsc4py.init(["-dm_plex_check_all"])
        from petsc4py import PETSc
    except ImportError as missing:
        return skip("PETSc", missing)
    for stem, options in (("prisms22", ["--msh-version", "2.2"]), ("prisms41", []), ("tets", ["--split", "tets"]), ("wedge18", ["--order", "2"]),
                          ("tets10", ["--order", "2", "--split", "tets"])):
        mesh, tags = make(folder, ROUND, f"petsc_{stem}", *options)
        plex = PETSc.DMPlex().createFromFile(str(mesh), comm=PETSc.COMM_SELF)
        first, last = plex.getHeightStratum(0)
        expect(last - first == sum(v["num_cells"] for v in tags["volumes"]), f"petsc {stem}: {last - first} cells")
        for label, groups, key in (("Cell Sets", tags["volumes"], "num_cells"), ("Face Sets", tags["faces"], "num_faces")):
            height = 0 if key == "num_cells" else 1
            low, high = plex.getHeightStratum(height)
            for group in groups:
                points = plex.getStratumIS(label, group["id"]).getIndices()
                count = ((points >= low) & (points < high)).sum()
                expect(count == group[key], f"petsc {stem}: {group['name']} has {count}, expected {group[key]}")
        # Faces with one cell are the hull, and all of it is tagged.
        low, high = plex.getHeightStratum(1)
        hull = sum(plex.getSupportSize(f) == 1 for f in range(low, high))
        expect(hull == sum(f["num_faces"] for f in tags["faces"] if not f["inner"]), f"petsc {stem}: {hull} faces on the hull")
        ran.append(f"PETSc DMPlex, {stem}: {last - first} cells, {hull} faces on the hull, all of them tagged; its own checks pass")


def check_netgen(folder):
    try:
        from netgen.read_gmsh import ReadGmsh
    except ImportError as missing:
        return skip("Netgen", missing)
    for stem, options, width in (("prisms", [], 6), ("tets", ["--split", "tets"], 4)):
        mesh, tags = make(folder, ROUND, f"netgen_{stem}", "--msh-version", "2.2", "--ascii", *options)
        read = ReadGmsh(str(mesh))
        elements = read.Elements3D()
        expect(len(elements) == sum(v["num_cells"] for v in tags["volumes"]), f"netgen {stem}: {len(elements)} cells")
        expect({len(e.vertices) for e in elements} == {width}, f"netgen {stem}: nodes per cell")
        faces = len(read.Elements2D())
        expect(faces == sum(f["num_faces"] for f in tags["faces"]), f"netgen {stem}: {faces} faces")
        ran.append(f"Netgen ReadGmsh, {stem}: {len(elements)} cells, {faces} faces")


def check_openfoam(folder):
    tools = {name: shutil.which(name) or shutil.which(f"{name}.openfoam") for name in ("gmshToFoam", "checkMesh")}
    if None in tools.values():
        return skip("OpenFOAM", "gmshToFoam and checkMesh are not installed")
    control = ("FoamFile { version 2.0; format ascii; class dictionary; object controlDict; }\napplication x; startFrom startTime; startTime 0; "
               "stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1; writePrecision 12;\n")
    for stem, options in (("prisms", []), ("tets", ["--split", "tets"])):
        mesh, tags = make(folder, ROUND, f"foam_{stem}", "--msh-version", "2.2", "--ascii", "--unit", "mm", *options)
        case = folder / f"case_{stem}"
        (case / "system").mkdir(parents=True)
        (case / "system/controlDict").write_text(control)
        for scheme, entries in (("fvSchemes", ("ddtSchemes", "gradSchemes", "divSchemes", "laplacianSchemes", "interpolationSchemes", "snGradSchemes")),
                                ("fvSolution", ())):
            (case / "system" / scheme).write_text(f"FoamFile {{ version 2.0; format ascii; class dictionary; object {scheme}; }}\n" +
                                                  "".join(f"{entry} {{ }}\n" for entry in entries))
        shutil.copy(mesh, case / "mesh.msh")
        done = shell([tools["gmshToFoam"], "mesh.msh"], case)
        expect(done.returncode == 0, f"gmshToFoam {stem}: {done.stdout[-800:]}{done.stderr[-300:]}")
        done = shell([tools["checkMesh"], "-constant", "-allTopology"], case)
        checked = done.stdout + done.stderr
        cells = re.search(r"^\s+cells:\s+(\d+)", checked, re.M)
        expect(cells and int(cells[1]) == sum(v["num_cells"] for v in tags["volumes"]), f"checkMesh {stem}: {checked[-1500:]}")
        leftover = re.search(r"defaultFaces\s+(\d+)", checked)
        expect(leftover is None or int(leftover[1]) == 0, f"checkMesh {stem}: defaultFaces has {leftover and leftover[1]} faces")
        volume_found = re.search(r"Total volume = ([0-9.e+-]+)", checked)
        exact = sum(v["volume_m3"] for v in tags["volumes"]) * 1e9
        expect(volume_found and abs(float(volume_found[1].rstrip(".")) / exact - 1) < 1e-4, f"checkMesh {stem}: volume {volume_found and volume_found[1]}, expected {exact}")
        for problem in ("Open cells found", "negative volume", "zero or negative", "Number of regions: [2-9]"):
            expect(not re.search(problem, checked), f"checkMesh {stem}: {problem}")
        ran.append(f"OpenFOAM gmshToFoam and checkMesh, {stem}: {cells and cells[1]} cells, {leftover[1] if leftover else 0} default faces")


def main():
    for check in (check_getdp, check_calculix, check_vtk, check_petsc, check_netgen, check_openfoam):
        with tempfile.TemporaryDirectory() as name:
            check(pathlib.Path(name))
    print("\n".join(ran))
    if faults:
        return 1
    return 0 if ran else SKIPPED


sys.exit(main())
