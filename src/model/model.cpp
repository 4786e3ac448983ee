// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/model/model.hpp"

#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::model {

Model Model::from_parts(ModelParts parts) {
  const auto num_slabs = static_cast<std::int32_t>(parts.slabs.size());
  const auto num_materials = static_cast<std::int32_t>(parts.materials.size());
  const auto num_nets = static_cast<std::int32_t>(parts.nets.size());
  PCBMESH_ASSERT(num_slabs > 0);
  for (std::size_t i = 0; i < parts.slabs.size(); ++i) {
    const Slab& slab = parts.slabs[i];
    PCBMESH_ASSERT(slab.z_top_nm > slab.z_bottom_nm);
    PCBMESH_ASSERT(i == 0 || slab.z_bottom_nm == parts.slabs[i - 1].z_top_nm);
    PCBMESH_ASSERT(slab.material >= 0 && slab.material < num_materials && slab.outside >= -1 && slab.outside < num_materials);
  }
  PCBMESH_ASSERT(parts.bodies.size() >= 2 && parts.bodies[0].kind == BodyKind::domain &&
                 parts.bodies[1].kind == BodyKind::board);
  for (std::size_t i = 0; i < parts.bodies.size(); ++i) {
    const Body& body = parts.bodies[i];
    PCBMESH_ASSERT(body.first_slab >= 0 && body.first_slab <= body.last_slab && body.last_slab < num_slabs);
    PCBMESH_ASSERT(i >= 2 || (body.first_slab == 0 && body.last_slab == num_slabs - 1));
    PCBMESH_ASSERT(body.material >= -1 && body.material < num_materials && body.net >= board::no_net && body.net < num_nets);
  }
  for (const BodyShape& shape : parts.shapes) {
    PCBMESH_ASSERT(shape.body >= 0 && static_cast<std::size_t>(shape.body) < parts.bodies.size() && !shape.rings.empty());
  }
  Model model;
  model.parts_ = std::make_shared<const ModelParts>(std::move(parts));
  return model;
}

std::string_view Model::net_name(std::int32_t net) const {
  return net < 0 ? std::string_view("no net") : std::string_view(parts_->nets[static_cast<std::size_t>(net)]);
}

Label Model::resolve(std::int32_t slab, std::span<const std::int32_t> present) const {
  const Slab& here = parts_->slabs[static_cast<std::size_t>(slab)];
  if (present.empty() || present[0] != 0) return {};
  if (present.size() < 2 || present[1] != 1) return {here.outside, board::no_net, -2};
  const Body* top = nullptr;
  for (std::int32_t index : present.subspan(2)) {
    const Body& body = parts_->bodies[static_cast<std::size_t>(index)];
    if (slab < body.first_slab || slab > body.last_slab) continue;
    if (top == nullptr || body.priority > top->priority) top = &body;
  }
  if (top == nullptr) return {here.material, board::no_net, -2};
  if (top->hollow) return {-1, board::no_net, top->net};
  return {top->material, top->net, -2};
}

}  // namespace pcbmesh::model
