#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "examples/sprung_wheel.h"
#include "hil/hil_response.h"
#include "hil/hil_run.h"
#include "online/step/step.h"
#include "support/hil_peers.h"
#include "support/program.h"
#include "support/shipped.h"
#include "support/started.h"

using namespace railstep;
using Catch::Contains;

namespace {

const std::string kTrack = kScenes + "open_track.toml";
const std::string kTwoWheels =
    "external_wheel=[{name=\"a\", rail=\"left\", limit_n=1e6}, {name=\"b\", rail=\"right\", "
    "limit_n=1e6}]";
constexpr double kDt = 1e-3, kHertz = 9e10;
constexpr int kFrames = 200;
/// Places of one wheel in the packets: from the start of what is sent, from the end of the answer.
enum { kPlace = 0, kForce = 4, kNextPlace = 5, kSent = 7, kAnswer = 11, kFreeZ = 4, kGive = 10 };

std::unique_ptr<Simulation> open_track() {
  return simulation_of(read_any_scene(kTrack, {"step.dt_s=1e-3", "step.frame_s=1e-3"}));
}

ExchangeLayout layout_of(const Simulation& run) {
  ExchangeLayout layout{run.inputs(), run.columns(), 1e6, -1};
  Response::add_names(run, layout.inputs, layout.outputs);
  return layout;
}

HilPlan plan_of(std::int64_t frames) {
  HilPlan plan;
  plan.schedule = {1e6, frames, 0, Policy::free_run};
  plan.empty = plan.schedule;
  plan.empty.slots = 1;
  plan.respond = true;
  return plan;
}

/// The vehicle of tools/examples, which sends a packet for each one that it receives.
struct Rider {
  ::Scheme scheme = scheme_of(kDt);
  ::Vehicle vehicle{};
  int made = 0;

  double place(int frame) const { return kStart + kSpeed * (frame * kDt); }
  /// Closes the contact of the next frame. @returns the force on the rail
  double close(double free_z, double give) {
    const double force = closed_contact(&scheme, &vehicle, kHertz, free_z, give);
    vehicle = moved(&scheme, &vehicle, force);
    ++made;
    return -force;
  }
  Values answer(const double* came) {
    const double force = close(came[kFreeZ], came[kGive]);
    return {place(made), 0., 0., 0., force, place(made + 1), 0.};
  }
};

/// Forces on the rail if vehicle and track are in one program, and the track's state at the end.
struct Coupled {
  Values force;
  std::uint64_t hash = 0;
};

Coupled in_one_program() {
  const auto run = open_track();
  Outputs outputs{};
  publish_start(run->model(), run->state, outputs);
  Rider rider;
  Coupled all;
  for (int n = 1; n <= kFrames; ++n) {
    Values in = {rider.place(n), 0., 0., 0., 0.};
    double free[3], compliance[9];
    REQUIRE(external_response(run->model(), in.data(), run->state, run->workspace, free,
                              compliance) == Status::ok);
    in[kForce] = rider.close(free[2], compliance[8]);
    REQUIRE(advance_frame(run->model(), in.data(), run->state, run->workspace, outputs) ==
            Status::ok);
    all.force.push_back(in[kForce]);
  }
  all.hash = state_hash(run->model(), run->state);
  return all;
}

/// Makes each frame wait for its inputs, so that no clock decides which inputs it takes.
class LockStep : public Exchange {
 public:
  explicit LockStep(Exchange& of) : of_(of) {}
  const double* inputs(std::int64_t frame) noexcept override {
    const double* came = of_.inputs(frame);
    while (came == nullptr && !deadline_.passed()) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      came = of_.inputs(frame);
    }
    return came;
  }
  void outputs(const FrameOutputs& made) noexcept override { of_.outputs(made); }

 private:
  Exchange& of_;
  Deadline deadline_;  // of all frames
};

/// Forces of a vehicle that is reached only by packets.
/// @param track  steps the track until it has made its frames
template <class Track>
Values ride(const ExchangeLayout& layout, Peer& peer, Track&& track) {
  Values force;
  std::thread vehicle([&] {
    Rider rider;
    Values came(layout.outputs.size());
    peer.send(-1, {0., 0., 0., 0., 0., rider.place(1), 0.});
    for (int n = 0; n < kFrames; ++n) {
      if (peer.receive(came) != n - 1) return;
      const Values sent = rider.answer(came.data() + came.size() - kAnswer);
      force.push_back(sent[kForce]);
      peer.send(n, sent);
    }
  });
  track();
  vehicle.join();
  return force;
}

