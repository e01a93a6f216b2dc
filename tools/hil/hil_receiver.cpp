#include "hil/hil_receiver.h"

#include <algorithm>

namespace railstep {

bool Receiver::take(std::span<const unsigned char> bytes, std::uint64_t sender, std::int64_t now,
                    std::int64_t begun, double* values) noexcept {
  const bool open = !started_ || now - last_good_ >= kPeerSilence;
  const auto head = decode(bytes, PacketKind::inputs, names_, count_, kept_.data());
  // One number far ahead, forged or not, would shut out all that follow and count them as lost.
  const bool strange = started_ && (sender != sender_ || (head && head->sequence > newest_ &&
                                                          head->sequence - newest_ > kMostAhead));
  if (!head || head->sequence > kMostSequence || (!open && strange)) {
    ++counts_.foreign;
    return false;
  }
  if (open && (strange || head->sequence <= newest_)) started_ = false;
  if (!follows(head->sequence)) return false;
  sender_ = sender;
  last_good_ = now;
  ++counts_.good;
  if (head->frame >= 0 && head->frame <= begun) ++counts_.late;
  std::copy(kept_.begin(), kept_.end(), values);
  return true;
}

/// Whether a sequence number is newer than all before it; counts it otherwise.
bool Receiver::follows(std::uint64_t sequence) noexcept {
  if (!started_) {
    started_ = true;
    first_ = newest_ = sequence;
    seen_ = 1;
    return true;
  }
  if (sequence > newest_) {
    const std::uint64_t step = sequence - newest_;
    counts_.lost += static_cast<std::int64_t>(step - 1);
    seen_ = step < kMemory ? (seen_ << step) | 1 : 1;
    newest_ = sequence;
    return true;
  }
  const std::uint64_t back = newest_ - sequence;
  if (back >= kMemory || (seen_ >> back & 1) != 0) {
    ++counts_.repeated;
    return false;
  }
  seen_ |= std::uint64_t{1} << back;
  ++counts_.reordered;
  if (sequence > first_) --counts_.lost;  // what went out before the first was never counted
  return false;
}

}  // namespace railstep
