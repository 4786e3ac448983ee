// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/skin.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "pcbmesh/mesh/planar_edges.hpp"
#include "src/view/section_plane.hpp"

namespace pcbmesh::view {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

constexpr std::size_t block_size = 1 << 14;

/// Collects faces and hands them on in blocks.
class FaceStream {
 public:
  explicit FaceStream(const SkinVisitor& visit) : visit_(visit) { block_.reserve(block_size); }
  void put(const SkinFace& face) {
    block_.push_back(face);
    if (block_.size() == block_size) flush();
  }
  void flush() {
    if (!block_.empty()) visit_(block_);
    block_.clear();
  }

 private:
  const SkinVisitor& visit_;
  std::vector<SkinFace> block_;
};

/// Visibility worked out per region and slab, and per triangle.
class Shown {
 public:
  Shown(const mesh::PrismMesh& mesh, const Visibility& visibility) : mesh_(mesh), num_slabs_(mesh.plan().num_slabs()) {
    const mesh::PlanarMesh& planar = mesh.planar();
    regions_ = planar.regions();
    const std::size_t num_cells = index(planar.num_regions()) * index(num_slabs_);
    classes_.assign(num_cells, -1);
    groups_.assign(num_cells, -1);
    std::vector<char> seen(index(planar.num_regions()), 0);
    for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
      const std::int32_t r = regions_[index(t)];
      if (seen[index(r)] != 0) continue;
      seen[index(r)] = 1;
      for (std::int32_t s = 0; s < num_slabs_; ++s) set(r, s, mesh.tag_of(s, t), visibility);
    }
    if (visibility.box_m) mark_outside(*visibility.box_m);
    if (visibility.section) mark_beyond(*visibility.section);
  }

  /// Faces show between different classes; -1 = not there.
  [[nodiscard]] std::int32_t class_of(std::int32_t slab, std::int32_t t) const {
    if (t < 0 || slab < 0 || slab >= num_slabs_ || (!outside_.empty() && outside_[index(t)] != 0)) return -1;
    return classes_[index(regions_[index(t)]) * index(num_slabs_) + index(slab)];
  }
  [[nodiscard]] std::int32_t group_of(std::int32_t slab, std::int32_t t) const {
    if (class_of(slab, t) < 0) return -1;
    return groups_[index(regions_[index(t)]) * index(num_slabs_) + index(slab)];
  }
  [[nodiscard]] bool has_box() const { return !outside_.empty(); }
  [[nodiscard]] bool is_beyond(std::int32_t t) const { return !beyond_.empty() && beyond_[index(t)] != 0; }
  [[nodiscard]] bool same_region(std::int32_t t, std::int32_t u) const { return regions_[index(t)] == regions_[index(u)]; }

 private:
  void set(std::int32_t region, std::int32_t slab, std::int32_t group, const Visibility& visibility) {
    if (group < 0 || (!visibility.hidden_groups.empty() && visibility.hidden_groups[index(group)] != 0)) return;
    const std::size_t cell = index(region) * index(num_slabs_) + index(slab);
    groups_[cell] = group;
    switch (visibility.mode) {
      case SkinMode::outer:
        classes_[cell] = 0;
        break;
      case SkinMode::materials:
        classes_[cell] = mesh_.volume_tags()[index(group)].material;
        break;
      case SkinMode::groups:
        classes_[cell] = group;
        break;
      case SkinMode::layers:
        classes_[cell] = mesh_.volume_tags()[index(group)].layer;
        break;
    }
  }
  void mark_outside(const std::array<double, 4>& box) {
    const auto triangles = mesh_.planar().triangles();
    const auto points = mesh_.planar().points_m();
    outside_.resize(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      double x = 0, y = 0;
      for (const std::int32_t v : triangles[t]) {
        x += points[index(v)][0] / 3;
        y += points[index(v)][1] / 3;
      }
      outside_[t] = x < box[0] || y < box[1] || x > box[2] || y > box[3] ? 1 : 0;
    }
  }
  void mark_beyond(const SectionPlane& plane) {
    if (plane.axis == 2) return;
    const auto triangles = mesh_.planar().triangles();
    const auto points = mesh_.planar().points_m();
    beyond_.resize(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      beyond_[t] = 1;
      for (const std::int32_t v : triangles[t]) {
        const double depth = above(plane, points[index(v)][static_cast<std::size_t>(plane.axis)]);
        if (plane.keep_above ? depth > 0 : depth < 0) beyond_[t] = 0;
      }
    }
  }

  const mesh::PrismMesh& mesh_;
  std::int32_t num_slabs_;
  std::span<const std::int32_t> regions_;
  std::vector<std::int32_t> classes_, groups_;
  std::vector<char> outside_, beyond_;
};

