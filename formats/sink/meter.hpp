// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>

#include "pcbmesh/base/progress.hpp"

namespace pcbmesh::formats {

/// Reports progress over the items of a file without a call per block.
class Meter {
 public:
  Meter(const Progress& progress, std::int64_t total) : progress_(progress), total_(std::max<std::int64_t>(total, 1)) {}
  /// @throws Error cancelled (103).
  void add(std::int64_t count) {
    done_ += count;
    if ((++calls_ & 63U) == 0) progress_.at("write", std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_)));
  }

 private:
  const Progress& progress_;
  std::int64_t total_, done_ = 0;
  std::uint32_t calls_ = 0;
};

}  // namespace pcbmesh::formats
