// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/checks/context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "validation/checks/cell_shapes.hpp"

namespace pcbmesh::validation::checks {
namespace {

constexpr std::int64_t max_findings_of_a_code = 50;
constexpr std::int32_t max_dense_tag = 1 << 22;

template <class Block>
std::vector<std::int64_t> first_of_blocks(const std::vector<Block>& blocks) {
  std::vector<std::int64_t> first{0};
  for (const Block& block : blocks) first.push_back(first.back() + block.size());
  return first;
}

std::pair<std::size_t, std::int64_t> locate(const std::vector<std::int64_t>& first, std::int64_t index) {
  const auto block = static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), index) - first.begin()) - 1;
  return {block, index - first[block]};
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

void TagTable::gather(const std::vector<std::int32_t>& tags) {
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const std::int32_t tag = tags[i];
    if (i > 0 && tag == tags[i - 1]) continue;
    if (tag < 0 || tag >= max_dense_tag) {
      wild_.push_back(tag);
      continue;
    }
    const auto wanted = static_cast<std::size_t>(tag) + 1;
    if (dense_.size() < wanted) dense_.resize(std::max(wanted, std::min<std::size_t>(2 * dense_.size(), max_dense_tag)), -1);
    dense_[static_cast<std::size_t>(tag)] = 0;
  }
}

void TagTable::finish() {
  std::sort(wild_.begin(), wild_.end());
  wild_.erase(std::unique(wild_.begin(), wild_.end()), wild_.end());
  for (const std::int32_t tag : wild_) {
    if (tag < 0) tags_.push_back(tag);
  }
  for (std::size_t tag = 0; tag < dense_.size(); ++tag) {
    if (dense_[tag] < 0) continue;
    dense_[tag] = static_cast<std::int32_t>(tags_.size());
    tags_.push_back(static_cast<std::int32_t>(tag));
  }
  for (const std::int32_t tag : wild_) {
    if (tag >= 0) tags_.push_back(tag);
  }
}

int TagTable::slot_of_wild(std::int32_t tag) const {
  const auto place = std::lower_bound(tags_.begin(), tags_.end(), tag);
  return place != tags_.end() && *place == tag ? static_cast<int>(place - tags_.begin()) : -1;
}

Context::Context(const mesh::MeshData& mesh_data, const Expectation* expected, const CheckOptions& options)
    : mesh(mesh_data),
      expectation(expected),
      num_threads(std::clamp(options.num_threads, 1, 256)),
      first_cell(first_of_blocks(mesh_data.cells)),
      first_face(first_of_blocks(mesh_data.faces)),
      cell_tags(mesh_data.cells),
      face_tags(mesh_data.faces) {
  if (mesh.nodes.empty()) return;
  Vector3 lo = mesh.nodes.front(), hi = lo;
  double sum = 0;
  for (const Vector3& node : mesh.nodes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lo[axis] = std::min(lo[axis], node[axis]);
      hi[axis] = std::max(hi[axis], node[axis]);
      sum += std::abs(node[axis]);
    }
  }
  // One infinity or NaN anywhere survives in the sum. Beyond 1e90 volumes overflow.
  has_geometry = std::isfinite(sum) && sum < 1e90;
  if (!has_geometry) return;
  low = lo;
  high = hi;
  tolerance = 1e-9 * length(high - low);
}

std::pair<std::size_t, std::int64_t> Context::locate_cell(std::int64_t cell) const {
  return locate(first_cell, cell);
}

std::pair<std::size_t, std::int64_t> Context::locate_face(std::int64_t face) const {
  return locate(first_face, face);
}

std::span<const std::int64_t> Context::corners_of_cell(std::int64_t cell) const {
  const auto [block, index] = locate_cell(cell);
  const auto n = static_cast<std::size_t>(corners_of(mesh.cells[block].kind));
  return std::span(mesh.cells[block].corners).subspan(static_cast<std::size_t>(index) * n, n);
}

std::span<const std::int64_t> Context::corners_of_face(std::int64_t face) const {
  const auto [block, index] = locate_face(face);
  const auto n = static_cast<std::size_t>(corners_of(mesh.faces[block].kind));
  return std::span(mesh.faces[block].corners).subspan(static_cast<std::size_t>(index) * n, n);
}

std::int32_t Context::tag_of_cell(std::int64_t cell) const {
  const auto [block, index] = locate_cell(cell);
  return mesh.cells[block].tags[static_cast<std::size_t>(index)];
}

std::int32_t Context::tag_of_face(std::int64_t face) const {
  const auto [block, index] = locate_face(face);
  return mesh.faces[block].tags[static_cast<std::size_t>(index)];
}

