// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcbmesh/base/error.hpp"
#include "src/study/choices.hpp"
#include "src/study/faults.hpp"

namespace pcbmesh::study {
namespace {

void check_region(const Study& study, FaultList& faults) {
  if (study.region == RegionKind::nets && study.nets.empty())
    faults.add("/region/nets", "a region by nets needs at least one net name");
  for (const std::string& net : study.nets)
    if (net.empty()) faults.add("/region/nets", "a net name is empty");
  for (std::size_t i = 0; i < study.nets.size(); ++i)
    if (std::find(study.nets.begin(), study.nets.begin() + static_cast<std::ptrdiff_t>(i), study.nets[i]) !=
        study.nets.begin() + static_cast<std::ptrdiff_t>(i))
      faults.add("/region/nets", fmt::format("net '{}' is named twice", study.nets[i]));
  faults.require_length("/region/margin", study.margin, 0, max_coordinate_nm);
  if (study.region == RegionKind::box && !study.box) faults.add("/region/box", "a region by box needs the box");
  if (!study.box) return;
  const geometry::Box& box = *study.box;
  if (box.max.x <= box.min.x || box.max.y <= box.min.y)
    faults.add("/region/box", "the box is empty: max must lie above and to the right of min");
  for (Nm value : {box.min.x, box.min.y, box.max.x, box.max.y})
    faults.require_length("/region/box", value, -max_coordinate_nm, max_coordinate_nm);
}

void check_mesh(const Study& study, FaultList& faults) {
  if (study.frequency_hz && !is_frequency(*study.frequency_hz))
    faults.add("/mesh/frequency", fmt::format("{} Hz is out of range; expected above 0 and up to 10 THz", *study.frequency_hz));
  if (study.longest_edge) faults.require_length("/mesh/longest_edge", *study.longest_edge, 1, max_coordinate_nm);
  if (study.edge_at_copper) faults.require_length("/mesh/edge_at_copper", *study.edge_at_copper, 1, max_coordinate_nm);
  if (study.edge_at_copper && study.longest_edge && *study.edge_at_copper > *study.longest_edge)
    faults.add("/mesh/edge_at_copper", fmt::format("{} is longer than the longest edge, {}",
                                                   format_length(*study.edge_at_copper), format_length(*study.longest_edge)));
  if (!(study.min_angle_deg > 0 && study.min_angle_deg <= 28.6))
    faults.add("/mesh/min_angle_deg",
               fmt::format("{} is out of range; expected above 0 and up to 28.6 degrees (refinement is sure to end up to 20.7)",
                           study.min_angle_deg));
  if (!(study.growth > 0 && study.growth <= 10))
    faults.add("/mesh/growth", fmt::format("{} is out of range; expected above 0 and up to 10", study.growth));
  if (study.edge_at_copper && study.seed == TriangleSeed::hex)
    faults.add("/mesh/seed",
               "the hexagonal lattice has edges of one length, but edge_at_copper asks for graded ones; leave one out");
  if (study.tolerance) faults.require_length("/mesh/tolerance", *study.tolerance, 1, nm_per_mm);
}

void check_elements(const Study& study, FaultList& faults) {
  if (study.order != 1 && study.order != 2)
    faults.add("/output/order", fmt::format("elements of order {} are not made; expected 1 or 2", study.order));
  if (study.wedge_nodes != 15 && study.wedge_nodes != 18)
    faults.add("/output/wedge_nodes", fmt::format("there is no wedge of {} nodes; expected 15 or 18", study.wedge_nodes));
  if (study.order == 2 && study.split == ElementSplit::tetrahedra && study.wedge_nodes == 15)
    faults.add("/output/wedge_nodes", "tetrahedra of second order are cut from wedges of 18 nodes; leave 15 out");
}

}  // namespace

std::string_view name_of(RegionKind value) {
  return name_in(region_names, value);
}
std::string_view name_of(ConductorMode value) {
  return name_in(conductor_names, value);
}
std::string_view name_of(ConductorSurface value) {
  return name_in(surface_names, value);
}
std::string_view name_of(HeightPolicy value) {
  return name_in(policy_names, value);
}
std::string_view name_of(SublayerRule value) {
  return name_in(sublayer_names, value);
}
std::string_view name_of(TriangleSeed value) {
  return name_in(seed_names, value);
}

std::string_view name_of(ElementSplit value) {
  return name_in(split_names, value);
}

HeightPolicy parse_height_policy(std::string_view text) {
  constexpr std::array<std::string_view, 5> paper_cases{"1", "2", "3", "4", "5"};
  for (std::size_t i = 0; i < paper_cases.size(); ++i)
    if (text == paper_cases[i]) return policy_names[i + 1].value;
  return value_in(policy_names, text, "height policy");
}
SublayerRule parse_sublayer_rule(std::string_view text) {
  return value_in(sublayer_names, text, "sub-layer rule");
}
TriangleSeed parse_triangle_seed(std::string_view text) {
  return value_in(seed_names, text, "triangle seed");
}
ElementSplit parse_element_split(std::string_view text) {
  return value_in(split_names, text, "split");
}
ConductorMode parse_conductor_mode(std::string_view text) {
  return value_in(conductor_names, text, "conductor mode");
}

bool Study::operator==(const Study& other) const {
  const auto same_box = [](const geometry::Box& a, const geometry::Box& b) { return a.min == b.min && a.max == b.max; };
  return region == other.region && nets == other.nets && margin == other.margin && box.has_value() == other.box.has_value() &&
         (!box || same_box(*box, *other.box)) && conductors == other.conductors && conductor_rules == other.conductor_rules &&
         air_above == other.air_above && air_below == other.air_below && air_around == other.air_around &&
         frequency_hz == other.frequency_hz && longest_edge == other.longest_edge && min_angle_deg == other.min_angle_deg &&
         edge_at_copper == other.edge_at_copper && growth == other.growth && seed == other.seed && smooth == other.smooth &&
         policy == other.policy && sublayers == other.sublayers && tolerance == other.tolerance &&
         arcs.sagitta_nm == other.arcs.sagitta_nm && arcs.mode == other.arcs.mode && unit == other.unit &&
         split == other.split && order == other.order && wedge_nodes == other.wedge_nodes &&
         max_prisms == other.max_prisms && conductor_surface == other.conductor_surface && problem == other.problem &&
         solver == other.solver && ports == other.ports && boundaries == other.boundaries && sweep == other.sweep &&
         modes == other.modes;
}

std::optional<double> highest_frequency_hz(const Study& study) {
  if (study.frequency_hz || !study.sweep) return study.frequency_hz;
  return study.sweep->list_hz.empty() ? study.sweep->to_hz : study.sweep->list_hz.back();
}

std::vector<Fault> faults_of(const Study& study) {
  FaultList faults;
  check_region(study, faults);
  faults.require_length("/air/above", study.air_above, 0, max_coordinate_nm);
  faults.require_length("/air/below", study.air_below, 0, max_coordinate_nm);
  faults.require_length("/air/around", study.air_around, 0, max_coordinate_nm);
  check_mesh(study, faults);
  faults.require_length("/arcs/sagitta", study.arcs.sagitta_nm, 1, nm_per_mm);
  check_elements(study, faults);
  if (study.max_prisms < 1)
    faults.add("/limits/max_prisms", fmt::format("{} is out of range; expected at least 1", study.max_prisms));
  check_physics(study, faults);
  return faults.take();
}

std::string text_of(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += fmt::format("{}{}: {}", text.empty() ? "" : "\n  ", fault.field, fault.text);
  return text;
}

void check(const Study& study) {
  if (const std::vector<Fault> faults = faults_of(study); !faults.empty())
    throw Error(ErrorCode::study_invalid, text_of(faults));
}

}  // namespace pcbmesh::study
