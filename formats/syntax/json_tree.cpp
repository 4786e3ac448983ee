// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/syntax/json_tree.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_set>
#include <utility>

#include "pcbmesh/base/near_miss.hpp"

namespace pcbmesh::formats::syntax {
namespace {

/// Counts lines while nlohmann's lexer reads: its events carry no place. The lexer looks one character ahead after a
/// number, so the line is that of the last character taken, not of the next one.
struct LineCounter {
  std::int64_t line = 1;
  bool newline_taken = false;
  void take(char c) {
    if (newline_taken) ++line;
    newline_taken = c == '\n';
  }
};

class CountingIterator {
 public:
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  using iterator_category = std::input_iterator_tag;
  CountingIterator(const char* at, LineCounter* counter) : at_(at), counter_(counter) {}
  const char& operator*() const { return *at_; }
  CountingIterator& operator++() {
    counter_->take(*at_++);
    return *this;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  LineCounter* counter_;
};

std::string_view name_of(JsonKind kind) {
  switch (kind) {
    case JsonKind::null:
      return "null";
    case JsonKind::boolean:
      return "true or false";
    case JsonKind::number:
      return "a number";
    case JsonKind::string:
      return "a string";
    case JsonKind::array:
      return "an array";
    case JsonKind::object:
      return "an object";
  }
  return "a value";
}

/// Nothing in a message may be longer than a line, whatever the file holds.
std::string shortened(std::string_view text) {
  constexpr std::size_t longest = 60;
  return text.size() <= longest ? std::string(text) : fmt::format("{}...", text.substr(0, longest));
}

}  // namespace

/// SAX events -> nodes.
class TreeBuilder {
 public:
  using Node = JsonDocument::Node;
  TreeBuilder(JsonDocument& document, const LineCounter& lines) : document_(document), lines_(lines) {}

  bool null() { return add({.kind = JsonKind::null}); }
  bool boolean(bool value) { return add({.kind = JsonKind::boolean, .truth = value}); }
  bool number_integer(std::int64_t value) {
    return add({.number = static_cast<double>(value), .integer = value, .kind = JsonKind::number, .is_integer = true});
  }
  bool number_unsigned(std::uint64_t value) {
    if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      return add({.number = static_cast<double>(value), .kind = JsonKind::number});
    return number_integer(static_cast<std::int64_t>(value));
  }
  bool number_float(double value, const std::string&) { return add({.number = value, .kind = JsonKind::number}); }
  bool string(std::string& value) {
    const auto [at, length] = keep(value);
    return add({.text_at = at, .text_length = length, .kind = JsonKind::string});
  }
  bool binary(std::vector<std::uint8_t>&) { return false; }
  bool start_object(std::size_t) { return open(JsonKind::object); }
  bool start_array(std::size_t) { return open(JsonKind::array); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& value) {
    if (!names_.back().insert(value).second)
      fail(ErrorCode::file_syntax, fmt::format("field '{}' stands twice in one object", shortened(value)));
    std::tie(key_at_, key_length_) = keep(value);
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& error) {
    std::string text = error.what();
    const bool overflow = error.id == 406;
    // "[json.exception...] parse error at line 3, column 7: ..." -> what follows the place
    if (const auto tag = text.find("] "); tag != std::string::npos) text.erase(0, tag + 2);
    if (const auto column = text.find(", column "); column != std::string::npos)
      text = "JSON syntax error in" + text.substr(column + 1);
    fail(overflow ? ErrorCode::input_number : ErrorCode::file_syntax, text);
  }

 private:
  std::pair<std::uint32_t, std::uint32_t> keep(const std::string& value) {
    const auto at = document_.strings_.size();
    if (at + value.size() > std::numeric_limits<std::uint32_t>::max()) fail(ErrorCode::file_syntax, "more than 4 GB of text");
    document_.strings_ += value;
    return {static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(value.size())};
  }

