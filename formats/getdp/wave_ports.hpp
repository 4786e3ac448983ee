// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "formats/deck/field_problem.hpp"

/// Wave ports of TEM and quasi-TEM lines, from two static fields on the port's own faces, each 1 V on the signal conductor and
/// 0 V on every other. With its dielectrics the first, phi, is the mode's electric field -grad phi; without them the second,
/// phi_0, is its magnetic one, for dielectrics do not change inductance. Their capacitances C and C0 give the effective
/// permittivity C/C0 and the impedance 1/(c sqrt(C C0)): D. M. Pozar, Microwave Engineering, ch. 3.
/// A field's part in the mode is V = (E, grad phi_0)/(grad phi_0, grad phi_0), since modes are orthogonal by E of one and H of
/// the other. V is an unknown of its own; the port's tangential H is that of the mode alone, (2 V_in - V) grad phi_0, so waves
/// of other shape meet a magnetic wall. Profile and impedance are real and the same at all frequencies.
namespace pcbmesh::formats::getdp {

[[nodiscard]] bool is_wave(const deck::FieldPort& port);
/// Refuses wave ports whose wave is no TEM or quasi-TEM one; warns where further modes may travel.
/// @throws Error format_limit (703).
void require_tem_ports(const deck::FieldProblem& problem, Diagnostics& diagnostics);

/// Pieces of the deck, of all wave ports at once; empty without any. Ports are numbered from 1, as in the rest of the deck.
struct WavePorts {
  std::string groups;      ///< of a Group object
  std::string functions;   ///< of a Function object
  std::string statics;     ///< constraints, function spaces and formulations of the modes
  std::string quantities;  ///< of the formulation of the field
  std::string sources;     ///< its terms, both sides
  std::string systems;     ///< of the resolution
  std::string operations;  ///< of the resolution, before all results: sets $y_n, the mode's sqrt(C/C0), and $z_n, its impedance
  std::string observables;  ///< of the post-processing of the field: v_n, the wave's voltage
  std::string post;         ///< post-processings and post-operations of the modes
};
[[nodiscard]] WavePorts wave_ports(const deck::FieldProblem& problem);

}  // namespace pcbmesh::formats::getdp
