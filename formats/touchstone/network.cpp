// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/sink/file_sink.hpp"
#include "formats/touchstone/port_results.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::touchstone {
namespace {

using Matrix = std::vector<Complex>;  // n x n, row by row

/// X with X A = B, by Gauss with row exchange on the transposed system.
Matrix right_quotient(const Matrix& b, const Matrix& a, std::size_t n) {
  Matrix lhs(n * n), rhs(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      lhs[i * n + j] = a[j * n + i];
      rhs[i * n + j] = b[j * n + i];
    }
  for (std::size_t c = 0; c < n; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < n; ++r)
      if (std::abs(lhs[r * n + c]) > std::abs(lhs[pivot * n + c])) pivot = r;
    for (std::size_t j = 0; j < n; ++j) {
      std::swap(lhs[c * n + j], lhs[pivot * n + j]);
      std::swap(rhs[c * n + j], rhs[pivot * n + j]);
    }
    for (std::size_t r = 0; r < n; ++r) {
      if (r == c) continue;
      const Complex factor = lhs[r * n + c] / lhs[c * n + c];
      for (std::size_t j = 0; j < n; ++j) {
        lhs[r * n + j] -= factor * lhs[c * n + j];
        rhs[r * n + j] -= factor * rhs[c * n + j];
      }
    }
  }
  Matrix out(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) out[j * n + i] = rhs[i * n + j] / lhs[i * n + i];
  return out;
}

/// Largest singular value by Jacobi rotations of the columns: exact to rounding, also for equal ones.
double largest_singular_value(Matrix a, std::size_t n) {
  constexpr int sweeps = 60;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double off = 0;
    for (std::size_t p = 0; p + 1 < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q) {
        double pp = 0, qq = 0;
        Complex pq = 0;
        for (std::size_t i = 0; i < n; ++i) {
          pp += std::norm(a[i * n + p]);
          qq += std::norm(a[i * n + q]);
          pq += std::conj(a[i * n + p]) * a[i * n + q];
        }
        const double size = std::abs(pq);
        if (size <= 1e-16 * std::sqrt(pp * qq) || size == 0) continue;
        off = std::max(off, size / std::sqrt(pp * qq));
        const Complex phase = pq / size;
        const double tau = (qq - pp) / (2 * size);
        const double t = (tau >= 0 ? 1 : -1) / (std::abs(tau) + std::sqrt(1 + tau * tau));
        const double c = 1 / std::sqrt(1 + t * t), s = c * t;
        for (std::size_t i = 0; i < n; ++i) {
          const Complex x = a[i * n + p], y = a[i * n + q] * std::conj(phase);
          a[i * n + p] = c * x - s * y;
          a[i * n + q] = s * x + c * y;
        }
      }
    if (off < 1e-15) break;
  }
  double largest = 0;
  for (std::size_t j = 0; j < n; ++j) {
    double norm = 0;
    for (std::size_t i = 0; i < n; ++i) norm += std::norm(a[i * n + j]);
    largest = std::max(largest, std::sqrt(norm));
  }
  return largest;
}

}  // namespace

ScatteringSweep renormalised(const ScatteringSweep& sweep, double impedance_ohm) {
  const std::size_t n = sweep.ports.size();
  ScatteringSweep out = sweep;
  std::vector<double> gamma, root;
  for (ScatteringSweep::Port& port : out.ports) {
    gamma.push_back((impedance_ohm - port.impedance_ohm) / (impedance_ohm + port.impedance_ohm));
    root.push_back(2 * std::sqrt(impedance_ohm * port.impedance_ohm) / (impedance_ohm + port.impedance_ohm));
    port.impedance_ohm = impedance_ohm;
  }
  // b' = (S - G) and a' = (1 - G S) of the old incident waves, in units of the new roots: S' = D^-1 (S - G) (1 - G S)^-1 D.
  for (Matrix& s : out.scatter) {
    Matrix numerator = s, denominator(n * n);
    for (std::size_t i = 0; i < n; ++i) {
      numerator[i * n + i] -= gamma[i];
      for (std::size_t j = 0; j < n; ++j) denominator[i * n + j] = (i == j ? 1.0 : 0.0) - gamma[i] * s[i * n + j];
    }
    s = right_quotient(numerator, denominator, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) s[i * n + j] *= root[j] / root[i];
  }
  return out;
}

NetworkCheck check_network(const ScatteringSweep& sweep) {
  const std::size_t n = sweep.ports.size();
  NetworkCheck check;
  for (std::size_t f = 0; f < sweep.scatter.size(); ++f) {
    const Matrix& s = sweep.scatter[f];
    if (const double gain = largest_singular_value(s, n); gain > check.largest_gain) {
      check.largest_gain = gain;
      check.largest_gain_hz = sweep.frequencies_hz[f];
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (const double d = std::abs(s[i * n + j] - s[j * n + i]); d > check.asymmetry) {
          check.asymmetry = d;
          check.asymmetry_hz = sweep.frequencies_hz[f];
        }
  }
  return check;
}

std::string to_touchstone(const ScatteringSweep& sweep) {
  const std::size_t n = sweep.ports.size();
  std::string out = "! S-parameters, written by pcbmesh from the port results of a solver\n";
  for (std::size_t p = 0; p < n; ++p) {
    PCBMESH_ASSERT(sweep.ports[p].impedance_ohm == sweep.ports.front().impedance_ohm);
    out += fmt::format("! Port[{}] = {}\n", p + 1, sweep.ports[p].name);
  }
  out += fmt::format("# Hz S RI R {}\n", sweep.ports.front().impedance_ohm);
  for (std::size_t f = 0; f < sweep.scatter.size(); ++f) {
    out += fmt::format("{}", sweep.frequencies_hz[f]);
    for (std::size_t k = 0; k < n * n; ++k) {
      // Two ports: S11 S21 S12 S22. More: row by row, a new line for each row, at most four values on one.
      const std::size_t row = n == 2 ? k % 2 : k / n, column = n == 2 ? k / 2 : k % n;
      const Complex& s = sweep.scatter[f][row * n + column];
      if (n > 2 && (column == 0 ? row > 0 : column % 4 == 0)) out += "\n ";
      out += fmt::format(" {} {}", s.real(), s.imag());
    }
    out += "\n";
  }
  return out;
}

void write_touchstone(const ScatteringSweep& sweep, const std::filesystem::path& file) {
  const std::string ending = fmt::format(".s{}p", sweep.ports.size());
  std::string given = file.extension().string();
  std::ranges::transform(given, given.begin(), [](char c) { return c == 'S' ? 's' : c == 'P' ? 'p' : c; });
  if (given != ending)
    throw Error(ErrorCode::usage,
                fmt::format("the results have {} ports; the file's name must end in {}", sweep.ports.size(), ending),
                {.file = file.string()});
  FileSink sink(file);
  sink.put(to_touchstone(sweep));
  sink.commit();
}

}  // namespace pcbmesh::formats::touchstone
