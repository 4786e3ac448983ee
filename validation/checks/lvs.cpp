// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh against layout: opens, shorts, and what each net is.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "validation/checks/checks.hpp"
#include "validation/checks/net_pieces.hpp"

namespace pcbmesh::validation::checks {
namespace {

std::size_t ix(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Layer of the group a place stands in; empty if not known.
std::string layer_of(const Context& context, const Finding::Place& place) {
  if (place.cell >= 0)
    for (const Expectation::Volume& volume : context.expectation->volumes)
      if (volume.tag == context.tag_of_cell(place.cell)) return volume.layer;
  return {};
}

/// Nodes of a net's pieces in boxes, for the nearest node of another piece.
class GapFinder {
 public:
  GapFinder(const Context& context, const NetPieces& nets, std::int32_t net) : context_(context) {
    std::map<std::int32_t, std::vector<std::int64_t>> nodes;
    nets.visit_nodes(net, [&](std::int32_t piece, std::int64_t node) { nodes[piece].push_back(node); });
    for (auto& [piece, list] : nodes) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      pieces_.push_back({piece, std::move(list)});
    }
    double extent = 0;
    for (std::size_t i = 0; i < 2; ++i) extent = std::max(extent, context.high[i] - context.low[i]);
    box_ = std::max(extent / 256, 1e-30);
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      for (const std::int64_t node : pieces_[p].nodes) boxes_[key_of(box_of(node, 0), box_of(node, 1))].push_back({p, node});
  }

  struct Gap {
    std::int32_t piece = -1;  ///< the smaller one
    Vector3 at{};             ///< middle between the nearest nodes
    Vector3 to{};             ///< place of the other piece's node
    std::int64_t node = -1;   ///< of the smaller piece
    double distance = 0;
  };

  /// For every piece but the largest: where it comes nearest to any other, least gap first.
  [[nodiscard]] std::vector<Gap> gaps() const {
    std::size_t largest = 0;
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      if (pieces_[p].nodes.size() > pieces_[largest].nodes.size()) largest = p;
    std::vector<Gap> found;
    for (std::size_t p = 0; p < pieces_.size(); ++p)
      if (p != largest)
        if (const auto gap = gap_of(p)) found.push_back(*gap);
    std::stable_sort(found.begin(), found.end(), [](const Gap& a, const Gap& b) { return a.distance < b.distance; });
    return found;
  }

 private:
  struct PieceNodes {
    std::int32_t piece;
    std::vector<std::int64_t> nodes;
  };
  struct Entry {
    std::size_t piece;
    std::int64_t node;
  };
  [[nodiscard]] std::int64_t box_of(std::int64_t node, std::size_t axis) const {
    return static_cast<std::int64_t>(std::floor((context_.mesh.nodes[ix(node)][axis] - context_.low[axis]) / box_));
  }
  static std::int64_t key_of(std::int64_t i, std::int64_t j) { return i * 4096 + j; }

  /// Rings of boxes outwards until no nearer node can come.
  [[nodiscard]] std::optional<Gap> gap_of(std::size_t piece) const {
    Gap best{.piece = pieces_[piece].piece, .distance = std::numeric_limits<double>::infinity()};
    Vector3 from{};
    constexpr std::size_t most_nodes = 4096;  // of a piece: beyond, every so many-th will do for a place
    const std::vector<std::int64_t>& nodes = pieces_[piece].nodes;
    for (std::size_t n = 0; n < nodes.size(); n += 1 + nodes.size() / most_nodes) {
      const Vector3& p = context_.mesh.nodes[ix(nodes[n])];
      const std::int64_t i = box_of(nodes[n], 0), j = box_of(nodes[n], 1);
      for (std::int64_t ring = 0; ring <= 260 && static_cast<double>(ring - 1) * box_ < best.distance; ++ring)
        for (std::int64_t di = -ring; di <= ring; ++di)
          for (std::int64_t dj = -ring; dj <= ring; dj += (std::abs(di) == ring || ring == 0) ? 1 : 2 * ring) {
            const auto box = boxes_.find(key_of(i + di, j + dj));
            if (box == boxes_.end()) continue;
            for (const Entry& entry : box->second) {
              if (entry.piece == piece) continue;
              const Vector3& q = context_.mesh.nodes[ix(entry.node)];
              const double distance = std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]);
              if (distance >= best.distance) continue;
              best.distance = distance;
              best.node = nodes[n];
              best.to = q;
              from = p;
            }
          }
    }
    if (!std::isfinite(best.distance)) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k) best.at[k] = (from[k] + best.to[k]) / 2;
    return best;
  }

  const Context& context_;
  std::vector<PieceNodes> pieces_;
  double box_ = 1;
  std::unordered_map<std::int64_t, std::vector<Entry>> boxes_;
};

