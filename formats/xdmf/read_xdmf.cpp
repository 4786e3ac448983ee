// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/xdmf/read_xdmf.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "formats/hdf5/file_reader.hpp"
#include "formats/syntax/input_file.hpp"
#include "formats/syntax/xml_tree.hpp"
#include "formats/vtk/mesh_assembly.hpp"
#include "formats/xdmf/topology.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::xdmf {
namespace {

using syntax::XmlElement;

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n"), last = text.find_last_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string() : std::string(text.substr(first, last - first + 1));
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, const Progress& progress) : file_(file), progress_(progress), mesh_(file) {}
  mesh::MeshData read();

 private:
  [[noreturn]] void fail(const XmlElement& where, const std::string& text, ErrorCode code = ErrorCode::file_syntax) const {
    throw Error(code, text, {.file = file_.string(), .byte = where.byte});
  }
  void read_grids(const XmlElement& parent);
  void read_grid(const XmlElement& grid);
  void read_tags_grid(const XmlElement& grid);
  [[nodiscard]] const XmlElement& item_of(const XmlElement& owner) const;
  template <class Value>
  [[nodiscard]] std::vector<Value> numbers(const XmlElement& owner);
  [[nodiscard]] const hdf5::FileReader& heavy(const XmlElement& item, const std::string& name);
  [[nodiscard]] std::int64_t points_of(const XmlElement& grid);
  [[nodiscard]] std::vector<std::int64_t> tags_of(const XmlElement& grid);

  std::filesystem::path file_;
  const Progress& progress_;
  vtk::MeshAssembly mesh_;
  std::map<std::string, std::unique_ptr<hdf5::FileReader>> heavy_;
  std::map<std::string, std::int64_t> first_node_;  ///< by the text that names the points
  bool has_grid_ = false;
};

const XmlElement& Reader::item_of(const XmlElement& owner) const {
  const XmlElement* item = owner.child("DataItem");
  if (item == nullptr) fail(owner, fmt::format("{} has no DataItem", owner.name));
  if (!item->attribute("Reference").empty() || !item->children.empty())
    fail(*item, "references and functions between data items are not read");
  return *item;
}

const hdf5::FileReader& Reader::heavy(const XmlElement& item, const std::string& name) {
  auto& reader = heavy_[name];
  if (reader == nullptr) {
    const std::filesystem::path path = file_.parent_path() / name;
    if (!std::filesystem::exists(path))
      fail(item, fmt::format("the file '{}' with its numbers is not beside it", name), ErrorCode::file_unreadable);
    reader = std::make_unique<hdf5::FileReader>(path);
  }
  return *reader;
}

