# SPDX-License-Identifier: GPL-3.0-or-later
"""What a laboratory does with S-parameters, done to computed ones: joining, one-port calibration, removal of ports' own fields, gating in time, step response.
Arrays run over frequency first; chain matrices are (n, 2, 2), in volts and amperes, current of port 2 leaving."""
import numpy

Z_REF = 50.0


def touchstone(path):
    """(hz, s of shape (n, ports, ports)) of a file as pcbmesh writes it: Hz, real and imaginary, 50 ohm."""
    ports = int(path.suffix[2:-1])
    words = [float(word) for line in path.read_text().splitlines() if line.strip() and line[0] not in "!#" for word in line.split()]
    rows = numpy.array(words).reshape(-1, 1 + 2 * ports * ports)
    s = (rows[:, 1::2] + 1j * rows[:, 2::2]).reshape(-1, ports, ports)
    return rows[:, 0], s.transpose(0, 2, 1) if ports == 2 else s  # a two-port lists S21 before S12


def admittance(s):
    one = numpy.eye(s.shape[1])
    return numpy.linalg.solve(one + s, one - s) / Z_REF


def reflection(z):
    return (z - Z_REF) / (z + Z_REF)


def impedance(reflected):
    return Z_REF * (1 + reflected) / (1 - reflected)


def ports_in_parallel(y, first, second):
    """Admittance matrix where two ports are tied together, as the two ground legs of a connector are; the joined port takes the place of the first."""
    y = y.copy()
    y[:, first, :] += y[:, second, :]
    y[:, :, first] += y[:, :, second]
    keep = [port for port in range(y.shape[1]) if port != second]
    return y[:, keep][:, :, keep]


def chain_of_admittance(y):
    y11, y12, y21, y22 = y[:, 0, 0], y[:, 0, 1], y[:, 1, 0], y[:, 1, 1]
    return numpy.array([[-y22 / y21, -1 / y21], [(y12 * y21 - y11 * y22) / y21, -y11 / y21]]).transpose(2, 0, 1)


def chain(s):
    return chain_of_admittance(admittance(s))


def reversed_chain(m):
    """The same reciprocal two-port seen from its other end."""
    return numpy.array([[m[:, 1, 1], m[:, 0, 1]], [m[:, 1, 0], m[:, 0, 0]]]).transpose(2, 0, 1)


def seen_through(m, z_load):
    return (m[:, 0, 0] * z_load + m[:, 0, 1]) / (m[:, 1, 0] * z_load + m[:, 1, 1])


def transmission_line(z_line, gamma, length):
    """Chain matrix; gamma per length."""
    angle = gamma * length
    return numpy.array([[numpy.cosh(angle), z_line * numpy.sinh(angle)], [numpy.sinh(angle) / z_line, numpy.cosh(angle)]]).transpose(2, 0, 1)


def line_between(hz, thru, line, extra_length):
    """Propagation constant and impedance of the line by which two solved pieces differ: from eigenvalues and from the capacitance of the difference; no field of a port enters either."""
    m_thru, m_line = chain(thru), chain(line)
    grows = numpy.linalg.eigvals(m_line @ numpy.linalg.inv(m_thru))
    logs = numpy.log(grows)
    gamma = numpy.array([pair[numpy.argmax(pair.real)] for pair in logs]) / extra_length
    gamma = numpy.abs(gamma.real) + 1j * numpy.abs(gamma.imag)
    lowest = [admittance(s[:1]).sum() for s in (thru, line)]  # both ends at one voltage: the line's capacitance
    per_length = (lowest[1] - lowest[0]) / extra_length * hz / hz[0]
    return gamma, gamma / per_length


def gamma_between(wanted_hz, hz, gamma):
    """Propagation constant at other frequencies: loss of skins goes with the root of frequency and loads the phase as much, loss of the laminate goes with frequency."""
    root, wanted_root = numpy.sqrt(hz), numpy.sqrt(wanted_hz)
    loss = numpy.linalg.lstsq(numpy.array([1 / root, numpy.ones_like(hz)]).T, gamma.real / hz, rcond=None)[0]
    delay = numpy.linalg.lstsq(numpy.array([1 / root, numpy.ones_like(hz)]).T, gamma.imag / hz, rcond=None)[0]
    return loss[0] * wanted_root + loss[1] * wanted_hz + 1j * (delay[0] * wanted_root + delay[1] * wanted_hz)


def port_box(thru, gamma, z_line, length):
    """Chain matrix of the field that a lumped port adds at the end of a line, from one solved line with the same port, mirrored, at its other end.
    A reciprocal two-port so near the identity is a shunt and a series part; Newton's method finds the two that give the solved line."""
    boxes = []
    for solved, wanted in zip(chain(thru), transmission_line(z_line, gamma, length)):
        series, shunt = 0j, 0j

        def joined(series, shunt, inner=wanted):
            box = numpy.array([[1 + series * shunt, series], [shunt, 1]])
            return box @ inner @ box[::-1, ::-1].T

        for _ in range(20):
            now = joined(series, shunt)
            by_series = (joined(series + 1e-6, shunt) - now) / 1e-6
            by_shunt = (joined(series, shunt + 1e-9) - now) / 1e-9
            change = numpy.linalg.solve([[by_series[0, 1], by_shunt[0, 1]], [by_series[1, 0], by_shunt[1, 0]]], [solved[0, 1] - now[0, 1], solved[1, 0] - now[1, 0]])
            series, shunt = series + change[0], shunt + change[1]
        boxes.append([[1 + series * shunt, series], [shunt, 1]])
    return numpy.array(boxes)


