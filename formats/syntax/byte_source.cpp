// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/syntax/byte_source.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <charconv>
#include <limits>
#include <system_error>
#include <utility>

#include "formats/syntax/input_file.hpp"

namespace pcbmesh::formats::syntax {
namespace {

static_assert(std::endian::native == std::endian::little, "values are taken as they stand in the file");

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

bool is_packed(std::string_view head) {
  using namespace std::string_view_literals;
  return head.starts_with("\x1F\x8B"sv) || head.starts_with("\xFD\x37zXZ\0"sv);
}

/// Text that is safe to show: what a damaged file holds may be anything.
std::string shown(std::string_view word) {
  std::string out;
  for (const char c : word.substr(0, 40)) out += c >= 0x20 && c < 0x7F ? c : '?';
  return word.size() > 40 ? out + "..." : out;
}

}  // namespace

ByteSource::ByteSource(const std::filesystem::path& file) : file_(file) {
  const auto unreadable = [&](int why) {
    throw Error(ErrorCode::file_unreadable, "can't be read: " + std::generic_category().message(why), {.file = file.string()});
  };
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0) unreadable(errno);
  try {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) unreadable(errno);
    if (S_ISDIR(status.st_mode)) unreadable(EISDIR);
    size_ = static_cast<std::int64_t>(status.st_size);
    window_.resize(window_size);
    static_cast<void>(fill_window());
    const bool packed = is_packed({window_.data(), window_end_});
    const auto name = file.extension();
    if (packed || !S_ISREG(status.st_mode) || name == ".gz" || name == ".xz") {
      const std::string bytes = syntax::read_whole_file(file);
      window_.assign(bytes.begin(), bytes.end());
      window_end_ = window_.size();
      size_ = static_cast<std::int64_t>(bytes.size());
      ::close(std::exchange(descriptor_, -1));
    }
  } catch (...) {
    if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
    throw;
  }
}

ByteSource::~ByteSource() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

/// Moves what is left to the front and reads more behind it; false at the end of the file.
bool ByteSource::fill_window() {
  if (descriptor_ < 0) return false;
  std::memmove(window_.data(), window_.data() + at_, window_end_ - at_);
  window_start_ += static_cast<std::int64_t>(at_);
  window_end_ -= at_;
  at_ = 0;
  if (window_end_ == window_.size()) return false;
  while (true) {
    const ssize_t count = ::read(descriptor_, window_.data() + window_end_, window_.size() - window_end_);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail("can't be read: " + std::generic_category().message(errno), ErrorCode::file_unreadable);
    window_end_ += static_cast<std::size_t>(count);
    return count > 0;
  }
}

void ByteSource::refill(std::size_t count) {
  while (window_end_ - at_ < count)
    if (!fill_window()) fail_truncated();
}

bool ByteSource::skip_blanks() {
  while (true) {
    for (; at_ < window_end_; ++at_) {
      if (!is_blank(window_[at_])) return true;
      line_ += window_[at_] == '\n' ? 1 : 0;
    }
    if (!fill_window()) return false;
  }
}

std::string_view ByteSource::word() {
  if (!skip_blanks()) fail_truncated();
  std::size_t length = 0;
  while (true) {
    while (at_ + length < window_end_ && !is_blank(window_[at_ + length])) ++length;
    if (length > longest_line) fail("a word of the file has no end; this is no text");
    if (at_ + length < window_end_ || !fill_window()) break;
  }
  at_ += length;
  return {window_.data() + at_ - length, length};
}

std::string_view ByteSource::line() {
  std::size_t length = 0;
  while (true) {
    while (at_ + length < window_end_ && window_[at_ + length] != '\n') ++length;
    if (length > longest_line) fail("a line of the file has no end; this is no text");
    if (at_ + length < window_end_) break;
    if (!fill_window()) {
      if (length == 0) fail_truncated();
      break;
    }
  }
  std::string_view text(window_.data() + at_, length);
  const bool has_end = at_ + length < window_end_;
  at_ += length + (has_end ? 1 : 0);
  line_ += has_end ? 1 : 0;
  if (text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

void ByteSource::end_line() {
  const std::string_view rest = line();
  if (rest.find_first_not_of(" \t") != std::string_view::npos)
    fail(fmt::format("'{}' was not expected in this line", shown(rest)));
}

void ByteSource::skip_past(std::string_view marker) {
  char before = '\n';
  while (true) {
    require(marker.size());
    const std::string_view rest(window_.data() + at_, window_end_ - at_);
    if (before == '\n' && rest.starts_with(marker)) break;
    const std::size_t dollar = rest.find('$', 1);
    // Without a marker in sight all but a possible start of one can go.
    const std::size_t step = dollar != std::string_view::npos ? dollar : rest.size();
    for (const char c : rest.substr(0, step)) line_ += c == '\n' ? 1 : 0;
    before = rest[step - 1];
    at_ += step;
  }
  at_ += marker.size();
}

void ByteSource::enter(std::string section, bool as_text) {
  section_ = std::move(section);
  as_text_ = as_text;
}

void ByteSource::fail(std::string text, ErrorCode code) const {
  Spot spot{.file = file_.string()};
  if (as_text_)
    spot.line = line_;
  else
    spot.byte = offset();
  if (!section_.empty()) text = fmt::format("in {}: {}", section_, text);
  throw Error(code, std::move(text), std::move(spot));
}

void ByteSource::fail_truncated() const {
  fail(fmt::format("the file ends too early, after {} bytes; write or copy it again", size_), ErrorCode::file_truncated);
}

namespace {

template <class T>
T number_of(const ByteSource& source, std::string_view word, const char* what) {
  T value{};
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_whole = end == word.data() + word.size() && !word.empty();
  if (error == std::errc() && is_whole) return value;
  source.fail(fmt::format("'{}' is no {}{}", shown(word), what, error == std::errc::result_out_of_range ? " in range" : ""));
}

}  // namespace

std::int32_t Numbers::integer() {
  return binary_ ? source_->raw<std::int32_t>() : number_of<std::int32_t>(*source_, source_->word(), "integer");
}

std::int64_t Numbers::size() {
  if (!binary_) return number_of<std::int64_t>(*source_, source_->word(), "integer");
  const auto value = source_->raw<std::uint64_t>();
  if (value > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    source_->fail(fmt::format("{} is no sensible count or id", value));
  return static_cast<std::int64_t>(value);
}

double Numbers::real() {
  return binary_ ? source_->raw<double>() : number_of<double>(*source_, source_->word(), "number");
}

std::int64_t Numbers::count(std::int64_t bytes, std::int64_t letters, std::string_view what) {
  return justified(size(), bytes, letters, what);
}

std::int64_t Numbers::justified(std::int64_t count, std::int64_t bytes, std::int64_t letters, std::string_view what) const {
  if (count < 0) source_->fail(fmt::format("{} {} are announced", count, what));
  // The last item of a text needs no blank behind it.
  const std::int64_t each = binary_ ? bytes : letters, room = source_->remaining() + (binary_ ? 0 : 1);
  if (count > room / each)
    source_->fail(fmt::format("{} {} are announced, but the {} bytes that follow can't hold them; the count is wrong or the "
                              "file was cut off",
                              count, what, source_->remaining()),
                  ErrorCode::file_truncated);
  return count;
}

}  // namespace pcbmesh::formats::syntax
