// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pcbmesh/layering/prism_quality.hpp"
#include "pcbmesh/mesh/layer_plan.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::layering {

/// The paper's CALCULATE_PRISM_HEIGHT: common height h for one policy, metres; nullopt for policies none and
/// matched, which have no common height.
/// Thinnest layer means thinnest board slab: air does not count. @throws Error layering_invalid (501) where there is no board
/// slab, or no triangle to take heights from.
[[nodiscard]] std::optional<double> common_height_m(study::HeightPolicy policy, const HeightStatistics& heights,
                                                    std::span<const model::Slab> slabs);

/// Longest edge for the second triangulation (REVISED step): h if the policy feeds back and h < longest_edge, else nullopt.
[[nodiscard]] std::optional<double> feedback_edge_m(study::HeightPolicy policy, double common_height_m, double longest_edge_m);

/// Number of sub-layers of a layer of height H for common height h. Tolerates rounding: 0.4 / 0.1 is 4.
/// `optimal` uses the final mesh's mean optimal height instead of h. At least 1; above 2^31 - 1 it is 2^31 - 1.
/// @throws Error layering_invalid (501) if a height is not a positive number.
[[nodiscard]] int num_sublayers(study::SublayerRule rule, double layer_height_m, double common_height_m,
                                const HeightStatistics& final_heights);

/// Counts per layer that make the plain mean of the prism quality as great as it can be: sum of n_i g_i(n_i) over sum of n_i,
/// solved exactly (of the binned heights) by Dinkelbach's iteration. The plain mean can be gamed by many small good prisms:
/// look at the volume-weighted one too. @throws Error layering_invalid (501) without heights. @cost O(layers x cuts x bins).
[[nodiscard]] std::vector<int> best_mean_counts(std::span<const double> layer_heights_m, const HeightStatistics& final_heights);

/// Sub-layers of each slab by the rule. `common_height_m` empty: one per slab unless the rule is optimal or best_mean.
[[nodiscard]] std::vector<int> sublayer_counts(std::span<const model::Slab> slabs, study::SublayerRule rule,
                                               std::optional<double> common_height_m, const HeightStatistics& final_heights);

/// Sub-layers of each slab as the paper's tables imply: case 1 (basic) truncates quotients of z differences in single
/// precision, z counted from the bottom in metres, so that 0.4 over 0.1 mm may be 3; in cases 2 to 5 layers stay whole.
[[nodiscard]] std::vector<int> paper_counts(std::span<const model::Slab> slabs, study::HeightPolicy policy);

/// z levels for all slabs by `sublayer_counts` alone, without the bounds of a field solver.
/// Levels are equally spaced in a slab, and slab faces are exactly its z in metres.
/// @throws Error layering_invalid (501) if a count exceeds 1,000,000, or all together exceed 10,000,000.
[[nodiscard]] mesh::LayerPlan choose_layers(std::span<const model::Slab> slabs, study::SublayerRule rule,
                                            std::optional<double> common_height_m, const HeightStatistics& final_heights);

}  // namespace pcbmesh::layering