Coupled by_packets(const std::string& way) {
  const auto run = open_track();
  const ExchangeLayout layout = layout_of(*run);
  HilPlan plan = plan_of(kFrames);
  plan.wait_s = 60.;
  Coupled all;
  const auto with = [&](Exchange& exchange, Peer& peer) {
    LockStep lock_step(exchange);
    all.force = ride(layout, peer, [&] { run_paced(*run, plan, {&lock_step}); });
  };
  if (way == "udp") {
    const std::uint16_t port = free_port();
    UdpExchange exchange("127.0.0.1:" + std::to_string(port), layout);
    UdpPeer peer(layout, port);
    with(exchange, peer);
  } else {
    const std::string name = "railstep_response_" + std::to_string(getpid());
    SharedExchange exchange(name, layout);
    SharedPeer peer(layout, name);
    with(exchange, peer);
  }
  all.hash = state_hash(run->model(), run->state);
  return all;
}

/// Gives the inputs of two wheels for every frame but one and keeps the outputs.
struct Script : Exchange {
  static constexpr int kSilent = 7;
  std::vector<Values> given, made;
  const double* inputs(std::int64_t frame) noexcept override {
    return frame == kSilent ? nullptr : given[static_cast<std::size_t>(frame)].data();
  }
  void outputs(const FrameOutputs& of) noexcept override {
    std::copy_n(of.values, made[next_].size(), made[next_].begin());
    ++next_;
  }

 private:
  std::size_t next_ = 0;
};

double x_at(int wheel, int frame) { return 4. + .7 * wheel + .03 * frame; }

}  // namespace

TEST_CASE("a vehicle reached only by packets gives the same bits as a vehicle in one program",
          "[hil][response]") {
  const Coupled want = in_one_program();
  CHECK(*std::min_element(want.force.begin(), want.force.end()) < -5e4);
  for (const char* way : {"udp", "shm"}) {
    CAPTURE(way);
    const Coupled got = by_packets(way);
    CHECK(got.force == want.force);
    CHECK(got.hash == want.hash);
  }
}

TEST_CASE("the response in each output is that of the next frame", "[hil][response]") {
  const std::vector<std::string> words = {
      "load=[]",        kTwoWheels,          "track.unknowns=\"full\"",
      "step.dt_s=1e-3", "step.frame_s=1e-3", "support.stiffness_roll_n_m_per_rad=1e6"};
  constexpr int kMade = 20;
  for (const char* kind : {"full", "modal"}) {
    std::vector<std::string> scene = words;
    scene.push_back(std::string("condense.kind=\"") + kind + "\"");
    const auto read = [&] { return read_any_scene(kScenes + "moving_load.toml", scene); };
    const auto run = simulation_of(read()), beside = simulation_of(read());
    const ExchangeLayout layout = layout_of(*run);
    REQUIRE(layout.inputs.size() == 14);
    CHECK(layout.inputs[10] == "a.next_x_m");
    CHECK(layout.inputs[13] == "b.next_y_m");
    const std::size_t columns = run->columns().size();
    REQUIRE(layout.outputs.size() == columns + 4 + 6 + 21);
    CHECK(layout.outputs[columns + 4] == "a.free_dx_m");
    CHECK(layout.outputs[columns + 10 + 1] == "a.dy_per_a.force_x_m_per_n");
    CHECK(layout.outputs.back() == "b.dz_per_b.force_z_m_per_n");
    Script script;
    script.made.assign(kMade + 2, Values(layout.outputs.size()));
    for (int n = 0; n <= kMade; ++n)
      script.given.push_back({x_at(0, n), .001, 10., 200., -5e4 - 100. * n, x_at(1, n), 0., 0., 0.,
                              -4e4, x_at(0, n + 1), .001, x_at(1, n + 1), 0.});
    const HilRecord record = run_paced(*run, plan_of(kMade), {&script});
    REQUIRE(record.paced.frames == kMade);

    Outputs outputs{};
    publish_start(beside->model(), beside->state, outputs);
    Values next(10, 0.);
    for (int frame = -1; frame < kMade; ++frame) {
      CAPTURE(kind, frame);
      if (frame >= 0) {
        const int of = frame == Script::kSilent ? frame - 1 : frame;  // the inputs are held
        const Values& in = script.given[static_cast<std::size_t>(of)];
        static_cast<void>(
            advance_frame(beside->model(), in.data(), beside->state, beside->workspace, outputs));
        next = {in[10], in[11], 0., 0., 0., in[12], in[13], 0., 0., 0.};
      }
      double free[6], compliance[36];
      static_cast<void>(external_response(beside->model(), next.data(), beside->state,
                                          beside->workspace, free, compliance));
      const double* at = script.made[static_cast<std::size_t>(frame) + 1].data() + columns;
      for (const int place : {0, 1, 5, 6}) CHECK(*at++ == next[static_cast<std::size_t>(place)]);
      for (const double each : free) CHECK(*at++ == each);
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j <= i; ++j) CHECK(*at++ == compliance[6 * i + j]);
    }
    CHECK(state_hash(beside->model(), beside->state) == state_hash(run->model(), run->state));
  }
}

