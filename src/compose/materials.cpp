// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/near_miss.hpp"

namespace pcbmesh::compose {
namespace {

using board::Material;

/// The library's values under the board's name.
Material renamed(const study::LibraryMaterial& from, std::string name) {
  return {.name = std::move(name),
          .eps_r = from.eps_r,
          .tan_delta = from.tan_delta,
          .mu_r = from.mu_r,
          .sigma_s_per_m = from.sigma_s_per_m,
          .dispersion = from.dispersion,
          .at_hz = from.at_hz.value_or(0),
          .roughness = from.roughness,
          .source = from.source};
}

bool is_dielectric(const Material& m) {
  constexpr double semiconductors_s_per_m = 1e3;
  return m.sigma_s_per_m < semiconductors_s_per_m;
}

std::string text_of(const Material& m) {
  if (!is_dielectric(m)) return fmt::format("{:.4g} S/m", m.sigma_s_per_m);
  return fmt::format("eps_r {:.4g}, tan delta {:.3g}{}", m.eps_r, m.tan_delta,
                     m.at_hz > 0 ? fmt::format(" at {:.4g} GHz", m.at_hz * 1e-9) : "");
}

}  // namespace

MaterialTable::MaterialTable(const board::Board& board, const study::Study& study, Diagnostics& diagnostics)
    : library_(study::builtin_materials()), frequency_hz_(study::highest_frequency_hz(study)) {
  const study::Materials& wanted = study.fabrication.materials;
  library_.insert(library_.end(), wanted.library.begin(), wanted.library.end());
  materials_.assign(board.materials().begin(), board.materials().end());
  choose(study);
  fill_in(board, diagnostics);
  if (wanted.stated.kind == DispersionKind::djordjevic_sarkar)
    for (Material& m : materials_)
      if (is_dielectric(m) && m.dispersion.kind == DispersionKind::constant && m.tan_delta > 0 && m.source.empty()) {
        m.dispersion = djordjevic_sarkar_through({m.eps_r, m.tan_delta}, wanted.stated.at_hz);
        m.at_hz = wanted.stated.at_hz;
      }
  for (Material& m : materials_) m = evaluated(std::move(m));
}

void MaterialTable::choose(const study::Study& study) {
  const auto add = [&](std::string text) { unknown_ += (unknown_.empty() ? "" : "; ") + std::move(text); };
  std::vector<std::string> own;
  for (const Material& m : materials_) own.push_back(m.name);
  for (const study::MaterialChoice& choice : study.fabrication.materials.choices) {
    const auto mine =
        std::find_if(materials_.begin(), materials_.end(), [&](const Material& m) { return m.name == choice.board; });
    const study::LibraryMaterial* taken = study::find_material(library_, choice.take);
    if (mine == materials_.end())
      add(fmt::format("the board has no material '{}'{}; `pcbmesh inspect` lists them", choice.board,
                      did_you_mean(choice.board, own)));
    if (taken == nullptr) add(fmt::format("no library has a material '{}'{}", choice.take, near(choice.take)));
    if (mine != materials_.end() && taken != nullptr) *mine = renamed(*taken, mine->name);
  }
}

std::vector<study::Fault> MaterialTable::layers_without_permittivity(const board::Board& board) const {
  std::vector<study::Fault> faults;
  for (const board::StackupLayer& layer : board.stackup()) {
    if (layer.kind == board::LayerKind::copper || layer.kind == board::LayerKind::solder_mask || layer.material < 0) continue;
    const Material& m = materials_[static_cast<std::size_t>(layer.material)];
    if (!m.is_assumed) continue;
    faults.push_back(
        {"/materials/use",
         fmt::format("layer '{0}' has no permittivity: the board does not state that of its material '{1}', nor does "
                     "the library know it, and a field solver can't guess; state it in the stackup, or name a "
                     "material: \"materials\": {{\"use\": [{{\"board\": \"{1}\", \"take\": \"FR-4\"}}]}}",
                     layer.name, m.name)});
  }
  return faults;
}

void MaterialTable::fill_in(const board::Board& board, Diagnostics& diagnostics) {
  for (Material& m : materials_) {
    if (!m.is_assumed) continue;
    if (const study::LibraryMaterial* found = study::find_material(library_, m.name)) {
      m = renamed(*found, m.name);
      diagnostics.assume(Severity::note, "compose.material_from_library",
                         fmt::format("the board does not state the permittivity of '{}'; the library's '{}' is taken: {} ({})",
                                     m.name, found->name, text_of(m), found->source),
                         {.file = board.source()});
    } else {
      diagnostics.assume(Severity::note, "compose.material_assumed",
                         fmt::format("the board does not state the permittivity of '{}', nor does the library know it: {}",
                                     m.name, text_of(m)),
                         {.file = board.source()});
    }
  }
}

Material MaterialTable::evaluated(Material material) const {
  if (material.dispersion.kind == DispersionKind::constant || !frequency_hz_) return material;
  const Permittivity value = permittivity_at(material.dispersion, {material.eps_r, material.tan_delta}, *frequency_hz_);
  material.eps_r = value.eps_r;
  material.tan_delta = value.tan_delta;
  material.at_hz = *frequency_hz_;
  return material;
}

std::int32_t MaterialTable::air() {
  Material air{.name = "air"};
  for (int copy = 2;; ++copy) {
    const auto found = std::find_if(materials_.begin(), materials_.end(), [&](const auto& m) { return m.name == air.name; });
    if (found == materials_.end()) break;
    if (found->eps_r == 1 && found->tan_delta == 0 && found->mu_r == 1 && found->sigma_s_per_m == 0)
      return static_cast<std::int32_t>(found - materials_.begin());
    air.name = fmt::format("air {}", copy);
  }
  materials_.push_back(std::move(air));
  return static_cast<std::int32_t>(materials_.size()) - 1;
}

std::int32_t MaterialTable::named(std::string_view name) {
  const auto own = std::find_if(materials_.begin(), materials_.end(), [&](const Material& m) { return m.name == name; });
  if (own != materials_.end()) return static_cast<std::int32_t>(own - materials_.begin());
  const study::LibraryMaterial* found = study::find_material(library_, name);
  if (found == nullptr) return -1;
  const auto added =
      std::find_if(materials_.begin(), materials_.end(), [&](const Material& m) { return m.name == found->name; });
  if (added != materials_.end()) return static_cast<std::int32_t>(added - materials_.begin());
  materials_.push_back(evaluated(renamed(*found, found->name)));
  return static_cast<std::int32_t>(materials_.size()) - 1;
}

std::string MaterialTable::near(std::string_view name) const {
  std::vector<std::string> names;
  for (const Material& m : materials_) names.push_back(m.name);
  for (const study::LibraryMaterial& m : library_) {
    names.push_back(m.name);
    names.insert(names.end(), m.aliases.begin(), m.aliases.end());
  }
  return did_you_mean(name, names);
}

}  // namespace pcbmesh::compose
