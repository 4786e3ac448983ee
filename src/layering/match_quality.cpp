// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/match_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::layering {
namespace {

/// Triangles at least this large, as optimal height over the mean one of the edge bound, were made by the bound.
constexpr double bulk_over_mean = 0.5;
/// Sub-layers of one layer and of the stack a search looks at: beyond, quality comes from the wrong place.
constexpr int most_cuts_of_layer = 400, most_cuts = 4000;
constexpr double edge_step = 1.0218971486541166;  // 2^(1/32)
constexpr int most_edge_steps = 480;              // down to 2^-15 of the longest edge

/// Sums both means of a stack while single layers gain cuts.
class PlanSums {
 public:
  PlanSums(const HeightStatistics& heights, std::span<const double> layer_heights_m, std::span<const int> counts)
      : heights_(heights), layers_(layer_heights_m), counts_(counts.begin(), counts.end()), quality_(layers_.size()) {
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      volume_ += layers_[i];
      quality_[i] = {at(i, counts_[i]), at(i, counts_[i] + 1)};
      add(i, 1.0);
    }
  }
  [[nodiscard]] PlanQuality quality() const { return {mean_ / num_, by_volume_ / volume_}; }
  [[nodiscard]] PlanQuality with_one_more(std::size_t i) const {
    const auto& [now, next] = quality_[i];
    const auto n = static_cast<double>(counts_[i]);
    return {(mean_ - n * now.mean + (n + 1) * next.mean) / (num_ + 1),
            (by_volume_ + layers_[i] * (next.by_volume - now.by_volume)) / volume_};
  }
  void cut(std::size_t i) {
    add(i, -1.0);
    ++counts_[i];
    quality_[i] = {quality_[i].second, at(i, counts_[i] + 1)};
    add(i, 1.0);
  }
  [[nodiscard]] const std::vector<int>& counts() const { return counts_; }
  [[nodiscard]] int num_sublayers() const { return static_cast<int>(num_); }

 private:
  [[nodiscard]] PlanQuality at(std::size_t i, int count) {
    const double height = layers_[i] / count;
    const auto [found, is_new] = known_.try_emplace(height);
    if (is_new) found->second = {mean_quality_at(heights_, height), area_quality_at(heights_, height)};
    return found->second;
  }
  void add(std::size_t i, double sign) {
    const auto n = static_cast<double>(counts_[i]);
    mean_ += sign * n * quality_[i].first.mean;
    by_volume_ += sign * layers_[i] * quality_[i].first.by_volume;
    num_ += sign * n;
  }

  const HeightStatistics& heights_;
  std::span<const double> layers_;
  std::vector<int> counts_;
  std::vector<std::pair<PlanQuality, PlanQuality>> quality_;  ///< of a layer now and with one cut more
  std::map<double, PlanQuality> known_;                       ///< layers of one height share their figures
  double mean_ = 0, by_volume_ = 0, volume_ = 0, num_ = 0;
};

const MeasuredEdge& nearest(std::span<const MeasuredEdge> measured, double edge_m) {
  return *std::min_element(measured.begin(), measured.end(), [&](const MeasuredEdge& a, const MeasuredEdge& b) {
    return std::abs(std::log(a.longest_edge_m / edge_m)) < std::abs(std::log(b.longest_edge_m / edge_m));
  });
}

}  // namespace

TriangleShape triangle_shape(study::TriangleSeed seed, bool smooth) {
  if (seed == study::TriangleSeed::hex) return {0.765, 0.169, smooth ? 0.99 : 0.96};
  return smooth ? TriangleShape{0.86, 0.198, 0.945} : TriangleShape{};
}

