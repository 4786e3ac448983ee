// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "formats/deck/deck_file.hpp"
#include "formats/getdp/wave_ports.hpp"
#include "formats/getdp/write_pro.hpp"

namespace pcbmesh::formats::getdp {
namespace {

using mesh::BoundaryCondition;

/// Relative permittivity with both losses, at the frequency of the moment.
std::string permittivity(const board::Material& material) {
  std::string loss = fmt::format("-{}", number(material.eps_r * material.tan_delta));
  if (material.sigma_s_per_m > 0) loss += fmt::format(" - {}/(Omega[]*Eps0)", number(material.sigma_s_per_m));
  return fmt::format("Complex[{}, {}]", number(material.eps_r), loss);
}

/// Where the field needs a surface term.
std::vector<std::int32_t> surface_term_faces(const deck::FieldProblem& problem) {
  std::vector<std::int32_t> ids;
  for (const deck::Face& face : problem.faces)
    if (face.condition == BoundaryCondition::absorbing || face.condition == BoundaryCondition::impedance ||
        face.condition == BoundaryCondition::conductor ||
        (face.condition == BoundaryCondition::port && !is_wave(problem.ports[static_cast<std::size_t>(face.port)])))
      ids.push_back(face.id);
  return ids;
}

/// Surface impedance over that of free space, by the medium behind an absorbing face: Sqrt[eps/mu], slab by slab.
std::string absorbing_admittance(const deck::Face& face, double unit_m) {
  std::string out;
  for (std::size_t i = 0; i < face.media.size(); ++i) {
    const deck::Medium& medium = face.media[i];
    const std::string value = fmt::format("Sqrt[{}/{}]", permittivity(medium.material), number(medium.material.mu_r));
    if (i + 1 < face.media.size())
      out += fmt::format("(Z[] < {}) ? {} : ", number(medium.z_high_m / unit_m), value);
    else
      out += value;
  }
  return out.empty() ? "1" : out;
}

/// Relative surface admittance Y*Z0 of every face with a surface term.
std::string admittances(const deck::FieldProblem& problem, double unit_m) {
  std::string out;
  for (const deck::Face& face : problem.faces) {
    std::string value;
    switch (face.condition) {
      case BoundaryCondition::absorbing:
        value = absorbing_admittance(face, unit_m);
        break;
      case BoundaryCondition::impedance:
        value = fmt::format("Z0/{}", number(face.impedance_ohm));
        break;
      case BoundaryCondition::conductor: {
        // Both sides of a sheet carry current: half the impedance of a slab of its thickness, coth of half the thickness.
        const std::string sigma = number(face.metal.sigma_s_per_m), mu = number(face.metal.mu_r);
        const double sides = face.is_inner ? 2 : 1;
        const std::string gamma = fmt::format("Complex[1, 1]*Sqrt[Omega[]*Mu0*{}*{}/2]", mu, sigma);
        if (face.thickness_m > 0)
          value = fmt::format("{}*Z0*{}/({})*Tanh_Of[({})*{}]", number(sides), sigma, gamma, gamma,
                              number(face.thickness_m / sides));
        else
          value = fmt::format("{}*Z0*{}/({})", number(sides), sigma, gamma);
        break;
      }
      case BoundaryCondition::port:
        if (is_wave(problem.ports[static_cast<std::size_t>(face.port)])) continue;
        value = fmt::format("Z0/(R_{0}*W_{0}/H_{0})", face.port + 1);
        break;
      default:
        continue;
    }
    out += fmt::format("  y_Face[Sur_{}] = {};\n", face.id, value);
  }
  return out;
}

/// Field of a coaxial port: V / (r ln(b/a)) towards its axis, where ln(b/a) = 2 pi H / W.
std::string ring_constants(const mesh::Port& port, std::size_t port_number, double unit_m) {
  const std::string x = fmt::format("({} - X[])", number(port.at_m[0] / unit_m)),
                    y = fmt::format("({} - Y[])", number(port.at_m[1] / unit_m));
  return fmt::format(
      "  r_Port[Sur_Port_{0}] = Sqrt[{1}^2 + {2}^2];  // from the axis\n"
      "  d_Port[Sur_Port_{0}] = Vector[{1}/r_Port[], {2}/r_Port[], 0];\n"
      "  e_Wave[Sur_Port_{0}] = ($excited == {0}) ? d_Port[]*W_{0}/(2*Pi*H_{0}*r_Port[]) : Vector[0, 0, 0];  // 1 V inwards\n",
      port_number, x, y);
}

std::string port_constants(const deck::FieldProblem& problem, double unit_m) {
  std::string out;
  for (std::size_t p = 0; p < problem.ports.size(); ++p) {
    if (is_wave(problem.ports[p])) continue;
    const mesh::Port& port = problem.ports[p].port;
    out += fmt::format("  // port {}: {}\n", p + 1, deck::plain(port.name));
    out += fmt::format(
        "  DefineConstant[ R_{0} = {{{1}, Name \"R_{0}\"}} ];  // ohm\n  H_{0} = {2}; W_{0} = {3};  // mesh units\n", p + 1,
        number(port.impedance_ohm), number(port.length_m / unit_m), number(port.width_m / unit_m));
    if (port.kind == mesh::PortKind::coaxial) {
      out += ring_constants(port, p + 1, unit_m);
      continue;
    }
    out += fmt::format("  d_Port[Sur_Port_{}] = Vector[{}, {}, {}];\n", p + 1, number(port.direction[0]),
                       number(port.direction[1]), number(port.direction[2]));
    out +=
        fmt::format("  e_Wave[Sur_Port_{0}] = ($excited == {0}) ? d_Port[]/H_{0} : Vector[0, 0, 0];  // 1 V inwards\n", p + 1);
  }
  return out;
}

std::string port_groups(const deck::FieldProblem& problem) {
  std::string out;
  std::vector<std::int32_t> all, lumped, waves;
  for (std::size_t p = 0; p < problem.ports.size(); ++p) {
    const std::vector<std::int32_t>& faces = problem.ports[p].faces;
    out += fmt::format("  Sur_Port_{} = {};\n", p + 1, region(faces));
    all.insert(all.end(), faces.begin(), faces.end());
    std::vector<std::int32_t>& kind = is_wave(problem.ports[p]) ? waves : lumped;
    kind.insert(kind.end(), faces.begin(), faces.end());
  }
  return out +
         fmt::format("  Sur_Ports = {};\n  Sur_Lumped = {};\n  Sur_Waves = {};\n", region(all), region(lumped), region(waves));
}

/// For one frequency: factor once, then one right-hand side per excited port.
std::string sweep(const deck::FieldProblem& problem, const std::string& results) {
  std::string out;
  bool is_first = true;
  for (std::size_t j = 0; j < problem.ports.size(); ++j) {
    if (!problem.ports[j].port.is_excited) continue;
    out += fmt::format("        Evaluate[ $excited = {} ]; {} PostOperation[Volts];\n", j + 1,
                       is_first ? "Generate[Sys_E]; Solve[Sys_E];" : "GenerateRHSGroup[Sys_E, Sur_Ports]; SolveAgain[Sys_E];");
    is_first = false;
    for (std::size_t i = 0; i < problem.ports.size(); ++i)
      out += fmt::format(
          "        Print[ {{$frequency, {0}, {1}, Re[$volts_{1}]{2}, Im[$volts_{1}]}}, Format \"%.17g %g %g %.17g %.17g\", "
          "File \"{3}\" ];\n",
          j + 1, i + 1, i == j ? " - 1" : "", results);
  }
  return out;
}

}  // namespace

namespace {

std::string times(const std::string& factor) {
  return factor.empty() ? factor : "*" + factor;
}

}  // namespace

std::string driven_pro(const deck::FieldProblem& problem) {
  const double unit_m = metres_per(problem.options.unit);
  const std::string results = deck::result_files(problem).written;
  const WavePorts waves = wave_ports(problem);
  std::vector<std::int32_t> metal = metal_volumes(problem);
  const std::vector<std::int32_t> pec = problem.faces_with(BoundaryCondition::pec);
  metal.insert(metal.end(), pec.begin(), pec.end());
  std::string out = opening(problem, "Driven full wave");
  out += "Group {\n" + named_groups(problem) + port_groups(problem) + waves.groups;
  out += fmt::format("  Vol_Field = {};\n  Vol_Metal = {};\n  Vol_Every = Region[{{Vol_Field, Vol_Metal}}];\n",
                     region(field_volumes(problem)), region(metal_volumes(problem)));
  out += fmt::format("  Dom_Metal = {};  // no tangential field\n  Sur_Terms = {};\n", region(metal),
                     region(surface_term_faces(problem)));
  out += "  Dom_E = Region[{Vol_Field, Sur_Terms, Sur_Waves}];\n}\nFunction {\n";
  out += fmt::format("  Light = {}; Z0 = {}; Eps0 = {}; Mu0 = {};\n  Unit = {};  // metres per mesh unit\n",
                     number(deck::light_m_per_s), number(deck::free_space_ohm), number(deck::eps0_f_per_m),
                     number(deck::mu0_h_per_m), number(unit_m));
  std::vector<std::string> frequencies;
  for (const double f : problem.options.frequencies_hz) frequencies.push_back(number(f));
  out += fmt::format("  Sweep() = {{{}}};  // Hz\n", fmt::join(frequencies, ", "));
  out +=
      "  Omega[] = 2*Pi*$frequency;  k0[] = Omega[]*Unit/Light;  I[] = Complex[0, 1];\n"
      "  Tanh_Of[] = (1 - Exp[-2*$1])/(1 + Exp[-2*$1]);\n";
  out += stretch_functions(problem, unit_m);
  for (const deck::Volume& volume : problem.volumes)
    if (!volume.is_conductor)
      out += fmt::format("  eps_Vol[Vol_{0}] = {1}{2};  nu_Vol[Vol_{0}] = {3}{4};  // {5}\n", volume.id,
                         permittivity(volume.material), times(stretch_tensor(volume.stretched, false)),
                         number(1 / volume.material.mu_r), times(stretch_tensor(volume.stretched, true)),
                         deck::plain(volume.name));
  out += port_constants(problem, unit_m) + waves.functions + admittances(problem, unit_m) + "}\n";
  out += edge_space(problem, "Dom_E");
  out += integration();
  out += waves.statics;
  out += fmt::format(
      "Formulation {{\n  {{ Name Form_E; Type FemEquation; Quantity {{ {{ Name e; Type Local; NameOfSpace Hcurl_E; }}{} }}",
      waves.quantities);
  out += R"(
    Equation {
      Galerkin { [ nu_Vol[] * Dof{d e}, {d e} ]; In Vol_Field; Jacobian Jac_All; Integration Int_All; }
      Galerkin { [ -k0[]^2 * eps_Vol[] * Dof{e}, {e} ]; In Vol_Field; Jacobian Jac_All; Integration Int_All; }
)";
  if (!surface_term_faces(problem).empty())
    out += "      Galerkin { [ I[] * k0[] * y_Face[] * Dof{e}, {e} ]; In Sur_Terms; Jacobian Jac_All; Integration Int_All; }\n";
  if (!std::ranges::all_of(problem.ports, is_wave))
    out +=
        "      Galerkin { [ -2 * I[] * k0[] * y_Face[] * e_Wave[], {e} ]; In Sur_Lumped; Jacobian Jac_All; Integration "
        "Int_All; }\n";
  out += waves.sources + "    } }\n}\n";
  out += fmt::format(
      "Resolution {{\n  {{ Name Driven; System {{ {{ Name Sys_E; NameOfFormulation Form_E; Type Complex; Frequency "
      "Sweep(0); }}{} }}\n    Operation {{\n{}      DeleteFile[\"{}\"];\n      Print[ \"# pcbmesh port results 1\", "
      "File \"{}\" ];\n",
      waves.systems, waves.operations, results, results);
  for (std::size_t p = 0; p < problem.ports.size(); ++p)
    out += fmt::format("      Print[ {{{3}_{0}}}, Format \"# port {0} %.17g {1}\", File \"{2}\" ];\n", p + 1,
                       deck::plain(problem.ports[p].port.name), results, is_wave(problem.ports[p]) ? "$z" : "R");
  out += fmt::format("      Print[ \"# frequency_hz excited observed re im\", File \"{}\" ];\n", results);
  out += "      For i In {0:#Sweep()-1}\n        Evaluate[ $frequency = Sweep(i) ]; SetFrequency[Sys_E, Sweep(i)];\n";
  out += sweep(problem, results);
  out +=
      "      EndFor\n      SaveSolution[Sys_E];\n    } }\n}\nPostProcessing {\n  { Name Post_E; NameOfFormulation Form_E; "
      "NameOfSystem Sys_E; Quantity {\n"
      "      { Name e; Value { Local { [ {e} ]; In Vol_Field; Jacobian Jac_All; } } }\n";
  for (std::size_t p = 0; p < problem.ports.size(); ++p) {
    if (is_wave(problem.ports[p])) continue;
    const bool is_ring = problem.ports[p].port.kind == mesh::PortKind::coaxial;
    out += fmt::format(
        "      {{ Name v_{0}; Value {{ Integral {{ [ {{e}}*d_Port[]/{1} ]; In Sur_Port_{0}; Jacobian Jac_All; "
        "Integration Int_All; }} }} }}\n",
        p + 1, is_ring ? std::string("(2*Pi*r_Port[])") : fmt::format("W_{}", p + 1));
  }
  out += waves.observables + "    } }\n}\n" + waves.post +
         "PostOperation {\n  { Name Volts; NameOfPostProcessing Post_E; Operation {\n";
  for (std::size_t p = 0; p < problem.ports.size(); ++p)
    out += fmt::format(
        "      Print[ v_{0}[Sur_Port_{0}], OnGlobal, Format Table, StoreInVariable $volts_{0}, File \"/dev/null\" ];\n", p + 1);
  out += fmt::format(
      "    }} }}\n  {{ Name Field; NameOfPostProcessing Post_E; Operation {{  // of the last solution: -pos Field\n"
      "      Print[ e, OnElementsOf Vol_Field, File \"{}.e.pos\" ]; }} }}\n}}\n",
      deck::plain(problem.stem()));
  return out;
}

}  // namespace pcbmesh::formats::getdp
