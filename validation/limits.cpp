// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/validation/limits.hpp"

#include <algorithm>

#include "validation/json_field.hpp"

namespace pcbmesh::validation {
namespace {

struct LimitName {
  std::string_view name;
  std::optional<Limit> Limits::*member;
  double low, high;  ///< sensible values
};

constexpr double any = std::numeric_limits<double>::max();
constexpr LimitName names[] = {{"min_face_angle_deg", &Limits::min_face_angle_deg, 0, 90},
                               {"min_dihedral_deg", &Limits::min_dihedral_deg, 0, 90},
                               {"max_dihedral_deg", &Limits::max_dihedral_deg, 60, 180},
                               {"max_aspect_ratio", &Limits::max_aspect_ratio, 1, any},
                               {"max_height_growth", &Limits::max_height_growth, 1, any},
                               {"min_edge_m", &Limits::min_edge_m, 0, any},
                               {"max_warp", &Limits::max_warp, 0, 1},
                               {"min_scaled_jacobian", &Limits::min_scaled_jacobian, 0, 1},
                               {"min_prism_quality", &Limits::min_prism_quality, 0, 1.0264}};

std::string all_names() {
  std::string list;
  for (const LimitName& one : names) list += fmt::format("{}{}", list.empty() ? "" : ", ", one.name);
  return list;
}

Limit read_limit(const Field& field, const LimitName& name) {
  Limit limit;
  // A plain number is short for an error at that value.
  const Field value = field.is_object() ? field["value"] : field;
  limit.value = value.number();
  if (limit.value < name.low || limit.value > name.high) {
    value.fail(name.high == any ? fmt::format("at least {}", name.low) : fmt::format("in {}..{}", name.low, name.high));
  }
  if (!field.is_object()) return limit;
  for (const auto& [key, member] : field.members()) {
    if (key == "value") continue;
    if (key != "severity") member.fail("absent: a limit has a value and a severity");
    const std::string word = member.text();
    if (word != "error" && word != "warning") member.fail("\"error\" or \"warning\"");
    limit.severity = word == "error" ? FindingSeverity::error : FindingSeverity::warning;
  }
  return limit;
}

}  // namespace

Limits read_limits(const std::string& file) {
  const JsonSource source{file, "see docs/schema/check-limits.schema.json"};
  const nlohmann::json document = parse_json(source);
  const Field top(&document, "", source);
  if (top["schema_version"].integer(0, 1000) != 1) top["schema_version"].fail("1, the only version this program knows");
  Limits limits;
  for (const auto& [key, field] : top.members()) {
    if (key == "schema_version" || key == "$schema") continue;
    if (key == "unit_m") {
      limits.unit_m = field.number();
      if (!(*limits.unit_m > 0)) field.fail("greater than zero");
      continue;
    }
    const auto name = std::ranges::find(names, key, &LimitName::name);
    if (name == std::end(names)) field.fail("absent: there is no such limit; there are " + all_names());
    limits.*(name->member) = read_limit(field, *name);
  }
  return limits;
}

}  // namespace pcbmesh::validation
