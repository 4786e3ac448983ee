// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <tuple>

#include "folder.hpp"
#include "formats/msh/format.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/group_names.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::formats {
namespace {

using testing::contents;
using testing::Folder;
using testing::sample_parts;

struct Variant {
  std::string version;
  bool binary;
};
const Variant variants[] = {{"4.1", true}, {"4.1", false}, {"2.2", true}, {"2.2", false}};

void write(const mesh::PrismMesh& mesh, const std::filesystem::path& file, const WriteMeshOptions& options,
           const Progress& progress = Progress{}) {
  write_mesh(mesh, file, options, {}, progress);
}

mesh::MeshData written_and_read(const mesh::PrismMesh& mesh, const WriteMeshOptions& options) {
  const Folder folder;
  write(mesh, folder / "a.msh", options);
  EXPECT_EQ(folder.num_files(), 1u);
  return msh::mesh_format.read(folder / "a.msh", Progress{});
}

/// (corners, tag) of all elements with n corners each, sorted.
std::multiset<std::pair<std::vector<std::int64_t>, std::int32_t>> elements_of(const std::vector<std::int64_t>& corners,
                                                                              const std::vector<std::int32_t>& tags, int n) {
  std::multiset<std::pair<std::vector<std::int64_t>, std::int32_t>> out;
  for (std::size_t i = 0; i < tags.size(); ++i) {
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(i) * n;
    out.emplace(std::vector<std::int64_t>(first, first + n), tags[i]);
  }
  return out;
}

void expect_same(const mesh::PrismMeshParts& parts, const mesh::PrismMesh& mesh, const mesh::MeshData& read, double scale) {
  const testing::ExplicitMesh expected = testing::spell_out(parts.planar, parts.plan, parts.column_tags);
  ASSERT_EQ(read.nodes.size(), expected.nodes.size());
  for (std::size_t i = 0; i < read.nodes.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(read.nodes[i][k], expected.nodes[i][k] * scale) << "node " << i;
  ASSERT_EQ(read.cells.size(), 1u);
  EXPECT_EQ(read.cells[0].kind, mesh::CellKind::wedge);
  std::multiset<std::pair<std::vector<std::int64_t>, std::int32_t>> prisms;
  for (std::size_t i = 0; i < expected.prisms.size(); ++i)
    prisms.emplace(std::vector<std::int64_t>(expected.prisms[i].begin(), expected.prisms[i].end()), expected.tags[i] + 1);
  EXPECT_TRUE(elements_of(read.cells[0].corners, read.cells[0].tags, 6) == prisms);
  // Each face is the outward side of exactly one prism, and each such side without a mate is a face.
  auto sides = testing::faces_of(expected.prisms);
  std::size_t open = 0;
  for (const auto& [key, owners] : sides) open += owners.size() == 1 ? 1 : 0;
  std::size_t faces = 0;
  std::map<std::int32_t, std::int64_t> per_tag;
  for (const mesh::FaceBlock& block : read.faces) {
    const int n = corners_of(block.kind);
    for (const auto& [corners, tag] : elements_of(block.corners, block.tags, n)) {
      auto key = corners;
      std::sort(key.begin(), key.end());
      const auto side = sides.find(key);
      ASSERT_NE(side, sides.end());
      ASSERT_EQ(side->second.size(), 1u) << "a face inside the mesh";
      EXPECT_EQ(testing::turned(corners), testing::turned(side->second[0]));
      ++per_tag[tag];
      ++faces;
    }
  }
  EXPECT_EQ(faces, open);
  for (const mesh::FaceTag& tag : mesh.face_tags()) EXPECT_EQ(per_tag[tag.id], tag.num_triangles + tag.num_quads) << tag.name;
  EXPECT_EQ(read.num_other_elements, (std::vector<std::int64_t>{0, 0}));
}

TEST(MshWriter, EveryVariantReadsBackExactlyWithAndWithoutVoids) {
  for (const bool with_voids : {true, false}) {
    const mesh::PrismMeshParts parts = sample_parts(with_voids);
    const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(parts);
    for (const Variant& variant : variants) {
      for (const LengthUnit unit : {LengthUnit::metre, LengthUnit::millimetre, LengthUnit::micrometre}) {
        SCOPED_TRACE(variant.version + (variant.binary ? " binary " : " text ") + std::string(name_of(unit)));
        const mesh::MeshData read = written_and_read(mesh, {variant.binary, unit, variant.version});
        expect_same(parts, mesh, read, unit == LengthUnit::metre ? 1 : unit == LengthUnit::millimetre ? 1e3 : 1e6);
        std::vector<std::tuple<int, int, std::string>> names, expected;
        for (const mesh::FaceTag& tag : mesh.face_tags()) expected.emplace_back(2, tag.id, tag.name);
        for (const mesh::VolumeTag& tag : mesh.volume_tags()) expected.emplace_back(3, tag.id, tag.name);
        for (const mesh::GroupName& name : read.names) names.emplace_back(name.dimension, name.tag, name.name);
        EXPECT_EQ(names, expected);
      }
    }
  }
}

TEST(MshWriter, ShortVersionNamesAndTheDefaultMeanWhatTheySay) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(sample_parts());
  const Folder folder;
  const auto head = [&](const std::string& version) {
    write(mesh, folder / "a.msh", {.binary = false, .version = version});
    return contents(folder / "a.msh").substr(0, 24);
  };
  EXPECT_EQ(head(""), "$MeshFormat\n4.1 0 8\n$End");
  EXPECT_EQ(head("4"), head("4.1"));
  EXPECT_EQ(head("2"), "$MeshFormat\n2.2 0 8\n$End");
  EXPECT_EQ(head("2"), head("2.2"));
  testing::create(folder / "a.msh", "old");
  try {
    write(mesh, folder / "a.msh", {.version = "3.0"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
  }
  EXPECT_EQ(contents(folder / "a.msh"), "old");
}

TEST(MshWriter, TextIsWhatTheFormatSays) {
  const mesh::PrismMeshParts all = testing::plain_parts(1, 1, 1);
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(all);
  const auto& t = mesh.planar().triangles();
  const auto row = [&](std::size_t i, std::int64_t add) {
    return std::to_string(t[i][0] + add) + " " + std::to_string(t[i][1] + add) + " " + std::to_string(t[i][2] + add);
  };
  const Folder folder;
  write(mesh, folder / "a.msh", {.binary = false, .unit = LengthUnit::millimetre, .version = {}});
  const std::string text = contents(folder / "a.msh");
  EXPECT_EQ(text.substr(0, text.find("$Elements")),
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"f\"\n3 1 \"v\"\n$EndPhysicalNames\n"
            "$Entities\n0 0 1 1 \n1 0 0 0 1 1 0.1 1 1 0 \n1 0 0 0 1 1 0.1 1 1 0 \n$EndEntities\n"
            "$Nodes\n1 8 1 8 \n3 1 0 8 \n1\n2\n3\n4\n5\n6\n7\n8\n"
            "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 0.1\n1 0 0.1\n0 1 0.1\n1 1 0.1\n$EndNodes\n");
  EXPECT_NE(text.find("$Elements\n3 10 1 10 \n2 1 2 4 \n"), std::string::npos) << text;
  EXPECT_NE(
      text.find("3 1 6 2 \n9 " + row(0, 1) + " " + row(0, 5) + "\n10 " + row(1, 1) + " " + row(1, 5) + "\n$EndElements\n"),
      std::string::npos);
  write(mesh, folder / "b.msh", {.binary = false, .unit = LengthUnit::millimetre, .version = "2.2"});
  const std::string old = contents(folder / "b.msh");
  EXPECT_NE(old.find("$Nodes\n8\n1 0 0 0\n2 1 0 0\n"), std::string::npos) << old;
  EXPECT_NE(old.find("\n9 6 2 1 1 " + row(0, 1) + " " + row(0, 5) + "\n"), std::string::npos) << old;
}

TEST(MshWriter, BinarySizesAreThePromisedOnes) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::plain_parts(1, 1, 1));
  const Folder folder;
  write(mesh, folder / "a.msh", {.version = "2.2"});
  // Header 12+8+5+15, names 15+2+8+8+18, nodes 7+2+8*28+11, elements 10+3+3*12+4*(12+12)+4*(12+16)+2*36+14.
  EXPECT_EQ(contents(folder / "a.msh").size(), 40u + 51u + 244u + 343u);
}

TEST(MshWriter, MeshesBeyond32BitsAreRefusedByVersion2WithASentence) {
  mesh::PrismMeshParts parts = testing::plain_parts(20, 20, 1);
  std::vector<double> z_m(2'700'001);
  for (std::size_t k = 0; k < z_m.size(); ++k) z_m[k] = static_cast<double>(k) * 1e-9;
  parts.plan = mesh::LayerPlan::from_parts({std::move(z_m), std::vector<std::int32_t>(2'700'000, 0)});
  for (mesh::Cap& cap : parts.caps) cap.level = cap.level == 1 ? 2'700'000 : 0;
  parts.volume_tags[0].num_prisms = 2'700'000LL * 800;
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(parts);
  ASSERT_GT(mesh.num_prisms(), std::numeric_limits<std::int32_t>::max());
  const Folder folder;
  try {
    write(mesh, folder / "a.msh", {.version = "2.2"});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::format_limit) << error.what();
    EXPECT_NE(error.text().find("4.1"), std::string::npos);
  }
  EXPECT_EQ(folder.num_files(), 0u);
}

