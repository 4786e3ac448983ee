// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/geometry/path.hpp"

namespace pcbmesh::model {

enum class SlabKind { air, dielectric, copper };

/// Horizontal slice of the domain between two z planes. Slabs are stored bottom to top.
struct Slab {
  std::string layer;  ///< name of the board layer, or "air below", "air above"
  SlabKind kind = SlabKind::dielectric;
  Nm z_bottom_nm = 0;
  Nm z_top_nm = 0;             ///< > z_bottom_nm
  std::int32_t material = -1;  ///< inside the board outline, where no body is: index into materials
  std::int32_t outside = -1;   ///< outside the board outline: material, or -1 = not meshed
  bool operator==(const Slab&) const = default;
};

enum class BodyKind {
  domain,  ///< body 0: the footprint of the meshed region; outside it nothing is meshed
  board,   ///< body 1: inside of the board outline, cut-outs excluded
  copper,  ///< tracks, pads, fills of one net on one copper slab
  hole,    ///< unplated hole: material of the body (air), or void if material is -1
  barrel   ///< plated hole: filled with copper of its net
};

/// A plane set extruded through a contiguous range of slabs; its shapes are drawn in `shapes`.
struct Body {
  std::string name;  ///< for messages, e.g. "copper GND on F.Cu"
  BodyKind kind = BodyKind::copper;
  std::int32_t material = -1;
  std::int32_t net = board::no_net;
  std::int32_t first_slab = 0;  ///< lowest slab
  std::int32_t last_slab = 0;   ///< highest slab, >= first_slab
  std::int32_t priority = 0;    ///< the highest present wins; ties: the lower body index
  bool hollow = false;          ///< not meshed, skin tagged surface|net
  bool operator==(const Body&) const = default;
};

/// Rings that belong to one body. The body covers the union of its shapes.
struct BodyShape {
  std::int32_t body = 0;
  std::vector<geometry::Ring> rings;  ///< non-zero winding
  bool simple = true;                 ///< false: winding may be negative; the overlay normalises it on its own
  std::int64_t line = 0;              ///< in the board file
  bool operator==(const BodyShape&) const = default;
};

struct ModelParts {
  std::string source;
  std::vector<board::Material> materials;
  std::vector<std::string> nets;
  std::vector<Slab> slabs;
  std::vector<Body> bodies;  ///< [0] domain, [1] board
  std::vector<BodyShape> shapes;
  std::vector<std::int32_t> nets_of_interest;  ///< nets named by the study; empty = all
  Nm narrowest_feature_nm = 0;                 ///< smallest pen, hole or pad width of the copper in the domain; 0 = unknown
  Nm narrowest_of_interest_nm = 0;             ///< the same for nets_of_interest
  std::vector<geometry::OutlineCircle> circles{};  ///< that outlines may follow, ascending; only if the study asks for order 2
};

/// What fills one cell: region x slab.
struct Label {
  std::int32_t material = -1;  ///< -1 = void
  std::int32_t net = board::no_net;
  std::int32_t hollow_net = -2;  ///< void because of a hollow conductor: its net (may be no_net); -2 = not so
  [[nodiscard]] bool is_void() const { return material < 0; }
  friend auto operator<=>(const Label&, const Label&) = default;
};

/// The domain to be meshed.
///
/// @guarantee M1  slabs are contiguous, bottom to top, each of positive height
/// @guarantee M2  bodies[0] is the domain and bodies[1] the board, both through all slabs; every body names existing slabs,
/// materials, nets
/// @guarantee M3  every shape names an existing body and has at least one ring
class Model {
 public:
  /// @throws Error internal (901) when an invariant is broken: only compose() builds models.
  [[nodiscard]] static Model from_parts(ModelParts parts);

  [[nodiscard]] const std::string& source() const { return parts_->source; }
  [[nodiscard]] std::span<const board::Material> materials() const { return parts_->materials; }
  [[nodiscard]] std::span<const std::string> nets() const { return parts_->nets; }
  [[nodiscard]] std::span<const Slab> slabs() const { return parts_->slabs; }
  [[nodiscard]] std::span<const Body> bodies() const { return parts_->bodies; }
  [[nodiscard]] std::span<const BodyShape> shapes() const { return parts_->shapes; }
  [[nodiscard]] std::span<const std::int32_t> nets_of_interest() const { return parts_->nets_of_interest; }
  [[nodiscard]] std::span<const geometry::OutlineCircle> circles() const { return parts_->circles; }
  [[nodiscard]] Nm narrowest_feature_nm() const { return parts_->narrowest_feature_nm; }
  [[nodiscard]] Nm narrowest_of_interest_nm() const { return parts_->narrowest_of_interest_nm; }

  /// Net name, or "no net".
  [[nodiscard]] std::string_view net_name(std::int32_t net) const;

  /// What fills slab `slab` where exactly the bodies `present` (ascending indices) cover the plane.
  /// Outside the domain: void. Outside the board: slab.outside. Else the body of highest priority, else slab.material.
  /// @cost O(present).
  [[nodiscard]] Label resolve(std::int32_t slab, std::span<const std::int32_t> present) const;

 private:
  std::shared_ptr<const ModelParts> parts_;
};

}  // namespace pcbmesh::model