class LayoutComparison {
 public:
  LayoutComparison(const Context& context, const NetPieces& nets, const Expectation& netlist, CheckLog& log)
      : context_(context), nets_(nets), netlist_(netlist), log_(log) {
    pieces_of_net_.resize(nets.nets().size());
    for (std::size_t p = 0; p < nets.pieces().size(); ++p) pieces_of_net_[ix(nets.pieces()[p].net)].push_back(p);
  }

  void compare_pieces() {
    for (const Expectation::Net& expected : netlist_.nets) {
      if (expected.pieces < 0) continue;
      const auto place = std::lower_bound(nets_.nets().begin(), nets_.nets().end(), expected.name);
      const bool is_there = place != nets_.nets().end() && *place == expected.name;
      const std::int32_t net = is_there ? static_cast<std::int32_t>(place - nets_.nets().begin()) : -1;
      const std::int64_t found = is_there ? static_cast<std::int64_t>(pieces_of_net_[ix(net)].size()) : 0;
      if (found > expected.pieces)
        report_open(expected, net, found);
      else if (found == 0 && !is_promised(expected.name))
        continue;  // hollow, in a mesh without tagged skins: nothing to count
      else if (found == 0 && expected.pieces > 0)
        report("net.open",
               fmt::format("net {} has no copper in the mesh, but {} pieces in the layout", expected.name, expected.pieces),
               expected.pieces, {}, {expected.name}, "");
      else if (found < expected.pieces)
        report_merged(expected, net, found);
    }
  }

  void compare_contacts() {
    std::set<std::array<std::string, 2>> allowed;
    for (auto pair : netlist_.touching_nets) {
      if (pair[1] < pair[0]) std::swap(pair[0], pair[1]);
      allowed.insert(pair);
    }
    for (const auto& [pair, contact] : nets_.contacts()) {
      const std::string &a = nets_.nets()[ix(pair.first)], &b = nets_.nets()[ix(pair.second)];
      if (allowed.contains({a, b})) continue;  // names ascend with their indices
      const std::string layer = layer_of(context_, contact.place);
      const Vector3 at = contact.place.at;
      report("net.short",
             fmt::format("copper of nets {} and {} shares {} faces, first on layer {} at ({:.9g}, {:.9g}, {:.9g})", a, b,
                         contact.count, layer.empty() ? "?" : layer, at[0], at[1], at[2]),
             contact.count, {contact.place}, {a, b}, layer);
    }
  }

 private:
  /// Whether the mesh should have copper of a net that it has not.
  [[nodiscard]] bool is_promised(const std::string& net) const {
    return &netlist_ != context_.expectation || std::ranges::any_of(context_.expectation->volumes, [&](const auto& volume) {
      return volume.conductor && volume.net == net;
    });
  }

  void report(std::string_view code, std::string text, std::int64_t count, std::vector<Finding::Place> places,
              std::vector<std::string> nets, std::string layer) {
    log_.found(code, FindingSeverity::error, std::move(text), count, std::move(places));
    log_.describe_last(std::move(nets), std::move(layer));
  }

  void report_open(const Expectation::Net& expected, std::int32_t net, std::int64_t found) {
    const std::vector<GapFinder::Gap> gaps = GapFinder(context_, nets_, net).gaps();
    std::vector<Finding::Place> places;
    for (std::size_t i = 0; i < gaps.size() && i < 8; ++i) {
      const std::int64_t cell = nets_.cell_at(net, gaps[i].node, gaps[i].to);
      Finding::Place place = cell >= 0 ? context_.place_of_cell(cell) : nets_.pieces()[ix(gaps[i].piece)].place;
      place.at = gaps[i].at;
      places.push_back(std::move(place));
    }
    const std::string layer = places.empty() ? "" : layer_of(context_, places.front());
    const std::string where =
        places.empty()
            ? ""
            : fmt::format("; the narrowest gap, {:.4g} wide, is on layer {} at ({:.9g}, {:.9g}, {:.9g})", gaps.front().distance,
                          layer.empty() ? "?" : layer, places.front().at[0], places.front().at[1], places.front().at[2]);
    report("net.open",
           fmt::format("net {} is open: {} pieces of copper in the mesh, {} in the layout{}", expected.name, found,
                       expected.pieces, where),
           found - expected.pieces, std::move(places), {expected.name}, layer);
  }

