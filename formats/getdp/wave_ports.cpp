// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/getdp/wave_ports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formats/getdp/write_pro.hpp"

namespace pcbmesh::formats::getdp {
namespace {

using mesh::BoundaryCondition;

constexpr std::string_view nearest = "a lumped port across the gap; Palace solves for the modes of a wave port of any kind";

const std::vector<deck::Medium>& media_of(const deck::FieldProblem& problem, const deck::FieldPort& port) {
  static const std::vector<deck::Medium> none;
  const auto face = std::ranges::find_if(
      problem.faces, [&](const deck::Face& f) { return std::ranges::find(port.faces, f.id) != port.faces.end(); });
  return face == problem.faces.end() ? none : face->media;
}

/// Ids of everything that conducts: of one net, or of all others and the pec sides.
std::vector<std::int32_t> conductors(const deck::FieldProblem& problem, std::int32_t net, bool is_signal) {
  std::vector<std::int32_t> ids;
  for (const deck::Volume& volume : problem.volumes)
    if (volume.is_conductor && (volume.net == net) == is_signal) ids.push_back(volume.id);
  for (const deck::Face& face : problem.faces) {
    const bool is_copper = face.kind == mesh::FaceTagKind::conductor || face.kind == mesh::FaceTagKind::sheet;
    const bool conducts = is_copper || face.condition == BoundaryCondition::pec;
    if (conducts && (is_copper && face.net == net) == is_signal) ids.push_back(face.id);
  }
  return ids;
}

/// Does the port's rectangle reach into perfectly matched layers, where static fields mean nothing?
bool reaches_into(const mesh::Shell& shell, const mesh::Port& port) {
  constexpr double on_side_m = 1e-9;
  const bool faces_x =
      std::min(std::abs(port.at_m[0] - shell.outer_min_m[0]), std::abs(port.at_m[0] - shell.outer_max_m[0])) < on_side_m;
  const std::size_t across = faces_x ? 1 : 0;
  const auto outside = [&](std::size_t axis, double extent_m) {
    return port.at_m[axis] - 0.5 * extent_m < shell.inner_min_m[axis] - on_side_m ||
           port.at_m[axis] + 0.5 * extent_m > shell.inner_max_m[axis] + on_side_m;
  };
  return outside(across, port.width_m) || outside(2, port.length_m);
}

std::string permittivity(const std::vector<deck::Medium>& media, double unit_m) {
  std::string out;
  for (std::size_t i = 0; i < media.size(); ++i)
    out += i + 1 < media.size()
               ? fmt::format("(Z[] < {}) ? {} : ", number(media[i].z_high_m / unit_m), number(media[i].material.eps_r))
               : number(media[i].material.eps_r);
  return out;
}

}  // namespace

bool is_wave(const deck::FieldPort& port) {
  return port.port.kind == mesh::PortKind::wave;
}

void require_tem_ports(const deck::FieldProblem& problem, Diagnostics& diagnostics) {
  for (const deck::FieldPort& port : problem.ports) {
    if (!is_wave(port)) continue;
    const std::int32_t net = port.port.positive_net;
    const auto refuse = [&](std::string_view why) {
      deck::refuse("GetDP",
                   fmt::format("wave port '{}' in this deck, which knows TEM and quasi-TEM waves alone: {}",
                               deck::plain(port.port.name), why),
                   nearest);
    };
    if (net < 0 || conductors(problem, net, true).empty()) refuse("no signal conductor leads to it, as in a hollow waveguide");
    if (conductors(problem, net, false).empty()) refuse("no second conductor leads to it to carry the current back");
    if (problem.shell && reaches_into(*problem.shell, port.port))
      refuse("it reaches into the perfectly matched layers, so give it a width and a height that end before them");
    double slowest = 1;
    for (const deck::Medium& medium : media_of(problem, port)) {
      if (medium.material.mu_r != 1)
        refuse(fmt::format("'{}' behind it is magnetic, and the inductance is taken from the capacitance without dielectrics",
                           deck::plain(medium.material.name)));
      slowest = std::max(slowest, std::sqrt(medium.material.eps_r));
    }
    const auto highest = std::ranges::max_element(problem.options.frequencies_hz);
    if (highest == problem.options.frequencies_hz.end()) continue;
    const double half_wave_m = 0.5 * deck::light_m_per_s / (*highest * slowest);
    const double across_m = std::max(port.port.width_m, port.port.length_m);
    if (across_m > half_wave_m)
      diagnostics.warn(
          "deck.wide_wave_port",
          fmt::format("wave port '{}' is {:.3g} mm across, and half a wave at {:.4g} GHz is {:.3g} mm: modes beyond "
                      "the TEM one may travel there and are not told apart; make the port smaller, or the sweep lower",
                      port.port.name, across_m * 1e3, *highest * 1e-9, half_wave_m * 1e3));
  }
}

WavePorts wave_ports(const deck::FieldProblem& problem) {
  const double unit_m = metres_per(problem.options.unit);
  WavePorts out;
  std::string spaces, formulations, constraints;
  for (std::size_t p = 0; p < problem.ports.size(); ++p) {
    const deck::FieldPort& port = problem.ports[p];
    if (!is_wave(port)) continue;
    const std::size_t n = p + 1;
    const std::int32_t net = port.port.positive_net;
    out.groups += fmt::format("  Dom_Signal_{0} = {1};  // 1 V at port {0}\n  Dom_Still_{0} = {2};  // 0 V\n", n,
                              region(conductors(problem, net, true)), region(conductors(problem, net, false)));
    out.functions += fmt::format("  eps_Mode[Sur_Port_{0}] = {1};  // port {0}: {2}, the static field of a TEM line\n", n,
                                 permittivity(media_of(problem, port), unit_m), deck::plain(port.port.name));
    const std::string integrated = fmt::format("In Sur_Port_{}; Jacobian Jac_All; Integration Int_All;", n);
    constraints += fmt::format(
        "  {{ Name Con_Mode_{0}; Type Assign; Case {{ {{ Region Dom_Still_{0}; Value 0.; }} {{ Region Dom_Signal_{0}; Value "
        "1.; "
        "}} }} }}\n",
        n);
    for (const auto& [kind, weight] : {std::pair{"Mode", "eps_Mode[] * "}, std::pair{"Air", ""}}) {
      spaces += fmt::format(
          "  {{ Name Hgrad_{1}_{0}; Type Form0;\n    BasisFunction {{ {{ Name sn_{1}_{0}; NameOfCoef vn_{1}_{0}; Function "
          "BF_Node; Support Sur_Port_{0}; Entity NodesOf[All]; }} }}\n    Constraint {{ {{ NameOfCoef vn_{1}_{0}; EntityType "
          "NodesOf; NameOfConstraint Con_Mode_{0}; }} }} }}\n",
          n, kind);
      formulations += fmt::format(
          "  {{ Name Form_{1}_{0}; Type FemEquation; Quantity {{ {{ Name v; Type Local; NameOfSpace Hgrad_{1}_{0}; }} }}\n"
          "    Equation {{ Galerkin {{ [ {2}Dof{{d v}}, {{d v}} ]; {3} }} }} }}\n",
          n, kind, weight, integrated);
      out.systems +=
          fmt::format(" {{ Name Sys_{1}_{0}; NameOfFormulation Form_{1}_{0}; Type Complex; Frequency 1.; }}", n, kind);
      out.operations += fmt::format("      Generate[Sys_{1}_{0}]; Solve[Sys_{1}_{0}]; PostOperation[{1}_{0}];\n", n, kind);
      out.post += fmt::format(
          "PostProcessing {{ {{ Name Post_{1}_{0}; NameOfFormulation Form_{1}_{0}; NameOfSystem Sys_{1}_{0}; Quantity {{\n"
          "      {{ Name c; Value {{ Integral {{ [ {2}{{d v}}*{{d v}} ]; {3} }} }} }}\n"
          "      {{ Name area; Value {{ Integral {{ [ 1. ]; {3} }} }} }} }} }} }}\n"
          "PostOperation {{ {{ Name {1}_{0}; NameOfPostProcessing Post_{1}_{0}; Operation {{\n"
          "      Print[ c[Sur_Port_{0}], OnGlobal, Format Table, StoreInVariable $c_{1}_{0}, File \"/dev/null\" ];\n"
          "      Print[ area[Sur_Port_{0}], OnGlobal, Format Table, StoreInVariable $area_{0}, File \"/dev/null\" ]; }} }} "
          "}}\n",
          n, kind, weight, integrated);
    }
    spaces += fmt::format(
        "  {{ Name Hvolt_{0}; Type Scalar;\n    BasisFunction {{ {{ Name sr_{0}; NameOfCoef ur_{0}; Function BF_Region; "
        "Support "
        "Sur_Port_{0}; Entity Sur_Port_{0}; }} }} }}\n",
        n);
    out.operations += fmt::format(
        "      Evaluate[ $y_{0} = Sqrt[Re[$c_Mode_{0}/$c_Air_{0}]] ]; Evaluate[ $z_{0} = Z0/Sqrt[Re[$c_Mode_{0}*$c_Air_{0}]] "
        "];\n"
        "      Print[ {{Re[$z_{0}], Re[$y_{0}^2]}}, Format \"port {0}: %g ohm, effective permittivity %g\" ];\n",
        n);
    out.quantities += fmt::format(
        "\n      {{ Name v_Air_{0}; Type Local; NameOfSpace Hgrad_Air_{0}; }} {{ Name u_{0}; Type Local; NameOfSpace "
        "Hvolt_{0}; "
        "}}",
        n);
    out.sources += fmt::format(
        "      // port {0}: u is the voltage of its mode, and the mode's magnetic field takes or brings the wave\n"
        "      Galerkin {{ [ Dof{{u_{0}}}/$area_{0}, {{u_{0}}} ]; {1} }}\n"
        "      Galerkin {{ [ -Dof{{e}}*{{d v_Air_{0}}}/$c_Air_{0}, {{u_{0}}} ]; {1} }}\n"
        "      Galerkin {{ [ I[] * k0[] * $y_{0} * Dof{{u_{0}}} * {{d v_Air_{0}}}, {{e}} ]; {1} }}\n"
        "      Galerkin {{ [ -2 * I[] * k0[] * $y_{0} * (($excited == {0}) ? 1. : 0.) * {{d v_Air_{0}}}, {{e}} ]; {1} }}\n",
        n, integrated);
    out.observables += fmt::format(
        "      {{ Name v_{0}; Value {{ Integral {{ [ {{e}}*{{d v_Air_{0}}}/$c_Air_{0} ]; {1} }} }} }}\n", n, integrated);
  }
  if (!spaces.empty())
    out.statics =
        "Constraint {\n" + constraints + "}\nFunctionSpace {\n" + spaces + "}\nFormulation {\n" + formulations + "}\n";
  return out;
}

}  // namespace pcbmesh::formats::getdp
