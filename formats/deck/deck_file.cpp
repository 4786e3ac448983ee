// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/deck/deck_file.hpp"

#include <fmt/format.h>

#include "formats/sink/file_sink.hpp"

namespace pcbmesh::formats::deck {

void put_file(const std::filesystem::path& file, std::string_view text, Deck& deck) {
  FileSink sink(file);
  sink.put(text);
  sink.commit();
  deck.files.push_back(file);
}

void put_run_script(const std::filesystem::path& file, std::string_view what, std::string_view body, Deck& deck) {
  put_file(file, fmt::format("#!/bin/sh\n# {}\nset -eu\ncd \"$(dirname \"$0\")\"\n{}", what, body), deck);
  deck.command = {"sh", file.string()};
}

}  // namespace pcbmesh::formats::deck
