#include "patch.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>
#include <limits>

#include "online/math/sha256.h"
#include "online/model/block.h"

namespace railstep::fuzz {
namespace {

constexpr std::size_t kMostPatches = 64;

void put_word(std::vector<std::byte>& bytes, std::size_t at, std::uint64_t value) {
  if (at + 8 <= bytes.size()) std::memcpy(bytes.data() + at, &value, 8);
}

std::uint64_t special(std::uint64_t which) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kValues[] = {0.,    -0.,        1.,     -1.,
                                1e300, -1e300,     1e-12,  kInfinite,
                                1e150, 1e-300,     1e9,    std::numeric_limits<double>::quiet_NaN(),
                                .5,    -kInfinite, 1e-320, 1e18};
  return std::bit_cast<std::uint64_t>(kValues[which % std::size(kValues)]);
}

std::uint64_t changed(std::uint64_t old, std::uint8_t kind, std::uint64_t value) {
  switch (kind % 6) {
    case 0:
      return value;
    case 1:
      return old + static_cast<std::uint64_t>(static_cast<std::int64_t>(value % 17) - 8);
    case 2:
      return old ^ (std::uint64_t{1} << (value % 64));
    case 3:
      return special(value);
    case 4:
      return std::bit_cast<std::uint64_t>(-std::bit_cast<double>(old));
    default:
      return value % 64;
  }
}

template <typename T>
void patch(std::byte* at, std::uint8_t kind, std::uint64_t value) {
  T word = 0;
  std::memcpy(&word, at, sizeof word);
  word = static_cast<T>(changed(word, kind, value));
  std::memcpy(at, &word, sizeof word);
}

}  // namespace

std::uint64_t Bytes::word(std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes && left_ > 0; ++i, --left_)
    value |= std::uint64_t{*at_++} << (8 * i);
  return value;
}

std::vector<std::uint8_t> Bytes::take(std::size_t bytes) {
  const std::size_t kept = std::min(bytes, left_);
  std::vector<std::uint8_t> taken(at_, at_ + kept);
  at_ += kept;
  left_ -= kept;
  return taken;
}

void apply_patches(Bytes& input, const std::vector<Room>& rooms, std::vector<std::byte>& bytes) {
  for (std::size_t i = 0; i < kMostPatches && !input.empty(); ++i) {
    const std::uint8_t kind = input.byte();
    const auto where = static_cast<std::size_t>(input.word(3));
    const std::uint64_t value = input.word(8);
    const Room& room = rooms[kind / 12 % rooms.size()];
    const bool wide = kind / 6 % 2 == 0;
    const std::size_t width = wide ? 8 : 4;
    if (room.bytes < width) continue;
    std::byte* const at = bytes.data() + room.from + width * (where % (room.bytes / width));
    if (wide)
      patch<std::uint64_t>(at, kind, value);
    else
      patch<std::uint32_t>(at, kind, value);
  }
}

namespace {

std::size_t header_bytes_of(const std::vector<std::byte>& block) {
  std::uint32_t bytes = 0;
  std::memcpy(&bytes, block.data() + offsetof(BlockHeader, header_bytes), sizeof bytes);
  return bytes;
}

}  // namespace

void sign_block(std::vector<std::byte>& block) {
  if (block.size() < sizeof(BlockHeader)) return;
  put_word(block, offsetof(BlockHeader, bytes), block.size());
  const std::size_t from = header_bytes_of(block);
  if (from < sizeof(BlockHeader) || from > block.size()) return;
  sha256(block.data() + from, block.size() - from,
         reinterpret_cast<std::uint8_t*>(block.data() + kSumAt));
  put_word(block, kCrcAt, 0);
  put_word(block, kCrcAt, header_crc(reinterpret_cast<const unsigned char*>(block.data()), from));
}

void sign_tail(std::vector<std::byte>& bytes) {
  if (bytes.size() < 64) return;
  put_word(bytes, 16, bytes.size());
  const std::size_t body = bytes.size() - 32;
  sha256(bytes.data(), body, reinterpret_cast<std::uint8_t*>(bytes.data() + body));
}

}  // namespace railstep::fuzz
