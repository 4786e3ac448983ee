// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "validation/checks/checks.hpp"

namespace pcbmesh::validation::checks {
namespace {

using FaceKey = std::array<std::int64_t, 4>;

/// Nodes by place, found within the tolerance.
class PlaceTable {
 public:
  PlaceTable(const Context& context, double tolerance) : context_(context), tolerance_(tolerance), cell_(64 * tolerance) {}

  /// Nodes of one place stand for each other: a crack that reaches the side is another check's business.
  [[nodiscard]] std::int64_t add(std::int64_t node) {
    if (const std::int64_t known = find(at(node)); known >= 0) return known;
    nodes_[key_of(cell_of(at(node)))].push_back(node);
    return node;
  }
  /// -1 if there is none.
  [[nodiscard]] std::int64_t find(const Vector3& place) const {
    const auto low = cell_of({place[0] - tolerance_, place[1] - tolerance_, place[2] - tolerance_}),
               high = cell_of({place[0] + tolerance_, place[1] + tolerance_, place[2] + tolerance_});
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto found = nodes_.find(key_of({x, y, z}));
          if (found == nodes_.end()) continue;
          for (const std::int64_t node : found->second) {
            if (length(at(node) - place) <= tolerance_) return node;
          }
        }
      }
    }
    return -1;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] const Vector3& at(std::int64_t node) const { return context_.mesh.nodes[static_cast<std::size_t>(node)]; }
  [[nodiscard]] Cell cell_of(const Vector3& place) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<std::int64_t>(std::floor((place[axis] - context_.low[axis]) / cell_ + 0.38196601125));
    }
    return cell;
  }
  [[nodiscard]] static std::uint64_t key_of(const Cell& cell) {
    std::uint64_t h = 0;
    for (const std::int64_t c : cell) h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15u;
    return h;
  }

  const Context& context_;
  double tolerance_, cell_;
  std::unordered_map<std::uint64_t, std::vector<std::int64_t>> nodes_;
};

FaceKey sorted_key(std::span<const std::int64_t> corners) {
  FaceKey key{-1, -1, -1, -1};
  std::copy(corners.begin(), corners.end(), key.begin());
  std::sort(key.begin(), key.end());
  return key;
}

std::vector<std::int64_t> faces_of_group(const Context& context, const std::string& name) {
  std::vector<std::int64_t> faces;
  for (int slot = 0; slot < context.face_tags.size(); ++slot) {
    const std::int32_t tag = context.face_tags.tag(slot);
    if (context.name_of(2, tag) != name) continue;
    for (std::int64_t face = 0; face < context.num_faces(); ++face) {
      if (context.tag_of_face(face) == tag) faces.push_back(face);
    }
  }
  return faces;
}

/// Least coordinates of all corners; zero without faces.
Vector3 low_corner(const Context& context, std::span<const std::int64_t> faces) {
  if (faces.empty()) return {};
  constexpr double huge = std::numeric_limits<double>::infinity();
  Vector3 low{huge, huge, huge};
  for (const std::int64_t face : faces) {
    for (const std::int64_t node : context.corners_of_face(face)) {
      const Vector3& at = context.mesh.nodes[static_cast<std::size_t>(node)];
      for (std::size_t axis = 0; axis < 3; ++axis) low[axis] = std::min(low[axis], at[axis]);
    }
  }
  return low;
}

void check_pair(const Context& context, const Expectation::Periodic& pair, CheckLog& log) {
  const std::vector<std::int64_t> faces_a = faces_of_group(context, pair.a), faces_b = faces_of_group(context, pair.b);
  log.examined(static_cast<std::int64_t>(faces_a.size() + faces_b.size()));
  const Vector3 low_a = low_corner(context, faces_a), low_b = low_corner(context, faces_b);
  Vector3 shift = low_b - low_a;
  for (std::size_t axis = 0; axis < 3 && pair.shift_m; ++axis)
    shift[axis] = (*pair.shift_m)[axis] / context.expectation->unit_m;
  PlaceTable table(context, std::max(context.tolerance, 1e-300));
  std::vector<FaceKey> keys;
  for (const std::int64_t face : faces_b) {
    const auto corners = context.corners_of_face(face);
    std::array<std::int64_t, 4> ids{};
    for (std::size_t i = 0; i < corners.size(); ++i) ids[i] = table.add(corners[i]);
    keys.push_back(sorted_key(std::span<const std::int64_t>(ids).first(corners.size())));
  }
  std::sort(keys.begin(), keys.end());
  Tally unmatched;
  std::int64_t num_matched = 0;
  for (const std::int64_t face : faces_a) {
    const auto corners = context.corners_of_face(face);
    std::array<std::int64_t, 4> partners{};
    bool all = true;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Vector3 place = context.mesh.nodes[static_cast<std::size_t>(corners[i])];
      for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += shift[axis];
      partners[i] = table.find(place);
      all = all && partners[i] >= 0;
    }
    const FaceKey key = sorted_key(std::span<const std::int64_t>(partners).first(corners.size()));
    if (all && std::binary_search(keys.begin(), keys.end(), key)) {
      ++num_matched;
    } else {
      unmatched.add(face);
    }
  }
  log.found("periodic.unmatched",
            fmt::format("{} of {} faces of '{}' have no partner in '{}', shifted by ({:.9g}, {:.9g}, {:.9g})",
                        unmatched.count(), faces_a.size(), pair.a, pair.b, shift[0], shift[1], shift[2]),
            unmatched, PlaceKind::face);
  const std::int64_t extra = static_cast<std::int64_t>(faces_b.size()) - num_matched;
  if (unmatched.count() == 0 && extra != 0) {
    log.found("periodic.unmatched", fmt::format("'{}' has {} faces without a partner in '{}'", pair.b, extra, pair.a), extra);
  }
}

