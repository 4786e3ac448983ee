// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// Copper of a pad on one layer, as the file describes it; lengths in millimetres.
struct PadShape {
  enum class Kind { circle, rectangle, oval, rounded, trapezoid, custom };
  Kind kind = Kind::rectangle;
  Vec size{};
  Vec offset{};  ///< moves the copper, not the hole
  Vec delta{};   ///< trapezoid
  double round_ratio = 0.25;
  double chamfer_ratio = 0;
  /// Corners cut instead of rounded, in KiCad's frame (y down): top left, top right, bottom right, bottom left.
  bool chamfered[4] = {false, false, false, false};
  bool round_anchor = false;
  syntax::Sexpr primitives{};
};

/// Overwrites those fields that the list (a pad, or one layer of its padstack) states.
void read_pad_shape(Reading& reading, syntax::Sexpr list, syntax::Sexpr kind, PadShape& shape);

/// Figures of the shape. `place` takes the pad's frame to the board's.
[[nodiscard]] std::vector<geometry::Figure> pad_figures(Reading& reading, const PadShape& shape, const Placement& place,
                                                        syntax::Sexpr pad);

}  // namespace pcbmesh::formats::kicad
