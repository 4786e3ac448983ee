// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/footprints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "formats/kicad/graphics.hpp"
#include "formats/kicad/pad_shape.hpp"
#include "formats/kicad/tracks.hpp"
#include "formats/kicad/zones.hpp"

namespace pcbmesh::formats::kicad {
namespace {

using board::ShapeKind;
using syntax::Sexpr;

constexpr std::array<std::string_view, 42> ignored_parts{"layer",
                                                         "at",
                                                         "attr",
                                                         "path",
                                                         "tags",
                                                         "descr",
                                                         "model",
                                                         "uuid",
                                                         "embedded_fonts",
                                                         "embedded_files",
                                                         "tstamp",
                                                         "tedit",
                                                         "sheetfile",
                                                         "sheetname",
                                                         "solder_mask_margin",
                                                         "solder_paste_margin",
                                                         "solder_paste_ratio",
                                                         "solder_paste_margin_ratio",
                                                         "duplicate_pad_numbers_are_jumpers",
                                                         "locked",
                                                         "placed",
                                                         "net_tie_pad_groups",
                                                         "group",
                                                         "clearance",
                                                         "zone_connect",
                                                         "thermal_width",
                                                         "thermal_gap",
                                                         "autoplace_cost90",
                                                         "autoplace_cost180",
                                                         "private_layers",
                                                         "generator",
                                                         "version",
                                                         "generator_version",
                                                         "component_classes",
                                                         "jumper_pad_groups",
                                                         "stackup",
                                                         "units",
                                                         "variant",
                                                         "point",
                                                         "zone_layer_connections",
                                                         "sheet",
                                                         "net_tie"};
constexpr std::array<std::string_view, 9> annotations{"fp_text", "fp_text_box", "property", "dimension", "table",
                                                      "image",   "target",      "barcode",  "gr_text"};
constexpr std::array<std::string_view, 47> pad_words{"at",
                                                     "size",
                                                     "drill",
                                                     "layers",
                                                     "net",
                                                     "net_name",
                                                     "uuid",
                                                     "tstamp",
                                                     "roundrect_rratio",
                                                     "chamfer_ratio",
                                                     "chamfer",
                                                     "rect_delta",
                                                     "options",
                                                     "primitives",
                                                     "padstack",
                                                     "remove_unused_layers",
                                                     "keep_end_layers",
                                                     "zone_layer_connections",
                                                     "pintype",
                                                     "pinfunction",
                                                     "die_length",
                                                     "die_delay",
                                                     "solder_mask_margin",
                                                     "solder_paste_margin",
                                                     "solder_paste_margin_ratio",
                                                     "solder_paste_ratio",
                                                     "clearance",
                                                     "zone_connect",
                                                     "thermal_width",
                                                     "thermal_gap",
                                                     "thermal_bridge_width",
                                                     "thermal_bridge_angle",
                                                     "property",
                                                     "tenting",
                                                     "teardrops",
                                                     "locked",
                                                     "status",
                                                     "offset",
                                                     "capping",
                                                     "covering",
                                                     "plugging",
                                                     "filling",
                                                     "backdrill",
                                                     "tertiary_drill",
                                                     "thermal_gap_ratio",
                                                     "sim_electrical_type",
                                                     "radius"};

struct Hole {
  Vec size{};    ///< millimetres; x = 0: none
  Vec offset{};  ///< of the copper
};

Hole read_hole(Reading& reading, Sexpr drill) {
  Hole hole;
  std::array<double, 2> numbers{};
  std::size_t count = 0;
  for (Sexpr part = drill.arg(0); part; part = part.next()) {
    if (part.is_list()) {
      if (part.head() == "offset") hole.offset = reading.vec(part);
    } else if (part.raw() != "oval" && count < 2) {
      numbers[count++] = reading.number(part);
    }
  }
  hole.size = {numbers[0], count == 2 ? numbers[1] : numbers[0]};
  return hole;
}

class PadReader {
 public:
  PadReader(Reading& reading, Sexpr pad, const Placement& footprint, const std::string& component)
      : reading_(reading), pad_(pad), component_(component), type_(pad.arg(1).raw()), net_(reading.net_of(pad)) {
    const Sexpr at = pad.child("at");
    position_ = footprint(reading.vec_of(pad, "at"));
    // A pad's angle is absolute: it holds its footprint's already.
    place_ = Placement(position_, at.arg(2) ? reading.number(at.arg(2)) : 0);
  }

