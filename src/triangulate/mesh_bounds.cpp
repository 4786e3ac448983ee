// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/mesh_bounds.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace pcbmesh::triangulate {
namespace {

// An edge of exactly the asked length passes, however the caller's arithmetic rounded that length.
constexpr double tie = 1 + 1e-12;

constexpr double paper_angle_deg = 20.7, paper_bound = 0.125;

}  // namespace

MeshBounds::MeshBounds(double longest_edge, double min_angle_deg, double floor)
    : longest_(longest_edge), longest2_(longest_edge * longest_edge * tie), floor_(std::min(floor, longest_edge / 8)) {
  const double sine = std::sin(min_angle_deg * std::numbers::pi / 180);
  sine2_bound_ = min_angle_deg == paper_angle_deg ? paper_bound : sine * sine;
  floor2_ = floor_ * floor_;
}

void MeshBounds::set_grading(double edge_at_copper, double growth, const SegmentDistance& copper) {
  at_copper_ = std::min(edge_at_copper, longest_);
  at_copper2_ = at_copper_ * at_copper_ * tie;
  growth_ = growth;
  copper_ = &copper;
  floor_ = std::min(floor_, edge_at_copper / 8);
  floor2_ = floor_ * floor_;
}

void MeshBounds::add_spot(Spot spot) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  BoxedSpot boxed{std::move(spot), {infinity, infinity}, {-infinity, -infinity}};
  for (const auto& ring : boxed.spot.rings)
    for (const auto& p : ring)
      for (std::size_t axis = 0; axis < 2; ++axis) {
        boxed.min[axis] = std::min(boxed.min[axis], p[axis]);
        boxed.max[axis] = std::max(boxed.max[axis], p[axis]);
      }
  floor_ = std::min(floor_, boxed.spot.longest_edge / 8);
  floor2_ = floor_ * floor_;
  spots_.push_back(std::move(boxed));
}

bool MeshBounds::is_too_long_in_spot(Cdt::Face_handle face, double longest2) const {
  const auto &p = face->vertex(0)->point(), &q = face->vertex(1)->point(), &r = face->vertex(2)->point();
  const double x = (p.x() + q.x() + r.x()) / 3, y = (p.y() + q.y() + r.y()) / 3;
  for (const auto& [spot, min, max] : spots_) {
    if (x < min[0] || x > max[0] || y < min[1] || y > max[1] || longest2 <= spot.longest_edge * spot.longest_edge * tie)
      continue;
    bool is_inside = false;
    for (const auto& ring : spot.rings)
      for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
        if ((ring[i][1] > y) != (ring[j][1] > y) &&
            x < ring[i][0] + (ring[j][0] - ring[i][0]) * (y - ring[i][1]) / (ring[j][1] - ring[i][1]))
          is_inside = !is_inside;
    if (is_inside) return true;
  }
  return false;
}

double MeshBounds::wanted(Cdt::Vertex_handle vertex) const {
  if (vertex->wanted_edge() < 0) {
    // Beyond this distance the field has reached the longest edge: the search may stop there.
    const double distance = copper_->at(vertex->point().x(), vertex->point().y(), (longest_ - at_copper_) / growth_);
    vertex->set_wanted_edge(static_cast<float>(at_copper_ + growth_ * distance));
  }
  return static_cast<double>(vertex->wanted_edge());
}

bool MeshBounds::is_too_long_here(Cdt::Face_handle face, double longest2) const {
  const double bound = std::min({wanted(face->vertex(0)), wanted(face->vertex(1)), wanted(face->vertex(2))});
  return longest2 > bound * bound * (1 + 1e-6);  // the cache holds floats
}

}  // namespace pcbmesh::triangulate
