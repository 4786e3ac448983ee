// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/tracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace pcbmesh::formats::kicad {
namespace {

using board::ShapeKind;
using syntax::Sexpr;

constexpr std::array<std::string_view, 13> track_words{"start",   "mid",  "end",    "width",  "layer",  "layers",
                                                       "net",     "uuid", "tstamp", "status", "locked", "solder_mask_margin",
                                                       "net_name"};
constexpr std::array<std::string_view, 24> via_words{"at",
                                                     "size",
                                                     "drill",
                                                     "layers",
                                                     "net",
                                                     "net_name",
                                                     "uuid",
                                                     "tstamp",
                                                     "status",
                                                     "locked",
                                                     "free",
                                                     "remove_unused_layers",
                                                     "keep_end_layers",
                                                     "start_end_only",
                                                     "zone_layer_connections",
                                                     "padstack",
                                                     "backdrill",
                                                     "tertiary_drill",
                                                     "tenting",
                                                     "capping",
                                                     "covering",
                                                     "plugging",
                                                     "filling",
                                                     "teardrops"};
constexpr std::array<std::string_view, 2> post_machining_words{"front_post_machining", "back_post_machining"};

void add_track(Reading& reading, Sexpr item, Outlined drawn) {
  const LayerMask copper = reading.copper_of(item);
  if (copper == 0) {
    reading.warn("kicad.track_off_copper", "track on no copper layer of this board; skipped", item);
    return;
  }
  drawn.pen = reading.number_of(item, "width").value_or(0);
  reading.add_copper(ShapeKind::track, copper, reading.net_of(item), reading.figure(drawn, Placement{}, item), item);
}

struct Span {
  int first = 0, last = 0;
};

/// Copper layers between two named ones, in order; the whole board if they can't be read.
Span span_of(Reading& reading, Sexpr layers, Sexpr item) {
  const Span whole{0, reading.layers.num_copper() - 1};
  const int a = reading.layers.find(layers.arg(0).raw()), b = reading.layers.find(layers.arg(1).raw());
  if (a < 0 || b < 0) {
    reading.warn("kicad.via_span",
                 fmt::format("hole from '{}' to '{}', which are not copper layers of this board; it is read as going through",
                             shown(layers.arg(0).raw()), shown(layers.arg(1).raw())),
                 item);
    return whole;
  }
  return {std::min(a, b), std::max(a, b)};
}

/// Diameter of the copper on every layer of the span.
std::vector<double> ring_sizes(Reading& reading, Sexpr item, Span span) {
  const double front = reading.number_of(item, "size").value_or(0);
  std::vector<double> sizes(static_cast<std::size_t>(reading.layers.num_copper()), front);
  const Sexpr padstack = item.child("padstack");
  for (const Sexpr layer : padstack) {
    if (!layer.is_list() || layer.head() == "mode") continue;
    const auto size = layer.head() == "layer" ? reading.number_of(layer, "size") : std::nullopt;
    if (!size) {
      reading.count_unknown_list(layer);
      continue;
    }
    const std::string_view name = layer.arg(0).raw();
    const int index = reading.layers.find(name);
    if (name == "Inner")
      for (int i = span.first + 1; i < span.last; ++i) sizes[static_cast<std::size_t>(i)] = *size;
    else if (index >= 0)
      sizes[static_cast<std::size_t>(index)] = *size;
    else
      reading.warn("kicad.unknown_layer", fmt::format("layer '{}' is not in the layer table; skipped", shown(name)), layer);
  }
  return sizes;
}

/// Holes drilled into the via afterwards: they take barrel and rings away again.
void read_later_drills(Reading& reading, Sexpr item, geometry::Point at, std::int32_t net) {
  for (const Sexpr part : item) {
    if (!part.is_list() || (part.head() != "backdrill" && part.head() != "tertiary_drill")) continue;
    const Nm tool = reading.length(reading.number_of(part, "size").value_or(0), part);
    if (tool <= 0 || !part.child("layers")) continue;
    const Span span = span_of(reading, part.child("layers"), part);
    reading.add_drill({.figure = geometry::disc(at, tool),
                       .first_copper = span.first,
                       .last_copper = span.last,
                       .plated = false,
                       .net = net,
                       .kind = ShapeKind::via,
                       .is_backdrill = true},
                      part);
  }
}

void add_ring(Reading& reading, Sexpr item, int layer, std::int32_t net, geometry::Figure ring, bool optional,
              Sexpr fill_layers) {
  if (!optional) {
    reading.add_copper(ShapeKind::via, layer, net, std::move(ring), item);
    return;
  }
  for (Sexpr name = fill_layers.arg(0); name; name = name.next())
    if (reading.layers.find(name.raw()) == layer) {
      reading.add_copper(ShapeKind::via, layer, net, std::move(ring), item);
      return;
    }
  if (ring.pen <= 0) return;
  reading.optional_rings.push_back({layer, net, ShapeKind::via, {std::move(ring)}, !fill_layers, item.line()});
}

}  // namespace

