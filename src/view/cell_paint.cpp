// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/view/cell_render.hpp"

namespace pcbmesh::view {
namespace {

std::size_t index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

double longest_edge_mm(const SkinPolygon& polygon) {
  double longest = 0;
  for (int i = 0; i < polygon.size; ++i) {
    const auto &p = polygon.corners[index(i)], &q = polygon.corners[index((i + 1) % polygon.size)];
    longest = std::max(longest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
  }
  return longest * 1e3;
}

bool is_flat(const SkinPolygon& polygon) {
  double low = std::numeric_limits<double>::max(), high = -low, x0 = low, x1 = -low, y0 = low, y1 = -low;
  for (int i = 0; i < polygon.size; ++i) {
    const auto& p = polygon.corners[index(i)];
    x0 = std::min(x0, p[0]);
    x1 = std::max(x1, p[0]);
    y0 = std::min(y0, p[1]);
    y1 = std::max(y1, p[1]);
    low = std::min(low, p[2]);
    high = std::max(high, p[2]);
  }
  return high - low < 1e-6 * std::max(x1 - x0, y1 - y0);
}

}  // namespace

std::vector<ColourMode> colour_modes_of(const CellMesh& mesh) {
  std::vector<ColourMode> out;
  if (!mesh.materials().empty()) out.push_back(ColourMode::material);
  if (!mesh.nets().empty()) out.push_back(ColourMode::net);
  if (!mesh.layers().empty()) out.push_back(ColourMode::layer);
  out.push_back(ColourMode::group);
  if (!mesh.face_tags().empty()) out.push_back(ColourMode::face_tag);
  out.push_back(ColourMode::prism_quality);
  out.push_back(ColourMode::size);
  return out;
}

std::string title_of(const CellMesh& mesh, ColourMode mode) {
  if (mode == ColourMode::size) return "Longest edge of the face, mm";
  if (mode != ColourMode::prism_quality) return std::string(title_of(mode));
  bool any_wedge = false, any_tetrahedron = false;
  for (const mesh::CellBlock& b : mesh.mesh().cells) {
    any_wedge = any_wedge || b.kind == mesh::CellKind::wedge;
    any_tetrahedron = any_tetrahedron || b.kind == mesh::CellKind::tetrahedron;
  }
  if (!any_tetrahedron) return std::string(title_of(mode));
  return any_wedge ? "Quality: q_p of prisms, mean ratio of tetrahedra" : "Mean ratio of tetrahedra";
}

Films::Films(const CellMesh& mesh) {
  const auto is = [&](std::int32_t group, bool (*kind)(const board::Material&)) {
    if (group < 0) return false;
    const std::int32_t material = mesh.groups()[index(group)].material;
    return material >= 0 && kind(mesh.materials()[index(material)]);
  };
  for (const CellFace& face : mesh.faces()) {
    if (is(face.group, is_mask) && is(face.neighbour_group, is_conductor))
      behind_.emplace_back(face.cell, face.neighbour_group);
    if (is(face.neighbour_group, is_mask) && is(face.group, is_conductor)) behind_.emplace_back(face.neighbour, face.group);
  }
  std::sort(behind_.begin(), behind_.end());
}

std::int32_t Films::behind(std::int64_t cell) const {
  const auto found = std::lower_bound(behind_.begin(), behind_.end(), std::pair{cell, std::int32_t{-1}});
  return found != behind_.end() && found->first == cell ? found->second : -1;
}

CellPaint::CellPaint(const CellMesh& mesh, ColourMode mode) : mesh_(mesh), mode_(mode), films_(mesh) {
  const std::vector<ColourMode> modes = colour_modes_of(mesh);
  if (std::find(modes.begin(), modes.end(), mode) == modes.end()) {
    std::vector<std::string_view> names;
    for (const ColourMode m : modes) names.push_back(name_of(m));
    throw Error(ErrorCode::usage,
                fmt::format("this mesh can't be coloured by {}: its groups are not named layer|material|net, and cells know no "
                            "columns; take one of {}",
                            name_of(mode), fmt::join(names, ", ")),
                {.file = mesh.mesh().source});
  }
  for (std::size_t i = 0; i < mesh.groups().size(); ++i) {
    const CellGroup& g = mesh.groups()[i];
    const auto by_material = [&] {
      return g.material < 0 ? group_colour(static_cast<std::int32_t>(i)) : material_colour(mesh.materials(), g.material);
    };
    if (mode == ColourMode::net)
      groups_.push_back(g.net >= 0 ? net_colour(g.net) : quiet(by_material()));
    else if (mode == ColourMode::layer && g.layer >= 0)
      groups_.push_back(layer_colour(g.layer, mesh.layers().size()));
    else if (mode == ColourMode::group)
      groups_.push_back(group_colour(static_cast<std::int32_t>(i)));
    else
      groups_.push_back(by_material());
  }
  if (mode != ColourMode::size) return;
  range_ = {std::numeric_limits<double>::max(), 0};
  Visibility all;
  all.mode = SkinMode::groups;
  visit_cell_skin(mesh, all, [&](const CellSkinFace& face) {
    const double edge = longest_edge_mm(face.polygon);
    range_ = {std::min(range_[0], edge), std::max(range_[1], edge)};
  });
}

Rgb CellPaint::of(const CellSkinFace& face) const {
  if (mode_ == ColourMode::prism_quality) {
    const std::optional<double> q = mesh_.quality_of(face.cell);
    return q ? ramp_at(*q) : no_value;
  }
  if (mode_ == ColourMode::size)
    return ramp_at(range_[1] > range_[0] ? std::log(longest_edge_mm(face.polygon) / range_[0]) / std::log(range_[1] / range_[0])
                                         : 0.5);
  if (mode_ == ColourMode::face_tag) return face.tag < 0 ? no_value : group_colour(face.tag);
  const Rgb own = groups_[index(face.group)];
  const std::int32_t behind = face.is_section || !is_flat(face.polygon) ? -1 : films_.behind(face.cell);
  return behind < 0 ? own : mix(own, groups_[index(behind)], film_share(mode_));
}

std::optional<Rgb> CellPaint::of_tag(std::int32_t face_tag) const {
  const std::string& kind = mesh_.face_tags()[index(face_tag)].kind;
  if (mode_ == ColourMode::face_tag) return group_colour(face_tag);
  if (kind == "port" || kind == "wave_port") return port_colour;
  if (kind != "sheet" || is_continuous(mode_)) return {};
  return sheet_colour;
}

std::vector<LegendEntry> CellPaint::legend(const std::vector<char>& hidden_groups) const {
  std::vector<LegendEntry> out;
  if (is_continuous(mode_)) return out;
  const auto put = [&](const std::string& name, Rgb colour) {
    if (std::none_of(out.begin(), out.end(), [&](const LegendEntry& e) { return e.name == name; }))
      out.push_back({name, colour});
  };
  if (mode_ == ColourMode::face_tag) {
    for (std::size_t i = 0; i < mesh_.face_tags().size(); ++i)
      put(mesh_.face_tags()[i].name, group_colour(static_cast<std::int32_t>(i)));
    put("no tag", no_value);
    return out;
  }
  for (std::size_t i = 0; i < mesh_.groups().size(); ++i) {
    const CellGroup& g = mesh_.groups()[i];
    if (g.num_cells == 0 || (!hidden_groups.empty() && hidden_groups[i] != 0)) continue;
    const bool is_named = g.material >= 0;
    put(mode_ == ColourMode::group || !is_named ? g.name
        : mode_ == ColourMode::net              ? (g.net >= 0 ? mesh_.nets()[index(g.net)] : "no net")
        : mode_ == ColourMode::layer            ? mesh_.layers()[index(g.layer)]
                                                : mesh_.materials()[index(g.material)].name,
        groups_[i]);
  }
  for (std::size_t i = 0; i < mesh_.face_tags().size(); ++i)
    if (const std::optional<Rgb> colour = of_tag(static_cast<std::int32_t>(i)); mesh_.face_tags()[i].is_inner && colour)
      put(mesh_.face_tags()[i].name, *colour);
  return out;
}

}  // namespace pcbmesh::view