  bool add(Node node) {
    if (document_.nodes_.size() >= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
      fail(ErrorCode::file_syntax, "more than 2^31 values");
    const auto index = static_cast<std::int32_t>(document_.nodes_.size());
    node.key_at = key_at_;
    node.key_length = key_length_;
    key_length_ = 0;
    node.line = static_cast<std::int32_t>(std::min<std::int64_t>(lines_.line, std::numeric_limits<std::int32_t>::max()));
    if (!open_.empty()) {
      node.parent = open_.back();
      Node& parent = document_.nodes_[static_cast<std::size_t>(node.parent)];
      if (last_.back() < 0)
        parent.first_child = index;
      else
        document_.nodes_[static_cast<std::size_t>(last_.back())].next = index;
      last_.back() = index;
      ++parent.num_children;
    }
    document_.nodes_.push_back(node);
    return true;
  }

  bool open(JsonKind kind) {
    if (open_.size() >= JsonDocument::max_depth)
      fail(ErrorCode::file_syntax, fmt::format("nested deeper than {} levels", JsonDocument::max_depth));
    add({.kind = kind});
    open_.push_back(static_cast<std::int32_t>(document_.nodes_.size() - 1));
    last_.push_back(-1);
    names_.emplace_back();
    return true;
  }
  bool close() {
    open_.pop_back();
    last_.pop_back();
    names_.pop_back();
    return true;
  }
  [[noreturn]] void fail(ErrorCode code, std::string_view text) const {
    throw Error(code, std::string(text), {.file = document_.file_, .line = lines_.line});
  }

  JsonDocument& document_;
  const LineCounter& lines_;
  std::vector<std::int32_t> open_, last_;
  std::vector<std::unordered_set<std::string>> names_;
  std::uint32_t key_at_ = 0, key_length_ = 0;
};

JsonDocument JsonDocument::parse(std::string_view text, std::string_view file, ErrorCode field_error) {
  JsonDocument document;
  document.file_ = file;
  document.field_error_ = field_error;
  LineCounter lines;
  TreeBuilder builder(document, lines);
  const CountingIterator first(text.data(), &lines), last(text.data() + text.size(), &lines);
  nlohmann::json::sax_parse(first, last, &builder);
  PCBMESH_ASSERT(!document.nodes_.empty());
  return document;
}

JsonValue::Iterator& JsonValue::Iterator::operator++() {
  index_ = document_->nodes_[static_cast<std::size_t>(index_)].next;
  return *this;
}

JsonKind JsonValue::kind() const {
  return document_->nodes_[static_cast<std::size_t>(index_)].kind;
}
std::int64_t JsonValue::line() const {
  return document_->nodes_[static_cast<std::size_t>(index_)].line;
}
std::int32_t JsonValue::size() const {
  return document_->nodes_[static_cast<std::size_t>(index_)].num_children;
}
JsonValue::Iterator JsonValue::begin() const {
  return {document_, document_->nodes_[static_cast<std::size_t>(index_)].first_child};
}
Spot JsonValue::spot() const {
  return {.file = document_->file_, .line = line()};
}

std::string_view JsonValue::key() const {
  const auto& node = document_->nodes_[static_cast<std::size_t>(index_)];
  return std::string_view(document_->strings_).substr(node.key_at, node.key_length);
}

std::string JsonValue::pointer() const {
  std::vector<std::string> steps;
  for (std::int32_t at = index_; at > 0;) {
    const auto parent_index = document_->nodes_[static_cast<std::size_t>(at)].parent;
    const JsonValue parent(document_, parent_index);
    std::string step;
    if (parent.is(JsonKind::object)) {
      for (char c : JsonValue(document_, at).key())
        step += c == '~' ? std::string("~0") : c == '/' ? std::string("~1") : std::string(1, c);
    } else {
      int rank = 0;
      for (auto it = parent.begin(); (*it).index_ != at; ++it) ++rank;
      step = std::to_string(rank);
    }
    steps.push_back(shortened(step));
    at = parent_index;
  }
  std::string out;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) out += "/" + *step;
  return out;
}

std::optional<JsonValue> JsonValue::find(std::string_view name) const {
  if (!is(JsonKind::object)) fail_kind("an object");
  for (JsonValue member : *this)
    if (member.key() == name) return member;
  return std::nullopt;
}

JsonValue JsonValue::at(std::string_view name) const {
  if (const auto member = find(name)) return *member;
  fail(fmt::format("the field '{}' is missing", name));
}

std::optional<JsonValue> JsonValue::find_set(std::string_view name) const {
  const auto member = find(name);
  return member && member->is(JsonKind::null) ? std::nullopt : member;
}

void JsonValue::allow_only(const std::vector<std::string_view>& names) const {
  if (!is(JsonKind::object)) fail_kind("an object");
  for (JsonValue member : *this) {
    if (std::find(names.begin(), names.end(), member.key()) != names.end()) continue;
    const std::vector<std::string> known(names.begin(), names.end());
    std::string remedy = did_you_mean(member.key(), known);
    if (remedy.empty()) remedy = fmt::format("; fields here are {}", fmt::join(known, ", "));
    member.fail(fmt::format("unknown field '{}'{}", shortened(member.key()), remedy));
  }
}

const JsonValue& JsonValue::as_array() const {
  if (!is(JsonKind::array)) fail_kind("an array");
  return *this;
}

std::string_view JsonValue::as_string() const {
  if (!is(JsonKind::string)) fail_kind("a string");
  const auto& node = document_->nodes_[static_cast<std::size_t>(index_)];
  return std::string_view(document_->strings_).substr(node.text_at, node.text_length);
}

bool JsonValue::as_boolean() const {
  if (!is(JsonKind::boolean)) fail_kind("true or false");
  return document_->nodes_[static_cast<std::size_t>(index_)].truth;
}

double JsonValue::as_number() const {
  if (!is(JsonKind::number)) fail_kind("a number");
  return document_->nodes_[static_cast<std::size_t>(index_)].number;
}

std::int64_t JsonValue::as_integer() const {
  if (!is(JsonKind::number)) fail_kind("a whole number");
  const auto& node = document_->nodes_[static_cast<std::size_t>(index_)];
  if (node.is_integer) return node.integer;
  constexpr double exact_limit = 9007199254740992.0;  // 2^53: "2e8" is as good a whole number as 200000000
  if (std::abs(node.number) <= exact_limit && node.number == std::floor(node.number))
    return static_cast<std::int64_t>(node.number);
  fail(fmt::format("{} is not a whole number in range", node.number));
}

Nm JsonValue::as_length(double mm_per_unit) const {
  try {
    if (is(JsonKind::number)) return nm_from_mm(as_number() * mm_per_unit);
    if (!is(JsonKind::string)) fail_kind("a length (a number, or a string with its unit such as \"35um\")");
    const std::string_view text = as_string();
    const char last = text.empty() ? '0' : text.back();
    if ((last >= '0' && last <= '9') || last == '.')
      fail(fmt::format("'{}' has no unit; write a bare number or add the unit, as in \"35um\"", shortened(text)));
    return parse_length(text);
  } catch (const Error& error) {
    if (!error.spot().file.empty() || error.spot().line > 0) throw;
    // A length beyond any board is a bad number of a board file, but a wrong field of a study.
    const bool plain_number = error.code() == ErrorCode::input_number && document_->field_error_ == ErrorCode::file_syntax;
    fail(plain_number ? ErrorCode::input_number : document_->field_error_, error.text());
  }
}

void JsonValue::fail(std::string_view text) const {
  fail(document_->field_error_, text);
}

void JsonValue::fail(ErrorCode code, std::string_view text) const {
  const std::string place = pointer();
  throw Error(code, place.empty() ? std::string(text) : fmt::format("{}: {}", place, text), spot());
}

void JsonValue::fail_kind(std::string_view expected) const {
  fail(fmt::format("expected {}, found {}", expected, name_of(kind())));
}

}  // namespace pcbmesh::formats::syntax