int Context::corners_of_half_face(std::int64_t half_face, std::array<std::int64_t, 4>& corners) const {
  const auto [block, index] = locate_cell(half_face >> 3);
  const mesh::CellBlock& cells = mesh.cells[block];
  const LocalFace& face = faces_of(cells.kind)[static_cast<std::size_t>(half_face & 7)];
  const auto base = static_cast<std::size_t>(index) * static_cast<std::size_t>(corners_of(cells.kind));
  for (std::size_t i = 0; i < static_cast<std::size_t>(face.num_corners); ++i) {
    corners[i] = cells.corners[base + static_cast<std::size_t>(face.corners[i])];
  }
  return face.num_corners;
}

std::string Context::name_of(int dimension, std::int32_t tag) const {
  for (const mesh::GroupName& name : mesh.names) {
    if (name.dimension == dimension && name.tag == tag) return name.name;
  }
  if (expectation == nullptr) return {};
  if (dimension == 3) {
    for (const auto& volume : expectation->volumes) {
      if (volume.tag == tag) return volume.name;
    }
  } else {
    for (const auto& face : expectation->faces) {
      if (face.tag == tag) return face.name;
    }
  }
  return {};
}

Vector3 Context::centre(std::span<const std::int64_t> corners) const {
  Vector3 sum{};
  double n = 0;
  for (const std::int64_t corner : corners) {
    if (corner < 0 || corner >= num_nodes()) continue;
    const Vector3& node = mesh.nodes[static_cast<std::size_t>(corner)];
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += node[axis];
    ++n;
  }
  if (n > 0) {
    for (double& x : sum) x /= n;
  }
  return sum;
}

Finding::Place Context::place_of_cell(std::int64_t cell) const {
  return {.cell = cell, .at = centre(corners_of_cell(cell)), .group = name_of(3, tag_of_cell(cell))};
}

Finding::Place Context::place_of_face(std::int64_t face) const {
  return {.at = centre(corners_of_face(face)), .group = name_of(2, tag_of_face(face)), .face = face};
}

Finding::Place Context::place_of_half_face(std::int64_t half_face) const {
  std::array<std::int64_t, 4> corners{};
  const auto n = static_cast<std::size_t>(corners_of_half_face(half_face, corners));
  return {.cell = half_face >> 3, .at = centre(std::span(corners).first(n)), .group = name_of(3, tag_of_cell(half_face >> 3))};
}

Finding::Place Context::place_of_node(std::int64_t node) const {
  return {.at = mesh.nodes[static_cast<std::size_t>(node)], .group = {}, .node = node};
}

CheckLog::CheckLog(Report& report, const Context& context, std::string name)
    : report_(report), context_(context), start_s_(cpu_seconds()) {
  run_.name = std::move(name);
}

CheckLog::~CheckLog() {
  for (const auto& [code, given] : given_) {
    if (given.count_beyond == 0) continue;
    report_.findings.push_back({code,
                                given.severity,
                                fmt::format("and the same for {} more groups or nets", given.findings - max_findings_of_a_code),
                                given.count_beyond,
                                {}});
  }
  run_.cpu_s = cpu_seconds() - start_s_;
  report_.checks.push_back(std::move(run_));
}

void CheckLog::found(std::string_view code, FindingSeverity severity, std::string text, const Tally& tally, PlaceKind kind) {
  if (tally.count() == 0) return;
  std::vector<Finding::Place> places;
  for (const std::int64_t id : tally.kept()) {
    switch (kind) {
      case PlaceKind::cell:
        places.push_back(context_.place_of_cell(id));
        break;
      case PlaceKind::face:
        places.push_back(context_.place_of_face(id));
        break;
      case PlaceKind::half_face:
        places.push_back(context_.place_of_half_face(id));
        break;
      case PlaceKind::node:
        places.push_back(context_.place_of_node(id));
        break;
      case PlaceKind::none:
        break;
    }
  }
  found(code, severity, std::move(text), tally.count(), std::move(places));
}

void CheckLog::found(std::string_view code, FindingSeverity severity, std::string text, std::int64_t count,
                     std::vector<Finding::Place> places) {
  run_.num_found += count;
  Given& given = given_.try_emplace(std::string(code)).first->second;
  given.severity = severity;
  is_last_kept_ = ++given.findings <= max_findings_of_a_code;
  if (!is_last_kept_) {
    given.count_beyond += count;
    return;
  }
  report_.findings.push_back({std::string(code), severity, std::move(text), count, std::move(places)});
}

void CheckLog::describe_last(std::vector<std::string> nets, std::string layer) {
  if (!is_last_kept_) return;
  report_.findings.back().nets = std::move(nets);
  report_.findings.back().layer = std::move(layer);
}

}  // namespace pcbmesh::validation::checks
