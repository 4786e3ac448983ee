// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/validation/report.hpp"

namespace pcbmesh::validation {
namespace {

using nlohmann::json;

/// One value of the file and the way to it, for messages: "volumes[3].num_cells".
class Field {
 public:
  Field(const json* value, std::string path, const std::string& file) : value_(value), path_(std::move(path)), file_(&file) {}

  [[noreturn]] void fail(std::string_view expected) const {
    throw Error(ErrorCode::file_syntax,
                fmt::format("{} must be {}; the file is damaged or not a tags.json of pcbmesh, write the mesh again",
                            path_.empty() ? "the top level" : path_, expected),
                Spot{.file = *file_});
  }
  [[nodiscard]] bool is_absent() const { return value_ == nullptr || value_->is_null(); }
  [[nodiscard]] Field operator[](const char* key) const {
    if (value_ == nullptr || !value_->is_object()) fail("an object");
    const auto member = value_->find(key);
    return {member == value_->end() ? nullptr : &*member, path_.empty() ? key : path_ + "." + key, *file_};
  }
  [[nodiscard]] std::vector<Field> list() const {
    if (value_ == nullptr || !value_->is_array()) fail("a list");
    std::vector<Field> fields;
    for (std::size_t i = 0; i < value_->size(); ++i)
      fields.emplace_back(&(*value_)[i], fmt::format("{}[{}]", path_, i), *file_);
    return fields;
  }
  [[nodiscard]] std::string text() const {
    if (value_ == nullptr || !value_->is_string()) fail("a text");
    return value_->get<std::string>();
  }
  [[nodiscard]] std::string text_or_empty() const { return is_absent() ? std::string() : text(); }
  [[nodiscard]] bool flag() const {
    if (value_ == nullptr || !value_->is_boolean()) fail("true or false");
    return value_->get<bool>();
  }
  [[nodiscard]] std::int64_t integer(std::int64_t low, std::int64_t high) const {
    const std::string expected = fmt::format("a whole number in {}..{}", low, high);
    if (value_ == nullptr || !value_->is_number_integer()) fail(expected);
    if (value_->is_number_unsigned() && value_->get<std::uint64_t>() > static_cast<std::uint64_t>(high)) fail(expected);
    const auto number = value_->get<std::int64_t>();
    if (number < low || number > high) fail(expected);
    return number;
  }
  [[nodiscard]] double number() const {
    if (value_ == nullptr || !value_->is_number() || !std::isfinite(value_->get<double>())) fail("a finite number");
    return value_->get<double>();
  }
  /// Absent or negative means unknown.
  [[nodiscard]] std::int64_t count_or_unknown() const {
    return is_absent() ? -1 : std::max<std::int64_t>(-1, integer(std::numeric_limits<std::int64_t>::min(), max_count));
  }
  [[nodiscard]] double measure_or_unknown() const { return is_absent() ? -1.0 : number(); }

 private:
  static constexpr std::int64_t max_count = std::numeric_limits<std::int64_t>::max();
  const json* value_;
  std::string path_;
  const std::string* file_;
};

constexpr std::int64_t max_tag = std::numeric_limits<std::int32_t>::max();

std::int32_t read_tag(const Field& group, std::set<std::int32_t>& seen) {
  const auto tag = static_cast<std::int32_t>(group["id"].integer(1, max_tag));
  if (!seen.insert(tag).second) group["id"].fail(fmt::format("given once: {} came before", tag));
  return tag;
}

void read_volumes(const Field& list, Expectation& out) {
  std::set<std::int32_t> seen;
  for (const Field& field : list.list()) {
    Expectation::Volume volume;
    volume.tag = read_tag(field, seen);
    volume.name = field["name"].text();
    volume.layer = field["layer"].text_or_empty();
    volume.material = field["material"].text_or_empty();
    volume.net = field["net"].text_or_empty();
    volume.conductor = !field["conductor"].is_absent() && field["conductor"].flag();
    volume.num_cells = field["num_cells"].count_or_unknown();
    volume.volume_m3 = field["volume_m3"].measure_or_unknown();
    out.volumes.push_back(std::move(volume));
  }
}

void read_faces(const Field& list, Expectation& out) {
  std::set<std::int32_t> seen;
  for (const Field& field : list.list()) {
    Expectation::Face face;
    face.tag = read_tag(field, seen);
    face.name = field["name"].text();
    const std::string kind = field["kind"].text();
    constexpr std::string_view kinds[] = {"outer", "conductor", "sheet", "port", "wave_port", "interface"};
    if (std::ranges::find(kinds, kind) == std::end(kinds))
      field["kind"].fail("one of outer, conductor, sheet, port, wave_port, interface");
    face.outer = field["inner"].is_absent() ? kind == "outer" || kind == "wave_port" : !field["inner"].flag();
    face.num_faces = field["num_faces"].count_or_unknown();
    face.area_m2 = field["area_m2"].measure_or_unknown();
    out.faces.push_back(std::move(face));
  }
}

void read_nets(const Field& top, Expectation& out) {
  if (const Field nets = top["nets"]; !nets.is_absent()) {
    for (const Field& field : nets.list()) {
      const auto pieces = std::min<std::int64_t>(field["pieces"].count_or_unknown(), max_tag);
      out.nets.push_back({field["name"].text(), static_cast<std::int32_t>(pieces)});
    }
  }
  const Field touching = top["touching_nets"];
  if (touching.is_absent()) return;
  for (const Field& field : touching.list()) {
    const std::vector<Field> pair = field.list();
    if (pair.size() != 2) field.fail("a list of two net names");
    out.touching_nets.push_back({pair[0].text(), pair[1].text()});
  }
}

json parse(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  if (in) bytes << in.rdbuf();
  if (!in || in.bad()) {
    throw Error(ErrorCode::file_unreadable, "the file can't be read; give the tags.json written beside the mesh",
                Spot{.file = file});
  }
  const std::string text = std::move(bytes).str();
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    const auto byte = static_cast<std::int64_t>(error.byte);
    const auto end = text.begin() + std::min<std::int64_t>(byte, static_cast<std::int64_t>(text.size()));
    throw Error(ErrorCode::file_syntax,
                fmt::format("the file is no JSON from byte {} of {} on; it is damaged or cut short, write the mesh again", byte,
                            text.size()),
                Spot{.file = file, .line = 1 + std::count(text.begin(), end, '\n')});
  }
}

}  // namespace

Expectation read_expectation(const std::string& file) {
  const json document = parse(file);
  const Field top(&document, "", file);
  if (top["schema_version"].integer(0, max_tag) != 1) top["schema_version"].fail("1, the only version this program knows");
  Expectation out;
  out.unit_m = top["unit_m"].number();
  if (!(out.unit_m > 0)) top["unit_m"].fail("greater than zero");
  read_volumes(top["volumes"], out);
  read_faces(top["faces"], out);
  read_nets(top, out);
  return out;
}

}  // namespace pcbmesh::validation
