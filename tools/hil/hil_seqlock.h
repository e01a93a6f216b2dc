#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace railstep {

/// Words in memory that one writer changes while others read them, without waiting on either side.
/// The first word is the lock: odd while the writer is at work, and another even number behind
/// each change. No fences, which ThreadSanitizer does not know: a reader that sees a word of a
/// change (release, acquire) sees the odd lock before it too, and throws its words away.
class SeqLock {
 public:
  using Word = std::atomic<std::uint64_t>;
  static_assert(Word::is_always_lock_free && sizeof(Word) == 8);

  /// @param words  [1 + count] shared; zeros at first
  SeqLock(Word* words, std::size_t count) : words_(words), count_(count) {}

  void write(const std::uint64_t* from) noexcept {
    const std::uint64_t odd = words_[0].load(std::memory_order_relaxed) | 1u;  // of a dead writer
    words_[0].store(odd, std::memory_order_relaxed);
    for (std::size_t i = 0; i < count_; ++i)
      words_[1 + i].store(from[i], std::memory_order_release);
    words_[0].store(odd + 1, std::memory_order_release);
  }

  /// @param into  [count] overwritten, with what is whole if true is returned
  /// @param seen  the lock's number of what was read
  /// @returns false where the writer was at work at every try
  bool read(std::uint64_t* into, int tries, std::uint64_t& seen) const noexcept {
    for (int n = 0; n < tries; ++n) {
      const std::uint64_t before = words_[0].load(std::memory_order_acquire);
      if ((before & 1u) != 0) continue;
      for (std::size_t i = 0; i < count_; ++i)
        into[i] = words_[1 + i].load(std::memory_order_acquire);
      if (words_[0].load(std::memory_order_relaxed) != before) continue;
      seen = before;
      return true;
    }
    return false;
  }

  /// The lock's number: the same one, the same words.
  std::uint64_t number() const noexcept { return words_[0].load(std::memory_order_acquire); }

 private:
  Word* words_;
  std::size_t count_;
};

}  // namespace railstep
