# SPDX-License-Identifier: GPL-3.0-or-later
"""Boards in native JSON through pcbmesh to a solver and back: what a user does, as a function."""
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tests/decks"))
from program import PROGRAM, ROOT, run  # noqa: E402,F401

MM = 1e-3
ENDINGS = {"dolfinx": ".vtkhdf", "mfem": ".mesh"}


def has_getdp():
    return shutil.which("getdp") is not None


def has_dolfinx():
    """Debian keeps dolfinx for complex numbers where no interpreter looks by itself."""
    asked = subprocess.run([sys.executable, "-c", "import dolfinx, h5py"], env={"PETSC_DIR": "/usr/lib/petscdir/petsc-complex", **os.environ}, capture_output=True)
    return asked.returncode == 0


def has_palace():
    return bool(os.environ.get("PALACE")) and shutil.which(os.environ["PALACE"]) is not None


class Solved:
    """One mesh that was solved: its counts, the unknowns, CPU seconds of the solver, and the folder."""

    def __init__(self, folder, name, report, log, cpu_s):
        self.folder, self.name, self.report, self.cpu_s = folder, name, report, cpu_s
        self.prisms = report["counts"]["prisms"]
        self.unknowns = max([int(n) for n in re.findall(r"(\d+) (?:Dofs|unknowns)", log)], default=0)

    def touchstone(self):
        """[(hz, S as rows)] of the Touchstone file."""
        file = next(self.folder.glob(f"{self.name}.s[0-9]*p"))
        ports = int(file.suffix[2:-1])
        numbers = [float(word) for line in file.read_text().splitlines() if line and line[0] not in "!#" for word in line.split()]
        width = 1 + 2 * ports * ports
        out = []
        for at in range(0, len(numbers), width):
            values = [complex(numbers[at + 1 + 2 * k], numbers[at + 2 + 2 * k]) for k in range(ports * ports)]
            rows = [values[r * ports:(r + 1) * ports] for r in range(ports)]
            if ports == 2:
                rows = [[values[0], values[2]], [values[1], values[3]]]
            out.append((numbers[at], rows))
        return out

    def capacitance(self):
        """{(net, net): farad}, symmetric."""
        nets, out = {}, {}
        for line in (self.folder / f"{self.name}.capacitance.txt").read_text().splitlines():
            words = line.split()
            if words[:2] == ["#", "net"] and words[2].isdigit():
                nets[int(words[2])] = " ".join(words[3:])
            elif words and words[0] != "#":
                a, b, farad = nets[int(words[0])], nets[int(words[1])], float(words[2])
                out[a, b] = out[b, a] = farad
        return out

    def port_impedances(self):
        """Ohm, as the solver's port results state them: of a wave port what its mode has."""
        return [float(line.split()[3]) for line in (self.folder / f"{self.name}.ports.txt").read_text().splitlines() if line.startswith("# port ")]

    def quality_factors(self):
        """Of the modes, where the deck's solver says them."""
        part = (self.folder / f"{self.name}.modes.txt").read_text().split("# quality factor\n")[1]
        return [float(line.split()[1]) for line in part.splitlines() if line]

    def resonances_hz(self):
        """Ascending: the rows below the first heading, which GetDP repeats for every mode."""
        heading, found = None, []
        for line in (self.folder / f"{self.name}.modes.txt").read_text().splitlines():
            if line.startswith("#"):
                heading = heading or line
                if line != heading:
                    break
            elif len(line.split()) > 1:
                found.append(float(line.split()[1]))
        return sorted(found)


def solve(board, study, folder, solver="getdp", arguments=(), environment=None):
    """Meshes `board` for `study` (dictionaries as in their JSON files), runs the one command that pcbmesh prints, reads what comes of it."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    name = board["name"]
    (folder / f"{name}.json").write_text(json.dumps(board, indent=1))
    (folder / f"{name}.study.json").write_text(json.dumps(study, indent=1))
    meshed = run("mesh", folder / f"{name}.json", "--study", folder / f"{name}.study.json", "--for", solver, "-o", folder / f"{name}{ENDINGS.get(solver, '.msh')}", *arguments)
    if meshed.returncode != 0:
        raise RuntimeError(f"{name}: {meshed.stderr}{meshed.stdout}")
    report = json.loads((folder / f"{name}.report.json").read_text())
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = meshed.stdout.strip().splitlines()[-1].strip()
    done = subprocess.run(command, shell=True, capture_output=True, text=True, env={**os.environ, "PCBMESH": str(PROGRAM), "OMP_NUM_THREADS": "1", **(environment or {})})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    (folder / f"{name}.log").write_text(done.stdout + done.stderr)
    if done.returncode != 0:
        raise RuntimeError(f"{name}: {command}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return Solved(folder, name, report, done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def solve_twin(solved, resolution):
    """The same deck on the tetrahedral twin of the mesh; the results take the place of the prisms'."""
    import twin
    twin.write(solved.folder / f"{solved.name}.msh", solved.folder / f"{solved.name}.tets.msh")
    done = subprocess.run(["getdp", f"{solved.name}.pro", "-msh", f"{solved.name}.tets.msh", "-solve", resolution, "-v", "3"], cwd=solved.folder,
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stdout[-2000:] + done.stderr[-2000:])
    return Solved(solved.folder, solved.name, solved.report, done.stdout, 0)


def board(name, layers, outline, nets, **copper):
    """Native board JSON in millimetres. layers: (name, thickness) of copper, (name, thickness, eps_r, tan_delta) of dielectric."""
    materials = [{"name": "m_" + layer[0], "eps_r": layer[2], "tan_delta": layer[3]} for layer in layers if len(layer) == 4]
    stackup = [{"name": layer[0], "kind": "copper" if len(layer) == 2 else "dielectric", "thickness": layer[1],
                **({} if len(layer) == 2 else {"material": "m_" + layer[0]})} for layer in layers]
    return {"pcbmesh_board": 1, "name": name, "units": "mm", "materials": materials, "stackup": stackup, "nets": nets,
            "outline": outline, **copper}


def rect(x0, y0, x1, y1):
    return {"rect": [[x0, y0], [x1, y1]]}
