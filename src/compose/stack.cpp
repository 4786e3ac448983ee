// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/stack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::compose {
namespace {

using board::Board;
using board::LayerKind;
using board::StackupLayer;

bool is_called_prepreg(const Board& board, const StackupLayer& layer) {
  const auto says = [](std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
    return lower.find("prepreg") != std::string::npos;
  };
  return says(layer.name) || says(layer.user_name) || says(board.materials()[static_cast<std::size_t>(layer.material)].name);
}

/// Kept layers, top to bottom, as stackup indices. Mask lies on the outermost copper or is left out.
std::vector<std::int32_t> kept_layers(const Board& board, const study::Study& study, Diagnostics& diagnostics) {
  const std::int32_t top = board.copper_layers().front(), bottom = board.copper_layers().back();
  std::vector<std::int32_t> kept;
  for (std::size_t i = 0; i < board.stackup().size(); ++i) {
    const StackupLayer& layer = board.stackup()[i];
    const auto index = static_cast<std::int32_t>(i);
    const bool lies_on_copper = index + 1 == top || index == bottom + 1;
    if (layer.kind != LayerKind::solder_mask || (study.fabrication.solder_mask && lies_on_copper)) {
      kept.push_back(index);
      continue;
    }
    diagnostics.note("compose.solder_mask_left_out", "solder mask layers are left out of the mesh",
                     {.file = board.source(), .layer = layer.name});
  }
  return kept;
}

/// How copper layer kept[at] is filled and etched.
struct GapFilling {
  std::int32_t material = -1;    ///< of its gaps; -1 = air, or mask
  bool is_narrow_on_top = true;  ///< etched from above
};

GapFilling gap_filling(const Board& board, const std::vector<std::int32_t>& kept, std::size_t at, const ResolvedFill& fill) {
  const auto layer = [&](std::size_t k) -> const StackupLayer& { return board.stackup()[static_cast<std::size_t>(kept[k])]; };
  const StackupLayer* above = nullptr;
  const StackupLayer* below = nullptr;
  for (std::size_t k = at; k-- > 0 && above == nullptr;)
    if (layer(k).kind == LayerKind::dielectric) above = &layer(k);
  for (std::size_t k = at + 1; k < kept.size() && below == nullptr; ++k)
    if (layer(k).kind == LayerKind::dielectric) below = &layer(k);
  const bool is_first = above == nullptr, is_last = below == nullptr;
  GapFilling filling{.is_narrow_on_top =
                         is_first || (!is_last && is_called_prepreg(board, *above) && !is_called_prepreg(board, *below))};
  // Foil on a core of which nothing is known: the prepreg that filled the gaps etched it, so to speak.
  if (!is_first && !is_last && fill.side == FillSide::above) filling.is_narrow_on_top = true;
  if (!is_first && !is_last && fill.side == FillSide::below) filling.is_narrow_on_top = false;
  switch (fill.side) {
    case FillSide::above:
      filling.material = is_first ? -1 : above->material;
      return filling;
    case FillSide::below:
      filling.material = is_last ? -1 : below->material;
      return filling;
    case FillSide::material:
      filling.material = fill.material;
      return filling;
    case FillSide::automatic:
      break;
  }
  if (is_first || is_last) return filling;
  filling.material = filling.is_narrow_on_top ? above->material : below->material;
  return filling;
}

/// Heights above the layer's bottom at which a copper layer is cut, ascending, and the inset of each part.
struct Stairs {
  std::vector<Nm> heights;  ///< without 0 and the thickness
  std::vector<Nm> insets;   ///< one more than heights
};

/// The slope as stairs of equal area: each step stands in the middle of the slope.
Stairs etch_stairs(const study::Etch& etch, Nm thickness, bool is_narrow_on_top) {
  Stairs stairs;
  const double undercut = static_cast<double>(thickness) / etch.factor;
  for (int step = 0; step < etch.steps; ++step) {
    if (step > 0) stairs.heights.push_back(thickness * step / etch.steps);
    stairs.insets.push_back(std::llround(undercut * (step + 0.5) / etch.steps));
  }
  if (!is_narrow_on_top) std::reverse(stairs.insets.begin(), stairs.insets.end());
  return stairs;
}

/// Cuts the part that holds this height; nothing happens at the faces or where there is a cut.
void cut_at(Stairs& stairs, Nm height, Nm thickness) {
  if (height <= 0 || height >= thickness) return;
  const auto place = std::lower_bound(stairs.heights.begin(), stairs.heights.end(), height);
  if (place != stairs.heights.end() && *place == height) return;
  const auto part = place - stairs.heights.begin();
  stairs.heights.insert(place, height);
  stairs.insets.insert(stairs.insets.begin() + part, stairs.insets[static_cast<std::size_t>(part)]);
}

class StackBuilder {
 public:
  StackBuilder(const Board& board, const study::Study& study, const std::vector<char>& only_sheets,
               const std::vector<ResolvedFill>& fills, MaterialTable& materials, Diagnostics& diagnostics)
      : board_(board), study_(study), only_sheets_(only_sheets), fills_(fills), kept_(kept_layers(board, study, diagnostics)) {
    stack_.air = materials.air();
    stack_.outside = study.air_above > 0 || study.air_below > 0 || study.air_around > 0 ? stack_.air : -1;
    stack_.copper.resize(board.copper_layers().size());
    stack_.copper_slices.resize(board.copper_layers().size());
  }

