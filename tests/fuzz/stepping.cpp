#include "stepping.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "online/model/block.h"
#include "online/model/load_model.h"
#include "online/model/snapshot.h"
#include "oracle.h"
#include "run/heap_count.h"

namespace railstep::fuzz {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kKnownBits = 2 * RAILSTEP_BEYOND_PROFILE - 1;
constexpr std::uint64_t kMostState = std::uint64_t{1} << 16;  // bytes: some thousand unknowns
constexpr double kMostWork = 5e6;                             // bytes of state times steps

/// Inputs of the n-th frame: none, small, and every kind that a frame has to correct.
std::vector<double> inputs_of(std::size_t count, int n) {
  constexpr double kValues[] = {0., 1., -1e3, 2.5, 1e300, -kNan, 5e-324, -1e9};
  std::vector<double> inputs(count);
  for (std::size_t i = 0; i < count; ++i)
    inputs[i] = kValues[(i + static_cast<std::size_t>(n)) % std::size(kValues)];
  return inputs;
}

bool are_finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double x) { return std::isfinite(x); });
}

/// Checks that the response under external wheels changes no state and is finite or says it is not.
void check_response(Held& held) {
  const std::size_t n = 3 * static_cast<std::size_t>(railstep_external_wheels(held.model()));
  if (n == 0) return;
  const auto inputs = inputs_of(static_cast<std::size_t>(railstep_inputs(held.model())), 1);
  std::vector<double> free(n), compliance(n * n);
  const std::uint64_t before = railstep_hash(held.run());
  const std::uint32_t met =
      railstep_response(held.run(), inputs.data(), free.data(), compliance.data());
  check(railstep_hash(held.run()) == before, "a response changed the run");
  check((met & ~kKnownBits) == 0, "a response met what has no name");
  if ((met & RAILSTEP_NONFINITE_STATE) != 0) return;
  check(are_finite(free.data(), n) && are_finite(compliance.data(), n * n),
        "a response is not finite and does not say so");
}

struct Ran {
  std::uint64_t hash;
  std::uint32_t met;
  std::vector<double> rows;
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), 8 * a.size()) == 0;
}

Ran run_on(Held& held, int from) {
  Ran ran{0, 0, {}};
  for (int n = from; n < kFrames; ++n) {
    ran.met |= held.frame(n);
    const std::vector<double> row = held.row();
    ran.rows.insert(ran.rows.end(), row.begin(), row.end());
  }
  ran.hash = railstep_hash(held.run());
  return ran;
}

/// Checks that names are found at their own index.
void check_names(const railstep_model* model) {
  char name[64];
  check(railstep_input_name(model, -1, name, sizeof name) == 0, "an input before the first");
  check(railstep_output_name(model, railstep_outputs(model), name, sizeof name) == 0,
        "an output behind the last");
  for (std::int32_t i = 0; i < std::min(railstep_outputs(model), 8); ++i) {
    const std::size_t length = railstep_output_name(model, i, name, sizeof name);
    if (length == 0 || length >= sizeof name || std::strlen(name) != length) continue;
    const std::int32_t found = railstep_find_output(model, name);
    check(found >= 0 && found <= i, "an output is not found by its name");
  }
}

}  // namespace

Held::Held(const std::vector<std::byte>& block, bool own)
    : block_(&block), model_memory_(railstep_model_bytes() / 8 + 1, kNan) {
  loaded_ = railstep_load(block.data(), block.size(), model_memory_.data(), railstep_model_bytes(),
                          &model_);
  check((loaded_ == RAILSTEP_OK) == (model_ != nullptr), "a model that was refused, or none");
  check(loaded_ >= RAILSTEP_OK && loaded_ <= RAILSTEP_OTHER_BITS, "a result without a name");
  Model same{};
  if (loaded_ != RAILSTEP_OK ||
      load_model(block.data(), block.size(), same).status != LoadStatus::ok)
    return;
  watched_ = static_cast<std::size_t>(own ? state_doubles(same) : 2 * std::int64_t{same.unknowns});
}

