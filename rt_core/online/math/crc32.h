#pragma once
#include <cstddef>
#include <cstdint>

namespace railstep {

/// CRC-32 as of IEEE 802.3, zlib and PNG (reflected, 0xEDB88320), of "123456789" 0xCBF43926.
/// @param before  that of the bytes before these, 0 of none
std::uint32_t crc32(const void* bytes, std::size_t count, std::uint32_t before = 0) noexcept;

}  // namespace railstep
