// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/msh/group_names.hpp"

#include <functional>
#include <set>
#include <string_view>

namespace pcbmesh::formats::msh {
namespace {

std::string_view cut(std::string_view name, std::size_t most) {
  if (name.size() <= most) return name;
  // Never inside a UTF-8 sequence: back to a byte that starts a character.
  while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xC0U) == 0x80U) --most;
  return name.substr(0, most);
}

std::string cleaned(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
    if (c == '"') c = '\'';
  }
  return name.empty() ? "unnamed" : name;
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
      const std::string ending = "~" + std::to_string(number);
      out[i] = std::string(cut(full, max_name_bytes - ending.size())) + ending;
      if (taken.insert(out[i]).second) break;
    }
  }
  return out;
}

}  // namespace pcbmesh::formats::msh
