// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/syntax/sexpr.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::syntax {

struct SexprTree::Parser {
  SexprTree& tree;
  const SexprOptions& options;
  std::string_view text;
  std::size_t at = 0;
  std::vector<std::uint32_t> open{};
  bool head_wanted = false;   ///< the last thing seen was an opening bracket
  bool at_line_start = true;  ///< only blanks since the line began

  [[noreturn]] void fail(ErrorCode code, std::size_t offset, std::string what) const {
    throw Error(code, std::move(what), Spot{.file = tree.file_, .line = tree.line_of(offset)});
  }

  static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\0' || c == '\f' || c == '\v';
  }
  static bool ends_word(char c) { return is_blank(c) || c == '(' || c == ')' || c == '"'; }

  void find_lines() {
    tree.line_starts_.push_back(0);
    const char* const data = text.data();
    for (const char* p = data;
         (p = static_cast<const char*>(std::memchr(p, '\n', text.size() - static_cast<std::size_t>(p - data)))) != nullptr; ++p)
      tree.line_starts_.push_back(static_cast<std::uint32_t>(p - data + 1));
  }

  void add(std::size_t offset, Kind kind, std::size_t length) {
    tree.nodes_.push_back(
        {static_cast<std::uint32_t>(offset * 4) + static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(length)});
  }

  void open_list(std::size_t offset) {
    open.push_back(static_cast<std::uint32_t>(tree.nodes_.size()));
    add(offset, Kind::list, 0);
    head_wanted = true;
  }

  void close_list() {
    tree.nodes_[open.back()].extent = static_cast<std::uint32_t>(tree.nodes_.size());
    open.pop_back();
    head_wanted = false;
  }

  void take_string() {
    const std::size_t begin = ++at;
    for (;; ++at) {
      at = text.find_first_of("\"\\", at);
      if (at == std::string_view::npos)
        fail(ErrorCode::file_truncated, begin - 1, "the file ends inside the string that starts here");
      if (text[at] == '"') break;
      ++at;  // escaped character
    }
    add(begin, Kind::quoted, at - begin);
    ++at;
    head_wanted = false;
  }

  void take_block() {
    const std::size_t begin = at, close = text.find('|', at + 1);
    if (close == std::string_view::npos)
      fail(ErrorCode::file_truncated, begin, "the file ends inside the |data| that starts here");
    at = close + 1;
    add(begin, Kind::word, at - begin);
    head_wanted = false;
  }

  void take_word() {
    const std::size_t begin = at;
    while (at < text.size() && !ends_word(text[at])) ++at;
    const std::string_view word = text.substr(begin, at - begin);
    if (!head_wanted && std::find(options.words_missing_bracket.begin(), options.words_missing_bracket.end(), word) !=
                            options.words_missing_bracket.end()) {
      tree.repaired_lines_.push_back(tree.line_of(begin));
      open_list(begin);
    }
    add(begin, Kind::word, word.size());
    head_wanted = false;
  }

  void skip_blanks() {
    while (at < text.size() && is_blank(text[at])) {
      if (text[at] == '\n') at_line_start = true;
      ++at;
    }
    if (at < text.size() && text[at] == '#' && at_line_start) {
      at = std::min(text.find('\n', at), text.size());
      skip_more = true;
    }
  }
  bool skip_more = false;

  void run() {
    find_lines();
    tree.nodes_.reserve(text.size() / 6);
    if (text.substr(0, 3) == "\xEF\xBB\xBF") at = 3;
    for (;;) {
      do {
        skip_more = false;
        skip_blanks();
      } while (skip_more);
      if (at >= text.size()) break;
      at_line_start = false;
      const char c = text[at];
      if (open.empty()) {
        if (!tree.nodes_.empty())
          fail(ErrorCode::file_syntax, at,
               "text after the closing bracket of the whole file: a ')' too many stands before this line");
        if (c != '(') fail(ErrorCode::file_syntax, at, "expected '(' at the start: this is no s-expression file");
      }
      if (c == '(') {
        open_list(at++);
      } else if (c == ')') {
        close_list();
        ++at;
      } else if (c == '"') {
        take_string();
      } else if (c == '|') {
        take_block();
      } else {
        take_word();
      }
    }
    if (tree.nodes_.empty()) fail(ErrorCode::file_truncated, 0, "the file is empty");
    if (!open.empty()) {
      const Sexpr inside{&tree, open.back(), static_cast<std::uint32_t>(tree.nodes_.size())};
      tree.nodes_[open.back()].extent = static_cast<std::uint32_t>(tree.nodes_.size());
      fail(ErrorCode::file_truncated, tree.nodes_[open.back()].begin_and_kind / 4,
           fmt::format("the file ends before the list '({}' that starts here is closed ({} lists are open); copy or save the "
                       "board again",
                       inside.head().substr(0, 40), open.size()));
    }
  }
};

