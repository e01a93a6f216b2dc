#pragma once
#include <cstddef>
#include <cstdint>

namespace railstep {

/// CRC-32 of IEEE 802.3, zlib and PNG (reflected, 0xEDB88320); "123456789" gives 0xCBF43926.
/// @param before  CRC of the bytes before these; 0 without any
std::uint32_t crc32(const void* bytes, std::size_t count, std::uint32_t before = 0) noexcept;

}  // namespace railstep
