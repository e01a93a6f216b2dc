#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace railstep::fuzz {

/// Reads an input piece by piece; after its end every byte is 0.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : at_(data), left_(size) {}
  bool empty() const { return left_ == 0; }
  std::size_t left() const { return left_; }
  /// A little-endian number of 1 to 8 bytes.
  std::uint64_t word(std::size_t bytes);
  std::uint8_t byte() { return static_cast<std::uint8_t>(word(1)); }
  /// The next `bytes`, or as many as are left.
  std::vector<std::uint8_t> take(std::size_t bytes);

 private:
  const std::uint8_t* at_;
  std::size_t left_;
};

/// Part of a block that a patch changes.
struct Room {
  std::size_t from, bytes;
};

/// Applies the patches that are left in an input to good bytes, up to 64 of them. A patch has 12
/// bytes: kind, place (3), value (8). By kind a word of 8 or 4 bytes is replaced, moved a little,
/// flipped in one bit or made a special number.
/// @param rooms  where patches may go; the kind chooses one
void apply_patches(Bytes& input, const std::vector<Room>& rooms, std::vector<std::byte>& bytes);

/// Sets the size and the sums of a block to those of its bytes.
void sign_block(std::vector<std::byte>& block);
/// Corrects the size at byte 16 and the SHA-256 at the end of a snapshot or a recording.
void sign_tail(std::vector<std::byte>& bytes);

}  // namespace railstep::fuzz
