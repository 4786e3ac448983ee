#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The reports of pcbmesh check as their readers see them: JUnit, SARIF, HTML in a browser, offenders in a mesh library; the certificate."""
import html.parser
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse
import xml.etree.ElementTree

from program import ROOT, SKIPPED, run

try:
    import jsonschema
    import meshio
    import numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(SKIPPED)


class Text(html.parser.HTMLParser):
    """Visible text, and whether every tag is closed in order."""
    VOID = {"meta", "br"}

    def __init__(self):
        super().__init__()
        self.open, self.words, self.faults, self.links = [], [], [], []

    def handle_starttag(self, tag, attributes):
        if tag not in self.VOID:
            self.open.append(tag)
        self.links += [value for key, value in attributes if key in ("src", "href")]

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(tag)

    def handle_data(self, data):
        self.words.append(data)


class Reports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        cls.made = run("mesh", ROOT / "examples/microstrip.json", "-o", cls.out / "good.msh", "--msh-version", "2.2", "--ascii", "--quiet")
        # Twenty cells turned inside out: the corners of their bases go round the other way.
        text = (cls.out / "good.msh").read_text().splitlines()
        wedges = [i for i, line in enumerate(text) if re.match(r"\d+ 6 2 ", line)]
        for i in wedges[100:120]:
            w = text[i].split()
            w[6], w[7], w[9], w[10] = w[7], w[6], w[10], w[9]
            text[i] = " ".join(w)
        cls.bad = cls.out / "a bad <mesh>.msh"
        cls.bad.write_text("\n".join(text) + "\n")
        names = {name: cls.out / f"report.{name}" for name in ("junit", "sarif", "html", "vtu")}
        cls.done = run("check", cls.bad, "--tags", cls.out / "good.tags.json", "--junit", names["junit"], "--sarif", names["sarif"], "--html",
                       names["html"], "--offenders", names["vtu"], "--json", "--quiet")
        cls.names, cls.report = names, json.loads(cls.done.stdout)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_the_report_obeys_its_schema(self):
        jsonschema.validate(self.report, json.loads((ROOT / "docs/schema/check-report.schema.json").read_text()))
        self.assertEqual(self.done.returncode, 1)
        inverted = next(f for f in self.report["findings"] if f["code"] == "cell.inverted")
        self.assertEqual((inverted["count"], len(inverted["places"])), (20, 8))

    def test_junit_counts_what_it_lists(self):
        root = xml.etree.ElementTree.parse(self.names["junit"]).getroot()
        for element in (root, root[0]):
            cases = list(element.iter("testcase"))
            self.assertEqual(int(element.get("tests")), len(cases))
            self.assertEqual(int(element.get("failures")), sum(case.find("failure") is not None for case in cases))
        self.assertEqual(root[0].get("name"), str(self.bad))
        failed = {case.get("name") for case in root.iter("testcase") if case.find("failure") is not None}
        self.assertEqual(failed, {f["code"] for f in self.report["findings"] if f["severity"] == "error"})
        self.assertEqual(len({case.get("name") for case in root.iter("testcase")}), len(list(root.iter("testcase"))))

    def test_sarif_obeys_the_rules_of_its_standard(self):
        log = json.loads(self.names["sarif"].read_text())
        self.assertEqual((log["version"], len(log["runs"])), ("2.1.0", 1))
        driver = log["runs"][0]["tool"]["driver"]
        rules = driver["rules"]
        self.assertTrue(driver["name"] and driver["version"])
        self.assertEqual(len({rule["id"] for rule in rules}), len(rules))  # 3.19.23: unique
        for rule in rules:
            self.assertIn(rule["defaultConfiguration"]["level"], ("none", "note", "warning", "error"))
            self.assertTrue(rule["shortDescription"]["text"] and rule["help"]["text"])
        self.assertEqual(len(log["runs"][0]["results"]), len(self.report["findings"]))
        for result in log["runs"][0]["results"]:
            self.assertEqual(rules[result["ruleIndex"]]["id"], result["ruleId"])  # 3.27.6
            self.assertIn(result["level"], ("none", "note", "warning", "error"))
            self.assertTrue(result["message"]["text"])
            self.assertGreaterEqual(result["occurrenceCount"], 1)  # 3.27.24
            for location in result["locations"]:
                uri = location["physicalLocation"]["artifactLocation"]["uri"]
                self.assertEqual(urllib.parse.unquote(urllib.parse.urlparse(uri).path), str(self.bad))
                self.assertNotRegex(uri, r"[<> ]")

    def test_sarif_has_the_objects_of_its_standard(self):
        """Debian's classes are generated from the published schema: each object of ours has only its names and all that it must have."""
        try:
            import attr
            import sarif_om as om
        except ImportError as missing:
            self.skipTest(str(missing))
        below = {om.SarifLog: {"runs": om.Run}, om.Run: {"tool": om.Tool, "results": om.Result}, om.Tool: {"driver": om.ToolComponent},
                 om.ToolComponent: {"rules": om.ReportingDescriptor},
                 om.ReportingDescriptor: {"shortDescription": om.MultiformatMessageString, "help": om.MultiformatMessageString,
                                          "defaultConfiguration": om.ReportingConfiguration},
                 om.Result: {"message": om.Message, "locations": om.Location},
                 om.Location: {"physicalLocation": om.PhysicalLocation, "logicalLocations": om.LogicalLocation},
                 om.PhysicalLocation: {"artifactLocation": om.ArtifactLocation}}
        seen = set()

        def look(value, kind):
            seen.add(kind)
            fields = {field.metadata["schema_property_name"]: field for field in attr.fields(kind)}
            self.assertLessEqual(set(value), set(fields), kind)
            self.assertFalse([name for name, field in fields.items() if field.default is attr.NOTHING and name not in value], kind)
            for name, inner in value.items():
                kind_below = below.get(kind, {}).get(name)
                for one in inner if isinstance(inner, list) else [inner]:
                    self.assertEqual(isinstance(one, dict), kind_below is not None, (kind, name))
                    if kind_below:
                        look(one, kind_below)

        look(json.loads(self.names["sarif"].read_text()), om.SarifLog)
        self.assertEqual(seen, set(below) | {kind for names in below.values() for kind in names.values()})
        self.assertRaises(AssertionError, look, {"version": "2.1.0", "run": []}, om.SarifLog)

    # The elements of JUnit's reports that CI systems agree on: what each must have, may have besides, and what may stand in it, in order.
    JUNIT = {"testsuites": ({"tests", "failures"}, {"name", "errors", "disabled", "time"}, ("testsuite",)),
             "testsuite": ({"name", "tests", "failures", "errors"}, {"skipped", "disabled", "time", "timestamp", "hostname", "id", "package"},
                           ("properties", "testcase", "system-out", "system-err")),
             "testcase": ({"name", "classname"}, {"time", "assertions", "status"}, ("skipped", "error", "failure", "system-out", "system-err")),
             "failure": (set(), {"message", "type"}, ()), "system-out": (set(), set(), ())}

    def test_junit_has_the_elements_others_read(self):
        def look(element):
            must, may, inside = self.JUNIT[element.tag]
            self.assertLessEqual(must, set(element.attrib), element.tag)
            self.assertLessEqual(set(element.attrib), must | may, element.tag)
            places = [inside.index(child.tag) for child in element]
            self.assertEqual(places, sorted(places), element.tag)
            for name in ("tests", "failures", "errors", "skipped"):
                self.assertGreaterEqual(int(element.get(name, "0")), 0)
            self.assertGreaterEqual(float(element.get("time", "0")), 0)
            for child in element:
                look(child)

        look(xml.etree.ElementTree.parse(self.names["junit"]).getroot())

    def test_junit_read_by_another_program(self):
        try:
            import junitparser
        except ImportError as missing:
            self.skipTest(str(missing))
        report = junitparser.JUnitXml.fromfile(str(self.names["junit"]))
        failed = {case.name for suite in report for case in suite if any(isinstance(one, junitparser.Failure) for one in case.result)}
        self.assertEqual(failed, {f["code"] for f in self.report["findings"] if f["severity"] == "error"})
        before = report.tests, report.failures, report.errors
        report.update_statistics()  # counts again what it has read
        self.assertEqual((report.tests, report.failures, report.errors), before)

    def test_html_is_whole_and_loads_nothing(self):
        text = Text()
        text.feed(self.names["html"].read_text())
        self.assertEqual((text.open, text.faults, text.links), ([], [], []))
        words = " ".join(text.words)
        self.assertIn("a bad <mesh>.msh: failed", words)
        self.assertIn("cell.inverted", words)

    def test_html_in_a_browser(self):
        browser = shutil.which("chromium")
        if not browser:
            self.skipTest("chromium is not installed")
        with tempfile.TemporaryDirectory() as profile:
            done = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}", "--dump-dom",
                                   self.names["html"].as_uri()], capture_output=True, text=True, timeout=120)
        if done.returncode:
            self.skipTest(f"chromium does not run here: {done.stderr[-200:]}")
        self.assertIn("a bad &lt;mesh&gt;.msh: failed</h1>", done.stdout)
        self.assertIn("<h2 class=\"error\">error cell.inverted</h2>", done.stdout)

    def test_offenders_hold_all_of_each_finding(self):
        grid = meshio.read(self.names["vtu"], file_format="vtu")
        numbers = numpy.concatenate(grid.cell_data["finding"])
        for i, finding in enumerate(self.report["findings"]):
            if finding["code"] == "cell.inverted":
                self.assertEqual(int((numbers == i).sum()), 20)

    def test_the_certificate_holds_for_its_mesh_alone(self):
        certificate = self.out / "good.certificate.json"
        self.assertEqual(self.made.returncode, 0, self.made.stderr)
        jsonschema.validate(json.loads(certificate.read_text()), json.loads((ROOT / "docs/schema/certificate.schema.json").read_text()))
        self.assertEqual(run("check", self.out / "good.msh", "--certificate", certificate).returncode, 0)
        other = run("check", self.bad, "--tags", self.out / "good.tags.json", "--certificate", certificate, "--json")
        codes = {f["code"] for f in json.loads(other.stdout)["findings"]}
        self.assertLessEqual({"certificate.file_differs", "certificate.verdict_differs", "certificate.volume_differs"}, codes)
        again = self.out / "again"
        again.mkdir()
        run("mesh", ROOT / "examples/microstrip.json", "-o", again / "good.msh", "--msh-version", "2.2", "--ascii", "--quiet", "--threads", "1")
        self.assertEqual((again / "good.certificate.json").read_bytes(), certificate.read_bytes(), "another run, other threads, other folder")
        self.assertEqual(run("check", self.out / "good.msh", "--no-tags", "--certificate", certificate).returncode, 2)

    def test_the_certificate_holds_the_parts_of_a_mesh(self):
        done = run("mesh", ROOT / "examples/serpentine.json", "-o", self.out / "set.xdmf", "-o", self.out / "set.pvtu")
        if "has no HDF5" in done.stderr:
            self.skipTest("this build has no HDF5")
        certificate = self.out / "set.certificate.json"
        document = json.loads(certificate.read_text())
        jsonschema.validate(document, json.loads((ROOT / "docs/schema/certificate.schema.json").read_text()))
        parts = {file["name"]: file["of"] for file in document["files"] if file["role"] == "part"}
        self.assertEqual(parts, {"set.vtkhdf": "set.xdmf", "set_faces.xdmf": "set.xdmf", "set_paraview.xdmf": "set.xdmf", "set_pvtu": "set.pvtu"})
        self.assertLessEqual(set(parts), {line.split()[1].rsplit("/", 1)[-1] for line in done.stdout.splitlines() if line.startswith("  wrote")})
        with open(self.out / "set_paraview.xdmf", "a") as file:
            file.write("\n")
        found = run("check", self.out / "set.xdmf", "--certificate", certificate, "--json")
        self.assertIn("set_paraview.xdmf, a part of set.xdmf", found.stdout)


if __name__ == "__main__":
    unittest.main()
