// SPDX-License-Identifier: GPL-3.0-or-later
// Damage to arrays, nodes and cells, with the code that must be found and what else such a mesh rightly shows.
#pragma once

#include "fault_injector.hpp"

namespace pcbmesh::tests {

/// Moves an inner node to the middle of an edge of its own neighbours, `ulps` beyond it: a triangle there gets no area, or
/// the area of an ulp, on either side.
inline std::string move_onto_edge(Damage& d, int ulps) {
  const int y = 2 + d.below(3), x = 5 + (y + 1) % 2;  // squares of even x + y are cut from here to the far corner
  auto& at = d.at(d.node(x, y, 3));
  at[1] += 0.5e-3;
  at[0] = d.at(d.node(x + 1, y, 3))[0];
  for (int i = 0; i < std::abs(ulps); ++i) at[0] = std::nextafter(at[0], ulps > 0 ? 1 : 0);
  if (ulps == 0) return "cell.flat";
  if (ulps < 0) return "cell.nearly_flat";
  return d.cells == Cells::prisms ? "cell.folded" : "cell.inverted";
}

/// Two cells of their own, apart from all others: an edge of one crosses an edge of the other, `ulps` deep.
inline std::string cross_two_edges(Damage& d, int ulps) {
  double top = 1e-4;
  const auto at = [](double x, double y, double z) { return std::array<double, 3>{1 + x, y, z}; };
  const auto add = [&](std::array<std::int64_t, 4> ids) {
    if (d.six_volumes(ids) < 0) std::swap(ids[2], ids[3]);
    d.add(mesh::CellKind::tetrahedron, {ids.begin(), ids.end()}, Damage::core);
  };
  const std::int64_t a = d.add_node(at(-1e-3, 0, top)), b = d.add_node(at(1e-3, 0, top)), e = d.add_node(at(0, -2e-4, 2e-5)),
                     f = d.add_node(at(0, 3e-4, 1e-5));
  add({a, b, e, f});
  for (int i = 0; i < ulps; ++i) top = std::nextafter(top, 0);
  const std::int64_t p = d.add_node(at(0, -1e-3, top)), q = d.add_node(at(0, 1e-3, top)), r = d.add_node(at(3e-4, 0, 2e-4)),
                     t = d.add_node(at(-2e-4, 0, 3e-4));
  add({p, q, r, t});
  return "boundary.crossing";
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

/// The three tetrahedra of a prism divided anew, so that one of its walls gets the other diagonal.
inline std::string turn_a_wall(Damage& d, int x, int y, const std::vector<Damage::CellAt>& cells) {
  const std::int64_t a = d.node(x, y, 2), b = d.node(x + 1, y, 2), e = d.node(x + 1, y + 1, 2), f = d.node(x, y + 1, 2),
                     up = d.node(0, 0, 1);
  const auto has = [](const auto& ids, std::int64_t id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); };
  const bool rises = std::any_of(cells.begin(), cells.end(), [&](const auto& cell) {
    const auto ids = d.corners(cell);
    return has(ids, a) && has(ids, e);
  });
  // Walls are cut from the smaller node; as if b were smaller than a, the wall between them alone is cut the other way.
  const std::array<std::int64_t, 3> p{b, a, rises ? e : f};
  const std::int32_t tag = d.tag(cells.front());
  std::vector<Damage::CellAt> old;
  for (const auto& cell : cells) {
    const auto ids = d.corners(cell);
    if (std::all_of(ids.begin(), ids.end(), [&](std::int64_t id) { return has(p, id) || has(p, id - up); }))
      old.push_back(cell);
  }
  d.erase_all(old);
  for (std::array<std::int64_t, 4> t : {std::array{p[0], p[1], p[2], p[2] + up}, std::array{p[0], p[1], p[1] + up, p[2] + up},
                                        std::array{p[0], p[0] + up, p[1] + up, p[2] + up}}) {
    if (d.six_volumes(t) < 0) std::swap(t[2], t[3]);
    d.add(mesh::CellKind::tetrahedron, {t[0], t[1], t[2], t[3]}, tag);
  }
  return "boundary.overlap";
}

inline std::string turn_a_diagonal(Damage& d) {
  const int x = 5 + d.below(2), y = 2 + d.below(3);
  auto cells = d.cells_in(x, x + 1, y, y + 1, 2);
  if (!d.has_wedge(cells.front())) return turn_a_wall(d, x, y, cells);
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
       {always("node.orphan", "no node belongs to a cell any more"), always("net.open", "the nets have no copper"),
        always("face.tagged_no_cell", "no tagged face is a face of a cell"),
        always("tag.missing", "no group of tags.json has a cell"), always("tag.empty_group", "the names are still there"),
        always("layer.incomplete", "no layer has a cell")}},
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
       {always("cell.flat", "the edges at that corner lie in one plane: one of them has no length"),
        always("face.untagged", "the neighbours lose the faces they shared with it"),
        always("volume.wrong", "the cell shrinks"),
        perhaps("boundary.open",
                "where two faces of the cell become one face twice, a third cell or the wrong side is found, and the rest does "
                "not close"),
        perhaps("boundary.pinched", "its own faces and those of its neighbours meet at the same edges"),
        perhaps("face.many_owners", "two of its faces become one, with the neighbour as third"),
        perhaps("volume.not_enclosed", "faces of three cells are no boundary"),
        perhaps("face.not_planar", "the wall behind the moved corner is bent"),
        always("limit.needle", "an edge without length"), always("limit.sliver", "an edge without length"),
        always("limit.aspect", "an edge without length"), always("limit.edge", "an edge without length"),
        always("limit.jacobian", "zero at that corner"), perhaps("limit.quality", "a base without area")}},
      {"one node at two corners of a tagged face",
       [](Damage& d) {
         d.c.mesh.faces[0].corners[1] = d.c.mesh.faces[0].corners[0];
         return "face.corner_repeated";
       },
       {always("face.tagged_no_cell", "it is the face of no cell"), always("face.untagged", "the face it was has no tag now"),
        always("face.area", "a quadrangle keeps half its area, a triangle none")}},
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
       {always("boundary.crack", "both sides of the slit lie on each other"),
        always("face.untagged", "both sides of the slit are boundary")}},
      {"layers apart by 1 ulp",
       [](Damage& d) {
         const double z = d.at(d.node(0, 0, 2))[2];
         d.detach_above(2, std::nextafter(z, 1) - z);
         return "node.near_duplicate";
       },
       {always("boundary.crack", "both sides of the gap lie on each other, within the tolerance"),
        always("face.untagged", "both sides of the gap are boundary"),
        always("layer.uneven_level", "one side is an ulp off its level")}},
      {"layers side by side without common nodes",
       [](Damage& d) {
         d.detach_above(2, 0);
         return "boundary.crack";
       },
       {always("node.duplicate", "each node is there twice"), always("face.untagged", "both sides are boundary")}},
      {"a hanging node",
       hang_a_node,
       {always("boundary.overlap", "the halves lie on the whole face of the neighbour"),
        always("face.untagged", "neither is shared"), always("volume.cell_count", "two cells in place of one")}},
      {"a node off its level",
       [](Damage& d) {
         d.at(d.inner_node(3))[2] += 3e-6;
         return "layer.off_level";
       },
       {always("volume.wrong", "the group above grows, the group below shrinks"),
        always("layer.outside", "its cells reach into the next layer")}},
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
       {perhaps("cell.folded", "prisms behind the node keep a good corner"),
        perhaps("cell.inverted", "tetrahedra have one Jacobian only"), always("limit.jacobian", "negative"),
        perhaps("limit.quality", "zero or less for a folded prism"),
        perhaps("face.not_planar", "walls of prisms are bent by it")}},
      {"a node moved onto the opposite edge",
       [](Damage& d) { return move_onto_edge(d, 0); },
       {always("limit.needle", "a triangle without height"), always("limit.jacobian", "zero or nearly so"),
        always("limit.sliver", "angles of the cells over it"),
        perhaps("cell.inverted", "tetrahedra between the levels turn over before"),
        perhaps("face.not_planar", "walls of prisms are bent by it")}},
      {"a node moved short of the opposite edge by 1 ulp",
       [](Damage& d) { return move_onto_edge(d, -1); },
       {always("limit.needle", "a triangle without height"), always("limit.jacobian", "zero or nearly so"),
        perhaps("limit.sliver", "angles of the cells over it"),
        perhaps("cell.inverted", "tetrahedra between the levels turn over before"),
        perhaps("face.not_planar", "walls of prisms are bent by it")}},
      {"a node moved past the opposite edge by 1 ulp",
       [](Damage& d) { return move_onto_edge(d, 1); },
       {always("limit.needle", "a triangle without height"), always("limit.jacobian", "zero or nearly so"),
        perhaps("limit.sliver", "angles of the cells over it"), perhaps("face.not_planar", "walls of prisms are bent by it"),
        perhaps("cell.folded", "prisms keep a good base"), perhaps("cell.inverted", "tetrahedra have one Jacobian only")}},
      {"a whole level moved",
       [](Damage& d) {
         for (int i = 0; i < (Damage::n + 1) * (Damage::n + 1); ++i) d.at(d.node(0, 0, 3) + i)[2] += 5e-6;
         return "layer.off_level";
       },
       {always("layer.outside", "the layers on both sides do not end where they should"),
        always("layer.incomplete", "the level of tags.json has no nodes"),
        always("volume.wrong", "one layer is thicker, one thinner")}},
      {"a node of one periodic side moved along it",
       [](Damage& d) {
         d.at(d.node(Damage::n, 2 + d.below(5), 4))[1] += 0.2e-3;
         return "periodic.unmatched";
       },
       {always("periodic.moved", "it is not where the link takes its partner"),
        perhaps("face.not_planar", "walls of prisms are bent by it")}},
      {"a pair of a periodic link lost",
       [](Damage& d) {
         auto& nodes = d.c.mesh.periodic[0].nodes;
         nodes.erase(nodes.begin() + d.below(static_cast<int>(nodes.size())));
         return "periodic.unmatched";
       },
       {}},
      {"a periodic link to a node that is not there",
       [](Damage& d) {
         d.c.mesh.periodic[0].nodes[3][1] = -1;
         return "periodic.link";
       },
       {always("periodic.unmatched", "faces at that node have no partner")}},
      {"one partner for two nodes of a periodic side",
       [](Damage& d) {
         auto& nodes = d.c.mesh.periodic[0].nodes;
         nodes[4][1] = nodes[3][1];
         return "periodic.link";
       },
       {always("periodic.unmatched", "faces at that node have no partner"),
        always("periodic.moved", "the partner is not where it should be")}},
      {"two partners of a periodic link swapped",
       [](Damage& d) {
         auto& nodes = d.c.mesh.periodic[0].nodes;
         std::swap(nodes[3][1], nodes[14][1]);
         return "periodic.moved";
       },
       {always("periodic.unmatched", "faces at those nodes have no partner")}},
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
       {always("face.same_orientation", "its faces look the other way"),
        always("volume.not_enclosed", "its volume counts negative inside a boundary that counts it"),
        always("volume.wrong", "its volume counts negative"), always("limit.jacobian", "negative"),
        perhaps("limit.quality", "negative for a prism")}},
      {"two corners swapped",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         std::swap(d.corner(cell, 0), d.corner(cell, 1));
         return d.has_wedge(cell) ? "cell.folded" : "cell.inverted";
       },
       {always("face.same_orientation", "the faces that keep their corners look the other way"),
        always("volume.not_enclosed", "its volume is wrong inside a boundary that is right"),
        always("volume.wrong", "its volume is wrong"), always("limit.jacobian", "negative"),
        perhaps("limit.quality", "negative where the base is turned"),
        perhaps("face.untagged", "the walls of a twisted prism are nobody else's"),
        perhaps("boundary.open", "a twisted prism shares some faces the wrong way round"),
        perhaps("face.not_planar", "two walls of a twisted prism are bent"),
        perhaps("limit.sliver", "angles of a twisted prism"),
        perhaps("boundary.crossing", "the walls of a twisted prism cut those of its neighbours"),
        perhaps("boundary.pinched", "twisted walls and the neighbours' walls meet at the same edges"),
        perhaps("limit.growth", "height is volume over area, and a twisted prism has little volume")}},
      {"a flat cell",
       [](Damage& d) {
         const int x = 5 + d.below(2), y = 2 + d.below(3);
         d.at(d.node(x, y, 3))[2] = d.at(d.node(x, y, 2))[2];
         return "cell.flat";
       },
       {always("node.duplicate", "the node lies on the one below"),
        always("layer.spans_levels", "its cells do not reach to their upper level"),
        always("layer.outside", "cells above reach into the layer below"),
        always("volume.wrong", "one group grows, one shrinks"), always("limit.needle", "an edge without length"),
        perhaps("limit.sliver", "of tetrahedra without height"), always("limit.aspect", "an edge without length"),
        always("limit.edge", "an edge without length"), always("limit.jacobian", "zero at those corners")}},
      {"a cell lost inside",
       [](Damage& d) {
         d.erase(d.inner_cell());
         return "face.untagged";
       },
       {always("volume.cell_count", "one cell less than tags.json says"), always("volume.wrong", "its volume is missing")}},
      {"a cell lost at the hull",
       [](Damage& d) {
         d.erase(d.pick(d.cells_in(5, 7, 2, 5, 3)));
         return "face.untagged";
       },
       {always("volume.cell_count", "one cell less than tags.json says"), always("volume.wrong", "its volume is missing"),
        perhaps("face.tagged_no_cell", "its tagged faces are left over"),
        perhaps("boundary.pinched", "the hole of a tetrahedron touches the outside along an edge only")}},
      {"a cell there twice",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         d.add(d.block_of(cell).kind, d.corners(cell), d.tag(cell));
         return "cell.duplicate";
       },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"),
        always("face.many_owners", "each of its faces has three cells"),
        always("volume.not_enclosed", "space is filled twice")}},
      {"a cell there twice, with its own nodes",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         auto p = d.corners(cell);
         for (auto& id : p) id = d.add_node(d.at(id));
         d.add(d.block_of(cell).kind, p, d.tag(cell));
         return "cell.overlap";
       },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"), always("node.duplicate", "the nodes of the copy"),
        always("face.untagged", "the faces of the copy are nobody else's")}},
      {"four hundred cells in one place",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         const auto kind = d.block_of(cell).kind;
         const std::int32_t tag = d.tag(cell);
         const auto original = d.corners(cell);
         for (int i = 0; i < 400; ++i) {
           auto p = original;
           for (auto& id : p) id = d.add_node(d.at(id));
           d.add(kind, p, tag);
         }
         return "boundary.not_searched";
       },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"), always("node.duplicate", "the nodes of the copies"),
        always("face.untagged", "the faces of the copies are nobody else's"),
        always("boundary.crack", "the faces of the copies lie on each other"),
        always("cell.overlap", "the copies fill one place")}},
      {"a third cell on a face",
       [](Damage& d) {
         const auto cell = d.inner_cell();
         auto p = d.corners(cell);
         const auto last = d.centre(p);
         d.add(mesh::CellKind::tetrahedron, {p[0], p[1], p[2], d.add_node(last)}, d.tag(cell));
         return "face.many_owners";
       },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"), always("face.untagged", "its other faces are boundary"),
        always("boundary.open", "they end at the face of three cells, which is none"),
        always("volume.not_enclosed", "it lies inside another cell"),
        always("layer.off_level", "its tip lies between levels")}},
      {"a second mesh laid over the first",
       [](Damage& d) {
         return overlay_a_copy(d, {0.37e-3, 0.41e-3, 13e-6}, 1);
       },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"), always("cell.overlap", "its sides lie in the first mesh"),
        always("face.untagged", "its sides have no tags"), always("layer.off_level", "it is shifted upwards"),
        always("layer.outside", "it is shifted upwards"), always("net.open", "each net has twice its pieces")}},
      {"a second mesh inside the first",
       [](Damage& d) {
         return overlay_a_copy(d, {0, 0, 0}, 0.5);
       },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"),
        always("node.duplicate", "some of its nodes meet nodes of the first"),
        always("face.untagged", "its sides have no tags"), always("layer.off_level", "its levels are others"),
        always("layer.outside", "its levels are others"), always("net.open", "each net has twice its pieces")}},
      {"two cells edge across edge",
       [](Damage& d) { return cross_two_edges(d, 0); },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"), always("face.untagged", "they stand alone"),
        always("layer.off_level", "their tips lie between levels"),
        always("layer.outside", "the upper one is in the wrong layer")}},
      {"two cells edge through edge by 1 ulp",
       [](Damage& d) { return cross_two_edges(d, 1); },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"), always("face.untagged", "they stand alone"),
        always("layer.off_level", "their tips lie between levels"),
        always("layer.outside", "the upper one is in the wrong layer"),
        always("layer.uneven_level", "one edge lies an ulp below its level")}},
      {"the other diagonal in one square",
       turn_a_diagonal,
       {always("face.untagged", "faces of either diagonal are nobody else's")}},
      {"a prism split in tetrahedra",
       split_a_prism,
       {always("face.untagged", "quadrangles against triangles: neither is shared"),
        always("volume.cell_count", "three cells in place of one"),
        always("boundary.pinched", "walls of both divisions meet at the edges of the prism")}},
      {"a pyramid",
       [](Damage& d) {
         const std::int64_t a = d.add_node({1, 0, 0}), b = d.add_node({1.001, 0, 0}), e = d.add_node({1.001, 0.001, 0}),
                            f = d.add_node({1, 0.001, 0}), top = d.add_node({1.0005, 0.0005, 1e-4});
         d.add(mesh::CellKind::pyramid, {a, b, e, f, top}, Damage::core);
         return "profile.palace.pyramids";
       },
       {always("volume.cell_count", "more cells than tags.json says"),
        always("volume.wrong", "their volume is counted besides"), always("face.untagged", "it stands alone")}},
      {"the domain touches itself along an edge",
       [](Damage& d) {
         auto list = d.cells_in(5, 6, 2, 3, 2);
         for (const auto& cell : d.cells_in(6, 7, 3, 4, 2)) list.push_back(cell);
         d.erase_all(std::move(list));
         return "boundary.pinched";
       },
       {always("volume.cell_count", "the cells of two squares are gone"), always("volume.wrong", "and their volume"),
        always("face.untagged", "the walls of the holes have no tag")}},
      {"a layer made too coarse: a level left out",
       [](Damage& d) {
         auto& levels = d.c.expectation.levels_m;
         levels.insert(levels.begin() + 3, 0.5 * (levels[2] + levels[3]));
         return "layer.spans_levels";
       },
       {always("layer.incomplete", "the level of tags.json has no nodes")}},
      {"a layer lost",
       [](Damage& d) {
         d.erase_all(d.cells_in(0, Damage::n, 0, Damage::n, 3));
         return "layer.incomplete";
       },
       {always("node.orphan", "the nodes of its top belong to no cell"), always("face.untagged", "the faces below it are bare"),
        always("face.tagged_no_cell", "its tagged sides are left over"),
        always("tag.missing", "it was the only layer of its group"), always("tag.empty_group", "the name is still there")}},
      {"a layer squeezed",
       [](Damage& d) {
         for (int i = 0; i < (Damage::n + 1) * (Damage::n + 1); ++i) d.at(d.node(0, 0, 3) + i)[2] = 143e-6;
         return d.cells == Cells::prisms ? "limit.growth" : "limit.aspect";
       },
       {always("layer.off_level", "the level is moved"),
        always("layer.outside", "the layers on both sides do not end where they should"),
        always("layer.incomplete", "the level of tags.json has no nodes"),
        always("volume.wrong", "one layer is thicker, one thinner"), always("limit.edge", "8 micrometres, less than the limit"),
        always("limit.aspect", "1.4 mm over 8 micrometres"), perhaps("limit.quality", "of flat prisms"),
        perhaps("limit.sliver", "of flat tetrahedra"), perhaps("limit.needle", "of flat tetrahedra")}},
      {"a node close to its neighbour",
       [](Damage& d) {
         d.at(d.node(5, 2 + d.below(3), 4))[0] += 0.999e-3;
         return "limit.needle";
       },
       {perhaps("face.not_planar", "walls of prisms are bent by it"), perhaps("limit.sliver", "of tetrahedra between the two"),
        always("limit.aspect", "one very short edge"), always("limit.edge", "one very short edge"),
        perhaps("limit.jacobian", "of the cells between the two, unless a diagonal runs between them")}},
  };
}

}  // namespace pcbmesh::tests