  void run() {
    reading_.count_unknown(pad_, pad_words);
    if (pad_.child("drill")) hole_ = read_hole(reading_, pad_.child("drill"));
    copper_ = reading_.copper_of(pad_);
    shape_.offset = hole_.offset;
    read_pad_shape(reading_, pad_, pad_.arg(2), shape_);
    if (copper_ != 0 && has_copper()) add_copper();
    add_hole();
    add_pin();
  }

 private:
  /// An unplated hole has copper only where the pad is wider than its hole.
  [[nodiscard]] bool has_copper() const {
    if (type_ != "np_thru_hole") return true;
    return shape_.kind == PadShape::Kind::custom || shape_.size.x > hole_.size.x || shape_.size.y > hole_.size.y;
  }

  [[nodiscard]] bool goes_through() const { return type_ == "thru_hole" || type_ == "np_thru_hole"; }

  void add_copper() {
    const int last = reading_.layers.num_copper() - 1;
    std::vector<PadShape> shapes(static_cast<std::size_t>(last) + 1, shape_);
    std::vector<bool> own(shapes.size(), false);
    read_padstack(shapes, own);
    const bool remove = goes_through() && Reading::flag(pad_, "remove_unused_layers"),
               keep_ends = Reading::flag(pad_, "keep_end_layers");
    const Sexpr fill_layers = pad_.child("zone_layer_connections");
    LayerMask held = 0;
    for (Sexpr name = fill_layers.arg(0); name; name = name.next()) {
      const int index = reading_.layers.find(name.raw());
      if (index >= 0) held |= LayerMask{1} << index;
    }
    std::vector<geometry::Figure> front = pad_figures(reading_, shape_, place_, pad_);
    if (front.empty() && !pad_.child("padstack")) reading_.warn("kicad.no_area", "pad without area; skipped", pad_, position_);
    for (int layer = 0; layer <= last; ++layer) {
      if ((copper_ >> layer & 1) == 0) continue;
      const auto i = static_cast<std::size_t>(layer);
      std::vector<geometry::Figure> figures = own[i] ? pad_figures(reading_, shapes[i], place_, pad_) : front;
      const bool is_end = layer == 0 || layer == last;
      const bool optional = remove && !(is_end && keep_ends) && (held >> layer & 1) == 0;
      if (optional)
        reading_.optional_rings.push_back({layer, net_, ShapeKind::pad, std::move(figures), !fill_layers, pad_.line()});
      else
        for (geometry::Figure& figure : figures) reading_.add_copper(ShapeKind::pad, layer, net_, std::move(figure), pad_);
    }
  }

  void read_padstack(std::vector<PadShape>& shapes, std::vector<bool>& own) {
    for (const Sexpr layer : pad_.child("padstack")) {
      if (!layer.is_list() || layer.head() == "mode") continue;
      if (layer.head() != "layer") {
        reading_.count_unknown_list(layer);
        continue;
      }
      PadShape shape = shape_;
      // A layer's own entry starts from plain corners and no shift; the size stays the front's if absent.
      shape.offset = {};
      shape.delta = {};
      std::fill(std::begin(shape.chamfered), std::end(shape.chamfered), false);
      read_pad_shape(reading_, layer, layer.child("shape").arg(0), shape);
      const std::string_view name = layer.arg(0).raw();
      const int index = reading_.layers.find(name);
      if (name == "Inner") {
        for (std::size_t i = 1; i + 1 < shapes.size(); ++i) shapes[i] = shape, own[i] = true;
      } else if (index >= 0) {
        shapes[static_cast<std::size_t>(index)] = shape;
        own[static_cast<std::size_t>(index)] = true;
      } else {
        reading_.warn("kicad.unknown_layer", fmt::format("layer '{}' is not in the layer table; skipped", shown(name)), layer);
      }
    }
  }

