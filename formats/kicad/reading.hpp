// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/kicad/layers.hpp"
#include "formats/kicad/transform.hpp"
#include "formats/syntax/sexpr.hpp"
#include "pcbmesh/base/diagnostics.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/board/board.hpp"

namespace pcbmesh::formats::kicad {

/// Copper of a via or pad that exists only if something of its net touches it on that layer (remove_unused_layers).
struct OptionalRing {
  std::int32_t copper_layer = 0;
  std::int32_t net = board::no_net;
  board::ShapeKind kind = board::ShapeKind::via;
  std::vector<geometry::Figure> figures{};
  bool fills_count = true;  ///< false: the file states that no fill holds this ring
  std::int64_t line = 0;
};

/// One piece drawn on Edge.Cuts, already on the nanometre grid with y up.
struct EdgePiece {
  geometry::Path path{};
  std::int64_t line = 0;
};

/// State of one reading: the tree, the tables read so far, what has been gathered, and words about it.
class Reading {
 public:
  Reading(const syntax::SexprTree& tree, std::int64_t file_version, LayerTable layer_table);

  const syntax::SexprTree& tree;
  const std::int64_t version;
  const LayerTable layers;
  board::BoardParts parts{};
  Diagnostics diagnostics{};
  std::vector<OptionalRing> optional_rings{};
  std::vector<EdgePiece> edges{};
  std::vector<std::size_t> loose_drawings{};  ///< shapes: top-level drawings on copper that state no net

  // Numbers and places. All throw Error input_number (203) or file_syntax (202) with the line.
  [[nodiscard]] double number(syntax::Sexpr atom) const;
  /// First argument of the named sub-list, or nullopt if there is no such list.
  [[nodiscard]] std::optional<double> number_of(syntax::Sexpr list, std::string_view head) const;
  /// (head x y)
  [[nodiscard]] Vec vec(syntax::Sexpr list) const;
  /// The named sub-list as a point; an absent one is an error.
  [[nodiscard]] Vec vec_of(syntax::Sexpr list, std::string_view head) const;
  [[nodiscard]] Nm length(double millimetres, syntax::Sexpr at) const;
  /// KiCad's frame to the board's: nanometres, y up.
  [[nodiscard]] geometry::Point point(Vec p, syntax::Sexpr at) const;
  [[nodiscard]] geometry::Path path(const Outlined& drawn, const Placement& place, syntax::Sexpr at) const;
  [[nodiscard]] geometry::Figure figure(const Outlined& drawn, const Placement& place, syntax::Sexpr at) const;
  /// Booleans of all versions: absent = no, (word) = yes, (word yes), (word no), bare word = yes.
  [[nodiscard]] static bool flag(syntax::Sexpr list, std::string_view word);

  // Nets.
  void read_net_table(syntax::Sexpr root);
  /// Net of an item from its (net ...), in the old form (code) or the new one (name).
  [[nodiscard]] std::int32_t net_of(syntax::Sexpr item);

  // Layers of an item.
  /// Copper meant by (layer L) or (layers ...); unknown names are counted.
  [[nodiscard]] LayerMask copper_of(syntax::Sexpr item);
  [[nodiscard]] static bool is_on(syntax::Sexpr item, std::string_view layer);

  /// Adds copper; a figure without area is counted and dropped.
  void add_copper(board::ShapeKind kind, std::int32_t copper_layer, std::int32_t net, geometry::Figure figure,
                  syntax::Sexpr item);
  void add_copper(board::ShapeKind kind, LayerMask copper, std::int32_t net, const geometry::Figure& figure,
                  syntax::Sexpr item);
  /// @param tool  the path of the tool and its diameter as pen
  void add_drill(board::Drill drill, syntax::Sexpr item);

  [[nodiscard]] Spot spot(syntax::Sexpr at, std::optional<Vec> place = std::nullopt) const;
  void warn(std::string_view code, std::string_view text, syntax::Sexpr at, std::optional<Vec> place = std::nullopt);
  /// The file does not state a value; the text names the one taken.
  void assume(std::string_view code, std::string_view text, syntax::Sexpr at, std::optional<Vec> place = std::nullopt);
  /// Counts every sub-list of `item` whose head is in neither list; construct and place are reported at the end.
  void count_unknown(syntax::Sexpr item, std::span<const std::string_view> known);
  void count_unknown_list(syntax::Sexpr list);
  /// Turns the counted unknown constructs into one diagnostic per word (at most 32 words).
  void report_unknown();

 private:
  struct Unknown {
    std::int64_t count = 0;
    std::vector<std::int64_t> lines;
  };
  std::map<std::int64_t, std::int32_t> net_by_code_;
  std::map<std::string, std::int32_t, std::less<>> net_by_name_;
  std::map<std::string, Unknown, std::less<>> unknown_;
  [[nodiscard]] std::int32_t net_named(std::string name);
};

/// Quotes a piece of the file for a message: short and printable.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace pcbmesh::formats::kicad
