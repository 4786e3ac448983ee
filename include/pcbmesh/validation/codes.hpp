// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::validation {

/// One kind of finding. Codes are stable: scripts and CI systems match on them.
struct CheckCode {
  std::string_view code;     ///< e.g. "node.hanging"
  FindingSeverity severity;  ///< as the check reports it
  std::string_view subject;  ///< heading in docs/checks.md, e.g. "Nodes"
  std::string_view meaning;  ///< what is wrong and why it matters
  std::string_view remedy;   ///< what to do
};

/// Every code that check() can report, grouped by subject, as in docs/checks.md.
[[nodiscard]] std::span<const CheckCode> check_codes();
/// nullptr if there is no such code. @cost O(codes).
[[nodiscard]] const CheckCode* find_check_code(std::string_view code);
/// One line per code, for `pcbmesh check --list`.
[[nodiscard]] std::string list_check_codes();
/// Meaning and remedy of one code, for `pcbmesh check --explain`.
[[nodiscard]] std::string explain_check_code(const CheckCode& entry);
/// "error" or "warning".
[[nodiscard]] std::string_view word_of(FindingSeverity severity);

}  // namespace pcbmesh::validation
