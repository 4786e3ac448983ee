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
