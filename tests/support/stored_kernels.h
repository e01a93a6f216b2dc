#pragma once
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <ios>
#include <vector>

#include "offline/element/straight_beam.h"
#include "support/sections.h"

namespace railstep {

/// Numbers in [-1, 1) that are the same on every machine: Knuth's MMIX generator.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(static_cast<std::int64_t>(state_ >> 11)) * 0x1p-52 - 1.;
  }

 private:
  std::uint64_t state_;
};

/// FNV-1a over the bits.
inline std::uint64_t hash(std::uint64_t h, const double* x, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    unsigned char bytes[sizeof(double)];
    std::memcpy(bytes, x + i, sizeof bytes);
    for (const unsigned char byte : bytes) h = (h ^ byte) * 1099511628211ULL;
  }
  return h;
}
inline constexpr std::uint64_t kEmpty = 14695981039346656037ULL;

/// Holds a kernel's bits to those that g++ 12 stored, at -O3 with SSE2; every compiler, level and
/// vector width that was tried has the same. What to do where they differ is said.
inline void check_stored(const char* kernel, std::uint64_t found, std::uint64_t stored) {
  INFO(
      "The bits of " << kernel << " have the hash 0x" << std::hex << found << ", stored is 0x"
                     << stored << ".\n"
                     << "The hash pins the order of every sum of the kernel. Model files must step "
                        "to the same bits in each build.\n"
                        "If other builds still have the stored hash, this one's compiler or flags "
                        "reorder sums: mend the build (docs/determinism.md).\n"
                        "If the kernel was changed on purpose: check it by the tests of its file "
                        "against dense matrices, run tools/determinism-matrix, which shows that "
                        "all builds agree, store the models' hashes by tools/determinism-matrix "
                        "--store, and write the hash found here into this test.");
  CHECK(found == stored);
}

inline bool same_bits(const double* a, const double* b, std::size_t n) {
  return std::memcmp(a, b, n * sizeof(double)) == 0;
}

inline BeamSection full_section_f() {
  BeamSection f = section_f();
  f.moments = moments(kSectionF);
  return f;
}

/// Made-up constants that no library has computed; every one of them has an effect.
inline StraightBeam made_up_beam() {
  Numbers numbers(5);
  StraightBeam beam{};
  beam.per_length = 1. / .6;
  for (double& p : beam.preload) p = 1e5 * numbers.next();
  for (double& c : beam.stiffness) c = 1e8 * numbers.next();
  return beam;
}

/// Nodes of n elements of 0.6 m along x, with every unknown shaken, then rotated by R.
inline std::vector<double> shaken_nodes(int n, std::uint64_t seed, double shake,
                                        const Eigen::Matrix3d& R = Eigen::Matrix3d::Identity()) {
  Numbers numbers(seed);
  std::vector<double> q;
  for (int node = 0; node <= 2 * n; ++node) {
    Eigen::Matrix3d columns = Eigen::Matrix3d::Identity();
    columns(0, 0) = .3 * node;
    columns = R * columns;
    for (int c = 0; c < 9; ++c) q.push_back(columns(c % 3, c / 3) + shake * numbers.next());
  }
  return q;
}

}  // namespace railstep
