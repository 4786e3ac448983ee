// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/extrude/face_tags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "pcbmesh/base/units.hpp"
#include "pcbmesh/extrude/extrude.hpp"
#include "src/extrude/tag_names.hpp"

namespace pcbmesh::extrude {
namespace {

constexpr std::array<const char*, num_sides> side_names{"zmin", "zmax", "xmin", "xmax", "ymin", "ymax", "side"};
/// Place of each side in model::ModelParts::sides.
constexpr std::array<std::size_t, num_sides> side_places{4, 5, 0, 1, 2, 3, 6};

mesh::BoundaryCondition condition_of(model::SideKind kind) {
  switch (kind) {
    case model::SideKind::none:
      return mesh::BoundaryCondition::none;
    case model::SideKind::absorbing:
      return mesh::BoundaryCondition::absorbing;
    case model::SideKind::pec:
      return mesh::BoundaryCondition::pec;
    case model::SideKind::pmc:
      return mesh::BoundaryCondition::pmc;
    case model::SideKind::impedance:
      return mesh::BoundaryCondition::impedance;
    case model::SideKind::periodic:
      return mesh::BoundaryCondition::periodic;
  }
  return mesh::BoundaryCondition::none;
}

/// Condition of a hollow or sheet conductor's faces, from the bodies of the net that are so; of sheets, the thinnest counts.
void set_conductor(mesh::FaceTag& tag, const model::Model& model, bool of_sheets) {
  tag.condition = mesh::BoundaryCondition::pec;
  Nm thickness = 0;
  for (const model::Body& body : model.bodies()) {
    if (body.net != tag.net || (of_sheets ? !body.sheet.has_value() : !body.hollow) || body.material < 0) continue;
    if (of_sheets && (thickness == 0 || body.sheet->thickness_nm < thickness)) thickness = body.sheet->thickness_nm;
    const bool is_lossy = model.materials()[static_cast<std::size_t>(body.material)].sigma_s_per_m > 0;
    if (tag.material >= 0 || !is_lossy || model.conductors_are_perfect()) continue;
    tag.condition = mesh::BoundaryCondition::conductor;
    tag.material = body.material;
  }
  tag.thickness_m = static_cast<double>(thickness) * metres_per_nm;
}

}  // namespace

mesh::FaceTag TagSpace::describe(std::int32_t tag, const model::Model& model) const {
  mesh::FaceTag out;
  if (tag < outline_side(num_outline_)) {
    const bool is_of_box = tag < num_sides;
    const auto side = static_cast<std::size_t>(is_of_box ? tag : tag - num_sides);
    const model::SideCondition& condition = is_of_box ? model.sides()[side_places[side]] : model.outline_sides()[side];
    out.name = is_of_box ? side_names[side] : fmt::format("side_{}", side + 1);
    out.condition = condition_of(condition.kind);
    out.impedance_ohm = condition.ohms;
    return out;
  }
  if (const std::int32_t index = port_of(tag); index >= 0) {
    const model::Port& port = model.ports()[static_cast<std::size_t>(index)];
    out.kind = port.is_wave ? mesh::FaceTagKind::wave_port : mesh::FaceTagKind::port;
    out.name = (port.is_wave ? "waveport|" : "port|") + escape_tag_part(port.name);
    out.condition = mesh::BoundaryCondition::port;
    out.port = index;
    return out;
  }
  const bool of_sheets = tag >= inner_sheet(board::no_net), on_hull = tag >= outer_sheet(board::no_net);
  out.kind = of_sheets ? mesh::FaceTagKind::sheet : mesh::FaceTagKind::conductor;
  out.is_inner = of_sheets && !on_hull;
  out.net = (tag - surface(board::no_net)) % num_nets_ - 1;
  out.name = (of_sheets ? "sheet|" : "surface|") + net_part(model.nets(), out.net) + (on_hull ? "|outer" : "");
  set_conductor(out, model, of_sheets);
  return out;
}

}  // namespace pcbmesh::extrude
