// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pcbmesh::formats::syntax {

class SexprTree;

/// One list or atom of a SexprTree: a light cursor, valid while the tree lives. A default cursor is "absent":
/// every question to it answers no, empty or absent, so that look-ups can be chained.
class Sexpr {
 public:
  Sexpr() = default;

  explicit operator bool() const noexcept { return tree_ != nullptr; }
  [[nodiscard]] bool is_list() const noexcept;
  [[nodiscard]] bool is_quoted() const noexcept;
  /// Atom that is not quoted.
  [[nodiscard]] bool is_word() const noexcept;
  /// Bytes of an atom as they stand in the file, without the quotes; empty for a list.
  [[nodiscard]] std::string_view raw() const noexcept;
  /// An atom's text with its escapes resolved.
  [[nodiscard]] std::string text() const;
  /// First atom of a list, e.g. "via"; empty if there is none.
  [[nodiscard]] std::string_view head() const noexcept;
  /// First item of the list, or absent. Walk with next().
  [[nodiscard]] Sexpr first() const noexcept;
  /// Sibling after this one, or absent.
  [[nodiscard]] Sexpr next() const noexcept;
  /// n-th item after the head, counted from 0, or absent.
  [[nodiscard]] Sexpr arg(std::size_t n) const noexcept;
  /// First sub-list with this head, or absent.
  [[nodiscard]] Sexpr child(std::string_view head) const noexcept;
  /// Whether the list holds this bare word after its head.
  [[nodiscard]] bool has_word(std::string_view word) const noexcept;
  /// 1-based line, 0 if absent. @cost O(log lines).
  [[nodiscard]] std::int64_t line() const noexcept;
  /// Byte offset in the file, 0 if absent.
  [[nodiscard]] std::size_t offset() const noexcept;

  class Iterator;
  /// Items of a list, head included, for range-for.
  [[nodiscard]] Iterator begin() const noexcept;
  [[nodiscard]] Iterator end() const noexcept;

 private:
  friend class SexprTree;
  Sexpr(const SexprTree* tree, std::uint32_t index, std::uint32_t stop) : tree_(tree), index_(index), stop_(stop) {}
  const SexprTree* tree_ = nullptr;
  std::uint32_t index_ = 0;
  std::uint32_t stop_ = 0;  ///< where the parent ends
};

struct SexprOptions {
  /// Words that can only head a list: where one stands as a plain item, the writer forgot its opening bracket, and it
  /// is put back.
  std::span<const std::string_view> words_missing_bracket{};
};

/// Arena tree of one s-expression: lists, words, "strings" with backslash escapes, |base64| blocks, # comment lines.
/// No recursion anywhere: any depth of nesting is taken.
/// @cost 8 bytes per item beside the text; about 100 MB/s.
class SexprTree {
 public:
  /// @throws Error file_truncated (205): empty, or the end comes inside a list or string; file_syntax (202): does not start
  ///               with a bracket, or goes on after the closing one.
  SexprTree(std::string text, std::string file, const SexprOptions& options = {});
  SexprTree(const SexprTree&) = delete;
  SexprTree& operator=(const SexprTree&) = delete;

  [[nodiscard]] Sexpr root() const noexcept { return {this, 0, static_cast<std::uint32_t>(nodes_.size())}; }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] std::size_t num_items() const noexcept { return nodes_.size(); }
  /// Lines where an opening bracket was put back.
  [[nodiscard]] std::span<const std::int64_t> repaired_lines() const noexcept { return repaired_lines_; }

 private:
  friend class Sexpr;
  enum class Kind : std::uint32_t { list = 0, word = 1, quoted = 2 };
  struct Node {
    std::uint32_t begin_and_kind;  ///< byte offset * 4 + kind; offsets stay below 2^30, see max_unpacked_bytes
    std::uint32_t extent;          ///< atom: bytes; list: index of the first node behind it
  };
  struct Parser;
  [[nodiscard]] std::int64_t line_of(std::size_t offset) const noexcept;

  std::string text_;
  std::string file_;
  std::vector<Node> nodes_;  ///< in file order: a list's items follow it at once
  std::vector<std::uint32_t> line_starts_;
  std::vector<std::int64_t> repaired_lines_;
};

class Sexpr::Iterator {
 public:
  explicit Iterator(Sexpr at) : at_(at) {}
  Sexpr operator*() const noexcept { return at_; }
  Iterator& operator++() noexcept {
    at_ = at_.next();
    return *this;
  }
  bool operator!=(const Iterator& other) const noexcept { return static_cast<bool>(at_) != static_cast<bool>(other.at_); }

 private:
  Sexpr at_;
};

inline Sexpr::Iterator Sexpr::begin() const noexcept {
  return Iterator(first());
}
inline Sexpr::Iterator Sexpr::end() const noexcept {
  return Iterator(Sexpr{});
}

}  // namespace pcbmesh::formats::syntax
