// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace pcbmesh::validation::paper {

/// Table 1: the two height rules on `count` triangles with corners uniform in the unit square, both on the same sample.
[[nodiscard]] nlohmann::ordered_json measure_random_triangles(std::uint64_t seed, int count);

/// Figure 4: quality over height of one random triangle, and the parabola of the closed second derivative (F8).
[[nodiscard]] nlohmann::ordered_json sample_sensitivity(std::uint64_t seed);

/// The layers the printed tables imply for an example, which are not those of the text.
struct CompatLayers {
  std::vector<double> heights_m;           ///< 0 = degenerate: it counts as a prism of quality 0
  std::vector<std::int32_t> first_counts;  ///< sub-layers of each in case 1; cases 2 to 5 cut nothing
};

/// Tables 3 and 4: all five cases on one board, with CGAL's way of refinement as the authors had it ("cases") and with the
/// product's ("product_cases"). Each with the compat layers and, in clean mode (every layer of the board really cut), for every
/// sub-layer rule.
[[nodiscard]] nlohmann::ordered_json measure_cases(const std::filesystem::path& board, const CompatLayers& compat);

}  // namespace pcbmesh::validation::paper
