// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/fabrication_options.hpp"

#include <fmt/format.h>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::cli {

std::shared_ptr<FabricationOptions> add_fabrication_options(CLI::App& command) {
  auto o = std::make_shared<FabricationOptions>();
  constexpr const char* making = "How the board is made";
  command.add_option("--vias", o->vias, "Plated holes: copper (filled), plated (tubes) or plugged:MATERIAL")->group(making);
  command.add_option("--plating", o->plating, "Wall of tubes (default 25um)")->group(making);
  command.add_option("--merge-vias", o->merge_vias, "Make blocks of vias of one net up to this pitch apart")->group(making);
  command.add_option("--etch", o->etch, "Etched copper as stairs: thickness over what either edge loses, e.g. 3")
      ->group(making);
  command.add_flag("--solder-mask", o->solder_mask, "Mesh the solder mask")->group(making);
  command.add_option("--materials", o->materials, "Material library JSON, before the program's own")
      ->check(CLI::ExistingFile)
      ->group(making);
  command
      .add_option("--max-unknowns", o->max_unknowns, "Refuse above this many first-order edge-element unknowns (default: none)")
      ->group(making);
  return o;
}

void take_fabrication_options(const FabricationOptions& o, study::Fabrication& f) {
  if (!o.vias.empty()) {
    const std::size_t colon = o.vias.find(':');
    f.vias.fill = study::parse_via_fill(o.vias.substr(0, colon));
    f.vias.plug = colon == std::string::npos ? "" : o.vias.substr(colon + 1);
  }
  if (!o.plating.empty()) f.vias.plating = parse_length(o.plating);
  if (!o.merge_vias.empty()) f.merge_vias = parse_length(o.merge_vias);
  if (o.etch != 0) f.etch = study::Etch{.factor = o.etch};
  if (o.solder_mask) f.solder_mask = true;
  if (!o.materials.empty()) {
    const std::vector<study::LibraryMaterial> library = study::read_materials(o.materials);
    f.materials.library.insert(f.materials.library.end(), library.begin(), library.end());
  }
  if (o.max_unknowns != 0) {
    if (!(o.max_unknowns >= 1 && o.max_unknowns < 1e15))
      throw Error(ErrorCode::usage, fmt::format("--max-unknowns {} is no count", o.max_unknowns));
    f.max_unknowns = static_cast<std::int64_t>(o.max_unknowns);
  }
}

}  // namespace pcbmesh::cli
