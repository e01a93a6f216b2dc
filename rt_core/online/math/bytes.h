#pragma once
#include <cstdint>
#include <cstring>

namespace railstep {

// Numbers in bytes, little-endian on every machine.

inline void put_word(unsigned char* at, std::uint64_t value) noexcept {
  for (int i = 0; i < 8; ++i) at[i] = static_cast<unsigned char>(value >> (8 * i));
}
inline std::uint64_t get_word(const unsigned char* at) noexcept {
  std::uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value |= std::uint64_t{at[i]} << (8 * i);
  return value;
}
inline void put_double(unsigned char* at, double value) noexcept {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_word(at, bits);
}
inline double get_double(const unsigned char* at) noexcept {
  const std::uint64_t bits = get_word(at);
  double value = 0.;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Whether `n` bytes are the same, in a time that does not depend on where they differ.
inline bool same_bytes(const unsigned char* a, const void* b, int n) noexcept {
  int different = 0;
  for (int i = 0; i < n; ++i) different |= a[i] ^ static_cast<const unsigned char*>(b)[i];
  return different == 0;
}

}  // namespace railstep
