// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/model/model.hpp"

#include <algorithm>
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
  const std::size_t first_port = parts.bodies.size() - std::min(parts.bodies.size(), parts.ports.size());
  std::size_t first_guide = first_port;
  while (first_guide > 0 && parts.bodies[first_guide - 1].kind == BodyKind::shell) --first_guide;
  for (std::size_t i = 0; i < parts.bodies.size(); ++i) {
    PCBMESH_ASSERT((parts.bodies[i].kind == BodyKind::port) == (i >= first_port));
    PCBMESH_ASSERT((parts.bodies[i].kind == BodyKind::shell) == (i >= first_guide && i < first_port));
  }
  PCBMESH_ASSERT(parts.outline.size() == parts.outline_sides.size());
  for (const Port& port : parts.ports) {
    PCBMESH_ASSERT(port.body >= 0 && static_cast<std::size_t>(port.body) >= first_port &&
                   static_cast<std::size_t>(port.body) < parts.bodies.size());
    PCBMESH_ASSERT(port.positive_net < num_nets && port.negative_net < num_nets && port.face >= 0 && port.face <= num_slabs);
  }
  for (const Body& body : parts.bodies)
    PCBMESH_ASSERT(!body.sheet || (body.sheet->face >= 0 && body.sheet->face <= num_slabs && !body.hollow));
  for (const BodyShape& shape : parts.shapes) {
    PCBMESH_ASSERT(shape.body >= 0 && static_cast<std::size_t>(shape.body) < parts.bodies.size() && !shape.rings.empty());
  }
  Model model;
  model.first_guide_ = static_cast<std::int32_t>(first_guide);
  model.parts_ = std::make_shared<const ModelParts>(std::move(parts));
  return model;
}

std::string_view Model::net_name(std::int32_t net) const {
  return net < 0 ? std::string_view("no net") : std::string_view(parts_->nets[static_cast<std::size_t>(net)]);
}

Label Model::resolve(std::int32_t slab, std::span<const std::int32_t> present) const {
  const Slab& here = parts_->slabs[static_cast<std::size_t>(slab)];
  if (present.empty() || present[0] != 0) return {};
  std::uint8_t stretched = here.is_stretched ? stretched_z : 0;
  for (auto body = present.rbegin(); parts_->shell && body != present.rend() && *body >= first_guide_; ++body)
    stretched |= parts_->bodies[static_cast<std::size_t>(*body)].stretched;
  if (present.size() < 2 || present[1] != 1) return {here.outside, board::no_net, -2, stretched};
  const std::int32_t index = top_body(slab, present);
  if (index < 0) return {here.material, board::no_net, -2, stretched};
  const Body& top = parts_->bodies[static_cast<std::size_t>(index)];
  if (top.hollow) return {-1, board::no_net, top.net, stretched};
  return {top.material, top.net, -2, stretched};
}

std::int32_t Model::top_body(std::int32_t slab, std::span<const std::int32_t> present) const {
  std::int32_t top = -1, priority = 0;
  for (const std::int32_t index : present) {
    const Body& body = parts_->bodies[static_cast<std::size_t>(index)];
    if (index < 2 || body.sheet || index >= first_guide_ || slab < body.first_slab || slab > body.last_slab) continue;
    if (top < 0 || body.priority > priority) top = index, priority = body.priority;
  }
  return top;
}

std::int32_t Model::sheet_at(std::int32_t face, std::span<const std::int32_t> present) const {
  if (present.size() < 3 || present[0] != 0 || present[1] != 1) return -1;
  const auto sheet = std::find_if(present.begin() + 2, present.end(), [&](std::int32_t index) {
    const Body& body = parts_->bodies[static_cast<std::size_t>(index)];
    return body.sheet && body.sheet->face == face;
  });
  if (sheet == present.end()) return -1;
  const auto num_slabs = static_cast<std::int32_t>(parts_->slabs.size());
  const Body& conductor = parts_->bodies[static_cast<std::size_t>(*sheet)];
  for (const std::int32_t slab : {face - 1, face}) {
    const std::int32_t top = slab >= 0 && slab < num_slabs ? top_body(slab, present) : -1;
    if (top < 0) continue;
    // A film of mask lies on a sheet and leaves it alone; everything else takes its place.
    const Body& other = parts_->bodies[static_cast<std::size_t>(top)];
    if (other.kind != BodyKind::filler || other.priority > conductor.priority) return -1;
  }
  return *sheet;
}

}  // namespace pcbmesh::model