bool Held::small() const {
  const BlockHeader header = header_of(block_->data());
  const double steps = static_cast<double>(header.steps_per_frame) *
                       static_cast<double>(std::max<std::int64_t>(header.check_frames, kFrames));
  return railstep_snapshot_bytes(model_) <= kMostState &&
         railstep_run_bytes(model_) <= 32 * kMostState &&
         static_cast<double>(railstep_snapshot_bytes(model_)) * steps <= kMostWork;
}

void Held::start() {
  const std::size_t bytes = railstep_run_bytes(model_);
  run_memory_.assign(bytes / 8 + 1, kNan);
  check(railstep_start(model_, run_memory_.data(), bytes - 1, &run_) == RAILSTEP_TOO_LITTLE_MEMORY,
        "a run in too little memory");
  check(railstep_start(model_, run_memory_.data(), bytes, &run_) == RAILSTEP_OK, "no run");
}

std::uint32_t Held::frame(int n) {
  const auto inputs = inputs_of(static_cast<std::size_t>(railstep_inputs(model_)), n);
  const std::int64_t calls = heap_calls(), steps = railstep_steps(run_);
  const std::uint32_t met = railstep_step(run_, n % 3 == 0 ? nullptr : inputs.data());
  check(heap_calls() == calls, "a frame took something from the heap");
  check(railstep_steps(run_) >= steps, "a frame went back");
  check_state(met);
  return met;
}

void Held::check_state(std::uint32_t met) const {
  check((met & ~kKnownBits) == 0, "a frame met what has no name");
  if ((met & RAILSTEP_NONFINITE_STATE) != 0) return;
  const std::vector<double> outputs = row();
  check(are_finite(outputs.data(), outputs.size()), "an output is not finite, unsaid");
  const std::vector<std::uint8_t> bytes = saved();
  std::vector<double> state(watched_);
  std::memcpy(state.data(), bytes.data() + kSnapshotHead, 8 * state.size());
  check(are_finite(state.data(), state.size()), "a state is not finite, unsaid");
}

std::vector<double> Held::row() const {
  std::vector<double> outputs(static_cast<std::size_t>(railstep_outputs(model_)));
  railstep_read(run_, outputs.data());
  return outputs;
}

std::vector<std::uint8_t> Held::saved() const {
  std::vector<std::uint8_t> bytes(railstep_snapshot_bytes(model_));
  railstep_save(run_, bytes.data());
  return bytes;
}

std::int32_t Held::restore(const std::vector<std::uint8_t>& snapshot) {
  return railstep_restore(run_, snapshot.data(), snapshot.size());
}

bool step_block(const std::vector<std::byte>& block, bool own) {
  Held first(block, own);
  if (first.loaded() != RAILSTEP_OK) return false;
  check_names(first.model());
  if (!first.small()) return true;
  first.start();
  const std::int32_t checked = railstep_self_check(first.run());
  check(checked == RAILSTEP_OK || (!own && checked == RAILSTEP_OTHER_BITS),
        "a model of this program does not pass its own check");
  Held other(block, own);
  other.start();
  check(railstep_hash(first.run()) == railstep_hash(other.run()), "two starts differ");
  for (int n = 0; n < kFrames / 2; ++n) static_cast<void>(first.frame(n));
  const std::vector<std::uint8_t> half = first.saved();
  const Ran once = run_on(first, kFrames / 2);
  check(other.restore(half) == RAILSTEP_OK, "a snapshot is not taken back");
  check(other.saved() == half, "a snapshot comes back with other bytes");
  const Ran again = run_on(other, kFrames / 2);
  check(once.hash == again.hash && once.met == again.met, "a run made twice has other bits");
  const bool lost = (once.met & RAILSTEP_NONFINITE_STATE) != 0;  // then a row may be older
  check(lost || same_bits(once.rows, again.rows), "a run made twice has other outputs");
  check_response(first);
  return true;
}

}  // namespace railstep::fuzz
