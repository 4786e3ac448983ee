// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>

#include "formats/syntax/input_file.hpp"
#include "src/study/fabrication_json.hpp"
#include "src/study/json_fields.hpp"
#include "src/study/library_text.hpp"

namespace pcbmesh::study {
namespace {

constexpr int materials_version = 1;

constexpr std::array<Choice<DispersionKind>, 3> model_names{{{DispersionKind::constant, "constant"},
                                                             {DispersionKind::djordjevic_sarkar, "djordjevic_sarkar"},
                                                             {DispersionKind::debye, "debye"}}};
constexpr std::array<Choice<RoughnessKind>, 4> roughness_names{{{RoughnessKind::none, "none"},
                                                                {RoughnessKind::hammerstad, "hammerstad"},
                                                                {RoughnessKind::groisse, "groisse"},
                                                                {RoughnessKind::huray, "huray"}}};

template <typename Value, std::size_t N>
Value choice(const JsonValue& field, const std::array<Choice<Value>, N>& choices, std::string_view what) {
  return parsed(field, [&] { return value_in(choices, field.as_string(), what); });
}

double hertz(const JsonValue& field) {
  const double value = read_frequency_hz(field);
  if (!(value > 0)) field.fail("expected a frequency above 0");
  return value;
}

double number(const JsonValue& object, std::string_view name, double otherwise, double least, double most) {
  const auto field = object.find(name);
  if (!field) return otherwise;
  const double value = field->as_number();
  if (!(value >= least && value <= most)) field->fail(fmt::format("{} is out of range; expected {} to {}", value, least, most));
  return value;
}

double metres(const JsonValue& object, std::string_view name) {
  const JsonValue field = object.at(name);
  const double value = static_cast<double>(field.as_length(1.0)) * metres_per_nm;
  if (!(value > 0)) field.fail("expected a length above 0");
  return value;
}

Dispersion read_model(const JsonValue& object, const LibraryMaterial& material) {
  const DispersionKind kind = choice(object.at("kind"), model_names, "model");
  Dispersion model{.kind = kind};
  if (kind == DispersionKind::constant) {
    object.allow_only({"kind"});
  } else if (kind == DispersionKind::debye) {
    object.allow_only({"kind", "eps_inf", "poles"});
    (void)object.at("eps_inf");
    model.eps_inf = number(object, "eps_inf", 1, 1, 1e6);
    for (const JsonValue entry : object.at("poles").as_array()) {
      entry.allow_only({"delta_eps", "relaxation"});
      (void)entry.at("delta_eps");
      model.poles.push_back({number(entry, "delta_eps", 0, 1e-12, 1e6), hertz(entry.at("relaxation"))});
    }
    if (model.poles.empty()) object.fail("a Debye model needs at least one pole");
  } else {
    object.allow_only({"kind", "eps_inf", "slope", "low", "high"});
    const auto low = object.find("low"), high = object.find("high");
    model.low_hz = low ? hertz(*low) : 1e3;
    model.high_hz = high ? hertz(*high) : 1e12;
    if (model.high_hz <= model.low_hz) object.fail("'high' must lie above 'low'");
    if (object.find("slope")) {
      (void)object.at("eps_inf");
      model.eps_inf = number(object, "eps_inf", 1, 0, 1e6);
      model.slope = number(object, "slope", 0, 0, 1e6);
    } else {
      if (!material.at_hz || !(material.tan_delta > 0))
        object.fail("without 'slope' the model goes through eps_r and tan_delta: give these, above 0, and 'at'");
      if (*material.at_hz <= model.low_hz || *material.at_hz >= model.high_hz)
        object.fail("'at' must lie between 'low' and 'high'");
      model = djordjevic_sarkar_through({material.eps_r, material.tan_delta}, *material.at_hz, model.low_hz, model.high_hz);
    }
  }
  return model;
}

Roughness read_roughness(const JsonValue& object) {
  Roughness roughness{.kind = choice(object.at("kind"), roughness_names, "roughness")};
  switch (roughness.kind) {
    case RoughnessKind::none:
      object.allow_only({"kind"});
      break;
    case RoughnessKind::hammerstad:
    case RoughnessKind::groisse:
      object.allow_only({"kind", "rms"});
      roughness.rms_m = metres(object, "rms");
      break;
    case RoughnessKind::huray:
      object.allow_only({"kind", "nodule_radius", "surface_ratio"});
      roughness.nodule_radius_m = metres(object, "nodule_radius");
      (void)object.at("surface_ratio");
      roughness.surface_ratio = number(object, "surface_ratio", 0, 0, 1e3);
      break;
  }
  return roughness;
}

/// Letters and digits alone, in lower case.
std::string plain(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z')
      text += static_cast<char>(c + 32);
    else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80)
      text += c;
  }
  return text;
}

}  // namespace

