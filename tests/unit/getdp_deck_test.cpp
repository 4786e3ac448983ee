// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdlib>
#include <sstream>

#include "box_mesh.hpp"
#include "folder.hpp"
#include "formats/touchstone/port_results.hpp"
#include "pcbmesh/formats/deck.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "thrown_error.hpp"

namespace pcbmesh {
namespace {

using formats::DeckOptions;
using mesh::BoundaryCondition;
using study::Problem;
using testing::Box;
using testing::box_parts;
using Complex = std::complex<double>;

constexpr double light = 299'792'458.0;

bool has_getdp() {
  return std::system("getdp -version > /dev/null 2>&1") == 0;  // NOLINT: one thread
}

/// Writes mesh and deck, runs the solver, gives back the text of its results.
std::string solve(const mesh::PrismMesh& mesh, const DeckOptions& options, const std::filesystem::path& folder,
                  const std::string& resolution, const std::string& results) {
  formats::WriteMeshOptions write;
  write.unit = options.unit;
  write.version = "2.2";
  write.one_number_space = true;
  formats::write_mesh(mesh, folder / options.mesh, write);
  Diagnostics diagnostics;
  const formats::Deck deck = formats::write_deck(mesh, "getdp", options, folder, diagnostics);
  EXPECT_EQ(deck.command.front(), "sh");
  const std::string command =
      fmt::format("cd '{}' && getdp box.pro -msh box.msh -solve {} -v 3 > log.txt 2>&1", folder.string(), resolution);
  EXPECT_EQ(std::system(command.c_str()), 0) << testing::contents(folder / "log.txt");
  const std::string out = testing::contents(folder / results);
  EXPECT_FALSE(out.empty()) << testing::contents(folder / "log.txt");
  return out;
}

/// Parallel-plate line along x, its ends closed by ports of the line's own impedance.
Box line(int cells, const board::Material& material, double port_ohm_factor = 1) {
  Box box;
  box.cells = {cells, std::max(1, cells / 10), std::max(1, cells / 10)};
  box.size_m = {0.1, 0.02, 0.01};
  box.material = material;
  const double ohm = 376.730313668 / std::sqrt(material.eps_r) * 0.01 / 0.02 * port_ohm_factor;
  box.sides = {BoundaryCondition::pec,  BoundaryCondition::pec, BoundaryCondition::port,
               BoundaryCondition::port, BoundaryCondition::pmc, BoundaryCondition::pmc};
  box.port_of_side = {-1, -1, 0, 1, -1, -1};
  for (const char* name : {"in", "out"}) {
    mesh::Port port;
    port.name = name;
    port.impedance_ohm = ohm;
    port.length_m = 0.01;
    port.width_m = 0.02;
    box.ports.push_back(port);
  }
  return box;
}

formats::touchstone::ScatteringSweep solve_line(const Box& box, const std::filesystem::path& folder,
                                                LengthUnit unit = LengthUnit::metre) {
  DeckOptions options;
  options.frequencies_hz = {1e9, 3e9};
  options.mesh = "box.msh";
  options.unit = unit;
  (void)solve(mesh::PrismMesh::from_parts(box_parts(box)), options, folder, "Driven", "box.ports.txt");
  return formats::touchstone::read_port_results(folder / "box.ports.txt");
}

TEST(GetdpDeck, CavityOfEightCellsGivesWhatAnIndependentCodeGave) {
  if (!has_getdp()) GTEST_SKIP() << "getdp is not installed";
  const testing::Folder folder;
  Box box;
  box.size_m = {1, 0.9, 0.7};
  box.sides.fill(BoundaryCondition::pec);
  DeckOptions options;
  options.problem = Problem::eigenmode;
  options.mesh = "box.msh";
  options.modes.above_hz = light * std::sqrt(20.0) / (2 * M_PI);
  options.modes.number = 2;
  std::istringstream rows(
      solve(mesh::PrismMesh::from_parts(box_parts(box)), options, folder.path(), "Resonances", "box.modes.txt"));
  std::string row;
  double lowest = 1e300;
  while (std::getline(rows, row) && row.find("stored") == std::string::npos) {
    double number = 0, hz = 0;
    if (std::istringstream(row) >> number >> hz) lowest = std::min(lowest, hz);
  }
  const double k0 = 2 * M_PI * lowest / light;
  EXPECT_NEAR(k0 * k0, 22.8166, 1e-4) << testing::contents(folder.path() / "box.modes.txt");
}

TEST(GetdpDeck, LineConvergesWithTheSquareOfTheEdge) {
  if (!has_getdp()) GTEST_SKIP() << "getdp is not installed";
  const board::Material material{"dielectric", 4, 0, 1, 0};
  std::vector<double> errors;
  for (const int cells : {10, 20, 40}) {
    const testing::Folder folder;
    const auto sweep = solve_line(line(cells, material), folder.path());
    const double k = 2 * M_PI * 3e9 / light * 2;
    errors.push_back(std::abs(sweep.scatter[1][2] - std::exp(Complex(0, -k * 0.1))));
    EXPECT_LT(std::abs(sweep.scatter[1][2] - sweep.scatter[1][1]), 1e-9) << "reciprocal";
  }
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.8) << errors[0] << " " << errors[1];
  EXPECT_NEAR(errors[1] / errors[2], 4, 0.4) << errors[1] << " " << errors[2];
}

TEST(GetdpDeck, LossTangentConductivityImpedanceAndUnitReachTheSolver) {
  if (!has_getdp()) GTEST_SKIP() << "getdp is not installed";
  const double k = 2 * M_PI * 1e9 / light * 2;
  const auto s21 = [](const Box& box, LengthUnit unit = LengthUnit::metre) {
    const testing::Folder folder;
    return std::abs(solve_line(box, folder.path(), unit).scatter[0][2]);
  };
  EXPECT_NEAR(s21(line(40, {"d", 4, 0, 1, 0})), 1, 1e-3);
  EXPECT_NEAR(s21(line(40, {"d", 4, 0.05, 1, 0})), std::exp(-k * 0.1 * 0.025), 2e-3);
  // sigma that makes the same loss at this frequency
  EXPECT_NEAR(s21(line(40, {"d", 4, 0, 1, 0.05 * 4 * 2 * M_PI * 1e9 * 8.8541878128e-12})), std::exp(-k * 0.1 * 0.025), 2e-3);
  EXPECT_NEAR(s21(line(40, {"d", 4, 0.05, 1, 0}), LengthUnit::millimetre), std::exp(-k * 0.1 * 0.025), 2e-3);
  // Twice the ports' impedance: mismatch of a line of z = 1/2 between them.
  const Complex reflection(-1.0 / 3, 0), travel = std::exp(Complex(0, -k * 0.1));
  const Complex expected = (1.0 - reflection * reflection) * travel / (1.0 - reflection * reflection * travel * travel);
  EXPECT_NEAR(s21(line(40, {"d", 4, 0, 1, 0}, 2)), std::abs(expected), 3e-3);
}

TEST(GetdpDeck, AbsorbingSideTakesTheMediumBehindIt) {
  if (!has_getdp()) GTEST_SKIP() << "getdp is not installed";
  for (const bool absorbs : {true, false}) {
    Box box = line(40, {"d", 4, 0, 1, 0});
    box.sides[3] = absorbs ? BoundaryCondition::absorbing : BoundaryCondition::pmc;
    box.port_of_side[3] = -1;
    box.ports.pop_back();
    const testing::Folder folder;
    const double reflection = std::abs(solve_line(box, folder.path()).scatter[0][0]);
    EXPECT_NEAR(reflection, absorbs ? 0 : 1, 3e-3);
  }
}

TEST(GetdpDeck, ImpedanceAndLossyConductorSides) {
  if (!has_getdp()) GTEST_SKIP() << "getdp is not installed";
  const testing::Folder folder;
  Box box = line(40, {"d", 4, 0, 1, 0});
  mesh::PrismMeshParts parts = box_parts(box);
  parts.materials.push_back({"resistive", 1, 0, 1, 1e5});
  for (const std::size_t side : {0, 1}) {
    parts.face_tags[side].condition = BoundaryCondition::conductor;
    parts.face_tags[side].material = 1;
  }
  DeckOptions options;
  options.frequencies_hz = {1e9, 3e9};
  options.mesh = "box.msh";
  (void)solve(mesh::PrismMesh::from_parts(parts), options, folder.path(), "Driven", "box.ports.txt");
  const auto sweep = formats::touchstone::read_port_results(folder.path() / "box.ports.txt");
  // Plates of surface resistance R at distance h: alpha = R / (eta h).
  for (const std::size_t f : {0, 1}) {
    const double resistance = std::sqrt(M_PI * sweep.frequencies_hz[f] * 4e-7 * M_PI / 1e5);
    const double alpha = resistance / (376.73 / 2 * 0.01);
    EXPECT_NEAR(-std::log(std::abs(sweep.scatter[f][2])), alpha * 0.1, 0.05 * alpha * 0.1);
  }
}

/// The same line with the upper side as a net's copper and wave ports at the ends named.
mesh::PrismMeshParts wave_line(int cells, const board::Material& material, std::initializer_list<std::size_t> waves,
                               double port_ohm_factor = 1) {
  Box box = line(cells, material, port_ohm_factor);
  for (const std::size_t p : waves) {
    box.ports[p].kind = mesh::PortKind::wave;
    box.ports[p].impedance_ohm = 1e-3;  // means nothing there
    box.ports[p].positive_net = 0;
  }
  mesh::PrismMeshParts parts = box_parts(box);
  parts.nets = {"A"};
  parts.face_tags[1].kind = mesh::FaceTagKind::conductor;
  parts.face_tags[1].net = 0;
  for (const std::size_t p : waves) parts.face_tags[2 + p].kind = mesh::FaceTagKind::wave_port;
  return parts;
}

formats::touchstone::ScatteringSweep solve_parts(const mesh::PrismMeshParts& parts, LengthUnit unit = LengthUnit::metre) {
  const testing::Folder folder;
  DeckOptions options;
  options.frequencies_hz = {1e9, 3e9};
  options.mesh = "box.msh";
  options.unit = unit;
  (void)solve(mesh::PrismMesh::from_parts(parts), options, folder.path(), "Driven", "box.ports.txt");
  return formats::touchstone::read_port_results(folder.path() / "box.ports.txt");
}

TEST(GetdpDeck, WavePortsFindImpedanceAndWaveOfALine) {
  if (!has_getdp()) GTEST_SKIP() << "getdp is not installed";
  const double ohm = 376.730313668 / 2 * 0.01 / 0.02, k = 2 * M_PI * 3e9 / light * 2;
  std::vector<double> errors;
  for (const int cells : {10, 20, 40}) {
    const auto sweep = solve_parts(wave_line(cells, {"dielectric", 4, 0, 1, 0}, {0, 1}), LengthUnit::millimetre);
    for (const auto& port : sweep.ports) EXPECT_NEAR(port.impedance_ohm, ohm, 1e-9 * ohm) << "plates: exact on any mesh";
    const auto& s = sweep.scatter[1];
    errors.push_back(std::abs(s[2] - std::exp(Complex(0, -k * 0.1))) + std::abs(s[0]));
    EXPECT_LT(std::abs(s[2] - s[1]), 1e-9) << "reciprocal";
    EXPECT_NEAR(std::norm(s[0]) + std::norm(s[2]), 1, 1e-9) << "nothing is lost";
  }
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.8) << errors[0] << " " << errors[1];
  EXPECT_NEAR(errors[1] / errors[2], 4, 0.4) << errors[1] << " " << errors[2];
}

