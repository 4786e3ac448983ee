// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/view/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "pcbmesh/view/paint.hpp"
#include "src/view/svg.hpp"

namespace pcbmesh::view {
namespace {

constexpr int side = 640, gap = 28, overview = 300, top = 84, letters_per_line = 112;
constexpr Nm half_window_nm = 2 * nm_per_mm;
constexpr std::string_view mark_colour = "#d1242f";

struct Frame {
  geometry::Box window;
  double scale = 1;  ///< pixels per nanometre
  double x = 0, y = 0;
  [[nodiscard]] double px(double at_nm) const { return x + scale * (at_nm - static_cast<double>(window.min.x)); }
  [[nodiscard]] double py(double at_nm) const { return y + scale * (static_cast<double>(window.max.y) - at_nm); }
  [[nodiscard]] double width() const { return scale * static_cast<double>(window.max.x - window.min.x); }
  [[nodiscard]] double height() const { return scale * static_cast<double>(window.max.y - window.min.y); }
};

Frame frame_for(const geometry::Box& window, double x, double y, double room) {
  const auto larger = static_cast<double>(std::max({window.max.x - window.min.x, window.max.y - window.min.y, Nm{1}}));
  return {window, room / larger, x, y};
}

std::string path_of(const Frame& frame, const std::vector<geometry::Ring>& rings) {
  std::string path;
  for (const geometry::Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      path += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", frame.px(static_cast<double>(ring[i].x)),
                          frame.py(static_cast<double>(ring[i].y)));
    path += "Z";
  }
  return path;
}

/// Every outline with its cut-outs; where two overlap, both show.
std::string outlines(const board::Board& board, const Frame& frame, std::string_view style) {
  std::string out;
  for (const board::Outline& outline : board.outlines()) {
    std::vector<geometry::Ring> rings{geometry::flatten(outline.outer, {})};
    for (const geometry::Path& cutout : outline.cutouts) rings.push_back(geometry::flatten(cutout, {}));
    out += fmt::format("<path d=\"{}\" {}/>\n", path_of(frame, rings), style);
  }
  return out;
}

geometry::Box whole_board(const board::Board& board) {
  geometry::Box box;
  for (const board::Outline& outline : board.outlines()) box.add(geometry::bounds({outline.outer, 0, true}));
  if (box.is_empty())
    for (const board::Shape& shape : board.shapes()) box.add(geometry::bounds(shape.figure));
  return box;
}

/// Copper in the window: the named layer and net in full colour, the rest as a shadow.
std::string copper(const board::Board& board, const Error& error, const Frame& frame) {
  std::string shadow, other_nets, named;
  for (const board::Shape& shape : board.shapes()) {
    if (!geometry::bounds(shape.figure).touches(frame.window)) continue;
    bool simple = true;
    const std::string path = path_of(frame, geometry::outline(shape.figure, {}, simple));
    // An error of the outline alone names no copper: then all of it is shadow.
    const bool on_layer =
        error.spot().layer.empty() ? !error.spot().net.empty() : board.copper_name(shape.copper_layer) == error.spot().layer;
    const bool of_net = !error.spot().net.empty() && board.net_name(shape.net) == error.spot().net;
    (!on_layer ? shadow : of_net ? named : other_nets) += path;
  }
  std::string drills;
  for (const board::Drill& drill : board.drills()) {
    if (!geometry::bounds(drill.figure).touches(frame.window)) continue;
    bool simple = true;
    drills += path_of(frame, geometry::outline(drill.figure, {}, simple));
  }
  return fmt::format(
      "<path d=\"{}\" fill=\"#8a94a0\" fill-opacity=\".25\"/>\n<path d=\"{}\" fill=\"#cd7f3c\" fill-opacity=\".75\" "
      "stroke=\"#8f5526\" "
      "stroke-width=\".6\"/>\n<path d=\"{}\" fill=\"#2f6fb5\" fill-opacity=\".85\" stroke=\"#1b4676\" stroke-width=\".6\"/>\n"
      "<path d=\"{}\" fill=\"#ffffff\" stroke=\"#444c56\" stroke-width=\".8\"/>\n",
      shadow, other_nets, named, drills);
}

void put_frame(SvgPage& page, const Frame& frame, std::string_view id, std::string_view inside) {
  page.put(fmt::format(
      "<clipPath id=\"{0}\"><rect x=\"{1:.1f}\" y=\"{2:.1f}\" width=\"{3:.1f}\" height=\"{4:.1f}\"/></clipPath>\n"
      "<rect x=\"{1:.1f}\" y=\"{2:.1f}\" width=\"{3:.1f}\" height=\"{4:.1f}\" fill=\"#fbfcfd\" stroke=\"#9aa5b1\"/>\n"
      "<g clip-path=\"url(#{0})\">\n{5}</g>\n",
      id, frame.x, frame.y, frame.width(), frame.height(), inside));
}

std::string cross(const Frame& frame, const std::array<double, 2>& at_mm, double radius) {
  const double x = frame.px(at_mm[0] * 1e6), y = frame.py(at_mm[1] * 1e6);
  return fmt::format(
      "<g stroke=\"{0}\" fill=\"none\" stroke-width=\"2\"><circle cx=\"{1:.1f}\" cy=\"{2:.1f}\" r=\"{3}\"/><path "
      "d=\"M{4:.1f} {2:.1f}h{5}M{1:.1f} {6:.1f}v{5}\"/></g>\n",
      mark_colour, x, y, radius, x - 1.6 * radius, 3.2 * radius, y - 1.6 * radius);
}

/// The message in lines of even length, cut between words.
std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    if (!lines.back().empty() && lines.back().size() + end + 1 > letters_per_line) lines.emplace_back();
    if (!lines.back().empty()) lines.back() += ' ';
    lines.back() += text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace

std::string refusal_svg(const board::Board& board, const Error& error) {
  const std::array<double, 2> at = *error.spot().at_mm;
  const geometry::Point place{static_cast<Nm>(at[0] * 1e6), static_cast<Nm>(at[1] * 1e6)};
  geometry::Box window;
  window.add(place);
  const Frame near = frame_for(window.grown(half_window_nm), gap, top, side);
  geometry::Box all = whole_board(board);
  all.add(place);
  const Frame far = frame_for(all.grown((all.max.x - all.min.x) / 20 + nm_per_mm / 10), gap + side + gap, top, overview);

  const std::vector<std::string> lines = lines_of(error.text());
  const int height = top + side + 30 + 20 * static_cast<int>(lines.size()) + 16;
  SvgPage page(gap + side + gap + overview + gap, height, {});
  page.title(fmt::format("Not meshed: error {}", static_cast<int>(error.code())));
  page.put(fmt::format("<text x=\"20\" y=\"58\">{}</text>\n", escape_xml(error.spot().text())));
  constexpr std::string_view body = "fill=\"#d9cd9f\" fill-opacity=\".6\" fill-rule=\"evenodd\" stroke=\"#6d6443\"";
  constexpr std::string_view line = "fill=\"none\" stroke=\"#6d6443\" stroke-width=\"1.5\"";
  put_frame(page, near, "near",
            outlines(board, near, body) + copper(board, error, near) + outlines(board, near, line) + cross(near, at, 14));
  put_frame(page, far, "far", outlines(board, far, body) + cross(far, at, 9));
  const double mm = near.scale * static_cast<double>(nm_per_mm), bar_y = near.y + near.height() - 14;
  page.put(
      fmt::format("<g><path d=\"M{0:.1f} {1:.1f}v5h{2:.1f}v-5\" fill=\"none\" stroke=\"#1d2733\" stroke-width=\"1.5\"/><text "
                  "x=\"{3:.1f}\" y=\"{4:.1f}\" font-size=\"13\">1 mm</text></g>\n",
                  near.x + 12, bar_y - 5, mm, near.x + 20 + mm, bar_y + 4));
  if (!error.spot().net.empty() || !error.spot().layer.empty())
    page.put(fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"13\">{}{}</text>\n", gap + side + gap, top + far.height() + 28,
                         error.spot().layer.empty() ? "" : escape_xml(fmt::format("layer {}  ", error.spot().layer)),
                         error.spot().net.empty() ? "" : escape_xml(fmt::format("net {} in blue", error.spot().net))));
  for (std::size_t i = 0; i < lines.size(); ++i)
    page.put(fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", gap, top + side + 34 + 20 * static_cast<int>(i),
                         escape_xml(lines[i])));
  return page.finish();
}

}  // namespace pcbmesh::view
