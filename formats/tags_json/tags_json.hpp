// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/units.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::formats::tags_json {

/// Materials that conduct at least this well count as conductors, like everything that belongs to a net.
/// Lossy dielectrics lie many orders below, metals and inks above.
inline constexpr double conductor_sigma_s_per_m = 1e3;

/// Writes the contract beside a mesh: what each volume and face tag means, its size, materials, nets.
/// Layout: docs/schema/tags.schema.json. Areas, volumes and the box are in metres whatever the unit of the mesh file.
/// Nets are listed if they have copper cells, skins or sheets; pieces null = not known.
/// @param unit  of the mesh file.
/// @param first_face_id  added to the ids of face groups, as in a mesh file of one number space.
/// @param written  what the mesh file holds if that is not the mesh's prisms: numbers of elements are taken from it. Sizes stay
///                those of the prisms with straight edges.
/// @throws Error write_failed (701); the file appears whole or not at all.
void write_tags(const mesh::PrismMesh& mesh, const std::filesystem::path& file, LengthUnit unit, std::int32_t first_face_id = 0,
                const mesh::MeshSource* written = nullptr);

/// The contract of a mesh handed on to the mesh that was made of it: unit and numbers of elements are those of `written`.
/// @throws Error file_unreadable (201), file_syntax (202) for a file that is none; write_failed (701).
void carry_tags(const std::filesystem::path& from, const std::filesystem::path& to, double unit_m,
                const mesh::MeshSource& written);

}  // namespace pcbmesh::formats::tags_json
