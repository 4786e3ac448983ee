// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/pipeline/straight_ports.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace pcbmesh::pipeline {
namespace {

using geometry::Point;

/// A slanted line is rounded to the grid vertex by vertex.
constexpr double line_tolerance_nm = 3;
/// Of a length or an area; the mesh is held to twice as much.
constexpr double relative_tolerance = 1e-3;

/// What the graph has of one port.
struct Drawn {
  double on_line_nm = 0;  ///< edges on its line
  double area_nm2 = 0;    ///< of its footprint
};

double apart(Point a, Point b) {
  return std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
}

bool is_on(const std::array<Point, 2>& line, Point p) {
  const double length = apart(line[0], line[1]);
  const double ux = static_cast<double>(line[1].x - line[0].x) / length,
               uy = static_cast<double>(line[1].y - line[0].y) / length;
  const double dx = static_cast<double>(p.x - line[0].x), dy = static_cast<double>(p.y - line[0].y);
  const double along = dx * ux + dy * uy;
  return std::abs(dx * uy - dy * ux) <= line_tolerance_nm && along >= -line_tolerance_nm && along <= length + line_tolerance_nm;
}

}  // namespace

std::vector<std::size_t> bent_ports(const mesh::PlanarGraph& graph, const model::Model& model) {
  if (model.ports().empty()) return {};
  std::map<std::int32_t, std::size_t> port_of_body;
  for (std::size_t i = 0; i < model.ports().size(); ++i) port_of_body[model.ports()[i].body] = i;
  std::vector<Drawn> drawn(model.ports().size());
  for (std::size_t e = 0; e < graph.edges().size(); ++e) {
    const Point u = graph.vertices()[static_cast<std::size_t>(graph.edges()[e][0])],
                v = graph.vertices()[static_cast<std::size_t>(graph.edges()[e][1])];
    for (const mesh::Increment& increment : graph.increments(e)) {
      const auto found = port_of_body.find(increment.body);
      if (found == port_of_body.end()) continue;
      const model::Port& port = model.ports()[found->second];
      Drawn& here = drawn[found->second];
      const Point o = port.line[0];  // products of differences stay exact enough
      here.area_nm2 += 0.5 * increment.delta *
                       (static_cast<double>(u.x - o.x) * static_cast<double>(v.y - o.y) -
                        static_cast<double>(v.x - o.x) * static_cast<double>(u.y - o.y));
      if (port.faces == model::PortFaces::wall && is_on(port.line, u) && is_on(port.line, v)) here.on_line_nm += apart(u, v);
    }
  }
  std::vector<std::size_t> bent;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const model::Port& port = model.ports()[i];
    const bool is_wall = port.faces == model::PortFaces::wall;
    const double wanted = is_wall ? apart(port.line[0], port.line[1]) : port.area_m2 / (metres_per_nm * metres_per_nm);
    const double found = is_wall ? drawn[i].on_line_nm : drawn[i].area_nm2;
    if (std::abs(found - wanted) > relative_tolerance * wanted) bent.push_back(i);
  }
  return bent;
}

}  // namespace pcbmesh::pipeline
