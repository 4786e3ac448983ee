// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "pcbmesh/mesh/mesh_source.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/mesh/prism_source.hpp"

namespace pcbmesh::extrude {

/// A circle of the layout.
struct Circle {
  std::array<double, 2> centre_m{};
  double radius_m = 0;
};

struct SecondOrderOptions {
  bool with_face_nodes = true;    ///< wedges of 18 nodes and quadrangles of 9, else 15 and 8
  std::vector<Circle> circles{};  ///< arcs of the layout; empty = everything stays straight
  double longest_sagitta_m = 0;   ///< chords that are farther from their arc are no chords of it
  bool for_tetrahedra = false;    ///< the wedges will be split: check the pieces as well
};

/// What became of the arcs.
struct SecondOrderStatistics {
  std::int64_t num_curved_edges = 0;        ///< of the planar mesh
  std::int64_t num_straightened_edges = 0;  ///< on a circle, but an element beside them would have folded
  std::int64_t num_folded_triangles = 0;    ///< triangles of the planar mesh that would have folded
};

class RankedSet;

/// The prisms of an implicit mesh with nodes of second order. Corners keep their ids; behind them come the middles of
/// horizontal edges level by level, then of vertical edges sub-layer by sub-layer, then of quadrangles. All by arithmetic.
///
/// A constrained edge of the plane is curved if both its ends lie on one circle of the layout: within 2 nm plus a tenth of the
/// edge's own sagitta, which is at most twice `longest_sagitta_m`. Its middle then lies on that circle. A curved edge is curved
/// through all layers: every prism that stands on it agrees.
///
/// @guarantee Q1  corners, tags, names and the order of elements are those of PrismSource
/// @guarantee Q2  the Jacobian of every wedge is positive everywhere, by its Bezier coefficients, and at least a tenth of the
/// straight one; edges that would break this stay straight and are counted. `for_tetrahedra`: also of the pieces, at their
/// nodes
/// @guarantee Q3  the domain keeps its volume if its outline has no arcs
/// @cost memory O(planar mesh + distinct slab masks x planar mesh / 8 bytes); no table of prisms.
class SecondOrderSource final : public mesh::MeshSource {
 public:
  SecondOrderSource(const mesh::PrismMesh& mesh, SecondOrderOptions options, mesh::PrismQuality quality = {});
  ~SecondOrderSource() override;

  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) override;
  void visit(std::size_t block, const VisitNodes& visit) override;
  [[nodiscard]] mesh::Extent extent_of(std::size_t group) override;
  [[nodiscard]] bool has_field(mesh::CellField field) const override { return prisms_.has_field(field); }
  [[nodiscard]] bool has_tagged_hull() const override { return true; }
  void visit_field(std::size_t block, mesh::CellField field, const VisitValues& visit) override {
    prisms_.visit_field(block, field, visit);
  }

  [[nodiscard]] const SecondOrderStatistics& statistics() const { return statistics_; }

 private:
  using Edge = std::array<std::int32_t, 2>;
  /// Nodes of one kind that share a level or sub-layer, numbered in a row.
  struct Strip {
    enum class Kind : std::uint8_t { horizontal, vertical, face } kind = Kind::horizontal;
    std::int32_t index = 0;  ///< level or sub-layer
    std::int64_t first = 0;
    const RankedSet* members = nullptr;  ///< of edges, or of vertices for vertical
  };
  struct Corner {
    std::int32_t level = 0, vertex = 0;
  };
  void find_edges();
  void make_sets();
  void curve_edges(const SecondOrderOptions& options);
  void number_nodes(bool with_face_nodes);
  void announce_kinds();
  [[nodiscard]] std::int32_t edge_between(std::int32_t a, std::int32_t b) const;
  [[nodiscard]] Corner corner_of(std::int64_t node);
  [[nodiscard]] std::int64_t on_edge(std::int32_t level, std::int32_t edge) const;
  [[nodiscard]] std::int64_t on_vertical(std::int32_t sublayer, std::int32_t vertex) const;
  [[nodiscard]] std::int64_t on_face(std::int32_t sublayer, std::int32_t edge) const;
  void complete(mesh::ElementKind kind, std::span<const std::int64_t> corners, std::int64_t* row);

  mesh::PrismMesh mesh_;
  mesh::PrismSource prisms_;
  bool with_face_nodes_;
  std::vector<Edge> edges_;               ///< u < v, sorted
  std::vector<std::int32_t> first_edge_;  ///< per vertex u, plus one
  std::vector<std::array<double, 2>> middles_m_;
  std::vector<std::int32_t> pattern_of_slab_;
  std::vector<std::unique_ptr<RankedSet>> sets_;
  std::vector<const RankedSet*> vertices_of_level_, edges_of_level_, vertices_of_sublayer_, edges_of_sublayer_;
  std::vector<std::int64_t> first_on_edge_, first_on_vertical_, first_on_face_;
  std::vector<Strip> strips_;
  std::int32_t last_level_ = 0;
  SecondOrderStatistics statistics_;
};

}  // namespace pcbmesh::extrude
