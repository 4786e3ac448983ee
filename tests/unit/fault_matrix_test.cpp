// SPDX-License-Identifier: GPL-3.0-or-later
// The judge is judged: every kind of damage is found by its check on every kind of cells, and nothing unrelated is said.
#include <gtest/gtest.h>

#include "fault_list.hpp"

namespace pcbmesh::tests {
namespace {

constexpr std::uint64_t num_seeds = 8;

std::set<std::string> codes_of(const validation::Report& report) {
  std::set<std::string> codes;
  for (const auto& finding : report.findings) codes.insert(finding.code);
  return codes;
}

TEST(FaultMatrix, TheUndamagedMeshesShowNothing) {
  for (const Cells cells : all_cells) {
    const validation::Report report = Damage(cells, 0).check();
    EXPECT_TRUE(report.findings.empty()) << name_of(cells) << "\n" << to_text(report);
  }
}

TEST(FaultMatrix, EveryFaultIsFoundByItsCheckAndByNoUnrelatedOne) {
  int kinds = 0;
  for (const Fault& fault : all_faults()) {
    std::set<std::string> allowed(fault.consequences.begin(), fault.consequences.end()), seen;
    bool applied = false;
    for (const Cells cells : all_cells) {
      for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
        Damage damage(cells, seed);
        const std::string expected = fault.apply(damage);
        if (expected.empty()) continue;
        applied = true;
        const validation::Report report = damage.check();
        const std::set<std::string> found = codes_of(report);
        EXPECT_TRUE(found.contains(expected))
            << fault.name << ", " << name_of(cells) << ", seed " << seed << ": no " << expected << "\n"
            << to_text(report);
        for (const std::string& code : found) {
          seen.insert(code);
          EXPECT_TRUE(code == expected || allowed.contains(code))
              << fault.name << ", " << name_of(cells) << ", seed " << seed << ": unrelated " << code;
        }
      }
    }
    EXPECT_TRUE(applied) << fault.name;
    kinds += applied ? 1 : 0;
    // A list of consequences that holds more than what happens would hide false alarms.
    for (const std::string& code : allowed) EXPECT_TRUE(seen.contains(code)) << fault.name << ": never showed " << code;
  }
  EXPECT_GE(kinds, 40);
}

TEST(FaultMatrix, TenThousandRandomGoodMeshesGiveNoFalseAlarm) {
  for (std::uint64_t seed = 0; seed < 10'000; ++seed) {
    const CheckCase good = build_block(random_plan(seed));
    const validation::Report report = check(good.mesh, &good.expectation, {.num_threads = 1});
    for (const auto& finding : report.findings) {
      // Random voids may well touch along an edge only.
      ASSERT_EQ(finding.code, "boundary.pinched") << "seed " << seed << "\n" << to_text(report);
    }
  }
}

}  // namespace
}  // namespace pcbmesh::tests
