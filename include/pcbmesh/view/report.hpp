// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcbmesh/layering/quality_report.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/validation/report.hpp"
#include "pcbmesh/view/cell_mesh.hpp"
#include "pcbmesh/view/plots.hpp"

namespace pcbmesh::view {

/// Something to read about, with a place to fly to if it has one.
struct PagePlace {
  std::string severity;  ///< "error", "warning", "note" or "quality"
  std::string code;      ///< e.g. "net.short"
  std::string text;
  std::int64_t count = 1;
  std::vector<std::array<double, 3>> at_m{};  ///< first places; may be empty
};

/// What the page tells beside the mesh.
struct PageContents {
  std::string title;
  std::string source;            ///< file the mesh was made from
  std::optional<bool> passed{};  ///< verdict of the check; empty = not checked
  std::vector<std::pair<std::string, std::string>> facts{};
  std::vector<PagePlace> places{};
  layering::QualityReport quality{};
  std::optional<FrontPlot> front{};  ///< policy matched: what was traded for what
};

/// Findings of a check as places. @param unit_m  metres per unit of the checked file.
[[nodiscard]] std::vector<PagePlace> places_of(const validation::Report& report, double unit_m);
/// The worst prisms as places.
[[nodiscard]] std::vector<PagePlace> places_of(const layering::QualityReport& quality);
/// The worst cells as places.
[[nodiscard]] std::vector<PagePlace> places_of(const CellMesh& mesh, const CellQuality& quality);

/// One self-contained page with the whole mesh, every layer of it, in a viewer: no network, no other file. It carries the
/// implicit mesh, compressed; coordinates are kept to a 2^24th of the mesh's larger side.
/// @cost O(planar mesh + boundary faces); about 7 bytes per planar triangle and 0.7 MB for the viewer.
[[nodiscard]] std::string report_html(const mesh::PrismMesh& mesh, const PageContents& contents);
/// The same page of a mesh of cells. It carries CellMesh::faces() with the cells on either side, their groups and qualities,
/// not the cells inside a group: a section shows the groups it goes through. Coordinates are kept to a 2^24th of the mesh's
/// larger side and of its height.
/// @cost O(faces of the mesh); about 4 bytes per face of a mesh of prisms and 0.7 MB for the viewer.
[[nodiscard]] std::string report_html(const CellMesh& mesh, const PageContents& contents);

}  // namespace pcbmesh::view
