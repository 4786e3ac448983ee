// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <set>

#include "validation/checks/checks.hpp"

namespace pcbmesh::validation::checks {

NetContacts::NetContacts(const Context& context) : context_(context) {
  net_of_slot_.assign(static_cast<std::size_t>(context.cell_tags.size()), -1);
  if (context.expectation == nullptr) return;
  const auto is_copper = [&](const Expectation::Volume& volume) {
    return volume.conductor && !volume.net.empty() && context.cell_tags.slot(volume.tag) >= 0;
  };
  std::set<std::string> names;
  for (const auto& volume : context.expectation->volumes) {
    if (is_copper(volume)) names.insert(volume.net);
  }
  nets_.assign(names.begin(), names.end());
  for (const auto& volume : context.expectation->volumes) {
    if (!is_copper(volume)) continue;
    const auto net = std::lower_bound(nets_.begin(), nets_.end(), volume.net) - nets_.begin();
    net_of_slot_[static_cast<std::size_t>(context.cell_tags.slot(volume.tag))] = static_cast<std::int32_t>(net);
  }
  if (!is_needed()) return;
  touches_.resize(static_cast<std::size_t>(context.num_threads));
  parent_.resize(static_cast<std::size_t>(context.num_cells()));
  for (std::size_t i = 0; i < parent_.size(); ++i) parent_[i] = static_cast<std::int64_t>(i);
}

std::int64_t NetContacts::root(std::int64_t cell) {
  while (true) {
    std::atomic_ref slot(parent_[static_cast<std::size_t>(cell)]);
    std::int64_t parent = slot.load(std::memory_order_relaxed);
    if (parent == cell) return cell;
    const std::int64_t above = std::atomic_ref(parent_[static_cast<std::size_t>(parent)]).load(std::memory_order_relaxed);
    // Parents only ever sink, so halving the path is safe even if another thread just did the same.
    if (above != parent) slot.compare_exchange_weak(parent, above, std::memory_order_relaxed);
    cell = above;
  }
}

void NetContacts::join(std::int64_t a, std::int64_t b) {
  while (true) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (a > b) std::swap(a, b);
    std::int64_t expected = b;
    // Fails only if another thread has just hung b below a third piece: then look again.
    if (std::atomic_ref(parent_[static_cast<std::size_t>(b)]).compare_exchange_strong(expected, a)) return;
  }
}

std::vector<std::vector<std::int64_t>> NetContacts::pieces() const {
  std::vector<std::vector<std::int64_t>> result(nets_.size());
  for (std::size_t b = 0; b < context_.mesh.cells.size(); ++b) {
    const mesh::CellBlock& block = context_.mesh.cells[b];
    for (std::int64_t i = 0; i < block.size(); ++i) {
      const std::int64_t cell = context_.first_cell[b] + i;
      if (parent_[static_cast<std::size_t>(cell)] != cell) continue;
      const int slot = context_.cell_tags.slot(block.tags[static_cast<std::size_t>(i)]);
      const std::int32_t net = net_of_slot_[static_cast<std::size_t>(slot)];
      if (net >= 0) result[static_cast<std::size_t>(net)].push_back(cell);
    }
  }
  return result;
}

std::map<std::pair<std::int32_t, std::int32_t>, Tally> NetContacts::touches() const {
  std::map<std::pair<std::int32_t, std::int32_t>, Tally> all;
  for (const auto& mine : touches_) {
    for (const auto& [pair, tally] : mine) all[pair].merge(tally);
  }
  return all;
}

}  // namespace pcbmesh::validation::checks
