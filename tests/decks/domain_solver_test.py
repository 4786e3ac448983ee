#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the edges of the domain do to a field, solved by GetDP: matched layers swallow a wave, periodic sides repeat it, symmetry halves it."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from program import PROGRAM, ROOT, SKIPPED, run

if not shutil.which("getdp"):
    print("skipped: getdp is not installed; scripts/setup installs it")
    sys.exit(SKIPPED)

LIGHT = 299_792_458.0
# Two wide plates 1 mm apart, eps_r 4: between magnetic walls they guide a plane wave.
PLATES = {
    "pcbmesh_board": 1, "units": "mm", "materials": [{"name": "core", "eps_r": 4}],
    "stackup": [{"name": "top", "kind": "copper", "thickness": "35um"}, {"name": "core", "kind": "dielectric", "thickness": "1mm", "material": "core"},
                {"name": "bottom", "kind": "copper", "thickness": "35um"}],
    "nets": ["GND", "LINE"], "outline": {"rect": [[-10, -10], [50, 20]]},
    "planes": [{"layer": "top", "net": "LINE", "rect": [[-9, -9], [49, 19]]}, {"layer": "bottom", "net": "GND", "rect": [[-9, -9], [49, 19]]}],
}
LENGTH, WIDTH, HEIGHT, EPS = 20e-3, 2e-3, 1e-3, 4
LINE = {"region": {"box": {"min": [0, 0], "max": [20, 2]}}, "air": {"above": 0, "below": 0}, "conductors": {"mode": "hollow", "surface": "pec"},
        "mesh": {"longest_edge": 1, "height_policy": "none", "elements_per_wavelength": 1}}
faults = []


def expect(condition, text):
    if not condition:
        faults.append(text)


def solve(folder, name, result, study):
    board, file, out = folder / "plates.json", folder / f"{name}.study.json", folder / name
    board.write_text(json.dumps(PLATES))
    file.write_text(json.dumps({"schema_version": 1, "solver": "getdp", **study}))
    done = run("mesh", board, "--study", file, "-o", f"{out}/")
    if done.returncode == 0:
        done = subprocess.run(["sh", out / "plates.run.sh"], capture_output=True, text=True, env={**os.environ, "PCBMESH": str(PROGRAM)}, timeout=300)
    if done.returncode != 0 or not (out / result).exists():
        raise SystemExit(f"{name}: exit {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-3000:]}")
    return (out / result).read_text()


def reflections(folder, name, xmax):
    """|S11| of the line, driven at xmin through its own impedance."""
    port = {"name": "P1", "net": "LINE", "reference": "GND", "at": {"side": "xmin"}, "width": WIDTH * 1e3, "impedance": 376.730313668 / math.sqrt(EPS) * HEIGHT / WIDTH}
    text = solve(folder, name, "plates.s1p", {**LINE, "boundaries": {"all": "none", "ymin": "pmc", "ymax": "pmc", "xmin": "pmc", "xmax": xmax},
                                              "ports": [port], "sweep": {"from": 1e9, "to": 10e9, "points": 4}})
    rows = [line.split() for line in text.splitlines() if line and line[0] not in "!#"]
    return [math.hypot(float(re), float(im)) for _, re, im in rows]


def modes(folder, name, ends):
    text = solve(folder, name, "plates.modes.txt", {**LINE, "problem": "eigenmode", "modes": {"number": 4, "above": 2e9},
                                                    "boundaries": {"all": "none", "ymin": "pmc", "ymax": "pmc", "xmin": ends, "xmax": ends}})
    rows = [line.split() for line in text[:text.index("# stored")].splitlines() if line and line[0] != "#"]
    return sorted(float(row[1]) for row in rows)


def matched_layers_swallow_a_wave(folder):
    wall = reflections(folder, "wall", "pec")
    expect(len(wall) == 4 and all(abs(s - 1) < 1e-3 for s in wall), f"a wall reflects {wall}")
    coarse = reflections(folder, "coarse", {"kind": "pml", "thickness": 5, "layers": 3})
    fine = reflections(folder, "fine", {"kind": "pml", "thickness": 10, "layers": 5})
    expect(max(coarse) < 0.04, f"three layers reflect {coarse}")
    expect(max(fine) < 0.015, f"five layers of twice the thickness reflect {fine}")


def periodic_sides_repeat_the_field(folder):
    """Between magnetic walls n half waves fit; periodic, n whole ones, each as sine and cosine."""
    half = LIGHT / (2 * LENGTH * math.sqrt(EPS))
    walls, pairs = modes(folder, "walls", "pmc"), modes(folder, "pairs", "periodic")
    expect(all(abs(f / (n * half) - 1) < 0.006 for n, f in zip((1, 2, 3), walls)), f"walls: {walls}, not multiples of {half}")
    expect(len(pairs) >= 3 and all(abs(f / wanted - 1) < 0.01 for f, wanted in zip(pairs, (2 * half, 2 * half, 4 * half))), f"periodic: {pairs}, not twice {2 * half}")


def symmetry_halves(folder):
    """Half a line beside a magnetic wall has half its capacitance."""
    values = []
    for name, low in (("whole", 2), ("half", 5)):
        out = folder / name
        done = run("mesh", ROOT / "examples/microstrip.json", "--region", f"6mm,{low}mm,14mm,8mm", "--boundary", "all=none", "--boundary", "ymin=pmc", "--conductors", "hollow",
                   "--problem", "electrostatic", "--for", "getdp", "-o", f"{out}/")
        expect(done.returncode == 0, f"{name}: {done.stderr}")
        subprocess.run(["sh", out / "microstrip.run.sh"], capture_output=True, timeout=300, check=True)
        rows = [line.split() for line in (out / "microstrip.capacitance.txt").read_text().splitlines() if line[0] != "#"]
        values.append(float(rows[-1][2]))
    expect(values[0] > 0 and abs(values[1] / values[0] - 0.5) < 0.002, f"capacitances {values}")


with tempfile.TemporaryDirectory() as scratch:
    for step in (matched_layers_swallow_a_wave, periodic_sides_repeat_the_field, symmetry_halves):
        step(pathlib.Path(scratch))
for fault in faults:
    print("FAULT:", fault)
sys.exit(1 if faults else 0)
