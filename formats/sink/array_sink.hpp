// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <span>

#include "formats/sink/file_sink.hpp"

namespace pcbmesh::formats {

/// Takes the bytes of one array, in order, in pieces of any size.
class ArraySink {
 public:
  virtual ~ArraySink() = default;
  ArraySink(const ArraySink&) = delete;
  ArraySink& operator=(const ArraySink&) = delete;

  /// Contiguous room for `size` bytes, at most max_piece, to be filled by the caller, who then calls advance().
  [[nodiscard]] virtual char* room(std::size_t size) = 0;
  virtual void advance(std::size_t size) = 0;
  /// Call when all is there.
  virtual void finish() = 0;
  template <class Value>
  void put(Value value) {
    std::memcpy(room(sizeof value), &value, sizeof value);
    advance(sizeof value);
  }

  static constexpr std::size_t max_piece = std::size_t{64} * 1024;

 protected:
  ArraySink() = default;
};

/// Straight into a file.
class PlainArray final : public ArraySink {
 public:
  explicit PlainArray(FileSink& sink) : sink_(sink) {}
  [[nodiscard]] char* room(std::size_t size) override { return sink_.room(size); }
  void advance(std::size_t size) override { sink_.advance(size); }
  void finish() override {}

 private:
  FileSink& sink_;
};

/// Cuts the array into blocks of one size, the last one shorter.
class BlockedArray final : public ArraySink {
 public:
  using TakeBlock = std::function<void(std::span<const char> block)>;
  BlockedArray(std::size_t block_size, TakeBlock take)
      : block_size_(block_size),
        take_(std::move(take)),
        buffer_(std::make_unique_for_overwrite<char[]>(block_size + max_piece)) {}
  [[nodiscard]] char* room(std::size_t) override { return buffer_.get() + used_; }
  void advance(std::size_t size) override {
    used_ += size;
    if (used_ >= block_size_) hand_over();
  }
  void finish() override {
    if (used_ > 0) take_({buffer_.get(), used_});
    used_ = 0;
  }

 private:
  void hand_over() {
    std::size_t at = 0;
    for (; used_ - at >= block_size_; at += block_size_) take_({buffer_.get() + at, block_size_});
    std::memmove(buffer_.get(), buffer_.get() + at, used_ - at);
    used_ -= at;
  }

  std::size_t block_size_;
  TakeBlock take_;
  std::unique_ptr<char[]> buffer_;
  std::size_t used_ = 0;
};

}  // namespace pcbmesh::formats