SexprTree::SexprTree(std::string text, std::string file, const SexprOptions& options)
    : text_(std::move(text)), file_(std::move(file)) {
  if (text_.size() >= (std::size_t{1} << 30))
    throw Error(ErrorCode::file_unreadable, "the file is larger than 1 GiB", Spot{.file = file_});
  Parser{*this, options, text_}.run();
}

std::int64_t SexprTree::line_of(std::size_t offset) const noexcept {
  return std::upper_bound(line_starts_.begin(), line_starts_.end(), offset) - line_starts_.begin();
}

namespace {
constexpr std::uint32_t kind_mask = 3;
}

bool Sexpr::is_list() const noexcept {
  return tree_ != nullptr &&
         (tree_->nodes_[index_].begin_and_kind & kind_mask) == static_cast<std::uint32_t>(SexprTree::Kind::list);
}

bool Sexpr::is_quoted() const noexcept {
  return tree_ != nullptr &&
         (tree_->nodes_[index_].begin_and_kind & kind_mask) == static_cast<std::uint32_t>(SexprTree::Kind::quoted);
}

bool Sexpr::is_word() const noexcept {
  return tree_ != nullptr &&
         (tree_->nodes_[index_].begin_and_kind & kind_mask) == static_cast<std::uint32_t>(SexprTree::Kind::word);
}

std::string_view Sexpr::raw() const noexcept {
  if (tree_ == nullptr || is_list()) return {};
  const SexprTree::Node& node = tree_->nodes_[index_];
  return std::string_view(tree_->text_).substr(node.begin_and_kind / 4, node.extent);
}

std::string Sexpr::text() const {
  const std::string_view bytes = raw();
  if (!is_quoted() || bytes.find('\\') == std::string_view::npos) return std::string(bytes);
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != '\\' || i + 1 == bytes.size()) {
      out += bytes[i];
      continue;
    }
    const char c = bytes[++i];
    out += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c;
  }
  return out;
}

Sexpr Sexpr::first() const noexcept {
  if (!is_list()) return {};
  const std::uint32_t stop = tree_->nodes_[index_].extent;
  return index_ + 1 < stop ? Sexpr{tree_, index_ + 1, stop} : Sexpr{};
}

Sexpr Sexpr::next() const noexcept {
  if (tree_ == nullptr) return {};
  const std::uint32_t behind = is_list() ? tree_->nodes_[index_].extent : index_ + 1;
  return behind < stop_ ? Sexpr{tree_, behind, stop_} : Sexpr{};
}

std::string_view Sexpr::head() const noexcept {
  return first().raw();
}

Sexpr Sexpr::arg(std::size_t n) const noexcept {
  Sexpr item = first().next();
  for (; n > 0 && item; --n) item = item.next();
  return item;
}

Sexpr Sexpr::child(std::string_view head) const noexcept {
  for (Sexpr item = first(); item; item = item.next())
    if (item.is_list() && item.head() == head) return item;
  return {};
}

bool Sexpr::has_word(std::string_view word) const noexcept {
  for (Sexpr item = first().next(); item; item = item.next())
    if (item.is_word() && item.raw() == word) return true;
  return false;
}

std::int64_t Sexpr::line() const noexcept {
  return tree_ == nullptr ? 0 : tree_->line_of(offset());
}

std::size_t Sexpr::offset() const noexcept {
  return tree_ == nullptr ? 0 : tree_->nodes_[index_].begin_and_kind / 4;
}

}  // namespace pcbmesh::formats::syntax
