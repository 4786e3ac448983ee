#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Forecasts of real regions beside what came, and docs/evidence/forecast.md.

usage: run.py [--write]
"""
import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "tests/decks"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "boards"))
from program import DATA, ROOT, require_data, run_json  # noqa: E402
from run import region_nets  # noqa: E402

REGIONS = ["04_antmicro_si_test_4L_v6.kicad_pcb", "05_stickhub_2L_v9.kicad_pcb.xz", "06_thunderscope_pcie_interposer_4L_v9.kicad_pcb.xz",
           "07_antmicro_myra_sip_4L_v7.kicad_pcb.xz", "08_pico_ice_4L_v8.kicad_pcb.xz", "09_glasgow_4L_v9.kicad_pcb.xz",
           "10_vespa_pcie_4L_v5.99.kicad_pcb.xz", "11_hackrf_one_rf_4L_v6.kicad_pcb.xz", "13_antmicro_ddr5_testbed_6L_v6.kicad_pcb.xz",
           "16_tinytapeout_4L_v9.kicad_pcb.xz"]
ALLOWED = 0.15
COLUMNS = [("triangles", lambda f: f["triangles"]), ("prisms", lambda f: f["prisms"]),
           ("order 1, prisms", lambda f: f["edge_elements_on_prisms"][0]["unknowns"]),
           ("order 2, prisms", lambda f: f["edge_elements_on_prisms"][1]["unknowns"]),
           ("order 3, prisms", lambda f: f["edge_elements_on_prisms"][2]["unknowns"]),
           ("order 1, tetrahedra", lambda f: f["edge_elements_on_tetrahedra"][0]["unknowns"]),
           ("nonzeros, order 1", lambda f: f["edge_elements_on_prisms"][0]["nonzeros"])]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true", help="write docs/evidence/forecast.md")
    options = parser.parse_args()
    require_data()
    head = "| region | " + " | ".join(f"{name}: forecast | exact | error" for name, _ in COLUMNS[:3]) + " | " + " | ".join(f"{name}: error" for name, _ in COLUMNS[3:]) + " |"
    lines = [head, "|---" * (1 + 9 + len(COLUMNS) - 3) + "|"]
    worst = 0
    print(head)
    for name in REGIONS:
        board = DATA / "kicad" / name
        nets = region_nets(board)
        report = run_json("mesh", board, "--dry-run", "--quiet", "--nets", ",".join(n.replace("\\", "\\\\").replace(",", "\\,") for n in nets), "--margin", "1mm")
        before, exact = report["forecast"], report["measured"]
        cells = [f"{name.split('_v')[0]}: {', '.join(nets)}"]
        for index, (_, value) in enumerate(COLUMNS):
            error = value(before) / value(exact) - 1
            worst = max(worst, abs(error))
            if index < 3:
                cells += [f"{value(before):,.0f}", f"{value(exact):,.0f}"]
            cells.append(f"{100 * error:+.1f} %")
        lines.append("| " + " | ".join(cells) + " |")
        print(lines[-1], flush=True)
    last = f"Worst error: {100 * worst:.1f} %, allowed {100 * ALLOWED:.0f} %."
    print(last)
    if options.write:
        text = ("# Forecast beside what came\n\nMade by `validation/cases/forecast/run.py --write`: regions round the shortest routed pair (or net) of ten boards, default study.\n"
                "The forecast is made after the outlines are triangulated and before the height policy's second triangulation, sub-layers and prisms;\n"
                "the exact counts are those of the mesh (`pcbmesh mesh --dry-run --forecast` prints both). Counting formulas and their sources:\n"
                "`include/pcbmesh/mesh/unknowns.hpp`; a unit test holds them to meshes spelt out entity by entity.\n\n")
        (ROOT / "docs/evidence/forecast.md").write_text(text + "\n".join(lines) + "\n\n" + last + "\n")
    return 0 if worst <= ALLOWED else 1


if __name__ == "__main__":
    sys.exit(main())
