// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/cell_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "src/view/cell_faces.hpp"

namespace pcbmesh::view {
namespace {

using Point = std::array<double, 3>;

constexpr double metal_s_per_m = 5.8e7, laminate_eps_r = 4;
constexpr std::size_t most_worst = 10, num_bins = 40;

std::size_t index(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

double distance2(const Point& p, const Point& q) {
  const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
  return x * x + y * y + z * z;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

bool names_a_metal(std::string_view material) {
  const std::string name = lower(material);
  for (const std::string_view metal : {"copper", "gold", "silver", "alumin", "brass", "solder", "pec", "conductor", "metal"})
    if (name.find(metal) != std::string::npos && name.find("mask") == std::string::npos) return true;
  return name == "cu";
}

bool names_air(std::string_view material) {
  const std::string name = lower(material);
  return name == "air" || name == "vacuum";
}

/// Index of a name in a table that grows.
std::int32_t index_of(std::vector<std::string>& table, std::string_view name) {
  const auto place = std::find(table.begin(), table.end(), name) - table.begin();
  if (place == static_cast<std::ptrdiff_t>(table.size())) table.emplace_back(name);
  return static_cast<std::int32_t>(place);
}

/// The parts of "layer|material|net"; nothing for names spelt otherwise.
std::optional<std::array<std::string, 3>> parts_of(const std::string& name) {
  const std::size_t first = name.find('|'), last = name.rfind('|');
  if (first == std::string::npos || first == last) return {};
  return std::array{name.substr(0, first), name.substr(first + 1, last - first - 1), name.substr(last + 1)};
}

std::string name_in(const mesh::MeshData& mesh, int dimension, std::int32_t tag) {
  for (const mesh::GroupName& n : mesh.names)
    if (n.dimension == dimension && n.tag == tag) return n.name;
  if (tag == 0) return "untagged";
  return fmt::format("{} {}", dimension == 3 ? "volume" : "surface", tag);
}

/// Six times the volume, by the faces seen from the first corner.
double volume_of(const CellMesh& mesh, const CellMesh::Cell& cell) {
  const Point origin = mesh.node_m(cell.corners[0]);
  const auto at = [&](int local) {
    const Point p = mesh.node_m(cell.corners[index(local)]);
    return Point{p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]};
  };
  double six = 0;
  for (const LocalFace& face : local_faces(cell.kind)) {
    for (int i = 1; i + 1 < face.num_corners; ++i) {
      const Point p = at(face.corners[0]), q = at(face.corners[index(i)]), r = at(face.corners[index(i) + 1]);
      six += p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
    }
  }
  return std::abs(six) / 6;
}

double area_of(const Point& p, const Point& q, const Point& r) {
  const Point u{q[0] - p[0], q[1] - p[1], q[2] - p[2]}, v{r[0] - p[0], r[1] - p[1], r[2] - p[2]};
  return std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
}

double wedge_quality(const std::array<Point, 6>& p) {
  double area = 0, beta = 0, height = 0;
  for (std::size_t first : {std::size_t{0}, std::size_t{3}}) {
    const Point &a = p[first], &b = p[first + 1], &c = p[first + 2];
    area += area_of(a, b, c) / 2;
    beta += (distance2(a, b) + distance2(b, c) + distance2(c, a)) / 2;
  }
  for (std::size_t i = 0; i < 3; ++i) height += std::sqrt(distance2(p[i], p[i + 3])) / 3;
  return beta + height > 0 ? layering::prism_quality(area, beta, height) : 0;
}

}  // namespace

CellMesh::CellMesh(std::shared_ptr<const mesh::MeshData> mesh, double unit_m, const validation::Expectation* tags,
                   const std::optional<std::array<double, 4>>& box_m)
    : mesh_(std::move(mesh)), unit_m_(unit_m) {
  std::map<std::int32_t, std::int32_t> group_of_tag;
  first_cell_.push_back(0);
  for (const mesh::CellBlock& block : mesh_->cells) {
    first_cell_.push_back(first_cell_.back() + block.size());
    for (const std::int64_t node : block.corners)
      if (node < 0 || node >= static_cast<std::int64_t>(mesh_->nodes.size()))
        throw Error(
            ErrorCode::file_syntax,
            fmt::format("a cell has node {} for a corner; the mesh has {} nodes, counted from 0", node, mesh_->nodes.size()),
            {.file = mesh_->source});
    for (const std::int32_t tag : block.tags) group_of_tag.emplace(tag, 0);
  }
  if (num_cells() == 0)
    throw Error(ErrorCode::region_empty,
                "the mesh has no volume cells, so there is nothing to draw; write tetrahedra or prisms",
                {.file = mesh_->source});
  for (auto& [tag, group] : group_of_tag) {
    group = static_cast<std::int32_t>(groups_.size());
    groups_.push_back({.id = tag, .name = name_in(*mesh_, 3, tag)});
  }
  group_of_.reserve(index(num_cells()));
  for (const mesh::CellBlock& block : mesh_->cells)
    for (const std::int32_t tag : block.tags) group_of_.push_back(group_of_tag.at(tag));
  if (box_m) keep_box(*box_m);
  measure_groups();
  name_groups(tags);
  find_bands();
  name_face_tags(tags);
  faces_ = match_cell_faces(*this, face_tags_);
}

void CellMesh::keep_box(const std::array<double, 4>& box) {
  bool any = false;
  for (std::int64_t c = 0; c < num_cells(); ++c) {
    const Point at = centre_m(c);
    if (at[0] < box[0] || at[1] < box[1] || at[0] > box[2] || at[1] > box[3]) group_of_[index(c)] = -1;
    any = any || group_of_[index(c)] >= 0;
  }
  if (!any)
    throw Error(ErrorCode::region_empty,
                fmt::format("no cell lies in the box from {}, {} to {}, {} m", box[0], box[1], box[2], box[3]),
                {.file = mesh_->source});
}

void CellMesh::measure_groups() {
  std::vector<std::int64_t> measured(groups_.size(), 0);
  for (CellGroup& g : groups_) g.z_m = {std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (std::int64_t c = 0; c < num_cells(); ++c) {
    if (group_of_[index(c)] < 0) continue;
    CellGroup& g = groups_[index(group_of_[index(c)])];
    const Cell here = cell(c);
    ++g.num_cells;
    g.volume_m3 += volume_of(*this, here);
    for (const std::int64_t node : here.corners) {
      const double z = node_m(node)[2];
      g.z_m = {std::min(g.z_m[0], z), std::max(g.z_m[1], z)};
    }
    if (const std::optional<double> q = quality_of(c)) {
      std::int64_t& n = measured[index(group_of_[index(c)])];
      g.worst_quality = n == 0 ? *q : std::min(g.worst_quality, *q);
      g.mean_quality += (*q - g.mean_quality) / static_cast<double>(++n);
    }
  }
}

std::vector<CellGroup*> CellMesh::groups_from_below() {
  std::vector<CellGroup*> out;
  for (CellGroup& g : groups_)
    if (g.num_cells > 0) out.push_back(&g);
  std::sort(out.begin(), out.end(),
            [](const CellGroup* a, const CellGroup* b) { return a->z_m != b->z_m ? a->z_m < b->z_m : a->id < b->id; });
  return out;
}

void CellMesh::find_bands() {
  const std::vector<CellGroup*> from_below = groups_from_below();
  if (std::all_of(from_below.begin(), from_below.end(), [](const CellGroup* g) { return g->layer >= 0; })) {
    for (CellGroup* g : from_below) g->band = g->layer;
    num_bands_ = static_cast<std::int32_t>(layers_.size());
    return;
  }
  double top = std::numeric_limits<double>::lowest();
  for (CellGroup* g : from_below) {
    const double slack = 1e-6 * (g->z_m[1] - g->z_m[0]);
    if (g == from_below.front() || g->z_m[0] >= top - slack) ++num_bands_;
    g->band = num_bands_ - 1;
    top = std::max(top, g->z_m[1]);
  }
}

void CellMesh::name_groups(const validation::Expectation* tags) {
  std::vector<std::string> material_names;
  // Nets have their colours by their place, which tags.json keeps.
  if (tags != nullptr)
    for (const auto& net : tags->nets) index_of(nets_, net.name);
  for (CellGroup* g : groups_from_below()) {
    const validation::Expectation::Volume* told = nullptr;
    if (tags != nullptr)
      for (const auto& v : tags->volumes)
        if (v.tag == g->id) told = &v;
    std::array<std::string, 3> parts;
    if (told != nullptr)
      parts = {told->layer, told->material, told->net.empty() ? "none" : told->net};
    else if (const auto found = parts_of(g->name))
      parts = *found;
    else
      continue;
    g->layer = index_of(layers_, parts[0]);
    g->material = index_of(material_names, parts[1]);
    if (parts[2] != "none") g->net = index_of(nets_, parts[2]);
    if (index(g->material) == materials_.size()) {
      board::Material& m = materials_.emplace_back();
      const bool is_metal = told != nullptr ? told->conductor : names_a_metal(parts[1]);
      m.name = parts[1];
      m.eps_r = is_metal || names_air(parts[1]) ? 1 : laminate_eps_r;
      m.sigma_s_per_m = is_metal ? metal_s_per_m : 0;
    }
    g->is_air = g->net < 0 && names_air(parts[1]);
  }
}

void CellMesh::name_face_tags(const validation::Expectation* tags) {
  std::map<std::int32_t, std::int64_t> counts;
  for (const mesh::FaceBlock& block : mesh_->faces)
    for (const std::int32_t tag : block.tags) ++counts[tag];
  for (const auto& [tag, count] : counts) {
    if (tag == 0) continue;
    CellFaceTag& t = face_tags_.emplace_back();
    t.id = tag;
    t.name = name_in(*mesh_, 2, tag);
    t.num_faces = count;
    for (const std::string_view kind : {"sheet", "port", "wave_port", "interface"})
      if (t.name.starts_with(std::string(kind) + "|")) t.kind = kind;
    if (tags != nullptr)
      for (const auto& f : tags->faces)
        if (f.tag == tag) t.kind = f.kind;
  }
}

CellMesh::Cell CellMesh::cell(std::int64_t i) const {
  const auto after = std::upper_bound(first_cell_.begin(), first_cell_.end(), i);
  const auto block = static_cast<std::size_t>(after - first_cell_.begin()) - 1;
  const mesh::CellBlock& b = mesh_->cells[block];
  const auto n = static_cast<std::size_t>(mesh::corners_of(b.kind));
  return {b.kind, std::span(b.corners).subspan(index(i - first_cell_[block]) * n, n)};
}

std::int32_t CellMesh::group_of(std::int64_t cell) const {
  return group_of_[index(cell)];
}

std::array<double, 3> CellMesh::centre_m(std::int64_t i) const {
  const Cell here = cell(i);
  Point sum{};
  for (const std::int64_t node : here.corners)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += node_m(node)[k];
  for (double& v : sum) v /= static_cast<double>(here.corners.size());
  return sum;
}

std::optional<double> CellMesh::quality_of(std::int64_t i) const {
  const Cell here = cell(i);
  if (here.kind == mesh::CellKind::wedge) {
    std::array<Point, 6> p;
    for (std::size_t k = 0; k < 6; ++k) p[k] = node_m(here.corners[k]);
    return wedge_quality(p);
  }
  if (here.kind != mesh::CellKind::tetrahedron) return {};
  double sum = 0;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b) sum += distance2(node_m(here.corners[a]), node_m(here.corners[b]));
  return sum > 0 ? 12 * std::cbrt(std::pow(3 * volume_of(*this, here), 2)) / sum : 0;
}

CellQuality CellMesh::quality() const {
  CellQuality out;
  bool any_wedge = false, any_tetrahedron = false;
  for (const mesh::CellBlock& b : mesh_->cells) {
    any_wedge = any_wedge || (b.kind == mesh::CellKind::wedge && b.size() > 0);
    any_tetrahedron = any_tetrahedron || (b.kind == mesh::CellKind::tetrahedron && b.size() > 0);
  }
  out.histogram.measure = !any_tetrahedron ? "prism_quality"
                          : !any_wedge     ? "Mean ratio of tetrahedra"
                                           : "q_p of prisms, mean ratio of tetrahedra";
  out.histogram.high = any_wedge ? layering::max_prism_quality : 1.0;
  out.histogram.counts.assign(num_bins, 0);
  const auto worse = [](const CellQuality::Worst& a, const CellQuality::Worst& b) {
    return a.quality != b.quality ? a.quality < b.quality : a.cell < b.cell;
  };
  double sum = 0;
  for (std::int64_t c = 0; c < num_cells(); ++c) {
    const std::int32_t group = group_of_[index(c)];
    const std::optional<double> q = group < 0 ? std::nullopt : quality_of(c);
    if (!q) continue;
    ++out.num_measured;
    sum += *q;
    const double bin = *q / out.histogram.high * static_cast<double>(num_bins);
    ++out.histogram.counts[std::min(num_bins - 1, static_cast<std::size_t>(std::max(0.0, bin)))];
    const CellQuality::Worst here{c, *q, {}, group};
    if (out.worst.size() == most_worst && !worse(here, out.worst.back())) continue;
    out.worst.insert(std::upper_bound(out.worst.begin(), out.worst.end(), here, worse), here);
    if (out.worst.size() > most_worst) out.worst.pop_back();
  }
  for (CellQuality::Worst& w : out.worst) w.at_m = centre_m(w.cell);
  if (out.num_measured > 0) out.mean = sum / static_cast<double>(out.num_measured);
  return out;
}

}  // namespace pcbmesh::view
