// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/extrude/ranked_set.hpp"

#include <algorithm>

namespace pcbmesh::extrude {

std::int32_t RankedSet::member(std::int32_t rank) const {
  if (words_.empty()) return rank;
  const auto word = static_cast<std::size_t>(std::upper_bound(ranks_.begin(), ranks_.end(), rank) - ranks_.begin()) - 1;
  std::uint64_t bits = words_[word];
  for (std::int32_t skip = rank - ranks_[word]; skip > 0; --skip) bits &= bits - 1;
  return static_cast<std::int32_t>(word * 64) + std::countr_zero(bits);
}

}  // namespace pcbmesh::extrude
