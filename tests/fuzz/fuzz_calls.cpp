// Any order of calls of the C interface: a byte chooses the next call, the bytes after it its
// arguments. Pointers have the sizes that the header requires. Their content comes from the input:
// invalid blocks, memory that is too small or misaligned, indices out of range, names without an
// end, snapshots of other models, runs that have not begun.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <vector>

#include "bases.h"
#include "online/interface/railstep.h"
#include "oracle.h"
#include "patch.h"
#include "run/heap_count.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

constexpr std::size_t kSlots = 3;
constexpr std::uint32_t kKnownBits = 2 * RAILSTEP_BEYOND_PROFILE - 1;

/// A model and a run in their own memory; either may be missing.
struct Slot {
  std::vector<std::byte> block;
  std::vector<double> model_memory, run_memory;
  const railstep_model* model = nullptr;
  railstep_run* run = nullptr;
};

/// Everything that calls have made so far.
class Caller {
 public:
  explicit Caller(Bytes& input) : input_(input) {}
  void call();

 private:
  Slot& slot() { return slots_[input_.byte() % kSlots]; }
  void load(Slot& to);
  void start(Slot& on);
  void name(const Slot& of);
  void find(const Slot& of);
  void save(Slot& from);
  void restore(Slot& to);
  void step(Slot& on);
  void respond(Slot& on);
  void read(const Slot& from);
  void texts();
  std::vector<double> inputs(const railstep_model* model);

  Bytes& input_;
  std::array<Slot, kSlots> slots_;
  std::vector<std::uint8_t> snapshot_;
};

/// Loads a block that is good, cut, changed, signed or missing, in memory that may be misaligned.
void Caller::load(Slot& to) {
  const std::uint8_t how = input_.byte();
  to = Slot{};
  to.block = base_block(input_.byte());
  if (how % 8 == 1) to.block.resize(input_.word(2) % (to.block.size() + 1));
  if (how % 8 == 2) apply_patches(input_, {{0, to.block.size()}}, to.block);
  const std::size_t bytes = to.block.size(), shift = how % 8 == 3 ? 1 + how / 32 % 7 : 0;
  to.block.resize(bytes + shift);
  std::memmove(to.block.data() + shift, to.block.data(), bytes);
  const std::size_t room = railstep_model_bytes() - (how % 8 == 4 ? 1 : 0);
  to.model_memory.assign(railstep_model_bytes() / 8 + 2, std::nan(""));
  auto* const memory =
      reinterpret_cast<std::byte*>(to.model_memory.data()) + (how % 8 == 5 ? 4 : 0);
  const std::int32_t result = railstep_load(how % 8 == 6 ? nullptr : to.block.data() + shift,
                                            how % 8 == 6 ? 0 : bytes, memory, room, &to.model);
  check((result == RAILSTEP_OK) == (to.model != nullptr), "a model that was refused, or none");
  check(result != RAILSTEP_OK || how % 8 == 0 || how % 8 == 1 || how % 8 == 2 || how % 8 == 7,
        "a load that had to be refused");
  if (result != RAILSTEP_OK) to = Slot{};
}

void Caller::start(Slot& on) {
  if (on.model == nullptr) return;
  const std::uint8_t how = input_.byte() % 4;
  const std::size_t bytes = railstep_run_bytes(on.model);
  on.run_memory.assign(bytes / 8 + 2, std::nan(""));
  auto* const memory = reinterpret_cast<std::byte*>(on.run_memory.data()) + (how == 1 ? 2 : 0);
  const std::size_t room = how == 2 ? static_cast<std::size_t>(input_.word(2)) % bytes : bytes;
  const std::int32_t result = railstep_start(on.model, memory, room, &on.run);
  check(result == (how == 1   ? RAILSTEP_MISALIGNED
                   : how == 2 ? RAILSTEP_TOO_LITTLE_MEMORY
                              : RAILSTEP_OK),
        "a run in memory that it cannot have, or none in its own");
  check((result == RAILSTEP_OK) == (on.run != nullptr), "a run that was refused, or none");
}

void Caller::name(const Slot& of) {
  if (of.model == nullptr) return;
  const bool is_input = input_.byte() % 2 == 0;
  const auto index = static_cast<std::int32_t>(input_.word(1) - 8);
  const std::size_t room = input_.byte() % 40;
  std::vector<char> text(room);
  const std::size_t length = is_input ? railstep_input_name(of.model, index, text.data(), room)
                                      : railstep_output_name(of.model, index, text.data(), room);
  const std::int32_t count = is_input ? railstep_inputs(of.model) : railstep_outputs(of.model);
  check((length > 0) == (index >= 0 && index < count), "a name of nothing, or none of something");
  check(room == 0 || std::memchr(text.data(), 0, room) != nullptr, "a name without an end");
}

