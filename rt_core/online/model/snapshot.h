#pragma once
#include <cstddef>

#include "online/model/state.h"

namespace railstep {

enum class SnapshotStatus : std::uint8_t {
  ok,
  not_a_snapshot,  // it does not begin as a snapshot does
  other_version,   // of the format
  wrong_size,      // too short, too long, or of a model with another number of unknowns
  wrong_sum,       // its bytes are not the ones that were written
  other_model,     // it was taken of another model
  bad_content,     // steps below 0 or above 2^53, status bits that do not stay set, a kept matrix
                   // that cannot be solved with
};

/// A state in bytes, the same on every machine; numbers are little-endian, from the first byte:
///   8 bytes "railsnap", int64 format, int64 bytes of the whole, 32 bytes Model::sum, int64 steps,
///   uint64 latched status, int64 count, `count` doubles of the state, 32 bytes SHA-256
///   of all before.
inline constexpr std::int64_t kSnapshotFormat = 1;
inline constexpr std::size_t kSnapshotHead = 8 + 8 + 8 + 32 + 8 + 8 + 8;
inline constexpr std::size_t kSnapshotSum = 32;

inline std::size_t snapshot_bytes(const Model& model) noexcept {
  return kSnapshotHead + sizeof(double) * static_cast<std::size_t>(state_doubles(model)) +
         kSnapshotSum;
}

/// Writes any state, also with numbers that are not finite. No heap.
/// @param bytes  [snapshot_bytes(model)]
void save_snapshot(const Model& model, const State& state, unsigned char* bytes) noexcept;

/// Restores a state of the same model to the bit. The state changes only if all bytes are as they
/// were written. No heap.
[[nodiscard]] SnapshotStatus restore_snapshot(const Model& model, const void* bytes,
                                              std::size_t count, State& state) noexcept;

}  // namespace railstep
