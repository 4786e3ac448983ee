// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "validation/checks/context.hpp"

namespace pcbmesh::validation::checks {

/// Which conductor cells hang together through whole shared faces, and which nets meet. Fed by the face matching, from
/// many threads at once; the outcome does not depend on their order.
class NetContacts {
 public:
  explicit NetContacts(const Context& context);

  /// Some group of the mesh is copper of a net: without any there is nothing to do.
  [[nodiscard]] bool is_needed() const { return !nets_.empty(); }
  /// Two cells share a face.
  void meet(int worker, std::int64_t cell_a, std::int64_t cell_b, std::int64_t half_face) {
    const std::int32_t a = net_of_cell(cell_a), b = net_of_cell(cell_b);
    if (a < 0 || b < 0) return;
    if (a == b) {
      join(cell_a, cell_b);
    } else {
      touches_[static_cast<std::size_t>(worker)][a < b ? std::pair(a, b) : std::pair(b, a)].add(half_face);
    }
  }
  [[nodiscard]] const std::vector<std::string>& nets() const { return nets_; }
  /// Index into nets() of a copper cell, -1 for others.
  [[nodiscard]] std::int32_t net_of(std::int64_t cell) const { return net_of_cell(cell); }
  /// First cell of the piece that a copper cell belongs to.
  [[nodiscard]] std::int64_t piece_of(std::int64_t cell) { return root(cell); }
  /// First cell of each connected piece, per net, ascending.
  [[nodiscard]] std::vector<std::vector<std::int64_t>> pieces() const;
  /// Shared faces per pair of nets (indices into nets()).
  [[nodiscard]] std::map<std::pair<std::int32_t, std::int32_t>, Tally> touches() const;

 private:
  [[nodiscard]] std::int32_t net_of_cell(std::int64_t cell) const {
    const int slot = context_.cell_tags.slot(context_.tag_of_cell(cell));
    return slot < 0 ? -1 : net_of_slot_[static_cast<std::size_t>(slot)];
  }
  [[nodiscard]] std::int64_t root(std::int64_t cell);
  void join(std::int64_t a, std::int64_t b);

  const Context& context_;
  std::vector<std::string> nets_;          ///< nets with copper cells, sorted by name
  std::vector<std::int32_t> net_of_slot_;  ///< per tag slot, -1 = no copper of a net
  std::vector<std::int64_t> parent_;       ///< per cell; a root is the smallest cell of its piece
  std::vector<std::map<std::pair<std::int32_t, std::int32_t>, Tally>> touches_;  ///< per worker
};

}  // namespace pcbmesh::validation::checks
