// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "src/overlay/census.hpp"

namespace pcbmesh::overlay {
namespace {

constexpr std::int32_t no_conductor = -2;

/// Net of the conductor in every slab of a face with these bodies, then of the sheet at every level; no_conductor where there
/// is none. Memoised per state.
class ConductorColumns {
 public:
  ConductorColumns(const LabelPool& labels, const model::Model& model) : labels_(labels), model_(model) {}

  const std::vector<std::int32_t>& of(std::int32_t state) {
    if (memo_.size() <= ix(state)) memo_.resize(ix(labels_.size()));
    std::vector<std::int32_t>& column = memo_[ix(state)];
    if (!column.empty()) return column;
    present_.clear();
    for (const Increment& in : labels_.entries(state)) present_.push_back(in.body);
    for (std::size_t slab = 0; slab < model_.slabs().size(); ++slab) {
      const model::Label label = model_.resolve(static_cast<std::int32_t>(slab), present_);
      const std::int32_t net = label.is_void() ? label.hollow_net : label.net;
      column.push_back(net >= 0 ? net : no_conductor);
    }
    for (std::size_t level = 0; level <= model_.slabs().size(); ++level) {
      const std::int32_t sheet = model_.sheet_at(static_cast<std::int32_t>(level), present_);
      const std::int32_t net = sheet < 0 ? no_conductor : model_.bodies()[ix(sheet)].net;
      column.push_back(net >= 0 ? net : no_conductor);
    }
    return column;
  }

 private:
  const LabelPool& labels_;
  const model::Model& model_;
  std::vector<std::vector<std::int32_t>> memo_;
  std::vector<std::int32_t> present_;
};

}  // namespace

bool has_fillers(const model::Model& model) {
  return std::ranges::any_of(model.bodies(), [](const model::Body& body) { return body.kind == model::BodyKind::filler; });
}

std::vector<std::int32_t> count_pieces_by_cells(const EdgeGraph& graph, const Faces& faces, const LabelPool& labels,
                                                const model::Model& model) {
  const std::size_t num_slabs = model.slabs().size();
  ConductorColumns columns(labels, model);
  const std::size_t num_places = 2 * num_slabs + 1;  // slabs, then levels
  UnionFind cells(faces.state.size() * num_places);
  const auto cell = [&](std::int32_t face, std::size_t place) {
    return static_cast<std::int32_t>(ix(face) * num_places + place);
  };
  for (std::size_t f = 0; f < faces.state.size(); ++f) {
    const std::vector<std::int32_t>& column = columns.of(faces.state[f]);
    for (std::size_t slab = 1; slab < num_slabs; ++slab)
      if (column[slab] != no_conductor && column[slab] == column[slab - 1])
        cells.unite(cell(static_cast<std::int32_t>(f), slab - 1), cell(static_cast<std::int32_t>(f), slab));
  }
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    // Copies: the memo may grow.
    const std::vector<std::int32_t> left = columns.of(faces.state[ix(faces.left[e])]);
    const std::vector<std::int32_t>& right = columns.of(faces.state[ix(faces.right[e])]);
    for (std::size_t place = 0; place < num_places; ++place)
      if (left[place] != no_conductor && left[place] == right[place])
        cells.unite(cell(faces.left[e], place), cell(faces.right[e], place));
    // A sheet meets what stands beside it, below and above.
    for (std::size_t level = 0; level <= num_slabs; ++level)
      for (std::size_t slab = level == 0 ? 0 : level - 1; slab < std::min(level + 1, num_slabs); ++slab) {
        const std::size_t sheet = num_slabs + level;
        if (left[sheet] != no_conductor && left[sheet] == right[slab])
          cells.unite(cell(faces.left[e], sheet), cell(faces.right[e], slab));
        if (right[sheet] != no_conductor && right[sheet] == left[slab])
          cells.unite(cell(faces.right[e], sheet), cell(faces.left[e], slab));
      }
  }
  std::vector<std::int32_t> pieces(model.nets().size(), 0);
  for (std::size_t f = 0; f < faces.state.size(); ++f) {
    const std::vector<std::int32_t>& column = columns.of(faces.state[f]);
    for (std::size_t place = 0; place < num_places; ++place)
      if (column[place] != no_conductor) {
        const std::int32_t own = cell(static_cast<std::int32_t>(f), place);
        if (cells.find(own) == own) ++pieces[ix(column[place])];
      }
  }
  return pieces;
}

}  // namespace pcbmesh::overlay
