// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/msh/mesh_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace pcbmesh::formats::msh {
namespace {

using mesh::CellKind;
using mesh::FaceKind;

/// Element types of first order, by the format's number.
enum Type : std::int32_t {
  line = 1,
  triangle = 2,
  quadrangle = 3,
  tetrahedron = 4,
  hexahedron = 5,
  prism = 6,
  pyramid = 7,
  point = 15
};

}  // namespace

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

void NodeNumbers::finish(const ByteSource& source) {
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

ElementType MeshBuilder::type_of(std::int32_t type) const {
  switch (type) {
    case Type::point:
      return {0, 1};
    case Type::line:
      return {1, 2};
    case Type::triangle:
      return {2, 3};
    case Type::quadrangle:
      return {2, 4};
    case Type::tetrahedron:
      return {3, 4};
    case Type::hexahedron:
      return {3, 8};
    case Type::prism:
      return {3, 6};
    case Type::pyramid:
      return {3, 5};
    default:
      if (type >= 8 && type <= 140)
        source_.fail(
            fmt::format("element type {} is curved or of second or higher order; only straight first-order elements "
                        "are read, so write the mesh with order 1",
                        type));
      source_.fail(fmt::format("there is no element type {}", type));
  }
}

MeshBuilder::Target MeshBuilder::target_of(std::int32_t type) {
  const auto cell = [&](CellKind kind) {
    mesh::CellBlock& block = cells_[static_cast<std::size_t>(kind)];
    return Target{&block.corners, &block.tags};
  };
  const auto face = [&](FaceKind kind) {
    mesh::FaceBlock& block = faces_[static_cast<std::size_t>(kind)];
    return Target{&block.corners, &block.tags};
  };
  switch (type) {
    case Type::triangle:
      return face(FaceKind::triangle);
    case Type::quadrangle:
      return face(FaceKind::quadrangle);
    case Type::tetrahedron:
      return cell(CellKind::tetrahedron);
    case Type::hexahedron:
      return cell(CellKind::hexahedron);
    case Type::prism:
      return cell(CellKind::wedge);
    case Type::pyramid:
      return cell(CellKind::pyramid);
    default:
      return {};
  }
}

void MeshBuilder::reserve(std::int32_t type, std::int64_t count) {
  const Target target = target_of(type);
  if (target.tags == nullptr) return;
  const auto more = [](auto& items, std::size_t extra) {
    // Many small blocks must not make each of them a copy of all before.
    if (items.size() + extra > items.capacity()) items.reserve(std::max(items.size() + extra, items.capacity() * 2));
  };
  more(*target.tags, static_cast<std::size_t>(count));
  more(*target.corners, static_cast<std::size_t>(count) * static_cast<std::size_t>(type_of(type).num_nodes));
}

void MeshBuilder::add_element(std::int32_t type, std::int64_t number, std::int32_t tag, std::span<const std::int64_t> nodes) {
  elements_.add(number);
  std::array<std::int64_t, 8> indices{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    indices[i] = numbers_.find(nodes[i]);
    if (indices[i] < 0) source_.fail(fmt::format("element {} names node {}, which does not exist", number, nodes[i]));
  }
  if (tag < 0) source_.fail(fmt::format("element {} has physical group {}; groups are numbered from 1 here", number, tag));
  const Target target = target_of(type);
  if (const int dimension = type_of(type).dimension; tag == 0 && dimension < 3) {
    ++mesh_.num_untagged[static_cast<std::size_t>(dimension)];
  }
  if (target.tags == nullptr) {
    ++mesh_.num_other_elements[type == Type::point ? 0 : 1];
    return;
  }
  if (tag == 0 && (type == Type::triangle || type == Type::quadrangle)) return;
  target.tags->push_back(tag);
  target.corners->insert(target.corners->end(), indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(nodes.size()));
}

void MeshBuilder::finish_elements() {
  if (const std::int64_t repeated = elements_.find_repeated(); repeated >= 0)
    source_.fail(fmt::format("element number {} is given twice", repeated));
}

mesh::MeshData MeshBuilder::take(std::string source_name) {
  mesh_.source = std::move(source_name);
  for (std::size_t kind = 0; kind < cells_.size(); ++kind) {
    cells_[kind].kind = static_cast<CellKind>(kind);
    if (!cells_[kind].tags.empty()) mesh_.cells.push_back(std::move(cells_[kind]));
  }
  for (std::size_t kind = 0; kind < faces_.size(); ++kind) {
    faces_[kind].kind = static_cast<FaceKind>(kind);
    if (!faces_[kind].tags.empty()) mesh_.faces.push_back(std::move(faces_[kind]));
  }
  return std::move(mesh_);
}

}  // namespace pcbmesh::formats::msh
