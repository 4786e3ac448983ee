// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/abaqus/read_inp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/mesh_builder/mesh_builder.hpp"
#include "formats/syntax/byte_source.hpp"

namespace pcbmesh::formats::abaqus {
namespace {

using mesh::ElementKind;

constexpr std::int64_t lines_per_report = 1 << 16;

std::string upper_case(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t' || text.back() == '\r')) text.remove_suffix(1);
  return text;
}

/// Digits decide: C3D8R and C3D8I are bricks of eight nodes.
std::optional<ElementKind> kind_of(const std::string& type) {
  if (!type.starts_with("C3D")) return std::nullopt;
  int nodes = 0;
  std::from_chars(type.data() + 3, type.data() + type.size(), nodes);
  switch (nodes) {
    case 4:
      return ElementKind::tetrahedron;
    case 5:
      return ElementKind::pyramid;
    case 6:
      return ElementKind::wedge;
    case 8:
      return ElementKind::hexahedron;
    case 10:
      return ElementKind::tetrahedron10;
    case 15:
      return ElementKind::wedge15;
    default:
      return std::nullopt;
  }
}

/// Place of each node of the file in Gmsh order.
std::span<const std::uint8_t> places(ElementKind kind) {
  static constexpr std::array<std::uint8_t, 15> wedge{0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11};
  static constexpr std::array<std::uint8_t, 10> tetrahedron{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
  static constexpr std::array<std::uint8_t, 8> same{0, 1, 2, 3, 4, 5, 6, 7};
  if (kind == ElementKind::wedge15) return wedge;
  if (kind == ElementKind::tetrahedron10) return tetrahedron;
  return std::span(same).first(static_cast<std::size_t>(mesh::nodes_of(kind)));
}

/// Nodes of side S1, S2 ... in Gmsh's local numbers, outward; of second order behind them. Empty: there is no such side.
std::vector<int> side_nodes(ElementKind kind, int side) {
  static const std::map<ElementKind, std::vector<std::vector<int>>> sides{
      {ElementKind::tetrahedron, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}},
      {ElementKind::tetrahedron10, {{0, 2, 1, 6, 5, 4}, {0, 1, 3, 4, 9, 7}, {1, 2, 3, 5, 8, 9}, {0, 3, 2, 7, 8, 6}}},
      {ElementKind::pyramid, {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}},
      {ElementKind::wedge, {{0, 2, 1}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}},
      {ElementKind::wedge15,
       {{0, 2, 1, 7, 9, 6},
        {3, 4, 5, 12, 14, 13},
        {0, 1, 4, 3, 6, 10, 12, 8},
        {1, 2, 5, 4, 9, 11, 14, 10},
        {2, 0, 3, 5, 7, 8, 13, 11}}},
      {ElementKind::hexahedron, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}}};
  const auto& of_kind = sides.at(kind);
  if (side < 1 || static_cast<std::size_t>(side) > of_kind.size()) return {};
  return of_kind[static_cast<std::size_t>(side) - 1];
}

ElementKind face_kind(std::size_t nodes) {
  return nodes == 3   ? ElementKind::triangle
         : nodes == 4 ? ElementKind::quadrangle
         : nodes == 6 ? ElementKind::triangle6
                      : ElementKind::quadrangle8;
}

/// Names to tags: the number behind the first letter if there is one, else the next free number.
class Tags {
 public:
  explicit Tags(char letter) : letter_(letter) {}
  std::int32_t of(const std::string& name) {
    const auto [found, is_new] = tags_.try_emplace(upper_case(name), 0);
    if (!is_new) return found->second;
    std::int32_t tag = 0;
    if (name.size() > 1 && upper_case(name)[0] == letter_) {
      const char *first = name.data() + 1, *last = name.data() + name.size();
      const auto [end, error] = std::from_chars(first, last, tag);
      if (error != std::errc() || tag < 1 || (end != last && *end != '_') || taken_.contains(tag)) tag = 0;
    }
    if (tag == 0) {
      tag = taken_.empty() ? 1 : taken_.rbegin()->first;
      while (taken_.contains(tag)) tag = tag == std::numeric_limits<std::int32_t>::max() ? 1 : tag + 1;
    }
    taken_.emplace(tag, name);
    return found->second = tag;
  }
  [[nodiscard]] const std::map<std::int32_t, std::string>& names() const { return taken_; }