template <class Value>
std::vector<Value> text_numbers(std::string_view text, const auto& fail) {
  std::vector<Value> out;
  const char *at = text.data(), *const end = at + text.size();
  while (true) {
    while (at != end && (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')) ++at;
    if (at == end) return out;
    if (*at == '+') ++at;
    Value value{};
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) fail(fmt::format("value {} is no number in range", out.size()));
    out.push_back(value);
    at = next;
  }
}

template <class Value>
std::vector<Value> Reader::numbers(const XmlElement& owner) {
  const XmlElement& item = item_of(owner);
  const std::string_view format = item.attribute("Format");
  std::vector<Value> out;
  if (format == "XML" || format.empty()) {
    out = text_numbers<Value>(item.text, [&](const std::string& text) { fail(item, text); });
  } else if (format == "HDF") {
    const std::string text = trimmed(item.text);
    const std::size_t colon = text.rfind(":/");
    if (colon == std::string::npos) fail(item, fmt::format("'{}' names no data set of an HDF5 file", text.substr(0, 80)));
    const hdf5::FileReader& file = heavy(item, text.substr(0, colon));
    if constexpr (std::is_integral_v<Value>)
      out = file.integers(text.substr(colon + 1));
    else
      out = file.reals(text.substr(colon + 1));
  } else {
    fail(item, fmt::format("format '{}' is not read; HDF and XML are", format.substr(0, 40)));
  }
  std::uint64_t expected = 1;
  for (const std::int64_t extent : text_numbers<std::int64_t>(
           item.attribute("Dimensions"), [&](const std::string& text) { fail(item, "Dimensions: " + text); }))
    expected = extent < 0 || expected > out.size() + 1 ? out.size() + 1 : expected * static_cast<std::uint64_t>(extent);
  if (expected != out.size())
    fail(item,
         fmt::format("Dimensions '{}' do not fit the {} values there are", item.attribute("Dimensions").substr(0, 40),
                     out.size()),
         ErrorCode::file_truncated);
  return out;
}

std::int64_t Reader::points_of(const XmlElement& grid) {
  const XmlElement* geometry = grid.child("Geometry");
  if (geometry == nullptr) fail(grid, "the grid has no Geometry");
  const std::string_view type =
      geometry->attribute("GeometryType").empty() ? geometry->attribute("Type") : geometry->attribute("GeometryType");
  if (type != "XYZ" && !type.empty())
    fail(*geometry, fmt::format("geometry of the type '{}' is not read, only XYZ", type.substr(0, 40)));
  const std::string name = trimmed(item_of(*geometry).text);
  if (const auto known = first_node_.find(name); known != first_node_.end()) return known->second;
  const std::int64_t first = mesh_.num_nodes();
  const std::vector<double> values = numbers<double>(*geometry);
  if (values.size() % 3 != 0) fail(*geometry, fmt::format("{} coordinates make no whole points", values.size()));
  mesh_.add_nodes(values);
  first_node_.emplace(name, first);
  return first;
}

std::vector<std::int64_t> Reader::tags_of(const XmlElement& grid) {
  // dolfinx names the values of a grid of tags as the grid.
  for (const std::string_view name :
       {std::string_view("volume_tag"), std::string_view("face_tag"), std::string_view("gmsh:physical"),
        std::string_view("material"), std::string_view("attribute"), grid.attribute("Name")})
    for (const XmlElement& attribute : grid.children) {
      if (attribute.name != "Attribute" || attribute.attribute("Name") != name || attribute.attribute("Center") != "Cell")
        continue;
      std::vector<std::int64_t> tags = numbers<std::int64_t>(attribute);
      for (const std::int64_t tag : tags)
        if (tag < std::numeric_limits<std::int32_t>::min() || tag > std::numeric_limits<std::int32_t>::max())
          fail(attribute, fmt::format("tag {} does not fit 32 bits", tag));
      return tags;
    }
  return {};
}

/// Grids without points of their own, as dolfinx writes them: those of tags hold cells of the grid before, or its faces, once
/// more, with values under the name of the grid; those of functions have no elements either, and nothing for a mesh.
void Reader::read_tags_grid(const XmlElement& grid) {
  const XmlElement* topology = grid.child("Topology");
  if (topology == nullptr) return;
  if (first_node_.size() != 1) fail(grid, "a grid without points of its own needs exactly one grid with points before it");
  const auto refuse = [&](const std::string& text) { fail(*topology, text); };
  const std::string_view type = topology->attribute("TopologyType");
  const std::vector<std::int64_t> nodes = numbers<std::int64_t>(*topology), tags = tags_of(grid);
  const auto kind = kind_of(type);
  if (!kind || mesh::dimension_of(*kind) != 3) return add_elements(mesh_, type, nodes, tags, refuse);
  const auto width = static_cast<std::size_t>(mesh::nodes_of(*kind));
  if (nodes.size() != tags.size() * width)
    refuse(fmt::format("holds {} node numbers, but there are {} tags", nodes.size(), tags.size()));
  for (std::size_t i = 0; i < tags.size(); ++i)
    mesh_.set_tag_of_cell(*kind, std::span(nodes).subspan(i * width, width), static_cast<std::int32_t>(tags[i]), 0);
}

void Reader::read_grid(const XmlElement& grid) {
  if (grid.child("Geometry") == nullptr && grid.child("xi:include") != nullptr) return read_tags_grid(grid);
  has_grid_ = true;
  const std::int64_t first_node = points_of(grid);
  const XmlElement* topology = grid.child("Topology");
  if (topology == nullptr) fail(grid, "the grid has no Topology");
  const std::string_view type =
      topology->attribute("TopologyType").empty() ? topology->attribute("Type") : topology->attribute("TopologyType");
  add_elements(
      mesh_, type, numbers<std::int64_t>(*topology), tags_of(grid), [&](const std::string& text) { fail(*topology, text); },
      first_node);
  progress_.check();
}

void Reader::read_grids(const XmlElement& parent) {
  for (const XmlElement& grid : parent.children) {
    if (grid.name != "Grid") continue;
    const std::string_view type = grid.attribute("GridType");
    if (type == "Collection" || type == "Tree")
      read_grids(grid);
    else
      read_grid(grid);
  }
}

mesh::MeshData Reader::read() {
  const syntax::XmlTree tree = syntax::parse_xml(syntax::read_whole_file(file_), file_);
  if (tree.root.name != "Xdmf") fail(tree.root, fmt::format("this is no XDMF file but '{}'", tree.root.name.substr(0, 40)));
  const XmlElement* domain = tree.root.child("Domain");
  if (domain == nullptr) fail(tree.root, "the file holds no Domain");
  read_grids(*domain);
  if (!has_grid_) fail(*domain, "the file holds no Grid");
  mesh_.turn_wedges_if_inside_out();  // the format is silent about them: dolfinx and ParaView take them in different orders
  mesh::MeshData out = mesh_.take();
  out.format.name = "xdmf";
  // Names stand in the numbers' file, where it is one of ours.
  for (const auto& [name, reader] : heavy_)
    for (const int dimension : {2, 3}) {
      if (dimension == 2 && out.faces.empty()) continue;  // they belong to another light file
      const std::string path = std::string("/VTKHDF/FieldData/") + (dimension == 3 ? "volume" : "face");
      if (!reader->has(path + "_names") || !reader->has(path + "_tags")) continue;
      const auto names = reader->texts(path + "_names");
      const auto tags = reader->integers(path + "_tags");
      for (std::size_t i = 0; i < std::min(names.size(), tags.size()); ++i)
        out.names.push_back({dimension, static_cast<std::int32_t>(tags[i]), names[i]});
    }
  return out;
}

}  // namespace

mesh::MeshData read_xdmf(const std::filesystem::path& file, const Progress& progress) {
  progress.check();
  return Reader(file, progress).read();
}

}  // namespace pcbmesh::formats::xdmf
