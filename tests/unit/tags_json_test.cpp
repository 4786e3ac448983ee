// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/tags_json/tags_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "folder.hpp"
#include "pcbmesh/base/error.hpp"
#include "sample_prism_mesh.hpp"

namespace pcbmesh::formats {
namespace {

using nlohmann::json;
using testing::Folder;

json written(const mesh::PrismMeshParts& parts, LengthUnit unit = LengthUnit::metre) {
  const Folder folder;
  tags_json::write_tags(mesh::PrismMesh::from_parts(parts), folder / "a.tags.json", unit);
  EXPECT_EQ(folder.num_files(), 1u);
  return json::parse(testing::contents(folder / "a.tags.json"));
}

TEST(TagsJson, SaysWhatEveryTagMeans) {
  const mesh::PrismMeshParts parts = testing::sample_parts();
  const json out = written(parts, LengthUnit::millimetre);
  EXPECT_EQ(out["schema_version"], 1);
  EXPECT_EQ(out["unit_m"], 1e-3);
  ASSERT_EQ(out["volumes"].size(), parts.volume_tags.size());
  for (std::size_t i = 0; i < parts.volume_tags.size(); ++i) {
    const mesh::VolumeTag& tag = parts.volume_tags[i];
    EXPECT_EQ(out["volumes"][i]["id"], tag.id);
    EXPECT_EQ(out["volumes"][i]["name"], tag.name);
    EXPECT_EQ(out["volumes"][i]["num_cells"], tag.num_prisms);
    EXPECT_EQ(out["volumes"][i]["volume_m3"], tag.volume_m3) << "not a digit is lost";
  }
  EXPECT_EQ(out["volumes"][1]["layer"], "bottom");
  EXPECT_EQ(out["volumes"][1]["material"], "copper");
  EXPECT_EQ(out["volumes"][1]["net"], "GND");
  EXPECT_EQ(out["volumes"][1]["conductor"], true);
  EXPECT_EQ(out["volumes"][0]["net"], nullptr);
  EXPECT_EQ(out["volumes"][0]["conductor"], false);
  ASSERT_EQ(out["faces"].size(), 4u);
  EXPECT_EQ(out["faces"][3]["kind"], "conductor");
  EXPECT_EQ(out["faces"][3]["net"], "hollow");
  EXPECT_EQ(out["faces"][2]["kind"], "outer");
  EXPECT_EQ(out["faces"][2]["net"], nullptr);
  EXPECT_EQ(out["faces"][2]["num_faces"], parts.face_tags[2].num_triangles + parts.face_tags[2].num_quads);
  EXPECT_EQ(out["faces"][2]["area_m2"], parts.face_tags[2].area_m2);
  EXPECT_EQ(out["materials"][1]["sigma_s_per_m"], 5.8e7);
  ASSERT_EQ(out["nets"].size(), 3U) << "nets with copper cells or skins";
  EXPECT_EQ(out["nets"][0]["name"], "GND");
  EXPECT_EQ(out["nets"][0]["pieces"], 2);
  EXPECT_EQ(out["nets"][0]["volume_m3"], parts.volume_tags[1].volume_m3);
  EXPECT_EQ(out["nets"][1]["pieces"], nullptr) << "not known";
  EXPECT_EQ(out["nets"][2]["name"], "hollow");
  EXPECT_EQ(out["nets"][2]["num_cells"], 0);
  EXPECT_EQ(out["nets"][2]["area_m2"], parts.face_tags[3].area_m2);
  EXPECT_EQ(out["materials"][0]["model"]["kind"], "constant");
  EXPECT_EQ(out["materials"][0]["assumed"], false);
  EXPECT_EQ(out["touching_nets"], json::parse(R"([["GND","/clk+"]])"));
  EXPECT_EQ(out["bounding_box_m"]["max"][1], 4 * 7e-4);
}

TEST(TagsJson, CopperWithoutNetConductsAndStrangeNamesSurvive) {
  mesh::PrismMeshParts parts = testing::sample_parts();
  parts.volume_tags[1].net = -1;
  parts.nets[1] = "bad\xFF\"name";
  parts.volume_tags[4].name = std::string(200, 'n');
  const json out = written(parts);
  EXPECT_EQ(out["volumes"][1]["conductor"], true);
  EXPECT_EQ(out["volumes"][3]["net"], "bad\xEF\xBF\xBD\"name");
  EXPECT_EQ(out["volumes"][4]["name"], std::string(125, 'n') + "~5") << "spelt as in the mesh file";
}

/// Keys of an object and of the objects in its arrays, as "volumes[].id".
std::set<std::string> keys_of(const json& value, const std::string& path = "") {
  std::set<std::string> keys;
  if (value.is_array())
    for (const json& item : value) keys.merge(keys_of(item, path + "[]"));
  if (!value.is_object()) return keys;
  for (const auto& [key, item] : value.items()) {
    keys.insert(path + "." + key);
    keys.merge(keys_of(item, path + "." + key));
  }
  return keys;
}

/// The same from the schema's properties.
std::set<std::string> schema_keys_of(const json& schema, const std::string& path = "") {
  std::set<std::string> keys;
  if (schema.contains("items")) keys.merge(schema_keys_of(schema["items"], path + "[]"));
  if (!schema.contains("properties")) return keys;
  EXPECT_EQ(schema["additionalProperties"], false) << path;
  EXPECT_EQ(schema["required"].size(), schema["properties"].size()) << path;
  for (const auto& [key, item] : schema["properties"].items()) {
    keys.insert(path + "." + key);
    keys.merge(schema_keys_of(item, path + "." + key));
  }
  return keys;
}

TEST(TagsJson, ThePublishedSchemaNamesEveryKey) {
  const json schema =
      json::parse(testing::contents(std::filesystem::path(PCBMESH_SOURCE_DIR) / "docs/schema/tags.schema.json"));
  mesh::PrismMeshParts parts = testing::sample_parts();
  parts.ports = {{.name = "P1", .positive_net = 1, .negative_net = 0}};
  parts.net_pieces[1] = 1;
  parts.shell = mesh::Shell{};
  parts.materials[0].dispersion = {.kind = DispersionKind::debye, .eps_inf = 3, .poles = {{1, 1e9}}};
  EXPECT_EQ(schema_keys_of(schema), keys_of(written(parts)));
}

}  // namespace
}  // namespace pcbmesh::formats
