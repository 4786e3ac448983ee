// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/study/study.hpp"
#include "src/compose/bodies.hpp"
#include "src/compose/copper_finder.hpp"
#include "src/compose/stack.hpp"

namespace pcbmesh::compose {

/// Nets of a port; without a reference the nearest plane is found.
struct Terminals {
  std::int32_t positive = board::no_net;
  std::optional<std::int32_t> negative;
};

/// Faces between which a conductor lies; a sheet has one face.
struct Faces {
  std::int32_t low = 0, high = 0;
};

/// A plane found opposite a conductor, or why there is none.
struct Reference {
  std::int32_t layer = -1;
  std::int32_t net = board::no_net;
  Nm distance_nm = 0;
  std::string reason;
};

struct References {
  Reference below, above;
  [[nodiscard]] const Reference& nearest() const {
    if (above.layer < 0) return below;
    return below.layer < 0 || above.distance_nm < below.distance_nm ? above : below;
  }
};

/// A rectangle across the gap between two conductors of one layer, or why there is none.
struct GapPlace {
  std::int32_t net = board::no_net;
  geometry::Ring rectangle;  ///< counter-clockwise
  std::array<double, 3> direction{};
  std::array<double, 2> middle_nm{};
  double length_nm = 0, width_nm = 0;
  std::string reason;
};

/// Looks for what a port can stand on.
class PortSearch {
 public:
  PortSearch(const board::Board& board, const study::Study& study, const std::vector<ResolvedRule>& rules, const Stack& stack,
             const CopperFinder& copper)
      : board_(board), study_(study), rules_(rules), stack_(stack), copper_(copper) {}

  [[nodiscard]] std::int32_t num_layers() const { return static_cast<std::int32_t>(board_.copper_layers().size()); }
  [[nodiscard]] std::int32_t num_slabs() const { return static_cast<std::int32_t>(stack_.slabs.size()); }
  [[nodiscard]] Nm z_nm(std::int32_t face) const;
  [[nodiscard]] Faces faces_of(std::int32_t net, std::int32_t layer) const;
  /// Face on which flat ports of a layer lie: where the copper meets the core it was etched on.
  [[nodiscard]] std::int32_t gap_face(std::int32_t layer) const { return stack_.copper[static_cast<std::size_t>(layer)].sheet; }

  /// Nearest plane below and above that covers the whole section, with nothing in between.
  [[nodiscard]] References find_references(const Terminals& nets, std::int32_t layer, const Section& section) const;
  [[nodiscard]] Reference find_reference(const Terminals& nets, std::int32_t layer, const Section& section) const;
  [[nodiscard]] GapPlace find_gap(const Terminals& nets, std::int32_t layer, geometry::Point p,
                                  const std::optional<Nm>& width) const;

 private:
  [[nodiscard]] bool has_fills(std::int32_t net) const;
  [[nodiscard]] Reference look(const Terminals& nets, std::int32_t layer, const Section& section, int step) const;
  [[nodiscard]] std::optional<GapPlace> gap_towards(const Terminals& nets, std::int32_t layer, geometry::Point p,
                                                    std::array<double, 2> direction, double width_nm) const;

  const board::Board& board_;
  const study::Study& study_;
  const std::vector<ResolvedRule>& rules_;
  const Stack& stack_;
  const CopperFinder& copper_;
};

}  // namespace pcbmesh::compose
