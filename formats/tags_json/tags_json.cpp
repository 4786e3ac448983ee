// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/tags_json/tags_json.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/sink/file_sink.hpp"
#include "formats/syntax/input_file.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/group_names.hpp"
#include "pcbmesh/mesh/net_measures.hpp"

namespace pcbmesh::formats::tags_json {
namespace {

using Json = nlohmann::ordered_json;

constexpr int schema_version = 1;

Json net_or_null(const mesh::PrismMesh& mesh, std::int32_t net) {
  return net < 0 ? Json(nullptr) : Json(mesh.nets()[static_cast<std::size_t>(net)]);
}

template <class NameOf>
Json entry_or_null(std::int32_t index, NameOf name_of) {
  return index < 0 ? Json(nullptr) : Json(name_of(static_cast<std::size_t>(index)));
}

template <class Tags>
std::vector<std::string> names_of(const Tags& tags) {
  std::vector<std::string> names;
  for (const auto& tag : tags) names.push_back(tag.name);
  return mesh::group_names(names);
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
                   {"stretched", tag.stretched == 0 ? Json(nullptr) : Json(mesh::axes_text(tag.stretched))},
                   {"num_cells", tag.num_prisms},
                   {"volume_m3", tag.volume_m3}});
  }
  return out;
}

/// Every key is always there; null where the kind has no such number.
Json model_json(const Dispersion& dispersion) {
  const bool is_wideband = dispersion.kind == DispersionKind::djordjevic_sarkar;
  const auto of_wideband = [&](double value) { return is_wideband ? Json(value) : Json(nullptr); };
  Json model{{"kind", name_of(dispersion.kind)},
             {"eps_inf", dispersion.kind == DispersionKind::constant ? Json(nullptr) : Json(dispersion.eps_inf)},
             {"slope", of_wideband(dispersion.slope)},
             {"low_hz", of_wideband(dispersion.low_hz)},
             {"high_hz", of_wideband(dispersion.high_hz)},
             {"poles", Json::array()}};
  for (const DebyePole& pole : dispersion.poles)
    model["poles"].push_back({{"delta_eps", pole.delta_eps}, {"relaxation_hz", pole.relaxation_hz}});
  return model;
}

Json roughness_json(const Roughness& roughness) {
  const bool has_rms = roughness.kind == RoughnessKind::hammerstad || roughness.kind == RoughnessKind::groisse;
  const bool has_nodules = roughness.kind == RoughnessKind::huray;
  return {{"kind", name_of(roughness.kind)},
          {"rms_m", has_rms ? Json(roughness.rms_m) : Json(nullptr)},
          {"nodule_radius_m", has_nodules ? Json(roughness.nodule_radius_m) : Json(nullptr)},
          {"surface_ratio", has_nodules ? Json(roughness.surface_ratio) : Json(nullptr)}};
}

Json materials(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  for (const board::Material& material : mesh.materials())
    out.push_back({{"name", material.name},
                   {"eps_r", material.eps_r},
                   {"tan_delta", material.tan_delta},
                   {"mu_r", material.mu_r},
                   {"sigma_s_per_m", material.sigma_s_per_m},
                   {"at_hz", material.at_hz > 0 ? Json(material.at_hz) : Json(nullptr)},
                   {"model", model_json(material.dispersion)},
                   {"roughness", roughness_json(material.roughness)},
                   {"assumed", material.is_assumed},
                   {"source", material.source.empty() ? Json(nullptr) : Json(material.source)}});
  return out;
}

Json faces(const mesh::PrismMesh& mesh, std::int32_t first_face_id) {
  Json out = Json::array();
  const std::vector<std::string> names = names_of(mesh.face_tags());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const mesh::FaceTag& tag = mesh.face_tags()[i];
    out.push_back({{"id", tag.id + first_face_id},
                   {"dimension", 2},
                   {"name", names[i]},
                   {"kind", mesh::name_of(tag.kind)},
                   {"inner", tag.is_inner},
                   {"net", net_or_null(mesh, tag.net)},
                   {"condition", mesh::name_of(tag.condition)},
                   {"impedance_ohm", tag.impedance_ohm > 0 ? Json(tag.impedance_ohm) : Json(nullptr)},
                   {"material", entry_or_null(tag.material, [&](std::size_t m) { return mesh.materials()[m].name; })},
                   {"thickness_m", tag.thickness_m > 0 ? Json(tag.thickness_m) : Json(nullptr)},
                   {"port", entry_or_null(tag.port, [&](std::size_t p) { return mesh.ports()[p].name; })},
                   {"partner", entry_or_null(tag.partner, [&](std::size_t f) { return names[f]; })},
                   {"num_faces", tag.num_triangles + tag.num_quads},
                   {"area_m2", tag.area_m2}});
  }
  return out;
}

Json ports(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  for (const mesh::Port& port : mesh.ports())
    out.push_back({{"name", port.name},
                   {"kind", mesh::name_of(port.kind)},
                   {"impedance_ohm", port.impedance_ohm},
                   {"excited", port.is_excited},
                   {"direction", port.kind == mesh::PortKind::coaxial ? Json(nullptr) : Json(port.direction)},
                   {"length_m", port.length_m},
                   {"width_m", port.width_m},
                   {"positive_net", net_or_null(mesh, port.positive_net)},
                   {"negative_net", net_or_null(mesh, port.negative_net)},
                   {"at_m", port.at_m}});
  return out;
}

