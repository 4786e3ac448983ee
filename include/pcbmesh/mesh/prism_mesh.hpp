// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/board/board.hpp"
#include "pcbmesh/mesh/layer_plan.hpp"
#include "pcbmesh/mesh/planar_mesh.hpp"

namespace pcbmesh::mesh {

/// One volume group: all prisms of one (layer, material, net), and of one set of stretched axes.
struct VolumeTag {
  std::int32_t id = 0;     ///< 1-based, dense
  std::string name;        ///< "layer|material|net", net "none" where there is none; "...|pml xy" where x and y are stretched
  std::int32_t layer = 0;  ///< index into layers
  std::int32_t material = 0;   ///< index into materials
  std::int32_t net = -1;       ///< index into nets, or -1
  std::uint8_t stretched = 0;  ///< axes of a perfectly matched layer: 1 x, 2 y, 4 z; 0 = none
  std::int64_t num_prisms = 0;
  double volume_m3 = 0;
};

enum class FaceTagKind {
  outer,      ///< hull of the domain
  conductor,  ///< skin of a hollow conductor
  sheet,      ///< conductor of no thickness
  port,       ///< lumped port
  wave_port,  ///< wave port, on the hull
  interface   ///< between two volume groups, on request
};
[[nodiscard]] std::string_view name_of(FaceTagKind kind);

/// What holds on a face group.
enum class BoundaryCondition {
  none,       ///< nothing is said: a solver's natural condition
  absorbing,  ///< first-order absorbing boundary
  pec,        ///< perfect electric conductor
  pmc,        ///< perfect magnetic conductor
  impedance,  ///< surface impedance of FaceTag::impedance_ohm
  conductor,  ///< lossy conductor of FaceTag::material
  port,       ///< FaceTag::port
  periodic    ///< partner of FaceTag::partner
};
[[nodiscard]] std::string_view name_of(BoundaryCondition condition);

/// One face group.
struct FaceTag {
  std::int32_t id = 0;  ///< 1-based, dense, own number space beside the volumes
  std::string name;     ///< "xmin".."zmax", "side" (all other outer faces), "surface|net", "sheet|net", "port|name" ...
  FaceTagKind kind = FaceTagKind::outer;
  std::int32_t net = -1;
  bool is_inner = false;  ///< all its faces lie between two prisms; else none does
  BoundaryCondition condition = BoundaryCondition::none;
  double impedance_ohm = 0;    ///< condition impedance
  std::int32_t material = -1;  ///< condition conductor: index into materials
  double thickness_m = 0;      ///< sheet: thickness of the copper it stands for
  std::int32_t port = -1;      ///< condition port: index into ports
  std::int32_t partner = -1;   ///< condition periodic: index into face_tags
  std::int64_t num_triangles = 0;
  std::int64_t num_quads = 0;
  double area_m2 = 0;
};

/// Perfectly matched layers: between two boxes, which coincide on sides without any. The stretch of an axis grows from 0 at
/// the inner box with the depth over the thickness, to the power `order`.
struct Shell {
  std::array<double, 3> inner_min_m{}, inner_max_m{}, outer_min_m{}, outer_max_m{};
  int order = 2;
};

/// "x", "yz" ...; empty for 0.
[[nodiscard]] std::string axes_text(std::uint8_t stretched);

enum class PortKind {
  lumped,  ///< a rectangle between two conductors
  wave,    ///< on the hull
  coaxial  ///< a flat ring round a barrel: lumped, its field radial
};
[[nodiscard]] std::string_view name_of(PortKind kind);

/// A port: one or several face groups, from its positive to its negative terminal.
struct Port {
  std::string name;
  PortKind kind = PortKind::lumped;
  double impedance_ohm = 50;
  bool is_excited = true;
  std::array<double, 3> direction{0, 0, 1};  ///< lumped: unit vector of the field, from negative to positive terminal;
                                             ///< coaxial: 0, for the field points to the axis through at_m
  double length_m = 0;                       ///< lumped: distance of the terminals, along direction; coaxial: b - a
  double width_m = 0;                        ///< lumped: extent across; coaxial: 2 pi (b - a) / ln(b / a) of its radii
  std::int32_t positive_net = -1;            ///< net at the positive terminal, -1 = none
  std::int32_t negative_net = -1;            ///< reference net
  std::array<double, 3> at_m{};              ///< middle of the port
};

/// Horizontal tagged face: triangle `triangle` at level `level`. On the boundary `up` = its outward normal points to +z;
/// between two prisms `up` is true.
struct Cap {
  std::int32_t tag = 0;  ///< index into face_tags
  std::int32_t level = 0;
  std::int32_t triangle = 0;
  bool up = false;
};

/// Vertical tagged face over planar edge a->b, one per sub-layer of `slab`; on the boundary the meshed side is to the left of
/// a->b, so that the outward normal points to the right.
struct Wall {
  std::int32_t tag = 0;
  std::int32_t slab = 0;
  std::int32_t a = 0;
  std::int32_t b = 0;
};

struct PrismMeshParts {
  PlanarMesh planar;
  LayerPlan plan;
  std::vector<std::string> layers;  ///< layer names, one per distinct name, bottom to top
  std::vector<board::Material> materials;
  std::vector<std::string> nets;
  std::vector<VolumeTag> volume_tags;  ///< sorted by first slab, then material, then net
  std::vector<FaceTag> face_tags;
  std::vector<std::int32_t> column_tags;  ///< [region * num_slabs + slab]: index into volume_tags, or -1 = void
  std::vector<Cap> caps;                  ///< sorted by (tag, level, triangle)
  std::vector<Wall> walls;                ///< sorted by (tag, slab, a, b)
  std::vector<std::int32_t> net_pieces;   ///< per net: connected pieces of its copper by the exact layout; -1 = not known
  std::vector<std::array<std::int32_t, 2>> touching_nets;  ///< pairs of nets that touch in the layout itself
  std::vector<Port> ports;
  std::optional<Shell> shell{};  ///< set if some volume tag is stretched
};

/// The mesh: PlanarMesh x LayerPlan x label table. Implicit: ids by arithmetic, nodes and cells computed on demand.
/// Void cells (hollow conductors, cut-outs without air) are absent, and ids are dense all the same.
///
/// Node of planar vertex v at level k: node_id(k, v). Prism over triangle t in sub-layer s: prism_id(s, t), corners
/// (bottom 0 1 2 counter-clockwise seen from above, top 3 4 5): positive Jacobian in Gmsh order.
///
/// @guarantee X1  memory is O(planar mesh + regions x slabs + boundary faces of one sub-layer per slab), never O(prisms)
/// @guarantee X2  node and prism ids are 0..n-1, ascending in (level, vertex) and (sub-layer, triangle)
/// @guarantee X3  every face between a prism and a void or the outside is in exactly one of caps and walls; faces between two
/// prisms may be, once, under a tag that is_inner
class PrismMesh {
 public:
  /// @throws Error internal (901). @cost O(planar mesh x distinct slab masks + boundary faces x log).
  [[nodiscard]] static PrismMesh from_parts(PrismMeshParts parts);

