// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstring>

#include "folder.hpp"
#include "formats/vtu/format.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::formats {
namespace {

using testing::contents;
using testing::Folder;

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

TEST(VtuWriter, HoldsEveryPrismInIdOrderWithItsTags) {
  for (const bool with_voids : {true, false}) {
    const mesh::PrismMeshParts parts = testing::sample_parts(with_voids);
    const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(parts);
    const testing::ExplicitMesh expected = testing::spell_out(parts.planar, parts.plan, parts.column_tags);
    const Folder folder;
    write_mesh(mesh, folder / "a.vtu", {.unit = LengthUnit::millimetre, .version = {}});
    EXPECT_EQ(folder.num_files(), 1u);
    const std::string file = contents(folder / "a.vtu");
    const auto points = array_of<double>(file, "Points");
    ASSERT_EQ(points.size(), expected.nodes.size() * 3);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(points[i], expected.nodes[i / 3][i % 3] * 1e3);
    const auto corners = array_of<std::int64_t>(file, "connectivity"), ends = array_of<std::int64_t>(file, "offsets");
    const auto types = array_of<std::uint8_t>(file, "types");
    const auto tags = array_of<std::int32_t>(file, "volume_tag"), layers = array_of<std::int32_t>(file, "layer_id"),
               materials = array_of<std::int32_t>(file, "material_id"), nets = array_of<std::int32_t>(file, "net_id");
    ASSERT_EQ(corners.size(), expected.prisms.size() * 6);
    ASSERT_EQ(nets.size(), expected.prisms.size());
    for (std::size_t i = 0; i < expected.prisms.size(); ++i) {
      constexpr std::size_t legacy[] = {0, 2, 1, 3, 5, 4};
      for (std::size_t k = 0; k < 6; ++k) ASSERT_EQ(corners[6 * i + k], expected.prisms[i][legacy[k]]);
      ASSERT_EQ(ends[i], static_cast<std::int64_t>(6 * (i + 1)));
      ASSERT_EQ(types[i], 13);
      const mesh::VolumeTag& tag = parts.volume_tags[static_cast<std::size_t>(expected.tags[i])];
      ASSERT_EQ(std::tuple(tags[i], layers[i], materials[i], nets[i]), std::tuple(tag.id, tag.layer, tag.material, tag.net));
    }
    EXPECT_TRUE(file.ends_with("\n </AppendedData>\n</VTKFile>\n"));
  }
}

TEST(VtuWriter, OptionsMeantForOtherFilesOfTheRunChangeNothing) {
  const mesh::PrismMesh mesh = mesh::PrismMesh::from_parts(testing::plain_parts(1, 1, 1));
  const Folder folder;
  write_mesh(mesh, folder / "a.vtu", {});
  write_mesh(mesh, folder / "b.vtu", {.binary = false, .version = "2.2"});
  EXPECT_EQ(contents(folder / "a.vtu"), contents(folder / "b.vtu"));
}

}  // namespace
}  // namespace pcbmesh::formats
