# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs paper_measure and pcbmesh and gives back plain dictionaries; holds every window of acceptance in one place."""
import json
import os
import pathlib
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
PROGRAM = pathlib.Path(os.environ.get("PCBMESH_PROGRAM", ROOT / "build/bin/pcbmesh"))
MEASURE = PROGRAM.parent / "paper_measure"
PRINTED = json.loads((HERE / "printed.json").read_text())
EXAMPLES = ("serpentine", "via")
SEED, COUNT = 1, 20_000
MM2 = 1e-6


def _json_of(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def table1(seed=SEED):
    return _json_of([MEASURE, "table1", seed, COUNT])


def figure4(seed=4):
    return _json_of([MEASURE, "figure4", seed])


def cases(example):
    return _json_of([MEASURE, "cases", ROOT / f"examples/{example}.json", HERE / f"{example}.compat.json"])


def mesh_file(board, *flags):
    """Report of the product itself on the board alone, nothing written."""
    return _json_of([PROGRAM, "mesh", board, "--air", "0", "--tolerance", "0.1um", "--dry-run", "--json", "--quiet", *flags])


def gain_percent(rows, quality):
    """(best case, gain over case 1 in percent)."""
    best = max(rows, key=quality)
    return best["case"], 100 * (quality(best) / quality(rows[0]) - 1)


def compat_quality(row):
    return row["compat"]["mean_prism"]


def clean_quality(rule):
    return lambda row: row["clean"][rule]["mean_prism"]


class Windows:
    """Values and where they must lie; one line of the acceptance table each."""

    def __init__(self):
        self.rows = []

    def within(self, what, value, low, high):
        self.rows.append((what, value, low, high, low <= value <= high))

    def near(self, what, value, target, tolerance):
        self.within(what, value, target - tolerance, target + tolerance)

    def relative(self, what, value, target, fraction):
        self.near(what, value, target, fraction * target)

    def failures(self):
        return [row for row in self.rows if not row[4]]


def table1_windows(windows, one):
    windows.near("Table 1: avg, Eq. 3", one["optimal_height"]["avg"], 0.5277, 0.0064)
    windows.near("Table 1: avg, average edge", one["average_edge"]["avg"], 0.5083, 0.0062)
    windows.within("Table 1: max, Eq. 3", one["optimal_height"]["max"], 0, 1.0264005)
    windows.within("Table 1: max, average edge", one["average_edge"]["max"], 0, 1 - 1e-12)
    windows.near("Table 1: ratio of the averages, one sample", one["average_edge"]["avg"] / one["optimal_height"]["avg"], 0.96320, 0.0003)


INITIAL = {"serpentine": (382, 0.847, 0.005, (0.282843, 0.6594, 2.28)), "via": (326, 0.808, 0.006, (0.01965, 0.1963, 1.187))}
COMPAT = {"serpentine": ((0.361, 0.590, 0.522, 0.699, 0.555), 4, 90), "via": ((0.3745, 0.317, 0.3745, 0.683, 0.698), 5, 83)}
CLEAN = {"serpentine": (0.911, 298_672, 94.4), "via": (0.9215, 1_534_680, 87.5)}


def example_windows(windows, example, measured):
    rows = measured["cases"]
    count, quality, tolerance, (low, mean, high) = INITIAL[example]
    first = rows[0]
    windows.relative(f"{example}: triangles at 2 mm", first["triangles"], count, 0.01)
    windows.near(f"{example}: q_t at 2 mm", first["mean_triangle"], quality, tolerance)
    heights = {key: first["heights"][key] * 1e3 for key in ("min_m", "avg_m", "max_m")}
    if example == "serpentine":
        windows.near("serpentine: smallest h*, mm", heights["min_m"], low, 1e-6)
    else:
        windows.relative(f"{example}: smallest h*, mm", heights["min_m"], low, 0.01)
    windows.relative(f"{example}: mean h*, mm", heights["avg_m"], mean, 0.01)
    windows.relative(f"{example}: largest h*, mm", heights["max_m"], high, 0.02)
    targets, best_case, least_gain = COMPAT[example]
    for row, target in zip(rows, targets):
        windows.near(f"{example} compat: q_p of case {row['case']}", compat_quality(row), target, 0.006)
    best, gain = gain_percent(rows, compat_quality)
    windows.near(f"{example} compat: best case", best, best_case, 0)
    windows.within(f"{example} compat: gain of the best over case 1, %", gain, least_gain, 1000)
    quality, prisms, least_gain = CLEAN[example]
    best, gain = gain_percent(rows, clean_quality("round"))
    winner = rows[best - 1]["clean"]["round"]
    windows.near(f"{example} clean, round: best q_p", winner["mean_prism"], quality, 0.006)
    windows.relative(f"{example} clean, round: prisms of the best", winner["prisms"], prisms, 0.01)
    windows.within(f"{example} clean, round: gain over case 1, %", gain, least_gain, 1000)
    count_windows(windows, example, measured)


def count_windows(windows, example, measured):
    """Prisms are triangles times sub-layers, and volumes fill the board."""
    volume = measured["stack_m"] * measured["cases"][0]["area_m2"]
    wrong, worst = 0, 0.0
    for row in measured["cases"] + measured["product_cases"]:
        for rule in row["clean"].values():
            wrong += rule["prisms"] != row["triangles"] * rule["sublayers"]
            worst = max(worst, abs(rule["volume_m3"] / volume - 1))
        wrong += row["compat"]["prisms"] != row["triangles"] * row["compat"]["sublayers"]
    windows.near(f"{example}: meshes whose prisms are not triangles x sub-layers", wrong, 0, 0)
    windows.within(f"{example}: worst relative error of the volume", worst, 0, 1e-9)
    windows.near(f"{example}: smallest angle, all cases, deg", min(row["min_angle_deg"] for row in measured["cases"] + measured["product_cases"]), 25, 4.3 + 5e-3)
