// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/mesh_builder/mesh_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace pcbmesh::formats {
MeshBuilder::MeshBuilder(syntax::ByteSource& source) : source_(source) {
  mesh_.num_other_elements.assign(2, 0);
}

std::int64_t IdRuns::find_repeated() {
  std::sort(runs_.begin(), runs_.end());
  for (std::size_t i = 1; i < runs_.size(); ++i)
    if (runs_[i].first <= runs_[i - 1].second) return runs_[i].first;
  return -1;
}

void NodeNumbers::add(std::int64_t number) {
  if (size_ == 0) first_ = number;
  if (is_dense_ && number != first_ + size_) {
    is_dense_ = false;
    numbers_.reserve(static_cast<std::size_t>(size_) + 1);
    for (std::int64_t i = 0; i < size_; ++i) numbers_.push_back(first_ + i);
  }
  if (!is_dense_) numbers_.push_back(number);
  ++size_;
}

void NodeNumbers::finish(const syntax::ByteSource& source) {
  if (is_dense_) {
    if (size_ > 0 && first_ < 1) source.fail(fmt::format("node number {} is not positive", first_));
    return;
  }
  const auto [least, greatest] = std::minmax_element(numbers_.begin(), numbers_.end());
  if (*least < 1) source.fail(fmt::format("node number {} is not positive", *least));
  const auto twice = [&](std::int64_t number) { source.fail(fmt::format("node number {} is given twice", number)); };
  if (*greatest <= 4 * size_ + 1024) {
    table_.assign(static_cast<std::size_t>(*greatest) + 1, -1);
    for (std::size_t i = 0; i < numbers_.size(); ++i) {
      std::int64_t& entry = table_[static_cast<std::size_t>(numbers_[i])];
      if (entry >= 0) twice(numbers_[i]);
      entry = static_cast<std::int64_t>(i);
    }
  } else {
    sorted_.reserve(numbers_.size());
    for (std::size_t i = 0; i < numbers_.size(); ++i) sorted_.emplace_back(numbers_[i], static_cast<std::int64_t>(i));
    std::sort(sorted_.begin(), sorted_.end());
    for (std::size_t i = 1; i < sorted_.size(); ++i)
      if (sorted_[i].first == sorted_[i - 1].first) twice(sorted_[i].first);
  }
  numbers_ = {};
}

std::int64_t NodeNumbers::find_sparse(std::int64_t number) const {
  if (!table_.empty())
    return number >= 0 && number < static_cast<std::int64_t>(table_.size()) ? table_[static_cast<std::size_t>(number)] : -1;
  const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair<std::int64_t, std::int64_t>{number, 0});
  return found != sorted_.end() && found->first == number ? found->second : -1;
}

void MeshBuilder::add_name(int dimension, std::int32_t tag, std::string name) {
  if (dimension < 0 || dimension > 3) source_.fail(fmt::format("a physical name has dimension {}", dimension));
  mesh_.names.push_back({dimension, tag, std::move(name)});
}

void MeshBuilder::finish_nodes() {
  if (has_nodes_) source_.fail("the file has two sections of nodes");
  has_nodes_ = true;
  numbers_.finish(source_);
}

void MeshBuilder::add_element(mesh::ElementKind kind, std::int64_t number, std::int32_t tag,
                              std::span<const std::int64_t> nodes) {
  elements_.add(number);
  std::array<std::int64_t, 18> indices{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    indices[i] = numbers_.find(nodes[i]);
    if (indices[i] < 0) source_.fail(fmt::format("element {} names node {}, which does not exist", number, nodes[i]));
  }
  if (tag < 0) source_.fail(fmt::format("element {} has physical group {}; groups are numbered from 1 here", number, tag));
  if (tag == 0 && mesh::dimension_of(kind) == 2) {
    ++mesh_.num_untagged[2];
    return;
  }
  blocks_.add(kind, tag, std::span(indices).first(nodes.size()));
}

void MeshBuilder::finish_elements() {
  if (const std::int64_t repeated = elements_.find_repeated(); repeated >= 0)
    source_.fail(fmt::format("element number {} is given twice", repeated));
}

mesh::MeshData MeshBuilder::take(std::string source_name) {
  mesh_.source = std::move(source_name);
  blocks_.move_to(mesh_);
  return std::move(mesh_);
}

}  // namespace pcbmesh::formats
