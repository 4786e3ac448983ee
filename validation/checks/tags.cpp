// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "validation/checks/checks.hpp"
#include "validation/checks/parallel.hpp"

namespace pcbmesh::validation::checks {
namespace {

/// One dimension's tags: what the elements carry, what the mesh names, what tags.json says.
struct Groups {
  int dimension = 3;
  const char* what = "volume";
  const TagTable* used = nullptr;
  std::vector<std::int64_t> counts{};  ///< elements by slot
  std::map<std::int32_t, std::string> named{}, expected{};
  std::map<std::int32_t, std::int64_t> expected_counts{};
  bool is_expected = false;
};

void check_repeated_names(const Context& context, Groups& groups, CheckLog& log) {
  std::map<std::string, std::int32_t> tag_of_name;
  for (const mesh::GroupName& name : context.mesh.names) {
    if (name.dimension != groups.dimension) continue;
    const auto [entry, is_new] = groups.named.emplace(name.tag, name.name);
    if (!is_new && entry->second != name.name) {
      log.found("tag.two_names", FindingSeverity::error,
                fmt::format("{} tag {} is named both '{}' and '{}'", groups.what, name.tag, entry->second, name.name));
    }
    const auto [owner, is_first] = tag_of_name.emplace(name.name, name.tag);
    if (!is_first && owner->second != name.tag) {
      log.found("tag.name_repeated", FindingSeverity::error,
                fmt::format("{} tags {} and {} are both named '{}'", groups.what, owner->second, name.tag, name.name));
    }
  }
}

void check_used(const Groups& groups, CheckLog& log) {
  for (int slot = 0; slot < groups.used->size(); ++slot) {
    const std::int32_t tag = groups.used->tag(slot);
    const std::int64_t count = groups.counts[static_cast<std::size_t>(slot)];
    if (tag <= 0) {
      log.found("tag.not_positive", FindingSeverity::error,
                fmt::format("{} {} elements carry the tag {}; tags are positive, 0 means untagged", count, groups.what, tag),
                count);
      continue;
    }
    if (!groups.named.empty() && !groups.named.contains(tag)) {
      log.found("tag.unnamed", FindingSeverity::error,
                fmt::format("{} tag {} ({} elements) has no name", groups.what, tag, count), count);
    }
    if (groups.is_expected && !groups.expected.contains(tag)) {
      log.found("tag.unexpected", FindingSeverity::error,
                fmt::format("{} tag {} ({} elements) is not in tags.json", groups.what, tag, count), count);
    }
  }
  if (groups.named.empty() && groups.used->size() > 0) {
    log.found("tag.no_names", FindingSeverity::warning, fmt::format("the mesh names none of its {} groups", groups.what));
  }
}

void check_named(const Groups& groups, CheckLog& log) {
  for (const auto& [tag, name] : groups.named) {
    const auto expected = groups.expected.find(tag);
    if (groups.is_expected && expected != groups.expected.end() && expected->second != name) {
      log.found("tag.name_differs", FindingSeverity::error,
                fmt::format("{} tag {} is '{}' in the mesh and '{}' in tags.json", groups.what, tag, name, expected->second));
    }
    if (groups.used->slot(tag) < 0) {
      log.found("tag.empty_group", FindingSeverity::warning,
                fmt::format("{} group {} '{}' has no elements", groups.what, tag, name));
    }
  }
  for (const auto& [tag, name] : groups.expected) {
    if (groups.used->slot(tag) >= 0 || groups.expected_counts.at(tag) == 0) continue;
    log.found("tag.missing", FindingSeverity::error,
              fmt::format("no element carries the {} tag {} '{}' of tags.json", groups.what, tag, name));
  }
}

void check_dimension(const Context& context, Groups groups, CheckLog& log) {
  log.examined(groups.used->size());
  check_repeated_names(context, groups, log);
  check_used(groups, log);
  check_named(groups, log);
}

std::vector<std::int64_t> count_faces(const Context& context) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(context.face_tags.size()), 0);
  for (const mesh::FaceBlock& block : context.mesh.faces) {
    for (const std::int32_t tag : block.tags) ++counts[static_cast<std::size_t>(context.face_tags.slot(tag))];
  }
  return counts;
}

/// Area of a triangle, or of a quadrangle as half the cross product of its diagonals (exact for a flat one).
double area_of(const Context& context, const std::int64_t* corners, int n) {
  const auto at = [&](int k) -> const Vector3& { return context.mesh.nodes[static_cast<std::size_t>(corners[k])]; };
  return 0.5 * length(n == 3 ? cross(at(1) - at(0), at(2) - at(0)) : cross(at(2) - at(0), at(3) - at(1)));
}

}  // namespace

void check_tags(const Context& context, const std::vector<std::int64_t>& cells_of_tag, Report& report) {
  CheckLog log(report, context, "tags");
  Groups volumes{.dimension = 3, .what = "volume", .used = &context.cell_tags, .counts = cells_of_tag};
  Groups faces{.dimension = 2, .what = "face", .used = &context.face_tags, .counts = count_faces(context)};
  if (context.expectation != nullptr) {
    volumes.is_expected = faces.is_expected = true;
    for (const auto& volume : context.expectation->volumes) {
      volumes.expected[volume.tag] = volume.name;
      volumes.expected_counts[volume.tag] = volume.num_cells;
    }
    for (const auto& face : context.expectation->faces) {
      faces.expected[face.tag] = face.name;
      faces.expected_counts[face.tag] = face.num_faces;
    }
  }
  check_dimension(context, std::move(volumes), log);
  check_dimension(context, std::move(faces), log);
}

void check_face_groups(const Context& context, Report& report) {
  CheckLog log(report, context, "face groups");
  const auto num_slots = static_cast<std::size_t>(context.face_tags.size());
  std::vector<CompensatedSum> areas(num_slots);
  for (const mesh::FaceBlock& block : context.mesh.faces) {
    const int n = corners_of(block.kind);
    for (std::int64_t i = 0; i < block.size(); ++i) {
      const int slot = context.face_tags.slot(block.tags[static_cast<std::size_t>(i)]);
      areas[static_cast<std::size_t>(slot)].add(area_of(context, block.corners.data() + i * n, n));
    }
  }
  log.examined(context.num_faces());
  if (context.expectation == nullptr) return;
  const std::vector<std::int64_t> counts = count_faces(context);
  for (const auto& expected : context.expectation->faces) {
    const int slot = context.face_tags.slot(expected.tag);
    if (slot < 0) continue;  // check_tags reports it
    const auto s = static_cast<std::size_t>(slot);
    if (expected.num_faces >= 0 && expected.num_faces != counts[s]) {
      log.found("face.count", FindingSeverity::error,
                fmt::format("face group {} '{}' has {} faces, tags.json says {}", expected.tag, expected.name, counts[s],
                            expected.num_faces),
                std::abs(expected.num_faces - counts[s]));
    }
    if (expected.area_m2 < 0 || !context.has_geometry) continue;
    const double unit = context.expectation->unit_m;
    const double found = areas[s].value() * unit * unit;
    if (std::abs(found - expected.area_m2) <= 1e-9 * std::max(found, expected.area_m2)) continue;
    log.found("face.area", FindingSeverity::error,
              fmt::format("face group {} '{}' covers {:.12g} m2, tags.json says {:.12g} m2", expected.tag, expected.name, found,
                          expected.area_m2));
  }
}

}  // namespace pcbmesh::validation::checks
