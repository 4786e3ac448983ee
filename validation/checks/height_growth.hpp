// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "validation/checks/context.hpp"

namespace pcbmesh::validation::checks {

/// Heights of prisms and hexahedra over the faces they share. Fed by the face matching, from many threads at once.
class HeightGrowth {
 public:
  explicit HeightGrowth(const Context& context)
      : context_(context), workers_(context.limits.max_height_growth ? static_cast<std::size_t>(context.num_threads) : 0) {}

  [[nodiscard]] bool is_needed() const { return !workers_.empty() && context_.has_geometry; }
  /// Two cells share a face, seen as these half faces.
  void meet(int worker, std::int64_t half_face_a, std::int64_t half_face_b) {
    const double a = height_over(half_face_a), b = height_over(half_face_b);
    if (!(a > 0 && b > 0)) return;
    Worker& mine = workers_[static_cast<std::size_t>(worker)];
    const double growth = std::max(a, b) / std::min(a, b);
    mine.largest = std::max(mine.largest, growth);
    if (growth > context_.limits.max_height_growth->value * (1 + 1e-9)) mine.beyond.add(half_face_a);
  }
  [[nodiscard]] double largest() const {
    double all = 1;
    for (const Worker& mine : workers_) all = std::max(all, mine.largest);
    return all;
  }
  [[nodiscard]] Tally beyond() const {
    Tally all;
    for (const Worker& mine : workers_) all.merge(mine.beyond);
    return all;
  }

 private:
  /// Volume over area of the face; 0 for tetrahedra, pyramids and the walls of prisms, which have no height of this kind.
  [[nodiscard]] double height_over(std::int64_t half_face) const;
  struct Worker {
    Tally beyond;
    double largest = 1;
  };
  const Context& context_;
  std::vector<Worker> workers_;
};

}  // namespace pcbmesh::validation::checks
