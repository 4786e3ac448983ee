// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "formats/kicad/board_reader.hpp"
#include "pcbmesh/base/error.hpp"

/// Small boards written as text.
namespace pcbmesh::tests {

using formats::ReadBoardResult;

inline const std::string four_layers =
    "(layers (0 \"F.Cu\" signal) (4 \"In1.Cu\" power \"ground\") (6 \"In2.Cu\" signal) (2 \"B.Cu\" signal) (25 \"Edge.Cuts\" "
    "user))";
inline const std::string four_old_layers =
    "(layers (0 F.Cu signal) (1 In1.Cu power) (2 In2.Cu signal) (31 B.Cu signal) (44 Edge.Cuts user))";
inline const std::string nets = "(net 0 \"\") (net 1 \"GND\") (net 2 \"/a b\")";
inline const std::string edge =
    "(gr_rect (start 0 0) (end 20 10) (stroke (width 0.1) (type default)) (fill no) (layer \"Edge.Cuts\"))";

inline ReadBoardResult read_text(const std::string& text) {
  return formats::kicad::read_board_text(text, "test.kicad_pcb", "test");
}
inline std::string text_of(const std::string& items, const std::string& version = "20241229", const std::string& setup = "") {
  return "(kicad_pcb (version " + version + ") (generator \"test\")\n(general (thickness 1.6))\n" +
         (std::stoll(version) < 20240101 ? four_old_layers : four_layers) + "\n(setup " + setup + ")\n" + nets + "\n" + items +
         ")\n";
}
inline ReadBoardResult read(const std::string& items, const std::string& version = "20241229", const std::string& setup = "") {
  return read_text(text_of(items, version, setup));
}
inline Error error_of(const std::string& text) {
  try {
    (void)read_text(text);
  } catch (const Error& error) {
    return error;
  }
  return Error(ErrorCode::internal, "no error");
}

}  // namespace pcbmesh::tests
