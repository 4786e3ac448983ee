// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/hdf5/file_reader.hpp"
#include "formats/native_mesh/layout.hpp"
#include "formats/vtk/mesh_assembly.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/native_mesh.hpp"
#include "pcbmesh/mesh/prism_source.hpp"

namespace pcbmesh::formats {
namespace native_mesh {
namespace {

using mesh::PrismMesh;
using mesh::PrismMeshParts;

class Tables {
 public:
  explicit Tables(const hdf5::FileReader& file) : file_(file) {}

  [[nodiscard]] std::vector<std::int32_t> integers(const std::string& path) const {
    std::vector<std::int32_t> out;
    for (const std::int64_t value : file_.integers(path)) {
      if (value < std::numeric_limits<std::int32_t>::min() || value > std::numeric_limits<std::int32_t>::max())
        file_.fail(path, fmt::format("{} does not fit 32 bits", value));
      out.push_back(static_cast<std::int32_t>(value));
    }
    return out;
  }
  template <class Value, std::size_t width>
  [[nodiscard]] std::vector<std::array<Value, width>> rows(const std::string& path) const {
    const auto shape = file_.shape(path);
    if (shape.size() != 2 || shape[1] != static_cast<std::int64_t>(width))
      file_.fail(path, fmt::format("needs {} columns", width));
    std::vector<std::array<Value, width>> out(static_cast<std::size_t>(shape[0]));
    const auto fill = [&](const auto& values) {
      for (std::size_t i = 0; i < values.size(); ++i) out[i / width][i % width] = values[i];
    };
    if constexpr (std::is_integral_v<Value>)
      fill(integers(path));
    else
      fill(file_.reals(path));
    return out;
  }
  /// One column of a table, given to one member of its items after the other.
  template <class Items, class Values, class Give>
  void give(const std::string& path, Items& items, const Values& values, Give give_to) const {
    if (values.size() != items.size())
      file_.fail(path, fmt::format("has {} entries where its table has {}", values.size(), items.size()));
    for (std::size_t i = 0; i < items.size(); ++i) give_to(items[i], values[i]);
  }
  template <class Items, class Give>
  void integers(const std::string& path, Items& items, Give give_to) const {
    give(path, items, file_.integers(path), give_to);
  }
  template <class Items, class Give>
  void reals(const std::string& path, Items& items, Give give_to) const {
    give(path, items, file_.reals(path), give_to);
  }
  template <class Items, class Give>
  void texts(const std::string& path, Items& items, Give give_to) const {
    give(path, items, file_.texts(path), give_to);
  }
  /// The value of an enumeration whose last is `last`, by its name.
  template <class Enum>
  [[nodiscard]] Enum value_named(const std::string& path, const std::string& text, Enum last) const {
    for (int i = 0; i <= static_cast<int>(last); ++i)
      if (mesh::name_of(static_cast<Enum>(i)) == text) return static_cast<Enum>(i);
    file_.fail(path, fmt::format("'{}' is not known", text.substr(0, 40)));
  }
  [[nodiscard]] const hdf5::FileReader& file() const { return file_; }

