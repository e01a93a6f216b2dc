#pragma once
#include <cstring>
#include <vector>

#include "offline/pack/artefact.h"
#include "online/math/sha256.h"
#include "online/model/load_model.h"
#include "online/track/track_sensor.h"
#include "support/condensed_tracks.h"

namespace railstep {

using Block = std::vector<std::byte>;

inline LoadResult read(const Block& block, Model& model) {
  return load_model(block.data(), block.size(), model);
}
inline LoadStatus status_of(const Block& block) {
  Model model;
  return read(block, model).status;
}

inline void put_word(Block& block, std::size_t at, std::int64_t value) {
  std::memcpy(block.data() + at, &value, sizeof value);
}
inline std::int64_t word_of(const Block& block, std::size_t at) {
  std::int64_t value = 0;
  std::memcpy(&value, block.data() + at, sizeof value);
  return value;
}

/// Offset of the payload of a block with a whole header, bytes.
inline std::size_t payload_of(const Block& block) { return header_of(block.data()).header_bytes; }
/// Offset of a section, bytes.
inline std::size_t section_at(const Block& block, SectionName name) {
  return header_of(block.data()).section[name].at;
}

/// Sets size and checksums to those of the block's present content.
inline void sign(Block& block) {
  put_word(block, offsetof(BlockHeader, bytes), static_cast<std::int64_t>(block.size()));
  const std::size_t from = payload_of(block);
  if (from > block.size()) return;
  sha256(block.data() + from, block.size() - from,
         reinterpret_cast<std::uint8_t*>(block.data() + kSumAt));
  put_word(block, kCrcAt, header_crc(reinterpret_cast<const unsigned char*>(block.data()), from));
}

/// A run of a model from its start in memory of its own, with its last outputs and all that a
/// replay needs.
struct LoadedRun {
  const Model& model;
  std::vector<double> memory, scratch, track_sensors;
  State state;
  Workspace workspace;
  Outputs outputs{};

  explicit LoadedRun(const Model& made)
      : model(made),
        memory(static_cast<std::size_t>(state_doubles(made))),
        scratch(static_cast<std::size_t>(workspace_doubles(made))),
        track_sensors(static_cast<std::size_t>(made.track_sensor.count)),
        state(state_on(made, memory.data())),
        workspace(workspace_on(made, scratch.data())) {
    reset(model, state);
    publish_start(model, state, outputs);
    read_track_sensors(model, state, outputs, track_sensors.data());
  }
  Status frames(int count) {
    Status met = Status::ok;
    for (int i = 0; i < count; ++i) {
      met = met | advance_frame(model, state, workspace, outputs);
      read_track_sensors(model, state, outputs, track_sensors.data());
    }
    return met;
  }
};

}  // namespace railstep
