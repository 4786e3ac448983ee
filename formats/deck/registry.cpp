// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "formats/getdp/format.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/deck.hpp"

namespace pcbmesh::formats {
namespace {

// The table: a new solver is one include above and one entry here.
constexpr std::array<const DeckFormat*, 1> deck_table{&getdp::deck_format};

constexpr std::array<std::string_view, 3> problem_names{"driven", "eigenmode", "electrostatic"};

}  // namespace

std::string_view name_of(Problem problem) {
  return problem_names[static_cast<std::size_t>(problem)];
}

Problem parse_problem(std::string_view text) {
  const auto found = std::ranges::find(problem_names, text);
  if (found == problem_names.end())
    throw Error(ErrorCode::usage, fmt::format("'{}' is no problem; choose driven, eigenmode or electrostatic", text));
  return static_cast<Problem>(found - problem_names.begin());
}

std::span<const DeckFormat* const> deck_formats() {
  return deck_table;
}

const DeckFormat& find_deck_format(std::string_view name) {
  const auto found = std::ranges::find(deck_table, name, [](const DeckFormat* format) { return format->name; });
  if (found != deck_table.end()) return **found;
  std::string list;
  for (const DeckFormat* format : deck_table) list += fmt::format("{}{}", list.empty() ? "" : ", ", format->name);
  throw Error(ErrorCode::usage, fmt::format("there is no deck for '{}'; solvers are {}", name, list));
}

Deck write_deck(const mesh::PrismMesh& mesh, std::string_view solver, const DeckOptions& options,
                const std::filesystem::path& folder, Diagnostics& diagnostics) {
  return find_deck_format(solver).write(mesh, options, folder, diagnostics);
}

}  // namespace pcbmesh::formats
