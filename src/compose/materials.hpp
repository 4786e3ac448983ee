// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::compose {

/// The materials of a model: the board's, in its order, as the study wants them; air and library materials behind them.
///
/// A material of the board takes a library's values where the study says so, or where the board does not state its
/// permittivity and the library knows its name. Dispersive ones are evaluated at the study's frequency.
class MaterialTable {
 public:
  /// Materials that the study names in vain go into unknown().
  MaterialTable(const board::Board& board, const study::Study& study, Diagnostics& diagnostics);

  /// What "/materials/use" names and nobody knows, in one sentence; empty = nothing.
  [[nodiscard]] const std::string& unknown() const { return unknown_; }
  /// A layer of the board between two copper layers whose permittivity nobody knows, for every such layer: what to do.
  [[nodiscard]] std::vector<study::Fault> layers_without_permittivity(const board::Board& board) const;

  /// The board's own air if it has one; else air is added under a free name.
  [[nodiscard]] std::int32_t air();
  /// By name: the board's, else the library's, which is then added. -1 if neither knows it.
  [[nodiscard]] std::int32_t named(std::string_view name);
  /// Names that `named` would find near a misspelt one, as "; did you mean 'x'?"; empty if there is none.
  [[nodiscard]] std::string near(std::string_view name) const;
  [[nodiscard]] const std::vector<board::Material>& all() const { return materials_; }
  [[nodiscard]] std::vector<board::Material> take() { return std::move(materials_); }

 private:
  [[nodiscard]] board::Material evaluated(board::Material material) const;
  void choose(const study::Study& study);
  void fill_in(const board::Board& board, Diagnostics& diagnostics);

  std::string unknown_;
  std::vector<study::LibraryMaterial> library_;
  std::optional<double> frequency_hz_;
  std::vector<board::Material> materials_;
};

}  // namespace pcbmesh::compose
