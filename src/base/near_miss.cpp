// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/base/near_miss.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pcbmesh {
namespace {

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
  return out;
}

/// Insertions, deletions, substitutions and swaps of neighbours (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::vector<std::string> near_misses(std::string_view name, std::span<const std::string> candidates, std::size_t most) {
  constexpr std::size_t longest_compared = 200;  // a hostile name must not cost a quadratic amount
  const std::string wanted = lower_case(name);
  const std::size_t limit = std::max<std::size_t>(1, std::min<std::size_t>(name.size() / 2, 3));
  std::vector<std::pair<std::size_t, std::string>> scored;
  for (const std::string& original : candidates) {
    const std::string candidate = lower_case(original);
    if (wanted.size() > longest_compared || candidate.size() > longest_compared) continue;
    std::size_t score = edit_distance(wanted, candidate);
    const bool contained = wanted.size() >= 3 && candidate.size() >= 3 &&
                           (candidate.find(wanted) != std::string::npos || wanted.find(candidate) != std::string::npos);
    if (contained) score = std::min(score, limit);
    if (score <= limit) scored.emplace_back(score, original);
  }
  std::sort(scored.begin(), scored.end());
  std::vector<std::string> out;
  for (auto& [score, candidate] : scored)
    if (out.size() < most) out.push_back(std::move(candidate));
  return out;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> candidates) {
  std::string out;
  for (const std::string& candidate : near_misses(name, candidates))
    out += fmt::format("{}'{}'", out.empty() ? "; did you mean " : " or ", candidate);
  return out.empty() ? out : out + "?";
}

}  // namespace pcbmesh
