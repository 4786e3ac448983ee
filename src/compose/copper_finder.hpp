// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::compose {

/// Cross-section of a conductor: where it is cut, and along which unit vector the cut runs.
struct Section {
  std::array<double, 2> middle_nm{};
  std::array<double, 2> along{1, 0};
  double width_nm = 0;
  [[nodiscard]] geometry::Point at(double share) const;  ///< -0.5 and 0.5 are its ends
};

/// Answers where copper is in the layout as drawn.
class CopperFinder {
 public:
  CopperFinder(const board::Board& board, const study::Study& study);

  /// Nets with copper at a point of a copper layer, ascending, each once.
  [[nodiscard]] std::vector<std::int32_t> nets_at(std::int32_t layer, geometry::Point p) const;
  [[nodiscard]] bool covers(std::int32_t layer, std::int32_t net, geometry::Point p) const;
  /// Whether wide copper (fills, polygons and tracks at least this wide, no pads) of the net is there.
  [[nodiscard]] bool has_plane(std::int32_t layer, std::int32_t net, geometry::Point p, double least_width_nm) const;
  /// Across the track at a point, else across pad or polygon along the axis in which it is narrower.
  [[nodiscard]] std::optional<Section> section_at(std::int32_t layer, std::int32_t net, geometry::Point p) const;
  /// Across pad or polygon, along x or y, whichever is narrower, or along `along`; nine tenths of its extent.
  [[nodiscard]] std::optional<Section> pad_section(std::int32_t layer, std::int32_t net, geometry::Point p,
                                                   const std::optional<std::array<double, 2>>& along = {}) const;
  /// Intervals of the net's copper on the line x = at (axis 0) or y = at (axis 1), as coordinates along the line.
  [[nodiscard]] std::vector<std::pair<double, double>> cuts(std::int32_t layer, std::int32_t net, int axis, Nm at) const;
  /// Sections along the tracks that leave a pad at `p`, nearest first, up to `reach_nm` away.
  [[nodiscard]] std::vector<Section> sections_away_from(std::int32_t layer, std::int32_t net, geometry::Point p,
                                                        double reach_nm) const;
  /// From p in a direction: distances at which the net's copper is left and other copper met, and its net.
  struct Gap {
    double leave_nm = 0, meet_nm = 0;
    std::int32_t net = board::no_net;
  };
  [[nodiscard]] std::optional<Gap> gap_from(std::int32_t layer, std::int32_t net, geometry::Point p,
                                            std::array<double, 2> direction, double reach_nm) const;
  /// Drill that comes nearer to the section's line than its radius, or null.
  [[nodiscard]] const board::Drill* drill_in(const Section& section) const;

 private:
  [[nodiscard]] const std::vector<geometry::Ring>& rings_of(std::int32_t shape) const;
  [[nodiscard]] bool shape_covers(std::int32_t shape, geometry::Point p) const;
  /// Nearest crossings of the shape's outline with the line through p, before and behind it.
  void chord(std::int32_t shape, geometry::Point p, std::array<double, 2> direction, double& before, double& behind) const;
  [[nodiscard]] std::span<const std::int32_t> on_layer(std::int32_t layer) const {
    return by_layer_[static_cast<std::size_t>(layer)];
  }

  const board::Board& board_;
  const study::Study& study_;
  std::vector<std::vector<std::int32_t>> by_layer_;
  std::vector<geometry::Box> boxes_;
  mutable std::map<std::int32_t, std::vector<geometry::Ring>> rings_;  ///< outlines of shapes that were looked at
};

}  // namespace pcbmesh::compose