/// Height of each layer; the z levels of all its sub-layers.
Json layers(const mesh::PrismMesh& mesh) {
  const mesh::LayerPlan& plan = mesh.plan();
  // A layer is one or several adjacent slabs; the slabs of a volume tag say which.
  std::vector<std::int32_t> layer_of_slab(static_cast<std::size_t>(plan.num_slabs()), -1);
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t)
    for (std::int32_t slab = 0; slab < plan.num_slabs(); ++slab)
      if (const std::int32_t tag = mesh.tag_of(slab, t); tag >= 0)
        layer_of_slab[static_cast<std::size_t>(slab)] = mesh.volume_tags()[static_cast<std::size_t>(tag)].layer;
  Json out = Json::array();
  for (std::size_t layer = 0; layer < mesh.layers().size(); ++layer) {
    Json levels = Json::array();
    for (std::int32_t slab = 0; slab < plan.num_slabs(); ++slab) {
      if (layer_of_slab[static_cast<std::size_t>(slab)] != static_cast<std::int32_t>(layer)) continue;
      for (std::int32_t k = plan.first_sublayer(slab) + (levels.empty() ? 0 : 1); k <= plan.first_sublayer(slab + 1); ++k)
        levels.push_back(plan.z_m()[static_cast<std::size_t>(k)]);
    }
    if (!levels.empty()) out.push_back({{"name", mesh.layers()[layer]}, {"levels_m", std::move(levels)}});
  }
  return out;
}

Json nets(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  const std::vector<mesh::NetMeasure> measures = mesh::measure_nets(mesh);
  for (std::size_t i = 0; i < measures.size(); ++i) {
    const mesh::NetMeasure& net = measures[i];
    if (net.area_m2 <= 0) continue;
    const std::int32_t pieces = i < mesh.net_pieces().size() ? mesh.net_pieces()[i] : -1;
    Json ports = Json::array();
    for (const std::int32_t port : net.ports) ports.push_back(mesh.ports()[static_cast<std::size_t>(port)].name);
    out.push_back({{"name", mesh.nets()[i]},
                   {"pieces", pieces >= 0 ? Json(pieces) : Json(nullptr)},
                   {"num_cells", net.num_prisms},
                   {"volume_m3", net.volume_m3},
                   {"area_m2", net.area_m2},
                   {"ports", std::move(ports)}});
  }
  return out;
}

Json shell(const mesh::PrismMesh& mesh) {
  if (!mesh.shell()) return nullptr;
  const mesh::Shell& shell = *mesh.shell();
  return {{"inner_m", {{"min", shell.inner_min_m}, {"max", shell.inner_max_m}}},
          {"outer_m", {{"min", shell.outer_min_m}, {"max", shell.outer_max_m}}},
          {"order", shell.order}};
}

Json touching_nets(const mesh::PrismMesh& mesh) {
  Json out = Json::array();
  for (const auto& [a, b] : mesh.touching_nets()) out.push_back({net_or_null(mesh, a), net_or_null(mesh, b)});
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

/// Numbers of elements as a mesh holds them.
void put_counts(Json& tags, const mesh::MeshSource& written, std::int32_t first_face_id) {
  for (const mesh::ElementGroup& group : written.groups())
    for (Json& entry : tags[group.dimension == 3 ? "volumes" : "faces"])
      if (entry["id"] == group.tag + (group.dimension == 2 ? first_face_id : 0))
        entry[group.dimension == 3 ? "num_cells" : "num_faces"] = group.num_elements;
}

void write_json(const Json& tags, const std::filesystem::path& file) {
  FileSink sink(file);
  // Net names come from other people's files and need not be UTF-8.
  sink.put(tags.dump(1, ' ', false, Json::error_handler_t::replace));
  sink.put("\n");
  sink.commit();
}

}  // namespace

void carry_tags(const std::filesystem::path& from, const std::filesystem::path& to, double unit_m,
                const mesh::MeshSource& written) {
  Json tags;
  try {
    tags = Json::parse(syntax::read_whole_file(from));
    tags.at("unit_m") = unit_m;
    put_counts(tags, written, 0);
  } catch (const Json::exception&) {
    throw Error(ErrorCode::file_syntax, "this is no tags.json of pcbmesh; move it away from the mesh, or write the mesh anew",
                {.file = from.string()});
  }
  write_json(tags, to);
}

void write_tags(const mesh::PrismMesh& mesh, const std::filesystem::path& file, LengthUnit unit, std::int32_t first_face_id,
                const mesh::MeshSource* written) {
  Json out;
  out["schema_version"] = schema_version;
  out["unit_m"] = metres_per(unit);
  out["bounding_box_m"] = bounding_box(mesh);
  out["layers"] = layers(mesh);
  out["volumes"] = volumes(mesh);
  out["faces"] = faces(mesh, first_face_id);
  if (written != nullptr) put_counts(out, *written, first_face_id);
  out["shell"] = shell(mesh);
  out["ports"] = ports(mesh);
  out["materials"] = materials(mesh);
  out["nets"] = nets(mesh);
  out["touching_nets"] = touching_nets(mesh);
  write_json(out, file);
}

}  // namespace pcbmesh::formats::tags_json
