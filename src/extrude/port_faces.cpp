// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/extrude/port_faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/units.hpp"

namespace pcbmesh::extrude {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

// A slanted line is rounded to the nanometre grid vertex by vertex.
constexpr double line_tolerance_m = 3e-9;
// Of a lumped port's area and of the length of its edges; rounding on the grid stays far below.
constexpr double relative_tolerance = 2e-3;

/// What the mesh has of one port.
struct Found {
  std::int32_t tag = -1;
  std::int64_t num_inner = 0, num_outer = 0;
  double positive_m = 0, negative_m = 0;  ///< length of its edges on the two conductors
};

class PortCheck {
 public:
  PortCheck(const mesh::PrismMeshParts& parts, const Columns& columns, const model::Model& model, const PortFootprints& ports,
            const std::vector<mesh::PlanarEdge>& edges)
      : parts_(parts), columns_(columns), model_(model), ports_(ports), found_(model.ports().size()) {
    for (std::size_t t = 0; t < parts.face_tags.size(); ++t)
      if (const std::int32_t port = parts.face_tags[t].port; port >= 0) found_[index(port)].tag = static_cast<std::int32_t>(t);
    count_faces(edges);
    for (const mesh::PlanarEdge& edge : edges) measure_edge(edge);
  }

  [[nodiscard]] bool is_inner(std::size_t port) const { return found_[port].num_inner > 0; }
  [[nodiscard]] std::int32_t tag(std::size_t port) const { return found_[port].tag; }

  /// What is wrong with a port; empty = nothing.
  [[nodiscard]] std::string fault(std::size_t number) const {
    const model::Port& port = model_.ports()[number];
    const Found& found = found_[number];
    if (found.tag < 0)
      return "has no face in the mesh: another outline runs within the tolerance of it, or it lies in copper; move it or give "
             "a smaller tolerance";
    if (found.num_inner > 0 && found.num_outer > 0)
      return "lies on the hull in part; move it inside, or put it on the side itself";
    if (port.is_wave) return found.num_inner > 0 ? "must be on the hull; give a side of the region" : "";
    const double wanted = port.area_m2, area = parts_.face_tags[index(found.tag)].area_m2;
    if (std::abs(area - wanted) > relative_tolerance * wanted)
      return fmt::format(
          "covers {:.4g} mm2 where its {} has {:.4g} mm2: something stands in it, or an outline within the tolerance of it has "
          "moved it; "
          "move it, make it narrower or give a smaller tolerance",
          area * 1e6, port.is_coaxial ? "ring" : "rectangle", wanted * 1e6);
    for (const auto& [length, edge, net, end] :
         {std::tuple{found.positive_m, port.positive_edge_m, port.positive_net, "positive"},
          std::tuple{found.negative_m, port.negative_edge_m, port.negative_net, "negative"}})
      if (std::abs(length - edge) > relative_tolerance * edge)
        return fmt::format("touches net {} along {:.4g} um of its {:.4g} um long {} edge; move it or make it narrower",
                           model_.net_name(net), length * 1e6, edge * 1e6, end);
    return "";
  }

 private:
  void count_faces(const std::vector<mesh::PlanarEdge>& edges) {
    const auto num_slabs = columns_.num_slabs();
    const auto slab_of = parts_.plan.slab_of_sublayer();
    for (const mesh::Cap& cap : parts_.caps) {
      const std::int32_t port = parts_.face_tags[index(cap.tag)].port;
      if (port < 0) continue;
      const std::int32_t face = cap.level == parts_.plan.num_sublayers() ? num_slabs : slab_of[index(cap.level)];
      const std::int32_t region = parts_.planar.regions()[index(cap.triangle)];
      const bool inner =
          face > 0 && face < num_slabs && !columns_.at(region, face - 1).is_void() && !columns_.at(region, face).is_void();
      ++(inner ? found_[index(port)].num_inner : found_[index(port)].num_outer);
    }
    for (const mesh::Wall& wall : parts_.walls) {
      const std::int32_t port = parts_.face_tags[index(wall.tag)].port;
      if (port < 0) continue;
      const auto edge = std::find_if(edges.begin(), edges.end(), [&](const mesh::PlanarEdge& e) {
        return (e.a == wall.a && e.b == wall.b) || (e.a == wall.b && e.b == wall.a);
      });
      const bool inner = edge->right >= 0 && !columns_.at(region_of(edge->left), wall.slab).is_void() &&
                         !columns_.at(region_of(edge->right), wall.slab).is_void();
      ++(inner ? found_[index(port)].num_inner : found_[index(port)].num_outer);
    }
  }

