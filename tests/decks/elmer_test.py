#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks for Elmer, solved by Elmer. Debian has no package: with ElmerGrid and ElmerSolver on the path they run, else the test is skipped."""
import math
import shutil
import unittest

from solver_cases import InFolder, cases, exact, require, solve

require(shutil.which("ElmerSolver") and shutil.which("ElmerGrid"), "ElmerGrid and ElmerSolver are not on the path, and Debian has no package of them")


class Elmer(InFolder):
    """Elmer writes files of its own: what a case makes of GetDP's is not there, so they are read here."""

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
        near, through = self.line(hz=3e9)
        delay = -math.tau * 3e9 * 2 * 0.1 / exact.LIGHT
        self.assertLess(abs(through - complex(math.cos(delay), math.sin(delay))), 0.03)
        self.assertLess(abs(near - 1), 0.03)

    def line(self, **more):
        """Voltages of the fed and of the other port, for a wave of 1 V inwards."""
        re1, im1, re2, im2 = self.numbers(cases.tem_line, 5, result="line.port1.dat", **more)[:4]
        return complex(re1, -im1) / 0.02, complex(re2, -im2) / 0.02

    def test_changes_of_the_study_change_the_result_as_they_must(self):
        """Loss tangent, port impedance, one boundary: each reaches the solver and does what the formula says."""
        ohm, wave_number = exact.ETA0 / 4, math.tau * 1e9 / exact.LIGHT * 2
        _, plain = self.line(hz=1e9)
        self.assertLess(abs(plain - exact.line_s(ohm, 1j * wave_number, 0.1, ohm)[1]), 0.03)
        _, lossy = self.line(hz=1e9, tan_delta=0.05)
        self.assertLess(abs(abs(lossy) - math.exp(-wave_number * 0.1 * 0.025)), 0.03)
        near, through = self.line(hz=1e9, ohm_factor=2)
        wanted = exact.line_s(ohm, 1j * wave_number, 0.1, 2 * ohm)
        self.assertGreater(abs(wanted[0]), 0.2)
        self.assertLess(abs(near - 1 - wanted[0]), 0.05)
        self.assertLess(abs(through - wanted[1]), 0.05)
        _, walled = self.line(hz=1e9, boundaries={"all": "none", "ymin": "pec", "ymax": "pec"})
        self.assertLess(abs(walled), 0.03)


if __name__ == "__main__":
    unittest.main(verbosity=1)
