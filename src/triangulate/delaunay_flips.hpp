// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <boost/container/small_vector.hpp>
#include <utility>

#include "src/triangulate/cdt.hpp"

namespace pcbmesh::triangulate {

/// Lawson's flips from the edges at and round v until all is constrained Delaunay again. Needs every triangle at v to be
/// counter-clockwise. Faces keep their marks: a flip never crosses a constrained edge.
/// @return the number of flips
inline int make_delaunay_round(Cdt& cdt, Cdt::Vertex_handle v) {
  boost::container::small_vector<std::pair<Cdt::Face_handle, int>, 64> suspects;
  auto face = cdt.incident_faces(v);
  const auto first = face;
  do {
    const int i = face->index(v);
    suspects.emplace_back(face, i);
    suspects.emplace_back(face, Cdt::ccw(i));
  } while (++face != first);
  int num_flips = 0;
  while (!suspects.empty()) {
    auto [near, i] = suspects.back();
    suspects.pop_back();
    if (!cdt.is_flipable(near, i)) continue;
    // Both faces survive the flip with other corners; whatever was noted of them is noted anew.
    const Cdt::Face_handle far = near->neighbor(i);
    cdt.flip(near, i);
    ++num_flips;
    for (const Cdt::Face_handle& changed : {near, far}) {
      for (int k = 0; k < 3; ++k) {
        if (changed->neighbor(k) != near && changed->neighbor(k) != far) suspects.emplace_back(changed, k);
      }
    }
  }
  return num_flips;
}

}  // namespace pcbmesh::triangulate
