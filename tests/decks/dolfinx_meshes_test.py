#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Boxes that dolfinx makes and writes, as XDMF (HDF5 and text) with tags of cells and faces, and as VTU: pcbmesh check judges them, whole and damaged."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from program import SKIPPED, run

# Debian keeps one dolfinx per PETSc and chooses at start-up; the child below is started with the first there is.
PLACES = sorted(pathlib.Path("/usr/lib/petscdir").glob("petsc3*/*/lib/python3/dist-packages/dolfinx"))
if not PLACES:
    print("skipped: dolfinx is not installed (apt-get install python3-dolfinx-complex)")
    sys.exit(SKIPPED)

MAKE = """
import sys, numpy
from mpi4py import MPI
from dolfinx import mesh, io
for kind in (mesh.CellType.tetrahedron, mesh.CellType.hexahedron):
    box = mesh.create_box(MPI.COMM_WORLD, [[0, 0, 0], [2, 1, 0.5]], [4, 3, 2], kind)
    box.topology.create_connectivity(2, 3)
    faces = numpy.sort(mesh.exterior_facet_indices(box.topology))
    cells = numpy.arange(box.topology.index_map(3).size_local, dtype=numpy.int32)
    halves = mesh.locate_entities(box, 3, lambda x: x[0] <= 1 + 1e-9)
    values = numpy.full(len(cells), 8, dtype=numpy.int32)
    values[halves] = 7
    tags = {"bodies": mesh.meshtags(box, 3, cells, values), "sides": mesh.meshtags(box, 2, faces, numpy.full(len(faces), 5, dtype=numpy.int32))}
    for encoding in (io.XDMFFile.Encoding.HDF5, io.XDMFFile.Encoding.ASCII):
        with io.XDMFFile(MPI.COMM_WORLD, f"{sys.argv[1]}/{kind.name}_{encoding.name}.xdmf", "w", encoding=encoding) as file:
            file.write_mesh(box)
            for name, one in tags.items():
                one.name = name
                file.write_meshtags(one)
    with io.VTKFile(MPI.COMM_WORLD, f"{sys.argv[1]}/{kind.name}.pvd", "w") as file:
        file.write_mesh(box)
"""


class Boxes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        place = PLACES[0].parent
        done = subprocess.run(["/usr/bin/python3", "-c", MAKE, str(cls.out)], capture_output=True, text=True, timeout=300, cwd=cls.out,
                              env={**os.environ, "PETSC_DIR": str(place.parents[2]), "PYTHONPATH": str(place), "OMP_NUM_THREADS": "1",
                                   "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
        if done.returncode:
            cls.folder.cleanup()
            raise unittest.SkipTest(f"dolfinx does not run here: {done.stderr[-300:]}")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def check(self, file, *options):
        done = run("check", file, "--json", "--quiet", *options)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        report = json.loads(done.stdout)
        return report, {finding["code"]: finding for finding in report["findings"]}

    def test_xdmf_with_tags_is_good(self):
        for kind, cells, faces in (("tetrahedron", 144, 104), ("hexahedron", 24, 52)):
            for encoding in ("HDF5", "ASCII"):
                with self.subTest(kind=kind, encoding=encoding):
                    report, found = self.check(self.out / f"{kind}_{encoding}.xdmf")
                    self.assertEqual((report["num_cells"], report["num_faces"]), (cells, faces))
                    self.assertFalse([code for code, finding in found.items() if finding["severity"] == "error"], found)
                    # Values of the grid of tags came to the cells of the mesh.
                    volumes = {volume["tag"]: volume["volume"] for volume in report["volumes"]}
                    self.assertEqual(set(volumes), {7, 8})
                    self.assertAlmostEqual(volumes[7], 0.5)

    def test_cells_of_any_order_in_vtu(self):
        for kind, cells in (("tetrahedron", 144), ("hexahedron", 24)):
            report, found = self.check(self.out / f"{kind}_p0_000000.vtu")
            self.assertEqual(report["num_cells"], cells)
            self.assertEqual({code for code, finding in found.items() if finding["severity"] == "error"}, {"tag.not_positive"}, found)

    def test_damaged(self):
        text = (self.out / "tetrahedron_ASCII.xdmf").read_text()
        items = list(re.finditer(r"(<DataItem[^>]*>)([^<]*)(</DataItem>)", text))
        tetrahedra, points = items[0], items[1]

        def with_item(item, body):
            (self.out / "d.xdmf").write_text(text[:item.start(2)] + body + text[item.end(2):])
            return {code for code, finding in self.check(self.out / "d.xdmf")[1].items() if finding["severity"] == "error"}

        rows = tetrahedra[2].strip().splitlines()
        first = rows[0].split()
        # The tags find the cell all the same: its corners are the same ones.
        self.assertIn("cell.inverted", with_item(tetrahedra, "\n".join([" ".join([first[1], first[0], *first[2:]])] + rows[1:])))
        places = points[2].strip().splitlines()
        inner = next(i for i, row in enumerate(places) if [float(x) for x in row.split()[:2]] == [1.0, 1 / 3] and float(row.split()[2]) == 0.25)
        self.assertIn("cell.inverted", with_item(points, "\n".join(places[:inner] + ["1.9 0.33 0.25"] + places[inner + 1:])))


if __name__ == "__main__":
    unittest.main()
