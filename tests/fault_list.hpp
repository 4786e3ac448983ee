// SPDX-License-Identifier: GPL-3.0-or-later
// Every kind of damage, with the code that must be found and what else such a mesh rightly shows.
#pragma once

#include "fault_list_cells.hpp"

namespace pcbmesh::tests {

inline void retag(Damage& d, int x0, int x1, int y0, int y1, int k, std::int32_t tag) {
  for (const auto& cell : d.cells_in(x0, x1, y0, y1, k)) d.tag(cell) = tag;
}

/// All names of one dimension and tag.
inline mesh::GroupName& name_of(Damage& d, int dimension, std::int32_t tag) {
  return *std::find_if(d.c.mesh.names.begin(), d.c.mesh.names.end(),
                       [&](const mesh::GroupName& name) { return name.dimension == dimension && name.tag == tag; });
}

inline std::vector<Fault> tag_faults() {
  return {
      {"a cell under another group of its layer",
       [](Damage& d) {
         d.tag(d.pick(d.cells_in(5, 7, 2, 5, 1))) = Damage::copper_b;
         return "volume.wrong";
       },
       {always("volume.cell_count", "two groups have another number of cells"),
        perhaps("net.open", "it is a piece of its own, unless it touches the net")}},
      {"a cell under a group of another layer",
       [](Damage& d) {
         d.tag(d.pick(d.cells_in(5, 7, 2, 5, 2))) = Damage::cover;
         return "layer.outside";
       },
       {always("volume.cell_count", "two groups have another number of cells"), always("volume.wrong", "and another volume")}},
      {"a cell without a tag",
       [](Damage& d) {
         d.tag(d.inner_cell()) = 0;
         return "tag.not_positive";
       },
       {always("volume.cell_count", "its group has one cell less"), always("volume.wrong", "and less volume")}},
      {"a cell with a negative tag",
       [](Damage& d) {
         d.tag(d.inner_cell()) = -4;
         return "tag.not_positive";
       },
       {always("volume.cell_count", "its group has one cell less"), always("volume.wrong", "and less volume")}},
      {"a cell with a tag nobody knows",
       [](Damage& d) {
         d.tag(d.inner_cell()) = 7;
         return "tag.unexpected";
       },
       {always("volume.cell_count", "its group has one cell less"), always("volume.wrong", "and less volume"),
        always("tag.unnamed", "the file does not name it either")}},
      {"a group merged into another",
       [](Damage& d) {
         retag(d, 0, Damage::n, 0, Damage::n, 3, Damage::prepreg);
         return "tag.missing";
       },
       {always("volume.cell_count", "two groups have another number of cells"), always("volume.wrong", "and another volume"),
        always("tag.empty_group", "its name is still there"), always("layer.outside", "its cells belong to another layer now"),
        always("layer.incomplete", "its layer has no cells")}},
      {"a volume's name dropped",
       [](Damage& d) {
         std::erase_if(d.c.mesh.names, [](const auto& name) { return name.dimension == 3 && name.tag == 3; });
         return "tag.unnamed";
       },
       {}},
      {"all names of volumes dropped",
       [](Damage& d) {
         std::erase_if(d.c.mesh.names, [](const auto& name) { return name.dimension == 3; });
         return "tag.no_names";
       },
       {}},
      {"a group renamed",
       [](Damage& d) {
         name_of(d, 3, 2).name = "F.Cu|copper|C";
         return "tag.name_differs";
       },
       {}},
      {"two groups of one name",
       [](Damage& d) {
         name_of(d, 3, 2).name = name_of(d, 3, 3).name;
         return "tag.name_repeated";
       },
       {always("tag.name_differs", "tags.json has two names")}},
      {"two names for one group",
       [](Damage& d) {
         d.c.mesh.names.push_back({3, 2, "another"});
         return "tag.two_names";
       },
       {}},
      {"a named group without elements",
       [](Damage& d) {
         d.c.mesh.names.push_back({3, 77, "nothing"});
         return "tag.empty_group";
       },
       {}},
      {"another unit of length",
       [](Damage& d) {
         d.c.expectation.unit_m = 1e-3;
         return "volume.wrong";
       },
       {always("face.area", "areas by the square"), always("layer.off_level", "heights too"),
        always("layer.outside", "heights too"), always("layer.incomplete", "heights too"),
        always("limit.edge", "lengths in metres too")}},
      {"a net cut in two",
       [](Damage& d) {
         retag(d, 5, 6, 7, 8, 1, Damage::copper_layer_fill);
         return "net.open";
       },
       {always("volume.cell_count", "two groups have another number of cells"), always("volume.wrong", "and another volume")}},
      {"a bridge between nets",
       [](Damage& d) {
         retag(d, 6, 7, 6, 7, 1, Damage::copper_a);
         return "net.short";
       },
       {always("volume.cell_count", "two groups have another number of cells"), always("volume.wrong", "and another volume")}},
      {"pieces of a net grown together",
       [](Damage& d) {
         retag(d, 4, 5, 5, 6, 1, Damage::copper_b);
         return "net.merged";
       },
       {always("volume.cell_count", "two groups have another number of cells"), always("volume.wrong", "and another volume")}},
  };
}

inline std::vector<Fault> face_faults() {
  return {
      {"a boundary face dropped",
       [](Damage& d) {
         d.erase(d.face_of(Damage::outer));
         return "face.untagged";
       },
       {always("face.count", "its group has one face less"), always("face.area", "and less area")}},
      {"a face under another outer group",
       [](Damage& d) {
         d.tag(d.face_of(Damage::outer)) = Damage::xmin;
         return "face.count";
       },
       {always("face.area", "two groups have another area"),
        always("periodic.unmatched", "a face of a periodic side that the other side has not")}},
      {"a face without a tag",
       [](Damage& d) {
         d.tag(d.face_of(Damage::outer)) = 0;
         return "tag.not_positive";
       },
       {always("face.count", "its group has one face less"), always("face.area", "and less area")}},
      {"a face tagged twice, the same way",
       [](Damage& d) {
         d.add_face(d.corners(d.face_of(Damage::outer)), Damage::outer);
         return "face.tagged_twice";
       },
       {always("face.count", "its group has one face more"), always("face.area", "and more area")}},
      {"a face tagged twice, two ways",
       [](Damage& d) {
         d.add_face(d.corners(d.face_of(Damage::outer)), Damage::ground);
         return "face.tagged_twice";
       },
       {always("face.count", "its group has one face more"), always("face.area", "and more area")}},
      {"a tagged face that is none",
       [](Damage& d) {
         d.add_face({d.node(0, 0, 4), d.node(2, 1, 4), d.node(3, 3, 2)}, Damage::outer);
         return "face.tagged_no_cell";
       },
       {always("face.count", "its group has one face more"), always("face.area", "and more area")}},
      {"one side of a wall split in triangles",
       [](Damage& d) {
         if (d.cells == Cells::tetrahedra) return "";
         auto face = d.face_of(Damage::wave_port);
         while (d.corners(face).size() != 4) face = d.face_of(Damage::wave_port);
         const auto p = d.corners(face);
         d.erase(face);
         d.add_face({p[0], p[1], p[2]}, Damage::wave_port);
         d.add_face({p[0], p[2], p[3]}, Damage::wave_port);
         return "face.tagged_no_cell";
       },
       {always("face.untagged", "the quadrangle of the cell has no tag"), always("face.count", "two faces in place of one")}},
      {"two triangles of a wall tagged as one quadrangle",
       [](Damage& d) {
         if (d.cells == Cells::prisms) return "";
         // The square of a wall is cut from its smaller lower node to the larger upper one.
         const int x = d.below(Damage::n);
         const std::int64_t a = d.node(x, 0, 1), b = d.node(x + 1, 0, 1), up = d.node(0, 0, 1);
         for (const auto& corners : {std::vector{a, b, b + up}, std::vector{a, b + up, a + up}}) {
           for (std::size_t k = 0; k < d.c.mesh.faces.size(); ++k) {
             for (std::int64_t i = d.c.mesh.faces[k].size() - 1; i >= 0; --i) {
               if (d.corners(Damage::FaceAt{k, i}) == corners) d.erase(Damage::FaceAt{k, i});
             }
           }
         }
         d.add_face({a, b, b + up, a + up}, Damage::wave_port);
         return "face.tagged_no_cell";
       },
       {always("face.untagged", "the triangles of the cells have no tag"), always("face.count", "one face in place of two")}},
      {"an inner face in an outer group",
       [](Damage& d) { return add_inner_face_to(d, Damage::outer, "face.outer_tag_inside"); },
       {always("face.count", "its group has one face more"), always("face.area", "and more area"),
        always("face.tag_mixes", "the group has faces inside and outside")}},
      {"an inner face in a conductor's group",
       [](Damage& d) { return add_inner_face_to(d, Damage::ground, "face.tag_mixes"); },
       {always("face.count", "its group has one face more"), always("face.area", "and more area")}},
      {"a boundary face turned inwards",
       [](Damage& d) {
         const auto face = d.face_of(Damage::outer);
         auto& block = d.c.mesh.faces[face.block];
         const auto size = static_cast<std::size_t>(corners_of(block.kind));
         std::swap(block.corners[static_cast<std::size_t>(face.index) * size],
                   block.corners[static_cast<std::size_t>(face.index) * size + 2]);
         return "face.tagged_inward";
       },
       {}},
      {"no tagged faces at all",
       [](Damage& d) {
         d.c.mesh.faces.clear();
         d.c.expectation.faces.clear();
         d.c.expectation.periodic.clear();
         return "face.none_tagged";
       },
       {always("tag.empty_group", "their names are still there"),
        always("profile.palace.no_boundary", "no boundary elements")}},
  };
}

inline std::vector<Fault> solver_faults() {
  return {
      {"MSH 4.1 for Palace",
       [](Damage& d) {
         d.c.mesh.format.version = "4.1";
         return "profile.palace.format";
       },
       {}},
      {"elements without a group",
       [](Damage& d) {
         d.c.mesh.num_untagged[2] = 3;
         return "profile.palace.untagged_elements";
       },
       {}},
      {"attributes with gaps",
       [](Damage& d) {
         for (auto& block : d.c.mesh.faces) {
           for (auto& tag : block.tags) tag = tag == Damage::wave_port ? 70 : tag;
         }
         name_of(d, 2, Damage::wave_port).tag = 70;
         d.c.expectation.faces.back().tag = 70;
         return "profile.palace.sparse_attributes";
       },
       {}},
      {"a sheet one element wide",
       [](Damage& d) {
         // Palace divides all cells into tetrahedra there: nothing to do on tetrahedra.
         if (d.cells == Cells::tetrahedra) return "";
         for (auto& block : d.c.mesh.faces) {
           for (std::int64_t i = block.size() - 1; i >= 0; --i) {
             const Damage::FaceAt face{static_cast<std::size_t>(&block - d.c.mesh.faces.data()), i};
             if (d.tag(face) == Damage::sheet && d.centre(d.corners(face))[1] > 2e-3) d.erase(face);
           }
         }
         return "profile.palace.chord";
       },
       {always("face.count", "its group has fewer faces"), always("face.area", "and less area"),
        always("profile.palace.port_conductors", "the port stood under the part that is gone")}},
      {"a lumped port that is not flat",
       [](Damage& d) {
         d.at(d.node(2, 3, 0))[1] += 0.1e-3;
         return "profile.palace.port_not_planar";
       },
       {always("face.area", "the moved node stretches its faces"),
        perhaps("face.not_planar", "walls of prisms are bent by it")}},
      {"a lumped port with a corner too many",
       [](Damage& d) {
         for (const auto& cell : d.cells_in(1, 2, 2, 3, 1)) {
           for (const auto& face : d.faces_of_cell(cell)) {
             const bool in_plane = std::all_of(face.begin(), face.end(), [&](std::int64_t id) { return d.at(id)[1] == 3e-3; });
             if (!in_plane) continue;
             d.add_face(face, Damage::port);
             return "profile.palace.port_not_rectangular";
           }
         }
         return "";
       },
       {always("face.count", "its group has one face more"), always("face.area", "and more area")}},
      {"a lumped port with one conductor",
       [](Damage& d) {
         for (auto& block : d.c.mesh.faces) {
           for (std::int64_t i = block.size() - 1; i >= 0; --i) {
             const Damage::FaceAt face{static_cast<std::size_t>(&block - d.c.mesh.faces.data()), i};
             if (d.tag(face) == Damage::sheet) d.erase(face);
           }
         }
         return "profile.palace.port_conductors";
       },
       {always("tag.missing", "the sheet has no faces"), always("tag.empty_group", "its name is still there"),
        always("profile.palace.sparse_attributes", "its attribute is not in use")}},
      {"a wave port between cells",
       [](Damage& d) { return add_inner_face_to(d, Damage::wave_port, "profile.palace.wave_port_inside"); },
       {always("face.count", "its group has one face more"), always("face.area", "and more area"),
        always("profile.palace.wave_port_not_planar", "the face lies out of the plane of the port"),
        always("face.outer_tag_inside", "a wave port is an outer group"),
        always("face.tag_mixes", "the group has faces inside and outside")}},
      {"a wave port round a corner",
       [](Damage& d) {
         d.tag(d.face_of(Damage::outer)) = Damage::wave_port;
         return "profile.palace.wave_port_not_planar";
       },
       {always("face.count", "two groups have another number of faces"), always("face.area", "and another area")}},
  };
}

/// The mesh is as good as before, but meant for another solver.
inline std::string for_solver(Damage& d, const char* solver, const char* code) {
  d.options.profile = validation::find_profile(solver);
  return code;
}

/// Nodes of second order: as many as given per prism and quadrangle, or none. Where they lie is nobody's matter here.
inline void add_mids(Damage& d, std::int32_t per_prism, std::int32_t per_quadrangle) {
  for (auto& block : d.c.mesh.cells) {
    block.num_mid = block.kind == mesh::CellKind::wedge ? per_prism : 6;
    block.mids.assign(static_cast<std::size_t>(block.num_mid) * block.tags.size(), 0);
  }
  for (auto& block : d.c.mesh.faces) {
    block.num_mid = block.kind == mesh::FaceKind::quadrangle ? per_quadrangle : 3;
    block.mids.assign(static_cast<std::size_t>(block.num_mid) * block.tags.size(), 0);
  }
}

inline void faces_of_first_order(Damage& d) {
  for (auto& block : d.c.mesh.faces) {
    block.num_mid = 0;
    block.mids.clear();
  }
}

inline std::vector<Fault> other_solver_faults() {
  return {
      {"prisms of 15 nodes for Palace",
       [](Damage& d) {
         add_mids(d, 9, 4);
         return d.cells == Cells::tetrahedra ? "" : "profile.palace.incomplete_elements";
       },
       {}},
      {"cells of second order, faces of first, for Palace",
       [](Damage& d) {
         add_mids(d, 12, 5);
         faces_of_first_order(d);
         return "profile.palace.mixed_orders";
       },
       {}},
      {"MSH 4.1 for MFEM",
       [](Damage& d) {
         d.c.mesh.format.version = "4.1";
         return for_solver(d, "mfem", "profile.mfem.format");
       },
       {}},
      {"elements without a group, for MFEM",
       [](Damage& d) {
         d.c.mesh.num_untagged[1] = 3;
         return for_solver(d, "mfem", "profile.mfem.untagged_elements");
       },
       {}},
      {"attributes with gaps, for MFEM",
       [](Damage& d) {
         for (auto& block : d.c.mesh.faces) std::replace(block.tags.begin(), block.tags.end(), Damage::wave_port, 70);
         name_of(d, 2, Damage::wave_port).tag = 70;
         d.c.expectation.faces.back().tag = 70;
         return for_solver(d, "mfem", "profile.mfem.sparse_attributes");
       },
       {}},
      {"prisms of 15 nodes for MFEM",
       [](Damage& d) {
         add_mids(d, 9, 4);
         return d.cells == Cells::tetrahedra ? "" : for_solver(d, "mfem", "profile.mfem.incomplete_elements");
       },
       {}},
      {"cells of second order, faces of first, for MFEM",
       [](Damage& d) {
         add_mids(d, 12, 5);
         faces_of_first_order(d);
         return for_solver(d, "mfem", "profile.mfem.mixed_orders");
       },
       {}},
      {"MSH 4.1 for GetDP",
       [](Damage& d) {
         d.c.mesh.format.version = "4.1";
         return for_solver(d, "getdp", "profile.getdp.format");
       },
       {always("profile.getdp.shared_region", "volumes and faces are both numbered from 1")}},
      {"one number for volumes and faces, for GetDP",
       [](Damage& d) { return for_solver(d, "getdp", "profile.getdp.shared_region"); },
       {}},
      {"prisms of 18 nodes for GetDP",
       [](Damage& d) {
         add_mids(d, 12, 5);
         return d.cells == Cells::tetrahedra ? "" : for_solver(d, "getdp", "profile.getdp.second_order_prisms");
       },
       {always("profile.getdp.shared_region", "volumes and faces are both numbered from 1")}},
      {"a binary file for Elmer", [](Damage& d) { return for_solver(d, "elmer", "profile.elmer.format"); }, {}},
      {"prisms of 15 nodes for Elmer",
       [](Damage& d) {
         add_mids(d, 9, 4);
         d.c.mesh.format.is_binary = false;
         return d.cells == Cells::tetrahedra ? "" : for_solver(d, "elmer", "profile.elmer.second_order_prisms");
       },
       {}},
      {"two kinds of cells for dolfinx",
       [](Damage& d) { return d.cells == Cells::mixed ? for_solver(d, "dolfinx", "profile.dolfinx.mixed_cells") : ""; },
       {always("profile.dolfinx.prisms", "one kind of them"),
        always("profile.dolfinx.face_tags", "and they have tagged faces")}},
      {"prisms for dolfinx",
       [](Damage& d) {
         d.c.mesh.faces.clear();
         d.c.expectation.faces.clear();
         d.c.expectation.periodic.clear();
         d.c.mesh.periodic.clear();
         std::erase_if(d.c.mesh.names, [](const auto& name) { return name.dimension == 2; });
         return d.cells == Cells::tetrahedra ? "" : for_solver(d, "dolfinx", "profile.dolfinx.prisms");
       },
       {perhaps("profile.dolfinx.mixed_cells", "the mixed mesh has tetrahedra besides"),
        always("face.none_tagged", "the faces were taken away, so as not to be in the way")}},
      {"tagged faces of prisms for dolfinx",
       [](Damage& d) { return d.cells == Cells::tetrahedra ? "" : for_solver(d, "dolfinx", "profile.dolfinx.face_tags"); },
       {always("profile.dolfinx.prisms", "these are the prisms"),
        perhaps("profile.dolfinx.mixed_cells", "the mixed mesh has tetrahedra besides")}},
  };
}

inline std::vector<Fault> all_faults() {
  std::vector<Fault> all;
  for (auto part :
       {array_faults(), node_faults(), cell_faults(), tag_faults(), face_faults(), solver_faults(), other_solver_faults()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace pcbmesh::tests
