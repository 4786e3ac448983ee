#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that other programs made, good ones and ones that other programs broke: pcbmesh check judges them, alone and by profile."""
import json
import pathlib
import re
import shlex
import sys
import tempfile
import unittest
import xml.etree.ElementTree

from program import ROOT, SKIPPED, run

try:
    import gmsh
    import meshio
    import numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)


def codes(done):
    return [finding["code"] for finding in json.loads(done.stdout)["findings"]]


def errors(done):
    return [finding["code"] for finding in json.loads(done.stdout)["findings"] if finding["severity"] == "error"]


def gmsh_box(file, version, prisms, binary=False, port=True):
    """A box of 4 x 2 x 1, extruded by Gmsh in three levels; a strip of its top is a conductor, and a port stands below its edge."""
    gmsh.clear()
    geo = gmsh.model.geo
    xs, ys = (0, 1, 3, 4), (0, 1, 2)
    point = {(x, y): geo.addPoint(x, y, 0, 0.5) for x in xs for y in ys}
    across = {(i, y): geo.addLine(point[xs[i], y], point[xs[i + 1], y]) for i in range(3) for y in ys}
    along = {(x, j): geo.addLine(point[x, ys[j]], point[x, ys[j + 1]]) for x in xs for j in range(2)}
    solids, top, bottom, wall = [], {}, [], None
    for i in range(3):
        for j in range(2):
            loop = geo.addCurveLoop([across[i, ys[j]], along[xs[i + 1], j], -across[i, ys[j + 1]], -along[xs[i], j]])
            base = geo.addPlaneSurface([loop])
            out = geo.extrude([(2, base)], 0, 0, 1, [3], recombine=prisms)
            top[i, j] = out[0][1]
            solids.append(out[1][1])
            bottom.append(base)
            if (i, j) == (1, 0):
                wall = out[4][1]  # over the third line: y = 1 between x = 1 and 3
    geo.synchronize()
    name = gmsh.model.setPhysicalName
    name(3, gmsh.model.addPhysicalGroup(3, solids, 1), "substrate")
    strip = [top[1, 0]]
    name(2, gmsh.model.addPhysicalGroup(2, strip, 1), "pec|LINE")
    name(2, gmsh.model.addPhysicalGroup(2, bottom, 2), "pec|GND")
    tagged = set(strip) | set(bottom)
    if port:
        name(2, gmsh.model.addPhysicalGroup(2, [wall], 3), "port|P1")
        tagged.add(wall)
    hull = [abs(tag) for _, tag in gmsh.model.getBoundary([(3, s) for s in solids], combined=True, oriented=False)]
    name(2, gmsh.model.addPhysicalGroup(2, [s for s in hull if s not in tagged], 4 if port else 3), "outer")
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.4)
    gmsh.model.mesh.generate(3)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.Binary", 1 if binary else 0)
    gmsh.write(str(file))
    return file


