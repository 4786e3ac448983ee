#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Decks that run: native boards through pcbmesh to GetDP and back to numbers, judged by closed formulas. The short form of
validation/cases/solvers."""
import cmath
import json
import math
import os
import re
import shlex
import subprocess
import unittest

from program import PROGRAM, ROOT, run
from solver_cases import InFolder, cases, exact, require, solve

require(solve.has_getdp(), "getdp is not installed; scripts/setup installs it")


class Solvers(InFolder):
    def test_cavity_converges_to_the_closed_formula(self):
        errors = []
        for edge in (30, 15):
            _, pairs = cases.cavity(self.out, edge)
            errors.append([found / wanted - 1 for found, wanted in pairs])
        self.assertEqual(len(errors[1]), 3)
        self.assertTrue(all(0 < e < 0.01 for e in errors[1]), errors)
        self.assertTrue(all(coarse / fine > 3 for coarse, fine in zip(*errors)), errors)

    def test_cavity_of_bricks_has_the_digits_of_an_independent_code(self):
        """k0^2 of the first mode as noted for such bricks of another mesh generator."""
        for bricks, wanted in ((4, 25.145), (8, 22.8166)):
            solved, found = cases.box_cavity(self.out, bricks)
            self.assertEqual(solved.prisms, 2 * bricks ** 3)
            self.assertEqual(f"{found:.{len(str(wanted).split('.')[1])}f}", str(wanted))

    def test_tem_line_converges_with_the_square_of_the_edge(self):
        errors = []
        for edge in (10, 5, 2.5):
            _, s, wanted = cases.tem_line(self.out, edge)
            errors.append(abs(s[1][0] - wanted[1]))
        self.assertGreater(errors[0] / errors[1], 3.4, errors)
        self.assertGreater(errors[1] / errors[2], 3.6, errors)
        self.assertLess(errors[2], 0.02, errors)

    def test_changes_of_the_study_change_the_result_as_they_must(self):
        """Loss tangent, port impedance, one boundary: each reaches the solver and does what the formula says."""
        _, s, wanted = cases.tem_line(self.out, 2.5, hz=1e9)
        self.assertLess(abs(s[1][0] - wanted[1]), 2e-3)
        _, lossy, wanted = cases.tem_line(self.out, 2.5, hz=1e9, tan_delta=0.05)
        self.assertLess(abs(lossy[1][0] - wanted[1]), 2e-3)
        self.assertLess(abs(lossy[1][0]), 0.91)
        _, mismatched, wanted = cases.tem_line(self.out, 2.5, hz=1e9, ohm_factor=2)
        self.assertLess(abs(mismatched[0][0] - wanted[0]), 5e-3)
        self.assertGreater(abs(mismatched[0][0]), 0.2)
        # Electric side walls instead of magnetic ones: a waveguide far below its cut-off.
        _, walled, _ = cases.tem_line(self.out, 5, hz=1e9, boundaries={"all": "none", "ymin": "pec", "ymax": "pec"})
        self.assertLess(abs(walled[1][0]), 1e-3)

    def test_capacitances(self):
        for mode in ("solid", "hollow", "sheet"):
            _, found, wanted = cases.plates(self.out, mode=mode)
            self.assertAlmostEqual(found / wanted, 1, places=12, msg=mode)
        solved, found, wanted = cases.coaxial_via(self.out)
        self.assertLess(abs(found / wanted - 1), 0.01)
        twin = solve.solve_twin(solved, "Capacitance").capacitance()["SIG", "SIG"]
        self.assertLess(abs(twin / found - 1), 0.005, "prisms and their tetrahedral twin agree")

    def test_coaxial_ports_feed_a_coaxial_line(self):
        """Two rings at the ends of a barrel in a round shield: amplitude, phase and sign of what arrives, and of what comes back."""
        errors = []
        for edge in (0.4, 0.2):
            _, s, wanted = cases.coaxial_line(self.out, edge)
            errors.append(abs(s[1][0] - wanted[1]) + abs(s[0][0] - wanted[0]))
        self.assertLess(errors[0], 0.05, errors)
        self.assertLess(errors[1], 0.6 * errors[0], errors)
        _, s, wanted = cases.coaxial_line(self.out, 0.2, ohm_factor=2)
        self.assertGreater(abs(s[0][0]), 0.5)
        self.assertLess(abs(s[0][0] - wanted[0]), 0.01)
        self.assertLess(abs(s[1][0] - wanted[1]), 0.01)

    def test_wave_ports_take_the_mode_and_nothing_else(self):
        """A lossless microstrip: the electric and the magnetic profile of its mode differ, and a port that took one for the other would lose 5 % of the power."""
        solved, ((_, s),) = cases.guided(self.out, "microstrip", 1.0, 0.3, hz=[5e9], length=3, air=2.5)
        ohm, effective = exact.microstrip(1.1e-3, 0.508e-3, 3.66)
        self.assertLess(abs(solved.port_impedances()[0] / ohm - 1), 0.03)
        self.assertLess(abs(1 - abs(s[0][0]) ** 2 - abs(s[1][0]) ** 2), 1e-9)
        self.assertLess(abs(s[0][0]), 0.005)
        delay = -cmath.phase(s[1][0]) / (2 * math.pi * 5e9 * 3e-3) * exact.LIGHT
        self.assertLess(abs(delay / math.sqrt(effective) - 1), 0.02)
        _, ((_, mixed),) = cases.guided(self.out, "microstrip", 1.0, 0.3, hz=[5e9], length=3, air=2.5, kinds=("wave", "lumped"))
        self.assertLess(abs(mixed[0][1] - mixed[1][0]), 1e-6)
        self.assertLess(max(abs(mixed[0][0]), abs(mixed[1][1])), 0.3)

    def test_via_transition_is_passive_and_reciprocal(self):
        _, sweep = cases.via_transition(self.out, hz=(4e9,))
        s = sweep[0][1]
        self.assertLess(abs(s[0][1] - s[1][0]), 1e-6)
        for column in range(2):
            self.assertLessEqual(sum(abs(s[row][column]) ** 2 for row in range(2)), 1)

    def test_what_a_solver_cannot_say_is_refused_before_a_mesh_is_written(self):
        board = cases.board("b", [("top", 0.035), ("core", 0.5, 4.0, 0.0), ("bottom", 0.035)], cases.rect(0, 0, 10, 5), ["A", "GND"],
                            planes=[{"layer": "top", "net": "A"}, {"layer": "bottom", "net": "GND"}])
        file = self.out / "b.json"
        file.write_text(json.dumps(board))
        for arguments, words in ((["--for", "palace", "--problem", "electrostatic"], ["solid copper", "hollow"]),
                                 (["--for", "getdp", "--boundary", "all=none"], ["port", "frequencies"]),
                                 (["--for", "getdp", "--problem", "eigenmode", "--boundary", "all=absorbing"], ["absorbing", "driven"]),
                                 (["--for", "dolfinx", "--problem", "eigenmode", "--split", "none"], ["edge elements", "--split tets", "getdp"]),
                                 (["--for", "mfem", "--problem", "eigenmode", "--to", "mfem", "--boundary", "all=absorbing"], ["absorbing", "driven sweep"]),
                                 (["--for", "getdp", "--problem", "eigenmode", "--order", "2"], ["first order"])):
            done = run("mesh", file, "--air", "0", "-o", self.out / ("x.vtkhdf" if "dolfinx" in arguments else "x.msh"), *arguments)
            self.assertNotEqual(done.returncode, 0, arguments)
            for word in words:
                self.assertIn(word, done.stderr, arguments)
            self.assertEqual([p.name for p in self.out.glob("x*")], [], arguments)

    def test_what_palace_prints_becomes_the_tables_of_the_other_decks(self):
        """Files that Palace 0.17 left, read by the run script with `true` in Palace's place."""
        board = cases.board("b", [("top", 0.035), ("core", 1, 1.0, 0.0), ("bottom", 0.035)], cases.rect(-2, -2, 12, 6), ["A", "it's B"],
                            planes=[{"layer": "top", "net": "A"}, {"layer": "bottom", "net": "it's B"}])
        driven = {"problem": "driven", "ports": [cases.port("p 1", "A", "xmin", 50, "it's B"), cases.port("p2", "A", "xmax", 200, "it's B")], "sweep": {"list": [3e9]}}
        (self.out / "b.json").write_text(json.dumps(board))
        for problem, file, lines, result in (
                (driven, "port-S.csv", ["f (GHz), |S[1][1]| (dB), arg(S[1][1]) (deg.), |S[2][1]| (dB), arg(S[2][1]) (deg.), |S[1][2]| (dB), arg(S[1][2]) (deg.), |S[2][2]| (dB), arg(S[2][2]) (deg.)",
                                        " 3.00000000e+00, -inf, +0.0, -6.020599913280e+00, +9.000000000000e+01, -6.020599913280e+00, +9.000000000000e+01, -2.000000000000e+01, -1.800000000000e+02"], "b.ports.txt"),
                ({"problem": "eigenmode"}, "eig.csv", ["m, Re{f} (GHz), Im{f} (GHz), Q, Error (Bkwd.), Error (Abs.)", " 1.00e+00, +2.277713923816e+00, +1.138828491907e-02, +1.000037498984e+02, +5.1e-14, +7.5e-12"], "b.modes.txt"),
                ({"problem": "electrostatic"}, "terminal-C.csv", ["i, C[i][1] (F), C[i][2] (F)", " 1.00e+00, +2.5e-12, -2.25e-12", " 2.00e+00, -2.25e-12, +3.5e-12"], "b.capacitance.txt")):
            (self.out / "s.json").write_text(json.dumps({"schema_version": 1, "region": {"kind": "box", "box": {"min": [0, 0], "max": [10, 4]}}, "air": {"above": 0, "below": 0, "around": 0},
                                                         "conductors": {"mode": "hollow", "surface": "pec"}, "boundaries": {"all": "none"}, **problem}))
            done = run("mesh", self.out / "b.json", "--study", self.out / "s.json", "--for", "palace", "-o", self.out / "b.msh")
            self.assertEqual(done.returncode, 0, done.stderr)
            (self.out / "postpro/b").mkdir(parents=True, exist_ok=True)
            (self.out / "postpro/b" / file).write_text("\n".join(lines) + "\n")
            done = subprocess.run(["sh", self.out / "b.run.sh"], capture_output=True, text=True, env={**os.environ, "PALACE": "true", "ORDER": "3", "PCBMESH": str(PROGRAM)})
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            self.assertEqual(json.loads((self.out / "b.order.palace.json").read_text())["Solver"]["Order"], 3)
            rows = [line.split() for line in (self.out / result).read_text().splitlines() if not line.startswith("#")]
            if file == "port-S.csv":
                self.assertEqual([row[:3] for row in rows], [["3000000000", *pair] for pair in ("11", "12", "21", "22")], "frequency, excited, observed")
                for row, wanted in zip(rows, (0, 1j, 0.25j, -0.1)):  # powers turned into waves of 1 V into 50 and 200 ohm
                    self.assertAlmostEqual(complex(float(row[3]), float(row[4])), wanted, places=11)
                self.assertIn("# port 2 200 p2", (self.out / result).read_text())
            elif file == "eig.csv":
                self.assertEqual(rows, [["0", "2277713923.816"], ["0", "100.0037498984"]])
            else:
                self.assertEqual(rows, [["1", "1", "2.5e-12"], ["1", "2", "-2.25e-12"], ["2", "2", "3.5e-12"]])
                self.assertIn("# net 2 it's B\n", (self.out / result).read_text())

    def test_copper_that_floats_without_a_body_is_refused(self):
        """A skin or sheet without a net has no condition that any of these solvers knows: it would be as if it were not there."""
        board = cases.board("b", [("top", 0.035), ("upper", 0.5, 4.0, 0.0), ("mid", 0.035), ("lower", 0.5, 4.0, 0.0), ("bottom", 0.035)], cases.rect(0, 0, 10, 5), ["A", "GND"],
                            tracks=[{"layer": "mid", "width": 1, "points": [[2, 2], [8, 2]]}], planes=[{"layer": "top", "net": "A"}, {"layer": "bottom", "net": "GND"}])
        file = self.out / "b.json"
        file.write_text(json.dumps(board))
        for solver in ("palace", "elmer", "getdp", "mfem", "dolfinx"):
            for mode in ("hollow", "sheet"):
                out = self.out / f"{solver}_{mode}"
                done = run("mesh", file, "--air", "0", "--for", solver, "--problem", "electrostatic", "--conductors", mode, "-o", out)
                self.assertEqual((done.returncode, "error 703" in done.stderr), (5, True), done.stderr)
                for words in (f"{mode} copper without a net, '{'sheet' if mode == 'sheet' else 'surface'}|none', which floats", "solid copper"):
                    self.assertIn(words, done.stderr)
                self.assertEqual(list(out.glob("*")), [])

    def test_palace_elmer_mfem_and_dolfinx_hold_everything_of_the_study(self):
        board = cases.board("b", [("top", 0.035), ("core", 0.5, 4.1, 0.013), ("bottom", 0.035)], cases.rect(-2, -2, 12, 7), ["A", "GND"],
                            tracks=[{"layer": "top", "net": "A", "width": 1, "points": [[-1, 2], [11, 2]]}], planes=[{"layer": "bottom", "net": "GND"}])
        study = cases.study("driven", 2, ports=[cases.port("p1", "A", "xmin", 47), cases.port("p2", "A", "xmax", 53)], sweep=[1e9, 2e9], region=[0, 0, 10, 4],
                            boundaries={"all": "absorbing", "ymin": "pec", "ymax": {"kind": "impedance", "ohms": 321}}, air=(1, 0), conductors={"mode": "hollow", "surface": "lossy"})
        import jsonschema
        (self.out / "s.json").write_text(json.dumps(study))
        for solver in ("palace", "elmer", "mfem", "dolfinx"):
            ring = {"name": "C", "net": "A", "at": {"point": [5, 2], "layer": "bottom"}, "shape": "coaxial"}
            holed = {**board, "vias": [{"at": [5, 2], "drill": 0.4, "net": "A"}]}
            (self.out / "b.json").write_text(json.dumps(holed))
            (self.out / "ring.json").write_text(json.dumps({**study, "ports": [ring]}))
            done = run("mesh", self.out / "b.json", "--study", self.out / "ring.json", "--for", solver, "-o", self.out / f"ring_{solver}")
            if solver != "palace":
                self.assertIn("coaxial port 'C'", done.stderr)
                self.assertNotEqual(done.returncode, 0)
                continue
            self.assertEqual(done.returncode, 0, done.stderr)
            deck = json.loads((self.out / "ring_palace/b.palace.json").read_text())
            self.assertEqual(deck["Boundaries"]["LumpedPort"][0]["Direction"], "-R")
            jsonschema.Draft7Validator(json.loads((ROOT / "tests/decks/palace.schema.json").read_text())).validate(deck)
            done = run("check", self.out / "ring_palace/b.msh", "--profile", "palace")
            self.assertEqual(done.returncode, 0, done.stdout)
        (self.out / "b.json").write_text(json.dumps(board))
        for solver in ("palace", "elmer", "mfem", "dolfinx"):
            done = run("mesh", self.out / "b.json", "--study", self.out / "s.json", "--for", solver, "-o", self.out / solver)
            self.assertEqual(done.returncode, 0, done.stderr)
        deck = json.loads((self.out / "palace/b.palace.json").read_text())
        tags = {f["name"]: f["id"] for f in json.loads((self.out / "palace/b.tags.json").read_text())["faces"]}
        jsonschema.Draft7Validator(json.loads((ROOT / "tests/decks/palace.schema.json").read_text())).validate(deck)
        boundaries = deck["Boundaries"]
        self.assertNotIn("WavePortPEC", boundaries)
        self.assertEqual(deck["Model"]["L0"], 1.0)
        self.assertFalse(deck["Model"]["RefineCrackElements"])
        self.assertLessEqual(deck["Solver"]["Linear"]["Tol"], 1e-10, "or the network is not reciprocal to 1e-6")
        self.assertEqual(deck["Solver"]["Driven"]["Samples"], [{"Type": "Point", "Freq": [1.0, 2.0]}])
        materials = {(m["Permittivity"], m["LossTan"]) for m in deck["Domains"]["Materials"]}
        self.assertEqual(materials, {(4.1, 0.013), (1.0, 0.0)})
        self.assertEqual([(p["R"], p["Excitation"], p["Attributes"]) for p in boundaries["LumpedPort"]], [(47, 1, [tags["port|p1"]]), (53, 2, [tags["port|p2"]])])
        self.assertIn(tags["ymin"], boundaries["PEC"]["Attributes"])
        self.assertEqual(boundaries["Impedance"], [{"Attributes": [tags["ymax"]], "Rs": 321}])
        self.assertEqual({c["Conductivity"] for c in boundaries["Conductivity"]}, {5.8e7})
        named = set(sum(([*b["Attributes"]] for key, group in boundaries.items() for b in (group if isinstance(group, list) else [group])), []))
        self.assertEqual(named, set(tags.values()), "every face group has a condition")
        waves = [{**cases.port(name, "A", side, 50), "kind": "wave"} for name, side in (("p1", "xmin"), ("p2", "xmax"))]
        (self.out / "w.json").write_text(json.dumps({**study, "ports": waves, "boundaries": {**study["boundaries"], "xmin": "none", "xmax": "none"}}))
        done = run("mesh", self.out / "b.json", "--study", self.out / "w.json", "--for", "palace", "-o", self.out / "wave")
        self.assertEqual((done.returncode, "deck.wave_port_mode" in done.stderr), (0, True), done.stderr)
        deck = json.loads((self.out / "wave/b.palace.json").read_text())
        jsonschema.Draft7Validator(json.loads((ROOT / "tests/decks/palace.schema.json").read_text())).validate(deck)
        boundaries = deck["Boundaries"]
        self.assertEqual(boundaries["WavePortPEC"]["Attributes"], sum((c["Attributes"] for c in boundaries["Conductivity"]), []), "lossy copper bounds the mode as if it were ideal")
        sif = (self.out / "elmer/b.port1.sif").read_text()
        for word in ("Good Conductor BC", "Absorbing BC", "Electric Robin Coefficient im", "Magnetic Boundary Load im 3", "E re {e}"):
            self.assertIn(word, sif)
        self.assertAlmostEqual(float(re.search(r"Relative Permittivity im = Real (\S+)", sif).group(1)), 4.1 * 0.013, places=12, msg="loss is positive here")
        self.assertEqual(sif.count("Boundary Condition "), len(tags))
        lines = [shlex.split(line) for line in (self.out / "mfem/b.problem.txt").read_text().splitlines()]
        faces = {words[1]: words[2:] for words in lines if words[0] == "face"}
        self.assertEqual(set(faces), set(tags))
        self.assertEqual((faces["ymin"], faces["ymax"], faces["port|p2"]), (["pec"], ["impedance", "321"], ["port", "1"]))
        self.assertEqual(faces["surface|A"], ["conductor", "0", "1", "1", "0", "1", "58000000"])
        self.assertEqual([faces["xmin"][i] for i in (0, 1, 2, 3, 7, 8)], ["absorbing", "2", "0.000535", "4.1", "0.00157", "1"], "what lies behind, by height")
        self.assertEqual([words[1] for words in lines if words[0] == "frequency_hz"], ["1000000000", "2000000000"])
        self.assertEqual([(words[1], words[2], words[-1]) for words in lines if words[0] == "port"], [("p1", "47", "1"), ("p2", "53", "1")])
        self.assertIn("4.1 0.013 1 0", (self.out / "mfem/b.problem.txt").read_text())
        script = (self.out / "dolfinx/b.py").read_text()
        problem = json.loads(script.split('r"""')[1].split('"""')[0])
        self.assertEqual({face["name"] for face in problem["faces"]}, set(tags))
        self.assertEqual(next(f for f in problem["faces"] if f["name"] == "ymax")["impedance_ohm"], 321)
        self.assertEqual({(v["eps_r"], v["tan_delta"]) for v in problem["volumes"]}, {(4.1, 0.013), (1.0, 0.0)})
        self.assertEqual([(port["impedance_ohm"], len(port["faces"])) for port in problem["ports"]], [(47, 1), (53, 1)])
        self.assertEqual(problem["frequencies_hz"], [1e9, 2e9])
        self.assertEqual(json.loads((self.out / "dolfinx/b.resolved.json").read_text())["output"]["split"], "tets", "no edge elements on prisms there")
        compile(script, "b.py", "exec")


if __name__ == "__main__":
    unittest.main(verbosity=1)