  void report_merged(const Expectation::Net& expected, std::int32_t net, std::int64_t found) {
    std::vector<Finding::Place> places;
    for (const std::size_t p : pieces_of_net_[ix(net)])
      if (places.size() < 8) places.push_back(nets_.pieces()[p].place);
    report("net.merged",
           fmt::format("pieces of net {} have grown together or are lost: {} in the mesh, {} in the layout", expected.name,
                       found, expected.pieces),
           expected.pieces - found, std::move(places), {expected.name}, "");
  }

  const Context& context_;
  const NetPieces& nets_;
  const Expectation& netlist_;
  CheckLog& log_;
  std::vector<std::vector<std::size_t>> pieces_of_net_;
};

/// Names of port groups by the nets that share an edge with them.
std::vector<std::vector<std::string>> ports_of_nets(const Context& context, const NetPieces& nets) {
  std::vector<std::set<std::string>> ports(nets.nets().size());
  std::vector<std::string> port_of_slot(ix(context.face_tags.size()));
  bool any = false;
  for (int slot = 0; slot < context.face_tags.size(); ++slot) {
    const std::string name = context.name_of(2, context.face_tags.tag(slot));
    const bool is_port = name.starts_with("port|") || name.starts_with("waveport|");
    if (is_port) port_of_slot[ix(slot)] = name.substr(name.find('|') + 1);
    any = any || is_port;
  }
  for (std::int64_t face = 0; any && face < context.num_faces(); ++face) {
    const std::string& port = port_of_slot[ix(context.face_tags.slot(context.tag_of_face(face)))];
    if (port.empty()) continue;
    const auto corners = context.corners_of_face(face);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::int32_t net = nets.net_of_node()[ix(corners[k])];
      if (net >= 0 && net == nets.net_of_node()[ix(corners[k + 1 == corners.size() ? 0 : k + 1])])
        ports[ix(net)].insert(port.substr(0, port.find('|')));
    }
  }
  std::vector<std::vector<std::string>> lists;
  for (const std::set<std::string>& set : ports) lists.emplace_back(set.begin(), set.end());
  return lists;
}

void describe_nets(const Context& context, const NetPieces& nets, const Expectation& netlist, Report& report) {
  const std::vector<std::vector<std::string>> ports = ports_of_nets(context, nets);
  std::map<std::string, const Expectation::Net*> expected;
  for (const Expectation::Net& net : netlist.nets) expected.emplace(net.name, &net);
  std::map<std::int32_t, const GroupVolume*> volumes;
  for (const GroupVolume& volume : report.volumes) volumes.emplace(volume.tag, &volume);
  for (std::size_t n = 0; n < nets.nets().size(); ++n) {
    NetVerdict verdict{.name = nets.nets()[n], .ports = ports[n]};
    if (const auto found = expected.find(verdict.name); found != expected.end())
      verdict.expected_pieces = found->second->pieces;
    for (const NetPieces::Piece& piece : nets.pieces())
      if (piece.net == static_cast<std::int32_t>(n)) ++verdict.pieces;
    for (const Expectation::Volume& volume : context.expectation->volumes) {
      if (!volume.conductor || volume.net != verdict.name) continue;
      const auto measured = volumes.find(volume.tag);
      if (measured == volumes.end()) continue;
      verdict.num_cells += measured->second->num_cells;
      verdict.volume += measured->second->volume;
    }
    report.nets.push_back(std::move(verdict));
  }
}

}  // namespace

void check_nets(const Context& context, NetContacts& cells, const Expectation* netlist, Report& report) {
  if (context.expectation == nullptr) return;
  CheckLog log(report, context, "nets");
  const NetPieces nets(context, cells);
  log.examined(static_cast<std::int64_t>(nets.nets().size()));
  const Expectation& wanted = netlist == nullptr ? *context.expectation : *netlist;
  LayoutComparison comparison(context, nets, wanted, log);
  comparison.compare_pieces();
  comparison.compare_contacts();
  describe_nets(context, nets, wanted, report);
}

}  // namespace pcbmesh::validation::checks
