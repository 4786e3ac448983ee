// SPDX-License-Identifier: GPL-3.0-or-later
#include "validation/checks/net_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>

namespace pcbmesh::validation::checks {
namespace {

std::size_t ix(std::int64_t i) {
  return static_cast<std::size_t>(i);
}

/// Net in the name of a skin or sheet group, "surface|NET..." or "sheet|NET..."; empty for others and for copper without net.
std::string net_in_name(std::string_view name) {
  for (const std::string_view kind : {std::string_view("surface|"), std::string_view("sheet|")}) {
    if (!name.starts_with(kind)) continue;
    const std::string_view rest = name.substr(kind.size());
    const std::string_view net = rest.substr(0, rest.find('|'));
    if (net == "none") return {};
    std::string plain;  // as in volume names: '|', '%', '"' and control characters stand as %XX
    for (std::size_t i = 0; i < net.size(); ++i) {
      const auto digit = [&](std::size_t k) {
        const char c = net[k];
        return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
      };
      if (net[i] == '%' && i + 2 < net.size() && digit(i + 1) >= 0 && digit(i + 2) >= 0) {
        plain += static_cast<char>(digit(i + 1) * 16 + digit(i + 2));
        i += 2;
      } else {
        plain += net[i];
      }
    }
    return plain;
  }
  return {};
}

}  // namespace

NetPieces::NetPieces(const Context& context, NetContacts& cells) : context_(context) {
  gather_nets(cells);
  if (nets_.empty()) return;
  gather_skins();
  for (std::int64_t cell = 0; cells.is_needed() && cell < context.num_cells(); ++cell)
    if (cells.net_of(cell) >= 0 && cells.piece_of(cell) == cell) {
      cell_pieces_.push_back(cell);
      cell_piece_net_.push_back(net_of_cell_net_[ix(cells.net_of(cell))]);
    }
  parent_.resize(cell_pieces_.size() + skins_.size());
  for (std::size_t i = 0; i < parent_.size(); ++i) parent_[i] = static_cast<std::int32_t>(i);
  take_cell_contacts(cells);
  if (!skins_.empty()) {
    join_cells_to_skins(cells);
    join_cells_to_sheets(cells);
    join_by_edges();
    join_across_hollows();
  }
  number_pieces(cells);
}

void NetPieces::gather_nets(const NetContacts& cells) {
  nets_ = cells.nets();
  net_of_face_slot_.assign(ix(context_.face_tags.size()), -1);
  is_sheet_slot_.assign(net_of_face_slot_.size(), 0);
  std::vector<std::string> names(net_of_face_slot_.size());
  for (int slot = 0; slot < context_.face_tags.size(); ++slot) {
    const std::string name = context_.name_of(2, context_.face_tags.tag(slot));
    names[ix(slot)] = net_in_name(name);
    is_sheet_slot_[ix(slot)] = name.starts_with("sheet|") ? 1 : 0;
    if (!names[ix(slot)].empty()) nets_.push_back(names[ix(slot)]);
  }
  std::sort(nets_.begin(), nets_.end());
  nets_.erase(std::unique(nets_.begin(), nets_.end()), nets_.end());
  const auto index_of = [&](const std::string& name) {
    return static_cast<std::int32_t>(std::lower_bound(nets_.begin(), nets_.end(), name) - nets_.begin());
  };
  for (std::size_t slot = 0; slot < names.size(); ++slot)
    if (!names[slot].empty()) net_of_face_slot_[slot] = index_of(names[slot]);
  for (const std::string& name : cells.nets()) net_of_cell_net_.push_back(index_of(name));
}

void NetPieces::gather_skins() {
  for (std::int64_t face = 0; face < context_.num_faces(); ++face) {
    const auto slot = ix(context_.face_tags.slot(context_.tag_of_face(face)));
    if (net_of_face_slot_[slot] >= 0) skins_.push_back({face, net_of_face_slot_[slot], is_sheet_slot_[slot] != 0});
  }
}

std::int32_t NetPieces::root(std::int32_t element) {
  while (parent_[ix(element)] != element) {
    parent_[ix(element)] = parent_[ix(parent_[ix(element)])];
    element = parent_[ix(element)];
  }
  return element;
}

void NetPieces::unite(std::int32_t a, std::int32_t b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  parent_[ix(std::max(a, b))] = std::min(a, b);
}

void NetPieces::meet(std::int32_t a, std::int32_t b, std::int64_t face) {
  Contact& contact = contacts_[{std::min(a, b), std::max(a, b)}];
  if (contact.count++ == 0) contact.place = context_.place_of_face(face);
}

void NetPieces::take_cell_contacts(const NetContacts& cells) {
  for (const auto& [pair, tally] : cells.touches()) {
    const std::int32_t a = net_of_cell_net_[ix(pair.first)], b = net_of_cell_net_[ix(pair.second)];
    contacts_[{std::min(a, b), std::max(a, b)}] = {tally.count(), context_.place_of_half_face(tally.kept().front())};
  }
}

void NetPieces::join_cells_to_skins(NetContacts& cells) {
  if (!cells.is_needed()) return;
  using Key = std::array<std::int64_t, 4>;
  const auto key_of = [](std::span<const std::int64_t> corners) {
    Key key{-1, -1, -1, -1};
    std::copy(corners.begin(), corners.end(), key.begin());
    std::sort(key.begin(), key.end());
    return key;
  };
  std::vector<std::pair<Key, std::int32_t>> faces;
  std::vector<char> on_skin(ix(context_.num_nodes()), 0);
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    const auto corners = context_.corners_of_face(skins_[i].face);
    faces.emplace_back(key_of(corners), static_cast<std::int32_t>(i));
    for (const std::int64_t node : corners) on_skin[ix(node)] = 1;
  }
  std::sort(faces.begin(), faces.end());
  for (std::int64_t cell = 0; cell < context_.num_cells(); ++cell) {
    const std::int32_t cell_net = cells.net_of(cell);
    if (cell_net < 0) continue;
    const auto own = context_.corners_of_cell(cell);
    if (std::ranges::count_if(own, [&](std::int64_t node) { return on_skin[ix(node)] != 0; }) < 3) continue;
    const std::int64_t first = cells.piece_of(cell);
    const auto piece =
        static_cast<std::int32_t>(std::lower_bound(cell_pieces_.begin(), cell_pieces_.end(), first) - cell_pieces_.begin());
    const std::size_t block = context_.locate_cell(cell).first;
    const int num_faces = context_.mesh.cells[block].kind == mesh::CellKind::tetrahedron  ? 4
                          : context_.mesh.cells[block].kind == mesh::CellKind::hexahedron ? 6
                                                                                          : 5;
    for (int local = 0; local < num_faces; ++local) {
      std::array<std::int64_t, 4> corners{};
      const int count = context_.corners_of_half_face((cell << 3) | local, corners);
      const Key key = key_of(std::span(corners).first(ix(count)));
      for (auto at = std::lower_bound(faces.begin(), faces.end(), std::pair(key, -1)); at != faces.end() && at->first == key;
           ++at) {
        const Skin& skin = skins_[ix(at->second)];
        const std::int32_t net = net_of_cell_net_[ix(cell_net)];
        if (skin.net == net)
          unite(piece, static_cast<std::int32_t>(cell_pieces_.size()) + at->second);
        else
          meet(skin.net, net, skin.face);
      }
    }
  }
}

