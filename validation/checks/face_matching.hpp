// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "validation/checks/context.hpp"
#include "validation/checks/tally.hpp"

namespace pcbmesh::validation::checks {

class NetContacts;
class HeightGrowth;

/// Every face of every cell, brought together with its equals. Half faces are cell << 3 | local face.
struct FaceMatch {
  std::vector<std::int64_t> boundary;  ///< half faces of exactly one cell, by smallest node
  std::int64_t num_inner = 0;          ///< faces shared properly by two cells

  // Half faces:
  Tally many_owners;       ///< one per face of three or more cells
  Tally same_orientation;  ///< one per face that two cells see from the same side
  Tally untagged;          ///< boundary without a tagged face
  // Tagged faces:
  Tally tagged_twice;    ///< second and further tagged faces on the same corners
  Tally tagged_no_cell;  ///< on no face of any cell
  Tally tagged_inward;   ///< on the boundary, but turned inwards
  Tally outer_inside;    ///< of a group of kind outer, between two cells
  // Cells:
  Tally duplicate_cells;  ///< with the same corners as an earlier one

  std::vector<std::int64_t> outer_of_tag, inner_of_tag;  ///< tagged faces by slot of Context::face_tags

  void merge(const FaceMatch& other);
};

struct MatchOptions {
  std::int64_t bytes_per_cell = 36;            ///< for the entries being matched; less memory means more passes over the cells
  std::int64_t min_entries_at_once = 1 << 20;  ///< however few bytes_per_cell allows
  bool wide_ids = false;                       ///< 64-bit entries even where 32 bits would do
};

/// @param nets, growth  told of every pair of cells that share a face; may be null.
/// REQUIRES every corner to be a node. @cost about 45 bytes per cell, 0.15 us per cell.
[[nodiscard]] FaceMatch match_faces(const Context& context, NetContacts* nets, HeightGrowth* growth = nullptr,
                                    const MatchOptions& options = {});

}  // namespace pcbmesh::validation::checks
