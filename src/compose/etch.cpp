// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/etch.hpp"

#include <utility>

#include "pcbmesh/geometry/polygon_sets.hpp"

namespace pcbmesh::compose {
namespace {

using geometry::Ring;
using model::BodyShape;

/// What the shapes cover. A shape that may cross itself is united on its own first, so that its negative loops cancel nothing.
std::vector<Ring> covered(const std::vector<BodyShape>& shapes) {
  std::vector<Ring> rings;
  for (const BodyShape& shape : shapes) {
    std::vector<Ring> own = shape.simple ? shape.rings : geometry::united(shape.rings);
    rings.insert(rings.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  }
  return geometry::united(rings);
}

/// Outer rings with their holes, as shapes of one body: they are apart, so one shape holds them all.
std::vector<BodyShape> as_shapes(std::vector<Ring> rings, std::int64_t line) {
  if (rings.empty()) return {};
  BodyShape shape;
  shape.line = line;
  shape.simple = rings.size() == 1;
  shape.rings = std::move(rings);
  return {std::move(shape)};
}

}  // namespace

std::map<std::int32_t, std::vector<BodyShape>> etched(const std::map<std::int32_t, std::vector<BodyShape>>& by_net, Nm inset) {
  if (inset == 0) return by_net;
  std::map<std::int32_t, std::vector<Ring>> copper;
  std::vector<Ring> all;
  for (const auto& [net, shapes] : by_net) {
    std::vector<Ring> rings = covered(shapes);
    all.insert(all.end(), rings.begin(), rings.end());
    copper.emplace(net, std::move(rings));
  }
  const std::vector<Ring> left = geometry::shrunk(all, inset);
  std::map<std::int32_t, std::vector<BodyShape>> result;
  for (const auto& [net, rings] : copper) {
    geometry::Box box;
    for (const Ring& ring : rings)
      for (const geometry::Point p : ring) box.add(p);
    std::vector<Ring> near;
    for (const Ring& ring : left) {
      geometry::Box own;
      for (const geometry::Point p : ring) own.add(p);
      if (own.touches(box)) near.push_back(ring);
    }
    std::vector<BodyShape> shapes = as_shapes(geometry::intersected(rings, near), by_net.at(net).front().line);
    if (!shapes.empty()) result.emplace(net, std::move(shapes));
  }
  return result;
}

}  // namespace pcbmesh::compose
