#include "hil/hil_run.h"

#include <sys/resource.h>

#include <algorithm>
#include <thread>

#include "hil/hil_inputs.h"
#include "hil/hil_packet.h"
#include "hil/hil_response.h"
#include "online/model/external_input.h"
#include "online/step/step.h"
#include "online/step/trace_row.h"
#include "run/heap_count.h"
#include "run/simulate.h"

namespace railstep {
namespace {

/// The inputs that are places of external wheels.
std::vector<std::size_t> places_of(const Model& model) {
  std::vector<std::size_t> at;
  for (std::int32_t n = 0; n < model.external_wheels; ++n)
    for (int d = 0; d < kExternalPlaces; ++d)
      at.push_back(static_cast<std::size_t>(model.external_wheel[n].input + d));
  return at;
}

/// All that a frame needs, made before the first one.
class Stepper {
 public:
  Stepper(Simulation& run, const HilPlan& plan, const std::vector<Exchange*>& exchanges,
          HilRecord& record)
      : run_(run),
        plan_(plan),
        exchanges_(exchanges),
        record_(record),
        held_(static_cast<std::size_t>(run.model().inputs), plan.silence, plan.ramp,
              places_of(run.model())),
        columns_(static_cast<std::size_t>(trace_columns(run.model()))),
        row_(columns_),
        clock_{plan.interrupted} {
    if (plan.respond) row_.resize(columns_ + response_.emplace(run).count());
    publish_start(run.model(), run.state, outputs_);
    trace_row(run.model(), run.state, outputs_, row_.data());
  }

  /// @returns whether inputs came in time, or need not be waited for
  bool wait() noexcept {
    constexpr std::int64_t kLook = 1'000'000;  // ns
    const std::int64_t end = clock_.now() + static_cast<std::int64_t>(1e9 * plan_.wait_s);
    while (plan_.wait_s > 0. && !held_.heard() && !is_over() && clock_.now() < end) {
      give(-1);
      clock_.sleep_until(clock_.now() + kLook);
    }
    return plan_.wait_s <= 0. || held_.heard();
  }

  /// The start, from which a vehicle outside makes its first frame.
  void begin() noexcept {
    if (!response_) return;
    respond(run_.state.input);
    publish(-1, 0);
  }

  /// @returns whether the run goes on
  bool frame(std::int64_t n) noexcept {
    const double* const given = give(n);
    if (plan_.given != nullptr)
      std::copy_n(given, run_.model().inputs, plan_.given + n * run_.model().inputs);
    record_.status =
        record_.status | advance_frame(run_.model(), given, run_.state, run_.workspace, outputs_);
    record_.first_bad_unknown = outputs_.first_bad_unknown;
    if (held_.stopping() && record_.safe_stop_frame < 0) record_.safe_stop_frame = n;
    trace_row(run_.model(), run_.state, outputs_, row_.data());
    if (response_ && record_.first_bad_unknown < 0) respond(given);
    if (n == plan_.stall_frame) stall();
    publish(n, 0);
    return record_.first_bad_unknown < 0 && !is_over();
  }

  /// Whether a signal came or an exchange is lost, and notes it.
  bool is_over() noexcept {
    record_.interrupted =
        plan_.interrupted != nullptr && plan_.interrupted->load(std::memory_order_relaxed);
    for (const Exchange* const exchange : exchanges_)
      record_.lost = record_.lost || exchange->lost();
    return record_.interrupted || record_.lost;
  }

  /// The last frame's outputs again, and that it was the last.
  void end(std::int64_t frames) noexcept { publish(frames - 1, kLastFrame); }

 private:
  const double* give(std::int64_t n) noexcept {
    const double* fresh = nullptr;
    for (Exchange* const exchange : exchanges_) {
      const double* const came = exchange->inputs(n);
      if (fresh == nullptr) fresh = came;
    }
    if (response_ && fresh != nullptr) response_->ask(fresh + run_.model().inputs);
    return n < 0 && fresh == nullptr ? nullptr : held_.next(fresh, run_.state.input);
  }

  void respond(const double* given) noexcept {
    asked_ = response_->answer(run_, given, row_.data() + columns_);
  }

  void publish(std::int64_t n, std::uint32_t flags) noexcept {
    const FrameOutputs made{n, outputs_.status | asked_,
                            flags | (held_.stopping() ? kSafeStop : 0u), row_.data()};
    for (Exchange* const exchange : exchanges_) exchange->outputs(made);
  }

  void stall() const noexcept {
    const std::int64_t end = clock_.now() + plan_.stall_ns;
    while (clock_.now() < end) {
    }
  }

  Simulation& run_;
  const HilPlan& plan_;
  const std::vector<Exchange*>& exchanges_;
  HilRecord& record_;
  HeldInputs held_;
  Outputs outputs_{};
  std::optional<Response> response_;
  Status asked_ = Status::ok;  // what the places of the next frame meet
  std::size_t columns_;
  std::vector<double> row_;
  MonotonicClock clock_;
};

/// The calling thread's account with the system.
rusage thread_usage() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage;
}

void step_thread(const HilPlan& plan, Stepper& stepper, HilRecord& record) {
  record.settings = become_realtime(plan.realtime);
  if (!stepper.wait()) {
    record.unheard = true;
    return;
  }
  const MonotonicClock clock{plan.interrupted};
  pace(
      plan.empty, clock, [&stepper](std::int64_t) { return !stepper.is_over(); },
      record.empty_wakeup, record.empty_frame);
  const rusage before = thread_usage();
  const std::int64_t heap = heap_calls();
  stepper.begin();
  record.paced = pace(
      plan.schedule, clock, [&stepper](std::int64_t n) { return stepper.frame(n); }, record.wakeup,
      record.frame);
  if (record.paced.ended) stepper.is_over();
  record.allocations = heap_calls() - heap;
  const rusage after = thread_usage();
  record.minor_faults = after.ru_minflt - before.ru_minflt;
  record.major_faults = after.ru_majflt - before.ru_majflt;
  record.preemptions = after.ru_nivcsw - before.ru_nivcsw;
  stepper.end(record.paced.frames);
}

}  // namespace

HilRecord run_paced(Simulation& run, const HilPlan& plan, const std::vector<Exchange*>& exchanges) {
  HilRecord record;
  Stepper stepper(run, plan, exchanges, record);
  std::thread([&] { step_thread(plan, stepper, record); }).join();
  unlock_memory();
  return record;
}

}  // namespace railstep
