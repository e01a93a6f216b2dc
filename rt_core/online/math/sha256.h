#pragma once

#include <cstddef>
#include <cstdint>

namespace railstep {

/// SHA-256 (FIPS 180-4) of bytes in pieces: start, add, ..., finish.
class Sha256 {
 public:
  void add(const void* bytes, std::size_t count) noexcept;
  /// Writes the 32 bytes of the digest and starts again.
  void finish(std::uint8_t* digest) noexcept;

 private:
  static constexpr std::uint32_t kStart[8] = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                              0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  void compress(const std::uint8_t* block) noexcept;

  std::uint32_t hash_[8] = {kStart[0], kStart[1], kStart[2], kStart[3],
                            kStart[4], kStart[5], kStart[6], kStart[7]};
  std::uint64_t length_ = 0;  // bytes so far
  std::uint8_t pending_[64] = {};
};

/// Digest of one block of bytes, 32 bytes.
void sha256(const void* bytes, std::size_t count, std::uint8_t* digest) noexcept;

}  // namespace railstep
