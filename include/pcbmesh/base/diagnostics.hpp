// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh {

enum class Severity { note, warning };

/// All messages of one kind: counted in full, with the first few texts and places kept.
struct Diagnostic {
  Severity severity = Severity::warning;
  std::string code;            ///< stable dotted name, e.g. "kicad.text_on_copper"
  std::string text;            ///< text of the first occurrence
  std::int64_t count = 0;      ///< how often it happened
  std::vector<Spot> spots;     ///< places of the first `max_spots` occurrences
  bool is_assumption = false;  ///< a value was taken that the input does not state
  static constexpr std::size_t max_spots = 8;
};

/// Words about a value that was made all the same: skipped features, defaults taken, snapped vertices.
/// Messages are grouped by code, in order of first appearance; none is lost, all are counted.
class Diagnostics {
 public:
  void note(std::string_view code, std::string_view text, Spot spot = {});
  void warn(std::string_view code, std::string_view text, Spot spot = {});
  /// The input does not state a value; the text names the one taken.
  void assume(Severity severity, std::string_view code, std::string_view text, Spot spot = {});
  /// Appends another stage's messages.
  void merge(const Diagnostics& other);

  [[nodiscard]] std::span<const Diagnostic> entries() const noexcept { return entries_; }
  [[nodiscard]] std::int64_t num_warnings() const noexcept;
  /// Count of one code, 0 if it never happened.
  [[nodiscard]] std::int64_t count(std::string_view code) const noexcept;

 private:
  void add(Severity severity, std::string_view code, std::string_view text, Spot spot, bool is_assumption = false);
  std::vector<Diagnostic> entries_;
};

}  // namespace pcbmesh
