// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/bodies.hpp"
#include "src/compose/copper_finder.hpp"
#include "src/compose/footprint.hpp"
#include "src/compose/port_search.hpp"
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {

/// A port that is right, and where it stands.
struct Placed {
  model::Port port;
  std::vector<geometry::Ring> footprint;  ///< outer ring first, counter-clockwise; a clockwise one is a hole
  std::int32_t first_slab = 0, last_slab = 0;
};

/// What was found, or why nothing was.
struct Outcome {
  std::optional<Placed> placed;
  std::string fault;
};

/// Two ports that would share faces.
[[nodiscard]] bool overlap(const Placed& a, const Placed& b);

/// Finds the rectangle of a port on the board.
class PortPlacer {
 public:
  PortPlacer(const board::Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules,
             const Footprint& footprint, const Stack& stack)

      : board_(board),
        arcs_(study.arcs),
        footprint_(footprint),
        copper_(board, study),
        search_(board, study, rules, stack, copper_) {}

  /// REQUIRES both nets to be on the board.
  [[nodiscard]] Outcome place(const study::Port& wanted) const;

 private:
  [[nodiscard]] Outcome at_pin(const study::Port& wanted, const Terminals& nets) const;
  [[nodiscard]] Outcome at_point(const study::Port& wanted, const Terminals& nets) const;
  [[nodiscard]] Outcome on_side(const study::Port& wanted, const Terminals& nets) const;
  /// Upright, between the net and the reference found above or below.
  [[nodiscard]] Outcome vertical(const study::Port& wanted, const Terminals& nets, std::int32_t layer,
                                 const Section& section) const;
  /// Rectangle of the hull round the conductor that is cut there.
  [[nodiscard]] Outcome wave(const study::Port& wanted, const Terminals& nets, std::int32_t layer, const Section& conductor,
                             study::HullSide side) const;
  /// Flat, across the gap to the reference on the same layer.
  [[nodiscard]] Outcome across_gap(const study::Port& wanted, const Terminals& nets, std::int32_t layer,
                                   geometry::Point p) const;
  /// A flat ring round a plated hole, from the plane to the hole's copper.
  [[nodiscard]] Outcome coaxial(const study::Port& wanted, const Terminals& nets, geometry::Point p) const;
  [[nodiscard]] std::optional<std::int32_t> find_layer(const std::string& name) const;
  [[nodiscard]] std::string net_text(std::int32_t net) const;
  [[nodiscard]] geometry::Ring triangle_beside(geometry::Point a, geometry::Point b, const Section& section) const;

  const board::Board& board_;
  geometry::ArcOptions arcs_;
  const Footprint& footprint_;
  CopperFinder copper_;
  PortSearch search_;
};

}  // namespace pcbmesh::compose
