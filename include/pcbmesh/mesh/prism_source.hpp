// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::mesh {

/// Area (m2) and sum of squared edges (m2) of a prism's triangle: with the height, all that its quality depends on.
using PrismBase = std::array<double, 2>;
/// Qualities of the prisms of one height over some triangles. REQUIRES as many qualities as bases.
using PrismQuality = std::function<void(std::span<const PrismBase> bases, double height_m, std::span<double> qualities)>;

/// The prisms and tagged faces of an implicit mesh, block by block. Prisms of a tag come slab by slab, a few triangles through
/// all its sub-layers at a time.
///
/// @cost memory O(regions x slabs) + triangle lists of slabs: at most `cache_bytes`, but always room for two; with voids
/// also 12 bytes per vertex of the plane; once the quality is asked for 16 bytes per triangle.
class PrismSource final : public MeshSource {
 public:
  /// @param quality  null: no field `quality`.
  explicit PrismSource(const PrismMesh& mesh, PrismQuality quality = {}, std::size_t cache_bytes = std::size_t{32} << 20);

  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) override { mesh_.fill_nodes(first, out); }
  void visit(std::size_t block, const VisitNodes& visit) override;
  [[nodiscard]] Extent extent_of(std::size_t group) override;
  [[nodiscard]] bool has_field(CellField field) const override { return field != CellField::quality || quality_ != nullptr; }
  void visit_field(std::size_t block, CellField field, const VisitValues& visit) override;
  [[nodiscard]] const PrismMesh* prisms() const override { return &mesh_; }
  [[nodiscard]] bool has_tagged_hull() const override { return true; }

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
  /// Grows from nothing.
  struct Box {
    std::array<double, 2> min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    std::array<double, 2> max{-min[0], -min[1]};
    void add(const std::array<double, 2>& point) {
      for (std::size_t i = 0; i < 2; ++i) {
        min[i] = std::min(min[i], point[i]);
        max[i] = std::max(max[i], point[i]);
      }
    }
  };
  class Rows;
  void survey_volumes();
  void survey_faces();
  void survey_shapes();
  void survey_volume_boxes();
  /// Calls visit(slab, region, volume tag) for everything that is there, from the bottom.
  template <class Visit>
  void visit_columns(Visit&& visit) const;
  /// Index into face_tags or volume_tags of a block.
  [[nodiscard]] std::int32_t tag_index_of(const ElementBlock& block) const;
  void visit_caps(std::int32_t tag_index, Rows& rows);
  void visit_walls(std::int32_t tag_index, Rows& rows) const;
  void visit_wedges(std::int32_t tag_index, Rows& rows);
  /// Calls visit(sub-layer, triangles) for a few triangles through all sub-layers, then the next few: the order of all prisms.
  template <class Visit>
  void visit_pieces(std::int32_t tag_index, Visit&& visit);
  /// Prisms over triangles whose corners, as ranks in the levels below and above, stand in `low` and `high`, three each.
  void visit_sublayer(std::int32_t sublayer, std::span<const std::int32_t> low, std::span<const std::int32_t> high,
                      Rows& rows) const;
  /// Node ids of a level by vertex, minus the level's first id; empty if they are the vertices themselves.
  [[nodiscard]] std::span<const std::int32_t> ranks_of(std::int32_t level);
  [[nodiscard]] std::span<const std::int32_t> triangles_of(std::int32_t slab, std::int32_t tag_index);

  PrismMesh mesh_;
  PrismQuality quality_;
  std::vector<std::vector<std::int32_t>> slabs_of_tag_;
  std::vector<std::int32_t> any_triangle_;  ///< by region, all of whose triangles share its tags; -1 = has none
  std::vector<Box> volume_boxes_;           ///< by volume tag, once an extent is asked for
  std::vector<SlabGroups> cache_;
  std::array<LevelRanks, 3> level_ranks_;  ///< bottom, inside and top of the slab that is being written
  std::vector<PrismBase> shapes_;          ///< by triangle, once the quality is asked for
  std::size_t max_cached_ = 2;
  std::uint64_t clock_ = 0;
};

}  // namespace pcbmesh::mesh