/// Sheets have no faces of cells beside them: a copper cell touches a sheet along an edge.
void NetPieces::join_cells_to_sheets(NetContacts& cells) {
  struct Side {
    std::int64_t a, b;
    std::int32_t skin;
    bool operator<(const Side& other) const { return std::tie(a, b, skin) < std::tie(other.a, other.b, other.skin); }
  };
  std::vector<Side> sides;
  std::vector<char> on_sheet(ix(context_.num_nodes()), 0);
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    if (!skins_[i].is_sheet) continue;
    const auto corners = context_.corners_of_face(skins_[i].face);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::int64_t a = corners[k], b = corners[k + 1 == corners.size() ? 0 : k + 1];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(i)});
      on_sheet[ix(a)] = 1;
    }
  }
  if (sides.empty() || !cells.is_needed()) return;
  std::sort(sides.begin(), sides.end());
  for (std::int64_t cell = 0; cell < context_.num_cells(); ++cell) {
    const std::int32_t cell_net = cells.net_of(cell);
    if (cell_net < 0) continue;
    const auto own = context_.corners_of_cell(cell);
    if (std::ranges::count_if(own, [&](std::int64_t node) { return on_sheet[ix(node)] != 0; }) < 2) continue;
    const auto piece = static_cast<std::int32_t>(
        std::lower_bound(cell_pieces_.begin(), cell_pieces_.end(), cells.piece_of(cell)) - cell_pieces_.begin());
    for (const std::int64_t a : own)
      for (const std::int64_t b : own) {
        if (a >= b) continue;
        for (auto at = std::lower_bound(sides.begin(), sides.end(), Side{a, b, -1});
             at != sides.end() && at->a == a && at->b == b; ++at) {
          const Skin& sheet = skins_[ix(at->skin)];
          const std::int32_t net = net_of_cell_net_[ix(cell_net)];
          if (sheet.net == net)
            unite(piece, static_cast<std::int32_t>(cell_pieces_.size()) + at->skin);
          else
            meet(sheet.net, net, sheet.face);
        }
      }
  }
}

