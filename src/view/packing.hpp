// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::view {

/// One array of the packed mesh: `count` numbers of `bytes` bytes, byte planes from the lowest to the highest.
/// Arrays named "...+" hold zigzag differences: n -> (n << 1) ^ (n >> 31), each from the entry before.
struct PackedArray {
  std::string name;
  std::size_t count = 0;
  int bytes = 1;
};

/// The implicit mesh as bytes that compress well.
struct PackedMesh {
  std::string bytes;
  std::vector<PackedArray> arrays;                 ///< in the order of `bytes`
  double x0_m = 0, y0_m = 0, step_m = 1;           ///< x = x0 + step * integer
  std::vector<std::vector<std::int32_t>> columns;  ///< distinct columns: group per slab, -1 = void
};
[[nodiscard]] PackedMesh pack(const mesh::PrismMesh& mesh);

}  // namespace pcbmesh::view
