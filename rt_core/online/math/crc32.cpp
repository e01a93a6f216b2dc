#include "online/math/crc32.h"

namespace railstep {

namespace {

struct Table {
  std::uint32_t of[256];
};

constexpr Table make_table() noexcept {
  Table table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t sum = byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1) ^ ((sum & 1u) != 0u ? 0xEDB88320u : 0u);
    table.of[byte] = sum;
  }
  return table;
}
constexpr Table kTable = make_table();

}  // namespace

std::uint32_t crc32(const void* bytes, std::size_t count, std::uint32_t before) noexcept {
  const auto* const at = static_cast<const unsigned char*>(bytes);
  std::uint32_t sum = ~before;
  for (std::size_t i = 0; i < count; ++i) sum = (sum >> 8) ^ kTable.of[(sum ^ at[i]) & 255u];
  return ~sum;
}

}  // namespace railstep
