// Laws of bits: a model file, a snapshot and other frames change nothing.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "online/interface/railstep.h"
#include "properties.h"

namespace railstep::property {
namespace {

/// A run through the C interface, in memory that is NaN at first.
class Held {
 public:
  explicit Held(const std::vector<std::byte>& block)
      : model_memory_(railstep_model_bytes() / 8 + 1) {
    const std::int32_t loaded = railstep_load(block.data(), block.size(), model_memory_.data(),
                                              railstep_model_bytes(), &model_);
    if (loaded != RAILSTEP_OK) throw std::runtime_error(railstep_result_text(loaded));
    run_memory_.assign(railstep_run_bytes(model_) / 8 + 1, std::nan(""));
    const std::int32_t started =
        railstep_start(model_, run_memory_.data(), railstep_run_bytes(model_), &run_);
    if (started != RAILSTEP_OK) throw std::runtime_error(railstep_result_text(started));
  }
  void step() { static_cast<void>(railstep_step(run_, nullptr)); }
  std::vector<double> row() const {
    std::vector<double> values(static_cast<std::size_t>(railstep_outputs(model_)));
    railstep_read(run_, values.data());
    return values;
  }
  std::vector<unsigned char> saved() const {
    std::vector<unsigned char> bytes(railstep_snapshot_bytes(model_));
    railstep_save(run_, bytes.data());
    return bytes;
  }
  std::int32_t restore(const std::vector<unsigned char>& bytes) {
    return railstep_restore(run_, bytes.data(), bytes.size());
  }
  std::uint64_t hash() const { return railstep_hash(run_); }

 private:
  std::vector<double> model_memory_, run_memory_;
  const railstep_model* model_ = nullptr;
  railstep_run* run_ = nullptr;
};

/// Describes the first difference of a frame's row from the trace; empty if none.
std::string difference(const Trace& trace, std::size_t frame, const std::vector<double>& row) {
  for (std::size_t c = 0; c < row.size(); ++c) {
    const double expected = trace.at(frame, c);
    if (std::bit_cast<std::uint64_t>(expected) != std::bit_cast<std::uint64_t>(row[c]))
      return fmt::format("{} of row {}: {:.17g} for {:.17g}", trace.columns[c], frame, row[c],
                         expected);
  }
  return {};
}

/// Frames for snapshots: one chosen by the seed, and those at which a wheel lands or lifts off.
std::vector<std::size_t> frames_to_cut(const Trace& trace, std::uint64_t seed) {
  std::vector<std::size_t> cuts = {seed % trace.frames()};
  for (std::size_t c = 1; c < trace.columns.size(); ++c) {
    if (!trace.columns[c].ends_with("gap_m")) continue;
    for (std::size_t frame = 1; frame < trace.frames() && cuts.size() < 4; ++frame)
      if ((trace.at(frame, c) < 0.) != (trace.at(frame - 1, c) < 0.)) cuts.push_back(frame);
  }
  return cuts;
}

}  // namespace

Outcome model_file(const Document& scene, std::uint64_t) {
  const auto run = simulation_of(scene);
  const Trace trace = trace_of(*run);
  Simulation file(run->block(), "the model file");
  const Trace again = trace_of(file);
  if (again.hash != trace.hash) return Outcome::of(false, "the model file ends in another state");
  Held held(run->block());
  for (std::size_t frame = 0; frame < trace.frames(); ++frame) {
    if (frame > 0) held.step();
    const std::string off = difference(trace, frame, held.row());
    if (!off.empty()) return Outcome::of(false, off);
  }
  return Outcome::of(held.hash() == trace.hash, "hash by the C interface");
}

Outcome snapshot(const Document& scene, std::uint64_t seed) {
  const auto run = simulation_of(scene);
  const Trace trace = trace_of(*run);
  for (const std::size_t cut : frames_to_cut(trace, seed)) {
    Held first(run->block()), second(run->block());
    for (std::size_t frame = 0; frame < cut; ++frame) first.step();
    for (std::uint64_t frame = 0; frame < seed % 5; ++frame) second.step();
    if (second.restore(first.saved()) != RAILSTEP_OK)
      return Outcome::of(false, fmt::format("the snapshot of row {} is refused", cut));
    for (std::size_t frame = cut + 1; frame < trace.frames(); ++frame) {
      second.step();
      const std::string off = difference(trace, frame, second.row());
      if (!off.empty()) return Outcome::of(false, fmt::format("cut at row {}: {}", cut, off));
    }
    if (second.hash() != trace.hash)
      return Outcome::of(false, fmt::format("cut at row {}: another state at the end", cut));
  }
  return {};
}

Outcome frames(const Document& scene, std::uint64_t) {
  const double dt = number(scene["step"], "dt_s");
  const auto steps = std::llround(number(scene["step"], "duration_s") / dt);
  const auto in_frame = std::llround(number(scene["step"], "frame_s", dt) / dt);
  if (in_frame == 1 && steps % 2 != 0) return Outcome::none("an odd number of steps");
  Document other = scene;
  other["step"]["frame_s"] = static_cast<double>(in_frame == 1 ? 2 : 1) * dt;
  const Trace here = trace_of(scene), there = trace_of(other);
  return Outcome::of(here.hash == there.hash,
                     fmt::format("states {:016x} and {:016x}", here.hash, there.hash));
}

}  // namespace railstep::property
