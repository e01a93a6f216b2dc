#include "online/model/snapshot.h"

#include "online/math/bytes.h"
#include "online/math/sha256.h"

namespace railstep {

namespace {

constexpr char kMagic[8] = {'r', 'a', 'i', 'l', 's', 'n', 'a', 'p'};
constexpr std::size_t kFormatAt = 8, kSizeAt = 16, kModelAt = 24, kStepsAt = 56, kLatchedAt = 64,
                      kCountAt = 72;
static_assert(kCountAt + 8 == kSnapshotHead);
// A step's time is a double. Far from where one more step would overflow.
constexpr std::int64_t kMostSteps = std::int64_t{1} << 53;

}  // namespace

void save_snapshot(const Model& model, const State& state, unsigned char* bytes) noexcept {
  const auto count = static_cast<std::size_t>(state_doubles(model));
  for (int i = 0; i < 8; ++i) bytes[i] = static_cast<unsigned char>(kMagic[i]);
  put_word(bytes + kFormatAt, kSnapshotFormat);
  put_word(bytes + kSizeAt, snapshot_bytes(model));
  std::memcpy(bytes + kModelAt, model.sum, sizeof model.sum);
  put_word(bytes + kStepsAt, static_cast<std::uint64_t>(state.steps));
  put_word(bytes + kLatchedAt, static_cast<std::uint64_t>(state.latched));
  put_word(bytes + kCountAt, count);
  unsigned char* at = bytes + kSnapshotHead;
  for (std::size_t i = 0; i < count; ++i, at += 8) put_double(at, state.u[i]);  // one row from u on
  sha256(bytes, static_cast<std::size_t>(at - bytes), at);
}

SnapshotStatus restore_snapshot(const Model& model, const void* bytes, std::size_t count,
                                State& state) noexcept {
  const auto* at = static_cast<const unsigned char*>(bytes);
  if (count < kSnapshotHead || !same_bytes(at, kMagic, 8)) return SnapshotStatus::not_a_snapshot;
  if (get_word(at + kFormatAt) != kSnapshotFormat) return SnapshotStatus::other_version;
  const auto doubles = static_cast<std::size_t>(state_doubles(model));
  if (count != get_word(at + kSizeAt)) return SnapshotStatus::wrong_size;
  if (count < kSnapshotHead + kSnapshotSum) return SnapshotStatus::wrong_size;
  unsigned char sum[kSnapshotSum];
  sha256(at, count - kSnapshotSum, sum);
  if (!same_bytes(at + (count - kSnapshotSum), sum, sizeof sum)) return SnapshotStatus::wrong_sum;
  if (!same_bytes(at + kModelAt, model.sum, sizeof model.sum)) return SnapshotStatus::other_model;
  if (get_word(at + kCountAt) != doubles || count != snapshot_bytes(model))
    return SnapshotStatus::wrong_size;
  const auto steps = static_cast<std::int64_t>(get_word(at + kStepsAt));
  const std::uint64_t latched = get_word(at + kLatchedAt);
  if (steps < 0 || steps > kMostSteps || (latched & ~static_cast<std::uint64_t>(kLatched)) != 0)
    return SnapshotStatus::bad_content;
  state.steps = steps;
  state.latched = static_cast<Status>(latched);
  for (std::size_t i = 0; i < doubles; ++i) state.u[i] = get_double(at + kSnapshotHead + 8 * i);
  return SnapshotStatus::ok;
}

}  // namespace railstep
