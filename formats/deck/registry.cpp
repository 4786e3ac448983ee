// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "formats/dolfinx/format.hpp"
#include "formats/elmer_deck/format.hpp"
#include "formats/getdp/format.hpp"
#include "formats/mfem_deck/format.hpp"
#include "formats/palace/format.hpp"
#include "pcbmesh/base/error.hpp"
#include "pcbmesh/formats/deck.hpp"

namespace pcbmesh::formats {
namespace {

// The table: a new solver is one include above and one entry here.
constexpr std::array<const DeckFormat*, 5> deck_table{&getdp::deck_format, &palace::deck_format, &elmer_deck::deck_format,
                                                      &dolfinx::deck_format, &mfem_deck::deck_format};

}  // namespace

DeckOptions deck_options(const study::Study& study, std::string mesh) {
  return {study.problem, study.sweep ? study.sweep->frequencies_hz() : std::vector<double>(), study.modes, std::move(mesh),
          study.unit};
}

std::span<const DeckFormat* const> deck_formats() {
  return deck_table;
}

bool has_deck(std::string_view solver) {
  return std::ranges::any_of(deck_table, [&](const DeckFormat* format) { return format->name == solver; });
}

const DeckFormat& find_deck_format(std::string_view name) {
  const auto found = std::ranges::find(deck_table, name, [](const DeckFormat* format) { return format->name; });
  if (found != deck_table.end()) return **found;
  std::string list;
  for (const DeckFormat* format : deck_table) list += fmt::format("{}{}", list.empty() ? "" : ", ", format->name);
  throw Error(ErrorCode::usage, fmt::format("there is no deck for '{}'; solvers are {}", name, list));
}

void require_deck(const mesh::PrismMesh& mesh, std::string_view solver, const DeckOptions& options) {
  find_deck_format(solver).require(mesh, options);
}

Deck write_deck(const mesh::PrismMesh& mesh, std::string_view solver, const DeckOptions& options,
                const std::filesystem::path& folder, Diagnostics& diagnostics) {
  return find_deck_format(solver).write(mesh, options, folder, diagnostics);
}

}  // namespace pcbmesh::formats
