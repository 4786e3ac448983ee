# SPDX-License-Identifier: GPL-3.0-or-later
"""The cases: board and study of each, and what comes of them beside the closed formula. Lengths of boards in millimetres.
`run` goes to solve(): the solver (GetDP if none is named), arguments, environment."""
import cmath
import math

import exact
from solve import MM, board, rect, solve

ALL_NONE = {"all": "none"}


def study(problem, longest_edge, *, ports=(), sweep=(), boundaries=None, air=(0, 0), conductors=None, region=None, seed="hex", **more):
    """A study with every default that matters to a comparison spelt out."""
    out = {"schema_version": 1, "problem": problem, "conductors": conductors or {"mode": "solid", "surface": "pec"},
           "air": {"above": air[0], "below": air[1], "around": 0}, "boundaries": boundaries or ALL_NONE,
           "mesh": {"longest_edge": longest_edge, "seed": seed, "height_policy": "average", "sublayers": "round", **more.pop("mesh", {})}, **more}
    if seed != "hex":
        out["mesh"].pop("seed")
    if ports:
        out["ports"] = list(ports)
    if sweep:
        out["sweep"] = {"list": list(sweep)}
    if region:
        out["region"] = {"kind": "box", "box": {"min": region[:2], "max": region[2:]}}
    return out


def port(name, net, side, ohm, reference="GND", **more):
    return {"name": name, "net": net, "reference": reference, "at": {"side": side}, "impedance": ohm, **more}


# ---- cavity -------------------------------------------------------------------------------------------------------

def cavity(folder, edge_mm, size=(100, 90, 70), mode="solid", **run):
    """A box of vacuum between two solid planes, electric walls around."""
    made = board("cavity", [("top", 1.0), ("space", size[2], 1.0, 0.0), ("bottom", 1.0)], rect(0, 0, size[0], size[1]), ["LID", "GND"],
                 planes=[{"layer": "top", "net": "LID"}, {"layer": "bottom", "net": "GND"}])
    wanted = exact.cavity_hz([MM * s for s in size])
    solved = solve(made, study("eigenmode", edge_mm, boundaries={"all": "pec"}, conductors={"mode": mode, "surface": "pec"}, modes={"number": 4, "above": 0.95 * wanted[0]}), folder, **run)
    found = solved.resonances_hz()
    return solved, [(f, w) for f, w in zip(found, wanted)][:3]


def box_cavity(folder, n, size=(100, 90, 70), **run):
    """The same box of n x n x n bricks, each cut into two prisms, diagonals turning from brick to brick; the first k0^2, lengths in units of the
    longest side. The bricks are drawn as triangles of copper in two nets, which alternate so that no edge between them is lost."""
    def corner(i, j):
        return [size[0] * i / n, size[1] * j / n]

    triangles = {"A": [], "B": []}
    for i in range(n):
        for j in range(n):
            square = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
            halves = ((0, 1, 2), (0, 2, 3)) if (i + j) % 2 == 0 else ((0, 1, 3), (1, 2, 3))
            for half, net in zip(halves, "AB" if i % 2 == 0 else "BA"):
                triangles[net].append([square[corner] for corner in half])
    made = board("box", [("top", 1.0), ("space", size[2], 1.0, 0.0), ("bottom", 1.0)], rect(0, 0, size[0], size[1]), ["A", "B", "GND"],
                 polygons=[{"layer": "top", "net": net, "points": points} for net, each in triangles.items() for points in each],
                 planes=[{"layer": "bottom", "net": "GND"}])
    solved = solve(made, study("eigenmode", size[0], boundaries={"all": "pec"}, modes={"number": 3, "above": 0.95 * exact.cavity_hz([MM * s for s in size])[0]}, seed="delaunay",
                               conductors={"mode": "sheet", "surface": "pec"},
                               mesh={"height_policy": "none", "sublayers": "none", "elements_per_dielectric": n, "min_angle_deg": 1}), folder, **run)
    return solved, (2 * math.pi * solved.resonances_hz()[0] * MM * size[0] / exact.LIGHT) ** 2


# ---- lines --------------------------------------------------------------------------------------------------------

