#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "hil/hil_packet.h"

namespace railstep {

/// Counts of the packets with inputs. Every one that came is good, repeated, reordered or foreign;
/// late ones are among the good.
struct PacketCounts {
  std::int64_t good = 0;       // newer than all before: taken
  std::int64_t late = 0;       // taken, but meant for a frame that had begun
  std::int64_t lost = 0;       // sequence numbers passed over that did not come yet
  std::int64_t repeated = 0;   // came before, or so far behind the newest that no one can tell
  std::int64_t reordered = 0;  // came behind a newer one: not taken, and not lost either
  std::int64_t foreign = 0;    // short, long, damaged, of another kind, version, model or sender
};

/// Tells new packets from others: the newest wins. A sender that starts its sequence numbers again
/// or far ahead, and another sender, is taken after kPeerSilence without a good packet.
class Receiver {
 public:
  static constexpr std::int64_t kPeerSilence = 1'000'000'000;  // ns
  static constexpr std::uint64_t kMemory = 64;                 // packets behind the newest
  static constexpr std::uint64_t kMostSequence = 1ULL << 48;   // beyond: foreign
  static constexpr std::uint64_t kMostAhead = 1'000'000;  // of the newest; beyond: not its like

  /// @param names, count  of the model's inputs
  Receiver(std::uint32_t names, std::uint32_t count) : names_(names), count_(count), kept_(count) {}

  /// @param sender  a number of its own for each sender
  /// @param now     ns, of any clock that does not go back
  /// @param begun   the newest frame that has begun, -1 before the first
  /// @param values  [count] overwritten where the packet is taken
  /// @returns whether it is taken
  bool take(std::span<const unsigned char> bytes, std::uint64_t sender, std::int64_t now,
            std::int64_t begun, double* values) noexcept;

  const PacketCounts& counts() const noexcept { return counts_; }

 private:
  bool follows(std::uint64_t sequence) noexcept;

  std::uint32_t names_, count_;
  std::vector<double> kept_;  // of a packet that is whole, but perhaps not the newest
  PacketCounts counts_;
  bool started_ = false;
  std::uint64_t sender_ = 0, first_ = 0, newest_ = 0;
  std::uint64_t seen_ = 0;  // bit k: newest - k came
  std::int64_t last_good_ = 0;
};

}  // namespace railstep
