# SPDX-License-Identifier: GPL-3.0-or-later
"""Capacitances of one mesh in every code at hand, on prisms and on their tetrahedral twin."""
import os

import cases
import laplace
import solve
from solve import MM

ORDER = ("GetDP, prisms", "dolfinx, prisms", "MFEM, prisms", "CalculiX, prisms", "GetDP, twin", "dolfinx, twin")
LINES_MM = (0.015, 0.004)  # edge at the strips, length of the slice


def beside(code):
    """[(other code, most that they may differ)]: rounding on the same elements, 0.5 % else."""
    return {"dolfinx, prisms": [("GetDP, prisms", 1e-8)], "MFEM, prisms": [("GetDP, prisms", 1e-8)], "CalculiX, prisms": [("GetDP, prisms", 0.005)],
            "GetDP, twin": [("GetDP, prisms", 0.005)], "dolfinx, twin": [("GetDP, twin", 1e-8), ("GetDP, prisms", 0.005)]}.get(code, [])


def off_formula(folder, case, nets, ground):
    """{("a to b", wanted farad): {code: part by which it is off}} in parts of the largest wanted, for small couplings are differences of large terms.
    case: (folder, **run) -> (solved, found, wanted); nets, ground: face groups, as laplace.capacitances has them."""
    solved, found, wanted = case(folder / "getdp")
    by_code = {"GetDP, prisms": found}
    if laplace.has_calculix():
        by_code["CalculiX, prisms"] = laplace.capacitances(solved, nets, ground)
    by_code["GetDP, twin"] = solve.solve_twin(solved, "Capacitance").capacitance()
    if solve.has_dolfinx():
        by_code["dolfinx, prisms"] = case(folder / "dolfinx", solver="dolfinx")[1]
        by_code["dolfinx, twin"] = case(folder / "twin", solver="dolfinx", arguments=["--split", "tets"])[1]
    if os.environ.get("MFEM_DIR"):
        by_code["MFEM, prisms"] = case(folder / "mfem", solver="mfem")[1]
    scale = max(abs(farad) for farad in wanted.values())
    return {(f"{a} to {b}", farad): {code: (values[a, b] - farad) / scale for code, values in by_code.items()} for (a, b), farad in wanted.items()}


def plates(folder, **run):
    solved, found, wanted = cases.plates(folder, mode="hollow", **run)
    return solved, {("A", "GND"): found}, {("A", "GND"): wanted}


def barrel(folder, **run):
    solved, found, wanted = cases.coaxial_via(folder, 0.2, 0.05, **run)
    return solved, {("SIG", "SIG"): found}, {("SIG", "SIG"): wanted}


def lines(edge_mm, slice_mm):
    def case(folder, **run):
        solved, *tables = cases.coupled_lines(folder, 0.5, edge_mm, slice_mm=slice_mm, run=run)
        return solved, *({(f"L{i}", f"L{j}"): MM * slice_mm * table[i][j] for i, j in ((0, 0), (1, 1), (0, 1), (0, 2))} for table in tables)
    return case


def three_lines(folder, edge_mm=LINES_MM[0], slice_mm=LINES_MM[1]):
    return off_formula(folder, lines(edge_mm, slice_mm), {net: [f"sheet|{net}"] for net in ("L0", "L1", "L2")}, ["sheet|GND|outer"])


def everything(folder):
    """[(name of the case, off_formula of it)]"""
    return [("plates", off_formula(folder, plates, {"A": ["surface|A"], "GND": ["surface|GND"]}, [])),
            ("coaxial via", off_formula(folder, barrel, {"SIG": ["surface|SIG"]}, ["side"])),
            ("three lines", three_lines(folder))]