def tem_line(folder, edge_mm, hz=3e9, tan_delta=0.0, ohm_factor=1.0, boundaries=None, eps_r=4.0, mode="solid", **run):
    """Parallel plates 20 mm wide with magnetic side walls, 10 mm apart, 100 mm long: TEM, known to every digit."""
    ohm = exact.ETA0 / math.sqrt(eps_r) / 2
    made = board("line", [("top", 1.0), ("core", 10.0, eps_r, tan_delta), ("bottom", 1.0)], rect(-10, -10, 110, 30), ["A", "GND"],
                 planes=[{"layer": "top", "net": "A"}, {"layer": "bottom", "net": "GND"}])
    ports = [port("p1", "A", "xmin", ohm * ohm_factor), port("p2", "A", "xmax", ohm * ohm_factor)]
    solved = solve(made, study("driven", edge_mm, ports=ports, sweep=[hz], region=[0, 0, 100, 20], boundaries=boundaries, conductors={"mode": mode, "surface": "pec"},
                               mesh={"height_policy": "none", "sublayers": "none"}), folder, **run)
    s = solved.touchstone()[0][1]
    k = 2 * math.pi * hz / exact.LIGHT * cmath.sqrt(eps_r * (1 - 1j * tan_delta))
    wanted = exact.line_s(ohm / cmath.sqrt(1 - 1j * tan_delta), 1j * k, 0.1, ohm * ohm_factor)
    return solved, s, wanted


def microstrip(folder, edge_mm, edge_at_copper_mm, hz=(2e9,), tan_delta=0.0, length=10.0, mode="sheet", width=1.1, height=0.508, eps_r=3.66, air=3.0, half=4.0, **mesh):
    """A 50 ohm line of length 10 mm: two lumped ports at its ends, walls far away."""
    made = board("microstrip", [("top", 0.035), ("core", height, eps_r, tan_delta), ("bottom", 0.035)], rect(-2, -half - 2, length + 2, half + 2), ["LINE", "GND"],
                 tracks=[{"layer": "top", "net": "LINE", "width": width, "points": [[-1, 0], [length + 1, 0]]}], planes=[{"layer": "bottom", "net": "GND"}])
    ports = [port("p1", "LINE", "xmin", 50), port("p2", "LINE", "xmax", 50)]
    solved = solve(made, study("driven", edge_mm, ports=ports, sweep=hz, region=[0, -half, length, half], air=(air, 0), seed="delaunay",
                               conductors={"mode": mode, "surface": "pec"}, mesh={"edge_at_copper": edge_at_copper_mm, "growth": 0.5, **mesh}), folder)
    return solved, solved.touchstone()


def stripline(folder, edge_mm, edge_at_copper_mm, hz=(2e9,), tan_delta=0.0, length=10.0, width=0.5, height=1.0, eps_r=4.0, half=2.5, **mesh):
    """A thin strip midway between planes."""
    made = board("stripline", [("top", 0.035), ("upper", height / 2, eps_r, tan_delta), ("mid", 0.035), ("lower", height / 2, eps_r, tan_delta), ("bottom", 0.035)],
                 rect(-2, -half - 2, length + 2, half + 2), ["LINE", "GND"],
                 tracks=[{"layer": "mid", "net": "LINE", "width": width, "points": [[-1, 0], [length + 1, 0]]}],
                 planes=[{"layer": "top", "net": "GND"}, {"layer": "bottom", "net": "GND"}])
    ports = [port("p1", "LINE", "xmin", 50), port("p2", "LINE", "xmax", 50)]
    solved = solve(made, study("driven", edge_mm, ports=ports, sweep=hz, region=[0, -half, length, half], seed="delaunay",
                               conductors={"mode": "sheet", "surface": "pec"}, mesh={"edge_at_copper": edge_at_copper_mm, "growth": 0.5, **mesh}), folder)
    return solved, solved.touchstone()


def two_lengths(line, folder, short, long, *arguments, **more):
    """Propagation constant by frequency from two lines that differ in length alone: their ports and ends cancel."""
    first, s_short = line(folder, *arguments, length=short, **more)
    second, s_long = line(folder, *arguments, length=long, **more)
    out = []
    for (hz, a), (_, b) in zip(s_short, s_long):
        out.append((hz, exact.gamma_of_two(a, b, MM * (long - short))))
    return second, out