 private:
  char letter_;
  std::map<std::string, std::int32_t> tags_;
  std::map<std::int32_t, std::string> taken_;
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const Progress& progress) : source_(file), progress_(progress), builder_(source_) {}
  mesh::MeshData read(std::string name);

 private:
  enum class Block { other, node, element, surface };
  struct Element {
    std::int64_t number;
    std::size_t first;  ///< in nodes_
    ElementKind kind;
    std::int32_t tag;
  };
  struct Side {
    std::int64_t element;
    std::int32_t side, tag;
  };
  void take_comment(std::string_view line);
  void take_keyword(std::string_view line);
  void take_node(std::string_view line);
  void take_element(std::string_view line);
  void take_side(std::string_view line);
  void finish();
  /// Numbers between commas.
  template <class Visit>
  void visit_fields(std::string_view line, Visit&& visit) const {
    while (true) {
      const std::size_t comma = line.find(',');
      visit(trimmed(line.substr(0, comma)));
      if (comma == std::string_view::npos) return;
      line.remove_prefix(comma + 1);
    }
  }
  [[nodiscard]] std::int64_t integer(std::string_view word) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) source_.fail("a number was expected here");
    return value;
  }
  [[nodiscard]] double real(std::string_view word) const {
    if (word.starts_with('+')) word.remove_prefix(1);
    std::string text(word);
    std::ranges::replace(text, 'D', 'E');
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) source_.fail("a coordinate was expected here");
    return value;
  }

  syntax::ByteSource source_;
  const Progress& progress_;
  MeshBuilder builder_;
  Block block_ = Block::other;
  ElementKind kind_ = ElementKind::wedge;
  std::int32_t tag_ = 0;
  std::vector<std::int64_t> row_;  ///< an element may go on in the next line
  std::vector<std::int64_t> nodes_;
  std::vector<Element> elements_;
  std::vector<Side> sides_;
  Tags volumes_{'V'}, surfaces_{'S'};
  std::map<std::int32_t, std::string> volume_names_, surface_names_;  ///< from comments: set names hold no blanks or bars
};

mesh::MeshData Reader::read(std::string name) {
  if (source_.size() == 0) source_.fail("the file is empty", ErrorCode::file_truncated);
  for (std::int64_t lines = 1; source_.skip_blanks(); ++lines) {
    const std::string line(trimmed(source_.line()));
    if (lines % lines_per_report == 0)
      progress_.at("read", static_cast<double>(source_.offset()) / static_cast<double>(source_.size()));
    if (line.starts_with("**")) {
      take_comment(line);
      continue;
    }
    if (line.starts_with('*')) {
      if (!row_.empty()) source_.fail("an element ends too early: it has fewer nodes than its type");
      take_keyword(line);
    } else if (block_ == Block::node) {
      take_node(line);
    } else if (block_ == Block::element) {
      take_element(line);
    } else if (block_ == Block::surface) {
      take_side(line);
    }
  }
  finish();
  return builder_.take(std::move(name));
}

/// "** volume 3 top|copper|GND": how the group is really called.
void Reader::take_comment(std::string_view line) {
  for (const auto& [word, names] :
       {std::pair<std::string_view, std::map<std::int32_t, std::string>*>{"** volume ", &volume_names_},
        {"** surface ", &surface_names_}}) {
    if (!line.starts_with(word)) continue;
    const std::string_view rest = line.substr(word.size());
    std::int32_t tag = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), tag);
    const auto used = static_cast<std::size_t>(end - rest.data());
    if (error == std::errc() && used + 1 < rest.size() && rest[used] == ' ') (*names)[tag] = std::string(rest.substr(used + 1));
  }
}

void Reader::take_keyword(std::string_view line) {
  std::string keyword;
  std::map<std::string, std::string> options;
  visit_fields(line, [&](std::string_view field) {
    const std::size_t equal = field.find('=');
    if (keyword.empty())
      keyword = upper_case(field);
    else if (equal != std::string_view::npos)
      options[upper_case(trimmed(field.substr(0, equal)))] = std::string(trimmed(field.substr(equal + 1)));
  });
  block_ = Block::other;
  if (keyword == "*INCLUDE") source_.fail("files that include others are not read; put the mesh into one file");
  if (keyword == "*NODE") block_ = Block::node;
  if (keyword == "*ELEMENT") {
    const std::string type = upper_case(options["TYPE"]);
    const std::optional<ElementKind> kind = kind_of(type);
    if (!kind)
      source_.fail(
          fmt::format("elements of type '{}' are not read; C3D4, C3D5, C3D6, C3D8, C3D10 and C3D15 are", type.substr(0, 20)));
    kind_ = *kind;
    tag_ = options["ELSET"].empty() ? 0 : volumes_.of(options["ELSET"]);
    block_ = Block::element;
  }
  if (keyword == "*SURFACE" && !options["NAME"].empty() &&
      (options["TYPE"].empty() || upper_case(options["TYPE"]) == "ELEMENT")) {
    tag_ = surfaces_.of(options["NAME"]);
    block_ = Block::surface;
  }
}

