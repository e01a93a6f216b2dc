#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hil/hil_exchange.h"
#include "hil/hil_seqlock.h"
#include "hil/hil_udp.h"

namespace railstep {

/// A block of POSIX shared memory; 64-bit words, little-endian as the machine is:
///   0  8 bytes "railshm1"            4  byte at which the inputs begin
///   1  1 once all of this stands     5  byte at which the outputs begin
///   2  count of inputs               6  byte at which the names begin
///   3  count of outputs              7  bytes of the names
/// The names of the inputs, then of the outputs, have a line feed behind each. Inputs and outputs
/// begin at a multiple of 64 bytes, each a lock (hil_seqlock.h) and under it 3 + count words:
///   1  number of the change, from 1     3  status, and in the upper 32 bits flags (of outputs)
///   2  int64 frame, as in hil_packet.h  4  count doubles
inline constexpr std::size_t kSharedHead = 8;  // words
inline constexpr std::size_t kBlockHead = 3;   // words under a lock before the values
inline constexpr std::size_t kBlockLock = 1;

/// Counts of the inputs and outputs.
struct SharedCounts {
  std::int64_t fresh = 0;  // frames that found new inputs
  std::int64_t late = 0;   // of them meant for a frame that had begun
  std::int64_t torn = 0;   // frames that met a writer at work at every try, and held what they had
};

/// Inputs and outputs of each frame in shared memory of that name; it is taken away at the end.
/// Another process of the same user may cut the memory short at any time, and whoever touches it
/// then gets SIGBUS. The handler of that signal, for one exchange at a time, replaces all of it by
/// pages of zeros. So the step thread never has to ask for its size, and the missing first word
/// shows the loss.
class SharedExchange : public Exchange {
 public:
  /// Throws InputError where it cannot be made, or stands there already.
  SharedExchange(const std::string& name, const ExchangeLayout& layout);
  ~SharedExchange() override;

  const double* inputs(std::int64_t frame) noexcept override;
  void outputs(const FrameOutputs& made) noexcept override;
  /// Whether another process cut the memory short or wrote over its first word.
  bool lost() const noexcept override;

  /// For a handler of signals that ends the program: takes the name away.
  static void unlink_at_once() noexcept;

  const SharedCounts& counts() const noexcept { return counts_; }

 private:
  void lay_out(const ExchangeLayout& layout, const std::string& names);

  std::string name_;
  void* memory_ = nullptr;
  std::size_t bytes_ = 0, inputs_at_ = 0, outputs_at_ = 0;
  std::vector<std::uint64_t> in_, out_;  // [3 + count]
  std::vector<double> value_;            // [inputs]
  std::uint64_t seen_ = 0, sequence_ = 0;
  SharedCounts counts_;
};

}  // namespace railstep
