// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/profiles/rules.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pcbmesh::validation::profiles {
namespace {

struct RoleName {
  std::string_view word;
  FaceRole role;
};

constexpr RoleName kinds[] = {{"outer", FaceRole::outer},         {"conductor", FaceRole::conductor},
                              {"sheet", FaceRole::sheet},         {"port", FaceRole::port},
                              {"wave_port", FaceRole::wave_port}, {"interface", FaceRole::interface}};
constexpr RoleName first_words[] = {{"port", FaceRole::port},           {"waveport", FaceRole::wave_port},
                                    {"wave_port", FaceRole::wave_port}, {"surface", FaceRole::conductor},
                                    {"pec", FaceRole::conductor},       {"conductor", FaceRole::conductor},
                                    {"sheet", FaceRole::sheet}};

FaceRole role_of(const checks::Context& context, std::int32_t tag, std::string_view name) {
  if (context.expectation != nullptr) {
    for (const auto& face : context.expectation->faces) {
      if (face.tag != tag) continue;
      const auto kind = std::ranges::find(kinds, face.kind, &RoleName::word);
      if (kind != std::end(kinds)) return kind->role;
    }
  }
  const std::size_t bar = name.find('|');
  if (bar == std::string_view::npos) return FaceRole::unknown;
  const auto word = std::ranges::find(first_words, name.substr(0, bar), &RoleName::word);
  return word == std::end(first_words) ? FaceRole::unknown : word->role;
}

}  // namespace

std::vector<FaceGroup> face_groups(const checks::Context& context) {
  std::vector<FaceGroup> groups(static_cast<std::size_t>(context.face_tags.size()));
  for (std::size_t slot = 0; slot < groups.size(); ++slot) {
    FaceGroup& group = groups[slot];
    group.tag = context.face_tags.tag(static_cast<int>(slot));
    group.name = context.name_of(2, group.tag);
    group.role = role_of(context, group.tag, group.name);
    if (context.expectation == nullptr) continue;
    const auto& expected = context.expectation->faces;
    const auto face = std::ranges::find(expected, group.tag, &Expectation::Face::tag);
    group.is_coaxial =
        face != expected.end() && !face->port.empty() && std::ranges::count(context.expectation->coaxial_ports, face->port) > 0;
  }
  for (std::int64_t face = 0; face < context.num_faces(); ++face) {
    groups[static_cast<std::size_t>(context.face_tags.slot(context.tag_of_face(face)))].faces.push_back(face);
  }
  return groups;
}

std::int64_t num_cells(const checks::Context& context, mesh::CellKind kind) {
  std::int64_t count = 0;
  for (const mesh::CellBlock& block : context.mesh.cells) count += block.kind == kind ? block.size() : 0;
  return count;
}

bool has_cells(const checks::Context& context, mesh::CellKind kind) {
  return num_cells(context, kind) > 0;
}

bool is_msh4(const checks::Context& context) {
  return context.mesh.format.name == "msh" && context.mesh.format.version.starts_with('4');
}

std::int64_t num_prisms_of_order_2(const checks::Context& context, int num_mid) {
  std::int64_t count = 0;
  for (const mesh::CellBlock& block : context.mesh.cells) {
    count += block.kind == mesh::CellKind::wedge && block.num_mid == num_mid ? block.size() : 0;
  }
  return count;
}

void report_incomplete(const checks::Context& context, std::string_view code, checks::CheckLog& log) {
  if (context.mesh.format.name != "msh") return;
  std::int64_t quadrangles = 0;
  for (const mesh::FaceBlock& block : context.mesh.faces) {
    quadrangles += block.kind == mesh::FaceKind::quadrangle && block.num_mid == 4 ? block.size() : 0;
  }
  const std::int64_t prisms = num_prisms_of_order_2(context, 9);
  if (prisms + quadrangles == 0) return;
  log.found(code, fmt::format("{} prisms have 15 nodes and {} quadrangles 8", prisms, quadrangles), prisms + quadrangles);
}

void report_mixed_orders(const checks::Context& context, std::string_view code, checks::CheckLog& log) {
  if (context.mesh.format.name != "msh") return;
  std::int64_t first = 0, second = 0;
  const auto look = [&](const auto& blocks) {
    for (const auto& block : blocks) (block.num_mid == 0 ? first : second) += block.size();
  };
  look(context.mesh.cells);
  look(context.mesh.faces);
  if (first == 0 || second == 0) return;
  log.found(code, fmt::format("{} elements are of first and {} of second order", first, second), std::min(first, second));
}

void report_untagged(const checks::Context& context, std::string_view code, checks::CheckLog& log) {
  const auto& untagged = context.mesh.num_untagged;
  const std::int64_t count = untagged[0] + untagged[1] + untagged[2];
  // A mesh without any group is taken as one attribute, with a warning.
  const bool has_tags = context.cell_tags.size() > 1 || (context.cell_tags.size() == 1 && context.cell_tags.tag(0) > 0);
  if (count == 0 || !has_tags) return;
  log.found(code,
            fmt::format("{} elements of the file belong to no group ({} points, {} lines, {} faces) beside others that do",
                        count, untagged[0], untagged[1], untagged[2]),
            count);
}

void report_sparse(const checks::Context& context, std::string_view code, checks::CheckLog& log) {
  const auto look = [&](const checks::TagTable& tags, const char* what) {
    if (tags.size() == 0 || tags.tag(tags.size() - 1) <= tags.size()) return;
    log.found(code,
              fmt::format("{} {} attributes are in use, but the largest is {}", tags.size(), what, tags.tag(tags.size() - 1)));
  };
  look(context.cell_tags, "volume");
  look(context.face_tags, "boundary");
}

}  // namespace pcbmesh::validation::profiles
