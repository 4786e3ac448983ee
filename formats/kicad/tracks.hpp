// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// Tools thinner than this are no real drill (lasers begin near 25 um). They are read as
/// min(spare_drill_nm, half the copper's diameter), with a warning that names the place.
inline constexpr Nm thinnest_drill_nm = 20 * nm_per_um;
inline constexpr Nm spare_drill_nm = 100 * nm_per_um;

/// Applies the rule above. @return the tool's diameter, > 0.
[[nodiscard]] Nm checked_drill(Reading& reading, Nm tool, Nm copper, syntax::Sexpr item, Vec at);

/// (segment ...) and (arc ...) at top level.
void read_segment(Reading& reading, syntax::Sexpr item);
void read_track_arc(Reading& reading, syntax::Sexpr item);

/// Via sizes of files up to v5, whose vias may leave the drill to the net class.
class ViaDefaults {
 public:
  ViaDefaults(Reading& reading, syntax::Sexpr root);
  [[nodiscard]] double drill_mm(const Reading& reading, std::int32_t net, bool micro) const;

 private:
  struct Drills {
    double via_mm = 0.3, micro_mm = 0.1;  ///< KiCad's own defaults
  };
  Drills board_{};
  std::map<std::string, Drills, std::less<>> by_net_;
};

/// (via ...) of every kind, with padstack, backdrills and rings that exist only where something touches them.
void read_via(Reading& reading, const ViaDefaults& defaults, syntax::Sexpr item);

}  // namespace pcbmesh::formats::kicad
