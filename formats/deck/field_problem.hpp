// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcbmesh/formats/deck.hpp"

/// A field problem in words that no solver owns: what every deck is written from.
namespace pcbmesh::formats::deck {

inline constexpr double light_m_per_s = 299'792'458.0;
inline constexpr double eps0_f_per_m = 8.8541878128e-12;
inline constexpr double mu0_h_per_m = 1.25663706212e-6;
inline constexpr double free_space_ohm = 376.730313668;

/// One volume group.
struct Volume {
  std::int32_t id = 0;  ///< in the mesh file
  std::string name;
  std::int32_t net = -1;
  board::Material material;
  bool is_conductor = false;   ///< no field inside: skin depth is far below any mesh
  std::uint8_t stretched = 0;  ///< axes of a perfectly matched layer, as in mesh::VolumeTag
};

/// What lies behind a face group between two heights: mean over the area, conductors left out.
struct Medium {
  double z_low_m = 0, z_high_m = 0;
  board::Material material;
};

/// One face group, its condition resolved: never `none`.
struct Face {
  std::int32_t id = 0;  ///< in the mesh file
  std::string name;
  mesh::FaceTagKind kind = mesh::FaceTagKind::outer;
  mesh::BoundaryCondition condition = mesh::BoundaryCondition::pmc;
  bool is_inner = false;
  std::int32_t net = -1;
  double impedance_ohm = 0;     ///< condition impedance
  board::Material metal;        ///< condition conductor
  double thickness_m = 0;       ///< condition conductor on a sheet; 0 = thick
  std::int32_t port = -1;       ///< index into ports
  std::int32_t partner = -1;    ///< condition periodic: id of the opposite side
  std::vector<Medium> media{};  ///< condition absorbing, or a wave port: bottom to top
};

struct FieldPort {
  mesh::Port port;
  std::vector<std::int32_t> faces{};  ///< ids of its face groups
};

/// All copper of one net: solid volumes, skins of hollow copper, sheets.
struct Conductor {
  std::string name;
  std::vector<std::int32_t> volumes{}, faces{};  ///< ids
};

struct FieldProblem {
  DeckOptions options;
  std::vector<Volume> volumes;
  std::vector<Face> faces;
  std::vector<FieldPort> ports;  ///< those with faces in the mesh, in the mesh's order
  std::vector<Conductor> conductors;
  std::vector<std::int32_t> floating;  ///< ids of volumes of copper without a net
  std::optional<mesh::Shell> shell{};  ///< perfectly matched layers
  std::array<double, 2> period_m{};    ///< lengths of the domain along x and y

  [[nodiscard]] std::vector<std::int32_t> faces_with(mesh::BoundaryCondition condition) const;
  /// File name of the mesh without its ending.
  [[nodiscard]] std::string stem() const;
};

/// @param first_face_id  added to the mesh's face ids: 0, or the number of volume groups in one number space.
/// @throws Error study_invalid (102) when the problem is not well posed: all reasons at once.
[[nodiscard]] FieldProblem state(const mesh::PrismMesh& mesh, const DeckOptions& options, std::int32_t first_face_id,
                                 Diagnostics& diagnostics);

/// Refuses what a solver cannot do. @throws Error format_limit (703).
[[noreturn]] void refuse(std::string_view solver, std::string_view what, std::string_view nearest);

/// Text that is safe inside comments, quotes and printf formats of every deck: printable ASCII without " \ %.
[[nodiscard]] std::string plain(std::string_view text);

/// Text as one word of a shell.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace pcbmesh::formats::deck
