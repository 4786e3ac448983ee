// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
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
  bool is_stretched = false;   ///< of a perfectly matched layer above or below
  bool operator==(const Slab&) const = default;
};

enum class BodyKind {
  domain,  ///< body 0: the footprint of the meshed region; outside it nothing is meshed
  board,   ///< body 1: inside of the board outline, cut-outs excluded
  copper,  ///< tracks, pads, fills of one net on one copper slab
  hole,    ///< unplated hole: material of the body (air), or void if material is -1
  barrel,  ///< plated hole: copper of its net
  filler,  ///< air or dielectric that takes a place of its own: inside of a tube, backdrilled hole, mask over copper
  shell,   ///< perfectly matched layers beside the domain: fills nothing, its edges are kept straight
  port     ///< footprint of a port: likewise
};

/// Axes along which a perfectly matched layer stretches its coordinates.
inline constexpr std::uint8_t stretched_x = 1, stretched_y = 2, stretched_z = 4;

/// Where a conductor without thickness lies.
struct SheetPlace {
  std::int32_t face = 0;  ///< face f is the bottom of slab f; face num_slabs is the top of the last slab
  std::string layer;      ///< its copper layer, which may have no slab
  Nm thickness_nm = 0;    ///< of the copper it stands for
  bool operator==(const SheetPlace&) const = default;
};

