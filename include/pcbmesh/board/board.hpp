// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/dispersion.hpp"
#include "pcbmesh/base/units.hpp"
#include "pcbmesh/geometry/path.hpp"

namespace pcbmesh::board {

inline constexpr std::int32_t no_net = -1;

/// Electrical material. Relative values; conductivity in S/m.
struct Material {
  std::string name;
  double eps_r = 1.0;
  double tan_delta = 0.0;
  double mu_r = 1.0;
  double sigma_s_per_m = 0.0;
  Dispersion dispersion{};  ///< not constant: eps_r and tan_delta are its values at `at_hz`
  double at_hz = 0;         ///< frequency of eps_r and tan_delta; 0 = not stated
  Roughness roughness{};    ///< of its surface, for conductors
  bool is_assumed = false;  ///< the board does not state eps_r; a usual value was taken
  std::string source{};     ///< where the numbers come from, if from a library
  bool operator==(const Material&) const = default;
};

enum class LayerKind { copper, dielectric, solder_mask };

/// One layer of the stackup.
struct StackupLayer {
  std::string name;       ///< canonical name, e.g. "F.Cu", "dielectric 1"
  std::string user_name;  ///< name the designer gave, may be empty
  LayerKind kind = LayerKind::dielectric;
  Nm thickness_nm = 0;         ///< > 0
  std::int32_t material = -1;  ///< index into materials
  bool operator==(const StackupLayer&) const = default;
};

enum class ShapeKind { track, via, pad, fill, graphic };
[[nodiscard]] std::string_view name_of(ShapeKind kind);

/// Copper on one layer.
struct Shape {
  std::int32_t copper_layer = 0;  ///< 0 = top, counts copper layers only
  std::int32_t net = no_net;      ///< index into nets, or no_net
  ShapeKind kind = ShapeKind::track;
  geometry::Figure figure;
  std::int64_t line = 0;  ///< where it stands in the source file, 0 = unknown
  bool operator==(const Shape&) const = default;
};

/// Drilled or routed hole through a span of copper layers.
struct Drill {
  geometry::Figure figure;        ///< dot or segment with pen = tool diameter > 0; or a filled closed path, routed
  std::int32_t first_copper = 0;  ///< topmost copper layer of the span
  std::int32_t last_copper = 0;   ///< bottommost, >= first_copper
  bool plated = true;
  std::int32_t net = no_net;
  ShapeKind kind = ShapeKind::via;  ///< via or pad
  std::int64_t line = 0;
  bool is_backdrill = false;  ///< drilled after plating, from one end of the span: takes barrel and rings away; not plated
  bool operator==(const Drill&) const = default;
};

/// One board: closed outer outline and the closed cut-outs inside it.
struct Outline {
  geometry::Path outer;
  std::vector<geometry::Path> cutouts;
  bool operator==(const Outline&) const = default;
};

/// Component pin, kept so that ports can be placed by name.
struct Pin {
  std::string component;  ///< reference designator, e.g. "U3"
  std::string number;     ///< pad number
  std::int32_t net = no_net;
  geometry::Point at;
  std::int32_t copper_layer = 0;  ///< side the part stands on (top side for through-hole pads)
  bool operator==(const Pin&) const = default;
};

struct BoardParts {
  std::string name;
  std::string source;  ///< file it came from
  std::vector<Material> materials;
  std::vector<StackupLayer> stackup;  ///< top to bottom
  std::vector<std::string> nets;      ///< names; unique
  std::vector<Outline> outlines;      ///< may be empty: the study then decides
  std::vector<Shape> shapes;
  std::vector<Drill> drills;
  std::vector<Pin> pins;
};

/// What was designed. Immutable; copies share storage.
///
/// @guarantee B1  every shape names an existing copper layer and net; every layer an existing material
/// @guarantee B2  thicknesses > 0, at least one copper layer
/// @guarantee B3  drill spans are ordered and inside the stack, tool diameters > 0 (or a filled path)
/// @guarantee B4  all coordinates are within max_coordinate_nm; outlines are closed
class Board {
 public:
  /// @throws Error board_invalid (301), stackup_invalid (303), outline_invalid (302) naming the offender.
  [[nodiscard]] static Board from_parts(BoardParts parts);

  [[nodiscard]] const std::string& name() const { return parts_->name; }
  [[nodiscard]] const std::string& source() const { return parts_->source; }
  [[nodiscard]] std::span<const Material> materials() const { return parts_->materials; }
  [[nodiscard]] std::span<const StackupLayer> stackup() const { return parts_->stackup; }
  [[nodiscard]] std::span<const std::string> nets() const { return parts_->nets; }
  [[nodiscard]] std::span<const Outline> outlines() const { return parts_->outlines; }
  [[nodiscard]] std::span<const Shape> shapes() const { return parts_->shapes; }
  [[nodiscard]] std::span<const Drill> drills() const { return parts_->drills; }
  [[nodiscard]] std::span<const Pin> pins() const { return parts_->pins; }

  /// Stackup indices of the copper layers, top to bottom.
  [[nodiscard]] std::span<const std::int32_t> copper_layers() const { return copper_layers_; }
  /// Name of copper layer i. @cost O(1).
  [[nodiscard]] const std::string& copper_name(std::int32_t i) const;
  /// Index of a net by exact name, or nullopt.
  [[nodiscard]] std::optional<std::int32_t> find_net(std::string_view name) const;
  /// Up to `most` net names close to a misspelt one (edit distance, substring), best first.
  [[nodiscard]] std::vector<std::string> similar_nets(std::string_view name, std::size_t most = 5) const;
  /// Net name, or "no net".
  [[nodiscard]] std::string_view net_name(std::int32_t net) const;

 private:
  std::shared_ptr<const BoardParts> parts_;
  std::vector<std::int32_t> copper_layers_;
};

}  // namespace pcbmesh::board
