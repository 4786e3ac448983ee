// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/shell.hpp"

#include <fmt/format.h>

#include "src/compose/bodies.hpp"

namespace pcbmesh::compose {
namespace {

using geometry::Box;
using study::HullSide;

/// The part of the outer box from `depth` inside the layers of a side outwards.
Box strip(const Footprint& footprint, HullSide side, Nm depth) {
  Box box = footprint.outer;
  switch (side) {
    case HullSide::xmin:
      box.max.x = footprint.box.min.x - depth;
      break;
    case HullSide::xmax:
      box.min.x = footprint.box.max.x + depth;
      break;
    case HullSide::ymin:
      box.max.y = footprint.box.min.y - depth;
      break;
    default:
      box.min.y = footprint.box.max.y + depth;
      break;
  }
  return box;
}

}  // namespace

void add_shell(const study::Study& study, const Footprint& footprint, const Stack& stack, model::ModelParts& parts) {
  model::Shell shell{.inner = footprint.box, .outer = footprint.outer};
  shell.outer_z = shell.inner_z = {stack.slabs.front().z_bottom_nm, stack.slabs.back().z_top_nm};
  bool has_layers = false;
  for (std::size_t i = 0; i < study::num_hull_sides; ++i) {
    const study::Boundary& boundary = study.boundaries[i];
    const auto side = static_cast<HullSide>(i);
    if (boundary.kind != study::BoundaryKind::pml) continue;
    has_layers = true;
    shell.order = boundary.order;
    if (side == HullSide::zmin) shell.inner_z[0] += boundary.thickness;
    if (side == HullSide::zmax) shell.inner_z[1] -= boundary.thickness;
    if (side > HullSide::ymax) continue;
    keep_open(parts, boundary.thickness / boundary.layers);
    for (int layer = 0; layer < boundary.layers; ++layer) {
      const Box box = strip(footprint, side, boundary.thickness * layer / boundary.layers);
      model::Body body{.name = fmt::format("matched layer {} of {}", layer + 1, study::name_of(side)),
                       .kind = model::BodyKind::shell,
                       .first_slab = 0,
                       .last_slab = static_cast<std::int32_t>(stack.slabs.size()) - 1};
      body.stretched = side <= HullSide::xmax ? model::stretched_x : model::stretched_y;
      append_body(parts, std::move(body),
                  {{.rings = {{box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}}}, .simple = true}});
    }
  }
  if (has_layers) parts.shell = shell;
}

}  // namespace pcbmesh::compose
