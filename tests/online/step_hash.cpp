// Steps a model file and prints the hashes of its state and outputs. They must depend neither on
// the host's floating-point mode, nor on the workspace's old content, nor on the kernels that the
// processor has chosen. Needs only the online library, so it runs wherever that does.
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "online/beam/kernels.h"
#include "online/math/float_mode.h"
#include "online/model/load_model.h"
#include "online/model/state.h"
#include "online/step/self_check.h"
#include "online/step/step.h"
#include "online/system/sensor.h"
#include "online/track/track_sensor.h"

using namespace railstep;

namespace {

using Word = FloatMode::Word;

#if defined(__SSE2__)
void set_mode(Word word) { _mm_setcsr(word); }
// MXCSR: rounding to nearest, down, up, towards zero, each with FTZ and DAZ on and off; FTZ alone,
// DAZ alone; every trap on; all sticky flags raised.
constexpr Word kModes[] = {0x1f80, 0x9fc0, 0x3f80, 0xbfc0, 0x5f80, 0xdfc0,
                           0x7f80, 0xffc0, 0x9f80, 0x1fc0, 0x0000, 0x7fff};
#else
void set_mode(Word word) { asm volatile("msr fpcr, %0" : : "r"(word) : "memory"); }
// FPCR: rounding to nearest, up, down, towards zero, each with FZ on and off; NaNs without payload;
// every trap on.
constexpr Word kModes[] = {0x0,       0x1000000, 0x400000,  0x1400000, 0x800000,
                           0x1800000, 0xc00000,  0x1c00000, 0x2000000, 0x9f00};
#endif
constexpr std::size_t kModeCount = sizeof kModes / sizeof *kModes;

/// FNV-1a, as state_hash().
class Hash {
 public:
  void add(const void* at, std::size_t bytes) {
    const auto* const from = static_cast<const unsigned char*>(at);
    for (std::size_t i = 0; i < bytes; ++i) value_ = (value_ ^ from[i]) * 0x100000001b3u;
  }
  template <typename T>
  void add(const T* at, std::int32_t count) {
    if (count > 0) add(static_cast<const void*>(at), sizeof(T) * static_cast<std::size_t>(count));
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

std::vector<double> doubles(std::int64_t count, double value) {
  return std::vector<double>(static_cast<std::size_t>(count), value);
}

/// One run of a model in a host's floating-point modes, which change from call to call.
class Run {
 public:
  Run(const Model& model, std::size_t modes)
      : model_(model),
        memory_(doubles(state_doubles(model), 0.)),
        scratch_(doubles(workspace_doubles(model), 0.)),
        track_sensors_(doubles(model.track_sensor.count, 0.)),
        state_(state_on(model, memory_.data())),
        workspace_(workspace_on(model, scratch_.data())),
        modes_(modes) {
    check_inputs(model, input_);
    reset(model, state_);
    called([&] { publish_start(model_, state_, outputs_); });
    publish();
    was_closed_ = closed();
  }

  void frame() {
    // All bits set is a NaN that no arithmetic makes, so it is the same in every mode.
    if (!scratch_.empty()) std::memset(scratch_.data(), 0xff, sizeof(double) * scratch_.size());
    called(
        [&] { status_ = status_ | advance_frame(model_, input_, state_, workspace_, outputs_); });
    publish();
    const std::vector<bool> now = closed();
    for (std::size_t i = 0; i < now.size(); ++i) {
      opened_ += was_closed_[i] && !now[i] ? 1 : 0;
      closed_ += !was_closed_[i] && now[i] ? 1 : 0;
    }
    was_closed_ = now;
  }

  std::uint64_t state() const { return state_hash(model_, state_); }
  std::uint64_t outputs() const { return published_.value(); }
  int opened() const { return opened_; }
  int closings() const { return closed_; }
  Status status() const { return status_; }
  bool kept_mode() const { return kept_mode_; }

 private:
  /// Makes a call in the next of the host's modes, which must stay as it was, flags included.
  template <typename Call>
  void called(const Call& call) {
    const Word own = FloatMode::read();
    set_mode(kModes[calls_++ % modes_]);
    const Word before = FloatMode::read();  // a machine may lack some of its bits
    call();
    const Word after = FloatMode::read();
    set_mode(own);
    kept_mode_ = kept_mode_ && after == before;
  }

  void publish() {
    const Outputs& o = outputs_;
    published_.add(&o.status, 1);
    for (const double* of_load : {o.load_x, o.load_place, o.load_deflection, o.load_force})
      published_.add(of_load, model_.loads);
    for (const double* of_wheel :
         {o.contact_force, o.contact_force_mean, o.contact_force_peak, o.contact_impulse,
          o.contact_gap, o.contact_x, o.contact_place, o.contact_rail_z})
      published_.add(of_wheel, wheel_count(model_));
    published_.add(o.contact_on_rail, wheel_count(model_));
    for (const double* of_contact :
         {o.contact_force, o.contact_force_peak, o.contact_impulse, o.contact_gap})
      published_.add(of_contact + wheel_count(model_), flange_count(model_));
    published_.add(o.external_force, model_.external_wheels);
    for (std::int32_t i = 0; i < model_.external_wheels; ++i) {
      published_.add(o.external_displacement[i], 3);
      published_.add(o.external_velocity[i], 3);
    }
    published_.add(&o.constraint_violation, 1);
    published_.add(&o.iterations, 1);
    published_.add(&o.force_residual, 1);
    called([&] { read_track_sensors(model_, state_, outputs_, track_sensors_.data()); });
    published_.add(track_sensors_.data(), model_.track_sensor.count);
    for (std::int32_t i = 0; i < model_.system.sensors; ++i) {
      PointMotion motion{};
      called([&] { motion = sensor_motion(model_, state_, i); });
      published_.add(&motion, 1);
    }
  }

  /// Whether each wheel, flange and one-sided port bears a force.
  std::vector<bool> closed() const {
    std::vector<bool> bears;
    const auto add = [&bears](const double* force, std::int32_t count) {
      bears.reserve(bears.size() + static_cast<std::size_t>(count));
      for (std::int32_t i = 0; i < count; ++i) bears.push_back(force[i] != 0.);
    };
    add(state_.contact_force, contact_count(model_));
    add(state_.port_force, model_.fixed.count);
    return bears;
  }

  const Model& model_;
  std::vector<double> memory_, scratch_, track_sensors_;
  State state_;
  Workspace workspace_;
  Outputs outputs_{};
  double input_[kMaxInputs] = {};
  std::size_t modes_, calls_ = 0;
  Hash published_;
  std::vector<bool> was_closed_;
  int opened_ = 0, closed_ = 0;
  Status status_ = Status::ok;
  bool kept_mode_ = true;
};

/// A file in whole words, so that the block in them is aligned; `bytes` is the file's length.
std::vector<std::int64_t> words_of(const char* path, std::size_t& bytes) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> content{std::istreambuf_iterator<char>(file), {}};
  bytes = content.size();
  std::vector<std::int64_t> words(bytes / sizeof(std::int64_t) + 1);
  if (bytes > 0) std::memcpy(words.data(), content.data(), bytes);
  return words;
}

int refuse(const char* path, const char* why) {
  std::fprintf(stderr, "error: %s: %s\n", path, why);
  return 2;
}

int fail(const char* path, const char* why) {
  std::fprintf(stderr, "error: %s: %s\n", path, why);
  return 1;
}

/// Expected hashes of a run; an empty one is not checked.
struct Wanted {
  const char *state, *outputs;
};

bool differs(std::uint64_t found, const char* wanted) {
  return *wanted != '\0' && found != std::strtoull(wanted, nullptr, 16);
}

int step_hash(const char* path, long frames, const Wanted& wanted) {
  std::size_t bytes = 0;
  const std::vector<std::int64_t> block = words_of(path, bytes);
  const auto model = std::make_unique<Model>();
  const LoadResult loaded = load_model(block.data(), bytes, *model);
  if (loaded.status != LoadStatus::ok) return refuse(path, "no model file of this version");
  Run plain(*model, 1), disturbed(*model, kModeCount);
  for (long i = 0; i < frames; ++i) {
    use_kernels(&kBaseKernels);
    plain.frame();
    use_kernels(nullptr);
    disturbed.frame();
  }
  std::printf("%016" PRIx64 " %016" PRIx64 " %d %d %u %s\n", plain.state(), plain.outputs(),
              plain.opened(), plain.closings(), static_cast<unsigned>(plain.status()),
              kernels_in_use().name);
  if (has(plain.status(), Status::nonfinite_state))
    return fail(path, "the state is no longer finite");
  if (!plain.kept_mode() || !disturbed.kept_mode())
    return fail(path, "the host's floating-point mode is not as it was");
  if (plain.state() != disturbed.state())
    return fail(path, "the state depends on the host's floating-point mode or on kernels");
  if (plain.outputs() != disturbed.outputs())
    return fail(path, "the outputs depend on the host's floating-point mode or on kernels");
  const bool state = differs(plain.state(), wanted.state);
  if (!state && !differs(plain.outputs(), wanted.outputs)) return 0;
  std::fputs(
      "Every build must step to the stored bits. If what a step computes was changed on purpose,\n"
      "store the new hashes by tools/determinism-matrix --store (docs/determinism.md).\n",
      stderr);
  return fail(path, state ? "the state differs from the stored hash"
                          : "the outputs differ from the stored hash");
}

}  // namespace

int main(int count, char** text) {
  char* end = nullptr;
  const bool counts = count == 3 || count == 5;
  const long frames = counts ? std::strtol(text[2], &end, 10) : 0;
  if (!counts || *end != '\0' || frames < 1) {
    std::fputs(
        "usage: step_hash MODEL FRAMES [STATE OUTPUTS]\n"
        "prints, after so many frames of a model file: hash of the state, hash of all that was\n"
        "published, how many contacts had opened and closed at the frames' ends, status bits, the\n"
        "kernels of this processor, with which it comes to the same as with the base.\n"
        "Fails where a hash is not the given one.\n",
        stderr);
    return 2;
  }
  const Wanted wanted = count == 5 ? Wanted{text[3], text[4]} : Wanted{"", ""};
  return step_hash(text[1], frames, wanted);
}
