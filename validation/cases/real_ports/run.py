#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Five real boards with ports, for five solvers, with the default study of `pcbmesh init`, and docs/evidence/ports.md.

usage: run.py [--write]
"""
import argparse
import cmath
import math
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tests/decks"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "solvers"))
import ports_boards_slow_test as boards  # noqa: E402
from program import ROOT  # noqa: E402

TEXT = """# Ports on real boards, and on a coaxial line

Made by `validation/cases/real_ports/run.py --write`. Each row is what a user does: `pcbmesh init BOARD --nets NETS --margin 0.5mm --for SOLVER`,
`pcbmesh mesh BOARD --study ...` with no edit of the study in between, `pcbmesh check MESH --profile SOLVER`. Every check passes with no error, every
line has ports at both ends, and every port fills its rectangle. Gmsh finds exactly the groups that `tags.json` promises, each with its name, number of
elements and area or volume: in the mesh as it is up to 25 million cells, else in a coarser one of the same study (`--policy none`), which has the
same groups. The meshes of dolfinx (VTKHDF) and MFEM are counted by h5py and by their text, and Gmsh reads what `pcbmesh convert` makes of them.
For dolfinx, which has no edge elements on prisms, `init` asks for the tetrahedral twin. `tests/decks/ports_boards_slow_test.py` repeats it, the two
large regions coarsely.

"""


def coaxial_lines():
    """A coaxial line between two coaxial ports, solved by GetDP, beside the formula of a line."""
    import cases
    import solve
    if not solve.has_getdp():
        return ["GetDP is not installed: not run."]
    lines = ["A barrel of radius 0.3 mm in a round board of radius 1 mm with an electric wall about it, eps_r 4, 10 mm long, 3 GHz, a coaxial port in the antipad at",
             "either end (`cases.coaxial_line`), solved by GetDP on prisms. Reference: a line of eta / (2 pi) ln(b / a) ohm.", "",
             "| longest edge | ports | prisms | S21 | line | error | S11 | line | error |", "|---|---|---|---|---|---|---|---|---|"]
    show = lambda z: f"{z.real:+.4f} {z.imag:+.4f} i"  # noqa: E731
    for factor in (1.0, 2.0):
        for edge in (0.4, 0.2, 0.1):
            with tempfile.TemporaryDirectory() as scratch:
                solved, s, wanted = cases.coaxial_line(pathlib.Path(scratch), edge, ohm_factor=factor)
            lines.append(f"| {edge} mm | {'matched' if factor == 1 else 'of twice its impedance'} | {solved.prisms:,} | {show(s[1][0])} | {show(complex(wanted[1]))} | {abs(s[1][0] - wanted[1]):.4f} "
                         f"| {show(s[0][0])} | {show(complex(wanted[0]))} | {abs(s[0][0] - wanted[0]):.4f} |")
    return lines


def elements_along_a_port():
    """A line between two upright ports over one, two and four elements of dielectric, the triangles the same, solved by GetDP."""
    import cases
    import solve
    if not solve.has_getdp():
        return ["GetDP is not installed: not run."]

    def line(folder, layers, length, width=1.1, height=0.508, half=1.0):
        made = cases.board("line", [("top", 0.035), ("core", height, 3.66, 0.0), ("bottom", 0.035)], cases.rect(-2, -half - 2, length + 2, half + 2), ["LINE", "GND"],
                           tracks=[{"layer": "top", "net": "LINE", "width": width, "points": [[0, 0], [length, 0]]}], planes=[{"layer": "bottom", "net": "GND"}])
        ports = [{"name": name, "net": "LINE", "reference": "GND", "at": {"point": [x, 0]}, "impedance": 50, "max_edge": height} for name, x in (("p1", width / 2), ("p2", length - width / 2))]
        study = cases.study("driven", 0.6, ports=ports, sweep=[2e9], region=[-1, -half, length + 1, half], air=(0.8, 0), seed="delaunay", conductors={"mode": "sheet", "surface": "pec"},
                            mesh={"edge_at_copper": 0.5, "growth": 0.5, "elements_per_dielectric": layers})
        solved = solve.solve(made, study, folder)
        return solved, solved.touchstone()[0][1]

    lines = ["A line 1.1 mm wide over 0.508 mm of eps_r 3.66 between two upright ports of 50 ohm, 2 GHz, ideal sheets, the same triangles, `max_edge` of the ports as long as they are",
             "high: the dielectric has the elements named here, under the whole line. Errors against eight.", "",
             "| length | elements | prisms | error of S11 | error of S21 | phase of S21 off by |", "|---|---|---|---|---|---|"]
    for length in (4.0, 8.0):
        s = {}
        for layers in (8, 4, 2, 1):
            with tempfile.TemporaryDirectory() as scratch:
                s[layers] = line(pathlib.Path(scratch), layers, length)
        for layers in (1, 2, 4):
            solved, found = s[layers]
            wanted = s[8][1]
            lines.append(f"| {length} mm | {layers} | {solved.prisms:,} | {abs(found[0][0] - wanted[0][0]):.4f} | {abs(found[1][0] - wanted[1][0]):.4f} | {math.degrees(cmath.phase(found[1][0] / wanted[1][0])):+.2f} degrees |")
    lines += ["", "Two elements err less than a third as much as one. Only part of the error in phase grows with the length of the line: the run does not tell what the line, its ends and",
              "the port contribute. Two are the rule because a port stands where a line does; they go through the whole layer, and `max_edge` of the port takes their place where a study wants one."]
    return lines


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true", help="write docs/evidence/ports.md")
    options = parser.parse_args()
    boards.MOST_CELLS = 25_000_000  # about 10 GB in Gmsh
    boards.gmsh.initialize()
    boards.gmsh.option.setNumber("General.Terminal", 0)
    lines = ["| region | nets | solver | ports | cells | elements along, across | worst ratio of edges on a port | groups | CPU s |", "|---|---|---|---|---|---|---|---|---|"]
    for case in boards.BOARDS:
        for solver in boards.SOLVERS:
            with tempfile.TemporaryDirectory() as scratch:
                row = boards.look_at(*case, solver, pathlib.Path(scratch))
            least = min((p["elements_along"], p["elements_across"]) for p in row["quality"])
            worst = max(p["worst_aspect"] for p in row["quality"])
            name = f"{row['kind']}, {row['board'].split('_v')[0]}"
            lines.append(f"| {name} | {row['nets']} | {solver} | {len(row['ports'])} | {row['cells']:,} | {least[0]}, {least[1]} | {worst:.1f} | {row['groups']} | {row['cpu_s']:.1f} |")
            print(lines[-1], flush=True)
    boards.gmsh.finalize()
    for fault in boards.faults:
        print("FAULT:", fault)
    coaxial = coaxial_lines()
    along = elements_along_a_port()
    print("\n".join(coaxial + along))
    if options.write and not boards.faults:
        text = TEXT + "\n".join(lines) + "\n\nCPU seconds of `init`, `mesh` (with its own check) and `check` together.\n\n## Coaxial ports\n\n" + "\n".join(coaxial) + "\n\n## Elements along a port\n\n" + "\n".join(along) + "\n"
        (ROOT / "docs/evidence/ports.md").write_text(text)
    return 1 if boards.faults else 0


if __name__ == "__main__":
    sys.exit(main())
