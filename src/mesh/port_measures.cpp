// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/port_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace pcbmesh::mesh {
namespace {

using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Extents of the faces of one port, gathered face by face.
class Gauge {
 public:
  explicit Gauge(const Port& port) : port_(port) { measure_.shortest_edge_m = std::numeric_limits<double>::infinity(); }

  void add_face(std::span<const Vector> corners) {
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector &a = corners[i], &b = corners[(i + 1) % corners.size()];
      const Vector edge{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
      const double size = std::sqrt(dot(edge, edge)), part = std::abs(dot(edge, port_.direction));
      shortest = std::min(shortest, size);
      longest = std::max(longest, size);
      along_ = std::max(along_, part);
      across_ = std::max(across_, std::sqrt(std::max(0.0, size * size - part * part)));
    }
    ++measure_.num_faces;
    measure_.shortest_edge_m = std::min(measure_.shortest_edge_m, shortest);
    measure_.longest_edge_m = std::max(measure_.longest_edge_m, longest);
    measure_.worst_aspect = std::max(measure_.worst_aspect, longest / shortest);
  }

  [[nodiscard]] PortMeasure result() const {
    PortMeasure out = measure_;
    if (out.num_faces == 0) return {};
    const auto count = [](double whole, double part) {
      constexpr double tie = 1e-6;  // ports lie on the nanometre grid
      return part > 0 ? static_cast<int>(std::ceil(whole / part - tie)) : 0;
    };
    if (port_.kind == PortKind::coaxial) out.least_along = count(port_.length_m, out.longest_edge_m);
    if (port_.kind != PortKind::lumped) return out;
    out.least_along = count(port_.length_m, along_);
    out.least_across = count(port_.width_m, across_);
    return out;
  }

 private:
  const Port& port_;
  PortMeasure measure_;
  double along_ = 0, across_ = 0;
};

}  // namespace

std::vector<PortMeasure> measure_ports(const PrismMesh& mesh) {
  std::vector<Gauge> gauges;
  for (const Port& port : mesh.ports()) gauges.emplace_back(port);
  const auto gauge_of = [&](std::int32_t tag) -> Gauge* {
    const std::int32_t port = mesh.face_tags()[static_cast<std::size_t>(tag)].port;
    return port < 0 ? nullptr : &gauges[static_cast<std::size_t>(port)];
  };
  const auto at = [&](std::int32_t vertex, std::int32_t level) {
    const auto& p = mesh.planar().points_m()[static_cast<std::size_t>(vertex)];
    return Vector{p[0], p[1], mesh.plan().z_m()[static_cast<std::size_t>(level)]};
  };
  if (!gauges.empty()) {
    for (const Cap& cap : mesh.caps()) {
      Gauge* gauge = gauge_of(cap.tag);
      if (gauge == nullptr) continue;
      const auto& c = mesh.planar().triangles()[static_cast<std::size_t>(cap.triangle)];
      gauge->add_face(std::array{at(c[0], cap.level), at(c[1], cap.level), at(c[2], cap.level)});
    }
    for (const Wall& wall : mesh.walls()) {
      Gauge* gauge = gauge_of(wall.tag);
      if (gauge == nullptr) continue;
      for (std::int32_t k = mesh.plan().first_sublayer(wall.slab); k < mesh.plan().first_sublayer(wall.slab + 1); ++k)
        gauge->add_face(std::array{at(wall.a, k), at(wall.b, k), at(wall.b, k + 1), at(wall.a, k + 1)});
    }
  }
  std::vector<PortMeasure> measures;
  for (const Gauge& gauge : gauges) measures.push_back(gauge.result());
  return measures;
}

}  // namespace pcbmesh::mesh
