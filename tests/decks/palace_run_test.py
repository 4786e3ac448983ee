#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks for Palace, solved by Palace. Debian has no package: PALACE names its launcher (the program `palace` of its own
installation), else the test is skipped."""
import os
import subprocess
import unittest

from program import DATA, PROGRAM, ROOT, run
from solver_cases import InFolder, cases, exact, require, solve

require(solve.has_palace(), "PALACE does not name Palace's launcher, of which Debian has no package")
require(solve.has_getdp(), "getdp is not installed; scripts/setup installs it")


def by_palace(order=1):
    return {"solver": "palace", "environment": {"ORDER": str(order), "NP": "1"}}


def apart(one, other):
    """Largest difference of two S-matrices at the first frequency."""
    return max(abs(a - b) for rows in zip(one[0][1], other[0][1]) for a, b in zip(*rows))


class Palace(InFolder):
    def both(self, case, *arguments, **more):
        """S by Palace and by GetDP on the same prisms: the same lowest-order edge elements, so the same numbers."""
        return [case(self.out / name, *arguments, **more, **how)[1] for name, how in (("palace", by_palace()), ("getdp", {"solver": "getdp"}))]

    def test_capacitances(self):
        for mode in ("hollow", "sheet"):
            _, found, wanted = cases.plates(self.out, mode=mode, **by_palace())
            self.assertAlmostEqual(found / wanted, 1, places=7, msg=mode)
        _, found, wanted = cases.coaxial_via(self.out, 0.4, 0.1, **by_palace(2))
        self.assertLess(abs(found / wanted - 1), 0.002)

    def test_cavity(self):
        for order, bound in ((1, 0.02), (2, 1e-3)):
            _, pairs = cases.cavity(self.out, 20 if order == 1 else 30, mode="hollow", **by_palace(order))
            self.assertEqual(len(pairs), 3)
            for found, wanted in pairs:
                self.assertLess(abs(found / wanted - 1), bound, order)

    def test_quality_of_a_cavity_with_skins(self):
        """Field upright between two copper planes: Q is their distance over the skin depth. Every mode that was asked for is found."""
        made = solve.board("cavity", [("top", 1.0), ("space", 70, 1.0, 0.0), ("bottom", 1.0)], solve.rect(0, 0, 100, 90), ["LID", "GND"],
                           planes=[{"layer": "top", "net": "LID"}, {"layer": "bottom", "net": "GND"}])
        study = cases.study("eigenmode", 25, boundaries={"all": "pec"}, conductors={"mode": "hollow", "surface": "lossy"}, modes={"number": 3, "above": 2e9})
        solved = solve.solve(made, study, self.out, **by_palace())
        hz = solved.resonances_hz()
        self.assertEqual(len(hz), 3)
        self.assertLess(abs(solved.quality_factors()[0] * exact.skin_depth_m(hz[0], 5.8e7) / 0.07 - 1), 0.005)

    def test_line_of_plates(self):
        """Order two is far nearer on the same prisms; loss and ports of another impedance come through."""
        errors = []
        for order in (1, 2):
            _, s, wanted = cases.tem_line(self.out, 10, mode="hollow", **by_palace(order))
            errors.append(abs(s[1][0] - wanted[1]))
        self.assertLess(errors[1], errors[0] / 50, errors)
        _, s, wanted = cases.tem_line(self.out, 10, mode="hollow", tan_delta=0.05, ohm_factor=0.5, **by_palace(2))
        for found, closed in zip((s[0][0], s[1][0]), wanted):
            self.assertLess(abs(found - closed), 5e-3)

    def test_coaxial_ports(self):
        """Palace takes the radii of a ring from its corners, we take those of its area: 0.3 % of the surface impedance here."""
        found, wanted = self.both(lambda folder, **run: (None, [(0, cases.coaxial_line(folder, 0.5, **run)[1])]))
        self.assertLess(apart(found, wanted), 5e-3)

    def test_driven_agrees_with_getdp_on_the_same_prisms(self):
        self.assertLess(apart(*self.both(cases.via_transition, 0.8, 0.4, hz=(4e9,), tan_delta=0.0, ports_ohm=(30, 70))), 1e-8, "lossy skins, absorbing walls, unequal ports")
        self.assertLess(apart(*self.both(cases.via_transition, 0.8, 0.4, hz=(4e9,))), 1e-4, "Palace's absorbing walls leave the loss of what lies behind out")
        self.assertLess(apart(*self.both(cases.strip, "pec")), 1e-8, "ideal sheets inside")
        self.assertLess(apart(*self.both(cases.strip, "lossy", "hollow")), 1e-8, "lossy skins")
        self.assertLess(apart(*self.both(cases.strip, "lossy")), 2e-4, "Palace cuts lossy sheets: their two sides carry currents of their own")

    def test_wave_ports(self):
        """Ports that fill a closed cross-section: the mode that Palace solves for and the quasi-TEM mode of GetDP's deck."""
        walls = {"all": "none", "ymin": "pec", "ymax": "pec"}
        for mode, surface in (("hollow", "pec"), ("sheet", "pec"), ("hollow", "lossy"), ("sheet", "lossy")):
            found, wanted = self.both(lambda folder, **run: cases.strip(folder / mode / surface, surface, mode, "wave", walls, width=6, **run))
            self.assertLess(apart(found, wanted), 2e-3, (mode, surface))
            self.assertLess(abs(found[0][1][0][0]), 0.01, (mode, surface))

    def test_prisms_stay_prisms_and_second_order_meshes_are_read(self):
        """A sheet that is narrow beside its triangles: Palace would cut prisms into tetrahedra before it cuts the sheet."""
        board = ROOT / "examples/microstrip.json"
        region = ("--nets", "LINE", "--conductors", "sheet", "--port", "A,net=LINE,at=xmin", "--port", "B,net=LINE,at=xmax", "--region", "5mm,1mm,15mm,9mm",
                  "--boundary", "xmin=none", "--boundary", "xmax=none", "--sweep", "2GHz:2GHz:1", "--longest-edge", "2mm", "--policy", "none")
        found = {}
        for name, options in (("prisms", ()), ("curved", ("--order", "2"))):
            done = run("mesh", board, *region, *options, "--for", "palace", "-o", self.out / f"{name}.msh")
            self.assertEqual(done.returncode, 0, done.stderr)
            deck = self.out / f"{name}.palace.json"
            deck.write_text(deck.read_text().replace('"RefineCrackElements": false', '"RefineCrackElements": true'))
            solved = self.run_script(name)
            self.assertIn("Prism: P = 9", solved)
            self.assertNotIn("Tetrahedron", solved)
            found[name] = solve.Solved(self.out, name, {"counts": {"prisms": 0}}, "", 0).touchstone()
        self.assertLess(apart(found["prisms"], found["curved"]), 1e-5)

    def run_script(self, name):
        done = subprocess.run(["sh", str(self.out / f"{name}.run.sh")], capture_output=True, text=True, env={**os.environ, "PCBMESH": str(PROGRAM), **by_palace()["environment"]})
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr[-2000:])
        return done.stdout

    @unittest.skipUnless(DATA.is_dir(), "the real boards are not there")
    def test_a_line_of_a_real_board(self):
        """The amplifier's output on the HackRF One, by the study that `init` writes: what Palace finds is what GetDP finds."""
        board = next((DATA / "kicad").glob("11_hackrf_one_rf_4L_v6*"))
        found = {}
        for solver in ("palace", "getdp"):
            study, mesh = self.out / f"{solver}.study.json", self.out / f"{solver}.msh"
            self.assertEqual(run("init", board, "--nets", "/frontend/RX_AMP_OUT", "--margin", "0.3mm", "--for", solver, "--policy", "none", "-o", study).returncode, 0)
            done = run("mesh", board, "--study", study, "--sweep", "5GHz:5GHz:1", "-o", mesh)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.run_script(solver)
            found[solver] = solve.Solved(self.out, solver, {"counts": {"prisms": 0}}, "", 0).touchstone()
        self.assertLess(apart(found["palace"], found["getdp"]), 1e-8)


if __name__ == "__main__":
    unittest.main(verbosity=1)
