// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/triangulate/periodic_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/geometry/ring_contact.hpp"
#include "src/triangulate/split_edge.hpp"

namespace pcbmesh::triangulate {
namespace {

using Vertex = Cdt::Vertex_handle;

// Vertices of the graph lie on the nanometre grid; what is nearer than half of it is one place.
constexpr double nearly_nm = 0.5;

double coordinate(Vertex v, int axis) {
  return axis == 0 ? v->point().x() : v->point().y();
}

const char* name_of(int axis, bool is_high) {
  constexpr const char* names[2][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}};
  return names[axis][is_high ? 1 : 0];
}

/// What a column shows in a slab, for a message.
std::string text_of(const model::Label& label, const model::Model& model) {
  if (label.is_void())
    return label.hollow_net >= board::no_net ? fmt::format("hollow copper of {}", model.net_name(label.hollow_net)) : "nothing";
  if (label.net >= 0) return fmt::format("copper of {}", model.net_name(label.net));
  return model.materials()[static_cast<std::size_t>(label.material)].name;
}

std::string sheet_text(std::int32_t body, const model::Model& model) {
  return body < 0 ? std::string("no sheet")
                  : fmt::format("a sheet of {}", model.net_name(model.bodies()[static_cast<std::size_t>(body)].net));
}

}  // namespace

PeriodicSides::PeriodicSides(const model::Model& model, double unit_nm) : unit_nm_(unit_nm) {
  geometry::Box box;
  for (const model::BodyShape& shape : model.shapes())
    if (shape.body == 0)
      for (const geometry::Ring& ring : shape.rings) box.add(geometry::bounds(ring));
  low_ = {static_cast<double>(box.min.x) / unit_nm, static_cast<double>(box.min.y) / unit_nm};
  high_ = {static_cast<double>(box.max.x) / unit_nm, static_cast<double>(box.max.y) / unit_nm};
  for (std::size_t axis = 0; axis < 2; ++axis) is_periodic_[axis] = model.sides()[2 * axis].kind == model::SideKind::periodic;
}

bool PeriodicSides::is_on(Vertex v, int axis, bool is_high) const {
  const auto across = static_cast<std::size_t>(axis), along = 1 - across;
  const double at = coordinate(v, 1 - axis);
  return coordinate(v, axis) == (is_high ? high_[across] : low_[across]) && at >= low_[along] && at <= high_[along];
}

std::vector<Vertex> PeriodicSides::side(const Cdt& cdt, int axis, bool is_high) const {
  std::vector<Vertex> found;
  for (const Vertex v : cdt.finite_vertex_handles())
    if (is_on(v, axis, is_high)) found.push_back(v);
  std::ranges::sort(found, {}, [&](Vertex v) { return coordinate(v, 1 - axis); });
  return found;
}

std::int64_t PeriodicSides::mirror(Cdt& cdt, const GraphEdgeIndex& graph_edges) const {
  std::int64_t num_added = 0;
  // What is added on the sides of one axis is never at a corner, so not on the sides of the other.
  for (const int axis : {0, 1}) {
    if (!is_periodic_[static_cast<std::size_t>(axis)]) continue;
    const std::array<std::vector<Vertex>, 2> sides{side(cdt, axis, false), side(cdt, axis, true)};
    for (const bool to_high : {true, false}) {
      const std::vector<Vertex>&from = sides[to_high ? 0 : 1], &to = sides[to_high ? 1 : 0];
      const double at = (to_high ? high_ : low_)[static_cast<std::size_t>(axis)];
      Vertex before;
      std::size_t next = 0;
      for (const Vertex v : from) {
        const double along = coordinate(v, 1 - axis);
        while (next < to.size() && coordinate(to[next], 1 - axis) <= along + nearly_nm / unit_nm_) before = to[next++];
        PCBMESH_ASSERT(before != Vertex());
        if (along - coordinate(before, 1 - axis) < nearly_nm / unit_nm_) {
          // Split in two ways at one place, but for rounding: a vertex of the graph stays where it is.
          const Vertex kept = before->is_graph_vertex() ? before : v, moved = before->is_graph_vertex() ? v : before;
          const double across = coordinate(moved, axis), place = coordinate(kept, 1 - axis);
          moved->set_point(axis == 0 ? Kernel::Point_2(across, place) : Kernel::Point_2(place, across));
          continue;
        }
        PCBMESH_ASSERT(next < to.size());
        const Kernel::Point_2 place = axis == 0 ? Kernel::Point_2(at, along) : Kernel::Point_2(along, at);
        const std::int32_t edge = graph_edge_of(graph_edges, before, to[next]);
        const Vertex added = split_edge(cdt, before, to[next], place);
        if (added == Vertex()) {
          Spot spot;
          spot.at_mm = {place.x() * unit_nm_ * 1e-6, place.y() * unit_nm_ * 1e-6};
          throw Error(
              ErrorCode::triangulation_limit,
              fmt::format("the triangles of periodic sides {} and {} can't be made alike here; use a larger --tolerance",
                          name_of(axis, false), name_of(axis, true)),
              spot);
        }
        added->set_graph_edge(edge);
        before = added;
        ++num_added;
      }
    }
  }
  return num_added;
}