HeightStatistics predict_heights(const HeightStatistics& measured, double from_m, double to_m, const TriangleShape& shape) {
  const double scale = to_m / from_m;
  const double ideal_quality = max_prism_quality * shape.triangle_quality;
  std::map<int, HeightBin> bins;  // 16 an octave: enough for means to 1e-3, and far fewer than measured
  const auto add = [&](double height, double count, double quality, const HeightBin& from) {
    HeightBin& bin = bins[static_cast<int>(std::floor(16.0 * std::log2(height)))];
    bin.height += height * count;
    bin.count += count;
    bin.sum_quality += quality * count;
    bin.area_m2 += from.area_m2;
    bin.sum_area_quality += quality * from.area_m2 * (from.sum_area_quality / from.area_m2) / (from.sum_quality / from.count);
  };
  for (const HeightBin& bin : measured.bins) {
    const double quality = bin.sum_quality / bin.count;
    if (bin.height >= bulk_over_mean * shape.height * from_m) {
      // Finer triangles hang less on the outlines, so they come nearer to the shape the bound makes.
      const double better = scale < 1 ? std::max(0.0, ideal_quality - quality) * (1 - scale) : 0.0;
      add(bin.height * scale, bin.count / (scale * scale), quality + better, bin);
    } else if (bin.height > to_m) {
      add(shape.height * to_m, bin.area_m2 / (shape.area * to_m * to_m), std::max(quality, ideal_quality), bin);
    } else {
      add(bin.height, bin.count, quality, bin);
    }
  }
  HeightStatistics out;
  double count = 0, quality = 0, height = 0, over_height = 0, over_square = 0;
  for (auto [key, bin] : bins) {
    bin.height /= bin.count;
    count += bin.count;
    quality += bin.sum_quality;
    height += bin.height * bin.count;
    over_height += bin.sum_quality / bin.height;
    over_square += bin.sum_quality / (bin.height * bin.height);
    out.bins.push_back(bin);
  }
  if (out.bins.empty()) return out;
  out.num_triangles = std::llround(count);
  // Means divide by the whole number: the sums must fit it.
  for (HeightBin& bin : out.bins) bin.sum_quality *= static_cast<double>(out.num_triangles) / count;
  out.minimum = out.bins.front().height;
  out.maximum = out.bins.back().height;
  out.average = height / count;
  out.weighted = over_height / over_square;
  out.mean_triangle_quality = quality / count / max_prism_quality;
  return out;
}

PlanQuality plan_quality(const HeightStatistics& heights, std::span<const double> layer_heights_m,
                         std::span<const int> counts) {
  return PlanSums(heights, layer_heights_m, counts).quality();
}

std::vector<CountChoice> best_counts(const HeightStatistics& heights, std::span<const double> layer_heights_m,
                                     std::span<const int> least) {
  std::map<int, CountChoice> best;
  std::vector<int> most;
  for (std::size_t i = 0; i < layer_heights_m.size(); ++i)
    most.push_back(std::max(least[i], std::min(most_cuts_of_layer, 2 * optimal_cuts(layer_heights_m[i], heights.average) + 1)));
  for (const double weight : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    PlanSums sums(heights, layer_heights_m, least);
    for (;;) {
      const PlanQuality now = sums.quality();
      const auto [at, is_new] = best.try_emplace(sums.num_sublayers());
      if (is_new || now.least() > at->second.quality.least()) at->second = {sums.counts(), sums.num_sublayers(), now};
      std::size_t choice = most.size();
      double greatest = -std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < most.size(); ++i) {
        if (sums.counts()[i] >= most[i]) continue;
        const PlanQuality next = sums.with_one_more(i);
        const double value = weight * next.mean + (1 - weight) * next.by_volume;
        if (value > greatest + 1e-12) {
          greatest = value;
          choice = i;
        }
      }
      if (choice == most.size() || sums.num_sublayers() >= most_cuts) break;
      sums.cut(choice);
    }
  }
  std::vector<CountChoice> out;
  for (auto& [num, choice] : best)
    if (out.empty() || choice.quality.least() > out.back().quality.least() + 1e-9) out.push_back(std::move(choice));
  return out;
}

