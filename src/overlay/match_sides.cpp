// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/match_sides.hpp"

#include <algorithm>
#include <cstdint>

#include "pcbmesh/geometry/ring_contact.hpp"

namespace pcbmesh::overlay {
namespace {

using geometry::Point;

/// Vertices on a side, by their place along it.
std::vector<std::size_t> on_side(const std::vector<Point>& vertices, const geometry::Box& box, Nm Point::*across,
                                 Nm Point::*along, Nm at) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (vertices[i].*across == at && box.contains(vertices[i])) found.push_back(i);
  std::ranges::sort(found, [&](std::size_t a, std::size_t b) { return vertices[a].*along < vertices[b].*along; });
  return found;
}

}  // namespace

PeriodicSides::PeriodicSides(const model::Model& model)
    : in_x_(model.sides()[0].kind == model::SideKind::periodic), in_y_(model.sides()[2].kind == model::SideKind::periodic) {
  if (is_empty()) return;
  for (const model::BodyShape& shape : model.shapes())
    if (shape.body == 0)
      for (const geometry::Ring& ring : shape.rings) box_.add(geometry::bounds(ring));
}

void match_sides(std::vector<Point>& vertices, const model::Model& model, Nm tolerance_nm) {
  const PeriodicSides sides(model);
  const geometry::Box& box = sides.box();
  for (const bool in_x : {true, false}) {
    if (!(in_x ? sides.in_x() : sides.in_y())) continue;
    Nm Point::*const across = in_x ? &Point::x : &Point::y;
    Nm Point::*const along = in_x ? &Point::y : &Point::x;
    const auto low = on_side(vertices, box, across, along, box.min.*across);
    const auto high = on_side(vertices, box, across, along, box.max.*across);
    std::size_t i = 0;
    for (const std::size_t v : high) {
      while (i < low.size() && vertices[low[i]].*along <= vertices[v].*along - tolerance_nm) ++i;
      if (i == low.size()) break;
      if (vertices[low[i]].*along < vertices[v].*along + tolerance_nm) vertices[v].*along = vertices[low[i++]].*along;
    }
  }
}

}  // namespace pcbmesh::overlay
