// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/tags_json/tags_json.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/sink/file_sink.hpp"
#include "formats/tags_json/group_names.hpp"

namespace pcbmesh::formats::tags_json {
namespace {

using Json = nlohmann::ordered_json;

constexpr int schema_version = 1;

Json net_or_null(const mesh::PrismMesh& mesh, std::int32_t net) {
  return net < 0 ? Json(nullptr) : Json(mesh.nets()[static_cast<std::size_t>(net)]);
}

template <class Tags>
std::vector<std::string> names_of(const Tags& tags) {
  std::vector<std::string> names;
  for (const auto& tag : tags) names.push_back(tag.name);
  return group_names(names);
}

Json volumes(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  const std::vector<std::string> names = names_of(mesh.volume_tags());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const mesh::VolumeTag& tag = mesh.volume_tags()[i];
    const board::Material& material = mesh.materials()[static_cast<std::size_t>(tag.material)];
    out.push_back({{"id", tag.id},
                   {"dimension", 3},
                   {"name", names[i]},
                   {"layer", mesh.layers()[static_cast<std::size_t>(tag.layer)]},
                   {"material", material.name},
                   {"net", net_or_null(mesh, tag.net)},
                   {"conductor", tag.net >= 0 || material.sigma_s_per_m >= conductor_sigma_s_per_m},
                   {"num_cells", tag.num_prisms},
                   {"volume_m3", tag.volume_m3}});
  }
  return out;
}

Json materials(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  for (const board::Material& material : mesh.materials())
    out.push_back({{"name", material.name},
                   {"eps_r", material.eps_r},
                   {"tan_delta", material.tan_delta},
                   {"mu_r", material.mu_r},
                   {"sigma_s_per_m", material.sigma_s_per_m}});
  return out;
}

Json faces(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  const std::vector<std::string> names = names_of(mesh.face_tags());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const mesh::FaceTag& tag = mesh.face_tags()[i];
    out.push_back({{"id", tag.id},
                   {"dimension", 2},
                   {"name", names[i]},
                   {"kind", tag.kind == mesh::FaceTagKind::outer ? "outer" : "conductor"},
                   {"net", net_or_null(mesh, tag.net)},
                   {"num_faces", tag.num_triangles + tag.num_quads},
                   {"area_m2", tag.area_m2}});
  }
  return out;
}

Json nets(const mesh::PrismMesh& mesh) {
  std::vector<bool> has_cells(mesh.nets().size(), false);
  for (const mesh::VolumeTag& tag : mesh.volume_tags())
    if (tag.net >= 0 && tag.num_prisms > 0) has_cells[static_cast<std::size_t>(tag.net)] = true;
  Json out = Json::array();
  for (std::size_t i = 0; i < has_cells.size() && i < mesh.net_pieces().size(); ++i)
    if (has_cells[i] && mesh.net_pieces()[i] >= 0) out.push_back({{"name", mesh.nets()[i]}, {"pieces", mesh.net_pieces()[i]}});
  return out;
}

Json touching_nets(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  for (const auto& [a, b] : mesh.touching_nets()) out.push_back({net_or_null(mesh, a), net_or_null(mesh, b)});
  return out;
}

/// One entry per run of neighbouring slabs that hold cells of the layer.
Json layers(const mesh::PrismMesh& mesh) {
  const mesh::LayerPlan& plan = mesh.plan();
  const auto num_slabs = static_cast<std::size_t>(plan.num_slabs());
  std::vector<std::vector<bool>> is_in(mesh.layers().size(), std::vector<bool>(num_slabs, false));
  std::vector<std::int32_t> offsets, triangles;
  for (std::size_t slab = 0; slab < num_slabs; ++slab) {
    mesh.group_triangles(static_cast<std::int32_t>(slab), offsets, triangles);
    for (std::size_t tag = 0; tag < mesh.volume_tags().size(); ++tag)
      if (offsets[tag + 1] > offsets[tag]) is_in[static_cast<std::size_t>(mesh.volume_tags()[tag].layer)][slab] = true;
  }
  const auto z = [&](std::size_t slab) {
    return plan.z_m()[static_cast<std::size_t>(plan.first_sublayer(static_cast<std::int32_t>(slab)))];
  };
  Json out = Json::array();
  for (std::size_t layer = 0; layer < is_in.size(); ++layer)
    for (std::size_t slab = 0, end = 0; slab < num_slabs; slab = end + 1) {
      end = slab;
      while (end < num_slabs && is_in[layer][end]) ++end;
      if (end > slab) out.push_back({{"name", mesh.layers()[layer]}, {"z_min_m", z(slab)}, {"z_max_m", z(end)}});
    }
  return out;
}

/// Heights of the levels that carry nodes.
Json levels(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  for (std::int32_t k = 0; k < mesh.plan().num_levels(); ++k)
    if (mesh.num_nodes_of_level(k) > 0) out.push_back(mesh.plan().z_m()[static_cast<std::size_t>(k)]);
  return out;
}

Json bounding_box(const mesh::PrismMesh& mesh) {
  constexpr double far = std::numeric_limits<double>::infinity();
  std::array<double, 3> min{far, far, far}, max{-far, -far, -far};
  for (const auto& point : mesh.planar().points_m())
    for (std::size_t i = 0; i < 2; ++i) {
      min[i] = std::min(min[i], point[i]);
      max[i] = std::max(max[i], point[i]);
    }
  for (std::int32_t k = 0; k < mesh.plan().num_levels(); ++k) {
    if (mesh.num_nodes_of_level(k) == 0) continue;
    min[2] = std::min(min[2], mesh.plan().z_m()[static_cast<std::size_t>(k)]);
    max[2] = std::max(max[2], mesh.plan().z_m()[static_cast<std::size_t>(k)]);
  }
  if (mesh.num_nodes() == 0) return nullptr;
  return {{"min", min}, {"max", max}};
}

}  // namespace

void write_tags(const mesh::PrismMesh& mesh, const std::filesystem::path& file, LengthUnit unit) {
  Json out;
  out["schema_version"] = schema_version;
  out["unit_m"] = metres_per(unit);
  out["bounding_box_m"] = bounding_box(mesh);
  out["volumes"] = volumes(mesh);
  out["faces"] = faces(mesh);
  out["materials"] = materials(mesh);
  out["nets"] = nets(mesh);
  out["touching_nets"] = touching_nets(mesh);
  out["layers"] = layers(mesh);
  out["levels_m"] = levels(mesh);
  FileSink sink(file);
  // Net names come from other people's files and need not be UTF-8.
  sink.put(out.dump(1, ' ', false, Json::error_handler_t::replace));
  sink.put("\n");
  sink.commit();
}

}  // namespace pcbmesh::formats::tags_json
