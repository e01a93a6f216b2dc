// A recording: patches to a recording of a few frames, or a recording itself. Its sum is corrected,
// and on request the sums of the block in it too.
#include <cstring>
#include <map>
#include <vector>

#include "bases.h"
#include "online/model/block.h"
#include "oracle.h"
#include "patch.h"
#include "run/recording.h"
#include "run/simulate.h"
#include "scene/scene_system.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

constexpr std::size_t kHead = 64;

std::vector<std::byte> recorded(std::size_t which) {
  const auto run = simulation_of(read_any_scene(base_scene(which)));
  Recording made = Recording::begin(*run, 2);
  static_cast<void>(
      simulate(*run, 5, nullptr, false, [&](std::int64_t) { made.frame(*run, run->state.input); }));
  made.finish(*run);
  return made.bytes();
}

const std::vector<std::byte>& base_recording(std::size_t which) {
  static std::map<std::size_t, std::vector<std::byte>> made;
  std::vector<std::byte>& bytes = made[which % base_count()];
  if (bytes.empty()) bytes = recorded(which);
  return bytes;
}

std::vector<std::byte> patched(Bytes& input) {
  std::vector<std::byte> bytes = base_recording(input.byte());
  const std::uint8_t how = input.byte();
  std::uint64_t block = 0;
  std::memcpy(&block, bytes.data() + 48, 8);  // size in the good recording
  const std::size_t behind = kHead + static_cast<std::size_t>(block);
  apply_patches(
      input, {{0, kHead}, {24, 24}, {behind, bytes.size() - 32 - behind}, {kHead, behind - kHead}},
      bytes);
  if (how % 2 == 1) {  // the sums of the model in it are corrected too
    std::vector<std::byte> own(bytes.begin() + kHead,
                               bytes.begin() + static_cast<std::ptrdiff_t>(behind));
    sign_block(own);
    std::copy(own.begin(), own.end(), bytes.begin() + kHead);
  }
  if (how % 16 == 2) bytes.resize(bytes.size() - how);
  if (how % 16 != 4) sign_tail(bytes);
  return bytes;
}

/// Whether a command would make the run within seconds.
bool is_short(const Recording& recording) {
  if (recording.frames > 200 || recording.block.size() < sizeof(BlockHeader)) return false;
  BlockHeader header;
  std::memcpy(&header, recording.block.data(), sizeof header);
  return header.check_frames <= 8 && header.steps_per_frame <= 100;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes input(data, size);
  std::vector<std::byte> bytes;
  if (size >= 8 && std::memcmp(data, "railreco", 8) == 0) {
    const auto* const at = reinterpret_cast<const std::byte*>(data);
    bytes.assign(at, at + size);
    sign_tail(bytes);
  } else {
    bytes = patched(input);
  }
  const auto file =
      written("input.recording", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  accepts([&] {
    const Recording found = Recording::read(file);
    check(found.bytes() == bytes, "a recording is not written as it was read");
    if (!is_short(found)) return;
    const Replay once = replay(found, "input"), again = replay(found, "input");
    check(once.identical == again.identical && once.first.found == again.first.found,
          "a run made again twice has other bits");
  });
  return 0;
}
