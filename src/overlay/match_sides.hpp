// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "pcbmesh/geometry/point.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::overlay {

/// The sides of the domain that the model calls periodic.
class PeriodicSides {
 public:
  explicit PeriodicSides(const model::Model& model);
  [[nodiscard]] bool is_empty() const { return !in_x_ && !in_y_; }
  /// Whether a point lies on one of them.
  [[nodiscard]] bool hold(geometry::Point p) const {
    if (is_empty() || !box_.contains(p)) return false;
    return (in_x_ && (p.x == box_.min.x || p.x == box_.max.x)) || (in_y_ && (p.y == box_.min.y || p.y == box_.max.y));
  }
  [[nodiscard]] bool in_x() const { return in_x_; }
  [[nodiscard]] bool in_y() const { return in_y_; }
  [[nodiscard]] const geometry::Box& box() const { return box_; }

 private:
  geometry::Box box_;
  bool in_x_ = false, in_y_ = false;
};

/// Where sides are periodic, what crosses both at places nearer than the tolerance crosses them at one: vertices of xmax and
/// ymax move along their side. Vertices and edges are a tolerance apart, so nothing meets that was apart.
void match_sides(std::vector<geometry::Point>& vertices, const model::Model& model, Nm tolerance_nm);

}  // namespace pcbmesh::overlay
