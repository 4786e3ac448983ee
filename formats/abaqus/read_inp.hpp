// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::formats::abaqus {

/// Reads the mesh of an Abaqus or CalculiX input file: *NODE, *ELEMENT of kinds C3D4, C3D5, C3D6, C3D8, C3D10 and C3D15 (any
/// letters may follow, as in C3D8R) and *SURFACE of sides of elements ("12, S3"). The element set named on *ELEMENT is the
/// volume group, the surface the face group: "V3_air" has tag 3, names without a number are counted from the greatest; a
/// comment "** volume 3 air" gives the name that a set name can't spell. Elements without a set have no tag. Everything else
/// (other sets, materials, steps) is passed over. Also packed as .gz or .xz. Shares no code with the writer.
/// @throws Error file_unreadable (201); file_syntax (202): other kinds of elements, *INCLUDE, nodes or elements that do not
///         exist; file_truncated (205). With the line.
/// @cost one pass; memory never exceeds a small multiple of the file's size.
[[nodiscard]] mesh::MeshData read_inp(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::formats::abaqus
