// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/syntax/sexpr.hpp"

namespace pcbmesh::formats::kicad {

/// Set of copper layers, bit i = copper layer i.
using LayerMask = std::uint64_t;

/// The board's layer table: which names are copper, in order from the top.
class LayerTable {
 public:
  struct Copper {
    std::string name;       ///< canonical: F.Cu, In1.Cu .., B.Cu
    std::string user_name;  ///< the designer's, may be empty
  };

  /// Up to v5 and 5.99 a renamed copper layer stands under its user name alone and copper is ranked by ordinal
  /// (0 top .. 31 bottom); later files use canonical names and ordinals that mean nothing.
  /// @throws Error board_invalid (301) if there is no copper layer or a name stands twice.
  LayerTable(syntax::Sexpr layers, std::int64_t version, const std::string& file);

  [[nodiscard]] int num_copper() const noexcept { return static_cast<int>(copper_.size()); }
  [[nodiscard]] const Copper& copper(int i) const { return copper_[static_cast<std::size_t>(i)]; }
  /// Index of a copper layer by any of its names; not_copper for another known layer; unknown.
  static constexpr int not_copper = -1, unknown = -2;
  [[nodiscard]] int find(std::string_view name) const;
  [[nodiscard]] LayerMask all_copper() const noexcept { return (LayerMask{1} << copper_.size()) - 1; }
  /// Copper meant by one entry of a layer set: a name, "*.Cu", "F&B.Cu"; 0 for anything else.
  /// @param[out] known  false if the entry is a name this board does not have
  [[nodiscard]] LayerMask mask(std::string_view entry, bool& known) const;

 private:
  std::vector<Copper> copper_;
  std::map<std::string, int, std::less<>> by_name_;
};

}  // namespace pcbmesh::formats::kicad
