// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/checks/box_tree.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace pcbmesh::validation::checks {

BoxTree::BoxTree(std::span<const Box> boxes) : boxes_(boxes), order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0);
  Vector3 typical{};
  for (const Box& box : boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      typical[axis] += (double{box.high[axis]} - double{box.low[axis]}) / static_cast<double>(boxes.size());
    }
  }
  nodes_.reserve(boxes.size() / 2 + 2);
  build(0, boxes.size(), typical);
}

void BoxTree::build(std::size_t first, std::size_t end, const Vector3& typical_size) {
  constexpr std::size_t leaf_size = 6;
  constexpr double huge = std::numeric_limits<double>::infinity();
  Box around;
  Vector3 least{huge, huge, huge}, most{-huge, -huge, -huge};  // of twice the middles
  for (std::size_t i = first; i < end; ++i) {
    const Box& box = boxes_[static_cast<std::size_t>(order_[i])];
    around.add(box);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double middle = double{box.low[axis]} + double{box.high[axis]};
      least[axis] = std::min(least[axis], middle);
      most[axis] = std::max(most[axis], middle);
    }
  }
  const std::size_t node = nodes_.size();
  nodes_.push_back({around, 0, static_cast<std::int32_t>(first), static_cast<std::int32_t>(end)});
  if (end - first > leaf_size) {
    // Boards are flat: measured in typical faces, a stack of layers is as wide as the board, and is split as early.
    std::size_t axis = 0;
    double widest = -1;
    for (std::size_t a = 0; a < 3; ++a) {
      const double width = (most[a] - least[a]) / std::max(typical_size[a], 1e-300);
      if (width > widest) {
        widest = width;
        axis = a;
      }
    }
    const std::size_t half = first + (end - first) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(half), at(end), [&](std::int32_t a, std::int32_t b) {
      const Box& box_a = boxes_[static_cast<std::size_t>(a)];
      const Box& box_b = boxes_[static_cast<std::size_t>(b)];
      const double middle_a = double{box_a.low[axis]} + double{box_a.high[axis]},
                   middle_b = double{box_b.low[axis]} + double{box_b.high[axis]};
      return middle_a != middle_b ? middle_a < middle_b : a < b;
    });
    nodes_[node].first = nodes_[node].end = 0;
    build(first, half, typical_size);
    build(half, end, typical_size);
  }
  nodes_[node].skip = static_cast<std::int32_t>(nodes_.size());
}

}  // namespace pcbmesh::validation::checks
