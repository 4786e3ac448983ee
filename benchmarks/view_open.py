#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens pages of about a million prisms in headless Chromium without a graphics card: time to the first and to the whole picture, frames
while dragging. Usage, from the top folder: /usr/bin/python3 benchmarks/view_open.py [page.html ...]; without pages it makes them.
Wall times of a shared machine: the load is printed beside them."""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/decks"))
from browser import Browser  # noqa: E402
from program import PROGRAM  # noqa: E402

folder = pathlib.Path(tempfile.mkdtemp())
pages = [pathlib.Path(p) for p in sys.argv[1:]]
if not pages:
    for name, board, *options in (("serpentine, case 5", "examples/serpentine.json", "--study", "examples/paper.study.json", "--policy", "5"),
                                  ("via, case 5", "examples/via.json", "--study", "examples/paper.study.json", "--policy", "5"),
                                  ("StickHub", "/usr/share/kicad/demos/stickhub/StickHub.kicad_pcb")):
        pages.append(folder / f"{name}.html")
        subprocess.run([PROGRAM, "view", board, *options, "--no-check", "--quiet", "-o", pages[-1]], check=True, cwd=ROOT)

print("| page | MiB | prisms | first picture, s | whole picture, s | frames per s, turning | exploded: whole, s | frames per s, turning | load |")
print("|---|---|---|---|---|---|---|---|---|")
for page in pages:
    with Browser() as b:
        b.open(page)
        times = b.run("window.pcbmesh.page.stage.times")
        x, y, width, height = b.box("#canvas")
        b.run("window.frames_seen = 0; { const s = window.pcbmesh.page.stage, o = s.on_frame; s.on_frame = () => { ++window.frames_seen; o(); }; }")

        def turning():
            b.settle()
            b.run("window.frames_seen = 0")
            start = time.monotonic()
            b.drag(x + 0.4 * width, y + 0.5 * height, x + 0.6 * width, y + 0.55 * height, 40)
            return b.run("window.frames_seen") / (time.monotonic() - start)
        calm = turning()
        start = time.monotonic()
        b.set_value("#explode", 1)
        b.settle()
        exploded = time.monotonic() - start
        print(f"| {page.stem} | {page.stat().st_size / 2**20:.2f} | {b.run('window.pcbmesh.page.model.tables.num_cells'):,} | {times['first_picture'] / 1e3:.2f} | "
              f"{times['whole_picture'] / 1e3:.2f} | {calm:.1f} | {exploded:.1f} | {turning():.1f} | {os.getloadavg()[0]:.0f} on {os.cpu_count()} cores |", flush=True)