def calibrated(raw, raw_open, raw_short, raw_load):
    """Reflection after a one-port calibration that takes its three standards for ideal: open 1, short -1, load 0. All arguments are reflections at the same raw plane."""
    # raw = (a + b true) / (1 + c true); the load gives a at once.
    a = raw_load
    # open: a + b - raw_open c = raw_open; short: a - b + raw_short c = raw_short
    c = (raw_open + raw_short - 2 * a) / (raw_short - raw_open)
    b = raw_open * (1 + c) - a
    return (raw - a) / (b - c * raw)


def interpolated(wanted_hz, hz, values):
    """Rational interpolation (barycentric, adaptive choice of supports) of one response of a real circuit, mirrored to negative frequencies."""
    points = numpy.concatenate([-hz[::-1], hz]) / hz[-1]
    data = numpy.concatenate([numpy.conj(values[::-1]), values])
    supports, taken = [], numpy.full(len(points), numpy.mean(data))
    for _ in range(len(points) // 2):
        worst = int(numpy.argmax(abs(taken - data)))
        if abs(taken - data)[worst] < 1e-4 * max(abs(data)):
            break
        for index in (worst, len(points) - 1 - worst):
            if index not in supports:
                supports.append(index)
        rest = [i for i in range(len(points)) if i not in supports]
        if len(rest) < len(supports):
            break
        loewner = (data[rest, None] - data[None, supports]) / (points[rest, None] - points[None, supports])
        weights = numpy.linalg.svd(loewner)[2][-1].conj()
        taken = data.copy()
        cauchy = 1 / (points[rest, None] - points[None, supports])
        taken[rest] = (cauchy @ (weights * data[supports])) / (cauchy @ weights)
        best = (list(supports), weights)
    chosen, weights = best
    x = numpy.asarray(wanted_hz, float) / hz[-1]
    distance = x[:, None] - points[None, chosen]
    hit = abs(distance) < 1e-12
    cauchy = 1 / numpy.where(hit, 1, distance)
    found = (cauchy @ (weights * data[chosen])) / (cauchy @ weights)
    for row, column in zip(*numpy.nonzero(hit)):
        found[row] = data[chosen[column]]
    return found


def smooth(wanted_hz, hz, values):
    """Polynomial through few points of a piece short against the wavelength: odd and even parts of a real circuit, even in frequency and odd."""
    x, w = hz / hz[-1], numpy.asarray(wanted_hz) / hz[-1]
    n = len(hz)
    even = numpy.linalg.solve(numpy.vander(x * x, n), values.real)
    odd = numpy.linalg.solve(numpy.vander(x * x, n) * x[:, None], values.imag)
    return numpy.vander(w * w, n) @ even + 1j * (numpy.vander(w * w, n) * w[:, None] @ odd)


def _spectrum(hz, s, at_dc, window):
    """Even grid from 0 to the highest frequency: measured curves begin above 0, where a straight line to the value at 0 is taken."""
    step = hz[1] - hz[0]
    grid = numpy.arange(int(hz[-1] / step + 0.5) + 1) * step
    hz, s = numpy.concatenate([[0], hz]), numpy.concatenate([[at_dc], s])
    values = numpy.interp(grid, hz, s.real) + 1j * numpy.interp(grid, hz, s.imag)
    shape = numpy.kaiser(2 * len(grid) - 1, 6)[len(grid) - 1:] if window else numpy.ones(len(grid))
    return grid, values, shape


def step_response(hz, s, at_dc, seconds):
    """Reflection of a step of voltage whose edge the band limits (Kaiser window, beta 6), at the times asked for. `at_dc`: reflection of the resistances alone."""
    grid, values, shape = _spectrum(hz, s, at_dc, True)
    size = 1 << 15
    padded = numpy.zeros(size // 2 + 1, complex)
    padded[:len(grid)] = values * shape
    times = numpy.arange(size) / (size * (grid[1] - grid[0]))
    early = size // 16  # the edge begins before 0
    impulse = numpy.roll(numpy.fft.irfft(padded, size), early)
    return numpy.interp(seconds, times - times[early], numpy.cumsum(impulse))


def gated(hz, s, at_dc, begin, end, edge=0.3e-9):
    """The part of a reflection that comes back between two times; soft edges; trustworthy away from the ends of the band."""
    grid, values, shape = _spectrum(hz, s, at_dc, True)
    size = 1 << 15
    padded = numpy.zeros(size // 2 + 1, complex)
    padded[:len(grid)] = values * shape
    impulse = numpy.fft.irfft(padded, size)
    times = numpy.arange(size) / (size * (grid[1] - grid[0]))
    times = numpy.where(times > times[-1] / 2, times - times[-1] - times[1], times)
    rise = numpy.clip((times - begin) / edge + 0.5, 0, 1)
    fall = numpy.clip((end - times) / edge + 0.5, 0, 1)
    gate = numpy.sin(numpy.pi / 2 * rise) ** 2 * numpy.sin(numpy.pi / 2 * fall) ** 2
    spectrum = numpy.fft.rfft(impulse * gate)[:len(grid)] / shape
    return numpy.interp(hz, grid, spectrum.real) + 1j * numpy.interp(hz, grid, spectrum.imag)
