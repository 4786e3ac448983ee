// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/sink/file_sink.hpp"

#include <bit>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats {

static_assert(std::endian::native == std::endian::little, "binary formats are written in the machine's byte order");

FileSink::FileSink(const std::filesystem::path& target, std::uint64_t expected_bytes)
    : part_(target, expected_bytes), buffer_(std::make_unique_for_overwrite<char[]>(buffer_size)) {}

void FileSink::put(std::string_view text) {
  if (text.size() > buffer_size - used_) {
    flush();
    if (text.size() >= buffer_size) return write_all(text.data(), text.size());
  }
  std::memcpy(buffer_.get() + used_, text.data(), text.size());
  used_ += text.size();
}

void FileSink::overwrite(std::uint64_t at, std::string_view text) {
  PCBMESH_ASSERT(at + text.size() <= size());
  if (at < written_) flush();
  if (at >= written_)
    std::memcpy(buffer_.get() + (at - written_), text.data(), text.size());
  else
    part_.write_at(at, text.data(), text.size());
}

void FileSink::flush() {
  const std::size_t size = used_;
  used_ = 0;
  write_all(buffer_.get(), size);
}

void FileSink::write_all(const char* bytes, std::size_t size) {
  part_.write_at(written_, bytes, size);
  written_ += size;
}

void FileSink::save() {
  flush();
  part_.save(written_);
}

void FileSink::commit() {
  if (used_ > 0) flush();
  part_.commit(written_);
}

}  // namespace pcbmesh::formats
