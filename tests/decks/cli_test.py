#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The program as its user meets it: help, exit codes, messages, files left behind."""
import json
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

from program import PROGRAM, ROOT, run, run_json

SERPENTINE = ROOT / "examples/serpentine.json"


class Cli(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.out = pathlib.Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def leftovers(self):
        return sorted(p.name for p in self.out.iterdir())

    def test_help_has_examples_and_every_command(self):
        text = run("--help").stdout
        for word in ("Examples", "mesh", "inspect", "check", "formats", "Exit codes"):
            self.assertIn(word, text)
        for command in ("mesh", "inspect", "check"):
            self.assertIn("Examples", run(command, "--help").stdout)
        self.assertRegex(run("--version").stdout, r"^pcbmesh \d+\.\d+\.\d+\n$")

    def test_mesh_writes_the_mesh_its_contract_study_and_report(self):
        done = run("mesh", SERPENTINE, "--air", "0", "-o", self.out / "a.msh")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.leftovers(), ["a.certificate.json", "a.msh", "a.report.json", "a.resolved.json", "a.tags.json"])
        self.assertIn("passed", done.stdout)
        again = run("mesh", SERPENTINE, "--study", self.out / "a.resolved.json", "-o", self.out / "b.msh")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual((self.out / "a.msh").read_bytes(), (self.out / "b.msh").read_bytes(), "the resolved study gives the same bytes")

    def test_every_policy_meshes_the_papers_examples(self):
        for example in ("serpentine", "via"):
            for policy in ("basic", "average", "maximum", "minimum", "thinnest_layer", "none"):
                report = run_json("mesh", ROOT / f"examples/{example}.json", "--air", "0", "--policy", policy, "--sublayers", "floor", "-o", self.out / "x.msh")
                self.assertEqual(sum(f["count"] for f in report["check"]["findings"] if f["severity"] == "error"), 0, (example, policy))
                self.assertEqual(report["counts"]["prisms"], report["counts"]["triangles"] * report["counts"]["sublayers"])

    def test_explain_says_who_forced_which_height(self):
        bounds = ["--frequency", "20GHz", "--elements-per-wavelength", "20", "--elements-per-dielectric", "6", "--height-growth", "1.6"]
        done = run("mesh", SERPENTINE, *bounds, "--explain", "-o", self.out / "a.msh", "-o", self.out / "a.vtu")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("passed", done.stdout, "unequal sub-layers are written, read back and judged")
        for words in ("forced by", "across: at least 6", "growth"):
            self.assertIn(words, done.stdout)
        plain = run("mesh", SERPENTINE, *bounds[:4], "--policy", "none", "--sublayers", "none", "--explain", "--dry-run").stdout
        self.assertIn("wavelength: at most 749.5 um", plain, "air: c / 20 GHz / 20")
        report = json.loads((self.out / "a.report.json").read_text())
        layers = {layer["layer"]: layer for layer in report["layers"]}
        self.assertEqual([layers[n]["forced_by"] for n in ("L2", "L4", "air above")], ["across", "across", "growth"])
        self.assertEqual(sum(layer["prisms"] for layer in layers.values()), report["counts"]["prisms"])
        self.assertAlmostEqual(sum(layer["prisms"] * layer["quality"] for layer in layers.values()) / report["counts"]["prisms"], report["quality"]["mean_prism"], 3)
        air = layers["air above"]["sublayer_heights_m"]
        self.assertAlmostEqual(sum(air), 1e-3, 12)
        self.assertTrue(all(b <= 1.6000001 * a for a, b in zip(air, air[1:])) and air[-1] > air[0], air)
        self.assertIsNone(report["match"])

    def test_skin_depth_grades_copper_and_the_mesh_stays_right(self):
        report = run_json("mesh", SERPENTINE, "--air", "0", "--frequency", "1GHz", "--skin-depth-layers", "2", "-o", self.out / "s.msh")
        self.assertEqual(sum(f["count"] for f in report["check"]["findings"] if f["severity"] == "error"), 0)
        copper = next(layer for layer in report["layers"] if layer["layer"] == "L3")
        self.assertEqual(copper["forced_by"], "skin_depth")
        self.assertAlmostEqual(copper["skin_depth_m"], 2.09e-6, delta=0.01e-6)
        self.assertLessEqual(sum(copper["sublayer_heights_m"][:2]), copper["skin_depth_m"] * 1.000001)

    def test_policy_matched_meets_its_goal_and_repeats(self):
        goal = ["--air", "0", "--seed", "hex", "--smooth", "--policy", "matched", "--target-quality", "0.75"]
        report = run_json("mesh", SERPENTINE, *goal, "-o", self.out / "a.msh")
        self.assertGreaterEqual(min(report["quality"]["mean_prism"], report["quality"]["volume_weighted_prism"]), 0.75)
        match = report["match"]
        self.assertEqual(match["meshes"][match["chosen"]]["prisms"], report["counts"]["prisms"])
        self.assertTrue(0 < match["knee"] < len(match["front"]))
        run_json("mesh", SERPENTINE, "--study", self.out / "a.resolved.json", "-o", self.out / "b.msh")
        self.assertEqual((self.out / "a.msh").read_bytes(), (self.out / "b.msh").read_bytes())
        done = run("mesh", SERPENTINE, "--policy", "matched", "--target-quality", "0.9", "--budget-prisms", "300", "--dry-run")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("502", done.stderr)
        done = run("mesh", SERPENTINE, "--target-quality", "0.9", "--dry-run")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("matched", done.stderr)

    def test_usage_errors_are_exit_2_and_say_what_to_do(self):
        for arguments, words in (
            (["mesh", SERPENTINE], ["-o"]),
            (["mesh", SERPENTINE, "-o", self.out / "x.step"], ["formats"]),
            (["mesh", SERPENTINE, "--margin", "2furlongs", "-o", self.out / "x.msh"], ["furlongs"]),
            (["mesh", SERPENTINE, "--policy", "best", "-o", self.out / "x.msh"], ["average"]),
            (["mesh", SERPENTINE, "--min-angle", "40", "-o", self.out / "x.msh"], ["angle"]),
            (["mesh", SERPENTINE, "--tolerance", "-1um", "-o", self.out / "x.msh"], ["tolerance"]),
            ([], ["subcommand"]),
        ):
            done = run(*arguments)
            self.assertEqual(done.returncode, 2, (arguments, done.stderr))
            for word in words:
                self.assertIn(word, done.stderr + done.stdout)
        self.assertEqual(self.leftovers(), [])

    def test_input_errors_are_exit_3_and_name_the_place(self):
        bad = self.out / "bad.kicad_pcb"
        for content in ("", "(kicad_pcb (version 20221018) (layers", "(" * 10000, "hello", "(kicad_pcb (version nan))", "\0" * 100, "(kicad_pcb (version 20221018)))))"):
            bad.write_text(content)
            done = run("inspect", bad)
            self.assertEqual(done.returncode, 3, (content[:40], done.stderr))
            self.assertIn("bad.kicad_pcb", done.stderr)
        self.assertEqual(run("inspect", self.out / "absent.kicad_pcb").returncode, 3)
        done = run("mesh", SERPENTINE, "--nets", "no_such_net", "-o", self.out / "x.msh")
        self.assertEqual(done.returncode, 3)
        self.assertIn("no_such_net", done.stderr)

    def test_output_errors_are_exit_5(self):
        done = run("mesh", SERPENTINE, "-o", self.out / "absent/x.msh")
        self.assertEqual(done.returncode, 5)
        self.assertIn("absent", done.stderr)
        self.assertEqual(run("mesh", SERPENTINE, "-o", self.out).returncode, 5)

    def test_budget_is_refused_before_anything_is_written(self):
        done = run("mesh", SERPENTINE, "--longest-edge", "10um", "--max-prisms", "1000", "-o", self.out / "x.msh")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("--max-prisms", done.stderr)
        self.assertEqual(self.leftovers(), [])

    def test_dry_run_counts_and_writes_nothing(self):
        dry = run_json("mesh", SERPENTINE, "--air", "0", "--dry-run")
        self.assertEqual(self.leftovers(), [])
        real = run_json("mesh", SERPENTINE, "--air", "0", "-o", self.out / "x.msh")
        self.assertEqual(dry["counts"], real["counts"])

    def test_check_finds_damage_and_exits_1(self):
        run("mesh", SERPENTINE, "--air", "0", "--ascii", "--msh-version", "2.2", "-o", self.out / "x.msh")
        self.assertEqual(run("check", self.out / "x.msh").returncode, 0)
        lines = (self.out / "x.msh").read_text().splitlines()
        start = next(i for i, line in enumerate(lines) if line == "$Nodes") + 2
        number, x, y, z = lines[start + 40].split()
        lines[start + 40] = f"{number} {float(x) + 1e-3} {y} {z}"
        (self.out / "broken.msh").write_text("\n".join(lines) + "\n")
        done = run("check", self.out / "broken.msh", "--tags", self.out / "x.tags.json")
        self.assertEqual(done.returncode, 1, done.stdout)
        report = run_json("check", self.out / "broken.msh")
        self.assertTrue(report["findings"])

    def test_inspect_json_names_layers_and_nets(self):
        info = run_json("inspect", SERPENTINE)
        self.assertEqual(len(info["layers"]), 5)
        self.assertTrue(all("name" in net and "layers" in net for net in info["nets"]))

    def test_interrupt_leaves_the_old_file_and_no_debris(self):
        target = self.out / "x.msh"
        target.write_text("old")
        process = subprocess.Popen([PROGRAM, "mesh", SERPENTINE, "--air", "0", "--longest-edge", "12um", "-o", target], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(0.7)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(target.read_text(), "old")
        self.assertEqual([name for name in self.leftovers() if name.endswith(".part")], [])

    def test_a_file_of_cells_alone_is_no_broken_mesh(self):
        for name in ("a.vtu", "b.xdmf"):
            for conductors in ("solid", "hollow", "sheet"):
                done = run("mesh", ROOT / "examples/microstrip.json", "--conductors", conductors, "-o", self.out / name)
                self.assertEqual(done.returncode, 0, done.stdout)
                self.assertRegex(done.stdout, r"check +passed", name)
                found = {f["code"] for f in run_json("check", self.out / name)["findings"]}
                self.assertEqual(found, {"face.none_tagged"}, "cells and names are judged, faces are said to be absent")
        (self.out / "a.vtu").write_bytes((self.out / "a.vtu").read_bytes().replace(b'Name="volume_tag"', b'Name="volume_tug"'))
        self.assertEqual(run("check", self.out / "a.vtu").returncode, 1, "cells without tags are a fault all the same")

    def test_convert_hands_the_tags_on(self):
        run("mesh", SERPENTINE, "--air", "0", "-o", self.out / "a.msh", "--no-check")
        done = run("convert", self.out / "a.msh", self.out / "b.vtu", "--split", "tets", "--unit", "mm")
        self.assertEqual(done.returncode, 0, done.stderr)
        tags = json.loads((self.out / "b.tags.json").read_text())
        self.assertEqual(tags["unit_m"], 1e-3)
        old = json.loads((self.out / "a.tags.json").read_text())
        self.assertEqual([v["num_cells"] for v in tags["volumes"]], [3 * v["num_cells"] for v in old["volumes"]])
        self.assertEqual(run_json("check", self.out / "b.vtu")["findings"], [], "volumes, names and counts hold in the new unit")
        # One tags.json can't tell of two meshes of different units.
        done = run("convert", self.out / "a.msh", self.out / "a.inp", "--unit", "mm")
        self.assertIn("another name", done.stderr)
        self.assertEqual(json.loads((self.out / "a.tags.json").read_text()), old)
        (self.out / "a.tags.json").write_text("{}")
        done = run("convert", self.out / "a.msh", self.out / "c.vtu")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("tags.json", done.stderr)

    def test_a_full_disk_ends_in_exit_5_the_old_file_and_no_debris(self):
        script = 'mount -t tmpfs -o size=400k none "$1" 2>/dev/null || exit 77; echo old > "$1/x.msh"; cd "$1"; "$2" mesh "$3" --air 0 --longest-edge 50um -o x.msh 2>&1; code=$?; ls; cat x.msh; exit $code'
        done = subprocess.run(["unshare", "-m", "sh", "-c", script, "sh", self.out, PROGRAM, SERPENTINE], capture_output=True, text=True, timeout=120)
        if done.returncode == 77 or "unshare" in done.stderr:
            self.skipTest("may not mount a small disk here")
        self.assertEqual(done.returncode, 5, done.stdout)
        self.assertRegex(done.stdout, r"No space left.*needed.*are free")
        self.assertEqual(done.stdout.splitlines()[-2:], ["x.msh", "old"], "nothing but the old file is there")

    def test_a_killed_run_leaves_the_old_mesh_or_the_new_one(self):
        target = self.out / "x.msh"
        arguments = [PROGRAM, "mesh", SERPENTINE, "--air", "0", "--longest-edge", "60um", "--no-check", "-o", target]
        start = time.monotonic()
        subprocess.run(arguments, check=True, stdout=subprocess.DEVNULL)
        seconds = time.monotonic() - start
        new = target.read_bytes()
        killed = 0
        for i in range(20):
            target.write_text("old")
            process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL)
            time.sleep(seconds * i / 20)
            process.kill()
            killed += process.wait(timeout=60) < 0
            self.assertIn(target.read_bytes(), (b"old", new))
        self.assertGreater(killed, 2, "few runs were cut short: the test proves little")

    def test_a_mesh_that_is_a_folder_is_written_and_certified(self):
        done = run("mesh", SERPENTINE, "-o", self.out / "a.elmer")
        self.assertEqual(done.returncode, 0, done.stderr)
        certificate = json.loads((self.out / "a.certificate.json").read_text())
        self.assertIn("a.elmer", [file["name"] for file in certificate["files"]])
        self.assertTrue((self.out / "a.elmer/mesh.header").exists())

    def test_same_input_same_bytes(self):
        for name in ("a", "b"):
            run("mesh", SERPENTINE, "-o", self.out / f"{name}.msh", "--threads", "1" if name == "a" else "3")
        self.assertEqual((self.out / "a.msh").read_bytes(), (self.out / "b.msh").read_bytes())
        self.assertEqual((self.out / "a.tags.json").read_bytes(), (self.out / "b.tags.json").read_bytes())


if __name__ == "__main__":
    unittest.main(verbosity=1)