  void add_hole() {
    const double narrow = std::min(hole_.size.x, hole_.size.y);
    if (!(narrow > 0)) {
      if (goes_through())
        reading_.warn("kicad.pad_without_hole", "through-hole pad without a drill; no hole is made", pad_, position_);
      return;
    }
    if (!goes_through()) {
      reading_.warn("kicad.hole_in_smd_pad", "surface-mount pad with a drill; the hole is not made", pad_, position_);
      return;
    }
    const double reach = (std::max(hole_.size.x, hole_.size.y) - narrow) / 2;
    const Vec arm = hole_.size.x >= hole_.size.y ? Vec{reach, 0} : Vec{0, reach};
    Outlined slot;
    slot.points = {Vec{} - arm, arm};
    if (!(reach > 0)) slot.points.pop_back();
    geometry::Figure figure = reading_.figure(slot, place_, pad_);
    const double ring = std::min(shape_.size.x, shape_.size.y);
    figure.pen = checked_drill(reading_, reading_.length(narrow, pad_), reading_.length(ring, pad_), pad_, position_);
    const bool plated = type_ == "thru_hole";
    reading_.add_drill({.figure = std::move(figure),
                        .first_copper = 0,
                        .last_copper = reading_.layers.num_copper() - 1,
                        .plated = plated,
                        .net = plated ? net_ : board::no_net,
                        .kind = ShapeKind::pad},
                       pad_);
    for (const Sexpr part : pad_)
      if (part.is_list() && (part.head() == "backdrill" || part.head() == "tertiary_drill"))
        reading_.warn("kicad.pad_backdrill", "backdrill of a pad is not read; its barrel is too long", part);
  }

  void add_pin() {
    const std::string number = pad_.arg(0).text();
    if (number.empty() || copper_ == 0 || type_ == "np_thru_hole") return;
    const int layer = goes_through() ? 0 : std::countr_zero(copper_);
    reading_.parts.pins.push_back({component_, number, net_, reading_.point(position_, pad_), layer});
  }

  Reading& reading_;
  Sexpr pad_;
  const std::string& component_;
  std::string_view type_;
  std::int32_t net_;
  Vec position_{};
  Placement place_{};
  Hole hole_{};
  LayerMask copper_ = 0;
  PadShape shape_{};
};

std::string reference_of(Sexpr footprint) {
  for (const Sexpr part : footprint) {
    if (!part.is_list()) continue;
    if (part.head() == "fp_text" && part.arg(0).raw() == "reference") return part.arg(1).text();
    if (part.head() == "property" && part.arg(0).raw() == "Reference") return part.arg(1).text();
  }
  return {};
}

}  // namespace

void read_footprint(Reading& reading, Sexpr footprint) {
  const Sexpr at = footprint.child("at");
  const Placement place(at ? reading.vec(at) : Vec{}, at.arg(2) ? reading.number(at.arg(2)) : 0);
  const std::string reference = reference_of(footprint);
  for (const Sexpr part : footprint) {
    if (!part.is_list()) continue;
    const std::string_view head = part.head();
    if (head == "pad")
      PadReader(reading, part, place, reference).run();
    else if (is_graphic(head))
      read_graphic(reading, place, part);
    else if (head == "zone")
      read_zone(reading, part);
    else if (std::find(annotations.begin(), annotations.end(), head) != annotations.end())
      skip_annotation(reading, part);
    else if (std::find(ignored_parts.begin(), ignored_parts.end(), head) == ignored_parts.end())
      reading.count_unknown_list(part);
  }
}

}  // namespace pcbmesh::formats::kicad
