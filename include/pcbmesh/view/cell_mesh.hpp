// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/layering/quality_report.hpp"
#include "pcbmesh/mesh/mesh_data.hpp"
#include "pcbmesh/validation/report.hpp"
#include "pcbmesh/view/skin.hpp"

namespace pcbmesh::view {

/// All cells of one volume tag.
struct CellGroup {
  std::int32_t id = 0;         ///< the file's tag; 0 = cells without a tag
  std::string name;            ///< of the file, else "volume 7"
  std::int32_t layer = -1;     ///< index into CellMesh::layers(), -1 = not known
  std::int32_t material = -1;  ///< index into CellMesh::materials(), -1 = not known
  std::int32_t net = -1;       ///< index into CellMesh::nets(), -1 = none or not known
  bool is_air = false;
  std::int64_t num_cells = 0;
  double volume_m3 = 0;
  double mean_quality = 0, worst_quality = 0;  ///< of the cells that have a measure; 0 = none has
  std::array<double, 2> z_m{};                 ///< lowest and highest node
  std::int32_t band = 0;  ///< its layer; without layers, groups whose heights overlap are of one; counted upwards
};

struct CellFaceTag {
  std::int32_t id = 0;
  std::string name;       ///< of the file, else "surface 7"
  std::string kind;       ///< as in tags.json, empty = not known
  bool is_inner = false;  ///< some face lies between two cells
  std::int64_t num_faces = 0;
};

/// A face that may be seen: on the hull, between two volume groups, or tagged.
struct CellFace {
  std::array<std::int64_t, 4> nodes{-1, -1, -1, -1};  ///< counter-clockwise seen from outside `cell`; three of a triangle
  std::int64_t cell = -1;                             ///< index over all blocks of the file in order
  std::int64_t neighbour = -1;                        ///< cell on the other side, -1 = none
  std::int32_t group = -1;                            ///< index into groups()
  std::int32_t neighbour_group = -1;
  std::int32_t tag = -1;  ///< index into face_tags()
  [[nodiscard]] int size() const { return nodes[3] < 0 ? 3 : 4; }
};

/// Figures of the cells' shapes.
struct CellQuality {
  std::int64_t num_measured = 0;
  double mean = 0;
  layering::QualityHistogram histogram;
  struct Worst {
    std::int64_t cell = -1;
    double quality = 0;
    std::array<double, 3> at_m{};
    std::int32_t group = 0;
  };
  std::vector<Worst> worst;  ///< ascending, at most ten
};

/// A mesh of explicit cells as pictures need it: the faces that may be seen, groups with what their names tell. Any kinds,
/// mixed; elements of second order by their corners.
///
/// Layer, material and net come from names spelt "layer|material|net", as every file of this program has them. What is a
/// conductor and what kind a face tag is come from tags.json, or else from the names.
///
/// @guarantee W1  faces(): every face of exactly one cell once; of two cells once if their groups differ or it is tagged
/// @guarantee W2  faces() and all figures depend on the mesh alone, not on memory or threads
/// @cost O(cells); memory 60 bytes per face of faces(), 16 per node, and at most 200 MB while faces are matched.
class CellMesh {
 public:
  /// @param box_m  only cells whose centre is inside are there
  /// @throws Error file_syntax (202) for a corner that is no node of the mesh; region_empty (305) if no cell is left.
  CellMesh(std::shared_ptr<const mesh::MeshData> mesh, double unit_m, const validation::Expectation* tags = nullptr,
           const std::optional<std::array<double, 4>>& box_m = {});

