// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Meshes/Triangulation_mesher_level_traits_2.h>
#include <CGAL/Triangulation_data_structure_2.h>
#include <CGAL/Triangulation_vertex_base_2.h>

#include <array>
#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <cstdint>

namespace pcbmesh::triangulate {

/// Time stamp of 32 bits, as CGAL's containers want it: it makes the order of handles, and so the mesh,
/// independent of the allocator.
class TimeStamped {
 public:
  using Has_timestamp = CGAL::Tag_true;
  [[nodiscard]] std::size_t time_stamp() const { return stamp_ == unset ? static_cast<std::size_t>(-1) : stamp_; }
  void set_time_stamp(std::size_t stamp) { stamp_ = static_cast<std::uint32_t>(stamp); }

 private:
  static constexpr std::uint32_t unset = 0xffffffffU;
  std::uint32_t stamp_ = unset;
};

/// Where a vertex comes from: a vertex of the graph, a split graph edge, or the inside of a face.
class Origin {
 public:
  static constexpr std::int32_t inside = -1;
  void set_graph_vertex(std::int32_t id) { link_ = id; }
  void set_graph_edge(std::int32_t edge) { link_ = -2 - edge; }
  [[nodiscard]] bool is_graph_vertex() const { return link_ >= 0; }
  [[nodiscard]] bool is_on_graph_edge() const { return link_ < inside; }
  [[nodiscard]] std::int32_t graph_vertex() const { return link_; }
  [[nodiscard]] std::int32_t graph_edge() const { return -2 - link_; }

 private:
  std::int32_t link_ = inside;
};

/// Vertex of 32 or 40 bytes: point, face, origin, stamp and the cached edge length wanted here.
template <class Kernel, class Base = CGAL::Triangulation_vertex_base_2<Kernel>>
class CdtVertex : public Base, public Origin, public TimeStamped {
 public:
  template <class Tds>
  struct Rebind_TDS {
    using Other = CdtVertex<Kernel, typename Base::template Rebind_TDS<Tds>::Other>;
  };
  using Base::Base;
  [[nodiscard]] float wanted_edge() const { return wanted_edge_; }
  void set_wanted_edge(float length) const { wanted_edge_ = length; }

 private:
  mutable float wanted_edge_ = -1;  // negative: not asked yet; a cache, hence mutable
};

/// Face of 64 bytes, one cache line, against 88 of CGAL's mesher face.
template <class Kernel, class Base = CGAL::Constrained_triangulation_face_base_2<Kernel>>
class CdtFace : public Base, public TimeStamped {
 public:
  template <class Tds>
  struct Rebind_TDS {
    using Other = CdtFace<Kernel, typename Base::template Rebind_TDS<Tds>::Other>;
  };
  using Base::Base;
  [[nodiscard]] bool is_in_domain() const { return is_in_domain_; }
  void set_in_domain(bool is_in) { is_in_domain_ = is_in; }
  /// During refinement: ticket in the queue of bad faces, 0 = not queued. During the flood: 1 + region.
  [[nodiscard]] std::uint32_t ticket() const { return ticket_; }
  void set_ticket(std::uint32_t ticket) { ticket_ = ticket; }

 private:
  bool is_in_domain_ = false;
  std::uint32_t ticket_ = 0;
};

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Tds = CGAL::Triangulation_data_structure_2<CdtVertex<Kernel>, CdtFace<Kernel>>;
using Cdt =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Tds, CGAL::No_constraint_intersection_requiring_constructions_tag>;

static_assert(sizeof(Tds::Face) <= 64);

}  // namespace pcbmesh::triangulate

/// Conflict zones of our triangulation live on the stack: with CGAL's linked lists a fifth of the time went to malloc.
template <>
struct CGAL::Triangulation_mesher_level_traits_2<pcbmesh::triangulate::Cdt>
    : public CGAL::Triangulation_ref_impl<pcbmesh::triangulate::Cdt> {
  using Triangulation = pcbmesh::triangulate::Cdt;
  using Point = Triangulation::Point;
  using Vertex_handle = Triangulation::Vertex_handle;
  using Face_handle = Triangulation::Face_handle;
  using Edge = Triangulation::Edge;
  using CGAL::Triangulation_ref_impl<Triangulation>::triangulation_ref_impl;

  explicit Triangulation_mesher_level_traits_2(Triangulation& triangulation)
      : CGAL::Triangulation_ref_impl<Triangulation>(triangulation) {}

  struct Zone {
    using Faces = boost::container::small_vector<Face_handle, 24>;
    using Edges = boost::container::small_vector<Edge, 24>;
    using Faces_iterator = Faces::iterator;
    using Edges_iterator = Edges::iterator;
    Triangulation::Locate_type locate_type = Triangulation::FACE;
    Face_handle fh;
    int i = 0;
    Face_handle parent_face;  // the face whose refinement point is inserted
    Faces faces;
    Edges boundary_edges;  // seen from outside, counter-clockwise round the zone
  };

  Vertex_handle insert_impl(const Point& p, Zone& zone) {
    return triangulation_ref_impl().star_hole(p, zone.boundary_edges.begin(), zone.boundary_edges.end(), zone.faces.begin(),
                                              zone.faces.end());
  }
};
