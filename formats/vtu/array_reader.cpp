// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/vtu/array_reader.hpp"

#include <fmt/format.h>
#include <lz4.h>
#include <lzma.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <utility>

namespace pcbmesh::formats::vtu {
namespace {

using syntax::XmlElement;

/// Decodes until the text ends or something is no base64; '=' ends it. Returns the letters used, padding included.
std::size_t decode(std::string_view text, std::string& out) {
  static constexpr std::array<signed char, 256> values = [] {
    std::array<signed char, 256> table{};
    table.fill(-1);
    constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < letters.size(); ++i)
      table[static_cast<unsigned char>(letters[i])] = static_cast<signed char>(i);
    return table;
  }();
  std::size_t at = 0;
  for (; at + 4 <= text.size(); at += 4) {
    std::array<int, 4> v{};
    for (std::size_t i = 0; i < 4; ++i) v[i] = values[static_cast<unsigned char>(text[at + i])];
    if (v[0] < 0 || v[1] < 0) return at;
    out.push_back(static_cast<char>(v[0] << 2 | v[1] >> 4));
    if (v[2] < 0) return text[at + 2] == '=' ? at + 4 : at;
    out.push_back(static_cast<char>((v[1] & 15) << 4 | v[2] >> 2));
    if (v[3] < 0) return text[at + 3] == '=' ? at + 4 : at;
    out.push_back(static_cast<char>((v[2] & 3) << 6 | v[3]));
  }
  return at;
}

std::size_t base64_length(std::size_t bytes) {
  return (bytes + 2) / 3 * 4;
}

std::string without_blanks(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text)
    if (c != ' ' && c != '\n' && c != '\r' && c != '\t') out.push_back(c);
  return out;
}

std::size_t bytes_of_type(std::string_view type) {
  for (const auto& [name, bytes] : {std::pair<std::string_view, std::size_t>{"Int8", 1},
                                    {"UInt8", 1},
                                    {"Int16", 2},
                                    {"UInt16", 2},
                                    {"Int32", 4},
                                    {"UInt32", 4},
                                    {"Int64", 8},
                                    {"UInt64", 8},
                                    {"Float32", 4},
                                    {"Float64", 8}})
    if (type == name) return bytes;
  return 0;
}

template <class Stored, class Value>
void convert(const std::string& bytes, std::vector<Value>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    Stored stored;
    std::memcpy(&stored, bytes.data() + i * sizeof stored, sizeof stored);
    out[i] = static_cast<Value>(stored);
  }
}

/// Most bytes that one packed byte can become.
std::size_t most_unpacked(std::string_view compressor, std::size_t packed) {
  const std::size_t ratio = compressor == "vtkLZ4DataCompressor" ? 256 : compressor == "vtkZLibDataCompressor" ? 1100 : 16384;
  return packed * ratio + 64;
}

}  // namespace

ArrayReader::ArrayReader(std::string_view bytes, const syntax::XmlTree& tree, std::filesystem::path file)
    : bytes_(bytes), file_(std::move(file)), compressor_(tree.root.attribute("compressor")) {
  const XmlElement& root = tree.root;
  if (root.name != "VTKFile" || root.attribute("type") != "UnstructuredGrid")
    fail(root, fmt::format("this is no VTK unstructured grid, but '{} {}'", root.name.substr(0, 40),
                           root.attribute("type").substr(0, 40)));
  if (root.attribute("byte_order") == "BigEndian")
    fail(root, "the file is big-endian and only little-endian files are read; write it again on this machine");
  const std::string_view header = root.attribute("header_type");
  if (!header.empty() && header != "UInt32" && header != "UInt64")
    fail(root, fmt::format("header_type '{}' is neither UInt32 nor UInt64", header.substr(0, 40)));
  if (header == "UInt64") header_bytes_ = 8;
  if (!compressor_.empty() && compressor_ != "vtkZLibDataCompressor" && compressor_ != "vtkLZ4DataCompressor" &&
      compressor_ != "vtkLZMADataCompressor")
    fail(root, fmt::format("compressor '{}' is not known; zlib, LZ4 and LZMA are", compressor_.substr(0, 40)));
  if (tree.stopped_at < 0) return;
  const XmlElement* appended = root.child("AppendedData");
  appended_is_raw_ = appended == nullptr || appended->attribute("encoding") != "base64";
  const std::size_t start = bytes.find('_', static_cast<std::size_t>(tree.stopped_at));
  if (start == std::string_view::npos) fail(root, "the appended data do not start with '_'", ErrorCode::file_truncated);
  appended_ = bytes.substr(start + 1);
}

void ArrayReader::fail(const XmlElement& where, std::string text, ErrorCode code) const {
  const std::string_view name = where.attribute("Name");
  if (!name.empty()) text = fmt::format("array '{}': {}", name.substr(0, 60), text);
  throw Error(code, std::move(text), {.file = file_.string(), .byte = where.byte});
}

std::uint64_t ArrayReader::header_number(std::string_view bytes, std::size_t index) const {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + index * header_bytes_, header_bytes_);
  return value;
}

