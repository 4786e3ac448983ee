// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "validation/checks/vector3.hpp"

namespace pcbmesh::validation::checks {

/// Of floats, rounded outwards: half the memory, and never too small.
struct Box {
  std::array<float, 3> low{huge, huge, huge}, high{-huge, -huge, -huge};

  void add(const Vector3& at, double margin = 0) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], below(at[axis] - margin));
      high[axis] = std::max(high[axis], -below(-(at[axis] + margin)));
    }
  }
  void add(const Box& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], other.low[axis]);
      high[axis] = std::max(high[axis], other.high[axis]);
    }
  }
  [[nodiscard]] bool meets(const Box& other) const {
    return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] && other.low[1] <= high[1] &&
           low[2] <= other.high[2] && other.low[2] <= high[2];
  }

 private:
  static constexpr float huge = std::numeric_limits<float>::infinity();
  /// The largest float not above x.
  static float below(double x) {
    constexpr double most = std::numeric_limits<float>::max();
    if (x > most) return std::numeric_limits<float>::max();
    if (x < -most) return -huge;
    const auto near = static_cast<float>(x);
    return static_cast<double>(near) <= x ? near : std::nextafter(near, -huge);
  }
};

/// Binary tree of boxes for "which boxes meet this one". @cost about 25 bytes per box; O(n log n) to build.
class BoxTree {
 public:
  /// REQUIRES fewer than 2^31 boxes.
  explicit BoxTree(std::span<const Box> boxes);

  /// Calls visit(index) for each box that meets `box`; stops when visit returns false.
  /// @return number of boxes looked at.
  template <class Visit>
  std::int64_t each_meeting(const Box& box, Visit&& visit) const {
    std::int64_t looked = 0;
    std::size_t node = 0;
    // Preorder with skip links: no stack.
    while (node < nodes_.size()) {
      const Node& here = nodes_[node];
      ++looked;
      if (!here.box.meets(box)) {
        node = static_cast<std::size_t>(here.skip);
        continue;
      }
      for (std::int32_t i = here.first; i < here.end; ++i) {
        ++looked;
        const auto index = static_cast<std::size_t>(order_[static_cast<std::size_t>(i)]);
        if (boxes_[index].meets(box) && !visit(index)) return looked;
      }
      ++node;
    }
    return looked;
  }

 private:
  struct Node {
    Box box;
    std::int32_t skip = 0;            ///< next node when this one is left out
    std::int32_t first = 0, end = 0;  ///< boxes of a leaf in order_; empty for inner nodes
  };
  void build(std::size_t first, std::size_t end, const Vector3& typical_size);

  std::span<const Box> boxes_;
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace pcbmesh::validation::checks
