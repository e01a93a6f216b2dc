#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace railstep {

/// From one thread to another, the newest value only: three slots, of which each side owns one and
/// the third goes back and forth. Neither side waits, whatever the other does.
class NewestBox {
 public:
  explicit NewestBox(std::size_t count) : slot_{Slot(count), Slot(count), Slot(count)} {}

  /// For the producer: the slot to fill, then to put().
  double* blank() noexcept { return slot_[back_].data(); }
  void put() noexcept {
    back_ = middle_.exchange(back_ | kNew, std::memory_order_acq_rel) & kIndex;
  }
  /// For the consumer: the last value that was put, or null where it was taken already. Valid until
  /// the next call.
  const double* take() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kNew) == 0) return nullptr;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return slot_[front_].data();
  }

 private:
  using Slot = std::vector<double>;
  static constexpr std::uint32_t kIndex = 3, kNew = 4;

  Slot slot_[3];
  std::uint32_t back_ = 0;
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t front_ = 2;
};

/// From one thread to another, all in order: a ring of entries with a head and `count` values each.
/// A full ring refuses; neither side waits.
template <class Head>
class Queue {
 public:
  Queue(std::size_t entries, std::size_t count)
      : entries_(entries), count_(count), head_(entries), value_(entries * count) {}

  /// For the producer. @param values  [count] @returns whether there was room
  bool put(const Head& head, const double* values) noexcept {
    const std::size_t at = put_.load(std::memory_order_relaxed);
    if (at - taken_.load(std::memory_order_acquire) == entries_) return false;
    const std::size_t slot = at % entries_;
    head_[slot] = head;
    for (std::size_t i = 0; i < count_; ++i) value_[slot * count_ + i] = values[i];
    put_.store(at + 1, std::memory_order_release);
    return true;
  }
  /// For the consumer: hands the oldest entry to `use(head, values)`. @returns whether there was
  /// one
  template <class Use>
  bool take(Use&& use) {
    const std::size_t at = taken_.load(std::memory_order_relaxed);
    if (at == put_.load(std::memory_order_acquire)) return false;
    const std::size_t slot = at % entries_;
    use(head_[slot], value_.data() + slot * count_);
    taken_.store(at + 1, std::memory_order_release);
    return true;
  }

 private:
  std::size_t entries_, count_;
  std::vector<Head> head_;
  std::vector<double> value_;  // [entries][count]
  alignas(64) std::atomic<std::size_t> put_{0};
  alignas(64) std::atomic<std::size_t> taken_{0};
};

}  // namespace railstep
