// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "pcbmesh/base/progress.hpp"
#include "src/overlay/cell_grid.hpp"
#include "src/overlay/edge_graph.hpp"
#include "src/overlay/labels.hpp"

namespace pcbmesh::overlay {

struct NodingCounts {
  std::int64_t num_snapped = 0;    ///< vertices merged or moved
  std::int64_t num_crossings = 0;  ///< crossings made vertices
  int num_passes = 0;
};

/// Makes an edge graph planar: vertices closer than the tolerance become one, vertices near an edge split it, crossings
/// become vertices, until nothing changes. Tolerance 0: exact arrangement on the nanometre grid.
///
/// Only places that changed are looked at again: a test of two unchanged items cannot come out differently.
/// With a tolerance, edges of body 0 (domain), body 1 (board), shells and ports are stiff: vertices near them move onto them.
class Noder {
 public:
  /// @param graph  distinct points, normalised edges.
  /// @param first_guide  bodies from here on are of shells and ports.
  Noder(EdgeGraph graph, LabelPool& labels, Nm tolerance, const Progress& progress,
        std::int32_t first_guide = std::numeric_limits<std::int32_t>::max());

  /// @throws Error overlay_no_fixpoint (402), cancelled (103).
  void settle();

  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
  [[nodiscard]] const NodingCounts& counts() const { return counts_; }
  [[nodiscard]] LabelPool& labels() { return labels_; }
  [[nodiscard]] Nm tolerance() const { return tolerance_; }
  /// 0 = not stiff, 1 = board, 2 = shell or port, 3 = domain.
  [[nodiscard]] int stiffness(const Edge& e) const;

  /// Adds a point; settle() looks at it.
  std::int32_t add_point(Point p);
  /// Takes edges out (flags per edge) and puts others in; settle() looks at those.
  void replace(const std::vector<std::uint8_t>& removed, std::vector<Edge>& added);
  /// Edges and vertices whose surroundings changed since the last call: for blunting.
  [[nodiscard]] EdgeGraph take();

 private:
  struct Split {
    std::int32_t edge, vertex;
    double share;           ///< place along the edge, 0..1
    double line_distance2;  ///< squared distance to the edge
  };
  struct Pair {
    std::int32_t first, second;
    friend auto operator<=>(const Pair&, const Pair&) = default;
  };
  struct Move {
    std::int32_t vertex;
    int stiffness;
    double line_distance2;
    Point to;
  };

  bool pass();
  bool cluster();
  bool split();
  void rank_vertices();
  [[nodiscard]] bool splits(std::int32_t vertex, const Edge& e, Foot& foot) const;
  void collect_near(std::vector<Split>& found, std::vector<Pair>& crossing);
  void resolve_crossings(std::vector<Pair>& crossing, std::vector<Split>& found);
  void collect_moves(const std::vector<Split>& found);
  bool apply_splits(std::vector<Split>& found);
  [[nodiscard]] std::vector<std::int32_t> clustered(std::vector<std::int32_t>& members, const CellGrid& grid);

  std::vector<Point> points_;
  std::vector<Edge> edges_;          ///< normalised
  std::vector<std::uint8_t> fresh_;  ///< per edge: geometry new since it was last tested
  std::vector<std::uint8_t> moved_;  ///< per point: new or moved since it was last tested
  std::vector<std::uint8_t> used_;   ///< per point: has edges
  std::vector<std::uint8_t>
      rank_;  ///< per point: 0 free, else 2 x stiffness of its stiffest edges, less 1 if they run straight through
  std::vector<Move> moves_;
  LabelPool& labels_;
  std::int32_t first_guide_;
  Nm tolerance_ = 0;
  double tolerance2_ = 0;
  const Progress& progress_;
  NodingCounts counts_;
  geometry::Box box_;
};

}  // namespace pcbmesh::overlay
