// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/units.hpp"
#include "pcbmesh/geometry/point.hpp"

namespace pcbmesh::study {

/// What the solver is to find.
enum class Problem {
  driven,        ///< S-parameters over a sweep
  eigenmode,     ///< resonances
  electrostatic  ///< capacitances of the nets
};

/// Solver the mesh is meant for: sets version, unit and rules of the export, and refuses early what the solver can't do.
enum class Solver { none, palace, getdp, elmer, dolfinx, mfem };

enum class PortKind {
  lumped,  ///< a rectangle between two conductors
  wave     ///< a rectangle of the hull round the conductor that is cut there
};

/// How a lumped port lies between its conductors.
enum class PortShape {
  automatic,  ///< vertical where a reference lies above or below, else gap
  vertical,   ///< upright, from the reference on another layer to the net
  gap,        ///< flat, across the gap to the reference on the same layer
  coaxial     ///< flat ring in the antipad of a via, from the plane to the barrel or its pad
};

/// Sides of the domain. `side` stands for all other outer walls, those of a polygon too.
enum class HullSide { xmin, xmax, ymin, ymax, zmin, zmax, side };
inline constexpr std::size_t num_hull_sides = 7;

/// Where a port is: exactly one of pin, point and side is given.
struct PortPlace {
  std::string pin{};                       ///< component pin, "J1.2"
  std::optional<geometry::Point> point{};  ///< place on the board
  std::string layer{};             ///< copper layer of the net at that point, of the plane round a coaxial port; empty = found
  std::optional<HullSide> side{};  ///< where the region cuts the net: xmin, xmax, ymin or ymax
  bool operator==(const PortPlace&) const = default;
};

/// A port from the reference net (negative terminal) to the net (positive terminal).
struct Port {
  std::string name{};
  PortKind kind = PortKind::lumped;
  std::string net{};        ///< positive terminal
  std::string reference{};  ///< negative terminal; empty = the plane found nearest
  PortPlace at{};
  PortShape shape = PortShape::automatic;
  double impedance_ohm = 50;
  bool excited = true;
  std::optional<Nm> width{};   ///< extent along the conductor's cross-section; empty = the conductor's width
  std::optional<Nm> height{};  ///< wave: height above the reference; empty = up to the next reference or the end of the domain
  std::optional<Nm> max_edge{};  ///< longest edge on its faces; empty = two elements at least across and along, wave: no bound
  bool operator==(const Port&) const = default;
};

enum class BoundaryKind {
  automatic,  ///< absorbing; none where a lumped port lies on the side, or a ring may lie right at it, for it would be loaded
  none,       ///< nothing is said: the solver's natural condition
  absorbing,  ///< first-order absorbing boundary
  pec,        ///< electric wall; symmetry plane of odd fields
  pmc,        ///< magnetic wall; symmetry plane of even fields
  impedance,  ///< surface impedance
  periodic,   ///< with the opposite side, whose triangles match; xmin with xmax, ymin with ymax
  pml         ///< perfectly matched layers outside the air box, and `backing` behind them
};

/// What holds on one side of the domain.
struct Boundary {
  BoundaryKind kind = BoundaryKind::automatic;
  double ohms = 0;                           ///< kind impedance
  Nm thickness = 0;                          ///< kind pml: of all its layers
  int layers = 3;                            ///< kind pml: elements across, at least
  int order = 2;                             ///< kind pml: power of the depth by which the stretch grows; one for all sides
  BoundaryKind backing = BoundaryKind::pec;  ///< kind pml: on the outer faces; pec, pmc, absorbing or none
  bool operator==(const Boundary&) const = default;
};

/// Frequencies to be solved.
struct Sweep {
  double from_hz = 0;  ///< with an empty list: `points` frequencies, evenly spaced, both ends included
  double to_hz = 0;
  std::int64_t points = 0;
  std::vector<double> list_hz{};  ///< ascending; if not empty, these and no others
  /// All frequencies, ascending.
  [[nodiscard]] std::vector<double> frequencies_hz() const;
  bool operator==(const Sweep&) const = default;
};

/// Eigenmode: how many, from which frequency on.
struct Modes {
  std::int64_t number = 5;
  double above_hz = 1e8;
  bool operator==(const Modes&) const = default;
};

[[nodiscard]] std::string_view name_of(Problem value);
[[nodiscard]] std::string_view name_of(Solver value);
[[nodiscard]] std::string_view name_of(PortKind value);
[[nodiscard]] std::string_view name_of(PortShape value);
[[nodiscard]] std::string_view name_of(HullSide value);
[[nodiscard]] std::string_view name_of(BoundaryKind value);
/// Inverse of name_of. @throws Error usage (101) listing the choices.
[[nodiscard]] Problem parse_problem(std::string_view text);
[[nodiscard]] Solver parse_solver(std::string_view text);
[[nodiscard]] PortKind parse_port_kind(std::string_view text);
[[nodiscard]] PortShape parse_port_shape(std::string_view text);
[[nodiscard]] HullSide parse_hull_side(std::string_view text);
[[nodiscard]] BoundaryKind parse_boundary_kind(std::string_view text);

}  // namespace pcbmesh::study
