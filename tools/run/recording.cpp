#include "run/recording.h"

#include <fmt/core.h>

#include <cstring>

#include "online/math/bytes.h"
#include "online/math/sha256.h"
#include "online/model/snapshot.h"
#include "online/step/step.h"

namespace railstep {
namespace {

constexpr char kMagic[] = "railreco";
constexpr std::int64_t kFormat = 1;
constexpr std::size_t kHead = 64, kSum = 32;

/// Reads a file's bytes in order; after the first that is missing, everything is.
class Reader {
 public:
  explicit Reader(const std::vector<std::byte>& bytes)
      : at_(reinterpret_cast<const unsigned char*>(bytes.data())), left_(bytes.size()) {}

  bool good() const { return good_ && left_ == kSum; }
  std::int64_t word() {
    const unsigned char* const at = take(8);
    return at == nullptr ? 0 : static_cast<std::int64_t>(get_word(at));
  }
  std::vector<std::byte> block(std::int64_t count) {
    const auto* const at = reinterpret_cast<const std::byte*>(take(count));
    return at == nullptr ? std::vector<std::byte>{} : std::vector<std::byte>(at, at + count);
  }
  /// Numbers of 8 bytes each.
  template <typename T, typename Get>
  std::vector<T> values(std::int64_t count, Get get) {
    if (count < 0 || static_cast<std::uint64_t>(count) > left_ / 8) good_ = false;
    std::vector<T> all(good_ ? static_cast<std::size_t>(count) : 0);
    for (T& value : all) value = get(take(8));
    return all;
  }

 private:
  const unsigned char* take(std::int64_t count) {
    if (count < 0 || static_cast<std::uint64_t>(count) > left_) good_ = false;
    if (!good_) return nullptr;
    const unsigned char* const from = at_;
    at_ += count;
    left_ -= static_cast<std::size_t>(count);
    return from;
  }

  const unsigned char* at_;
  std::size_t left_;
  bool good_ = true;
};

void append_word(std::vector<std::byte>& to, std::uint64_t value) {
  unsigned char bytes[8];
  put_word(bytes, value);
  const auto* const from = reinterpret_cast<const std::byte*>(bytes);
  to.insert(to.end(), from, from + 8);
}

/// Whether a file's first and last bytes are a whole recording's.
void check_frame(const std::vector<std::byte>& bytes, const std::string& name) {
  const auto* const at = reinterpret_cast<const unsigned char*>(bytes.data());
  if (bytes.size() < kHead + kSum || !same_bytes(at, kMagic, 8))
    throw InputError(
        "E-RECORDING-01",
        fmt::format(
            "{}: this is not a recording; expected a file that `railstep run --record` wrote",
            name));
  if (get_word(at + 8) != static_cast<std::uint64_t>(kFormat))
    throw InputError(
        "E-RECORDING-02",
        fmt::format("{}: the recording has format {}; expected format {}. Record the run again",
                    name, static_cast<std::int64_t>(get_word(at + 8)), kFormat));
  if (get_word(at + 16) != bytes.size())
    throw InputError(
        "E-RECORDING-03",
        fmt::format(
            "{}: the recording says that it has {} bytes, and it has {}; record the run again",
            name, static_cast<std::int64_t>(get_word(at + 16)), bytes.size()));
  unsigned char sum[kSum];
  sha256(at, bytes.size() - kSum, sum);
  if (!same_bytes(at + (bytes.size() - kSum), sum, kSum))
    throw InputError(
        "E-RECORDING-04",
        fmt::format(
            "{}: the content of the recording does not match its SHA-256; record the run again",
            name));
}

}  // namespace

Recording Recording::begin(const Simulation& run, std::int64_t every) {
  Recording made;
  made.every = every;
  made.block = run.block();
  made.snapshot.resize(snapshot_bytes(run.model()));
  save_snapshot(run.model(), run.state, reinterpret_cast<unsigned char*>(made.snapshot.data()));
  return made;
}

void Recording::frame(const Simulation& run, const double* given) {
  inputs.insert(inputs.end(), given, given + run.model().inputs);
  if (++frames % every == 0) hashes.push_back(state_hash(run.model(), run.state));
}

void Recording::finish(const Simulation& run) {
  if (frames % every != 0) hashes.push_back(state_hash(run.model(), run.state));
}

std::vector<std::byte> Recording::bytes() const {
  const std::int64_t width = frames > 0 ? static_cast<std::int64_t>(inputs.size()) / frames : 0;
  const std::size_t size =
      kHead + block.size() + snapshot.size() + 8 * (inputs.size() + hashes.size()) + kSum;
  const auto* const magic = reinterpret_cast<const std::byte*>(kMagic);
  std::vector<std::byte> all(magic, magic + 8);
  all.reserve(size);
  for (const std::int64_t word :
       {kFormat, static_cast<std::int64_t>(size), frames, width, every,
        static_cast<std::int64_t>(block.size()), static_cast<std::int64_t>(snapshot.size())})
    append_word(all, static_cast<std::uint64_t>(word));
  all.insert(all.end(), block.begin(), block.end());
  all.insert(all.end(), snapshot.begin(), snapshot.end());
  for (const double value : inputs) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    append_word(all, bits);
  }
  for (const std::uint64_t hash : hashes) append_word(all, hash);
  std::byte sum[kSum];
  sha256(all.data(), all.size(), reinterpret_cast<std::uint8_t*>(sum));
  all.insert(all.end(), sum, sum + kSum);
  return all;
}

