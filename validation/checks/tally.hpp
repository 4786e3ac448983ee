// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::validation::checks {

/// Counts offenders and keeps the smallest ids, so that the outcome does not depend on the order they are met in.
class Tally {
 public:
  static constexpr std::size_t max_kept = Finding::max_offenders;

  void add(std::int64_t id) {
    ++count_;
    keep(id);
  }
  void merge(const Tally& other) {
    count_ += other.count_;
    for (const std::int64_t id : other.kept_) keep(id);
  }
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// The smallest ids, ascending.
  [[nodiscard]] std::vector<std::int64_t> kept(std::size_t most = max_kept) const {
    std::vector<std::int64_t> ids = kept_;
    std::sort(ids.begin(), ids.end());
    if (ids.size() > most) ids.resize(most);
    return ids;
  }

 private:
  /// Unordered until full, a heap with the largest id on top from then on: an id that comes too late costs one comparison.
  void keep(std::int64_t id) {
    if (kept_.size() < max_kept) {
      kept_.push_back(id);
      if (kept_.size() == max_kept) std::make_heap(kept_.begin(), kept_.end());
      return;
    }
    if (id >= kept_.front()) return;
    std::pop_heap(kept_.begin(), kept_.end());
    kept_.back() = id;
    std::push_heap(kept_.begin(), kept_.end());
  }
  std::int64_t count_ = 0;
  std::vector<std::int64_t> kept_;
};

}  // namespace pcbmesh::validation::checks
