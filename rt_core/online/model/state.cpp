#include "online/model/state.h"

#include <cstring>

#include "online/math/tiny.h"

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

State copied_state(const Model& model, const State& from, double* memory) noexcept {
  State to = state_on(model, memory);
  std::memcpy(to.numbers, from.numbers,
              sizeof(double) * static_cast<std::size_t>(state_doubles(model)));
  to.steps = from.steps;
  return to;
}

void reset(const Model& model, State& state) noexcept {
  state.steps = 0;
  state.latched = Status::ok;
  const std::int64_t given = start_doubles(model), all = state_doubles(model);
  for (std::int64_t i = 0; i < given; ++i) state.numbers[i] = without_tiny(model.start[i]);
  for (std::int64_t i = given; i < all; ++i) state.numbers[i] = 0.;
}

std::uint64_t state_hash(const Model& model, const State& state) noexcept {
  std::uint64_t hash = mix(0xcbf29ce484222325u, static_cast<std::uint64_t>(state.steps));
  hash = mix(hash, static_cast<std::uint64_t>(state.latched));
  const std::int64_t count = state_doubles(model);
  for (std::int64_t i = 0; i < count; ++i) {
    std::uint64_t word = 0;
    std::memcpy(&word, state.numbers + i, sizeof word);
    hash = mix(hash, word);
  }
  return hash;
}

}  // namespace railstep
