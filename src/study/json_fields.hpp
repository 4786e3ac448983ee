// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "formats/syntax/json_tree.hpp"
#include "pcbmesh/base/error.hpp"
#include "src/study/choices.hpp"

namespace pcbmesh::study {

using formats::syntax::JsonDocument;
using formats::syntax::JsonKind;
using formats::syntax::JsonValue;
using Json = nlohmann::ordered_json;

inline constexpr double study_unit_mm = 1.0;  // a bare number is a length in millimetres, as on the command line

/// Runs `parse`; its complaint about a value becomes the field's, with line and pointer.
template <typename Parse>
auto parsed(const JsonValue& field, Parse&& parse) {
  try {
    return parse();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::usage) throw;
    field.fail(error.text());
  }
}

template <typename Value, std::size_t N>
void read_choice(const JsonValue& object, std::string_view name, const std::array<Choice<Value>, N>& choices, Value& into) {
  if (const auto field = object.find(name)) into = parsed(*field, [&] { return value_in(choices, field->as_string(), name); });
}

inline void read_length(const JsonValue& object, std::string_view name, Nm& into) {
  if (const auto field = object.find(name)) into = field->as_length(study_unit_mm);
}

inline void read_optional_length(const JsonValue& object, std::string_view name, std::optional<Nm>& into) {
  if (const auto field = object.find_set(name)) into = field->as_length(study_unit_mm);
}

/// Hertz, or text with a unit.
inline double read_frequency_hz(const JsonValue& field) {
  return field.is(JsonKind::string) ? parsed(field, [&] { return parse_frequency_hz(field.as_string()); }) : field.as_number();
}

/// With a unit where that says just this frequency, "10GHz", else in hertz.
[[nodiscard]] Json frequency_json(double hz);

[[nodiscard]] geometry::Point read_corner(const JsonValue& value);

/// Exact text of a length: whole millimetres, micrometres or nanometres.
[[nodiscard]] std::string exact_length(Nm value);
[[nodiscard]] Json optional_length(const std::optional<Nm>& value);
[[nodiscard]] Json corner(geometry::Point p);

/// Fields "problem", "solver", "ports", "boundaries", "sweep" and "modes".
void read_physics(const JsonValue& root, Study& study);
void write_physics(const Study& study, const StudyWords& words, Json& root);

}  // namespace pcbmesh::study