LibraryMaterial read_material(const JsonValue& object) {
  object.allow_only(
      {"name", "aliases", "eps_r", "tan_delta", "at", "mu_r", "sigma_s_per_m", "model", "roughness", "source", "note"});
  LibraryMaterial material;
  material.name = object.at("name").as_string();
  if (material.name.empty()) object.at("name").fail("a material needs a name");
  if (const auto aliases = object.find("aliases"))
    for (const JsonValue alias : aliases->as_array()) material.aliases.emplace_back(alias.as_string());
  material.eps_r = number(object, "eps_r", 1, 1, 1e6);
  material.tan_delta = number(object, "tan_delta", 0, 0, 1e3);
  material.mu_r = number(object, "mu_r", 1, 1e-6, 1e7);
  material.sigma_s_per_m = number(object, "sigma_s_per_m", 0, 0, 1e12);
  if (const auto at = object.find_set("at")) material.at_hz = hertz(*at);
  if (const auto model = object.find_set("model")) {
    material.dispersion = read_model(*model, material);
    if (material.dispersion.kind != DispersionKind::constant && !object.find("eps_r") && material.at_hz) {
      const Permittivity value = permittivity_at(material.dispersion, {}, *material.at_hz);
      material.eps_r = value.eps_r;
      material.tan_delta = value.tan_delta;
    }
  }
  if (const auto roughness = object.find_set("roughness")) material.roughness = read_roughness(*roughness);
  if (const auto source = object.find("source")) material.source = source->as_string();
  return material;
}

Json material_json(const LibraryMaterial& m) {
  Json out{{"name", m.name}, {"aliases", m.aliases}, {"eps_r", m.eps_r}, {"tan_delta", m.tan_delta}};
  out["at"] = m.at_hz ? Json(*m.at_hz) : Json(nullptr);
  out["mu_r"] = m.mu_r;
  out["sigma_s_per_m"] = m.sigma_s_per_m;
  const Dispersion& d = m.dispersion;
  Json model{{"kind", name_of(d.kind)}};
  if (d.kind == DispersionKind::djordjevic_sarkar)
    model.update(Json{{"eps_inf", d.eps_inf}, {"slope", d.slope}, {"low", d.low_hz}, {"high", d.high_hz}});
  if (d.kind == DispersionKind::debye) {
    model["eps_inf"] = d.eps_inf;
    for (const DebyePole& pole : d.poles)
      model["poles"].push_back(Json{{"delta_eps", pole.delta_eps}, {"relaxation", pole.relaxation_hz}});
  }
  out["model"] = std::move(model);
  Json roughness{{"kind", name_of(m.roughness.kind)}};
  const auto nanometres = [](double length_m) { return fmt::format("{}nm", std::llround(length_m / metres_per_nm)); };
  if (m.roughness.kind == RoughnessKind::hammerstad || m.roughness.kind == RoughnessKind::groisse)
    roughness["rms"] = nanometres(m.roughness.rms_m);
  if (m.roughness.kind == RoughnessKind::huray) {
    roughness["nodule_radius"] = nanometres(m.roughness.nodule_radius_m);
    roughness["surface_ratio"] = m.roughness.surface_ratio;
  }
  out["roughness"] = std::move(roughness);
  out["source"] = m.source;
  return out;
}

std::vector<LibraryMaterial> parse_materials(std::string_view json, std::string_view file_name) {
  const JsonDocument document = JsonDocument::parse(json, file_name, ErrorCode::study_invalid);
  const JsonValue root = document.root();
  root.allow_only({"$schema", "schema_version", "note", "materials"});
  const JsonValue version = root.at("schema_version");
  if (version.as_integer() != materials_version)
    version.fail(fmt::format("material file version {} is not known; this program reads version {}", version.as_integer(),
                             materials_version));
  std::vector<LibraryMaterial> library;
  std::set<std::string> names;
  for (const JsonValue entry : root.at("materials").as_array()) {
    library.push_back(read_material(entry));
    std::set<std::string> own{plain(library.back().name)};
    for (const std::string& alias : library.back().aliases) own.insert(plain(alias));
    for (const std::string& name : own)
      if (!names.insert(name).second) entry.fail(fmt::format("the name '{}' is taken by an earlier material", name));
  }
  return library;
}

std::vector<LibraryMaterial> read_materials(const std::filesystem::path& file) {
  return parse_materials(formats::syntax::read_whole_file(file), file.string());
}

std::vector<LibraryMaterial> builtin_materials() {
  return parse_materials(library_text, "built-in materials");
}

const LibraryMaterial* find_material(const std::vector<LibraryMaterial>& library, std::string_view name) {
  const std::string wanted = plain(name);
  if (wanted.empty()) return nullptr;
  for (std::size_t i = library.size(); i-- > 0;) {
    if (plain(library[i].name) == wanted) return &library[i];
    for (const std::string& alias : library[i].aliases)
      if (plain(alias) == wanted) return &library[i];
  }
  return nullptr;
}

}  // namespace pcbmesh::study