def stripline_slice(folder, edge_mm, at_copper_mm, width=0.5, height=1.0, eps_r=4.0, half=2.0, slice_mm=0.02, **mesh):
    """Impedance of the same strip from the capacitance of a thin slice: in one dielectric the delay is known."""
    solved, found, _ = coupled_lines(folder, edge_mm, at_copper_mm, strips=((0.0, width),), height=height, eps_r=eps_r, half=half, slice_mm=slice_mm, **mesh)
    return solved, math.sqrt(eps_r) / (exact.LIGHT * found[0][0]), exact.stripline_ohm(MM * width, MM * height, eps_r)


def microstrip_slice(folder, edge_mm, at_copper_mm, eps_r=3.66, width=1.1, height=0.508, half=4.0, air=4.0, slice_mm=0.02):
    """(impedance, effective permittivity) from two slices, with and without the dielectric."""
    farads = []
    for e in (eps_r, 1.0):
        made = board("slice", [("top", 0.02), ("core", height, e, 0.0), ("bottom", 0.02)], rect(-1, -half - 1, slice_mm + 1, half + 1), ["LINE", "GND"],
                     tracks=[{"layer": "top", "net": "LINE", "width": width, "points": [[-0.5, 0], [slice_mm + 0.5, 0]]}], planes=[{"layer": "bottom", "net": "GND"}])
        solved = solve(made, study("electrostatic", edge_mm, region=[0, -half, slice_mm, half], air=(air, 0), seed="delaunay",
                                   conductors={"mode": "sheet", "surface": "pec"}, mesh={"edge_at_copper": at_copper_mm, "growth": 0.4}), folder)
        farads.append(solved.capacitance()["LINE", "LINE"] / (MM * slice_mm))
    return solved, 1 / (exact.LIGHT * math.sqrt(farads[0] * farads[1])), farads[0] / farads[1]


def strip(folder, surface="pec", mode="sheet", kind="lumped", boundaries=None, hz=2e9, tan_delta=(0.02, 0.01), width=None, **run):
    """A strip between planes and two dielectrics, 10 mm long: one wall an impedance, the other a plane of symmetry, unless said."""
    made = board("strip", [("top", 0.035), ("upper", 1.0, 4.0, tan_delta[0]), ("mid", 0.035), ("lower", 1.0, 2.0, tan_delta[1]), ("bottom", 0.035)], rect(-2, -5, 12, 5), ["LINE", "GND"],
                 tracks=[{"layer": "mid", "net": "LINE", "width": 1.0, "points": [[-1, 0], [11, 0]]}], planes=[{"layer": "top", "net": "GND"}, {"layer": "bottom", "net": "GND"}])
    ports = [port(name, "LINE", side, 50, kind=kind, width=width) for name, side in (("p1", "xmin"), ("p2", "xmax"))]
    walls = boundaries or {"all": "none", "ymin": {"kind": "impedance", "ohms": 200}, "ymax": "pmc"}
    solved = solve(made, study("driven", 1.2, ports=ports, sweep=[hz], region=[0, -3, 10, 3], boundaries=walls, seed="delaunay", conductors={"mode": mode, "surface": surface},
                               mesh={"edge_at_copper": 0.4, "height_policy": "none", "sublayers": "none"}), folder, **run)
    return solved, solved.touchstone()


# ---- capacitances -------------------------------------------------------------------------------------------------

def plates(folder, edge_mm=2.0, mode="solid", **run):
    """Two planes and two dielectrics: exact to rounding."""
    made = board("plates", [("top", 0.035), ("upper", 0.3, 4.4, 0.02), ("lower", 0.2, 3.0, 0.02), ("bottom", 0.035)], rect(0, 0, 10, 5), ["A", "GND"],
                 planes=[{"layer": "top", "net": "A"}, {"layer": "bottom", "net": "GND"}])
    solved = solve(made, study("electrostatic", edge_mm, conductors={"mode": mode}), folder, **run)
    return solved, solved.capacitance()["A", "GND"], -exact.EPS0 * 50e-6 / (0.3e-3 / 4.4 + 0.2e-3 / 3.0)


