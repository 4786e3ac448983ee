// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/view/cell_mesh.hpp"
#include "pcbmesh/view/render.hpp"

namespace pcbmesh::cli {

/// The flags of a picture, as typed.
struct PictureFlags {
  std::string view = "iso", colour, edges, size, section, background = "light", mode;
  std::vector<std::string> layers, show_nets, hidden;
  double azimuth = 1e9, elevation = 1e9, zoom = 1, explode = 0, thickness = 0;
  std::string box;
  bool show_air = false;
};

/// Adds the flags to a command.
[[nodiscard]] std::shared_ptr<PictureFlags> add_picture_flags(CLI::App& command);

/// What can be shown and hidden in a mesh, by name.
struct ShownNames {
  std::vector<std::string> layers, materials, nets;
  struct Group {
    std::string name;
    std::int32_t layer = -1, material = -1, net = -1;  ///< -1 = none or not known
    bool is_air = false;
  };
  std::vector<Group> groups;
};
[[nodiscard]] ShownNames shown_names(const mesh::PrismMesh& mesh);
[[nodiscard]] ShownNames shown_names(const view::CellMesh& mesh);

/// The box of --show-box, if there is one. @throws Error usage (101).
[[nodiscard]] std::optional<std::array<double, 4>> show_box(const PictureFlags& flags);
/// Flags resolved against a mesh's names. An empty colour is left as it is in PictureOptions.
/// @throws Error usage (101), name_unknown (304) with the near misses.
[[nodiscard]] view::PictureOptions picture_options(const PictureFlags& flags, const ShownNames& names);

}  // namespace pcbmesh::cli
