// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/study/physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

void check_boundaries(const Study& study, FaultList& faults) {
  for (std::size_t i = 0; i < num_hull_sides; ++i) {
    const Boundary& boundary = study.boundaries[i];
    const auto side = static_cast<HullSide>(i);
    const std::string field = fmt::format("/boundaries/{}", name_of(side));
    if (boundary.kind == BoundaryKind::impedance && !(boundary.ohms > 0 && boundary.ohms <= 1e9))
      faults.add(field, fmt::format("a surface impedance of {} ohms is out of range; expected above 0", boundary.ohms));
    if (boundary.kind == BoundaryKind::periodic)
      faults.add(field,
                 "periodic sides are not built: the triangles of two sides do not match; take pmc or pec on both, "
                 "or a larger region with absorbing sides");
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
  if (study.solver == Solver::palace) return;
  for (std::size_t i = 0; i < study.ports.size() && study.problem == Problem::driven; ++i)
    if (study.ports[i].kind == PortKind::wave)
      faults.add(
          fmt::format("/ports/{}/kind", i),
          fmt::format("wave port '{}': only palace solves wave ports; make it lumped, or take palace", study.ports[i].name));
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
