// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "formats/getdp/write_pro.hpp"

namespace pcbmesh::formats::getdp {

std::string number(double value) {
  // A number without a point is an int to GetDP, and 3000000000 overflows.
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + "." : text;
}

std::string region(std::span<const std::int32_t> ids) {
  return fmt::format("Region[{{{}}}]", fmt::join(ids, ", "));
}

std::vector<std::int32_t> field_volumes(const deck::FieldProblem& problem) {
  std::vector<std::int32_t> ids;
  for (const deck::Volume& volume : problem.volumes)
    if (!volume.is_conductor) ids.push_back(volume.id);
  return ids;
}

std::vector<std::int32_t> metal_volumes(const deck::FieldProblem& problem) {
  std::vector<std::int32_t> ids;
  for (const deck::Volume& volume : problem.volumes)
    if (volume.is_conductor) ids.push_back(volume.id);
  return ids;
}

std::string opening(const deck::FieldProblem& problem, std::string_view what) {
  return fmt::format("// {} of {}, written by pcbmesh. Run it: sh {}\n", what, deck::plain(problem.options.mesh),
                     deck::plain(problem.stem() + ".run.sh"));
}

std::string named_groups(const deck::FieldProblem& problem) {
  std::string out;
  for (const deck::Volume& volume : problem.volumes)
    out += fmt::format("  Vol_{0} = Region[{0}];  // {1}: eps_r {2}, tan delta {3}, mu_r {4}, {5} S/m{6}\n", volume.id,
                       deck::plain(volume.name), volume.material.eps_r, volume.material.tan_delta, volume.material.mu_r,
                       volume.material.sigma_s_per_m, volume.is_conductor ? "; metal" : "");
  for (const deck::Face& face : problem.faces)
    out +=
        fmt::format("  Sur_{0} = Region[{0}];  // {1}: {2}\n", face.id, deck::plain(face.name), mesh::name_of(face.condition));
  return out;
}

std::string_view integration() {
  return R"(Jacobian {
  { Name Jac_All; Case { { Region Vol_Every; Jacobian Vol; } { Region All; Jacobian Sur; } } }
}
Integration {
  { Name Int_All; Case { { Type Gauss; Case {
    { GeoElement Prism; NumberOfPoints 6; } { GeoElement Tetrahedron; NumberOfPoints 4; }
    { GeoElement Triangle; NumberOfPoints 3; } { GeoElement Quadrangle; NumberOfPoints 4; } } } } }
}
)";
}

std::string edge_space(const deck::FieldProblem& problem, std::string_view support) {
  std::string links;
  for (const deck::Face& face : problem.faces) {
    if (face.condition != mesh::BoundaryCondition::periodic || !face.name.ends_with("max")) continue;
    const double unit_m = metres_per(problem.options.unit);
    const bool in_x = face.name.starts_with('x');
    const std::string back = number(problem.period_m[in_x ? 0 : 1] / unit_m);
    links += fmt::format(
        "    {{ Region Sur_{}; Type Link; RegionRef Sur_{}; Coefficient 1.; Function Vector[X[]{}, Y[]{}, Z[]]; }}\n", face.id,
        face.partner, in_x ? "-" + back : "", in_x ? "" : "-" + back);
  }
  return fmt::format(R"(Constraint {{
  {{ Name Con_Metal; Case {{
    {{ Region Dom_Metal; Type Assign; Value 0.; }}
{}  }} }}
}}
FunctionSpace {{
  {{ Name Hcurl_E; Type Form1;
    BasisFunction {{ {{ Name se; NameOfCoef ee; Function BF_Edge; Support {}; Entity EdgesOf[All]; }} }}
    Constraint {{ {{ NameOfCoef ee; EntityType EdgesOf; NameOfConstraint Con_Metal; }} }} }}
}}
)",
                     links, support);
}

std::string stretch_functions(const deck::FieldProblem& problem, double unit_m) {
  if (!problem.shell) return {};
  // A conductivity of the coordinate itself, so that what comes back from the outer face has lost the same at every frequency:
  // the usual choice, J.-P. Berenger, J. Comput. Phys. 114, 1994. More loss than this is reflected by the coarse layers.
  constexpr double wanted_reflection = 1e-3;
  const mesh::Shell& shell = *problem.shell;
  std::string out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char name = static_cast<char>('x' + axis), coordinate = static_cast<char>('X' + axis);
    std::string branches;
    const auto add = [&](bool is_high, double inner_m, double outer_m) {
      const double thickness_m = std::abs(outer_m - inner_m);
      if (thickness_m <= 0) return;
      const double sigma = -(shell.order + 1) * std::log(wanted_reflection) / (2 * deck::free_space_ohm * thickness_m);
      const std::string inner = number(inner_m / unit_m), depth = number(thickness_m / unit_m);
      branches += fmt::format("({0}[] {1} {2}) ? Complex[1., -{3}*(Fabs[{0}[] - ({2})]/{4})^{5}/(Omega[]*Eps0)] : ", coordinate,
                              is_high ? ">" : "<", inner, number(sigma), depth, shell.order);
    };
    add(false, shell.inner_min_m[axis], shell.outer_min_m[axis]);
    add(true, shell.inner_max_m[axis], shell.outer_max_m[axis]);
    out += fmt::format("  s_{}[] = {}Complex[1., 0.];\n", name, branches);
  }
  return out;
}

std::string stretch_tensor(std::uint8_t axes, bool is_inverse) {
  if (axes == 0) return {};
  const auto s = [&](std::size_t axis) {
    return ((axes >> axis) & 1) != 0 ? fmt::format("s_{}[]", static_cast<char>('x' + axis)) : std::string("1.");
  };
  std::string entries;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string along = s(axis), across = s((axis + 1) % 3) + "*" + s((axis + 2) % 3);
    entries += (axis > 0 ? ", " : "") + (is_inverse ? along + "/(" + across + ")" : across + "/" + along);
  }
  return fmt::format("TensorDiag[{}]", entries);
}

}  // namespace pcbmesh::formats::getdp
