// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/native_mesh/format.hpp"

#include <array>

#include "formats/native_mesh/layout.hpp"

namespace pcbmesh::formats::native_mesh {
namespace {

constexpr std::array<std::string_view, 1> extensions{".pcbmesh"};

}  // namespace

constinit const MeshFormat mesh_format{
    "native",
    "pcbmesh's own implicit mesh: plane, levels, labels",
    extensions,
    write_native,
    read_native,
    {.written = kind_set(mesh::ElementKind::wedge, mesh::ElementKind::triangle, mesh::ElementKind::quadrangle),
     .readable = kind_set(mesh::ElementKind::wedge, mesh::ElementKind::triangle, mesh::ElementKind::quadrangle),
     .has_tags = true,
     .has_names = true}};

}  // namespace pcbmesh::formats::native_mesh
