// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "pcbmesh/formats/registry.hpp"
#include "src/cli/commands.hpp"
#include "src/cli/diagnostics_json.hpp"
#include "src/cli/terminal.hpp"

namespace pcbmesh::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string board, format;
  bool json = false, quiet = false;
};

constexpr std::array shape_kinds{board::ShapeKind::track, board::ShapeKind::via, board::ShapeKind::pad, board::ShapeKind::fill,
                                 board::ShapeKind::graphic};

/// Shapes and layers of one net.
struct NetSummary {
  std::array<std::int64_t, shape_kinds.size()> counts{};
  std::int64_t drills = 0;
  std::set<std::int32_t> layers;
};

std::vector<NetSummary> summarise(const board::Board& board) {
  std::vector<NetSummary> nets(board.nets().size() + 1);  // the last one: no net
  const auto of = [&](std::int32_t net) -> NetSummary& { return net < 0 ? nets.back() : nets[static_cast<std::size_t>(net)]; };
  for (const board::Shape& shape : board.shapes()) {
    NetSummary& summary = of(shape.net);
    ++summary.counts[static_cast<std::size_t>(shape.kind)];
    summary.layers.insert(shape.copper_layer);
  }
  for (const board::Drill& drill : board.drills()) ++of(drill.net).drills;
  return nets;
}

geometry::Box extent(const board::Board& board) {
  geometry::Box box;
  for (const board::Outline& outline : board.outlines()) box.add(geometry::bounds({outline.outer, 0, true}));
  if (box.is_empty())
    for (const board::Shape& shape : board.shapes()) box.add(geometry::bounds(shape.figure));
  return box;
}

std::string_view kind_name(board::LayerKind kind) {
  switch (kind) {
    case board::LayerKind::copper:
      return "copper";
    case board::LayerKind::dielectric:
      return "dielectric";
    case board::LayerKind::solder_mask:
      return "solder mask";
  }
  return "layer";
}

double mm(Nm length) {
  return static_cast<double>(length) * 1e-6;
}

/// Rough size of a whole-board mesh at the default settings, for a first decision.
/// Feature-bound boards give about 2.6 triangles per outline vertex after cleaning (docs/evidence/boards.md); 2 mm edges fill
/// the rest.
double forecast_triangles(const board::Board& board, const geometry::Box& box) {
  double features = 0;
  for (const board::Shape& shape : board.shapes())
    features += shape.kind == board::ShapeKind::fill ? static_cast<double>(shape.figure.path.points.size()) * 0.5 : 8.0;
  for (std::size_t i = 0; i < board.drills().size(); ++i) features += 8;
  const double area = box.is_empty() ? 0 : mm(box.max.x - box.min.x) * mm(box.max.y - box.min.y);
  return 2.6 * features + area / (0.198 * 4.0);
}

std::string to_json(const board::Board& board, const Diagnostics& diagnostics) {
  const geometry::Box box = extent(board);
  Json layers = Json::array();
  for (const board::StackupLayer& layer : board.stackup()) {
    const board::Material& m = board.materials()[static_cast<std::size_t>(layer.material)];
    layers.push_back({{"name", layer.name},
                      {"user_name", layer.user_name},
                      {"kind", kind_name(layer.kind)},
                      {"thickness_mm", mm(layer.thickness_nm)},
                      {"material", m.name},
                      {"eps_r", m.eps_r},
                      {"tan_delta", m.tan_delta},
                      {"sigma_s_per_m", m.sigma_s_per_m}});
  }
  Json nets = Json::array();
  const std::vector<NetSummary> summaries = summarise(board);
  for (std::size_t n = 0; n < summaries.size(); ++n) {
    const NetSummary& s = summaries[n];
    if (n + 1 == summaries.size() && s.layers.empty() && s.drills == 0) continue;
    Json names = Json::array();
    for (std::int32_t layer : s.layers) names.push_back(board.copper_name(layer));
    Json entry{{"name", n + 1 == summaries.size() ? Json(nullptr) : Json(board.nets()[n])}};
    for (std::size_t k = 0; k < shape_kinds.size(); ++k)
      entry[fmt::format("{}s", board::name_of(shape_kinds[k]))] = s.counts[k];
    entry["drills"] = s.drills;
    entry["layers"] = names;
    nets.push_back(entry);
  }
  return Json{{"source", board.source()},
              {"outlines", board.outlines().size()},
              {"box_mm", box.is_empty() ? Json(nullptr) : Json{mm(box.min.x), mm(box.min.y), mm(box.max.x), mm(box.max.y)}},
              {"layers", layers},
              {"nets", nets},
              {"counts", {{"shapes", board.shapes().size()}, {"drills", board.drills().size()}, {"pins", board.pins().size()}}},
              {"forecast", {{"triangles", std::llround(forecast_triangles(board, box))}}},
              {"diagnostics", diagnostics_json(diagnostics)}}
      .dump(2);
}

