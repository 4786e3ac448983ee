// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::formats::msh {

/// Reads MSH 2.2 (2.0 to 2.2) and 4.1, text and binary of either byte order, also packed as .gz or .xz.
///
/// Corners are indices into `nodes`, whatever numbers the file gives its nodes. An element's tag is its physical group,
/// in 4.1 the first one of its entity; 0 if it has none. Cells and faces come as one block per kind and order, in file order;
/// faces without a physical group are left out like points and lines, which are counted. Links of $Periodic between surfaces
/// come as MeshData::periodic, their nodes and faces by index.
/// Shares no code with the writer, so that reading back proves something.
///
/// @throws Error file_unreadable (201); file_syntax (202): not MSH, a version or element kind that is not read, numbers that
///         contradict each other; file_truncated (205): the file ends early. With line (text) or byte offset (binary).
/// @cost one pass; memory never exceeds a small multiple of the file's size, whatever its counts claim.
[[nodiscard]] mesh::MeshData read_msh(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::formats::msh
