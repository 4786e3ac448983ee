// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pcbmesh/geometry/path.hpp"

namespace pcbmesh::tests {

/// Area of a union of rings, each by its own non-zero winding, by a sweep over horizontal bands: an oracle that shares no
/// code with the overlay. Between two neighbouring vertex heights the covered width is linear but for crossings; bands are
/// split at every crossing, so that height times width at mid-height is the area up to rounding.
class UnionArea {
 public:
  void add(const geometry::Ring& ring) {
    const auto id = static_cast<std::uint32_t>(windings_.size());
    windings_.push_back(0);
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      const geometry::Point a = ring[j], b = ring[i];
      if (a.y == b.y) continue;
      const bool up = b.y > a.y;
      const geometry::Point low = up ? a : b, high = up ? b : a;
      edges_.push_back({static_cast<double>(low.y), static_cast<double>(high.y), static_cast<double>(low.x),
                        static_cast<double>(high.x - low.x) / static_cast<double>(high.y - low.y), id, up ? 1 : -1});
    }
  }

  void add(const geometry::Figure& figure, const geometry::ArcOptions& options) {
    bool simple = true;
    for (const geometry::Ring& ring : geometry::outline(figure, options, simple)) add(ring);
  }

  /// Square millimetres.
  double mm2() {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& e, const Edge& f) { return e.y0 < f.y0; });
    std::vector<double> heights;
    for (const Edge& e : edges_) heights.insert(heights.end(), {e.y0, e.y1});
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
    std::vector<Crossing> active;
    std::size_t next = 0;
    double area = 0;
    for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
      const double low = heights[k], high = heights[k + 1];
      std::erase_if(active, [&](const Crossing& c) { return edges_[c.edge].y1 <= low; });
      while (next < edges_.size() && edges_[next].y0 <= low) active.push_back({static_cast<std::uint32_t>(next++), 0, 0});
      area += band(active, low, high);
    }
    return area * 1e-12;
  }

 private:
  struct Edge {
    double y0, y1, x0, slope;
    std::uint32_t ring;
    int sign;
    [[nodiscard]] double at(double y) const { return x0 + (y - y0) * slope; }
  };
  struct Crossing {
    std::uint32_t edge;
    double low, high;  ///< x at the lower and upper side of the band
  };

  double band(std::vector<Crossing>& active, double low, double high) {
    for (Crossing& c : active) c.low = edges_[c.edge].at(low), c.high = edges_[c.edge].at(high);
    // Nearly sorted from the band below: insertion sort.
    for (std::size_t i = 1; i < active.size(); ++i)
      for (std::size_t j = i; j > 0 && before(active[j], active[j - 1]); --j) std::swap(active[j], active[j - 1]);
    cuts_.clear();
    for (std::size_t i = 0; i + 1 < active.size(); ++i) {
      if (active[i].high <= active[i + 1].high) continue;
      find_cuts(active, low, high);
      break;
    }
    if (cuts_.empty()) return (high - low) * width(active, (low + high) / 2);
    cuts_.push_back(high);
    std::sort(cuts_.begin(), cuts_.end());
    double area = 0, from = low;
    for (const double to : cuts_) {
      if (to <= from) continue;
      const double middle = (from + to) / 2;
      scratch_ = active;
      for (Crossing& c : scratch_) c.low = c.high = edges_[c.edge].at(middle);
      for (std::size_t i = 1; i < scratch_.size(); ++i)
        for (std::size_t j = i; j > 0 && before(scratch_[j], scratch_[j - 1]); --j) std::swap(scratch_[j], scratch_[j - 1]);
      area += (to - from) * width(scratch_, middle);
      from = to;
    }
    return area;
  }

  static bool before(const Crossing& a, const Crossing& b) { return a.low < b.low || (a.low == b.low && a.high < b.high); }

  /// Heights of all pairs whose order differs between the sides of the band, found by sorting by the upper side.
  void find_cuts(const std::vector<Crossing>& active, double low, double high) {
    scratch_ = active;
    for (std::size_t i = 1; i < scratch_.size(); ++i)
      for (std::size_t j = i; j > 0 && scratch_[j].high < scratch_[j - 1].high; --j) {
        const Crossing &a = scratch_[j - 1], &b = scratch_[j];
        const double gap_low = b.low - a.low, gap_high = a.high - b.high;
        if (gap_low + gap_high > 0) cuts_.push_back(low + (high - low) * gap_low / (gap_low + gap_high));
        std::swap(scratch_[j], scratch_[j - 1]);
      }
  }

  double width(const std::vector<Crossing>& active, double y) {
    double sum = 0, entered = 0;
    int inside = 0;
    for (const Crossing& c : active) {
      const Edge& e = edges_[c.edge];
      int& winding = windings_[e.ring];
      const bool was = winding != 0;
      winding += e.sign;
      const bool is = winding != 0;
      if (was == is) continue;
      if (inside == 0) entered = e.at(y);
      inside += is ? 1 : -1;
      if (inside == 0) sum += e.at(y) - entered;
    }
    return sum;
  }

  std::vector<Edge> edges_;
  std::vector<int> windings_;
  std::vector<double> cuts_;
  std::vector<Crossing> scratch_;
};

}  // namespace pcbmesh::tests