std::string to_text(const board::Board& board) {
  const geometry::Box box = extent(board);
  std::string out = fmt::format("{}\n", board.source());
  if (!box.is_empty())
    out += fmt::format("  {:.4g} x {:.4g} mm, box ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) mm, {} outline{}\n",
                       mm(box.max.x - box.min.x), mm(box.max.y - box.min.y), mm(box.min.x), mm(box.min.y), mm(box.max.x),
                       mm(box.max.y), board.outlines().size(), board.outlines().size() == 1 ? "" : "s");
  out += "\nStackup, top to bottom\n";
  for (const board::StackupLayer& layer : board.stackup()) {
    const board::Material& m = board.materials()[static_cast<std::size_t>(layer.material)];
    out += fmt::format("  {:<16} {:<12} {:>10}  {:<14} eps_r {:<5.4g} tan_d {:<7.4g}{}\n", layer.name, kind_name(layer.kind),
                       format_length(layer.thickness_nm), m.name, m.eps_r, m.tan_delta,
                       layer.user_name.empty() || layer.user_name == layer.name ? "" : "  \"" + layer.user_name + "\"");
  }
  const std::vector<NetSummary> summaries = summarise(board);
  std::vector<std::size_t> order;
  for (std::size_t n = 0; n < summaries.size(); ++n)
    if (!summaries[n].layers.empty() || summaries[n].drills > 0) order.push_back(n);
  const auto weight = [&](std::size_t n) {
    std::int64_t sum = summaries[n].drills;
    for (std::int64_t c : summaries[n].counts) sum += c;
    return sum;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return weight(a) > weight(b); });
  constexpr std::size_t most = 40;
  out += fmt::format("\nNets with copper: {}{}\n  {:<32} {:>7} {:>6} {:>6} {:>6} {:>8} {:>6}  layers\n", order.size(),
                     order.size() > most ? fmt::format(" (the {} largest; --json lists all)", most) : "", "name", "tracks",
                     "vias", "pads", "fills", "graphics", "drills");
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i) {
    const NetSummary& s = summaries[order[i]];
    std::vector<std::string> names;
    for (std::int32_t layer : s.layers) names.push_back(board.copper_name(layer));
    out += fmt::format("  {:<32} {:>7} {:>6} {:>6} {:>6} {:>8} {:>6}  {}\n",
                       order[i] + 1 == summaries.size() ? "(no net)" : board.nets()[order[i]], s.counts[0], s.counts[1],
                       s.counts[2], s.counts[3], s.counts[4], s.drills, fmt::join(names, " "));
  }
  out += fmt::format(
      "\nForecast: a mesh of the whole board has in the order of {} triangles per sub-layer; pcbmesh mesh --dry-run counts "
      "exactly.\n",
      grouped(std::llround(forecast_triangles(board, box) / 1000) * 1000));
  return out;
}

int run(const Options& options) {
  const formats::ReadBoardResult read = formats::read_board(options.board, options.format, terminal_progress(options.quiet));
  clear_progress();
  if (options.json) {
    fmt::print("{}\n", to_json(read.board, read.diagnostics));
    return 0;
  }
  print_diagnostics(read.diagnostics);
  fmt::print("{}", to_text(read.board));
  return 0;
}

}  // namespace

Command add_inspect_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("inspect", "Show a board: stackup, layers, nets, shape counts, forecast");
  auto options = std::make_shared<Options>();
  command->add_option("board", options->board, "Board file")->required();
  command->add_option("--format", options->format, "Format of the board (default: by content and name)");
  command->add_flag("--json", options->json, "Print JSON: an object with layers and nets");
  command->add_flag("--quiet", options->quiet, "No progress line");
  command->footer("Examples:\n  pcbmesh inspect board.kicad_pcb\n  pcbmesh inspect board.kicad_pcb --json | jq '.nets[].name'");
  return {command, [options] { return run(*options); }};
}

}  // namespace pcbmesh::cli