Nm checked_drill(Reading& reading, Nm tool, Nm copper, Sexpr item, Vec at) {
  if (tool >= thinnest_drill_nm) return tool;
  const Nm instead = copper >= 2 * thinnest_drill_nm ? std::min(spare_drill_nm, copper / 2) : thinnest_drill_nm;
  reading.warn("kicad.tiny_drill",
               fmt::format("drill of {} is no real tool; {} is used", format_length(tool), format_length(instead)), item, at);
  return instead;
}

void read_segment(Reading& reading, Sexpr item) {
  reading.count_unknown(item, track_words);
  Outlined drawn;
  drawn.points = {reading.vec_of(item, "start"), reading.vec_of(item, "end")};
  if (drawn.points[0] == drawn.points[1]) drawn.points.pop_back();
  add_track(reading, item, std::move(drawn));
}

void read_track_arc(Reading& reading, Sexpr item) {
  reading.count_unknown(item, track_words);
  add_track(reading, item,
            arc_by_points(reading.vec_of(item, "start"), reading.vec_of(item, "mid"), reading.vec_of(item, "end")));
}

ViaDefaults::ViaDefaults(Reading& reading, Sexpr root) {
  const Sexpr setup = root.child("setup");
  board_.via_mm = reading.number_of(setup, "via_drill").value_or(board_.via_mm);
  board_.micro_mm = reading.number_of(setup, "uvia_drill").value_or(board_.micro_mm);
  for (const Sexpr net_class : root) {
    if (!net_class.is_list() || net_class.head() != "net_class") continue;
    Drills drills = board_;
    drills.via_mm = reading.number_of(net_class, "via_drill").value_or(drills.via_mm);
    drills.micro_mm = reading.number_of(net_class, "uvia_drill").value_or(drills.micro_mm);
    if (net_class.arg(0).raw() == "Default") board_ = drills;
    for (const Sexpr add : net_class)
      if (add.is_list() && add.head() == "add_net") by_net_.insert_or_assign(add.arg(0).text(), drills);
  }
}

double ViaDefaults::drill_mm(const Reading& reading, std::int32_t net, bool micro) const {
  Drills drills = board_;
  if (net >= 0) {
    const auto found = by_net_.find(reading.parts.nets[static_cast<std::size_t>(net)]);
    if (found != by_net_.end()) drills = found->second;
  }
  return micro ? drills.micro_mm : drills.via_mm;
}

void read_via(Reading& reading, const ViaDefaults& defaults, Sexpr item) {
  for (const Sexpr part : item) {
    if (!part.is_list() || std::find(via_words.begin(), via_words.end(), part.head()) != via_words.end()) continue;
    if (std::find(post_machining_words.begin(), post_machining_words.end(), part.head()) != post_machining_words.end())
      reading.warn("kicad.post_machining", "counterbore or countersink of a via is not read; the via keeps its barrel there",
                   part);
    else
      reading.count_unknown_list(part);
  }
  const Vec place = reading.vec_of(item, "at");
  const geometry::Point at = reading.point(place, item);
  const std::int32_t net = reading.net_of(item);
  const bool micro = item.has_word("micro");
  const bool partial = micro || item.has_word("blind") || item.has_word("buried");
  const Span span = partial ? span_of(reading, item.child("layers"), item) : Span{0, reading.layers.num_copper() - 1};

  const std::vector<double> sizes = ring_sizes(reading, item, span);
  double drill = reading.number_of(item, "drill").value_or(0);
  if (!(drill > 0)) {
    drill = defaults.drill_mm(reading, net, micro);
    reading.diagnostics.assume(Severity::note, "kicad.via_default_drill", "via without a drill; the net class' drill is used",
                               reading.spot(item));
  }
  const Nm copper = reading.length(sizes[static_cast<std::size_t>(span.first)], item);
  const Nm tool = checked_drill(reading, reading.length(drill, item), copper, item, place);
  if (tool >= copper)
    reading.warn("kicad.drill_not_smaller", "hole as wide as its copper or wider: no ring is left", item, place);

  const bool remove = Reading::flag(item, "remove_unused_layers");
  const bool only_ends = Reading::flag(item, "start_end_only");
  const bool keep_ends = Reading::flag(item, "keep_end_layers");
  for (int layer = span.first; layer <= span.last; ++layer) {
    const bool is_end = layer == span.first || layer == span.last;
    if (only_ends && !is_end) continue;
    geometry::Figure ring = geometry::disc(at, reading.length(sizes[static_cast<std::size_t>(layer)], item));
    add_ring(reading, item, layer, net, std::move(ring), remove && !(is_end && keep_ends),
             item.child("zone_layer_connections"));
  }
  reading.add_drill({.figure = geometry::disc(at, tool),
                     .first_copper = span.first,
                     .last_copper = span.last,
                     .plated = true,
                     .net = net,
                     .kind = ShapeKind::via},
                    item);
  read_later_drills(reading, item, at, net);
}

}  // namespace pcbmesh::formats::kicad
