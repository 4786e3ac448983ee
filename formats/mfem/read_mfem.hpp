// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::formats::mfem {

/// Reads MFEM meshes of versions 1.0, 1.2 and 1.3, three-dimensional, of straight elements; also packed as .gz or .xz.
/// Attribute sets of one attribute become its name; larger sets have no place in MeshData and are passed over. Shares no code
/// with the writer.
/// @throws Error file_unreadable (201); file_syntax (202): another version, a curved or planar mesh, numbers that contradict
/// each
///         other; file_truncated (205). With the line.
/// @cost one pass; memory never exceeds a small multiple of the file's size.
[[nodiscard]] mesh::MeshData read_mfem(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::formats::mfem
