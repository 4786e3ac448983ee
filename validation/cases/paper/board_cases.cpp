// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/running_sum.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/extrude/extrude.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/layering/choose_layers.hpp"
#include "pcbmesh/layering/prism_quality.hpp"
#include "pcbmesh/layering/quality_report.hpp"
#include "pcbmesh/overlay/overlay.hpp"
#include "pcbmesh/triangulate/triangulate.hpp"
#include "validation/cases/paper/measure.hpp"

namespace pcbmesh::validation::paper {
namespace {

using Json = nlohmann::ordered_json;
using study::HeightPolicy;
using study::SublayerRule;

constexpr double longest_edge_m = 2e-3;  // the paper's first bound
constexpr std::array policies{HeightPolicy::basic, HeightPolicy::average, HeightPolicy::maximum, HeightPolicy::minimum,
                              HeightPolicy::thinnest_layer};
constexpr std::array rules{SublayerRule::floor, SublayerRule::round, SublayerRule::ceil, SublayerRule::none,
                           SublayerRule::optimal};

/// The paper's world: the board alone, nothing simplified (a tenth of a micrometre moves no octagon).
study::Study study_of_paper() {
  study::Study study;
  study.air_above = study.air_below = 0;
  study.tolerance = 100;
  study.longest_edge = 2 * nm_per_mm;
  study.paper_compat = true;
  return study;
}

/// Sums over prisms of equal base: one per triangle and sub-layer height.
struct PrismMean {
  RunningSum quality, weighted, volume;
  std::int64_t num_prisms = 0;
  void add(double area, double beta, double height) {
    const double q = height > 0 ? layering::prism_quality(area, beta, height) : 0.0;
    quality.add(q);
    weighted.add(q * area * height);
    volume.add(area * height);
    ++num_prisms;
  }
};

Json compat_json(const mesh::PlanarMesh& planar, const CompatLayers& compat, bool is_first_case) {
  std::vector<double> heights;
  for (std::size_t i = 0; i < compat.heights_m.size(); ++i) {
    const int count = is_first_case ? compat.first_counts[i] : 1;
    heights.insert(heights.end(), static_cast<std::size_t>(count), compat.heights_m[i] / count);
  }
  PrismMean mean;
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto squared = planar.squared_edges_m2(t);
    for (const double height : heights) mean.add(planar.area_m2(t), squared[0] + squared[1] + squared[2], height);
  }
  return {{"sublayers", heights.size()},
          {"prisms", mean.num_prisms},
          {"mean_prism", mean.quality.total() / static_cast<double>(mean.num_prisms)},
          {"volume_weighted_prism", mean.weighted.total() / mean.volume.total()}};
}

/// The product's own way: extruded, tagged, measured.
Json extruded_json(const mesh::PlanarMesh& planar, const mesh::LayerPlan& plan, const model::Model& model,
                   const overlay::OverlayResult& graph) {
  const mesh::PrismMesh prisms = extrude::extrude(planar, plan, model, graph.net_pieces, graph.touching_nets);
  const layering::QualityStatistics quality = layering::quality_statistics(prisms);
  double volume = 0;
  for (const mesh::VolumeTag& tag : prisms.volume_tags()) volume += tag.volume_m3;
  return {{"sublayers", plan.num_sublayers()},
          {"prisms", prisms.num_prisms()},
          {"mean_prism", quality.mean_prism},
          {"volume_weighted_prism", quality.volume_weighted_prism},
          {"volume_m3", volume}};
}

Json heights_json(const layering::HeightStatistics& heights, std::int32_t num_triangles) {
  return {{"min_m", heights.minimum},
          {"avg_m", heights.average},
          {"max_m", heights.maximum},
          {"share_below_average", static_cast<double>(heights.num_below_average) / num_triangles}};
}

Json all_heights_json(const mesh::PlanarMesh& planar) {
  Json out = Json::array();
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto squared = planar.squared_edges_m2(t);
    out.push_back(layering::optimal_height(squared[0] + squared[1] + squared[2]));
  }
  return out;
}

