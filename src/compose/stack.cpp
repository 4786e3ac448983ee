// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/stack.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// Kept layers, top to bottom, as stackup indices.
std::vector<std::int32_t> kept_layers(const Board& board, Diagnostics& diagnostics) {
  std::vector<std::int32_t> kept;
  for (std::size_t i = 0; i < board.stackup().size(); ++i) {
    const StackupLayer& layer = board.stackup()[i];
    if (layer.kind != LayerKind::solder_mask) {
      kept.push_back(static_cast<std::int32_t>(i));
      continue;
    }
    diagnostics.note("compose.solder_mask_left_out", "solder mask layers are left out of the mesh",
                     {.file = board.source(), .layer = layer.name});
  }
  return kept;
}

/// What fills the gaps of a copper layer.
struct Gap {
  std::int32_t material = -1;  ///< -1 = air
  bool from_above = true;      ///< it comes from the layer above
};

Gap gap_of(const Board& board, const std::vector<std::int32_t>& kept, std::size_t at) {
  if (at == 0 || at + 1 == kept.size()) return {-1, at == 0};
  const auto layer = [&](std::size_t k) -> const StackupLayer& { return board.stackup()[static_cast<std::size_t>(kept[k])]; };
  const StackupLayer* above = nullptr;
  const StackupLayer* below = nullptr;
  for (std::size_t k = at; k-- > 0 && above == nullptr;)
    if (layer(k).kind == LayerKind::dielectric) above = &layer(k);
  for (std::size_t k = at + 1; k < kept.size() && below == nullptr; ++k)
    if (layer(k).kind == LayerKind::dielectric) below = &layer(k);
  if (above == nullptr && below == nullptr) return {};
  if (above == nullptr) return {below->material, false};
  if (below == nullptr) return {above->material, true};
  const bool only_above_is_prepreg = is_called_prepreg(board, *above) && !is_called_prepreg(board, *below);
  return only_above_is_prepreg ? Gap{above->material, true} : Gap{below->material, false};
}

/// The board's own air if it has one; else air is added under a free name.
std::int32_t air_among(std::vector<board::Material>& materials) {
  board::Material air{.name = "air"};
  for (int copy = 2;; ++copy) {
    const auto found = std::find_if(materials.begin(), materials.end(), [&](const auto& m) { return m.name == air.name; });
    if (found == materials.end()) break;
    if (*found == air) return static_cast<std::int32_t>(found - materials.begin());
    air.name = fmt::format("air {}", copy);
  }
  materials.push_back(std::move(air));
  return static_cast<std::int32_t>(materials.size()) - 1;
}

}  // namespace

Stack build_stack(const Board& board, const study::Study& study, const std::vector<char>& only_sheets,
                  Diagnostics& diagnostics) {
  Stack stack;
  stack.materials.assign(board.materials().begin(), board.materials().end());
  stack.air = air_among(stack.materials);
  stack.outside = study.air_above > 0 || study.air_below > 0 || study.air_around > 0 ? stack.air : -1;
  stack.copper.resize(board.copper_layers().size());

  const auto append = [&](std::string name, model::SlabKind kind, Nm thickness, Nm bottom, std::int32_t material) {
    stack.slabs.push_back({std::move(name), kind, bottom, bottom + thickness, material, stack.outside});
  };
  if (study.air_below > 0) append("air below", model::SlabKind::air, study.air_below, -study.air_below, stack.air);
  stack.first_board_slab = static_cast<std::int32_t>(stack.slabs.size());

  const std::vector<std::int32_t> kept = kept_layers(board, diagnostics);
  auto copper = static_cast<std::int32_t>(board.copper_layers().size());
  Nm z = 0;
  for (std::size_t k = kept.size(); k-- > 0;) {
    const StackupLayer& layer = board.stackup()[static_cast<std::size_t>(kept[k])];
    std::int32_t material = layer.material;
    model::SlabKind kind = model::SlabKind::dielectric;
    if (layer.kind == LayerKind::copper) {
      const auto here = static_cast<std::size_t>(--copper);
      const auto face = static_cast<std::int32_t>(stack.slabs.size());
      const Gap gap = gap_of(board, kept, k);
      stack.copper[here] = {face, only_sheets[here] ? face : face + 1, only_sheets[here] || gap.from_above ? face : face + 1};
      if (only_sheets[here]) continue;
      kind = model::SlabKind::copper;
      material = gap.material < 0 ? stack.air : gap.material;
    }
    append(layer.name, kind, layer.thickness_nm, z, material);
    z += layer.thickness_nm;
  }
  stack.last_board_slab = static_cast<std::int32_t>(stack.slabs.size()) - 1;
  if (z == 0)
    throw Error(ErrorCode::stackup_invalid,
                "every conductor is a sheet and the stackup has no dielectric: nothing has any height; make the conductors "
                "solid or hollow",
                {.file = board.source()});
  if (study.air_above > 0) append("air above", model::SlabKind::air, study.air_above, z, stack.air);
  return stack;
}

}  // namespace pcbmesh::compose
