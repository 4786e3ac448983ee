// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pcbmesh/formats/registry.hpp"
#include "src/cli/commands.hpp"

namespace pcbmesh::cli {
namespace {

using formats::KindSet;
using formats::MeshFormat;
using mesh::ElementKind;

std::vector<ElementKind> kinds_of(KindSet set) {
  std::vector<ElementKind> out;
  for (int i = 0; i <= static_cast<int>(ElementKind::wedge18); ++i)
    if (const auto kind = static_cast<ElementKind>(i); formats::holds(set, kind)) out.push_back(kind);
  return out;
}

/// "1", "1 and 2", or "-".
std::string orders_of(KindSet set) {
  bool has[3] = {};
  for (const ElementKind kind : kinds_of(set)) has[mesh::order_of(kind)] = true;
  return has[1] && has[2] ? "1, 2" : has[1] ? "1" : has[2] ? "2" : "-";
}

std::string yes(bool value) {
  return value ? "yes" : "-";
}

/// "triangle, quadrangle (8), tetrahedron, wedge (15, 18)": one word per shape, nodes of second order behind it.
std::string shapes_of(KindSet set) {
  constexpr std::pair<ElementKind, std::string_view> shapes[] = {
      {ElementKind::triangle, "triangle"}, {ElementKind::quadrangle, "quadrangle"}, {ElementKind::tetrahedron, "tetrahedron"},
      {ElementKind::pyramid, "pyramid"},   {ElementKind::wedge, "wedge"},           {ElementKind::hexahedron, "hexahedron"}};
  std::string out;
  for (const auto& [first_order, name] : shapes) {
    if (!formats::holds(set, first_order)) continue;
    std::string second;
    for (const ElementKind kind : kinds_of(set))
      if (kind != first_order && mesh::dimension_of(kind) == mesh::dimension_of(first_order) &&
          mesh::corners_of(kind) == mesh::corners_of(first_order))
        second += fmt::format("{}{}", second.empty() ? "" : ", ", mesh::nodes_of(kind));
    out += fmt::format("{}{}{}", out.empty() ? "" : ", ", name, second.empty() ? "" : " (" + second + ")");
  }
  return out.empty() ? "-" : out;
}

nlohmann::ordered_json names_of(KindSet set) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const ElementKind kind : kinds_of(set)) out.push_back(mesh::name_of(kind));
  return out;
}

int print_json() {
  nlohmann::ordered_json out{{"boards", nlohmann::ordered_json::array()}, {"meshes", nlohmann::ordered_json::array()}};
  for (const formats::BoardFormat* f : formats::board_formats())
    out["boards"].push_back({{"name", f->name}, {"title", f->title}, {"extensions", f->extensions}});
  for (const MeshFormat* f : formats::mesh_formats())
    out["meshes"].push_back({{"name", f->name},
                             {"title", f->title},
                             {"extensions", f->extensions},
                             {"write", f->write != nullptr},
                             {"read", f->read != nullptr},
                             {"kinds_written", names_of(f->scope.written)},
                             {"kinds_read", names_of(f->scope.readable)},
                             {"tags", f->scope.has_tags},
                             {"names", f->scope.has_names},
                             {"folder", f->scope.is_folder}});
  fmt::print("{}\n", out.dump(2));
  return 0;
}

/// The table as README shows it.
int print_markdown() {
  fmt::print("| format | endings | write | read | orders written | elements (nodes of second order) | tags | names |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  for (const MeshFormat* f : formats::mesh_formats())
    fmt::print("| {} | `{}` | {} | {} | {} | {} | {} | {} |\n", f->title, fmt::join(f->extensions, "` `"),
               yes(f->write != nullptr), yes(f->read != nullptr), orders_of(f->scope.written), shapes_of(f->scope.written),
               yes(f->scope.has_tags), yes(f->scope.has_names));
  return 0;
}

int print_text() {
  fmt::print("Boards (read)\n");
  for (const formats::BoardFormat* f : formats::board_formats())
    fmt::print("  {:<12} {:<24} {}\n", f->name, fmt::format("{}", fmt::join(f->extensions, " ")), f->title);
  fmt::print("  Boards and meshes may be packed: .gz and .xz are unpacked on the fly.\n\nMeshes\n");
  fmt::print("  {:<9} {:<13} {:<6} {:<5} {:<7} {:<5} {:<6} {}\n", "", "endings", "write", "read", "orders", "tags", "names",
             "");
  for (const MeshFormat* f : formats::mesh_formats())
    fmt::print("  {:<9} {:<13} {:<6} {:<5} {:<7} {:<5} {:<6} {}\n", f->name, fmt::format("{}", fmt::join(f->extensions, " ")),
               yes(f->write != nullptr), yes(f->read != nullptr), orders_of(f->scope.written), yes(f->scope.has_tags),
               yes(f->scope.has_names), f->title);
  fmt::print("\nElements written (nodes of second order)\n");
  for (const MeshFormat* f : formats::mesh_formats()) fmt::print("  {:<9} {}\n", f->name, shapes_of(f->scope.written));
  return 0;
}

}  // namespace

Command add_formats_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("formats", "List the formats that can be read and written, and what they hold");
  auto as_json = std::make_shared<bool>(false), as_markdown = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "Print JSON");
  command->add_flag("--markdown", *as_markdown, "Print the table of mesh formats for a document");
  return {command, [as_json, as_markdown] { return *as_json ? print_json() : *as_markdown ? print_markdown() : print_text(); }};
}

}  // namespace pcbmesh::cli