TEST(GetdpDeck, WavePortBesideALumpedOneOfAnotherImpedance) {
  if (!has_getdp()) GTEST_SKIP() << "getdp is not installed";
  // A line that ends in thrice its own impedance: half of the voltage comes back, whichever end is fed.
  const double k = 2 * M_PI * 1e9 / light * 2;
  for (const std::size_t wave : {0, 1}) {
    const auto sweep = solve_parts(wave_line(40, {"dielectric", 4, 0, 1, 0}, {wave}, 3));
    EXPECT_NEAR(sweep.ports[1 - wave].impedance_ohm / sweep.ports[wave].impedance_ohm, 3, 1e-9);
    const auto& s = sweep.scatter[0];
    const Complex travel = std::exp(Complex(0, -k * 0.1));
    EXPECT_LT(std::abs(s[3 * wave] - 0.5 * travel * travel), 4e-3) << s[3 * wave];
    EXPECT_LT(std::abs(s[3 * (1 - wave)] + 0.5), 4e-3) << s[3 * (1 - wave)];
    EXPECT_LT(std::abs(s[1] - std::sqrt(0.75) * travel), 4e-3) << s[1];
    EXPECT_LT(std::abs(s[1] - s[2]), 1e-9) << "reciprocal";
  }
}

TEST(GetdpDeck, WavePortsWithLossReferToTheImpedanceWithout) {
  if (!has_getdp()) GTEST_SKIP() << "getdp is not installed";
  const double k = 2 * M_PI * 1e9 / light * 2;
  const auto sweep = solve_parts(wave_line(40, {"dielectric", 4, 0.05, 1, 0}, {0, 1}));
  EXPECT_NEAR(std::abs(sweep.scatter[0][2]), std::exp(-k * 0.1 * 0.025), 2e-3);
  EXPECT_NEAR(sweep.ports[0].impedance_ohm, 376.730313668 / 4, 1e-6);
}

