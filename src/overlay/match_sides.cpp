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

void match_sides(std::vector<Point>& vertices, const model::Model& model, Nm tolerance_nm) {
  const auto is_periodic = [&](std::size_t side) { return model.sides()[side].kind == model::SideKind::periodic; };
  geometry::Box box;
  for (const model::BodyShape& shape : model.shapes())
    if (shape.body == 0)
      for (const geometry::Ring& ring : shape.rings) box.add(geometry::bounds(ring));
  for (const bool in_x : {true, false}) {
    if (!is_periodic(in_x ? 0 : 2)) continue;
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
