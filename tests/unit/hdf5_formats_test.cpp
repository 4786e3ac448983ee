// SPDX-License-Identifier: GPL-3.0-or-later
// VTKHDF, XDMF and the native mesh: written, read back, damaged.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>

#include "folder.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/native_mesh.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/mesh/prism_source.hpp"
#include "same_mesh.hpp"
#include "sample_prism_mesh.hpp"
#include "thrown_error.hpp"

namespace pcbmesh::formats {
namespace {

using testing::contents;
using testing::error_of;
using testing::Folder;

void quality(std::span<const mesh::PrismBase> bases, double height, std::span<double> qualities) {
  for (std::size_t i = 0; i < bases.size(); ++i) {
    const auto [area, beta] = bases[i];
    qualities[i] = area * height / beta;
  }
}

/// False, with a word, in a build without the library.
bool has_hdf5() {
  const Folder folder;
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(1, 1, 1)));
  try {
    write_mesh(source, folder / "a.vtkhdf", {});
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::format_not_built);
    EXPECT_NE(error.text().find("PCBMESH_WITH_HDF5"), std::string::npos);
    return false;
  }
}
#define SKIP_WITHOUT_HDF5() \
  if (!has_hdf5()) GTEST_SKIP() << "this build has no HDF5"

WriteMeshOptions packed(int num_threads) {
  WriteMeshOptions options;
  options.compression = Compression::zlib;
  options.num_threads = num_threads;
  return options;
}

class Hdf5Formats : public ::testing::TestWithParam<const char*> {};

TEST_P(Hdf5Formats, ReadBackExactly) {
  SKIP_WITHOUT_HDF5();
  for (const bool with_voids : {true, false}) {
    mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts(with_voids)), quality);
    for (WriteMeshOptions options : {WriteMeshOptions{}, packed(2)}) {
      for (const int bits : {32, 64}) {
        options.index_bits = bits;
        const Folder folder;
        const auto file = folder / (std::string("a") + GetParam());
        write_mesh(source, file, options);
        const bool has_faces = std::string(GetParam()) != ".xdmf";
        testing::expect_same_mesh(source, read_mesh(file), 1, {.faces = has_faces, .names = true});
        if (has_faces) continue;
        testing::expect_same_mesh(source, read_mesh(folder / "a_paraview.xdmf"), 1, {.faces = true, .names = true});
      }
    }
  }
}

TEST_P(Hdf5Formats, TheSameMeshGivesTheSameBytesForAnyNumberOfThreads) {
  SKIP_WITHOUT_HDF5();
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(90, 90, 20)), quality);
  const Folder folder;
  const std::string ending = GetParam(), heavy = ending == ".xdmf" ? ".vtkhdf" : ending;
  write_mesh(source, folder / ("a" + ending), packed(1));
  const std::string first = contents(folder / ("a" + heavy));
  for (const int num_threads : {1, 3}) {
    write_mesh(source, folder / ("a" + ending), packed(num_threads));
    EXPECT_TRUE(contents(folder / ("a" + heavy)) == first) << num_threads << " threads";
  }
  testing::expect_same_mesh(source, read_mesh(folder / ("a" + heavy)), 1, {});
}

TEST_P(Hdf5Formats, CancellingLeavesTheOldFileAlone) {
  SKIP_WITHOUT_HDF5();
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(100, 100, 20)), quality);
  const std::string ending = GetParam();
  if (ending == ".pcbmesh") GTEST_SKIP() << "too small to be cancelled half way";
  const std::string heavy = ending == ".xdmf" ? ".vtkhdf" : ending;
  for (const WriteMeshOptions& options : {WriteMeshOptions{}, packed(2)}) {
    const Folder folder;
    testing::create(folder / ("a" + heavy), "old");
    std::atomic<bool> cancel = false;
    const Progress progress([&](std::string_view, double done) { cancel = cancel || done > 0.4; }, &cancel);
    const Error error = error_of([&] { write_mesh(source, folder / ("a" + ending), options, {}, progress); });
    EXPECT_EQ(error.code(), ErrorCode::cancelled) << error.what();
    EXPECT_EQ(contents(folder / ("a" + heavy)), "old");
    EXPECT_EQ(folder.num_files(), 1u);
  }
}

TEST_P(Hdf5Formats, AFileCutAnywhereIsRefused) {
  SKIP_WITHOUT_HDF5();
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(2, 1, 1)));
  const Folder folder;
  const std::string ending = GetParam(), heavy = ending == ".xdmf" ? ".vtkhdf" : ending;
  write_mesh(source, folder / ("a" + ending), {});
  const std::string whole = contents(folder / ("a" + heavy));
  for (std::size_t size = 0; size < whole.size(); size += 37) {
    testing::create(folder / ("a" + heavy), whole.substr(0, size));
    const Error error = error_of([&] { static_cast<void>(read_mesh(folder / ("a" + ending))); });
    ASSERT_TRUE(error.code() == ErrorCode::file_truncated || error.code() == ErrorCode::file_syntax) << size << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Hdf5Formats, ::testing::Values(".vtkhdf", ".xdmf", ".pcbmesh"),
                         [](const auto& ending) { return std::string(ending.param).substr(1); });

