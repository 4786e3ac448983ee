// SPDX-License-Identifier: GPL-3.0-or-later
// Layouts damaged at random: every damage is found, as what it is, where it is.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <ranges>
#include <set>
#include <span>

#include "folder.hpp"
#include "formats/tags_json/tags_json.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/geometry/polygon_sets.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "pcbmesh/pipeline/write_outputs.hpp"
#include "test_data.hpp"

namespace pcbmesh {
namespace {

using board::Board;
using board::Shape;
using geometry::Box;
using geometry::Point;
using geometry::Ring;

constexpr int num_damages = 200;

board::BoardParts parts_of(const Board& b) {
  return {b.name(),
          b.source(),
          {b.materials().begin(), b.materials().end()},
          {b.stackup().begin(), b.stackup().end()},
          {b.nets().begin(), b.nets().end()},
          {b.outlines().begin(), b.outlines().end()},
          {b.shapes().begin(), b.shapes().end()},
          {b.drills().begin(), b.drills().end()},
          {b.pins().begin(), b.pins().end()}};
}

std::vector<Ring> rings_in(const geometry::Figure& figure, const Box& box) {
  bool simple = true;
  std::vector<Ring> kept;
  for (const Ring& ring : geometry::outline(figure, {}, simple))
    if (Ring cut = geometry::clip_to_box(ring, box); cut.size() >= 3) kept.push_back(std::move(cut));
  return kept.empty() ? kept : geometry::united(kept);
}

/// The test's own idea of what is connected: shapes that overlap, and holes that pierce them.
class Oracle {
 public:
  Oracle(const Board& board, const Box& box) : board_(board) {
    for (const Shape& shape : board.shapes())
      if (geometry::bounds(shape.figure).touches(box))
        add(shape.copper_layer, shape.copper_layer, shape.net, rings_in(shape.figure, box));
    for (const board::Drill& drill : board.drills())
      if (drill.plated && geometry::bounds(drill.figure).touches(box))
        add(drill.first_copper, drill.last_copper, drill.net, rings_in(drill.figure, box));
  }

  [[nodiscard]] int pieces(std::int32_t net) const {
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < items_.size(); ++i)
      if (items_[i].net == net) own.push_back(i);
    std::vector<std::size_t> parent(own.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
      while (parent[i] != i) i = parent[i] = parent[parent[i]];
      return i;
    };
    for (std::size_t i = 0; i < own.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (root(i) != root(j) && meet(items_[own[i]], items_[own[j]])) parent[root(i)] = root(j);
    std::set<std::size_t> roots;
    for (std::size_t i = 0; i < own.size(); ++i) roots.insert(root(i));
    return static_cast<int>(roots.size());
  }

  /// Nets whose copper a figure on a layer would overlap.
  [[nodiscard]] std::set<std::int32_t> nets_under(const geometry::Figure& figure, std::int32_t layer, const Box& box) const {
    Item item{layer, layer, -2, rings_in(figure, box), {}};
    for (const Ring& ring : item.rings)
      for (const Point p : ring) item.box.add(p);
    std::set<std::int32_t> nets;
    for (const Item& other : items_)
      if (!nets.contains(other.net) && meet(item, other)) nets.insert(other.net);
    return nets;
  }

 private:
  struct Item {
    std::int32_t first, last, net;
    std::vector<Ring> rings;
    Box box;
  };
  void add(std::int32_t first, std::int32_t last, std::int32_t net, std::vector<Ring> rings) {
    if (rings.empty()) return;
    Item item{first, last, net, std::move(rings), {}};
    for (const Ring& ring : item.rings)
      for (const Point p : ring) item.box.add(p);
    items_.push_back(std::move(item));
  }
  static bool meet(const Item& a, const Item& b) {
    return a.first <= b.last && b.first <= a.last && a.box.touches(b.box) && !geometry::intersected(a.rings, b.rings).empty();
  }
  const Board& board_;
  std::vector<Item> items_;
};

struct Damage {
  std::string what, code;
  std::vector<std::int32_t> nets;  ///< ascending
  std::string layer;               ///< empty = not checked
  std::optional<Point> at;
  double reach_mm = 0;
  board::BoardParts parts{};
};

class Damager {
 public:
  Damager(const Board& board, const Box& box) : board_(board), box_(box), intact_(board, box) {
    for (std::size_t i = 0; i < board.shapes().size(); ++i)
      if (box.contains(middle(board.shapes()[i].figure)) && board.shapes()[i].net >= 0) shapes_.push_back(i);
    for (std::size_t i = 0; i < board.drills().size(); ++i) {
      const board::Drill& d = board.drills()[i];
      if (d.plated && d.net >= 0 && d.kind == board::ShapeKind::via && box.contains(middle(d.figure))) vias_.push_back(i);
    }
  }

