// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "pcbmesh/validation/outputs.hpp"

namespace pcbmesh::validation {
namespace {

struct Offender {
  std::vector<std::int64_t> corners;
  int vtk_type = 0;
  std::size_t finding = 0;
  std::int32_t tag = 0;
  bool is_face = false;
};

int vtk_type_of(mesh::CellKind kind) {
  constexpr int types[] = {10, 14, 13, 12};
  return types[static_cast<int>(kind)];
}

int vtk_type_of(mesh::FaceKind kind) {
  return kind == mesh::FaceKind::triangle ? 5 : 9;
}

/// Element `index` over all blocks in order; false if there is none.
template <class Block>
bool take(const std::vector<Block>& blocks, std::int64_t index, Offender& out) {
  for (const Block& block : blocks) {
    if (index < 0) return false;
    if (index >= block.size()) {
      index -= block.size();
      continue;
    }
    const auto corners = static_cast<std::size_t>(corners_of(block.kind)), i = static_cast<std::size_t>(index);
    if ((i + 1) * corners > block.corners.size()) return false;
    const auto first = block.corners.begin() + static_cast<std::ptrdiff_t>(i * corners);
    out.corners.assign(first, first + static_cast<std::ptrdiff_t>(corners));
    out.vtk_type = vtk_type_of(block.kind);
    out.tag = block.tags[i];
    return true;
  }
  return false;
}

std::vector<Offender> offenders_of(const Report& report, const mesh::MeshData& mesh) {
  const auto num_nodes = static_cast<std::int64_t>(mesh.nodes.size());
  std::vector<Offender> all;
  const auto keep = [&](Offender one) {
    if (std::ranges::all_of(one.corners, [&](std::int64_t node) { return node >= 0 && node < num_nodes; })) {
      all.push_back(std::move(one));
    }
  };
  for (std::size_t f = 0; f < report.findings.size(); ++f) {
    const Finding& finding = report.findings[f];
    const auto keep_elements = [&](std::int64_t cell, std::int64_t face, std::int64_t node) {
      Offender one;
      one.finding = f;
      if (take(mesh.cells, cell, one)) keep(one);
      one.is_face = true;
      if (take(mesh.faces, face, one)) keep(one);
      if (node >= 0) keep({{node}, 1, f, 0, false});
    };
    for (const std::int64_t cell : finding.cells) keep_elements(cell, -1, -1);
    for (const std::int64_t face : finding.faces) keep_elements(-1, face, -1);
    for (const std::int64_t node : finding.nodes) keep_elements(-1, -1, node);
    if (!finding.cells.empty() || !finding.faces.empty() || !finding.nodes.empty()) continue;
    for (const Finding::Place& place : finding.places) keep_elements(place.cell, place.face, place.node);
  }
  return all;
}

template <class Value>
std::string array_text(const char* type, const char* name, const std::vector<Offender>& all, Value value) {
  std::string text = fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">\n", type, name);
  for (const Offender& one : all) text += fmt::format("{}\n", value(one));
  return text + "</DataArray>\n";
}

}  // namespace

std::string to_offenders_vtu(const Report& report, const mesh::MeshData& mesh) {
  const std::vector<Offender> all = offenders_of(report, mesh);
  std::string points, connectivity;
  std::int64_t num_points = 0;
  // Each element brings its own points: a coinciding pair of nodes must not look like one.
  for (const Offender& one : all) {
    for (const std::int64_t node : one.corners) {
      const auto& at = mesh.nodes[static_cast<std::size_t>(node)];
      for (const double x : at) points += fmt::format("{} ", std::isfinite(x) ? x : 0.0);
      points += "\n";
      connectivity += fmt::format("{} ", num_points++);
    }
    connectivity += "\n";
  }
  std::size_t end = 0;
  return fmt::format(
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
             "<UnstructuredGrid><Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
             "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n{}</DataArray></Points>\n"
             "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n{}</DataArray>\n",
             num_points, all.size(), points, connectivity) +
         array_text("Int64", "offsets", all, [&](const Offender& one) { return end += one.corners.size(); }) +
         array_text("UInt8", "types", all, [](const Offender& one) { return one.vtk_type; }) + "</Cells>\n<CellData>\n" +
         array_text("Int64", "finding", all, [](const Offender& one) { return one.finding; }) +
         array_text("Int32", "tag", all, [](const Offender& one) { return one.tag; }) +
         array_text("UInt8", "is_face", all, [](const Offender& one) { return one.is_face ? 1 : 0; }) +
         "</CellData>\n</Piece></UnstructuredGrid></VTKFile>\n";
}

}  // namespace pcbmesh::validation
