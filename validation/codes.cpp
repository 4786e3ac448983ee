// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/validation/codes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace pcbmesh::validation {
namespace {

// The order is the order of docs/checks.md. Adding a line here needs one there: validation_outputs_test.cpp compares them.
constexpr CheckCode table[] = {
    {"array.size", FindingSeverity::error, "Arrays",
     "corners and tags of a block do not fit together; nothing else was checked",
     "the file is damaged or its reader is wrong: write the mesh again"},
    {"array.kind", FindingSeverity::error, "Arrays", "a block of an unknown element kind; nothing else was checked",
     "the file is damaged or its reader is wrong: write the mesh again"},
    {"mesh.empty", FindingSeverity::error, "Arrays", "no cells",
     "check that the region of interest holds something and that the right file was given"},
    {"node.not_finite", FindingSeverity::error, "Arrays",
     "a coordinate is infinite, not a number or beyond 1e90; volumes and geometry were not checked",
     "find the step that made the coordinate; often a text file cut short"},
    {"cell.corner_out_of_range", FindingSeverity::error, "Arrays",
     "a cell or tagged face names a node that does not exist; faces and nets were not checked",
     "the file is damaged, or ids were counted from 1 instead of 0"},
    {"face.corner_out_of_range", FindingSeverity::error, "Arrays",
     "a cell or tagged face names a node that does not exist; faces and nets were not checked",
     "the file is damaged, or ids were counted from 1 instead of 0"},
    {"cell.corner_repeated", FindingSeverity::error, "Arrays", "one node stands at two corners: the element is degenerate",
     "remove the element, or use the kind with fewer corners"},
    {"face.corner_repeated", FindingSeverity::error, "Arrays", "one node stands at two corners: the element is degenerate",
     "remove the element, or use the kind with fewer corners"},
    {"node.orphan", FindingSeverity::error, "Nodes", "a node belongs to no cell: a solver's matrix gets an empty row",
     "drop unused nodes when writing"},
    {"node.duplicate", FindingSeverity::error, "Nodes",
     "a node has exactly the coordinates of an earlier one: usually a crack (see boundary.crack)", "merge the nodes"},
    {"node.near_duplicate", FindingSeverity::error, "Nodes", "a node lies within the tolerance of an earlier one",
     "merge the nodes; if the gap is meant, it is too narrow for the size of the board"},
    {"node.hanging", FindingSeverity::error, "Nodes",
     "a node lies inside an edge or face of the boundary without being its corner: the neighbours are divided differently "
     "(T-junction)",
     "divide both sides alike"},
    {"cell.inverted", FindingSeverity::error, "Cells", "Jacobian negative at every corner: corners listed in the wrong order",
     "swap two corners of each base, or upper and lower base"},
    {"cell.folded", FindingSeverity::error, "Cells",
     "Jacobian negative at some corners: a node passed through a face of its cell",
     "undo the motion of the node; mesh finer there"},
    {"cell.flat", FindingSeverity::error, "Cells", "a corner without volume: coinciding nodes, or edges in one plane",
     "remove the cell; look for layers of no height"},
    {"cell.duplicate", FindingSeverity::error, "Cells", "the same corners as an earlier cell", "remove one of them"},
    {"cell.overlap", FindingSeverity::error, "Cells",
     "space behind boundary faces is filled more than once: two meshes laid over each other, or cells inside other cells, "
     "without shared nodes",
     "mesh the parts together, or remove one of them"},
    {"face.many_owners", FindingSeverity::error, "Faces", "three or more cells share one face: cells overlap",
     "remove the extra cell; see cell.duplicate"},
    {"face.same_orientation", FindingSeverity::error, "Faces",
     "both cells of a face lie on the same side of it: one is inside out or they overlap", "see cell.inverted"},
    {"face.untagged", FindingSeverity::error, "Faces",
     "a boundary face carries no tagged face. On the outside: forgotten. Inside: a hole, a crack or a mismatch, and a solver "
     "would put a magnetic wall there",
     "tag it if it is outside; else see node.hanging, boundary.*"},
    {"face.none_tagged", FindingSeverity::warning, "Faces",
     "the mesh has no tagged faces at all, so that the boundary can be judged from geometry only", "write boundary groups"},
    {"face.tagged_twice", FindingSeverity::error, "Faces", "a tagged face repeats another, under the same tag or a second one",
     "keep one"},
    {"face.tagged_no_cell", FindingSeverity::error, "Faces",
     "a tagged face is a face of no cell; several solvers refuse such a file", "remove it, or restore the cell"},
    {"face.tag_mixes", FindingSeverity::error, "Faces", "one group holds boundary faces and faces between two cells",
     "split the group"},
    {"face.outer_tag_inside", FindingSeverity::error, "Faces",
     "tags.json says the group is outer, but the face lies between two cells", "tag the boundary only"},
    {"face.tagged_inward", FindingSeverity::warning, "Faces",
     "a tagged boundary face is turned inwards: its normal has the wrong sign where a solver uses it", "reverse its corners"},
    {"face.count", FindingSeverity::error, "Faces", "a face group has another number of faces or area than tags.json says",
     "the mesh and tags.json are from different runs, or faces carry the wrong tag"},
    {"face.area", FindingSeverity::error, "Faces", "a face group has another number of faces or area than tags.json says",
     "the mesh and tags.json are from different runs, or faces carry the wrong tag"},
    {"face.not_planar", FindingSeverity::warning, "Faces",
     "a quadrangle of a cell is not flat: its diagonals miss each other (limit max_warp, 1e-3 of their length if not given)",
     "move the node back into the plane, or split the face; prisms of boards have flat walls"},
    {"boundary.open", FindingSeverity::error, "Boundary",
     "at an edge the faces of the boundary do not cancel: it is no closed surface",
     "follows from face.many_owners or face.same_orientation; mend those first"},
    {"boundary.pinched", FindingSeverity::warning, "Boundary",
     "four or more boundary faces meet at an edge: the domain touches itself there only. Right in itself, but some solvers "
     "want a manifold boundary",
     "widen the gap or the contact in the layout"},
    {"boundary.crack", FindingSeverity::error, "Boundary",
     "two boundary faces lie on each other, corner on corner, with different nodes", "merge the nodes of both sides"},
    {"boundary.quad_on_triangles", FindingSeverity::error, "Boundary", "a quadrangle meets triangles over the same corners",
     "split both sides alike, or put pyramids between"},
    {"boundary.overlap", FindingSeverity::error, "Boundary",
     "two boundary faces in one plane overlap: other diagonal, other division, or layers that share no nodes",
     "divide both sides alike"},
    {"boundary.not_searched", FindingSeverity::warning, "Boundary",
     "so many faces lie on top of each other that the search was given up", "mend the other findings, then check again"},
    {"boundary.crossing", FindingSeverity::error, "Boundary",
     "two boundary faces cut through each other: the cells behind them overlap",
     "mesh the parts together, so that they share nodes"},
    {"volume.not_enclosed", FindingSeverity::error, "Volumes", "the sum of all cells is not the volume their boundary encloses",
     "see face.many_owners, face.same_orientation, cell.inverted"},
    {"volume.wrong", FindingSeverity::error, "Volumes",
     "a group's volume is not the one in tags.json (area times height from the layout)",
     "wrong tags, missing cells, moved nodes, or another unit of length"},
    {"volume.cell_count", FindingSeverity::error, "Volumes", "a group has another number of cells than tags.json says",
     "wrong tags, missing cells, moved nodes, or another unit of length"},
    {"tag.not_positive", FindingSeverity::error, "Tags and names", "elements without a tag (0) or with a negative one",
     "give every cell and tagged face a positive tag"},
    {"tag.unnamed", FindingSeverity::error, "Tags and names", "a tag in use has no name, though other tags have", "name it"},
    {"tag.no_names", FindingSeverity::warning, "Tags and names",
     "the file names no group of this dimension (some formats can't)", "rely on tags.json"},
    {"tag.two_names", FindingSeverity::error, "Tags and names", "one tag with two names, or two tags with one name",
     "make names unique"},
    {"tag.name_repeated", FindingSeverity::error, "Tags and names", "one tag with two names, or two tags with one name",
     "make names unique"},
    {"tag.name_differs", FindingSeverity::error, "Tags and names", "the mesh and tags.json name a tag differently",
     "they are from different runs"},
    {"tag.empty_group", FindingSeverity::warning, "Tags and names", "a named group without elements", "drop the name"},
    {"tag.missing", FindingSeverity::error, "Tags and names", "a tag of tags.json is carried by no element",
     "cells or faces were lost, or the files are from different runs"},
    {"tag.unexpected", FindingSeverity::error, "Tags and names", "elements carry a tag that tags.json does not know",
     "cells or faces were lost, or the files are from different runs"},
    {"net.open", FindingSeverity::error, "Nets",
     "a net falls into more pieces than in the layout, or has no copper at all; the places are the narrowest gaps",
     "lower the snapping tolerance or mesh size there"},
    {"net.merged", FindingSeverity::error, "Nets", "pieces of one net that are apart in the layout have grown together",
     "lower the snapping tolerance or mesh size there"},
    {"net.short", FindingSeverity::error, "Nets", "copper of two nets shares faces, and the layout does not let them touch",
     "as above; if the contact is meant, it belongs in touching_nets"},
    {"layer.outside", FindingSeverity::error, "Layers", "a cell reaches beyond the heights of the layer its group belongs to",
     "wrong tag, or nodes moved up or down"},
    {"layer.off_level", FindingSeverity::error, "Layers", "a node lies on none of the levels of tags.json",
     "the mesh and tags.json are from different runs, or nodes were moved"},
    {"layer.uneven_level", FindingSeverity::warning, "Layers",
     "a node lies within the tolerance of its level but not exactly on it: levels that should be one plane are not",
     "write coordinates with 17 digits, in binary, or in one precision throughout"},
    {"layer.spans_levels", FindingSeverity::error, "Layers",
     "a cell does not reach from one level to the next: it leaves a level out, or lies in one", "divide it at the level"},
    {"layer.incomplete", FindingSeverity::error, "Layers",
     "a level without nodes, or a sub-layer without any cell of its layer",
     "cells were lost, or the files are from different runs"},
    {"periodic.unmatched", FindingSeverity::error, "Periodic",
     "a face of a periodic group has no partner of the same corners in the other group", "mesh both sides alike"},
    {"limit.needle", FindingSeverity::error, "Limits", "the smallest angle in a face of a cell is below min_face_angle_deg",
     "raise the angle bound of the mesher, or its tolerance where features nearly touch"},
    {"limit.sliver", FindingSeverity::error, "Limits",
     "an angle between two faces of a cell is below min_dihedral_deg or above max_dihedral_deg",
     "as for limit.needle; for tetrahedra, smooth or flip"},
    {"limit.aspect", FindingSeverity::error, "Limits",
     "the longest edge of a cell is more than max_aspect_ratio times its shortest",
     "smaller triangles over thin layers, or fewer sub-layers"},
    {"limit.growth", FindingSeverity::error, "Limits",
     "stacked prisms or hexahedra differ in height by more than max_height_growth", "more sub-layers in the thicker layer"},
    {"limit.edge", FindingSeverity::error, "Limits", "an edge is shorter than min_edge_m",
     "raise the tolerance, or leave out layers this thin"},
    {"limit.jacobian", FindingSeverity::error, "Limits", "the smallest scaled Jacobian of a cell is below min_scaled_jacobian",
     "as for limit.needle"},
    {"limit.quality", FindingSeverity::error, "Limits", "the quality q_p of a prism is below min_prism_quality",
     "see docs/quality.md: heights that fit the triangles"},
    {"profile.palace.format", FindingSeverity::error, "Profile palace",
     "the file is MSH 4, and the reader of Palace knows 2.2 only: it misreads later versions without a word",
     "write MSH 2.2 (--msh-version 2.2; in Gmsh Mesh.MshFileVersion = 2.2)"},
    {"profile.palace.untagged_elements", FindingSeverity::error, "Profile palace",
     "points, lines or faces of the file belong to no group beside others that do: the reader aborts",
     "put them in groups, or leave them out (in Gmsh Mesh.SaveAll = 0)"},
    {"profile.palace.sparse_attributes", FindingSeverity::warning, "Profile palace",
     "attributes are not 1, 2, ..., n: allowed, but tables by attribute get holes", "number groups without gaps"},
    {"profile.palace.pyramids", FindingSeverity::error, "Profile palace", "cells are pyramids",
     "mesh without pyramids: prisms and tetrahedra meet at triangles only"},
    {"profile.palace.no_boundary", FindingSeverity::error, "Profile palace",
     "no boundary elements: no port, no conductor, no absorbing side", "write the tagged faces too"},
    {"profile.palace.chord", FindingSeverity::error, "Profile palace",
     "an edge inside a sheet joins two points of its rim: Palace divides the whole mesh into tetrahedra before it cuts it "
     "there",
     "two triangles or more across every sheet, or RefineCrackElements false"},
    {"profile.palace.port_not_planar", FindingSeverity::error, "Profile palace", "a lumped port is not flat",
     "draw the port in one plane"},
    {"profile.palace.port_not_rectangular", FindingSeverity::error, "Profile palace", "a lumped port does not fill a rectangle",
     "draw it as a rectangle; of ports that tags.json calls coaxial this is not asked"},
    {"profile.palace.port_conductors", FindingSeverity::error, "Profile palace",
     "a lumped port does not touch two conductors with attributes of their own",
     "extend the port to signal and ground, and give them different tags"},
    {"profile.palace.wave_port_inside", FindingSeverity::error, "Profile palace",
     "faces of a wave port lie between two cells: it needs one side only", "move the port to the outside of the domain"},
    {"profile.palace.wave_port_not_planar", FindingSeverity::error, "Profile palace", "a wave port is not flat",
     "cut the domain flat at the port"},
    {"profile.mfem.format", FindingSeverity::error, "Profile mfem",
     "the file is MSH 4, and MFEM up to 4.9 reads 2.2 only: it misreads later versions without a word",
     "write MSH 2.2, or use a later MFEM"},
    {"profile.mfem.untagged_elements", FindingSeverity::error, "Profile mfem",
     "points, lines or faces of the file belong to no group beside others that do: the reader aborts",
     "put them in groups, or leave them out"},
    {"profile.mfem.sparse_attributes", FindingSeverity::warning, "Profile mfem",
     "attributes are not 1, 2, ..., n: tables by attribute get holes", "number groups without gaps"},
    {"profile.getdp.format", FindingSeverity::error, "Profile getdp",
     "the file is MSH 4; GetDP without Gmsh's library reads 2.2 only", "write MSH 2.2"},
    {"profile.getdp.shared_region", FindingSeverity::warning, "Profile getdp",
     "one number names both a volume group and a face group, and Region[n] takes both", "number volumes and faces apart"},
    {"profile.elmer.format", FindingSeverity::error, "Profile elmer", "the file is binary, and ElmerGrid reads text only",
     "write text (--ascii)"},
    {"profile.dolfinx.mixed_cells", FindingSeverity::error, "Profile dolfinx",
     "the mesh mixes kinds of cells; dolfinx reads one kind", "split everything into tetrahedra"},
    {"profile.dolfinx.prisms", FindingSeverity::error, "Profile dolfinx",
     "cells are prisms, on which there are no edge elements: scalar problems only", "use the tetrahedral twin of the mesh"},
    {"profile.dolfinx.face_tags", FindingSeverity::error, "Profile dolfinx",
     "faces are tagged on a mesh with prisms: the reader refuses them", "use the tetrahedral twin, or find faces by place"},
    {"certificate.file_differs", FindingSeverity::error, "Certificate",
     "a file has another SHA-256 than the certificate says: it was changed or comes from another run",
     "use the files of the run, or mesh again"},
    {"certificate.verdict_differs", FindingSeverity::error, "Certificate",
     "a check looked at or found another number of things than the certificate says",
     "see certificate.file_differs; if the files agree, the versions of pcbmesh differ"},
    {"certificate.volume_differs", FindingSeverity::error, "Certificate",
     "the volume of a group or material is not the one in the certificate", "see certificate.file_differs"},
};

}  // namespace

std::span<const CheckCode> check_codes() {
  return table;
}

const CheckCode* find_check_code(std::string_view code) {
  const auto found = std::ranges::find(table, code, &CheckCode::code);
  return found == std::end(table) ? nullptr : found;
}

std::string list_check_codes() {
  std::string text;
  std::string_view subject;
  for (const CheckCode& entry : table) {
    if (entry.subject != subject) text += fmt::format("{}{}\n", text.empty() ? "" : "\n", entry.subject);
    subject = entry.subject;
    text += fmt::format("  {:<34} {:<8} {}\n", entry.code, word_of(entry.severity), entry.meaning);
  }
  return text;
}

std::string explain_check_code(const CheckCode& entry) {
  return fmt::format("{} ({})\n  meaning  {}\n  remedy   {}\n", entry.code, word_of(entry.severity), entry.meaning,
                     entry.remedy);
}

std::string_view word_of(FindingSeverity severity) {
  return severity == FindingSeverity::error ? "error" : "warning";
}

}  // namespace pcbmesh::validation
