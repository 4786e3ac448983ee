// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>

#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats::native_mesh {

inline constexpr const char* format_name = "pcbmesh native mesh";
inline constexpr std::int64_t format_version = 1;

void write_native(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                  const Progress& progress);
/// The mesh written out: every node, prism and face.
[[nodiscard]] mesh::MeshData read_native(const std::filesystem::path& file, const Progress& progress);

}  // namespace pcbmesh::formats::native_mesh