std::vector<std::int32_t> PeriodicSides::bodies_inside(const Cdt& cdt, const Regions& regions, Vertex a, Vertex b) const {
  Cdt::Face_handle face;
  int i = 0;
  if (!cdt.is_edge(a, b, face, i)) report_bug("a side of the domain is a chain of edges", __FILE__, __LINE__);
  for (const Cdt::Face_handle one : {face, face->neighbor(i)}) {
    const std::size_t region = one->ticket() - 1;
    if (!regions.is_in_domain(region)) continue;
    std::vector<std::int32_t> present;
    for (const mesh::Increment& body : regions.of(region))
      if (body.delta > 0) present.push_back(body.body);
    return present;
  }
  return {};
}

void PeriodicSides::require_same(const Cdt& cdt, const Regions& regions, const model::Model& model) const {
  const auto num_slabs = static_cast<std::int32_t>(model.slabs().size());
  for (const int axis : {0, 1}) {
    if (!is_periodic_[static_cast<std::size_t>(axis)]) continue;
    const std::vector<Vertex> low = side(cdt, axis, false), high = side(cdt, axis, true);
    PCBMESH_ASSERT(low.size() == high.size());
    for (std::size_t i = 0; i + 1 < low.size(); ++i) {
      const auto here = bodies_inside(cdt, regions, low[i], low[i + 1]),
                 there = bodies_inside(cdt, regions, high[i], high[i + 1]);
      if (here == there) continue;
      const auto refuse = [&](const std::string& layer, const std::string& one, const std::string& other) {
        Spot spot{.layer = layer};
        spot.at_mm = {0.5e-6 * unit_nm_ * (low[i]->point().x() + low[i + 1]->point().x()),
                      0.5e-6 * unit_nm_ * (low[i]->point().y() + low[i + 1]->point().y())};
        throw Error(ErrorCode::study_invalid,
                    fmt::format("/boundaries/{0}: {0} shows {2} here and {1}, across from it, {3}; a periodic cell shows the "
                                "same on both sides: choose the region so that its length is a whole number of periods, or "
                                "take another boundary",
                                name_of(axis, false), name_of(axis, true), one, other),
                    spot);
      };
      for (std::int32_t slab = 0; slab < num_slabs; ++slab) {
        const model::Label one = model.resolve(slab, here), other = model.resolve(slab, there);
        if (one != other)
          refuse(model.slabs()[static_cast<std::size_t>(slab)].layer, text_of(one, model), text_of(other, model));
      }
      for (std::int32_t face = 0; face <= num_slabs; ++face) {
        const std::int32_t one = model.sheet_at(face, here), other = model.sheet_at(face, there);
        if (one != other)
          refuse(model.bodies()[static_cast<std::size_t>(std::max(one, other))].sheet->layer, sheet_text(one, model),
                 sheet_text(other, model));
      }
    }
  }
}

std::vector<Vertex> PeriodicSides::in_order(const Cdt& cdt) const {
  std::vector<Vertex> found;
  if (is_empty()) return found;
  for (const Vertex v : cdt.finite_vertex_handles()) {
    bool is_found = false;
    for (const int axis : {0, 1})
      for (const bool is_high : {false, true})
        is_found = is_found || (is_periodic_[static_cast<std::size_t>(axis)] && is_on(v, axis, is_high));
    if (is_found) found.push_back(v);
  }
  std::ranges::sort(found, {}, [](Vertex v) { return std::pair(v->point().y(), v->point().x()); });
  return found;
}

}  // namespace pcbmesh::triangulate
