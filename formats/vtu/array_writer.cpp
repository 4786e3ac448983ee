// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtu/array_writer.hpp"

#include <algorithm>
#include <cstring>

#include "formats/sink/block_press.hpp"
#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::vtu {
namespace {

constexpr std::size_t block_bytes = std::size_t{1} << 18;
constexpr std::size_t text_bytes = std::size_t{1} << 15;  // a multiple of every value's size
constexpr std::size_t block_head = 3;                     // number of blocks, size of a block, size of the last one

constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

void encode(const unsigned char* from, char* to) {
  to[0] = letters[from[0] >> 2U];
  to[1] = letters[(from[0] & 3U) << 4U | from[1] >> 4U];
  to[2] = letters[(from[1] & 15U) << 2U | from[2] >> 6U];
  to[3] = letters[from[2] & 63U];
}

template <class Value>
void put_numbers(FileSink& sink, std::span<const char> bytes, std::size_t per_line, std::int64_t& index) {
  for (std::size_t at = 0; at < bytes.size(); at += sizeof(Value)) {
    Value value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    if constexpr (sizeof(Value) == 1)
      sink.put_number(int{value});
    else
      sink.put_number(value);
    sink.put(++index % static_cast<std::int64_t>(per_line) == 0 ? "\n" : " ");
  }
}

std::span<const char> bytes_of(const std::vector<std::uint64_t>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof values[0]};
}

}  // namespace

void Base64::put(std::span<const char> bytes) {
  while (num_rest_ > 0 && num_rest_ < 3 && !bytes.empty()) {
    rest_[num_rest_++] = bytes.front();
    bytes = bytes.subspan(1);
  }
  const auto put_triples = [&](const char* from, std::size_t count) {
    constexpr std::size_t at_once = FileSink::max_room / 4;
    for (; count > 0; count -= std::min(count, at_once)) {
      const std::size_t part = std::min(count, at_once);
      char* to = sink_.room(4 * part);
      for (std::size_t i = 0; i < part; ++i, from += 3, to += 4) encode(reinterpret_cast<const unsigned char*>(from), to);
      sink_.advance(4 * part);
    }
  };
  if (num_rest_ == 3) {
    put_triples(rest_.data(), 1);
    num_rest_ = 0;
  }
  if (num_rest_ > 0) return;
  put_triples(bytes.data(), bytes.size() / 3);
  for (const char byte : bytes.subspan(bytes.size() / 3 * 3)) rest_[num_rest_++] = byte;
}

void Base64::finish() {
  if (num_rest_ == 0) return;
  const std::string text = text_of({rest_.data(), num_rest_});
  sink_.put(text);
  num_rest_ = 0;
}

std::string Base64::text_of(std::span<const char> bytes) {
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::array<unsigned char, 3> three{};
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::memcpy(three.data(), bytes.data() + at, count);
    std::array<char, 4> four{};
    encode(three.data(), four.data());
    for (std::size_t i = count + 1; i < 4; ++i) four[i] = '=';
    text.append(four.data(), four.size());
  }
  return text;
}

void ArrayWriter::put_text(const ArrayHead& head, const FillArray& fill) {
  const std::size_t per_line = head.num_components > 1 ? static_cast<std::size_t>(head.num_components) : 12;
  std::int64_t index = 0;
  BlockedArray out(text_bytes, [&](std::span<const char> bytes) {
    if (head.type == "UInt8") return put_numbers<std::uint8_t>(sink_, bytes, per_line, index);
    if (head.type == "Int32") return put_numbers<std::int32_t>(sink_, bytes, per_line, index);
    if (head.type == "Int64") return put_numbers<std::int64_t>(sink_, bytes, per_line, index);
    if (head.type == "Float32") return put_numbers<float>(sink_, bytes, per_line, index);
    put_numbers<double>(sink_, bytes, per_line, index);
  });
  fill(out);
  out.finish();
  PCBMESH_ASSERT(index == head.num_values);
  sink_.put("\n");
}

ArrayWriter::BlockSizes ArrayWriter::sizes_for(const ArrayHead& head) {
  const std::uint64_t num_blocks = (head.num_bytes() + block_bytes - 1) / block_bytes;
  BlockSizes sizes(block_head + num_blocks, 0);
  sizes[0] = num_blocks;
  sizes[1] = block_bytes;
  sizes[2] = head.num_bytes() % block_bytes;  // 0 if the last block is full
  return sizes;
}

void ArrayWriter::put_packed(const ArrayHead& head, const FillArray& fill,
                             const std::function<void(std::span<const char>)>& take, BlockSizes& sizes) {
  std::size_t next = block_head;
  BlockPress press(
      options_.num_threads,
      [&](std::span<const char> plain, std::vector<char>& packed) {
        options_.compression == Compression::lz4 ? pack_lz4(plain, packed) : pack_zlib(plain, packed);
      },
      [&](std::span<const char> packed) {
        PCBMESH_ASSERT(next < sizes.size());
        sizes[next++] = packed.size();
        take(packed);
      });
  std::uint64_t num_bytes = 0;
  BlockedArray out(block_bytes, [&](std::span<const char> plain) {
    num_bytes += plain.size();
    press.add(plain);
  });
  fill(out);
  out.finish();
  press.finish();
  PCBMESH_ASSERT(next == sizes.size() && num_bytes == head.num_bytes());
}

void ArrayWriter::put_base64(const ArrayHead& head, const FillArray& fill) {
  Base64 text(sink_);
  if (options_.compression == Compression::none) {
    const std::vector<std::uint64_t> size{head.num_bytes()};
    text.put(bytes_of(size));
    BlockedArray out(block_bytes, [&](std::span<const char> bytes) { text.put(bytes); });
    fill(out);
    out.finish();
    text.finish();
  } else {
    BlockSizes sizes = sizes_for(head);
    const std::uint64_t at = sink_.size();
    sink_.put(Base64::text_of(bytes_of(sizes)));
    put_packed(
        head, fill, [&](std::span<const char> packed) { text.put(packed); }, sizes);
    text.finish();
    sink_.overwrite(at, Base64::text_of(bytes_of(sizes)));
  }
  sink_.put("\n");
}

void ArrayWriter::put_appended(const ArrayHead& head, const FillArray& fill) {
  const std::uint64_t at = sink_.size();
  if (options_.compression == Compression::none) {
    sink_.put_raw(head.num_bytes());
    PlainArray out(sink_);
    fill(out);
    PCBMESH_ASSERT(sink_.size() - at == sizeof(std::uint64_t) + head.num_bytes());
    return;
  }
  BlockSizes sizes = sizes_for(head);
  sink_.put({bytes_of(sizes).data(), bytes_of(sizes).size()});
  put_packed(
      head, fill,
      [&](std::span<const char> packed) {
        sink_.put({packed.data(), packed.size()});
      },
      sizes);
  sink_.overwrite(at, {bytes_of(sizes).data(), bytes_of(sizes).size()});
}

}  // namespace pcbmesh::formats::vtu