void put_caps(const mesh::PrismMesh& mesh, const Shown& shown, FaceStream& out) {
  const std::int32_t num_slabs = mesh.plan().num_slabs(), num_triangles = mesh.planar().num_triangles();
  for (std::int32_t face = 0; face <= num_slabs; ++face) {
    for (std::int32_t t = 0; t < num_triangles; ++t) {
      const std::int32_t below = shown.class_of(face - 1, t), above = shown.class_of(face, t);
      if (below == above || shown.is_beyond(t)) continue;
      const std::int32_t lower = shown.group_of(face - 1, t), upper = shown.group_of(face, t);
      if (below >= 0) out.put({SkinFaceKind::up, face - 1, t, -1, -1, lower, upper});
      if (above >= 0) out.put({SkinFaceKind::down, face, t, -1, -1, upper, lower});
    }
  }
}

void put_walls(const mesh::PrismMesh& mesh, const Shown& shown, FaceStream& out) {
  const std::int32_t num_slabs = mesh.plan().num_slabs();
  mesh::visit_planar_edges(mesh.planar(), [&](const mesh::PlanarEdge& edge) {
    // Where no box cuts through regions, cells of one region differ nowhere.
    if (edge.right >= 0 && !shown.has_box() && shown.same_region(edge.left, edge.right)) return;
    for (std::int32_t s = 0; s < num_slabs; ++s) {
      const std::int32_t left = shown.class_of(s, edge.left), right = shown.class_of(s, edge.right);
      if (left == right) continue;
      const std::int32_t here = shown.group_of(s, edge.left), there = shown.group_of(s, edge.right);
      if (left >= 0 && !shown.is_beyond(edge.left)) out.put({SkinFaceKind::wall, s, edge.left, edge.a, edge.b, here, there});
      if (right >= 0 && !shown.is_beyond(edge.right)) out.put({SkinFaceKind::wall, s, edge.right, edge.b, edge.a, there, here});
    }
  });
}

void put_section(const mesh::PrismMesh& mesh, const Shown& shown, const SectionPlane& plane, FaceStream& out) {
  const auto triangles = mesh.planar().triangles();
  const auto points = mesh.planar().points_m();
  const std::int32_t num_slabs = mesh.plan().num_slabs();
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
    if (plane.axis != 2) {
      int num_below = 0, num_above = 0;
      for (const std::int32_t v : triangles[index(t)]) {
        const double depth = above(plane, points[index(v)][static_cast<std::size_t>(plane.axis)]);
        num_below += depth < 0 ? 1 : 0;
        num_above += depth > 0 ? 1 : 0;
      }
      if (num_below == 0 || num_above == 0) continue;
    }
    for (std::int32_t s = 0; s < num_slabs; ++s) {
      if (shown.class_of(s, t) < 0) continue;
      const auto [low, high] = slab_z_m(mesh, s);
      if (plane.axis == 2 && !(above(plane, low) < 0 && above(plane, high) > 0)) continue;
      out.put({SkinFaceKind::section, s, t, -1, -1, shown.group_of(s, t), -1});
    }
  }
}

SkinPolygon section_polygon(const mesh::PrismMesh& mesh, const SectionPlane& plane, const SkinFace& face) {
  const auto& corners = mesh.planar().triangles()[index(face.triangle)];
  const auto points = mesh.planar().points_m();
  SkinPolygon out;
  if (plane.axis == 2) {
    for (const std::int32_t v : corners)
      out.corners[index(out.size++)] = {points[index(v)][0], points[index(v)][1], plane.at_m};
    if (plane.keep_above) std::swap(out.corners[0], out.corners[1]);
    return out;
  }
  const auto axis = static_cast<std::size_t>(plane.axis);
  std::array<std::array<double, 2>, 3> hits{};
  std::size_t num_hits = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &p = points[index(corners[i])], &q = points[index(corners[(i + 1) % 3])];
    const double dp = above(plane, p[axis]), dq = above(plane, q[axis]);
    // Each corner on the plane counts once, as the start of its side.
    if (dp == 0)
      hits[num_hits++] = p;
    else if ((dp < 0) != (dq < 0) && dq != 0)
      hits[num_hits++] = {p[0] + dp / (dp - dq) * (q[0] - p[0]), p[1] + dp / (dp - dq) * (q[1] - p[1])};
  }
  if (num_hits != 2) return out;
  hits[0][axis] = hits[1][axis] = plane.at_m;
  // Seen from the side that was cut away, the quadrilateral runs counter-clockwise.
  const std::size_t along = 1 - axis;
  const bool ascending = (axis == 0) != plane.keep_above;
  if ((hits[0][along] < hits[1][along]) != ascending) std::swap(hits[0], hits[1]);
  const auto [low, high] = slab_z_m(mesh, face.slab);
  out.corners[0] = {hits[0][0], hits[0][1], low};
  out.corners[1] = {hits[1][0], hits[1][1], low};
  out.corners[2] = {hits[1][0], hits[1][1], high};
  out.corners[3] = {hits[0][0], hits[0][1], high};
  out.size = 4;
  return out;
}

}  // namespace

