#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks for Elmer, solved by Elmer. Debian has no package: with ElmerGrid and ElmerSolver on the path they run, else the test is skipped."""
import math
import pathlib
import shutil
import sys
import tempfile
import unittest

from program import ROOT, SKIPPED

sys.path.insert(0, str(ROOT / "validation/cases/solvers"))
if not (shutil.which("ElmerSolver") and shutil.which("ElmerGrid")):
    print("skipped: ElmerGrid and ElmerSolver are not on the path, and Debian has no package of them")
    sys.exit(SKIPPED)
try:
    import cases
    import exact
    import solve
except ImportError as missing:
    print(f"skipped: {missing}; scripts/setup installs it")
    sys.exit(SKIPPED)


class Elmer(unittest.TestCase):
    """Elmer writes files of its own: what a case makes of GetDP's is not there, so they are read here."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def numbers(self, case, *arguments, result, **more):
        def hollow(board, study, folder, **run):
            study["conductors"] = {"mode": "hollow", "surface": "pec"}  # it refuses solid copper
            return solve.solve(board, study, folder, "elmer")
        plain, cases.solve = cases.solve, hollow
        try:
            case(self.out, *arguments, **more)
        except (FileNotFoundError, StopIteration):
            pass
        finally:
            cases.solve = plain
        return [float(word) for word in (self.out / result).read_text().split()]

    def test_capacitances(self):
        found = self.numbers(cases.plates, result="plates.capacitance.dat")
        self.assertAlmostEqual(found[1] / (exact.EPS0 * 50e-6 / (0.3e-3 / 4.4 + 0.2e-3 / 3.0)), 1, places=6)
        found = self.numbers(cases.coaxial_via, result="coaxial.capacitance.dat")
        self.assertLess(abs(found[0] / (exact.coaxial_farad_per_m(0.2e-3, 1e-3, 1.0) * 4.1e-3) - 1), 0.01)

    def test_cavity(self):
        wanted = exact.cavity_hz([0.1, 0.09, 0.07])
        for found, closed in zip(sorted(self.numbers(cases.cavity, 20, result="cavity.modes.dat"))[:3], wanted):
            self.assertLess(abs(found / closed - 1), 0.005)

    def test_driven_line(self):
        """Time is exp(-i omega t) there; fields are averaged over nodes before they are integrated, so the port is rougher than GetDP's."""
        re1, im1, re2, im2 = self.numbers(cases.tem_line, 5, result="line.port1.dat")[:4]
        through = complex(re2, -im2) / 0.02
        delay = -math.tau * 3e9 * 2 * 0.1 / exact.LIGHT
        self.assertLess(abs(through - complex(math.cos(delay), math.sin(delay))), 0.03)
        self.assertLess(abs(complex(re1, im1) / 0.02 - 1), 0.03)


if __name__ == "__main__":
    unittest.main(verbosity=1)
