// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "formats/deck/deck_file.hpp"
#include "formats/getdp/write_pro.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::getdp {
namespace {

using mesh::BoundaryCondition;

constexpr double floating_eps_r = 1e8;  // a field inside is eight orders below that outside

}  // namespace

std::string eigenmode_pro(const deck::FieldProblem& problem) {
  const double unit_m = metres_per(problem.options.unit);
  const std::string results = deck::result_files(problem).written;
  std::vector<std::int32_t> metal = metal_volumes(problem);
  // Loss of the skins is second order in the frequency of a resonance: they are ideal here.
  for (const BoundaryCondition condition : {BoundaryCondition::pec, BoundaryCondition::conductor}) {
    const std::vector<std::int32_t> faces = problem.faces_with(condition);
    metal.insert(metal.end(), faces.begin(), faces.end());
  }
  std::string out = opening(problem, "Resonances");
  out += "Group {\n" + named_groups(problem);
  out += fmt::format(
      "  Vol_Field = {};\n  Vol_Metal = {};\n  Vol_Every = Region[{{Vol_Field, Vol_Metal}}];\n  Dom_Metal = {};\n}}\n",
      region(field_volumes(problem)), region(metal_volumes(problem)), region(metal));
  out += "Function {\n";
  for (const deck::Volume& volume : problem.volumes)
    if (!volume.is_conductor)
      out += fmt::format("  eps_Vol[Vol_{0}] = {1};  tan_Vol[Vol_{0}] = {2};  nu_Vol[Vol_{0}] = {3};  // {4}\n", volume.id,
                         number(volume.material.eps_r),
                         number(volume.material.tan_delta +
                                volume.material.sigma_s_per_m / (2 * 3.14159265358979324 * problem.options.modes.above_hz *
                                                                 deck::eps0_f_per_m * volume.material.eps_r)),
                         number(1 / volume.material.mu_r), deck::plain(volume.name));
  // Eigenvalues are k0^2 in squared reciprocal mesh units.
  const double hz_per_root = deck::light_m_per_s / (2 * 3.14159265358979324 * unit_m);
  const double target = problem.options.modes.above_hz / hz_per_root;
  // Gradients are static solutions of no interest; they lie at zero but for rounding.
  out += fmt::format("  Hz_Per_Root = {};\n  Is_Wave[] = Norm[$EigenvalueReal] > {};\n}}\n", number(hz_per_root),
                     number(1e-3 * std::min(target, target * target)));
  out += edge_space("Vol_Field");
  out += integration();
  out += R"(Formulation {
  { Name Form_E; Type FemEquation; Quantity { { Name e; Type Local; NameOfSpace Hcurl_E; } }
    Equation {
      Galerkin { [ nu_Vol[] * Dof{d e}, {d e} ]; In Vol_Field; Jacobian Jac_All; Integration Int_All; }
      Galerkin { DtDtDof [ eps_Vol[] * Dof{e}, {e} ]; In Vol_Field; Jacobian Jac_All; Integration Int_All; }
    } }
}
)";
  out += fmt::format(R"(Resolution {{
  {{ Name Resonances; System {{ {{ Name Sys_E; NameOfFormulation Form_E; Type Complex; }} }}
    Operation {{ GenerateSeparate[Sys_E]; EigenSolve[Sys_E, {0}, {1}, 0, Is_Wave[]]; SaveSolutions[Sys_E];
      DeleteFile["{2}"]; PostOperation[Modes]; }} }}
}}
PostProcessing {{
  {{ Name Post_E; NameOfFormulation Form_E; NameOfSystem Sys_E; Quantity {{
      {{ Name e; Value {{ Local {{ [ {{e}} ]; In Vol_Field; Jacobian Jac_All; }} }} }}
      {{ Name frequency_hz; Value {{ Term {{ Type Global; [ Hz_Per_Root * $EigenvalueReal ]; In Vol_Field; }} }} }}
      {{ Name stored; Value {{ Integral {{ [ eps_Vol[]*SquNorm[{{e}}] ]; In Vol_Field; Jacobian Jac_All; Integration Int_All; }} }} }}
      {{ Name lost; Value {{ Integral {{ [ eps_Vol[]*tan_Vol[]*SquNorm[{{e}}] ]; In Vol_Field; Jacobian Jac_All; Integration Int_All; }} }} }}
    }} }}
}}
PostOperation {{
  {{ Name Modes; NameOfPostProcessing Post_E; Operation {{  // rows: mode, value; Q of the dielectric = stored/lost
      Echo[ "# frequency_hz", Format Table, File >> "{2}" ];
      Print[ frequency_hz, OnRegion Vol_Field, Format Table, File >> "{2}" ];
      Echo[ "# stored", Format Table, File >> "{2}" ];
      Print[ stored[Vol_Field], OnGlobal, Format Table, File >> "{2}" ];
      Echo[ "# lost", Format Table, File >> "{2}" ];
      Print[ lost[Vol_Field], OnGlobal, Format Table, File >> "{2}" ]; }} }}
  {{ Name Field; NameOfPostProcessing Post_E; Operation {{ Print[ e, OnElementsOf Vol_Field, File "{3}.e.pos" ]; }} }}
}}
)",
                     problem.options.modes.number, number(target * target), results, deck::plain(problem.stem()));
  return out;
}

