// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/view/render.hpp"

namespace pcbmesh::cli {

/// The flags of a picture, as typed.
struct PictureFlags {
  std::string view = "iso", colour = "material", edges, size, section, background = "light", mode;
  std::vector<std::string> layers, show_nets, hidden;
  double azimuth = 1e9, elevation = 1e9, zoom = 1, explode = 0, thickness = 0;
  std::string box;
  bool show_air = false;
};

/// Adds the flags to a command.
[[nodiscard]] std::shared_ptr<PictureFlags> add_picture_flags(CLI::App& command);

/// Flags resolved against a mesh's names. @throws Error usage (101), name_unknown (304) with the near misses.
[[nodiscard]] view::PictureOptions picture_options(const PictureFlags& flags, const mesh::PrismMesh& mesh);

}  // namespace pcbmesh::cli
