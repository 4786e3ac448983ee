// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "formats/mesh_builder/element_blocks.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats::vtk {

/// Collects a mesh from the arrays of a file; every index is checked here.
class MeshAssembly {
 public:
  explicit MeshAssembly(std::filesystem::path file);

  /// Nodes that follow those there are. @param values  three per node.
  void add_nodes(std::span<const double> values);
  [[nodiscard]] std::int64_t num_nodes() const { return static_cast<std::int64_t>(mesh_.nodes.size()); }
  void reserve(mesh::ElementKind kind, std::int64_t count) { blocks_.reserve(kind, count); }
  /// @param nodes  node numbers, `first_node` less than they are; in the file's order. @param order  file[i] = ours[order[i]].
  /// @throws Error file_syntax (202) for numbers without a node.
  void add_element(mesh::ElementKind kind, std::span<const std::int64_t> nodes, std::span<const std::uint8_t> order,
                   std::int32_t tag, std::int64_t first_node = 0);
  void add_point_or_line(bool is_line) { ++mesh_.num_other_elements[is_line ? 1 : 0]; }
  void add_name(int dimension, std::int32_t tag, std::string name) { mesh_.names.push_back({dimension, tag, std::move(name)}); }
  /// Turns all wedges of first order round if most of them are inside out: VTK changed its mind about their corners, and files
  /// do not say.
  void turn_wedges_if_inside_out();
  [[nodiscard]] mesh::MeshData take();

 private:
  std::filesystem::path file_;
  mesh::MeshData mesh_;
  ElementBlocks blocks_;
  std::int64_t num_elements_ = 0;
};

}  // namespace pcbmesh::formats::vtk