/// Everything about the planar mesh of one case that the paper prints, and the smallest angle.
Json planar_json(const mesh::PlanarMesh& planar) {
  const layering::HeightStatistics heights = layering::height_statistics(planar);
  double longest2 = 0, area = 0, min_angle_deg = 60;
  for (std::int32_t t = 0; t < planar.num_triangles(); ++t) {
    const auto squared = planar.squared_edges_m2(t);
    longest2 = std::max({longest2, squared[0], squared[1], squared[2]});
    area += planar.area_m2(t);
    min_angle_deg = std::min(min_angle_deg, layering::prism_measures(planar.area_m2(t), squared, 1).min_dihedral_deg);
  }
  return {{"triangles", planar.num_triangles()},
          {"mean_triangle", heights.mean_triangle_quality},
          {"heights", heights_json(heights, planar.num_triangles())},
          {"longest_edge_m", std::sqrt(longest2)},
          {"area_m2", area},
          {"min_angle_deg", min_angle_deg}};
}

struct Example {
  model::Model model;
  overlay::OverlayResult graph;
};

/// The five cases with one mesher. @param mesh_at  planar mesh for a longest edge in metres
/// @param measure  figures of the prisms of a plan over a planar mesh
template <class MeshAt, class Measure>
Json case_rows(const Example& example, const CompatLayers& compat, MeshAt mesh_at, Measure measure) {
  const mesh::PlanarMesh first = mesh_at(longest_edge_m);
  const layering::HeightStatistics first_heights = layering::height_statistics(first);
  Json rows = Json::array();
  for (std::size_t i = 0; i < policies.size(); ++i) {
    const double height = *layering::common_height_m(policies[i], first_heights, example.model.slabs());
    const std::optional<double> feedback = layering::feedback_edge_m(policies[i], height, longest_edge_m);
    const mesh::PlanarMesh planar = feedback ? mesh_at(*feedback) : first;
    const layering::HeightStatistics heights = layering::height_statistics(planar);
    Json row = planar_json(planar);
    row["case"] = i + 1;
    row["common_height_m"] = height;
    row["longest_edge_bound_m"] = feedback.value_or(longest_edge_m);
    row["compat"] = compat_json(planar, compat, policies[i] == HeightPolicy::basic);
    for (const SublayerRule rule : rules) {
      const mesh::LayerPlan plan = layering::choose_layers(example.model.slabs(), rule, height, heights);
      row["clean"][std::string(study::name_of(rule))] = measure(planar, plan);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Example read_example(const std::filesystem::path& board_file) {
  Diagnostics diagnostics;
  const study::Study study = study_of_paper();
  const board::Board board = formats::read_board(board_file).board;
  overlay::OverlayOptions options;
  options.tolerance_nm = study.tolerance;
  model::Model model = compose::compose(board, study, diagnostics);
  overlay::OverlayResult graph = overlay::overlay(model, options, diagnostics);
  return {std::move(model), std::move(graph)};
}

}  // namespace

Json measure_cases(const std::filesystem::path& board_file, const CompatLayers& compat) {
  const Example example = read_example(board_file);
  const auto mesher = [&](bool as_in_paper) {
    return [&example, as_in_paper](double edge_m) {
      Diagnostics diagnostics;
      triangulate::TriangulateOptions options;
      options.longest_edge_nm = edge_m / metres_per_nm;
      options.as_in_paper = as_in_paper;
      return triangulate::triangulate(example.graph.graph, example.model, options, diagnostics).mesh;
    };
  };
  const auto measure = [&](const mesh::PlanarMesh& planar, const mesh::LayerPlan& plan) {
    return extruded_json(planar, plan, example.model, example.graph);
  };
  double stack_m = 0;
  for (const model::Slab& slab : example.model.slabs())
    stack_m += static_cast<double>(slab.z_top_nm - slab.z_bottom_nm) * metres_per_nm;
  return {{"board", board_file.filename().string()},
          {"stack_m", stack_m},
          {"initial_heights_m", all_heights_json(mesher(true)(longest_edge_m))},
          {"cases", case_rows(example, compat, mesher(true), measure)},
          {"product_cases", case_rows(example, compat, mesher(false), measure)}};
}

}  // namespace pcbmesh::validation::paper
