// SPDX-License-Identifier: GPL-3.0-or-later
// Damage to arrays, nodes and cells, with the code that must be found and what else such a mesh rightly shows.
#pragma once

#include "fault_injector.hpp"

namespace pcbmesh::tests {

inline const std::vector<std::string>& wrong_counts() {
  static const std::vector<std::string> codes{"volume.cell_count", "volume.wrong"};
  return codes;
}

inline std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Cuts an inner cell in two through the middle of a horizontal edge; its neighbours stay whole.
inline std::string hang_a_node(Damage& d) {
  const auto cell = d.inner_cell();
  const auto p = d.corners(cell);
  const std::int32_t tag = d.tag(cell);
  const auto middle = [&](std::size_t i, std::size_t k) { return d.add_node(d.centre(std::array{p[i], p[k]})); };
  if (d.has_wedge(cell)) {
    const std::int64_t low = middle(0, 1), high = middle(3, 4);
    d.erase(cell);
    d.add(mesh::CellKind::wedge, {p[0], low, p[2], p[3], high, p[5]}, tag);
    d.add(mesh::CellKind::wedge, {low, p[1], p[2], high, p[4], p[5]}, tag);
    return "node.hanging";
  }
  std::array<std::size_t, 2> edge{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = i + 1; k < 4; ++k) {
      if (d.at(p[i])[2] == d.at(p[k])[2]) edge = {i, k};
    }
  }
  auto first = p, second = p;
  first[edge[0]] = second[edge[1]] = middle(edge[0], edge[1]);
  d.erase(cell);
  d.add(mesh::CellKind::tetrahedron, first, tag);
  d.add(mesh::CellKind::tetrahedron, second, tag);
  return "node.hanging";
}

inline std::string split_a_prism(Damage& d) {
  const auto cells = d.cells_in(5, 7, 2, 5, 2);
  if (!d.has_wedge(cells.front())) return {};
  const auto cell = d.pick(cells);
  const auto p = d.corners(cell);
  const std::int32_t tag = d.tag(cell);
  d.erase(cell);
  d.add(mesh::CellKind::tetrahedron, {p[0], p[4], p[5], p[3]}, tag);
  d.add(mesh::CellKind::tetrahedron, {p[0], p[1], p[2], p[5]}, tag);
  d.add(mesh::CellKind::tetrahedron, {p[0], p[1], p[5], p[4]}, tag);
  return "boundary.quad_on_triangles";
}

inline std::string turn_a_diagonal(Damage& d) {
  const int x = 5 + d.below(2), y = 2 + d.below(3);
  auto cells = d.cells_in(x, x + 1, y, y + 1, 2);
  if (!d.has_wedge(cells.front())) return {};
  const std::int32_t tag = d.tag(cells.front());
  const std::int64_t a = d.node(x, y, 2), b = d.node(x + 1, y, 2), e = d.node(x + 1, y + 1, 2), f = d.node(x, y + 1, 2),
                     up = d.node(0, 0, 1);
  const auto of_first = d.corners(cells.front()), of_second = d.corners(cells.back());
  const auto has = [](const auto& ids, std::int64_t id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); };
  const bool rises = has(of_first, a) && has(of_second, a);
  d.erase_all(cells);
  for (const auto& t :
       rises ? std::array{std::array{a, b, f}, std::array{b, e, f}} : std::array{std::array{a, b, e}, std::array{a, e, f}}) {
    d.add(mesh::CellKind::wedge, {t[0], t[1], t[2], t[0] + up, t[1] + up, t[2] + up}, tag);
  }
  return "boundary.overlap";
}

inline std::string overlay_a_copy(Damage& d, const std::array<double, 3>& shift, double scale) {
  const auto cells = d.mesh_cells();
  const std::array<double, 3> pivot{4e-3, 4e-3, 2e-4};
  const auto num_nodes = static_cast<std::int64_t>(d.c.mesh.nodes.size());
  for (std::int64_t i = 0; i < num_nodes; ++i) {
    auto place = d.at(i);
    for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = pivot[axis] + scale * (place[axis] - pivot[axis]) + shift[axis];
    d.add_node(place);
  }
  for (const auto& [kind, corners, tag] : cells) {
    auto moved = corners;
    for (auto& id : moved) id += num_nodes;
    d.add(kind, moved, tag);
  }
  return scale == 1 ? "boundary.crossing" : "cell.overlap";
}

inline std::string add_inner_face_to(Damage& d, std::int32_t tag, const char* code) {
  const auto faces = d.faces_of_cell(d.inner_cell());
  d.add_face(faces[static_cast<std::size_t>(d.below(static_cast<int>(faces.size())))], tag);
  return code;
}

