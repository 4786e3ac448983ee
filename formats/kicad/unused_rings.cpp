// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/unused_rings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace pcbmesh::formats::kicad {
namespace {

using geometry::Box;
using geometry::Point;
using geometry::Ring;

constexpr geometry::ArcOptions coarse{};

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
  std::size_t shape = 0;
};

/// Shapes of one net on one layer, by the left side of their boxes.
struct Group {
  std::vector<Candidate> by_left;
  std::vector<Nm> right_most;  ///< largest right side up to and including i
};

class RingJudge {
 public:
  explicit RingJudge(Reading& reading) : reading_(reading) {
    for (const OptionalRing& ring : reading.optional_rings) groups_[{ring.copper_layer, ring.net}];
    for (std::size_t i = 0; i < reading.parts.shapes.size(); ++i) {
      const board::Shape& shape = reading.parts.shapes[i];
      const auto group = groups_.find({shape.copper_layer, shape.net});
      if (group != groups_.end()) group->second.by_left.push_back({geometry::bounds(shape.figure), i});
    }
    for (auto& [key, group] : groups_) {
      std::sort(group.by_left.begin(), group.by_left.end(), [](const Candidate& a, const Candidate& b) {
        return std::pair(a.box.min.x, a.shape) < std::pair(b.box.min.x, b.shape);
      });
      for (const Candidate& c : group.by_left)
        group.right_most.push_back(group.right_most.empty() ? c.box.max.x : std::max(group.right_most.back(), c.box.max.x));
    }
  }

  bool is_used(const OptionalRing& ring) {
    if (ring.net == board::no_net) return false;
    Box box;
    std::vector<Ring> outline;
    bool simple = true;
    for (const geometry::Figure& figure : ring.figures) {
      box.add(geometry::bounds(figure));
      for (Ring& r : geometry::outline(figure, coarse, simple)) outline.push_back(std::move(r));
    }
    const Group& group = groups_.at({ring.copper_layer, ring.net});
    const auto behind = std::partition_point(group.by_left.begin(), group.by_left.end(),
                                             [&](const Candidate& c) { return c.box.min.x <= box.max.x; });
    for (auto i = static_cast<std::size_t>(behind - group.by_left.begin()); i-- > 0 && group.right_most[i] >= box.min.x;)
      if (group.by_left[i].box.touches(box) && touches(ring, outline, group.by_left[i].shape)) return true;
    return false;
  }

 private:
  bool touches(const OptionalRing& ring, const std::vector<Ring>& outline, std::size_t index) {
    const board::Shape& shape = reading_.parts.shapes[index];
    if (shape.kind == board::ShapeKind::fill) {
      if (!ring.fills_count) return false;
      auto& fill = fills_[index];
      if (!fill) fill = std::make_unique<FillIndex>(shape.figure);
      for (const Ring& r : outline)
        if (std::any_of(r.begin(), r.end(), [&](Point p) { return fill->contains(p); })) return true;
      return false;
    }
    bool simple = true;
    const std::vector<Ring> other = geometry::outline(shape.figure, coarse, simple);
    for (const Ring& r : other)
      if (is_in(outline, r.front())) return true;
    for (const Ring& r : outline)
      if (is_in(other, r.front())) return true;
    return edges_cross(outline, other);
  }

  Reading& reading_;
  std::map<std::pair<std::int32_t, std::int32_t>, Group> groups_;
  std::map<std::size_t, std::unique_ptr<FillIndex>> fills_;
};

}  // namespace

void add_used_rings(Reading& reading) {
  if (reading.optional_rings.empty()) return;
  RingJudge judge(reading);
  std::vector<board::Shape> used;
  for (OptionalRing& ring : reading.optional_rings) {
    if (!judge.is_used(ring)) continue;
    for (geometry::Figure& figure : ring.figures)
      if (figure.pen > 0 || figure.filled)
        used.push_back({ring.copper_layer, ring.net, ring.kind, std::move(figure), ring.line});
  }
  reading.parts.shapes.insert(reading.parts.shapes.end(), std::make_move_iterator(used.begin()),
                              std::make_move_iterator(used.end()));
}

}  // namespace pcbmesh::formats::kicad