std::vector<FrontPoint> pareto_front(std::span<const MeasuredEdge> measured, std::span<const double> layer_heights_m,
                                     std::span<const int> least, const TriangleShape& shape, int extra, double most_prisms) {
  PCBMESH_ASSERT(!measured.empty());
  double edge_m = 0;
  for (const MeasuredEdge& m : measured) edge_m = std::max(edge_m, m.longest_edge_m);
  std::vector<FrontPoint> points;
  for (int step = 0; step < most_edge_steps; ++step, edge_m /= edge_step) {
    const MeasuredEdge& base = nearest(measured, edge_m);
    const HeightStatistics heights = predict_heights(base.heights, base.longest_edge_m, edge_m, shape);
    const auto triangles = static_cast<double>(heights.num_triangles);
    bool is_any = false;
    for (CountChoice& choice : best_counts(heights, layer_heights_m, least)) {
      const double prisms = triangles * (choice.num_sublayers + extra);
      if (prisms > most_prisms) break;
      is_any = true;
      points.push_back({edge_m, triangles, prisms, std::move(choice)});
    }
    if (!is_any && step > 0) break;
  }
  std::stable_sort(points.begin(), points.end(), [](const FrontPoint& a, const FrontPoint& b) { return a.prisms < b.prisms; });
  std::vector<FrontPoint> front;
  for (FrontPoint& point : points)
    if (front.empty() || point.choice.quality.least() > front.back().choice.quality.least() + 1e-6)
      front.push_back(std::move(point));
  return front;
}

std::size_t knee_of(std::span<const FrontPoint> front) {
  PCBMESH_ASSERT(!front.empty());
  const auto x = [&](std::size_t i) { return std::log(front[i].prisms); };
  const auto y = [&](std::size_t i) { return front[i].choice.quality.least(); };
  const std::size_t last = front.size() - 1;
  if (x(last) <= x(0)) return last;
  const double slope = (y(last) - y(0)) / (x(last) - x(0));
  std::size_t knee = last;
  double farthest = 0;
  for (std::size_t i = 0; i <= last; ++i) {
    const double above = y(i) - y(0) - slope * (x(i) - x(0));
    if (above > farthest) {
      farthest = above;
      knee = i;
    }
  }
  return knee;
}

std::int64_t num_edges(const mesh::PrismMesh& mesh) {
  const mesh::PlanarMesh& planar = mesh.planar();
  const mesh::LayerPlan& plan = mesh.plan();
  const std::int32_t num_slabs = plan.num_slabs();
  std::int64_t total = 0;
  // Upright edges stand over the vertices of a slab.
  for (std::int32_t slab = 0; slab < num_slabs; ++slab) {
    std::vector<bool> is_there(static_cast<std::size_t>(planar.num_points()), false);
    for (std::int32_t t = 0; t < planar.num_triangles(); ++t)
      if (mesh.tag_of(slab, t) >= 0)
        for (const std::int32_t v : planar.triangles()[static_cast<std::size_t>(t)])
          is_there[static_cast<std::size_t>(v)] = true;
    total += std::count(is_there.begin(), is_there.end(), true) * (plan.first_sublayer(slab + 1) - plan.first_sublayer(slab));
  }
  // Level edges: each planar edge once per level that touches a prism beside it.
  std::vector<std::pair<std::array<std::int32_t, 2>, std::int32_t>> sides;  // edge, triangle
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto& corners = planar.triangles()[static_cast<std::size_t>(t)];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [u, v] = std::minmax(corners[i], corners[(i + 1) % 3]);
      sides.push_back({{u, v}, t});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].first == sides[i].first) ++end;
    bool below = false;
    for (std::int32_t slab = 0; slab < num_slabs; ++slab) {
      bool here = false;
      for (std::size_t k = i; k < end; ++k) here = here || mesh.tag_of(slab, sides[k].second) >= 0;
      total += (here || below ? 1 : 0) + (here ? plan.first_sublayer(slab + 1) - plan.first_sublayer(slab) - 1 : 0);
      below = here;
    }
    total += below ? 1 : 0;
    i = end;
  }
  return total;
}

}  // namespace pcbmesh::layering
