// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/validation/report.hpp"
#include "validation/checks/tally.hpp"
#include "validation/checks/vector3.hpp"

namespace pcbmesh::validation::checks {

/// The distinct tags of all blocks as dense slots, ascending by tag.
class TagTable {
 public:
  template <class Block>
  explicit TagTable(const std::vector<Block>& blocks) {
    for (const Block& block : blocks) gather(block.tags);
    finish();
  }
  [[nodiscard]] int size() const { return static_cast<int>(tags_.size()); }
  [[nodiscard]] std::int32_t tag(int slot) const { return tags_[static_cast<std::size_t>(slot)]; }
  /// -1 if no element carries the tag.
  [[nodiscard]] int slot(std::int32_t tag) const {
    if (tag >= 0 && static_cast<std::size_t>(tag) < dense_.size()) return dense_[static_cast<std::size_t>(tag)];
    return slot_of_wild(tag);
  }

 private:
  void gather(const std::vector<std::int32_t>& tags);
  void finish();
  [[nodiscard]] int slot_of_wild(std::int32_t tag) const;
  std::vector<std::int32_t> dense_;  ///< slot per small non-negative tag
  std::vector<std::int32_t> wild_;   ///< negative and huge tags; garbage must not cost memory
  std::vector<std::int32_t> tags_;
};

/// What every check sees. Cells and faces are numbered through over all blocks; a half face is cell << 3 | local face.
struct Context {
  Context(const mesh::MeshData& mesh, const Expectation* expectation, const CheckOptions& options);

  const mesh::MeshData& mesh;
  const Expectation* expectation;
  int num_threads;
  std::vector<std::int64_t> first_cell, first_face;  ///< per block, plus one
  TagTable cell_tags, face_tags;
  bool has_geometry = true;  ///< every coordinate is finite
  Vector3 low{}, high{};     ///< bounding box; zero if !has_geometry
  /// Points closer than this are one point: 1e-9 of the bounding box's diagonal. On a 300 mm board that is 0.3 nm: below
  /// the nanometre grid of layouts, a million times above the rounding of doubles.
  double tolerance = 0;

  [[nodiscard]] std::int64_t num_nodes() const { return static_cast<std::int64_t>(mesh.nodes.size()); }
  [[nodiscard]] std::int64_t num_cells() const { return first_cell.back(); }
  [[nodiscard]] std::int64_t num_faces() const { return first_face.back(); }

  /// Block and index in the block.
  [[nodiscard]] std::pair<std::size_t, std::int64_t> locate_cell(std::int64_t cell) const;
  [[nodiscard]] std::pair<std::size_t, std::int64_t> locate_face(std::int64_t face) const;
  [[nodiscard]] std::span<const std::int64_t> corners_of_cell(std::int64_t cell) const;
  [[nodiscard]] std::span<const std::int64_t> corners_of_face(std::int64_t face) const;
  [[nodiscard]] std::int32_t tag_of_cell(std::int64_t cell) const;
  [[nodiscard]] std::int32_t tag_of_face(std::int64_t face) const;
  /// Corners of a half face, counter-clockwise seen from outside; returns how many.
  int corners_of_half_face(std::int64_t half_face, std::array<std::int64_t, 4>& corners) const;

  /// Name of a group: the mesh's own, else the expectation's, else empty.
  [[nodiscard]] std::string name_of(int dimension, std::int32_t tag) const;
  [[nodiscard]] Finding::Place place_of_cell(std::int64_t cell) const;
  [[nodiscard]] Finding::Place place_of_face(std::int64_t face) const;
  [[nodiscard]] Finding::Place place_of_half_face(std::int64_t half_face) const;
  [[nodiscard]] Finding::Place place_of_node(std::int64_t node) const;

 private:
  [[nodiscard]] Vector3 centre(std::span<const std::int64_t> corners) const;
};

/// What the ids of a tally mean.
enum class PlaceKind { none, cell, face, half_face, node };

/// Collects findings of one check and measures it. Codes that come once per group or net are cut off after 50 findings,
/// and one last finding counts the rest: a mesh that is wrong everywhere must still give a report one can read.
class CheckLog {
 public:
  CheckLog(Report& report, const Context& context, std::string name);
  ~CheckLog();
  CheckLog(const CheckLog&) = delete;
  CheckLog& operator=(const CheckLog&) = delete;

  void examined(std::int64_t count) { run_.num_examined += count; }
  /// Nothing is reported for an empty tally.
  void found(std::string_view code, FindingSeverity severity, std::string text, const Tally& tally, PlaceKind kind);
  void found(std::string_view code, FindingSeverity severity, std::string text, std::int64_t count = 1,
             std::vector<Finding::Place> places = {});
  /// Says which nets and which layer the finding just made is about.
  void describe_last(std::vector<std::string> nets, std::string layer);

 private:
  bool is_last_kept_ = false;
  Report& report_;
  const Context& context_;
  CheckRun run_;
  double start_s_;
  struct Given {
    std::int64_t findings = 0, count_beyond = 0;
    FindingSeverity severity = FindingSeverity::error;
  };
  std::map<std::string, Given, std::less<>> given_;  ///< by code
};

}  // namespace pcbmesh::validation::checks
