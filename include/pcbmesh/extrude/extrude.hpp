// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/mesh/layer_plan.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::extrude {

/// Planar mesh x layer plan x model -> tagged prism mesh.
///
/// Volume tags: one per (layer, material, net) in use. Face tags: zmin, zmax; xmin, xmax, ymin, ymax for walls on the sides of
/// the bounding box, "side" for other outer walls, "surface|net" for skins of hollow conductors. Only tags in use are listed;
/// the six box sides come first.
///
/// @guarantee E1  every face between a prism and a void or the outside has exactly one tag
/// @guarantee E2  a face tag is either outer or conductor, never both
/// @cost O(triangles x slabs).
[[nodiscard]] mesh::PrismMesh extrude(const mesh::PlanarMesh& planar, const mesh::LayerPlan& plan, const model::Model& model,
                                      std::span<const std::int32_t> net_pieces,
                                      std::span<const std::array<std::int32_t, 2>> touching_nets);

}  // namespace pcbmesh::extrude
