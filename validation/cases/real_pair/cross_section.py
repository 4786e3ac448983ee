# SPDX-License-Identifier: GPL-3.0-or-later
"""Impedance and delay of a microstrip, or of a pair, from the electrostatics of its cross-section: a plane mesh by Gmsh, nodal elements of second order by GetDP.
Independent of pcbmesh: no layout, no prisms, no edge elements, no ports. Lossless, quasi-TEM."""
import math
import pathlib
import re
import subprocess
import tempfile
from dataclasses import dataclass

LIGHT, EPS_0 = 299792458.0, 8.8541878128e-12


@dataclass(frozen=True)
class Section:
    """All lengths in mm. `etch`: each upper corner lies so much further in than the lower one; `mask`: thickness of solder mask on laminate and trace (0 = none)."""
    width: float = 0.185
    gap: float = 0.0  # between the traces of a pair; 0 = one trace
    height: float = 0.12
    thickness: float = 0.035
    eps_r: float = 4.18
    etch: float = 0.0
    mask: float = 0.0
    eps_mask: float = 3.3


DECK = """
Group {{ Air = Region[1]; Laminate = Region[2]; Mask = Region[3]; Plane = Region[10]; Hot = Region[11]; Mirror = Region[12];
  Dom = Region[{{Air, Laminate, Mask}}]; }}
Function {{ eps[Air] = 1; eps[Laminate] = {laminate}; eps[Mask] = {mask}; }}
Constraint {{ {{ Name Volts; Case {{ {{ Region Plane; Value 0; }} {{ Region Hot; Value 1; }} {mirror} }} }} }}
Constraint {{ {{ Name Flat; Case {{ {{ Region Plane; Value 0; }} {{ Region Hot; Value 0; }} {mirror} }} }} }}
FunctionSpace {{ {{ Name H; Type Form0; BasisFunction {{
  {{ Name s; NameOfCoef v; Function BF_Node; Support Dom; Entity NodesOf[All]; }}
  {{ Name q; NameOfCoef w; Function BF_Node_2E; Support Dom; Entity EdgesOf[All]; }} }}
  Constraint {{ {{ NameOfCoef v; EntityType NodesOf; NameOfConstraint Volts; }} {{ NameOfCoef w; EntityType EdgesOf; NameOfConstraint Flat; }} }} }} }}
Jacobian {{ {{ Name J; Case {{ {{ Region All; Jacobian Vol; }} }} }} }}
Integration {{ {{ Name I; Case {{ {{ Type Gauss; Case {{ {{ GeoElement Triangle; NumberOfPoints 6; }} }} }} }} }} }}
Formulation {{ {{ Name F; Type FemEquation; Quantity {{ {{ Name v; Type Local; NameOfSpace H; }} }}
  Equation {{ Galerkin {{ [eps[] * Dof{{d v}}, {{d v}}]; In Dom; Jacobian J; Integration I; }} }} }} }}
Resolution {{ {{ Name R; System {{ {{ Name A; NameOfFormulation F; }} }} Operation {{ Generate[A]; Solve[A]; SaveSolution[A]; }} }} }}
PostProcessing {{ {{ Name P; NameOfFormulation F; Quantity {{ {{ Name w; Value {{ Integral {{ [eps[] * SquNorm[{{d v}}]]; In Dom; Jacobian J; Integration I; }} }} }} }} }} }}
PostOperation {{ {{ Name W; NameOfPostProcessing P; Operation {{ Print[w[Dom], OnGlobal, Format Table, File "w.txt"]; }} }} }}
"""


