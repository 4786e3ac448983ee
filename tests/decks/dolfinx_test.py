#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The dolfinx deck, run: against closed formulas, and against GetDP on the same elements, where two codes must agree to rounding."""
import json
import unittest

from program import run
from solver_cases import InFolder, cases, codes, require, solve

require(solve.has_dolfinx(), "dolfinx is not installed; scripts/setup installs it")

SECOND = {"DEGREE": "2"}


class Dolfinx(InFolder):
    def twin_of_getdp(self, case, *arguments, **more):
        """Port results of GetDP on the tetrahedral twin that twin.py cuts."""
        solved = case(self.out / "getdp", *arguments, **more)[0]
        solve.solve_twin(solved, "Driven")
        return self.port_results(solved)

    def port_results(self, solved):
        rows = [line.split() for line in (solved.folder / f"{solved.name}.ports.txt").read_text().splitlines() if line[0] != "#"]
        return {tuple(map(float, row[:3])): complex(float(row[3]), float(row[4])) for row in rows}

    def test_cavity(self):
        _, pairs = cases.cavity(self.out, 15, solver="dolfinx")
        self.assertEqual(len(pairs), 3)
        self.assertTrue(all(abs(found / wanted - 1) < 0.01 for found, wanted in pairs), pairs)
        _, pairs = cases.cavity(self.out, 20, solver="dolfinx", environment=SECOND)
        self.assertTrue(all(abs(found / wanted - 1) < 2e-4 for found, wanted in pairs), pairs)

    def test_capacitances_on_prisms(self):
        for mode in ("solid", "hollow", "sheet"):
            _, found, wanted = cases.plates(self.out, mode=mode, solver="dolfinx")
            self.assertAlmostEqual(found / wanted, 1, places=12, msg=mode)
        _, found, wanted = cases.coaxial_via(self.out, solver="dolfinx")
        self.assertLess(abs(found / wanted - 1), 0.01)
        _, tetrahedra, _ = cases.coaxial_via(self.out, solver="dolfinx", arguments=["--split", "tets"])
        self.assertNotEqual(tetrahedra, found)
        self.assertLess(abs(tetrahedra / found - 1), 0.005, "prisms and their tetrahedral twin agree")
        if solve.has_getdp():
            _, other, _ = cases.coaxial_via(self.out, solver="getdp")
            self.assertAlmostEqual(other / found, 1, places=9, msg="GetDP on the same prisms")

    @unittest.skipUnless(solve.has_getdp(), "getdp is not installed; scripts/setup installs it")
    def test_three_lines_in_every_code(self):
        """Fields that vary along both edges of a prism's wall, which plates and a barrel have not: too few points of integration show here alone."""
        for (pair, _), off in codes.three_lines(self.out, 0.035, 0.02).items():
            self.assertGreaterEqual(len(off), 4)
            for code, value in off.items():
                self.assertLess(abs(value), 0.03, (pair, code))
                for other, bound in codes.beside(code):
                    # Of this coarse mesh tetrahedra are 1 % off the prisms; the evidence refines until 0.5 % holds.
                    self.assertLess(abs(value - off[other]), 0.011 if bound > 1e-3 and "twin" in code else bound, (pair, code, other))

    def test_changes_of_the_study_change_the_result_as_they_must(self):
        self.expect_changes_of_the_study("dolfinx", SECOND)

    @unittest.skipUnless(solve.has_getdp(), "getdp is not installed; scripts/setup installs it")
    def test_agrees_with_getdp_on_every_surface_term(self):
        """Lossy skins, absorbing walls before layered media, ports inside; then a sheet, an impedance wall, a conducting filling."""
        wanted = self.twin_of_getdp(cases.via_transition, 0.8, 0.4, hz=(4e9,))
        solved, _ = cases.via_transition(self.out, 0.8, 0.4, hz=(4e9,), solver="dolfinx")
        found = self.port_results(solved)
        self.assertEqual(found.keys(), wanted.keys())
        for key, value in wanted.items():
            self.assertLess(abs(found[key] - value), 1e-8, key)
        def sheet(folder, solver="getdp"):
            board = cases.board("sheet", [("top", 0.035), ("core", 0.5, 4.1, 0.013), ("bottom", 0.035)], cases.rect(-2, -2, 12, 7), ["A", "GND"],
                                tracks=[{"layer": "top", "net": "A", "width": 1, "points": [[-1, 2], [11, 2]]}], planes=[{"layer": "bottom", "net": "GND"}])
            board["materials"][0]["sigma"] = 0.05
            study = cases.study("driven", 2, ports=[cases.port("p1", "A", "xmin", 47), cases.port("p2", "A", "xmax", 53)], sweep=[1e9, 2e9], region=[0, 0, 10, 4],
                                boundaries={"all": "absorbing", "xmin": "none", "xmax": "none", "ymin": "pec", "ymax": {"kind": "impedance", "ohms": 321}}, air=(1, 0),
                                conductors={"mode": "sheet", "surface": "lossy"})
            return [solve.solve(board, study, folder, solver)]
        wanted = self.twin_of_getdp(sheet)
        found = self.port_results(sheet(self.out, "dolfinx")[0])
        self.assertEqual(len(found), 8)
        for key, value in wanted.items():
            self.assertLess(abs(found[key] - value), 1e-8, key)

    def test_what_it_cannot_say_is_refused(self):
        board = cases.board("b", [("top", 0.035), ("core", 0.5, 4.0, 0.0), ("bottom", 0.035)], cases.rect(0, 0, 10, 5), ["A", "GND"],
                            planes=[{"layer": "top", "net": "A"}, {"layer": "bottom", "net": "GND"}])
        (self.out / "b.json").write_text(json.dumps(board))
        eigen = ["--for", "dolfinx", "--problem", "eigenmode", "--boundary"]
        for arguments, words in (([*eigen, "all=pec", "--split", "none"], ["edge elements", "--split tets", "getdp"]),
                                 ([*eigen, "all=pec", "--order", "2"], ["first order"]),
                                 ([*eigen, "all=absorbing"], ["absorbing", "driven"]),
                                 ([*eigen, "all=pec", "--to", "msh"], ["reads vtkhdf"])):
            done = run("mesh", self.out / "b.json", "--air", "0", "-o", self.out / "new/", *arguments)
            self.assertNotEqual(done.returncode, 0, arguments)
            for word in words:
                self.assertIn(word, done.stderr, arguments)
            self.assertFalse((self.out / "new").exists(), f"{arguments}: a folder for nothing")
        done = run("mesh", self.out / "b.json", "--air", "0", "-o", self.out / "new/", *eigen, "all=pec", "--dry-run")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertFalse((self.out / "new").exists(), "--dry-run makes no folder")


if __name__ == "__main__":
    unittest.main(verbosity=1)
