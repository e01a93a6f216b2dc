#pragma once
#include <cstddef>
#include <cstdint>

#include "online/model/status.h"

namespace railstep {

/// The outputs of a frame, as the step thread passes them on.
struct FrameOutputs {
  std::int64_t frame = 0;  // from 0
  Status status = Status::ok;
  std::uint32_t flags = 0;         // kLastFrame, kSafeStop
  const double* values = nullptr;  // [columns of the trace]
};

/// The step thread's end of an exchange: no call waits, allocates or asks the system.
class Exchange {
 public:
  Exchange() = default;
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;
  virtual ~Exchange() = default;

  /// The newest inputs since the last call; null where none came. Valid until the next call.
  /// @param frame  that begins
  virtual const double* inputs(std::int64_t frame) noexcept = 0;
  virtual void outputs(const FrameOutputs& made) noexcept = 0;
  /// Whether another process took the shared memory away.
  virtual bool lost() const noexcept { return false; }
};

}  // namespace railstep
