// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace pcbmesh::extrude {

/// Subset of 0..n-1 that numbers its members: bit words and one running count per word. No words = the full set.
class RankedSet {
 public:
  /// One byte per item, not 0 = member.
  explicit RankedSet(std::span<const char> members) {
    for (const char is_in : members) size_ += is_in != 0 ? 1 : 0;
    if (static_cast<std::size_t>(size_) == members.size()) return;
    words_.assign((members.size() + 63) / 64, 0);
    for (std::size_t i = 0; i < members.size(); ++i)
      if (members[i] != 0) words_[i / 64] |= std::uint64_t{1} << (i % 64);
    std::int32_t before = 0;
    for (const std::uint64_t word : words_) {
      ranks_.push_back(before);
      before += std::popcount(word);
    }
  }
  [[nodiscard]] std::int32_t size() const { return size_; }
  /// Members before i.
  [[nodiscard]] std::int32_t rank(std::int32_t i) const {
    if (words_.empty()) return i;
    const auto at = static_cast<std::size_t>(i);
    return ranks_[at / 64] + std::popcount(words_[at / 64] & ((std::uint64_t{1} << (at % 64)) - 1));
  }
  /// The member of a rank. REQUIRES 0 <= rank < size().
  [[nodiscard]] std::int32_t member(std::int32_t rank) const;
  /// Calls visit(member) for ranks first .. first + count - 1.
  template <class Visit>
  void visit(std::int32_t first, std::int32_t count, Visit&& visit) const {
    if (count <= 0) return;
    for (std::int32_t i = member(first);; ++i) {
      if (!words_.empty() && ((words_[static_cast<std::size_t>(i) / 64] >> (i % 64)) & 1U) == 0) continue;
      visit(i);
      if (--count == 0) return;
    }
  }

 private:
  std::vector<std::uint64_t> words_;
  std::vector<std::int32_t> ranks_;
  std::int32_t size_ = 0;
};

}  // namespace pcbmesh::extrude
