// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/layering/quality_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "pcbmesh/base/running_sum.hpp"
#include "pcbmesh/layering/prism_quality.hpp"

namespace pcbmesh::layering {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;
constexpr int num_bins = 20;

std::size_t index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// What of a prism does not hang on its height.
struct Base {
  double area = 0, beta = 0, shortest2 = 0, longest2 = 0, min_angle_deg = 0, max_angle_deg = 0;
  Base(double area_m2, const std::array<double, 3>& squared) : area(area_m2), beta(squared[0] + squared[1] + squared[2]) {
    std::tie(shortest2, longest2) = std::minmax({squared[0], squared[1], squared[2]});
    // cot(angle) = (sum of the two edges beside it - edge opposite, all squared) / 4A
    min_angle_deg = std::atan2(4.0 * area, beta - 2.0 * shortest2) * degrees;
    max_angle_deg = std::atan2(4.0 * area, beta - 2.0 * longest2) * degrees;
  }
  [[nodiscard]] PrismMeasures with_height(double height) const {
    const double height2 = height * height;
    PrismMeasures out;
    out.quality = prism_quality(area, beta, height);
    out.nine_edge = nine_edge_quality(area, beta, height);
    out.scaled_jacobian = 2.0 / std::numbers::sqrt3 * std::sin(min_angle_deg / degrees);
    out.aspect_ratio = std::sqrt(std::max(longest2, height2) / std::min(shortest2, height2));
    out.min_dihedral_deg = min_angle_deg;
    out.max_dihedral_deg = std::max(90.0, max_angle_deg);
    return out;
  }
};

struct GroupSums {
  RunningSum volume, quality, weighted, nine_edge;
  std::int64_t num_prisms = 0;
  double min_quality = std::numeric_limits<double>::max(), min_dihedral_deg = 180, max_aspect_ratio = 0;

  void add(const PrismMeasures& m, double prism_volume, std::int32_t count) {
    volume.add(count * prism_volume);
    quality.add(count * m.quality);
    weighted.add(count * prism_volume * m.quality);
    nine_edge.add(count * m.nine_edge);
    num_prisms += count;
    min_quality = std::min(min_quality, m.quality);
    min_dihedral_deg = std::min(min_dihedral_deg, m.min_dihedral_deg);
    max_aspect_ratio = std::max(max_aspect_ratio, m.aspect_ratio);
  }
  void add(const GroupSums& other) {
    volume.add(other.volume.total());
    quality.add(other.quality.total());
    weighted.add(other.weighted.total());
    nine_edge.add(other.nine_edge.total());
    num_prisms += other.num_prisms;
    min_quality = std::min(min_quality, other.min_quality);
    min_dihedral_deg = std::min(min_dihedral_deg, other.min_dihedral_deg);
    max_aspect_ratio = std::max(max_aspect_ratio, other.max_aspect_ratio);
  }
  [[nodiscard]] QualityGroup named(std::string name) const {
    const auto count = static_cast<double>(num_prisms);
    return {std::move(name),
            num_prisms,
            volume.total(),
            quality.total() / count,
            weighted.total() / volume.total(),
            min_quality,
            nine_edge.total() / count,
            min_dihedral_deg,
            max_aspect_ratio};
  }
};

void add_to(QualityHistogram& histogram, double value, std::int64_t count) {
  const double share = (value - histogram.low) / (histogram.high - histogram.low);
  const double bin = std::clamp(std::floor(share * num_bins), 0.0, num_bins - 1.0);
  histogram.counts[static_cast<std::size_t>(bin)] += count;
}

/// The few worst prisms, kept as a heap with the best of them on top.
class WorstList {
 public:
  explicit WorstList(int size) : size_(static_cast<std::size_t>(std::max(size, 0))) {}
  using Entry = std::tuple<double, std::int32_t, std::int32_t, std::size_t>;  ///< quality, slab, triangle, which equal cuts
  void offer(double quality, std::int32_t slab, std::int32_t triangle, std::size_t equal_cuts) {
    const Entry entry{quality, slab, triangle, equal_cuts};
    if (entries_.size() == size_) {
      if (size_ == 0 || !(entry < entries_.front())) return;
      std::pop_heap(entries_.begin(), entries_.end());
      entries_.pop_back();
    }
    entries_.push_back(entry);
    std::push_heap(entries_.begin(), entries_.end());
  }
  [[nodiscard]] std::vector<Entry> sorted() && {
    std::sort_heap(entries_.begin(), entries_.end());
    return std::move(entries_);
  }

