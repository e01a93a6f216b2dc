#include "offline/pack/artefact.h"

#include <cstring>
#include <stdexcept>

#include "online/math/sha256.h"
#include "online/model/describe.h"
#include "online/model/load.h"

namespace railstep {

namespace {

class Writer {
 public:
  explicit Writer(std::vector<std::byte>& block) : block_(block) {}

  void count(std::int32_t& value, std::int64_t most) {
    if (value < 0 || value > most)
      throw std::invalid_argument("a model too large to be written: " + std::to_string(value) +
                                  " of something of which " + std::to_string(most) +
                                  " are accepted");
    word(value);
  }
  void integer(std::int64_t value) { word(value); }
  void real(double value) {
    std::int64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    word(bits);
  }
  void reals(const double* values, std::int64_t n) { array(values, n, sizeof(double)); }
  void integers(const std::int32_t* values, std::int64_t n) {
    array(values, n, sizeof(std::int32_t));
  }
  template <typename T>
  void structures(const T* values, std::int64_t n) {
    array(values, n, sizeof(T));
  }
  void text(const std::string& text) {
    word(static_cast<std::int64_t>(text.size()));
    bytes(text.data(), text.size());
  }

 private:
  void word(std::int64_t value) { bytes(&value, sizeof value); }
  void array(const void* values, std::int64_t n, std::size_t size) {
    if (values == nullptr) n = 0;
    word(n);
    if (n > 0) bytes(values, static_cast<std::size_t>(n) * size);
  }
  /// Padded to 8 bytes.
  void bytes(const void* from, std::size_t count) {
    const auto* at = static_cast<const std::byte*>(from);
    block_.insert(block_.end(), at, at + count);
    block_.resize((block_.size() + 7) / 8 * 8);
  }

  std::vector<std::byte>& block_;
};

void put(std::vector<std::byte>& block, std::size_t at, std::int64_t value) {
  std::memcpy(block.data() + at, &value, sizeof value);
}

constexpr std::size_t kSum = 24, kCovered = 56;  // where the sum stands, and what it covers from

}  // namespace

std::vector<std::byte> to_block(const Model& model, const std::string& text) {
  std::vector<std::byte> block(kCovered);
  Writer writer(block);
  writer.text(text);
  Model copy = model;  // describe() also reads into one
  describe(writer, copy);
  describe_start(writer, copy);
  std::memcpy(block.data(), "railstep", 8);
  put(block, 8, kBlockFormat);
  put(block, 16, static_cast<std::int64_t>(block.size()));
  sha256(block.data() + kCovered, block.size() - kCovered,
         reinterpret_cast<std::uint8_t*>(block.data() + kSum));
  return block;
}

std::string sum_of(const std::vector<std::byte>& block) {
  static const char* const digits = "0123456789abcdef";
  std::string text;
  for (std::size_t i = kSum; i < kSum + 32; ++i) {
    text += digits[std::to_integer<int>(block[i]) >> 4];
    text += digits[std::to_integer<int>(block[i]) & 15];
  }
  return text;
}

}  // namespace railstep
