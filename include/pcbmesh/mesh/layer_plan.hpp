// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace pcbmesh::mesh {

struct LayerPlanParts {
  std::vector<double> z_m;         ///< levels, strictly increasing, num_sublayers + 1
  std::vector<std::int32_t> slab;  ///< slab of each sub-layer, non-decreasing, dense from 0
};

/// z levels of the extrusion and the slab each sub-layer belongs to; bottom to top.
///
/// @guarantee L1  z strictly increasing; every slab has at least one sub-layer, and slab faces are levels
class LayerPlan {
 public:
  /// @throws Error layering_invalid (501).
  [[nodiscard]] static LayerPlan from_parts(LayerPlanParts parts);
  [[nodiscard]] std::int32_t num_sublayers() const { return static_cast<std::int32_t>(parts_->slab.size()); }
  [[nodiscard]] std::int32_t num_levels() const { return num_sublayers() + 1; }
  [[nodiscard]] std::int32_t num_slabs() const { return parts_->slab.back() + 1; }
  [[nodiscard]] std::span<const double> z_m() const { return parts_->z_m; }
  [[nodiscard]] std::span<const std::int32_t> slab_of_sublayer() const { return parts_->slab; }
  [[nodiscard]] double height_m(std::int32_t sublayer) const;
  /// First sub-layer of a slab; slab num_slabs() gives num_sublayers().
  [[nodiscard]] std::int32_t first_sublayer(std::int32_t slab) const;

 private:
  std::shared_ptr<const LayerPlanParts> parts_;
  std::vector<std::int32_t> first_;
};

}  // namespace pcbmesh::mesh
