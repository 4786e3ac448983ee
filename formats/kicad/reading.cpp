// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::kicad {

using syntax::Sexpr;

namespace {

constexpr std::int64_t net_codes_gone = 20251028;
constexpr std::size_t max_unknown_words = 32;

std::optional<std::int64_t> whole_number(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string shown(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += c >= 0 && c < ' ' ? '?' : c;
  if (text.size() > 40) out += "...";
  return out;
}

Reading::Reading(const syntax::SexprTree& tree_, std::int64_t file_version, LayerTable layer_table)
    : tree(tree_), version(file_version), layers(std::move(layer_table)) {}

Spot Reading::spot(Sexpr at, std::optional<Vec> place) const {
  Spot spot{.file = tree.file(), .line = at.line()};
  if (place) spot.at_mm = {place->x, -place->y};
  return spot;
}

void Reading::warn(std::string_view code, std::string_view text, Sexpr at, std::optional<Vec> place) {
  diagnostics.warn(code, text, spot(at, place));
}

void Reading::assume(std::string_view code, std::string_view text, Sexpr at, std::optional<Vec> place) {
  diagnostics.assume(Severity::warning, code, text, spot(at, place));
}

double Reading::number(Sexpr atom) const {
  std::string_view text = atom.raw();
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(value)) return value;
  throw Error(ErrorCode::input_number,
              atom ? fmt::format("'{}' where a number is expected", shown(atom.is_list() ? "(...)" : atom.raw()))
                   : "a number is missing",
              spot(atom));
}

std::optional<double> Reading::number_of(Sexpr list, std::string_view head) const {
  const Sexpr found = list.child(head);
  if (!found) return std::nullopt;
  if (!found.arg(0)) throw Error(ErrorCode::input_number, fmt::format("({}) without a number", head), spot(found));
  return number(found.arg(0));
}

Vec Reading::vec(Sexpr list) const {
  const Sexpr x = list.arg(0), y = x.next();
  if (!x || !y)
    throw Error(ErrorCode::file_syntax, fmt::format("expected two numbers in ({} x y)", shown(list.head())), spot(list));
  return {number(x), number(y)};
}

Vec Reading::vec_of(Sexpr list, std::string_view head) const {
  const Sexpr found = list.child(head);
  if (!found)
    throw Error(ErrorCode::file_syntax, fmt::format("({} ...) without its ({} x y)", shown(list.head()), head), spot(list));
  return vec(found);
}

Nm Reading::length(double millimetres, Sexpr at) const {
  constexpr double limit = static_cast<double>(max_coordinate_nm) / static_cast<double>(nm_per_mm);
  if (!(std::abs(millimetres) <= limit))
    throw Error(ErrorCode::input_number,
                fmt::format("{:.6g} mm is no length or place on a board (limit {} mm)", millimetres, limit), spot(at));
  return static_cast<Nm>(std::llround(millimetres * static_cast<double>(nm_per_mm)));
}

geometry::Point Reading::point(Vec p, Sexpr at) const {
  return {length(p.x, at), length(-p.y, at)};
}

geometry::Path Reading::path(const Outlined& drawn, const Placement& place, Sexpr at) const {
  geometry::Path out;
  out.closed = drawn.closed;
  out.points.reserve(drawn.points.size());
  for (const Vec p : drawn.points) out.points.push_back(point(place(p), at));
  out.arc_starts.reserve(drawn.arc_starts.size());
  for (const std::size_t i : drawn.arc_starts) out.arc_starts.push_back(static_cast<std::int32_t>(i));
  return out;
}

geometry::Figure Reading::figure(const Outlined& drawn, const Placement& place, Sexpr at) const {
  return {path(drawn, place, at), length(drawn.pen, at), drawn.filled};
}

bool Reading::flag(Sexpr list, std::string_view word) {
  const Sexpr found = list.child(word);
  if (!found) return list.has_word(word);
  return !found.arg(0) || (found.arg(0).raw() != "no" && found.arg(0).raw() != "false");
}

std::int32_t Reading::net_named(std::string name) {
  if (name.empty()) return board::no_net;
  const auto [found, is_new] = net_by_name_.try_emplace(name, static_cast<std::int32_t>(parts.nets.size()));
  if (is_new) parts.nets.push_back(std::move(name));
  return found->second;
}

void Reading::read_net_table(Sexpr root) {
  for (const Sexpr net : root) {
    if (!net.is_list() || net.head() != "net") continue;
    const auto code = whole_number(net.arg(0).raw());
    if (!code) throw Error(ErrorCode::input_number, fmt::format("'{}' is no net code", shown(net.arg(0).raw())), spot(net));
    if (!net_by_code_.emplace(*code, net_named(net.arg(1).text())).second)
      warn("kicad.net_code_twice", "two nets have the same code; items of that code go to the first", net);
  }
}

std::int32_t Reading::net_of(Sexpr item) {
  const Sexpr net = item.child("net");
  if (!net) return board::no_net;
  const Sexpr id = net.arg(0);
  if (version >= net_codes_gone || id.is_quoted()) return net_named(id.text());
  const auto code = whole_number(id.raw());
  if (!code) throw Error(ErrorCode::input_number, fmt::format("'{}' is no net code", shown(id.raw())), spot(net));
  const auto found = net_by_code_.find(*code);
  if (found != net_by_code_.end()) return found->second;
  // Code 0 is "no net" even where the table does not say so; pads repeat the name beside the code.
  if (*code == 0) return board::no_net;
  if (net.arg(1)) {
    warn("kicad.unknown_net", "net code is not in the net table; the name beside it is used", net);
    return net_named(net.arg(1).text());
  }
  warn("kicad.unknown_net", fmt::format("net code {} is not in the net table; the copper is read as having no net", *code),
       net);
  return board::no_net;
}

LayerMask Reading::copper_of(Sexpr item) {
  LayerMask copper = 0;
  for (const std::string_view word : {"layer", "layers"}) {
    for (Sexpr entry = item.child(word).arg(0); entry; entry = entry.next()) {
      if (entry.is_list() || (entry.is_word() && entry.raw() == "knockout")) continue;
      bool known = true;
      copper |= layers.mask(entry.raw(), known);
      if (!known)
        warn("kicad.unknown_layer", fmt::format("layer '{}' is not in the layer table; skipped", shown(entry.raw())), entry);
    }
  }
  return copper;
}

bool Reading::is_on(Sexpr item, std::string_view layer) {
  for (const std::string_view word : {"layer", "layers"})
    for (Sexpr entry = item.child(word).arg(0); entry; entry = entry.next())
      if (entry.raw() == layer) return true;
  return false;
}

void Reading::add_copper(board::ShapeKind kind, std::int32_t copper_layer, std::int32_t net, geometry::Figure figure,
                         Sexpr item) {
  const geometry::Path& path = figure.path;
  if (figure.filled && (!path.closed || path.points.size() < 3)) figure.filled = false;
  if (path.points.empty() || figure.pen < 0 || (figure.pen == 0 && !figure.filled)) {
    warn("kicad.no_area", fmt::format("{} without area (width 0); skipped", board::name_of(kind)), item);
    return;
  }
  parts.shapes.push_back({copper_layer, net, kind, std::move(figure), item.line()});
}

void Reading::add_copper(board::ShapeKind kind, LayerMask copper, std::int32_t net, const geometry::Figure& figure,
                         Sexpr item) {
  for (int layer = 0; layer < layers.num_copper(); ++layer)
    if ((copper >> layer & 1) != 0) add_copper(kind, layer, net, figure, item);
}

void Reading::add_drill(board::Drill drill, Sexpr item) {
  drill.line = item.line();
  parts.drills.push_back(std::move(drill));
}

void Reading::count_unknown_list(Sexpr list) {
  std::string name = shown(list.head());
  if (name.empty()) name = "()";
  auto found = unknown_.find(name);
  if (found == unknown_.end()) {
    if (unknown_.size() >= max_unknown_words) name = "(other)";
    found = unknown_.try_emplace(std::move(name)).first;
  }
  if (++found->second.count <= static_cast<std::int64_t>(Diagnostic::max_spots)) found->second.lines.push_back(list.line());
}

void Reading::count_unknown(Sexpr item, std::span<const std::string_view> known) {
  for (const Sexpr part : item)
    if (part.is_list() && std::find(known.begin(), known.end(), part.head()) == known.end()) count_unknown_list(part);
}

void Reading::report_unknown() {
  for (const auto& [word, seen] : unknown_)
    for (std::int64_t i = 0; i < seen.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      diagnostics.warn("kicad.unknown_construct." + word, fmt::format("'{}' is not known to this reader and was skipped", word),
                       k < seen.lines.size() ? Spot{.file = tree.file(), .line = seen.lines[k]} : Spot{});
    }
}

}  // namespace pcbmesh::formats::kicad