ArrayReader::Blocks ArrayReader::blocks_of(const XmlElement& array, std::string_view head, std::size_t expected) const {
  Blocks blocks;
  const std::uint64_t count = header_number(head, 0);
  blocks.block_bytes = header_number(head, 1);
  blocks.last_bytes = header_number(head, 2);
  for (std::size_t i = 0; i < count; ++i) blocks.packed.push_back(header_number(head, 3 + i));
  if (blocks.last_bytes == 0) blocks.last_bytes = blocks.block_bytes;  // a full last block
  const bool sound = count == 0 ? expected == 0
                                : blocks.block_bytes <= expected && blocks.last_bytes <= blocks.block_bytes &&
                                      count <= expected / blocks.block_bytes + 1 &&
                                      (count - 1) * blocks.block_bytes + blocks.last_bytes == expected;
  // A mesh smaller than a block announces the block's usual size.
  const bool single = count == 1 && blocks.last_bytes == expected;
  if (!sound && !single)
    fail(array, fmt::format("{} packed blocks of {} bytes, the last one of {}, do not make the {} bytes it must have", count,
                            blocks.block_bytes, blocks.last_bytes, expected));
  if (single) blocks.block_bytes = blocks.last_bytes;
  return blocks;
}

std::string ArrayReader::unpack(const XmlElement& array, const Blocks& blocks, std::string_view packed,
                                std::size_t expected) const {
  std::size_t total = 0;
  for (const std::size_t size : blocks.packed) {
    if (size > packed.size() - total) fail(array, "the file ends inside of its packed blocks", ErrorCode::file_truncated);
    total += size;
  }
  if (expected > most_unpacked(compressor_, total))
    fail(array, fmt::format("{} packed bytes can't become the {} it must have", total, expected));
  std::string out(expected, '\0');
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < blocks.packed.size(); ++i) {
    const std::size_t size = i + 1 == blocks.packed.size() ? blocks.last_bytes : blocks.block_bytes;
    const char* source = packed.data() + from;
    bool good = false;
    if (compressor_ == "vtkLZ4DataCompressor") {
      good = LZ4_decompress_safe(source, out.data() + to, static_cast<int>(blocks.packed[i]), static_cast<int>(size)) ==
             static_cast<int>(size);
    } else if (compressor_ == "vtkZLibDataCompressor") {
      uLongf got = size;
      good = uncompress(reinterpret_cast<Bytef*>(out.data() + to), &got, reinterpret_cast<const Bytef*>(source),
                        blocks.packed[i]) == Z_OK &&
             got == size;
    } else {
      std::uint64_t memory = std::uint64_t{512} << 20;
      std::size_t in = 0, got = 0;
      good =
          lzma_stream_buffer_decode(&memory, 0, nullptr, reinterpret_cast<const std::uint8_t*>(source), &in, blocks.packed[i],
                                    reinterpret_cast<std::uint8_t*>(out.data() + to), &got, size) == LZMA_OK &&
          got == size;
    }
    if (!good) fail(array, fmt::format("packed block {} of {} is damaged", i + 1, blocks.packed.size()));
    from += blocks.packed[i];
    to += size;
  }
  return out;
}

std::string ArrayReader::decode_raw(const XmlElement& array, std::string_view rest, std::size_t expected) const {
  const std::size_t head = (compressor_.empty() ? 1 : 3) * header_bytes_;
  if (rest.size() < head) fail(array, "the file ends in front of it", ErrorCode::file_truncated);
  if (compressor_.empty()) {
    const std::uint64_t size = header_number(rest, 0);
    if (size != expected) fail(array, fmt::format("has {} bytes where {} are expected", size, expected));
    rest.remove_prefix(head);
    if (rest.size() < size)
      fail(array, fmt::format("announces {} bytes, but the file ends after {}", size, rest.size()), ErrorCode::file_truncated);
    return std::string(rest.substr(0, size));
  }
  const std::uint64_t count = header_number(rest, 0);
  if (count > (rest.size() - head) / header_bytes_)
    fail(array, fmt::format("announces {} packed blocks, more than the file can hold", count), ErrorCode::file_truncated);
  const Blocks blocks = blocks_of(array, rest, expected);
  return unpack(array, blocks, rest.substr(head + count * header_bytes_), expected);
}

