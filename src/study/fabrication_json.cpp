// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/study/fabrication_json.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "src/study/json_fields.hpp"

namespace pcbmesh::study {
namespace {

constexpr std::array<Choice<ViaFill>, 3> fill_names{
    {{ViaFill::copper, "copper"}, {ViaFill::plated, "plated"}, {ViaFill::plugged, "plugged"}}};
constexpr std::array<Choice<HoleKind>, 3> hole_names{{{HoleKind::any, "any"}, {HoleKind::via, "via"}, {HoleKind::pad, "pad"}}};
constexpr std::array<Choice<DispersionKind>, 2> stated_names{
    {{DispersionKind::constant, "constant"}, {DispersionKind::djordjevic_sarkar, "djordjevic_sarkar"}}};

void read_text(const JsonValue& object, std::string_view name, std::string& into) {
  if (const auto field = object.find(name)) into = field->as_string();
}

/// What is not named stays as `how` has it.
void read_hole_fill(const JsonValue& object, HoleFill& how) {
  read_choice(object, "fill", fill_names, how.fill);
  read_text(object, "plug", how.plug);
  if (const auto field = object.find("plating")) how.plating = field->as_length(study_unit_mm);
  if (const auto field = object.find("capped")) how.capped = field->as_boolean();
}

void read_vias(const JsonValue& object, Fabrication& into) {
  object.allow_only({"fill", "plug", "plating", "capped", "rules"});
  read_hole_fill(object, into.vias);
  const auto rules = object.find("rules");
  if (!rules) return;
  for (const JsonValue entry : rules->as_array()) {
    entry.allow_only({"net", "kind", "fill", "plug", "plating", "capped"});
    HoleRule rule{.how = into.vias};
    read_text(entry, "net", rule.net);
    read_choice(entry, "kind", hole_names, rule.kind);
    read_hole_fill(entry, rule.how);
    into.hole_rules.push_back(std::move(rule));
  }
}

void read_backdrills(const JsonValue& list, Fabrication& into) {
  for (const JsonValue entry : list.as_array()) {
    entry.allow_only({"net", "from", "to", "oversize"});
    Backdrill backdrill;
    read_text(entry, "net", backdrill.net);
    backdrill.from = entry.at("from").as_string();
    backdrill.to = entry.at("to").as_string();
    if (const auto field = entry.find("oversize")) backdrill.oversize = field->as_length(study_unit_mm);
    into.backdrills.push_back(std::move(backdrill));
  }
}

void read_materials_section(const JsonValue& object, const std::filesystem::path& folder, Materials& into) {
  object.allow_only({"file", "define", "use", "stated"});
  if (const auto file = object.find_set("file")) into.library = read_materials(folder / std::string(file->as_string()));
  if (const auto define = object.find("define"))
    for (const JsonValue entry : define->as_array()) into.library.push_back(read_material(entry));
  if (const auto use = object.find("use"))
    for (const JsonValue entry : use->as_array()) {
      entry.allow_only({"board", "take"});
      into.choices.push_back({std::string(entry.at("board").as_string()), std::string(entry.at("take").as_string())});
    }
  if (const auto stated = object.find("stated")) {
    stated->allow_only({"model", "at"});
    read_choice(*stated, "model", stated_names, into.stated.kind);
    if (const auto at = stated->find("at")) into.stated.at_hz = read_frequency_hz(*at);
  }
}

void put_hole_fill(Json& json, const HoleFill& how) {
  json["fill"] = name_of(how.fill);
  json["plug"] = how.plug;
  json["plating"] = exact_length(how.plating);
  json["capped"] = how.capped;
}

}  // namespace

std::string_view name_of(ViaFill value) {
  return name_in(fill_names, value);
}

ViaFill parse_via_fill(std::string_view text) {
  return value_in(fill_names, text, "via fill");
}

void read_fabrication(const JsonValue& root, const std::filesystem::path& folder, Fabrication& into) {
  if (const auto object = root.find("vias")) read_vias(*object, into);
  if (const auto list = root.find("backdrill")) read_backdrills(*list, into);
  if (const auto object = root.find_set("merge_vias")) {
    object->allow_only({"pitch"});
    into.merge_vias = object->at("pitch").as_length(study_unit_mm);
  }
  if (const auto object = root.find_set("etch")) {
    object->allow_only({"factor", "steps"});
    into.etch.emplace();
    if (const auto field = object->find("factor")) into.etch->factor = field->as_number();
    if (const auto field = object->find("steps")) into.etch->steps = static_cast<int>(field->as_integer());
  }
  if (const auto field = root.find("solder_mask")) into.solder_mask = field->as_boolean();
  if (const auto list = root.find("fill"))
    for (const JsonValue entry : list->as_array()) {
      entry.allow_only({"layer", "from"});
      into.gap_fills.push_back({std::string(entry.at("layer").as_string()), std::string(entry.at("from").as_string())});
    }
  if (const auto object = root.find("materials")) read_materials_section(*object, folder, into.materials);
  if (const auto limits = root.find("limits"))
    if (const auto field = limits->find_set("max_unknowns")) into.max_unknowns = field->as_integer();
}

void write_fabrication(const Fabrication& fabrication, Json& root) {
  Json& vias = root["vias"];
  put_hole_fill(vias, fabrication.vias);
  vias["rules"] = Json::array();
  constexpr std::string_view kinds[] = {"any", "via", "pad"};
  for (const HoleRule& rule : fabrication.hole_rules) {
    Json entry{{"net", rule.net}, {"kind", kinds[static_cast<int>(rule.kind)]}};
    put_hole_fill(entry, rule.how);
    vias["rules"].push_back(std::move(entry));
  }
  root["backdrill"] = Json::array();
  for (const Backdrill& b : fabrication.backdrills)
    root["backdrill"].push_back(Json{{"net", b.net}, {"from", b.from}, {"to", b.to}, {"oversize", exact_length(b.oversize)}});
  root["merge_vias"] = fabrication.merge_vias ? Json{{"pitch", exact_length(*fabrication.merge_vias)}} : Json(nullptr);
  root["etch"] =
      fabrication.etch ? Json{{"factor", fabrication.etch->factor}, {"steps", fabrication.etch->steps}} : Json(nullptr);
  root["solder_mask"] = fabrication.solder_mask;
  root["fill"] = Json::array();
  for (const GapFill& fill : fabrication.gap_fills) root["fill"].push_back(Json{{"layer", fill.layer}, {"from", fill.from}});
  Json& materials = root["materials"];
  materials["file"] = nullptr;  // what it held stands in "define", so that the resolved study needs no other file
  materials["define"] = Json::array();
  for (const LibraryMaterial& material : fabrication.materials.library) materials["define"].push_back(material_json(material));
  materials["use"] = Json::array();
  for (const MaterialChoice& choice : fabrication.materials.choices)
    materials["use"].push_back(Json{{"board", choice.board}, {"take", choice.take}});
  materials["stated"] =
      Json{{"model", name_of(fabrication.materials.stated.kind)}, {"at", frequency_json(fabrication.materials.stated.at_hz)}};
  root["limits"]["max_unknowns"] = fabrication.max_unknowns ? Json(*fabrication.max_unknowns) : Json(nullptr);
}

}  // namespace pcbmesh::study
