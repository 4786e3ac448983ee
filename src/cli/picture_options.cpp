// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/cli/picture_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/near_miss.hpp"
#include "pcbmesh/base/units.hpp"

namespace pcbmesh::cli {
namespace {

constexpr double unset = 1e9;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::vector<std::string> split_all(const std::vector<std::string>& texts) {
  std::vector<std::string> out;
  for (const std::string& text : texts)
    for (std::string& part : split(text, ','))
      if (!part.empty()) out.push_back(std::move(part));
  return out;
}

/// Index of a name in a table. @throws Error name_unknown (304) with the near misses.
std::int32_t find_name(const std::string& name, std::span<const std::string> table, std::string_view kind) {
  const auto found = std::find(table.begin(), table.end(), name);
  if (found == table.end())
    throw Error(ErrorCode::name_unknown, fmt::format("the mesh has no {} '{}'{}", kind, name, did_you_mean(name, table)));
  return static_cast<std::int32_t>(found - table.begin());
}

/// Hides groups of the layer, material or net of this name, or the group itself.
void hide(std::vector<char>& hidden, const std::string& name, const ShownNames& names) {
  bool found = false;
  const auto is_named = [&](const std::vector<std::string>& table, std::int32_t i) {
    return i >= 0 && table[index(i)] == name;
  };
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    const ShownNames::Group& group = names.groups[i];
    if (group.name != name && !is_named(names.layers, group.layer) && !is_named(names.materials, group.material) &&
        !is_named(names.nets, group.net))
      continue;
    hidden[i] = 1;
    found = true;
  }
  if (found) return;
  std::vector<std::string> all = names.materials;
  all.insert(all.end(), names.layers.begin(), names.layers.end());
  all.insert(all.end(), names.nets.begin(), names.nets.end());
  for (const ShownNames::Group& group : names.groups) all.push_back(group.name);
  throw Error(ErrorCode::name_unknown,
              fmt::format("--hide: the mesh has no layer, material, net or group '{}'{}", name, did_you_mean(name, all)));
}

std::vector<char> hidden_groups(const PictureFlags& flags, const ShownNames& names) {
  std::vector<char> hidden;
  for (const ShownNames::Group& group : names.groups) hidden.push_back(group.is_air && !flags.show_air ? 1 : 0);
  std::vector<std::int32_t> layers, nets;
  for (const std::string& name : split_all(flags.layers)) layers.push_back(find_name(name, names.layers, "layer"));
  for (const std::string& name : split_all(flags.show_nets)) nets.push_back(find_name(name, names.nets, "net"));
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    const ShownNames::Group& group = names.groups[i];
    if (!layers.empty() && std::find(layers.begin(), layers.end(), group.layer) == layers.end()) hidden[i] = 1;
    if (!nets.empty() && std::find(nets.begin(), nets.end(), group.net) == nets.end()) hidden[i] = 1;
  }
  for (const std::string& name : split_all(flags.hidden)) hide(hidden, name, names);
  return hidden;
}

/// "x=10mm" cuts away what stands before the plane; "x=10mm+" keeps the side of greater coordinates, "x=10mm-" the other.
view::SectionPlane parse_section(const std::string& text, const view::Camera& camera) {
  view::SectionPlane plane;
  const std::size_t at = text.find('=');
  const std::string axis = text.substr(0, at);
  if (at == std::string::npos || (axis != "x" && axis != "y" && axis != "z"))
    throw Error(ErrorCode::usage, fmt::format("--section '{}': expected an axis and a place, e.g. x=10mm; x=10mm+ keeps what "
                                              "lies above it, x=10mm- what lies below",
                                              text));
  plane.axis = axis[0] - 'x';
  std::string place = text.substr(at + 1);
  const std::array<double, 3> towards = view::direction_of(camera);
  plane.keep_above = towards[static_cast<std::size_t>(plane.axis)] < 0;
  if (place.ends_with('+') || place.ends_with('-')) {
    plane.keep_above = place.back() == '+';
    place.pop_back();
  }
  plane.at_m = static_cast<double>(parse_length(place)) * metres_per_nm;
  return plane;
}

int pixels(const std::string& text, const std::string& whole) {
  int value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size() || value < 1)
    throw Error(ErrorCode::usage, fmt::format("--size '{}': expected pixels, e.g. 1600x1000", whole));
  return value;
}

view::Rgb parse_rgb(const std::string& text) {
  unsigned value = 0;
  const auto [end, fault] = std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
  if (text.size() != 7 || fault != std::errc{} || end != text.data() + text.size())
    throw Error(ErrorCode::usage,
                fmt::format("--background '{}': take light, dark, transparent or a colour such as #ffffff", text));
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255),
          static_cast<std::uint8_t>(value & 255)};
}

view::Background parse_background(const std::string& text) {
  if (text == "light") return {};
  if (text == "dark") return {{28, 34, 42}, {13, 17, 22}, false};
  if (text == "transparent") return {{}, {}, true};
  if (!text.starts_with('#'))
    throw Error(ErrorCode::usage,
                fmt::format("--background '{}': take light, dark, transparent or a colour such as #ffffff", text));
  const view::Rgb colour = parse_rgb(text);
  return {colour, colour, false};
}

std::array<double, 4> parse_show_box(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 4)
    throw Error(ErrorCode::usage, fmt::format("--show-box '{}': expected four lengths xmin,ymin,xmax,ymax", text));
  std::array<double, 4> box{};
  for (std::size_t i = 0; i < 4; ++i) box[i] = static_cast<double>(parse_length(parts[i])) * metres_per_nm;
  if (box[0] >= box[2] || box[1] >= box[3]) throw Error(ErrorCode::usage, fmt::format("--show-box '{}' has no area", text));
  return box;
}

}  // namespace

