// SPDX-License-Identifier: GPL-3.0-or-later
// Limits files, solver profiles and certificates, beyond what the fault matrix shows.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fault_injector.hpp"
#include "folder.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/sha256.hpp"
#include "pcbmesh/validation/certificate.hpp"

namespace pcbmesh::validation {
namespace {

using tests::Cells;
using tests::Damage;

std::string write_file(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file.string();
}

std::vector<std::string> codes_of(const Report& report) {
  std::vector<std::string> codes;
  for (const Finding& finding : report.findings) codes.push_back(finding.code);
  return codes;
}

Report judged_by(const char* profile, Damage& damage) {
  damage.options.profile = find_profile(profile);
  return damage.check();
}

TEST(Limits, ReadsNumbersAndSeverities) {
  const testing::Folder folder;
  const Limits limits = read_limits(write_file(
      folder.path() / "limits.json",
      R"({"schema_version": 1, "unit_m": 1e-3, "min_face_angle_deg": 5, "max_warp": {"value": 0.01, "severity": "warning"}})"));
  ASSERT_TRUE(limits.min_face_angle_deg && limits.max_warp);
  EXPECT_EQ(limits.min_face_angle_deg->value, 5);
  EXPECT_EQ(limits.min_face_angle_deg->severity, FindingSeverity::error);
  EXPECT_EQ(limits.max_warp->severity, FindingSeverity::warning);
  EXPECT_EQ(limits.unit_m, 1e-3);
  EXPECT_FALSE(limits.max_aspect_ratio);
}

TEST(Limits, SaysWhatIsWrongWithAFile) {
  const testing::Folder folder;
  const auto message = [&](const std::string& text) -> std::string {
    try {
      (void)read_limits(write_file(folder.path() / "limits.json", text));
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing";
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_TRUE(has(message(R"({"schema_version": 1, "max_aspct_ratio": 3})"), "max_aspct_ratio must be absent"));
  EXPECT_TRUE(has(message(R"({"schema_version": 1, "max_aspect_ratio": 0.5})"), "at least 1"));
  EXPECT_TRUE(
      has(message(R"({"schema_version": 1, "min_dihedral_deg": {"value": 100}})"), "min_dihedral_deg.value must be in 0..90"));
  EXPECT_TRUE(has(message(R"({"schema_version": 1, "max_warp": {"severity": "error"}})"), "max_warp.value"));
  EXPECT_TRUE(has(message(R"({"schema_version": 1, "max_warp": {"value": 1, "severity": "bad"}})"), "severity"));
  EXPECT_TRUE(has(message(R"({"schema_version": 2})"), "schema_version must be 1"));
  EXPECT_TRUE(has(message("{"), "no JSON"));
}

/// One regular prism of edge 1, and one regular tetrahedron far from it.
mesh::MeshData regular_cells() {
  const double h = std::sqrt(3.0) / 2;
  mesh::MeshData mesh;
  mesh.nodes = {{0, 0, 0},   {1, 0, 0}, {0.5, h, 0}, {0, 0, 1},   {1, 0, 1},
                {0.5, h, 1}, {5, 0, 0}, {6, 0, 0},   {5.5, h, 0}, {5.5, h / 3, std::sqrt(2.0 / 3)}};
  mesh.cells = {{mesh::CellKind::wedge, {0, 1, 2, 3, 4, 5}, {1}}, {mesh::CellKind::tetrahedron, {6, 7, 8, 9}, {1}}};
  mesh.names = {{3, 1, "all"}};
  return mesh;
}

TEST(Limits, RegularCellsHaveTheMeasuresOfTheBook) {
  const auto beyond = [](std::optional<Limit> Limits::*member, double value) {
    CheckOptions options;
    options.limits.*member = Limit{value, FindingSeverity::error};
    const Report report = check(regular_cells(), nullptr, options);
    std::int64_t cells = 0;
    for (const Finding& finding : report.findings) cells += finding.code.starts_with("limit.") ? finding.count : 0;
    return cells;
  };
  // Smallest face angle 60 degrees in both; dihedral 60 in the prism, 70.53 in the tetrahedron; largest 90 in the prism.
  EXPECT_EQ(beyond(&Limits::min_face_angle_deg, 60), 0);
  EXPECT_EQ(beyond(&Limits::min_face_angle_deg, 60.01), 2);
  EXPECT_EQ(beyond(&Limits::min_dihedral_deg, 60), 0);
  EXPECT_EQ(beyond(&Limits::min_dihedral_deg, 60.01), 1);
  EXPECT_EQ(beyond(&Limits::min_dihedral_deg, 70.53), 2);
  EXPECT_EQ(beyond(&Limits::max_dihedral_deg, 90), 0);
  EXPECT_EQ(beyond(&Limits::max_dihedral_deg, 89.9), 1);
  EXPECT_EQ(beyond(&Limits::max_dihedral_deg, 70.52), 2);
  EXPECT_EQ(beyond(&Limits::max_aspect_ratio, 1), 0);
  EXPECT_EQ(beyond(&Limits::min_edge_m, 1), 0);
  EXPECT_EQ(beyond(&Limits::min_edge_m, 1.001), 2);
  EXPECT_EQ(beyond(&Limits::min_scaled_jacobian, 1), 0) << "both are scaled to 1";
  EXPECT_EQ(beyond(&Limits::min_prism_quality, 1), 0);
  EXPECT_EQ(beyond(&Limits::min_prism_quality, 1.01), 1);
}

TEST(Profiles, EachFindsWhatItsSolverForbids) {
  Damage damage(Cells::mixed, 0);
  EXPECT_EQ(codes_of(judged_by("dolfinx", damage)),
            (std::vector<std::string>{"profile.dolfinx.mixed_cells", "profile.dolfinx.prisms", "profile.dolfinx.face_tags"}));
  EXPECT_EQ(codes_of(judged_by("elmer", damage)), std::vector<std::string>{"profile.elmer.format"});
  EXPECT_EQ(codes_of(judged_by("getdp", damage)), std::vector<std::string>{"profile.getdp.shared_region"});
  EXPECT_TRUE(judged_by("mfem", damage).findings.empty());
  damage.c.mesh.format = {"msh", "4.1", false};
  damage.c.mesh.num_untagged = {2, 0, 0};
  EXPECT_EQ(codes_of(judged_by("mfem", damage)),
            (std::vector<std::string>{"profile.mfem.format", "profile.mfem.untagged_elements"}));
  EXPECT_TRUE(judged_by("elmer", damage).findings.empty());
  EXPECT_EQ(codes_of(judged_by("getdp", damage)),
            (std::vector<std::string>{"profile.getdp.format", "profile.getdp.shared_region"}));
  Damage tets(Cells::tetrahedra, 0);
  EXPECT_TRUE(judged_by("dolfinx", tets).findings.empty());
  EXPECT_EQ(find_profile("hfss"), nullptr);
  EXPECT_EQ(all_profiles().size(), 5u);
}

TEST(Profiles, GroupsAreKnownByNameWithoutTagsJson) {
  Damage damage(Cells::prisms, 0);
  const auto check_alone = [&] { return check(damage.c.mesh, nullptr, damage.options); };
  EXPECT_TRUE(check_alone().findings.empty()) << to_text(check_alone());
  damage.at(damage.node(2, 3, 0))[1] += 0.1e-3;
  const std::vector<std::string> codes = codes_of(check_alone());
  EXPECT_NE(std::ranges::find(codes, "profile.palace.port_not_planar"), codes.end());
}

TEST(Sha256, IsTheOneOfTheStandard) {
  const testing::Folder folder;
  EXPECT_EQ(sha256_of_file(write_file(folder.path() / "a", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(write_file(folder.path() / "b", "")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_file(write_file(folder.path() / "c", std::string(1'000'000, 'a'))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_THROW((void)sha256_of_file(folder.path() / "nothing"), Error);
  // A folder: `(cd d; sha256sum a b) | sha256sum`, whatever order the files were made in.
  std::filesystem::create_directory(folder.path() / "d");
  write_file(folder.path() / "d" / "b", "");
  write_file(folder.path() / "d" / "a", "abc");
  const std::string list = sha256_of_file(folder.path() / "a") + "  a\n" + sha256_of_file(folder.path() / "b") + "  b\n";
  EXPECT_EQ(sha256_of_file(folder.path() / "d"), sha256_of_file(write_file(folder.path() / "list", list)));
}

TEST(Certificate, HoldsForItsMeshAndForNoOther) {
  const testing::Folder folder;
  const auto mesh_file = folder.path() / "a.msh", tags_file = folder.path() / "a.tags.json";
  write_file(mesh_file, "mesh");
  write_file(tags_file, "tags");
  Damage damage(Cells::prisms, 0);
  const Report report = damage.check();
  const Certificate made =
      certify(report, damage.c.expectation, 1, {certified_file("tags", tags_file), certified_file("mesh", mesh_file)});
  const std::string text = to_json(made);
  EXPECT_EQ(text.find(folder.path().string()), std::string::npos) << "no path in it";
  const Certificate read = read_certificate(write_file(folder.path() / "a.certificate.json", text));
  EXPECT_EQ(to_json(read), text);

  Report same = report;
  check_certificate(read, mesh_file, tags_file, 1, same);
  EXPECT_TRUE(same.passed()) << to_text(same);

  write_file(mesh_file, "other");
  damage.tag(damage.pick(damage.cells_in(5, 7, 2, 5, 1))) = Damage::copper_b;
  Report other = damage.check();
  check_certificate(read, mesh_file, tags_file, 1, other);
  const std::vector<std::string> codes = codes_of(other);
  for (const char* code : {"certificate.file_differs", "certificate.verdict_differs", "certificate.volume_differs"}) {
    EXPECT_NE(std::ranges::find(codes, code), codes.end()) << code;
  }
}

TEST(Certificate, HoldsThePartsOfItsMeshOnly) {
  const testing::Folder folder;
  const auto mesh_file = folder.path() / "a.xdmf", tags_file = folder.path() / "a.tags.json", part = folder.path() / "a.vtkhdf",
             other = folder.path() / "b.vtkhdf";
  for (const auto& file : {mesh_file, tags_file, part, other}) write_file(file, file.filename().string());
  const Report report = Damage(Cells::prisms, 0).check();
  std::vector<Certificate::File> files{certified_file("tags", tags_file), certified_file("mesh", mesh_file),
                                       certified_file("part", part), certified_file("part", other)};
  files[2].of = "a.xdmf";
  files[3].of = "b.xdmf";
  const std::string text = to_json(certify(report, {}, 1, files));
  const Certificate read = read_certificate(write_file(folder.path() / "a.certificate.json", text));
  EXPECT_EQ(to_json(read), text);
  const auto passes = [&] {
    Report now = report;
    check_certificate(read, mesh_file, tags_file, 1, now);
    return std::ranges::count(codes_of(now), std::string("certificate.file_differs")) == 0;
  };
  EXPECT_TRUE(passes());
  write_file(other, "a part of another mesh");
  EXPECT_TRUE(passes());
  write_file(part, "other numbers");
  EXPECT_FALSE(passes());
  std::filesystem::remove(part);
  EXPECT_FALSE(passes());
}

TEST(Certificate, SaysWhatIsWrongWithADamagedFile) {
  const testing::Folder folder;
  const std::string good = to_json(certify({}, {}, 1, {{"mesh", "a.msh", std::string(64, 'a')}}));
  const auto refuses = [&](std::string text) {
    EXPECT_THROW((void)read_certificate(write_file(folder.path() / "c.json", text)), Error) << text;
  };
  EXPECT_NO_THROW((void)read_certificate(write_file(folder.path() / "c.json", good)));
  refuses(good.substr(0, good.size() / 2));
  refuses("[]");
  std::string short_hash = good;
  short_hash.replace(short_hash.find("aaaa"), 4, "xyz");
  refuses(short_hash);
}

TEST(Offenders, HoldAllOfAFinding) {
  Damage damage(Cells::prisms, 0);
  for (auto& tag : damage.c.mesh.faces[0].tags) tag = Damage::outer;
  auto& cells = damage.c.mesh.cells[0];
  for (std::int64_t i = 0; i < 100; ++i) {
    std::swap(cells.corners[static_cast<std::size_t>(6 * i + 1)], cells.corners[static_cast<std::size_t>(6 * i + 2)]);
    std::swap(cells.corners[static_cast<std::size_t>(6 * i + 4)], cells.corners[static_cast<std::size_t>(6 * i + 5)]);
  }
  const Report report = damage.check();
  const auto inverted = std::ranges::find(report.findings, "cell.inverted", &Finding::code);
  ASSERT_NE(inverted, report.findings.end());
  EXPECT_EQ(inverted->count, 100);
  EXPECT_EQ(inverted->places.size(), Finding::max_places);
  ASSERT_EQ(inverted->cells.size(), 100u);
  EXPECT_EQ(inverted->cells.front(), 0);
  EXPECT_EQ(inverted->cells.back(), 99);
}

TEST(Interiors, ATurnedBoxInsideABoxWithTheSameSides) {
  // Two boxes of the same extent, divided differently, share no node but the corners' places: nothing crosses.
  mesh::MeshData mesh;
  const auto add_box = [&](int n) {
    const auto base = static_cast<std::int64_t>(mesh.nodes.size());
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
          mesh.nodes.push_back({static_cast<double>(i) / n, static_cast<double>(j) / n, static_cast<double>(k) / n});
    const auto node = [&](int i, int j, int k) { return base + (static_cast<std::int64_t>(k) * (n + 1) + j) * (n + 1) + i; };
    if (mesh.cells.empty()) mesh.cells.push_back({mesh::CellKind::hexahedron, {}, {}});
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          for (const int up : {0, 1})
            for (const std::int64_t id :
                 {node(i, j, k + up), node(i + 1, j, k + up), node(i + 1, j + 1, k + up), node(i, j + 1, k + up)})
              mesh.cells[0].corners.push_back(id);
          mesh.cells[0].tags.push_back(1);
        }
  };
  mesh.names = {{3, 1, "all"}};
  add_box(3);
  EXPECT_TRUE(check(mesh, nullptr).passed());
  add_box(4);
  const Report report = check(mesh, nullptr);
  const auto overlap = std::ranges::find(report.findings, "cell.overlap", &Finding::code);
  ASSERT_NE(overlap, report.findings.end()) << to_text(report);
  EXPECT_EQ(overlap->count, 6 * 9 + 6 * 16);
}

}  // namespace
}  // namespace pcbmesh::validation
