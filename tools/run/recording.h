#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "run/simulation.h"

namespace railstep {

/// A run that can be made again: the model, the state from which it began, what every frame was
/// given, and the state's hash every few frames. In a file, little-endian, from the first byte:
///   8 bytes "railreco", int64 format, int64 bytes of the whole, int64 frames, int64 inputs, int64
///   frames from one hash to the next, int64 bytes of the model's block, int64 bytes of the
///   snapshot, the block, the snapshot (model/snapshot.h), [frames][inputs] doubles, uint64
///   hashes after frames `every`, 2 `every`, ... and after the last one, 32 bytes SHA-256 of all
///   before.
struct Recording {
  std::int64_t every = 1;
  std::int64_t frames = 0;
  std::vector<std::byte> block, snapshot;
  std::vector<double> inputs;         // [frames][inputs of the model]
  std::vector<std::uint64_t> hashes;  // [hash_count()]

  /// Begins one at a simulation's state.
  static Recording begin(const Simulation& run, std::int64_t every);
  /// A frame that was made. @param given  [inputs], or null without inputs
  void frame(const Simulation& run, const double* given);
  /// Call it after the last frame.
  void finish(const Simulation& run);

  std::vector<std::byte> bytes() const;
  /// Throws InputError naming the file for a file that is not a whole recording.
  static Recording read(const std::filesystem::path& file);

  /// Number of hashes for a number of frames.
  std::int64_t hash_count() const { return (frames + every - 1) / every; }
  /// The frame after which the n-th hash was taken.
  std::int64_t hashed_frame(std::int64_t n) const {
    return (n + 1) * every < frames ? (n + 1) * every : frames;
  }
};

/// A frame after which the repeated run has another state.
struct ReplayDifference {
  std::int64_t frame;  // from 1; it or one before it, back to the last hash that agreed
  std::uint64_t recorded, found;
};

/// Makes the run again and compares all hashes.
/// @returns no difference where all agree; else the first one
struct Replay {
  bool identical;
  ReplayDifference first;
};
Replay replay(const Recording& recording, const std::string& name);

}  // namespace railstep
