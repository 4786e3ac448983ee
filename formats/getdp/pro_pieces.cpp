// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

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

std::string edge_space(std::string_view support) {
  return fmt::format(R"(Constraint {{
  {{ Name Con_Metal; Type Assign; Case {{ {{ Region Dom_Metal; Value 0.; }} }} }}
}}
FunctionSpace {{
  {{ Name Hcurl_E; Type Form1;
    BasisFunction {{ {{ Name se; NameOfCoef ee; Function BF_Edge; Support {}; Entity EdgesOf[All]; }} }}
    Constraint {{ {{ NameOfCoef ee; EntityType EdgesOf; NameOfConstraint Con_Metal; }} }} }}
}}
)",
                     support);
}

}  // namespace pcbmesh::formats::getdp
