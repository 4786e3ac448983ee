// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/units.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh {
namespace {

/// Splits "35um" into 35 and "um"; locale-independent.
std::pair<double, std::string_view> number_and_unit(std::string_view text, std::string_view what) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) throw Error(ErrorCode::usage, fmt::format("'{}' is no {}", text, what));
  std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (!unit.empty() && unit.front() == ' ') unit.remove_prefix(1);
  while (!unit.empty() && unit.back() == ' ') unit.remove_suffix(1);
  return {value, unit};
}

}  // namespace

Nm nm_from_mm(double millimetres) {
  const double nm = millimetres * 1e6;
  if (!(std::abs(nm) <= static_cast<double>(max_coordinate_nm)))
    throw Error(ErrorCode::input_number,
                fmt::format("{} mm is not a length on a board (limit {} mm)", millimetres, max_coordinate_nm / nm_per_mm));
  return static_cast<Nm>(std::llround(nm));
}

Nm parse_length(std::string_view text) {
  const auto [value, unit] = number_and_unit(text, "length (examples: 35um, 0.2mm, 8mil)");
  double mm = 0;
  if (unit.empty() || unit == "mm")
    mm = value;
  else if (unit == "um" || unit == "\xC2\xB5m" || unit == "\xCE\xBCm")
    mm = value * 1e-3;
  else if (unit == "nm")
    mm = value * 1e-6;
  else if (unit == "m")
    mm = value * 1e3;
  else if (unit == "cm")
    mm = value * 10;
  else if (unit == "mil" || unit == "mils" || unit == "thou")
    mm = value * 0.0254;
  else if (unit == "in" || unit == "inch")
    mm = value * 25.4;
  else
    throw Error(ErrorCode::usage, fmt::format("'{}': unknown unit '{}'; use nm, um, mm, cm, m, mil or in", text, unit));
  const double nm = mm * 1e6;
  if (!(std::abs(nm) <= static_cast<double>(max_coordinate_nm)))
    throw Error(ErrorCode::usage,
                fmt::format("'{}' is beyond {} mm, the largest length on a board", text, max_coordinate_nm / nm_per_mm));
  return static_cast<Nm>(std::llround(nm));
}

double parse_frequency_hz(std::string_view text) {
  const auto [value, unit] = number_and_unit(text, "frequency (examples: 10GHz, 2.4e9)");
  double scale = 0;
  if (unit.empty() || unit == "Hz")
    scale = 1;
  else if (unit == "kHz")
    scale = 1e3;
  else if (unit == "MHz")
    scale = 1e6;
  else if (unit == "GHz")
    scale = 1e9;
  else if (unit == "THz")
    scale = 1e12;
  else
    throw Error(ErrorCode::usage, fmt::format("'{}': unknown unit '{}'; use Hz, kHz, MHz, GHz or THz", text, unit));
  if (!(value > 0)) throw Error(ErrorCode::usage, fmt::format("'{}': a frequency must be positive", text));
  return value * scale;
}

std::string format_length(Nm length_nm) {
  const double size = std::abs(static_cast<double>(length_nm));
  if (size >= 1e5) return fmt::format("{:.6g} mm", static_cast<double>(length_nm) * 1e-6);
  if (size >= 1e3 || length_nm == 0) return fmt::format("{:.6g} um", static_cast<double>(length_nm) * 1e-3);
  return fmt::format("{} nm", length_nm);
}

double metres_per(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::metre:
      return 1;
    case LengthUnit::millimetre:
      return 1e-3;
    case LengthUnit::micrometre:
      return 1e-6;
  }
  return 1;
}

std::string_view name_of(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::metre:
      return "m";
    case LengthUnit::millimetre:
      return "mm";
    case LengthUnit::micrometre:
      return "um";
  }
  return "m";
}

LengthUnit parse_length_unit(std::string_view text) {
  for (LengthUnit unit : {LengthUnit::metre, LengthUnit::millimetre, LengthUnit::micrometre})
    if (text == name_of(unit)) return unit;
  throw Error(ErrorCode::usage, fmt::format("unknown unit '{}'; use m, mm or um", text));
}

}  // namespace pcbmesh