inline std::vector<Fault> array_faults() {
  return {
      {"corners cut short",
       [](Damage& d) {
         d.c.mesh.cells[0].corners.pop_back();
         return "array.size";
       },
       {}},
      {"unknown kind of cell",
       [](Damage& d) {
         d.c.mesh.cells[0].kind = static_cast<mesh::CellKind>(9);
         return "array.kind";
       },
       {}},
      {"all cells lost",
       [](Damage& d) {
         d.c.mesh.cells.clear();
         return "mesh.empty";
       },
       {"node.orphan", "net.open", "face.tagged_no_cell", "tag.missing", "tag.empty_group", "layer.incomplete"}},
      {"a coordinate is no number",
       [](Damage& d) {
         d.at(d.inner_node(2))[1] = std::nan("");
         return "node.not_finite";
       },
       {}},
      {"a cell names a node that is not there",
       [](Damage& d) {
         d.corner(d.inner_cell(), 2) = 1'000'000;
         return "cell.corner_out_of_range";
       },
       {}},
      {"a tagged face names a node that is not there",
       [](Damage& d) {
         d.c.mesh.faces[0].corners[1] = -1;
         return "face.corner_out_of_range";
       },
       {}},
      {"one node at two corners of a cell",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         d.corner(cell, 1) = d.corner(cell, 0);
         return "cell.corner_repeated";
       },
       std::vector<std::string>{"volume.wrong", "cell.flat", "face.untagged", "boundary.open", "boundary.pinched",
                                "face.not_planar", "limit.needle", "limit.sliver", "limit.aspect", "limit.edge",
                                "limit.jacobian", "limit.quality", "volume.not_enclosed", "face.many_owners"}},
      {"one node at two corners of a tagged face",
       [](Damage& d) {
         d.c.mesh.faces[0].corners[1] = d.c.mesh.faces[0].corners[0];
         return "face.corner_repeated";
       },
       {"face.tagged_no_cell", "face.untagged", "face.area"}},
  };
}

inline std::vector<Fault> node_faults() {
  return {
      {"a node of no cell",
       [](Damage& d) {
         d.add_node({5.5e-3, 3.5e-3, 1e-4});
         return "node.orphan";
       },
       {}},
      {"a cell with its own copy of one node",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         auto& id = d.corner(cell, 0);
         id = d.add_node(d.at(id));
         return "node.duplicate";
       },
       {"boundary.crack", "face.untagged"}},
      {"layers apart by 1 ulp",
       [](Damage& d) {
         const double z = d.at(d.node(0, 0, 2))[2];
         d.detach_above(2, std::nextafter(z, 1) - z);
         return "node.near_duplicate";
       },
       {"boundary.crack", "face.untagged", "layer.uneven_level"}},
      {"layers side by side without common nodes",
       [](Damage& d) {
         d.detach_above(2, 0);
         return "boundary.crack";
       },
       {"node.duplicate", "face.untagged"}},
      {"a hanging node", hang_a_node, {"boundary.overlap", "face.untagged", "volume.cell_count"}},
      {"a node off its level",
       [](Damage& d) {
         d.at(d.inner_node(3))[2] += 3e-6;
         return "layer.off_level";
       },
       {"volume.wrong", "layer.outside"}},
      {"a node off its level by 1 ulp",
       [](Damage& d) {
         double& z = d.at(d.inner_node(3))[2];
         z = std::nextafter(z, 1);
         return "layer.uneven_level";
       },
       {}},
      {"a node through its neighbours",
       [](Damage& d) {
         d.at(d.inner_node(3))[0] += 1.6e-3;
         return d.cells == Cells::tetrahedra ? "cell.inverted" : "cell.folded";
       },
       {"cell.folded", "cell.inverted", "limit.jacobian", "limit.quality", "face.not_planar"}},
      {"a whole level moved",
       [](Damage& d) {
         for (int i = 0; i < (Damage::n + 1) * (Damage::n + 1); ++i) d.at(d.node(0, 0, 3) + i)[2] += 5e-6;
         return "layer.off_level";
       },
       {"layer.outside", "layer.incomplete", "volume.wrong"}},
      {"a node of one periodic side moved along it",
       [](Damage& d) {
         d.at(d.node(Damage::n, 2 + d.below(5), 4))[1] += 0.2e-3;
         return "periodic.unmatched";
       },
       {"face.not_planar"}},
  };
}

