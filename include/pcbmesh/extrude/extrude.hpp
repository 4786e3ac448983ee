// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "pcbmesh/mesh/layer_plan.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::extrude {

/// Planar mesh x layer plan x model -> tagged prism mesh.
///
/// Volume tags: one per (layer, material, net) in use, named "layer|material|net", net "none" where there is none; sorted by
/// layer, material, net. Adjacent slabs of one name are one layer. A layer or material name that comes again for a different
/// layer or material gets " #2", " #3" ..., so that every tag name is unique.
///
/// Face tags: "zmin", "zmax", "xmin", "xmax", "ymin", "ymax" for faces on the sides of the bounding box of the meshed part,
/// "side" for all other outer faces (walls elsewhere, and steps beside voids that are no conductors), "surface|net" for skins
/// of hollow conductors ("surface|none" without a net), "sheet|net" for sheets between two prisms, "sheet|net|outer" for sheets
/// on the hull, "port|name" and "waveport|name". Only tags in use are listed, in this order; nets ascending.
///
/// @param net_pieces     per net of the model, or empty = not known; handed on to the mesh, as is `touching_nets`.
/// @guarantee E1  every face between a prism and a void or the outside has exactly one tag
/// @guarantee E2  no face tag has faces between two prisms and faces of the boundary
/// @guarantee E3  the faces of a lumped port are its rectangle or ring, and its edges lie on its two conductors
/// @throws Error port_invalid (306) naming every port that is otherwise
/// @throws Error internal (901) if the plan or the planar mesh was made for another model.
/// @cost O(triangles x slabs); memory O(triangles + regions x slabs + boundary faces of one sub-layer per slab).
[[nodiscard]] mesh::PrismMesh extrude(const mesh::PlanarMesh& planar, const mesh::LayerPlan& plan, const model::Model& model,
                                      std::span<const std::int32_t> net_pieces,
                                      std::span<const std::array<std::int32_t, 2>> touching_nets);

/// One part of a tag name. Inside it '|', '%', '"', control characters, and the first letter of a net called just "none",
/// are written %XX (two upper-case hexadecimal digits of the byte), so that a name splits at '|' into its parts again.
[[nodiscard]] std::string escape_tag_part(std::string_view name);
/// Inverse of escape_tag_part; a '%' without two hexadecimal digits stays as it is.
[[nodiscard]] std::string unescape_tag_part(std::string_view part);

}  // namespace pcbmesh::extrude