/// A plane set extruded through a contiguous range of slabs; its shapes are drawn in `shapes`. A sheet is at one face instead,
/// and its slabs are a slab beside that face.
struct Body {
  std::string name;  ///< for messages, e.g. "copper GND on F.Cu"
  BodyKind kind = BodyKind::copper;
  std::int32_t material = -1;
  std::int32_t net = board::no_net;
  std::int32_t first_slab = 0;        ///< lowest slab
  std::int32_t last_slab = 0;         ///< highest slab, >= first_slab
  std::int32_t priority = 0;          ///< the highest present wins; ties: the lower body index
  bool hollow = false;                ///< not meshed, skin tagged surface|net
  std::uint8_t stretched = 0;         ///< shell: stretched_x or stretched_y
  std::optional<SheetPlace> sheet{};  ///< copper: no thickness, its faces tagged sheet|net
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

/// What holds on a side of the domain.
enum class SideKind { none, absorbing, pec, pmc, impedance, periodic };
struct SideCondition {
  SideKind kind = SideKind::none;
  double ohms = 0;  ///< kind impedance
  bool operator==(const SideCondition&) const = default;
};
/// Sides in this order: xmin, xmax, ymin, ymax, zmin, zmax, and all other outer walls.
inline constexpr std::size_t num_sides = 7;

enum class PortFaces {
  wall,  ///< upright: over the part of the footprint's edge that is `line`, through the footprint's slabs
  cap    ///< flat: the footprint at face `face`
};

/// Port between two conductors, or on the hull.
struct Port {
  std::string name;
  std::int64_t study_index = 0;  ///< place in the study's list, for messages
  bool is_wave = false;
  bool is_coaxial = false;  ///< a cap whose footprint is a ring
  double impedance_ohm = 50;
  bool is_excited = true;
  std::int32_t positive_net = board::no_net;
  std::int32_t negative_net = board::no_net;
  std::int32_t body = 0;  ///< its footprint
  PortFaces faces = PortFaces::wall;
  std::array<geometry::Point, 2> line{};     ///< wall: the segment it stands on
  std::int32_t face = 0;                     ///< cap
  std::array<double, 3> direction{0, 0, 1};  ///< from the negative to the positive terminal; coaxial: 0
  double length_m = 0;                       ///< along direction; coaxial: outer less inner radius
  double width_m = 0;                        ///< across; coaxial: 2 pi length / ln(outer / inner)
  double area_m2 = 0;                        ///< lumped: of its faces
  double positive_edge_m = 0;                ///< lumped: length of its edge on the positive terminal
  double negative_edge_m = 0;                ///< lumped: on the negative terminal
  double longest_edge_m = 0;                 ///< study's bound on edges of its faces; 0 = none
  std::array<double, 3> at_m{};              ///< middle
};

/// Perfectly matched layers round the domain: between two boxes, which coincide on sides without any.
struct Shell {
  geometry::Box inner, outer;
  std::array<Nm, 2> inner_z{}, outer_z{};  ///< bottom, top
  int order = 2;                           ///< the stretch grows with the depth to this power
};

struct ModelParts {
  std::string source;
  std::vector<board::Material> materials;
  std::vector<std::string> nets;
  std::vector<Slab> slabs;
  std::vector<Body> bodies;  ///< [0] domain, [1] board
  std::vector<BodyShape> shapes;
  std::vector<std::int32_t> nets_of_interest;      ///< nets named by the study; empty = all
  Nm narrowest_feature_nm = 0;                     ///< smallest pen, hole or pad width of the copper in the domain; 0 = unknown
  Nm narrowest_of_interest_nm = 0;                 ///< the same for nets_of_interest
  std::vector<geometry::OutlineCircle> circles{};  ///< that outlines may follow, ascending; only if the study asks for order 2
  std::vector<Port> ports;
  std::array<SideCondition, num_sides> sides{};
  std::vector<geometry::Point> outline;      ///< of a polygonal domain: corners, side k from corner k to the next; else empty
  std::vector<SideCondition> outline_sides;  ///< one per corner
  std::optional<Shell> shell{};
  bool conductors_are_perfect = false;  ///< hollow and sheet conductors: PEC, not lossy copper
};

/// What fills one cell: region x slab.
struct Label {
  std::int32_t material = -1;  ///< -1 = void
  std::int32_t net = board::no_net;
  std::int32_t hollow_net = -2;  ///< void because of a hollow conductor: its net (may be no_net); -2 = not so
  std::uint8_t stretched = 0;    ///< axes of a perfectly matched layer
  [[nodiscard]] bool is_void() const { return material < 0; }
  friend auto operator<=>(const Label&, const Label&) = default;
};

/// The domain to be meshed.
///
/// @guarantee M1  slabs are contiguous, bottom to top, each of positive height
/// @guarantee M2  bodies[0] is the domain and bodies[1] the board, both through all slabs; every body names existing slabs,
/// materials, nets
/// @guarantee M3  every shape names an existing body and has at least one ring
/// @guarantee M4  bodies of the shell come last but for those of ports; every port has one, and every such body a port
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
  [[nodiscard]] std::span<const Port> ports() const { return parts_->ports; }
  /// Index of the first body that fills nothing, of the shell or a port; the number of bodies if there is none.
  [[nodiscard]] std::int32_t first_guide_body() const { return first_guide_; }
  [[nodiscard]] const std::array<SideCondition, num_sides>& sides() const { return parts_->sides; }
  [[nodiscard]] std::span<const geometry::Point> outline() const { return parts_->outline; }
  [[nodiscard]] std::span<const SideCondition> outline_sides() const { return parts_->outline_sides; }
  [[nodiscard]] const std::optional<Shell>& shell() const { return parts_->shell; }
  [[nodiscard]] bool conductors_are_perfect() const { return parts_->conductors_are_perfect; }

  /// Net name, or "no net".
  [[nodiscard]] std::string_view net_name(std::int32_t net) const;

  /// What fills slab `slab` where exactly the bodies `present` (ascending indices) cover the plane.
  /// Outside the domain: void. Outside the board: slab.outside. Else the body of highest priority, else slab.material.
  /// @cost O(present).
  [[nodiscard]] Label resolve(std::int32_t slab, std::span<const std::int32_t> present) const;
  /// Sheet at face `face` where exactly the bodies `present` cover the plane: its index, or -1. Copper, barrels, holes and
  /// cut-outs beside the face take its place. @cost O(present).
  [[nodiscard]] std::int32_t sheet_at(std::int32_t face, std::span<const std::int32_t> present) const;

 private:
  /// Body of highest priority in a slab, or -1.
  [[nodiscard]] std::int32_t top_body(std::int32_t slab, std::span<const std::int32_t> present) const;
  std::shared_ptr<const ModelParts> parts_;
  std::int32_t first_guide_ = 0;
};

}  // namespace pcbmesh::model
