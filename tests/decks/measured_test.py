# SPDX-License-Identifier: GPL-3.0-or-later
"""validation/cases/measured: what a laboratory does with S-parameters, done to networks whose answer is known. No board, no solver."""
import importlib.machinery
import importlib.util
import os
import pathlib
import sys
import tempfile
import unittest

try:
    import numpy
except ImportError:
    print("skipped: no numpy")
    sys.exit(77)

ROOT = pathlib.Path(os.environ.get("PCBMESH_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(ROOT / "validation/cases/measured"))
sys.dont_write_bytecode = True
import networks  # noqa: E402
import structures  # noqa: E402

loader = importlib.machinery.SourceFileLoader("run", str(ROOT / "validation/cases/measured/run"))
run = importlib.util.module_from_spec(importlib.util.spec_from_loader("run", loader))
loader.exec_module(run)

HZ = numpy.array([2e8, 2e9, 4e9, 6e9])
OMEGA = 2 * numpy.pi * HZ


def s_of(m):
    a, b, c, d = m[:, 0, 0], m[:, 0, 1] / 50, m[:, 1, 0] * 50, m[:, 1, 1]
    total = a + b + c + d
    return numpy.array([[(a + b - c - d) / total, 2 * (a * d - b * c) / total], [2 / total, (-a + b - c + d) / total]]).transpose(2, 0, 1)


def lossy_line(omega):
    """52 ohm, 5.8 ns/m, tan delta 0.02, with the field of a port at either end."""
    gamma = 1j * omega * 5.8e-9 * numpy.sqrt(1 - 0.02j)
    z = 52 / numpy.sqrt(1 - 0.02j) + 0 * omega
    box = numpy.array([[1 - omega ** 2 * 30e-12 * 10e-15, 1j * omega * 30e-12], [1j * omega * 10e-15, 1 + 0 * omega]]).transpose(2, 0, 1)
    return gamma, z, box


def equal(found, wanted, tolerance, what):
    miss = numpy.max(abs(numpy.asarray(found) - numpy.asarray(wanted)))
    assert miss <= tolerance, f"{what}: {miss} off"


class Measured(unittest.TestCase):
    def test_two_lengths_give_the_line_and_the_port(self):
        gamma, z, box = lossy_line(OMEGA)
        pieces = [s_of(box @ networks.transmission_line(z, gamma, length) @ networks.reversed_chain(box)) for length in (2e-3, 4e-3)]
        found_gamma, found_z = networks.line_between(HZ, *pieces, 2e-3)
        equal(found_gamma / gamma, 1, 1e-9, "propagation constant")
        equal(found_z / z, 1, 2e-3, "impedance")  # the capacitance is taken at the lowest frequency
        equal(networks.port_box(pieces[0], gamma, z, 2e-3), box, 1e-9, "field of the port")
        skin = (1 + 1j) * 1e-5
        between = numpy.array([3e8, 1e9, 5e9])
        equal(networks.gamma_between(between, HZ, skin * numpy.sqrt(HZ) + gamma) / (skin * numpy.sqrt(between) + lossy_line(2 * numpy.pi * between)[0]), 1, 1e-9, "constant between the solved frequencies")

    def test_calibration_forgets_what_lies_before_its_standards(self):
        gamma, z, box = lossy_line(OMEGA)
        before = box @ networks.transmission_line(z, gamma, 7e-3)
        true = numpy.array([0.3 + 0.2j, -0.7j, 0.9, -0.4 + 0.1j])
        raw = [networks.reflection(networks.seen_through(before, networks.impedance(r))) for r in (true, 0.999999999 + 0 * HZ, -1 + 0 * HZ, 0 * HZ)]
        equal(networks.calibrated(*raw), true, 1e-6, "calibrated reflection")
        moved = networks.reflection(networks.seen_through(before @ networks.transmission_line(z, gamma, 1e-3), networks.impedance(true)))
        assert numpy.max(abs(networks.calibrated(moved, *raw[1:]) - true)) > 0.01, "a millimetre more behind the standards must be seen"

    def test_legs_in_parallel_halve_their_impedance(self):
        # Port 0 and port 1 each reach port 2 through 100 ohm: tied, one of 50 ohm.
        y = numpy.array([[[0.01, 0, -0.01], [0, 0.01, -0.01], [-0.01, -0.01, 0.02]]], complex)
        equal(networks.ports_in_parallel(y, 0, 1), [[[0.02, -0.02], [-0.02, 0.02]]], 1e-15, "tied ports")
        equal(networks.chain_of_admittance(networks.ports_in_parallel(y, 0, 1)), [[[1, 50], [0, 1]]], 1e-12, "chain matrix")

    def test_few_frequencies_carry_a_resonance_and_a_launch(self):
        many = numpy.linspace(2e8, 6e9, 400)
        units = {"MHz": 1e6, "GHz": 1e9}
        few = numpy.array([float(word[:-3]) * units[word[-3:]] for word in structures.LONG_PIECE.split()[1].split(",")])

        def stub(hz):
            gamma, z, _ = lossy_line(2 * numpy.pi * hz)
            open_stub = 1 / networks.seen_through(networks.transmission_line(z, gamma, 8.4e-3), 1e9)
            return networks.reflection(1 / (open_stub + 1 / 50))

        equal(networks.interpolated(many, few, stub(few)), stub(many), 2e-3, "stub between the solved frequencies")

        def mismatched_line(hz):
            gamma, z, _ = lossy_line(2 * numpy.pi * hz)
            return s_of(networks.transmission_line(0.8 * z, gamma, 26e-3))

        for row, column in ((0, 0), (1, 0)):
            equal(networks.interpolated(many, few, mismatched_line(few)[:, row, column]), mismatched_line(many)[:, row, column], 5e-3, "line as long as the meander")

        def launch(hz):
            omega = 2 * numpy.pi * hz
            return networks.reflection(1j * omega * 0.4e-9 + 1 / (1j * omega * 0.5e-12 + 1 / 50))

        equal(networks.smooth(many, HZ, launch(HZ)), launch(many), 2e-3, "launch between the solved frequencies")

    def test_gate_takes_the_first_of_two_echoes(self):
        hz = numpy.linspace(2e8, 6e9, 1001)
        first, second = 0.4 * numpy.exp(-2j * numpy.pi * hz * 0.3e-9), 0.05 * numpy.exp(-2j * numpy.pi * hz * 4e-9)
        use = (hz > 1e9) & (hz < 5e9)  # nearer the ends of the band a gate has little to go by
        kept = networks.gated(hz, first + second, 0.45, -0.5e-9, 2.2e-9)
        equal(kept[use], first[use], 0.005, "gated reflection")
        seconds = numpy.linspace(-0.5e-9, 3e-9, 701)
        step = networks.step_response(hz, first, 0.4, seconds)
        equal(step[0], 0, 0.01, "step response before the echo")
        equal(step[-1], 0.4, 0.01, "step response after the echo")
        half = seconds[numpy.argmax(step > 0.2)]
        equal(half, 0.3e-9, 1e-11, "time of the echo")

    def test_touchstone_lists_s21_before_s12(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "x.s2p"
            path.write_text("! two ports\n# Hz S RI R 50\n1e9 0.1 0 0.21 0 0.12 0 0.2 0\n")
            hz, s = networks.touchstone(path)
        equal(s[0], [[0.1, 0.12], [0.21, 0.2]], 0, "two-port")
        equal(hz, [1e9], 0, "frequency")

    def test_board_is_cut_off_below_a_layer(self):
        board = structures.parsed('''(kicad_pcb (layers (0 "F.Cu" signal) (1 "In1.Cu" signal) (2 "In2.Cu" signal) (31 "B.Cu" signal) (44 "Edge.Cuts" user))
          (setup (stackup (layer "F.Cu" (thickness 0.035)) (layer "d1" (thickness 0.1)) (layer "In1.Cu") (layer "d2") (layer "In2.Cu") (layer "d3") (layer "B.Cu") (copper_finish "None")))
          (footprint "X" (pad "1" smd rect (layers "F.Cu" "F.Mask")) (pad "2" smd rect (layers "B.Cu" "B.Mask")) (pad "3" thru_hole circle (layers "*.Cu")))
          (segment (layer "B.Cu")) (segment (layer "F.Cu")) (zone (layers "F.Cu" "In1.Cu")) (zone (layer "In2.Cu")) (via (layers "F.Cu" "B.Cu")))''')
        text = structures.written(structures.cut_below(board, '"In1.Cu"')).replace("\n", "")
        assert "In2" not in text and "d2" not in text and '"2" smd' not in text, text
        assert '(31 "B.Cu" signal)' in text and '(pad "3"' in text and "via" in text and text.count("segment") == 1 and text.count("zone") == 1, text
        assert structures.entry(structures.cut_below(board, '"In2.Cu"'), "zone") is not None
        assert '"d2"' in structures.written(structures.cut_below(board, '"In2.Cu"'))

    def test_curves_say_where_the_analyser_was_calibrated(self):
        """What docs/evidence/measured.md concludes from the published curves alone."""
        if not (structures.DATA / "gerber/gerber2ems_stub_short/vna.csv").exists():
            self.skipTest("no measured curves in PCBMESH_TEST_DATA")
        hz, stub = run.measured("stub")
        _, meander = run.measured("meander")
        self.assertEqual((1000, 2e8, 6e9), (len(hz), hz[0], hz[-1]))
        seconds = numpy.linspace(-0.3e-9, 0.6e-9, 901)
        step = networks.step_response(hz, stub, 0.0, seconds)
        self.assertLess(numpy.max(abs(step[seconds < -0.02e-9] - step[0])), 0.005, "no connector before the reference plane")
        equal(run.dip(seconds, step, 0, 0.4e-9), 0.14e-9, 0.01e-9, "dip of the stub")
        early = networks.step_response(hz, meander, 1.0, seconds)
        self.assertLess(numpy.min(early[seconds < 0]), -0.2, "the meander's connector lies before the reference plane")
        self.assertLess(numpy.max(abs(meander[hz < 2.5e9])), 1.0)
        self.assertGreater(numpy.max(abs(meander)), 1.05, "an open line above 1: a connector was taken away that is not there")

    def test_bounds_are_judged_by_what_the_curves_show(self):
        seconds = numpy.linspace(-0.5e-9, 1.5e-9, 2001)
        hz = numpy.linspace(2e8, 6e9, 1001)
        open_line = networks.step_response(hz, numpy.exp(-2j * numpy.pi * hz * 0.42e-9), 1.0, seconds)
        equal(run.crossing(seconds, open_line, 0.5, 0.1e-9), 0.42e-9, 0.0042e-9, "open end")  # one per cent: below 0.2 GHz nothing was measured, and a chord is no arc
        self.assertEqual(0.5, run.rms(numpy.array([0.3, 0.4j, 9]) * 2 ** 0.5, numpy.array([True, True, False])))


if __name__ == "__main__":
    unittest.main()
