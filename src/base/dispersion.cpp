// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/dispersion.hpp"

#include <cmath>
#include <complex>

namespace pcbmesh {
namespace {

using Complex = std::complex<double>;

Permittivity split(Complex eps) {
  return {eps.real(), -eps.imag() / eps.real()};
}

Complex wideband(double frequency_hz, double low_hz, double high_hz) {
  return std::log(Complex(high_hz, frequency_hz) / Complex(low_hz, frequency_hz));
}

}  // namespace

std::string_view name_of(DispersionKind kind) {
  constexpr std::string_view names[] = {"constant", "djordjevic_sarkar", "debye"};
  return names[static_cast<int>(kind)];
}

std::string_view name_of(RoughnessKind kind) {
  constexpr std::string_view names[] = {"none", "hammerstad", "groisse", "huray"};
  return names[static_cast<int>(kind)];
}

Permittivity permittivity_at(const Dispersion& dispersion, Permittivity constant, double frequency_hz) {
  switch (dispersion.kind) {
    case DispersionKind::constant:
      return constant;
    case DispersionKind::djordjevic_sarkar:
      return split(dispersion.eps_inf + dispersion.slope * wideband(frequency_hz, dispersion.low_hz, dispersion.high_hz));
    case DispersionKind::debye: {
      Complex eps = dispersion.eps_inf;
      for (const DebyePole& pole : dispersion.poles) eps += pole.delta_eps / Complex(1, frequency_hz / pole.relaxation_hz);
      return split(eps);
    }
  }
  return constant;
}

Dispersion djordjevic_sarkar_through(Permittivity value, double at_hz, double low_hz, double high_hz) {
  const Complex unit = wideband(at_hz, low_hz, high_hz);
  Dispersion made{.kind = DispersionKind::djordjevic_sarkar, .low_hz = low_hz, .high_hz = high_hz};
  made.slope = value.eps_r * value.tan_delta / -unit.imag();
  made.eps_inf = value.eps_r - made.slope * unit.real();
  return made;
}

}  // namespace pcbmesh
