// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/mesh/layer_plan.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/model/model.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::layering {

/// What the field solver asks of the sub-layers of one slab.
struct SlabLimits {
  double wavelength_height_m = std::numeric_limits<double>::infinity();  ///< no sub-layer higher than this
  int least_count = 1;                                                   ///< elements across a dielectric
  int port_count = 1;                                                    ///< elements along the ports that stand in it
  double face_height_m = std::numeric_limits<double>::infinity();        ///< of the first sub-layer at each face: skin depth
  double skin_depth_m = 0;                                               ///< 0 = no meshed copper, or not asked for
};

/// Slowest wave of a slab, as a factor on the vacuum's: sqrt(eps_r mu_r) of its material, and of what lies outside the board.
[[nodiscard]] double slowness(const model::Model& model, const model::Slab& slab);

/// Wavelength in the slab's own material; dielectrics; upright lumped ports; skin depth sqrt(2 / (omega mu sigma)) of copper
/// that is meshed, cut into study.skin_depth_layers heights that grow by `height_growth`. @throws Error layering_invalid (501)
/// for copper without conductivity where the skin depth is asked for.
[[nodiscard]] std::vector<SlabLimits> slab_limits(const model::Model& model, const study::Study& study);

/// What decided how a slab is cut.
enum class HeightCause {
  slab,        ///< nothing asks for a cut
  policy,      ///< height policy and sub-layer rule
  wavelength,  ///< elements per wavelength
  across,      ///< elements per dielectric
  port,        ///< elements along a port
  skin_depth,  ///< grading from the faces of copper
  growth       ///< a neighbour's low sub-layers
};
[[nodiscard]] std::string_view name_of(HeightCause cause);

/// How one slab is cut, and why.
struct LayerChoice {
  std::string layer;
  double height_m = 0;
  int policy_count = 1;  ///< before the bounds of the field solver
  int count = 1;
  double lowest_m = 0, highest_m = 0;  ///< of its sub-layers
  HeightCause cause = HeightCause::slab;
  SlabLimits limits;
};

struct DividedLayers {
  mesh::LayerPlan plan;
  std::vector<LayerChoice> layers;  ///< one per slab
};

/// Cuts each slab into at least `counts` sub-layers, and more where the limits ask. Without face heights and `growth` the
/// sub-layers of a slab are equal; with them they grow geometrically from faces and neighbours.
///
/// @guarantee D1  no sub-layer is higher than its wavelength_height_m or than slab height / max(count, least_count, port_count)
/// @guarantee D2  the sub-layers at both faces are at most face_height_m
/// @guarantee D3  neighbouring sub-layers, across slab faces too, differ at most by the factor `growth`
/// @param growth  ratio, at least 1.1; 2 if empty and any face height is finite
/// @throws Error layering_invalid (501) if a count exceeds 1,000,000, or all together exceed 10,000,000.
[[nodiscard]] DividedLayers divide_layers(std::span<const model::Slab> slabs, std::span<const int> counts,
                                          std::span<const SlabLimits> limits, std::optional<double> growth);

/// Fewest equal sub-layers of each slab that the wavelength and the elements per dielectric allow.
[[nodiscard]] std::vector<int> least_counts(std::span<const model::Slab> slabs, std::span<const SlabLimits> limits);

/// Heights, bottom to top, of the fewest sub-layers of one slab that obey: first <= bottom, last <= top, each <= most,
/// neighbours differ at most by the factor `growth`. All > 0 and finite, growth > 1. @cost O(sub-layers).
[[nodiscard]] std::vector<double> graded_heights(double height, double bottom, double top, double most, double growth);

/// One layer's prisms by the policy alone (equal sub-layers) and as they are.
struct LayerExplanation {
  std::int64_t num_triangles = 0;  ///< that carry prisms
  std::int64_t prisms_before = 0, prisms_after = 0;
  double quality_before = 0, quality_after = 0;        ///< mean q_p
  double quality_one_fewer = 0, quality_one_more = 0;  ///< mean q_p of one equal sub-layer fewer (0 = none) or more
  double best_height_m = 0;                            ///< mean optimal height of the triangles
  double relative_height = 0;                          ///< mean sub-layer height over best_height_m: s of F6
  double sensitivity_per_m2 = 0;                       ///< mean q_p''(h*) = -(4/3) q*/h*^2 (F8)
};
/// @cost O(triangles x slabs + distinct heights x bins).
[[nodiscard]] std::vector<LayerExplanation> explain_layers(const mesh::PrismMesh& mesh, std::span<const LayerChoice> layers);

}  // namespace pcbmesh::layering
