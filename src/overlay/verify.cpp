// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/overlay/verify.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pcbmesh::overlay {

std::vector<Mismatch> compare(const Census& exact, const Census& got, const model::Model& model) {
  std::vector<Mismatch> found;
  std::vector<NetPair> changed;
  std::set_symmetric_difference(exact.touching.begin(), exact.touching.end(), got.touching.begin(), got.touching.end(),
                                std::back_inserter(changed));
  for (const NetPair& nets : changed) {
    const bool met = !std::binary_search(exact.touching.begin(), exact.touching.end(), nets);
    found.push_back({fmt::format("nets {} and {} {} by snapping", model.net_name(nets[0]), model.net_name(nets[1]),
                                 met ? "come to touch" : "come apart"),
                     -1, board::no_net, nets});
  }
  for (std::size_t b = 0; b < exact.components.size(); ++b) {
    if (exact.components[b] == got.components[b]) continue;
    found.push_back({fmt::format("{} has {} parts in the layout but {} after snapping", model.bodies()[b].name,
                                 exact.components[b], got.components[b]),
                     static_cast<std::int32_t>(b), board::no_net, std::nullopt});
  }
  for (std::size_t n = 0; n < exact.pieces.size(); ++n) {
    if (exact.pieces[n] == got.pieces[n]) continue;
    Mismatch mismatch{fmt::format("net {} has {} pieces in the layout but {} after snapping", model.nets()[n], exact.pieces[n],
                                  got.pieces[n]),
                      -1, static_cast<std::int32_t>(n), std::nullopt};
    for (std::size_t b = 0; b < model.bodies().size() && mismatch.body < 0; ++b) {
      if (model.bodies()[b].net == static_cast<std::int32_t>(n)) mismatch.body = static_cast<std::int32_t>(b);
    }
    found.push_back(std::move(mismatch));
  }
  return found;
}

std::optional<Point> differing_place(const std::vector<Point>& a, const std::vector<Point>& b, double near_nm) {
  for (const auto* list : {&a, &b}) {
    const auto& other = list == &a ? b : a;
    for (const Point p : *list) {
      if (std::ranges::none_of(other, [&](Point q) { return distance2(p, q) <= near_nm * near_nm; })) return p;
    }
  }
  if (a.empty()) return std::nullopt;
  return a.front();
}

}  // namespace pcbmesh::overlay
