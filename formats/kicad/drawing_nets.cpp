// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/drawing_nets.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "formats/kicad/copper_index.hpp"

namespace pcbmesh::formats::kicad {
namespace {

/// A drawing of a million overlapping strokes must not hang the reader.
constexpr std::size_t most_tests = 500'000;

/// Clusters of touching drawings, by the smallest drawing in each.
class Clusters {
 public:
  explicit Clusters(std::size_t size) : parent_(size) {
    for (std::size_t i = 0; i < size; ++i) parent_[i] = i;
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

void adopt_nets(Reading& reading) {
  auto& shapes = reading.parts.shapes;
  const std::vector<std::size_t>& drawings = reading.loose_drawings;
  if (drawings.empty()) return;
  std::map<std::int32_t, CopperGroup> layers;
  constexpr std::size_t no_drawing = static_cast<std::size_t>(-1);
  std::vector<std::size_t> rank(shapes.size(), no_drawing);  // shape -> its place among the drawings
  for (std::size_t k = 0; k < drawings.size(); ++k) {
    rank[drawings[k]] = k;
    layers[shapes[drawings[k]].copper_layer];
  }
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const auto layer = layers.find(shapes[i].copper_layer);
    if (layer != layers.end() && (shapes[i].net != board::no_net || rank[i] != no_drawing))
      layer->second.add(geometry::bounds(shapes[i].figure), i);
  }
  for (auto& [layer, group] : layers) group.sort();

  TouchTest test;
  Clusters clusters(drawings.size());
  std::vector<std::set<std::int32_t>> nets(drawings.size());
  std::size_t num_tests = 0;
  for (std::size_t k = 0; k < drawings.size() && num_tests <= most_tests; ++k) {
    const board::Shape& drawing = shapes[drawings[k]];
    const Probe probe({&drawing.figure, 1});
    layers.at(drawing.copper_layer).any(probe.box, [&](std::size_t index) {
      const board::Shape& other = shapes[index];
      if (other.net == board::no_net) {
        if (rank[index] >= k || clusters.root(rank[index]) == clusters.root(k)) return false;
      } else if (nets[k].contains(other.net)) {
        return false;
      }
      if (++num_tests > most_tests) return true;
      const bool is_fill = other.kind == board::ShapeKind::fill;
      if (!(is_fill ? test.touches_fill(probe, index, other.figure) : TouchTest::touches(probe, {&other.figure, 1})))
        return false;
      if (other.net == board::no_net)
        clusters.join(k, rank[index]);
      else
        nets[k].insert(other.net);
      return false;
    });
  }
  if (num_tests > most_tests) {
    reading.diagnostics.warn("kicad.drawings_too_many", "too many drawings without a net overlap on copper; they keep no net",
                             {.file = reading.tree.file()});
    return;
  }
  for (std::size_t k = drawings.size(); k-- > 0;)
    if (clusters.root(k) != k) nets[clusters.root(k)].merge(nets[k]);
  for (std::size_t k = 0; k < drawings.size(); ++k) {
    const std::set<std::int32_t>& found = nets[clusters.root(k)];
    board::Shape& drawing = shapes[drawings[k]];
    if (found.size() == 1) drawing.net = *found.begin();
    if (found.size() > 1)
      reading.diagnostics.warn(
          "kicad.drawing_joins_nets",
          "drawing without a net touches copper of several nets: it shorts them, and keeps no net itself",
          {.file = reading.tree.file(), .line = drawing.line, .layer = reading.layers.copper(drawing.copper_layer).name});
  }
}

}  // namespace pcbmesh::formats::kicad
