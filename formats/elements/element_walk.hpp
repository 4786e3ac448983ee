// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>

#include "formats/sink/file_sink.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"

/// What writers of solver formats share: walking nodes and elements, node orders, numbers of fixed width.
namespace pcbmesh::formats {

/// One mesh on its way into one file.
struct WriteJob {
  mesh::MeshSource& source;
  FileSink& sink;
  double scale = 1;  ///< written units per unit of the source
  const Progress& progress;
  const std::filesystem::path& file;
};

/// Order of an element's nodes in a format. Corners are the same in all of them.
enum class NodeOrder {
  gmsh,
  vtk,    ///< VTK, Abaqus, CalculiX, XDMF: wedge edges 01 12 20 34 45 53 03 14 25
  exodus  ///< Exodus, Elmer, Nastran, libMesh: wedge edges 01 12 20 03 14 25 34 45 53
};
/// Permutation p of a kind: the format's node i is node p[i] in Gmsh order.
[[nodiscard]] std::span<const std::uint8_t> node_order(mesh::ElementKind kind, NodeOrder order);

/// Scaled coordinates in id order. `first` is the id of the first node, from 0.
using NodeVisit = std::function<void(std::int64_t first, std::span<const std::array<double, 3>> nodes)>;
void visit_nodes(const WriteJob& job, const NodeVisit& visit);

/// Calls visit(number, nodes) for every element of a block; `nodes` in the order asked for, counted from 0.
/// @param number  of the first element; the number after the last is returned.
using ElementVisit = std::function<void(std::int64_t number, std::span<const std::int64_t> nodes)>;
std::int64_t visit_elements(const WriteJob& job, std::size_t block, NodeOrder order, std::int64_t number,
                            const ElementVisit& visit);

/// @throws Error format_limit (703) if there are more than `most` nodes or elements, naming the format.
void require_count(const WriteJob& job, std::string_view format, std::int64_t most);

/// Appends a number of at most `width` characters that stands nearest to the value, with a decimal point and exponent 'E'.
/// Shortest text that reads back to the same value where that fits.
void put_real(FileSink& sink, double value, std::size_t width);
/// Appends an integer, right-aligned. REQUIRES that it fits.
void put_padded(FileSink& sink, std::int64_t value, std::size_t width);

/// Letters, digits, '_' and '-' stay, everything else becomes '_'; cut to `most` bytes.
[[nodiscard]] std::string plain_word(std::string_view name, std::size_t most);

}  // namespace pcbmesh::formats
