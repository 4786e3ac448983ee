// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pcbmesh/model/model.hpp"
#include "src/overlay/flood.hpp"
#include "src/overlay/union_find.hpp"

namespace pcbmesh::overlay {

/// Two nets, smaller first; board::no_net counts as a net of its own.
using NetPair = std::array<std::int32_t, 2>;

/// What must survive the snapping.
struct Census {
  std::vector<std::int32_t> components;  ///< per body: parts joined through edges
  std::vector<std::int32_t> pieces;  ///< per net: parts of copper and barrels, joined where slabs are shared; fillers part them
  std::vector<NetPair> touching;     ///< nets that overlap or share an edge in some slab; ascending
};

/// Which bodies conduct, and which of them can meet.
class Conductors {
 public:
  explicit Conductors(const model::Model& model) : model_(model) {}
  [[nodiscard]] bool conducts(std::int32_t body) const;
  /// Whether they have a slab, or the face of a sheet, in common.
  [[nodiscard]] bool share_slab(std::int32_t a, std::int32_t b) const;
  [[nodiscard]] std::int32_t net(std::int32_t body) const { return model_.bodies()[ix(body)].net; }
  [[nodiscard]] const model::Model& model() const { return model_; }
  /// Both conduct, share a slab, and have different nets.
  [[nodiscard]] bool clash(std::int32_t a, std::int32_t b) const {
    return net(a) != net(b) && conducts(a) && conducts(b) && share_slab(a, b);
  }
  /// Pairs of different nets on the two sides of an edge.
  void pairs_across(const LabelPool& labels, std::int32_t label, std::vector<NetPair>& out) const;
  /// Pairs of different nets in one face.
  void pairs_within(const LabelPool& labels, std::int32_t state, std::vector<NetPair>& out) const;

 private:
  const model::Model& model_;
};

/// @param faces  of `graph`; states are memberships: each entry is {body, 1}.
[[nodiscard]] Census take_census(const EdgeGraph& graph, const Faces& faces, LabelPool& labels, const Conductors& conductors);

/// Connected parts of bodies: element (face, body) -> representative element.
class BodyParts {
 public:
  BodyParts(const EdgeGraph& graph, const Faces& faces, LabelPool& labels);
  /// First element of a face; its bodies follow in the order of the face's state.
  [[nodiscard]] std::int32_t first(std::int32_t face) const { return offsets_[ix(face)]; }
  [[nodiscard]] std::int32_t num_elements() const { return offsets_.back(); }
  [[nodiscard]] std::int32_t part(std::int32_t element) { return joined_.find(element); }
  void unite(std::int32_t a, std::int32_t b) { joined_.unite(a, b); }

 private:
  std::vector<std::int32_t> offsets_;
  UnionFind joined_;
};

/// Whether copper is taken away somewhere by what is put in its place: then what is left must be counted slab by slab.
[[nodiscard]] bool has_fillers(const model::Model& model);

/// Per net: connected pieces of what is copper in the end, cell by cell (face x slab).
/// @param faces  states hold domain and board too.
/// @cost O(faces x slabs).
[[nodiscard]] std::vector<std::int32_t> count_pieces_by_cells(const EdgeGraph& graph, const Faces& faces,
                                                              const LabelPool& labels, const model::Model& model);

/// Area of each body.
[[nodiscard]] std::vector<double> areas_mm2(const EdgeGraph& graph, const LabelPool& labels, std::size_t num_bodies);

/// One place (leftmost point) per component of one body, ascending. Only for messages.
[[nodiscard]] std::vector<Point> places_of_parts(const EdgeGraph& graph, const Faces& faces, LabelPool& labels,
                                                 std::int32_t body);

}  // namespace pcbmesh::overlay
