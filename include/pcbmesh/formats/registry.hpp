// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/base/units.hpp"
#include "pcbmesh/board/board.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/mesh/mesh_source.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::formats {

enum class Match { no, maybe, yes };

struct ReadBoardResult {
  board::Board board;
  Diagnostics diagnostics;
};

/// A board format: plain data, listed in board_formats().
struct BoardFormat {
  std::string_view name;                                              ///< e.g. "kicad"
  std::string_view title;                                             ///< e.g. "KiCad board, file formats v5 to v10"
  std::span<const std::string_view> extensions;                       ///< with the dot
  Match (*sniff)(std::string_view head, std::string_view file_name);  ///< head: first 4 kB
  ReadBoardResult (*read)(const std::filesystem::path& file, const Progress& progress);
};

enum class Compression { none, zlib, lz4 };
/// Order of a wedge's corners in VTU and VTKHDF files. VTK up to 9.6, Gmsh, meshio and MFEM take `legacy`: the normal of the
/// first triangle points outwards. VTK from 9.7 on documents `parametric`, which is Gmsh's order.
enum class VtkWedge { legacy, parametric };
[[nodiscard]] std::string_view name_of(VtkWedge order);

/// What the formats may be told; each takes what it knows and leaves the rest.
struct WriteMeshOptions {
  bool binary = true;
  LengthUnit unit = LengthUnit::metre;
  std::string version;                          ///< format version, e.g. "4.1"; empty = the format's default
  Compression compression = Compression::none;  ///< VTK and HDF5 family; HDF5 knows zlib alone
  bool base64 = false;                          ///< VTK XML: arrays as base64 text, which makes the file valid XML
  VtkWedge vtk_wedge = VtkWedge::legacy;
  bool faces = false;             ///< VTU and PVTU: tagged faces as cells too
  int num_parts = 2;              ///< PVTU: pieces, at least 1
  int index_bits = 0;             ///< VTK and HDF5 family: 32 or 64; 0 = 32 where they suffice
  int num_threads = 1;            ///< for compression; the bytes are the same for any number
  bool one_number_space = false;  ///< face groups are numbered after the volume groups (GetDP knows one kind of number)
  std::string mfem_version{};     ///< "1.3" (named sets) or "1.0"; empty = 1.3
};

/// Element kinds as a set of bits.
using KindSet = std::uint32_t;
template <class... Kinds>
[[nodiscard]] constexpr KindSet kind_set(Kinds... kinds) {
  return (KindSet{0} | ... | (KindSet{1} << static_cast<int>(kinds)));
}
[[nodiscard]] constexpr bool holds(KindSet set, mesh::ElementKind kind) {
  return ((set >> static_cast<int>(kind)) & 1U) != 0;
}

inline constexpr KindSet all_kinds = (KindSet{1} << (static_cast<int>(mesh::ElementKind::wedge18) + 1)) - 1;

/// What a mesh format can hold of a mesh, as its reader and writer do it here.
struct FormatScope {
  KindSet written = 0;  ///< 0 = not stated
  KindSet readable = 0;
  bool has_tags = false;   ///< numbers of volume and face groups survive
  bool has_names = false;  ///< so do their names
  bool is_folder = false;  ///< the output is a folder of files
};

/// A mesh format. `write` or `read` may be null.
struct MeshFormat {
  std::string_view name;
  std::string_view title;
  std::span<const std::string_view> extensions;
  void (*write)(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                const Progress& progress);
  mesh::MeshData (*read)(const std::filesystem::path& file, const Progress& progress);
  FormatScope scope{};
  /// Files and folders that may stand beside `file` and belong to it; null = it stands alone.
  std::vector<std::filesystem::path> (*parts)(const std::filesystem::path& file) = nullptr;
};

/// The tables: explicit, ordered, no registration at start-up.
[[nodiscard]] std::span<const BoardFormat* const> board_formats();
[[nodiscard]] std::span<const MeshFormat* const> mesh_formats();

/// Mesh format by name if given, else by ending; nullptr if there is none.
[[nodiscard]] const MeshFormat* find_mesh_format(const std::filesystem::path& file, std::string_view format = {});

/// Reads a board: by format name if given, else by a unique "yes" from sniffing, else by extension.
/// Files ending in .xz or .gz are unpacked on the fly.
/// @throws Error file_unreadable (201), format_unknown (204) showing the head of the file and the list.
[[nodiscard]] ReadBoardResult read_board(const std::filesystem::path& file, std::string_view format = {},
                                         const Progress& progress = Progress{});

/// Writes a mesh: by format name if given, else by extension. The file appears whole or not at all; an existing
/// one survives any failure. @throws Error usage (101), write_failed (701), format_limit (703), cancelled (103).
void write_mesh(mesh::MeshSource& source, const std::filesystem::path& file, const WriteMeshOptions& options,
                std::string_view format = {}, const Progress& progress = Progress{});
/// The same for the prisms of an implicit mesh. Without a quality functor no cell array `quality` is written.
void write_mesh(const mesh::PrismMesh& mesh, const std::filesystem::path& file, const WriteMeshOptions& options,
                std::string_view format = {}, const Progress& progress = Progress{});

/// Files and folders beside a mesh that was written which belong to it: the numbers of an XDMF, the parts of a PVTU.
[[nodiscard]] std::vector<std::filesystem::path> parts_of_mesh(const std::filesystem::path& file, std::string_view format = {});

/// Reads a mesh for check and convert. @throws Error file_unreadable (201), file_syntax (202), file_truncated (205).
[[nodiscard]] mesh::MeshData read_mesh(const std::filesystem::path& file, std::string_view format = {},
                                       const Progress& progress = Progress{});

}  // namespace pcbmesh::formats
