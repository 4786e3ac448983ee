// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <string>
#include <vector>

#include "formats/hdf5/file_writer.hpp"
#include "formats/native_mesh/layout.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/mesh/prism_mesh.hpp"

namespace pcbmesh::formats::native_mesh {
namespace {

using mesh::PrismMesh;

/// Columns of tables and rows of arrays, written one data set after the other.
class Tables {
 public:
  explicit Tables(hdf5::FileWriter& file) : file_(file) {}
  /// One column of a table, from one member of its items.
  template <class Value, class Items, class Of>
  void column(const std::string& path, const Items& items, Of of) {
    std::vector<Value> values;
    for (const auto& item : items) values.push_back(static_cast<Value>(of(item)));
    file_.put(path, std::span<const Value>(values));
  }
  template <class Items, class Of>
  void names(const std::string& path, const Items& items, Of of) {
    std::vector<std::string> values;
    for (const auto& item : items) values.emplace_back(of(item));
    file_.put_strings(path, values);
  }
  /// Rows of fixed width.
  template <class Value, std::size_t width, class Items, class Of>
  void rows(const std::string& path, const Items& items, Of of) {
    const auto out = file_.begin(path, hdf5::number_type<Value>(), static_cast<std::int64_t>(items.size()), width);
    for (const auto& item : items)
      for (const Value value : std::array<Value, width>(of(item))) out->put(value);
    out->finish();
  }

