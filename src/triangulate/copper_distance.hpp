// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pcbmesh::triangulate {

/// Distance to the nearest of a fixed set of segments: a tree of boxes over the segments in Hilbert order.
class SegmentDistance {
 public:
  /// Ends of one segment: ax, ay, bx, by.
  using Segment = std::array<double, 4>;

  explicit SegmentDistance(std::vector<Segment> segments);

  [[nodiscard]] bool is_empty() const { return segments_.empty(); }
  /// Distance of (x, y) to the nearest segment, or `limit` if none is nearer. @cost O(log n) typical.
  [[nodiscard]] double at(double x, double y, double limit) const;

 private:
  using Box = std::array<double, 4>;  // xmin, ymin, xmax, ymax
  static constexpr std::size_t leaf_size = 4;
  std::vector<Segment> segments_;
  std::vector<Box> boxes_;      // heap order: children of i are 2i+1 and 2i+2
  std::size_t num_leaves_ = 0;  // a power of two
};

}  // namespace pcbmesh::triangulate
