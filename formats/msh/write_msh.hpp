// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/sink/file_sink.hpp"
#include "formats/sink/meter.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats::msh {

/// Gmsh's number of an element kind.
[[nodiscard]] constexpr std::int32_t gmsh_type(mesh::ElementKind kind) {
  constexpr std::int32_t types[] = {2, 3, 4, 7, 6, 5, 9, 16, 10, 11, 18, 13};
  return types[static_cast<int>(kind)];
}

/// Calls use.operator()<width>() for the width of an element kind, so that rows are written with a width the compiler knows.
template <class Use>
void with_width(mesh::ElementKind kind, Use&& use) {
  switch (mesh::nodes_of(kind)) {
    case 3:
      return use.template operator()<3>();
    case 4:
      return use.template operator()<4>();
    case 5:
      return use.template operator()<5>();
    case 6:
      return use.template operator()<6>();
    case 8:
      return use.template operator()<8>();
    case 9:
      return use.template operator()<9>();
    case 10:
      return use.template operator()<10>();
    case 15:
      return use.template operator()<15>();
    case 18:
      return use.template operator()<18>();
    default:
      report_bug("known width of an element", __FILE__, __LINE__);
  }
}

/// Everything the two versions' writers need; one per file.
struct WriteJob {
  mesh::MeshSource& source;
  FileSink& sink;
  bool binary = true;
  double scale = 1;  ///< written units per unit of the source
  const Progress& progress;
};

/// Writes int, size_t and double of MSH 4.1 as the mode wants them: packed, or followed by a blank.
class Fields {
 public:
  explicit Fields(const WriteJob& job) : sink_(job.sink), binary_(job.binary) {}
  void integer(std::int32_t value) { field(value); }
  void size(std::int64_t value) { field(static_cast<std::uint64_t>(value)); }
  void real(double value) { field(value); }
  void end_line() {
    if (!binary_) sink_.put("\n");
  }

 private:
  template <class T>
  void field(T value) {
    if (binary_) return sink_.put_raw(value);
    sink_.put_number(value);
    sink_.put(" ");
  }
  FileSink& sink_;
  bool binary_;
};

/// MSH 4.1: one discrete entity per physical group, entity tag = physical tag, no points or curves; all nodes in one block.
void write_41(const WriteJob& job);

/// MSH 2.2: tags (physical, elementary = physical); binary blocks have one header for all elements of a tag.
/// REQUIRES require_fits_22().
void write_22(const WriteJob& job);

/// @throws Error format_limit (703) beyond 2^31 - 1 nodes or elements.
void require_fits_22(const mesh::MeshSource& source, const std::filesystem::path& file);

/// $Periodic, behind the elements: each side of a periodic pair of a prism mesh with its partner, node by node; nothing where
/// there is none. MSH 2.2 has it as text always. @throws Error internal (901) where partners don't match.
void write_periodic_41(const WriteJob& job);
void write_periodic_22(const WriteJob& job);

/// Size of the file in bytes but for its few kB of headers; 0 for text, whose size nobody knows before.
[[nodiscard]] std::uint64_t expected_bytes_41(const mesh::MeshSource& source, bool binary);
[[nodiscard]] std::uint64_t expected_bytes_22(const mesh::MeshSource& source, bool binary);

template <class Value>
void store(char* to, Value value) {
  std::memcpy(to, &value, sizeof value);
}

/// Faces and cells together.
[[nodiscard]] std::int64_t num_elements(const mesh::MeshSource& source);

/// "$MeshFormat" and "$PhysicalNames", alike in both versions. `version` as the file shall say it.
void write_opening(const WriteJob& job, std::string_view version);

/// Scaled coordinates of all nodes in id order, block by block. `first` is the id of the block's first node, from 0.
using NodeVisit = std::function<void(std::int64_t first, std::span<const std::array<double, 3>> nodes)>;
void visit_nodes(const WriteJob& job, const NodeVisit& visit);

}  // namespace pcbmesh::formats::msh
