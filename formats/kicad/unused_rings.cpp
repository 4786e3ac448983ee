// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/unused_rings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <span>
#include <utility>

namespace pcbmesh::formats::kicad {
namespace {

using geometry::Box;
using geometry::Point;
using geometry::Ring;

constexpr geometry::ArcOptions coarse{.sagitta_nm = nm_per_um};
// Rings that only kiss (two vias exactly their diameter apart: 16 pairs in 20_vme_wren) do not touch for KiCad.
constexpr Nm kiss_nm = 10;

/// Edges of one fill, sorted into horizontal strips: a point is then judged by the edges of its strip alone.
class FillIndex {
 public:
  explicit FillIndex(const geometry::Figure& fill) : ring_(geometry::flatten(fill.path, coarse)) {
    for (const Point p : ring_) box_.add(p);
    if (ring_.size() < 3) return;
    // The root keeps tall edges, which stand in every strip, from costing more than n^1.5.
    const auto num_strips = static_cast<std::size_t>(std::sqrt(static_cast<double>(ring_.size()))) + 1;
    height_ = std::max<Nm>(1, (box_.max.y - box_.min.y) / static_cast<Nm>(num_strips) + 1);
    strips_.resize(num_strips + 1);
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const auto [low, high] = std::minmax(ring_[i].y, ring_[(i + 1) % ring_.size()].y);
      for (std::size_t s = strip(low); s <= strip(high); ++s) strips_[s].push_back(static_cast<std::uint32_t>(i));
    }
  }

  [[nodiscard]] bool contains(Point p) const {
    if (ring_.size() < 3 || !box_.contains(p)) return false;
    int winding = 0;
    for (const std::uint32_t i : strips_[strip(p.y)]) {
      const Point a = ring_[i], b = ring_[(i + 1) % ring_.size()];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      const int side = geometry::orientation(a, b, p);
      if (b.y > a.y ? side > 0 : side < 0) winding += b.y > a.y ? 1 : -1;
    }
    return winding != 0;
  }

 private:
  [[nodiscard]] std::size_t strip(Nm y) const { return static_cast<std::size_t>((y - box_.min.y) / height_); }
  Ring ring_;
  Box box_;
  Nm height_ = 1;
  std::vector<std::vector<std::uint32_t>> strips_;
};

bool is_in(const std::vector<Ring>& rings, Point p) {
  for (const Ring& ring : rings) {
    int winding = 0;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const Point a = ring[j], b = ring[i];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      const int side = geometry::orientation(a, b, p);
      if (b.y > a.y ? side > 0 : side < 0) winding += b.y > a.y ? 1 : -1;
    }
    if (winding != 0) return true;
  }
  return false;
}

bool edges_cross(const std::vector<Ring>& first, const std::vector<Ring>& second) {
  for (const Ring& r : first)
    for (std::size_t i = 0; i < r.size(); ++i)
      for (const Ring& s : second)
        for (std::size_t k = 0; k < s.size(); ++k) {
          const Point a = r[i], b = r[(i + 1) % r.size()], c = s[k], d = s[(k + 1) % s.size()];
          if (geometry::orientation(a, b, c) * geometry::orientation(a, b, d) <= 0 &&
              geometry::orientation(c, d, a) * geometry::orientation(c, d, b) <= 0)
            return true;
        }
  return false;
}

struct Candidate {
  Box box;
  std::size_t index = 0;  ///< shape, or num_shapes + optional ring
};

/// Shapes of one net on one layer, by the left side of their boxes.
struct Group {
  std::vector<Candidate> by_left;
  std::vector<Nm> right_most;  ///< largest right side up to and including i
};

class RingJudge {
 public:
  explicit RingJudge(Reading& reading) : reading_(reading), num_shapes_(reading.parts.shapes.size()) {
    for (std::size_t i = 0; i < reading.optional_rings.size(); ++i) {
      const OptionalRing& ring = reading.optional_rings[i];
      Box box;
      for (const geometry::Figure& figure : ring.figures) box.add(geometry::bounds(figure));
      groups_[{ring.copper_layer, ring.net}].by_left.push_back({box, num_shapes_ + i});
    }
    for (std::size_t i = 0; i < num_shapes_; ++i) {
      const board::Shape& shape = reading.parts.shapes[i];
      const auto group = groups_.find({shape.copper_layer, shape.net});
      if (group != groups_.end()) group->second.by_left.push_back({geometry::bounds(shape.figure), i});
    }
    for (auto& [key, group] : groups_) {
      std::sort(group.by_left.begin(), group.by_left.end(), [](const Candidate& a, const Candidate& b) {
        return std::pair(a.box.min.x, a.index) < std::pair(b.box.min.x, b.index);
      });
      for (const Candidate& c : group.by_left)
        group.right_most.push_back(group.right_most.empty() ? c.box.max.x : std::max(group.right_most.back(), c.box.max.x));
    }
  }

  bool is_used(std::size_t ring_index) {
    const OptionalRing& ring = reading_.optional_rings[ring_index];
    if (ring.net == board::no_net) return false;
    Box box;
    std::vector<geometry::Figure> figures = ring.figures;
    for (geometry::Figure& figure : figures) {
      box.add(geometry::bounds(figure));
      if (figure.pen > kiss_nm) figure.pen -= kiss_nm;
    }
    const std::vector<Ring> outline = rings_of(figures);
    const Group& group = groups_.at({ring.copper_layer, ring.net});
    const auto behind = std::partition_point(group.by_left.begin(), group.by_left.end(),
                                             [&](const Candidate& c) { return c.box.min.x <= box.max.x; });
    for (auto i = static_cast<std::size_t>(behind - group.by_left.begin()); i-- > 0 && group.right_most[i] >= box.min.x;) {
      const Candidate& c = group.by_left[i];
      if (c.index != num_shapes_ + ring_index && c.box.touches(box) && touches(ring, outline, c.index)) return true;
    }
    return false;
  }

 private:
  static std::vector<Ring> rings_of(std::span<const geometry::Figure> figures) {
    std::vector<Ring> rings;
    bool simple = true;
    for (const geometry::Figure& figure : figures)
      for (Ring& ring : geometry::outline(figure, coarse, simple)) rings.push_back(std::move(ring));
    return rings;
  }

  bool touches(const OptionalRing& ring, const std::vector<Ring>& outline, std::size_t index) {
    if (index >= num_shapes_) return touches(outline, rings_of(reading_.optional_rings[index - num_shapes_].figures));
    const board::Shape& shape = reading_.parts.shapes[index];
    if (shape.kind != board::ShapeKind::fill) return touches(outline, rings_of({&shape.figure, 1}));
    if (!ring.fills_count) return false;
    auto& fill = fills_[index];
    if (!fill) fill = std::make_unique<FillIndex>(shape.figure);
    for (const Ring& r : outline)
      if (std::any_of(r.begin(), r.end(), [&](Point p) { return fill->contains(p); })) return true;
    return false;
  }

  static bool touches(const std::vector<Ring>& first, const std::vector<Ring>& second) {
    for (const Ring& r : second)
      if (is_in(first, r.front())) return true;
    for (const Ring& r : first)
      if (is_in(second, r.front())) return true;
    return edges_cross(first, second);
  }

  Reading& reading_;
  std::size_t num_shapes_;
  std::map<std::pair<std::int32_t, std::int32_t>, Group> groups_;
  std::map<std::size_t, std::unique_ptr<FillIndex>> fills_;
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
