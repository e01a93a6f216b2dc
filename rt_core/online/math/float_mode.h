#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <xmmintrin.h>
#elif defined(__arm__) && defined(__ARM_FP) && (__ARM_FP & 8) == 0
#error "railstep computes in doubles, which this processor's floating-point unit does not have"
#elif !defined(__aarch64__) && !(defined(__arm__) && defined(__ARM_FP))
#error \
    "float_mode.h knows x86 with SSE2, aarch64 and Arm with FPv5; add the control word of this machine"
#endif

namespace railstep {

/// While it lives: round to nearest, subnormals flushed to zero (results and operands), no
/// exception traps. Then the caller's mode is restored. Subnormals cost up to 95 times a normal
/// number, and a caller's rounding mode would change the bits.
///
/// The control word is written through volatile code, but a compiler may still move plain
/// arithmetic across it: keep the guarded arithmetic in functions of another file.
class FloatMode {
 public:
  FloatMode() noexcept : before_(read()) { write((before_ & ~kCleared) | kSet); }
  ~FloatMode() { write(before_); }
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

#if defined(__SSE2__)
  using Word = std::uint32_t;
  static Word read() noexcept { return _mm_getcsr(); }

 private:
  // MXCSR: bits 13-14 rounding, 7-12 masks of traps, 0-5 their sticky flags, 15 FTZ, 6 DAZ.
  static constexpr Word kCleared = 0x6000u | 0x1f80u | 0x3fu, kSet = 0x8040u | 0x1f80u;
  static void write(Word word) noexcept { _mm_setcsr(word); }
#elif defined(__aarch64__)
  using Word = std::uint64_t;
  static Word read() noexcept {
    Word word;
    asm volatile("mrs %0, fpcr" : "=r"(word) : : "memory");
    return word;
  }

 private:
  // FPCR: bits 22-23 rounding, 8-12 and 15 traps, 24 FZ (results and operands), 25 NaNs without
  // payload, 0-2 alternate handling (FEAT_AFP), under which FZ flushes otherwise.
  static constexpr Word kCleared = 0xc00000u | 0x9f00u | 0x2000000u | 0x7u, kSet = 0x1000000u;
  static void write(Word word) noexcept { asm volatile("msr fpcr, %0" : : "r"(word) : "memory"); }
#else
  using Word = std::uint32_t;
  static Word read() noexcept {
    Word word;
    asm volatile("vmrs %0, fpscr" : "=r"(word) : : "memory");
    return word;
  }

 private:
  // FPSCR: bits 22-23 rounding, 8-12 and 15 traps, 24 FZ, 25 NaNs without payload, 26 another half
  // precision. The caller must not lose its sticky flags 0-4 and 7: they are restored too.
  static constexpr Word kCleared = 0xc00000u | 0x9f00u | 0x6000000u, kSet = 0x1000000u;
  static void write(Word word) noexcept { asm volatile("vmsr fpscr, %0" : : "r"(word) : "memory"); }
#endif

  Word before_;
};

}  // namespace railstep
