// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/study/physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "pcbmesh/study/solver_needs.hpp"
#include "src/study/choices.hpp"
#include "src/study/faults.hpp"

namespace pcbmesh::study {
namespace {

constexpr std::int64_t most_points = 100'000;

void check_port(const Port& port, std::size_t number, FaultList& faults) {
  const std::string field = fmt::format("/ports/{}", number);
  const std::string who = port.name.empty() ? fmt::format("port {}", number + 1) : fmt::format("port '{}'", port.name);
  if (port.name.empty()) faults.add(field + "/name", fmt::format("{} has no name", who));
  if (port.net.empty()) faults.add(field + "/net", fmt::format("{} names no net for its positive terminal", who));
  if (!port.net.empty() && port.net == port.reference)
    faults.add(field + "/reference",
               fmt::format("{} has both terminals on net '{}'; name another reference, or leave it out to have it found", who,
                           port.net));
  const int num_places = (port.at.pin.empty() ? 0 : 1) + (port.at.point ? 1 : 0) + (port.at.side ? 1 : 0);
  if (num_places != 1)
    faults.add(field + "/at", fmt::format("{} needs one place: a pin, a point or a side of the region", who));
  if (port.at.side && *port.at.side > HullSide::ymax)
    faults.add(field + "/at/side",
               fmt::format("{} can't be on {}; a net is cut at xmin, xmax, ymin or ymax", who, name_of(*port.at.side)));
  if (port.kind == PortKind::wave && num_places == 1 && !port.at.side)
    faults.add(field + "/at", fmt::format("wave {} must be on the hull; give a side of the region, or make it lumped", who));
  if (port.kind == PortKind::wave && port.shape != PortShape::automatic)
    faults.add(field + "/shape", fmt::format("wave {} has no shape; a shape belongs to lumped ports", who));
  if (port.at.point)
    for (const Nm value : {port.at.point->x, port.at.point->y})
      faults.require_length(field + "/at/point", value, -max_coordinate_nm, max_coordinate_nm);
  if (!(port.impedance_ohm > 0 && port.impedance_ohm <= 1e9))
    faults.add(field + "/impedance", fmt::format("{} ohms of {} are out of range; expected above 0", port.impedance_ohm, who));
  if (port.width) faults.require_length(field + "/width", *port.width, nm_per_um, max_coordinate_nm);
  if (port.height) faults.require_length(field + "/height", *port.height, nm_per_um, max_coordinate_nm);
  if (port.max_edge) faults.require_length(field + "/max_edge", *port.max_edge, nm_per_um, max_coordinate_nm);
  if (port.shape == PortShape::coaxial && port.at.side)
    faults.add(field + "/at", fmt::format("coaxial {} needs a via: give a pin, or a point on a plated hole", who));
  if (port.shape == PortShape::coaxial && port.width)
    faults.add(field + "/width", fmt::format("the width of coaxial {} follows from its antipad; leave it out", who));
  if (port.height && port.kind != PortKind::wave)
    faults.add(field + "/height", fmt::format("the height of lumped {} follows from its conductors; leave it out", who));
}

void check_ports(const Study& study, FaultList& faults) {
  for (std::size_t i = 0; i < study.ports.size(); ++i) {
    const Port& port = study.ports[i];
    check_port(port, i, faults);
    for (std::size_t j = 0; j < i; ++j) {
      if (!port.name.empty() && study.ports[j].name == port.name)
        faults.add(fmt::format("/ports/{}/name", i),
                   fmt::format("two ports are called '{}'; give each its own name", port.name));
      if (!port.net.empty() && study.ports[j].net == port.net && study.ports[j].at == port.at)
        faults.add(fmt::format("/ports/{}/at", i),
                   fmt::format("port '{}' stands where port '{}' stands already, on net '{}'; leave one out or move it",
                               port.name, study.ports[j].name, port.net));
    }
  }
}

void check_sweep(const Sweep& sweep, FaultList& faults) {
  if (!sweep.list_hz.empty()) {
    for (std::size_t i = 0; i < sweep.list_hz.size(); ++i) {
      if (!is_frequency(sweep.list_hz[i]))
        faults.add(fmt::format("/sweep/list/{}", i),
                   fmt::format("{} Hz is out of range; expected above 0 and up to 10 THz", sweep.list_hz[i]));
      if (i > 0 && !(sweep.list_hz[i] > sweep.list_hz[i - 1]))
        faults.add(fmt::format("/sweep/list/{}", i), "frequencies must ascend, and none may come twice");
    }
    return;
  }
  for (const auto& [field, hz] : {std::pair{"/sweep/from", sweep.from_hz}, {"/sweep/to", sweep.to_hz}})
    if (!is_frequency(hz)) faults.add(field, fmt::format("{} Hz is out of range; expected above 0 and up to 10 THz", hz));
  if (sweep.points < 1 || sweep.points > most_points)
    faults.add("/sweep/points", fmt::format("{} is out of range; expected 1 to {}", sweep.points, most_points));
  if (sweep.to_hz < sweep.from_hz || (sweep.points > 1 && sweep.to_hz == sweep.from_hz))
    faults.add("/sweep/to", fmt::format("the sweep ends at {:g} Hz and begins at {:g} Hz; the end must lie above", sweep.to_hz,
                                        sweep.from_hz));
}

void check_boundary(const std::string& field, const Boundary& boundary, FaultList& faults) {
  if (boundary.kind == BoundaryKind::impedance && !(boundary.ohms > 0 && boundary.ohms <= 1e9))
    faults.add(field, fmt::format("a surface impedance of {} ohms is out of range; expected above 0", boundary.ohms));
}

/// Only the upright sides of a box have partners: bottom and top of a board differ.
void check_periodic(const Study& study, HullSide side, const std::string& field, FaultList& faults) {
  if (side > HullSide::ymax) {
    faults.add(field, fmt::format("{} can't be periodic; xmin with xmax and ymin with ymax can", name_of(side)));
    return;
  }
  if (study.boundaries[static_cast<std::size_t>(opposite(side))].kind != BoundaryKind::periodic)
    faults.add(field, fmt::format("a periodic side needs its partner: make {} periodic too", name_of(opposite(side))));
  if (study.paper_compat) faults.add(field, "the paper knows no periodic sides; leave paper_compat out");
}

void check_matched_layers(const Study& study, HullSide side, const std::string& field, FaultList& faults) {
  const Boundary& boundary = study.boundaries[static_cast<std::size_t>(side)];
  faults.require_length(field + "/thickness", boundary.thickness, nm_per_um, max_coordinate_nm);
  if (boundary.layers < 1 || boundary.layers > 50)
    faults.add(field + "/layers", fmt::format("{} is out of range; expected 1 to 50", boundary.layers));
  if (boundary.order < 1 || boundary.order > 4)
    faults.add(field + "/order", fmt::format("{} is out of range; expected 1 to 4", boundary.order));
  for (const Boundary& other : study.boundaries)
    if (other.kind == BoundaryKind::pml && other.order != boundary.order) {
      faults.add(field + "/order",
                 fmt::format("{} here and {} on another side; take one order for all", boundary.order, other.order));
      break;
    }
  if (boundary.backing != BoundaryKind::pec && boundary.backing != BoundaryKind::pmc &&
      boundary.backing != BoundaryKind::absorbing && boundary.backing != BoundaryKind::none)
    faults.add(field + "/backing", fmt::format("{} can't be behind matched layers; expected pec, pmc, absorbing or none",
                                               name_of(boundary.backing)));
  if (side == HullSide::side)
    faults.add(field, "walls of cut-outs and polygons can't have matched layers; take absorbing there");
  if (study.region == RegionKind::polygon && side <= HullSide::ymax)
    faults.add(field, "a polygonal region has matched layers above and below only; take a box, or absorbing sides");
  for (const auto& [z_side, air, name] :
       {std::tuple{HullSide::zmin, study.air_below, "below"}, std::tuple{HullSide::zmax, study.air_above, "above"}})
    if (side == z_side && air == 0)
      faults.add(field, fmt::format("matched layers lie outside the air, and there is none; give some in /air/{}", name));
  if (study.region == RegionKind::whole && side <= HullSide::ymax && study.air_around == 0)
    faults.add(field, "matched layers lie outside the air, and there is none beside the board; give some in /air/around");
  if (study.paper_compat) faults.add(field, "the paper knows no matched layers; leave paper_compat out");
}

void check_polygon_boundaries(const Study& study, FaultList& faults) {
  const std::size_t num_sides = study.region == RegionKind::polygon ? study.polygon.size() : 0;
  for (std::size_t i = 0; i < study.polygon_boundaries.size(); ++i) {
    const Boundary& boundary = study.polygon_boundaries[i];
    const std::string field = fmt::format("/boundaries/side_{}", i + 1);
    if (i >= num_sides && boundary.kind != BoundaryKind::automatic)
      faults.add(field, num_sides == 0
                            ? std::string("sides with numbers are those of a polygonal region; name xmin, xmax, ymin or ymax")
                            : fmt::format("the polygon has sides side_1 to side_{}", num_sides));
    check_boundary(field, boundary, faults);
    if (boundary.kind == BoundaryKind::periodic || boundary.kind == BoundaryKind::pml)
      faults.add(field, fmt::format("a side of a polygon can't be {}; take absorbing, pec, pmc or impedance, or a box region",
                                    name_of(boundary.kind)));
  }
  if (num_sides == 0) return;
  for (const HullSide side : {HullSide::xmin, HullSide::xmax, HullSide::ymin, HullSide::ymax}) {
    const Boundary& boundary = study.boundaries[static_cast<std::size_t>(side)];
    if (boundary.kind == BoundaryKind::automatic || boundary == study.boundaries[static_cast<std::size_t>(HullSide::side)])
      continue;
    faults.add(fmt::format("/boundaries/{}", name_of(side)),
               fmt::format("a polygonal region has no side {}; name side_1 to side_{}, or side for all of them", name_of(side),
                           num_sides));
  }
  for (std::size_t p = 0; p < study.ports.size(); ++p)
    if (study.ports[p].at.side)
      faults.add(fmt::format("/ports/{}/at/side", p),
                 fmt::format("port '{}' can't be on {}: the region is a polygon; put it on a pin or a point, or take a box",
                             study.ports[p].name, name_of(*study.ports[p].at.side)));
}

void check_boundaries(const Study& study, FaultList& faults) {
  for (std::size_t i = 0; i < num_hull_sides; ++i) {
    const Boundary& boundary = study.boundaries[i];
    const auto side = static_cast<HullSide>(i);
    const std::string field = fmt::format("/boundaries/{}", name_of(side));
    check_boundary(field, boundary, faults);
    if (boundary.kind == BoundaryKind::periodic) check_periodic(study, side, field, faults);
    if (boundary.kind == BoundaryKind::pml) check_matched_layers(study, side, field, faults);
    if (boundary.kind == BoundaryKind::periodic || boundary.kind == BoundaryKind::pml)
      for (std::size_t p = 0; p < study.ports.size(); ++p)
        if (study.ports[p].at.side == side)
          faults.add(fmt::format("/ports/{}/at/side", p),
                     fmt::format("port '{}' can't be on {}, which is {}; move it inside, or take another boundary there",
                                 study.ports[p].name, name_of(side), name_of(boundary.kind)));
  }
  check_polygon_boundaries(study, faults);
}

/// Conditions that the mesh has, but no deck can say yet.
void check_deck_boundaries(const Study& study, FaultList& faults) {
  for (std::size_t i = 0; i < num_hull_sides; ++i) {
    const BoundaryKind kind = study.boundaries[i].kind;
    if (kind != BoundaryKind::pml && kind != BoundaryKind::periodic) continue;
    // GetDP's deck stretches coordinates at a frequency and links edges; the other decks have neither.
    const bool is_getdp = study.solver == Solver::getdp;
    if (is_getdp &&
        (study.problem == Problem::driven || (study.problem == Problem::eigenmode && kind == BoundaryKind::periodic)))
      continue;
    faults.add(
        fmt::format("/boundaries/{}", name_of(static_cast<HullSide>(i))),
        fmt::format("the deck of {} has no {} in a {} problem; the nearest it can do is {}. Without a solver the mesh is "
                    "written with all its tags",
                    name_of(study.solver), kind == BoundaryKind::pml ? "perfectly matched layers" : "periodic sides",
                    name_of(study.problem),
                    kind == BoundaryKind::pml ? "absorbing" : "pec or pmc on both sides, which are symmetry planes"));
  }
}

/// What the named solver cannot do is refused before anything is meshed.
void check_solver(const Study& study, FaultList& faults) {
  if (study.solver == Solver::none) return;
  if (study.problem == Problem::driven) {
    if (std::ranges::none_of(study.ports, [](const Port& port) { return port.excited; }))
      faults.add("/ports", "a driven problem needs a port that is excited; `pcbmesh ports` proposes some");
    if (!study.sweep) faults.add("/sweep", "a driven problem needs frequencies; give from, to and points, or a list");
  }
  if (needs_tetrahedra(study) && study.split != ElementSplit::tetrahedra)
    faults.add(
        "/output/split",
        fmt::format("{0} has no edge elements on prisms, so a {1} problem can't be posed on them; let prisms be cut into "
                    "tetrahedra (--split tets), or take palace, getdp, elmer or mfem, or problem electrostatic",
                    name_of(study.solver), name_of(study.problem)));
  if (study.order == 2 && study.solver != Solver::palace)
    faults.add("/output/order",
               fmt::format("the deck of {} reads elements of first order; take order 1, or palace", name_of(study.solver)));
  check_deck_boundaries(study, faults);
  if (study.solver == Solver::palace || study.solver == Solver::getdp) return;
  for (std::size_t i = 0; i < study.ports.size() && study.problem == Problem::driven; ++i)
    if (study.ports[i].kind == PortKind::wave)
      faults.add(
          fmt::format("/ports/{}/kind", i),
          fmt::format(
              "wave port '{}': only palace and getdp have wave ports in their decks; make it lumped, or take one of them",
              study.ports[i].name));
}

}  // namespace

bool needs_tetrahedra(const Study& study) {
  return study.solver == Solver::dolfinx && study.problem != Problem::electrostatic;
}

std::vector<double> Sweep::frequencies_hz() const {
  if (!list_hz.empty()) return list_hz;
  std::vector<double> all;
  for (std::int64_t i = 0; i < points; ++i)
    all.push_back(points == 1 ? from_hz
                              : from_hz + (to_hz - from_hz) * static_cast<double>(i) / static_cast<double>(points - 1));
  return all;
}

std::string_view name_of(Problem value) {
  return name_in(problem_names, value);
}
std::string_view name_of(Solver value) {
  return name_in(solver_names, value);
}
std::string_view name_of(PortKind value) {
  return name_in(port_kind_names, value);
}
std::string_view name_of(PortShape value) {
  return name_in(port_shape_names, value);
}
std::string_view name_of(HullSide value) {
  return name_in(hull_side_names, value);
}
std::string_view name_of(BoundaryKind value) {
  return name_in(boundary_names, value);
}
Problem parse_problem(std::string_view text) {
  return value_in(problem_names, text, "problem");
}
Solver parse_solver(std::string_view text) {
  return value_in(solver_names, text, "solver");
}
PortKind parse_port_kind(std::string_view text) {
  return value_in(port_kind_names, text, "port kind");
}
PortShape parse_port_shape(std::string_view text) {
  return value_in(port_shape_names, text, "port shape");
}
HullSide parse_hull_side(std::string_view text) {
  return value_in(hull_side_names, text, "side");
}
BoundaryKind parse_boundary_kind(std::string_view text) {
  return value_in(boundary_names, text, "boundary");
}

void check_physics(const Study& study, FaultList& faults) {
  check_ports(study, faults);
  check_boundaries(study, faults);
  check_solver(study, faults);
  if (study.sweep) check_sweep(*study.sweep, faults);
  if (study.modes.number < 1 || study.modes.number > 1000)
    faults.add("/modes/number", fmt::format("{} is out of range; expected 1 to 1000", study.modes.number));
  if (!is_frequency(study.modes.above_hz))
    faults.add("/modes/above", fmt::format("{} Hz is out of range; expected above 0 and up to 10 THz", study.modes.above_hz));
}

}  // namespace pcbmesh::study
