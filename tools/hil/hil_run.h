#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hil/hil_exchange.h"
#include "hil/hil_latency.h"
#include "hil/hil_pace.h"
#include "hil/hil_realtime.h"
#include "run/simulation.h"

namespace railstep {

/// The plan of a paced run.
struct HilPlan {
  Schedule schedule;
  Schedule empty;  // of the loop with an empty step, before the run
  RealtimeWish realtime;
  std::int64_t silence = 0, ramp = 1;  // frames, of HeldInputs
  double wait_s = 0.;                  // for the first inputs, before the clock starts
  std::int64_t stall_frame = -1;       // a frame that is made to take longer, for tests
  std::int64_t stall_ns = 0;
  double* given = nullptr;  // [slots][inputs] what frames were given; or null
  bool respond = false;     // hil_response.h goes with the outputs
  const std::atomic<bool>* interrupted = nullptr;  // ends the run; or null
};

/// The counts and times of a paced run.
struct HilRecord {
  std::vector<RealtimeSetting> settings;
  Paced paced;
  Latency frame, wakeup, empty_frame, empty_wakeup;
  Status status = Status::ok;
  std::int32_t first_bad_unknown = -1;
  std::int64_t safe_stop_frame = -1;  // from which inputs went to 0
  std::int64_t allocations = 0;       // calls of new within the paced run, by any thread
  std::int64_t minor_faults = 0, major_faults = 0;  // pages, of the step thread within it
  std::int64_t preemptions = 0;                     // of the step thread within it
  bool unheard = false;  // no inputs came within wait_s, and nothing was run
  bool interrupted = false;
  bool lost = false;  // an exchange, and the run ended
};

/// Paces a simulation's frames in a thread of its own, which has the real-time settings; between
/// two frames it does nothing but sleep. The first of the exchanges that has new inputs gives them.
HilRecord run_paced(Simulation& run, const HilPlan& plan, const std::vector<Exchange*>& exchanges);

}  // namespace railstep