 private:
  hdf5::FileWriter& file_;
};

void write_plane(Tables& out, hdf5::FileWriter& file, const mesh::PlanarMesh& plane) {
  const auto same = [](const auto& row) { return row; };
  out.rows<double, 2>("/plane/points", plane.points_m(), same);
  out.rows<std::int32_t, 3>("/plane/triangles", plane.triangles(), same);
  file.put("/plane/regions", plane.regions());
  out.rows<std::int32_t, 2>("/plane/constrained", plane.constrained(), same);
  std::vector<std::int32_t> offsets{0}, bodies;
  for (std::int32_t r = 0; r < plane.num_regions(); ++r) {
    const auto of_region = plane.bodies_of_region(r);
    bodies.insert(bodies.end(), of_region.begin(), of_region.end());
    offsets.push_back(static_cast<std::int32_t>(bodies.size()));
  }
  file.put("/plane/region_body_offsets", std::span<const std::int32_t>(offsets));
  file.put("/plane/region_bodies", std::span<const std::int32_t>(bodies));
}

void write_labels(hdf5::FileWriter& file, const PrismMesh& mesh) {
  const std::int32_t num_slabs = mesh.plan().num_slabs(), num_regions = mesh.planar().num_regions();
  std::vector<std::int32_t> labels(static_cast<std::size_t>(num_slabs) * static_cast<std::size_t>(num_regions), -1);
  std::vector<bool> seen(static_cast<std::size_t>(num_regions), false);
  for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t) {
    const auto region = static_cast<std::size_t>(mesh.planar().regions()[static_cast<std::size_t>(t)]);
    if (seen[region]) continue;  // all triangles of a region share their labels
    seen[region] = true;
    const auto row = region * static_cast<std::size_t>(num_slabs);
    for (std::int32_t s = 0; s < num_slabs; ++s) labels[row + static_cast<std::size_t>(s)] = mesh.tag_of(s, t);
  }
  file.put("/labels", std::span<const std::int32_t>(labels), num_slabs);
}

void write_tables(Tables& out, hdf5::FileWriter& file, const PrismMesh& mesh) {
  const auto name = [](const auto& item) { return item.name; };
  const auto same = [](const auto& item) { return item; };
  file.put_strings("/layers/name", std::vector<std::string>(mesh.layers().begin(), mesh.layers().end()));
  out.names("/materials/name", mesh.materials(), name);
  out.column<double>("/materials/eps_r", mesh.materials(), [](const auto& m) { return m.eps_r; });
  out.column<double>("/materials/tan_delta", mesh.materials(), [](const auto& m) { return m.tan_delta; });
  out.column<double>("/materials/mu_r", mesh.materials(), [](const auto& m) { return m.mu_r; });
  out.column<double>("/materials/sigma_s_per_m", mesh.materials(), [](const auto& m) { return m.sigma_s_per_m; });
  file.put_strings("/nets/name", std::vector<std::string>(mesh.nets().begin(), mesh.nets().end()));
  file.put("/nets/pieces", mesh.net_pieces());
  out.rows<std::int32_t, 2>("/nets/touching", mesh.touching_nets(), same);

  out.column<std::int32_t>("/volumes/tag", mesh.volume_tags(), [](const auto& t) { return t.id; });
  out.names("/volumes/name", mesh.volume_tags(), name);
  out.column<std::int32_t>("/volumes/layer", mesh.volume_tags(), [](const auto& t) { return t.layer; });
  out.column<std::int32_t>("/volumes/material", mesh.volume_tags(), [](const auto& t) { return t.material; });
  out.column<std::int32_t>("/volumes/net", mesh.volume_tags(), [](const auto& t) { return t.net; });
  out.column<std::int64_t>("/volumes/num_prisms", mesh.volume_tags(), [](const auto& t) { return t.num_prisms; });
  out.column<double>("/volumes/volume_m3", mesh.volume_tags(), [](const auto& t) { return t.volume_m3; });

  out.column<std::uint8_t>("/volumes/stretched", mesh.volume_tags(), [](const auto& t) { return t.stretched; });
  if (const auto& shell = mesh.shell()) {
    const std::array boxes{shell->inner_min_m, shell->inner_max_m, shell->outer_min_m, shell->outer_max_m};
    out.rows<double, 3>("/shell/boxes", boxes, same);
    out.column<std::int32_t>("/shell/order", std::array{shell->order}, same);
  }

  const auto faces = mesh.face_tags();
  out.column<std::int32_t>("/faces/tag", faces, [](const auto& t) { return t.id; });
  out.names("/faces/name", faces, name);
  out.names("/faces/kind", faces, [](const auto& t) { return mesh::name_of(t.kind); });
  out.column<std::int32_t>("/faces/net", faces, [](const auto& t) { return t.net; });
  out.column<std::uint8_t>("/faces/is_inner", faces, [](const auto& t) { return t.is_inner; });
  out.names("/faces/condition", faces, [](const auto& t) { return mesh::name_of(t.condition); });
  out.column<double>("/faces/impedance_ohm", faces, [](const auto& t) { return t.impedance_ohm; });
  out.column<std::int32_t>("/faces/material", faces, [](const auto& t) { return t.material; });
  out.column<double>("/faces/thickness_m", faces, [](const auto& t) { return t.thickness_m; });
  out.column<std::int32_t>("/faces/port", faces, [](const auto& t) { return t.port; });
  out.column<std::int32_t>("/faces/partner", faces, [](const auto& t) { return t.partner; });
  out.column<std::int64_t>("/faces/num_triangles", faces, [](const auto& t) { return t.num_triangles; });
  out.column<std::int64_t>("/faces/num_quads", faces, [](const auto& t) { return t.num_quads; });
  out.column<double>("/faces/area_m2", faces, [](const auto& t) { return t.area_m2; });
  out.rows<std::int32_t, 4>("/faces/caps", mesh.caps(), [](const mesh::Cap& c) {
    return std::array<std::int32_t, 4>{c.tag, c.level, c.triangle, c.up ? 1 : 0};
  });
  out.rows<std::int32_t, 4>("/faces/walls", mesh.walls(), [](const mesh::Wall& w) {
    return std::array<std::int32_t, 4>{w.tag, w.slab, w.a, w.b};
  });

  const auto ports = mesh.ports();
  out.names("/ports/name", ports, name);
  out.names("/ports/kind", ports, [](const auto& p) { return std::string(mesh::name_of(p.kind)); });
  out.column<double>("/ports/impedance_ohm", ports, [](const auto& p) { return p.impedance_ohm; });
  out.column<std::uint8_t>("/ports/is_excited", ports, [](const auto& p) { return p.is_excited; });
  out.rows<double, 3>("/ports/direction", ports, [](const auto& p) { return p.direction; });
  out.column<double>("/ports/length_m", ports, [](const auto& p) { return p.length_m; });
  out.column<double>("/ports/width_m", ports, [](const auto& p) { return p.width_m; });
  out.column<std::int32_t>("/ports/positive_net", ports, [](const auto& p) { return p.positive_net; });
  out.column<std::int32_t>("/ports/negative_net", ports, [](const auto& p) { return p.negative_net; });
  out.rows<double, 3>("/ports/at_m", ports, [](const auto& p) { return p.at_m; });
}

}  // namespace

void write_native(mesh::MeshSource& source, const std::filesystem::path& path, const WriteMeshOptions& options,
                  const Progress& progress) {
  if (source.prisms() == nullptr)
    throw Error(ErrorCode::format_limit,
                "the native format holds the prisms of an extruded mesh of first order alone; choose another format",
                {.file = path.string()});
  const PrismMesh& mesh = *source.prisms();
  progress.check();
  // Packed by default: this file is for keeping and passing on.
  hdf5::FileWriter file(path, {0, true, options.num_threads});
  file.put_attribute("/", "format", format_name);
  file.put_attribute("/", "version", std::array<std::int64_t, 1>{format_version});
  Tables tables(file);
  write_plane(tables, file, mesh.planar());
  file.put("/levels/z", mesh.plan().z_m());
  file.put("/levels/slab", mesh.plan().slab_of_sublayer());
  write_labels(file, mesh);
  write_tables(tables, file, mesh);
  progress.check();
  file.commit();
}

}  // namespace pcbmesh::formats::native_mesh
