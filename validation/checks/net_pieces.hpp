// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "validation/checks/context.hpp"
#include "validation/checks/net_contacts.hpp"

namespace pcbmesh::validation::checks {

/// Connected copper of a mesh: cells through shared faces; skins of hollow conductors and sheets through shared edges, through
/// the copper cells they lie on, and across the hollow between a face and the next one above it.
class NetPieces {
 public:
  NetPieces(const Context& context, NetContacts& cells);

  struct Contact {
    std::int64_t count = 0;
    Finding::Place place{};
  };
  struct Piece {
    std::int32_t net = -1;
    std::int64_t num_elements = 0;  ///< cells and faces
    Finding::Place place{};         ///< of its first element
  };

  /// Nets with copper cells, skins or sheets, sorted by name.
  [[nodiscard]] const std::vector<std::string>& nets() const { return nets_; }
  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  /// Contacts of different nets, smaller index first.
  [[nodiscard]] const std::map<std::pair<std::int32_t, std::int32_t>, Contact>& contacts() const { return contacts_; }
  /// Calls visit(piece, node) for every node of every piece of the net; nodes may come again.
  template <class Visit>
  void visit_nodes(std::int32_t net, Visit&& visit) const;
  /// Copper cell of the net at the node whose centre is nearest to the place; -1 if none is there.
  [[nodiscard]] std::int64_t cell_at(std::int32_t net, std::int64_t node, const Vector3& towards) const;
  /// Net of a node that lies on copper; -1 = none. Where nets meet, one of them.
  [[nodiscard]] const std::vector<std::int32_t>& net_of_node() const { return net_of_node_; }

 private:
  struct Skin {
    std::int64_t face = 0;
    std::int32_t net = -1;
    bool is_sheet = false;
  };
  void gather_nets(const NetContacts& cells);
  void gather_skins();
  void join_cells_to_skins(NetContacts& cells);
  void join_cells_to_sheets(NetContacts& cells);
  void join_by_edges();
  void join_across_hollows();
  void take_cell_contacts(const NetContacts& cells);
  void number_pieces(NetContacts& cells);
  void meet(std::int32_t a, std::int32_t b, std::int64_t face);
  std::int32_t root(std::int32_t element);
  void unite(std::int32_t a, std::int32_t b);

  const Context& context_;
  std::vector<std::string> nets_;
  std::vector<std::int32_t> net_of_cell_net_;  ///< NetContacts' index -> ours
  std::vector<std::int32_t> net_of_face_slot_;
  std::vector<char> is_sheet_slot_;
  std::vector<std::int64_t> cell_pieces_;  ///< first cell of each piece of cells, ascending
  std::vector<std::int32_t> cell_piece_net_;
  std::vector<Skin> skins_;
  std::vector<std::int32_t> parent_;         ///< pieces of cells, then skins
  std::vector<std::int32_t> piece_;          ///< per element: index into pieces_
  std::vector<std::int32_t> piece_of_cell_;  ///< per cell, -1 = no copper of a net
  std::vector<Piece> pieces_;
  std::vector<std::int32_t> net_of_node_;
  std::map<std::pair<std::int32_t, std::int32_t>, Contact> contacts_;
};

template <class Visit>
void NetPieces::visit_nodes(std::int32_t net, Visit&& visit) const {
  for (std::int64_t cell = 0; cell < context_.num_cells(); ++cell) {
    const std::int32_t piece = piece_of_cell_[static_cast<std::size_t>(cell)];
    if (piece < 0 || pieces_[static_cast<std::size_t>(piece)].net != net) continue;
    for (const std::int64_t node : context_.corners_of_cell(cell)) visit(piece, node);
  }
  for (std::size_t i = 0; i < skins_.size(); ++i) {
    if (skins_[i].net != net) continue;
    for (const std::int64_t node : context_.corners_of_face(skins_[i].face)) visit(piece_[cell_pieces_.size() + i], node);
  }
}

}  // namespace pcbmesh::validation::checks