std::string electrostatic_pro(const deck::FieldProblem& problem) {
  const double unit_m = metres_per(problem.options.unit);
  const std::string results = deck::result_files(problem).written;
  std::vector<std::int32_t> field = field_volumes(problem);
  field.insert(field.end(), problem.floating.begin(), problem.floating.end());
  std::vector<std::int32_t> metal, ground;
  for (const deck::Conductor& conductor : problem.conductors)
    metal.insert(metal.end(), conductor.volumes.begin(), conductor.volumes.end());
  for (const deck::Face& face : problem.faces)
    if (face.condition == BoundaryCondition::pec && face.kind == mesh::FaceTagKind::outer) ground.push_back(face.id);

  std::string out = opening(problem, "Capacitances between nets");
  out += "Group {\n" + named_groups(problem);
  for (std::size_t c = 0; c < problem.conductors.size(); ++c) {
    std::vector<std::int32_t> ids = problem.conductors[c].volumes;
    ids.insert(ids.end(), problem.conductors[c].faces.begin(), problem.conductors[c].faces.end());
    out += fmt::format("  Dom_Net_{} = {};  // {}\n", c + 1, region(ids), deck::plain(problem.conductors[c].name));
  }
  out += fmt::format("  Sur_Ground = {};  // pec sides of the domain: 0 V\n", region(ground));
  out += fmt::format("  Vol_Field = {};\n  Vol_Metal = {};\n  Vol_Every = Region[{{Vol_Field, Vol_Metal}}];\n}}\nFunction {{\n",
                     region(field), region(metal));
  for (const deck::Volume& volume : problem.volumes) {
    const bool floats = volume.is_conductor && volume.net < 0;
    if (!volume.is_conductor || floats)
      out +=
          fmt::format("  eps_Vol[Vol_{}] = {};  // {}{}\n", volume.id, number(floats ? floating_eps_r : volume.material.eps_r),
                      deck::plain(volume.name), floats ? ": floats" : "");
  }
  out += fmt::format("  Farad = {};  // permittivity of free space times metres per mesh unit\n}}\n",
                     number(deck::eps0_f_per_m * unit_m));
  out += "// One field per net: 1 V on it, 0 V on all others.\n";
  const std::size_t n = problem.conductors.size();
  for (std::size_t c = 1; c <= n; ++c) {
    out += fmt::format("Constraint {{ {{ Name Con_{}; Type Assign; Case {{ {{ Region Sur_Ground; Value 0.; }}", c);
    for (std::size_t other = 1; other <= n; ++other)
      out += fmt::format(" {{ Region Dom_Net_{}; Value {}; }}", other, other == c ? "1." : "0.");
    out += fmt::format(
        " }} }} }}\nFunctionSpace {{ {{ Name Hgrad_{0}; Type Form0;\n    BasisFunction {{ {{ Name sn_{0}; NameOfCoef vn_{0}; "
        "Function "
        "BF_Node; Support Vol_Field; Entity NodesOf[All]; }} }}\n    Constraint {{ {{ NameOfCoef vn_{0}; EntityType NodesOf; "
        "NameOfConstraint Con_{0}; }} }} }} }}\n",
        c);
  }
  out += integration();
  out += "Formulation {\n";
  for (std::size_t c = 1; c <= n; ++c)
    out += fmt::format(
        "  {{ Name Form_{0}; Type FemEquation; Quantity {{ {{ Name v_{0}; Type Local; NameOfSpace Hgrad_{0}; }} }}\n"
        "    Equation {{ Galerkin {{ [ eps_Vol[] * Dof{{d v_{0}}}, {{d v_{0}}} ]; In Vol_Field; Jacobian Jac_All; "
        "Integration Int_All; }} }} }}\n",
        c);
  out += "  { Name Form_All; Type FemEquation; Quantity {\n";
  for (std::size_t c = 1; c <= n; ++c) out += fmt::format("      {{ Name v_{0}; Type Local; NameOfSpace Hgrad_{0}; }}\n", c);
  out += "    } }\n}\nResolution {\n  { Name Capacitance; System {\n";
  for (std::size_t c = 1; c <= n; ++c) out += fmt::format("      {{ Name Sys_{0}; NameOfFormulation Form_{0}; }}\n", c);
  out += "    }\n    Operation {\n";
  for (std::size_t c = 1; c <= n; ++c)
    out += fmt::format("      Generate[Sys_{0}]; Solve[Sys_{0}]; SaveSolution[Sys_{0}];\n", c);
  out +=
      fmt::format("      DeleteFile[\"{0}\"];\n      Print[ \"# pcbmesh capacitance results 1\", File \"{0}\" ];\n", results);
  for (std::size_t c = 0; c < n; ++c)
    out +=
        fmt::format("      Print[ \"# net {} {}\", File \"{}\" ];\n", c + 1, deck::plain(problem.conductors[c].name), results);
  out += fmt::format("      Print[ \"# net net farad\", File \"{}\" ];\n      PostOperation[Matrix];\n", results);
  for (std::size_t a = 1; a <= n; ++a)
    for (std::size_t b = a; b <= n; ++b)
      out += fmt::format("      Print[ {{$c_{0}_{1}}}, Format \"{0} {1} %.17g\", File \"{2}\" ];\n", a, b, results);
  // Energy of two fields: symmetric, and its error is the square of theirs.
  out += "    } }\n}\nPostProcessing {\n  { Name Post_All; NameOfFormulation Form_All; Quantity {\n";
  for (std::size_t a = 1; a <= n; ++a)
    for (std::size_t b = a; b <= n; ++b)
      out += fmt::format(
          "      {{ Name c_{0}_{1}; Value {{ Integral {{ [ Farad*eps_Vol[]*{{d v_{0}}}*{{d v_{1}}} ]; In Vol_Field; "
          "Jacobian Jac_All; Integration Int_All; }} }} }}\n",
          a, b);
  for (std::size_t c = 1; c <= n; ++c)
    out += fmt::format("      {{ Name v_{0}; Value {{ Local {{ [ {{v_{0}}} ]; In Vol_Field; Jacobian Jac_All; }} }} }}\n", c);
  out += "    } }\n}\nPostOperation {\n  { Name Matrix; NameOfPostProcessing Post_All; Operation {\n";
  for (std::size_t a = 1; a <= n; ++a)
    for (std::size_t b = a; b <= n; ++b)
      out += fmt::format(
          "      Print[ c_{0}_{1}[Vol_Field], OnGlobal, Format Table, StoreInVariable $c_{0}_{1}, File \"/dev/null\" ];\n", a,
          b);
  out += "    } }\n  { Name Potential; NameOfPostProcessing Post_All; Operation {\n";
  for (std::size_t c = 1; c <= n; ++c)
    out +=
        fmt::format("      Print[ v_{}, OnElementsOf Vol_Field, File \"{}.v{}.pos\" ];\n", c, deck::plain(problem.stem()), c);
  return out + "    } }\n}\n";
}

}  // namespace pcbmesh::formats::getdp
