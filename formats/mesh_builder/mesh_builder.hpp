// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/mesh_builder/element_blocks.hpp"
#include "formats/syntax/byte_source.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats {

/// Ids seen so far as runs of neighbours: files number their items in long runs, so this stays small.
class IdRuns {
 public:
  void add(std::int64_t id) {
    if (!runs_.empty() && id == runs_.back().second + 1)
      ++runs_.back().second;
    else
      runs_.emplace_back(id, id);
  }
  /// An id that was added twice, or -1. Sorts. @cost O(runs log runs).
  [[nodiscard]] std::int64_t find_repeated();

 private:
  std::vector<std::pair<std::int64_t, std::int64_t>> runs_;  ///< first, last
};

/// Node numbers of a file -> 0-based indices.
class NodeNumbers {
 public:
  void add(std::int64_t number);
  /// Call when all are added. @throws Error file_syntax (202) if one came twice or is not positive.
  void finish(const syntax::ByteSource& source);
  [[nodiscard]] std::int64_t size() const { return size_; }
  /// Index, or -1 if there is no such node.
  [[nodiscard]] std::int64_t find(std::int64_t number) const {
    if (is_dense_) return number >= first_ && number - first_ < size_ ? number - first_ : -1;
    return find_sparse(number);
  }

 private:
  [[nodiscard]] std::int64_t find_sparse(std::int64_t number) const;
  bool is_dense_ = true;  ///< numbers are first_, first_ + 1, ...
  std::int64_t first_ = 1, size_ = 0;
  std::vector<std::int64_t> numbers_;                          ///< in file order, until finish(); only if not dense
  std::vector<std::int64_t> table_;                            ///< index by number, when numbers are fairly dense
  std::vector<std::pair<std::int64_t, std::int64_t>> sorted_;  ///< (number, index), when they are not
};

/// Collects a mesh while a file is read; every index is checked here.
class MeshBuilder {
 public:
  explicit MeshBuilder(syntax::ByteSource& source);

  void set_format(std::string version, bool is_binary) { mesh_.format = {"msh", std::move(version), is_binary}; }
  void add_name(int dimension, std::int32_t tag, std::string name);
  void add_node(std::int64_t number, const std::array<double, 3>& at) {
    numbers_.add(number);
    mesh_.nodes.push_back(at);
  }
  void reserve_nodes(std::int64_t count) { mesh_.nodes.reserve(static_cast<std::size_t>(count)); }
  void finish_nodes();
  [[nodiscard]] bool has_nodes() const { return has_nodes_; }

  /// Makes room for elements of one kind.
  void reserve(mesh::ElementKind kind, std::int64_t count) { blocks_.reserve(kind, count); }
  /// @param nodes  node numbers of the file, in Gmsh order, as many as the kind has. Faces without a tag are dropped.
  /// @throws Error file_syntax (202): a node that does not exist, a negative tag.
  void add_element(mesh::ElementKind kind, std::int64_t number, std::int32_t tag, std::span<const std::int64_t> nodes);
  /// Counts a point (0) or line (1), which no mesh here holds.
  void add_other(int dimension, std::int32_t tag) {
    ++mesh_.num_other_elements[static_cast<std::size_t>(dimension)];
    if (tag == 0) ++mesh_.num_untagged[static_cast<std::size_t>(dimension)];
  }
  [[nodiscard]] const NodeNumbers& numbers() const { return numbers_; }
  void finish_elements();

  [[nodiscard]] mesh::MeshData take(std::string source_name);

 private:
  syntax::ByteSource& source_;
  mesh::MeshData mesh_;
  NodeNumbers numbers_;
  IdRuns elements_;
  ElementBlocks blocks_;
  bool has_nodes_ = false;
};

}  // namespace pcbmesh::formats