class ForeignMeshes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)

    @classmethod
    def tearDownClass(cls):
        gmsh.finalize()

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def check(self, file, *options):
        return run("check", file, "--json", "--quiet", *options)

    def test_gmsh_prisms_and_tetrahedra_are_good(self):
        for prisms in (True, False):
            for version in (2.2, 4.1):
                for binary in (False, True):
                    file = gmsh_box(self.out / "a.msh", version, prisms, binary)
                    with self.subTest(prisms=prisms, version=version, binary=binary):
                        done = self.check(file)
                        self.assertEqual((done.returncode, errors(done)), (0, []))

    def test_the_profile_of_the_readme(self):
        """pcbmesh check mesh.msh --profile palace --junit report.xml"""
        file, report = gmsh_box(self.out / "mesh.msh", 2.2, True), self.out / "report.xml"
        done = self.check(file, "--profile", "palace", "--junit", report)
        self.assertEqual((done.returncode, errors(done)), (0, []), done.stdout)
        suite = xml.etree.ElementTree.parse(report).getroot()
        self.assertEqual(suite.get("failures"), "0")
        cases = [case.get("name") for case in suite.iter("testcase")]
        self.assertIn("profile.palace.chord", cases)
        for version, code in ((4.1, "profile.palace.format"),):
            done = self.check(gmsh_box(file, version, True), "--profile", "palace", "--junit", report)
            self.assertEqual((done.returncode, errors(done)), (1, [code]))
            failed = [case.get("name") for case in xml.etree.ElementTree.parse(report).getroot().iter("testcase") if case.find("failure") is not None]
            self.assertEqual(failed, [code])

    def test_the_very_commands_of_the_readme(self):
        """The block under "In CI", run as it stands, on a mesh of Gmsh and on one of our own."""
        block = re.search(r"## In CI\n```sh\n(.*?)```", (ROOT / "README.md").read_text(), re.S)[1]
        commands = [shlex.split(line) for line in block.splitlines() if line.startswith("pcbmesh ")]
        self.assertEqual(commands[0], "pcbmesh check mesh.msh --profile palace --junit report.xml".split())
        self.assertEqual(len(commands), 3)
        gmsh_box(self.out / "mesh.msh", 2.2, True)
        (self.out / "limits.json").write_text('{"schema_version": 1, "min_face_angle_deg": 5}')
        made = run("mesh", ROOT / "examples/microstrip.json", "-o", self.out / "usb.msh", "--quiet")
        self.assertEqual(made.returncode, 0, made.stderr)
        # Gmsh turns some tagged faces inwards: a warning, on which the second command fails as it says.
        for command, code in zip(commands, (0, 1, 0)):
            done = run(*command[1:], cwd=self.out)
            self.assertEqual(done.returncode, code, (command, done.stdout, done.stderr))
            if code:
                self.assertIn("face.tagged_inward", done.stdout)
        self.assertLessEqual({"report.xml", "report.sarif", "report.html", "bad.vtu"}, {file.name for file in self.out.iterdir()})
        # The gate closes: a cell of the foreign mesh turned inside out fails the same command, and the report says where.
        lines = (self.out / "mesh.msh").read_text().splitlines()
        first = next(i for i, line in enumerate(lines) if line.split()[1:3] == ["6", "2"])
        words = lines[first].split()
        lines[first] = " ".join(words[:5] + words[-3:] + words[-6:-3])
        (self.out / "mesh.msh").write_text("\n".join(lines) + "\n")
        self.assertEqual(run(*commands[0][1:], cwd=self.out).returncode, 1)
        failed = [case.get("name") for case in xml.etree.ElementTree.parse(self.out / "report.xml").getroot().iter("testcase") if case.find("failure") is not None]
        self.assertIn("cell.inverted", failed)

    def test_each_profile_on_prisms_and_tetrahedra_of_gmsh(self):
        prisms = gmsh_box(self.out / "prisms.msh", 2.2, True)
        tets = gmsh_box(self.out / "tets.msh", 2.2, False, binary=True)
        for profile, on_prisms, on_tets in (("palace", [], []), ("mfem", [], []), ("getdp", [], []), ("elmer", [], ["profile.elmer.format"]),
                                            ("dolfinx", ["profile.dolfinx.prisms", "profile.dolfinx.face_tags"], [])):
            with self.subTest(profile=profile):
                self.assertEqual(errors(self.check(prisms, "--profile", profile)), on_prisms)
                self.assertEqual(errors(self.check(tets, "--profile", profile)), on_tets)
        self.assertEqual(run("check", prisms, "--profile", "hfss").returncode, 2)

    def gmsh_periodic_box(self, file, version, binary, groups=True):
        """Tetrahedra; the side x = 2 is the side x = 0 moved."""
        gmsh.clear()
        geo = gmsh.model.geo
        points = [geo.addPoint(x, y, 0, 0.4) for x, y in ((0, 0), (2, 0), (2, 1), (0, 1))]
        lines = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
        base = geo.addPlaneSurface([geo.addCurveLoop(lines)])
        out = geo.extrude([(2, base)], 0, 0, 0.7)
        geo.synchronize()
        high, low = out[3][1], out[5][1]
        gmsh.model.mesh.setPeriodic(2, [high], [low], [1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
        if groups:
            name = gmsh.model.setPhysicalName
            name(3, gmsh.model.addPhysicalGroup(3, [out[1][1]], 1), "box")
            name(2, gmsh.model.addPhysicalGroup(2, [low], 1), "low")
            name(2, gmsh.model.addPhysicalGroup(2, [high], 2), "high")
            name(2, gmsh.model.addPhysicalGroup(2, [base, out[0][1], out[2][1], out[4][1]], 3), "outer")
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.4)
        gmsh.model.mesh.generate(3)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.option.setNumber("Mesh.Binary", 1 if binary else 0)
        gmsh.write(str(file))
        return file

    def test_periodic_sides_of_gmsh(self):
        file = self.out / "p.msh"
        for version in (2.2, 4.1):
            for binary in (False, True):
                for groups in (True, False):
                    with self.subTest(version=version, binary=binary, groups=groups):
                        done = self.check(self.gmsh_periodic_box(file, version, binary, groups))
                        looked = next(c["num_examined"] for c in json.loads(done.stdout)["checks"] if c["name"] == "periodic")
                        self.assertGreater(looked, 40)
                        self.assertFalse([code for code in codes(done) if code.startswith("periodic.")])

    def test_periodic_sides_damaged(self):
        for version in (2.2, 4.1):
            whole = self.gmsh_periodic_box(self.out / "p.msh", version, False).read_text()
            head, links = whole.split("$Periodic\n")
            rows = links.splitlines()
            first = next(i for i, row in enumerate(rows) if len(row.split()) == 3 and row.startswith("2 ")) + 3  # the pairs of the surfaces come behind transformation and count
            for damage, expected in (
                    (lambda r: r[:first - 1] + [str(int(r[first - 1]) - 1)] + r[first + 1:], {"periodic.unmatched"}),
                    (lambda r: r[:first] + [f"{r[first].split()[0]} 99999"] + r[first + 1:], {"periodic.unmatched", "periodic.link"}),
                    (lambda r: r[:first] + [f"{r[first].split()[0]} {r[first + 1].split()[1]}"] + r[first + 1:], {"periodic.unmatched", "periodic.link", "periodic.moved"})):
                (self.out / "d.msh").write_text(head + "$Periodic\n" + "\n".join(damage(rows)) + "\n")
                with self.subTest(version=version, expected=expected):
                    self.assertEqual(set(errors(self.check(self.out / "d.msh"))), expected)

    def test_second_order_of_gmsh(self):
        file = self.out / "o.msh"
        gmsh_box(file, 2.2, True)
        for incomplete, nodes in ((1, 15), (0, 18)):
            gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
            gmsh.model.mesh.setOrder(1)
            gmsh.model.mesh.setOrder(2)
            gmsh.write(str(file))
            for profile, code in (("palace", "incomplete_elements"), ("mfem", "incomplete_elements"), ("getdp", "second_order_prisms"), ("elmer", "second_order_prisms")):
                expected = [] if nodes == 18 and code == "incomplete_elements" else [f"profile.{profile}.{code}"]
                with self.subTest(profile=profile, nodes=nodes):
                    self.assertEqual(errors(self.check(file, "--profile", profile)), expected)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 0)

    def test_gmsh_files_with_elements_of_no_group(self):
        """Saved with SaveAll, a file of Gmsh has no groups at all; one element without a group beside others stops MFEM's reader."""
        file = gmsh_box(self.out / "a.msh", 2.2, True)
        gmsh.option.setNumber("Mesh.SaveAll", 1)
        gmsh.write(str(self.out / "all.msh"))
        gmsh.option.setNumber("Mesh.SaveAll", 0)
        self.assertIn("tag.not_positive", errors(self.check(self.out / "all.msh", "--profile", "palace")))
        lines = file.read_text().splitlines()
        first = next(i for i, line in enumerate(lines) if line.split()[1:3] == ["2", "2"])
        words = lines[first].split()
        lines[first] = " ".join(words[:3] + ["0"] + words[4:])
        file.write_text("\n".join(lines) + "\n")
        self.assertEqual(errors(self.check(file, "--profile", "palace")), ["face.untagged", "profile.palace.untagged_elements"])
        self.assertIn("profile.mfem.untagged_elements", errors(self.check(file, "--profile", "mfem")))

    def test_limits_of_gmsh_prisms(self):
        file, limits = gmsh_box(self.out / "a.msh", 2.2, True), self.out / "limits.json"
        limits.write_text('{"schema_version": 1, "min_face_angle_deg": 5, "max_height_growth": 1.01, "max_aspect_ratio": 10}')
        self.assertEqual(errors(self.check(file, "--limits", limits)), [])
        limits.write_text('{"schema_version": 1, "min_face_angle_deg": {"value": 89, "severity": "warning"}, "min_edge_m": 0.34}')
        done = self.check(file, "--limits", limits)
        self.assertEqual(done.returncode, 1)
        self.assertIn("limit.needle", codes(done))
        self.assertEqual(errors(done), ["limit.edge"])
        limits.write_text('{"schema_version": 1, "min_angel": 5}')
        done = self.check(file, "--limits", limits)
        self.assertEqual(done.returncode, 3)
        self.assertIn("min_angel", done.stderr)

    def test_netgen_tetrahedra(self):
        try:
            from netgen.csg import unit_cube
        except ImportError as missing:
            self.skipTest(str(missing))
        file = self.out / "netgen.msh"
        unit_cube.GenerateMesh(maxh=0.4).Export(str(file), "Gmsh2 Format")
        done = self.check(file)
        # Netgen counts corners the other way round: in Gmsh's order every tetrahedron of its file is inside out, and Gmsh says so too.
        self.assertEqual((done.returncode, errors(done)), (1, ["cell.inverted"]))
        report = json.loads(done.stdout)
        self.assertEqual(report["findings"][0]["count"], report["num_cells"])
        lines = []
        for line in file.read_text().splitlines():
            words = line.split()
            if len(words) in (8, 9) and words[1:3] in (["2", "2"], ["4", "2"]):
                words[-1], words[-2] = words[-2], words[-1]
            lines.append(" ".join(words))
        file.write_text("\n".join(lines) + "\n")
        done = self.check(file)
        self.assertEqual((done.returncode, errors(done)), (0, []), done.stdout)

    def meshio_box(self, n=3):
        axis = numpy.linspace(0, 1, n + 1)
        points = numpy.array([(x, y, z) for z in axis for y in axis for x in axis])
        node = lambda i, j, k: (k * (n + 1) + j) * (n + 1) + i
        wedges = []
        for k in range(n):
            for j in range(n):
                for i in range(n):
                    a, b, c, d = node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)
                    up = node(0, 0, 1)
                    wedges += [(a, b, c, a + up, b + up, c + up), (a, c, d, a + up, c + up, d + up)]
        return points, numpy.array(wedges)

    def write_meshio(self, points, wedges, file):
        tags = numpy.ones(len(wedges), dtype=int)
        mesh = meshio.Mesh(points, [("wedge", wedges)], cell_data={"gmsh:physical": [tags], "gmsh:geometrical": [tags]})
        meshio.write(file, mesh, file_format="gmsh22", binary=False)
        return self.check(file)

    def test_meshio_wedges_good_and_broken(self):
        points, wedges = self.meshio_box()
        done = self.write_meshio(points, wedges, self.out / "a.msh")
        self.assertEqual((done.returncode, errors(done)), (0, []), done.stdout)
        turned = wedges.copy()
        turned[20] = turned[20][[3, 4, 5, 0, 1, 2]]
        self.assertIn("cell.inverted", errors(self.write_meshio(points, turned, self.out / "b.msh")))
        moved = points.copy()
        moved[21] = moved[22] + (1e-12, 0, 0)
        self.assertIn("node.near_duplicate", errors(self.write_meshio(moved, wedges, self.out / "c.msh")))
        # Half of the mesh unconnected to the other half: neither Gmsh's check nor a solver that reads it complains of the holes.
        upper = wedges[len(wedges) // 3:] + len(points)
        cracked = self.write_meshio(numpy.vstack([points, points]), numpy.vstack([wedges[:len(wedges) // 3], upper]), self.out / "d.msh")
        self.assertIn("boundary.crack", errors(cracked))
        over = self.write_meshio(numpy.vstack([points, points + (0.13, 0.17, 0.11)]), numpy.vstack([wedges, wedges + len(points)]), self.out / "e.msh")
        self.assertIn("cell.overlap", errors(over))
        self.assertIn("boundary.crossing", errors(over))

    def test_an_element_that_gmsh_removed_inside(self):
        """Gmsh's own check says nothing about the hole."""
        gmsh_box(self.out / "a.msh", 2.2, True)
        solid = gmsh.model.getEntities(3)[0][1]
        kinds, elements, nodes = gmsh.model.mesh.getElements(3, solid)
        place = {tag: gmsh.model.mesh.getNode(tag)[0] for tag in set(nodes[0])}
        boundary = lambda p: any(abs(p[axis] - side) < 1e-9 for axis, sides in enumerate(((0, 4), (0, 2), (0, 1))) for side in sides)
        rows = nodes[0].reshape(-1, 6)
        inner = [i for i, row in enumerate(rows) if 1 / 3 - 1e-9 < min(place[t][2] for t in row) and max(place[t][2] for t in row) < 2 / 3 + 1e-9]
        self.assertTrue(inner)
        keep = [i for i in range(len(rows)) if i != inner[0]]
        inside, coordinates, _ = gmsh.model.mesh.getNodes(3, solid)
        gmsh.model.mesh.clear([(3, solid)])
        gmsh.model.mesh.addNodes(3, solid, inside, coordinates)
        gmsh.model.mesh.addElementsByType(solid, kinds[0], elements[0][keep], rows[keep].flatten())
        gmsh.write(str(self.out / "hole.msh"))
        self.assertIn("face.untagged", errors(self.check(self.out / "hole.msh")))


if __name__ == "__main__":
    unittest.main()
