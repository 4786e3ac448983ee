// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "formats/msh/write_msh.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::formats::msh {
namespace {

/// Nodes of an upright side, ordered by place along it, then by height.
std::vector<std::int64_t> nodes_of_side(const mesh::PrismMesh& mesh, std::int32_t tag, std::size_t along) {
  const auto walls = std::ranges::equal_range(mesh.walls(), tag, {}, &mesh::Wall::tag);
  std::vector<std::pair<std::int32_t, std::int32_t>> met;  // level, vertex
  for (const mesh::Wall& wall : walls)
    for (std::int32_t level = mesh.plan().first_sublayer(wall.slab); level <= mesh.plan().first_sublayer(wall.slab + 1);
         ++level)
      for (const std::int32_t vertex : {wall.a, wall.b}) met.emplace_back(level, vertex);
  std::ranges::sort(met);
  met.erase(std::unique(met.begin(), met.end()), met.end());
  const auto place = [&](const std::pair<std::int32_t, std::int32_t>& node) {
    return std::pair(mesh.planar().points_m()[static_cast<std::size_t>(node.second)][along], node.first);
  };
  std::ranges::sort(met, {}, place);
  std::vector<std::int64_t> nodes;
  for (const auto& [level, vertex] : met) nodes.push_back(mesh.node_id(level, vertex));
  return nodes;
}

/// One side and the one it repeats, which lies opposite.
struct Link {
  std::int32_t group = 0, partner = 0;
  std::array<double, 16> from_partner{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::vector<std::int64_t> nodes, partner_nodes;
};

/// Whether partners agree but for the way from one side to the other.
bool is_matched(const mesh::PrismMesh& mesh, const Link& link, std::size_t across, double way_m) {
  constexpr double tolerance_m = 1e-12;
  if (link.nodes.size() != link.partner_nodes.size()) return false;
  std::array<std::array<double, 3>, 1> one{}, other{};
  for (std::size_t i = 0; i < link.nodes.size(); ++i) {
    mesh.fill_nodes(link.nodes[i], one);
    mesh.fill_nodes(link.partner_nodes[i], other);
    other[0][across] += way_m;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (std::abs(one[0][axis] - other[0][axis]) > tolerance_m) return false;
  }
  return true;
}

std::vector<Link> links_of(const WriteJob& job) {
  std::vector<Link> links;
  const mesh::PrismMesh* mesh = job.source.prisms();
  if (mesh == nullptr) return links;
  for (std::size_t t = 0; t < mesh->face_tags().size(); ++t) {
    const mesh::FaceTag& tag = mesh->face_tags()[t];
    if (tag.partner < 0 || !tag.name.ends_with("max")) continue;
    const std::size_t across = tag.name.starts_with("x") ? 0 : 1;
    Link link;
    link.group = job.source.groups()[t].tag;
    link.partner = job.source.groups()[static_cast<std::size_t>(tag.partner)].tag;
    link.nodes = nodes_of_side(*mesh, static_cast<std::int32_t>(t), 1 - across);
    link.partner_nodes = nodes_of_side(*mesh, tag.partner, 1 - across);
    if (link.nodes.empty()) continue;
    std::array<std::array<double, 3>, 1> here{}, there{};
    mesh->fill_nodes(link.nodes.front(), here);
    PCBMESH_ASSERT(!link.partner_nodes.empty());
    mesh->fill_nodes(link.partner_nodes.front(), there);
    const double way_m = here[0][across] - there[0][across];
    PCBMESH_ASSERT(is_matched(*mesh, link, across, way_m));
    link.from_partner[4 * across + 3] = way_m * job.scale;
    links.push_back(std::move(link));
  }
  return links;
}

}  // namespace

void write_periodic_41(const WriteJob& job) {
  const std::vector<Link> links = links_of(job);
  if (links.empty()) return;
  Fields out(job);
  job.sink.put("$Periodic\n");
  out.size(static_cast<std::int64_t>(links.size()));
  out.end_line();
  for (const Link& link : links) {
    for (const std::int32_t number : {2, link.group, link.partner}) out.integer(number);
    out.end_line();
    out.size(static_cast<std::int64_t>(link.from_partner.size()));
    for (const double number : link.from_partner) out.real(number);
    out.end_line();
    out.size(static_cast<std::int64_t>(link.nodes.size()));
    out.end_line();
    for (std::size_t i = 0; i < link.nodes.size(); ++i) {
      out.size(link.nodes[i] + 1);
      out.size(link.partner_nodes[i] + 1);
      out.end_line();
    }
  }
  job.sink.put(job.binary ? "\n$EndPeriodic\n" : "$EndPeriodic\n");
}

void write_periodic_22(const WriteJob& job) {
  const std::vector<Link> links = links_of(job);
  if (links.empty()) return;
  FileSink& sink = job.sink;
  const auto number = [&](auto value, const char* after) {
    sink.put_number(value);
    sink.put(after);
  };
  sink.put("$Periodic\n");
  number(links.size(), "\n");
  for (const Link& link : links) {
    sink.put("2 ");
    number(link.group, " ");
    number(link.partner, "\nAffine");
    for (const double value : link.from_partner) {
      sink.put(" ");
      sink.put_number(value);
    }
    sink.put("\n");
    number(link.nodes.size(), "\n");
    for (std::size_t i = 0; i < link.nodes.size(); ++i) {
      number(link.nodes[i] + 1, " ");
      number(link.partner_nodes[i] + 1, "\n");
    }
  }
  sink.put("$EndPeriodic\n");
}

}  // namespace pcbmesh::formats::msh
