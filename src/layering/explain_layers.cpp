// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include "pcbmesh/layering/divide_layers.hpp"
#include "pcbmesh/layering/prism_quality.hpp"

namespace pcbmesh::layering {
namespace {

constexpr int bins_per_octave = 100, num_bins = 40 * bins_per_octave;  // from a picometre to a metre

std::size_t bin_of(double height_m) {
  return static_cast<std::size_t>(std::clamp(bins_per_octave * (std::log2(height_m) + 40.0), 0.0, num_bins - 1.0));
}

/// Triangles of one slab by optimal height. Coarser than HeightStatistics: a table of layers shows four digits.
struct SlabTriangles {
  std::int64_t count = 0;
  double sum_height = 0, sum_sensitivity = 0;
  std::vector<HeightBin> bins = std::vector<HeightBin>(num_bins);

  void add(double height, double quality, std::size_t at) {
    ++count;
    sum_height += height;
    sum_sensitivity -= 4.0 / 3.0 * quality / (height * height);
    HeightBin& bin = bins[at];
    bin.height += height;
    bin.sum_quality += quality;
    bin.count += 1;
  }
  [[nodiscard]] double mean_quality(double height) const {
    double sum = 0;
    for (const HeightBin& bin : bins)
      if (bin.count > 0) sum += bin.sum_quality * quality_falloff(height * bin.count / bin.height);
    return sum / static_cast<double>(count);
  }
};

std::vector<SlabTriangles> triangles_by_slab(const mesh::PrismMesh& mesh) {
  std::vector<SlabTriangles> slabs(static_cast<std::size_t>(mesh.plan().num_slabs()));
  const mesh::PlanarMesh& planar = mesh.planar();
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto squared = planar.squared_edges_m2(t);
    const double beta = squared[0] + squared[1] + squared[2];
    const double quality = max_prism_quality * triangle_quality(planar.area_m2(t), beta), height = optimal_height(beta);
    const std::size_t bin = bin_of(height);
    for (std::size_t s = 0; s < slabs.size(); ++s)
      if (mesh.tag_of(static_cast<std::int32_t>(s), t) >= 0) slabs[s].add(height, quality, bin);
  }
  return slabs;
}

}  // namespace

std::vector<LayerExplanation> explain_layers(const mesh::PrismMesh& mesh, std::span<const LayerChoice> layers) {
  const std::vector<SlabTriangles> slabs = triangles_by_slab(mesh);
  std::vector<LayerExplanation> out(layers.size());
  for (std::size_t s = 0; s < layers.size(); ++s) {
    const SlabTriangles& slab = slabs[s];
    const LayerChoice& layer = layers[s];
    LayerExplanation& e = out[s];
    if (slab.count == 0) continue;
    const auto num_triangles = static_cast<double>(slab.count);
    e.num_triangles = slab.count;
    e.prisms_before = slab.count * layer.policy_count;
    e.prisms_after = slab.count * layer.count;
    e.quality_before = slab.mean_quality(layer.height_m / layer.policy_count);
    if (layer.highest_m - layer.lowest_m <= 1e-9 * layer.highest_m) {
      e.quality_after = slab.mean_quality(layer.height_m / layer.count);
    } else {
      const auto slab_id = static_cast<std::int32_t>(s);
      for (std::int32_t k = mesh.plan().first_sublayer(slab_id); k < mesh.plan().first_sublayer(slab_id + 1); ++k)
        e.quality_after += slab.mean_quality(mesh.plan().height_m(k)) / layer.count;
    }
    if (layer.count > 1) e.quality_one_fewer = slab.mean_quality(layer.height_m / (layer.count - 1));
    e.quality_one_more = slab.mean_quality(layer.height_m / (layer.count + 1));
    e.best_height_m = slab.sum_height / num_triangles;
    e.relative_height = layer.height_m / layer.count / e.best_height_m;
    e.sensitivity_per_m2 = slab.sum_sensitivity / num_triangles;
  }
  return out;
}

}  // namespace pcbmesh::layering
