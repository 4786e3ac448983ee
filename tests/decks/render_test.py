#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: what they show, that they come out the same every time, and what is said when they can't be drawn."""
import gzip
import io
import json
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

from program import ROOT, SKIPPED, run

try:
    from PIL import Image, ImageChops
except ImportError:
    print("skipped: python3-pil is not installed")
    sys.exit(SKIPPED)

VIA = (ROOT / "examples/via.json", "--air", "0", "--policy", "average")
STRIP = (ROOT / "examples/microstrip.json",)
SVG = "{http://www.w3.org/2000/svg}"


def area(path):
    """Area of an SVG path of straight lines by the even-odd rule, for loops that do not cross: sum of signed areas."""
    total = 0
    for loop in re.findall(r"M([^Z]+)Z", path):
        points = [tuple(map(float, p.split())) for p in loop.split("L")]
        total += sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, points[1:] + points[:1])) / 2
    return total


class Pictures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name)

    def draw(self, *arguments, name="x.png"):
        done = run("render", *arguments, "-o", self.out / name, "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        return (self.out / name).read_bytes()

    def picture(self, *arguments):
        return Image.open(io.BytesIO(self.draw(*arguments)))

    def colours(self, *arguments):
        picture = self.picture(*arguments, "--background", "#ffffff", "--edges", "off").convert("RGB")
        return {c: n / (picture.width * picture.height) for n, c in picture.getcolors(1 << 24)}

    def test_same_bytes_every_time(self):
        self.assertEqual(self.draw(*VIA), self.draw(*VIA))
        self.assertEqual(self.draw(*STRIP, "--view", "top", name="x.svg"), self.draw(*STRIP, "--view", "top", name="x.svg"))

    def test_size_and_transparency(self):
        picture = self.picture(*VIA, "--size", "320x200", "--background", "transparent")
        self.assertEqual((picture.size, picture.mode), ((320, 200), "RGBA"))
        self.assertEqual(picture.getpixel((0, 0))[3], 0)
        self.assertEqual(picture.getpixel((160, 100))[3], 255)

    def test_top_view_shows_the_areas_of_the_layout(self):
        # Seen from above, one layer alone: the line of 1.1 mm on a board of 24 x 10 mm, and its pads.
        colours = self.colours(*STRIP, "--view", "top", "--layers", "top", "--only-nets", "LINE", "--size", "800x400")
        ground = max((c for c in colours if c != (255, 255, 255)), key=colours.get)
        self.assertTrue(ground[0] > ground[1] > ground[2], f"copper, not {ground}")
        box = self.picture(*STRIP, "--view", "top", "--layers", "top", "--only-nets", "LINE", "--size", "800x400", "--background", "transparent").getbbox()
        # From pad to pad 21.6 mm, pads 1.4 mm high.
        self.assertAlmostEqual((box[2] - box[0]) / (box[3] - box[1]), 21.6 / 1.4, delta=0.6)

    def test_everything_fits_whatever_the_view(self):
        for view in ("iso", "top", "bottom", "front", "back", "left", "right"):
            for explode in ("0", "2"):
                picture = self.picture(*VIA, "--view", view, "--explode", explode, "--size", "300x200", "--background", "transparent")
                left, top, right, bottom = picture.getbbox()
                self.assertTrue(left > 0 and top > 0 and right < 300 and bottom < 200, (view, explode))
                self.assertTrue(right - left > 250 or bottom - top > 160, (view, explode, "fills the picture"))

    def test_section_lays_the_barrel_open(self):
        whole = self.colours(*VIA, "--view", "front", "--colour", "net")
        cut = self.colours(*VIA, "--view", "front", "--colour", "net", "--section", "y=1.5748mm")
        self.assertGreater(len(cut), len(whole), "the signal's colour joins the shields' and the laminate's")

    def test_hidden_means_gone(self):
        only = self.colours(*VIA, "--hide", "FR4")
        brown = sum(n for c, n in only.items() if c[0] > c[2] + 40)
        self.assertGreater(brown, 0.05)
        self.assertEqual([c for c in only if abs(c[0] - 201) < 4 and abs(c[1] - 186) < 4], [])

    def test_plan_is_a_drawing_of_true_areas(self):
        text = self.draw(*STRIP, "--view", "top", "--layers", "top", "--only-nets", "LINE", "--title", "A <line> & \"its\" pads", name="x.svg").decode()
        tree = xml.fromstring(text)
        self.assertEqual(tree.find(f"{SVG}title").text, 'A <line> & "its" pads')
        paths = [p.get("d") for p in tree.iter(f"{SVG}path") if p.get("fill", "none") != "none"]
        mesh = run("mesh", *STRIP, "-o", self.out / "m.msh", "--quiet")
        self.assertEqual(mesh.returncode, 0, mesh.stderr)
        tags = json.loads((self.out / "m.tags.json").read_text())
        volumes = {v["name"]: v for v in tags["volumes"]}
        expected = volumes["top|copper|LINE"]["volume_m3"] / 35e-6 * 1e6
        self.assertAlmostEqual(sum(map(area, paths)), expected, delta=1e-3 * expected)
        self.assertIn(" mm</text>", text)
        self.assertIn("copper", text)

    def test_slanted_svg_has_the_picture_and_a_legend(self):
        tree = xml.fromstring(self.draw(*VIA, "--colour", "q_p", "--title", "Via", name="x.svg").decode())
        self.assertTrue(next(tree.iter(f"{SVG}image")).get("href").startswith("data:image/png;base64,"))
        self.assertIn("Prism quality q_p", [t.text for t in tree.iter(f"{SVG}text")])

    def test_a_native_mesh_gives_the_picture_of_its_board(self):
        done = run("mesh", *VIA, "-o", self.out / "x.pcbmesh", "-o", self.out / "x.msh", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.draw(self.out / "x.pcbmesh", name="mesh.png"), self.draw(*VIA, name="board.png"))
        done = run("view", self.out / "x.pcbmesh", "-o", self.out / "x.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("DecompressionStream", (self.out / "x.html").read_text())

    def test_a_report_holds_every_plot(self):
        done = run("view", *VIA[:3], "--policy", "matched", "--target-quality", "0.9", "-o", self.out / "m.html", "--no-check", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        plots = {xml.fromstring(svg).get("aria-label"): svg for svg in re.findall(r"<figure>(<svg.*?</svg>)", (self.out / "m.html").read_text(), re.S)}
        for title in ("Prism quality q_p", "Layers: height and cuts", "Mean prism quality over one common height", "Optimal prism height of every triangle",
                      "Pareto front: quality over prisms"):
            self.assertIn(title, plots)
        front = plots["Pareto front: quality over prisms"]
        done = run("mesh", *VIA[:3], "--policy", "matched", "--target-quality", "0.9", "-o", self.out / "m.msh", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        match = json.loads((self.out / "m.report.json").read_text())["match"]
        taken = match["meshes"][match["chosen"]]
        self.assertIn(f"taken: {taken['prisms']} prisms, quality {min(taken['mean_prism'], taken['volume_weighted_prism']):.4f}", front)
        self.assertEqual(len(re.findall(r"<circle", front)), len(match["meshes"]))
        self.assertIn("goal 0.9", front)
        # Another policy weighs nothing up.
        self.assertEqual(run("view", *VIA, "-o", self.out / "a.html", "--no-check", "--quiet").returncode, 0)
        self.assertNotIn("Pareto front", (self.out / "a.html").read_text().split("<script", 1)[0])

    def test_every_format_that_is_read_gives_the_picture_of_the_prism_mesh(self):
        files = [self.out / f"x{ending}" for ending in (".pcbmesh", ".msh", ".vtu", ".vtkhdf", ".xdmf", ".mesh", ".inp")]
        done = run("mesh", *VIA, "--quiet", *(part for file in files for part in ("-o", file)))
        self.assertEqual(done.returncode, 0, done.stderr)
        (self.out / "x.msh.gz").write_bytes(gzip.compress(files[1].read_bytes()))
        for options in ((), ("--section", "y=1.6mm", "--colour", "net"), ("--explode", "1", "--colour", "q_p")):
            pictures = {file.name: self.draw(file, *options, "--edges", "off") for file in (*files, self.out / "x.msh.gz")}
            for name, picture in pictures.items():
                # Text formats round coordinates, which may move a pixel or two.
                if name.endswith((".mesh", ".inp")):
                    a, b = (Image.open(io.BytesIO(p)).convert("RGB") for p in (picture, pictures["x.pcbmesh"]))
                    changed = ImageChops.difference(a, b).convert("L").point(lambda v: 255 if v > 8 else 0).histogram()[255]
                    self.assertLess(changed, 50, f"{name} {options}")
                else:
                    self.assertEqual(picture, pictures["x.pcbmesh"], f"{name} {options}")
        counts = [json.loads(run("render", file, "-o", self.out / "c.png", "--json").stdout) for file in files[:2]]
        self.assertEqual(counts[0]["prisms"], counts[1]["cells"])
        self.assertEqual([counts[0][k] for k in ("visible_triangles", "visible_quads")], [counts[1][k] for k in ("visible_triangles", "visible_quads")])

    def test_tetrahedra_cover_the_same_surface(self):
        done = run("mesh", *VIA, "--quiet", "-o", self.out / "x.msh")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = run("convert", self.out / "x.msh", self.out / "t.msh", "--split", "tets", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        a, b = (Image.open(io.BytesIO(self.draw(self.out / name, "--edges", "off", "--explode", "1"))).convert("RGB") for name in ("x.msh", "t.msh"))
        self.assertLess(ImageChops.difference(a, b).convert("L").point(lambda v: 255 if v > 8 else 0).histogram()[255], 0.001 * a.width * a.height)
        counts = json.loads(run("render", self.out / "t.msh", "-o", self.out / "t.png", "--json").stdout)
        self.assertEqual(counts["visible_quads"], 0)

    def test_cells_of_others_by_their_groups(self):
        tetrahedra = """$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 "Solid A"\n$EndPhysicalNames
$Nodes\n5\n1 0 0 0\n2 10 0 0\n3 0 10 0\n4 0 0 10\n5 10 10 10\n$EndNodes\n$Elements\n2\n1 4 2 7 1 1 2 3 4\n2 4 2 8 2 2 3 4 5\n$EndElements\n"""
        (self.out / "t.msh").write_text(tetrahedra)
        svg = self.draw(self.out / "t.msh", "--input-unit", "mm", name="t.svg").decode()
        texts = [t.text for t in xml.fromstring(svg).iter(f"{SVG}text")]
        for words in ("Volume group", "Solid A", "volume 8"):
            self.assertIn(words, texts)
        self.assertNotEqual(self.draw(self.out / "t.msh", "--input-unit", "mm"), self.draw(self.out / "t.msh", "--input-unit", "mm", "--hide", "Solid A"))
        # 2 mm off a corner of 10 mm: the unit counts.
        self.assertNotEqual(self.draw(self.out / "t.msh", "--input-unit", "mm", "--section", "z=2mm-"), self.draw(self.out / "t.msh", "--input-unit", "mm"))
        for arguments, words in ((("--colour", "net"), "group, q_p, size"), (("--hide", "Solid B"), "did you mean 'Solid A'"), (("--input-unit", "pt"), "pt"),
                                 (("--show-box", "20mm,20mm,30mm,30mm"), "no cell")):
            done = run("render", self.out / "t.msh", "-o", self.out / "no.png", *arguments)
            self.assertNotEqual(done.returncode, 0, arguments)
            self.assertIn(words, done.stderr)
            self.assertFalse((self.out / "no.png").exists())

    def test_usage(self):
        for arguments, words in (((*VIA, "-o", self.out / "x.jpg"), ".png or .svg"), ((*VIA, "-o", self.out / "x.png", "--view", "up"), "iso"),
                                 ((*VIA, "-o", self.out / "x.png", "--colour", "red"), "q_p"), ((*VIA, "-o", self.out / "x.png", "--size", "9x9"), "16"),
                                 ((*VIA, "-o", self.out / "x.png", "--section", "w=3"), "x=10mm")):
            done = run("render", *arguments)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)
        done = run("render", *VIA, "-o", self.out / "x.png", "--layers", "L33")
        self.assertEqual(done.returncode, 3)
        self.assertIn("did you mean 'L3'", done.stderr)
        done = run("render", *VIA, "-o", self.out / "x.png", "--hide", "FR4,copper")
        self.assertIn("nothing is left to draw", done.stderr)
        self.assertEqual(list(self.out.iterdir()), [])

    def test_refusal_is_drawn(self):
        board = json.loads((ROOT / "examples/microstrip.json").read_text())
        board["outline"] = [board["outline"], {"rect": [[20, 6], [30, 14]]}]
        (self.out / "b.json").write_text(json.dumps(board))
        for command, output in (("mesh", "b.msh"), ("view", "b.html"), ("render", "b.png")):
            picture = self.out / "b.refusal.svg"
            picture.unlink(missing_ok=True)
            done = run(command, self.out / "b.json", "-o", self.out / output)
            self.assertEqual(done.returncode, 3)
            self.assertIn("b.refusal.svg", done.stderr)
            self.assertFalse((self.out / output).exists())
            text = " ".join(t.text for t in xml.fromstring(picture.read_text()).iter(f"{SVG}text"))
            for words in ("error 302", "(20, 6) mm", "board outlines 1 and 2 overlap"):
                self.assertIn(words, text)


if __name__ == "__main__":
    unittest.main()
