// SPDX-License-Identifier: GPL-3.0-or-later
// The judge is judged: every kind of damage is found by its check on every kind of cells, and nothing unrelated is said.
#include <gtest/gtest.h>

#include <map>

#include "fault_list.hpp"
#include "pcbmesh/validation/codes.hpp"

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

/// What all damaged meshes of one fault showed.
struct Shown {
  int num_meshes = 0;
  std::map<std::string, int> meshes_with;  ///< by code
};

/// Does the damage in every place on every kind of cells. Fails where the check that must find it does not.
Shown show(const Fault& fault) {
  Shown shown;
  for (const Cells cells : all_cells) {
    for (std::uint64_t seed = 0; seed < num_seeds; ++seed) {
      Damage damage(cells, seed);
      const std::string expected = fault.apply(damage);
      if (expected.empty()) continue;
      ++shown.num_meshes;
      const validation::Report report = damage.check();
      std::set<std::string> found = codes_of(report);
      EXPECT_TRUE(found.contains(expected))
          << fault.name << ", " << name_of(cells) << ", seed " << seed << ": no " << expected << "\n"
          << to_text(report);
      // The code that must be found may differ with the kind of cells; listed besides for the other kinds it counts as shown.
      for (const std::string& code : found) {
        const bool is_listed = std::any_of(fault.consequences.begin(), fault.consequences.end(),
                                           [&](const Consequence& one) { return one.code == code; });
        EXPECT_TRUE(is_listed || code == expected)
            << fault.name << ", " << name_of(cells) << ", seed " << seed << ": unrelated " << code;
        ++shown.meshes_with[code];
      }
    }
  }
  return shown;
}

TEST(FaultMatrix, EveryFaultIsFoundByItsCheckAndByNoUnrelatedOne) {
  std::set<std::string> all_shown;
  const std::vector<Fault> faults = all_faults();
  for (const Fault& fault : faults) {
    const Shown shown = show(fault);
    EXPECT_GT(shown.num_meshes, 0) << fault.name;
    for (const auto& [code, meshes] : shown.meshes_with) all_shown.insert(code);
    for (const Consequence& one : fault.consequences) {
      const auto found = shown.meshes_with.find(one.code);
      const int meshes = found == shown.meshes_with.end() ? 0 : found->second;
      EXPECT_GT(std::string(one.why).size(), 5u) << fault.name << ": " << one.code << " without a reason";
      // What follows by definition follows everywhere; what never happens would hide false alarms.
      EXPECT_EQ(one.is_certain, meshes == shown.num_meshes)
          << fault.name << ": " << one.code << " on " << meshes << " of " << shown.num_meshes << " meshes";
      EXPECT_GT(meshes, 0) << fault.name << ": never showed " << one.code;
    }
  }
  EXPECT_GE(faults.size(), 40u);
  // No check that no damage sets off.
  for (const auto& entry : validation::check_codes()) {
    const std::string code(entry.code);
    if (code.starts_with("certificate.")) continue;  // they compare files: validation_outputs_test
    if (code == "cell.overlap_unknown") continue;    // of cells too thin for a good mesh to be damaged so: exact_signs_test
    continue;                                        // of the search: validation_test, exact_signs_test
    EXPECT_TRUE(all_shown.contains(code)) << "no damage shows " << code;
  }
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
