#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""One fault of every kind in one study of a real board: one run names them all, each with its object, its place and a way out."""
import json
import pathlib
import sys
import tempfile

from program import DATA, require_data, run

require_data()
BOARD = DATA / "kicad/04_antmicro_si_test_4L_v6.kicad_pcb"
P, N = "/DIFF_P", "/DIFF_N"

# The pair runs along y = -110.8325 and -111.1675 over a plane; the board below has a hole milled through both at x = 115.
FINE = {"name": "fine", "net": P, "at": {"point": [105, -110.8325]}}
PORTS = (
    # port, then words that the run must say of it
    (FINE, None),
    ({"name": "off_hull", "net": P, "kind": "wave", "at": {"point": [120, -110.8325]}}, ("/ports/1/at", "must be on the hull", "side")),
    ({"name": "one_terminal", "net": P, "reference": P, "at": {"point": [121, -110.8325]}}, ("/ports/2/reference", "both terminals on net '/DIFF_P'", "name")),
    ({"name": "again", "net": P, "at": {"point": [105, -110.84]}}, ("port 'again' would share faces with port 'fine' near (105, -110.83", "make them narrower or move one")),
    ({"name": "milled_away", "net": P, "at": {"point": [115, -110.8325]}}, ("at (115, -110.832) mm touches net '/DIFF_P' along 0 um of its 185 um long edge", "the board is cut out or ends", "move it or make it narrower")),
    ({"name": "not_cut", "net": P, "at": {"side": "ymax"}}, ("net '/DIFF_P' is not cut at ymax (y = -90 mm)", "take a side that cuts the net")),
    ({"name": "over_copper", "net": P, "kind": "wave", "at": {"side": "xmax"}, "width": "0.7mm"}, ("its edge at (125, -111.18", "mm cuts the copper of net '/DIFF_N' on F.Cu", "choose its width so that it goes round")),
    ({"name": "too_wide", "net": P, "at": {"point": [110, -110.8325]}, "width": "0.5mm"}, ("500 um wide at (110, -110.832) mm, leaves the copper of net '/DIFF_P' on F.Cu", "make it narrower or move it")),
    ({"name": "outside", "net": P, "at": {"point": [130, -110.8325]}}, ("(130, -110.832) mm lies outside the domain, (95, -118) mm to (125, -90) mm", "move the port or grow the region")),
    ({"name": "no_rectangle", "net": "Net-(J10-Pad1)", "shape": "gap", "at": {"point": [110.4, -98.485]}}, ("at (110.4, -98.485) mm on F.Cu", "no gap with two straight edges", "give a point opposite the reference")),
    ({"name": "no_reference", "net": N, "reference": "Net-(J10-Pad1)", "at": {"point": [110, -111.1675]}}, ("at (110, -111.16", "no reference was found, net 'Net-(J10-Pad1)' that covers it", "copper of net 'GND' on In1.Cu below it is in between", "Move the port")),
    ({"name": "no_via", "net": P, "shape": "coaxial", "at": {"point": [112, -110.8325]}}, ("net '/DIFF_P' has no plated hole at (112, -110.832) mm", "give a point on one of its vias")),
    ({"name": "no_pin", "net": P, "at": {"pin": "J99.1"}}, ("the board has no pin 'J99.1'", "pins of the net are J")),
    ({"name": "no_net", "net": "/DIFF_Q", "at": {"pin": "J11.1"}}, ("port 'no_net': the board has no net called '/DIFF_Q' (did you mean '/DIFF_N', '/DIFF_P'?)", "lists its")),
    ({"name": "no_ohms", "net": N, "impedance": -50, "at": {"point": [106, -111.1675]}}, ("/ports/14/impedance", "-50")),
)
REST = (
    ("/sweep/to", "the end must lie above"), ("/sweep/points", ""), ("/mesh/frequency", "10 THz"), ("/mesh/longest_edge", "out of range"),
    ("layer 'dielectric 1' has no permittivity", "\"take\""),
)


def milled(folder):
    """The board with a hole milled through the pair, and a laminate that nobody knows."""
    text = BOARD.read_text()
    layer = '(layer "dielectric 1" (type "core") (thickness 0.12) (material "FR4") (epsilon_r 4.18) (loss_tangent 0.02))'
    assert layer in text
    text = text.replace(layer, '(layer "dielectric 1" (type "core") (thickness 0.12) (material "Unobtainium 9000"))')
    end = text.rstrip().rfind(")")
    board = folder / "milled.kicad_pcb"
    board.write_text(text[:end] + '(gr_circle (center 115 111) (end 115.6 111) (layer "Edge.Cuts") (width 0.1))\n)\n')
    return board


def main():
    faults = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        study = folder / "wrong.study.json"
        study.write_text(json.dumps({
            "schema_version": 1, "region": {"kind": "box", "box": {"min": [95, -118], "max": [125, -90]}}, "conductors": {"mode": "hollow"},
            "solver": "palace", "ports": [port for port, _ in PORTS], "sweep": {"from": 2e9, "to": 1e9, "points": 0},
            "mesh": {"frequency": 1e15, "longest_edge": "-1mm"}}, indent=1))
        done = run("mesh", milled(folder), "--study", study, "-o", folder / "wrong.msh")
        said = done.stderr.splitlines()
        if done.returncode != 2 or list(folder.glob("wrong.*")) != [study]:
            faults.append(f"exit {done.returncode}, files {sorted(f.name for f in folder.iterdir())}")
        for number, (port, words) in enumerate(PORTS):
            name = port["name"]
            mine = [line for line in said if f"port '{name}'" in line or any(w in line for w in (words or ())[:1])]
            if words is None:
                if any(f"/ports/{number}:" in line for line in said):
                    faults.append(f"{name} is right, but: {mine}")
            elif not any(all(word in line for word in words) for line in mine):
                faults.append(f"{name}: {words} are not in {mine}")
        for pointer, word in REST:
            if not any(pointer in line and word in line for line in said):
                faults.append(f"{pointer}: not told")
        if faults:
            print(done.stderr)
        # The port that is right, alone on the same board, is meshed.
        study.write_text(json.dumps({"schema_version": 1, "region": {"kind": "box", "box": {"min": [104, -112], "max": [106, -110]}}, "conductors": {"mode": "hollow"}, "mesh": {"height_policy": "none"}, "ports": [FINE]}))
        done = run("mesh", milled(folder), "--study", study, "-o", folder / "right.msh")
        if done.returncode != 0:
            faults.append(f"right: {done.stderr}")
    for fault in faults:
        print("FAULT:", fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
