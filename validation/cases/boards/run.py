#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes real boards, whole or round some nets, judges every mesh, and prints the table of docs/evidence/boards.md.

usage: run.py [--write] [--only TEXT] [--keep FOLDER]
"""
import argparse
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tests/decks"))
from program import DATA, ROOT, run_json, run_measured, require_data  # noqa: E402

WHOLE_BOARD_UP_TO = 11  # boards numbered 00 to 11 are meshed whole; of the others a region


def boards():
    return sorted(p for p in (DATA / "kicad").iterdir() if ".kicad_pcb" in p.name)


def region_nets(board):
    """The nets of a region: the shortest routed differential pair of the board, else its shortest routed net with two pads."""
    info = run_json("inspect", board, "--quiet")
    routed = {n["name"]: n for n in info["nets"] if n["name"] and n["tracks"] and n["pads"] >= 2}
    size = {name: n["tracks"] + n["vias"] for name, n in routed.items()}
    pairs = [(size[name] + size[other], name, other) for name in routed for plus, minus in (("P", "N"), ("+", "-"), ("p", "n"))
             if name.endswith(plus) for other in [name[:-1] + minus] if other in routed]
    if pairs:
        return list(min(pairs)[1:])
    return [min((count, name) for name, count in size.items())[1]]


def mesh(board, folder):
    """One row of the table."""
    number = int(board.name[:2])
    name = board.name.split(".kicad_pcb")[0]
    arguments = ["mesh", board, "-o", folder / f"{name}.msh", "--json", "--quiet"]
    kind = "whole"
    if number > WHOLE_BOARD_UP_TO:
        nets = region_nets(board)
        kind = "nets " + ", ".join(nets)
        arguments += ["--nets", ",".join(n.replace("\\", "\\\\").replace(",", "\\,") for n in nets), "--margin", "1mm"]
    code, out, err, cpu, peak = run_measured(*arguments)
    row = {"board": name, "kind": kind, "exit": code, "cpu_s": cpu, "peak_mib": peak, "error": err.strip().splitlines()[-1] if err.strip() else ""}
    if code in (0, 1):
        report = json.loads(out)
        row["report"] = report
        row["errors"] = sum(f["count"] for f in report["check"]["findings"] if f["severity"] == "error")
        row["findings"] = [f["code"] for f in report["check"]["findings"]]
    return row


HEAD = ("| board | what | CPU s | of it mesh | peak MiB | triangles | sub-layers | prisms | min angle | below 20.7 | tolerance um | snapped | worst area error | q_t | q_p | check |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|")


def line(row):
    if "report" not in row:
        return f"| {row['board']} | {row['kind']} | {row['cpu_s']:.1f} | | {row['peak_mib']:.0f} | | | | | | | | | | | exit {row['exit']}: {row['error'][:150]} |"
    r = row["report"]
    return (f"| {row['board']} | {row['kind']} | {row['cpu_s']:.1f} | {r['cpu_s']['total']:.1f} | {row['peak_mib']:.0f} | {r['counts']['triangles']:,} | {r['counts']['sublayers']} | "
            f"{r['counts']['prisms']:,} | {r['triangulation']['min_angle_deg']:.1f} | {r['triangulation']['triangles_below_bound']} | {r['overlay']['tolerance_um']:.3g} | "
            f"{r['overlay']['vertices_snapped']:,} | {100 * r['overlay']['worst_area_error']:.2g} % | {r['quality']['mean_triangle']:.3f} | {r['quality']['mean_prism']:.3f} | "
            + ("passed |" if row["errors"] == 0 else f"{row['errors']} errors: {', '.join(row['findings'])} |"))


def main(arguments=None):
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true", help="write docs/evidence/boards.md")
    parser.add_argument("--only", default="", help="boards whose name contains this")
    parser.add_argument("--keep", type=pathlib.Path, help="keep the meshes in this folder")
    parser.add_argument("--most", type=int, default=20, help="boards above this number are left out")
    options = parser.parse_args(arguments)
    require_data()
    rows = []
    print(HEAD, flush=True)
    for board in boards():
        if options.only not in board.name or int(board.name[:2]) > options.most:
            continue
        with tempfile.TemporaryDirectory() as scratch:
            folder = options.keep or pathlib.Path(scratch)
            folder.mkdir(parents=True, exist_ok=True)
            rows.append(mesh(board, folder))
        print(line(rows[-1]), flush=True)
    if options.write:
        text = ("# Real boards\n\nMade by `validation/cases/boards/run.py --write`: every board of the test data, meshed with the default study and judged by `pcbmesh check`.\n"
                "CPU seconds of the whole program (reading, meshing, writing binary MSH, reading back, judging) and of meshing alone, on two busy cores.\n\n")
        (ROOT / "docs/evidence").mkdir(parents=True, exist_ok=True)
        (ROOT / "docs/evidence/boards.md").write_text(text + HEAD + "\n" + "\n".join(map(line, rows)) + "\n")
    bad = [row for row in rows if row.get("errors", 1) != 0]
    print(f"{len(rows)} boards, {len(bad)} without a passed check")
    return 1 if bad or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
