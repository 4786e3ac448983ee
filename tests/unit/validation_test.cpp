// SPDX-License-Identifier: GPL-3.0-or-later
// Good meshes, reports, tags.json. Damaged meshes: validation_faults_test.cpp.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "pcbmesh/base/error.hpp"
#include "unit/check_block.hpp"
#include "validation/checks/checks.hpp"

namespace pcbmesh::validation {
namespace {

using tests::CheckCase;

Report without_times(Report report) {
  for (CheckRun& run : report.checks) run.cpu_s = 0;
  return report;
}

/// Cells of every kind round one hexahedron: a pyramid above, a tetrahedron on the pyramid, a wedge beside it.
mesh::MeshData one_of_each_kind() {
  mesh::MeshData mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},     {0, 1, 0},   {0, 0, 1},   {1, 0, 1},
                {1, 1, 1}, {0, 1, 1}, {0.5, 0.5, 2}, {2, 0.5, 0}, {2, 0.5, 1}, {2, 0.5, 2}};
  mesh.cells = {{mesh::CellKind::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7}, {1}},
                {mesh::CellKind::pyramid, {4, 5, 6, 7, 8}, {1}},
                {mesh::CellKind::tetrahedron, {5, 11, 6, 8}, {1}},
                {mesh::CellKind::wedge, {1, 9, 2, 5, 10, 6}, {1}}};
  mesh.names = {{3, 1, "all"}};
  return mesh;
}

TEST(Check, PassesAGoodBoard) {
  const CheckCase good = tests::build_block(tests::board_plan());
  const Report report = check(good.mesh, &good.expectation);
  EXPECT_TRUE(report.passed()) << to_text(report);
  EXPECT_TRUE(report.findings.empty()) << to_text(report);
  EXPECT_EQ(report.num_cells, 150);
  ASSERT_EQ(report.volumes.size(), 5u);
  EXPECT_EQ(report.volumes[1].name, "F.Cu|copper|A");
  EXPECT_EQ(report.volumes[1].num_cells, 10);
  EXPECT_NEAR(report.volumes[1].volume, 5e-3 * 1e-3 * 35e-6, 1e-20);
}

TEST(Check, KnowsEveryCellKind) {
  mesh::MeshData mesh = one_of_each_kind();
  Report report = check(mesh, nullptr);
  EXPECT_TRUE(report.passed()) << to_text(report);
  ASSERT_EQ(report.volumes.size(), 1u);
  // 1 (cube) + 1/3 (pyramid) + 1/2 (wedge) + the tetrahedron's triple product / 6.
  EXPECT_NEAR(report.volumes[0].volume, 1 + 1.0 / 3 + 0.5 + 0.25, 1e-14);
  for (auto& block : mesh.cells) {
    // Mirrored: swapping two corners of each base turns the cell inside out.
    std::swap(block.corners[1],
              block.corners[block.kind == mesh::CellKind::pyramid || block.kind == mesh::CellKind::hexahedron ? 3u : 2u]);
    if (block.kind == mesh::CellKind::hexahedron) std::swap(block.corners[5], block.corners[7]);
    if (block.kind == mesh::CellKind::wedge) std::swap(block.corners[4], block.corners[5]);
  }
  report = check(mesh, nullptr);
  ASSERT_FALSE(report.findings.empty());
  EXPECT_EQ(report.findings[0].code, "cell.inverted");
  EXPECT_EQ(report.findings[0].count, 4);
}

TEST(Check, SameReportForAnyNumberOfThreads) {
  tests::BlockPlan plan = tests::board_plan();
  plan.nx = plan.ny = 60;
  plan.labels.assign(3 * 3600, 0);
  for (std::size_t i = 0; i < plan.labels.size(); ++i) plan.labels[i] = static_cast<int>(i * 7919 % 31 % 5);
  plan.rising.assign(3600, true);
  plan.shuffle_nodes = 5;
  CheckCase damaged = tests::build_block(plan);
  for (std::size_t i = 0; i < 400; ++i) damaged.mesh.cells[0].corners[i * 97 % 100000] = static_cast<std::int64_t>(i * 31);
  for (std::size_t i = 0; i < 40; ++i) damaged.mesh.nodes[i * 131] = damaged.mesh.nodes[i];
  for (std::size_t i = 0; i < 50; ++i) {
    auto& block = damaged.mesh.cells[0];
    for (std::size_t k = 0; k < 6; ++k) block.corners.push_back(std::int64_t{block.corners[12000 + 6 * i + k]});
    block.tags.push_back(1);
  }
  damaged.expectation.nets[0].pieces = 1;
  const std::string one = to_json(without_times(check(damaged.mesh, &damaged.expectation, {.num_threads = 1})));
  EXPECT_NE(one.find("node.duplicate"), std::string::npos);
  EXPECT_NE(one.find("face.many_owners"), std::string::npos);
  for (const int threads : {2, 7}) {
    EXPECT_EQ(one, to_json(without_times(check(damaged.mesh, &damaged.expectation, {.num_threads = threads}))));
  }
}

