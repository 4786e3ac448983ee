// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::mesh {

/// Vertices, edges, faces and cells of a prism mesh, and how many of them lie inside. Exact for meshes, real numbers rounded
/// for forecasts.
struct EntityCounts {
  std::int64_t nodes = 0;
  std::int64_t prisms = 0;
  std::int64_t edges = 0;           ///< horizontal and vertical
  std::int64_t boundary_edges = 0;  ///< of some face on the boundary
  std::int64_t triangles = 0, inner_triangles = 0;
  std::int64_t quads = 0, inner_quads = 0;
  /// Sum over the edges of 1 - (cells round it - inner faces round it): 1 for an edge inside, 0 for an ordinary one on the
  /// boundary, negative where the domain touches itself along it.
  std::int64_t closed_edges = 0;
  bool operator==(const EntityCounts&) const = default;
};

/// @cost O(planar edges x slabs).
[[nodiscard]] EntityCounts count_entities(const PrismMesh& mesh);

enum class Cells { prisms, tetrahedra };  ///< tetrahedra: every prism cut into three

/// Unknowns of Nedelec's first family of edge elements on a whole mesh, before boundary conditions take any away.
struct Unknowns {
  std::int64_t total = 0;
  std::int64_t on_boundary = 0;  ///< tangential field on the boundary
  double nonzeros = 0;           ///< of the matrix: pairs of unknowns with a cell in common, the diagonal included
};

/// Per edge k, per triangle k(k-1), per quadrangle 2k(k-1), per tetrahedron k(k-1)(k-2)/2, per prism k(k-1)(3k-4)/2.
///
/// Nonzeros: every pair of unknowns of a cell, counted once however many cells have both, by inclusion and exclusion over
/// cells, inner faces and edges.
///
/// @param order  1, 2, 3 ...
/// @source J.-C. Nedelec, Numer. Math. 35, 1980 (tetrahedra, cubes); prisms: the product of a triangle's and a segment's
/// spaces, 3 k (k+1) (k+2) / 2 in all, A. Bossavit, COMPEL 2008; the same numbers as MFEM's ND_WedgeElement.
[[nodiscard]] Unknowns count_unknowns(const EntityCounts& counts, int order, Cells cells);

}  // namespace pcbmesh::mesh
