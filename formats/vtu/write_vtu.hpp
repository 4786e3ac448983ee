// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "formats/vtk/piece.hpp"
#include "pcbmesh/formats/registry.hpp"

namespace pcbmesh::formats::vtu {

/// One array of a file: name, type and size are known before its bytes are made.
struct ArrayHead {
  std::string_view section, type, name;
  int num_components = 1;
  std::size_t value_bytes = 0;
  std::int64_t num_values = 0;
  [[nodiscard]] std::uint64_t num_bytes() const { return static_cast<std::uint64_t>(num_values) * value_bytes; }
};

/// Points, Cells, CellData: the arrays of a piece in the order of the file.
[[nodiscard]] std::vector<ArrayHead> arrays_of(const vtk::Piece& piece, std::size_t bytes_of_index);

/// One .vtu file. @param scale  written units per unit of the source. @param named  whose names go into the file, if any.
void write_vtu(const vtk::Piece& piece, const std::filesystem::path& file, const WriteMeshOptions& options, double scale,
               const Progress& progress, const mesh::MeshSource* named = nullptr);

}  // namespace pcbmesh::formats::vtu
