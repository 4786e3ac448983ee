// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pcbmesh::formats::syntax {

/// An element of an XML file with all below it.
struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  ///< all character data directly inside
  std::vector<XmlElement> children;
  std::int64_t byte = 0;  ///< of its '<' in the file

  [[nodiscard]] const XmlElement* child(std::string_view name) const;
  /// Empty if there is no such attribute.
  [[nodiscard]] std::string_view attribute(std::string_view name) const;
};

struct XmlTree {
  XmlElement root;
  /// Where the content of the element named by `stop_at` starts; -1 if there is none.
  std::int64_t stopped_at = -1;
};

/// Parses XML. From the start of an element named `stop_at` on nothing is read: raw bytes may follow there. Entities
/// are refused, as they could grow without end; a document type without them is passed over.
/// @throws Error file_syntax (202) with the byte offset, file_truncated (205).
[[nodiscard]] XmlTree parse_xml(std::string_view bytes, const std::filesystem::path& file, std::string_view stop_at = {});

}  // namespace pcbmesh::formats::syntax
