// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace pcbmesh::validation::checks {

/// Counts offenders and keeps the smallest ids, so that the outcome does not depend on the order they are met in.
class Tally {
 public:
  static constexpr std::size_t max_kept = 8;

  void add(std::int64_t id) {
    ++count_;
    keep(id);
  }
  void merge(const Tally& other) {
    count_ += other.count_;
    for (const std::int64_t id : other.kept_) keep(id);
  }
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Ascending.
  [[nodiscard]] std::span<const std::int64_t> kept() const { return kept_; }

 private:
  void keep(std::int64_t id) {
    if (kept_.size() == max_kept && id >= kept_.back()) return;
    kept_.insert(std::upper_bound(kept_.begin(), kept_.end(), id), id);
    if (kept_.size() > max_kept) kept_.pop_back();
  }
  std::int64_t count_ = 0;
  std::vector<std::int64_t> kept_;
};

}  // namespace pcbmesh::validation::checks
