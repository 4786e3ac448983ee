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

/// Place of an exact point, as the program prints coordinates.
std::string place_text(geometry::Point p) {
  return fmt::format("({:.6g}, {:.6g}) mm", static_cast<double>(p.x) * 1e-6, static_cast<double>(p.y) * 1e-6);
}

/// Where two segments cross in their interiors, rounded to the grid.
std::optional<geometry::Point> crossing(geometry::Point a, geometry::Point b, geometry::Point c, geometry::Point d) {
  const auto turn = [](geometry::Point p, geometry::Point q, geometry::Point r) { return geometry::orientation(p, q, r); };
  if (turn(a, b, c) * turn(a, b, d) >= 0 || turn(c, d, a) * turn(c, d, b) >= 0) return std::nullopt;
  const auto cross = [](geometry::Point o, geometry::Point p, geometry::Point q) {
    return static_cast<double>(p.x - o.x) * static_cast<double>(q.y - o.y) -
           static_cast<double>(p.y - o.y) * static_cast<double>(q.x - o.x);
  };
  const double t = cross(c, d, a) / (cross(c, d, a) - cross(c, d, b));
  return geometry::Point{a.x + std::llround(t * static_cast<double>(b.x - a.x)),
                         a.y + std::llround(t * static_cast<double>(b.y - a.y))};
}

void check_polygon(const Study& study, FaultList& faults) {
  const geometry::Ring& ring = study.polygon;
  if (study.region == RegionKind::polygon && ring.empty())
    faults.add("/region/polygon", "a region by polygon needs its corners, [[x, y], ...]");
  if (ring.empty()) return;
  if (ring.size() < 3) {
    faults.add("/region/polygon", fmt::format("a polygon of {} corners encloses nothing; give at least three", ring.size()));
    return;
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::string field = fmt::format("/region/polygon/{}", i);
    for (const Nm value : {ring[i].x, ring[i].y}) faults.require_length(field, value, -max_coordinate_nm, max_coordinate_nm);
    for (std::size_t j = 0; j < i; ++j)
      if (ring[j] == ring[i]) {
        faults.add(field,
                   fmt::format("corner {} lies at {} as corner {} does; leave one out", i + 1, place_text(ring[i]), j + 1));
        return;
      }
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const geometry::Point a = ring[i], b = ring[(i + 1) % ring.size()];
    for (std::size_t j = 0; j < ring.size(); ++j) {
      if (j == i || j == (i + 1) % ring.size() || geometry::orientation(a, b, ring[j]) != 0) continue;
      geometry::Box box;
      box.add(a), box.add(b);
      if (!box.contains(ring[j])) continue;
      faults.add(fmt::format("/region/polygon/{}", j),
                 fmt::format("the polygon touches itself at its corner {}, which lies on side {}; move it", place_text(ring[j]),
                             i + 1));
      return;
    }
  }
  for (std::size_t i = 0; i < ring.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (const auto at = crossing(ring[i], ring[(i + 1) % ring.size()], ring[j], ring[j + 1])) {
        faults.add("/region/polygon",
                   fmt::format("the polygon crosses itself near {}, side {} over side {}; order its corners along "
                               "the outline",
                               place_text(*at), j + 1, i + 1));
        return;
      }
}

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
  check_polygon(study, faults);
  if (!study.box) return;
  const geometry::Box& box = *study.box;
  if (box.max.x <= box.min.x || box.max.y <= box.min.y)
    faults.add("/region/box", "the box is empty: max must lie above and to the right of min");
  for (Nm value : {box.min.x, box.min.y, box.max.x, box.max.y})
    faults.require_length("/region/box", value, -max_coordinate_nm, max_coordinate_nm);
}

