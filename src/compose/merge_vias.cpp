// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/merge_vias.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "pcbmesh/geometry/polygon_sets.hpp"

namespace pcbmesh::compose {
namespace {

using board::Board;
using board::Drill;
using geometry::Box;
using geometry::Point;
using geometry::Ring;

Point centre_of(const Drill& drill) {
  return drill.figure.path.points.front();
}

bool is_within(Point a, Point b, Nm distance) {
  const auto dx = static_cast<__int128>(a.x - b.x), dy = static_cast<__int128>(a.y - b.y);
  return dx * dx + dy * dy <= static_cast<__int128>(distance) * distance;
}

/// What joints must not touch: shapes and holes, found by box.
class Obstacles {
 public:
  Obstacles(const Board& board, const study::Study& study) : board_(board), study_(study) {
    for (std::size_t i = 0; i < board.shapes().size(); ++i) shape_boxes_.push_back(geometry::bounds(board.shapes()[i].figure));
    for (std::size_t i = 0; i < board.drills().size(); ++i) drill_boxes_.push_back(geometry::bounds(board.drills()[i].figure));
  }

  [[nodiscard]] bool are_met_by(const MergedBlock& block) const {
    const Box box = geometry::bounds(block.figure);
    bool simple = true;
    const std::vector<Ring> own = geometry::outline(block.figure, study_.arcs, simple);
    for (std::size_t i = 0; i < shape_boxes_.size(); ++i) {
      const board::Shape& shape = board_.shapes()[i];
      if (shape.net == block.net || shape.copper_layer < block.first_copper || shape.copper_layer > block.last_copper) continue;
      if (shape_boxes_[i].touches(box) && meets(own, box, shape.figure)) return true;
    }
    for (std::size_t i = 0; i < drill_boxes_.size(); ++i) {
      const Drill& drill = board_.drills()[i];
      if (drill.plated && drill.net == block.net) continue;
      if (drill.last_copper < block.first_copper || drill.first_copper > block.last_copper) continue;
      if (drill_boxes_[i].touches(box) && meets(own, box, drill.figure)) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] bool meets(const std::vector<Ring>& own, const Box& box, const geometry::Figure& figure) const {
    bool simple = true;
    std::vector<Ring> near;
    for (const Ring& ring : geometry::outline(figure, study_.arcs, simple))
      if (Ring cut = geometry::clip_to_box(ring, box); cut.size() >= 3) near.push_back(std::move(cut));
    return !near.empty() && !geometry::intersected(own, near).empty();
  }

  const Board& board_;
  const study::Study& study_;
  std::vector<Box> shape_boxes_, drill_boxes_;
};

/// Vias that may be joined with each other.
struct Group {
  std::vector<const Drill*> vias;
  std::vector<std::size_t> parent;
  std::size_t root(std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
};

MergedBlock block_of(const Drill& like, std::vector<Point> corners) {
  MergedBlock block{.figure = geometry::segment(corners[0], corners[1], like.figure.pen),
                    .first_copper = like.first_copper,
                    .last_copper = like.last_copper,
                    .net = like.net,
                    .line = like.line};
  if (corners.size() == 3) {
    geometry::make_counter_clockwise(corners);
    block.figure = geometry::polygon(std::move(corners));
  }
  return block;
}

void join(const Board& board, Group& group, Nm pitch, const Obstacles& obstacles, MergedVias& into) {
  std::sort(group.vias.begin(), group.vias.end(), [](const Drill* a, const Drill* b) {
    return std::pair(centre_of(*a), a->line) < std::pair(centre_of(*b), b->line);
  });
  const std::size_t n = group.vias.size();
  group.parent.resize(n);
  std::iota(group.parent.begin(), group.parent.end(), std::size_t{0});
  std::vector<std::vector<std::size_t>> joined(n);  // later neighbours
  for (std::size_t i = 0; i < n; ++i) {
    const Point a = centre_of(*group.vias[i]);
    for (std::size_t j = i + 1; j < n; ++j) {
      const Point b = centre_of(*group.vias[j]);
      if (b.x - a.x > pitch) break;
      if (a == b || !is_within(a, b, pitch)) continue;
      MergedBlock block = block_of(*group.vias[i], {a, b});
      if (obstacles.are_met_by(block)) {
        ++into.num_refused;
        continue;
      }
      into.blocks.push_back(std::move(block));
      joined[i].push_back(j);
      group.parent[group.root(j)] = group.root(i);
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (const std::size_t j : joined[i])
      for (const std::size_t k : joined[j]) {
        if (std::find(joined[i].begin(), joined[i].end(), k) == joined[i].end()) continue;
        const std::vector<Point> corners{centre_of(*group.vias[i]), centre_of(*group.vias[j]), centre_of(*group.vias[k])};
        if (geometry::orientation(corners[0], corners[1], corners[2]) == 0) continue;
        MergedBlock block = block_of(*group.vias[i], corners);
        if (obstacles.are_met_by(block))
          ++into.num_refused;
        else
          into.blocks.push_back(std::move(block));
      }
  std::vector<std::int64_t> members(n, 0);
  for (std::size_t i = 0; i < n; ++i) ++members[group.root(i)];
  for (const std::int64_t count : members) {
    if (count == 1) ++into.num_alone;
    if (count < 2) continue;
    into.num_vias += count;
    ++into.num_blocks;
  }
  for (std::size_t i = 0; i < n; ++i)
    if (members[group.root(i)] > 1) into.members.push_back(static_cast<std::size_t>(group.vias[i] - board.drills().data()));
}

}  // namespace

MergedVias merge_vias(const Board& board, const study::Study& study, const Footprint& footprint, Nm pitch) {
  const Obstacles obstacles(board, study);
  std::map<std::array<std::int64_t, 4>, Group> groups;  // span, net, diameter
  for (const Drill& drill : board.drills()) {
    const bool is_round_via = drill.plated && drill.kind == board::ShapeKind::via && drill.net >= 0 &&
                              drill.figure.path.points.size() == 1 && !drill.figure.filled;
    if (!is_round_via || !geometry::bounds(drill.figure).touches(footprint.box)) continue;
    groups[{drill.first_copper, drill.last_copper, drill.net, drill.figure.pen}].vias.push_back(&drill);
  }
  MergedVias merged;
  for (auto& [key, group] : groups) join(board, group, pitch, obstacles, merged);
  std::sort(merged.members.begin(), merged.members.end());
  return merged;
}

}  // namespace pcbmesh::compose
