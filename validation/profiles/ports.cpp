// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/profiles/ports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "validation/checks/cell_shapes.hpp"

namespace pcbmesh::validation::profiles {
namespace {

using checks::operator-, checks::cross, checks::dot, checks::length, checks::Vector3;
using Point = std::array<double, 2>;
using NodePair = std::array<std::int64_t, 2>;

Vector3 twice_area(const checks::Context& context, std::int64_t face) {
  const auto corners = context.corners_of_face(face);
  const auto at = [&](std::size_t i) -> const Vector3& { return context.mesh.nodes[static_cast<std::size_t>(corners[i])]; };
  return corners.size() == 3 ? cross(at(1) - at(0), at(2) - at(0)) : cross(at(2) - at(0), at(3) - at(1));
}

double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Counter-clockwise (Andrew 1979).
std::vector<Point> convex_hull(std::vector<Point> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Point> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t base = hull.size();
    for (const Point& point : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// A smallest enclosing rectangle has a side on the hull.
double smallest_rectangle(const std::vector<Point>& hull) {
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point &a = hull[i], &b = hull[(i + 1) % hull.size()];
    const double size = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (size == 0) continue;
    const Point along{(b[0] - a[0]) / size, (b[1] - a[1]) / size};
    double left = 0, right = 0, high = 0;
    for (const Point& p : hull) {
      const Point d{p[0] - a[0], p[1] - a[1]};
      const double s = d[0] * along[0] + d[1] * along[1];
      left = std::min(left, s);
      right = std::max(right, s);
      high = std::max(high, along[0] * d[1] - along[1] * d[0]);
    }
    smallest = std::min(smallest, (right - left) * high);
  }
  return smallest;
}

std::set<NodePair> rim_of(const checks::Context& context, const FaceGroup& port) {
  std::set<NodePair> rim;
  for (const std::int64_t face : port.faces) {
    const auto corners = context.corners_of_face(face);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % corners.size()]);
      if (!rim.insert({low, high}).second) rim.erase({low, high});
    }
  }
  return rim;
}

bool touches(const std::set<NodePair>& rim, std::span<const std::int64_t> corners) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [low, high] = std::minmax(corners[i], corners[(i + 1) % corners.size()]);
    if (rim.contains({low, high})) return true;
  }
  return false;
}

/// Nets of solid copper with a face at the rim.
void add_solid_conductors(const checks::Context& context, const std::set<NodePair>& rim, std::set<std::string>& found) {
  if (context.expectation == nullptr) return;
  std::vector<std::string> conductor_of(static_cast<std::size_t>(context.cell_tags.size()));
  for (const auto& volume : context.expectation->volumes) {
    const int slot = context.cell_tags.slot(volume.tag);
    if (slot < 0 || !volume.conductor) continue;
    conductor_of[static_cast<std::size_t>(slot)] = volume.net.empty() ? volume.name : "net " + volume.net;
  }
  std::vector<std::uint8_t> is_at_rim(context.mesh.nodes.size(), 0);
  for (const NodePair& edge : rim) {
    for (const std::int64_t node : edge) is_at_rim[static_cast<std::size_t>(node)] = 1;
  }
  for (std::size_t b = 0; b < context.mesh.cells.size(); ++b) {
    const mesh::CellBlock& block = context.mesh.cells[b];
    const auto n = static_cast<std::size_t>(corners_of(block.kind));
    for (std::int64_t i = 0; i < block.size(); ++i) {
      const auto index = static_cast<std::size_t>(i);
      const std::string& name = conductor_of[static_cast<std::size_t>(context.cell_tags.slot(block.tags[index]))];
      if (name.empty() || found.contains(name)) continue;
      const auto corners = std::span(block.corners).subspan(index * n, n);
      const auto at_rim = [&](std::int64_t node) { return is_at_rim[static_cast<std::size_t>(node)] != 0; };
      if (std::ranges::count_if(corners, at_rim) < 2) continue;
      for (const checks::LocalFace& face : checks::faces_of(block.kind)) {
        std::array<std::int64_t, 4> ids{};
        const auto size = static_cast<std::size_t>(face.num_corners);
        for (std::size_t k = 0; k < size; ++k) ids[k] = corners[static_cast<std::size_t>(face.corners[k])];
        if (touches(rim, std::span<const std::int64_t>(ids).first(size))) found.insert(name);
      }
    }
  }
}

}  // namespace

PortShape shape_of_port(const checks::Context& context, std::span<const std::int64_t> faces) {
  Vector3 normal{}, origin{};
  double area = 0, largest = 0;
  for (const std::int64_t face : faces) {
    const Vector3 twice = twice_area(context, face);
    const double size = length(twice);
    area += 0.5 * size;
    if (size <= largest) continue;
    largest = size;
    normal = {twice[0] / size, twice[1] / size, twice[2] / size};
    origin = context.mesh.nodes[static_cast<std::size_t>(context.corners_of_face(face)[0])];
  }
  if (largest == 0) return {};
  // Axes of the plane: across the normal's smallest part, so that none of them vanishes.
  Vector3 across{};
  const auto smallest = std::ranges::min_element(normal, {}, [](double x) { return std::abs(x); }) - normal.begin();
  across[static_cast<std::size_t>(smallest)] = 1;
  Vector3 e1 = cross(normal, across);
  const double size1 = length(e1);
  for (double& x : e1) x /= size1;
  const Vector3 e2 = cross(normal, e1);
  PortShape shape;
  std::vector<Point> points;
  double extent = 0;
  for (const std::int64_t face : faces) {
    for (const std::int64_t node : context.corners_of_face(face)) {
      const Vector3 d = context.mesh.nodes[static_cast<std::size_t>(node)] - origin;
      shape.off_plane = std::max(shape.off_plane, std::abs(dot(d, normal)));
      extent = std::max(extent, length(d));
      points.push_back({dot(d, e1), dot(d, e2)});
    }
  }
  constexpr double relative = 1e-6;
  shape.is_planar = shape.off_plane <= std::max(relative * extent, context.tolerance);
  if (!shape.is_planar) return shape;
  const double rectangle = smallest_rectangle(convex_hull(std::move(points)));
  shape.is_rectangle = std::abs(rectangle - area) <= relative * rectangle;
  return shape;
}

std::vector<std::string> conductors_at(const checks::Context& context, const FaceGroup& port,
                                       std::span<const FaceGroup> groups) {
  const std::set<NodePair> rim = rim_of(context, port);
  std::set<std::string> found;
  for (const FaceGroup& group : groups) {
    if (!group.is_conductor()) continue;
    const auto meets = [&](std::int64_t face) { return touches(rim, context.corners_of_face(face)); };
    if (std::ranges::any_of(group.faces, meets)) found.insert(fmt::format("face group {} '{}'", group.tag, group.name));
  }
  add_solid_conductors(context, rim, found);
  return {found.begin(), found.end()};
}

}  // namespace pcbmesh::validation::profiles
