// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "folder.hpp"
#include "formats/vtu/format.hpp"
#include "pcbmesh/base/error.hpp"
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

/// One appended array, found by name the way a reader does.
template <class T>
std::vector<T> array_of(const std::string& file, const std::string& name) {
  const std::size_t tag = file.find("Name=\"" + name + "\""), offset_at = file.find("offset=\"", tag) + 8;
  const std::size_t offset = std::stoul(file.substr(offset_at)), start = file.find("<AppendedData encoding=\"raw\">\n_") + 31;
  std::uint64_t size = 0;
  std::memcpy(&size, file.data() + start + offset, sizeof size);
  std::vector<T> values(size / sizeof(T));
  std::memcpy(values.data(), file.data() + start + offset + sizeof size, size);
  return values;
}

TEST(VtuWriter, HoldsEveryPrismInTheSourcesOrderWithItsTags) {
  for (const bool with_voids : {true, false}) {
    const mesh::PrismMeshParts parts = testing::sample_parts(with_voids);
    const testing::ExplicitMesh expected = testing::spell_out(parts.planar, parts.plan, parts.column_tags);
    mesh::PrismSource source(mesh::PrismMesh::from_parts(parts), quality);
    const Folder folder;
    write_mesh(source, folder / "a.vtu", {.unit = LengthUnit::millimetre, .version = {}});
    EXPECT_EQ(folder.num_files(), 1u);
    const std::string file = contents(folder / "a.vtu");
    const auto points = array_of<double>(file, "Points");
    ASSERT_EQ(points.size(), expected.nodes.size() * 3);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i], expected.nodes[i / 3][i % 3] * 1e3);
    const auto corners = array_of<std::int32_t>(file, "connectivity"), ends = array_of<std::int32_t>(file, "offsets");
    const auto types = array_of<std::uint8_t>(file, "types");
    const auto tags = array_of<std::int32_t>(file, "volume_tag"), layers = array_of<std::int32_t>(file, "layer"),
               materials = array_of<std::int32_t>(file, "material"), nets = array_of<std::int32_t>(file, "net"),
               regions = array_of<std::int32_t>(file, "region");
    const auto qualities = array_of<float>(file, "quality");
    ASSERT_EQ(corners.size(), expected.prisms.size() * 6);
    ASSERT_EQ(qualities.size(), expected.prisms.size());
    std::size_t cell = 0;
    for (std::size_t b = 0; b < source.blocks().size(); ++b) {
      if (source.blocks()[b].kind != mesh::ElementKind::wedge) continue;
      const mesh::VolumeTag& tag = parts.volume_tags[static_cast<std::size_t>(source.blocks()[b].tag - 1)];
      std::vector<double> region_of, quality_of;
      source.visit_field(b, mesh::CellField::region, [&](auto v) { region_of.insert(region_of.end(), v.begin(), v.end()); });
      source.visit_field(b, mesh::CellField::quality, [&](auto v) { quality_of.insert(quality_of.end(), v.begin(), v.end()); });
      std::size_t in_block = 0;
      source.visit(b, [&](std::span<const std::int64_t> rows) {
        for (std::size_t at = 0; at < rows.size(); at += 6, ++cell, ++in_block) {
          constexpr std::size_t legacy[] = {0, 2, 1, 3, 5, 4};
          for (std::size_t k = 0; k < 6; ++k) ASSERT_EQ(corners[6 * cell + k], rows[at + legacy[k]]);
          ASSERT_EQ(ends[cell], static_cast<std::int32_t>(6 * (cell + 1)));
          ASSERT_EQ(types[cell], 13);
          ASSERT_EQ(std::tuple(tags[cell], layers[cell], materials[cell], nets[cell]),
                    std::tuple(tag.id, tag.layer, tag.material, tag.net));
          ASSERT_EQ(regions[cell], region_of[in_block]);
          ASSERT_EQ(qualities[cell], static_cast<float>(quality_of[in_block]));
        }
      });
    }
    EXPECT_EQ(cell, expected.prisms.size());
    EXPECT_TRUE(file.ends_with("\n </AppendedData>\n</VTKFile>\n"));
  }
}

struct Variant {
  const char* name;
  WriteMeshOptions options;
};

