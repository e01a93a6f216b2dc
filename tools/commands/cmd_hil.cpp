#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands/command.h"
#include "commands/options.h"
#include "hil/hil_response.h"
#include "hil/hil_run.h"
#include "hil/hil_shm.h"
#include "hil/hil_signals.h"
#include "hil/hil_udp.h"
#include "offline/math/refuse.h"
#include "report/hil_report.h"
#include "report/hil_table.h"
#include "run/memory.h"
#include "run/recording.h"
#include "run/simulate.h"
#include "text/remarks.h"
#include "text/write.h"

namespace railstep {
namespace {

constexpr const char* kPolicies[] = {"stop", "skip", "catch-up", "free-run"};
constexpr int kPriority = 50;

struct HilOptions {
  std::string input, policy = "skip", udp, shm, names, report, record;
  std::vector<std::string> overrides;
  double rate = 0., duration = 0.;  // Hz, s
  std::optional<int> cpu, priority;
  std::optional<double> grace;                // s
  double silence = 0., ramp = .1, wait = 0.;  // s
  std::int64_t stall_frame = -1;
  double stall_us = 0.;
  bool respond = false, json = false;
};

Policy policy_of(const std::string& name) {
  const auto* const at = std::find(std::begin(kPolicies), std::end(kPolicies), name);
  return static_cast<Policy>(at - std::begin(kPolicies));
}

std::int64_t slots_of(const HilOptions& o) {
  const double slots = std::round(o.rate * o.duration);
  if (!(slots >= 1.) || !(slots <= 1e12))
    throw InputError(
        "E-HIL-01",
        fmt::format("--duration {:g}: at --rate {:g} the run has {:g} frames; expected 1 to 1e12",
                    o.duration, o.rate, slots));
  return static_cast<std::int64_t>(slots);
}

/// Whole frames of a time: 0 for a time of 0, at least 1 for any other.
std::int64_t frames_of(double seconds, double rate) {
  return seconds <= 0. ? 0 : std::max<std::int64_t>(1, std::llround(seconds * rate));
}

/// The schedule of the empty loop: a quarter of the run, half a second at most, at its rate or at
/// 100 Hz where that is slower. It is there to be measured, and no overrun ends it.
Schedule empty_schedule(const HilOptions& o, const Schedule& run) {
  constexpr double kSlowest = 100.;  // Hz
  const double rate = std::max(o.rate, kSlowest), seconds = std::min(.5, .25 * o.duration);
  return {1e9 / rate, std::clamp<std::int64_t>(std::llround(seconds * rate), 1, 1'000'000), 0,
          run.policy == Policy::stop ? Policy::skip : run.policy};
}

HilPlan plan_of(const HilOptions& o) {
  HilPlan plan;
  plan.schedule = {1e9 / o.rate, slots_of(o), 0, policy_of(o.policy)};
  const double grace = o.grace.value_or(std::min(.1, .1 * o.duration));
  if (grace > o.duration)
    throw InputError(
        "E-HIL-02",
        fmt::format("--grace {:g} is longer than the run; expected at most --duration, {:g}", grace,
                    o.duration));
  plan.schedule.grace = std::min<std::int64_t>(std::llround(grace * o.rate), plan.schedule.slots);
  plan.empty = empty_schedule(o, plan.schedule);
  // alone on its CPU and never asleep, it would shut out what runs there
  const bool free_run = plan.schedule.policy == Policy::free_run;
  plan.realtime = {o.cpu, o.priority.value_or(free_run ? 0 : kPriority)};
  plan.silence = frames_of(o.silence, o.rate);
  plan.ramp = std::max<std::int64_t>(1, frames_of(o.ramp, o.rate));
  plan.wait_s = o.wait;
  plan.stall_frame = o.stall_frame;
  plan.stall_ns = std::llround(1e3 * o.stall_us);
  plan.respond = o.respond;
  plan.interrupted = &interrupted_by_signal;
  if (o.cpu) {
    const std::vector<int> allowed = allowed_cpus();
    if (std::find(allowed.begin(), allowed.end(), *o.cpu) == allowed.end())
      throw InputError("E-HIL-03", fmt::format("--cpu {}: this process may not run on that CPU; "
                                               "expected one that it may use, of {} to {}",
                                               *o.cpu, allowed.empty() ? 0 : allowed.front(),
                                               allowed.empty() ? 0 : allowed.back()));
  }
  if ((o.silence > 0. || o.wait > 0. || o.respond) && o.udp.empty() && o.shm.empty())
    throw InputError("E-HIL-04",
                     "--silence, --wait or --response is given without an exchange; expected --udp "
                     "or --shm beside it");
  return plan;
}

std::unique_ptr<Simulation> simulation_of(const HilOptions& o) {
  if (!is_artefact(o.input)) return railstep::simulation_of(read_any_scene(o.input, o.overrides));
  if (!o.overrides.empty())
    throw InputError("E-RUN-03",
                     fmt::format("--set changes a scene, and {} is a model; expected the scene. "
                                 "Condense it again with --set",
                                 o.input));
  return std::make_unique<Simulation>(std::filesystem::path(o.input));
}

/// The names that are exchanged: the model's inputs and outputs, and the response where it is asked
/// for.
ExchangeLayout layout_of(const HilOptions& o, const HilPlan& plan, const Simulation& run) {
  ExchangeLayout layout{run.inputs(), run.columns(), plan.schedule.period_ns, o.cpu.value_or(-1)};
  if (!o.respond) return layout;
  if (run.model().external_wheels == 0)
    throw InputError(
        "E-HIL-06",
        fmt::format("--response: {} has no [[external_wheel]]; expected a scene with one",
                    o.input));
  Response::add_names(run, layout.inputs, layout.outputs);
  return layout;
}

/// The names of the values, in their order, with the sums that packets carry.
std::string names_text(const ExchangeLayout& layout) {
  std::string text;
  const auto add = [&text](const char* kind, const std::vector<std::string>& names) {
    text += fmt::format("{} {} {:08x}\n", kind, names.size(), names_sum(names));
    for (const std::string& name : names) text += name + '\n';
  };
  add("inputs", layout.inputs);
  add("outputs", layout.outputs);
  return text;
}

/// Where inputs come from and outputs go to.
struct Exchanges {
  Exchanges(const HilOptions& o, const ExchangeLayout& layout) {
    if (!o.udp.empty() && std::max(layout.inputs.size(), layout.outputs.size()) > kMostInPacket)
      throw InputError("E-HIL-07", fmt::format("--udp: {} outputs do not fit into a packet; "
                                               "expected at most {}. Use --shm, or fewer sensors",
                                               layout.outputs.size(), kMostInPacket));
    if (!o.udp.empty()) udp.emplace(o.udp, layout);
    if (!o.shm.empty()) shm.emplace(o.shm, layout);
    if (udp) all.push_back(&*udp);
    if (shm) all.push_back(&*shm);
  }
  std::optional<UdpExchange> udp;
  std::optional<SharedExchange> shm;
  std::vector<Exchange*> all;
};

nlohmann::ordered_json settings_json(const std::vector<RealtimeSetting>& settings) {
  nlohmann::ordered_json told = nlohmann::ordered_json::object();
  for (const RealtimeSetting& each : settings)
    told[each.name] = each.done ? "done" : "refused: " + each.reason;
  return told;
}

void add_exchanges(const Exchanges& exchanges, nlohmann::ordered_json& told) {
  if (exchanges.udp) {
    const PacketCounts& in = exchanges.udp->received();
    const SentCounts out = exchanges.udp->sent();
    told["packets"] = {
        {"good", in.good},         {"late", in.late},           {"lost", in.lost},
        {"repeated", in.repeated}, {"reordered", in.reordered}, {"foreign", in.foreign},
        {"sent", out.sent},        {"unheard", out.unheard},    {"dropped", out.dropped}};
  }
  if (exchanges.shm) {
    const SharedCounts& in = exchanges.shm->counts();
    told["shared_memory"] = {{"fresh", in.fresh}, {"late", in.late}, {"torn", in.torn}};
  }
}

nlohmann::ordered_json to_json(const HilOptions& o, const HilPlan& plan, const HilRecord& record,
                               const Simulation& run) {
  const Model& model = run.model();
  const double frame_s = model.scheme.dt * model.steps_per_frame;
  const Paced& paced = record.paced;
  nlohmann::ordered_json told = {
      {"rate_hz", o.rate},
      {"frame_us", quantiles(record.frame)},
      {"wakeup_us", quantiles(record.wakeup)},
      {"overruns", paced.overruns},
      {"empty_loop_us", record.empty_frame.quantile_us(.5)},
      {"status", status_names(record.status)},
      {"policy", o.policy},
      {"frames", paced.frames},
      {"skipped", paced.skipped},
      {"most_behind_us", static_cast<double>(paced.most_behind_ns) / 1e3},
      {"grace_frames", plan.schedule.grace},
      {"grace_overruns", paced.grace_overruns},
      {"frame_length_s", frame_s},
      {"steps_per_frame", model.steps_per_frame},
      {"real_time_factor", frame_s * o.rate},
      {"empty_loop",
       {{"frame_us", quantiles(record.empty_frame)},
        {"wakeup_us", quantiles(record.empty_wakeup)}}},
      {"realtime", settings_json(record.settings)},
      {"virtual_machine", is_virtual_machine()},
      {"allocations", record.allocations},
      {"page_faults", {{"minor", record.minor_faults}, {"major", record.major_faults}}},
      {"preemptions", record.preemptions},
      {"final_time_s", static_cast<double>(run.state.steps) * model.scheme.dt},
      {"state_hash", fmt::format("{:016x}", state_hash(model, run.state))},
      {"interrupted", record.interrupted},
      {"safe_stop_frame", nullptr}};
  if (record.safe_stop_frame >= 0) told["safe_stop_frame"] = record.safe_stop_frame;
  return told;
}

void warn_of_refusals(const std::vector<RealtimeSetting>& settings, Remarks& remarks) {
  for (const RealtimeSetting& each : settings)
    if (!each.done)
      remarks.warning({"W-HIL-01", fmt::format("the system refused {} ({}); the run goes on "
                                               "without it",
                                               each.name, each.reason)});
}

/// Why another process ended the run; nothing where none did.
std::optional<Failed> ended_by_others(const HilRecord& record) {
  if (record.lost)
    return Failed("E-HIL-09",
                  "--shm: another process cut the shared memory short or changed its first word, "
                  "and the run ended");
  if (record.interrupted) return Failed("E-HIL-16", "a signal ended the run");
  return std::nullopt;
}

/// Adds the reason why the run did not reach its end, or frames that were late.
void judge(const HilRecord& record, const Simulation& run, Remarks& remarks) {
  if (record.first_bad_unknown >= 0)
    return remarks.error(nonfinite_error(run, record.first_bad_unknown));
  if (record.paced.stopped)
    return remarks.error(
        {"E-HIL-17", fmt::format("frame {} ended {:.1f} us after its slot, and --policy stop "
                                 "ended the run",
                                 record.paced.frames - 1,
                                 1e-3 * static_cast<double>(record.paced.most_behind_ns))});
  if (const auto ended = ended_by_others(record))
    return remarks.error({ended->id(), ended->sentence()});
  if (record.safe_stop_frame >= 0)
    return remarks.error({"E-HIL-18", fmt::format("no inputs came for the time of --silence: a "
                                                  "safe stop brought them to 0 from frame {} on",
                                                  record.safe_stop_frame)});
  if (record.paced.overruns > 0)
    remarks.note(Message("W-HIL-02",
                         fmt::format("{} frames ended after their slot", record.paced.overruns)));
}

/// Prints what the run met.
Exit verdict(const HilRecord& record, Remarks& remarks) {
  for (const std::string& name : status_names(record.status))
    if (name != "nonfinite_state")
      fmt::print(stderr, "note: {}: {}\n", name, status_sentence(name, {}));
  remarks.print();
  return remarks.has_errors() ? Exit::not_reached : Exit::done;
}

/// A recording with one hash, behind the last frame: no hash is made while frames are timed.
std::optional<Recording> begun_recording(const HilOptions& o, const HilPlan& plan,
                                         const Simulation& run) {
  if (o.record.empty()) return std::nullopt;
  constexpr double kMostInputs = 1e9;  // 8 GB
  if (static_cast<double>(plan.schedule.slots) * run.model().inputs > kMostInputs)
    throw InputError("E-HIL-08", fmt::format("--record would keep {} inputs of {} frames; expected "
                                             "at most {:g} numbers. Shorten the run",
                                             run.model().inputs, plan.schedule.slots, kMostInputs));
  const std::int64_t numbers = plan.schedule.slots * run.model().inputs;
  want_recording_memory(numbers);
  Recording made = Recording::begin(run, plan.schedule.slots + 1);
  made.inputs.resize(static_cast<std::size_t>(numbers));
  return made;
}

void write_recording(const std::string& file, const Simulation& run, const HilRecord& record,
                     Recording& recording) {
  recording.frames = record.paced.frames;
  recording.inputs.resize(static_cast<std::size_t>(recording.frames * run.model().inputs));
  recording.finish(run);
  const std::vector<std::byte> bytes = recording.bytes();
  write_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Exit run(const HilOptions& o) {
  HilPlan plan = plan_of(o);
  const std::unique_ptr<Simulation> simulation = simulation_of(o);
  const ExchangeLayout layout = layout_of(o, plan, *simulation);
  std::optional<Recording> recording = begun_recording(o, plan, *simulation);
  if (recording) plan.given = recording->inputs.data();
  end_on_signals();  // from here on something would be left behind
  Exchanges exchanges(o, layout);
  if (!o.names.empty()) write_file(o.names, names_text(layout));
  const HilRecord record = run_paced(*simulation, plan, exchanges.all);
  if (exchanges.udp) exchanges.udp->finish();
  Remarks remarks;
  warn_of_refusals(record.settings, remarks);
  remarks.print();
  if (record.unheard) {
    if (const auto ended = ended_by_others(record)) throw Failed(*ended);
    fail("E-HIL-10",
         fmt::format("no inputs came within the {:g} s of --wait, and nothing was run", o.wait));
  }
  nlohmann::ordered_json told = to_json(o, plan, record, *simulation);
  add_exchanges(exchanges, told);
  if (recording) write_recording(o.record, *simulation, record, *recording);
  if (!o.report.empty())
    write_file(o.report,
               hil_report(std::filesystem::path(o.input).stem().string(), told,
                          {{"frame", &record.frame}, {"empty loop", &record.empty_frame}},
                          {{"run", &record.wakeup}, {"empty loop", &record.empty_wakeup}}));
  judge(record, *simulation, remarks);
  remarks.add_to(told);
  if (o.json)
    print_json(told);
  else
    print_hil_table(told);
  return verdict(record, remarks);
}

void add_exchange_options(CLI::App& sub, HilOptions& o) {
  sub.add_option("--udp", o.udp, "listen for inputs on HOST:PORT; outputs go to the sender");
  sub.add_option("--shm", o.shm, "shared memory of this name for inputs and outputs");
  sub.add_option("--names", o.names, "write the names of inputs and outputs to this file")
      ->check(writes_file());
  sub.add_flag(
      "--response", o.respond,
      "add the compliance of the track under external wheels in the next frame to each output");
  sub.add_option("--wait", o.wait, "s to wait for the first inputs before the clock starts (0)")
      ->check(within(0., 1e6));
  CLI::Option* silence =
      sub.add_option("--silence", o.silence,
                     "s without inputs after which they go to 0 for good; 0: they are held (0)")
          ->check(within(0., 1e6));
  sub.add_option("--ramp", o.ramp, "s in which they go to 0 (0.1)")
      ->check(within(0., 1e6))
      ->needs(silence);
}

}  // namespace

Command add_hil(CLI::App& app) {
  auto o = std::make_shared<HilOptions>();
  CLI::App* sub = app.add_subcommand("hil", "Run paced by the clock, with inputs and outputs");
  sub->add_option("SCENE", o->input, "scene file (TOML) or model file")
      ->required()
      ->check(reads_file());
  sub->add_option("--rate", o->rate, "frames a second")->required()->check(within(1e-3, 1e6));
  sub->add_option("--duration", o->duration, "s by the clock")
      ->required()
      ->check(within(1e-6, 1e9));
  sub->add_option("--policy", o->policy,
                  "for frames that end late: stop, skip (default), "
                  "catch-up or free-run")
      ->check(CLI::IsMember({"stop", "skip", "catch-up", "free-run"}));
  sub->add_option("--grace", o->grace, "s at the start that are not counted (0.1 or a tenth)")
      ->check(within(0., 1e9));
  sub->add_option("--cpu", o->cpu, "CPU to which the stepping thread is pinned")
      ->check(within(0, 1 << 20));
  sub->add_option("--priority", o->priority,
                  "priority of SCHED_FIFO, 1 to 99 (50; free-run 0); 0: none is requested")
      ->check(within(0, 99));
  add_exchange_options(*sub, *o);
  sub->add_option("--report", o->report, "write a page with histograms (HTML)")
      ->check(writes_file());
  sub->add_option("--record", o->record, "write model and inputs, for `railstep replay`")
      ->check(writes_file());
  CLI::Option* stall_frame =
      sub->add_option("--stall-frame", o->stall_frame, "a frame that is made late, as a test")
          ->check(within(std::int64_t{0}, std::int64_t{1} << 40));
  CLI::Option* stall_us = sub->add_option("--stall-us", o->stall_us, "us that it takes longer")
                              ->check(within(0., 1e8))
                              ->needs(stall_frame);
  stall_frame->needs(stall_us);
  add_overrides(*sub, o->overrides);
  sub->add_flag("--json", o->json, "one JSON object on stdout");
  sub->footer(
      "Example: railstep hil track.model --rate 1000 --duration 10 --cpu 1 --report hil.html");
  return {sub, [o] { return run(*o); }};
}

}  // namespace railstep
