// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/diagnostics.hpp"

#include <algorithm>
#include <utility>

namespace pcbmesh {

void Diagnostics::note(std::string_view code, std::string_view text, Spot spot) {
  add(Severity::note, code, text, std::move(spot));
}
void Diagnostics::warn(std::string_view code, std::string_view text, Spot spot) {
  add(Severity::warning, code, text, std::move(spot));
}

void Diagnostics::assume(Severity severity, std::string_view code, std::string_view text, Spot spot) {
  add(severity, code, text, std::move(spot), true);
}

void Diagnostics::add(Severity severity, std::string_view code, std::string_view text, Spot spot, bool is_assumption) {
  auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Diagnostic& d) { return d.code == code; });
  if (found == entries_.end()) {
    entries_.push_back({severity, std::string(code), std::string(text), 0, {}, is_assumption});
    found = std::prev(entries_.end());
  }
  ++found->count;
  if (found->spots.size() < Diagnostic::max_spots && !spot.text().empty()) found->spots.push_back(std::move(spot));
}

void Diagnostics::merge(const Diagnostics& other) {
  for (const Diagnostic& d : other.entries_) {
    auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Diagnostic& e) { return e.code == d.code; });
    if (found == entries_.end()) {
      entries_.push_back(d);
      continue;
    }
    found->count += d.count;
    for (const Spot& spot : d.spots)
      if (found->spots.size() < Diagnostic::max_spots) found->spots.push_back(spot);
  }
}

std::int64_t Diagnostics::num_warnings() const noexcept {
  std::int64_t sum = 0;
  for (const Diagnostic& d : entries_)
    if (d.severity == Severity::warning) sum += d.count;
  return sum;
}

std::int64_t Diagnostics::count(std::string_view code) const noexcept {
  for (const Diagnostic& d : entries_)
    if (d.code == code) return d.count;
  return 0;
}

}  // namespace pcbmesh
