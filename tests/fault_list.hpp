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
  const std::vector<std::string> counts{"volume.cell_count", "volume.wrong"};
  return {
      {"a cell under another group of its layer",
       [](Damage& d) {
         d.tag(d.pick(d.cells_in(5, 7, 2, 5, 1))) = Damage::copper_b;
         return "volume.wrong";
       },
       {"volume.cell_count", "net.open"}},
      {"a cell under a group of another layer",
       [](Damage& d) {
         d.tag(d.pick(d.cells_in(5, 7, 2, 5, 2))) = Damage::cover;
         return "layer.outside";
       },
       counts},
      {"a cell without a tag",
       [](Damage& d) {
         d.tag(d.inner_cell()) = 0;
         return "tag.not_positive";
       },
       counts},
      {"a cell with a negative tag",
       [](Damage& d) {
         d.tag(d.inner_cell()) = -4;
         return "tag.not_positive";
       },
       counts},
      {"a cell with a tag nobody knows",
       [](Damage& d) {
         d.tag(d.inner_cell()) = 7;
         return "tag.unexpected";
       },
       counts + std::vector<std::string>{"tag.unnamed"}},
      {"a group merged into another",
       [](Damage& d) {
         retag(d, 0, Damage::n, 0, Damage::n, 3, Damage::prepreg);
         return "tag.missing";
       },
       counts + std::vector<std::string>{"tag.empty_group", "layer.outside", "layer.incomplete"}},
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
       {"tag.name_differs"}},
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
       {"face.area", "layer.off_level", "layer.outside", "layer.incomplete", "limit.edge"}},
      {"a net cut in two",
       [](Damage& d) {
         retag(d, 5, 6, 7, 8, 1, Damage::copper_layer_fill);
         return "net.open";
       },
       counts},
      {"a bridge between nets",
       [](Damage& d) {
         retag(d, 6, 7, 6, 7, 1, Damage::copper_a);
         return "net.short";
       },
       counts},
      {"pieces of a net grown together",
       [](Damage& d) {
         retag(d, 4, 5, 5, 6, 1, Damage::copper_b);
         return "net.merged";
       },
       counts},
  };
}

inline std::vector<Fault> face_faults() {
  const std::vector<std::string> counts{"face.count", "face.area"};
  return {
      {"a boundary face dropped",
       [](Damage& d) {
         d.erase(d.face_of(Damage::outer));
         return "face.untagged";
       },
       counts},
      {"a face under another outer group",
       [](Damage& d) {
         d.tag(d.face_of(Damage::outer)) = Damage::xmin;
         return "face.count";
       },
       {"face.area", "periodic.unmatched"}},
      {"a face without a tag",
       [](Damage& d) {
         d.tag(d.face_of(Damage::outer)) = 0;
         return "tag.not_positive";
       },
       counts},
      {"a face tagged twice, the same way",
       [](Damage& d) {
         d.add_face(d.corners(d.face_of(Damage::outer)), Damage::outer);
         return "face.tagged_twice";
       },
       counts},
      {"a face tagged twice, two ways",
       [](Damage& d) {
         d.add_face(d.corners(d.face_of(Damage::outer)), Damage::ground);
         return "face.tagged_twice";
       },
       counts},
      {"a tagged face that is none",
       [](Damage& d) {
         d.add_face({d.node(0, 0, 4), d.node(2, 1, 4), d.node(3, 3, 2)}, Damage::outer);
         return "face.tagged_no_cell";
       },
       counts},
      {"one side of a wall split in triangles",
       [](Damage& d) {
         if (d.cells != Cells::prisms) return "";
         auto face = d.face_of(Damage::wave_port);
         const auto p = d.corners(face);
         d.erase(face);
         d.add_face({p[0], p[1], p[2]}, Damage::wave_port);
         d.add_face({p[0], p[2], p[3]}, Damage::wave_port);
         return "face.tagged_no_cell";
       },
       {"face.untagged", "face.count"}},
      {"an inner face in an outer group",
       [](Damage& d) { return add_inner_face_to(d, Damage::outer, "face.outer_tag_inside"); },
       counts + std::vector<std::string>{"face.tag_mixes"}},
      {"an inner face in a conductor's group", [](Damage& d) { return add_inner_face_to(d, Damage::ground, "face.tag_mixes"); },
       counts},
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
       {"tag.empty_group", "profile.palace.no_boundary"}},
  };
}

inline std::vector<Fault> solver_faults() {
  const std::vector<std::string> counts{"face.count", "face.area"};
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
         if (d.cells == Cells::tetrahedra) return "";
         for (auto& block : d.c.mesh.faces) {
           for (std::int64_t i = block.size() - 1; i >= 0; --i) {
             const Damage::FaceAt face{static_cast<std::size_t>(&block - d.c.mesh.faces.data()), i};
             if (d.tag(face) == Damage::sheet && d.centre(d.corners(face))[1] > 2e-3) d.erase(face);
           }
         }
         return "profile.palace.chord";
       },
       counts + std::vector<std::string>{"profile.palace.port_conductors"}},
      {"a lumped port that is not flat",
       [](Damage& d) {
         d.at(d.node(2, 3, 0))[1] += 0.1e-3;
         return "profile.palace.port_not_planar";
       },
       {"face.not_planar", "face.area"}},
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
       counts},
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
       {"tag.missing", "tag.empty_group", "profile.palace.sparse_attributes"}},
      {"a wave port between cells",
       [](Damage& d) { return add_inner_face_to(d, Damage::wave_port, "profile.palace.wave_port_inside"); },
       counts + std::vector<std::string>{"profile.palace.wave_port_not_planar", "face.outer_tag_inside", "face.tag_mixes"}},
      {"a wave port round a corner",
       [](Damage& d) {
         d.tag(d.face_of(Damage::outer)) = Damage::wave_port;
         return "profile.palace.wave_port_not_planar";
       },
       counts},
  };
}

inline std::vector<Fault> all_faults() {
  std::vector<Fault> all;
  for (auto part : {array_faults(), node_faults(), cell_faults(), tag_faults(), face_faults(), solver_faults()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace pcbmesh::tests
