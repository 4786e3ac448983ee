// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "formats/mesh_builder/mesh_builder.hpp"
#include "formats/syntax/byte_source.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"

namespace pcbmesh::formats::msh {

/// Which faces of the mesh belong to which surface of the file. Faces of a group are in the mesh and kept here as runs of
/// indices; faces of none are kept as they are, because the mesh drops them.
class SurfaceFaces {
 public:
  /// @param in_mesh  index among the faces of this kind in the mesh; -1 = left out there
  /// @param corners  node numbers of the file
  void add(mesh::ElementKind kind, std::int32_t surface, std::int64_t in_mesh, std::span<const std::int64_t> corners);
  /// Corners of all faces of a surface, as indices of nodes.
  [[nodiscard]] std::vector<mesh::FaceBlock> of(std::int32_t surface, const MeshBuilder& builder) const;

 private:
  struct Run {
    mesh::ElementKind kind;
    std::int64_t first, count;
  };
  struct Surface {
    std::vector<Run> runs;
    std::vector<std::int64_t> triangles, quadrangles;  ///< node numbers of faces that are not in the mesh
  };
  std::map<std::int32_t, Surface> surfaces_;
  Surface* last_ = nullptr;
  std::int32_t last_tag_ = 0;
};

/// One link of $Periodic between surfaces, as the file has it.
struct SurfaceLink {
  std::int32_t surface = 0, partner = 0;
  std::optional<std::array<double, 12>> from_partner;
  std::vector<std::array<std::int64_t, 2>> node_numbers;
};

/// Reads the body of $Periodic. Links of points and curves are passed over: those of surfaces hold their nodes too.
/// @param numbers  text or binary as the file; MSH 2.2 writes this section as text always.
/// @throws Error file_syntax (202), file_truncated (205).
[[nodiscard]] std::vector<SurfaceLink> read_periodic(syntax::ByteSource& source, syntax::Numbers numbers, bool is_41);

/// Node numbers to indices, surfaces to faces. Call when nodes and elements are read.
[[nodiscard]] std::vector<mesh::PeriodicLink> resolve(std::span<const SurfaceLink> links, const SurfaceFaces& faces,
                                                      const MeshBuilder& builder);

}  // namespace pcbmesh::formats::msh
