// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "formats/kicad/reading.hpp"

namespace pcbmesh::formats::kicad {

/// Curves without an arc form (Bezier) become chords within this distance.
inline constexpr double curve_tolerance_mm = 1e-3;

/// Whether a list's head is one of (gr_|fp_)(line arc circle rect poly curve).
[[nodiscard]] bool is_graphic(std::string_view head);

/// What a graphic draws, in its own frame: pen, filled and all. Empty points if it draws nothing.
[[nodiscard]] Outlined drawn_by(Reading& reading, syntax::Sexpr item);

/// Appends the points and arcs of a (pts ...) list.
void append_points(Reading& reading, syntax::Sexpr pts, Outlined& out);

/// Graphic at top level or in a footprint: copper, a piece of the board edge, or nothing of interest.
void read_graphic(Reading& reading, const Placement& place, syntax::Sexpr item);

/// Texts, tables, dimensions, images and the like: counted where they stand on copper, since they are not read.
void skip_annotation(Reading& reading, syntax::Sexpr item);

}  // namespace pcbmesh::formats::kicad
