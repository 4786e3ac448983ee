// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace pcbmesh::formats {

/// Packs blocks in several threads and hands them on in their order: the result is the same for any number of threads.
class BlockPress {
 public:
  /// Packs one block; called from several threads.
  using Pack = std::function<void(std::span<const char> plain, std::vector<char>& packed)>;
  using Take = std::function<void(std::span<const char> packed)>;
  BlockPress(int num_threads, Pack pack, Take take);
  void add(std::span<const char> plain);
  /// Packs and hands on what waits.
  void finish();

 private:
  struct Block {
    std::vector<char> plain, packed;
  };
  Pack pack_;
  Take take_;
  std::size_t num_threads_;
  std::vector<Block> blocks_;
  std::size_t num_waiting_ = 0;
};

/// zlib stream. @param level  1 (fast) to 9.
void pack_zlib(std::span<const char> plain, std::vector<char>& packed, int level = 1);
/// LZ4 block without frame.
void pack_lz4(std::span<const char> plain, std::vector<char>& packed);
/// First bytes of all values, then second bytes ...: neighbouring numbers pack better so.
void shuffle(std::span<const char> plain, std::size_t value_size, std::vector<char>& shuffled);

}  // namespace pcbmesh::formats