void Caller::find(const Slot& of) {
  if (of.model == nullptr) return;
  std::vector<std::uint8_t> bytes = input_.take(input_.byte() % 32);
  bytes.push_back(0);
  const char* const text = reinterpret_cast<const char*>(bytes.data());
  const std::int32_t in = railstep_find_input(of.model, text);
  const std::int32_t out = railstep_find_output(of.model, text);
  check(in >= -1 && in < railstep_inputs(of.model), "an input that is not there");
  check(out >= -1 && out < railstep_outputs(of.model), "an output that is not there");
}

void Caller::save(Slot& from) {
  if (from.run == nullptr) return;
  snapshot_.assign(railstep_snapshot_bytes(from.model), 0);
  railstep_save(from.run, snapshot_.data());
}

void Caller::restore(Slot& to) {
  if (to.run == nullptr) return;
  const std::uint8_t how = input_.byte() % 4;
  std::vector<std::uint8_t> bytes = snapshot_;
  if (how == 1 && !bytes.empty()) bytes[input_.word(2) % bytes.size()] ^= 1u;
  if (how == 2) bytes.resize(input_.word(2) % (bytes.size() + 1));
  const std::uint64_t before = railstep_hash(to.run);
  const std::int32_t result = railstep_restore(to.run, bytes.data(), bytes.size());
  check(result == RAILSTEP_OK || railstep_hash(to.run) == before,
        "a snapshot that was refused changed the run");
  check(how != 1 || result != RAILSTEP_OK, "a snapshot with a flipped bit is taken");
}

std::vector<double> Caller::inputs(const railstep_model* model) {
  std::vector<double> values(static_cast<std::size_t>(railstep_inputs(model)));
  for (double& value : values) {
    const std::uint64_t bits = input_.word(2) << 48;  // sign, exponent and leading digits
    std::memcpy(&value, &bits, sizeof value);
  }
  return values;
}

void Caller::step(Slot& on) {
  if (on.run == nullptr) return;
  const bool given = input_.byte() % 2 == 0;
  const std::vector<double> values = given ? inputs(on.model) : std::vector<double>{};
  const std::int64_t calls = heap_calls(), before = railstep_steps(on.run);
  const std::uint32_t met = railstep_step(on.run, given ? values.data() : nullptr);
  check(heap_calls() == calls, "a frame took something from the heap");
  check((met & ~kKnownBits) == 0, "a frame met what has no name");
  check(railstep_steps(on.run) > before || (met & RAILSTEP_NONFINITE_STATE) != 0,
        "a frame made no step");
}

void Caller::respond(Slot& on) {
  if (on.run == nullptr || railstep_external_wheels(on.model) == 0) return;
  const std::size_t n = 3 * static_cast<std::size_t>(railstep_external_wheels(on.model));
  std::vector<double> free(n), compliance(n * n);
  const std::vector<double> values = inputs(on.model);
  const std::uint64_t before = railstep_hash(on.run);
  static_cast<void>(railstep_response(on.run, values.data(), free.data(), compliance.data()));
  check(railstep_hash(on.run) == before, "a response changed the run");
}

void Caller::read(const Slot& from) {
  if (from.run == nullptr) return;
  std::vector<double> row(static_cast<std::size_t>(railstep_outputs(from.model)));
  railstep_read(from.run, row.data());
  for (const double value : row) check(std::isfinite(value), "an output is not finite");
  check(railstep_time_s(from.run) >= 0. && railstep_frame_s(from.model) > 0. &&
            railstep_frames(from.model) >= 0,
        "a time below 0");
}

void Caller::texts() {
  const auto value = static_cast<std::uint32_t>(input_.word(4));
  check(railstep_version() == RAILSTEP_VERSION, "another version");
  check(std::strlen(railstep_result_text(static_cast<std::int32_t>(value))) > 0, "no text");
  const bool named = *railstep_status_name(value) != 0, said = *railstep_status_text(value) != 0;
  check(named == said && named == ((value & kKnownBits) != 0), "a status without a name");
}

void Caller::call() {
  const std::uint8_t which = input_.byte();
  if (which % 16 == 12) return texts();
  Slot& on = slot();
  switch (which % 16) {
    case 0:
      return load(on);
    case 1:
      return start(on);
    case 2:
      return name(on);
    case 3:
      return find(on);
    case 4:
      return save(on);
    case 5:
      return restore(on);
    case 6:
      return respond(on);
    case 7:
      return read(on);
    case 8:
      if (on.run != nullptr) railstep_reset(on.run);
      return;
    case 9:
      if (on.run != nullptr)
        check(railstep_self_check(on.run) == RAILSTEP_OK, "a run does not pass its check");
      return;
    default:
      return step(on);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes input(data, size);
  Caller caller(input);
  for (int n = 0; n < 100 && !input.empty(); ++n) caller.call();
  return 0;
}
