#include "online/math/sha256.h"

#include <cstring>

namespace railstep {
namespace {

/// Fractional parts of the cube roots of the first 64 primes.
constexpr std::uint32_t kRound[64] = {
    0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4, 0xab1c5ed5,
    0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe, 0x9bdc06a7, 0xc19bf174,
    0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f, 0x4a7484aa, 0x5cb0a9dc, 0x76f988da,
    0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7, 0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967,
    0x27b70a85, 0x2e1b2138, 0x4d2c6dfc, 0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85,
    0xa2bfe8a1, 0xa81a664b, 0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070,
    0x19a4c116, 0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
    0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7, 0xc67178f2};

std::uint32_t rotate(std::uint32_t x, int by) noexcept { return (x >> by) | (x << (32 - by)); }

}  // namespace

void Sha256::compress(const std::uint8_t* block) noexcept {
  std::uint32_t w[64];
  for (int i = 0; i < 16; ++i)
    w[i] = static_cast<std::uint32_t>(block[4 * i]) << 24 |
           static_cast<std::uint32_t>(block[4 * i + 1]) << 16 |
           static_cast<std::uint32_t>(block[4 * i + 2]) << 8 | block[4 * i + 3];
  for (int i = 16; i < 64; ++i) {
    const std::uint32_t a = w[i - 15], b = w[i - 2];
    w[i] = w[i - 16] + (rotate(a, 7) ^ rotate(a, 18) ^ (a >> 3)) + w[i - 7] +
           (rotate(b, 17) ^ rotate(b, 19) ^ (b >> 10));
  }
  std::uint32_t v[8];
  for (int i = 0; i < 8; ++i) v[i] = hash_[i];
  for (int i = 0; i < 64; ++i) {
    const std::uint32_t choose = (v[4] & v[5]) ^ (~v[4] & v[6]);
    const std::uint32_t majority = (v[0] & v[1]) ^ (v[0] & v[2]) ^ (v[1] & v[2]);
    const std::uint32_t first =
        v[7] + (rotate(v[4], 6) ^ rotate(v[4], 11) ^ rotate(v[4], 25)) + choose + kRound[i] + w[i];
    const std::uint32_t second = (rotate(v[0], 2) ^ rotate(v[0], 13) ^ rotate(v[0], 22)) + majority;
    for (int k = 7; k > 0; --k) v[k] = v[k - 1];
    v[4] += first;
    v[0] = first + second;
  }
  for (int i = 0; i < 8; ++i) hash_[i] += v[i];
}

void Sha256::add(const void* bytes, std::size_t count) noexcept {
  const auto* from = static_cast<const std::uint8_t*>(bytes);
  auto filled = static_cast<std::size_t>(length_ % 64);
  length_ += count;
  while (count > 0) {
    if (filled == 0 && count >= 64) {
      compress(from);
      from += 64;
      count -= 64;
      continue;
    }
    const std::size_t part = count < 64 - filled ? count : 64 - filled;
    std::memcpy(pending_ + filled, from, part);
    filled += part;
    from += part;
    count -= part;
    if (filled == 64) {
      compress(pending_);
      filled = 0;
    }
  }
}

void Sha256::finish(std::uint8_t* digest) noexcept {
  // One bit, zeros up to 56 bytes past a block, then the length in bits, high byte first.
  const std::uint64_t bits = length_ * 8;
  std::uint8_t tail[72] = {0x80};
  const auto zeros = static_cast<std::size_t>((119 - length_ % 64) % 64);
  for (int i = 0; i < 8; ++i)
    tail[1 + zeros + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(bits >> (56 - 8 * i));
  add(tail, zeros + 9);
  for (int i = 0; i < 32; ++i)
    digest[i] = static_cast<std::uint8_t>(hash_[i / 4] >> (24 - 8 * (i % 4)));
  *this = Sha256{};
}

void sha256(const void* bytes, std::size_t count, std::uint8_t* digest) noexcept {
  Sha256 hash;
  hash.add(bytes, count);
  hash.finish(digest);
}

}  // namespace railstep
