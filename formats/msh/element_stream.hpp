// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::formats::msh {

/// Gmsh's numbers of the element kinds written.
enum class ElementKind : std::int32_t { triangle = 2, quadrangle = 3, wedge = 6 };

[[nodiscard]] constexpr int num_corners(ElementKind kind) {
  return kind == ElementKind::triangle ? 3 : kind == ElementKind::quadrangle ? 4 : 6;
}

/// Elements of one kind that carry one tag.
struct ElementBlock {
  ElementKind kind = ElementKind::wedge;
  std::int32_t tag_index = 0;  ///< into face_tags or volume_tags
  std::int32_t tag = 0;        ///< its id
  std::int64_t count = 0;      ///< > 0
  [[nodiscard]] int dimension() const { return kind == ElementKind::wedge ? 3 : 2; }
};

/// Extent in metres; all zero if nothing carries the tag.
struct Extent {
  std::array<double, 3> min{};
  std::array<double, 3> max{};
};

/// A physical group as files name it.
struct Group {
  int dimension = 3;
  std::int32_t tag = 0;
  std::string name;  ///< unique within its dimension, at most 127 bytes, no quotes or control characters
  Extent extent;
};

/// Boundary faces, then prisms of an implicit mesh, block by block in file order; never holds the 3D mesh.
/// Faces are oriented outwards, seen from the meshed side. Prisms of a tag come slab by slab, a few triangles through all its
/// sub-layers at a time.
///
/// @cost memory O(regions x slabs) + triangle lists of slabs: at most `cache_bytes`, but always room for two; with voids
/// also 12 bytes per vertex of the plane.
class ElementStream {
 public:
  explicit ElementStream(const mesh::PrismMesh& mesh, std::size_t cache_bytes = std::size_t{32} << 20);

  [[nodiscard]] const mesh::PrismMesh& mesh() const { return mesh_; }
  /// Faces by tag (triangles before quadrangles), then volumes by tag; empty blocks are left out.
  [[nodiscard]] std::span<const ElementBlock> blocks() const { return blocks_; }
  [[nodiscard]] std::int64_t num_elements() const { return num_elements_; }
  /// Faces by tag, then volumes by tag.
  [[nodiscard]] std::span<const Group> groups() const { return groups_; }

  /// Corners (node ids from 0), num_corners(kind) per element; at most `chunk` elements a call.
  using Visit = std::function<void(std::span<const std::int64_t> corners)>;
  void visit(const ElementBlock& block, const Visit& visit);
  static constexpr std::size_t chunk = 256;  ///< rows stay in the first-level cache

 private:
  struct SlabGroups {
    std::int32_t slab = -1;
    std::uint64_t last_use = 0;
    std::vector<std::int32_t> offsets, triangles;
  };
  struct LevelRanks {
    std::int32_t level = -1;
    std::uint64_t last_use = 0;
    std::vector<std::int32_t> ranks;
  };
  class Rows;
  void survey_volumes();
  void survey_faces();
  void visit_caps(std::int32_t tag_index, Rows& rows) const;
  void visit_walls(std::int32_t tag_index, Rows& rows) const;
  void visit_wedges(std::int32_t tag_index, Rows& rows);
  void visit_sublayer(std::int32_t sublayer, std::span<const std::array<std::int32_t, 3>> triangles,
                      std::span<const std::int32_t> low_ranks, std::span<const std::int32_t> high_ranks, Rows& rows) const;
  /// Node ids of a level by vertex, minus the level's first id; empty if they are the vertices themselves.
  [[nodiscard]] std::span<const std::int32_t> ranks_of(std::int32_t level);
  [[nodiscard]] std::span<const std::int32_t> triangles_of(std::int32_t slab, std::int32_t tag_index);

  mesh::PrismMesh mesh_;
  std::vector<ElementBlock> blocks_;
  std::vector<Group> groups_;
  std::int64_t num_elements_ = 0;
  std::vector<std::vector<std::int32_t>> slabs_of_tag_;
  std::vector<SlabGroups> cache_;
  std::array<LevelRanks, 3> level_ranks_;  ///< bottom, inside and top of the slab that is being written
  std::size_t max_cached_ = 2;
  std::uint64_t clock_ = 0;
};

}  // namespace pcbmesh::formats::msh