void expect_equal(const mesh::PrismMesh& a, const mesh::PrismMesh& b) {
  const auto same = [](const auto& x, const auto& y) { return std::ranges::equal(x, y); };
  EXPECT_TRUE(same(a.planar().points_m(), b.planar().points_m()) && same(a.planar().triangles(), b.planar().triangles()));
  EXPECT_TRUE(same(a.planar().regions(), b.planar().regions()) && same(a.planar().constrained(), b.planar().constrained()));
  ASSERT_EQ(a.planar().num_regions(), b.planar().num_regions());
  for (std::int32_t r = 0; r < a.planar().num_regions(); ++r)
    EXPECT_TRUE(same(a.planar().bodies_of_region(r), b.planar().bodies_of_region(r)));
  EXPECT_TRUE(same(a.plan().z_m(), b.plan().z_m()) && same(a.plan().slab_of_sublayer(), b.plan().slab_of_sublayer()));
  EXPECT_TRUE(same(a.layers(), b.layers()) && same(a.materials(), b.materials()) && same(a.nets(), b.nets()));
  EXPECT_TRUE(same(a.net_pieces(), b.net_pieces()) && same(a.touching_nets(), b.touching_nets()));
  for (std::int32_t s = 0; s < a.plan().num_slabs(); ++s)
    for (std::int32_t t = 0; t < a.planar().num_triangles(); ++t) ASSERT_EQ(a.tag_of(s, t), b.tag_of(s, t));
  ASSERT_EQ(a.volume_tags().size(), b.volume_tags().size());
  for (std::size_t i = 0; i < a.volume_tags().size(); ++i) {
    const mesh::VolumeTag &x = a.volume_tags()[i], &y = b.volume_tags()[i];
    EXPECT_EQ(std::tie(x.id, x.name, x.layer, x.material, x.net, x.stretched, x.num_prisms, x.volume_m3),
              std::tie(y.id, y.name, y.layer, y.material, y.net, y.stretched, y.num_prisms, y.volume_m3));
  }
  ASSERT_EQ(a.face_tags().size(), b.face_tags().size());
  for (std::size_t i = 0; i < a.face_tags().size(); ++i) {
    const mesh::FaceTag &x = a.face_tags()[i], &y = b.face_tags()[i];
    EXPECT_EQ(std::tie(x.id, x.name, x.kind, x.net, x.is_inner, x.condition, x.impedance_ohm, x.material, x.thickness_m, x.port,
                       x.partner, x.num_triangles, x.num_quads, x.area_m2),
              std::tie(y.id, y.name, y.kind, y.net, y.is_inner, y.condition, y.impedance_ohm, y.material, y.thickness_m, y.port,
                       y.partner, y.num_triangles, y.num_quads, y.area_m2));
  }
  ASSERT_EQ(a.shell().has_value(), b.shell().has_value());
  if (a.shell()) {
    EXPECT_EQ(a.shell()->inner_min_m, b.shell()->inner_min_m);
    EXPECT_EQ(a.shell()->outer_max_m, b.shell()->outer_max_m);
    EXPECT_EQ(a.shell()->order, b.shell()->order);
  }
  ASSERT_EQ(a.ports().size(), b.ports().size());
  for (std::size_t i = 0; i < a.ports().size(); ++i) {
    const mesh::Port &x = a.ports()[i], &y = b.ports()[i];
    EXPECT_EQ(std::tie(x.name, x.kind, x.impedance_ohm, x.is_excited, x.direction, x.length_m, x.width_m, x.positive_net,
                       x.negative_net, x.at_m),
              std::tie(y.name, y.kind, y.impedance_ohm, y.is_excited, y.direction, y.length_m, y.width_m, y.positive_net,
                       y.negative_net, y.at_m));
  }
  const auto key = [](const mesh::Cap& c) { return std::tuple(c.tag, c.level, c.triangle, c.up); };
  EXPECT_TRUE(std::ranges::equal(a.caps(), b.caps(), {}, key, key));
  const auto wall_key = [](const mesh::Wall& w) { return std::tuple(w.tag, w.slab, w.a, w.b); };
  EXPECT_TRUE(std::ranges::equal(a.walls(), b.walls(), {}, wall_key, wall_key));
}

