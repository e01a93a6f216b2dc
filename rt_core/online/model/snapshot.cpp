#include "online/model/snapshot.h"

#include "online/math/bytes.h"
#include "online/math/sha256.h"
#include "online/model/system_workspace.h"

namespace railstep {

namespace {

constexpr char kMagic[8] = {'r', 'a', 'i', 'l', 's', 'n', 'a', 'p'};
constexpr std::size_t kFormatAt = 8, kSizeAt = 16, kModelAt = 24, kStepsAt = 56, kLatchedAt = 64,
                      kCountAt = 72;
static_assert(kCountAt + 8 == kSnapshotHead);
// The time of a step is a double. This is far below the overflow of the count.
constexpr std::int64_t kMostSteps = std::int64_t{1} << 53;

/// Whether the order of the rows of a factored matrix names each row once.
bool names_each(const unsigned char* order, std::int32_t rows) noexcept {
  const auto at = [order](std::int32_t i) {
    return static_cast<std::int32_t>(get_word(order + 8 * (i / 2)) >> (32 * (i % 2)));
  };
  for (std::int32_t i = 0; i < rows; ++i) {
    if (at(i) < 0 || at(i) >= rows) return false;
    for (std::int32_t k = 0; k < i; ++k)
      if (at(k) == at(i)) return false;
  }
  return true;
}

/// Whether the matrix that a state keeps, if it keeps one, is usable.
/// @param numbers  bytes of the state's numbers
bool kept_is_valid(const Model& model, const State& state, const unsigned char* numbers) noexcept {
  const SystemModel& system = model.system;
  if (system.unknowns == 0 || system.renew != Renew::kept) return true;
  const SystemTangent kept = system_tangent_on(system, state.kept);
  const auto at = [&](const void* place) {
    return numbers +
           (static_cast<const char*>(place) - reinterpret_cast<const char*>(state.numbers));
  };
  if (!(get_double(at(kept.age)) > 0.)) return true;
  const double rank = get_double(at(kept.rank));
  return rank >= 0. && rank <= system.joint_rows && names_each(at(kept.order), system_rows(system));
}

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
  for (std::size_t i = 0; i < count; ++i, at += 8) put_double(at, state.numbers[i]);
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
  if (!kept_is_valid(model, state, at + kSnapshotHead)) return SnapshotStatus::bad_content;
  state.steps = steps;
  state.latched = static_cast<Status>(latched);
  for (std::size_t i = 0; i < doubles; ++i)
    state.numbers[i] = get_double(at + kSnapshotHead + 8 * i);
  return SnapshotStatus::ok;
}

}  // namespace railstep
