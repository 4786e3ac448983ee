// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"
#include "src/overlay/census.hpp"
#include "src/overlay/edge_graph.hpp"

namespace pcbmesh::overlay {

/// Bodies that fill the same slabs, and the exact outlines of their unions within domain and board.
struct Sheet {
  std::vector<std::int32_t> bodies;  ///< ascending
  EdgeGraph outlines;                ///< labels: {body, +-1}
  std::vector<std::uint8_t>
      marks;  ///< per point, see collapse.hpp; fixed on the outline of the domain, or of the board for other bodies
};

struct Sheets {
  std::vector<Sheet> sheets;
  Census exact;
  std::vector<double> area_mm2;  ///< per body
  std::int64_t num_input_vertices = 0;
  std::int64_t num_specks = 0;  ///< parts thinner than a micrometre, left out
};

/// Exact arrangement (1 nm) of each group of bodies with equal slabs; edges stay where some body begins or ends.
/// Each shape that is not simple is inside where its own winding is not zero; a body is the union of its shapes.
/// Everything but the domain is cut at domain and board.
[[nodiscard]] Sheets make_sheets(const model::Model& model, LabelPool& labels, const Conductors& conductors,
                                 Diagnostics& diagnostics, const Progress& progress);

/// All sheets' graphs in one, points distinct.
[[nodiscard]] EdgeGraph overlaid(const std::vector<const EdgeGraph*>& graphs, LabelPool& labels);

}  // namespace pcbmesh::overlay
