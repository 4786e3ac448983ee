// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/mesh_bounds.hpp"

#include <cmath>
#include <numbers>

namespace pcbmesh::triangulate {
namespace {

// An edge of exactly the asked length passes, however the caller's arithmetic rounded that length.
constexpr double tie = 1 + 1e-12;

constexpr double paper_angle_deg = 20.7, paper_bound = 0.125;

}  // namespace

MeshBounds::MeshBounds(double longest_edge_nm, double min_angle_deg)
    : longest_nm_(longest_edge_nm),
      longest2_(longest_edge_nm * longest_edge_nm * tie),
      floor_nm_(std::min(50.0, longest_edge_nm / 8)) {
  const double sine = std::sin(min_angle_deg * std::numbers::pi / 180);
  sine2_bound_ = min_angle_deg == paper_angle_deg ? paper_bound : sine * sine;
  floor2_ = floor_nm_ * floor_nm_;
}

void MeshBounds::set_grading(double edge_at_copper_nm, double growth, const SegmentDistance& copper) {
  at_copper_nm_ = std::min(edge_at_copper_nm, longest_nm_);
  at_copper2_ = at_copper_nm_ * at_copper_nm_ * tie;
  growth_ = growth;
  copper_ = &copper;
  floor_nm_ = std::min(floor_nm_, edge_at_copper_nm / 8);
  floor2_ = floor_nm_ * floor_nm_;
}

double MeshBounds::wanted_nm(Cdt::Vertex_handle vertex) const {
  if (vertex->wanted_edge_nm() < 0) {
    // Beyond this distance the field has reached the longest edge: the search may stop there.
    const double reach = growth_ > 0 ? (longest_nm_ - at_copper_nm_) / growth_ : 0;
    const double distance = copper_->at(vertex->point().x(), vertex->point().y(), growth_ > 0 ? reach : 1e300);
    vertex->set_wanted_edge_nm(static_cast<float>(at_copper_nm_ + growth_ * distance));
  }
  return static_cast<double>(vertex->wanted_edge_nm());
}

bool MeshBounds::is_too_long_here(Cdt::Face_handle face, double longest2) const {
  const double wanted = std::min({wanted_nm(face->vertex(0)), wanted_nm(face->vertex(1)), wanted_nm(face->vertex(2))});
  return longest2 > wanted * wanted * (1 + 1e-6);  // the cache holds floats
}

}  // namespace pcbmesh::triangulate
