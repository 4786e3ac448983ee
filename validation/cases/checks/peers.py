# SPDX-License-Identifier: GPL-3.0-or-later
"""Other programs that judge meshes, each as a function file -> (verdict, words). A program that is not installed is None."""
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
PETSC_DIR = os.environ.get("PETSC_DIR", "/usr/lib/petscdir/petsc-real" if pathlib.Path("/usr/lib/petscdir/petsc-real").exists() else
                           next((str(path) for path in sorted(pathlib.Path("/usr/lib/petscdir").glob("petsc*/x86_64*-real"))), "/usr/lib/petsc"))
HOW_TO_INSTALL = {"gmsh -check": "gmsh", "VTK": "python3-paraview", "PETSc": "python3-petsc4py", "OpenFOAM": "openfoam"}


def run(command, **options):
    """(exit code, all output, CPU seconds)"""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          timeout=1200, env={**os.environ, "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                               "WM_PROJECT_DIR": "/usr/share/openfoam", "PETSC_DIR": PETSC_DIR}, **options)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.returncode, done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def gmsh_check(file):
    """Only an error changes Gmsh's exit code; its warnings count as found all the same."""
    code, text, cpu = run(["gmsh", "-check", file])
    lines = [line for line in text.splitlines() if re.match(r"(Error|Warning)\s*:", line)]
    bad = [line for line in lines if "Unknown" not in line]
    return ("found" if code else "warns" if bad else "passes"), (bad[0][:90] if bad else ""), cpu


VTK_SCRIPT = """
import sys, meshio, vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
import numpy
mesh = meshio.read(sys.argv[1])
points = vtk.vtkPoints(); points.SetData(numpy_to_vtk(mesh.points, deep=1))
grid = vtk.vtkUnstructuredGrid(); grid.SetPoints(points)
kinds = {"tetra": 10, "hexahedron": 12, "wedge": 13, "pyramid": 14}
grid.Allocate(sum(len(b.data) for b in mesh.cells))
for block in mesh.cells:
    if block.type not in kinds: continue
    data = block.data[:, [0, 2, 1, 3, 5, 4]] if block.type == "wedge" else block.data
    for row in data: grid.InsertNextCell(kinds[block.type], len(row), row.tolist())
import time; start = time.process_time()
validator = vtk.vtkCellValidator(); validator.SetInputData(grid); validator.Update()
spent = time.process_time() - start
states = vtk_to_numpy(validator.GetOutput().GetCellData().GetArray("ValidityState"))
bad = int((states != 0).sum())
print("CELLS", grid.GetNumberOfCells(), "BAD", bad, "STATE", int(states[states != 0][0]) if bad else 0, "SPENT", spent)
"""


def vtk_check(file):
    """The cells alone: VTK's validator looks at one cell at a time."""
    code, text, _ = run(["/usr/bin/python3", "-c", VTK_SCRIPT, file])
    found = re.search(r"BAD (\d+) STATE (\d+) SPENT (\S+)", text)
    if not found:
        return "refuses", text.strip().splitlines()[-1][:90] if text.strip() else f"exit {code}", 0.0
    bad = int(found[1])
    return ("found" if bad else "passes"), (f"{bad} cells, state {int(found[2]):#x}" if bad else ""), float(found[3])


PETSC_SCRIPT = """
import sys, time, petsc4py
petsc4py.init(["petsc", "-dm_plex_gmsh_use_regions", "0"])
from petsc4py import PETSc
plex = PETSc.DMPlex().createFromFile(sys.argv[1], interpolate=True)
start = time.process_time()
PETSc.Options().setValue("dm_plex_check_all", None)
plex.setFromOptions()
low, high = plex.getHeightStratum(1)
odd = sum(1 for f in range(low, high) if plex.getSupportSize(f) > 2)
print("ODD", odd, "SPENT", time.process_time() - start)
"""


def petsc_check(file):
    code, text, _ = run(["/usr/bin/python3", "-c", PETSC_SCRIPT, file])
    found = re.search(r"ODD (\d+) SPENT (\S+)", text)
    if found:
        return ("found" if int(found[1]) else "passes"), (f"{found[1]} faces of more than two cells" if int(found[1]) else ""), float(found[2])
    lines = [line for line in text.splitlines() if re.search(r"\[0\]|rror", line) and "***" not in line]
    return "found", (lines[-1][:90] if lines else f"exit {code}"), 0.0


usual_complaints = set()


def kind_of_complaint(line):
    return re.sub(r"[-+]?\d[\d.e+-]*", "#", line.strip())


def learn_openfoam(file):
    """What is said of a good mesh of thin layers too (small determinants) is no verdict on damage. Returns it."""
    def remember(words):
        usual_complaints.update(kind_of_complaint(line) for line in words.splitlines() if line.strip().startswith("***"))
        usual_complaints.update(re.findall(r"Found \d+ undefined faces", words))
    openfoam_check(file, remember)
    return "; ".join(sorted(complaint.strip("* ") for complaint in usual_complaints))


CONTROL = """FoamFile { version 2.0; format ascii; class dictionary; object controlDict; }
application checkMesh; startFrom startTime; startTime 0; stopAt endTime; endTime 1; deltaT 1; writeControl timeStep; writeInterval 1;
"""


def openfoam_check(file, look=lambda words: None):
    with tempfile.TemporaryDirectory() as name:
        case = pathlib.Path(name)
        (case / "system").mkdir()
        (case / "system/controlDict").write_text(CONTROL)
        schemes = "".join(f"{name} {{ default none; }} " for name in ("ddtSchemes", "gradSchemes", "divSchemes", "laplacianSchemes", "interpolationSchemes", "snGradSchemes"))
        (case / "system/fvSchemes").write_text("FoamFile { version 2.0; format ascii; class dictionary; object fvSchemes; }\n" + schemes + "\n")
        (case / "system/fvSolution").write_text("FoamFile { version 2.0; format ascii; class dictionary; object fvSolution; }\n")
        code, text, _ = run(["gmshToFoam", "-case", case, file])
        if code or "FOAM FATAL" in text:
            fatal = [line.strip() for line in text.splitlines() if line.strip() and "FATAL" not in line][-3:]
            return "refuses", " ".join(fatal)[:90], 0.0
        extra = re.search(r"Found (\d+) undefined faces", text)
        code, text, cpu = run(["checkMesh", "-case", case, "-allGeometry", "-allTopology"])
        look(text + "\n" + (extra[0] if extra else ""))
        stars = [line.strip() for line in text.splitlines() if line.strip().startswith("***") and kind_of_complaint(line) not in usual_complaints]
        if stars:
            return "found", stars[0][:90], cpu
        undefined = extra[0] if extra else ""
        if undefined not in usual_complaints and undefined:
            return "found", undefined, cpu
        if "Mesh OK" not in text and "***" not in text:
            return "refuses", text.strip().splitlines()[-1][:90], cpu
        return "passes", "", cpu


def has_python(module):
    return run(["/usr/bin/python3", "-c", f"import {module}"])[0] == 0


def peers():
    """Name -> function; and the names of those that are missing."""
    all_peers = {"gmsh -check": (gmsh_check, shutil.which("gmsh")), "VTK": (vtk_check, has_python("vtk, meshio")),
                 "PETSc": (petsc_check, has_python("petsc4py")), "OpenFOAM": (openfoam_check, shutil.which("checkMesh") and shutil.which("gmshToFoam"))}
    here = {name: call for name, (call, there) in all_peers.items() if there}
    for name in all_peers:
        if name not in here:
            print(f"skipped: {name} is not installed (Debian package {HOW_TO_INSTALL[name]})", file=sys.stderr)
    return here