std::string ArrayReader::decode_base64(const XmlElement& array, std::string_view rest, std::size_t expected) const {
  const auto truncated = [&] { fail(array, "its base64 text ends too early or is damaged", ErrorCode::file_truncated); };
  std::string head;
  const std::size_t head_bytes = (compressor_.empty() ? 1 : 3) * header_bytes_;
  decode(rest.substr(0, base64_length(head_bytes)), head);
  if (head.size() < head_bytes) truncated();
  if (compressor_.empty()) {
    const std::uint64_t size = header_number(head, 0);
    if (size != expected) fail(array, fmt::format("has {} bytes where {} are expected", size, expected));
    // Padding behind the header tells that it was encoded on its own.
    const bool is_split = rest.substr(0, base64_length(head_bytes)).ends_with('=') && expected > 0 && head.size() == head_bytes;
    std::string out;
    const std::size_t skipped = is_split ? 0 : head_bytes;
    if (is_split) rest.remove_prefix(base64_length(head_bytes));
    out.reserve(std::min(rest.size(), skipped + size));
    decode(rest.substr(0, base64_length(skipped + size)), out);
    if (out.size() < skipped + size) truncated();
    return out.substr(skipped, size);
  }
  const std::uint64_t count = header_number(head, 0);
  if (count > rest.size() / header_bytes_)
    fail(array, fmt::format("announces {} packed blocks, more than the file can hold", count), ErrorCode::file_truncated);
  const std::size_t whole_head = head_bytes + count * header_bytes_;
  head.clear();
  decode(rest.substr(0, base64_length(whole_head)), head);
  if (head.size() < whole_head) truncated();
  const Blocks blocks = blocks_of(array, head, expected);
  rest.remove_prefix(std::min(rest.size(), base64_length(whole_head)));
  std::size_t total = 0;
  for (const std::size_t size : blocks.packed) {
    if (size > rest.size()) truncated();
    total += size;
  }
  std::string packed;
  decode(rest.substr(0, base64_length(std::min(total, rest.size()))), packed);
  return unpack(array, blocks, packed, expected);
}

std::string ArrayReader::bytes_of(const XmlElement& array, std::size_t expected) const {
  const std::string_view format = array.attribute("format");
  if (format == "binary") return decode_base64(array, without_blanks(array.text), expected);
  if (format != "appended") fail(array, fmt::format("format '{}' is not known", format.substr(0, 40)));
  const std::string_view text = array.attribute("offset");
  std::uint64_t offset = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), offset);
  if (error != std::errc() || end == text.data()) fail(array, "has no sensible offset");
  if (offset > appended_.size()) fail(array, "starts behind the end of the file", ErrorCode::file_truncated);
  const std::string_view rest = appended_.substr(offset);
  return appended_is_raw_ ? decode_raw(array, rest, expected) : decode_base64(array, rest, expected);
}

template <class Value>
std::vector<Value> ArrayReader::text_values(const XmlElement& array, std::int64_t expected) const {
  std::vector<Value> out;
  // A value needs a digit and a blank: no more are made than the text can hold.
  out.reserve(std::min(static_cast<std::size_t>(expected), array.text.size() / 2 + 1));
  const char* at = array.text.data();
  const char* const end = at + array.text.size();
  while (true) {
    while (at != end && (*at == ' ' || *at == '\n' || *at == '\r' || *at == '\t')) ++at;
    if (at == end) break;
    if (*at == '+') ++at;
    Value value{};
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) fail(array, fmt::format("value {} is no number in range", out.size()));
    out.push_back(value);
    at = next;
    if (out.size() > static_cast<std::size_t>(expected)) break;
  }
  if (out.size() != static_cast<std::size_t>(expected))
    fail(array, fmt::format("has {} values where {} are expected", out.size(), expected), ErrorCode::file_truncated);
  return out;
}

template <class Value>
std::vector<Value> ArrayReader::values(const XmlElement& array, std::int64_t expected) const {
  const std::string_view type = array.attribute("type"), format = array.attribute("format");
  const std::size_t bytes_each = bytes_of_type(type);
  if (bytes_each == 0) fail(array, fmt::format("type '{}' is not known", type.substr(0, 40)));
  // The least a value can take in the file: one bit, if well packed.
  if (expected < 0 || static_cast<std::uint64_t>(expected) / 16384 > bytes_.size())
    fail(array, fmt::format("{} values are announced, more than the file can hold", expected), ErrorCode::file_truncated);
  if (format == "ascii" || format.empty()) return text_values<Value>(array, expected);
  const std::string bytes = bytes_of(array, static_cast<std::size_t>(expected) * bytes_each);
  std::vector<Value> out(static_cast<std::size_t>(expected));
  if (type == "Float64") convert<double>(bytes, out);
  if (type == "Float32") convert<float>(bytes, out);
  if (type == "Int64" || type == "UInt64") convert<std::int64_t>(bytes, out);
  if (type == "Int32") convert<std::int32_t>(bytes, out);
  if (type == "UInt32") convert<std::uint32_t>(bytes, out);
  if (type == "Int16") convert<std::int16_t>(bytes, out);
  if (type == "UInt16") convert<std::uint16_t>(bytes, out);
  if (type == "Int8") convert<std::int8_t>(bytes, out);
  if (type == "UInt8") convert<std::uint8_t>(bytes, out);
  return out;
}

std::vector<std::int64_t> ArrayReader::integers(const XmlElement& array, std::int64_t expected) const {
  if (array.attribute("type").starts_with("Float")) fail(array, "holds real numbers where integers are expected");
  return values<std::int64_t>(array, expected);
}

std::vector<double> ArrayReader::reals(const XmlElement& array, std::int64_t expected) const {
  return values<double>(array, expected);
}

}  // namespace pcbmesh::formats::vtu