 private:
  const hdf5::FileReader& file_;
};

std::int32_t as_index(std::int64_t value) {
  return value < -1 || value > std::numeric_limits<std::int32_t>::max() ? -2 : static_cast<std::int32_t>(value);
}

void read_names(const Tables& in, PrismMeshParts& parts) {
  const hdf5::FileReader& file = in.file();
  parts.layers = file.texts("/layers/name");
  parts.materials.resize(file.texts("/materials/name").size());
  auto& materials = parts.materials;
  in.texts("/materials/name", materials, [](auto& m, const auto& v) { m.name = v; });
  in.reals("/materials/eps_r", materials, [](auto& m, double v) { m.eps_r = v; });
  in.reals("/materials/tan_delta", materials, [](auto& m, double v) { m.tan_delta = v; });
  in.reals("/materials/mu_r", materials, [](auto& m, double v) { m.mu_r = v; });
  in.reals("/materials/sigma_s_per_m", materials, [](auto& m, double v) { m.sigma_s_per_m = v; });
  parts.nets = file.texts("/nets/name");
  parts.net_pieces = in.integers("/nets/pieces");
  parts.touching_nets = in.rows<std::int32_t, 2>("/nets/touching");
}

void read_volumes(const Tables& in, PrismMeshParts& parts) {
  auto& tags = parts.volume_tags;
  tags.resize(in.file().texts("/volumes/name").size());
  in.integers("/volumes/tag", tags, [](auto& t, std::int64_t v) { t.id = as_index(v); });
  in.texts("/volumes/name", tags, [](auto& t, const auto& v) { t.name = v; });
  in.integers("/volumes/layer", tags, [](auto& t, std::int64_t v) { t.layer = as_index(v); });
  in.integers("/volumes/material", tags, [](auto& t, std::int64_t v) { t.material = as_index(v); });
  in.integers("/volumes/net", tags, [](auto& t, std::int64_t v) { t.net = as_index(v); });
  in.integers("/volumes/num_prisms", tags, [](auto& t, std::int64_t v) { t.num_prisms = v; });
  in.reals("/volumes/volume_m3", tags, [](auto& t, double v) { t.volume_m3 = v; });
  // Files of earlier programs have no matched layers.
  if (in.file().has("/volumes/stretched"))
    in.integers("/volumes/stretched", tags, [](auto& t, std::int64_t v) { t.stretched = static_cast<std::uint8_t>(v & 7); });
  if (!in.file().has("/shell/boxes")) return;
  const auto boxes = in.rows<double, 3>("/shell/boxes");
  const auto order = in.integers("/shell/order");
  if (boxes.size() != 4 || order.size() != 1) in.file().fail("/shell/boxes", "expected four corners and one order");
  parts.shell = mesh::Shell{boxes[0], boxes[1], boxes[2], boxes[3], order[0]};
}

void read_faces(const Tables& in, PrismMeshParts& parts) {
  auto& tags = parts.face_tags;
  tags.resize(in.file().texts("/faces/name").size());
  in.integers("/faces/tag", tags, [](auto& t, std::int64_t v) { t.id = as_index(v); });
  in.texts("/faces/name", tags, [](auto& t, const auto& v) { t.name = v; });
  in.texts("/faces/kind", tags,
           [&](auto& t, const auto& v) { t.kind = in.value_named("/faces/kind", v, mesh::FaceTagKind::interface); });
  in.integers("/faces/net", tags, [](auto& t, std::int64_t v) { t.net = as_index(v); });
  in.integers("/faces/is_inner", tags, [](auto& t, std::int64_t v) { t.is_inner = v != 0; });
  in.texts("/faces/condition", tags, [&](auto& t, const auto& v) {
    t.condition = in.value_named("/faces/condition", v, mesh::BoundaryCondition::periodic);
  });
  in.reals("/faces/impedance_ohm", tags, [](auto& t, double v) { t.impedance_ohm = v; });
  in.integers("/faces/material", tags, [](auto& t, std::int64_t v) { t.material = as_index(v); });
  in.reals("/faces/thickness_m", tags, [](auto& t, double v) { t.thickness_m = v; });
  in.integers("/faces/port", tags, [](auto& t, std::int64_t v) { t.port = as_index(v); });
  in.integers("/faces/partner", tags, [](auto& t, std::int64_t v) { t.partner = as_index(v); });
  in.integers("/faces/num_triangles", tags, [](auto& t, std::int64_t v) { t.num_triangles = v; });
  in.integers("/faces/num_quads", tags, [](auto& t, std::int64_t v) { t.num_quads = v; });
  in.reals("/faces/area_m2", tags, [](auto& t, double v) { t.area_m2 = v; });
  for (const auto& [tag, level, triangle, up] : in.rows<std::int32_t, 4>("/faces/caps"))
    parts.caps.push_back({tag, level, triangle, up != 0});
  for (const auto& [tag, slab, a, b] : in.rows<std::int32_t, 4>("/faces/walls")) parts.walls.push_back({tag, slab, a, b});
}

void read_ports(const Tables& in, PrismMeshParts& parts) {
  auto& ports = parts.ports;
  ports.resize(in.file().texts("/ports/name").size());
  in.texts("/ports/name", ports, [](auto& p, const auto& v) { p.name = v; });
  in.texts("/ports/kind", ports, [](auto& p, const auto& v) {
    p.kind = v == "wave" ? mesh::PortKind::wave : v == "coaxial" ? mesh::PortKind::coaxial : mesh::PortKind::lumped;
  });
  in.reals("/ports/impedance_ohm", ports, [](auto& p, double v) { p.impedance_ohm = v; });
  in.integers("/ports/is_excited", ports, [](auto& p, std::int64_t v) { p.is_excited = v != 0; });
  in.give("/ports/direction", ports, in.rows<double, 3>("/ports/direction"), [](auto& p, const auto& v) { p.direction = v; });
  in.reals("/ports/length_m", ports, [](auto& p, double v) { p.length_m = v; });
  in.reals("/ports/width_m", ports, [](auto& p, double v) { p.width_m = v; });
  in.integers("/ports/positive_net", ports, [](auto& p, std::int64_t v) { p.positive_net = as_index(v); });
  in.integers("/ports/negative_net", ports, [](auto& p, std::int64_t v) { p.negative_net = as_index(v); });
  in.give("/ports/at_m", ports, in.rows<double, 3>("/ports/at_m"), [](auto& p, const auto& v) { p.at_m = v; });
}

mesh::PlanarMesh read_plane(const Tables& in) {
  mesh::PlanarMeshParts plane;
  plane.points_m = in.rows<double, 2>("/plane/points");
  plane.triangles = in.rows<std::int32_t, 3>("/plane/triangles");
  plane.regions = in.integers("/plane/regions");
  plane.constrained = in.rows<std::int32_t, 2>("/plane/constrained");
  plane.region_body_offsets = in.integers("/plane/region_body_offsets");
  plane.region_bodies = in.integers("/plane/region_bodies");
  const auto& offsets = plane.region_body_offsets;
  if (offsets.empty() || offsets.front() != 0 || !std::ranges::is_sorted(offsets))
    in.file().fail("/plane/region_body_offsets", "must ascend from 0");
  return mesh::PlanarMesh::from_parts(std::move(plane));
}

/// The tags' own numbers of prisms: writers put them into files before they count.
void check_counts(const hdf5::FileReader& file, const PrismMesh& mesh) {
  std::vector<std::int64_t> counts(mesh.volume_tags().size(), 0);
  for (std::int32_t slab = 0; slab < mesh.plan().num_slabs(); ++slab) {
    const std::int32_t height = mesh.plan().first_sublayer(slab + 1) - mesh.plan().first_sublayer(slab);
    for (std::int32_t t = 0; t < mesh.planar().num_triangles(); ++t)
      if (const std::int32_t tag = mesh.tag_of(slab, t); tag >= 0) counts[static_cast<std::size_t>(tag)] += height;
  }
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] != mesh.volume_tags()[i].num_prisms)
      file.fail("/volumes/num_prisms",
                fmt::format("says {} for volume {}, which has {}", mesh.volume_tags()[i].num_prisms, i + 1, counts[i]));
}

PrismMesh read_parts(const hdf5::FileReader& file) {
  const Tables in(file);
  PrismMeshParts parts;
  parts.planar = read_plane(in);
  parts.plan = mesh::LayerPlan::from_parts({file.reals("/levels/z"), in.integers("/levels/slab")});
  read_names(in, parts);
  read_volumes(in, parts);
  parts.column_tags = in.integers("/labels");
  read_faces(in, parts);
  read_ports(in, parts);
  PrismMesh mesh = PrismMesh::from_parts(std::move(parts));
  check_counts(file, mesh);
  return mesh;
}

}  // namespace