  [[nodiscard]] const PlanarMesh& planar() const { return parts_->planar; }
  [[nodiscard]] const LayerPlan& plan() const { return parts_->plan; }
  [[nodiscard]] std::span<const std::string> layers() const { return parts_->layers; }
  [[nodiscard]] std::span<const board::Material> materials() const { return parts_->materials; }
  [[nodiscard]] std::span<const std::string> nets() const { return parts_->nets; }
  [[nodiscard]] std::span<const VolumeTag> volume_tags() const { return parts_->volume_tags; }
  [[nodiscard]] std::span<const FaceTag> face_tags() const { return parts_->face_tags; }
  [[nodiscard]] std::span<const Cap> caps() const { return parts_->caps; }
  [[nodiscard]] std::span<const Wall> walls() const { return parts_->walls; }
  [[nodiscard]] std::span<const std::int32_t> net_pieces() const { return parts_->net_pieces; }
  [[nodiscard]] std::span<const std::array<std::int32_t, 2>> touching_nets() const { return parts_->touching_nets; }
  [[nodiscard]] std::span<const Port> ports() const { return parts_->ports; }
  [[nodiscard]] const std::optional<Shell>& shell() const { return parts_->shell; }

  [[nodiscard]] std::int64_t num_nodes() const { return num_nodes_; }
  [[nodiscard]] std::int64_t num_prisms() const { return num_prisms_; }
  /// Tagged faces: caps, and walls times sub-layers.
  [[nodiscard]] std::int64_t num_tagged_triangles() const;
  [[nodiscard]] std::int64_t num_tagged_quads() const;

