// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/extrude/tag_names.hpp"

#include <fmt/format.h>

#include <set>

#include "pcbmesh/extrude/extrude.hpp"

namespace pcbmesh::extrude {
namespace {

/// Value of a hexadecimal digit, or -1. Not isxdigit: that asks the locale.
int digit_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return -1;
}

}  // namespace

std::string escape_tag_part(std::string_view name) {
  std::string part;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    const bool is_reserved_word = i == 0 && name == no_net_word;
    if (byte < 0x20 || byte == 0x7f || byte == '|' || byte == '%' || byte == '"' || is_reserved_word) {
      part += fmt::format("%{:02X}", byte);
    } else {
      part += name[i];
    }
  }
  return part;
}

std::string unescape_tag_part(std::string_view part) {
  std::string name;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const bool has_digits =
        part[i] == '%' && i + 2 < part.size() && digit_value(part[i + 1]) >= 0 && digit_value(part[i + 2]) >= 0;
    if (has_digits) {
      name += static_cast<char>(digit_value(part[i + 1]) * 16 + digit_value(part[i + 2]));
      i += 2;
    } else {
      name += part[i];
    }
  }
  return name;
}

std::string net_part(std::span<const std::string> nets, std::int32_t net) {
  return net < 0 ? std::string(no_net_word) : escape_tag_part(nets[static_cast<std::size_t>(net)]);
}

std::vector<std::string> make_unique(std::vector<std::string> names) {
  // Names as given come first, so that "core #2" of the board keeps its name beside a second "core".
  std::set<std::string> taken(names.begin(), names.end());
  std::set<std::string> met;
  for (std::string& name : names) {
    if (met.insert(name).second) continue;
    std::string other;
    for (int number = 2; other.empty() || taken.contains(other); ++number) other = fmt::format("{} #{}", name, number);
    taken.insert(other);
    name = std::move(other);
  }
  return names;
}

}  // namespace pcbmesh::extrude
