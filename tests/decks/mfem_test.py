#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes and decks for MFEM, loaded and solved by MFEM itself. Debian has no package: MFEM_DIR names a build of MFEM 4.7 or
later (a driven sweep needs one with SuiteSparse), else the test is skipped."""
import json
import os
import pathlib
import subprocess
import unittest

from program import ROOT, run
from solver_cases import InFolder, cases, require, solve

require(os.environ.get("MFEM_DIR"), "MFEM_DIR is not set to a build of MFEM, of which Debian has no package")

LOADER = """#include <iostream>
#include "mfem.hpp"
int main(int, char** argv) {
  mfem::Mesh mesh(argv[1], 1, 0);
  double volume = 0;
  for (int e = 0; e < mesh.GetNE(); ++e) volume += mesh.GetElementVolume(e);
  std::cout.precision(15);
  std::cout << mesh.GetNE() << " " << mesh.GetNBE() << " " << volume << " " << mesh.CheckElementOrientation(false) << " "
            << mesh.attribute_sets.GetAttributeSetNames().size() << " " << mesh.bdr_attribute_sets.GetAttributeSetNames().size() << "\\n";
}
"""


class Mfem(InFolder):
    def test_both_versions_of_the_mesh_load(self):
        (self.out / "load.cpp").write_text(LOADER)
        config = next(c for c in (pathlib.Path(os.environ["MFEM_DIR"]) / sub / "config.mk" for sub in ("config", "share/mfem")) if c.exists())
        subprocess.run(["make", "-s", "-f", "-", "all"], input=f"include {config}\nall:\n\t$(MFEM_CXX) $(MFEM_FLAGS) load.cpp -o load $(MFEM_LIBS)\n", text=True, cwd=self.out, check=True)
        board = ROOT / "examples/microstrip.json"
        loaded = []
        for version in ("1.3", "1.0"):
            done = run("mesh", board, "--mfem-version", version, "-o", self.out / "m.mesh", "--longest-edge", "4mm")
            self.assertEqual(done.returncode, 0, done.stderr)
            loaded.append(subprocess.run([self.out / "load", self.out / "m.mesh"], capture_output=True, text=True, check=True).stdout.split())
        report = json.loads((self.out / "m.report.json").read_text())
        tags = json.loads((self.out / "m.tags.json").read_text())
        for words in loaded:
            self.assertEqual(int(words[0]), report["counts"]["prisms"])
            self.assertEqual(int(words[3]), 0, "no element is inverted")
        self.assertEqual(loaded[0][:4], loaded[1][:4])
        self.assertEqual((int(loaded[0][4]), int(loaded[0][5])), (len(tags["volumes"]), len(tags["faces"])), "named sets of 1.3")
        self.assertEqual(loaded[1][4:], ["0", "0"], "1.0 has none")

    def test_capacitances(self):
        for mode in ("solid", "hollow", "sheet"):
            _, found, wanted = cases.plates(self.out, mode=mode, solver="mfem")
            self.assertAlmostEqual(found / wanted, 1, places=12, msg=mode)
        _, found, wanted = cases.coaxial_via(self.out, solver="mfem")
        self.assertLess(abs(found / wanted - 1), 0.01)

    @unittest.skipUnless(solve.has_getdp(), "getdp is not installed; scripts/setup installs it")
    def test_resonances_agree_with_getdp_on_the_same_elements(self):
        """Prisms, then their tetrahedral twin: two codes and two eigenvalue solvers, the same lowest-order edge elements."""
        wanted, _ = cases.cavity(self.out / "getdp", 20)
        for arguments in ((), ("--split", "tets")):
            if arguments:
                solve.solve_twin(wanted, "Resonances")
            found, pairs = cases.cavity(self.out, 20, solver="mfem", arguments=arguments)
            self.assertEqual(len(pairs), 3)
            for a, b in zip(found.resonances_hz()[:3], wanted.resonances_hz()[:3]):
                self.assertLess(abs(a / b - 1), 1e-8, arguments)
        _, k_squared = cases.box_cavity(self.out, 8, solver="mfem")
        self.assertEqual(f"{k_squared:.4f}", "22.8166")
        _, pairs = cases.cavity(self.out, 20, solver="mfem", environment={"ORDER": "2"})
        self.assertTrue(all(abs(found / closed - 1) < 2e-4 for found, closed in pairs), pairs)

    def test_quality_of_a_filled_cavity(self):
        """A dielectric's own loss: Q is one over its loss tangent, whatever the mode."""
        board = cases.board("filled", [("top", 1.0), ("space", 70, 4.0, 0.02), ("bottom", 1.0)], cases.rect(0, 0, 100, 90), ["LID", "GND"],
                            planes=[{"layer": "top", "net": "LID"}, {"layer": "bottom", "net": "GND"}])
        study = cases.study("eigenmode", 30, boundaries={"all": "pec"}, modes={"number": 2, "above": 1e9})
        solved = solve.solve(board, study, self.out, "mfem")
        columns = (self.out / "filled.modes.txt").read_text().split("# ")[1:]
        stored, lost = ([float(line.split()[1]) for line in column.splitlines()[1:]] for column in columns[1:])
        self.assertEqual(len(stored), 2)
        self.assertTrue(all(abs(s / l - 50) < 1e-6 for s, l in zip(stored, lost)), (stored, lost))
        self.assertTrue(all(f > 1e9 for f in solved.resonances_hz()))

    def test_changes_of_the_study_change_the_result_as_they_must(self):
        self.expect_changes_of_the_study("mfem", {"ORDER": "2"})

    @unittest.skipUnless(solve.has_getdp(), "getdp is not installed; scripts/setup installs it")
    def test_driven_agrees_with_getdp_on_the_same_prisms(self):
        """Lossy skins, absorbing walls before layered media, ports inside: two codes, the same lowest-order edge elements."""
        _, wanted = cases.via_transition(self.out / "getdp", 0.8, 0.4, hz=(4e9,))
        _, found = cases.via_transition(self.out, 0.8, 0.4, hz=(4e9,), solver="mfem")
        for row in range(2):
            for column in range(2):
                self.assertLess(abs(found[0][1][row][column] - wanted[0][1][row][column]), 1e-9)

    def test_second_order_on_prisms(self):
        errors = []
        for order in ("1", "2"):
            _, s, wanted = cases.tem_line(self.out, 10, solver="mfem", environment={"ORDER": order})
            errors.append(abs(s[1][0] - wanted[1]))
        self.assertLess(errors[1], errors[0] / 100, errors)


if __name__ == "__main__":
    unittest.main(verbosity=1)
