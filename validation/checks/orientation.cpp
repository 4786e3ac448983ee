// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/checks/orientation.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace pcbmesh::validation::checks {

int orientation_exact(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  const auto point = [](const Vector3& at) { return Point(at[0], at[1], at[2]); };
  return static_cast<int>(CGAL::orientation(point(a), point(b), point(c), point(d)));
}

}  // namespace pcbmesh::validation::checks
