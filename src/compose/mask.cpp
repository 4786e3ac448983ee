// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/mask.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "src/compose/bodies.hpp"

namespace pcbmesh::compose {

void add_mask(const board::Board& board, const study::Study& study, const Footprint& footprint, const Stack& stack,
              model::ModelParts& parts, Diagnostics& diagnostics) {
  if (!study.fabrication.solder_mask) return;
  if (stack.masks.empty())
    diagnostics.warn("compose.solder_mask_absent", "the study asks for solder mask, but the board's stackup has none",
                     {.file = board.source()});
  for (const MaskSlabs& mask : stack.masks) {
    std::vector<model::BodyShape> film, openings;
    for (const board::Shape& shape : board.shapes()) {
      if (shape.copper_layer != mask.copper_layer || !geometry::bounds(shape.figure).touches(footprint.box)) continue;
      model::BodyShape rings = shape_of(shape.figure, study, footprint, shape.line);
      if (rings.rings.empty()) continue;
      if (shape.kind == board::ShapeKind::pad) openings.push_back(rings);
      // Pads too, though they are opened: then the film's outline is the copper's, and costs no edges of its own.
      film.push_back(std::move(rings));
    }
    const std::string& layer = board.copper_name(mask.copper_layer);
    diagnostics.assume(Severity::note, "compose.mask_openings",
                       "the board does not say where solder mask is open: pads are bare to their edge, vias and tracks covered",
                       {.file = board.source(), .layer = layer});
    if (!film.empty() && mask.film >= 0)
      append_body(parts,
                  {.name = fmt::format("mask over {}", layer),
                   .kind = model::BodyKind::filler,
                   .material = mask.material,
                   .first_slab = mask.film,
                   .last_slab = mask.film,
                   .priority = mask_priority},
                  std::move(film));
    if (!openings.empty())
      append_body(parts,
                  {.name = fmt::format("mask openings over {}", layer),
                   .kind = model::BodyKind::filler,
                   .material = stack.air,
                   .first_slab = mask.slabs.first,
                   .last_slab = mask.slabs.last,
                   .priority = hole_priority},
                  std::move(openings));
  }
}

}  // namespace pcbmesh::compose
