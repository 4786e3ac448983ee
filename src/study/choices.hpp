// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/near_miss.hpp"
#include "pcbmesh/study/study.hpp"

namespace pcbmesh::study {

/// One value of an enumeration and its name in files and on the command line.
template <typename Value>
struct Choice {
  Value value;
  std::string_view name;
};

inline constexpr std::array<Choice<RegionKind>, 4> region_names{
    {{RegionKind::whole, "whole"}, {RegionKind::nets, "nets"}, {RegionKind::box, "box"}, {RegionKind::polygon, "polygon"}}};
inline constexpr std::array<Choice<ConductorMode>, 3> conductor_names{
    {{ConductorMode::solid, "solid"}, {ConductorMode::hollow, "hollow"}, {ConductorMode::sheet, "sheet"}}};
inline constexpr std::array<Choice<ConductorSurface>, 2> surface_names{
    {{ConductorSurface::lossy, "lossy"}, {ConductorSurface::pec, "pec"}}};
/// In the order of their numbers: none, the paper's cases 1 to 5, our 6 and 7.
inline constexpr std::array<Choice<HeightPolicy>, 8> policy_names{{{HeightPolicy::none, "none"},
                                                                   {HeightPolicy::basic, "basic"},
                                                                   {HeightPolicy::average, "average"},
                                                                   {HeightPolicy::maximum, "maximum"},
                                                                   {HeightPolicy::minimum, "minimum"},
                                                                   {HeightPolicy::thinnest_layer, "thinnest_layer"},
                                                                   {HeightPolicy::weighted, "weighted"},
                                                                   {HeightPolicy::matched, "matched"}}};
inline constexpr std::array<Choice<SublayerRule>, 6> sublayer_names{{{SublayerRule::floor, "floor"},
                                                                     {SublayerRule::round, "round"},
                                                                     {SublayerRule::ceil, "ceil"},
                                                                     {SublayerRule::none, "none"},
                                                                     {SublayerRule::optimal, "optimal"},
                                                                     {SublayerRule::best_mean, "best_mean"}}};
inline constexpr std::array<Choice<TriangleSeed>, 2> seed_names{
    {{TriangleSeed::delaunay, "delaunay"}, {TriangleSeed::hex, "hex"}}};
inline constexpr std::array<Choice<ElementSplit>, 2> split_names{
    {{ElementSplit::none, "none"}, {ElementSplit::tetrahedra, "tets"}}};
inline constexpr std::array<Choice<geometry::ArcMode>, 4> arc_names{{{geometry::ArcMode::inscribed, "inscribed"},
                                                                     {geometry::ArcMode::circumscribed, "circumscribed"},
                                                                     {geometry::ArcMode::equal_area, "equal_area"},
                                                                     {geometry::ArcMode::octagon, "octagon"}}};

inline constexpr std::array<Choice<Problem>, 3> problem_names{
    {{Problem::driven, "driven"}, {Problem::eigenmode, "eigenmode"}, {Problem::electrostatic, "electrostatic"}}};
inline constexpr std::array<Choice<Solver>, 6> solver_names{{{Solver::none, "none"},
                                                             {Solver::palace, "palace"},
                                                             {Solver::getdp, "getdp"},
                                                             {Solver::elmer, "elmer"},
                                                             {Solver::dolfinx, "dolfinx"},
                                                             {Solver::mfem, "mfem"}}};
inline constexpr std::array<Choice<PortKind>, 2> port_kind_names{{{PortKind::lumped, "lumped"}, {PortKind::wave, "wave"}}};
inline constexpr std::array<Choice<PortShape>, 4> port_shape_names{{{PortShape::automatic, "auto"},
                                                                    {PortShape::vertical, "vertical"},
                                                                    {PortShape::gap, "gap"},
                                                                    {PortShape::coaxial, "coaxial"}}};
inline constexpr std::array<Choice<HullSide>, num_hull_sides> hull_side_names{{{HullSide::xmin, "xmin"},
                                                                               {HullSide::xmax, "xmax"},
                                                                               {HullSide::ymin, "ymin"},
                                                                               {HullSide::ymax, "ymax"},
                                                                               {HullSide::zmin, "zmin"},
                                                                               {HullSide::zmax, "zmax"},
                                                                               {HullSide::side, "side"}}};
inline constexpr std::array<Choice<BoundaryKind>, 8> boundary_names{{{BoundaryKind::automatic, "automatic"},
                                                                     {BoundaryKind::none, "none"},
                                                                     {BoundaryKind::absorbing, "absorbing"},
                                                                     {BoundaryKind::pec, "pec"},
                                                                     {BoundaryKind::pmc, "pmc"},
                                                                     {BoundaryKind::impedance, "impedance"},
                                                                     {BoundaryKind::periodic, "periodic"},
                                                                     {BoundaryKind::pml, "pml"}}};

template <typename Value, std::size_t N>
[[nodiscard]] std::string_view name_in(const std::array<Choice<Value>, N>& choices, Value value) {
  for (const Choice<Value>& choice : choices)
    if (choice.value == value) return choice.name;
  return "?";
}

/// @throws Error usage (101) listing the choices.
template <typename Value, std::size_t N>
[[nodiscard]] Value value_in(const std::array<Choice<Value>, N>& choices, std::string_view text, std::string_view what) {
  std::vector<std::string> names;
  for (const Choice<Value>& choice : choices) {
    if (choice.name == text) return choice.value;
    names.emplace_back(choice.name);
  }
  throw Error(ErrorCode::usage, fmt::format("unknown {} '{}'; choices are {}{}", what, text.substr(0, 60),
                                            fmt::join(names, ", "), did_you_mean(text, names)));
}

}  // namespace pcbmesh::study
