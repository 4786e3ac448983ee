// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "pcbmesh/geometry/path.hpp"

namespace pcbmesh::formats::kicad {

/// Boxes of copper on one layer, sorted by their left sides: finds the few that may touch a given box.
class CopperGroup {
 public:
  void add(const geometry::Box& box, std::size_t index) { by_left_.push_back({box, index}); }
  /// Call after the last add() and before any().
  void sort();

  /// Calls visit(index) for every entry whose box touches, until it returns true. @return whether it did.
  template <class Visit>
  bool any(const geometry::Box& box, Visit visit) const {
    for (std::size_t i = first_right_of(box.max.x); i-- > 0 && right_most_[i] >= box.min.x;)
      if (by_left_[i].box.touches(box) && visit(by_left_[i].index)) return true;
    return false;
  }

 private:
  struct Entry {
    geometry::Box box;
    std::size_t index = 0;
  };
  [[nodiscard]] std::size_t first_right_of(Nm x) const;
  std::vector<Entry> by_left_;
  std::vector<Nm> right_most_;  ///< largest right side up to and including i
};

/// What the touch test asks about: outlines a little inside the figures, so that copper that only kisses does not touch
/// (two vias exactly their diameter apart: 16 pairs in 20_vme_wren, which KiCad keeps apart).
struct Probe {
  geometry::Box box;
  std::vector<geometry::Ring> rings;
  explicit Probe(std::span<const geometry::Figure> figures);
};

/// Whether two pieces of copper on one layer share area, to about a micrometre.
class TouchTest {
 public:
  [[nodiscard]] static bool touches(const Probe& probe, std::span<const geometry::Figure> figures);
  /// The same for a large fill, asked many times: `key` names it; corners of the probe decide.
  [[nodiscard]] bool touches_fill(const Probe& probe, std::size_t key, const geometry::Figure& fill);

  TouchTest();
  ~TouchTest();

 private:
  class FillIndex;
  std::map<std::size_t, std::unique_ptr<FillIndex>> fills_;
};

}  // namespace pcbmesh::formats::kicad
