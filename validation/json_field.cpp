// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/json_field.hpp"

#include <fstream>
#include <sstream>

namespace pcbmesh::validation {

nlohmann::json parse_json(const JsonSource& source) {
  std::ifstream in(source.file, std::ios::binary);
  std::ostringstream bytes;
  if (in) bytes << in.rdbuf();
  if (!in || in.bad()) {
    throw Error(ErrorCode::file_unreadable, fmt::format("the file can't be read; {}", source.advice),
                Spot{.file = source.file});
  }
  const std::string text = std::move(bytes).str();
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const auto byte = static_cast<std::int64_t>(error.byte);
    const auto end = text.begin() + std::min<std::int64_t>(byte, static_cast<std::int64_t>(text.size()));
    throw Error(ErrorCode::file_syntax,
                fmt::format("the file is no JSON from byte {} of {} on; {}", byte, text.size(), source.advice),
                Spot{.file = source.file, .line = 1 + std::count(text.begin(), end, '\n')});
  }
}

}  // namespace pcbmesh::validation
