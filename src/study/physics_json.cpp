// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

#include "src/study/json_fields.hpp"

namespace pcbmesh::study {
namespace {

PortPlace read_place(const JsonValue& object) {
  object.allow_only({"pin", "point", "layer", "side"});
  PortPlace place;
  if (const auto field = object.find_set("pin")) place.pin = field->as_string();
  if (const auto field = object.find_set("point")) place.point = read_corner(*field);
  if (const auto field = object.find_set("layer")) place.layer = field->as_string();
  if (const auto field = object.find_set("side"))
    place.side = parsed(*field, [&] { return parse_hull_side(field->as_string()); });
  return place;
}

Port read_port(const JsonValue& object) {
  object.allow_only(
      {"note", "name", "kind", "net", "reference", "at", "shape", "impedance", "excited", "width", "height", "max_edge"});
  Port port;
  if (const auto field = object.find("note")) (void)field->as_string();
  port.name = object.at("name").as_string();
  read_choice(object, "kind", port_kind_names, port.kind);
  port.net = object.at("net").as_string();
  if (const auto field = object.find("reference")) port.reference = field->as_string();
  port.at = read_place(object.at("at"));
  read_choice(object, "shape", port_shape_names, port.shape);
  if (const auto field = object.find("impedance")) port.impedance_ohm = field->as_number();
  if (const auto field = object.find("excited")) port.excited = field->as_boolean();
  read_optional_length(object, "width", port.width);
  read_optional_length(object, "height", port.height);
  read_optional_length(object, "max_edge", port.max_edge);
  return port;
}

Boundary read_boundary(const JsonValue& field) {
  Boundary boundary;
  if (field.is(JsonKind::string)) {
    boundary.kind = parsed(field, [&] { return parse_boundary_kind(field.as_string()); });
    if (boundary.kind == BoundaryKind::impedance)
      field.fail("an impedance needs its ohms: {\"kind\": \"impedance\", \"ohms\": 377}");
    if (boundary.kind == BoundaryKind::pml)
      field.fail("perfectly matched layers need their thickness: {\"kind\": \"pml\", \"thickness\": \"3mm\"}");
    return boundary;
  }
  field.allow_only({"kind", "ohms", "thickness", "layers", "order", "backing"});
  (void)field.at("kind");
  read_choice(field, "kind", boundary_names, boundary.kind);
  if (const auto ohms = field.find("ohms")) boundary.ohms = ohms->as_number();
  const bool is_pml = boundary.kind == BoundaryKind::pml;
  for (const char* name : {"thickness", "layers", "order", "backing"})
    if (const auto other = field.find(name); other && !is_pml)
      other->fail("belongs to perfectly matched layers; take kind pml, or leave this out");
  if (!is_pml) return boundary;
  boundary.thickness = field.at("thickness").as_length(study_unit_mm);
  const auto count = [&](std::string_view name, int& into) {
    if (const auto number = field.find(name)) into = static_cast<int>(std::clamp<std::int64_t>(number->as_integer(), -1, 1000));
  };
  count("layers", boundary.layers);
  count("order", boundary.order);
  read_choice(field, "backing", boundary_names, boundary.backing);
  return boundary;
}

/// Number of the polygon's side that the name "side_3" means, from 1; 0 = none.
std::size_t polygon_side(std::string_view name) {
  constexpr std::string_view start = "side_";
  std::size_t number = 0;
  if (!name.starts_with(start)) return 0;
  const auto digits = name.substr(start.size());
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  constexpr std::size_t most_sides = 10'000;
  return fault == std::errc() && end == digits.data() + digits.size() && number <= most_sides ? number : 0;
}

void read_boundaries(const JsonValue& object, Study& study) {
  std::vector<std::string_view> names{"all", "xmin", "xmax", "ymin", "ymax", "zmin", "zmax", "side"};
  for (const JsonValue member : object)
    if (polygon_side(member.key()) > 0) names.push_back(member.key());
  object.allow_only(names);
  if (const auto field = object.find("all")) study.boundaries.fill(read_boundary(*field));
  for (std::size_t i = 0; i < num_hull_sides; ++i)
    if (const auto field = object.find(hull_side_names[i].name)) study.boundaries[i] = read_boundary(*field);
  for (const JsonValue member : object)
    if (const std::size_t number = polygon_side(member.key()); number > 0) {
      study.polygon_boundaries.resize(std::max(study.polygon_boundaries.size(), number));
      study.polygon_boundaries[number - 1] = read_boundary(member);
    }
}

Sweep read_sweep(const JsonValue& object) {
  object.allow_only({"from", "to", "points", "list"});
  Sweep sweep;
  if (const auto list = object.find_set("list")) {
    for (const char* other : {"from", "to", "points"})
      if (const auto field = object.find_set(other)) field->fail("a list of frequencies stands alone; leave this out");
    for (const JsonValue hz : list->as_array()) sweep.list_hz.push_back(read_frequency_hz(hz));
    if (sweep.list_hz.empty()) list->fail("the list is empty; name frequencies, or give from, to and points");
    return sweep;
  }
  sweep.from_hz = read_frequency_hz(object.at("from"));
  sweep.to_hz = read_frequency_hz(object.at("to"));
  sweep.points = object.at("points").as_integer();
  return sweep;
}

Json boundary_json(const Boundary& boundary) {
  if (boundary.kind == BoundaryKind::impedance) return {{"kind", name_of(boundary.kind)}, {"ohms", boundary.ohms}};
  if (boundary.kind == BoundaryKind::pml)
    return {{"kind", name_of(boundary.kind)},
            {"thickness", exact_length(boundary.thickness)},
            {"layers", boundary.layers},
            {"order", boundary.order},
            {"backing", name_of(boundary.backing)}};
  return name_of(boundary.kind);
}

Json place_json(const PortPlace& place) {
  if (place.point) {
    Json out{{"point", corner(*place.point)}};
    if (!place.layer.empty()) out["layer"] = place.layer;
    return out;
  }
  if (place.side) {
    Json out{{"side", name_of(*place.side)}};
    if (!place.layer.empty()) out["layer"] = place.layer;
    return out;
  }
  Json out{{"pin", place.pin}};
  if (!place.layer.empty()) out["layer"] = place.layer;
  return out;
}

Json port_json(const Port& port, const std::string& note) {
  Json out{{"name", port.name},
           {"kind", name_of(port.kind)},
           {"net", port.net},
           {"reference", port.reference},
           {"at", place_json(port.at)},
           {"shape", name_of(port.shape)},
           {"impedance", port.impedance_ohm},
           {"excited", port.excited},
           {"width", optional_length(port.width)}};
  if (port.kind == PortKind::wave) out["height"] = optional_length(port.height);
  out["max_edge"] = optional_length(port.max_edge);
  if (!note.empty()) out["note"] = note;
  return out;
}

Json all_ports_json(const Study& study, const StudyWords& words) {
  Json ports = Json::array();
  for (std::size_t i = 0; i < study.ports.size(); ++i)
    ports.push_back(port_json(study.ports[i], i < words.port_notes.size() ? words.port_notes[i] : ""));
  return ports;
}

}  // namespace

std::string ports_json(const Study& study, const StudyWords& words) {
  const std::string object = Json{{"ports", all_ports_json(study, words)}}.dump(2, ' ', false, Json::error_handler_t::replace);
  return object.substr(2, object.size() - 4) + "\n";  // without the braces: a member to paste
}

void read_physics(const JsonValue& root, Study& study) {
  read_choice(root, "problem", problem_names, study.problem);
  read_choice(root, "solver", solver_names, study.solver);
  if (const auto ports = root.find("ports"))
    for (const JsonValue entry : ports->as_array()) study.ports.push_back(read_port(entry));
  if (const auto object = root.find("boundaries")) read_boundaries(*object, study);
  if (const auto object = root.find_set("sweep")) study.sweep = read_sweep(*object);
  if (const auto object = root.find("modes")) {
    object->allow_only({"number", "above"});
    if (const auto field = object->find("number")) study.modes.number = field->as_integer();
    if (const auto field = object->find("above")) study.modes.above_hz = read_frequency_hz(*field);
  }
}

void write_physics(const Study& study, const StudyWords& words, Json& root) {
  root["problem"] = name_of(study.problem);
  root["solver"] = name_of(study.solver);
  root["ports"] = all_ports_json(study, words);
  Json& boundaries = root["boundaries"];
  for (std::size_t i = 0; i < num_hull_sides; ++i)
    boundaries[std::string(hull_side_names[i].name)] = boundary_json(study.boundaries[i]);
  for (std::size_t i = 0; i < study.polygon_boundaries.size(); ++i)
    boundaries[fmt::format("side_{}", i + 1)] = boundary_json(study.polygon_boundaries[i]);
  root["sweep"] = nullptr;
  if (study.sweep && !study.sweep->list_hz.empty()) {
    Json list = Json::array();
    for (const double hz : study.sweep->list_hz) list.push_back(frequency_json(hz));
    root["sweep"] = Json{{"list", std::move(list)}};
  }
  if (study.sweep && study.sweep->list_hz.empty())
    root["sweep"] = Json{{"from", frequency_json(study.sweep->from_hz)},
                         {"to", frequency_json(study.sweep->to_hz)},
                         {"points", study.sweep->points}};
  root["modes"] = Json{{"number", study.modes.number}, {"above", frequency_json(study.modes.above_hz)}};
}

}  // namespace pcbmesh::study
