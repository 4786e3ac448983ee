// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/view/cell_faces.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

namespace pcbmesh::view {
namespace {

std::size_t index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// A face of a cell, or one that carries a tag. Four corners are known by the three smallest, apart from triangles.
struct Entry {
  std::int64_t lowest = 0, second = 0, third = 0;
  std::int64_t owner = 0;  ///< cell << 3 | local face; of a tagged face -1 - index of its tag
  bool is_quad = false;
  [[nodiscard]] auto key() const { return std::tie(second, third, is_quad); }
};

Entry entry_of(std::array<std::int64_t, 4> nodes, int size, std::int64_t owner) {
  if (size == 3) nodes[3] = std::numeric_limits<std::int64_t>::max();
  // A sorting network: five comparisons, no branches.
  constexpr std::array<std::array<std::size_t, 2>, 5> steps{{{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}}};
  for (const auto& [i, j] : steps) {
    const auto [low, high] = std::minmax({nodes[i], nodes[j]});
    nodes[i] = low;
    nodes[j] = high;
  }
  return {nodes[0], nodes[1], nodes[2], owner, size == 4};
}

template <class Visit>
void visit_entries(const CellMesh& mesh, std::span<const CellFaceTag> tags, Visit&& visit) {
  std::int64_t cell = 0;
  for (const mesh::CellBlock& block : mesh.mesh().cells) {
    const auto faces = local_faces(block.kind);
    const std::int64_t* corners = block.corners.data();
    for (std::int64_t i = 0; i < block.size(); ++i, ++cell, corners += mesh::corners_of(block.kind)) {
      if (mesh.group_of(cell) < 0) continue;
      for (std::size_t f = 0; f < faces.size(); ++f) {
        std::array<std::int64_t, 4> nodes{};
        for (int k = 0; k < faces[f].num_corners; ++k) nodes[index(k)] = corners[faces[f].corners[index(k)]];
        visit(entry_of(nodes, faces[f].num_corners, cell << 3 | static_cast<std::int64_t>(f)));
      }
    }
  }
  const auto num_nodes = static_cast<std::int64_t>(mesh.mesh().nodes.size());
  for (const mesh::FaceBlock& block : mesh.mesh().faces) {
    const int size = mesh::corners_of(block.kind);
    for (std::int64_t i = 0; i < block.size(); ++i) {
      const auto found = std::lower_bound(tags.begin(), tags.end(), block.tags[index(i)],
                                          [](const CellFaceTag& t, std::int32_t id) { return t.id < id; });
      if (found == tags.end() || found->id != block.tags[index(i)]) continue;
      std::array<std::int64_t, 4> nodes{};
      bool is_known = true;
      for (int k = 0; k < size; ++k) {
        nodes[index(k)] = block.corners[index(i * size + k)];
        is_known = is_known && nodes[index(k)] >= 0 && nodes[index(k)] < num_nodes;
      }
      if (is_known) visit(entry_of(nodes, size, -1 - (found - tags.begin())));
    }
  }
}

/// Corners of a cell's face, turned outwards whatever the cell's own orientation.
CellFace face_of(const CellMesh& mesh, std::int64_t owner) {
  CellFace out;
  out.cell = owner >> 3;
  out.group = mesh.group_of(out.cell);
  const CellMesh::Cell cell = mesh.cell(out.cell);
  const LocalFace& local = local_faces(cell.kind)[index(owner & 7)];
  for (int k = 0; k < local.num_corners; ++k) out.nodes[index(k)] = cell.corners[index(local.corners[index(k)])];
  const auto p = mesh.node_m(out.nodes[0]), q = mesh.node_m(out.nodes[1]), r = mesh.node_m(out.nodes[2]),
             middle = mesh.centre_m(out.cell);
  double outwards = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    outwards += ((q[i] - p[i]) * (r[j] - p[j]) - (q[j] - p[j]) * (r[i] - p[i])) * (p[k] - middle[k]);
  }
  if (outwards < 0) std::reverse(out.nodes.begin(), out.nodes.begin() + local.num_corners);
  return out;
}

/// Takes the entries of one face: tags before cells, cells ascending.
void put_face(const CellMesh& mesh, std::span<const Entry> same, std::span<CellFaceTag> tags,
              std::vector<std::pair<std::int64_t, CellFace>>& out) {
  std::int32_t tag = -1;
  while (!same.empty() && same.front().owner < 0) {
    tag = static_cast<std::int32_t>(-1 - same.front().owner);
    same = same.subspan(1);
  }
  // A face of three cells is a fault that the check tells; it is drawn as a pair and a single one.
  for (; !same.empty(); same = same.subspan(std::min<std::size_t>(2, same.size()))) {
    const bool has_pair = same.size() > 1;
    const std::int32_t other = has_pair ? mesh.group_of(same[1].owner >> 3) : -1;
    if (has_pair && tag < 0 && other == mesh.group_of(same[0].owner >> 3)) continue;
    CellFace face = face_of(mesh, same[0].owner);
    face.tag = tag;
    if (has_pair) {
      face.neighbour = same[1].owner >> 3;
      face.neighbour_group = other;
      if (tag >= 0) tags[index(tag)].is_inner = true;
    }
    out.emplace_back(same[0].owner, face);
  }
}

}  // namespace

std::vector<CellFace> match_cell_faces(const CellMesh& mesh, std::span<CellFaceTag> tags, std::int64_t most_at_once) {
  const std::size_t num_nodes = mesh.mesh().nodes.size();
  std::vector<std::int64_t> starts(num_nodes + 1, 0);
  visit_entries(mesh, tags, [&](const Entry& e) { ++starts[index(e.lowest) + 1]; });
  for (std::size_t i = 0; i < num_nodes; ++i) starts[i + 1] += starts[i];
  std::vector<std::pair<std::int64_t, CellFace>> found;
  std::vector<Entry> entries;
  std::vector<std::int64_t> next;
  for (std::size_t first = 0; first < num_nodes;) {
    std::size_t last = first + 1;
    while (last < num_nodes && starts[last + 1] - starts[first] <= most_at_once) ++last;
    entries.resize(index(starts[last] - starts[first]));
    next.assign(starts.begin() + static_cast<std::ptrdiff_t>(first), starts.begin() + static_cast<std::ptrdiff_t>(last));
    visit_entries(mesh, tags, [&](const Entry& e) {
      if (index(e.lowest) >= first && index(e.lowest) < last)
        entries[index(next[index(e.lowest) - first]++ - starts[first])] = e;
    });
    for (std::size_t node = first; node < last; ++node) {
      const auto here = std::span(entries).subspan(index(starts[node] - starts[first]), index(starts[node + 1] - starts[node]));
      std::sort(here.begin(), here.end(),
                [](const Entry& a, const Entry& b) { return a.key() != b.key() ? a.key() < b.key() : a.owner < b.owner; });
      for (std::size_t i = 0; i < here.size();) {
        std::size_t end = i + 1;
        while (end < here.size() && here[end].key() == here[i].key()) ++end;
        put_face(mesh, here.subspan(i, end - i), tags, found);
        i = end;
      }
    }
    first = last;
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<CellFace> out;
  out.reserve(found.size());
  for (auto& [owner, face] : found) out.push_back(face);
  return out;
}

}  // namespace pcbmesh::view
