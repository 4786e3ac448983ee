// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "pcbmesh/view/cell_render.hpp"
#include "src/view/report_page.hpp"

namespace pcbmesh::view {
namespace {

/// Colours per mode, so that the page needs no rules of its own.
Json groups_json(const CellMesh& mesh) {
  std::vector<CellPaint> paints;
  for (const ColourMode mode : colour_modes_of(mesh))
    if (mode == ColourMode::net || mode == ColourMode::material) paints.emplace_back(mesh, mode);
  bool is_all_air = true;
  for (const CellGroup& g : mesh.groups()) is_all_air = is_all_air && g.is_air;
  Json groups = Json::array();
  for (std::size_t i = 0; i < mesh.groups().size(); ++i) {
    const CellGroup& g = mesh.groups()[i];
    const auto number = static_cast<std::int32_t>(i);
    const Rgb own = group_colour(number);
    groups.push_back({{"id", g.id},
                      {"name", g.name},
                      {"layer", g.layer},
                      {"material", g.material},
                      {"net", g.net},
                      {"cells", g.num_cells},
                      {"volume_m3", g.volume_m3},
                      {"mean_quality", g.mean_quality},
                      {"worst_quality", g.worst_quality},
                      {"air", g.is_air && !is_all_air},
                      {"band", g.band},
                      {"z_m", g.z_m},
                      {"colour", hex(own)},
                      {"net_colour", hex(own)}});
    for (const CellPaint& paint : paints)
      if (paint.mode() == ColourMode::net) groups.back()["net_colour"] = hex(paint.of_group(number));
  }
  return groups;
}

Json face_tags_json(const CellMesh& mesh) {
  Json tags = Json::array();
  for (std::size_t i = 0; i < mesh.face_tags().size(); ++i) {
    const CellFaceTag& tag = mesh.face_tags()[i];
    tags.push_back({{"id", tag.id},
                    {"name", tag.name},
                    {"kind", tag.kind},
                    {"inner", tag.is_inner},
                    {"faces", tag.num_faces},
                    {"colour", hex(group_colour(static_cast<std::int32_t>(i)))}});
  }
  return tags;
}

Json modes_json(const CellMesh& mesh) {
  Json modes = Json::array();
  for (const ColourMode mode : colour_modes_of(mesh)) modes.push_back({name_of(mode), title_of(mesh, mode)});
  return modes;
}

}  // namespace

std::vector<PagePlace> places_of(const CellMesh& mesh, const CellQuality& quality) {
  std::vector<PagePlace> out;
  for (const CellQuality::Worst& worst : quality.worst)
    out.push_back({"quality",
                   "worst cell",
                   fmt::format("cell {}: quality {:.4f} in {}", worst.cell, worst.quality,
                               mesh.groups()[static_cast<std::size_t>(worst.group)].name),
                   1,
                   {worst.at_m}});
  return out;
}

std::string report_html(const CellMesh& mesh, const PageContents& contents) {
  const PackedCells packed = pack(mesh);
  Json tables = shared_tables(contents, packed);
  tables["kind"] = "cells";
  tables.update(names_json(mesh.layers(), mesh.materials(), mesh.nets()));
  tables["modes"] = modes_json(mesh);
  tables["num_cells"] = mesh.num_cells();
  tables["num_bands"] = mesh.num_bands();
  tables["groups"] = groups_json(mesh);
  tables["face_tags"] = face_tags_json(mesh);
  tables["sides"] = packed.sides;
  tables["origin_m"] = packed.origin_m;
  tables["step_m"] = packed.step_m;
  tables["quality_step"] = packed.quality_step;
  tables["heights_m"] = packed.heights_m;
  return fill_page(tables, packed, shared_plots(contents), contents);
}

}  // namespace pcbmesh::view
