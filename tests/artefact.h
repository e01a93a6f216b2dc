#pragma once
#include <cstring>
#include <vector>

#include "condensed.h"
#include "offline/pack/artefact.h"
#include "online/math/sha256.h"
#include "online/model/load.h"
#include "online/step/probe.h"

namespace railstep {

using Block = std::vector<std::byte>;

inline constexpr std::size_t kSumAt = 24, kSummedFrom = 56, kModelFrom = 64;  // bytes of a block

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

/// Makes size and sum those of the block as it stands.
inline void sign(Block& block) {
  put_word(block, 16, static_cast<std::int64_t>(block.size()));
  sha256(block.data() + kSummedFrom, block.size() - kSummedFrom,
         reinterpret_cast<std::uint8_t*>(block.data() + kSumAt));
}

/// A model of memory's own, from its start; what it published last, and all that a replay needs.
struct LoadedRun {
  const Model& model;
  std::vector<double> memory, scratch, probes;
  State state;
  Workspace workspace;
  Outputs outputs{};

  explicit LoadedRun(const Model& made)
      : model(made),
        memory(static_cast<std::size_t>(state_doubles(made))),
        scratch(static_cast<std::size_t>(workspace_doubles(made))),
        probes(static_cast<std::size_t>(made.probe.count)),
        state(state_on(made, memory.data())),
        workspace(workspace_on(made, scratch.data())) {
    reset(model, state);
    publish_start(model, state, outputs);
    read_probes(model, state, outputs, probes.data());
  }
  Status frames(int count) {
    Status met = Status::ok;
    for (int i = 0; i < count; ++i) {
      met = met | advance_frame(model, state, workspace, outputs);
      read_probes(model, state, outputs, probes.data());
    }
    return met;
  }
};

}  // namespace railstep
