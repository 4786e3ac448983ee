// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/deck/adjacent_media.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "formats/tags_json/tags_json.hpp"

namespace pcbmesh::formats::deck {
namespace {

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

/// Area of each material behind one face tag between two levels.
struct Areas {
  std::map<std::int32_t, double> by_material;
  [[nodiscard]] board::Material mean(std::span<const board::Material> materials) const {
    double total = 0;
    board::Material mean{.name = "", .eps_r = 0, .tan_delta = 0, .mu_r = 0, .sigma_s_per_m = 0};
    for (const auto& [m, area] : by_material) {
      const board::Material& material = materials[index(m)];
      mean.name += (mean.name.empty() ? "" : " + ") + material.name;
      mean.eps_r += area * material.eps_r;
      mean.tan_delta += area * material.eps_r * material.tan_delta;
      mean.mu_r += area * material.mu_r;
      mean.sigma_s_per_m += area * material.sigma_s_per_m;
      total += area;
    }
    mean.tan_delta /= mean.eps_r;
    mean.eps_r /= total;
    mean.mu_r /= total;
    mean.sigma_s_per_m /= total;
    return mean;
  }
};

class Survey {
 public:
  explicit Survey(const mesh::PrismMesh& mesh) : mesh_(mesh), slabs_(mesh.face_tags().size()) {}

  void add(std::int32_t face_tag, std::int32_t slab, std::int32_t triangle, double area) {
    const std::int32_t tag = mesh_.tag_of(slab, triangle);
    if (tag < 0) return;
    const mesh::VolumeTag& volume = mesh_.volume_tags()[index(tag)];
    const bool conducts =
        volume.net >= 0 || mesh_.materials()[index(volume.material)].sigma_s_per_m >= tags_json::conductor_sigma_s_per_m;
    if (!conducts) slabs_[index(face_tag)][slab].by_material[volume.material] += area;
  }

  [[nodiscard]] std::vector<Medium> media(std::size_t face_tag) const {
    std::vector<Medium> out;
    for (const auto& [slab, areas] : slabs_[face_tag]) {
      const board::Material mean = areas.mean(mesh_.materials());
      const auto& plan = mesh_.plan();
      const double low = plan.z_m()[index(plan.first_sublayer(slab))], high = plan.z_m()[index(plan.first_sublayer(slab + 1))];
      if (!out.empty() && out.back().material == mean)
        out.back().z_high_m = high;
      else
        out.push_back({low, high, mean});
    }
    return out;
  }

 private:
  const mesh::PrismMesh& mesh_;
  std::vector<std::map<std::int32_t, Areas>> slabs_;
};

}  // namespace

std::vector<std::vector<Medium>> adjacent_media(const mesh::PrismMesh& mesh) {
  std::vector<std::vector<Medium>> out(mesh.face_tags().size());
  const auto looks_out = [&](std::int32_t tag) {
    const mesh::FaceTag& face = mesh.face_tags()[index(tag)];
    return face.condition == mesh::BoundaryCondition::absorbing || face.kind == mesh::FaceTagKind::wave_port;
  };
  Survey survey(mesh);
  const auto slab_of = mesh.plan().slab_of_sublayer();
  for (const mesh::Cap& cap : mesh.caps()) {
    if (!looks_out(cap.tag)) continue;
    const std::int32_t slab = slab_of[index(cap.up ? cap.level - 1 : cap.level)];
    survey.add(cap.tag, slab, cap.triangle, mesh.planar().area_m2(cap.triangle));
  }
  // Walls know their edge; the meshed triangle is the one to its left.
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> left_of;
  for (const mesh::Wall& wall : mesh.walls())
    if (looks_out(wall.tag)) left_of.insert({{wall.a, wall.b}, -1});
  if (!left_of.empty())
    for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
      const auto& corners = mesh.planar().triangles()[index(t)];
      for (std::size_t i = 0; i < 3; ++i)
        if (const auto found = left_of.find({corners[i], corners[i == 2 ? 0 : i + 1]}); found != left_of.end())
          found->second = t;
    }
  for (const mesh::Wall& wall : mesh.walls()) {
    if (!looks_out(wall.tag)) continue;
    const std::int32_t triangle = left_of.at({wall.a, wall.b});
    const auto &p = mesh.planar().points_m()[index(wall.a)], &q = mesh.planar().points_m()[index(wall.b)];
    if (triangle >= 0) survey.add(wall.tag, wall.slab, triangle, std::hypot(q[0] - p[0], q[1] - p[1]));
  }
  for (std::size_t tag = 0; tag < out.size(); ++tag) out[tag] = survey.media(tag);
  return out;
}

}  // namespace pcbmesh::formats::deck
