// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "pcbmesh/validation/report.hpp"
#include "validation/json_field.hpp"

namespace pcbmesh::validation {
namespace {

constexpr std::int64_t max_tag = std::numeric_limits<std::int32_t>::max();

std::int32_t read_tag(const Field& group, std::set<std::int32_t>& seen) {
  const auto tag = static_cast<std::int32_t>(group["id"].integer(1, max_tag));
  if (!seen.insert(tag).second) group["id"].fail(fmt::format("given once: {} came before", tag));
  return tag;
}

void read_volumes(const Field& list, Expectation& out) {
  std::set<std::int32_t> seen;
  for (const Field& field : list.list()) {
    Expectation::Volume volume;
    volume.tag = read_tag(field, seen);
    volume.name = field["name"].text();
    volume.layer = field["layer"].text_or_empty();
    volume.material = field["material"].text_or_empty();
    volume.net = field["net"].text_or_empty();
    volume.conductor = !field["conductor"].is_absent() && field["conductor"].flag();
    volume.num_cells = field["num_cells"].count_or_unknown();
    volume.volume_m3 = field["volume_m3"].measure_or_unknown();
    out.volumes.push_back(std::move(volume));
  }
}

/// Groups that name each other as partners are one pair.
void read_partner(const Field& face, const std::string& name, Expectation& out) {
  const std::string partner = face["partner"].text_or_empty();
  if (partner.empty()) return;
  const auto is_same = [&](const Expectation::Periodic& pair) { return pair.a == partner && pair.b == name; };
  if (std::ranges::none_of(out.periodic, is_same)) out.periodic.push_back({name, partner, std::nullopt});
}

void read_faces(const Field& list, Expectation& out) {
  std::set<std::int32_t> seen;
  for (const Field& field : list.list()) {
    Expectation::Face face;
    face.tag = read_tag(field, seen);
    face.name = field["name"].text();
    face.kind = field["kind"].text();
    constexpr std::string_view kinds[] = {"outer", "conductor", "sheet", "port", "wave_port", "interface"};
    if (std::ranges::find(kinds, face.kind) == std::end(kinds))
      field["kind"].fail("one of outer, conductor, sheet, port, wave_port, interface");
    face.outer = field["inner"].is_absent() ? face.kind == "outer" || face.kind == "wave_port" : !field["inner"].flag();
    read_partner(field, face.name, out);
    face.port = field["port"].text_or_empty();
    face.num_faces = field["num_faces"].count_or_unknown();
    face.area_m2 = field["area_m2"].measure_or_unknown();
    out.faces.push_back(std::move(face));
  }
}

void read_layers(const Field& top, Expectation& out) {
  const Field layers = top["layers"];
  if (layers.is_absent()) return;
  std::set<double> levels;
  for (const Field& field : layers.list()) {
    Expectation::Layer layer{field["name"].text(), 0, 0};
    std::vector<double> mine;
    for (const Field& level : field["levels_m"].list()) {
      mine.push_back(level.number());
      if (mine.size() > 1 && !(mine[mine.size() - 2] < mine.back())) level.fail("above the level before it");
    }
    if (mine.size() < 2) field["levels_m"].fail("at least two heights");
    layer.z_min_m = mine.front();
    layer.z_max_m = mine.back();
    levels.insert(mine.begin(), mine.end());
    out.layers.push_back(std::move(layer));
  }
  out.levels_m.assign(levels.begin(), levels.end());
}

void read_ports(const Field& top, Expectation& out) {
  const Field ports = top["ports"];
  if (ports.is_absent()) return;
  for (const Field& field : ports.list())
    if (field["kind"].text_or_empty() == "coaxial") out.coaxial_ports.push_back(field["name"].text());
}

void read_nets(const Field& top, Expectation& out) {
  if (const Field nets = top["nets"]; !nets.is_absent()) {
    for (const Field& field : nets.list()) {
      const auto pieces = std::min<std::int64_t>(field["pieces"].count_or_unknown(), max_tag);
      out.nets.push_back({field["name"].text(), static_cast<std::int32_t>(pieces)});
    }
  }
  const Field touching = top["touching_nets"];
  if (touching.is_absent()) return;
  for (const Field& field : touching.list()) {
    const std::vector<Field> pair = field.list();
    if (pair.size() != 2) field.fail("a list of two net names");
    out.touching_nets.push_back({pair[0].text(), pair[1].text()});
  }
}

}  // namespace

Expectation read_expectation(const std::string& file) {
  const JsonSource source{file, "the file is damaged or not a tags.json of pcbmesh, write the mesh again"};
  const nlohmann::json document = parse_json(source);
  const Field top(&document, "", source);
  if (top["schema_version"].integer(0, max_tag) != 1) top["schema_version"].fail("1, the only version this program knows");
  Expectation out;
  out.unit_m = top["unit_m"].number();
  if (!(out.unit_m > 0)) top["unit_m"].fail("greater than zero");
  read_volumes(top["volumes"], out);
  read_faces(top["faces"], out);
  read_nets(top, out);
  read_layers(top, out);
  read_ports(top, out);
  return out;
}

}  // namespace pcbmesh::validation