def geometry(section, odd, fine):
    """Half of the cross-section, x >= 0: of one trace its right half, of a pair its right trace; the rest follows by symmetry."""
    left = section.gap / 2
    right = left + (section.width if section.gap else section.width / 2)
    h, t, far = section.height, section.thickness, 30 * section.height
    lines = ['SetFactory("OpenCASCADE");', f"h = {h}; far = {far};", "Rectangle(1) = {0, 0, 0, far, h};", "Rectangle(2) = {0, h, 0, far, far};"]
    inner = section.etch if section.gap else 0
    corners = [(left, h), (right, h), (right - section.etch, h + t), (left + inner, h + t)]
    lines += [f"Point({100 + i}) = {{{x}, {y}, 0, {fine}}};" for i, (x, y) in enumerate(corners)]
    lines += [f"Line({100 + i}) = {{{100 + i}, {100 + (i + 1) % 4}}};" for i in range(4)]
    lines += ["Curve Loop(100) = {100:103}; Plane Surface(3) = {100};"]
    if section.mask:
        m = section.mask
        lines += [f"Rectangle(4) = {{0, {h}, 0, far, {m}}};", f"Rectangle(5) = {{{max(left - m, 0)}, {h}, 0, {right + m - max(left - m, 0)}, {t + m}}};",
                  "BooleanUnion(6) = { Surface{4}; Delete; }{ Surface{5}; Delete; };", "BooleanDifference(7) = { Surface{6}; Delete; }{ Surface{3}; };",
                  "BooleanDifference(8) = { Surface{2}; Delete; }{ Surface{3}; Delete; };", "BooleanFragments{ Surface{1, 8}; Delete; }{ Surface{7}; Delete; }"]
    else:
        lines += ["BooleanDifference(8) = { Surface{2}; Delete; }{ Surface{3}; Delete; };", "BooleanFragments{ Surface{1, 8}; Delete; }{}"]
    return "\n".join(lines), corners, far


def energy(section, odd, air, fine=0.002):
    """Twice the energy of one line at 1 V over eps_0: its capacitance per length over eps_0."""
    import gmsh
    text, corners, far = geometry(section, odd, fine)
    h, t = section.height, section.thickness
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        (folder / "x.geo").write_text(text)
        gmsh.initialize(["", "-v", "0"])
        gmsh.open(str(folder / "x.geo"))
        gmsh.model.occ.synchronize()
        tags = {1: [], 2: [], 3: []}
        for _, surface in gmsh.model.getEntities(2):
            x, y, _ = gmsh.model.occ.getCenterOfMass(2, surface)
            mass = gmsh.model.occ.getMass(2, surface)
            tags[2 if y < h else 1 if mass > far * far / 2 else 3].append(surface)
        for tag, surfaces in tags.items():
            if surfaces:
                gmsh.model.addPhysicalGroup(2, surfaces, tag)
        curves = {10: [], 11: [], 12: []}
        lowest_x, highest_x = corners[0][0], corners[1][0]
        for _, curve in gmsh.model.getEntities(1):
            x0, y0, _, x1, y1, _ = gmsh.model.occ.getBoundingBox(1, curve)
            near = 1e-5
            if y1 < near:
                curves[10].append(curve)
            elif x1 < near and section.gap:
                curves[12].append(curve)
            elif x0 > lowest_x - near and x1 < highest_x + near and y0 > h - near and y1 < h + t + near and (y1 > y0 + near or abs(y0 - h) < 1e-3 or abs(y1 - h - t) < 1e-3):
                if not (x1 < near):  # the axis of symmetry of one trace
                    curves[11].append(curve)
        for tag, members in curves.items():
            if members:
                gmsh.model.addPhysicalGroup(1, members, tag)
        field = gmsh.model.mesh.field
        field.add("Distance", 1)
        field.setNumbers(1, "CurvesList", curves[11])
        field.setNumber(1, "NumPointsPerCurve", 400)
        field.add("MathEval", 2)
        field.setString(2, "F", f"{fine} + 0.12 * F1")
        field.setAsBackgroundMesh(2)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(folder / "x.msh"))
        gmsh.finalize()
        mirror = "{ Region Mirror; Value 0; }" if odd else ""
        (folder / "x.pro").write_text(DECK.format(laminate=1 if air else section.eps_r, mask=1 if air else section.eps_mask, mirror=mirror))
        subprocess.run(["getdp", "x.pro", "-msh", "x.msh", "-solve", "R", "-pos", "W", "-v", "0"], cwd=folder, check=True, capture_output=True)
        found = float(re.findall(r"[-+.\deE]+", (folder / "w.txt").read_text())[-1])
    return found if section.gap else 2 * found


def line(section, odd=False, fine=0.002):
    """(impedance of one line in ohms, effective permittivity) of one trace, or of one trace of a pair in its odd or even mode."""
    filled, empty = energy(section, odd, False, fine), energy(section, odd, True, fine)
    return 1 / (LIGHT * EPS_0 * math.sqrt(filled * empty)), filled / empty


if __name__ == "__main__":
    for fine in (0.008, 0.004, 0.002):
        print(fine, "single", line(Section(), fine=fine), "odd", line(Section(gap=0.15), True, fine), "even", line(Section(gap=0.15), False, fine))
