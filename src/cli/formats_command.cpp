// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "pcbmesh/formats/registry.hpp"
#include "src/cli/commands.hpp"

namespace pcbmesh::cli {

Command add_formats_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("formats", "List the formats that can be read and written");
  auto as_json = std::make_shared<bool>(false);
  command->add_flag("--json", *as_json, "Print JSON");
  return {
      command, [as_json] {
        if (*as_json) {
          nlohmann::ordered_json out{{"boards", nlohmann::ordered_json::array()}, {"meshes", nlohmann::ordered_json::array()}};
          for (const formats::BoardFormat* f : formats::board_formats())
            out["boards"].push_back({{"name", f->name}, {"title", f->title}, {"extensions", f->extensions}});
          for (const formats::MeshFormat* f : formats::mesh_formats())
            out["meshes"].push_back({{"name", f->name},
                                     {"title", f->title},
                                     {"extensions", f->extensions},
                                     {"write", f->write != nullptr},
                                     {"read", f->read != nullptr}});
          fmt::print("{}\n", out.dump(2));
          return 0;
        }
        fmt::print("Boards (read)\n");
        for (const formats::BoardFormat* f : formats::board_formats())
          fmt::print("  {:<12} {:<24} {}\n", f->name, fmt::format("{}", fmt::join(f->extensions, " ")), f->title);
        fmt::print("  Boards may be packed: .gz and .xz are unpacked on the fly.\n\nMeshes\n");
        for (const formats::MeshFormat* f : formats::mesh_formats())
          fmt::print("  {:<12} {:<24} {:<5} {:<4} {}\n", f->name, fmt::format("{}", fmt::join(f->extensions, " ")),
                     f->write != nullptr ? "write" : "", f->read != nullptr ? "read" : "", f->title);
        return 0;
      }};
}

}  // namespace pcbmesh::cli