TEST(NativeMesh, ComesBackEqual) {
  SKIP_WITHOUT_HDF5();
  for (const bool with_voids : {true, false}) {
    mesh::PrismMeshParts parts = testing::sample_parts(with_voids);
    parts.ports = {{.name = "p1",
                    .kind = mesh::PortKind::wave,
                    .impedance_ohm = 75,
                    .is_excited = false,
                    .direction = {0, 1, 0},
                    .length_m = 1e-3,
                    .width_m = 2e-3,
                    .positive_net = 1,
                    .negative_net = 0,
                    .at_m = {1, 2, 3}},
                   {.name = "p2", .kind = mesh::PortKind::coaxial, .direction = {0, 0, 0}},
                   {.name = "p3"}};
    parts.face_tags[1].condition = mesh::BoundaryCondition::port;
    parts.face_tags[1].port = 0;
    parts.face_tags[2].condition = mesh::BoundaryCondition::impedance;
    parts.face_tags[2].impedance_ohm = 377;
    parts.face_tags[0].material = 1;
    parts.face_tags[0].thickness_m = 35e-6;
    parts.volume_tags[0].stretched = 5;
    parts.shell = mesh::Shell{{1, 2, 3}, {4, 5, 6}, {0, 1, 2}, {5, 6, 7}, 3};
    const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(parts);
    const Folder folder;
    write_mesh(mesh, folder / "a.pcbmesh", {.unit = LengthUnit::millimetre, .version = {}});
    expect_equal(mesh, read_prism_mesh(folder / "a.pcbmesh"));
  }
}

TEST(NativeMesh, TakesTwoBytesPerPrismAtMost) {
  SKIP_WITHOUT_HDF5();
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::plain_parts(200, 200, 20));
  const Folder folder;
  write_mesh(mesh, folder / "a.pcbmesh", {});
  EXPECT_LE(contents(folder / "a.pcbmesh").size(), 2 * static_cast<std::size_t>(mesh.num_prisms()));
}

TEST(NativeMesh, ContradictionsAndForeignFilesAreFaultsOfTheFile) {
  SKIP_WITHOUT_HDF5();
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::sample_parts());
  const Folder folder;
  mesh::PrismMeshParts lying = testing::sample_parts();
  ++lying.volume_tags[2].num_prisms;
  write_mesh(mesh::PrismMesh::from_parts(lying), folder / "a.pcbmesh", {});
  const Error count = error_of([&] { static_cast<void>(read_prism_mesh(folder / "a.pcbmesh")); });
  EXPECT_EQ(count.code(), ErrorCode::file_syntax) << count.what();
  EXPECT_NE(count.text().find("volume 3"), std::string::npos) << count.what();
  write_mesh(mesh, folder / "a.vtkhdf", {});
  std::filesystem::rename(folder / "a.vtkhdf", folder / "b.pcbmesh");
  const Error foreign = error_of([&] { static_cast<void>(read_prism_mesh(folder / "b.pcbmesh")); });
  EXPECT_EQ(foreign.code(), ErrorCode::file_syntax) << foreign.what();
  testing::create(folder / "c.pcbmesh", "not HDF5 at all, but long enough");
  const Error text = error_of([&] { static_cast<void>(read_prism_mesh(folder / "c.pcbmesh")); });
  EXPECT_EQ(text.code(), ErrorCode::file_syntax) << text.what();
}

TEST(Xdmf, SaysWhatIsWrong) {
  SKIP_WITHOUT_HDF5();
  const Folder folder;
  const auto text_of = [&](const std::string& from, const std::string& to) {
    std::string file =
        "<Xdmf Version=\"3.0\"><Domain><Grid GridType=\"Uniform\"><Geometry GeometryType=\"XYZ\">"
        "<DataItem Dimensions=\"4 3\" Format=\"XML\">0 0 0 1 0 0 0 1 0 0 0 1</DataItem></Geometry>"
        "<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"1\"><DataItem Dimensions=\"1 4\" Format=\"XML\">0 1 2 3"
        "</DataItem></Topology><Attribute Name=\"volume_tag\" Center=\"Cell\"><DataItem Dimensions=\"1\" "
        "Format=\"XML\">7</DataItem>"
        "</Attribute></Grid></Domain></Xdmf>";
    if (!from.empty()) file.replace(file.find(from), from.size(), to);
    testing::create(folder / "a.xdmf", file);
    return error_of([&] {
             const mesh::MeshData mesh = read_mesh(folder / "a.xdmf");
             throw Error(ErrorCode::usage, mesh.cells.at(0).tags.at(0) == 7 ? "good" : "bad");
           })
        .text();
  };
  EXPECT_EQ(text_of("", ""), "good");
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& said) {
    EXPECT_NE(text_of(from, to).find(said), std::string::npos) << text_of(from, to);
  };
  expect("0 1 2 3<", "0 1 2 4<", "refers to node 4");
  expect("\"1 4\"", "\"1 5\"", "do not fit the 4 values");
  expect("\"1 4\"", "\"99999999999 99999999999\"", "do not fit the 4 values");
  expect("Tetrahedron", "Octahedron", "'Octahedron' is not read");
  expect("Format=\"XML\">0 1", "Format=\"HDF\">b.h5:/a", "'b.h5' with its numbers is not beside it");
  expect("Format=\"XML\">0 1", "Format=\"Binary\">0 1", "format 'Binary' is not read");
  expect("\"XYZ\"", "\"ORIGIN_DXDYDZ\"", "is not read, only XYZ");
  expect("<Topology ", "<Nothing ", "");
}

}  // namespace
}  // namespace pcbmesh::formats
