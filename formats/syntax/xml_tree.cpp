// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/syntax/xml_tree.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::syntax {
namespace {

constexpr std::size_t deepest = 100;
constexpr std::size_t bytes_at_once = std::size_t{1} << 24;

/// State while the parser calls back. Exceptions wait until it has returned: it is C.
struct Building {
  XML_Parser parser = nullptr;
  std::string_view stop_at;
  XmlTree tree;
  std::vector<XmlElement> open;
  bool has_root = false;
  std::string fault;

  void stop(std::string why) {
    fault = std::move(why);
    XML_StopParser(parser, XML_FALSE);
  }
};

void close_element(Building& building) {
  XmlElement done = std::move(building.open.back());
  building.open.pop_back();
  if (building.open.empty()) {
    building.tree.root = std::move(done);
    building.has_root = true;
  } else {
    building.open.back().children.push_back(std::move(done));
  }
}

void XMLCALL on_start(void* user, const XML_Char* name, const XML_Char** attributes) {
  Building& building = *static_cast<Building*>(user);
  if (!building.fault.empty() || building.tree.stopped_at >= 0) return;
  if (building.open.size() >= deepest) return building.stop("elements are nested too deeply");
  XmlElement element;
  element.name = name;
  element.byte = static_cast<std::int64_t>(XML_GetCurrentByteIndex(building.parser));
  for (; *attributes != nullptr; attributes += 2) element.attributes.emplace_back(attributes[0], attributes[1]);
  const bool ends_here = !building.stop_at.empty() && element.name == building.stop_at;
  building.open.push_back(std::move(element));
  if (!ends_here) return;
  building.tree.stopped_at = building.open.back().byte + XML_GetCurrentByteCount(building.parser);
  XML_StopParser(building.parser, XML_FALSE);
}

void XMLCALL on_end(void* user, const XML_Char*) {
  Building& building = *static_cast<Building*>(user);
  if (building.fault.empty() && building.tree.stopped_at < 0) close_element(building);
}

void XMLCALL on_text(void* user, const XML_Char* text, int size) {
  Building& building = *static_cast<Building*>(user);
  if (!building.open.empty() && building.tree.stopped_at < 0)
    building.open.back().text.append(text, static_cast<std::size_t>(size));
}

void XMLCALL on_entity(void* user, const XML_Char*, int, const XML_Char*, int, const XML_Char*, const XML_Char*,
                       const XML_Char*, const XML_Char*) {
  static_cast<Building*>(user)->stop("the document type of the file declares entities, which mesh files do not need");
}

}  // namespace

const XmlElement* XmlElement::child(std::string_view wanted) const {
  const auto found = std::ranges::find(children, wanted, &XmlElement::name);
  return found == children.end() ? nullptr : &*found;
}

std::string_view XmlElement::attribute(std::string_view wanted) const {
  for (const auto& [key, value] : attributes)
    if (key == wanted) return value;
  return {};
}

XmlTree parse_xml(std::string_view bytes, const std::filesystem::path& file, std::string_view stop_at) {
  if (bytes.empty()) throw Error(ErrorCode::file_truncated, "the file is empty", {.file = file.string()});
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate("UTF-8"), XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  Building building;
  building.parser = parser.get();
  building.stop_at = stop_at;
  XML_SetUserData(parser.get(), &building);
  XML_SetElementHandler(parser.get(), on_start, on_end);
  XML_SetCharacterDataHandler(parser.get(), on_text);
  XML_SetEntityDeclHandler(parser.get(), on_entity);
  for (std::size_t at = 0; at < bytes.size();) {
    const std::string_view part = bytes.substr(at, bytes_at_once);
    at += part.size();
    const int is_final = at == bytes.size() ? 1 : 0;
    if (XML_Parse(parser.get(), part.data(), static_cast<int>(part.size()), is_final) == XML_STATUS_ERROR) break;
  }
  if (building.tree.stopped_at >= 0) {
    while (!building.open.empty()) close_element(building);
    return std::move(building.tree);
  }
  const XML_Error code = XML_GetErrorCode(parser.get());
  if (code == XML_ERROR_NONE && building.has_root) return std::move(building.tree);
  const bool is_cut = code == XML_ERROR_NO_ELEMENTS || code == XML_ERROR_UNCLOSED_TOKEN || code == XML_ERROR_PARTIAL_CHAR;
  throw Error(is_cut ? ErrorCode::file_truncated : ErrorCode::file_syntax,
              building.fault.empty() ? fmt::format("is no sound XML: {}", XML_ErrorString(code)) : building.fault,
              {.file = file.string(), .byte = static_cast<std::int64_t>(XML_GetCurrentByteIndex(parser.get()))});
}

}  // namespace pcbmesh::formats::syntax
