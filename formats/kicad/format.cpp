// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/format.hpp"

#include <array>

#include "formats/kicad/board_reader.hpp"
#include "formats/syntax/input_file.hpp"

namespace pcbmesh::formats::kicad {
namespace {

constexpr std::array<std::string_view, 1> extensions{".kicad_pcb"};

Match sniff(std::string_view head, std::string_view file_name) {
  const std::size_t start = head.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start != std::string_view::npos && head.substr(start, 10) == "(kicad_pcb") return Match::yes;
  return file_name.ends_with(".kicad_pcb") ? Match::maybe : Match::no;
}

ReadBoardResult read(const std::filesystem::path& file, const Progress& progress) {
  progress.at("read file", 0);
  std::string name = syntax::unpacked_name(file);
  if (name.ends_with(extensions[0])) name.resize(name.size() - extensions[0].size());
  return read_board_text(syntax::read_whole_file(file), file.string(), std::move(name), progress);
}

}  // namespace

const BoardFormat board_format{"kicad", "KiCad board (.kicad_pcb), file formats v4 to v10", extensions, sniff, read};

}  // namespace pcbmesh::formats::kicad
