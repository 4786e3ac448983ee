// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "pcbmesh/view/plots.hpp"
#include "pcbmesh/view/skin.hpp"
#include "src/view/report_page.hpp"

namespace pcbmesh::view {
namespace {

Json groups_json(const mesh::PrismMesh& mesh) {
  const std::vector<char> air = air_groups(mesh);
  const Paint by_net(mesh, ColourMode::net);
  Json groups = Json::array();
  for (std::size_t i = 0; i < mesh.volume_tags().size(); ++i) {
    const mesh::VolumeTag& tag = mesh.volume_tags()[i];
    groups.push_back({{"id", tag.id},
                      {"name", tag.name},
                      {"layer", tag.layer},
                      {"material", tag.material},
                      {"net", tag.net},
                      {"cells", tag.num_prisms},
                      {"volume_m3", tag.volume_m3},
                      {"air", air[i] != 0},
                      {"colour", hex(group_colour(static_cast<std::int32_t>(i)))},
                      {"net_colour", hex(by_net.of_group(static_cast<std::int32_t>(i)))}});
  }
  return groups;
}

Json face_tags_json(const mesh::PrismMesh& mesh) {
  Json tags = Json::array();
  for (std::size_t i = 0; i < mesh.face_tags().size(); ++i) {
    const mesh::FaceTag& tag = mesh.face_tags()[i];
    tags.push_back({{"id", tag.id},
                    {"name", tag.name},
                    {"kind", name_of(tag.kind)},
                    {"inner", tag.is_inner},
                    {"condition", name_of(tag.condition)},
                    {"triangles", tag.num_triangles},
                    {"quads", tag.num_quads},
                    {"area_m2", tag.area_m2},
                    {"colour", hex(group_colour(static_cast<std::int32_t>(i)))}});
  }
  return tags;
}

Json quality_json(const std::vector<layering::QualityGroup>& groups) {
  Json out = Json::array();
  for (const layering::QualityGroup& g : groups)
    out.push_back({g.name, g.num_prisms, g.volume_m3, g.mean_prism, g.volume_weighted_prism, g.min_prism, g.min_dihedral_deg,
                   g.max_aspect_ratio});
  return out;
}

/// "+y": the signed axis of a port's field, or its components where it runs askew.
std::string direction_text(const std::array<double, 3>& direction) {
  constexpr double along = 0.9999;
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(direction[k]) > along) return fmt::format("{}{}", direction[k] > 0 ? '+' : '-', "xyz"[k]);
  return fmt::format("{:.3f}, {:.3f}, {:.3f}", direction[0], direction[1], direction[2]);
}

Json ports_json(const mesh::PrismMesh& mesh) {
  Json ports = Json::array();
  const auto net = [&](std::int32_t i) { return i < 0 ? Json() : Json(mesh.nets()[static_cast<std::size_t>(i)]); };
  for (std::size_t i = 0; i < mesh.ports().size(); ++i) {
    const mesh::Port& p = mesh.ports()[i];
    Json tags = Json::array();
    for (std::size_t t = 0; t < mesh.face_tags().size(); ++t)
      if (mesh.face_tags()[t].port == static_cast<std::int32_t>(i)) tags.push_back(t);
    const bool is_lumped = p.kind == mesh::PortKind::lumped;
    ports.push_back({{"name", p.name},
                     {"kind", mesh::name_of(p.kind)},
                     {"impedance_ohm", p.impedance_ohm},
                     {"excited", p.is_excited},
                     {"direction", is_lumped                           ? Json(direction_text(p.direction))
                                   : p.kind == mesh::PortKind::coaxial ? Json("the radius, inwards")
                                                                       : Json()},
                     {"length_m", is_lumped ? Json(p.length_m) : Json()},
                     {"width_m", is_lumped ? Json(p.width_m) : Json()},
                     {"positive_net", net(p.positive_net)},
                     {"negative_net", net(p.negative_net)},
                     {"at_m", p.at_m},
                     {"tags", tags}});
  }
  return ports;
}

Json modes_json() {
  Json modes = Json::array();
  for (const ColourMode mode :
       {ColourMode::material, ColourMode::net, ColourMode::layer, ColourMode::group, ColourMode::face_tag,
        ColourMode::prism_quality, ColourMode::triangle_quality, ColourMode::size})
    modes.push_back({name_of(mode), title_of(mode)});
  return modes;
}

Json tables_json(const mesh::PrismMesh& mesh, const PageContents& contents, const PackedMesh& packed) {
  Json out = shared_tables(contents, packed);
  out["kind"] = "prisms";
  out.update(names_json(mesh.layers(), mesh.materials(), mesh.nets()));
  out["modes"] = modes_json();
  out["num_cells"] = mesh.num_prisms();
  out["groups"] = groups_json(mesh);
  out["face_tags"] = face_tags_json(mesh);
  out["ports"] = ports_json(mesh);
  out["z_m"] = mesh.plan().z_m();
  out["slab_of_sublayer"] = mesh.plan().slab_of_sublayer();
  out["columns"] = packed.columns;
  out["grid"] = {packed.x0_m, packed.y0_m, packed.step_m};
  out["quality"] = {{"layers", quality_json(contents.quality.layers)},
                    {"materials", quality_json(contents.quality.materials)},
                    {"nets", quality_json(contents.quality.nets)}};
  return out;
}

std::string plots_html(const mesh::PrismMesh& mesh, const PageContents& contents) {
  const layering::HeightStatistics heights = layering::height_statistics(mesh.planar());
  return shared_plots(contents) + figure(layer_heights_svg(mesh, heights)) + figure(height_sensitivity_svg(heights)) +
         figure(optimal_heights_svg(mesh, heights));
}

}  // namespace

std::vector<PagePlace> places_of(const validation::Report& report, double unit_m) {
  std::vector<PagePlace> out;
  for (const validation::Finding& finding : report.findings) {
    PagePlace place{finding.severity == validation::FindingSeverity::error ? "error" : "warning", finding.code, finding.text,
                    finding.count};
    for (const validation::Finding::Place& p : finding.places)
      place.at_m.push_back({p.at[0] * unit_m, p.at[1] * unit_m, p.at[2] * unit_m});
    out.push_back(std::move(place));
  }
  return out;
}

std::vector<PagePlace> places_of(const layering::QualityReport& quality) {
  std::vector<PagePlace> out;
  for (const layering::WorstPrism& worst : quality.worst)
    out.push_back({"quality",
                   "worst prism",
                   fmt::format("q_p {:.4f} in {}, height {:.3g} um", worst.quality, worst.group, worst.height_m * 1e6),
                   worst.num_sublayers,
                   {{worst.at_m[0], worst.at_m[1], worst.z_m}}});
  return out;
}

std::string report_html(const mesh::PrismMesh& mesh, const PageContents& contents) {
  const PackedMesh packed = pack(mesh);
  return fill_page(tables_json(mesh, contents, packed), packed, plots_html(mesh, contents), contents);
}

}  // namespace pcbmesh::view
