#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks for Palace, solved by Palace. Debian has no package: PALACE names its launcher (the program `palace` of its own
installation), else the test is skipped."""
import cmath
import math
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

from program import ROOT, SKIPPED

sys.path.insert(0, str(ROOT / "validation/cases/solvers"))
if not (os.environ.get("PALACE") and shutil.which(os.environ["PALACE"])):
    print("skipped: PALACE does not name Palace's launcher, of which Debian has no package")
    sys.exit(SKIPPED)
try:
    import cases
    import exact
    import solve
except ImportError as missing:
    print(f"skipped: {missing}; scripts/setup installs it")
    sys.exit(SKIPPED)


def order(number):
    return {"ORDER": str(number), "NP": "1"}


class Palace(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_capacitances(self):
        for mode in ("hollow", "sheet"):
            _, found, wanted = cases.plates(self.out, mode=mode, solver="palace", environment=order(1))
            self.assertAlmostEqual(found / wanted, 1, places=6, msg=mode)
        _, found, wanted = cases.coaxial_via(self.out, solver="palace", environment=order(2))
        self.assertLess(abs(found / wanted - 1), 0.01)

    def test_cavity(self):
        for number, bound in ((1, 0.02), (2, 2e-4)):
            _, pairs = cases.cavity(self.out, 20, solver="palace", environment=order(number))
            self.assertEqual(len(pairs), 3)
            for found, wanted in pairs:
                self.assertLess(abs(found / wanted - 1), bound, number)

    def test_line_of_plates(self):
        """Order two is a hundred times nearer on the same prisms; loss and ports of another impedance come through."""
        errors = []
        for number in (1, 2):
            _, s, wanted = cases.tem_line(self.out, 10, solver="palace", environment=order(number))
            errors.append(abs(s[1][0] - wanted[1]))
        self.assertLess(errors[1], errors[0] / 100, errors)
        _, s, wanted = cases.tem_line(self.out, 10, tan_delta=0.05, ohm_factor=0.5, solver="palace", environment=order(2))
        for found, closed in zip((s[0][0], s[1][0]), wanted):
            self.assertLess(abs(found - closed), 5e-3)

    @unittest.skipUnless(solve.has_getdp(), "getdp is not installed; scripts/setup installs it")
    def test_driven_agrees_with_getdp_on_the_same_prisms(self):
        """Lossy skins, absorbing walls before layered media, ports inside: two codes, the same lowest-order edge elements."""
        _, wanted = cases.via_transition(self.out / "getdp", 0.8, 0.4, hz=(4e9,))
        _, found = cases.via_transition(self.out, 0.8, 0.4, hz=(4e9,), solver="palace", environment=order(1))
        for row in range(2):
            for column in range(2):
                self.assertLess(abs(found[0][1][row][column] - wanted[0][1][row][column]), 1e-6)


if __name__ == "__main__":
    unittest.main(verbosity=1)
