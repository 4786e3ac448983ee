// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/board/board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/near_miss.hpp"

namespace pcbmesh::board {
namespace {

void require_place(const BoardParts& parts, geometry::Point p, std::int64_t line) {
  if (std::abs(p.x) > max_coordinate_nm || std::abs(p.y) > max_coordinate_nm)
    throw Error(ErrorCode::board_invalid, "coordinate beyond 1 m from the origin", {.file = parts.source, .line = line});
}

void require_figure(const BoardParts& parts, const geometry::Figure& figure, std::int64_t line, std::string_view what) {
  const Spot spot{.file = parts.source, .line = line};
  const geometry::Path& path = figure.path;
  if (path.points.empty()) throw Error(ErrorCode::board_invalid, fmt::format("{} without points", what), spot);
  for (geometry::Point p : path.points) require_place(parts, p, line);
  if (figure.pen < 0 || figure.pen > max_coordinate_nm)
    throw Error(ErrorCode::board_invalid, fmt::format("{} with width {} nm", what, figure.pen), spot);
  std::int32_t last = -1;
  for (std::int32_t i : path.arc_starts) {
    const auto n = static_cast<std::int32_t>(path.points.size());
    if (i <= last || i >= n || (!path.closed && i + 2 >= n) || n < 3)
      throw Error(ErrorCode::board_invalid, fmt::format("{} with a broken arc list", what), spot);
    last = i;
  }
  if (!figure.filled && figure.pen == 0)
    throw Error(ErrorCode::board_invalid, fmt::format("{} without area: neither filled nor drawn with a pen", what), spot);
}

}  // namespace

std::string_view name_of(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::track:
      return "track";
    case ShapeKind::via:
      return "via";
    case ShapeKind::pad:
      return "pad";
    case ShapeKind::fill:
      return "fill";
    case ShapeKind::graphic:
      return "graphic";
  }
  return "shape";
}

Board Board::from_parts(BoardParts parts) {
  Board board;
  const Spot file{.file = parts.source};
  std::unordered_set<std::string> names;
  for (std::size_t i = 0; i < parts.stackup.size(); ++i) {
    const StackupLayer& layer = parts.stackup[i];
    Spot spot = file;
    spot.layer = layer.name;
    if (layer.thickness_nm <= 0)
      throw Error(
          ErrorCode::stackup_invalid,
          fmt::format("layer has thickness {} nm; every layer needs a thickness above 0: mend the stackup", layer.thickness_nm),
          spot);
    if (layer.thickness_nm > max_coordinate_nm / 10)
      throw Error(ErrorCode::stackup_invalid, "layer is thicker than 100 mm", spot);
    if (layer.material < 0 || static_cast<std::size_t>(layer.material) >= parts.materials.size())
      throw Error(ErrorCode::stackup_invalid, "layer has no material", spot);
    if (layer.kind == LayerKind::copper) board.copper_layers_.push_back(static_cast<std::int32_t>(i));
    if (!names.insert(layer.name).second) throw Error(ErrorCode::stackup_invalid, "two stackup layers have this name", spot);
  }
  if (board.copper_layers_.empty()) throw Error(ErrorCode::stackup_invalid, "the stackup has no copper layer", file);
  for (const Material& m : parts.materials)
    if (!(m.eps_r > 0) || !(m.mu_r > 0) || !(m.tan_delta >= 0) || !(m.sigma_s_per_m >= 0) || !std::isfinite(m.eps_r) ||
        !std::isfinite(m.mu_r) || !std::isfinite(m.tan_delta) || !std::isfinite(m.sigma_s_per_m))
      throw Error(ErrorCode::board_invalid,
                  fmt::format("material {} has impossible values (eps_r {}, tan_delta {}, mu_r {}, sigma {})", m.name, m.eps_r,
                              m.tan_delta, m.mu_r, m.sigma_s_per_m),
                  file);
  std::unordered_set<std::string_view> nets;
  for (const std::string& net : parts.nets)
    if (!nets.insert(net).second) throw Error(ErrorCode::board_invalid, fmt::format("two nets are called '{}'", net), file);

  const auto num_copper = static_cast<std::int32_t>(board.copper_layers_.size());
  const auto num_nets = static_cast<std::int32_t>(parts.nets.size());
  for (const Shape& shape : parts.shapes) {
    if (shape.copper_layer < 0 || shape.copper_layer >= num_copper || shape.net < no_net || shape.net >= num_nets)
      throw Error(ErrorCode::board_invalid,
                  fmt::format("{} names copper layer {} of {} and net {} of {}", name_of(shape.kind), shape.copper_layer,
                              num_copper, shape.net, num_nets),
                  {.file = parts.source, .line = shape.line});
    require_figure(parts, shape.figure, shape.line, name_of(shape.kind));
  }
  for (const Drill& drill : parts.drills) {
    if (drill.first_copper < 0 || drill.last_copper >= num_copper || drill.first_copper > drill.last_copper ||
        drill.net < no_net || drill.net >= num_nets)
      throw Error(ErrorCode::board_invalid,
                  fmt::format("hole spans copper layers {} to {} of {}", drill.first_copper, drill.last_copper, num_copper),
                  {.file = parts.source, .line = drill.line});
    if (drill.figure.pen <= 0 && !drill.figure.filled)
      throw Error(ErrorCode::board_invalid, "hole with diameter 0", {.file = parts.source, .line = drill.line});
    require_figure(parts, drill.figure, drill.line, "hole");
  }
  for (const Outline& outline : parts.outlines) {
    const auto check_path = [&](const geometry::Path& path, std::string_view what) {
      if (!path.closed || path.points.size() < 3)
        throw Error(ErrorCode::outline_invalid, fmt::format("{} is not a closed outline", what), file);
      for (geometry::Point p : path.points) require_place(parts, p, 0);
    };
    check_path(outline.outer, "board outline");
    for (const geometry::Path& cutout : outline.cutouts) check_path(cutout, "cut-out");
  }
  board.parts_ = std::make_shared<const BoardParts>(std::move(parts));
  return board;
}

const std::string& Board::copper_name(std::int32_t i) const {
  return parts_->stackup[static_cast<std::size_t>(copper_layers_[static_cast<std::size_t>(i)])].name;
}

std::optional<std::int32_t> Board::find_net(std::string_view name) const {
  const auto found = std::find(parts_->nets.begin(), parts_->nets.end(), name);
  if (found == parts_->nets.end()) return std::nullopt;
  return static_cast<std::int32_t>(found - parts_->nets.begin());
}

std::vector<std::string> Board::similar_nets(std::string_view name, std::size_t most) const {
  return near_misses(name, parts_->nets, most);
}

std::string_view Board::net_name(std::int32_t net) const {
  return net < 0 ? std::string_view("no net") : std::string_view(parts_->nets[static_cast<std::size_t>(net)]);
}

}  // namespace pcbmesh::board
