// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "pcbmesh/geometry/ring_contact.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"

namespace pcbmesh::pipeline {
namespace {

using geometry::Point;

bool covers(const std::vector<geometry::Ring>& rings, Point p) {
  int winding = 0;
  for (const geometry::Ring& ring : rings) winding += geometry::winding_number(ring, p);
  return winding != 0;
}

/// Distance of a point from a figure's copper; 0 inside. `best` bounds the work.
double distance_nm(Point p, const geometry::Figure& figure, double best) {
  const geometry::Box box = geometry::bounds(figure);
  const double dx = static_cast<double>(std::max<Nm>({box.min.x - p.x, p.x - box.max.x, 0}));
  const double dy = static_cast<double>(std::max<Nm>({box.min.y - p.y, p.y - box.max.y, 0}));
  if (std::hypot(dx, dy) > best) return best;
  bool simple = true;
  const std::vector<geometry::Ring> rings = geometry::outline(figure, {}, simple);
  if (covers(rings, p)) return 0;
  double least = best;
  for (const geometry::Ring& ring : rings)
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
      least = std::min(least, geometry::distance_to_segment(p, ring[j], ring[i]));
  return least;
}

struct Feature {
  std::string text;
  double distance_nm = std::numeric_limits<double>::infinity();
};

/// Nearest copper of a net on a layer, or on all where the layer is empty or no copper; barrels count everywhere.
Feature nearest_feature(const board::Board& board, std::int32_t net, const std::string& layer, Point at) {
  std::int32_t copper_layer = -1;
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(board.copper_layers().size()); ++i)
    if (board.copper_name(i) == layer) copper_layer = i;
  Feature best;
  const auto offer = [&](const geometry::Figure& figure, std::string_view what, const std::string& where, std::int64_t line) {
    const double distance = distance_nm(at, figure, best.distance_nm);
    if (distance >= best.distance_nm) return;
    best.distance_nm = distance;
    best.text = fmt::format("{} on {}{}", what, where, line > 0 ? fmt::format(", {}:{}", board.source(), line) : "");
  };
  for (const board::Shape& shape : board.shapes())
    if (shape.net == net && (copper_layer < 0 || shape.copper_layer == copper_layer))
      offer(shape.figure, board::name_of(shape.kind), board.copper_name(shape.copper_layer), shape.line);
  for (const board::Drill& drill : board.drills())
    if (drill.plated && drill.net == net)
      offer(drill.figure, "plated hole",
            fmt::format("{} to {}", board.copper_name(drill.first_copper), board.copper_name(drill.last_copper)), drill.line);
  return best;
}

}  // namespace

void name_features(const board::Board& board, double unit_m, validation::Report& report) {
  for (validation::Finding& finding : report.findings) {
    if (finding.nets.empty() || finding.places.empty()) continue;
    const auto& at = finding.places.front().at;
    const Point place{std::llround(at[0] * unit_m / metres_per_nm), std::llround(at[1] * unit_m / metres_per_nm)};
    for (const std::string& name : finding.nets) {
      const auto net = board.find_net(name);
      if (!net) continue;
      const Feature feature = nearest_feature(board, *net, finding.layer, place);
      if (!feature.text.empty()) finding.text += fmt::format("; nearest copper of {}: {}", name, feature.text);
    }
  }
}

}  // namespace pcbmesh::pipeline
