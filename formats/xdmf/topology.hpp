// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "formats/vtk/mesh_assembly.hpp"

namespace pcbmesh::formats::xdmf {

/// By XDMF's name of the kind, in any case; nothing for "Mixed" and kinds that are not read.
[[nodiscard]] std::optional<mesh::ElementKind> kind_of(std::string_view topology);

/// Adds the elements of an XDMF topology. @param topology  XDMF's name of the kind, in any case, or "Mixed". Wedges stand in
/// Gmsh's order. @param tags  one per element, or empty. @param fail  throws.
/// @throws what `fail` throws, and Error of MeshAssembly.
void add_elements(vtk::MeshAssembly& mesh, std::string_view topology, std::span<const std::int64_t> numbers,
                  std::span<const std::int64_t> tags, const std::function<void(const std::string&)>& fail,
                  std::int64_t first_node = 0);

}  // namespace pcbmesh::formats::xdmf
