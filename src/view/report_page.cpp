// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/view/report_page.hpp"

#include <fmt/format.h>

#include <map>

#include "pcbmesh/base/version.hpp"
#include "pcbmesh/view/plots.hpp"
#include "src/view/page_parts.hpp"
#include "src/view/png.hpp"
#include "src/view/svg.hpp"

namespace pcbmesh::view {
namespace {

constexpr int compression = 6;

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

Json shared_tables(const PageContents& contents, const PackedArrays& packed) {
  Json out;
  out["title"] = contents.title;
  out["source"] = contents.source;
  Json arrays = Json::array();
  for (const PackedArray& a : packed.arrays) arrays.push_back({a.name, a.count, a.bytes});
  out["arrays"] = arrays;
  Json colours = Json::array();
  for (const Rgb& c : ramp()) colours.push_back(hex(c));
  out["ramp"] = colours;
  Json places = Json::array();
  for (const PagePlace& p : contents.places)
    places.push_back({{"severity", p.severity}, {"code", p.code}, {"text", p.text}, {"count", p.count}, {"at_m", p.at_m}});
  out["places"] = places;
  return out;
}

Json material_json(const board::Material& m, Rgb colour) {
  return {{"name", m.name},
          {"eps_r", m.eps_r},
          {"tan_delta", m.tan_delta},
          {"mu_r", m.mu_r},
          {"sigma", m.sigma_s_per_m},
          {"colour", hex(colour)},
          {"kind", is_conductor(m) ? "conductor"
                   : is_mask(m)    ? "mask"
                                   : "dielectric"}};
}

Json names_json(std::span<const std::string> layers, std::span<const board::Material> materials,
                std::span<const std::string> nets) {
  Json layer_rows = Json::array(), material_rows = Json::array(), net_rows = Json::array();
  for (std::size_t i = 0; i < layers.size(); ++i)
    layer_rows.push_back({{"name", layers[i]}, {"colour", hex(layer_colour(static_cast<std::int32_t>(i), layers.size()))}});
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto material = static_cast<std::int32_t>(i);
    material_rows.push_back(material_json(materials[i], material_colour(materials, material)));
  }
  for (std::size_t i = 0; i < nets.size(); ++i)
    net_rows.push_back({{"name", nets[i]}, {"colour", hex(net_colour(static_cast<std::int32_t>(i)))}});
  return {{"layers", layer_rows}, {"materials", material_rows}, {"nets", net_rows}};
}

std::string figure(const std::string& svg) {
  return "<figure>" + svg + "</figure>\n";
}

std::string shared_plots(const PageContents& contents) {
  std::string out;
  for (const layering::QualityHistogram& h : contents.quality.histograms) out += figure(histogram_svg(h));
  if (contents.front) out += figure(pareto_front_svg(*contents.front));
  return out;
}

std::string fill_page(const Json& tables, const PackedArrays& packed, const std::string& plots, const PageContents& contents) {
  const std::string tables_text = script_json(tables), packed_text = base64(gzip(packed.bytes, compression)),
                    verdict = verdict_html(contents), facts = facts_html(contents), title = escape_xml(contents.title),
                    source = escape_xml(contents.source);
  return fill(page_template(), {{"style", page_style()},
                                {"script", page_script()},
                                {"version", version()},
                                {"mesh", packed_text},
                                {"tables", tables_text},
                                {"plots", plots},
                                {"verdict", verdict},
                                {"facts", facts},
                                {"title", title},
                                {"source", source}});
}

}  // namespace pcbmesh::view