  /// One damage of a kind that surely opens or shorts something.
  std::optional<Damage> make(int kind, std::mt19937& random) {
    for (int attempt = 0; attempt < 400; ++attempt) {
      std::optional<Damage> damage = kind == 0   ? cut(random)
                                     : kind == 1 ? without_via(random)
                                     : kind == 2 ? bridge(random)
                                                 : closed_antipad(random);
      if (damage) return damage;
    }
    return std::nullopt;
  }

 private:
  static Point middle(const geometry::Figure& figure) {
    const Box b = geometry::bounds(figure);
    return {(b.min.x + b.max.x) / 2, (b.min.y + b.max.y) / 2};
  }
  template <class T>
  static T pick(const std::vector<T>& list, std::mt19937& random) {
    return list[random() % list.size()];
  }
  int pieces_before(std::int32_t net) {
    const auto found = pieces_.find(net);
    if (found != pieces_.end()) return found->second;
    return pieces_[net] = intact_.pieces(net);
  }
  bool is_opened(const board::BoardParts& parts, std::int32_t net) {
    const Board damaged = Board::from_parts(parts);
    return Oracle(damaged, box_).pieces(net) > pieces_before(net);
  }

  std::optional<Damage> cut(std::mt19937& random) {
    const std::size_t index = pick(shapes_, random);
    const Shape track = board_.shapes()[index];
    if (track.kind != board::ShapeKind::track || track.figure.path.points.size() != 2 || track.figure.filled)
      return std::nullopt;
    const Point a = track.figure.path.points[0], b = track.figure.path.points[1];
    const double length = std::hypot(static_cast<double>(b.x - a.x), static_cast<double>(b.y - a.y));
    const double gap = 100'000 + static_cast<double>(track.figure.pen);
    if (length < gap + 200'000) return std::nullopt;
    const auto along = [&](double t) {
      return Point{a.x + std::llround(t * static_cast<double>(b.x - a.x)),
                   a.y + std::llround(t * static_cast<double>(b.y - a.y))};
    };
    Damage d{"cut", "net.open", {track.net}, board_.copper_name(track.copper_layer), along(0.5), 0.3, parts_of(board_)};
    d.parts.shapes[index].figure = geometry::segment(a, along(0.5 - gap / 2 / length), track.figure.pen);
    d.parts.shapes.push_back(track);
    d.parts.shapes.back().figure = geometry::segment(along(0.5 + gap / 2 / length), b, track.figure.pen);
    if (!is_opened(d.parts, track.net)) return std::nullopt;
    return d;
  }

  std::optional<Damage> without_via(std::mt19937& random) {
    if (vias_.empty()) return std::nullopt;
    const std::size_t index = pick(vias_, random);
    Damage d{"via removed", "net.open", {board_.drills()[index].net}, "", std::nullopt, 0, parts_of(board_)};
    d.parts.drills.erase(d.parts.drills.begin() + static_cast<std::ptrdiff_t>(index));
    if (!is_opened(d.parts, d.nets[0])) return std::nullopt;
    return d;
  }

  std::optional<Damage> short_of(std::string what, std::int32_t layer, std::int32_t net, geometry::Figure figure, Point at,
                                 double reach_mm) {
    std::set<std::int32_t> under = intact_.nets_under(figure, layer, box_);
    under.insert(net);
    if (under.size() != 2 || under.contains(board::no_net)) return std::nullopt;
    Damage d{std::move(what), "net.short",     {under.begin(), under.end()}, board_.copper_name(layer), at,
             reach_mm,        parts_of(board_)};
    d.parts.shapes.push_back({layer, net, board::ShapeKind::track, std::move(figure), 0});
    return d;
  }

  std::optional<Damage> bridge(std::mt19937& random) {
    const Shape &a = board_.shapes()[pick(shapes_, random)], &b = board_.shapes()[pick(shapes_, random)];
    if (a.net == b.net || a.copper_layer != b.copper_layer || a.kind == board::ShapeKind::fill ||
        b.kind == board::ShapeKind::fill)
      return std::nullopt;
    const Point p = middle(a.figure), q = middle(b.figure);
    const double length = std::hypot(static_cast<double>(q.x - p.x), static_cast<double>(q.y - p.y));
    if (length > 2e6 || length < 1e5) return std::nullopt;
    return short_of("bridge", a.copper_layer, a.net, geometry::segment(p, q, 150'000), {(p.x + q.x) / 2, (p.y + q.y) / 2},
                    length * 0.5e-6 + 1.0);
  }

  std::optional<Damage> closed_antipad(std::mt19937& random) {
    if (vias_.empty()) return std::nullopt;
    const board::Drill& via = board_.drills()[pick(vias_, random)];
    const std::int32_t layer = static_cast<std::int32_t>(random() % board_.copper_layers().size());
    if (layer < via.first_copper || layer > via.last_copper) return std::nullopt;
    const Point at = middle(via.figure);
    for (Nm diameter = via.figure.pen + 200'000; diameter < 3'000'000; diameter += 100'000) {
      const std::set<std::int32_t> under = intact_.nets_under(geometry::disc(at, diameter), layer, box_);
      if (under.size() < 2) continue;
      for (const std::int32_t net : under)
        if (net != via.net && net >= 0)
          return short_of("antipad closed", layer, net, geometry::disc(at, diameter + 60'000), at,
                          static_cast<double>(diameter) * 1e-6);
      return std::nullopt;
    }
    return std::nullopt;
  }

  const Board& board_;
  Box box_;
  Oracle intact_;
  std::vector<std::size_t> shapes_, vias_;
  std::map<std::int32_t, int> pieces_;
};

/// A window with the tracks of many nets in it.
Box busy_window(const Board& board, Nm half) {
  std::vector<std::pair<Point, std::int32_t>> tracks;
  for (const Shape& shape : board.shapes()) {
    const Box b = geometry::bounds(shape.figure);
    if (shape.kind == board::ShapeKind::track && shape.net >= 0)
      tracks.push_back({{(b.min.x + b.max.x) / 2, (b.min.y + b.max.y) / 2}, shape.net});
  }
  Point best{};
  std::size_t most = 0;
  for (std::size_t i = 0; i < tracks.size(); i += 1 + tracks.size() / 200) {
    std::set<std::int32_t> nets;
    for (const auto& [at, net] : tracks)
      if (std::abs(at.x - tracks[i].first.x) < half && std::abs(at.y - tracks[i].first.y) < half) nets.insert(net);
    if (nets.size() > most) most = nets.size(), best = tracks[i].first;
  }
  return {{best.x - half, best.y - half}, {best.x + half, best.y + half}};
}

class Lvs : public ::testing::TestWithParam<unsigned> {};

struct Meshed {
  mesh::MeshData mesh;
  validation::Expectation tags;
};

Meshed meshed(const Board& board, const study::Study& study) {
  const pipeline::MeshBoardResult result = pipeline::mesh_board(board, study);
  const testing::Folder folder;  // tests run side by side
  const std::string file = (folder / "lvs.tags.json").string();
  formats::tags_json::write_tags(result.mesh, file, LengthUnit::metre);
  return {pipeline::expand(result.mesh), validation::read_expectation(file)};
}

TEST_P(Lvs, EveryDamageIsFoundAsWhatItIs) {
  PCBMESH_NEEDS_TEST_DATA();
  const std::filesystem::path file = tests::test_data() / "kicad/08_pico_ice_4L_v8.kicad_pcb.xz";
  const Board board = formats::read_board(file, "").board;
  study::Study study;
  study.region = study::RegionKind::box;
  study.box = busy_window(board, 3 * nm_per_mm);
  study.air_above = study.air_below = 200 * nm_per_um;
  study.policy = study::HeightPolicy::none;
  study.sublayers = study::SublayerRule::none;
  const Meshed intact = meshed(board, study);
  const validation::Report clean = validation::check(intact.mesh, &intact.tags);
  ASSERT_TRUE(clean.passed()) << validation::to_text(clean);

  std::mt19937 random(GetParam());
  Damager damager(board, *study.box);
  std::map<std::string, int> made;
  int num_placed = 0, num_placed_of_pieces = 0;
  for (int i = 0; i < num_damages / 2; ++i) {
    const std::optional<Damage> damage = damager.make(i % 4, random);
    if (!damage) continue;
    SCOPED_TRACE(fmt::format("{} {}: {}", i, damage->what, board.net_name(damage->nets[0])));
    const Board damaged = Board::from_parts(damage->parts);
    const Meshed now = meshed(damaged, study);
    validation::Report report = validation::check(now.mesh, &now.tags, {.netlist = &intact.tags});
    pipeline::name_features(damaged, 1.0, report);
    std::vector<std::string> nets;
    for (const std::int32_t net : damage->nets) nets.emplace_back(board.net_name(net));
    std::sort(nets.begin(), nets.end());
    const validation::Finding* found = nullptr;
    for (const validation::Finding& finding : report.findings) {
      if (finding.severity != validation::FindingSeverity::error) continue;
      if (finding.code == damage->code && finding.nets == nets) {
        found = &finding;
        continue;
      }
      // A bridge or disc may also cut what it lies on; nothing else may be said.
      const bool follows =
          damage->code == "net.short" && finding.code != "net.short" &&
          std::ranges::all_of(finding.nets, [&](const auto& net) { return std::ranges::count(nets, net) > 0; });
      EXPECT_TRUE(follows && !finding.nets.empty()) << finding.code << " " << finding.text;
    }
    ASSERT_NE(found, nullptr) << validation::to_text(report);
    if (!damage->layer.empty()) {
      EXPECT_EQ(found->layer, damage->layer) << found->text;
    }
    // Of a net in several pieces already, the narrowest gap need not be the new one; but it is among those that are told.
    const auto whole = std::ranges::find(intact.tags.nets, nets.front(), &validation::Expectation::Net::name);
    const bool was_whole = damage->code != "net.open" || (whole != intact.tags.nets.end() && whole->pieces == 1);
    if (damage->at) {
      ASSERT_FALSE(found->places.empty()) << found->text;
      const auto apart_mm = [&](const validation::Finding::Place& place) {
        return std::hypot(place.at[0] * 1e3 - static_cast<double>(damage->at->x) * 1e-6,
                          place.at[1] * 1e3 - static_cast<double>(damage->at->y) * 1e-6);
      };
      const auto told = std::span(found->places).first(was_whole ? 1 : found->places.size());
      EXPECT_LT(std::ranges::min(told | std::views::transform(apart_mm)), damage->reach_mm) << found->text;
      was_whole ? ++num_placed : ++num_placed_of_pieces;
    }
    EXPECT_NE(found->text.find("nearest copper of"), std::string::npos) << found->text;
    ++made[damage->what];
  }
  int total = 0;
  for (const auto& [what, count] : made) {
    fmt::print("{}: {}\n", what, count);
    total += count;
  }
  fmt::print("place asserted: {}, and {} of nets that were in several pieces\n", num_placed, num_placed_of_pieces);
  EXPECT_GE(total, num_damages / 2);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Lvs, ::testing::Values(7U, 8U));

}  // namespace
}  // namespace pcbmesh
