// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/report.hpp"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "pcbmesh/base/version.hpp"
#include "pcbmesh/view/paint.hpp"
#include "pcbmesh/view/plots.hpp"
#include "pcbmesh/view/skin.hpp"
#include "src/view/packing.hpp"
#include "src/view/page_parts.hpp"
#include "src/view/png.hpp"
#include "src/view/svg.hpp"

namespace pcbmesh::view {
namespace {

using Json = nlohmann::ordered_json;

constexpr int compression = 6;

Json names_json(const mesh::PrismMesh& mesh) {
  Json layers = Json::array(), materials = Json::array(), nets = Json::array();
  for (std::size_t i = 0; i < mesh.layers().size(); ++i)
    layers.push_back(
        {{"name", mesh.layers()[i]}, {"colour", hex(layer_colour(static_cast<std::int32_t>(i), mesh.layers().size()))}});
  for (std::size_t i = 0; i < mesh.materials().size(); ++i) {
    const board::Material& m = mesh.materials()[i];
    materials.push_back({{"name", m.name},
                         {"eps_r", m.eps_r},
                         {"tan_delta", m.tan_delta},
                         {"mu_r", m.mu_r},
                         {"sigma", m.sigma_s_per_m},
                         {"colour", hex(material_colour(mesh, static_cast<std::int32_t>(i)))},
                         {"kind", is_conductor(m) ? "conductor"
                                  : is_mask(m)    ? "mask"
                                                  : "dielectric"}});
  }
  for (std::size_t i = 0; i < mesh.nets().size(); ++i)
    nets.push_back({{"name", mesh.nets()[i]}, {"colour", hex(net_colour(static_cast<std::int32_t>(i)))}});
  return {{"layers", layers}, {"materials", materials}, {"nets", nets}};
}

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
                      {"prisms", tag.num_prisms},
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

Json tables_json(const mesh::PrismMesh& mesh, const PageContents& contents, const PackedMesh& packed) {
  Json out = names_json(mesh);
  out["title"] = contents.title;
  out["source"] = contents.source;
  out["num_prisms"] = mesh.num_prisms();
  out["num_nodes"] = mesh.num_nodes();
  out["groups"] = groups_json(mesh);
  out["face_tags"] = face_tags_json(mesh);
  out["z_m"] = mesh.plan().z_m();
  out["slab_of_sublayer"] = mesh.plan().slab_of_sublayer();
  out["columns"] = packed.columns;
  out["grid"] = {packed.x0_m, packed.y0_m, packed.step_m};
  Json arrays = Json::array();
  for (const PackedArray& a : packed.arrays) arrays.push_back({a.name, a.count, a.bytes});
  out["arrays"] = arrays;
  Json colours = Json::array();
  for (const Rgb& c : ramp()) colours.push_back(hex(c));
  out["ramp"] = colours;
  out["quality"] = {{"layers", quality_json(contents.quality.layers)},
                    {"materials", quality_json(contents.quality.materials)},
                    {"nets", quality_json(contents.quality.nets)}};
  Json places = Json::array();
  for (const PagePlace& p : contents.places)
    places.push_back({{"severity", p.severity}, {"code", p.code}, {"text", p.text}, {"count", p.count}, {"at_m", p.at_m}});
  out["places"] = places;
  return out;
}

/// Safe inside a script element: no "<" at all.
std::string script_json(const Json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace))
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  return out;
}

std::string facts_html(const PageContents& contents) {
  std::string out;
  for (const auto& [name, value] : contents.facts)
    out += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_xml(name), escape_xml(value));
  return out;
}

std::string verdict_html(const PageContents& contents) {
  if (!contents.passed) return "<span class=\"badge\">not checked</span>";
  return *contents.passed ? "<span class=\"badge good\">check passed</span>" : "<span class=\"badge bad\">check failed</span>";
}

std::string plots_html(const mesh::PrismMesh& mesh, const PageContents& contents) {
  const layering::HeightStatistics heights = layering::height_statistics(mesh.planar());
  std::string out;
  for (const layering::QualityHistogram& h : contents.quality.histograms) out += "<figure>" + histogram_svg(h) + "</figure>\n";
  out += "<figure>" + layer_heights_svg(mesh, heights) + "</figure>\n";
  out += "<figure>" + height_sensitivity_svg(heights) + "</figure>\n";
  out += "<figure>" + optimal_heights_svg(mesh, heights) + "</figure>\n";
  return out;
}

/// The template with every "{{name}}" filled in, in one pass: what is filled in is never looked at again.
std::string fill(std::string_view page, const std::map<std::string_view, std::string_view>& texts) {
  std::string out;
  for (;;) {
    const std::size_t first = page.find("{{"), last = page.find("}}", first);
    if (first == std::string_view::npos || last == std::string_view::npos) break;
    out += page.substr(0, first);
    out += texts.at(page.substr(first + 2, last - first - 2));
    page.remove_prefix(last + 2);
  }
  return out.append(page);
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
  const std::string tables = script_json(tables_json(mesh, contents, packed));
  const std::string packed_text = base64(gzip(packed.bytes, compression));
  const std::string plots = plots_html(mesh, contents), verdict = verdict_html(contents), facts = facts_html(contents),
                    title = escape_xml(contents.title), source = escape_xml(contents.source);
  return fill(page_template(), {{"style", page_style()},
                                {"script", page_script()},
                                {"version", version()},
                                {"mesh", packed_text},
                                {"tables", tables},
                                {"plots", plots},
                                {"verdict", verdict},
                                {"facts", facts},
                                {"title", title},
                                {"source", source}});
}

}  // namespace pcbmesh::view
