# SPDX-License-Identifier: GPL-3.0-or-later
"""The cases of validation/cases/solvers for the tests of decks, which end as skipped where a package is absent; a folder for each test."""
import pathlib
import sys
import tempfile
import unittest

from program import ROOT, SKIPPED

sys.path.insert(0, str(ROOT / "validation/cases/solvers"))


def require(holds, missing):
    """Ends the whole test as skipped, with a clear word, where what it is about is absent."""
    if not holds:
        print(f"skipped: {missing}")
        sys.exit(SKIPPED)


try:
    import cases  # noqa: F401
    import codes  # noqa: F401
    import exact  # noqa: F401
    import solve  # noqa: F401
except ImportError as absent:
    require(False, f"{absent}; scripts/setup installs it")


class InFolder(unittest.TestCase):
    """Each test has a folder of its own, self.out."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def expect_changes_of_the_study(self, solver, environment):
        """Loss tangent, port impedance, one boundary: each reaches the solver and does what the formula says."""
        def line(**more):
            _, s, wanted = cases.tem_line(self.out, 10, hz=1e9, solver=solver, environment=environment, **more)
            return s, wanted

        s, wanted = line()
        self.assertLess(abs(s[1][0] - wanted[1]), 1e-3)
        lossy, wanted = line(tan_delta=0.05)
        self.assertLess(abs(lossy[1][0] - wanted[1]), 1e-3)
        self.assertLess(abs(lossy[1][0]), 0.91)
        mismatched, wanted = line(ohm_factor=2)
        self.assertLess(abs(mismatched[0][0] - wanted[0]), 1e-3)
        self.assertGreater(abs(mismatched[0][0]), 0.2)
        walled, _ = line(boundaries={"all": "none", "ymin": "pec", "ymax": "pec"})
        self.assertLess(abs(walled[1][0]), 1e-3)
