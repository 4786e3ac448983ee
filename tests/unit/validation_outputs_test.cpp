// SPDX-License-Identifier: GPL-3.0-or-later
// The table of codes beside docs/checks.md and the sources, and the reports for CI systems.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "pcbmesh/validation/codes.hpp"
#include "pcbmesh/validation/outputs.hpp"
#include "unit/check_block.hpp"

namespace pcbmesh::validation {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The whole-word codes of a text that `pattern` finds in its first group.
std::set<std::string> codes_in(const std::string& text, const char* pattern) {
  std::set<std::string> codes;
  const std::regex expression(pattern);
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) codes.insert((*at)[1]);
  return codes;
}

std::set<std::string> table_codes() {
  std::set<std::string> codes;
  for (const CheckCode& entry : check_codes()) codes.insert(std::string(entry.code));
  return codes;
}

Report bad_report() {
  Report report;
  Finding finding{"node.hanging", FindingSeverity::error, "a <bad> \"node\" & \xff\x01", 9, {}};
  finding.places.push_back({0, {1, 2, 3}, "F.Cu|copper|A&B", -1, 4});
  report.findings = {finding, {"tag.no_names", FindingSeverity::warning, "no names", 1, {}}};
  return report;
}

TEST(CheckCodes, TableAndDocumentAgreeLineByLine) {
  std::istringstream lines(text_of(PCBMESH_SOURCE_DIR "/docs/checks.md"));
  std::set<std::string> documented;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    const std::string first = line.substr(0, line.find(" | "));
    for (const std::string& code : codes_in(first, "`([a-z]+(?:\\.[a-z_]+)+)`")) {
      const CheckCode* entry = find_check_code(code);
      ASSERT_NE(entry, nullptr) << code;
      EXPECT_TRUE(documented.insert(code).second) << code << " is documented twice";
      std::string plain = line;
      std::erase(plain, '`');
      EXPECT_NE(plain.find(" | " + std::string(word_of(entry->severity)) + " | " + std::string(entry->meaning) + " | "),
                std::string::npos)
          << code;
      if (!plain.ends_with("| as above |")) {
        EXPECT_TRUE(plain.ends_with("| " + std::string(entry->remedy) + " |")) << code;
      }
    }
  }
  EXPECT_EQ(documented, table_codes());
}

TEST(CheckCodes, TableHoldsExactlyWhatTheChecksReport) {
  std::set<std::string> used;
  for (const auto& file : std::filesystem::recursive_directory_iterator(PCBMESH_SOURCE_DIR "/validation")) {
    if (file.path().extension() == ".cpp" && file.path().filename() != "codes.cpp" &&
        file.path().string().find("/cases/") == std::string::npos)
      used.merge(codes_in(text_of(file.path()),
                          "\"((?:array|mesh|node|cell|face|boundary|volume|tag|net|layer|periodic|limit|profile\\.[a-z]+|"
                          "certificate)\\.[a-z_]+)\""));
  }
  EXPECT_EQ(used, table_codes());
}

TEST(Junit, OneCasePerCodeAndFailuresFollowTheThreshold) {
  const std::string tests = "tests=\"" + std::to_string(check_codes().size()) + "\"";
  const std::string strict = to_junit(bad_report(), "a&b.msh", FindingSeverity::warning),
                    mild = to_junit(bad_report(), "a.msh");
  EXPECT_NE(strict.find(tests + " failures=\"2\""), std::string::npos);
  EXPECT_NE(mild.find(tests + " failures=\"1\""), std::string::npos);
  EXPECT_NE(mild.find("<system-out>no names"), std::string::npos);
  EXPECT_NE(strict.find("a&amp;b.msh"), std::string::npos);
  EXPECT_NE(strict.find("a &lt;bad&gt; &quot;node&quot; &amp; ??"), std::string::npos) << strict;
}

TEST(Sarif, ResultsPointAtTheirRules) {
  const auto out = nlohmann::json::parse(to_sarif(bad_report(), "my board.msh"));
  EXPECT_EQ(out["version"], "2.1.0");
  const auto& run = out["runs"][0];
  ASSERT_EQ(run["results"].size(), 2u);
  for (const auto& result : run["results"]) {
    EXPECT_EQ(run["tool"]["driver"]["rules"][result["ruleIndex"].get<std::size_t>()]["id"], result["ruleId"]);
    EXPECT_EQ(result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"], "my%20board.msh");
  }
  EXPECT_EQ(run["results"][0]["occurrenceCount"], 9);
}

TEST(Offenders, CarryTheNamedElementsAndSurviveIdsOutOfRange) {
  const tests::CheckCase good = tests::build_block(tests::board_plan());
  Report report = bad_report();
  const std::string whole = to_offenders_vtu(report, good.mesh);
  EXPECT_NE(whole.find("NumberOfPoints=\"7\" NumberOfCells=\"2\""), std::string::npos) << whole.substr(0, 400);
  report.findings[0].places[0].cell = 1'000'000;
  report.findings[0].places[0].node = 1'000'000;
  EXPECT_NE(to_offenders_vtu(report, good.mesh).find("NumberOfCells=\"0\""), std::string::npos);
}

}  // namespace
}  // namespace pcbmesh::validation
