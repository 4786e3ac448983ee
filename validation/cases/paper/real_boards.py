# SPDX-License-Identifier: GPL-3.0-or-later
"""Regions of real boards: prisms of the paper's best case against the hexagonal, smoothed mesh of at least the same qualities."""
import json
import os
import pathlib
import subprocess

import evidence as e
import measurements as m

DATA = pathlib.Path(os.environ.get("PCBMESH_TEST_DATA", m.ROOT.parent / "shared/data")) / "kicad"
NUM_BOARDS = 5
BUDGET = "3e7"
POLICIES = ("basic", "average", "maximum", "minimum", "thinnest_layer")


def _report(*words):
    done = subprocess.run([str(w) for w in (m.PROGRAM, *words)], capture_output=True, text=True, timeout=300)
    return json.loads(done.stdout) if done.returncode == 0 else None


def _region(board):
    """Flags for two routed nets of middling size, as the case of the boards takes them; None where there are none."""
    info = _report("inspect", board, "--json", "--quiet")
    if info is None:
        return None
    routed = [n for n in info["nets"] if n["name"] and n["tracks"] and n["pads"] >= 2 and n["tracks"] + n["vias"] <= 400]
    routed.sort(key=lambda n: (-(n["tracks"] + n["vias"]), n["name"]))
    names = [n["name"] for n in routed[len(routed) // 2:][:2]]
    return ("--nets", ",".join(n.replace("\\", "\\\\").replace(",", "\\,") for n in names), "--margin", "0.5mm") if len(names) == 2 else None


def _mesh(board, region, *flags):
    report = _report("mesh", board, *region, "--air", "0", "--dry-run", "--json", "--quiet", "--max-prisms", BUDGET, *flags)
    if report is None:
        return None
    quality = report["quality"]
    return {"prisms": report["counts"]["prisms"], "q": quality["mean_prism"], "qv": quality["volume_weighted_prism"],
            "triangles": report["counts"]["triangles"], "outline": report["triangulation"]["input_vertices"]}


def _papers_best(board, region):
    """(policy, mesh) of greatest mean among the paper's cases within the budget, floor rule; and the cases beyond it."""
    found, beyond_budget = [], []
    for policy in POLICIES:
        got = _mesh(board, region, "--policy", policy, "--sublayers", "floor")
        if got is None:
            beyond_budget.append(policy)
        else:
            found.append((policy, got))
    return (max(found, key=lambda pair: pair[1]["q"]) if found else None), beyond_budget


def _fewest(board, region, goal):
    """Fewest prisms of hexagonal meshes with both qualities of the goal: bisection over the edge, both rules of cutting."""
    best = None
    for rule in ("optimal", "best_mean"):
        low, high = 20.0, 2000.0
        for _ in range(8):
            middle = (low * high) ** 0.5
            got = _mesh(board, region, "--seed", "hex", "--smooth", "--policy", "none", "--sublayers", rule, "--longest-edge", f"{middle:.5g}um")
            if got is None or (got["q"] >= goal["q"] and got["qv"] >= goal["qv"]):
                low = middle
                if got and (best is None or got["prisms"] < best["prisms"]):
                    best = dict(got, edge_um=middle, rule=rule)
            else:
                high = middle
    return best


def section():
    if not DATA.is_dir():
        return "Not measured: the boards are not on this machine.\n"
    rows = []
    for board in sorted(p for p in DATA.iterdir() if ".kicad_pcb" in p.name):
        if len(rows) == NUM_BOARDS:
            break
        region = _region(board)
        best, beyond_budget = _papers_best(board, region) if region else (None, [])
        if best is None:
            continue
        policy, goal = best
        ours = _fewest(board, region, goal)
        cells = ("not reached", "", "", "", "") if ours is None else (
            f"{ours['prisms']:,} ({ours['rule']}, {ours['edge_um']:.4g} um)", f"{ours['q']:.4f}", f"{ours['qv']:.4f}", f"{goal['prisms'] / ours['prisms']:.2f}", f"{ours['triangles'] / ours['outline']:.1f}")
        rows.append((board.name.split(".kicad_pcb")[0], policy, f"{goal['prisms']:,}", f"{goal['q']:.4f}", f"{goal['qv']:.4f}", *cells, ", ".join(beyond_budget) or "none"))
    fewer = [float(r[8]) for r in rows if r[8]]
    verdict = (f"Three times fewer prisms is reached on {sum(f >= 3 for f in fewer)} of {len(rows)}. The paper's cases 4 and 5, where they are its best, ask for more prisms than the "
               "budget and are not compared. Case 2 is coarse, and so are our meshes of its quality: with edges up to millimetres the angle bound, which grades away from the "
               "short edges of pads and arcs, makes the triangles, and the lattice has little left to save. The saving of the tables above needs edges of the "
               "size of the features or less. Only a coarser tolerance or arc sagitta takes away the rest.\n\n")
    return (verdict + "Two nets of middling size and 0.5 mm round them, copper solid, no air, floor as sub-layer rule for the paper's cases. Ours must reach both means.\n\n"
            + e.table(("board", "paper's best case", "prisms", "q_p", "by volume", "hex, smoothed: prisms", "q_p", "by volume", "times fewer", "triangles per outline vertex", f"cases above {float(BUDGET):.0e} prisms"), rows))