  Stack run() {
    const study::Boundary& below = study_.boundaries[static_cast<std::size_t>(study::HullSide::zmin)];
    const study::Boundary& above = study_.boundaries[static_cast<std::size_t>(study::HullSide::zmax)];
    if (below.kind == study::BoundaryKind::pml) {
      z_ = -study_.air_below - below.thickness;
      append_matched("pml below", below);
    }
    if (study_.air_below > 0) {
      z_ = -study_.air_below;
      append("air below", model::SlabKind::air, study_.air_below, stack_.air);
    }
    stack_.first_board_slab = next_slab();
    auto copper = static_cast<std::int32_t>(board_.copper_layers().size());
    for (std::size_t k = kept_.size(); k-- > 0;) {
      const StackupLayer& layer = layer_at(k);
      if (layer.kind == LayerKind::copper)
        append_copper(k, --copper);
      else if (layer.kind == LayerKind::solder_mask)
        append_mask(k);
      else
        append(layer.name, model::SlabKind::dielectric, layer.thickness_nm, layer.material);
    }
    stack_.last_board_slab = next_slab() - 1;
    if (stack_.last_board_slab < stack_.first_board_slab)
      throw Error(ErrorCode::stackup_invalid,
                  "every conductor is a sheet and the stackup has no dielectric: nothing has any height; make the conductors "
                  "solid or hollow",
                  {.file = board_.source()});
    if (study_.air_above > 0) append("air above", model::SlabKind::air, study_.air_above, stack_.air);
    if (above.kind == study::BoundaryKind::pml) append_matched("pml above", above);
    return std::move(stack_);
  }

 private:
  [[nodiscard]] const StackupLayer& layer_at(std::size_t k) const {
    return board_.stackup()[static_cast<std::size_t>(kept_[k])];
  }
  [[nodiscard]] std::int32_t next_slab() const { return static_cast<std::int32_t>(stack_.slabs.size()); }
  void append(std::string name, model::SlabKind kind, Nm thickness, std::int32_t material) {
    stack_.slabs.push_back({std::move(name), kind, z_, z_ + thickness, material, stack_.outside});
    z_ += thickness;
  }
  /// One slab per element asked for: slabs of one name are one layer.
  void append_matched(const std::string& name, const study::Boundary& boundary) {
    for (int i = 0; i < boundary.layers; ++i) {
      const Nm from = boundary.thickness * i / boundary.layers, to = boundary.thickness * (i + 1) / boundary.layers;
      append(name, model::SlabKind::air, to - from, stack_.air);
      stack_.slabs.back().is_stretched = true;
    }
  }
  /// The mask beside kept_[k], on the outer side of the stack.
  [[nodiscard]] const StackupLayer* mask_beside(std::size_t k, bool above) const {
    if (above ? k == 0 : k + 1 == kept_.size()) return nullptr;
    const StackupLayer& layer = layer_at(above ? k - 1 : k + 1);
    return layer.kind == LayerKind::solder_mask ? &layer : nullptr;
  }

