# SPDX-License-Identifier: GPL-3.0-or-later
"""Capacitances by CalculiX: steady heat flow is Laplace's equation, the flux out of a conductor at one kelvin is a charge over eps_0."""
import json
import re
import shutil
import subprocess

import exact
from solve import run


def has_calculix():
    return shutil.which("ccx") is not None


def capacitances(solved, nets, ground=()):
    """{(net, net): farad} of the prisms that another solver solved, as that solver's results have it; six digits. nets: {name: names of its face groups};
    ground: face groups that are held at nought besides."""
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
    text += "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL_NODES, 0.\n"
    groups = [(net, group) for net, names in nets.items() for group in names]
    for hot in nets:
        held = [(group, 0) for group in ground] + [(group, int(net == hot)) for net, group in groups]
        text += "*STEP\n*HEAT TRANSFER, STEADY STATE\n*BOUNDARY, OP=NEW\n" + "".join(f"{nodes[group]}, 11, 11, {kelvin}.\n" for group, kelvin in held)
        text += "".join(f"*NODE PRINT, NSET={nodes[group]}, TOTALS=ONLY\nRFL\n" for _, group in groups) + "*END STEP\n"
    (solved.folder / f"{name}.inp").write_text(text)
    done = subprocess.run(["ccx", name], cwd=solved.folder, capture_output=True, text=True)
    result = solved.folder / f"{name}.dat"
    found = re.findall(r"^\s+(-?\d\.\d+E[+-]\d+)\s*$", result.read_text(), re.M) if result.exists() else []
    if len(found) != len(nets) * len(groups):
        raise RuntimeError(f"ccx {name}: {len(found)} fluxes, not {len(nets) * len(groups)}\n{done.stdout[-800:]}")
    out, fluxes = {}, iter(found)
    for hot in nets:
        for net, _ in groups:
            out[hot, net] = out.get((hot, net), 0.0) + exact.EPS0 * float(next(fluxes))
    return out
