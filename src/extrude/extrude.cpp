// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/extrude/extrude.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/running_sum.hpp"
#include "src/extrude/boundary.hpp"
#include "src/extrude/columns.hpp"
#include "src/extrude/tag_names.hpp"

namespace pcbmesh::extrude {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// Adjacent slabs of one name and kind are one layer. Returns the layer of each slab.
std::vector<std::int32_t> name_layers(std::span<const model::Slab> slabs, std::vector<std::string>& layers) {
  std::vector<std::int32_t> layer_of_slab;
  for (std::size_t s = 0; s < slabs.size(); ++s) {
    const bool continues = s > 0 && slabs[s].layer == slabs[s - 1].layer && slabs[s].kind == slabs[s - 1].kind;
    if (!continues) layers.push_back(slabs[s].layer);
    layer_of_slab.push_back(static_cast<std::int32_t>(layers.size()) - 1);
  }
  layers = make_unique(std::move(layers));
  return layer_of_slab;
}

void name_materials(std::span<const board::Material> given, std::vector<board::Material>& materials) {
  materials.assign(given.begin(), given.end());
  std::vector<std::string> names;
  for (const board::Material& material : materials) names.push_back(material.name);
  names = make_unique(std::move(names));
  for (std::size_t i = 0; i < names.size(); ++i) materials[i].name = names[i];
}

/// Volume tags in use, and the tag of each column cell.
void add_volume_tags(mesh::PrismMeshParts& parts, const Columns& columns, std::span<const std::int32_t> layer_of_slab) {
  const std::int32_t num_regions = parts.planar.num_regions(), num_slabs = columns.num_slabs();
  using Key = std::tuple<std::int32_t, std::int32_t, std::int32_t, std::uint8_t>;  // layer, material, net, stretched axes
  const auto key_of = [&](const model::Label& label, std::int32_t slab) {
    return Key{layer_of_slab[index(slab)], label.material, label.net, label.stretched};
  };
  std::map<Key, std::int32_t> tags;
  for (std::int32_t s = 0; s < num_slabs; ++s) {
    for (std::int32_t r = 0; r < num_regions; ++r) {
      if (const model::Label& label = columns.at(r, s); !label.is_void()) tags.try_emplace(key_of(label, s), -1);
    }
  }
  for (auto& [key, tag_index] : tags) {
    tag_index = static_cast<std::int32_t>(parts.volume_tags.size());
    mesh::VolumeTag& tag = parts.volume_tags.emplace_back();
    std::tie(tag.layer, tag.material, tag.net, tag.stretched) = key;
    tag.id = tag_index + 1;
    tag.name = escape_tag_part(parts.layers[index(tag.layer)]) + "|" +
               escape_tag_part(parts.materials[index(tag.material)].name) + "|" + net_part(parts.nets, tag.net);
    if (tag.stretched != 0) tag.name += "|pml " + mesh::axes_text(tag.stretched);
  }
  parts.column_tags.assign(index(num_regions) * index(num_slabs), -1);
  for (std::int32_t r = 0; r < num_regions; ++r) {
    for (std::int32_t s = 0; s < num_slabs; ++s) {
      const model::Label& label = columns.at(r, s);
      if (!label.is_void()) parts.column_tags[index(r) * index(num_slabs) + index(s)] = tags.at(key_of(label, s));
    }
  }
}

/// Counts and volumes of the volume tags: area of each region times height of each slab.
void measure_volumes(mesh::PrismMeshParts& parts) {
  const auto num_slabs = index(parts.plan.num_slabs()), num_regions = index(parts.planar.num_regions());
  std::vector<std::int64_t> num_triangles(num_regions, 0);
  std::vector<RunningSum> areas(num_regions);
  for (std::int32_t t = 0; t < parts.planar.num_triangles(); ++t) {
    const auto region = index(parts.planar.regions()[index(t)]);
    ++num_triangles[region];
    areas[region].add(parts.planar.area_m2(t));
  }
  std::vector<RunningSum> volumes(parts.volume_tags.size());
  for (std::size_t r = 0; r < num_regions; ++r) {
    for (std::size_t s = 0; s < num_slabs; ++s) {
      const std::int32_t tag = parts.column_tags[r * num_slabs + s];
      if (tag < 0) continue;
      const std::int32_t low = parts.plan.first_sublayer(static_cast<std::int32_t>(s));
      const std::int32_t high = parts.plan.first_sublayer(static_cast<std::int32_t>(s) + 1);
      parts.volume_tags[index(tag)].num_prisms += num_triangles[r] * (high - low);
      volumes[index(tag)].add(areas[r].total() * (parts.plan.z_m()[index(high)] - parts.plan.z_m()[index(low)]));
    }
  }
  for (std::size_t i = 0; i < volumes.size(); ++i) parts.volume_tags[i].volume_m3 = volumes[i].total();
}

}  // namespace

