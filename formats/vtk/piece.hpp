// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "formats/sink/array_sink.hpp"
#include "formats/sink/meter.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats::vtk {

/// Neighbouring elements of one block of a source.
struct Run {
  std::size_t block = 0;
  std::int64_t first = 0, count = 0;
};

/// All elements of blocks that `wanted` picks.
[[nodiscard]] std::vector<Run> runs_of(const mesh::MeshSource& source,
                                       const std::function<bool(const mesh::ElementBlock&)>& wanted);
/// Elements [first, first + count) of the elements in `runs`, counted through.
[[nodiscard]] std::vector<Run> part_of(std::span<const Run> runs, std::int64_t first, std::int64_t count);

/// Values of one kind per cell, all but quality as 32-bit integers; -1 = none, tags 0 = none.
enum class CellArray { volume_tag, face_tag, layer, material, net, region, quality };
[[nodiscard]] std::string_view name_of(CellArray array);

/// Part of a mesh that becomes one data set: runs of elements, and the nodes they use with numbers of their own.
class Piece {
 public:
  /// @param all_nodes  true: the runs use all nodes of the source; they keep their numbers.
  /// @cost O(elements of the runs); memory one bit and a half per node unless all_nodes.
  Piece(mesh::MeshSource& source, std::vector<Run> runs, bool all_nodes, const Progress& progress);
  /// The same with the cell arrays of another piece: all parts of one mesh have the same ones.
  Piece(mesh::MeshSource& source, std::vector<Run> runs, std::vector<CellArray> arrays, const Progress& progress);

  [[nodiscard]] std::int64_t num_nodes() const { return num_nodes_; }
  [[nodiscard]] std::int64_t num_elements() const { return num_elements_; }
  /// Nodes of all elements together.
  [[nodiscard]] std::int64_t num_corners() const { return num_corners_; }
  /// Arrays that say something about these elements.
  [[nodiscard]] const std::vector<CellArray>& cell_arrays() const { return cell_arrays_; }
  /// Whether 32 bits hold all numbers of nodes and all offsets.
  [[nodiscard]] bool fits_32_bits() const;

  void put_points(double scale, ArraySink& out, Meter& meter) const;
  /// @param bytes  of an integer, 4 or 8.
  void put_corners(VtkWedge wedge, std::size_t bytes, ArraySink& out, Meter& meter) const;
  /// The same into two arrays in one go: in the chosen order, and in Gmsh's (VTK's of second order).
  void put_corners_twice(VtkWedge wedge, std::size_t bytes, ArraySink& out, ArraySink& parametric, Meter& meter) const;
  /// Where each element's corners end in the array of all corners; `from_zero`: with a leading 0.
  void put_ends(bool from_zero, std::size_t bytes, ArraySink& out, Meter& meter) const;
  void put_types(ArraySink& out, Meter& meter) const;
  void put_cell_array(CellArray array, ArraySink& out, Meter& meter) const;

 private:
  using VisitRows = std::function<void(std::span<const std::int64_t> nodes)>;
  void visit(const Run& run, const VisitRows& visit_rows) const;
  void mark_nodes(const Progress& progress);
  [[nodiscard]] std::vector<CellArray> telling_arrays() const;
  [[nodiscard]] bool has(std::int64_t node) const;
  [[nodiscard]] std::int64_t number_of(std::int64_t node) const;
  template <class Integer>
  void put_corners_of(const Run& run, VtkWedge wedge, ArraySink& out, ArraySink* parametric, Meter& meter) const;
  template <class Integer>
  void put_ends_of(bool from_zero, ArraySink& out, Meter& meter) const;
  [[nodiscard]] std::int32_t value_of(const Run& run, CellArray array) const;

  mesh::MeshSource& source_;
  std::vector<Run> runs_;
  std::vector<CellArray> cell_arrays_;
  std::int64_t num_nodes_ = 0, num_elements_ = 0, num_corners_ = 0;
  std::vector<std::uint64_t> words_;  ///< one bit per node of the source; empty: all
  std::vector<std::int64_t> ranks_;   ///< nodes before each word
};

/// Bytes of an integer that holds node numbers and offsets of the piece, as the options want it.
/// @throws Error format_limit (703) if 32 bits are wanted and do not hold them.
[[nodiscard]] std::size_t index_bytes(const Piece& piece, const WriteMeshOptions& options, const std::filesystem::path& file);

}  // namespace pcbmesh::formats::vtk