Recording Recording::read(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_bytes(file);
  check_frame(bytes, file.string());
  Reader reader(bytes);
  for (int skipped = 0; skipped < 3; ++skipped) static_cast<void>(reader.word());
  Recording found;
  found.frames = reader.word();
  const std::int64_t width = reader.word();
  found.every = reader.word();
  const std::int64_t block = reader.word(), snapshot = reader.word();
  found.block = reader.block(block);
  found.snapshot = reader.block(snapshot);
  constexpr std::int64_t kMost = std::int64_t{1} << 48;  // sums and products below do not overflow
  const bool counted = found.frames >= 0 && found.frames < kMost && width >= 0 &&
                       width <= kMaxInputs && found.every > 0 && found.every < kMost;
  if (counted) {
    found.inputs = reader.values<double>(found.frames * width, get_double);
    found.hashes = reader.values<std::uint64_t>(found.hash_count(), get_word);
  }
  if (!counted || !reader.good())
    throw InputError(
        "E-RECORDING-05",
        fmt::format("{}: the recording holds a number out of its range; record the run again",
                    file.string()));
  return found;
}

Replay replay(const Recording& recording, const std::string& name) {
  Simulation run(recording.block, name);
  const Model& model = run.model();
  const std::size_t width = static_cast<std::size_t>(model.inputs);
  const bool fits = recording.inputs.size() == static_cast<std::size_t>(recording.frames) * width;
  if (!fits || restore_snapshot(model, recording.snapshot.data(), recording.snapshot.size(),
                                run.state) != SnapshotStatus::ok)
    throw InputError("E-RECORDING-06", fmt::format("{}: model, state and inputs of the recording "
                                                   "do not belong together; record the run again",
                                                   name));
  Outputs outputs{};
  publish_start(model, run.state, outputs);
  std::int64_t frame = 0;
  for (std::size_t n = 0; n < recording.hashes.size(); ++n) {
    const std::int64_t until = recording.hashed_frame(static_cast<std::int64_t>(n));
    for (; frame < until; ++frame)  // what the status says of a frame it said when it was recorded
      static_cast<void>(
          advance_frame(model, recording.inputs.data() + static_cast<std::size_t>(frame) * width,
                        run.state, run.workspace, outputs));
    const std::uint64_t found = state_hash(model, run.state);
    if (found != recording.hashes[n]) return {false, {frame, recording.hashes[n], found}};
  }
  return {true, {}};
}

}  // namespace railstep
