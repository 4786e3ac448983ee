// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "folder.hpp"
#include "formats/touchstone/port_results.hpp"
#include "thrown_error.hpp"

namespace pcbmesh {
namespace {

using namespace formats::touchstone;
using testing::Folder;

const std::string opening =
    "# pcbmesh port results 1\n# port 1 50 in\n# port 2 50 out of it\n# frequency_hz excited observed re im\n";

ScatteringSweep read(const Folder& folder, const std::string& text) {
  testing::create(folder / "x.ports.txt", text);
  return read_port_results(folder / "x.ports.txt");
}

TEST(Touchstone, ReadsRowsInAnyOrderAndSortsFrequencies) {
  const Folder folder;
  const ScatteringSweep sweep = read(
      folder,
      opening +
          "2e9 2 2 0.4 0\n2e9 1 1 0.1 0\n2e9 1 2 0.3 0.5\n2e9 2 1 0.2 0\n1e9 1 1 0 0\n1e9 1 2 1 0\n1e9 2 1 1 0\n1e9 2 2 0 0\n");
  EXPECT_EQ(sweep.ports[1].name, "out of it");
  ASSERT_EQ(sweep.frequencies_hz, (std::vector<double>{1e9, 2e9}));
  EXPECT_EQ(sweep.scatter[1], (std::vector<Complex>{0.1, 0.2, Complex(0.3, 0.5), 0.4}));  // S21 = observed 2, excited 1
  const std::string text = to_touchstone(sweep);
  EXPECT_NE(text.find("# Hz S RI R 50\n"), std::string::npos);
  EXPECT_NE(text.find("2000000000 0.1 0 0.3 0.5 0.2 0 0.4 0\n"), std::string::npos) << "two ports: S11 S21 S12 S22\n" << text;
}

TEST(Touchstone, MorePortsAreRowsOfAtMostFourValues) {
  ScatteringSweep sweep;
  sweep.ports.assign(5, {"p", 50});
  sweep.frequencies_hz = {1e9};
  sweep.scatter.emplace_back(25);
  for (std::size_t k = 0; k < 25; ++k) sweep.scatter[0][k] = static_cast<double>(k);
  const std::string text = to_touchstone(sweep);
  EXPECT_NE(text.find("1000000000 0 0 1 0 2 0 3 0\n  4 0\n  5 0 6 0 7 0 8 0\n  9 0\n"), std::string::npos) << text;
}

TEST(Touchstone, RenormalisesASeriesResistorAsTheFormulaSays) {
  // Series R between ports of 50 ohm: S11 = R / (R + 100), S21 = 100 / (R + 100).
  const auto series = [](double r, double z1, double z2) {
    const double sum = r + z1 + z2;
    return std::vector<Complex>{(r + z2 - z1) / sum, 2 * std::sqrt(z1 * z2) / sum, 2 * std::sqrt(z1 * z2) / sum,
                                (r + z1 - z2) / sum};
  };
  ScatteringSweep sweep;
  sweep.ports = {{"a", 30}, {"b", 70}};
  sweep.frequencies_hz = {1};
  sweep.scatter = {series(20, 30, 70)};
  const ScatteringSweep at_50 = renormalised(sweep, 50);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(std::abs(at_50.scatter[0][k] - series(20, 50, 50)[k]), 0, 1e-14);
}

TEST(Touchstone, JudgesPassivityAndReciprocity) {
  ScatteringSweep sweep;
  sweep.ports.assign(2, {"p", 50});
  sweep.frequencies_hz = {1, 2};
  const Complex i(0, 1);
  sweep.scatter = {{0.6, 0.8 * i, 0.8 * i, 0.6}, {0, 1.25, 0.5, 0}};
  const NetworkCheck check = check_network(sweep);
  EXPECT_NEAR(check.largest_gain, 1.25, 1e-12);
  EXPECT_EQ(check.largest_gain_hz, 2);
  EXPECT_NEAR(check.asymmetry, 0.75, 1e-12);
  sweep.frequencies_hz.pop_back();
  sweep.scatter.pop_back();
  EXPECT_NEAR(check_network(sweep).largest_gain, 1, 1e-12) << "lossless";
}

TEST(Touchstone, SaysWhatIsWrongWithAFile) {
  const Folder folder;
  const auto fault = [&](const std::string& text) { return testing::error_of([&] { (void)read(folder, text); }); };
  EXPECT_EQ(fault("hello\n").code(), ErrorCode::file_syntax);
  EXPECT_EQ(fault(opening).code(), ErrorCode::file_truncated);
  EXPECT_EQ(fault(opening + "1e9 1 1 0 0\n").code(), ErrorCode::file_truncated) << "port 2 was not excited";
  EXPECT_NE(fault(opening + "1e9 1 1 0 0\n1e9 1 2 0 0\n").text().find("out of it"), std::string::npos);
  EXPECT_EQ(fault(opening + "1e9 1 3 0 0\n").spot().line, 5);
  EXPECT_EQ(fault(opening + "1e9 1 1 nan 0\n").code(), ErrorCode::input_number);
  EXPECT_EQ(fault(opening + "1e9 1 1 x 0\n").code(), ErrorCode::file_syntax);
  EXPECT_EQ(fault(opening + "-1e9 1 1 0 0\n").code(), ErrorCode::file_syntax);
  const ScatteringSweep sweep = read(folder, opening + "1e9 1 1 0 0\n1e9 1 2 1 0\n1e9 2 1 1 0\n1e9 2 2 0 0\n");
  EXPECT_EQ(testing::error_of([&] { write_touchstone(sweep, folder / "x.s3p"); }).code(), ErrorCode::usage);
  write_touchstone(sweep, folder / "x.s2p");
  EXPECT_TRUE(std::filesystem::exists(folder / "x.s2p"));
}

}  // namespace
}  // namespace pcbmesh
