// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/footprint.hpp"

namespace pcbmesh::compose {

/// Copper that joins neighbouring vias: a wall between two, or the prism between three.
struct MergedBlock {
  geometry::Figure figure;
  std::int32_t first_copper = 0, last_copper = 0;
  std::int32_t net = board::no_net;
  std::int64_t line = 0;  ///< of the first of its vias
};

struct MergedVias {
  std::vector<MergedBlock> blocks;
  std::vector<std::size_t> members;  ///< drills that became part of some block, ascending
  std::int64_t num_vias = 0;         ///< that became part of some block
  std::int64_t num_blocks = 0;       ///< connected groups of them
  std::int64_t num_alone = 0;        ///< vias of the domain that have no neighbour, or may not be joined to it
  std::int64_t num_refused = 0;      ///< joints left out because other copper or a hole is in the way
};

/// Round vias of one net, span and diameter whose centres are at most `pitch` apart are joined two by two, and where three
/// are, the triangle between them is filled. A joint that would touch copper of another net, or any hole of another net, on
/// a layer of the span is left out.
[[nodiscard]] MergedVias merge_vias(const board::Board& board, const study::Study& study, const Footprint& footprint, Nm pitch);

}  // namespace pcbmesh::compose
