// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcbmesh/mesh/planar_graph.hpp"

namespace pcbmesh::overlay {

using mesh::Increment;

/// Interned sums of increments. A label stands for the change of windings across an edge, and as well for the
/// windings of a face. Equal sums have equal ids; id 0 is the empty sum. Ids depend on the order of calls alone.
class LabelPool {
 public:
  LabelPool();

  /// @param entries ascending by body, deltas not zero.
  [[nodiscard]] std::int32_t intern(std::span<const Increment> entries);
  [[nodiscard]] std::int32_t single(std::int32_t body, std::int32_t delta);
  /// Sum of two labels; memoised. @cost amortised O(1) for repeated pairs.
  [[nodiscard]] std::int32_t add(std::int32_t a, std::int32_t b);
  [[nodiscard]] std::int32_t negate(std::int32_t a);
  [[nodiscard]] std::int32_t subtract(std::int32_t a, std::int32_t b) { return add(a, negate(b)); }
  [[nodiscard]] std::span<const Increment> entries(std::int32_t id) const {
    const auto first = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(id)]);
    const auto last = static_cast<std::size_t>(offsets_[static_cast<std::size_t>(id) + 1]);
    return std::span(entries_).subspan(first, last - first);
  }
  [[nodiscard]] std::int32_t delta(std::int32_t id, std::int32_t body) const;
  [[nodiscard]] std::int32_t size() const { return static_cast<std::int32_t>(offsets_.size()) - 1; }

 private:
  struct Sum {
    std::uint64_t key = 0;
    std::int32_t value = -1;  ///< -1 = free slot
  };
  void grow_slots();
  void grow_sums();

  std::vector<Increment> entries_;
  std::vector<std::int32_t> offsets_;
  std::vector<std::int32_t> slots_;  ///< open addressing over contents: label id or -1
  std::vector<Sum> sums_;            ///< open addressing over pairs of ids
  std::size_t num_sums_ = 0;
  std::vector<std::int32_t> negated_;
  std::vector<Increment> scratch_;
};

}  // namespace pcbmesh::overlay
