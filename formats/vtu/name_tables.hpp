// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "formats/sink/file_sink.hpp"
#include "formats/syntax/xml_tree.hpp"
#include "formats/vtk/mesh_assembly.hpp"
#include "formats/vtu/array_reader.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

namespace pcbmesh::formats::vtu {

/// What the numbers of the cell arrays mean, as field data: volume_names beside volume_tags, face_names beside face_tags, and
/// the lists that layer, material and net count in (from 0). Texts are bytes, each text ends with a zero: VTK has arrays of
/// texts too, but meshio refuses the whole file for them.
/// @param with_faces  the file holds faces.
void put_name_tables(FileSink& sink, const mesh::MeshSource& source, bool with_faces);

/// Names of groups from a grid's field data, if it has them as above. @throws Error file_syntax (202).
void read_name_tables(const ArrayReader& reader, const syntax::XmlElement& grid, vtk::MeshAssembly& mesh);

}  // namespace pcbmesh::formats::vtu