mesh::MeshData read_native(const std::filesystem::path& file, const Progress& progress) {
  mesh::PrismSource source(read_prism_mesh(file, progress));
  vtk::MeshAssembly out(file);
  constexpr std::int64_t nodes_at_once = 4096;
  std::vector<std::array<double, 3>> nodes(nodes_at_once);
  for (std::int64_t first = 0; first < source.num_nodes(); first += nodes_at_once) {
    const auto part = std::span(nodes).first(static_cast<std::size_t>(std::min(nodes_at_once, source.num_nodes() - first)));
    source.fill_nodes(first, part);
    out.add_nodes({part.front().data(), 3 * part.size()});
  }
  constexpr std::array<std::uint8_t, 6> same{0, 1, 2, 3, 4, 5};
  for (std::size_t i = 0; i < source.blocks().size(); ++i) {
    const mesh::ElementBlock& block = source.blocks()[i];
    const auto width = static_cast<std::size_t>(mesh::nodes_of(block.kind));
    out.reserve(block.kind, block.count);
    source.visit(i, [&](std::span<const std::int64_t> rows) {
      for (std::size_t at = 0; at < rows.size(); at += width)
        out.add_element(block.kind, rows.subspan(at, width), same, block.tag);
      progress.check();
    });
  }
  for (const mesh::ElementGroup& group : source.groups()) out.add_name(group.dimension, group.tag, group.name);
  return out.take();
}

}  // namespace native_mesh

mesh::PrismMesh read_prism_mesh(const std::filesystem::path& path, const Progress& progress) {
  progress.check();
  const hdf5::FileReader file(path);
  if (file.text_attribute("/", "format") != native_mesh::format_name)
    file.fail("", "this HDF5 file is no native mesh of pcbmesh: its attribute 'format' does not say so");
  const auto version = file.real_attribute("/", "version");
  if (version != static_cast<double>(native_mesh::format_version))
    file.fail("", fmt::format("is of version {}, and this program reads version {}", version.value_or(0),
                              native_mesh::format_version));
  try {
    return native_mesh::read_parts(file);
  } catch (const Error& error) {
    // The nouns guard their invariants as bugs of ours; in a file they are faults of the file.
    if (error.code() != ErrorCode::internal && error.code() != ErrorCode::layering_invalid) throw;
    file.fail("", fmt::format("its tables contradict each other ({})", error.text()));
  }
}

}  // namespace pcbmesh::formats
