// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/board_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "formats/kicad/drawing_nets.hpp"
#include "formats/kicad/footprints.hpp"
#include "formats/kicad/graphics.hpp"
#include "formats/kicad/outlines.hpp"
#include "formats/kicad/reading.hpp"
#include "formats/kicad/stackup.hpp"
#include "formats/kicad/tracks.hpp"
#include "formats/kicad/unused_rings.hpp"
#include "formats/kicad/zones.hpp"
#include "formats/syntax/sexpr.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::kicad {
namespace {

using syntax::Sexpr;

constexpr std::int64_t oldest_version = 4, newest_known_version = 20260206;

// The 9.0 writer forgets the bracket before this word inside (teardrops ...).
constexpr std::array<std::string_view, 1> words_missing_bracket{"filter_ratio"};

constexpr std::array<std::string_view, 24> ignored_parts{
    "version",        "generator", "generator_version", "host",     "general",       "paper",     "page",      "title_block",
    "layers",         "setup",     "property",          "net",      "net_class",     "group",     "generated", "embedded_fonts",
    "embedded_files", "variants",  "component_classes", "netclass", "zone_defaults", "teardrops", "point",     "variant"};
constexpr std::array<std::string_view, 7> annotations{"gr_text", "gr_text_box", "table",  "dimension",
                                                      "image",   "target",      "barcode"};

std::int64_t version_of(const syntax::SexprTree& tree) {
  const Sexpr root = tree.root(), version = root.child("version");
  if (root.head() != "kicad_pcb")
    throw Error(ErrorCode::file_syntax,
                fmt::format("starts with '({}'; a KiCad board starts with (kicad_pcb", shown(root.head())),
                {.file = tree.file(), .line = 1});
  const std::string_view text = version.arg(0).raw();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(ErrorCode::file_syntax, "the board states no (version N)",
                {.file = tree.file(), .line = std::max<std::int64_t>(1, version.line())});
  if (number < oldest_version)
    throw Error(ErrorCode::file_syntax,
                fmt::format("file version {} is older than KiCad 4; open the board in a newer KiCad and save it", number),
                {.file = tree.file(), .line = version.line()});
  return number;
}

void read_item(Reading& reading, const ViaDefaults& via_defaults, Sexpr item) {
  const std::string_view head = item.head();
  if (head == "segment")
    read_segment(reading, item);
  else if (head == "arc")
    read_track_arc(reading, item);
  else if (head == "via")
    read_via(reading, via_defaults, item);
  else if (head == "footprint" || head == "module")
    read_footprint(reading, item);
  else if (head == "zone")
    read_zone(reading, item);
  else if (is_graphic(head))
    read_graphic(reading, Placement{}, item);
  else if (std::find(annotations.begin(), annotations.end(), head) != annotations.end())
    skip_annotation(reading, item);
  else if (std::find(ignored_parts.begin(), ignored_parts.end(), head) == ignored_parts.end())
    reading.count_unknown_list(item);
}

}  // namespace

ReadBoardResult read_board_text(std::string text, std::string file, std::string name, const Progress& progress) {
  progress.at("parse", 0);
  const double bytes = static_cast<double>(std::max<std::size_t>(1, text.size()));
  const syntax::SexprTree tree(std::move(text), file, {words_missing_bracket});
  const Sexpr root = tree.root();
  const std::int64_t version = version_of(tree);
  if (!root.child("layers"))
    throw Error(ErrorCode::board_invalid, "the board has no layer table (layers ...)", {.file = file, .line = root.line()});
  Reading reading(tree, version, LayerTable(root.child("layers"), version, file));
  reading.parts.name = std::move(name);
  reading.parts.source = file;
  for (const std::int64_t line : tree.repaired_lines())
    reading.diagnostics.note("kicad.bracket_repaired", "a missing '(' before filter_ratio was put back",
                             {.file = file, .line = line});
  if (version > newest_known_version)
    reading.diagnostics.warn("kicad.newer_version",
                             fmt::format("file version {} is newer than the newest this reader knows ({}); check the result",
                                         version, newest_known_version),
                             {.file = file});

  read_stackup(reading, root);
  reading.read_net_table(root);
  const ViaDefaults via_defaults(reading, root);
  std::int64_t num_items = 0;
  for (const Sexpr item : root) {
    if (item.is_list()) read_item(reading, via_defaults, item);
    if (++num_items % 1024 == 0) progress.at("read board", std::min(1.0, static_cast<double>(item.offset()) / bytes));
  }
  adopt_nets(reading);
  add_used_rings(reading);
  progress.at("chain outline", 0);
  read_outlines(reading);
  reading.report_unknown();
  progress.at("read board", 1);
  return {board::Board::from_parts(std::move(reading.parts)), std::move(reading.diagnostics)};
}

}  // namespace pcbmesh::formats::kicad
