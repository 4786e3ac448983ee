// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/hilbert_order.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pcbmesh::triangulate {
namespace {

constexpr int bits = 16;

std::uint32_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint32_t key = 0;
  for (int level = bits - 1; level >= 0; --level) {
    const std::uint32_t right = (x >> level) & 1U, upper = (y >> level) & 1U;
    key = (key << 2U) | ((3U * right) ^ upper);
    if (upper == 0) {  // the lower quadrants hold turned copies of the curve
      if (right == 1) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
  }
  return key;
}

struct Keyed {
  std::uint32_t key;
  std::uint32_t index;
};

void radix_pass(const std::vector<Keyed>& from, std::vector<Keyed>& to, unsigned shift) {
  constexpr std::uint32_t mask = 0x7ffU;
  std::vector<std::size_t> starts(mask + 2, 0);
  for (const Keyed& item : from) ++starts[((item.key >> shift) & mask) + 1];
  for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
  for (const Keyed& item : from) to[starts[(item.key >> shift) & mask]++] = item;
}

}  // namespace

std::vector<std::uint32_t> hilbert_order(std::span<const std::array<float, 2>> points) {
  if (points.empty()) return {};
  std::array<float, 2> low = points[0], high = points[0];
  for (const auto& p : points) {
    low = {std::min(low[0], p[0]), std::min(low[1], p[1])};
    high = {std::max(high[0], p[0]), std::max(high[1], p[1])};
  }
  const float extent = std::max({high[0] - low[0], high[1] - low[1], 1e-30F});
  const float scale = 65535.0F / extent;
  std::vector<Keyed> items(points.size()), scratch(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto x = static_cast<std::uint32_t>((points[i][0] - low[0]) * scale);
    const auto y = static_cast<std::uint32_t>((points[i][1] - low[1]) * scale);
    items[i] = {hilbert_key(std::min(x, 65535U), std::min(y, 65535U)), static_cast<std::uint32_t>(i)};
  }
  radix_pass(items, scratch, 0);
  radix_pass(scratch, items, 11);
  radix_pass(items, scratch, 22);
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = scratch[i].index;
  return order;
}

}  // namespace pcbmesh::triangulate