  [[nodiscard]] const mesh::MeshData& mesh() const { return *mesh_; }
  [[nodiscard]] double unit_m() const { return unit_m_; }
  [[nodiscard]] std::int64_t num_cells() const { return first_cell_.back(); }
  [[nodiscard]] std::span<const CellGroup> groups() const { return groups_; }
  [[nodiscard]] std::span<const CellFaceTag> face_tags() const { return face_tags_; }
  [[nodiscard]] std::span<const std::string> layers() const { return layers_; }
  /// Name, and conductivity and permittivity just good enough to tell metal, air and laminate apart.
  [[nodiscard]] std::span<const board::Material> materials() const { return materials_; }
  [[nodiscard]] std::span<const std::string> nets() const { return nets_; }
  [[nodiscard]] std::int32_t num_bands() const { return num_bands_; }
  /// By smaller cell, then local face.
  [[nodiscard]] std::span<const CellFace> faces() const { return faces_; }

  [[nodiscard]] std::array<double, 3> node_m(std::int64_t node) const {
    const auto& p = mesh_->nodes[static_cast<std::size_t>(node)];
    return {p[0] * unit_m_, p[1] * unit_m_, p[2] * unit_m_};
  }
  /// Index into groups(), -1 = outside the box. @cost O(log blocks).
  [[nodiscard]] std::int32_t group_of(std::int64_t cell) const;
  /// Of wedges q_p, taken over the means of the two triangles' areas and squared sides and of the three heights; of tetrahedra
  /// the mean ratio 12 (3 V)^(2/3) / sum of squared edges, 1 = regular. Nothing for pyramids and hexahedra.
  /// @source q_p: Ye and Daniels, eq. 2; mean ratio: Liu and Joe 1994.
  [[nodiscard]] std::optional<double> quality_of(std::int64_t cell) const;
  [[nodiscard]] CellQuality quality() const;

  /// Cell of a block: corners as node numbers.
  struct Cell {
    mesh::CellKind kind = mesh::CellKind::wedge;
    std::span<const std::int64_t> corners;
  };
  [[nodiscard]] Cell cell(std::int64_t index) const;
  [[nodiscard]] std::array<double, 3> centre_m(std::int64_t cell) const;

 private:
  void name_groups(const validation::Expectation* tags);
  void name_face_tags(const validation::Expectation* tags);
  void measure_groups();
  [[nodiscard]] std::vector<CellGroup*> groups_from_below();
  void find_bands();
  void keep_box(const std::array<double, 4>& box_m);
  std::shared_ptr<const mesh::MeshData> mesh_;
  double unit_m_ = 1;
  std::vector<std::int64_t> first_cell_;  ///< per block, plus one
  std::vector<CellGroup> groups_;         ///< by id
  std::vector<std::int32_t> group_of_;    ///< per cell
  std::vector<CellFaceTag> face_tags_;    ///< by id
  std::vector<std::string> layers_, nets_;
  std::vector<board::Material> materials_;
  std::int32_t num_bands_ = 0;
  std::vector<CellFace> faces_;
};

/// A visible face: of a shown cell, or cut from one by the section plane.
struct CellSkinFace {
  std::int64_t cell = -1;
  std::int32_t group = -1, tag = -1;
  bool is_section = false;
  SkinPolygon polygon;  ///< metres, counter-clockwise seen from outside
};
using CellSkinVisitor = std::function<void(const CellSkinFace&)>;

/// Calls `visit` with the visible faces of cells: visit_skin() for meshes without layers. Mode layers tells bands apart. The
/// cut shows cell by cell. Box: see CellMesh.
///
/// @guarantee W3  of the cells of a prism mesh, the same faces as visit_skin() gives of the prism mesh itself
void visit_cell_skin(const CellMesh& mesh, const Visibility& visibility, const CellSkinVisitor& visit);
/// Calls `visit` with the faces of sheets and ports between two cells of which one is shown.
void visit_inner_cell_faces(const CellMesh& mesh, const Visibility& visibility, const CellSkinVisitor& visit);
/// Before anything is cut: the section plane is not looked at.
[[nodiscard]] SkinCount count_cell_skin(const CellMesh& mesh, const Visibility& visibility);

}  // namespace pcbmesh::view