  [[nodiscard]] std::int32_t region_of(std::int32_t triangle) const { return parts_.planar.regions()[index(triangle)]; }

  [[nodiscard]] bool has_conductor(std::int32_t triangle, std::int32_t face, std::int32_t slab, std::int32_t net) const {
    if (triangle < 0) return false;
    const std::int32_t region = region_of(triangle);
    if (const std::int32_t sheet = columns_.sheet_at(region, face); sheet >= 0 && model_.bodies()[index(sheet)].net == net)
      return true;
    if (slab < 0 || slab >= columns_.num_slabs()) return false;
    const model::Label& label = columns_.at(region, slab);
    return (!label.is_void() && label.net == net) || (label.is_void() && label.hollow_net == net);
  }

  void measure_edge(const mesh::PlanarEdge& edge) {
    const auto &p = parts_.planar.points_m()[index(edge.a)], &q = parts_.planar.points_m()[index(edge.b)];
    const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
    if (const std::int32_t number = ports_.on_line(edge); number >= 0) {
      const model::Port& port = model_.ports()[index(number)];
      const model::Body& body = model_.bodies()[index(port.body)];
      const auto touches = [&](bool above, std::int32_t net) {
        const std::int32_t face = above ? body.last_slab + 1 : body.first_slab, slab = above ? face : face - 1;
        return has_conductor(edge.left, face, slab, net) || has_conductor(edge.right, face, slab, net);
      };
      const bool positive_above = port.direction[2] > 0;
      if (touches(positive_above, port.positive_net)) found_[index(number)].positive_m += length;
      if (touches(!positive_above, port.negative_net)) found_[index(number)].negative_m += length;
    }
    if (edge.right < 0) return;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const model::Port& port = model_.ports()[i];
      if (port.faces != model::PortFaces::cap) continue;
      const auto number = static_cast<std::int32_t>(i);
      const bool on_left = ports_.covers(number, region_of(edge.left)), on_right = ports_.covers(number, region_of(edge.right));
      if (on_left == on_right) continue;
      const std::int32_t beyond = on_left ? edge.right : edge.left;
      const auto touches = [&](std::int32_t net) {
        return has_conductor(beyond, port.face, port.face, net) || has_conductor(beyond, port.face, port.face - 1, net);
      };
      if (touches(port.positive_net)) found_[i].positive_m += length;
      if (touches(port.negative_net)) found_[i].negative_m += length;
    }
  }

  const mesh::PrismMeshParts& parts_;
  const Columns& columns_;
  const model::Model& model_;
  const PortFootprints& ports_;
  std::vector<Found> found_;
};

mesh::Port port_of(const model::Port& port) {
  const mesh::PortKind kind = port.is_wave      ? mesh::PortKind::wave
                              : port.is_coaxial ? mesh::PortKind::coaxial
                                                : mesh::PortKind::lumped;
  return {port.name,     kind,         port.impedance_ohm, port.is_excited,   port.direction,
          port.length_m, port.width_m, port.positive_net,  port.negative_net, port.at_m};
}

}  // namespace

PortFootprints::PortFootprints(const mesh::PlanarMesh& planar, const model::Model& model) : planar_(planar), model_(model) {
  if (model.ports().empty()) return;
  std::vector<std::int32_t> port_of_body(model.bodies().size(), -1);
  for (std::size_t i = 0; i < model.ports().size(); ++i)
    port_of_body[index(model.ports()[i].body)] = static_cast<std::int32_t>(i);
  ports_of_region_.resize(index(planar.num_regions()));
  for (std::int32_t r = 0; r < planar.num_regions(); ++r)
    for (const std::int32_t body : planar.bodies_of_region(r))
      if (const std::int32_t port = port_of_body[index(body)]; port >= 0) ports_of_region_[index(r)].push_back(port);
}

