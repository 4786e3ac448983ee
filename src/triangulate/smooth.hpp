// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pcbmesh/base/progress.hpp"
#include "src/triangulate/cdt.hpp"
#include "src/triangulate/mesh_bounds.hpp"

namespace pcbmesh::triangulate {

struct SmoothSetup {
  int num_sweeps = 10;       ///< at most; ends sooner where nothing moves
  double guarded_sine2 = 0;  ///< no triangle gets a smaller angle than this, or than the worst at its vertex was
};

/// Optimal Delaunay smoothing (Chen 2004): each free vertex goes to the mean of the circumcentres round it, weighted by area,
/// and flips make the triangulation constrained Delaunay again. Vertices on graph edges stay, and so do all constraints and
/// region memberships. A move that would pass the guard or the bound on edges is halved, then dropped.
/// @cost O(vertices) per sweep; vertices with nothing new round them are not looked at again.
/// @source Chen, Mesh smoothing schemes based on optimal Delaunay triangulations, 2004.
void smooth(Cdt& cdt, const MeshBounds& bounds, const SmoothSetup& setup, const Progress& progress);

}  // namespace pcbmesh::triangulate
