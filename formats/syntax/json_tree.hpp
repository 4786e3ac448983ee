// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/base/units.hpp"

namespace pcbmesh::formats::syntax {

enum class JsonKind : std::uint8_t { null, boolean, number, string, array, object };

class JsonDocument;

/// One value of a JsonDocument: cheap to copy, valid as long as the document. The as_... functions check the kind and
/// throw with the value's line and JSON pointer.
class JsonValue {
 public:
  class Iterator {
   public:
    using value_type = JsonValue;
    using difference_type = std::ptrdiff_t;
    using iterator_category = std::input_iterator_tag;
    Iterator(const JsonDocument* document, std::int32_t index) : document_(document), index_(index) {}
    JsonValue operator*() const { return {document_, index_}; }
    Iterator& operator++();
    bool operator==(const Iterator&) const = default;

   private:
    const JsonDocument* document_;
    std::int32_t index_;
  };

  JsonValue(const JsonDocument* document, std::int32_t index) : document_(document), index_(index) {}

  [[nodiscard]] JsonKind kind() const;
  [[nodiscard]] bool is(JsonKind wanted) const { return kind() == wanted; }
  [[nodiscard]] std::int64_t line() const;     ///< 1-based
  [[nodiscard]] std::string_view key() const;  ///< name of this member; empty for array elements
  [[nodiscard]] std::string pointer() const;   ///< RFC 6901, "/tracks/3/width"; "" for the root
  [[nodiscard]] Spot spot() const;

  /// Members or elements in file order; empty for scalars.
  [[nodiscard]] Iterator begin() const;
  [[nodiscard]] Iterator end() const { return {document_, -1}; }
  [[nodiscard]] std::int32_t size() const;

  /// Member by name, or nullopt. @cost O(members). @throws if this is no object.
  [[nodiscard]] std::optional<JsonValue> find(std::string_view name) const;
  /// Member by name, or an error that names the missing field.
  [[nodiscard]] JsonValue at(std::string_view name) const;
  /// Like find, but null counts as absent.
  [[nodiscard]] std::optional<JsonValue> find_set(std::string_view name) const;
  /// Errors unless this is an object whose members are all among `names`; suggests the nearest name.
  void allow_only(std::initializer_list<std::string_view> names) const { allow_only(std::vector<std::string_view>(names)); }
  void allow_only(const std::vector<std::string_view>& names) const;

  const JsonValue& as_array() const;
  [[nodiscard]] std::string_view as_string() const;
  [[nodiscard]] bool as_boolean() const;
  [[nodiscard]] double as_number() const;
  [[nodiscard]] std::int64_t as_integer() const;
  /// Length: a number in units of `mm_per_unit` millimetres, or a string with its unit ("35um").
  [[nodiscard]] Nm as_length(double mm_per_unit) const;

  /// Throws the document's error for wrong fields: "/air/above: text" with file and line.
  [[noreturn]] void fail(std::string_view text) const;
  [[noreturn]] void fail(ErrorCode code, std::string_view text) const;

 private:
  [[noreturn]] void fail_kind(std::string_view expected) const;
  const JsonDocument* document_;
  std::int32_t index_;
};

/// JSON text as a flat tree that remembers lines. Strict RFC 8259: no comments, no NaN; members named twice and nesting
/// beyond 64 levels are errors.
class JsonDocument {
 public:
  static constexpr int max_depth = 64;

  /// @param field_error  code of all later complaints about fields.
  /// @throws Error file_syntax (202) with the line; input_number (203) for a number no double can hold.
  /// @cost O(text); 56 bytes per value.
  [[nodiscard]] static JsonDocument parse(std::string_view text, std::string_view file, ErrorCode field_error);

  JsonDocument(JsonDocument&&) = default;
  JsonDocument& operator=(JsonDocument&&) = default;
  [[nodiscard]] JsonValue root() const { return {this, 0}; }

 private:
  friend class JsonValue;
  friend class JsonValue::Iterator;
  friend class TreeBuilder;
  struct Node {
    double number = 0;
    std::int64_t integer = 0;  ///< if is_integer
    std::uint32_t key_at = 0, key_length = 0, text_at = 0, text_length = 0;
    std::int32_t parent = -1, first_child = -1, next = -1, num_children = 0;
    std::int32_t line = 0;
    JsonKind kind = JsonKind::null;
    bool is_integer = false;
    bool truth = false;
  };
  JsonDocument() = default;
  std::string file_;
  ErrorCode field_error_ = ErrorCode::file_syntax;
  std::vector<Node> nodes_;
  std::string strings_;
};

}  // namespace pcbmesh::formats::syntax
