#include "online/model/block.h"

#include "online/math/crc32.h"

namespace railstep {

std::uint32_t header_crc(const unsigned char* block, std::size_t header_bytes) noexcept {
  constexpr unsigned char kNone[8] = {};
  const std::uint32_t before = crc32(kNone, sizeof kNone, crc32(block, kCrcAt));
  return crc32(block + sizeof(BlockHeader), header_bytes - sizeof(BlockHeader), before);
}

}  // namespace railstep
