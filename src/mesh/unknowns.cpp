// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/unknowns.hpp"

#include <vector>

#include "pcbmesh/mesh/planar_edges.hpp"

namespace pcbmesh::mesh {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// Triangles that carry a prism in one slab.
std::vector<char> prisms_of_slab(const PrismMesh& mesh, std::int32_t slab) {
  std::vector<char> present(index(mesh.planar().num_triangles()), 0);
  if (slab < 0 || slab >= mesh.plan().num_slabs()) return present;
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) present[index(t)] = mesh.tag_of(slab, t) >= 0 ? 1 : 0;
  return present;
}

class EntityCounter {
 public:
  explicit EntityCounter(const PrismMesh& mesh) : mesh_(mesh), edges_(edges_of(mesh.planar())) {}

  EntityCounts run() {
    counts_.nodes = mesh_.num_nodes();
    counts_.prisms = mesh_.num_prisms();
    std::vector<char> below = prisms_of_slab(mesh_, -1);
    for (std::int32_t slab = 0; slab <= mesh_.plan().num_slabs(); ++slab) {
      const std::vector<char> above = prisms_of_slab(mesh_, slab);
      add_level(below, above, 1);
      if (slab < mesh_.plan().num_slabs()) {
        const std::int64_t num_sublayers = mesh_.plan().first_sublayer(slab + 1) - mesh_.plan().first_sublayer(slab);
        add_level(above, above, num_sublayers - 1);
        add_uprights(above, num_sublayers);
      }
      below = above;
    }
    return counts_;
  }

 private:
  void add_edge(int num_cells, int num_inner_faces, std::int64_t times) {
    if (num_cells == 0) return;
    counts_.edges += times;
    const int closed = 1 - (num_cells - num_inner_faces);
    counts_.closed_edges += closed * times;
    // All faces round an edge are inner ones only if the cells close a ring.
    if (closed != 1) counts_.boundary_edges += times;
  }

  /// Horizontal triangles and edges between two sub-layers.
  void add_level(const std::vector<char>& below, const std::vector<char>& above, std::int64_t times) {
    if (times == 0) return;
    for (std::size_t t = 0; t < below.size(); ++t) {
      counts_.triangles += (below[t] | above[t]) * times;
      counts_.inner_triangles += (below[t] & above[t]) * times;
    }
    for (const PlanarEdge& edge : edges_) {
      const int p = below[index(edge.left)], q = above[index(edge.left)];
      const int r = edge.right < 0 ? 0 : below[index(edge.right)], s = edge.right < 0 ? 0 : above[index(edge.right)];
      add_edge(p + q + r + s, (p & q) + (r & s) + (p & r) + (q & s), times);
    }
  }

  /// Quadrangles and vertical edges of one slab.
  void add_uprights(const std::vector<char>& present, std::int64_t num_sublayers) {
    std::vector<std::int32_t> cells(index(mesh_.planar().num_points()), 0), faces(cells.size(), 0);
    for (std::int32_t t = 0; t < mesh_.planar().num_triangles(); ++t)
      if (present[index(t)] != 0)
        for (const std::int32_t v : mesh_.planar().triangles()[index(t)]) ++cells[index(v)];
    for (const PlanarEdge& edge : edges_) {
      const int p = present[index(edge.left)], q = edge.right < 0 ? 0 : present[index(edge.right)];
      counts_.quads += (p | q) * num_sublayers;
      counts_.inner_quads += (p & q) * num_sublayers;
      if ((p & q) == 0) continue;
      ++faces[index(edge.a)];
      ++faces[index(edge.b)];
    }
    for (std::size_t v = 0; v < cells.size(); ++v) add_edge(cells[v], faces[v], num_sublayers);
  }

  const PrismMesh& mesh_;
  std::vector<PlanarEdge> edges_;
  EntityCounts counts_;
};

double squared(std::int64_t x) {
  return static_cast<double>(x) * static_cast<double>(x);
}

}  // namespace

EntityCounts count_entities(const PrismMesh& mesh) {
  return EntityCounter(mesh).run();
}

Unknowns count_unknowns(const EntityCounts& c, int order, Cells cells) {
  const std::int64_t k = order;
  const std::int64_t per_triangle = k * (k - 1), on_triangle = k * (k + 2);
  const std::int64_t boundary_triangles = c.triangles - c.inner_triangles, boundary_quads = c.quads - c.inner_quads;
  Unknowns u;
  if (cells == Cells::prisms) {
    const std::int64_t per_quad = 2 * k * (k - 1), on_quad = 2 * k * (k + 1);
    const std::int64_t per_prism = k * (k - 1) * (3 * k - 4) / 2, of_prism = 3 * k * (k + 1) * (k + 2) / 2;
    u.total = c.edges * k + c.triangles * per_triangle + c.quads * per_quad + c.prisms * per_prism;
    u.on_boundary = c.boundary_edges * k + boundary_triangles * per_triangle + boundary_quads * per_quad;
    u.nonzeros = static_cast<double>(c.prisms) * squared(of_prism) -
                 static_cast<double>(c.inner_triangles) * squared(on_triangle) -
                 static_cast<double>(c.inner_quads) * squared(on_quad) + static_cast<double>(c.closed_edges) * squared(k);
    return u;
  }
  // Each prism gives three tetrahedra with two faces between them; each quadrangle two triangles and a diagonal.
  const std::int64_t tetrahedra = 3 * c.prisms, edges = c.edges + c.quads;
  const std::int64_t triangles = c.triangles + 2 * c.quads + 2 * c.prisms;
  const std::int64_t inner_triangles = c.inner_triangles + 2 * c.inner_quads + 2 * c.prisms;
  const std::int64_t per_tetrahedron = k * (k - 1) * (k - 2) / 2, of_tetrahedron = k * (k + 2) * (k + 3) / 2;
  u.total = edges * k + triangles * per_triangle + tetrahedra * per_tetrahedron;
  u.on_boundary = (c.boundary_edges + boundary_quads) * k + (boundary_triangles + 2 * boundary_quads) * per_triangle;
  u.nonzeros = static_cast<double>(tetrahedra) * squared(of_tetrahedron) -
               static_cast<double>(inner_triangles) * squared(on_triangle) +
               static_cast<double>(c.closed_edges + c.inner_quads) * squared(k);
  return u;
}

}  // namespace pcbmesh::mesh