def coaxial_via(folder, edge_mm=0.3, at_copper_mm=0.05, drill=0.4, outer=2.0, height=1.0, **run):
    """The barrel of a via in a round board whose rim is grounded."""
    made = board("coaxial", [("top", 0.05), ("core", height, 4.0, 0.0), ("bottom", 0.05)], {"circle": {"at": [0, 0], "diameter": outer}}, ["SIG"],
                 vias=[{"at": [0, 0], "drill": drill, "net": "SIG"}])
    solved = solve(made, study("electrostatic", edge_mm, seed="delaunay", conductors={"mode": "hollow"}, boundaries={"all": "none", "xmin": "pec", "xmax": "pec", "ymin": "pec", "ymax": "pec", "side": "pec"},
                               mesh={"edge_at_copper": at_copper_mm, "growth": 0.5, "tolerance": "1um"}, arcs={"sagitta": "1um"}), folder, **run)
    # The gaps of the outer copper layers are air.
    per_eps = exact.coaxial_farad_per_m(drill / 2, outer / 2, 1.0) * MM
    return solved, solved.capacitance()["SIG", "SIG"], per_eps * (4.0 * height + 0.1)


def coaxial_line(folder, edge_mm=0.4, hz=3e9, height=10.0, drill=0.6, outer=2.0, eps_r=4.0, ohm_factor=1.0, copper=0.01, **run):
    """A barrel in a round board with an electric wall about it: a coaxial line, a coaxial port in the antipad at each end."""
    ohm = exact.ETA0 / math.sqrt(eps_r) * math.log(outer / drill) / (2 * math.pi)
    antipad = 0.99 * outer
    made = board("coaxial_line", [("top", copper), ("core", height, eps_r, 0.0), ("bottom", copper)], {"circle": {"at": [0, 0], "diameter": outer}}, ["SIG", "GND"],
                 vias=[{"at": [0, 0], "drill": drill, "net": "SIG", "antipad": antipad}], planes=[{"layer": "top", "net": "GND"}, {"layer": "bottom", "net": "GND"}])
    ports = [{"name": name, "net": "SIG", "at": {"point": [0, 0], "layer": layer}, "shape": "coaxial", "impedance": ohm * ohm_factor} for name, layer in (("p1", "top"), ("p2", "bottom"))]
    sides = {"all": "none", **{side: "pec" for side in ("xmin", "xmax", "ymin", "ymax", "side")}}
    solved = solve(made, study("driven", edge_mm, ports=ports, sweep=[hz], boundaries=sides, seed="delaunay", conductors={"mode": "hollow", "surface": "pec"},
                               mesh={"height_policy": "none", "sublayers": "none", "elements_per_wavelength": 25, "tolerance": "1um"}, arcs={"sagitta": "5um"}), folder, **run)
    s = solved.touchstone()[0][1]
    k = 2 * math.pi * hz / exact.LIGHT * math.sqrt(eps_r)
    return solved, s, exact.line_s(ohm, 1j * k, MM * height, ohm * ohm_factor)


def coupled_lines(folder, edge_mm, at_copper_mm, strips=((-0.7, 0.3), (0.0, 0.3), (0.7, 0.3)), height=1.0, eps_r=4.0, half=2.0, slice_mm=0.02, ply_mm=0, run=None, **mesh):
    """Thin strips (middle, width) midway between planes, a slice of their length: the capacitance matrix per metre. `ply_mm`: the dielectric is drawn with
    plies of this thickness beside the strips, from which heights can grow."""
    nets = [f"L{i}" for i in range(len(strips))]
    near = [("near_upper", ply_mm, eps_r, 0.0), ("mid", 0.02), ("near_lower", ply_mm, eps_r, 0.0)] if ply_mm else [("mid", 0.02)]
    made = board("coupled", [("top", 0.02), ("upper", height / 2 - ply_mm, eps_r, 0.0), *near, ("lower", height / 2 - ply_mm, eps_r, 0.0), ("bottom", 0.02)],
                 rect(-1, -half - 1, slice_mm + 1, half + 1), nets + ["GND"],
                 tracks=[{"layer": "mid", "net": net, "width": w, "points": [[-0.5, y], [slice_mm + 0.5, y]]} for net, (y, w) in zip(nets, strips)],
                 planes=[{"layer": "top", "net": "GND"}, {"layer": "bottom", "net": "GND"}])
    solved = solve(made, study("electrostatic", edge_mm, region=[0, -half, slice_mm, half], seed="delaunay", conductors={"mode": "sheet", "surface": "pec"},
                               mesh={"edge_at_copper": at_copper_mm, **{"growth": 0.4, **mesh}}), folder, **(run or {}))
    found = solved.capacitance()
    wanted = exact.strips_between_planes([(MM * (y - w / 2), MM * (y + w / 2)) for y, w in strips], MM * height, eps_r)
    return solved, [[found[a, b] / (MM * slice_mm) for b in nets] for a in nets], wanted


