// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/mesh/group_names.hpp"

#include <functional>
#include <set>
#include <string_view>

namespace pcbmesh::mesh {
namespace {

std::string_view cut(std::string_view name, std::size_t most) {
  if (name.size() <= most) return name;
  // Never inside a UTF-8 sequence: back to a byte that starts a character.
  while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xC0U) == 0x80U) --most;
  return name.substr(0, most);
}

/// Bytes of the UTF-8 character at the front, 0 if it is none.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t size = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < size) return 0;
  unsigned code = lead & (0xFFU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
    code = code << 6 | (byte(i) & 0x3FU);
  }
  constexpr unsigned least[] = {0, 0, 0x80, 0x800, 0x10000};
  return code < least[size] || code > 0x10FFFF || (code >= 0xD800 && code < 0xE000) ? 0 : size;
}

std::string cleaned(std::string_view name) {
  std::string out;
  while (!name.empty()) {
    const std::size_t size = character_bytes(name);
    const char c = name.front();
    if (size > 1)
      out += name.substr(0, size);
    else if (size == 0)
      out += '?';
    else
      out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? ' ' : c == '"' ? '\'' : c;
    name.remove_prefix(size > 1 ? size : 1);
  }
  return out.empty() ? "unnamed" : out;
}

}  // namespace

std::vector<std::string> group_names(std::span<const std::string> names) {
  std::vector<std::string> out(names.size());
  std::set<std::string, std::less<>> taken;
  std::vector<bool> is_kept(names.size());
  // Names that need no change first: none of them is renamed for another's sake.
  for (std::size_t i = 0; i < names.size(); ++i) {
    out[i] = cleaned(names[i]);
    is_kept[i] = out[i] == names[i] && out[i].size() <= max_name_bytes && taken.insert(out[i]).second;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (is_kept[i] || (out[i].size() <= max_name_bytes && taken.insert(out[i]).second)) continue;
    const std::string full = out[i];
    for (std::size_t number = i + 1;; number += names.size()) {
      const std::string digits = std::to_string(number);
      out[i] = cut(full, max_name_bytes - digits.size() - 1);
      out[i].append(1, '~').append(digits);
      if (taken.insert(out[i]).second) break;
    }
  }
  return out;
}

}  // namespace pcbmesh::mesh