TEST(Check, MatchesFacesAlikeInOnePassOrMany) {
  tests::BlockPlan plan = tests::board_plan();
  plan.nx = plan.ny = 60;
  plan.labels.assign(3 * 3600, 0);
  plan.labels[100] = tests::empty_label;
  plan.rising.assign(3600, false);
  plan.shuffle_nodes = 9;
  const CheckCase good = tests::build_block(plan);
  const checks::Context context(good.mesh, nullptr, {});
  const auto usual = checks::match_faces(context, nullptr);
  EXPECT_EQ(static_cast<std::int64_t>(usual.boundary.size()), good.mesh.faces[0].size() + good.mesh.faces[1].size());
  EXPECT_EQ(2 * usual.num_inner + static_cast<std::int64_t>(usual.boundary.size()), 5 * good.mesh.cells[0].size());
  for (const bool wide : {false, true}) {
    const auto other =
        checks::match_faces(context, nullptr, nullptr, {.bytes_per_cell = 1, .min_entries_at_once = 3000, .wide_ids = wide});
    EXPECT_EQ(other.boundary, usual.boundary);
    EXPECT_EQ(other.num_inner, usual.num_inner);
    EXPECT_EQ(other.untagged.count(), 0);
  }
}

TEST(Check, ManyCellsAtOneNode) {
  // A fan of tetrahedra with node 0 as the smallest of nearly all faces.
  constexpr int n = 30;
  mesh::MeshData mesh;
  mesh.nodes = {{n / 2.0, n / 2.0, 5}};
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) mesh.nodes.push_back({x * 1.0, y * 1.0, 0});
  }
  mesh::CellBlock tets;
  tets.kind = mesh::CellKind::tetrahedron;
  const auto node = [](int x, int y) { return static_cast<std::int64_t>(1 + y * (n + 1) + x); };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      tets.corners.insert(tets.corners.end(), {node(x, y), node(x + 1, y), node(x + 1, y + 1), 0});
      tets.corners.insert(tets.corners.end(), {node(x, y), node(x + 1, y + 1), node(x, y + 1), 0});
    }
  }
  tets.tags.assign(tets.corners.size() / 4, 1);
  mesh.cells = {tets};
  mesh.names = {{3, 1, "fan"}};
  const checks::Context context(mesh, nullptr, {});
  EXPECT_EQ(checks::match_faces(context, nullptr).boundary.size(), static_cast<std::size_t>(2 * n * n + 4 * n));
  EXPECT_TRUE(check(mesh, nullptr).passed());
}

TEST(Check, ManyTwinsOfOneCellDoNotStallIt) {
  mesh::MeshData mesh = one_of_each_kind();
  mesh::CellBlock wedges = mesh.cells[3];
  for (int i = 0; i < 20000; ++i) {
    wedges.corners.insert(wedges.corners.end(), {1, 9, 2, 5, 10, 6});
    wedges.tags.push_back(1);
  }
  mesh.cells[3] = wedges;
  for (int i = 0; i < 20000; ++i) mesh.nodes.push_back({0.5, 0.5, 0.5});
  EXPECT_FALSE(check(mesh, nullptr).passed());
}

TEST(Check, ReportsForPeopleAndMachines) {
  CheckCase bad = tests::build_block(tests::board_plan());
  bad.mesh.nodes.push_back({0.0012, 0.0023, 0});
  bad.mesh.names[0].name = "core\xff";
  const Report report = check(bad.mesh, &bad.expectation);
  const std::string text = to_text(report);
  EXPECT_EQ(text.rfind("FAILED: 2 kinds of error in 150 cells, 145 nodes, 160 tagged faces\n", 0), 0u) << text;
  EXPECT_NE(text.find("error node.orphan: 1 nodes belong to no cell\n    at (0.0012, 0.0023, 0), node 144\n"),
            std::string::npos)
      << text;
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_FALSE(json.at("passed").get<bool>());
  EXPECT_EQ(json.at("findings").at(0).at("code"), "node.orphan");
  EXPECT_EQ(json.at("findings").at(0).at("places").at(0).at("node"), 144);
  EXPECT_EQ(json.at("checks").size(), report.checks.size());
}

