// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/unused_rings.hpp"

#include <map>
#include <utility>

#include "formats/kicad/copper_index.hpp"

namespace pcbmesh::formats::kicad {
namespace {

class RingJudge {
 public:
  explicit RingJudge(Reading& reading) : reading_(reading), num_shapes_(reading.parts.shapes.size()) {
    for (std::size_t i = 0; i < reading.optional_rings.size(); ++i) {
      const OptionalRing& ring = reading.optional_rings[i];
      geometry::Box box;
      for (const geometry::Figure& figure : ring.figures) box.add(geometry::bounds(figure));
      groups_[{ring.copper_layer, ring.net}].add(box, num_shapes_ + i);
    }
    for (std::size_t i = 0; i < num_shapes_; ++i) {
      const board::Shape& shape = reading.parts.shapes[i];
      const auto group = groups_.find({shape.copper_layer, shape.net});
      if (group != groups_.end()) group->second.add(geometry::bounds(shape.figure), i);
    }
    for (auto& [key, group] : groups_) group.sort();
  }

  bool is_used(std::size_t ring_index) {
    const OptionalRing& ring = reading_.optional_rings[ring_index];
    if (ring.net == board::no_net) return false;
    const Probe probe(ring.figures);
    return groups_.at({ring.copper_layer, ring.net}).any(probe.box, [&](std::size_t index) {
      return index != num_shapes_ + ring_index && touches(ring, probe, index);
    });
  }

 private:
  bool touches(const OptionalRing& ring, const Probe& probe, std::size_t index) {
    if (index >= num_shapes_) return TouchTest::touches(probe, reading_.optional_rings[index - num_shapes_].figures);
    const board::Shape& shape = reading_.parts.shapes[index];
    if (shape.kind != board::ShapeKind::fill) return TouchTest::touches(probe, {&shape.figure, 1});
    return ring.fills_count && test_.touches_fill(probe, index, shape.figure);
  }

  Reading& reading_;
  std::size_t num_shapes_;
  std::map<std::pair<std::int32_t, std::int32_t>, CopperGroup> groups_;  ///< by layer and net
  TouchTest test_;
};

}  // namespace

void add_used_rings(Reading& reading) {
  if (reading.optional_rings.empty()) return;
  RingJudge judge(reading);
  std::vector<bool> is_used(reading.optional_rings.size());
  for (std::size_t i = 0; i < is_used.size(); ++i) is_used[i] = judge.is_used(i);
  std::vector<board::Shape> used;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (!is_used[i]) continue;
    OptionalRing& ring = reading.optional_rings[i];
    for (geometry::Figure& figure : ring.figures)
      if (figure.pen > 0 || figure.filled)
        used.push_back({ring.copper_layer, ring.net, ring.kind, std::move(figure), ring.line});
  }
  reading.parts.shapes.insert(reading.parts.shapes.end(), std::make_move_iterator(used.begin()),
                              std::make_move_iterator(used.end()));
}

}  // namespace pcbmesh::formats::kicad