 private:
  std::size_t size_;
  std::vector<Entry> entries_;
};

/// Sub-layers of equal height in one slab.
struct EqualCuts {
  std::size_t height = 0;  ///< index into heights
  std::int32_t count = 0, first_sublayer = 0;
};
struct SlabCuts {
  std::vector<double> heights;                ///< distinct
  std::vector<std::vector<EqualCuts>> slabs;  ///< ascending in height index
};

SlabCuts cuts_of(const mesh::LayerPlan& plan) {
  SlabCuts cuts;
  for (std::int32_t slab = 0; slab < plan.num_slabs(); ++slab) {
    std::vector<EqualCuts>& equal = cuts.slabs.emplace_back();
    for (std::int32_t k = plan.first_sublayer(slab); k < plan.first_sublayer(slab + 1); ++k) {
      const double height = plan.height_m(k);
      const auto same = std::find_if(cuts.heights.begin(), cuts.heights.end(),
                                     [&](double other) { return std::abs(other - height) <= 1e-9 * height; });
      const auto at = static_cast<std::size_t>(same - cuts.heights.begin());
      if (same == cuts.heights.end()) cuts.heights.push_back(height);
      const auto known = std::find_if(equal.begin(), equal.end(), [&](const EqualCuts& c) { return c.height == at; });
      if (known == equal.end())
        equal.push_back({at, 1, k});
      else
        ++known->count;
    }
  }
  return cuts;
}

WorstPrism describe(const mesh::PrismMesh& mesh, const SlabCuts& cuts, const WorstList::Entry& entry) {
  const auto [quality, slab, triangle, at] = entry;
  const EqualCuts& equal = cuts.slabs[index(slab)][at];
  const auto z = mesh.plan().z_m();
  WorstPrism out;
  out.quality = quality;
  for (const std::int32_t corner : mesh.planar().triangles()[index(triangle)]) {
    out.at_m[0] += mesh.planar().points_m()[index(corner)][0] / 3.0;
    out.at_m[1] += mesh.planar().points_m()[index(corner)][1] / 3.0;
  }
  out.z_m = 0.5 * (z[index(equal.first_sublayer)] + z[index(equal.first_sublayer) + 1]);
  out.height_m = cuts.heights[equal.height];
  out.triangle = triangle;
  out.slab = slab;
  out.num_sublayers = equal.count;
  out.group = mesh.volume_tags()[index(mesh.tag_of(slab, triangle))].name;
  return out;
}

template <class NameOf>
std::vector<QualityGroup> named_groups(const std::vector<GroupSums>& sums, NameOf name_of) {
  std::vector<QualityGroup> out;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].num_prisms > 0) out.push_back(sums[i].named(name_of(i)));
  }
  return out;
}

void write_groups(const mesh::PrismMesh& mesh, const std::vector<GroupSums>& tags, QualityReport& report) {
  std::vector<GroupSums> layers(mesh.layers().size()), materials(mesh.materials().size()), nets(mesh.nets().size() + 1);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const mesh::VolumeTag& tag = mesh.volume_tags()[i];
    layers[index(tag.layer)].add(tags[i]);
    materials[index(tag.material)].add(tags[i]);
    nets[tag.net < 0 ? mesh.nets().size() : index(tag.net)].add(tags[i]);
  }
  report.layers = named_groups(layers, [&](std::size_t i) { return mesh.layers()[i]; });
  report.materials = named_groups(materials, [&](std::size_t i) { return mesh.materials()[i].name; });
  report.nets = named_groups(nets, [&](std::size_t i) { return i < mesh.nets().size() ? mesh.nets()[i] : "no net"; });
}

}  // namespace

PrismMeasures prism_measures(double area_m2, const std::array<double, 3>& squared_edges_m2, double height_m) {
  return Base(area_m2, squared_edges_m2).with_height(height_m);
}

QualityReport quality_report(const mesh::PrismMesh& mesh, int num_worst) {
  const mesh::PlanarMesh& planar = mesh.planar();
  const SlabCuts cuts = cuts_of(mesh.plan());
  const auto num_slabs = static_cast<std::int32_t>(cuts.slabs.size());
  QualityReport report;
  const std::vector<std::int64_t> none(num_bins, 0);
  report.histograms = {{"prism_quality", 0, 1.05, none},
                       {"nine_edge_quality", 0, 1, none},
                       {"scaled_jacobian", 0, 1, none},
                       {"aspect_ratio", 1, 21, none},
                       {"min_dihedral_deg", 0, 60, none}};
  std::vector<GroupSums> tags(mesh.volume_tags().size());
  std::vector<PrismMeasures> measures(cuts.heights.size());
  std::vector<std::int64_t> counts(cuts.heights.size());
  WorstList worst(num_worst);
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const Base base(planar.area_m2(t), planar.squared_edges_m2(t));
    for (std::size_t h = 0; h < measures.size(); ++h) measures[h] = base.with_height(cuts.heights[h]);
    std::fill(counts.begin(), counts.end(), 0);
    for (std::int32_t slab = 0; slab < num_slabs; ++slab) {
      const std::int32_t tag = mesh.tag_of(slab, t);
      if (tag < 0) continue;
      const std::vector<EqualCuts>& slab_cuts = cuts.slabs[index(slab)];
      for (std::size_t i = 0; i < slab_cuts.size(); ++i) {
        const auto [h, count, first] = slab_cuts[i];
        counts[h] += count;
        tags[index(tag)].add(measures[h], base.area * cuts.heights[h], count);
        worst.offer(measures[h].quality, slab, t, i);
      }
    }
    for (std::size_t h = 0; h < measures.size(); ++h) {
      if (counts[h] == 0) continue;
      const PrismMeasures& m = measures[h];
      const std::array values{m.quality, m.nine_edge, m.scaled_jacobian, m.aspect_ratio, m.min_dihedral_deg};
      for (std::size_t i = 0; i < values.size(); ++i) add_to(report.histograms[i], values[i], counts[h]);
    }
  }
  for (const auto& entry : std::move(worst).sorted()) report.worst.push_back(describe(mesh, cuts, entry));
  write_groups(mesh, tags, report);
  return report;
}

}  // namespace pcbmesh::layering
