// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/net_measures.hpp"

#include <cmath>

#include "pcbmesh/mesh/planar_edges.hpp"

namespace pcbmesh::mesh {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// Net of each triangle's cell in a slab, -1 where there is none.
std::vector<std::int32_t> nets_of_slab(const PrismMesh& mesh, std::int32_t slab) {
  std::vector<std::int32_t> nets(index(mesh.planar().num_triangles()), -1);
  if (slab < 0 || slab >= mesh.plan().num_slabs()) return nets;
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t)
    if (const std::int32_t tag = mesh.tag_of(slab, t); tag >= 0) nets[index(t)] = mesh.volume_tags()[index(tag)].net;
  return nets;
}

}  // namespace

std::vector<NetMeasure> measure_nets(const PrismMesh& mesh) {
  std::vector<NetMeasure> measures(mesh.nets().size());
  bool has_copper = false;
  for (const VolumeTag& tag : mesh.volume_tags()) {
    if (tag.net < 0) continue;
    has_copper = true;
    measures[index(tag.net)].num_prisms += tag.num_prisms;
    measures[index(tag.net)].volume_m3 += tag.volume_m3;
  }
  if (has_copper) {
    const PlanarMesh& planar = mesh.planar();
    const std::vector<PlanarEdge> edges = edges_of(planar);
    std::vector<std::int32_t> below = nets_of_slab(mesh, -1);
    for (std::int32_t slab = 0; slab <= mesh.plan().num_slabs(); ++slab) {
      const std::vector<std::int32_t> here = nets_of_slab(mesh, slab);
      for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
        const std::int32_t p = below[index(t)], q = here[index(t)];
        if (p == q) continue;
        const double area = planar.area_m2(t);
        if (p >= 0) measures[index(p)].area_m2 += area;
        if (q >= 0) measures[index(q)].area_m2 += area;
      }
      below = here;
      if (slab == mesh.plan().num_slabs()) break;
      const auto z = mesh.plan().z_m();
      const double height = z[index(mesh.plan().first_sublayer(slab + 1))] - z[index(mesh.plan().first_sublayer(slab))];
      for (const PlanarEdge& edge : edges) {
        const std::int32_t p = here[index(edge.left)], q = edge.right < 0 ? -1 : here[index(edge.right)];
        if (p == q) continue;
        const auto &a = planar.points_m()[index(edge.a)], &b = planar.points_m()[index(edge.b)];
        const double area = std::hypot(b[0] - a[0], b[1] - a[1]) * height;
        if (p >= 0) measures[index(p)].area_m2 += area;
        if (q >= 0) measures[index(q)].area_m2 += area;
      }
    }
  }
  for (const FaceTag& tag : mesh.face_tags())
    if (tag.net >= 0 && (tag.kind == FaceTagKind::conductor || tag.kind == FaceTagKind::sheet))
      measures[index(tag.net)].area_m2 += tag.area_m2;
  for (std::size_t i = 0; i < mesh.ports().size(); ++i)
    for (const std::int32_t net : {mesh.ports()[i].positive_net, mesh.ports()[i].negative_net})
      if (net >= 0) measures[index(net)].ports.push_back(static_cast<std::int32_t>(i));
  return measures;
}

}  // namespace pcbmesh::mesh