std::array<double, 2> slab_z_m(const mesh::PrismMesh& mesh, std::int32_t slab) {
  const mesh::LayerPlan& plan = mesh.plan();
  return {plan.z_m()[index(plan.first_sublayer(slab))], plan.z_m()[index(plan.first_sublayer(slab + 1))]};
}

void visit_skin(const mesh::PrismMesh& mesh, const Visibility& visibility, const SkinVisitor& visit) {
  const Shown shown(mesh, visibility);
  FaceStream out(visit);
  put_caps(mesh, shown, out);
  put_walls(mesh, shown, out);
  if (visibility.section) put_section(mesh, shown, *visibility.section, out);
  out.flush();
}

void visit_inner_faces(const mesh::PrismMesh& mesh, const Visibility& visibility, const TaggedFaceVisitor& visit) {
  const auto is_inner = [&](std::int32_t tag) { return mesh.face_tags()[index(tag)].is_inner; };
  if (std::none_of(mesh.face_tags().begin(), mesh.face_tags().end(), [](const mesh::FaceTag& tag) { return tag.is_inner; }))
    return;
  const Shown shown(mesh, visibility);
  for (const mesh::Cap& cap : mesh.caps()) {
    if (!is_inner(cap.tag) || shown.is_beyond(cap.triangle)) continue;
    const std::int32_t above = mesh.plan().slab_of_sublayer()[index(cap.level)];
    if (shown.class_of(above - 1, cap.triangle) < 0 && shown.class_of(above, cap.triangle) < 0) continue;
    visit({{SkinFaceKind::up, above - 1, cap.triangle, -1, -1, mesh.tag_of(above - 1, cap.triangle), -1}, cap.tag});
  }
  std::map<std::array<std::int32_t, 2>, std::array<std::int32_t, 2>> beside;  // edge -> triangles to its left and right
  for (const mesh::Wall& wall : mesh.walls())
    if (is_inner(wall.tag)) beside[{std::min(wall.a, wall.b), std::max(wall.a, wall.b)}] = {-1, -1};
  if (beside.empty()) return;
  mesh::visit_planar_edges(mesh.planar(), [&](const mesh::PlanarEdge& edge) {
    const auto found = beside.find({std::min(edge.a, edge.b), std::max(edge.a, edge.b)});
    if (found != beside.end()) found->second = {edge.left, edge.right};
  });
  for (const mesh::Wall& wall : mesh.walls()) {
    if (!is_inner(wall.tag)) continue;
    const auto& [left, right] = beside.at({std::min(wall.a, wall.b), std::max(wall.a, wall.b)});
    if (shown.class_of(wall.slab, left) < 0 && shown.class_of(wall.slab, right) < 0) continue;
    if (shown.is_beyond(left)) continue;
    visit({{SkinFaceKind::wall, wall.slab, left, wall.a, wall.b, mesh.tag_of(wall.slab, left), -1}, wall.tag});
  }
}

SkinCount count_skin(const mesh::PrismMesh& mesh, const Visibility& visibility) {
  SkinCount count;
  visit_skin(mesh, visibility, [&](std::span<const SkinFace> faces) {
    for (const SkinFace& face : faces) {
      if (face.kind == SkinFaceKind::wall)
        count.num_quads += mesh.plan().first_sublayer(face.slab + 1) - mesh.plan().first_sublayer(face.slab);
      else
        ++count.num_triangles;
    }
  });
  return count;
}

SkinPolygon polygon_of(const mesh::PrismMesh& mesh, const Visibility& visibility, const SkinFace& face) {
  if (face.kind == SkinFaceKind::section) return section_polygon(mesh, *visibility.section, face);
  const auto [low, high] = slab_z_m(mesh, face.slab);
  const auto points = mesh.planar().points_m();
  SkinPolygon out;
  if (face.kind == SkinFaceKind::wall) {
    // The cell lies to the left of a -> b, so seen from outside b is on the left.
    const auto &a = points[index(face.a)], &b = points[index(face.b)];
    out.corners[0] = {a[0], a[1], low};
    out.corners[1] = {b[0], b[1], low};
    out.corners[2] = {b[0], b[1], high};
    out.corners[3] = {a[0], a[1], high};
    out.size = 4;
  } else {
    const bool is_up = face.kind == SkinFaceKind::up;
    for (const std::int32_t v : mesh.planar().triangles()[index(face.triangle)])
      out.corners[index(out.size++)] = {points[index(v)][0], points[index(v)][1], is_up ? high : low};
    if (!is_up) std::swap(out.corners[1], out.corners[2]);
  }
  return visibility.section ? cut(out, *visibility.section) : out;
}

std::vector<char> air_groups(const mesh::PrismMesh& mesh) {
  std::vector<char> out;
  for (const mesh::VolumeTag& tag : mesh.volume_tags()) {
    const board::Material& m = mesh.materials()[index(tag.material)];
    out.push_back(tag.net < 0 && m.eps_r == 1 && m.mu_r == 1 && m.tan_delta == 0 && m.sigma_s_per_m == 0 ? 1 : 0);
  }
  return out;
}

}  // namespace pcbmesh::view
