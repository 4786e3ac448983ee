#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The case of the paper in full: every window of docs/evidence/paper.md, measured anew, nothing written."""
import os
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(os.environ.get("PCBMESH_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
CASE = ROOT / "validation/cases/paper"
sys.path.insert(0, str(CASE))
sys.dont_write_bytecode = True
import beyond  # noqa: E402
import measurements as m  # noqa: E402


class Paper(unittest.TestCase):
    def assert_windows(self, windows, least):
        self.assertGreaterEqual(len(windows.rows), least)
        self.assertEqual([], windows.failures())

    def test_table_1(self):
        windows = m.Windows()
        m.table1_windows(windows, m.table1())
        self.assert_windows(windows, 5)
        self.assertEqual(m.table1(), m.table1(), "seeded")

    def test_tables_3_and_4_and_what_surpasses_them(self):
        windows, measured = m.Windows(), {}
        for example in m.EXAMPLES:
            measured[example] = m.cases(example)
            m.example_windows(windows, example, measured[example])
        beyond.targets(windows, measured)
        beyond.matched(windows, measured)
        beyond.compat_reports(windows, measured)
        self.assert_windows(windows, 80)

    def test_evidence_has_every_table(self):
        text = (ROOT / "docs/evidence/paper.md").read_text(encoding="utf-8")
        for heading in ("Table 1", "Figure 4", "Section 6.2, serpentine", "Section 6.2, via", "Table 3", "Table 4", "Beyond the paper", "Slips of the print"):
            self.assertIn(f"## {heading}", text)
        self.assertNotIn("**NO**", text)

    def test_wrong_use_is_refused(self):
        self.assertEqual(2, subprocess.run([m.MEASURE, "tablet"], capture_output=True).returncode)


if __name__ == "__main__":
    unittest.main()