std::vector<Variant> variants() {
  std::vector<Variant> out;
  for (const Compression compression : {Compression::none, Compression::zlib, Compression::lz4})
    for (const bool base64 : {false, true})
      for (const int bits : {32, 64}) {
        WriteMeshOptions options;
        options.compression = compression;
        options.base64 = base64;
        options.index_bits = bits;
        out.push_back({"binary", options});
      }
  WriteMeshOptions text;
  text.binary = false;
  out.push_back({"text", text});
  for (Variant& variant : out) {
    variant.options.faces = true;
    variant.options.unit = LengthUnit::millimetre;
  }
  out.push_back(out.front());
  out.back().options.vtk_wedge = VtkWedge::parametric;
  return out;
}

TEST(VtuWriter, EveryVariantReadsBackExactly) {
  for (const bool with_voids : {true, false}) {
    mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts(with_voids)), quality);
    for (const Variant& variant : variants()) {
      SCOPED_TRACE(::testing::Message() << variant.name << " compression " << static_cast<int>(variant.options.compression)
                                        << " base64 " << variant.options.base64 << " bits " << variant.options.index_bits);
      const Folder folder;
      write_mesh(source, folder / "a.vtu", variant.options);
      testing::expect_same_mesh(source, read_mesh(folder / "a.vtu"), 1e3, {.names = true});
    }
  }
}

TEST(VtuWriter, PackedFilesAreTheSameForAnyNumberOfThreads) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(100, 100, 20)));
  const Folder folder;
  WriteMeshOptions options;
  options.compression = Compression::zlib;
  write_mesh(source, folder / "a.vtu", options);
  options.num_threads = 3;
  write_mesh(source, folder / "b.vtu", options);
  EXPECT_TRUE(contents(folder / "a.vtu") == contents(folder / "b.vtu"));
  testing::expect_same_mesh(source, read_mesh(folder / "b.vtu"), 1, {.faces = false});
}

TEST(VtuWriter, PartsHoldEveryCellOnceAndNoNodeTooMany) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::sample_parts()), quality);
  const Folder folder;
  WriteMeshOptions options;
  options.num_parts = 3;
  options.faces = true;
  write_mesh(source, folder / "a.pvtu", options);
  std::int64_t cells = 0, faces = 0;
  for (const char* name : {"a_pvtu/0.vtu", "a_pvtu/1.vtu", "a_pvtu/2.vtu"}) {
    const mesh::MeshData part = read_mesh(folder / name);
    std::vector<bool> used(part.nodes.size(), false);
    for (const mesh::CellBlock& block : part.cells) {
      cells += block.size();
      for (const std::int64_t node : block.corners) used[static_cast<std::size_t>(node)] = true;
    }
    for (const mesh::FaceBlock& block : part.faces) {
      faces += block.size();
      for (const std::int64_t node : block.corners) used[static_cast<std::size_t>(node)] = true;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << name;
  }
  EXPECT_EQ(cells, source.num_elements(3));
  EXPECT_EQ(faces, source.num_elements(2));
  const std::string list = contents(folder / "a.pvtu");
  EXPECT_NE(list.find("<Piece Source=\"a_pvtu/2.vtu\"/>"), std::string::npos) << list;
  // Fewer parts leave none of the old ones behind; what is not ours stays.
  options.num_parts = 2;
  write_mesh(source, folder / "a.pvtu", options);
  EXPECT_FALSE(std::filesystem::exists(folder / "a_pvtu/2.vtu"));
  testing::create(folder / "a_pvtu/notes.txt", "precious");
  EXPECT_EQ(error_of([&] { write_mesh(source, folder / "a.pvtu", options); }).code(), ErrorCode::write_failed);
  EXPECT_TRUE(std::filesystem::exists(folder / "a_pvtu/1.vtu"));
}

