// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "pcbmesh/geometry/point.hpp"

namespace pcbmesh::geometry {

/// Bounding box of a ring.
[[nodiscard]] Box bounds(const Ring& ring) noexcept;

/// How two boundaries meet.
enum class ContactKind {
  none,      ///< no common point
  touching,  ///< common points, but no two edges cross in their interiors
  crossing   ///< two edges cross in their interiors
};

struct Contact {
  ContactKind kind = ContactKind::none;
  Point at;  ///< near the first crossing, else near the first touch
};

/// Strongest contact between the boundaries of two rings. Exact. @cost O(n log n) for edges short against the ring.
[[nodiscard]] Contact contact(const Ring& a, const Ring& b);

/// Place near which two edges of one ring cross in their interiors, or nullopt. Exact; touches do not count.
[[nodiscard]] std::optional<Point> self_crossing(const Ring& ring);

/// How often a ring runs round a point, exact; of a point on the ring itself it says little. @cost O(points).
[[nodiscard]] int winding_number(const Ring& ring, Point p) noexcept;

/// Of a point from the segment a-b, in nm; a may equal b.
[[nodiscard]] double distance_to_segment(Point p, Point a, Point b) noexcept;

/// +1 inside (non-zero winding), 0 on the boundary, -1 outside. Exact. @cost O(n).
[[nodiscard]] int location(Point p, const Ring& ring) noexcept;

/// Whether ring `inner` lies inside `outer`, given that no edges cross: decided by the first vertex off the boundary, both
/// ways; rings that coincide count as inside each other.
[[nodiscard]] bool is_inside(const Ring& inner, const Ring& outer) noexcept;

}  // namespace pcbmesh::geometry
