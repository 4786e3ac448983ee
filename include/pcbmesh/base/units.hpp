// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pcbmesh {

/// Length on the board plane and through the stackup, in integer nanometres.
/// Everything up to and including PlanarGraph is in Nm; from PlanarMesh on lengths are doubles in metres.
using Nm = std::int64_t;

inline constexpr Nm nm_per_um = 1'000;
inline constexpr Nm nm_per_mm = 1'000'000;
inline constexpr double metres_per_nm = 1e-9;

/// Largest coordinate magnitude accepted anywhere, 1 m. Differences then stay below 2^31 nm and every
/// orientation test is exact in 128-bit (in fact in 64-bit plus one) integers.
inline constexpr Nm max_coordinate_nm = 1'000'000'000;

/// Millimetres to the nearest nanometre. @throws Error input_number (203) if not finite or beyond max_coordinate_nm.
[[nodiscard]] Nm nm_from_mm(double millimetres);

/// Parses a length such as "35um", "2mm", "0.1mil", "1in", "5e-3m", "20nm"; a bare number is millimetres.
/// @throws Error usage (101) when the text is no length.
[[nodiscard]] Nm parse_length(std::string_view text);

/// Parses a frequency such as "10GHz", "2.4e9", "500MHz"; a bare number is hertz. @throws Error usage (101).
[[nodiscard]] double parse_frequency_hz(std::string_view text);

/// Shortest readable form of a length, e.g. "35 um", "1.6 mm".
[[nodiscard]] std::string format_length(Nm length_nm);

/// Unit of length written to a file.
enum class LengthUnit { metre, millimetre, micrometre };

/// Metres in one unit: 1, 1e-3, 1e-6.
[[nodiscard]] double metres_per(LengthUnit unit);
/// "m", "mm" or "um".
[[nodiscard]] std::string_view name_of(LengthUnit unit);
/// Inverse of name_of. @throws Error usage (101).
[[nodiscard]] LengthUnit parse_length_unit(std::string_view text);

}  // namespace pcbmesh