inline std::vector<Fault> cell_faults() {
  return {
      {"a cell inside out",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         std::swap(d.corner(cell, 1), d.corner(cell, 2));
         if (d.has_wedge(cell)) std::swap(d.corner(cell, 4), d.corner(cell, 5));
         return "cell.inverted";
       },
       {"face.same_orientation", "volume.not_enclosed", "volume.wrong", "limit.jacobian", "limit.quality"}},
      {"two corners swapped",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         std::swap(d.corner(cell, 0), d.corner(cell, 1));
         return d.has_wedge(cell) ? "cell.folded" : "cell.inverted";
       },
       {"face.same_orientation", "volume.not_enclosed", "volume.wrong", "limit.jacobian", "limit.quality", "face.untagged",
        "boundary.open", "face.not_planar", "limit.sliver", "boundary.crossing", "boundary.pinched", "limit.growth"}},
      {"a flat cell",
       [](Damage& d) {
         const int x = 5 + d.below(2), y = 2 + d.below(3);
         d.at(d.node(x, y, 3))[2] = d.at(d.node(x, y, 2))[2];
         return "cell.flat";
       },
       {"node.duplicate", "layer.spans_levels", "layer.outside", "volume.wrong", "limit.needle", "limit.sliver", "limit.aspect",
        "limit.edge", "limit.jacobian"}},
      {"a cell lost inside",
       [](Damage& d) {
         d.erase(d.inner_cell());
         return "face.untagged";
       },
       wrong_counts()},
      {"a cell lost at the hull",
       [](Damage& d) {
         d.erase(d.pick(d.cells_in(5, 7, 2, 5, 3)));
         return "face.untagged";
       },
       wrong_counts() + std::vector<std::string>{"face.tagged_no_cell", "boundary.pinched"}},
      {"a cell there twice",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         d.add(d.block_of(cell).kind, d.corners(cell), d.tag(cell));
         return "cell.duplicate";
       },
       wrong_counts() + std::vector<std::string>{"face.many_owners", "volume.not_enclosed"}},
      {"a cell there twice, with its own nodes",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         auto p = d.corners(cell);
         for (auto& id : p) id = d.add_node(d.at(id));
         d.add(d.block_of(cell).kind, p, d.tag(cell));
         return "cell.overlap";
       },
       wrong_counts() + std::vector<std::string>{"node.duplicate", "face.untagged"}},
      {"a third cell on a face",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         auto p = d.corners(cell);
         const auto last = d.centre(p);
         d.add(mesh::CellKind::tetrahedron, {p[0], p[1], p[2], d.add_node(last)}, d.tag(cell));
         return "face.many_owners";
       },
       wrong_counts() + std::vector<std::string>{"face.untagged", "boundary.open", "volume.not_enclosed", "layer.off_level"}},
      {"a second mesh laid over the first",
       [](Damage& d) {
         return overlay_a_copy(d, {0.37e-3, 0.41e-3, 13e-6}, 1);
       },
       wrong_counts() +
           std::vector<std::string>{"cell.overlap", "face.untagged", "layer.off_level", "layer.outside", "net.open"}},
      {"a second mesh inside the first",
       [](Damage& d) {
         return overlay_a_copy(d, {0, 0, 0}, 0.5);
       },
       wrong_counts() +
           std::vector<std::string>{"face.untagged", "layer.off_level", "layer.outside", "net.open", "node.duplicate"}},
      {"the other diagonal in one square", turn_a_diagonal, {"face.untagged"}},
      {"a prism split in tetrahedra", split_a_prism, {"face.untagged", "volume.cell_count", "boundary.pinched"}},
      {"a pyramid",
       [](Damage& d) {
         const std::int64_t a = d.add_node({1, 0, 0}), b = d.add_node({1.001, 0, 0}), e = d.add_node({1.001, 0.001, 0}),
                            f = d.add_node({1, 0.001, 0}), top = d.add_node({1.0005, 0.0005, 1e-4});
         d.add(mesh::CellKind::pyramid, {a, b, e, f, top}, Damage::core);
         return "profile.palace.pyramids";
       },
       wrong_counts() + std::vector<std::string>{"face.untagged"}},
      {"the domain touches itself along an edge",
       [](Damage& d) {
         auto list = d.cells_in(5, 6, 2, 3, 2);
         for (const auto& cell : d.cells_in(6, 7, 3, 4, 2)) list.push_back(cell);
         d.erase_all(std::move(list));
         return "boundary.pinched";
       },
       wrong_counts() + std::vector<std::string>{"face.untagged"}},
      {"a layer made too coarse: a level left out",
       [](Damage& d) {
         auto& levels = d.c.expectation.levels_m;
         levels.insert(levels.begin() + 3, 0.5 * (levels[2] + levels[3]));
         return "layer.spans_levels";
       },
       {"layer.incomplete"}},
      {"a layer lost",
       [](Damage& d) {
         d.erase_all(d.cells_in(0, Damage::n, 0, Damage::n, 3));
         return "layer.incomplete";
       },
       {"node.orphan", "face.untagged", "face.tagged_no_cell", "tag.missing", "tag.empty_group"}},
      {"a layer squeezed",
       [](Damage& d) {
         for (int i = 0; i < (Damage::n + 1) * (Damage::n + 1); ++i) d.at(d.node(0, 0, 3) + i)[2] = 143e-6;
         return d.cells == Cells::prisms ? "limit.growth" : "limit.aspect";
       },
       {"limit.aspect", "layer.off_level", "layer.outside", "layer.incomplete", "volume.wrong", "limit.edge", "limit.sliver",
        "limit.quality", "limit.needle"}},
      {"a node close to its neighbour",
       [](Damage& d) {
         d.at(d.node(5, 2 + d.below(3), 4))[0] += 0.999e-3;
         return "limit.needle";
       },
       {"face.not_planar", "limit.sliver", "limit.aspect", "limit.edge", "limit.jacobian"}},
  };
}

}  // namespace pcbmesh::tests
