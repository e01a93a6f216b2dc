#pragma once
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "support/block_fields.h"

namespace railstep {

/// Offset of a random word of a block's content, or of the next word that may be a count.
inline std::size_t some_word(const Block& block, std::mt19937_64& random) {
  const std::size_t from = payload_of(block), words = (block.size() - from) / 8;
  std::size_t at = from + 8 * static_cast<std::size_t>(random() % words);
  if (random() % 2 == 0) return at;
  while (at + 16 <= block.size() && (word_of(block, at) < 1 || word_of(block, at) > 100'000))
    at += 8;
  return at;
}

inline std::int64_t some_value(std::int64_t old, std::mt19937_64& random) {
  const auto bits = [](double x) {
    std::int64_t word = 0;
    std::memcpy(&word, &x, sizeof word);
    return word;
  };
  switch (random() % 10) {
    case 0:
      return static_cast<std::int64_t>(random());
    case 1:
      return old ^ (std::int64_t{1} << (random() % 63));
    case 2:
      return static_cast<std::int64_t>(random() % 64);
    case 3:
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(old) + 1u);
    case 4:
      return static_cast<std::int64_t>(static_cast<std::uint64_t>(old) - 1u);
    case 5:
      return -1;
    case 6:
      return std::numeric_limits<std::int64_t>::max();
    case 7:
      return bits(std::numeric_limits<double>::quiet_NaN());
    case 8:
      return bits(1e300);
    default:
      return bits(-std::numeric_limits<double>::infinity());
  }
}

/// The block with one to four words changed, and right size and checksums.
inline Block mutated(Block block, std::mt19937_64& random) {
  for (std::uint64_t i = 0, n = 1 + random() % 4; i < n; ++i) {
    const std::size_t at = some_word(block, random);
    put_word(block, at, some_value(word_of(block, at), random));
  }
  sign(block);
  return block;
}

/// The block with one integer of 4 bytes changed to a small number or a neighbour, and right size
/// and checksums. Structures and index tables are made of such integers.
inline Block with_other_integer(Block block, std::mt19937_64& random) {
  const std::size_t from = payload_of(block), integers = (block.size() - from) / 4;
  const std::size_t at = from + 4 * static_cast<std::size_t>(random() % integers);
  std::int32_t value = 0;
  std::memcpy(&value, block.data() + at, sizeof value);
  switch (random() % 6) {
    case 0:
      value = static_cast<std::int32_t>(random() % 64);
      break;
    case 1:
      value = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) + 1u);
      break;
    case 2:
      value = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) - 1u);
      break;
    case 3:
      value = -static_cast<std::int32_t>(random() % 64);
      break;
    case 4:
      value = std::numeric_limits<std::int32_t>::max();
      break;
    default:
      value = static_cast<std::int32_t>(random());
  }
  std::memcpy(block.data() + at, &value, sizeof value);
  sign(block);
  return block;
}

}  // namespace railstep