void NetPieces::join_by_edges() {
  struct Side {
    std::int64_t a, b;
    std::int32_t skin;
  };
  std::vector<Side> sides;
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    const auto corners = context_.corners_of_face(skins_[i].face);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const std::int64_t a = corners[k], b = corners[k + 1 == corners.size() ? 0 : k + 1];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(i)});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& p, const Side& q) { return std::tie(p.a, p.b, p.skin) < std::tie(q.a, q.b, q.skin); });
  const auto first_skin = static_cast<std::int32_t>(cell_pieces_.size());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i;
    for (; j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b; ++j) {
      for (std::size_t k = i; k < j; ++k) {
        const Skin &p = skins_[ix(sides[k].skin)], &q = skins_[ix(sides[j].skin)];
        if (p.net == q.net) {
          unite(first_skin + sides[k].skin, first_skin + sides[j].skin);
          continue;
        }
        // Conductors that touch meet along outlines of their upper and lower faces; corners that meet share an upright only.
        const Vector3 &a = context_.mesh.nodes[ix(sides[i].a)], &b = context_.mesh.nodes[ix(sides[i].b)];
        if (std::abs(b[2] - a[2]) < std::hypot(b[0] - a[0], b[1] - a[1])) meet(p.net, q.net, p.face);
      }
    }
    i = j;
  }
}

/// The hull of a hollow plate that the domain's edge cuts falls into an upper and a lower skin; what lies between is one
/// conductor all the same. Faces of one column have the same corners seen from above.
void NetPieces::join_across_hollows() {
  using Place = std::array<double, 2>;
  struct Level {
    std::array<Place, 3> corners;
    double z;
    bool is_floor;  ///< the hollow lies above it
    std::int32_t skin;
  };
  std::vector<Level> levels;
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    const auto corners = context_.corners_of_face(skins_[i].face);
    if (corners.size() != 3 || skins_[i].is_sheet) continue;
    const Vector3 &a = context_.mesh.nodes[ix(corners[0])], &b = context_.mesh.nodes[ix(corners[1])],
                  &c = context_.mesh.nodes[ix(corners[2])];
    const double turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (turn == 0) continue;
    Level level{{{{a[0], a[1]}, {b[0], b[1]}, {c[0], c[1]}}}, a[2], turn > 0, static_cast<std::int32_t>(i)};
    std::sort(level.corners.begin(), level.corners.end());
    levels.push_back(level);
  }
  std::sort(levels.begin(), levels.end(),
            [](const Level& p, const Level& q) { return std::tie(p.corners, p.z, p.skin) < std::tie(q.corners, q.z, q.skin); });
  const auto first_skin = static_cast<std::int32_t>(cell_pieces_.size());
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    const Level &low = levels[i], &high = levels[i + 1];
    if (low.corners != high.corners || !low.is_floor || high.is_floor) continue;
    const Skin &p = skins_[ix(low.skin)], &q = skins_[ix(high.skin)];
    if (p.net == q.net)
      unite(first_skin + low.skin, first_skin + high.skin);
    else
      meet(p.net, q.net, p.face);
  }
}

std::int64_t NetPieces::cell_at(std::int32_t net, std::int64_t node, const Vector3& towards) const {
  std::int64_t best = -1;
  double least = 0;
  for (std::int64_t cell = 0; cell < context_.num_cells(); ++cell) {
    const std::int32_t piece = piece_of_cell_[ix(cell)];
    if (piece < 0 || pieces_[ix(piece)].net != net) continue;
    if (std::ranges::find(context_.corners_of_cell(cell), node) == context_.corners_of_cell(cell).end()) continue;
    const Vector3 at = context_.place_of_cell(cell).at;
    const double distance = std::hypot(at[0] - towards[0], at[1] - towards[1], at[2] - towards[2]);
    if (best < 0 || distance < least) best = cell, least = distance;
  }
  return best;
}

void NetPieces::number_pieces(NetContacts& cells) {
  piece_.assign(parent_.size(), -1);
  for (std::size_t i = 0; i < parent_.size(); ++i) {
    const std::int32_t top = root(static_cast<std::int32_t>(i));
    if (piece_[ix(top)] < 0) {
      piece_[ix(top)] = static_cast<std::int32_t>(pieces_.size());
      const bool is_cell = i < cell_pieces_.size();
      pieces_.push_back(
          {is_cell ? cell_piece_net_[i] : skins_[i - cell_pieces_.size()].net, 0,
           is_cell ? context_.place_of_cell(cell_pieces_[i]) : context_.place_of_face(skins_[i - cell_pieces_.size()].face)});
    }
    piece_[i] = piece_[ix(top)];
  }
  net_of_node_.assign(ix(context_.num_nodes()), -1);
  piece_of_cell_.assign(ix(context_.num_cells()), -1);
  for (std::int64_t cell = 0; cells.is_needed() && cell < context_.num_cells(); ++cell) {
    if (cells.net_of(cell) < 0) continue;
    const auto at = std::lower_bound(cell_pieces_.begin(), cell_pieces_.end(), cells.piece_of(cell)) - cell_pieces_.begin();
    const std::int32_t piece = piece_[ix(at)];
    piece_of_cell_[ix(cell)] = piece;
    ++pieces_[ix(piece)].num_elements;
    for (const std::int64_t node : context_.corners_of_cell(cell)) net_of_node_[ix(node)] = pieces_[ix(piece)].net;
  }
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    ++pieces_[ix(piece_[cell_pieces_.size() + i])].num_elements;
    for (const std::int64_t node : context_.corners_of_face(skins_[i].face)) net_of_node_[ix(node)] = skins_[i].net;
  }
}

}  // namespace pcbmesh::validation::checks
