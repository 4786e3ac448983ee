// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtu/name_tables.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace pcbmesh::formats::vtu {
namespace {

using syntax::XmlElement;

/// Field data are small: as text in every file, whatever the arrays of points and cells are.
template <class Value>
void put_array(FileSink& sink, std::string_view type, const std::string& name, std::span<const Value> values) {
  sink.put(fmt::format("   <DataArray type=\"{}\" Name=\"{}\" NumberOfTuples=\"{}\" format=\"ascii\">\n", type, name,
                       values.size()));
  constexpr std::size_t values_per_line = 24;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sink.put_number(static_cast<std::int64_t>(values[i]));
    sink.put((i + 1) % values_per_line == 0 || i + 1 == values.size() ? "\n" : " ");
  }
  sink.put("   </DataArray>\n");
}

void put_texts(FileSink& sink, const std::string& name, std::span<const std::string> texts) {
  std::vector<unsigned char> bytes;
  for (const std::string& text : texts) {
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
  }
  if (!bytes.empty()) put_array(sink, "UInt8", name, std::span<const unsigned char>(bytes));
}

const XmlElement* field(const XmlElement& data, const std::string& name) {
  for (const XmlElement& array : data.children)
    if (array.name == "DataArray" && array.attribute("Name") == name) return &array;
  return nullptr;
}

std::vector<std::int64_t> values_of(const ArrayReader& reader, const XmlElement& array) {
  const std::string_view text = array.attribute("NumberOfTuples");
  std::int64_t count = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 0)
    reader.fail(array, fmt::format("NumberOfTuples='{}' is no sensible count", text.substr(0, 40)));
  return reader.integers(array, count);
}

}  // namespace

void put_name_tables(FileSink& sink, const mesh::MeshSource& source, bool with_faces) {
  sink.put("  <FieldData>\n");
  for (const int dimension : {3, 2}) {
    if (dimension == 2 && !with_faces) continue;
    std::vector<std::string> names;
    std::vector<std::int32_t> tags;
    for (const mesh::ElementGroup& group : source.groups()) {
      if (group.dimension != dimension) continue;
      names.push_back(group.name);
      tags.push_back(group.tag);
    }
    if (names.empty()) continue;
    const std::string kind = dimension == 3 ? "volume" : "face";
    put_array(sink, "Int32", kind + "_tags", std::span<const std::int32_t>(tags));
    put_texts(sink, kind + "_names", names);
  }
  std::vector<std::string> materials;
  for (const board::Material& material : source.materials()) materials.push_back(material.name);
  put_texts(sink, "layers", source.layers());
  put_texts(sink, "materials", materials);
  put_texts(sink, "nets", source.nets());
  sink.put("  </FieldData>\n");
}

void read_name_tables(const ArrayReader& reader, const XmlElement& grid, vtk::MeshAssembly& mesh) {
  const XmlElement* data = grid.child("FieldData");
  if (data == nullptr) return;
  for (const int dimension : {3, 2}) {
    const std::string kind = dimension == 3 ? "volume" : "face";
    const XmlElement *tags_array = field(*data, kind + "_tags"), *names_array = field(*data, kind + "_names");
    if (tags_array == nullptr || names_array == nullptr) continue;
    std::string bytes;
    for (const std::int64_t byte : values_of(reader, *names_array)) {
      if (byte < 0 || byte > 255) reader.fail(*names_array, fmt::format("{} is no byte of a text", byte));
      bytes.push_back(static_cast<char>(byte));
    }
    std::size_t at = 0;
    for (const std::int64_t tag : values_of(reader, *tags_array)) {
      const std::size_t end = bytes.find('\0', at);
      if (end == std::string::npos) reader.fail(*names_array, "has not as many names as there are tags");
      if (tag < std::numeric_limits<std::int32_t>::min() || tag > std::numeric_limits<std::int32_t>::max())
        reader.fail(*tags_array, fmt::format("tag {} does not fit 32 bits", tag));
      mesh.add_name(dimension, static_cast<std::int32_t>(tag), bytes.substr(at, end - at));
      at = end + 1;
    }
  }
}

}  // namespace pcbmesh::formats::vtu