bool PortFootprints::covers(std::int32_t port, std::int32_t region) const {
  return !ports_of_region_.empty() &&
         std::ranges::find(ports_of_region_[index(region)], port) != ports_of_region_[index(region)].end();
}

bool PortFootprints::is_on_line(std::int32_t port, std::int32_t vertex) const {
  const auto& [from, to] = model_.ports()[index(port)].line;
  return is_on_segment(planar_.points_m()[index(vertex)], from, to);
}

bool is_on_segment(const std::array<double, 2>& p, geometry::Point from, geometry::Point to) {
  const double ax = static_cast<double>(from.x) * metres_per_nm, ay = static_cast<double>(from.y) * metres_per_nm;
  const double ux = static_cast<double>(to.x - from.x) * metres_per_nm, uy = static_cast<double>(to.y - from.y) * metres_per_nm;
  const double length = std::hypot(ux, uy), dx = p[0] - ax, dy = p[1] - ay;
  if (length == 0) return false;
  const double along = (dx * ux + dy * uy) / length, across = (dx * uy - dy * ux) / length;
  return std::abs(across) <= line_tolerance_m && along >= -line_tolerance_m && along <= length + line_tolerance_m;
}

std::int32_t PortFootprints::on_line(const mesh::PlanarEdge& edge) const {
  if (ports_of_region_.empty()) return -1;
  const auto& left = ports_of_region_[index(planar_.regions()[index(edge.left)])];
  static const std::vector<std::int32_t> none;
  const auto& right = edge.right < 0 ? none : ports_of_region_[index(planar_.regions()[index(edge.right)])];
  for (const auto* ports : {&left, &right}) {
    for (const std::int32_t port : *ports) {
      const auto& other = ports == &left ? right : left;
      if (model_.ports()[index(port)].faces != model::PortFaces::wall || std::ranges::find(other, port) != other.end())
        continue;
      if (is_on_line(port, edge.a) && is_on_line(port, edge.b)) return port;
    }
  }
  return -1;
}

std::int32_t PortFootprints::cap_at(std::int32_t region, std::int32_t face) const {
  if (ports_of_region_.empty()) return -1;
  for (const std::int32_t port : ports_of_region_[index(region)])
    if (model_.ports()[index(port)].faces == model::PortFaces::cap && model_.ports()[index(port)].face == face) return port;
  return -1;
}

bool PortFootprints::has_slab(std::int32_t port, std::int32_t slab) const {
  const model::Body& body = model_.bodies()[index(model_.ports()[index(port)].body)];
  return slab >= body.first_slab && slab <= body.last_slab;
}

void add_ports(mesh::PrismMeshParts& parts, const Columns& columns, const model::Model& model, const PortFootprints& ports,
               const std::vector<mesh::PlanarEdge>& edges) {
  if (model.ports().empty()) return;
  const PortCheck check(parts, columns, model, ports, edges);
  std::string faults;
  Spot spot{.file = model.source()};
  for (std::size_t i = 0; i < model.ports().size(); ++i) {
    const model::Port& port = model.ports()[i];
    if (const std::string fault = check.fault(i); !fault.empty()) {
      faults += fmt::format("{}/ports/{}: port '{}' at ({:.6g}, {:.6g}) mm {}", faults.empty() ? "" : "\n  ", port.study_index,
                            port.name, port.at_m[0] * 1e3, port.at_m[1] * 1e3, fault);
      continue;
    }
    parts.face_tags[index(check.tag(i))].is_inner = check.is_inner(i);
    parts.ports.push_back(port_of(port));
  }
  if (!faults.empty()) throw Error(ErrorCode::port_invalid, faults, spot);
}

}  // namespace pcbmesh::extrude