void check_heights(const Study& study, FaultList& faults) {
  const auto require_between = [&](std::string_view field, double value, double least, double most) {
    if (!(value >= least && value <= most))
      faults.add(field, fmt::format("{} is out of range; expected {} to {}", value, least, most));
  };
  const HeightBounds& bounds = study.height_bounds;
  require_between("/mesh/elements_per_wavelength", bounds.elements_per_wavelength, 1, 1000);
  if (bounds.elements_per_dielectric)
    require_between("/mesh/elements_per_dielectric", *bounds.elements_per_dielectric, 1, 1000);
  if (bounds.skin_depth_layers) require_between("/mesh/skin_depth_layers", *bounds.skin_depth_layers, 1, 20);
  if (bounds.skin_depth_layers && !highest_frequency_hz(study))
    faults.add("/mesh/skin_depth_layers",
               "the skin depth hangs on the frequency, and none is given; give one (--frequency 10GHz)");
  if (bounds.height_growth) require_between("/mesh/height_growth", *bounds.height_growth, 1.1, 100);
  const MatchGoal& goal = study.match;
  if (goal.target_quality) require_between("/mesh/target_quality", *goal.target_quality, 0.01, 1.02);
  const auto require_budget = [&](std::string_view field, const std::optional<std::int64_t>& budget) {
    if (budget && *budget < 1) faults.add(field, fmt::format("{} is out of range; expected at least 1", *budget));
  };
  require_budget("/mesh/budget_prisms", goal.budget_prisms);
  require_budget("/mesh/budget_unknowns", goal.budget_unknowns);
  const bool has_goal = goal != MatchGoal{};
  if (has_goal && study.policy != HeightPolicy::matched)
    faults.add("/mesh/height_policy",
               fmt::format("a target quality or a budget is for policy matched, but the policy is {}; take matched (--policy "
                           "matched), or leave the goal out",
                           name_of(study.policy)));
  if (!study.paper_compat) return;
  const bool is_case = study.policy >= HeightPolicy::basic && study.policy <= HeightPolicy::thinnest_layer;
  if (!is_case || study.seed != TriangleSeed::delaunay || study.smooth || study.edge_at_copper ||
      bounds.elements_per_dielectric || bounds.skin_depth_layers || bounds.height_growth)
    faults.add("/mesh/paper_compat",
               "the paper knows its five policies, plain Delaunay refinement and no bounds on heights; leave the rest out");
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
  check_heights(study, faults);
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
  if (text.size() == 1 && text[0] >= '1' && text[0] <= '7') return policy_names[static_cast<std::size_t>(text[0] - '0')].value;
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
         (!box || same_box(*box, *other.box)) && polygon == other.polygon && conductors == other.conductors &&
         conductor_rules == other.conductor_rules && air_above == other.air_above && air_below == other.air_below &&
         air_around == other.air_around && frequency_hz == other.frequency_hz && longest_edge == other.longest_edge &&
         min_angle_deg == other.min_angle_deg && edge_at_copper == other.edge_at_copper && growth == other.growth &&
         seed == other.seed && smooth == other.smooth && policy == other.policy && sublayers == other.sublayers &&
         height_bounds == other.height_bounds && match == other.match && paper_compat == other.paper_compat &&
         tolerance == other.tolerance && arcs.sagitta_nm == other.arcs.sagitta_nm && arcs.mode == other.arcs.mode &&
         unit == other.unit && split == other.split && order == other.order && wedge_nodes == other.wedge_nodes &&
         max_prisms == other.max_prisms && conductor_surface == other.conductor_surface && problem == other.problem &&
         solver == other.solver && ports == other.ports && boundaries == other.boundaries &&
         polygon_boundaries == other.polygon_boundaries && sweep == other.sweep && modes == other.modes &&
         fabrication == other.fabrication;
}

std::array<Boundary, num_hull_sides> resolved_boundaries(const Study& study) {
  std::array<Boundary, num_hull_sides> boundaries = study.boundaries;
  const auto has_lumped_port = [&](std::size_t side) {
    return std::ranges::any_of(study.ports, [&](const Port& port) {
      return port.kind == PortKind::lumped && port.at.side && static_cast<std::size_t>(*port.at.side) == side;
    });
  };
  // Where there is no air, the ring of a coaxial port may lie right at the end of the domain, which would load it as well.
  const bool has_ring = std::ranges::any_of(study.ports, [](const Port& port) { return port.shape == PortShape::coaxial; });
  const auto is_behind_ring = [&](std::size_t side) {
    return has_ring && ((side == static_cast<std::size_t>(HullSide::zmin) && study.air_below == 0) ||
                        (side == static_cast<std::size_t>(HullSide::zmax) && study.air_above == 0));
  };
  for (std::size_t i = 0; i < num_hull_sides; ++i)
    if (boundaries[i].kind == BoundaryKind::automatic)
      boundaries[i].kind = has_lumped_port(i) || is_behind_ring(i) ? BoundaryKind::none : BoundaryKind::absorbing;
  return boundaries;
}

std::vector<Boundary> resolved_polygon_boundaries(const Study& study) {
  if (study.region != RegionKind::polygon) return {};
  std::vector<Boundary> boundaries = study.polygon_boundaries;
  boundaries.resize(study.polygon.size());
  const Boundary otherwise = resolved_boundaries(study)[static_cast<std::size_t>(HullSide::side)];
  for (Boundary& boundary : boundaries)
    if (boundary.kind == BoundaryKind::automatic) boundary = otherwise;
  return boundaries;
}

HullSide opposite(HullSide side) {
  return static_cast<HullSide>(static_cast<int>(side) ^ 1);
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
  check_fabrication(study.fabrication, faults);
  return faults.take();
}

std::string text_of(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults)
    text += fmt::format("{}{}{}{}", text.empty() ? "" : "\n  ", fault.field, fault.field.empty() ? "" : ": ", fault.text);
  return text;
}

void check(const Study& study) {
  if (const std::vector<Fault> faults = faults_of(study); !faults.empty())
    throw Error(ErrorCode::study_invalid, text_of(faults));
}

}  // namespace pcbmesh::study
