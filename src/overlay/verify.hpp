// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/overlay/census.hpp"

namespace pcbmesh::overlay {

/// Why a graph cannot stand for the layout.
struct Mismatch {
  std::string text;
  std::int32_t body = -1;            ///< whose parts differ, or -1
  std::int32_t net = board::no_net;  ///< whose pieces differ, or no_net
  std::optional<NetPair> nets;       ///< nets that met or parted
};

/// Compares what came out with what went in. Nets that met or parted come first, then parts per body, then pieces per net.
[[nodiscard]] std::vector<Mismatch> compare(const Census& exact, const Census& got, const model::Model& model);

/// A place where one has a part that the other lacks nearby; nullopt if none is found.
[[nodiscard]] std::optional<Point> differing_place(const std::vector<Point>& a, const std::vector<Point>& b, double near_nm);

}  // namespace pcbmesh::overlay
