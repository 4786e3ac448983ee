// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/syntax/input_file.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/study/solver_needs.hpp"
#include "src/study/choices.hpp"
#include "src/study/fabrication_json.hpp"
#include "src/study/json_fields.hpp"

namespace pcbmesh::study {
namespace {

// ---- JSON -> Study -----------------------------------------------------------------------------------------------

void read_region(const JsonValue& object, Study& study) {
  object.allow_only({"kind", "nets", "margin", "box", "polygon"});
  if (const auto nets = object.find("nets"))
    for (JsonValue net : nets->as_array()) study.nets.emplace_back(net.as_string());
  if (const auto box = object.find_set("box")) {
    box->allow_only({"min", "max"});
    study.box = geometry::Box{read_corner(box->at("min")), read_corner(box->at("max"))};
  }
  if (const auto polygon = object.find_set("polygon"))
    for (const JsonValue point : polygon->as_array()) study.polygon.push_back(read_corner(point));
  read_length(object, "margin", study.margin);
  // Without a kind, what is given tells: a box or polygon bounds the domain, and nets named beside it are the nets of interest
  // in it.
  if (!object.find("kind")) {
    if (!study.nets.empty()) study.region = RegionKind::nets;
    if (study.box) study.region = RegionKind::box;
    if (!study.polygon.empty()) study.region = RegionKind::polygon;
  }
  read_choice(object, "kind", region_names, study.region);
}

void read_conductors(const JsonValue& object, Study& study) {
  object.allow_only({"mode", "rules", "surface"});
  read_choice(object, "surface", surface_names, study.conductor_surface);
  read_choice(object, "mode", conductor_names, study.conductors);
  const auto rules = object.find("rules");
  if (!rules) return;
  for (JsonValue entry : rules->as_array()) {
    entry.allow_only({"net", "layer", "mode"});
    ConductorRule rule;
    if (const auto net = entry.find("net")) rule.net = net->as_string();
    if (const auto layer = entry.find("layer")) rule.layer = layer->as_string();
    (void)entry.at("mode");
    read_choice(entry, "mode", conductor_names, rule.mode);
    study.conductor_rules.push_back(std::move(rule));
  }
}

void read_heights(const JsonValue& object, Study& study) {
  const auto number = [&](std::string_view name, std::optional<double>& into) {
    if (const auto field = object.find_set(name)) into = field->as_number();
  };
  // A count too large for int is too large for the range too: check() says so.
  const auto count = [&](std::string_view name, std::optional<int>& into) {
    if (const auto field = object.find_set(name))
      into = static_cast<int>(std::clamp<std::int64_t>(field->as_integer(), -1, std::numeric_limits<int>::max()));
  };
  const auto budget = [&](std::string_view name, std::optional<std::int64_t>& into) {
    if (const auto field = object.find_set(name)) into = field->as_integer();
  };
  if (const auto field = object.find("elements_per_wavelength"))
    study.height_bounds.elements_per_wavelength = field->as_number();
  count("elements_per_dielectric", study.height_bounds.elements_per_dielectric);
  count("skin_depth_layers", study.height_bounds.skin_depth_layers);
  number("height_growth", study.height_bounds.height_growth);
  number("target_quality", study.match.target_quality);
  budget("budget_prisms", study.match.budget_prisms);
  budget("budget_unknowns", study.match.budget_unknowns);
  if (const auto field = object.find("paper_compat")) study.paper_compat = field->as_boolean();
}

void read_mesh(const JsonValue& object, Study& study) {
  object.allow_only({"frequency", "longest_edge", "min_angle_deg", "edge_at_copper", "growth", "seed", "smooth",
                     "height_policy", "sublayers", "tolerance", "elements_per_wavelength", "elements_per_dielectric",
                     "skin_depth_layers", "height_growth", "target_quality", "budget_prisms", "budget_unknowns",
                     "paper_compat"});
  if (const auto field = object.find_set("frequency")) study.frequency_hz = read_frequency_hz(*field);
  read_optional_length(object, "longest_edge", study.longest_edge);
  read_optional_length(object, "edge_at_copper", study.edge_at_copper);
  read_optional_length(object, "tolerance", study.tolerance);
  if (const auto field = object.find("min_angle_deg")) study.min_angle_deg = field->as_number();
  if (const auto field = object.find("growth")) study.growth = field->as_number();
  read_choice(object, "seed", seed_names, study.seed);
  if (const auto field = object.find("smooth")) study.smooth = field->as_boolean();
  read_choice(object, "sublayers", sublayer_names, study.sublayers);
  read_heights(object, study);
  if (const auto policy = object.find("height_policy"))
    study.policy = parsed(*policy, [&] {
      return policy->is(JsonKind::number) ? parse_height_policy(std::to_string(policy->as_integer()))
                                          : parse_height_policy(policy->as_string());
    });
}

/// Anything beyond a few digits is out of range; check() says so.
int small_integer(const JsonValue& field) {
  return static_cast<int>(std::clamp<std::int64_t>(field.as_integer(), -1, 1000));
}

void read_output(const JsonValue& object, Study& study) {
  object.allow_only({"unit", "split", "order", "wedge_nodes"});
  read_choice(object, "split", split_names, study.split);
  if (const auto field = object.find("order")) study.order = small_integer(*field);
  if (const auto field = object.find("wedge_nodes")) study.wedge_nodes = small_integer(*field);
  if (const auto unit = object.find("unit")) study.unit = parsed(*unit, [&] { return parse_length_unit(unit->as_string()); });
}

void read_version(const JsonValue& root) {
  const JsonValue version = root.at("schema_version");
  if (version.as_integer() != Study::schema_version)
    version.fail(fmt::format("study schema version {} is not known; this program reads version {}", version.as_integer(),
                             Study::schema_version));
}

std::optional<JsonValue> element(const JsonValue& array, std::string_view number) {
  std::int64_t i = 0;
  for (const JsonValue value : array)
    if (number == std::to_string(i++)) return value;
  return std::nullopt;
}

/// check() names fields by JSON pointer; here the pointer becomes a line.
Spot spot_of(const JsonValue& root, std::string_view text) {
  JsonValue at = root;
  std::string_view rest = text.substr(0, text.find(':'));
  while (!rest.empty() && rest.front() == '/') {
    rest.remove_prefix(1);
    const std::string_view step = rest.substr(0, rest.find('/'));
    const auto next = at.is(JsonKind::object) ? at.find(step) : at.is(JsonKind::array) ? element(at, step) : std::nullopt;
    if (!next) break;
    at = *next;
    rest.remove_prefix(step.size());
  }
  return at.spot();
}

}  // namespace

// ---- shared with physics_json.cpp ---------------------------------------------------------------------------------

geometry::Point read_corner(const JsonValue& value) {
  if (value.as_array().size() != 2) value.fail("expected two lengths, [x, y]");
  auto it = value.begin();
  const Nm x = (*it).as_length(study_unit_mm);
  const Nm y = (*++it).as_length(study_unit_mm);
  return {x, y};
}

std::string exact_length(Nm value) {
  if (value % nm_per_mm == 0) return fmt::format("{}mm", value / nm_per_mm);
  if (value % nm_per_um == 0) return fmt::format("{}um", value / nm_per_um);
  return fmt::format("{}nm", value);
}

Json frequency_json(double hz) {
  struct Unit {
    double hz;
    const char* name;
  };
  for (const auto& [unit_hz, name] : {Unit{1e9, "GHz"}, Unit{1e6, "MHz"}, Unit{1e3, "kHz"}}) {
    // A number that is short and comes back as it was; any other is exact in hertz alone.
    const std::string text = fmt::format("{:.6g}{}", hz / unit_hz, name);
    if (hz >= unit_hz && parse_frequency_hz(text) == hz) return text;
  }
  return hz;
}

Json optional_length(const std::optional<Nm>& value) {
  return value ? Json(exact_length(*value)) : Json(nullptr);
}

template <typename Value>
Json optional_value(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json corner(geometry::Point p) {
  return Json::array({exact_length(p.x), exact_length(p.y)});
}

// --------------------------------------------------------------------------------------------------------------------

namespace {

Study study_of(const JsonValue& root, std::string_view file_name) {
  root.allow_only({"$schema", "schema_version", "note",       "region", "conductors",  "air",        "mesh",     "arcs",
                   "output",  "limits",         "problem",    "solver", "ports",       "boundaries", "sweep",    "modes",
                   "vias",    "backdrill",      "merge_vias", "etch",   "solder_mask", "fill",       "materials"});
  read_version(root);
  if (const auto field = root.find("$schema")) (void)field->as_string();
  if (const auto field = root.find("note")) (void)field->as_string();
  Study study;
  if (const auto object = root.find("region")) read_region(*object, study);
  if (const auto object = root.find("conductors")) read_conductors(*object, study);
  if (const auto object = root.find("air")) {
    object->allow_only({"above", "below", "around"});
    read_length(*object, "above", study.air_above);
    read_length(*object, "below", study.air_below);
    read_length(*object, "around", study.air_around);
  }
  if (const auto object = root.find("mesh")) read_mesh(*object, study);
  if (const auto object = root.find("arcs")) {
    object->allow_only({"sagitta", "mode"});
    read_length(*object, "sagitta", study.arcs.sagitta_nm);
    read_choice(*object, "mode", arc_names, study.arcs.mode);
  }
  if (const auto object = root.find("output")) read_output(*object, study);
  if (const auto object = root.find("limits")) {
    object->allow_only({"max_prisms", "max_unknowns"});
    if (const auto field = object->find("max_prisms")) study.max_prisms = field->as_integer();
  }
  read_physics(root, study);
  const auto output = root.find("output");
  if (needs_tetrahedra(study) && !(output && output->find("split"))) study.split = ElementSplit::tetrahedra;
  read_fabrication(root, std::filesystem::path(file_name).parent_path(), study.fabrication);
  return study;
}

}  // namespace

Study parse_study(std::string_view json, std::string_view file_name) {
  const JsonDocument document = JsonDocument::parse(json, file_name, ErrorCode::study_invalid);
  const JsonValue root = document.root();
  Study study = study_of(root, file_name);
  try {
    check(study);
  } catch (const Error& error) {
    throw Error(error.code(), error.text(), spot_of(root, error.text()));
  }
  return study;
}

Study read_study(const std::filesystem::path& file) {
  return parse_study(formats::syntax::read_whole_file(file), file.string());
}

Study read_unchecked_study(const std::filesystem::path& file) {
  const std::string text = formats::syntax::read_whole_file(file);
  const JsonDocument document = JsonDocument::parse(text, file.string(), ErrorCode::study_invalid);
  return study_of(document.root(), file.string());
}

std::string with_lines(std::string_view faults, const std::filesystem::path& file) {
  const std::string text = formats::syntax::read_whole_file(file);
  const JsonDocument document = JsonDocument::parse(text, file.string(), ErrorCode::study_invalid);
  std::string out;
  while (!faults.empty()) {
    const std::string_view one = faults.substr(0, faults.find('\n'));
    faults.remove_prefix(std::min(faults.size(), one.size() + 1));
    const std::size_t start = one.find_first_not_of(' '), colon = one.find(':');
    if (start != std::string_view::npos && one[start] == '/' && colon != std::string_view::npos)
      out += fmt::format("{} ({}:{})", one, file.filename().string(), spot_of(document.root(), one.substr(start)).line);
    else
      out += one;
    if (!faults.empty()) out += '\n';
  }
  return out;
}

std::string to_json(const Study& study) {
  return to_json(study, {});
}

std::string to_json(const Study& study, const StudyWords& words) {
  Json root;
  if (!words.schema.empty()) root["$schema"] = words.schema;
  root["schema_version"] = Study::schema_version;
  if (!words.note.empty()) root["note"] = words.note;
  Json& region = root["region"];
  region["kind"] = name_of(study.region);
  region["nets"] = study.nets;
  region["margin"] = exact_length(study.margin);
  region["box"] = nullptr;
  if (study.box) region["box"] = Json{{"min", corner(study.box->min)}, {"max", corner(study.box->max)}};
  region["polygon"] = nullptr;
  if (!study.polygon.empty()) {
    region["polygon"] = Json::array();
    for (const geometry::Point p : study.polygon) region["polygon"].push_back(corner(p));
  }
  Json& conductors = root["conductors"];
  conductors["mode"] = name_of(study.conductors);
  conductors["surface"] = name_of(study.conductor_surface);
  conductors["rules"] = Json::array();
  for (const ConductorRule& rule : study.conductor_rules)
    conductors["rules"].push_back(Json{{"net", rule.net}, {"layer", rule.layer}, {"mode", name_of(rule.mode)}});
  root["air"] = Json{{"above", exact_length(study.air_above)},
                     {"below", exact_length(study.air_below)},
                     {"around", exact_length(study.air_around)}};
  Json& mesh = root["mesh"];
  mesh["frequency"] = study.frequency_hz ? frequency_json(*study.frequency_hz) : Json(nullptr);
  mesh["longest_edge"] = optional_length(study.longest_edge);
  mesh["min_angle_deg"] = study.min_angle_deg;
  mesh["edge_at_copper"] = optional_length(study.edge_at_copper);
  mesh["growth"] = study.growth;
  mesh["seed"] = name_of(study.seed);
  mesh["smooth"] = study.smooth;
  mesh["height_policy"] = name_of(study.policy);
  mesh["sublayers"] = name_of(study.sublayers);
  mesh["elements_per_wavelength"] = study.height_bounds.elements_per_wavelength;
  mesh["elements_per_dielectric"] = optional_value(study.height_bounds.elements_per_dielectric);
  mesh["skin_depth_layers"] = optional_value(study.height_bounds.skin_depth_layers);
  mesh["height_growth"] = optional_value(study.height_bounds.height_growth);
  mesh["target_quality"] = optional_value(study.match.target_quality);
  mesh["budget_prisms"] = optional_value(study.match.budget_prisms);
  mesh["budget_unknowns"] = optional_value(study.match.budget_unknowns);
  mesh["paper_compat"] = study.paper_compat;
  mesh["tolerance"] = optional_length(study.tolerance);
  root["arcs"] = Json{{"sagitta", exact_length(study.arcs.sagitta_nm)}, {"mode", name_in(arc_names, study.arcs.mode)}};
  root["output"] = Json{{"unit", name_of(study.unit)},
                        {"split", name_of(study.split)},
                        {"order", study.order},
                        {"wedge_nodes", study.wedge_nodes}};
  root["limits"] = Json{{"max_prisms", study.max_prisms}};
  write_physics(study, words, root);
  write_fabrication(study.fabrication, root);
  // A net name may hold any bytes; those that are no UTF-8 are replaced rather than refused.
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pcbmesh::study
