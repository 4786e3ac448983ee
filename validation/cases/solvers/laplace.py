# SPDX-License-Identifier: GPL-3.0-or-later
"""Capacitance by CalculiX: steady heat flow is Laplace's equation, the flux between conductors one kelvin apart is C / eps_0."""
import json
import re
import shutil
import subprocess

import exact
from solve import run


def has_calculix():
    return shutil.which("ccx") is not None


def capacitance(solved, hot, cold):
    """Farad between the face groups named `hot` and those named `cold` of a mesh that another solver solved; six digits."""
    name = f"{solved.name}_heat"
    done = run("convert", solved.folder / f"{solved.name}.msh", solved.folder / f"{name}_mesh.inp")
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    mesh = (solved.folder / f"{name}_mesh.inp").read_text()
    sets = {kind + tag: whole for whole, kind, tag in re.findall(r"(?:ELSET=|NSET=)((V|N)(\d+)_[^,\s]*)", mesh)}
    tags = json.loads((solved.folder / f"{solved.name}.tags.json").read_text())
    eps = {m["name"]: m["eps_r"] for m in tags["materials"]}
    nodes = {f["name"]: sets[f"N{f['id']}"] for f in tags["faces"] if f"N{f['id']}" in sets}
    text = f"*INCLUDE, INPUT={name}_mesh.inp\n" + "".join(f"*MATERIAL, NAME=M{i}\n*CONDUCTIVITY\n{eps[v['material']]}\n*SOLID SECTION, ELSET={sets['V' + str(v['id'])]}, MATERIAL=M{i}\n"
                                                         for i, v in enumerate(tags["volumes"]))
    held = "".join(f"{nodes[n]}, 11, 11, {value}\n" for names, value in ((cold, "0."), (hot, "1.")) for n in names)
    text += "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL_NODES, 0.\n*STEP\n*HEAT TRANSFER, STEADY STATE\n*BOUNDARY\n" + held
    text += "".join(f"*NODE PRINT, NSET={nodes[n]}, TOTALS=ONLY\nRFL\n" for n in hot) + "*END STEP\n"
    (solved.folder / f"{name}.inp").write_text(text)
    done = subprocess.run(["ccx", name], cwd=solved.folder, capture_output=True, text=True)
    result = solved.folder / f"{name}.dat"
    found = re.findall(r"^\s+(-?\d\.\d+E[+-]\d+)\s*$", result.read_text(), re.M) if result.exists() else []
    if len(found) != len(hot):
        raise RuntimeError(f"ccx {name}: no flux\n{done.stdout[-800:]}")
    return exact.EPS0 * sum(abs(float(f)) for f in found)
