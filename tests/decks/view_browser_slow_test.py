#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The page in a real browser: headless Chromium opens it, turns, toggles, explodes, cuts and picks, and the picture is looked at."""
import sys
import tempfile
import time
import unittest
from pathlib import Path

from program import DATA, ROOT, SKIPPED, run

try:
    import meshio
    import websocket  # noqa: F401
    from PIL import Image, ImageChops  # noqa: F401
    from browser import Browser, find_chromium
except ImportError as missing:
    print(f"skipped: {missing}; scripts/setup installs it")
    sys.exit(SKIPPED)
if not find_chromium():
    print("skipped: chromium is not installed; scripts/setup does it")
    sys.exit(SKIPPED)

COPPER, LAMINATE = (205, 127, 60), (201, 186, 126)


def share_of(picture, colour, tolerance=14):
    """Share of pixels whose hue is that of a colour: light scales all three channels by one factor."""
    count = 0
    pixels = list(picture.resize((picture.width // 2, picture.height // 2), 0).getdata())
    for p in pixels:
        scale = sum(p) / sum(colour)
        if 0.45 < scale < 1.1 and all(abs(a - scale * b) < tolerance for a, b in zip(p, colour)):
            count += 1
    return count / len(pixels)


def difference(a, b):
    """Share of pixels that differ visibly."""
    red, green, blue = ImageChops.difference(a, b).split()
    changed = ImageChops.lighter(ImageChops.lighter(red, green), blue).point(lambda v: 255 if v > 24 else 0)
    return changed.histogram()[255] / (a.width * a.height)


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = Path(cls.folder.name)
        boards = {"via": (ROOT / "examples/via.json", "--air", "0", "--policy", "average"),
                  "serpentine": (ROOT / "examples/serpentine.json", "--air", "0", "--policy", "minimum", "--sublayers", "floor")}
        if DATA.is_dir():
            boards["board"] = (DATA / "kicad/05_stickhub_2L_v6.kicad_pcb",)
        for name, (board, *options) in boards.items():
            done = run("mesh", board, *options, "-o", cls.out / f"{name}.msh", "-o", cls.out / f"{name}.vtu", "--html", cls.out / f"{name}.html", "--quiet")
            assert done.returncode == 0, done.stderr
        cls.browser = Browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.folder.cleanup()

    def open(self, name):
        if not (self.out / f"{name}.html").exists():
            self.skipTest("no real boards here")
        self.browser.console.clear()
        self.browser.requests.clear()
        self.browser.open(self.out / f"{name}.html")

    def tearDown(self):
        self.assertEqual(self.browser.console, [])
        self.assertTrue(all(url.startswith(("file:", "data:", "blob:")) for url in self.browser.requests), self.browser.requests)

    def canvas(self):
        self.browser.settle()
        return self.browser.picture(selector="#canvas")

    def page(self, expression):
        return self.browser.run(f"(() => {{ const page = window.pcbmesh.page, stage = page.stage, prisms = page.model; return {expression}; }})()")

    def check_whole(self):
        """What every page must do."""
        b = self.browser
        first = self.canvas()
        legend = b.run("[...document.querySelectorAll('#legend li .name')].map((e) => e.textContent)")
        self.assertIn("copper", legend)
        self.assertGreater(share_of(first, COPPER), 0.005, "copper is to be seen")
        self.assertGreater(share_of(first, LAMINATE), 0.02, "laminate is to be seen")

        x, y, width, height = b.box("#canvas")
        before = self.page("stage.angles().azimuth_deg")
        b.drag(x + 0.5 * width, y + 0.5 * height, x + 0.7 * width, y + 0.55 * height)
        self.assertGreater(abs(self.page("stage.angles().azimuth_deg") - before), 10, "dragging turns")
        self.assertGreater(difference(first, self.canvas()), 0.05)

        b.click_on("#view_iso")
        self.assertLess(difference(first, self.canvas()), 0.01, "the same view gives the same picture")

        b.run("[...document.querySelectorAll('#materials label')].find((l) => l.textContent.startsWith('copper')).click()")
        b.settle()
        bare = self.canvas()
        self.assertEqual(share_of(bare, COPPER, 8), 0, "hidden copper is gone")
        self.assertNotIn("copper", b.run("[...document.querySelectorAll('#legend li .name')].map((e) => e.textContent)"))
        b.run("document.querySelector('#materials button.link').click()")
        self.assertLess(difference(first, self.canvas()), 0.01, "and comes back")

        faces = self.page("(stage.need_faces(), stage.num_faces)")
        b.set_value("#explode", 1.5)
        self.assertGreater(difference(first, self.canvas()), 0.05, "layers fly apart")
        self.assertGreater(self.page("(stage.need_faces(), stage.num_faces)"), 1.3 * faces, "and show their own faces")
        b.set_value("#explode", 0)

        plain = self.canvas()
        b.click_on("#theme")
        dark = b.picture()
        self.assertLess(sum(dark.getpixel((dark.width - 5, 5))), 200)
        b.click_on("#theme")
        self.assertLess(difference(plain, self.canvas()), 0.01)
        return first

    def expect_pick(self, name, kind=None):
        """The picked ids against the mesh file, read by meshio: the cell of that number holds the place and has that group."""
        picked = self.page("page.picked")
        self.assertIsNotNone(picked)
        mesh = meshio.read(self.out / f"{name}.vtu")
        wedge = mesh.points[mesh.cells_dict["wedge"][picked["prism"]]]
        x, y, z = (v * 1e-3 for v in picked["at"])
        self.assertTrue(wedge[:, 2].min() - 1e-9 <= z <= wedge[:, 2].max() + 1e-9, "the place is in the cell's height")
        corners = wedge[:3, :2]
        turns = [(corners[(k + 1) % 3][0] - corners[k][0]) * (y - corners[k][1]) - (corners[(k + 1) % 3][1] - corners[k][1]) * (x - corners[k][0]) for k in range(3)]
        self.assertTrue(min(turns) > -1e-12 or max(turns) < 1e-12, "the place is in the cell's triangle")
        self.assertEqual(picked["group_id"], int(mesh.cell_data_dict["volume_tag"]["wedge"][picked["prism"]]))
        if kind:
            self.assertEqual(picked["kind"], kind)
        return picked

    def test_via(self):
        self.open("via")
        self.check_whole()
        b = self.browser
        x, y, width, height = b.box("#canvas")
        b.click(x + 0.5 * width, y + 0.5 * height)
        b.settle()
        picked = self.expect_pick("via", "up")
        self.assertEqual((picked["layer"], picked["face_tag"]), ("L1", "zmax"))
        text = b.run("document.querySelector('#pick').innerText")
        for words in ("Prism", "L1", "FR4", "zmax", f"{picked['q_p']:.3f}"[:4]):
            self.assertIn(words, text)

        # A cut through the middle shows the via's barrel, from the shield layers' copper to the drill.
        b.key("Escape")
        b.set_value("#section_axis", "y")
        b.set_value("#section_at", 0.5)
        b.settle()
        self.assertTrue(self.page("stage.plane.keep_above"), "the plane cuts away what stands before it")
        hit = self.page("(() => { const p = stage.project([(prisms.box.min_x + prisms.box.max_x) / 2, (prisms.box.min_y + prisms.box.max_y) / 2, (prisms.slab_z[0] + prisms.slab_z.at(-1)) / 2], 5); return stage.pick(p[0], p[1]); })()")
        self.assertEqual(hit["kind"], "section")
        self.assertEqual(self.page(f"prisms.describe({{slab: {hit['slab']}, t: {hit['t']}, kind: 'section', at: [0, 0, 0]}}).net"), "SIG")
        b.set_value("#section_axis", "none")

        # Walls have their tags too.
        b.click_on("#view_front")
        b.settle()
        px, py = self.page("stage.project([(prisms.box.min_x + prisms.box.max_x) / 2, prisms.box.min_y, (prisms.slab_z[4] + prisms.slab_z[5]) / 2], 4)")
        b.click(x + px, y + py)
        b.settle()
        picked = self.expect_pick("via", "wall")
        self.assertEqual(picked["face_tag"], "ymin")

    def test_serpentine(self):
        self.open("serpentine")
        self.check_whole()
        # The trace alone, found by its net.
        b = self.browser
        nets = b.run("[...document.querySelectorAll('#nets .name')].map((e) => e.textContent)")
        signal = next(n for n in nets if n not in ("GND", "no net"))
        b.run(f"[...document.querySelectorAll('#nets button.only')][{nets.index(signal)}].click()")
        self.browser.settle()
        self.assertEqual(set(self.page("page.model.tables.groups.filter((g, i) => !page.hidden[i]).map((g) => page.model.tables.nets[g.net].name)")), {signal})
        b.click_on("#view_fit")
        self.assertGreater(share_of(self.canvas(), COPPER), 0.01)

    def test_every_colour_mode_has_a_legend_and_a_picture_of_its_own(self):
        self.open("via")
        seen = []
        for mode in ("material", "net", "layer", "group", "tag", "q_p", "q_t", "size"):
            self.browser.set_value("#colour", mode)
            picture = self.canvas()
            self.assertTrue(all(difference(picture, other) > 0.02 for other in seen), mode)
            seen.append(picture)
            self.assertGreater(self.browser.run("document.querySelector('#legend').innerText.split('\\n').length"), 1)

    def test_real_board(self):
        self.open("board")
        self.check_whole()
        b = self.browser
        x, y, width, height = b.box("#canvas")
        b.click_on("#view_top")
        b.settle()
        b.click(x + 0.5 * width, y + 0.5 * height)
        b.settle()
        self.expect_pick("board", "up")
        # The list of findings flies there.
        b.run("(() => { const f = document.querySelectorAll('.fly button'); f[f.length - 1].click(); })()")
        b.settle()
        self.assertFalse(b.run("document.querySelector('#pin').hidden"))
        self.assertIn("worst prism", b.run("document.querySelector('#pin').textContent"))
        self.assertLess(self.page("stage.camera.position.distanceTo(stage.controls.target)"), 20)
        # While it moves, frames keep coming, of whatever there is time for.
        b.click_on("#view_iso")
        b.settle()
        b.run("window.frames_seen = 0; { const s = window.pcbmesh.page.stage, o = s.on_frame; s.on_frame = () => { ++window.frames_seen; o(); }; }")
        b.drag(x + 0.4 * width, y + 0.5 * height, x + 0.6 * width, y + 0.5 * height, 20)
        self.assertGreater(b.run("window.frames_seen"), 2)

    def test_sheets_and_ports_show_and_hide(self):
        done = run("view", ROOT / "examples/microstrip.json", "--sheet", "LINE", "--port", "P1,net=LINE,at=J1.1", "--no-check", "--quiet", "-o", self.out / "ports.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.open("ports")
        b = self.browser
        legend = b.run("document.querySelector('#legend').innerText")
        self.assertIn("sheet|LINE", legend)
        self.assertIn("port|P1", legend)
        magenta, copper = (224, 36, 130), COPPER
        self.assertGreater(share_of(self.canvas(), copper), 0.01, "the sheet lies on the laminate")
        b.run("[...document.querySelectorAll('#materials label')].filter((l) => !l.textContent.startsWith('copper')).forEach((l) => l.querySelector('input').checked && l.click())")
        self.assertGreater(share_of(self.canvas(), magenta, 20), 0.0001, "the port stands free")
        b.run("[...document.querySelectorAll('#tags label')].find((l) => l.textContent.startsWith('port|P1')).click()")
        self.assertEqual(share_of(self.canvas(), magenta, 20), 0)

    def test_ports_are_listed_and_flown_to(self):
        done = run("view", ROOT / "examples/microstrip.json", "--sheet", "LINE", "--port", "P1,net=LINE,at=J1.1", "--port", "P2,net=LINE,at=J2.1,z=75,passive",
                   "--no-check", "--quiet", "-o", self.out / "two_ports.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.open("two_ports")
        b = self.browser
        items = b.run("[...document.querySelectorAll('#ports li')].map((e) => e.innerText)")
        self.assertEqual(len(items), 2)
        for words in ("P1", "lumped", "50 \u03a9", "excited", "field along +z", "GND", "LINE"):
            self.assertIn(words, items[0])
        for words in ("P2", "75 \u03a9", "passive"):
            self.assertIn(words, items[1])
        b.run("document.querySelectorAll('#ports .fly button')[1].click()")
        b.settle()
        self.assertEqual(b.run("document.querySelector('#pin').textContent"), "port P2")
        x = self.page("stage.controls.target.x + stage.centre[0]")
        self.assertAlmostEqual(x, self.page("page.ports[1].at_m[0]") * 1e3, delta=0.01)
        self.assertLess(self.page("stage.camera.position.distanceTo(stage.controls.target)"), 30)
        # The box in the list and the one among the tags are one switch.
        b.run("document.querySelectorAll('#ports input')[0].click()")
        shown = {tag["name"]: box for tag, box in zip(self.page("prisms.tables.face_tags"), self.page("page.tag_list.boxes.map((b) => b.checked)"))}
        self.assertFalse(shown["port|P1"])
        self.assertTrue(shown["port|P2"])
        self.assertIn("Port P1 hidden", b.run("document.querySelector('#live').textContent"))
        self.expect_names_for_all()

    def test_colours_of_quality_are_those_of_the_cells(self):
        """Graded sub-layers: each wall piece, cap and cut has the colour of the very prism that a click reads."""
        graded = (ROOT / "examples/via.json", "--air", "0", "--policy", "average", "--height-growth", "1.3", "--quiet")
        for arguments in (("mesh", *graded, "-o", self.out / "g.msh"), ("view", *graded, "--no-check", "-o", self.out / "graded.html"),
                          ("view", self.out / "g.msh", "--no-check", "--quiet", "-o", self.out / "graded_cells.html")):
            done = run(*arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
        # Cells carry the quality of each, the prism mesh works it out.
        walls = []
        for name in ("graded_cells", "graded"):
            self.open(name)
            self.browser.set_value("#colour", "q_p")
            self.browser.run("document.querySelector('#edges').click()")
            self.browser.click_on("#view_front")
            walls.append(self.canvas())
        self.assertLess(difference(*walls), 0.002)
        # Pieces of walls as they are drawn: as many colours one above the other as there are heights.
        colours = self.page("""(() => {
            const { position, colour, ranges } = prisms.build(stage.visibility, prisms.paint("q_p"), stage.centre), above = new Map();
            for (const r of ranges.filter((r) => r.kind === "wall"))
                for (let v = r.start; v < r.start + r.count; v += 6) {
                    const z = (position[3 * v + 2] + position[3 * v + 8]) / 2 + stage.centre[2];
                    const key = [position[3 * v], position[3 * v + 1], position[3 * v + 3], position[3 * v + 4], prisms.storey_at(z)].join();
                    if (!above.has(key)) above.set(key, { slab: prisms.storey_at(z), seen: new Set() });
                    above.get(key).seen.add([...colour.slice(4 * v, 4 * v + 3)].join());
                }
            return [...above.values()].map(({ slab, seen }) => [slab, seen.size]);
        })()""")
        uneven = self.page("Array.from({length: prisms.num_slabs}, (_, s) => s).filter((s) => { const k = prisms.first_sublayer[s], l = prisms.first_sublayer[s + 1] - 1; return Math.abs((prisms.z[k + 1] - prisms.z[k]) / (prisms.z[l + 1] - prisms.z[l]) - 1) > 0.05; })")
        self.assertGreater(len(uneven), 0, "the example is graded unevenly")
        self.assertEqual({size for slab, size in colours if slab not in uneven}, {1})
        self.assertGreater(min(size for slab, size in colours if slab in uneven), 1)
        worst = self.page("""Math.max(...%s.flatMap((slab) => Array.from({length: prisms.first_sublayer[slab + 1] - prisms.first_sublayer[slab]}, (_, i) => {
            const k = prisms.first_sublayer[slab] + i, t = 5, at = [0, 0, (prisms.z[k] + prisms.z[k + 1]) / 2], paint = prisms.paint("q_p");
            const exact = prisms.describe({slab, t, kind: "section", at}).q_p, ramp = paint.ramp;
            const p = Math.min(Math.max(exact, 0), 1) * 8, j = Math.min(Math.floor(p), 7), want = ramp[j].map((v, c) => v + (p - j) * (ramp[j + 1][c] - v));
            return Math.max(...paint.face("section", slab, t, -1, -1, k).map((v, c) => Math.abs(v - want[c])), ...paint.face("wall", slab, t, 0, 1, k).map((v, c) => Math.abs(v - want[c])));
        })))""" % uneven)
        self.assertLess(worst, 1e-6)
        # And a cap has that of the sub-layer it lies on.
        slab = uneven[0]
        self.assertEqual(self.page(f"prisms.paint('q_p').face('up', {slab}, 5, -1, -1)"),
                         self.page(f"prisms.paint('q_p').face('section', {slab}, 5, -1, -1, prisms.first_sublayer[{slab + 1}] - 1)"))

    def test_cells_look_and_answer_as_the_prism_mesh(self):
        """The page of our own MSH beside that of the prism mesh it was written from."""
        done = run("view", self.out / "via.msh", "-o", self.out / "cells.html", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        b = self.browser
        found = {}
        for name in ("via", "cells"):
            self.open(name)
            b.settle()
            b.run("document.querySelector('#edges').click()")
            found[name] = {"picture": self.canvas()}
            x, y, width, height = b.box("#canvas")
            for mode in ("net", "layer", "q_p"):
                b.set_value("#colour", mode)
                found[name][mode] = self.canvas()
            b.click(x + 0.5 * width, y + 0.5 * height)
            b.settle()
            found[name]["pick"] = self.page("page.picked")
            b.key("Escape")
            b.set_value("#section_axis", "y")
            b.set_value("#colour", "net")
            found[name]["section"] = self.canvas()
            middle = "[(prisms.box.min_x + prisms.box.max_x) / 2, (prisms.box.min_y + prisms.box.max_y) / 2, (prisms.z_range[0] + prisms.z_range[1]) / 2]"
            px, py = self.page(f"stage.project({middle}, prisms.storey_at({middle}[2]))")
            found[name]["cut"] = self.page(f"prisms.describe(stage.pick({px}, {py}))")
            b.set_value("#section_axis", "none")
            b.set_value("#explode", 1.5)
            found[name]["exploded"] = self.canvas()
        for what in ("picture", "net", "layer", "q_p", "section", "exploded"):
            self.assertLess(difference(found["via"][what], found["cells"][what]), 0.004, what)
        prism, cell = found["via"]["pick"], found["cells"]["pick"]
        self.assertEqual(cell["cell"], prism["prism"])
        for key in ("group", "group_id", "layer", "material", "net", "face_tag", "face_tag_id"):
            self.assertEqual(cell[key], prism[key], key)
        self.assertAlmostEqual(cell["quality"], prism["q_p"], delta=1e-4)
        prism, cell = found["via"]["cut"], found["cells"]["cut"]
        self.assertEqual((cell["kind"], cell["group"]), ("section", prism["group"]))
        self.open("cells")
        self.check_whole()
        self.expect_names_for_all()

    def test_cells_of_gmsh_by_their_groups_with_a_damaged_one(self):
        try:
            import gmsh
        except ImportError:
            self.skipTest("python3-gmsh is not installed")
        gmsh.initialize()
        gmsh.option.setNumber("General.Verbosity", 1)
        occ = gmsh.model.occ
        occ.addBox(0, 0, 0, 10, 6, 2, 1)
        occ.addCylinder(3, 3, 0, 0, 0, 2, 1, 2)
        occ.fragment([(3, 1)], [(3, 2)])
        occ.synchronize()
        for tag, volume, name in ((7, 2, "post"), (9, 3, "block")):
            gmsh.model.addPhysicalGroup(3, [volume], tag)
            gmsh.model.setPhysicalName(3, tag, name)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.8)
        gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(self.out / "gmsh.msh"))
        gmsh.finalize()
        done = run("view", self.out / "gmsh.msh", "--input-unit", "mm", "-o", self.out / "gmsh.html", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.open("gmsh")
        b = self.browser
        self.assertEqual(b.run("[...document.querySelectorAll('#groups .name')].map((e) => e.textContent)"), ["post", "block"])
        self.assertEqual(b.run("['layers', 'materials', 'nets', 'ports'].filter((id) => document.getElementById(id).checkVisibility())"), [], "no empty lists")
        x, y, width, height = b.box("#canvas")
        b.click(x + 0.5 * width, y + 0.5 * height)
        b.settle()
        picked = self.page("page.picked")
        mesh = meshio.read(self.out / "gmsh.msh")
        tetrahedra = next(block for block in mesh.cells if block.type == "tetra")
        blocks = [(block.data, tags) for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]) if block.type == "tetra"]
        nodes = [n for data, _ in blocks for n in data]
        tags = [t for _, block in blocks for t in block]
        corners = mesh.points[nodes[picked["cell"]]]
        # Barycentric coordinates of the place: on a face of that very cell.
        import numpy
        shares = numpy.linalg.solve(numpy.vstack([corners.T, numpy.ones(4)]), [*picked["at"], 1])
        self.assertGreater(shares.min(), -1e-4)
        self.assertLess(abs(shares.min()), 1e-4)
        self.assertEqual(picked["group_id"], tags[picked["cell"]])
        self.assertGreater(len(tetrahedra.data), 10)
        # The post alone, then a cut that goes through it.
        whole = self.canvas()
        b.run("[...document.querySelectorAll('#groups button.only')][0].click()")
        self.assertGreater(difference(whole, self.canvas()), 0.1)
        b.run("document.querySelector('#groups button.link').click()")
        b.set_value("#section_axis", "y")
        b.settle()
        px, py = self.page("stage.project([3, 3, 1], 0)")
        hit = self.page(f"prisms.describe(stage.pick({px}, {py}))")
        self.assertEqual((hit["kind"], hit["group"]), ("section", "post"))
        px, py = self.page("stage.project([8, 3, 1], 0)")
        self.assertEqual(self.page(f"prisms.describe(stage.pick({px}, {py}))")["group"], "block")

        # Turn one cell inside out: the check says so, the list shows it, a click flies there.
        lines = (self.out / "gmsh.msh").read_text().split("\n")
        at = next(i for i, line in enumerate(lines) if line.split()[1:2] == ["4"] and len(line.split()) > 8)
        parts = lines[at].split()
        parts[-1], parts[-2] = parts[-2], parts[-1]
        lines[at] = " ".join(parts)
        (self.out / "damaged.msh").write_text("\n".join(lines))
        centre = mesh.points[[int(n) - 1 for n in parts[-4:]]].mean(axis=0)
        done = run("view", self.out / "damaged.msh", "--input-unit", "mm", "-o", self.out / "damaged.html", "--quiet")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.open("damaged")
        self.assertIn("check failed", b.run("document.querySelector('#panel header').innerText"))
        findings = b.run("[...document.querySelectorAll('#findings li')].map((e) => e.innerText)")
        index = next(i for i, text in enumerate(findings) if text.startswith("error") and "cell.inverted" in text)
        b.run(f"document.querySelectorAll('#findings li')[{index}].querySelector('.fly button').click()")
        b.settle()
        self.assertFalse(b.run("document.querySelector('#pin').hidden"))
        target = self.page("[0, 1, 2].map((k) => stage.controls.target.getComponent(k) + stage.centre[k])")
        for k in range(3):
            self.assertAlmostEqual(target[k], centre[k], delta=0.01)
        self.expect_names_for_all()

    def test_keyboard(self):
        self.open("via")
        b = self.browser
        b.run("document.querySelector('#canvas').focus()")
        before = self.page("stage.angles()")
        b.key("ArrowRight")
        b.key("ArrowUp")
        after = self.page("stage.angles()")
        self.assertAlmostEqual(after["azimuth_deg"] - before["azimuth_deg"], 5, delta=0.1)
        self.assertAlmostEqual(after["elevation_deg"] - before["elevation_deg"], 5, delta=0.1)
        target = self.page("stage.controls.target.x")
        b.key("ArrowRight", shift=True)
        self.assertNotEqual(self.page("stage.controls.target.x"), target)
        distance = self.page("stage.camera.position.distanceTo(stage.controls.target)")
        b.key("+")
        self.assertLess(self.page("stage.camera.position.distanceTo(stage.controls.target)"), 0.9 * distance)
        b.key("f")
        b.settle()
        b.key("Enter")
        b.settle()
        self.assertFalse(b.run("document.querySelector('#pick').hidden"))
        self.assertIn("Prism", b.run("document.querySelector('#live').textContent"))
        b.key("Escape")
        self.assertTrue(b.run("document.querySelector('#pick').hidden"))
        b.key("e")
        self.assertFalse(self.page("stage.edges"))
        b.key("x")
        self.assertEqual(self.page("page.explode"), 1)
        b.key("?")
        self.assertTrue(b.run("document.querySelector('#help').open"))
        b.key("Escape")
        # The view is reached with the tabulator alone.
        b.open(self.out / "via.html")
        b.key("Tab")
        b.key("Enter")
        self.assertEqual(b.run("document.activeElement.id"), "canvas", "the first link leads to the view")
        b.run("document.activeElement.blur()")
        reached = set()
        for _ in range(80):
            b.key("Tab")
            reached.add(b.run("document.activeElement.id"))
        for control in ("colour", "edges", "explode", "section_axis", "theme", "print"):
            self.assertIn(control, reached)

    def expect_names_for_all(self):
        """Whatever can be worked has a name that is read out."""
        nodes = self.browser.call("Accessibility.getFullAXTree")["nodes"]
        nameless = [n for n in nodes if not n.get("ignored") and n["role"]["value"] in ("button", "checkbox", "slider", "combobox", "searchbox", "application", "image", "dialog")
                    and not n.get("name", {}).get("value")]
        self.assertEqual(nameless, [])
        return nodes

    def test_names_for_those_who_listen(self):
        self.open("serpentine")
        nodes = self.expect_names_for_all()
        roles = {n["role"]["value"] for n in nodes}
        for role in ("application", "slider", "checkbox", "combobox", "button", "status", "complementary", "main", "navigation"):
            self.assertIn(role, roles)

    def test_prints(self):
        self.open("via")
        import base64
        raw = base64.b64decode(self.browser.call("Page.printToPDF", printBackground=True)["data"])
        self.assertTrue(raw.startswith(b"%PDF"))
        self.assertGreater(len(raw), 30000)
        self.assertIn(b"/Subtype /Image", raw)

    def test_a_hostile_name_stays_a_name(self):
        board = self.out / "hostile.json"
        text = (ROOT / "examples/via.json").read_text()
        self.assertIn('"SIG"', text)
        board.write_text(text.replace('"SIG"', '"</script><img src=x onerror=alert(1)>{{title}}"'))
        done = run("view", board, "--air", "0", "-o", self.out / "hostile.html")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.open("hostile")
        self.assertIn("</script><img src=x onerror=alert(1)>{{title}}", self.browser.run("[...document.querySelectorAll('#nets .name')].map((e) => e.textContent)"))
        self.assertEqual(self.browser.run("document.querySelectorAll('img').length"), 1)


if __name__ == "__main__":
    unittest.main()
