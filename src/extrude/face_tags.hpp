// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "pcbmesh/mesh/prism_mesh.hpp"
#include "pcbmesh/model/model.hpp"

namespace pcbmesh::extrude {

/// Sides of the meshed box, in the order of model::ModelParts::sides but with z first: the order of the tags.
enum Side : std::int32_t { zmin, zmax, xmin, xmax, ymin, ymax, side, num_sides };

/// Provisional face tags, in the order in which those in use are listed: sides, sides of a polygonal domain, skins of hollow
/// conductors by net, sheets by net, sheets on the hull by net, ports.
class TagSpace {
 public:
  explicit TagSpace(const model::Model& model)
      : num_outline_(static_cast<std::int32_t>(model.outline().size())),
        num_nets_(static_cast<std::int32_t>(model.nets().size()) + 1),
        num_ports_(static_cast<std::int32_t>(model.ports().size())) {}
  [[nodiscard]] std::int32_t outline_side(std::int32_t number) const { return num_sides + number; }
  [[nodiscard]] std::int32_t surface(std::int32_t net) const { return num_sides + num_outline_ + 1 + net; }
  [[nodiscard]] std::int32_t inner_sheet(std::int32_t net) const { return surface(net) + num_nets_; }
  [[nodiscard]] std::int32_t outer_sheet(std::int32_t net) const { return surface(net) + 2 * num_nets_; }
  [[nodiscard]] std::int32_t port(std::int32_t index) const { return num_sides + num_outline_ + 3 * num_nets_ + index; }
  [[nodiscard]] std::int32_t size() const { return port(num_ports_); }
  /// Port of a tag, or -1.
  [[nodiscard]] std::int32_t port_of(std::int32_t tag) const { return tag < port(0) ? -1 : tag - port(0); }

  /// The tag itself, with name, kind, net and condition; not its id, counts and is_inner of ports.
  [[nodiscard]] mesh::FaceTag describe(std::int32_t tag, const model::Model& model) const;

 private:
  std::int32_t num_outline_, num_nets_, num_ports_;
};

}  // namespace pcbmesh::extrude
