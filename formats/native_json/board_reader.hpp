// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/native_json/contour.hpp"
#include "formats/syntax/json_tree.hpp"
#include "pcbmesh/base/progress.hpp"
#include "pcbmesh/board/board.hpp"

namespace pcbmesh::formats::native_json {

/// JSON tree -> BoardParts. One pass over the fields; planes last, since vias and holes cut them.
class BoardReader {
 public:
  BoardReader(const syntax::JsonValue& root, const Progress& progress) : root_(root), progress_(progress) {}
  [[nodiscard]] board::BoardParts read();

 private:
  using JsonValue = syntax::JsonValue;

  /// What cuts planes of other nets: a drill with its pads.
  struct Piercing {
    std::string what;  ///< "the antipad of /vias/3"
    std::int64_t line = 0;
    geometry::Figure drill;
    std::int32_t first_copper = 0, last_copper = 0, net = board::no_net;
    std::map<std::int32_t, Nm> pads;  ///< diameter by copper layer
    std::optional<Nm> antipad;        ///< diameter
  };

  void read_head();
  void read_materials();
  void read_stackup();
  void read_nets();
  void read_outlines();
  void read_outline(const JsonValue& object);
  void read_track(const JsonValue& object);
  void read_polygon(const JsonValue& object);
  void read_pad(const JsonValue& object);
  void read_via(const JsonValue& object);
  void read_hole(const JsonValue& object);
  void read_plane(const JsonValue& object);
  void add_antipads(const JsonValue& plane, std::int32_t layer, std::int32_t net, Nm clearance, const geometry::Path& area,
                    std::vector<Hole>& holes) const;
  void read_via_pads(const JsonValue& pad, Piercing& piercing, geometry::Point at, std::int64_t line);

  /// Calls `read` for each element of a list field, if it is there.
  template <class Read>
  void each(std::string_view field, const Read& read) {
    const auto list = root_.find(field);
    if (!list) return;
    for (JsonValue entry : list->as_array()) {
      progress_.check();
      read(entry);
    }
  }

  [[nodiscard]] std::int32_t copper_layer(const JsonValue& name) const;
  [[nodiscard]] std::int32_t net_of(const JsonValue& object);
  [[nodiscard]] std::int32_t material_named(const JsonValue& name);
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> span_of(const JsonValue& object) const;
  [[nodiscard]] std::vector<Hole> holes_of(const JsonValue& object) const;

  JsonValue root_;
  const Progress& progress_;
  FileUnit unit_;
  board::BoardParts parts_;
  std::vector<std::string> copper_names_;
  std::map<std::string, std::int32_t, std::less<>> nets_;
  bool nets_are_listed_ = false;
  std::vector<Piercing> piercings_;
};

}  // namespace pcbmesh::formats::native_json
