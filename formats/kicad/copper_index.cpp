// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/copper_index.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcbmesh::formats::kicad {
namespace {

using geometry::Box;
using geometry::Point;
using geometry::Ring;

constexpr geometry::ArcOptions coarse{.sagitta_nm = nm_per_um};
constexpr Nm kiss_nm = 10;

std::vector<Ring> rings_of(std::span<const geometry::Figure> figures) {
  std::vector<Ring> rings;
  bool simple = true;
  for (const geometry::Figure& figure : figures)
    for (Ring& ring : geometry::outline(figure, coarse, simple)) rings.push_back(std::move(ring));
  return rings;
}

int winding_step(Point a, Point b, Point p) {
  if ((a.y > p.y) == (b.y > p.y)) return 0;
  const int side = geometry::orientation(a, b, p);
  if (b.y > a.y) return side > 0 ? 1 : 0;
  return side < 0 ? -1 : 0;
}

bool is_in(const std::vector<Ring>& rings, Point p) {
  for (const Ring& ring : rings) {
    int winding = 0;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) winding += winding_step(ring[j], ring[i], p);
    if (winding != 0) return true;
  }
  return false;
}

bool cross(Point a, Point b, Point c, Point d) {
  return geometry::orientation(a, b, c) * geometry::orientation(a, b, d) <= 0 &&
         geometry::orientation(c, d, a) * geometry::orientation(c, d, b) <= 0;
}

bool edges_cross(const std::vector<Ring>& first, const std::vector<Ring>& second) {
  Box around;
  for (const Ring& s : second)
    for (const Point p : s) around.add(p);
  for (const Ring& r : first)
    for (std::size_t i = 0; i < r.size(); ++i) {
      const Point a = r[i], b = r[(i + 1) % r.size()];
      Box edge;
      edge.add(a);
      edge.add(b);
      if (!edge.touches(around)) continue;
      for (const Ring& s : second)
        for (std::size_t k = 0; k < s.size(); ++k)
          if (cross(a, b, s[k], s[(k + 1) % s.size()])) return true;
    }
  return false;
}

}  // namespace

void CopperGroup::sort() {
  std::sort(by_left_.begin(), by_left_.end(),
            [](const Entry& a, const Entry& b) { return std::pair(a.box.min.x, a.index) < std::pair(b.box.min.x, b.index); });
  right_most_.clear();
  for (const Entry& entry : by_left_)
    right_most_.push_back(right_most_.empty() ? entry.box.max.x : std::max(right_most_.back(), entry.box.max.x));
}

std::size_t CopperGroup::first_right_of(Nm x) const {
  return static_cast<std::size_t>(
      std::partition_point(by_left_.begin(), by_left_.end(), [&](const Entry& e) { return e.box.min.x <= x; }) -
      by_left_.begin());
}

Probe::Probe(std::span<const geometry::Figure> figures) {
  std::vector<geometry::Figure> inner(figures.begin(), figures.end());
  for (geometry::Figure& figure : inner) {
    box.add(geometry::bounds(figure));
    if (figure.pen > kiss_nm) figure.pen -= kiss_nm;
  }
  rings = rings_of(inner);
}

/// Edges of one fill, sorted into horizontal strips: a point is then judged by the edges of its strip alone.
class TouchTest::FillIndex {
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
      winding += winding_step(ring_[i], ring_[(i + 1) % ring_.size()], p);
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

TouchTest::TouchTest() = default;
TouchTest::~TouchTest() = default;

bool TouchTest::touches(const Probe& probe, std::span<const geometry::Figure> figures) {
  const std::vector<Ring> other = rings_of(figures);
  for (const Ring& r : other)
    if (is_in(probe.rings, r.front())) return true;
  for (const Ring& r : probe.rings)
    if (is_in(other, r.front())) return true;
  return edges_cross(probe.rings, other);
}

bool TouchTest::touches_fill(const Probe& probe, std::size_t key, const geometry::Figure& fill) {
  auto& index = fills_[key];
  if (!index) index = std::make_unique<FillIndex>(fill);
  for (const Ring& r : probe.rings)
    if (std::any_of(r.begin(), r.end(), [&](Point p) { return index->contains(p); })) return true;
  return false;
}

}  // namespace pcbmesh::formats::kicad