void Reader::take_node(std::string_view line) {
  std::int64_t number = 0;
  std::array<double, 3> at{};
  std::size_t field = 0;
  visit_fields(line, [&](std::string_view word) {
    if (field == 0)
      number = integer(word);
    else if (field < 4 && !word.empty())
      at[field - 1] = real(word);
    ++field;
  });
  if (field < 3) source_.fail("a node needs a number and its coordinates");
  builder_.add_node(number, at);
}

void Reader::take_element(std::string_view line) {
  visit_fields(line, [&](std::string_view word) {
    if (!word.empty()) row_.push_back(integer(word));
  });
  const auto width = static_cast<std::size_t>(mesh::nodes_of(kind_)) + 1;
  if (row_.size() > width) source_.fail(fmt::format("an element of {} has {} nodes", mesh::name_of(kind_), row_.size() - 1));
  if (row_.size() < width) return;
  elements_.push_back({row_[0], nodes_.size(), kind_, tag_});
  const auto place = places(kind_);
  nodes_.resize(nodes_.size() + place.size());
  for (std::size_t i = 0; i < place.size(); ++i) nodes_[elements_.back().first + place[i]] = row_[i + 1];
  row_.clear();
}

void Reader::take_side(std::string_view line) {
  const std::size_t comma = line.find(',');
  if (comma == std::string_view::npos) source_.fail("a side of a surface needs an element and S1, S2 ...");
  const std::string_view first = trimmed(line.substr(0, comma)), second = trimmed(line.substr(comma + 1));
  if (second.size() < 2 || (second[0] != 'S' && second[0] != 's')) source_.fail("a side is named S1, S2 ...");
  if (first.empty() || first[0] < '0' || first[0] > '9')
    source_.fail("surfaces over element sets are not read; name the elements one by one");
  const std::int64_t side = integer(second.substr(1));
  if (side < 1 || side > 6) source_.fail(fmt::format("there is no side S{}", side));
  sides_.push_back({integer(first), static_cast<std::int32_t>(side), tag_});
}

void Reader::finish() {
  source_.enter("", true);
  if (!row_.empty()) source_.fail("the last element has too few nodes", ErrorCode::file_truncated);
  if (elements_.empty()) source_.fail("the file has no elements", ErrorCode::file_truncated);
  builder_.finish_nodes();
  std::int64_t next = 1;
  for (const Element& element : elements_) {
    next = std::max(next, element.number + 1);
    builder_.add_element(element.kind, element.number, element.tag,
                         std::span(nodes_).subspan(element.first, static_cast<std::size_t>(mesh::nodes_of(element.kind))));
  }
  builder_.finish_elements();
  std::ranges::sort(elements_, {}, &Element::number);
  std::vector<std::int64_t> face;
  for (const Side& side : sides_) {
    const auto found = std::ranges::lower_bound(elements_, side.element, {}, &Element::number);
    if (found == elements_.end() || found->number != side.element)
      source_.fail(fmt::format("a surface names element {}, which does not exist", side.element));
    face.clear();
    for (const int node : side_nodes(found->kind, side.side))
      face.push_back(nodes_[found->first + static_cast<std::size_t>(node)]);
    if (face.empty()) source_.fail(fmt::format("element {} has no side S{}", side.element, side.side));
    builder_.add_element(face_kind(face.size()), next++, side.tag, face);
  }
  const auto add_names = [&](int dimension, const Tags& tags, const std::map<std::int32_t, std::string>& real_names) {
    for (const auto& [tag, name] : tags.names()) {
      const auto found = real_names.find(tag);
      builder_.add_name(dimension, tag, found == real_names.end() ? name : found->second);
    }
  };
  add_names(3, volumes_, volume_names_);
  add_names(2, surfaces_, surface_names_);
}

}  // namespace

mesh::MeshData read_inp(const std::filesystem::path& file, const Progress& progress) {
  progress.check();
  return Reader(file, progress).read(file.string());
}

}  // namespace pcbmesh::formats::abaqus