TEST(MshWriter, CancellingLeavesTheOldFileAlone) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::plain_parts(100, 100, 20));
  for (const Variant& variant : variants) {
    const Folder folder;
    testing::create(folder / "a.msh", "old");
    std::atomic<bool> cancel = false;
    const Progress progress([&](std::string_view, double done) { cancel = cancel || done > 0.5; }, &cancel);
    try {
      write(mesh, folder / "a.msh", {.binary = variant.binary, .version = variant.version}, progress);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    EXPECT_EQ(contents(folder / "a.msh"), "old");
    EXPECT_EQ(folder.num_files(), 1u);
  }
}

TEST(MshWriter, ATagTableThatLiesIsOurBugNotABadFile) {
  mesh::PrismMeshParts parts = sample_parts();
  ++parts.volume_tags[2].num_prisms;
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(parts);
  const Folder folder;
  EXPECT_THROW(write(mesh, folder / "a.msh", {}), Error);
  EXPECT_EQ(folder.num_files(), 0u);
}

TEST(GroupNames, AreShortCleanAndDistinct) {
  const std::string long_a = std::string(130, 'x') + "a", long_b = std::string(130, 'x') + "b";
  const std::string umlauts = "u" + [] {
    std::string text;
    for (int i = 0; i < 100; ++i) text += "\xC3\xBC";
    return text;
  }();
  const std::vector<std::string> names{long_a, long_b, "a\"b", "a'b", "line\nbreak", "", "bad\xFFutf", umlauts, "same", "same"};
  const std::vector<std::string> out = mesh::group_names(names);
  EXPECT_EQ(std::set<std::string>(out.begin(), out.end()).size(), names.size());
  for (const std::string& name : out) EXPECT_LE(name.size(), mesh::max_name_bytes);
  EXPECT_EQ(out[0], std::string(125, 'x') + "~1");
  EXPECT_EQ(out[1], std::string(125, 'x') + "~2");
  EXPECT_EQ(out[2], "a'b~3") << "the name that needs no change keeps it";
  EXPECT_EQ(out[3], "a'b");
  EXPECT_EQ(out[4], "line break");
  EXPECT_EQ(out[5], "unnamed");
  EXPECT_EQ(out[6], "bad?utf");
  EXPECT_EQ(out[7], umlauts.substr(0, 125) + "~8");
  EXPECT_EQ(out[8], "same");
  EXPECT_EQ(out[9], "same~10");
  EXPECT_EQ(mesh::group_names(out), out);
}

}  // namespace
}  // namespace pcbmesh::formats
