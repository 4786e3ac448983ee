// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/error.hpp"

#include <fmt/format.h>

#include <utility>

namespace pcbmesh {

std::string Spot::text() const {
  std::string out = file;
  if (line > 0) out += fmt::format(":{}", line);
  if (byte >= 0) out += fmt::format("{}byte {}", out.empty() ? "" : ", ", byte);
  if (!layer.empty()) out += fmt::format("{}layer {}", out.empty() ? "" : ", ", layer);
  if (!net.empty()) out += fmt::format("{}net {}", out.empty() ? "" : ", ", net);
  if (at_mm) out += fmt::format("{}at ({:.6g}, {:.6g}) mm", out.empty() ? "" : ", ", (*at_mm)[0], (*at_mm)[1]);
  return out;
}

int exit_code(ErrorCode code) noexcept {
  const int number = static_cast<int>(code);
  if (code == ErrorCode::cancelled) return 130;
  if (code == ErrorCode::prism_limit) return 4;
  switch (number / 100) {
    case 1:
      return 2;
    case 2:
      return 3;
    case 3:
      return 3;
    case 4:
      return 4;
    case 5:
      return 4;
    case 6:
      return 4;
    case 7:
      return 5;
    default:
      return 70;
  }
}

Error::Error(ErrorCode code, std::string text, Spot spot, std::vector<std::int64_t> ids)
    : code_(code), text_(std::move(text)), spot_(std::move(spot)), ids_(std::move(ids)) {
  const std::string place = spot_.text();
  what_ = fmt::format("{}{}{} (error {})", place, place.empty() ? "" : ": ", text_, static_cast<int>(code_));
}

void report_bug(const char* condition, const char* file, int line) {
  throw Error(ErrorCode::internal,
              fmt::format("pcbmesh broke its own rule '{}' at {}:{}; this is a bug, please report it with the input", condition,
                          file, line));
}

}  // namespace pcbmesh
