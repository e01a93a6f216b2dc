#include "online/model/state.h"

#include <cstring>
#include <initializer_list>

namespace railstep {

namespace {

std::uint64_t mix(std::uint64_t hash, std::uint64_t word) noexcept {
  for (int byte = 0; byte < 8; ++byte) {
    hash ^= (word >> (8 * byte)) & 0xffu;
    hash *= 0x100000001b3u;
  }
  return hash;
}

}  // namespace

std::uint64_t state_hash(const Model& model, const State& state) noexcept {
  std::uint64_t hash = mix(0xcbf29ce484222325u, static_cast<std::uint64_t>(state.steps));
  for (const double* field : {state.u, state.v, state.a, state.g})
    for (std::int32_t i = 0; i < model.unknowns; ++i) {
      std::uint64_t word = 0;
      std::memcpy(&word, field + i, sizeof word);
      hash = mix(hash, word);
    }
  return hash;
}

}  // namespace railstep
