#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh hangs on the board, not on how its file is written: shuffled shapes give the same mesh, and a turned board changes
the number of triangles by less than 1 %, the mean quality by less than 0.003. Where it does not hold: docs/quality.md."""
import copy
import json
import math
import pathlib
import random
import tempfile
import unittest

from program import ROOT, run_json

TOLERANCE, QUALITY = 0.01, 0.003
WAYS = {"average": (), "fine": ("--policy", "none", "--longest-edge", "0.3mm"),
        "hex": ("--policy", "none", "--longest-edge", "0.4mm", "--seed", "hex", "--smooth")}


def small_board(seed):
    """Tracks, pads, vias and a plane with antipads, nothing on a raster."""
    rng = random.Random(seed)
    spot = lambda: [round(rng.uniform(1, 19), 4), round(rng.uniform(1, 11), 4)]
    tracks = [{"layer": rng.choice(["top", "bottom"]), "net": f"T{i}", "width": rng.choice([0.15, 0.2, 0.35]), "points": [[2, 0.6 * i + 1.03], [9 + 0.11 * i, 0.6 * i + 1.03], [12.3 + 0.13 * i, 0.41 * i + 2.17]]} for i in range(14)]
    vias = [{"at": [14.5 + 1.3 * (i % 4), 1.2 + 1.9 * (i // 4) + 0.031 * i], "drill": 0.3, "pad": 0.6, "net": "GND", "antipad": 0.9} for i in range(16)]
    pads = [{"layer": "top", "net": f"T{i}", "at": [2, 0.6 * i + 1.03], "size": [0.5, 0.4], "shape": "rect"} for i in range(14)]
    polygons = [{"layer": "top", "net": "FILL", "points": [[2, 10], [6.1, 9.9], [8.2, 11.3], [2.3, 11.5]]},
                {"layer": "bottom", "net": "FILL", "points": [[14.2, 9.1], [18.9, 9.4], [18.1, 11.2], [15.3, 10.9]]}]
    return {"pcbmesh_board": 1, "units": "mm", "materials": [{"name": "FR4", "eps_r": 4.3}],
            "stackup": [{"name": "top", "kind": "copper", "thickness": "35um"}, {"name": "core", "kind": "dielectric", "thickness": 0.8, "material": "FR4"},
                        {"name": "bottom", "kind": "copper", "thickness": "35um"}],
            "outline": {"points": [[0, 0], [20, 0], [20, 12], [0, 12]]}, "tracks": tracks, "vias": vias, "pads": pads, "polygons": polygons}


def shuffled(board, seed):
    """The same board, its lists in another order, every closed path from another corner."""
    rng, board = random.Random(seed), copy.deepcopy(board)
    for key in ("tracks", "vias", "pads", "polygons", "planes"):
        rng.shuffle(board.get(key, []))
    for area in board.get("polygons", []) + [board["outline"]]:
        start = rng.randrange(len(area["points"]))
        area["points"] = area["points"][start:] + area["points"][:start]
    return board


def turned(board, degrees):
    """The same board turned round the origin."""
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn = lambda p: [cosine * p[0] - sine * p[1], sine * p[0] + cosine * p[1]]

    def walk(value):
        if isinstance(value, dict):
            out = {}
            for key, item in value.items():
                if key == "points":
                    out[key] = [turn(p) for p in item]
                else:
                    out[key] = turn(item) if key == "at" else walk(item)
            return out
        return [walk(item) for item in value] if isinstance(value, list) else value

    board = walk(board)
    for pad in board.get("pads", []):
        pad["rotation"] = pad.get("rotation", 0) + degrees
    return board


class Order(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.boards = {"small": small_board(1)} | {name: json.loads((ROOT / f"examples/{name}.json").read_text()) for name in ("serpentine", "via")}
        for board in self.boards.values():
            board.pop("$schema", None)

    def tearDown(self):
        self.folder.cleanup()

    def measure(self, board, flags):
        file = pathlib.Path(self.folder.name) / "board.json"
        file.write_text(json.dumps(board))
        report = run_json("mesh", file, "--air", "0", "--dry-run", "--quiet", *flags)
        return report["counts"]["triangles"], report["quality"]["mean_triangle"]

    def compare(self, names, ways, variants, tolerance, quality_tolerance):
        for name in names:
            board = self.boards[name]
            for way in ways:
                flags = WAYS[way]
                count, quality = self.measure(board, flags)
                for what, other in variants(board):
                    with self.subTest(board=name, way=way, variant=what):
                        got, got_quality = self.measure(other, flags)
                        print(f"{name:<11}{way:<8}{what:<12} {count:>7} {got:>7} {100 * (got / count - 1):+.2f} %  q_t {quality:.4f} {got_quality - quality:+.4f}")
                        self.assertLessEqual(abs(got - count), tolerance * count)
                        self.assertLessEqual(abs(got_quality - quality), quality_tolerance)

    def test_the_order_of_shapes_changes_nothing(self):
        self.compare(self.boards, WAYS, lambda board: [(f"shuffle {seed}", shuffled(board, seed)) for seed in (1, 2)], 0, 0)

    def test_the_direction_of_the_board_changes_little(self):
        self.compare(["small"], ["average", "fine"], lambda board: [(f"{angle} deg", turned(board, angle)) for angle in (90, 30, 17.3)], TOLERANCE, QUALITY)

    def test_another_board_does_differ(self):
        count, _ = self.measure(self.boards["small"], WAYS["fine"])
        other = copy.deepcopy(self.boards["small"])
        del other["vias"][: len(other["vias"]) // 2]
        self.assertGreater(abs(self.measure(other, WAYS["fine"])[0] - count), TOLERANCE * count, "the tolerance tells boards apart")


if __name__ == "__main__":
    unittest.main()