TEST(VtuWriter, BlocksAreNamedLikeTheGroupsAndHoldTheirElements) {
  mesh::PrismMeshParts parts = testing::sample_parts();
  parts.volume_tags[0].name = "a<b & \"c\"";
  mesh::PrismSource source(mesh::PrismMesh::from_parts(parts));
  const Folder folder;
  write_mesh(source, folder / "a.vtm", {});
  const std::string list = contents(folder / "a.vtm");
  EXPECT_NE(list.find("name=\"a&lt;b &amp; 'c'\" file=\"a_vtm/volume_1.vtu\""), std::string::npos) << list;
  for (const mesh::ElementGroup& group : source.groups()) {
    if (group.num_elements == 0) continue;
    const mesh::MeshData block = read_mesh(
        folder / ("a_vtm/" + std::string(group.dimension == 3 ? "volume_" : "face_") + std::to_string(group.tag) + ".vtu"));
    std::int64_t count = 0;
    for (const mesh::CellBlock& cells : block.cells) {
      count += cells.size();
      for (const std::int32_t tag : cells.tags) EXPECT_EQ(tag, group.tag);
    }
    for (const mesh::FaceBlock& faces : block.faces) {
      count += faces.size();
      for (const std::int32_t tag : faces.tags) EXPECT_EQ(tag, group.tag);
    }
    EXPECT_EQ(count, group.num_elements) << group.name;
  }
}

TEST(VtuReader, AFileCutAnywhereIsRefusedWithAPlace) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(2, 1, 1)));
  const std::vector<Variant> all = variants();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Variant& variant = all[i];
    const Folder folder;
    write_mesh(source, folder / "a.vtu", variant.options);
    const std::string whole = contents(folder / "a.vtu");
    // The last line end is nobody's loss.
    const std::size_t last = whole.size() - 1;
    for (std::size_t size = 0; size < last; size += i == 0 ? 1 : 23) {
      testing::create(folder / "a.vtu", whole.substr(0, size));
      const Error error = error_of([&] { static_cast<void>(read_mesh(folder / "a.vtu")); });
      ASSERT_TRUE(error.code() == ErrorCode::file_truncated || error.code() == ErrorCode::file_syntax) << size << error.what();
      ASSERT_TRUE(size == 0 || error.spot().byte >= 0) << size << ": " << error.what();
    }
  }
}

TEST(VtuReader, DamagedBytesNeverCrashNorEatMemory) {
  mesh::PrismSource source(mesh::PrismMesh::from_parts(testing::plain_parts(2, 1, 1)));
  std::mt19937 random(11);
  for (const Variant& variant : variants()) {
    const Folder folder;
    write_mesh(source, folder / "a.vtu", variant.options);
    const std::string whole = contents(folder / "a.vtu");
    for (int run = 0; run < 100; ++run) {
      std::string bytes = whole;
      for (int flips = 1 + static_cast<int>(random() % 3); flips > 0; --flips)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      testing::create(folder / "a.vtu", bytes);
      try {
        static_cast<void>(read_mesh(folder / "a.vtu"));
      } catch (const Error& error) {
        ASSERT_NE(error.code(), ErrorCode::internal) << error.what();
      }
    }
  }
}

TEST(VtuReader, SaysWhatIsWrong) {
  const Folder folder;
  const auto text_of = [&](const std::string& from, const std::string& to) {
    std::string file =
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">"
        "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points>"
        "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
        "1</DataArray></Points><Cells>"
        "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
        "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
        "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
    if (!from.empty()) file.replace(file.find(from), from.size(), to);
    testing::create(folder / "a.vtu", file);
    return error_of([&] {
             static_cast<void>(read_mesh(folder / "a.vtu"));
             throw Error(ErrorCode::usage, "good");
           })
        .text();
  };
  EXPECT_EQ(text_of("", ""), "good");
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& said) {
    EXPECT_NE(text_of(from, to).find(said), std::string::npos) << text_of(from, to);
  };
  expect("0 1 2 3<", "0 1 2 4<", "refers to node 4, but there are 4 nodes");
  expect("0 1 2 3<", "0 1 2 -1<", "refers to node -1");
  expect(">4<", ">3<", "has 4 values where 3 are expected");
  expect(">10<", ">42<", "VTK type 42, which is not read");
  expect(">10<", ">24<", "has 4 corners");
  expect("LittleEndian", "BigEndian", "big-endian");
  expect("NumberOfPoints=\"4\"", "NumberOfPoints=\"99999999999\"", "more than the file can hold");
  expect("NumberOfCells=\"1\"", "NumberOfCells=\"-1\"", "no sensible count");
  expect("UnstructuredGrid\" v", "PolyData\" v", "no VTK unstructured grid");
  expect("1 0 0 0 1 0", "1 0 0 0 x 0", "value 7 is no number");
  expect("<VTKFile", "<!DOCTYPE a [<!ENTITY b \"c\">]><VTKFile", "declares entities");
}

}  // namespace
}  // namespace pcbmesh::formats
