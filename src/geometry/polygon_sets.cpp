// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/geometry/polygon_sets.hpp"

#include <polyclipping/clipper.hpp>

namespace pcbmesh::geometry {
namespace {

ClipperLib::Paths paths_of(const std::vector<Ring>& rings) {
  ClipperLib::Paths paths;
  paths.reserve(rings.size());
  for (const Ring& ring : rings) {
    ClipperLib::Path path;
    path.reserve(ring.size());
    for (const Point p : ring) path.emplace_back(p.x, p.y);
    paths.push_back(std::move(path));
  }
  return paths;
}

std::vector<Ring> rings_of(const ClipperLib::Paths& paths) {
  std::vector<Ring> rings;
  for (const ClipperLib::Path& path : paths) {
    if (path.size() < 3) continue;
    Ring ring;
    ring.reserve(path.size());
    for (const ClipperLib::IntPoint& p : path) ring.push_back({p.X, p.Y});
    rings.push_back(std::move(ring));
  }
  return rings;
}

ClipperLib::Paths combined(const std::vector<Ring>& a, const std::vector<Ring>& b, ClipperLib::ClipType type) {
  ClipperLib::Clipper clipper;
  clipper.StrictlySimple(true);
  clipper.AddPaths(paths_of(a), ClipperLib::ptSubject, true);
  clipper.AddPaths(paths_of(b), ClipperLib::ptClip, true);
  ClipperLib::Paths result;
  clipper.Execute(type, result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  return result;
}

}  // namespace

std::vector<Ring> united(const std::vector<Ring>& rings) {
  return rings_of(combined(rings, {}, ClipperLib::ctUnion));
}

std::vector<Ring> intersected(const std::vector<Ring>& a, const std::vector<Ring>& b) {
  return rings_of(combined(a, b, ClipperLib::ctIntersection));
}

std::vector<Ring> subtracted(const std::vector<Ring>& a, const std::vector<Ring>& b) {
  return rings_of(combined(a, b, ClipperLib::ctDifference));
}

std::vector<Ring> shrunk(const std::vector<Ring>& rings, Nm by) {
  constexpr double sharpest = 4;  // a corner is cut off only beyond four times the distance
  ClipperLib::ClipperOffset offset(sharpest);
  offset.AddPaths(combined(rings, {}, ClipperLib::ctUnion), ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
  ClipperLib::Paths result;
  offset.Execute(result, -static_cast<double>(by));
  return rings_of(result);
}

double covered_mm2(const std::vector<Ring>& rings) {
  double area = 0;
  for (const Ring& ring : united(rings)) area += area_mm2(ring);
  return area;
}

}  // namespace pcbmesh::geometry
