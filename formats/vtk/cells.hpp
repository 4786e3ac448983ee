// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats::vtk {

/// VTK's number of a cell kind, and back.
[[nodiscard]] std::uint8_t cell_type(mesh::ElementKind kind);
/// For cells of any order (69 to 74) the kind of first order: the number of nodes tells whether it is.
[[nodiscard]] std::optional<mesh::ElementKind> element_kind(int cell_type);

/// Node order: vtk[i] = ours[order[i]]. Linear wedges stand in the chosen order, quadratic ones in the only one there is.
[[nodiscard]] std::span<const std::uint8_t> node_order(mesh::ElementKind kind, VtkWedge wedge);
[[nodiscard]] bool is_identity(std::span<const std::uint8_t> order);

}  // namespace pcbmesh::formats::vtk
