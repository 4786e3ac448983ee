// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::kicad {
namespace {

constexpr int bottom_rank = 1000;
constexpr std::int64_t user_names_apart = 20200922;

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Rank of a canonical copper name from the top, or nullopt.
std::optional<int> canonical_rank(std::string_view name) {
  if (name == "F.Cu") return 0;
  if (name == "B.Cu") return bottom_rank;
  if (!name.starts_with("In") || !name.ends_with(".Cu")) return std::nullopt;
  const auto number = whole_number(name.substr(2, name.size() - 5));
  if (!number || *number < 1 || *number >= bottom_rank) return std::nullopt;
  return number;
}

std::string canonical_name(int rank) {
  return rank == 0 ? "F.Cu" : rank == bottom_rank ? "B.Cu" : fmt::format("In{}.Cu", rank);
}

struct Ranked {
  int rank = 0;
  std::string file_name, user_name;
  std::int64_t line = 0;
};

}  // namespace

LayerTable::LayerTable(syntax::Sexpr layers, std::int64_t version, const std::string& file) {
  std::vector<Ranked> ranked;
  for (const syntax::Sexpr layer : layers) {
    if (!layer.is_list()) continue;
    const auto ordinal = whole_number(layer.head());
    const std::string name = layer.arg(0).text();
    auto rank = canonical_rank(name);
    if (version < user_names_apart && ordinal && *ordinal >= 0 && *ordinal <= 31)
      rank = *ordinal == 31 ? bottom_rank : *ordinal;
    if (rank)
      ranked.push_back({*rank, name, layer.arg(2).text(), layer.line()});
    else
      by_name_.emplace(name, not_copper);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });
  if (ranked.empty())
    throw Error(ErrorCode::board_invalid, "the layer table names no copper layer; expected (layers (0 \"F.Cu\" signal) ...)",
                {.file = file, .line = layers.line()});
  if (ranked.size() > 60)
    throw Error(ErrorCode::board_invalid, fmt::format("{} copper layers; at most 60 are read", ranked.size()),
                {.file = file, .line = layers.line()});
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    const Ranked& layer = ranked[i];
    const int index = static_cast<int>(i);
    if ((i > 0 && ranked[i - 1].rank == layer.rank) || !by_name_.emplace(layer.file_name, index).second)
      throw Error(ErrorCode::board_invalid, "this copper layer stands twice in the layer table",
                  {.file = file, .line = layer.line, .layer = layer.file_name});
    std::string name = canonical_name(layer.rank);
    std::string user_name = layer.file_name != name ? layer.file_name : layer.user_name;
    if (user_name == name) user_name.clear();
    copper_.push_back({std::move(name), std::move(user_name)});
  }
  // Second names after all first ones, so that a layer called like another's canonical name keeps its own.
  for (std::size_t i = 0; i < copper_.size(); ++i) by_name_.emplace(copper_[i].name, static_cast<int>(i));
}

int LayerTable::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? unknown : found->second;
}

LayerMask LayerTable::mask(std::string_view entry, bool& known) const {
  known = true;
  if (entry == "*.Cu") return all_copper();
  if (entry == "F&B.Cu") return LayerMask{1} | LayerMask{1} << (copper_.size() - 1);
  if (entry.find('*') != std::string_view::npos || entry.find('&') != std::string_view::npos) return 0;
  const int index = find(entry);
  if (index >= 0) return LayerMask{1} << index;
  // Technical layers may be switched off in the table and still stand in pads; copper may not.
  known = index != unknown || (entry.find('.') != std::string_view::npos && !entry.ends_with(".Cu"));
  return 0;
}

}  // namespace pcbmesh::formats::kicad
