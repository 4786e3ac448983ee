#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The visible skin against VTK's: the same numbers of faces, for the whole mesh, without air, and of every layer on its own."""
import sys
import tempfile
import unittest
from pathlib import Path

from program import ROOT, SKIPPED, run, run_json

try:
    import vtk
except ImportError:
    print("skipped: python3-paraview is not installed")
    sys.exit(SKIPPED)


def surface(grid):
    """(triangles, quadrilaterals) of the cells' outer faces."""
    surface_filter = vtk.vtkDataSetSurfaceFilter()
    surface_filter.SetDelegation(False)
    surface_filter.SetInputData(grid)
    surface_filter.Update()
    out = surface_filter.GetOutput()
    counts = {vtk.VTK_TRIANGLE: 0, vtk.VTK_QUAD: 0}
    for i in range(out.GetNumberOfCells()):
        counts[out.GetCellType(i)] += 1
    return counts[vtk.VTK_TRIANGLE], counts[vtk.VTK_QUAD]


def threshold(grid, array, low, high):
    f = vtk.vtkThreshold()
    f.SetInputData(grid)
    f.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, array)
    f.SetThresholdFunction(vtk.vtkThreshold.THRESHOLD_BETWEEN)
    f.SetLowerThreshold(low)
    f.SetUpperThreshold(high)
    f.Update()
    return f.GetOutput()


class SkinAgainstVtk(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name)

    def read(self, board, *options):
        done = run("mesh", board, *options, "--no-check", "-o", self.out / "m.vtu", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(self.out / "m.vtu"))
        reader.Update()
        return reader.GetOutput()

    def skin(self, board, *options):
        done = run_json("render", board, *options, "--size", "64x64", "-o", self.out / "m.png")
        return done["visible_triangles"], done["visible_quads"]

    def compare(self, board, *options):
        grid = self.read(board, *options)
        self.assertEqual(self.skin(board, *options, "--show-air"), surface(grid), "whole mesh")
        layers = grid.GetCellData().GetArray("layer")
        low, high = (int(v) for v in layers.GetRange())
        per_layer = [surface(threshold(grid, "layer", k, k)) for k in range(low, high + 1)]
        self.assertEqual(self.skin(board, *options, "--show-air", "--explode", "1"), tuple(map(sum, zip(*per_layer))), "every layer")
        return grid

    def test_via(self):
        self.compare(ROOT / "examples/via.json", "--air", "0", "--policy", "average")

    def test_serpentine(self):
        self.compare(ROOT / "examples/serpentine.json", "--air", "0", "--policy", "minimum", "--sublayers", "floor")

    def test_hollow_conductors_and_air(self):
        board, options = ROOT / "examples/microstrip.json", ("--conductors", "hollow", "--air", "1mm")
        grid = self.compare(board, *options)
        # One material alone: hide the others by name. Material numbers are those of tags.json.
        import json
        tags = json.loads((self.out / "m.tags.json").read_text())
        names = [m["name"] for m in tags["materials"]]
        solid = sorted({v["material"] for v in tags["volumes"]})
        for name in solid:
            k = names.index(name)
            hidden = [h for other in solid if other != name for h in ("--hide", other)]
            self.assertEqual(self.skin(board, *options, "--show-air", *hidden), surface(threshold(grid, "material", k, k)), name)


if __name__ == "__main__":
    unittest.main()