std::shared_ptr<PictureFlags> add_picture_flags(CLI::App& command) {
  auto f = std::make_shared<PictureFlags>();
  constexpr const char* look = "Camera";
  command.add_option("--view", f->view, "iso (default), top, bottom, front, back, left or right")->group(look);
  command.add_option("--azimuth", f->azimuth, "Degrees round the board: 0 = from the front, 90 = from the right")->group(look);
  command.add_option("--elevation", f->elevation, "Degrees above the board: 90 = straight down")->group(look);
  command.add_option("--zoom", f->zoom, "1 (default) = everything fits")->check(CLI::Range(0.01, 10000.0))->group(look);
  command.add_option("--size", f->size, "Pixels, e.g. 1600x1000 (default)")->group(look);
  command.add_option("--explode", f->explode, "Set layers apart, e.g. 1")->check(CLI::Range(0.0, 100.0))->group(look);
  command.add_option("--thickness", f->thickness, "Stretch of z (default: so that a thin board still shows its layers)")
      ->check(CLI::Range(0.001, 1e6))
      ->group(look);
  command.add_option("--section", f->section, "Cut at a plane, e.g. y=12mm; y=12mm+ or y=12mm- says which side stays")
      ->group(look);
  constexpr const char* what = "What is shown";
  command
      .add_option("--colour,--color", f->colour,
                  "material (default; of cells without names: group), net, layer, group, tag, q_p, q_t or size")
      ->group(what);
  command.add_option("--edges", f->edges, "Mesh edges: fading (default: not where cells are tiny), on or off")
      ->check(CLI::IsMember({"fading", "on", "off"}))
      ->group(what);
  command.add_option("--layers", f->layers, "Only these layers, e.g. F.Cu,B.Cu")->group(what);
  command.add_option("--only-nets", f->show_nets, "Only these nets")->group(what);
  command.add_option("--hide", f->hidden, "Hide layers, materials, nets or groups by name, e.g. F.Mask")->group(what);
  command.add_option("--show-box", f->box, "Only cells in a box xmin,ymin,xmax,ymax")->group(what);
  command.add_flag("--show-air", f->show_air, "Air too; it is hidden otherwise")->group(what);
  command.add_option("--background", f->background, "light (default), dark, transparent or #rrggbb")->group(what);
  return f;
}

ShownNames shown_names(const mesh::PrismMesh& mesh) {
  ShownNames out{{mesh.layers().begin(), mesh.layers().end()}, {}, {mesh.nets().begin(), mesh.nets().end()}, {}};
  for (const board::Material& m : mesh.materials()) out.materials.push_back(m.name);
  const std::vector<char> air = view::air_groups(mesh);
  for (std::size_t i = 0; i < air.size(); ++i) {
    const mesh::VolumeTag& tag = mesh.volume_tags()[i];
    out.groups.push_back({tag.name, tag.layer, tag.material, tag.net, air[i] != 0});
  }
  return out;
}

ShownNames shown_names(const view::CellMesh& mesh) {
  ShownNames out{{mesh.layers().begin(), mesh.layers().end()}, {}, {mesh.nets().begin(), mesh.nets().end()}, {}};
  for (const board::Material& m : mesh.materials()) out.materials.push_back(m.name);
  for (const view::CellGroup& g : mesh.groups()) out.groups.push_back({g.name, g.layer, g.material, g.net, g.is_air});
  // Where nothing but air is there, air is what is to be seen.
  if (std::all_of(out.groups.begin(), out.groups.end(), [](const ShownNames::Group& g) { return g.is_air; }))
    for (ShownNames::Group& g : out.groups) g.is_air = false;
  return out;
}

std::optional<std::array<double, 4>> show_box(const PictureFlags& flags) {
  if (flags.box.empty()) return {};
  return parse_show_box(flags.box);
}

view::PictureOptions picture_options(const PictureFlags& flags, const ShownNames& names) {
  view::PictureOptions o;
  o.camera = view::parse_camera(flags.view);
  if (flags.azimuth != unset) o.camera.azimuth_deg = flags.azimuth;
  if (flags.elevation != unset) o.camera.elevation_deg = flags.elevation;
  o.camera.zoom = flags.zoom;
  if (!flags.size.empty()) {
    const std::vector<std::string> parts = split(flags.size, 'x');
    if (parts.size() != 2)
      throw Error(ErrorCode::usage, fmt::format("--size '{}': expected pixels, e.g. 1600x1000", flags.size));
    o.width = pixels(parts[0], flags.size);
    o.height = pixels(parts[1], flags.size);
  }
  o.explode = flags.explode;
  if (flags.thickness > 0) o.thickness_scale = flags.thickness;
  if (!flags.colour.empty()) o.colour = view::parse_colour_mode(flags.colour);
  if (flags.edges == "on") o.edges = view::Edges::on;
  if (flags.edges == "off") o.edges = view::Edges::off;
  o.background = parse_background(flags.background);
  o.visibility.hidden_groups = hidden_groups(flags, names);
  if (flags.explode > 0) o.visibility.mode = view::SkinMode::layers;
  if (!flags.section.empty()) o.visibility.section = parse_section(flags.section, o.camera);
  o.visibility.box_m = show_box(flags);
  return o;
}

}  // namespace pcbmesh::cli
