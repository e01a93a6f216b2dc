// A snapshot: patches to a snapshot of a run that has made some frames, or a snapshot itself. Its
// sum is corrected.
#include <cstring>
#include <vector>

#include "bases.h"
#include "online/model/snapshot.h"
#include "oracle.h"
#include "patch.h"
#include "stepping.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

std::vector<std::byte> bytes_of(const std::vector<std::uint8_t>& from) {
  const auto* const at = reinterpret_cast<const std::byte*>(from.data());
  return {at, at + from.size()};
}

std::vector<std::uint8_t> snapshot_of(Bytes& input, const Held& held) {
  const std::uint8_t ending = input.byte();
  std::vector<std::byte> bytes = bytes_of(held.saved());
  const std::size_t tail = bytes.size() - kSnapshotSum;
  apply_patches(input, {{0, kSnapshotHead}, {kSnapshotHead, tail - kSnapshotHead}, {56, 16}},
                bytes);
  if (ending % 8 == 1) bytes.resize(bytes.size() - std::min<std::size_t>(bytes.size(), ending));
  if (ending % 8 == 2) bytes.resize(bytes.size() + ending);
  if (ending % 8 != 3) sign_tail(bytes);
  const auto* const at = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return {at, at + bytes.size()};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes input(data, size);
  const std::uint8_t which = input.byte(), frames = input.byte() % 12;
  Held held(base_block(which));
  held.start();
  for (int n = 0; n < frames; ++n) static_cast<void>(held.frame(n));
  const std::vector<std::uint8_t> before = held.saved(), snapshot = snapshot_of(input, held);
  const std::int32_t result = held.restore(snapshot);
  if (result != RAILSTEP_OK) {
    check(result == RAILSTEP_NOT_A_SNAPSHOT || result == RAILSTEP_OTHER_VERSION ||
              result == RAILSTEP_WRONG_SIZE || result == RAILSTEP_WRONG_SUM ||
              result == RAILSTEP_OTHER_MODEL || result == RAILSTEP_BAD_CONTENT,
          "a snapshot is refused with a result that is not one of a snapshot");
    check(held.saved() == before, "a snapshot that was refused changed the run");
    return 0;
  }
  check(held.saved() == snapshot, "a snapshot comes back with other bytes");
  for (int n = 0; n < kFrames; ++n) static_cast<void>(held.frame(n));
  const std::uint64_t hash = railstep_hash(held.run());
  check(held.restore(snapshot) == RAILSTEP_OK, "a snapshot is taken back once and not twice");
  for (int n = 0; n < kFrames; ++n) static_cast<void>(held.frame(n));
  check(railstep_hash(held.run()) == hash, "a snapshot leads to other bits a second time");
  return 0;
}
