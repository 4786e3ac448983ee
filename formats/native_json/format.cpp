// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/native_json/format.hpp"

#include <array>
#include <utility>

#include "formats/native_json/board_reader.hpp"
#include "formats/syntax/input_file.hpp"
#include "formats/syntax/json_tree.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::native_json {
namespace {

constexpr std::array<std::string_view, 1> extensions{".json"};

Match sniff(std::string_view head, std::string_view /*file_name*/) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || head[first] != '{') return Match::no;
  return head.find("\"pcbmesh_board\"") == std::string_view::npos ? Match::no : Match::yes;
}

ReadBoardResult read(const std::filesystem::path& file, const Progress& progress) {
  progress.at("read", 0);
  return parse_board(syntax::read_whole_file(file), file.string(), progress);
}

}  // namespace

ReadBoardResult parse_board(std::string_view text, std::string_view file_name, const Progress& progress) {
  const syntax::JsonDocument document = syntax::JsonDocument::parse(text, file_name, ErrorCode::file_syntax);
  board::BoardParts parts = BoardReader(document.root(), progress).read();
  parts.source = file_name;
  return {board::Board::from_parts(std::move(parts)), {}};
}

const BoardFormat board_format{"native_json", "pcbmesh board (JSON, written by hand)", extensions, sniff, read};

}  // namespace pcbmesh::formats::native_json