  /// Index into volume_tags, or -1 if (slab, triangle) is void. @cost O(1).
  [[nodiscard]] std::int32_t tag_of(std::int32_t slab, std::int32_t triangle) const;
  /// Id of an existing node / prism. @cost O(1). REQUIRES the node / prism to exist.
  [[nodiscard]] std::int64_t node_id(std::int32_t level, std::int32_t vertex) const;
  [[nodiscard]] std::int64_t prism_id(std::int32_t sublayer, std::int32_t triangle) const;
  [[nodiscard]] bool has_node(std::int32_t level, std::int32_t vertex) const;
  /// Number of nodes of one level, and id of its first node.
  [[nodiscard]] std::int64_t num_nodes_of_level(std::int32_t level) const;
  [[nodiscard]] std::int64_t first_node_of_level(std::int32_t level) const;
  /// Number of prisms of one sub-layer, and id of its first prism.
  [[nodiscard]] std::int64_t num_prisms_of_sublayer(std::int32_t sublayer) const;
  [[nodiscard]] std::int64_t first_prism_of_sublayer(std::int32_t sublayer) const;

  /// Coordinates in metres of nodes [first, first + out.size()). @cost O(out + log levels + block search).
  void fill_nodes(std::int64_t first, std::span<std::array<double, 3>> out) const;
  /// Corners (node ids) of prisms [first, first + out.size()), and the tag index of each if `tags` is not empty.
  /// Safe to call from several threads. @cost O(out + log sub-layers + block search).
  void fill_prisms(std::int64_t first, std::span<std::array<std::int64_t, 6>> out, std::span<std::int32_t> tags = {}) const;
  /// Triangles of the planar mesh that carry each tag in one slab, grouped: offsets has volume_tags().size() + 1 entries.
  /// Ascending within a tag. @cost O(triangles + tags).
  void group_triangles(std::int32_t slab, std::vector<std::int32_t>& offsets, std::vector<std::int32_t>& triangles) const;

 private:
  /// Subset of 0..n-1 with constant-time rank: bit words and one running count per word. Empty words = the full set.
  struct Mask {
    std::vector<std::uint64_t> words;
    std::vector<std::int32_t> ranks;  ///< members before each word
    std::int32_t size = 0;            ///< members
    [[nodiscard]] bool is_full() const { return words.empty(); }
    [[nodiscard]] bool has(std::int32_t i) const;
    [[nodiscard]] std::int32_t rank(std::int32_t i) const;
    /// Calls visit(i) for members of rank first .. first + count - 1, ascending.
    template <class Visit>
    void visit(std::int64_t first, std::int64_t count, Visit&& visit) const;
  };
  /// Mask from one byte per item; a full set keeps no words.
  [[nodiscard]] static Mask mask_of(std::span<const char> members);
  void make_masks();
  void fill_sublayer(std::int32_t sublayer, std::int64_t rank, std::span<std::array<std::int64_t, 6>> out) const;
  [[nodiscard]] const Mask& level_mask(std::int32_t level) const;
  [[nodiscard]] const Mask& sublayer_mask(std::int32_t sublayer) const;

  std::shared_ptr<const PrismMeshParts> parts_;
  std::shared_ptr<const std::vector<Mask>> masks_;
  std::vector<std::int32_t> mask_of_level_, mask_of_sublayer_;
  std::vector<std::int64_t> first_node_, first_prism_;  ///< per level / sub-layer, plus one
  std::int64_t num_nodes_ = 0, num_prisms_ = 0;
};

}  // namespace pcbmesh::mesh