Columns::Columns(const mesh::PlanarMesh& planar, const model::Model& model)
    : num_slabs_(model.slabs().size()), labels_(index(planar.num_regions()) * model.slabs().size()) {
  std::vector<bool> has_triangles(index(planar.num_regions()), false);
  for (std::int32_t region : planar.regions()) has_triangles[index(region)] = true;
  const bool has_sheets =
      std::any_of(model.bodies().begin(), model.bodies().end(), [](const model::Body& body) { return body.sheet.has_value(); });
  if (has_sheets) sheets_.assign(index(planar.num_regions()) * (num_slabs_ + 1), -1);
  for (std::int32_t r = 0; r < planar.num_regions(); ++r) {
    if (!has_triangles[index(r)]) continue;
    const auto present = planar.bodies_of_region(r);
    if (has_sheets) {
      for (std::int32_t face = 0; face <= num_slabs(); ++face)
        sheets_[index(r) * (num_slabs_ + 1) + index(face)] = model.sheet_at(face, present);
    }
    for (std::size_t s = 0; s < num_slabs_; ++s) {
      labels_[index(r) * num_slabs_ + s] = model.resolve(static_cast<std::int32_t>(s), present);
    }
  }
}

namespace {

std::optional<mesh::Shell> shell_of(const std::optional<model::Shell>& shell) {
  if (!shell) return std::nullopt;
  const auto metres = [](geometry::Point p, Nm z) {
    return std::array<double, 3>{static_cast<double>(p.x) * metres_per_nm, static_cast<double>(p.y) * metres_per_nm,
                                 static_cast<double>(z) * metres_per_nm};
  };
  return mesh::Shell{metres(shell->inner.min, shell->inner_z[0]), metres(shell->inner.max, shell->inner_z[1]),
                     metres(shell->outer.min, shell->outer_z[0]), metres(shell->outer.max, shell->outer_z[1]), shell->order};
}

}  // namespace

mesh::PrismMesh extrude(const mesh::PlanarMesh& planar, const mesh::LayerPlan& plan, const model::Model& model,
                        std::span<const std::int32_t> net_pieces, std::span<const std::array<std::int32_t, 2>> touching_nets) {
  PCBMESH_ASSERT(index(plan.num_slabs()) == model.slabs().size());
  PCBMESH_ASSERT(net_pieces.empty() || net_pieces.size() == model.nets().size());
  for (std::int32_t r = 0; r < planar.num_regions(); ++r) {
    for (std::int32_t body : planar.bodies_of_region(r)) PCBMESH_ASSERT(body >= 0 && index(body) < model.bodies().size());
  }
  mesh::PrismMeshParts parts;
  parts.planar = planar;
  parts.plan = plan;
  const std::vector<std::int32_t> layer_of_slab = name_layers(model.slabs(), parts.layers);
  name_materials(model.materials(), parts.materials);
  parts.nets.assign(model.nets().begin(), model.nets().end());
  parts.shell = shell_of(model.shell());
  const Columns columns(planar, model);
  add_volume_tags(parts, columns, layer_of_slab);
  measure_volumes(parts);
  add_boundary(parts, columns, model);
  parts.net_pieces.assign(net_pieces.begin(), net_pieces.end());
  parts.touching_nets.assign(touching_nets.begin(), touching_nets.end());
  return mesh::PrismMesh::from_parts(std::move(parts));
}

}  // namespace pcbmesh::extrude
