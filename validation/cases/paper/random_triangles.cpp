// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "pcbmesh/base/running_sum.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "validation/cases/paper/measure.hpp"

namespace pcbmesh::validation::paper {
namespace {

using Json = nlohmann::ordered_json;

struct Triangle {
  double area = 0, beta = 0;
  std::array<double, 3> squared{};
};

/// The standard's distributions differ between libraries, so the scaling is our own: the same triangles everywhere.
Triangle draw(std::mt19937_64& random) {
  std::array<std::array<double, 2>, 3> p{};
  for (auto& corner : p) {
    for (double& x : corner) x = static_cast<double>(random() >> 11U) * 0x1p-53;
  }
  Triangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    const double dx = p[(i + 1) % 3][0] - p[(i + 2) % 3][0], dy = p[(i + 1) % 3][1] - p[(i + 2) % 3][1];
    triangle.squared[i] = dx * dx + dy * dy;
    triangle.beta += triangle.squared[i];
  }
  triangle.area = 0.5 * std::abs((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0]));
  return triangle;
}

struct Summary {
  double low = 10, high = 0;
  RunningSum sum;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    sum.add(value);
  }
  [[nodiscard]] Json json(int count) const { return {{"max", high}, {"min", low}, {"avg", sum.total() / count}}; }
};

}  // namespace

Json measure_random_triangles(std::uint64_t seed, int count) {
  std::mt19937_64 random(seed);
  Summary optimal, average, ratio;
  for (int i = 0; i < count; ++i) {
    const Triangle t = draw(random);
    const double best = layering::prism_quality(t.area, t.beta, layering::optimal_height(t.beta));
    const double edge = layering::prism_quality(t.area, t.beta, layering::average_edge_height(t.squared));
    optimal.add(best);
    average.add(edge);
    ratio.add(edge / best);
  }
  return {{"seed", seed},
          {"count", count},
          {"optimal_height", optimal.json(count)},
          {"average_edge", average.json(count)},
          {"paired_ratio", ratio.json(count)}};
}

Json sample_sensitivity(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Triangle t = draw(random);
  const double best = layering::optimal_height(t.beta), quality = layering::prism_quality(t.area, t.beta, best);
  const double second = -512.0 * t.area / (27.0 * t.beta * t.beta);
  Json points = Json::array();
  for (int i = 0; i <= 120; ++i) {
    const double height = best * (0.4 + 0.01 * i), away = height - best;
    points.push_back({height, layering::prism_quality(t.area, t.beta, height), quality + 0.5 * second * away * away});
  }
  return {{"seed", seed},
          {"edges", {std::sqrt(t.squared[0]), std::sqrt(t.squared[1]), std::sqrt(t.squared[2])}},
          {"optimal_height", best},
          {"optimal_quality", quality},
          {"second_derivative", second},
          {"points", points}};
}

}  // namespace pcbmesh::validation::paper
