// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/copper_distance.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "src/triangulate/hilbert_order.hpp"

namespace pcbmesh::triangulate {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double squared_to_box(const std::array<double, 4>& box, double x, double y) {
  const double dx = std::max({box[0] - x, 0.0, x - box[2]}), dy = std::max({box[1] - y, 0.0, y - box[3]});
  return dx * dx + dy * dy;
}

double squared_to_segment(const SegmentDistance::Segment& s, double x, double y) {
  const double ux = s[2] - s[0], uy = s[3] - s[1], px = x - s[0], py = y - s[1];
  const double length2 = ux * ux + uy * uy;
  const double t = length2 > 0 ? std::clamp((px * ux + py * uy) / length2, 0.0, 1.0) : 0.0;
  const double dx = px - t * ux, dy = py - t * uy;
  return dx * dx + dy * dy;
}

}  // namespace

SegmentDistance::SegmentDistance(std::vector<Segment> segments) {
  if (segments.empty()) return;
  std::vector<std::array<float, 2>> middles;
  middles.reserve(segments.size());
  for (const Segment& s : segments) {
    middles.push_back({static_cast<float>(0.5 * (s[0] + s[2])), static_cast<float>(0.5 * (s[1] + s[3]))});
  }
  segments_.reserve(segments.size());
  for (const std::uint32_t i : hilbert_order(middles)) segments_.push_back(segments[i]);
  num_leaves_ = std::bit_ceil((segments_.size() + leaf_size - 1) / leaf_size);
  boxes_.assign(2 * num_leaves_ - 1, Box{infinity, infinity, -infinity, -infinity});
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    Box& box = boxes_[num_leaves_ - 1 + k / leaf_size];
    const Segment& s = segments_[k];
    box = {std::min({box[0], s[0], s[2]}), std::min({box[1], s[1], s[3]}), std::max({box[2], s[0], s[2]}),
           std::max({box[3], s[1], s[3]})};
  }
  for (std::size_t i = num_leaves_ - 1; i-- > 0;) {
    const Box &l = boxes_[2 * i + 1], &r = boxes_[2 * i + 2];
    boxes_[i] = {std::min(l[0], r[0]), std::min(l[1], r[1]), std::max(l[2], r[2]), std::max(l[3], r[3])};
  }
}

double SegmentDistance::at(double x, double y, double limit) const {
  if (segments_.empty()) return limit;
  double best = limit * limit;
  std::array<std::pair<std::size_t, double>, 64> stack;  // depth of the tree is below 32
  std::size_t depth = 0;
  stack[depth++] = {0, squared_to_box(boxes_[0], x, y)};
  while (depth > 0) {
    const auto [node, nearest] = stack[--depth];
    if (!(nearest < best)) continue;
    if (node >= num_leaves_ - 1) {
      const std::size_t first = (node - (num_leaves_ - 1)) * leaf_size;
      const std::size_t last = std::min(first + leaf_size, segments_.size());
      for (std::size_t k = first; k < last; ++k) best = std::min(best, squared_to_segment(segments_[k], x, y));
      continue;
    }
    std::pair<std::size_t, double> left{2 * node + 1, squared_to_box(boxes_[2 * node + 1], x, y)};
    std::pair<std::size_t, double> right{2 * node + 2, squared_to_box(boxes_[2 * node + 2], x, y)};
    if (left.second < right.second) std::swap(left, right);  // the nearer one is popped first
    if (left.second < best) stack[depth++] = left;
    if (right.second < best) stack[depth++] = right;
  }
  return std::sqrt(best);
}

}  // namespace pcbmesh::triangulate
