// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/native_json/board_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/native_json/format.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/near_miss.hpp"

namespace pcbmesh::formats::native_json {
namespace {

using syntax::JsonKind;
using syntax::JsonValue;

/// Materials that need no entry.
const board::Material built_in_copper{.name = "copper", .sigma_s_per_m = 5.8e7};
const board::Material built_in_air{.name = "air"};

/// One of several words, or an error that lists them.
std::size_t read_word(const JsonValue& value, std::initializer_list<std::string_view> words) {
  const std::string_view text = value.as_string();
  const auto found = std::find(words.begin(), words.end(), text);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const std::vector<std::string> names(words.begin(), words.end());
  value.fail(fmt::format("unknown word '{}'; choices are {}{}", text.substr(0, 60), fmt::join(names, ", "),
                         did_you_mean(text, names)));
}

}  // namespace

board::BoardParts BoardReader::read() {
  root_.allow_only({"$schema", "pcbmesh_board", "name", "note", "units", "materials", "stackup", "nets", "outline", "tracks",
                    "polygons", "pads", "vias", "holes", "planes"});
  read_head();
  read_materials();
  read_stackup();
  read_nets();
  read_outlines();
  each("tracks", [&](const JsonValue& v) { read_track(v); });
  each("polygons", [&](const JsonValue& v) { read_polygon(v); });
  each("pads", [&](const JsonValue& v) { read_pad(v); });
  each("vias", [&](const JsonValue& v) { read_via(v); });
  each("holes", [&](const JsonValue& v) { read_hole(v); });
  each("planes", [&](const JsonValue& v) { read_plane(v); });
  return std::move(parts_);
}

void BoardReader::read_head() {
  const JsonValue version = root_.at("pcbmesh_board");
  if (version.as_integer() != format_version)
    version.fail(fmt::format("board format version {} is not known; this program reads version {}", version.as_integer(),
                             format_version));
  for (std::string_view field : {"$schema", "note"})
    if (const auto text = root_.find(field)) (void)text->as_string();
  if (const auto name = root_.find("name")) parts_.name = name->as_string();
  if (const auto units = root_.find("units")) {
    constexpr std::array<double, 4> millimetres{1.0, 1e-3, 0.0254, 25.4};
    unit_.mm = millimetres[read_word(*units, {"mm", "um", "mil", "in"})];
  }
}

void BoardReader::read_materials() {
  each("materials", [&](const JsonValue& entry) {
    entry.allow_only({"name", "eps_r", "tan_delta", "mu_r", "sigma", "note"});
    board::Material material{.name = std::string(entry.at("name").as_string())};
    if (material.name.empty()) entry.at("name").fail("a material needs a name");
    for (const board::Material& other : parts_.materials)
      if (other.name == material.name) entry.fail(fmt::format("two materials are called '{}'", material.name.substr(0, 60)));
    if (const auto value = entry.find("eps_r")) material.eps_r = value->as_number();
    if (const auto value = entry.find("tan_delta")) material.tan_delta = value->as_number();
    if (const auto value = entry.find("mu_r")) material.mu_r = value->as_number();
    if (const auto value = entry.find("sigma")) material.sigma_s_per_m = value->as_number();
    parts_.materials.push_back(std::move(material));
  });
}

std::int32_t BoardReader::material_named(const JsonValue& name) {
  const std::string_view wanted = name.as_string();
  std::vector<std::string> known;
  for (std::size_t i = 0; i < parts_.materials.size(); ++i) {
    if (parts_.materials[i].name == wanted) return static_cast<std::int32_t>(i);
    known.push_back(parts_.materials[i].name);
  }
  for (const board::Material* material : {&built_in_copper, &built_in_air}) {
    known.push_back(material->name);
    if (material->name != wanted) continue;
    parts_.materials.push_back(*material);
    return static_cast<std::int32_t>(parts_.materials.size()) - 1;
  }
  name.fail(ErrorCode::stackup_invalid,
            fmt::format("no material is called '{}'{}", wanted.substr(0, 60), did_you_mean(wanted, known)));
}

void BoardReader::read_stackup() {
  const JsonValue stackup = root_.at("stackup");
  for (JsonValue entry : stackup.as_array()) {
    entry.allow_only({"name", "kind", "thickness", "material", "note"});
    board::StackupLayer layer;
    layer.name = entry.at("name").as_string();
    if (layer.name.empty()) entry.at("name").fail(ErrorCode::stackup_invalid, "a layer needs a name");
    for (const board::StackupLayer& other : parts_.stackup)
      if (other.name == layer.name)
        entry.at("name").fail(ErrorCode::stackup_invalid, fmt::format("two layers are called '{}'", layer.name.substr(0, 60)));
    constexpr std::array kinds{board::LayerKind::copper, board::LayerKind::dielectric, board::LayerKind::solder_mask};
    layer.kind = kinds[read_word(entry.at("kind"), {"copper", "dielectric", "solder_mask"})];
    const JsonValue thickness = entry.at("thickness");
    layer.thickness_nm = thickness.as_length(unit_.mm);
    if (layer.thickness_nm <= 0)
      thickness.fail(ErrorCode::stackup_invalid,
                     fmt::format("{} is no thickness; every layer needs one above 0", format_length(layer.thickness_nm)));
    if (const auto material = entry.find("material")) {
      layer.material = material_named(*material);
    } else if (layer.kind == board::LayerKind::copper) {
      layer.material = -1;  // settled below: "copper", once it is known whether the file defines one
    } else {
      (void)entry.at("material");
    }
    if (layer.kind == board::LayerKind::copper) copper_names_.push_back(layer.name);
    parts_.stackup.push_back(std::move(layer));
  }
  if (copper_names_.empty()) stackup.fail(ErrorCode::stackup_invalid, "the stackup has no copper layer");
  for (board::StackupLayer& layer : parts_.stackup) {
    if (layer.material >= 0) continue;
    const auto found = std::find_if(parts_.materials.begin(), parts_.materials.end(),
                                    [](const auto& m) { return m.name == built_in_copper.name; });
    layer.material = static_cast<std::int32_t>(found - parts_.materials.begin());
    if (found == parts_.materials.end()) parts_.materials.push_back(built_in_copper);
  }
}

void BoardReader::read_nets() {
  nets_are_listed_ = root_.find("nets").has_value();
  each("nets", [&](const JsonValue& entry) {
    const std::string name(entry.as_string());
    if (name.empty()) entry.fail("a net needs a name; copper without a net has no field 'net'");
    if (!nets_.emplace(name, static_cast<std::int32_t>(parts_.nets.size())).second)
      entry.fail(ErrorCode::board_invalid, fmt::format("net '{}' is listed twice", name.substr(0, 60)));
    parts_.nets.push_back(name);
  });
}

std::int32_t BoardReader::net_of(const JsonValue& object) {
  const auto field = object.find_set("net");
  if (!field) return board::no_net;
  const std::string_view name = field->as_string();
  if (name.empty()) field->fail("a net needs a name; leave the field out for copper without a net");
  if (const auto found = nets_.find(name); found != nets_.end()) return found->second;
  if (nets_are_listed_)
    field->fail(ErrorCode::board_invalid,
                fmt::format("net '{}' is not in the list \"nets\"{}", name.substr(0, 60), did_you_mean(name, parts_.nets)));
  const auto index = static_cast<std::int32_t>(parts_.nets.size());
  parts_.nets.emplace_back(name);
  nets_.emplace(std::string(name), index);
  return index;
}

std::int32_t BoardReader::copper_layer(const JsonValue& name) const {
  const std::string_view wanted = name.as_string();
  const auto found = std::find(copper_names_.begin(), copper_names_.end(), wanted);
  if (found != copper_names_.end()) return static_cast<std::int32_t>(found - copper_names_.begin());
  std::string remedy = did_you_mean(wanted, copper_names_);
  if (remedy.empty()) remedy = fmt::format("; copper layers are {}", fmt::join(copper_names_, ", "));
  name.fail(ErrorCode::board_invalid, fmt::format("no copper layer is called '{}'{}", wanted.substr(0, 60), remedy));
}

std::pair<std::int32_t, std::int32_t> BoardReader::span_of(const JsonValue& object) const {
  const auto field = object.find_set("layers");
  if (!field) return {0, static_cast<std::int32_t>(copper_names_.size()) - 1};
  if (field->as_array().size() != 2) field->fail("expected the first and the last copper layer, [from, to]");
  auto it = field->begin();
  const std::int32_t a = copper_layer(*it);
  const std::int32_t b = copper_layer(*++it);
  return {std::min(a, b), std::max(a, b)};
}

std::vector<Hole> BoardReader::holes_of(const JsonValue& object) const {
  std::vector<Hole> holes;
  const auto field = object.find("holes");
  if (!field) return holes;
  for (JsonValue entry : field->as_array()) {
    entry.allow_only({"points", "rect", "circle", "slot", "note"});
    holes.push_back({read_area(entry, unit_), fmt::format("the hole {}", entry.pointer()), entry.line()});
  }
  return holes;
}

void BoardReader::read_outlines() {
  const auto field = root_.find_set("outline");
  if (!field) return;
  if (!field->is(JsonKind::array)) return read_outline(*field);
  for (JsonValue entry : *field) read_outline(entry);
}

void BoardReader::read_outline(const JsonValue& object) {
  object.allow_only({"points", "rect", "circle", "slot", "cutouts", "note"});
  board::Outline outline{read_area(object, unit_), {}};
  if (const auto cutouts = object.find("cutouts"))
    for (JsonValue entry : cutouts->as_array()) {
      entry.allow_only({"points", "rect", "circle", "slot", "note"});
      outline.cutouts.push_back(read_area(entry, unit_));
    }
  parts_.outlines.push_back(std::move(outline));
}

void BoardReader::read_track(const JsonValue& object) {
  object.allow_only({"layer", "net", "width", "points", "note"});
  board::Shape shape{.copper_layer = copper_layer(object.at("layer")),
                     .net = net_of(object),
                     .kind = board::ShapeKind::track,
                     .figure = {},
                     .line = object.line()};
  const JsonValue points = object.at("points");
  shape.figure.path = read_path(points, unit_, false);
  if (shape.figure.path.points.size() < 2) points.fail("a track needs two points at least");
  shape.figure.pen = read_positive(object.at("width"), unit_);
  parts_.shapes.push_back(std::move(shape));
}

void BoardReader::read_polygon(const JsonValue& object) {
  object.allow_only({"layer", "net", "kind", "points", "rect", "circle", "slot", "holes", "note"});
  constexpr std::array kinds{board::ShapeKind::fill, board::ShapeKind::pad, board::ShapeKind::track, board::ShapeKind::graphic};
  board::Shape shape{.copper_layer = copper_layer(object.at("layer")),
                     .net = net_of(object),
                     .kind = board::ShapeKind::fill,
                     .figure = {},
                     .line = object.line()};
  if (const auto kind = object.find("kind")) shape.kind = kinds[read_word(*kind, {"fill", "pad", "track", "graphic"})];
  shape.figure = {cut_holes(read_area(object, unit_), holes_of(object), object), 0, true};
  parts_.shapes.push_back(std::move(shape));
}

void BoardReader::read_plane(const JsonValue& object) {
  object.allow_only({"layer", "net", "points", "rect", "circle", "slot", "holes", "clearance", "note"});
  constexpr Nm default_clearance_nm = 200 * nm_per_um;
  const std::int32_t layer = copper_layer(object.at("layer"));
  const std::int32_t net = net_of(object);
  Nm clearance = default_clearance_nm;
  if (const auto field = object.find("clearance")) {
    clearance = field->as_length(unit_.mm);
    if (clearance < 0) field->fail(ErrorCode::input_number, "a clearance can't be negative");
  }
  std::vector<geometry::Path> areas;
  if (has_area(object)) {
    areas.push_back(read_area(object, unit_));
  } else {
    for (const board::Outline& outline : parts_.outlines) areas.push_back(outline.outer);
    if (areas.empty())
      object.fail(
          "a plane without an area covers the board outline, but the board has none; give points, rect, circle or slot");
  }
  if (areas.size() > 1)
    object.fail(
        "a plane without an area covers the board outline, but the board has several; give one plane with its area for each");
  std::vector<Hole> holes = holes_of(object);
  add_antipads(object, layer, net, clearance, areas.front(), holes);
  parts_.shapes.push_back({.copper_layer = layer,
                           .net = net,
                           .kind = board::ShapeKind::fill,
                           .figure = {cut_holes(std::move(areas.front()), holes, object), 0, true},
                           .line = object.line()});
}

}  // namespace pcbmesh::formats::native_json
