// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/pad_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "formats/kicad/graphics.hpp"

namespace pcbmesh::formats::kicad {
namespace {

using syntax::Sexpr;

struct KindName {
  std::string_view name;
  PadShape::Kind kind;
};
constexpr std::array<KindName, 8> kind_names{{{"circle", PadShape::Kind::circle},
                                              {"rect", PadShape::Kind::rectangle},
                                              {"oval", PadShape::Kind::oval},
                                              {"roundrect", PadShape::Kind::rounded},
                                              {"chamferedrect", PadShape::Kind::rounded},
                                              {"chamfered_rect", PadShape::Kind::rounded},
                                              {"trapezoid", PadShape::Kind::trapezoid},
                                              {"custom", PadShape::Kind::custom}}};
constexpr std::array<std::string_view, 4> corner_names{"top_left", "top_right", "bottom_right", "bottom_left"};

/// Rectangle whose corners are rounded, cut or sharp.
Outlined cornered(Vec centre, Vec size, double radius, double cut, const bool (&is_cut)[4]) {
  const double w = size.x / 2, h = size.y / 2;
  radius = std::min({radius, w, h});
  cut = std::min({cut, 2 * w, 2 * h});
  const Vec corners[4] = {{-w, -h}, {w, -h}, {w, h}, {-w, h}};
  const Vec along[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};  // direction of the side that leaves each corner
  const double inset = 1 - std::numbers::sqrt2 / 2;
  Outlined path;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec corner = centre + corners[i], out = along[i], in = along[(i + 3) % 4];
    const double d = is_cut[i] ? cut : radius;
    if (!(d > 0)) {
      path.line_to(corner);
      continue;
    }
    path.line_to(corner - d * in);
    if (is_cut[i])
      path.line_to(corner + d * out);
    else
      path.arc_to(corner - d * inset * in + d * inset * out, corner + d * out);
  }
  path.closed = true;
  path.filled = true;
  return path;
}

/// Stadium or disc.
Outlined stadium(Vec centre, Vec size) {
  Outlined path;
  path.pen = std::min(size.x, size.y);
  const Vec reach = size.x >= size.y ? Vec{(size.x - size.y) / 2, 0} : Vec{0, (size.y - size.x) / 2};
  path.points = {centre - reach, centre + reach};
  if (path.points[0] == path.points[1]) path.points.pop_back();
  return path;
}

Outlined trapezoid(Vec centre, Vec size, Vec delta) {
  const double w = size.x / 2, h = size.y / 2, dx = delta.x / 2, dy = delta.y / 2;
  Outlined path;
  path.points = {centre + Vec{-w + dy, -h - dx}, centre + Vec{w - dy, -h + dx}, centre + Vec{w + dy, h - dx},
                 centre + Vec{-w - dy, h + dx}};
  path.closed = path.filled = true;
  return path;
}

void append_primitives(Reading& reading, const PadShape& shape, const Placement& place,
                       std::vector<geometry::Figure>& figures) {
  constexpr std::array<std::string_view, 12> words{"start",  "mid",  "end",   "center", "pts",  "width",
                                                   "stroke", "fill", "angle", "radius", "uuid", "tstamp"};
  for (const Sexpr primitive : shape.primitives) {
    if (!primitive.is_list()) continue;
    const std::string_view head = primitive.head();
    // gr_bbox and gr_vector carry number box and spoke directions: no copper.
    if (head == "gr_bbox" || head == "gr_vector") continue;
    if (!is_graphic(head)) {
      reading.count_unknown_list(primitive);
      continue;
    }
    reading.count_unknown(primitive, words);
    Outlined drawn = drawn_by(reading, primitive);
    if (drawn.points.empty()) continue;
    for (Vec& p : drawn.points) p = p + shape.offset;
    figures.push_back(reading.figure(drawn, place, primitive));
  }
}

}  // namespace

void read_pad_shape(Reading& reading, Sexpr list, Sexpr kind, PadShape& shape) {
  if (kind) {
    const auto found =
        std::find_if(kind_names.begin(), kind_names.end(), [&](const KindName& k) { return k.name == kind.raw(); });
    if (found != kind_names.end())
      shape.kind = found->kind;
    else
      reading.warn("kicad.pad_shape", fmt::format("pad shape '{}' is not known; it is read as a rectangle", shown(kind.raw())),
                   list);
  }
  for (const Sexpr part : list) {
    if (!part.is_list()) continue;
    const std::string_view head = part.head();
    if (head == "size") {
      const Vec size = reading.vec(part);
      shape.size = {std::abs(size.x), std::abs(size.y)};
    } else if (head == "offset") {
      shape.offset = reading.vec(part);
    } else if (head == "rect_delta") {
      shape.delta = reading.vec(part);
    } else if (head == "roundrect_rratio") {
      shape.round_ratio = std::clamp(reading.number(part.arg(0)), 0.0, 0.5);
    } else if (head == "chamfer_ratio") {
      shape.chamfer_ratio = std::clamp(reading.number(part.arg(0)), 0.0, 0.5);
    } else if (head == "chamfer") {
      std::fill(std::begin(shape.chamfered), std::end(shape.chamfered), false);
      for (std::size_t i = 0; i < corner_names.size(); ++i) shape.chamfered[i] = part.has_word(corner_names[i]);
    } else if (head == "options") {
      shape.round_anchor = part.child("anchor").arg(0).raw() == "circle";
    } else if (head == "primitives") {
      shape.primitives = part;
    }
  }
}

std::vector<geometry::Figure> pad_figures(Reading& reading, const PadShape& shape, const Placement& place, Sexpr pad) {
  std::vector<geometry::Figure> figures;
  const auto add = [&](const Outlined& drawn) { figures.push_back(reading.figure(drawn, place, pad)); };
  const bool has_size = shape.size.x > 0 && shape.size.y > 0;
  const Vec half = 0.5 * shape.size;
  if (has_size) {
    switch (shape.kind) {
      case PadShape::Kind::circle:
        add(stadium(shape.offset, {shape.size.x, shape.size.x}));
        break;
      case PadShape::Kind::rectangle:
        add([&] {
          Outlined path = rectangle(shape.offset - half, shape.offset + half, 0);
          path.filled = true;
          return path;
        }());
        break;
      case PadShape::Kind::oval:
        add(stadium(shape.offset, shape.size));
        break;
      case PadShape::Kind::rounded: {
        const double side = std::min(shape.size.x, shape.size.y);
        add(cornered(shape.offset, shape.size, shape.round_ratio * side, shape.chamfer_ratio * side, shape.chamfered));
        break;
      }
      case PadShape::Kind::trapezoid:
        add(trapezoid(shape.offset, shape.size, shape.delta));
        break;
      case PadShape::Kind::custom:
        if (shape.round_anchor) {
          add(stadium(shape.offset, {shape.size.x, shape.size.x}));
        } else {
          Outlined path = rectangle(shape.offset - half, shape.offset + half, 0);
          path.filled = true;
          add(path);
        }
        break;
    }
  }
  if (shape.kind == PadShape::Kind::custom) append_primitives(reading, shape, place, figures);
  return figures;
}

}  // namespace pcbmesh::formats::kicad
