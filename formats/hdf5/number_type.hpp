// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace pcbmesh::formats::hdf5 {

/// Numbers as they stand in a file, little-endian.
enum class NumberType { uint8, uint16, int32, int64, float32, float64 };

[[nodiscard]] constexpr std::size_t size_of(NumberType type) {
  constexpr std::size_t sizes[] = {1, 2, 4, 8, 4, 8};
  return sizes[static_cast<int>(type)];
}

template <class Value>
[[nodiscard]] constexpr NumberType number_type() {
  if constexpr (std::is_same_v<Value, std::uint8_t>) return NumberType::uint8;
  if constexpr (std::is_same_v<Value, std::uint16_t>) return NumberType::uint16;
  if constexpr (std::is_same_v<Value, std::int32_t>) return NumberType::int32;
  if constexpr (std::is_same_v<Value, std::int64_t>) return NumberType::int64;
  if constexpr (std::is_same_v<Value, float>) return NumberType::float32;
  static_assert(std::is_integral_v<Value> || std::is_floating_point_v<Value>);
  if constexpr (std::is_same_v<Value, double>) return NumberType::float64;
}

}  // namespace pcbmesh::formats::hdf5
