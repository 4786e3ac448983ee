// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "src/triangulate/cdt.hpp"
#include "src/triangulate/copper_distance.hpp"

namespace pcbmesh::triangulate {

/// What is asked of every triangle, and the one function that measures it. Lengths are in units of the triangulation.
class MeshBounds {
 public:
  enum class Verdict { good, bad_shape, too_long };

  struct Shape {
    double longest2 = 0, middle2 = 0, shortest2 = 0;  // squared edge lengths
    int shortest = 0;                                 // corner opposite to the shortest edge
    double sine2 = 0;                                 // of the smallest angle
  };

  /// @param min_angle_deg  20.7 stands for the paper's bound B = 1/8 exactly
  /// @param floor  edges shorter than this are never split and never the reason to refine: what ends refinement between
  /// near-coincident edges
  MeshBounds(double longest_edge, double min_angle_deg, double floor);

  /// Wanted edge length: at_copper + growth * distance, at most the longest edge; `copper` must outlive this.
  void set_grading(double edge_at_copper, double growth, const SegmentDistance& copper);

  /// Wanted edge length inside a footprint, whose edges are constrained.
  struct Spot {
    std::vector<std::vector<std::array<double, 2>>> rings;  ///< even-odd
    double longest_edge = 0;
  };
  void add_spot(Spot spot);

  [[nodiscard]] double sine2_bound() const { return sine2_bound_; }
  [[nodiscard]] double longest_edge() const { return longest_; }
  [[nodiscard]] double floor() const { return floor_; }
  [[nodiscard]] double longest2() const { return longest2_; }

  [[nodiscard]] static Shape measure(const Kernel::Point_2& p, const Kernel::Point_2& q, const Kernel::Point_2& r) {
    const auto squared = [](const Kernel::Point_2& a, const Kernel::Point_2& b) {
      const double dx = b.x() - a.x(), dy = b.y() - a.y();
      return dx * dx + dy * dy;
    };
    const std::array<double, 3> edge2{squared(q, r), squared(r, p), squared(p, q)};
    Shape shape;
    shape.shortest = edge2[0] <= edge2[1] ? (edge2[0] <= edge2[2] ? 0 : 2) : (edge2[1] <= edge2[2] ? 1 : 2);
    shape.shortest2 = edge2[static_cast<std::size_t>(shape.shortest)];
    const double a = edge2[static_cast<std::size_t>((shape.shortest + 1) % 3)],
                 b = edge2[static_cast<std::size_t>((shape.shortest + 2) % 3)];
    shape.longest2 = std::max(a, b);
    shape.middle2 = std::min(a, b);
    const double cross = (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    shape.sine2 = cross * cross / (shape.longest2 * shape.middle2);
    return shape;
  }

  [[nodiscard]] static Shape measure(Cdt::Face_handle face) {
    return measure(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point());
  }

  [[nodiscard]] Verdict judge(Cdt::Face_handle face, const Shape& shape) const {
    if (shape.longest2 > longest2_) return Verdict::too_long;
    if (!spots_.empty() && is_too_long_in_spot(face, shape.longest2)) return Verdict::too_long;
    if (copper_ != nullptr && shape.longest2 > at_copper2_ && is_too_long_here(face, shape.longest2)) return Verdict::too_long;
    if (!(shape.sine2 < sine2_bound_) || shape.shortest2 < floor2_) return Verdict::good;
    return is_forced(face, shape.shortest) ? Verdict::good : Verdict::bad_shape;
  }

  /// Bad enough that shells round a corner of the graph may be split once more for it. Not below a hundred times the floor:
  /// there the triangle belongs to a corner sharper than the bound, and splitting would go on for ever.
  [[nodiscard]] bool is_worth_a_shell(const Shape& shape) const {
    return shape.sine2 < sine2_bound_ && shape.shortest2 > 1e4 * floor2_;
  }

  /// Is the angle at this corner an angle of the graph itself? No vertex can improve it.
  [[nodiscard]] static bool is_forced(Cdt::Face_handle face, int corner) {
    return face->is_constrained(Cdt::cw(corner)) && face->is_constrained(Cdt::ccw(corner));
  }

 private:
  [[nodiscard]] bool is_too_long_here(Cdt::Face_handle face, double longest2) const;
  [[nodiscard]] bool is_too_long_in_spot(Cdt::Face_handle face, double longest2) const;
  [[nodiscard]] double wanted(Cdt::Vertex_handle vertex) const;

  double longest_ = 0, longest2_ = 0, sine2_bound_ = 0, floor_ = 0, floor2_ = 0;
  double at_copper_ = 0, at_copper2_ = 0, growth_ = 0;
  const SegmentDistance* copper_ = nullptr;
  struct BoxedSpot {
    Spot spot;
    std::array<double, 2> min, max;
  };
  std::vector<BoxedSpot> spots_;
};

}  // namespace pcbmesh::triangulate
