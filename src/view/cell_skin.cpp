// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <utility>

#include "pcbmesh/view/cell_mesh.hpp"
#include "src/view/cell_faces.hpp"
#include "src/view/section_plane.hpp"

namespace pcbmesh::view {
namespace {

std::size_t index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Per group: faces show between different classes; -1 = not there.
std::vector<std::int32_t> classes_of(const CellMesh& mesh, const Visibility& visibility) {
  std::vector<std::int32_t> out;
  for (std::size_t g = 0; g < mesh.groups().size(); ++g) {
    const bool is_hidden = !visibility.hidden_groups.empty() && visibility.hidden_groups[g] != 0;
    const CellGroup& group = mesh.groups()[g];
    const auto own = static_cast<std::int32_t>(g);
    out.push_back(is_hidden                             ? -1
                  : visibility.mode == SkinMode::outer  ? 0
                  : visibility.mode == SkinMode::layers ? group.band
                  : visibility.mode == SkinMode::groups ? own
                  : group.material >= 0                 ? group.material
                                                        : static_cast<std::int32_t>(mesh.materials().size()) + own);
  }
  return out;
}

SkinPolygon polygon_of(const CellMesh& mesh, const Visibility& visibility, const CellFace& face, bool is_turned) {
  SkinPolygon out;
  for (int i = 0; i < face.size(); ++i) out.corners[index(out.size++)] = mesh.node_m(face.nodes[index(i)]);
  if (is_turned) std::reverse(out.corners.begin(), out.corners.begin() + out.size);
  return visibility.section ? cut(out, *visibility.section) : out;
}

/// Where the plane meets a cell, counter-clockwise seen from the side that was cut away.
SkinPolygon section_of(const CellMesh& mesh, const SectionPlane& plane, std::int64_t c) {
  const CellMesh::Cell cell = mesh.cell(c);
  const auto axis = static_cast<std::size_t>(plane.axis), u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::array<double, 8> depth{};
  bool any_below = false, any_above = false;
  for (std::size_t i = 0; i < cell.corners.size(); ++i) {
    depth[i] = above(plane, mesh.node_m(cell.corners[i])[axis]);
    (depth[i] < 0 ? any_below : any_above) = true;
  }
  SkinPolygon out;
  if (!any_below || !any_above) return out;
  for (const LocalFace& face : local_faces(cell.kind)) {
    for (int i = 0; i < face.num_corners; ++i) {
      const auto a = index(face.corners[index(i)]), b = index(face.corners[index((i + 1) % face.num_corners)]);
      // Each edge once: from its corner below.
      if (!(depth[a] < 0 && depth[b] >= 0) || out.size == 6) continue;
      const auto p = mesh.node_m(cell.corners[a]), q = mesh.node_m(cell.corners[b]);
      const double s = depth[a] / (depth[a] - depth[b]);
      auto& at = out.corners[index(out.size++)];
      for (std::size_t k = 0; k < 3; ++k) at[k] = p[k] + s * (q[k] - p[k]);
      at[axis] = plane.at_m;
    }
  }
  if (out.size < 3) return {};
  double mu = 0, mv = 0;
  for (int i = 0; i < out.size; ++i) {
    mu += out.corners[index(i)][u] / out.size;
    mv += out.corners[index(i)][v] / out.size;
  }
  // At most six corners, by their direction from the middle.
  const auto turn = [&](const std::array<double, 3>& p) { return std::atan2(p[v] - mv, p[u] - mu); };
  for (int i = 1; i < out.size; ++i)
    for (int k = i; k > 0 && turn(out.corners[index(k)]) < turn(out.corners[index(k - 1)]); --k)
      std::swap(out.corners[index(k)], out.corners[index(k - 1)]);
  if (plane.keep_above) std::reverse(out.corners.begin(), out.corners.begin() + out.size);
  return out;
}

bool is_brought_out(const CellFaceTag& tag) {
  return tag.kind == "sheet" || tag.kind == "port" || tag.kind == "wave_port";
}

}  // namespace

void visit_cell_skin(const CellMesh& mesh, const Visibility& visibility, const CellSkinVisitor& visit) {
  const std::vector<std::int32_t> classes = classes_of(mesh, visibility);
  for (const CellFace& face : mesh.faces()) {
    const std::int32_t here = classes[index(face.group)],
                       there = face.neighbour_group < 0 ? -1 : classes[index(face.neighbour_group)];
    if (here == there) continue;
    for (const bool is_turned : {false, true}) {
      if ((is_turned ? there : here) < 0) continue;
      const SkinPolygon polygon = polygon_of(mesh, visibility, face, is_turned);
      if (polygon.size == 0) continue;
      visit({is_turned ? face.neighbour : face.cell, is_turned ? face.neighbour_group : face.group, face.tag, false, polygon});
    }
  }
  if (!visibility.section) return;
  for (std::int64_t c = 0; c < mesh.num_cells(); ++c) {
    const std::int32_t group = mesh.group_of(c);
    if (group < 0 || classes[index(group)] < 0) continue;
    const SkinPolygon polygon = section_of(mesh, *visibility.section, c);
    if (polygon.size > 0) visit({c, group, -1, true, polygon});
  }
}

void visit_inner_cell_faces(const CellMesh& mesh, const Visibility& visibility, const CellSkinVisitor& visit) {
  const std::vector<std::int32_t> classes = classes_of(mesh, visibility);
  for (const CellFace& face : mesh.faces()) {
    if (face.tag < 0 || face.neighbour < 0 || !is_brought_out(mesh.face_tags()[index(face.tag)])) continue;
    if (classes[index(face.group)] < 0 && classes[index(face.neighbour_group)] < 0) continue;
    const SkinPolygon polygon = polygon_of(mesh, visibility, face, false);
    if (polygon.size > 0) visit({face.cell, face.group, face.tag, false, polygon});
  }
}

SkinCount count_cell_skin(const CellMesh& mesh, const Visibility& visibility) {
  SkinCount count;
  Visibility whole = visibility;
  whole.section.reset();
  visit_cell_skin(mesh, whole,
                  [&](const CellSkinFace& face) { ++(face.polygon.size == 3 ? count.num_triangles : count.num_quads); });
  return count;
}

}  // namespace pcbmesh::view
