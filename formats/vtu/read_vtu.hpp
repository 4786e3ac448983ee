// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::formats::vtu {

/// Text, base64 (whole or in two parts), appended raw or base64; plain, zlib, LZ4 or LZMA; 32- or 64-bit block headers; several
/// pieces. Tags from volume_tag and face_tag, else gmsh:physical, else material or attribute. Wedges in either order.
/// @throws Error file_unreadable (201), file_syntax (202), file_truncated (205), format_limit (703).
[[nodiscard]] mesh::MeshData read_vtu(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::formats::vtu
