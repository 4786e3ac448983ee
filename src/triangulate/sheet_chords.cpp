// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/sheet_chords.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "src/triangulate/flood.hpp"
#include "src/triangulate/split_edge.hpp"

namespace pcbmesh::triangulate {
namespace {

using Vertex = Cdt::Vertex_handle;

/// Per region of the flood: does a sheet cover it at one face?
std::vector<char> sheet_regions(const Regions& regions, const model::Model& model, std::int32_t face) {
  std::vector<char> covered(regions.size(), 0);
  std::vector<std::int32_t> present;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    present.clear();
    for (const mesh::Increment& body : regions.of(r))
      if (body.delta > 0) present.push_back(body.body);
    covered[r] = model.sheet_at(face, present) >= 0 ? 1 : 0;
  }
  return covered;
}

struct Chord {
  Vertex a, b;
};

/// Edges inside the sheets of one face with both ends on a rim.
void collect_chords(const Cdt& cdt, const std::vector<char>& covered, std::vector<char>& on_rim, std::vector<Chord>& chords) {
  const auto is_covered = [&](Cdt::Face_handle face) { return covered[face->ticket() - 1] != 0; };
  std::ranges::fill(on_rim, char{0});
  const auto stamp = [](Vertex v) { return v->time_stamp(); };
  for (auto edge = cdt.finite_edges_begin(); edge != cdt.finite_edges_end(); ++edge) {
    const auto& [face, i] = *edge;
    if (is_covered(face) == is_covered(face->neighbor(i))) continue;
    on_rim[stamp(face->vertex(Cdt::cw(i)))] = on_rim[stamp(face->vertex(Cdt::ccw(i)))] = 1;
  }
  for (auto edge = cdt.finite_edges_begin(); edge != cdt.finite_edges_end(); ++edge) {
    const auto& [face, i] = *edge;
    const Vertex a = face->vertex(Cdt::cw(i)), b = face->vertex(Cdt::ccw(i));
    if (is_covered(face) && is_covered(face->neighbor(i)) && on_rim[stamp(a)] && on_rim[stamp(b)]) chords.push_back({a, b});
  }
}

}  // namespace

std::int64_t split_sheet_chords(Cdt& cdt, const mesh::PlanarGraph& graph, const GraphEdgeIndex& graph_edges,
                                const model::Model& model) {
  std::vector<std::int32_t> faces;
  for (const model::Body& body : model.bodies())
    if (body.sheet) faces.push_back(body.sheet->face);
  std::ranges::sort(faces);
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::int64_t num_added = 0;
  while (!faces.empty()) {
    const Regions regions = flood(cdt, graph, graph_edges);
    std::size_t last_stamp = 0;
    for (auto v = cdt.all_vertices_begin(); v != cdt.all_vertices_end(); ++v)
      last_stamp = std::max(last_stamp, v->time_stamp());
    std::vector<char> on_rim(last_stamp + 1, 0);
    std::vector<Chord> chords;
    for (const std::int32_t face : faces) collect_chords(cdt, sheet_regions(regions, model, face), on_rim, chords);
    const std::int64_t before = num_added;
    for (const Chord& chord : chords) {
      Cdt::Face_handle face;
      int i = 0;
      if (!cdt.is_edge(chord.a, chord.b, face, i)) continue;  // split or flipped away since
      const Vertex v = split_in_the_middle(cdt, graph_edges, chord.a, chord.b);
      if (v != Vertex()) ++num_added;
    }
    if (num_added == before) break;
  }
  return num_added;
}

}  // namespace pcbmesh::triangulate
