// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/elmer_deck/write_sif.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pcbmesh::formats::elmer_deck {
namespace {

using mesh::BoundaryCondition;

constexpr double pi = 3.14159265358979324;

/// Value that is proportional to the frequency, as a table over the time steps of the scan, one step per frequency.
std::string over_sweep(const std::vector<double>& frequencies_hz, double per_radian) {
  std::string out = "Variable time\n    Real\n";
  for (std::size_t i = 0; i < frequencies_hz.size(); ++i)
    out += fmt::format("      {} {}\n", i + 1, 2 * pi * frequencies_hz[i] * per_radian);
  return out + "    End\n";
}

std::string header(const deck::FieldProblem& problem, std::string_view what) {
  std::string out = fmt::format("! {} of {}, written by pcbmesh\nHeader\n  Mesh DB \".\" \"{}\"\nEnd\nSimulation\n", what,
                                deck::plain(problem.options.mesh), deck::plain(problem.stem()));
  out += fmt::format("  Coordinate System = Cartesian\n  Coordinate Scaling = Real {}\n", metres_per(problem.options.unit));
  if (problem.options.problem == Problem::driven)
    out += fmt::format("  Simulation Type = Scanning\n  Timestep Intervals(1) = {}\n  Timestep Sizes(1) = 1\n",
                       problem.options.frequencies_hz.size());
  else
    out += "  Simulation Type = Steady\n";
  out += "  Steady State Max Iterations = 1\nEnd\nConstants\n";
  return out + fmt::format("  Permittivity of Vacuum = Real {}\n  Permeability of Vacuum = Real {}\nEnd\n", deck::eps0_f_per_m,
                           deck::mu0_h_per_m);
}

std::string bodies(const deck::FieldProblem& problem) {
  std::string out;
  for (std::size_t i = 0; i < problem.volumes.size(); ++i) {
    const deck::Volume& volume = problem.volumes[i];
    const board::Material& m = volume.material;
    out += fmt::format("Body {0}  ! {1}\n  Target Bodies(1) = {2}\n  Equation = 1\n  Material = {0}\nEnd\n", i + 1,
                       deck::plain(volume.name), volume.id);
    out += fmt::format("Material {}  ! {}\n  Relative Permittivity = Real {}\n", i + 1, deck::plain(m.name), m.eps_r);
    if (problem.options.problem != Problem::electrostatic) {
      out += fmt::format(
          "  Relative Permeability = Real {}\n  Relative Reluctivity = Real {}\n  Relative Permittivity im = Real {}\n", m.mu_r,
          1 / m.mu_r, m.eps_r * m.tan_delta);
      if (m.sigma_s_per_m > 0) out += fmt::format("  Electric Conductivity = Real {}\n", m.sigma_s_per_m);
    }
    out += "End\n";
  }
  return out;
}

/// Robin boundary of a surface admittance relative to that of free space, growing with the frequency.
std::string robin(const DeckOptions& options, double admittance) {
  return "  Electric Robin Coefficient im = " + over_sweep(options.frequencies_hz, admittance / deck::light_m_per_s);
}

std::string port(const deck::FieldProblem& problem, const deck::FieldPort& port, bool is_fed) {
  const mesh::Port& p = port.port;
  const double admittance = deck::free_space_ohm * p.length_m / (p.impedance_ohm * p.width_m);
  std::string out = robin(problem.options, admittance);
  if (is_fed)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (std::abs(p.direction[axis]) > 1e-12)
        out += fmt::format("  Magnetic Boundary Load im {} = {}", axis + 1,
                           over_sweep(problem.options.frequencies_hz,
                                      2 * admittance * p.direction[axis] / (p.length_m * deck::light_m_per_s)));
  return out;
}

std::string boundary(const deck::FieldProblem& problem, const deck::Face& face, std::size_t excited) {
  const bool is_eigenmode = problem.options.problem == Problem::eigenmode;
  const char* const metal = is_eigenmode ? "  E {e} = Real 0\n" : "  E re {e} = Real 0\n  E im {e} = Real 0\n";
  switch (face.condition) {
    case BoundaryCondition::pec:
      return metal;
    case BoundaryCondition::absorbing:
      return "  Absorbing BC = Logical True\n";
    case BoundaryCondition::impedance:
      return robin(problem.options, deck::free_space_ohm / face.impedance_ohm);
    case BoundaryCondition::conductor:
      if (is_eigenmode) return metal;
      return fmt::format(
          "  Good Conductor BC = Logical True\n  Layer Electric Conductivity = Real {}\n  Layer Relative Reluctivity = Real "
          "{}\n",
          // both sides of a sheet carry current: half the impedance, four times the conductivity
          face.metal.sigma_s_per_m * (face.is_inner ? 4 : 1), 1 / face.metal.mu_r);
    case BoundaryCondition::port:
      return port(problem, problem.ports[static_cast<std::size_t>(face.port)], static_cast<std::size_t>(face.port) == excited) +
             fmt::format("  Save Scalars {} = Logical True\n", face.port + 1);
    default:
      return "";
  }
}

std::string static_boundary(const deck::FieldProblem& problem, const deck::Face& face) {
  for (std::size_t c = 0; c < problem.conductors.size(); ++c)
    if (std::ranges::find(problem.conductors[c].faces, face.id) != problem.conductors[c].faces.end())
      return fmt::format("  Capacitance Body = Integer {}\n", c + 1);
  return face.condition == BoundaryCondition::pec ? "  Potential = Real 0\n" : "";
}

std::string solvers(const deck::FieldProblem& problem, std::size_t excited) {
  const std::string stem = deck::plain(problem.stem());
  constexpr const char* direct =
      "  Linear System Solver = Direct\n  Linear System Direct Method = Umfpack\n  Linear System Complex = Logical True\n";
  if (problem.options.problem == Problem::electrostatic)
    return fmt::format(
        "Equation 1\n  Active Solvers(1) = 1\nEnd\nSolver 1\n  Equation = \"Electrostatics\"\n  Procedure = \"StatElecSolve\" "
        "\"StatElecSolver\"\n  Variable = Potential\n  Calculate Capacitance Matrix = Logical True\n  Capacitance Bodies = "
        "Integer {}\n  Capacitance Matrix Filename = String \"{}.capacitance.dat\"\n  Linear System Solver = Iterative\n  "
        "Linear "
        "System Iterative Method = BiCGStab\n  Linear System Preconditioning = ILU1\n  Linear System Max Iterations = 2000\n  "
        "Linear System Convergence Tolerance = 1e-10\nEnd\n",
        problem.conductors.size(), stem);
  if (problem.options.problem == Problem::eigenmode)
    // VectorHelmholtz knows one frequency; resonances are EMWaveSolver's.
    return fmt::format(
        "Equation 1\n  Active Solvers(1) = 1\nEnd\nSolver 1\n  Equation = \"VectorWave\"\n  Variable = E\n  Procedure = "
        "\"EMWaveSolver\" \"EMWaveSolver\"\n  Use Piola Transform = Logical True\n  Linear System Solver = Direct\n  Linear "
        "System "
        "Direct Method = Umfpack\n  Eigen Analysis = Logical True\n  Eigen System Values = Integer {}\n  Eigen System Select = "
        "smallest magnitude\n  Eigen System Shift = Real {}\nEnd\nSolver 2  ! frequencies in Hz\n  Exec "
        "Solver = "
        "After Simulation\n  Equation = \"Modes\"\n  Procedure = \"SaveData\" \"SaveScalars\"\n  Filename = \"{}.modes.dat\"\n "
        " Save "
        "Eigenfrequencies = Logical True\nEnd\n",
        problem.options.modes.number, std::pow(2 * pi * problem.options.modes.above_hz, 2), stem);
  std::string out = "Equation 1\n  Active Solvers(2) = 1 2\n";
  out += "  Angular Frequency = " + over_sweep(problem.options.frequencies_hz, 1);
  out +=
      "End\nSolver 1\n  Equation = \"VectorHelmholtz\"\n  Procedure = \"VectorHelmholtz\" \"VectorHelmholtzSolver\"\n"
      "  Use Piola Transform = Logical True\n";
  out += direct;
  out +=
      "End\nSolver 2\n  Equation = \"Fields\"\n  Procedure = \"VectorHelmholtz\" \"VectorHelmholtzCalcFields\"\n"
      "  Calculate Electric field = Logical True\n  Linear System Solver = Iterative\n  Linear System Iterative Method = CG\n"
      "  Linear System Max Iterations = 2000\n  Linear System Convergence Tolerance = 1e-9\nEnd\n";
  // Voltage over volts of the incident wave: integral of E along the port's direction over its width; S = V - 1 at the fed
  // port.
  out += fmt::format(
      "Solver 3  ! per port: integrals of the field; S of port i from {} = (integral along its direction)/width{}\n"
      "  Exec Solver = After Timestep\n  Equation = \"Ports\"\n  Procedure = \"SaveData\" \"SaveScalars\"\n  Filename = "
      "\"{}.port{}.dat\"\n",
      excited + 1, ", minus 1 at the fed port", stem, excited + 1);
  std::size_t k = 0;
  for (std::size_t p = 0; p < problem.ports.size(); ++p)
    for (const char* part : {"re", "im"})
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::abs(problem.ports[p].port.direction[axis]) < 1e-12) continue;
        ++k;
        out += fmt::format(
            "  Variable {0} = String \"Electric field {1} {2}\"\n  Operator {0} = String \"boundary int\"\n  Mask Name {0} = "
            "String \"Save Scalars {3}\"\n",
            k, part, axis + 1, p + 1);
      }
  return out + "End\n";
}

}  // namespace

std::string sif(const deck::FieldProblem& problem, std::size_t excited) {
  constexpr const char* titles[] = {"Driven full wave", "Resonances", "Capacitances between nets"};
  std::string out = header(problem, titles[static_cast<std::size_t>(problem.options.problem)]);
  out += bodies(problem) + solvers(problem, excited);
  for (std::size_t i = 0; i < problem.faces.size(); ++i) {
    const deck::Face& face = problem.faces[i];
    out += fmt::format(
        "Boundary Condition {}  ! {}: {}\n  Target Boundaries(1) = {}\n{}End\n", i + 1, deck::plain(face.name),
        mesh::name_of(face.condition), face.id,
        problem.options.problem == Problem::electrostatic ? static_boundary(problem, face) : boundary(problem, face, excited));
  }
  return out;
}

}  // namespace pcbmesh::formats::elmer_deck
