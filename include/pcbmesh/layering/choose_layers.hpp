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

/// The paper's CALCULATE_PRISM_HEIGHT: common height h for one policy, metres; nullopt for policy none.
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

/// z levels for all slabs. `common_height_m` empty: one sub-layer per slab unless the rule is optimal or best_mean.
/// Levels are equally spaced in a slab, and slab faces are exactly its z in metres.
/// @throws Error layering_invalid (501) if a count exceeds 1,000,000, or all together exceed 10,000,000.
[[nodiscard]] mesh::LayerPlan choose_layers(std::span<const model::Slab> slabs, study::SublayerRule rule,
                                            std::optional<double> common_height_m, const HeightStatistics& final_heights);

}  // namespace pcbmesh::layering
