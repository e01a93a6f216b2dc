#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "online/interface/railstep.h"

namespace railstep::fuzz {

inline constexpr int kFrames = 10;

/// A model and a run of it by the C interface, in their own memory, which is filled with NaN.
class Held {
 public:
  /// @param own  a block that this program wrote: all of its state stays finite or the status says
  /// so. For other blocks only the unknowns and their rates are checked, as a frame does.
  explicit Held(const std::vector<std::byte>& block, bool own = false);

  std::int32_t loaded() const { return loaded_; }  // result of railstep_load()
  bool small() const;  // enough to be stepped within a fuzzer's patience
  void start();
  /// Makes a frame by the n-th of a fixed list of inputs and checks all that a frame promises.
  std::uint32_t frame(int n);
  std::vector<double> row() const;
  std::vector<std::uint8_t> saved() const;
  std::int32_t restore(const std::vector<std::uint8_t>& snapshot);
  const railstep_model* model() const { return model_; }
  railstep_run* run() const { return run_; }

 private:
  void check_state(std::uint32_t met) const;

  const std::vector<std::byte>* block_;
  std::vector<double> model_memory_, run_memory_;
  const railstep_model* model_ = nullptr;
  railstep_run* run_ = nullptr;
  std::size_t watched_ = 0;  // doubles of the state that are checked, from the first on
  std::int32_t loaded_;
};

/// Loads a block and, if it is accepted and small, steps it. Ten frames must not use the heap, must
/// be finite or say that they are not, and must have the same bits a second time and from a
/// snapshot.
/// @param own  a block that this program wrote: its self-check agrees
/// @returns whether it was accepted
bool step_block(const std::vector<std::byte>& block, bool own);

}  // namespace railstep::fuzz