TEST_CASE("a place that meets a limit sets its status bit one frame earlier", "[hil][response]") {
  const auto run = open_track();
  Script script;
  script.made.assign(4, Values(layout_of(*run).outputs.size()));
  struct Told : Exchange {
    Script& script;
    std::vector<Status> status;
    explicit Told(Script& of) : script(of) { status.reserve(8); }
    const double* inputs(std::int64_t frame) noexcept override { return script.inputs(frame); }
    void outputs(const FrameOutputs& of) noexcept override { status.push_back(of.status); }
  } told(script);
  for (int n = 0; n < 3; ++n) script.given.push_back({3., 0., 0., 0., -1e3, n == 1 ? -1. : 3., 0.});
  const HilRecord record = run_paced(*run, plan_of(3), {&told});
  const std::vector<Status> want = {Status::ok, Status::ok, Status::off_rail, Status::ok,
                                    Status::ok};  // the start, the frames, the last one again
  CHECK(told.status == want);
  CHECK(record.status == Status::ok);  // no frame was made at that place
}

TEST_CASE("the example's vehicle, paced over UDP, rides as that of the C interface",
          "[hil][response][cli]") {
  const auto folder = fresh_folder("hil_response");
  const auto file = [&](const char* name) { return (folder / name).string(); };
  REQUIRE(railstep_program("condense " + kTrack + " --set step.dt_s=1e-3 --set step.frame_s=1e-3" +
                           " --out " + file("model"))
              .code == 0);
  const Ran own = run_program(OWN_VEHICLE, file("model") + " 0.05 9e10");
  REQUIRE(own.code == 0);
  // On a busy machine a frame may be made before its forces came, which is another ride: the test
  // then repeats it with more time for each frame.
  Ran vehicle{1, {}, {}};
  for (int rate = 100; rate >= 10 && vehicle.code != 0; rate -= 30) {
    std::filesystem::remove(file("names"));
    const std::string address = "127.0.0.1:" + std::to_string(free_port());
    Started track("hil " + file("model") + " --rate " + std::to_string(rate) + " --duration " +
                  std::to_string(70. / rate) + " --response --wait 60 --json --names " +
                  file("names") + " --udp " + address);
    track.await(std::filesystem::path(file("names")));
    vehicle = run_program(HIL_VEHICLE, address + " " + file("names") + " 1e-3 0.05 9e10");
    const Ran hil = track.end();
    CAPTURE(hil.err, vehicle.err);
    REQUIRE(hil.code == 0);
    CHECK_THAT(hil.out, Contains("\"allocations\": 0"));
  }
  REQUIRE(vehicle.code == 0);
  CHECK(vehicle.out == own.out);
}

TEST_CASE("a response without external wheels or without an exchange is refused",
          "[hil][response][cli]") {
  const Ran alone = railstep_program("hil " + kTrack + " --rate 100 --duration 0.1 --response");
  CHECK(alone.code == 2);
  CHECK_THAT(alone.err, Contains("E-HIL-04"));
  const Ran without = railstep_program("hil " + kScenes +
                                       "moving_load.toml --rate 100 --duration 0.1 --response "
                                       "--shm railstep_no_wheel");
  CHECK(without.code == 2);
  CHECK_THAT(without.err, Contains("moving_load.toml") && Contains("E-HIL-06"));
}
