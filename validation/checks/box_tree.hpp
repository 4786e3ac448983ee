// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "validation/checks/vector3.hpp"

namespace pcbmesh::validation::checks {

struct Box {
  Vector3 low, high;
  [[nodiscard]] bool meets(const Box& other) const {
    return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] && other.low[1] <= high[1] &&
           low[2] <= other.high[2] && other.low[2] <= high[2];
  }
};

/// Binary tree of boxes for "which boxes meet this one". @cost about 70 bytes per box; O(n log n) to build.
class BoxTree {
 public:
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
        node = here.skip;
        continue;
      }
      for (std::size_t i = here.first; i < here.end; ++i) {
        ++looked;
        const auto index = static_cast<std::size_t>(order_[i]);
        if (boxes_[index].meets(box) && !visit(index)) return looked;
      }
      ++node;
    }
    return looked;
  }

 private:
  struct Node {
    Box box;
    std::size_t skip = 0;            ///< next node when this one is left out
    std::size_t first = 0, end = 0;  ///< boxes of a leaf in order_; empty for inner nodes
  };
  void build(std::size_t first, std::size_t end, const Vector3& typical_size);

  std::span<const Box> boxes_;
  std::vector<std::int32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace pcbmesh::validation::checks
