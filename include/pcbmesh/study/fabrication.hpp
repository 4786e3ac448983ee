// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/units.hpp"
#include "pcbmesh/study/materials.hpp"

namespace pcbmesh::study {

/// What a plated hole holds inside its plating.
enum class ViaFill {
  copper,  ///< copper: a solid barrel
  plated,  ///< air: a tube of copper
  plugged  ///< a named material
};
[[nodiscard]] std::string_view name_of(ViaFill value);
[[nodiscard]] ViaFill parse_via_fill(std::string_view text);

/// Which plated holes a rule is about.
enum class HoleKind { any, via, pad };

/// How a plated hole is made.
struct HoleFill {
  ViaFill fill = ViaFill::copper;
  std::string plug{};           ///< plugged: material of the board or the library
  Nm plating = 25 * nm_per_um;  ///< wall of a tube
  bool capped = false;          ///< plated over at both ends: the outer copper layers of its span stay whole
  bool operator==(const HoleFill&) const = default;
};

/// Overrides how some holes are made. Later rules win.
struct HoleRule {
  std::string net{};  ///< empty = every net
  HoleKind kind = HoleKind::any;
  HoleFill how{};
  bool operator==(const HoleRule&) const = default;
};

/// Holes drilled again, wider, to take a via's stub away: from one copper layer to another, both included.
struct Backdrill {
  std::string net{};  ///< empty = every net
  std::string from{}, to{};
  Nm oversize = 200 * nm_per_um;  ///< diameter beyond the via's drill
  bool operator==(const Backdrill&) const = default;
};

/// Copper narrower at its etched side than at its foot.
struct Etch {
  double factor = 3;  ///< copper thickness over what either edge loses at the narrow side
  int steps = 2;      ///< slabs that the slope becomes
  bool operator==(const Etch&) const = default;
};

/// What fills the gaps of one copper layer: "above", "below" or the name of a material.
struct GapFill {
  std::string layer{};
  std::string from{};
  bool operator==(const GapFill&) const = default;
};

/// Takes a library material in place of one of the board's.
struct MaterialChoice {
  std::string board{};  ///< name of the board's material
  std::string take{};   ///< name in the library
  bool operator==(const MaterialChoice&) const = default;
};

/// How dielectrics that the board states by eps_r and tan_delta alone depend on frequency.
struct StatedModel {
  DispersionKind kind = DispersionKind::constant;  ///< constant or djordjevic_sarkar
  double at_hz = 1e9;                              ///< frequency that the board's values are for
  bool operator==(const StatedModel&) const = default;
};

struct Materials {
  std::vector<LibraryMaterial> library{};  ///< beside the program's; from `file` or written in the study itself
  std::vector<MaterialChoice> choices{};
  StatedModel stated{};
  bool operator==(const Materials&) const = default;
};

/// The board as it is really made.
struct Fabrication {
  HoleFill vias{};
  std::vector<HoleRule> hole_rules{};
  std::vector<Backdrill> backdrills{};
  std::optional<Nm> merge_vias{};  ///< vias of one net and span whose centres are no farther apart become one block
  std::optional<Etch> etch{};
  bool solder_mask = false;  ///< mesh the mask
  std::vector<GapFill> gap_fills{};
  Materials materials{};
  std::optional<std::int64_t> max_unknowns{};  ///< refuse above this forecast of first-order edge-element unknowns
  bool operator==(const Fabrication&) const = default;
};

}  // namespace pcbmesh::study