class TagsFile {
 public:
  explicit TagsFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("pcbmesh_tags_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".json")) {
    std::ofstream(path_) << text;
  }
  ~TagsFile() { std::filesystem::remove(path_); }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

nlohmann::json sample_tags() {
  return {{"schema_version", 1},
          {"unit_m", 1e-3},
          {"volumes",
           {{{"id", 1},
             {"name", "core|fr4|none"},
             {"layer", "core"},
             {"material", "fr4"},
             {"net", nullptr},
             {"conductor", false},
             {"num_cells", 12},
             {"volume_m3", 1e-9}}}},
          {"faces", {{{"id", 3}, {"name", "zmin"}, {"kind", "outer"}, {"net", nullptr}, {"num_faces", 7}, {"area_m2", 2e-6}}}},
          {"nets", {{{"name", "GND"}, {"pieces", 2}}, {{"name", "VCC"}}}},
          {"touching_nets", nlohmann::json::array({nlohmann::json::array({"GND", "AGND"})})}};
}

TEST(Expectation, ReadsTagsJson) {
  const TagsFile file(sample_tags().dump());
  const Expectation read = read_expectation(file.path());
  EXPECT_EQ(read.unit_m, 1e-3);
  ASSERT_EQ(read.volumes.size(), 1u);
  EXPECT_EQ(read.volumes[0].net, "");
  EXPECT_EQ(read.volumes[0].num_cells, 12);
  ASSERT_EQ(read.faces.size(), 1u);
  EXPECT_TRUE(read.faces[0].outer);
  EXPECT_EQ(read.faces[0].num_faces, 7);
  ASSERT_EQ(read.nets.size(), 2u);
  EXPECT_EQ(read.nets[0].pieces, 2);
  EXPECT_EQ(read.nets[1].pieces, -1);
  EXPECT_EQ(read.touching_nets.at(0), (std::array<std::string, 2>{"GND", "AGND"}));
}

TEST(Expectation, SaysWhatIsWrongWithADamagedFile) {
  const auto message = [](const std::string& text) -> std::string {
    const TagsFile file(text);
    try {
      (void)read_expectation(file.path());
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file_syntax);
      return error.what();
    }
    return "nothing";
  };
  const auto changed = [&](const char* pointer, const nlohmann::json& value) {
    nlohmann::json tags = sample_tags();
    tags[nlohmann::json::json_pointer(pointer)] = value;
    return message(tags.dump());
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(message(sample_tags().dump().substr(0, 50)), "byte 51"));
  EXPECT_TRUE(has(message(""), "no JSON"));
  EXPECT_TRUE(has(message("[]"), "an object"));
  EXPECT_TRUE(has(message("{}"), "schema_version"));
  EXPECT_TRUE(has(changed("/schema_version", 2), "schema_version must be 1"));
  EXPECT_TRUE(has(changed("/unit_m", 0), "unit_m must be greater than zero"));
  EXPECT_TRUE(has(changed("/volumes/0/id", -4), "volumes[0].id must be a whole number"));
  EXPECT_TRUE(has(changed("/volumes/0/id", 18446744073709551615u), "volumes[0].id"));
  EXPECT_TRUE(has(changed("/volumes/0/num_cells", "many"), "volumes[0].num_cells"));
  EXPECT_TRUE(has(changed("/volumes/0/name", 7), "volumes[0].name must be a text"));
  EXPECT_TRUE(has(changed("/volumes/1", sample_tags()["volumes"][0]), "volumes[1].id must be given once"));
  EXPECT_TRUE(has(changed("/faces/0/kind", "inner"), "faces[0].kind"));
  EXPECT_TRUE(has(changed("/touching_nets/0", nlohmann::json::array({"A"})), "touching_nets[0] must be a list of two"));
  EXPECT_THROW((void)read_expectation("/nowhere/tags.json"), Error);
}

}  // namespace
}  // namespace pcbmesh::validation
