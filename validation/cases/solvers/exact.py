# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed formulas and one integral equation: what the solvers are judged by. Metres, farads, ohms, hertz."""
import cmath
import math

import numpy

LIGHT = 299_792_458.0
EPS0 = 8.8541878128e-12
MU0 = 1.25663706212e-6
ETA0 = 376.730313668


def cavity_hz(size, most=3, eps_r=1.0):
    """Resonances of a box with electric walls, ascending."""
    found = []
    for m in range(most + 1):
        for n in range(most + 1):
            for p in range(most + 1):
                if (m > 0) + (n > 0) + (p > 0) < 2:
                    continue
                k = math.pi * math.sqrt((m / size[0]) ** 2 + (n / size[1]) ** 2 + (p / size[2]) ** 2)
                found += [k * LIGHT / (2 * math.pi * math.sqrt(eps_r))] * (2 if m and n and p else 1)
    return sorted(found)


def elliptic_k(k):
    """Complete elliptic integral of the first kind of modulus k, by the arithmetic-geometric mean."""
    a, b = 1.0, math.sqrt(1 - k * k)
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (2 * a)


def ratio_of_k(k):
    """K(k)/K(k')."""
    return elliptic_k(k) / elliptic_k(math.sqrt(1 - k * k))


def stripline_ohm(width, height, eps_r):
    """Thin strip midway between two planes `height` apart (Cohn 1954): exact."""
    return ETA0 / (4 * math.sqrt(eps_r)) / ratio_of_k(math.tanh(math.pi * width / (2 * height)))


def coupled_stripline_ohm(width, gap, height, eps_r):
    """(even, odd) impedance of two thin strips midway between planes (Cohn 1955): exact."""
    one, both = math.tanh(math.pi * width / (2 * height)), math.tanh(math.pi * (width + gap) / (2 * height))
    return tuple(ETA0 / (4 * math.sqrt(eps_r)) / ratio_of_k(k) for k in (one * both, one / both))


def strips_between_planes(strips, height, eps_r, per_strip=160):
    """Capacitance matrix per metre of thin strips [(left, right), ...] midway between two grounded planes: charges on
    cosine-spaced segments, exact Green's function ln coth of the planes."""
    edges, owner = [], []
    for number, (left, right) in enumerate(strips):
        at = (left + right) / 2 - (right - left) / 2 * numpy.cos(numpy.linspace(0, math.pi, per_strip + 1))
        edges += list(zip(at[:-1], at[1:]))
        owner += [number] * per_strip
    low, high = numpy.array(edges).T
    middle, owner = (low + high) / 2, numpy.array(owner)

    def near(u):
        """Integral of -ln|u'| from 0 to u."""
        return -u * numpy.log(numpy.abs(u)) + u

    # Potential of a line charge: ln coth(pi |x| / 2 height) / (2 pi eps); its singular part is integrated exactly.
    x = middle[:, None] - middle[None, :]
    scaled = numpy.abs(math.pi * x / (2 * height))
    with numpy.errstate(divide="ignore", invalid="ignore"):
        smooth = -numpy.log(numpy.tanh(scaled)) + numpy.log(numpy.abs(x))
    smooth[scaled == 0] = math.log(2 * height / math.pi)
    singular = near(high[None, :] - middle[:, None]) - near(low[None, :] - middle[:, None])
    matrix = (smooth * (high - low)[None, :] + singular) / (2 * math.pi * EPS0 * eps_r)
    out = numpy.zeros((len(strips), len(strips)))
    for number in range(len(strips)):
        density = numpy.linalg.solve(matrix, (owner == number).astype(float))
        charge = density * (high - low)
        for other in range(len(strips)):
            out[other, number] = charge[owner == other].sum()
    return out


def coaxial_farad_per_m(inner_radius, outer_radius, eps_r):
    return 2 * math.pi * EPS0 * eps_r / math.log(outer_radius / inner_radius)


def microstrip(width, height, eps_r, thickness=0.0):
    """(ohm, effective permittivity) of Hammerstad and Jensen (1980), with their correction for thick strips."""
    u = width / height
    if thickness > 0:
        t = thickness / height
        wider = t / math.pi * math.log(1 + 4 * math.e / (t / math.tanh(math.sqrt(6.517 * u)) ** 2))
        u_1, u_r = u + wider, u + wider * (1 + 1 / math.cosh(math.sqrt(eps_r - 1))) / 2
    else:
        u_1 = u_r = u

    def air(v):
        f = 6 + (2 * math.pi - 6) * math.exp(-((30.666 / v) ** 0.7528))
        return ETA0 / (2 * math.pi) * math.log(f / v + math.sqrt(1 + (2 / v) ** 2))

    a = 1 + math.log((u_r ** 4 + (u_r / 52) ** 2) / (u_r ** 4 + 0.432)) / 49 + math.log(1 + (u_r / 18.1) ** 3) / 18.7
    b = 0.564 * ((eps_r - 0.9) / (eps_r + 3)) ** 0.053
    e = (eps_r + 1) / 2 + (eps_r - 1) / 2 * (1 + 10 / u_r) ** (-a * b)
    effective = e * (air(u_1) / air(u_r)) ** 2
    return air(u_r) / math.sqrt(e), effective


def microstrip_dielectric_neper_per_m(effective, eps_r, tan_delta, hz):
    filling = (1 - 1 / effective) / (1 - 1 / eps_r)
    return math.pi * hz / LIGHT * math.sqrt(effective) * filling * tan_delta


def line_s(z0, gamma, length, ports_ohm):
    """(S11, S21) of a line of complex propagation constant between two equal ports."""
    r = (z0 - ports_ohm) / (z0 + ports_ohm)
    e = cmath.exp(-gamma * length)
    return r * (1 - e * e) / (1 - r * r * e * e), (1 - r * r) * e / (1 - r * r * e * e)


def gamma_of_two(s_short, s_long, difference):
    """Propagation constant from two-port S of a short and a long line with the same ends: the eigenvalues of
    T_long / T_short, whatever the ends are. The difference shorter than half a wave."""
    def transfer(s):
        det = s[0][0] * s[1][1] - s[0][1] * s[1][0]
        return numpy.array([[-det, s[0][0]], [-s[1][1], 1]]) / s[1][0]
    values = numpy.linalg.eigvals(transfer(s_long) @ numpy.linalg.inv(transfer(s_short)))
    wave = min(values, key=lambda v: v.imag)
    return -cmath.log(wave) / difference


def skin_depth_m(hz, sigma_s_per_m):
    return 1 / math.sqrt(math.pi * hz * 4e-7 * math.pi * sigma_s_per_m)
