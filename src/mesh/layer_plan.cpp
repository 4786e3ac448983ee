// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/layer_plan.hpp"

#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::mesh {

LayerPlan LayerPlan::from_parts(LayerPlanParts parts) {
  const auto reject = [](const char* why) { throw Error(ErrorCode::layering_invalid, why); };
  if (parts.slab.empty() || parts.z_m.size() != parts.slab.size() + 1)
    reject("a layer plan needs one level more than sub-layers");
  LayerPlan plan;
  for (std::size_t k = 0; k < parts.slab.size(); ++k) {
    if (!(parts.z_m[k + 1] > parts.z_m[k])) reject("levels of the layer plan must increase strictly");
    const std::int32_t before = k == 0 ? -1 : parts.slab[k - 1];
    if (parts.slab[k] != before && parts.slab[k] != before + 1) reject("every slab needs at least one sub-layer, in order");
    if (parts.slab[k] != before) plan.first_.push_back(static_cast<std::int32_t>(k));
  }
  plan.first_.push_back(static_cast<std::int32_t>(parts.slab.size()));
  plan.parts_ = std::make_shared<const LayerPlanParts>(std::move(parts));
  return plan;
}

double LayerPlan::height_m(std::int32_t sublayer) const {
  const auto k = static_cast<std::size_t>(sublayer);
  return parts_->z_m[k + 1] - parts_->z_m[k];
}

std::int32_t LayerPlan::first_sublayer(std::int32_t slab) const {
  return first_[static_cast<std::size_t>(slab)];
}

}  // namespace pcbmesh::mesh
