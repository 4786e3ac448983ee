// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/sink/block_press.hpp"

#include <lz4.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats {
namespace {

/// Blocks packed at a time: the same for any number of threads, or two arrays that are written side by side would lie in the
/// file in another order.
constexpr std::size_t blocks_at_once = 4;

}  // namespace

BlockPress::BlockPress(int num_threads, Pack pack, Take take)
    : pack_(std::move(pack)),
      take_(std::move(take)),
      num_threads_(static_cast<std::size_t>(std::max(num_threads, 1))),
      blocks_(blocks_at_once) {}

void BlockPress::add(std::span<const char> plain) {
  blocks_[num_waiting_++].plain.assign(plain.begin(), plain.end());
  if (num_waiting_ == blocks_.size()) finish();
}

void BlockPress::finish() {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> failures(num_threads_);
  const auto work = [&](std::size_t worker) {
    try {
      for (std::size_t i = next++; i < num_waiting_; i = next++) pack_(blocks_[i].plain, blocks_[i].packed);
    } catch (...) {
      failures[worker] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t worker = 1; worker < std::min(num_threads_, num_waiting_); ++worker) threads.emplace_back(work, worker);
    work(0);
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  for (std::size_t i = 0; i < num_waiting_; ++i) take_(blocks_[i].packed);
  num_waiting_ = 0;
}

void pack_zlib(std::span<const char> plain, std::vector<char>& packed, int level) {
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  packed.resize(size);
  const int result = compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(plain.data()),
                               static_cast<uLong>(plain.size()), level);
  PCBMESH_ASSERT(result == Z_OK);
  packed.resize(size);
}

void pack_lz4(std::span<const char> plain, std::vector<char>& packed) {
  const int size = static_cast<int>(plain.size());
  packed.resize(static_cast<std::size_t>(LZ4_compressBound(size)));
  const int used = LZ4_compress_default(plain.data(), packed.data(), size, static_cast<int>(packed.size()));
  PCBMESH_ASSERT(used > 0);
  packed.resize(static_cast<std::size_t>(used));
}

void shuffle(std::span<const char> plain, std::size_t value_size, std::vector<char>& shuffled) {
  shuffled.resize(plain.size());
  const std::size_t count = plain.size() / value_size;
  for (std::size_t byte = 0; byte < value_size; ++byte) {
    const char* from = plain.data() + byte;
    char* to = shuffled.data() + byte * count;
    for (std::size_t i = 0; i < count; ++i, from += value_size) to[i] = *from;
  }
}

}  // namespace pcbmesh::formats