/// Partner of every node of a link; what is wrong with the link itself goes to the log.
std::unordered_map<std::int64_t, std::int64_t> partners_of(const Context& context, const mesh::PeriodicLink& link,
                                                           CheckLog& log) {
  std::unordered_map<std::int64_t, std::int64_t> partner_of, node_of;
  Tally twice, moved;
  std::int64_t num_absent = 0;
  double farthest = 0;
  const auto is_node = [&](std::int64_t id) { return id >= 0 && id < context.num_nodes(); };
  for (const auto& [node, partner] : link.nodes) {
    if (!is_node(node) || !is_node(partner)) {
      ++num_absent;
      continue;
    }
    const bool is_new = partner_of.try_emplace(node, partner).first->second == partner;
    if (!is_new || node_of.try_emplace(partner, node).first->second != node) twice.add(node);
    if (!link.from_partner) continue;
    const auto& rows = *link.from_partner;
    const Vector3 &from = context.mesh.nodes[static_cast<std::size_t>(partner)],
                  &at = context.mesh.nodes[static_cast<std::size_t>(node)];
    Vector3 to{};
    for (std::size_t i = 0; i < 3; ++i) {
      to[i] = rows[4 * i] * from[0] + rows[4 * i + 1] * from[1] + rows[4 * i + 2] * from[2] + rows[4 * i + 3];
    }
    const double off = length(at - to);
    if (off <= context.tolerance) continue;
    moved.add(node);
    farthest = std::max(farthest, off);
  }
  if (num_absent > 0)
    log.found("periodic.link", fmt::format("{}: {} pairs name a node that is not in the mesh", link.name, num_absent),
              num_absent);
  log.found("periodic.link", fmt::format("{}: {} nodes have two partners", link.name, twice.count()), twice, PlaceKind::node);
  log.found("periodic.moved",
            fmt::format("{}: {} of {} nodes are not where the file's transformation takes their partners, by up to {:.3g}",
                        link.name, moved.count(), link.nodes.size(), farthest),
            moved, PlaceKind::node);
  return partner_of;
}

/// Faces as sorted corners, `renamed` by the caller; corners without a new name become -1.
template <class Rename>
std::vector<FaceKey> keys_of(std::span<const mesh::FaceBlock> blocks, Rename&& rename) {
  std::vector<FaceKey> keys;
  for (const mesh::FaceBlock& block : blocks) {
    const auto n = static_cast<std::size_t>(corners_of(block.kind));
    for (std::size_t i = 0; i + n <= block.corners.size(); i += n) {
      std::array<std::int64_t, 4> ids{};
      for (std::size_t k = 0; k < n; ++k) ids[k] = rename(block.corners[i + k]);
      keys.push_back(sorted_key(std::span<const std::int64_t>(ids).first(n)));
    }
  }
  return keys;
}

/// A link that the file holds: the partners are named, so faces are compared by ids.
void check_link(const Context& context, const mesh::PeriodicLink& link, CheckLog& log) {
  const auto partner_of = partners_of(context, link, log);
  const auto own = keys_of(link.faces, [](std::int64_t id) { return id; });
  const auto mapped = keys_of(link.faces, [&](std::int64_t id) {
    const auto found = partner_of.find(id);
    return found == partner_of.end() ? -1 : found->second;
  });
  auto partners = keys_of(link.partner_faces, [](std::int64_t id) { return id; });
  std::sort(partners.begin(), partners.end());
  log.examined(static_cast<std::int64_t>(link.nodes.size() + own.size() + partners.size()));
  Tally lonely;
  std::int64_t num_matched = 0;
  for (std::size_t i = 0; i < mapped.size(); ++i) {
    // Corners stand behind the -1 that fill a key up; a corner without a partner is one more of those.
    const bool is_whole = std::ranges::count(mapped[i], -1) == std::ranges::count(own[i], -1);
    // A side that the file holds no faces of can't be compared; that they are missing is face.untagged.
    if (is_whole && (partners.empty() || std::binary_search(partners.begin(), partners.end(), mapped[i]))) {
      ++num_matched;
    } else {
      lonely.add(own[i].back());
    }
  }
  log.found("periodic.unmatched",
            fmt::format("{}: {} of {} faces have no partner with the same corners", link.name, lonely.count(), own.size()),
            lonely, PlaceKind::node);
  const std::int64_t extra = static_cast<std::int64_t>(partners.size()) - num_matched;
  if (lonely.count() == 0 && !own.empty() && extra > 0) {
    log.found("periodic.unmatched", fmt::format("{}: {} faces of the other side have no partner", link.name, extra), extra);
  }
}

}  // namespace

void check_periodic(const Context& context, Report& report) {
  const bool has_groups = context.expectation != nullptr && !context.expectation->periodic.empty();
  if (!has_groups && context.mesh.periodic.empty()) return;
  CheckLog log(report, context, "periodic");
  if (has_groups) {
    for (const auto& pair : context.expectation->periodic) check_pair(context, pair, log);
  }
  for (const mesh::PeriodicLink& link : context.mesh.periodic) check_link(context, link, log);
}

}  // namespace pcbmesh::validation::checks