  void append_copper(std::size_t k, std::int32_t copper) {
    const StackupLayer& layer = layer_at(k);
    const GapFilling filling = gap_filling(board_, kept_, k, fills_[static_cast<std::size_t>(copper)]);
    const StackupLayer *above = mask_beside(k, true), *below = mask_beside(k, false);
    const Nm thickness = layer.thickness_nm;
    Stairs stairs{{}, {0}};
    if (study_.fabrication.etch) stairs = etch_stairs(*study_.fabrication.etch, thickness, filling.is_narrow_on_top);
    // Mask fills the gaps from the laminate up, so high as it is thick.
    const Nm mask_to = above != nullptr ? above->thickness_nm : 0;
    const Nm mask_from = below != nullptr ? thickness - below->thickness_nm : thickness;
    cut_at(stairs, mask_to, thickness);
    cut_at(stairs, mask_from, thickness);

    const auto at = static_cast<std::size_t>(copper);
    CopperPlace& place = stack_.copper[at];
    place.low = place.high = place.sheet = next_slab();
    if (only_sheets_[at] != 0) return;
    Nm bottom = 0;
    for (std::size_t part = 0; part < stairs.insets.size(); ++part) {
      const Nm top = part < stairs.heights.size() ? stairs.heights[part] : thickness;
      std::int32_t material = filling.material >= 0 ? filling.material : stack_.air;
      if (filling.material < 0 && above != nullptr && top <= mask_to) material = above->material;
      if (filling.material < 0 && below != nullptr && bottom >= mask_from) material = below->material;
      std::vector<CopperSlice>& slices = stack_.copper_slices[at];
      if (!slices.empty() && slices.back().inset == stairs.insets[part])
        slices.back().slabs.last = next_slab();
      else
        slices.push_back({{next_slab(), next_slab()}, stairs.insets[part]});
      append(layer.name, model::SlabKind::copper, top - bottom, material);
      bottom = top;
    }
    place.high = next_slab();
    place.sheet = filling.is_narrow_on_top ? place.low : place.high;
  }

  /// A film over copper; where it is thicker than the copper, what rises above the copper covers the gaps too.
  void append_mask(std::size_t k) {
    const StackupLayer& layer = layer_at(k);
    const bool is_top = k + 1 < kept_.size() && layer_at(k + 1).kind == LayerKind::copper;
    const bool on_sheets = (is_top ? only_sheets_.front() : only_sheets_.back()) != 0;
    const Nm film = on_sheets ? 0 : std::min(layer.thickness_nm, layer_at(is_top ? k + 1 : k - 1).thickness_nm);
    const Nm everywhere = layer.thickness_nm - film;
    MaskSlabs mask{.slabs = {next_slab(), 0},
                   .copper_layer = is_top ? 0 : static_cast<std::int32_t>(board_.copper_layers().size()) - 1,
                   .material = layer.material};
    if (is_top && everywhere > 0) append(layer.name, model::SlabKind::dielectric, everywhere, layer.material);
    if (film > 0) mask.film = next_slab();
    if (film > 0) append(layer.name, model::SlabKind::dielectric, film, stack_.air);
    if (!is_top && everywhere > 0) append(layer.name, model::SlabKind::dielectric, everywhere, layer.material);
    mask.slabs.last = next_slab() - 1;
    stack_.masks.push_back(mask);
  }

  const Board& board_;
  const study::Study& study_;
  const std::vector<char>& only_sheets_;
  const std::vector<ResolvedFill>& fills_;
  std::vector<std::int32_t> kept_;
  Stack stack_;
  Nm z_ = 0;
};

}  // namespace

Stack build_stack(const Board& board, const study::Study& study, const std::vector<char>& only_sheets,
                  const std::vector<ResolvedFill>& fills, MaterialTable& materials, Diagnostics& diagnostics) {
  return StackBuilder(board, study, only_sheets, fills, materials, diagnostics).run();
}

}  // namespace pcbmesh::compose