# ---- via ----------------------------------------------------------------------------------------------------------

def via_transition(folder, edge_mm=0.6, at_copper_mm=0.25, hz=(2e9, 6e9), tan_delta=0.02, ports_ohm=(50, 50), **run):
    """A trace above two planes, a via through their antipads, a trace below."""
    made = board("via", [("top", 0.035), ("upper", 0.25, 4.0, tan_delta), ("gnd1", 0.035), ("middle", 0.4, 4.0, tan_delta), ("gnd2", 0.035), ("lower", 0.25, 4.0, tan_delta), ("bottom", 0.035)],
                 rect(-4, -4, 4, 4), ["LINE", "GND"],
                 tracks=[{"layer": "top", "net": "LINE", "width": 0.5, "points": [[-3.5, 0], [0, 0]]}, {"layer": "bottom", "net": "LINE", "width": 0.5, "points": [[0, 0], [3.5, 0]]}],
                 vias=[{"at": [0, 0], "drill": 0.3, "pad": 0.6, "net": "LINE", "antipad": 1.0}]
                 + [{"at": [x, y], "drill": 0.3, "pad": 0.6, "net": "GND", "layers": ["gnd1", "gnd2"]} for x, y in ((0, 1.2), (0, -1.2))],
                 planes=[{"layer": "gnd1", "net": "GND"}, {"layer": "gnd2", "net": "GND"}])
    ports = [port("p1", "LINE", "xmin", ports_ohm[0]), port("p2", "LINE", "xmax", ports_ohm[1])]
    solved = solve(made, study("driven", edge_mm, ports=ports, sweep=hz, region=[-3, -2, 3, 2], air=(1, 1), seed="delaunay", boundaries={"all": "absorbing", "xmin": "none", "xmax": "none"},
                               conductors={"mode": "hollow", "surface": "lossy"}, mesh={"edge_at_copper": at_copper_mm, "growth": 0.6, "height_policy": "none", "sublayers": "none"}), folder, **run)
    return solved, solved.touchstone()


# ---- wave ports ---------------------------------------------------------------------------------------------------

def guided(folder, kind, edge_mm, at_copper_mm, hz=(2e9,), length=10.0, eps_r=None, half=None, air=3.0, kinds=("wave", "wave"), ohm=50, boundaries=None, tan_delta=0.0, mode="sheet", **mesh):
    """A strip or microstrip from side to side of the region; wave ports cover the whole of an end."""
    width, eps_r, half = {"stripline": (0.5, eps_r or 4.0, half or 1.5), "microstrip": (1.1, eps_r or 3.66, half or 3.0)}[kind]
    if kind == "stripline":
        layers, air, on = [("top", 0.035), ("upper", 0.5, eps_r, tan_delta), ("mid", 0.035), ("lower", 0.5, eps_r, tan_delta), ("bottom", 0.035)], 0, "mid"
    else:
        layers, on = [("top", 0.035), ("core", 0.508, eps_r, tan_delta), ("bottom", 0.035)], "top"
    made = board(kind, layers, rect(-2, -half - 2, length + 2, half + 2), ["LINE", "GND"],
                 tracks=[{"layer": on, "net": "LINE", "width": width, "points": [[-1, 0], [length + 1, 0]]}],
                 planes=[{"layer": layer, "net": "GND"} for layer in (("top", "bottom") if kind == "stripline" else ("bottom",))])
    ends = [port(name, "LINE", side, ohm, **({"kind": "wave", "width": 2 * half} if each == "wave" else {})) for name, side, each in zip(("p1", "p2"), ("xmin", "xmax"), kinds)]
    solved = solve(made, study("driven", edge_mm, ports=ends, sweep=hz, region=[0, -half, length, half], air=(air, 0), seed="delaunay", boundaries=boundaries,
                               conductors={"mode": mode, "surface": "pec"}, mesh={"edge_at_copper": at_copper_mm, "growth": 0.5, **mesh}), folder)
    return solved, solved.touchstone()
