// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcbmesh::mesh {

enum class CellKind : std::uint8_t { tetrahedron, pyramid, wedge, hexahedron };
enum class FaceKind : std::uint8_t { triangle, quadrangle };

/// Corners of a cell or face kind.
[[nodiscard]] constexpr int corners_of(CellKind kind) {
  constexpr int corners[] = {4, 5, 6, 8};
  return corners[static_cast<int>(kind)];
}
[[nodiscard]] constexpr int corners_of(FaceKind kind) {
  return kind == FaceKind::triangle ? 3 : 4;
}

/// Cells of one kind and order. Corners in Gmsh order. Several blocks may be of one kind.
struct CellBlock {
  CellKind kind = CellKind::wedge;
  std::vector<std::int64_t> corners;  ///< node indices (0-based), corners_of(kind) per cell
  std::vector<std::int32_t> tags;     ///< volume tag per cell (the file's positive id; 0 = none)
  std::int32_t num_mid = 0;           ///< nodes of second order per cell; 0 = first order
  std::vector<std::int64_t> mids{};   ///< their indices, num_mid per cell, in Gmsh order (see ElementKind)
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(tags.size()); }
};

struct FaceBlock {
  FaceKind kind = FaceKind::triangle;
  std::vector<std::int64_t> corners;
  std::vector<std::int32_t> tags;
  std::int32_t num_mid = 0;
  std::vector<std::int64_t> mids{};
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(tags.size()); }
};

struct GroupName {
  int dimension = 3;
  std::int32_t tag = 0;
  std::string name;
};

/// The file a mesh was read from, as far as it matters to other programs that read it.
struct FileFormat {
  std::string name;        ///< as in the table of formats, e.g. "msh"; empty = not from a file
  std::string version;     ///< e.g. "2.2"; empty = the format has none
  bool is_binary = false;  ///< else text
};

/// A surface that is another one moved, as a file says ($Periodic of MSH): every node has a partner, every face a partner face.
struct PeriodicLink {
  std::string name;                                ///< for people, e.g. "surface 17 of surface 25"
  std::vector<std::array<std::int64_t, 2>> nodes;  ///< node, partner; -1 = a number the file gives to no node
  std::vector<FaceBlock> faces, partner_faces;     ///< all in the file, of a group or not (tags 0); empty = none are there
  std::optional<std::array<double, 12>>
      from_partner{};  ///< affine map from partner to node: three rows of four; nullopt = not said
};

/// An explicit mesh read from any file, for check and convert. Coordinates as written: a file does not know its unit.
struct MeshData {
  std::string source;  ///< file
  std::vector<std::array<double, 3>> nodes;
  std::vector<CellBlock> cells;
  std::vector<FaceBlock> faces;  ///< tagged faces only
  std::vector<GroupName> names;
  std::vector<std::int64_t> num_other_elements;  ///< points [0] and lines [1] met and ignored
  FileFormat format;
  std::array<std::int64_t, 3> num_untagged{};  ///< points, lines and faces of the file that belong to no group
  std::vector<PeriodicLink> periodic{};
};

}  // namespace pcbmesh::mesh