TEST(GetdpDeck, WavePortsThatAreNoTemOnesAreRefused) {
  const testing::Folder folder;
  Diagnostics diagnostics;
  DeckOptions options;
  options.mesh = "box.msh";
  options.frequencies_hz = {1e9};
  const auto write = [&](const mesh::PrismMeshParts& parts) {
    (void)formats::write_deck(mesh::PrismMesh::from_parts(parts), "getdp", options, folder.path(), diagnostics);
  };
  const auto refused = [&](const mesh::PrismMeshParts& parts) {
    const Error error = testing::error_of([&] { write(parts); });
    EXPECT_EQ(error.code(), ErrorCode::format_limit);
    EXPECT_NE(error.text().find("lumped"), std::string::npos) << error.text();
    return error.text();
  };
  auto hollow = wave_line(4, {"d", 4, 0, 1, 0}, {0, 1});
  hollow.face_tags[1].net = -1;
  EXPECT_NE(refused(hollow).find("no signal conductor"), std::string::npos);
  auto alone = wave_line(4, {"d", 4, 0, 1, 0}, {0, 1});
  alone.face_tags[0].condition = BoundaryCondition::pmc;
  EXPECT_NE(refused(alone).find("no second conductor"), std::string::npos);
  EXPECT_NE(refused(wave_line(4, {"ferrite", 4, 0, 10, 0}, {0, 1})).find("'ferrite'"), std::string::npos);
  auto layered = wave_line(4, {"d", 4, 0, 1, 0}, {0, 1});
  for (const std::size_t p : {0, 1}) layered.ports[p].at_m = {0.1 * static_cast<double>(p), 0.01, 0.005};
  layered.shell = mesh::Shell{{0, 0, 0}, {0.1, 0.02, 0.008}, {0, 0, 0}, {0.1, 0.02, 0.01}};
  EXPECT_NE(refused(layered).find("matched layers"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing is written";
  layered.shell->inner_max_m[2] = 0.01;  // as high as the port
  write(layered);
  options.frequencies_hz = {1e9, 5e9};  // half a wave is 15 mm, the port 20 mm wide
  write(wave_line(4, {"d", 4, 0, 1, 0}, {0, 1}));
  EXPECT_EQ(diagnostics.count("deck.wide_wave_port"), 2);
}

TEST(GetdpDeck, RefusesWhatItCannotSay) {
  const testing::Folder folder;
  Diagnostics diagnostics;
  DeckOptions options;
  options.mesh = "box.msh";
  options.frequencies_hz = {1e9};
  const auto refused = [&](const Box& box) {
    return testing::error_of([&] {
      (void)formats::write_deck(mesh::PrismMesh::from_parts(box_parts(box)), "getdp", options, folder.path(), diagnostics);
    });
  };
  Box box;
  box.sides.fill(BoundaryCondition::pec);
  EXPECT_EQ(refused(box).code(), ErrorCode::study_invalid);
  EXPECT_NE(refused(box).text().find("port"), std::string::npos);
  Box wave = line(4, {"d", 4, 0, 1, 0});
  wave.ports[1].kind = mesh::PortKind::wave;
  EXPECT_EQ(refused(wave).code(), ErrorCode::format_limit);
  EXPECT_NE(refused(wave).text().find("lumped"), std::string::npos);
  options.problem = Problem::eigenmode;
  box.sides[0] = BoundaryCondition::absorbing;
  EXPECT_NE(refused(box).text().find("driven"), std::string::npos);
  options.problem = Problem::electrostatic;
  EXPECT_NE(refused(box).text().find("two conductors"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing is written";
}

}  // namespace
}  // namespace pcbmesh
