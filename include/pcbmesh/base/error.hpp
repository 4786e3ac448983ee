// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <vector>

namespace pcbmesh {

/// Place that a message talks about. Every field is optional; empty or negative means unknown.
struct Spot {
  std::string file{};                            ///< path as the user gave it
  std::int64_t line = 0;                         ///< 1-based line, 0 = unknown
  std::int64_t byte = -1;                        ///< byte offset, for binary files
  std::string layer{};                           ///< board layer name
  std::string net{};                             ///< net name
  std::optional<std::array<double, 2>> at_mm{};  ///< place on the board, millimetres, y up

  /// "board.kicad_pcb:120, layer F.Cu, net GND, at (12.5, -3.1) mm"; empty if nothing is known.
  [[nodiscard]] std::string text() const;
};

/// Stable error codes, one range per room; docs/errors.md lists a remedy for each. Never renumbered.
enum class ErrorCode : int {
  usage = 101,                  ///< wrong command line or option value
  study_invalid = 102,          ///< study JSON has a wrong field or value
  cancelled = 103,              ///< the user or the caller cancelled the run
  file_unreadable = 201,        ///< file can't be opened or read
  file_syntax = 202,            ///< bytes are not of the format
  input_number = 203,           ///< number not finite, out of range or not a number
  format_unknown = 204,         ///< no reader recognises the file
  file_truncated = 205,         ///< file ends too early
  board_invalid = 301,          ///< board breaks an invariant (layer, net, span, thickness)
  outline_invalid = 302,        ///< board outline open, self-crossing or absent where it is needed
  stackup_invalid = 303,        ///< stackup can't be used (zero thickness, missing copper)
  name_unknown = 304,           ///< a net or layer named by the study is not on the board
  region_empty = 305,           ///< the region of interest holds nothing
  port_invalid = 306,           ///< a port of the study can't be placed on the board
  overlay_topology = 401,       ///< nets would open or short at every tolerance tried
  overlay_no_fixpoint = 402,    ///< noding did not settle
  planar_crossing_edges = 403,  ///< graph handed to the triangulation has crossing edges
  triangulation_limit = 404,    ///< vertex cap reached
  layering_invalid = 501,       ///< heights or sub-layers can't be chosen
  target_unreachable = 502,     ///< no mesh within the budget meets the goal of policy matched
  prism_limit = 601,            ///< forecast exceeds the user's budget
  write_failed = 701,           ///< file can't be written; nothing was left behind
  format_not_built = 702,       ///< the format needs a library this build lacks
  format_limit = 703,           ///< mesh too large or of a kind the format can't hold
  internal = 901,               ///< a bug in pcbmesh; please report
};

/// Exit code of the program for an error code: 2 usage, 3 input, 4 cannot mesh, 5 output, 70 bug.
[[nodiscard]] int exit_code(ErrorCode code) noexcept;

/// The one exception type. The message says what, where, what was expected and what to do.
class Error : public std::exception {
 public:
  Error(ErrorCode code, std::string text, Spot spot = {}, std::vector<std::int64_t> ids = {});

  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  [[nodiscard]] const Spot& spot() const noexcept { return spot_; }
  /// Ids of the offenders (features, vertices, cells), as the message explains them.
  [[nodiscard]] const std::vector<std::int64_t>& ids() const noexcept { return ids_; }
  /// Message without the place.
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  /// Place, then message, then "(error 301)".
  [[nodiscard]] const char* what() const noexcept override { return what_.c_str(); }

 private:
  ErrorCode code_;
  std::string text_;
  Spot spot_;
  std::vector<std::int64_t> ids_;
  std::string what_;
};

/// Throws Error internal (901). Used by PCBMESH_ASSERT.
[[noreturn]] void report_bug(const char* condition, const char* file, int line);

}  // namespace pcbmesh

/// O(1) check of our own logic; always on.
#define PCBMESH_ASSERT(condition)                                            \
  do {                                                                       \
    if (!(condition)) ::pcbmesh::report_bug(#condition, __FILE__, __LINE__); \
  } while (false)
