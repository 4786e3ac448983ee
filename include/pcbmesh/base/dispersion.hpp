// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

namespace pcbmesh {

/// How permittivity depends on frequency.
enum class DispersionKind {
  constant,           ///< eps_r and tan_delta as they stand
  djordjevic_sarkar,  ///< wideband Debye: a continuum of relaxations between two frequencies
  debye               ///< a sum of single relaxations
};
[[nodiscard]] std::string_view name_of(DispersionKind kind);

struct DebyePole {
  double delta_eps = 0;      ///< > 0
  double relaxation_hz = 0;  ///< > 0
  bool operator==(const DebyePole&) const = default;
};

/// Complex permittivity eps' - j eps'' over frequency.
///
/// djordjevic_sarkar: eps_inf + slope * ln((high + j f) / (low + j f)).
/// debye:             eps_inf + sum delta_eps / (1 + j f / relaxation).
/// @source A. Djordjevic, R. Biljic, V. Likar-Smiljanic, T. Sarkar, IEEE Trans. EMC 43(4), 2001, eq. (11) in natural
/// logarithms.
struct Dispersion {
  DispersionKind kind = DispersionKind::constant;
  double eps_inf = 1;
  double slope = 0;    ///< djordjevic_sarkar: fall of eps' per factor e of frequency
  double low_hz = 0;   ///< djordjevic_sarkar
  double high_hz = 0;  ///< djordjevic_sarkar
  std::vector<DebyePole> poles{};
  bool operator==(const Dispersion&) const = default;
};

struct Permittivity {
  double eps_r = 1;
  double tan_delta = 0;
};

/// @param constant  what holds for kind constant.
[[nodiscard]] Permittivity permittivity_at(const Dispersion& dispersion, Permittivity constant, double frequency_hz);

/// The wideband Debye curve that has this permittivity at this frequency. REQUIRES low < at < high, tan_delta > 0.
[[nodiscard]] Dispersion djordjevic_sarkar_through(Permittivity value, double at_hz, double low_hz = 1e3,
                                                   double high_hz = 1e12);

/// How a copper surface raises its resistance. Data for the solver: the mesh itself is smooth.
enum class RoughnessKind {
  none,
  hammerstad,  ///< rms height; 1 + 2/pi atan(1.4 (rms/skin depth)^2)
  groisse,     ///< rms height; 1 + exp(-(skin depth/(2 rms))^1.6)
  huray        ///< radius of the nodules and Hall-Huray surface ratio
};
[[nodiscard]] std::string_view name_of(RoughnessKind kind);

struct Roughness {
  RoughnessKind kind = RoughnessKind::none;
  double rms_m = 0;            ///< hammerstad, groisse
  double nodule_radius_m = 0;  ///< huray
  double surface_ratio = 0;    ///< huray
  bool operator==(const Roughness&) const = default;
};

}  // namespace pcbmesh
