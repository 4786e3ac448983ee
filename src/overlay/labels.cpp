// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/labels.hpp"

#include <algorithm>

namespace pcbmesh::overlay {
namespace {

std::uint64_t mix(std::uint64_t value) {
  value ^= value >> 33;
  value *= 0xff51afd7ed558ccdULL;
  value ^= value >> 33;
  value *= 0xc4ceb9fe1a85ec53ULL;
  return value ^ (value >> 33);
}

std::uint64_t hash_of(std::span<const Increment> entries) {
  std::uint64_t hash = entries.size();
  for (const Increment& e : entries) {
    const auto word =
        (static_cast<std::uint64_t>(static_cast<std::uint32_t>(e.body)) << 32) | static_cast<std::uint32_t>(e.delta);
    hash = mix(hash ^ word) + 0x9e3779b97f4a7c15ULL;
  }
  return hash;
}

}  // namespace

LabelPool::LabelPool() : offsets_{0, 0}, slots_(1024, -1), sums_(4096), negated_{0} {
  slots_[hash_of({}) & (slots_.size() - 1)] = 0;
}

std::int32_t LabelPool::intern(std::span<const Increment> entries) {
  std::size_t slot = hash_of(entries) & (slots_.size() - 1);
  for (; slots_[slot] >= 0; slot = (slot + 1) & (slots_.size() - 1)) {
    if (std::ranges::equal(this->entries(slots_[slot]), entries)) return slots_[slot];
  }
  const std::int32_t id = size();
  entries_.insert(entries_.end(), entries.begin(), entries.end());
  offsets_.push_back(static_cast<std::int32_t>(entries_.size()));
  negated_.push_back(-1);
  slots_[slot] = id;
  if (static_cast<std::size_t>(size()) * 2 > slots_.size()) grow_slots();
  return id;
}

void LabelPool::grow_slots() {
  std::vector<std::int32_t> larger(slots_.size() * 2, -1);
  for (std::int32_t id = 0; id < size(); ++id) {
    std::size_t slot = hash_of(entries(id)) & (larger.size() - 1);
    while (larger[slot] >= 0) slot = (slot + 1) & (larger.size() - 1);
    larger[slot] = id;
  }
  slots_ = std::move(larger);
}

void LabelPool::grow_sums() {
  std::vector<Sum> larger(sums_.size() * 2);
  for (const Sum& sum : sums_) {
    if (sum.value < 0) continue;
    std::size_t slot = mix(sum.key) & (larger.size() - 1);
    while (larger[slot].value >= 0) slot = (slot + 1) & (larger.size() - 1);
    larger[slot] = sum;
  }
  sums_ = std::move(larger);
}

std::int32_t LabelPool::single(std::int32_t body, std::int32_t delta) {
  const Increment one{body, delta};
  return intern(std::span(&one, 1));
}

std::int32_t LabelPool::add(std::int32_t a, std::int32_t b) {
  if (a == 0) return b;
  if (b == 0) return a;
  if (a > b) std::swap(a, b);
  const std::uint64_t key = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32) | static_cast<std::uint32_t>(b);
  std::size_t slot = mix(key) & (sums_.size() - 1);
  for (; sums_[slot].value >= 0; slot = (slot + 1) & (sums_.size() - 1)) {
    if (sums_[slot].key == key) return sums_[slot].value;
  }
  scratch_.clear();
  const auto first = entries(a), second = entries(b);
  std::size_t i = 0, j = 0;
  while (i < first.size() || j < second.size()) {
    if (j == second.size() || (i < first.size() && first[i].body < second[j].body)) {
      scratch_.push_back(first[i++]);
    } else if (i == first.size() || second[j].body < first[i].body) {
      scratch_.push_back(second[j++]);
    } else {
      const std::int32_t sum = first[i].delta + second[j].delta;
      if (sum != 0) scratch_.push_back({first[i].body, sum});
      ++i, ++j;
    }
  }
  const std::int32_t value = intern(scratch_);
  sums_[slot] = {key, value};
  if (++num_sums_ * 2 > sums_.size()) grow_sums();
  return value;
}

std::int32_t LabelPool::negate(std::int32_t a) {
  const auto index = static_cast<std::size_t>(a);
  if (negated_[index] >= 0) return negated_[index];
  scratch_.assign(entries(a).begin(), entries(a).end());
  for (Increment& e : scratch_) e.delta = -e.delta;
  const std::int32_t value = intern(scratch_);
  negated_[index] = value;
  negated_[static_cast<std::size_t>(value)] = a;
  return value;
}

std::int32_t LabelPool::delta(std::int32_t id, std::int32_t body) const {
  for (const Increment& e : entries(id)) {
    if (e.body == body) return e.delta;
    if (e.body > body) break;
  }
  return 0;
}

}  // namespace pcbmesh::overlay
