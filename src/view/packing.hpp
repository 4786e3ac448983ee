// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/view/cell_mesh.hpp"

namespace pcbmesh::view {

/// One array of the packed mesh: `count` numbers of `bytes` bytes, byte planes from the lowest to the highest.
/// Arrays named "...+" hold zigzag differences: n -> (n << 1) ^ (n >> 31), each from the entry before.
struct PackedArray {
  std::string name;
  std::size_t count = 0;
  int bytes = 1;
};

/// Arrays as bytes that compress well.
struct PackedArrays {
  std::string bytes;
  std::vector<PackedArray> arrays;  ///< in the order of `bytes`
  void put(std::string name, std::span<const std::uint32_t> values);
  void put_differences(std::string name, std::span<const std::int32_t> values);
};
[[nodiscard]] std::uint32_t zigzag(std::int32_t n);
inline constexpr double grid_steps = 16'777'215;  ///< 2^24 - 1: three bytes, and exact in a float

/// The implicit mesh.
struct PackedMesh : PackedArrays {
  double x0_m = 0, y0_m = 0, step_m = 1;           ///< x = x0 + step * integer
  std::vector<std::vector<std::int32_t>> columns;  ///< distinct columns: group per slab, -1 = void
};
[[nodiscard]] PackedMesh pack(const mesh::PrismMesh& mesh);

/// The faces of a cell mesh that may be seen, with the cells on either side and their qualities.
struct PackedCells : PackedArrays {
  std::array<double, 3> origin_m{};    ///< coordinate = origin + step * integer
  std::array<double, 2> step_m{1, 1};  ///< in the plane, and across it
  /// Distinct kinds of faces: group, group on the other side or -1, face tag or -1, and for either side the conductor that
  /// shines through, or -1.
  std::vector<std::array<std::int32_t, 5>> sides;
  /// Quality of a cell at a face: n = 0 no measure; n < 65536: (n - 1) * step; else that of the prism of height
  /// heights_m[n - 65536] over the face.
  double quality_step = 1;
  double height_step_m = 1e-13;  ///< heights closer than that are one
  std::vector<double> heights_m;
};
/// Face numbers, cells and node numbers below 2^31: what a page can hold is far less. @throws Error usage (101) beyond.
[[nodiscard]] PackedCells pack(const CellMesh& mesh);

}  // namespace pcbmesh::view
