#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "offline/irregularity/defect.h"
#include "offline/pack/step_compliance.h"
#include "support/endless_run.h"

using namespace railstep;

namespace {

constexpr double kHeadHeight = .1;  // m above the axis

Traffic wheelset_traffic(double start) {
  Wheelset w;
  w.mass = 1200.;
  w.inertia_roll = w.inertia_yaw = 700.;
  w.inertia_spin = 100.;
  w.weight = 98.1e3;
  w.start = start;
  w.speed = kSpeed;
  return {.wheelsets = {w}, .head = {kHeadHeight, .3, .035}};
}

/// A model with NaN in everything that its lines and levers hold of elements that it leaves out.
struct Poisoned {
  Model model;
  std::vector<std::vector<double>> reals;
  std::vector<std::vector<std::int32_t>> tables;

  explicit Poisoned(const Model& of) : model(of) {
    const auto elements = static_cast<std::size_t>(of.elements);
    std::vector<bool> met(elements, false);
    for (std::int32_t l = 0; l < of.lines; ++l)
      for (std::size_t i = 0; i < 27 * elements; ++i)
        if (of.line[l].unknown_of[0][i] >= 0) met[i / 27] = true;
    const auto first =
        static_cast<std::size_t>(std::find(met.begin(), met.end(), true) - met.begin());
    for (std::int32_t l = 0; l < of.lines; ++l) {
      LineModel& line = model.line[l];
      const std::ptrdiff_t values = std::ptrdiff_t{line.modal.rows} * 2 * line.modal.count;
      std::vector<double>& shape = reals.emplace_back(line.modal.shape, line.modal.shape + values);
      shape.resize(shape.size() + 2 * static_cast<std::size_t>(line.modal.count), kNan);
      for (const std::int32_t*& table : line.unknown_of) {
        std::vector<std::int32_t>& own = tables.emplace_back(table, table + 27 * elements);
        for (std::size_t i = 0; i < own.size(); ++i)
          if (!met[i / 27] && own[27 * first + i % 27] >= 0) own[i] = line.modal.rows;
        table = own.data();
      }
      ++line.modal.rows;
      line.modal.shape = shape.data();
    }
    const std::size_t places =
        std::size_t{kPDeltaSeats} * (static_cast<std::size_t>(of.p_delta.points) + 1);
    for (const double*& lever : model.p_delta.lever) {
      std::vector<double>& own = reals.emplace_back(lever, lever + elements * places);
      for (std::size_t i = 0; i < own.size(); ++i)
        if (!met[i / places]) own[i] = kNan;
      lever = own.data();
    }
    CHECK(std::count(met.begin(), met.end(), false) > 0);
  }
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
};
}  // namespace

TEST_CASE("a wheelset on a ring or a window has the forces of a long track with a fine mesh") {
  // The bound of docs/endless.md is 1e-3 of the peak for means over 1 ms, which show the force
  // below 440 Hz (-3 dB).
  const Track track = endless_track(70, 6, 2);
  ModelRun reference(track, wheelset_traffic(12.), framed({.scheme = generalised_alpha(kDt, .6)}));
  reference.packed->set_start(start_in_equilibrium(track, *reference.packed, 0.));
  reset(reference.model(), reference.state);
  const Heard want = listen(reference, 600, 40);
  const auto check = [&](const char* what, ModelRun run) {
    const Heard got = listen(run, 600, 40);
    const double force = largest(got.force, want.force), rail = largest(got.rail, want.rail);
    CAPTURE(what, force, rail);
    CHECK(force < 1e-3);
    CHECK(rail < 1e-3);
  };
  const Track ring = ring_of(endless_track(32, 4, 2)), window = window_of(endless_track(32, 6, 2));
  check("ring", moving_run(ring, wheelset_traffic(0.), ring_options(ring, 3, kDt)));
  check("window", moving_run(window, wheelset_traffic(0.), window_options(window, kDt)));
}

TEST_CASE("a wheelset starts in motion without a jolt") {
  // The force swings with the bays, at the start as later. The start settles to 1e-9 of the
  // displacement under the wheel, 4e-13 m: 4e-4 N by the contact's 1e9 N/m, 1e-8 of the force. A
  // start in static equilibrium leaves more, which must show.
  const Track ring = ring_of(endless_track(24, 2, 2));
  const auto strayed = [&](const std::vector<double>& start, ModelRun& run) {
    run.packed->set_start(start);
    reset(run.model(), run.state);
    const Heard first = listen(run, 0, 20), later = listen(run, 1000, 20);
    return largest(first.force, later.force);
  };
  ModelRun run(ring, wheelset_traffic(0.), framed(ring_options(ring, 2, kDt)));
  const double moving = strayed(start_moving(ring, *run.packed, 0.), run);
  const double still = strayed(start_in_equilibrium(ring, *run.packed, 0.), run);
  CAPTURE(moving, still);
  CHECK(moving < 1e-7);
  CHECK(still > 1e-3);
}

TEST_CASE("a wheel meets a joint at a kilometre once, and not once in each turn of the ring") {
  const Track ring = ring_of(endless_track(24, 2, 2));  // 14.4 m
  Traffic traffic = wheelset_traffic(0.);
  ModelRun smooth = moving_run(ring, traffic, ring_options(ring, 2, kDt));
  traffic.irregularities.push_back({0, 2, dipped_joint(20.1, 1e-3, .5, {.01, 0.})});
  ModelRun run = moving_run(ring, traffic, ring_options(ring, 2, kDt));
  std::vector<double> met;  // x of frames in which the joint shows, m
  for (int frame = 0; frame < 2000; ++frame) {
    run.step();
    smooth.step();
    const double more = run.outputs.contact_force_peak[0] - smooth.outputs.contact_force_peak[0];
    if (std::abs(more) > 5e3) met.push_back(run.outputs.contact_x[0]);
  }
  REQUIRE(!met.empty());
  // From the start of the ramp to the end of the track's oscillation, within 2 m.
  CHECK(met.front() > 19.5);
  CHECK(met.back() < 22.1);
  CHECK_THAT(run.outputs.contact_x[0], Catch::Matchers::WithinAbs(60., .01));
}

TEST_CASE("no step reads the elements of a ring that traffic never reaches") {
  // The rails roll over their seats, the wheelset rolls over a joint of one rail, and bays pass.
  Track ring = ring_of(endless_track(24, 2, 2));
  ring.unknowns = Unknowns::full;
  ring.support.stiffness = {50e6, 50e6, 120e6};
  ring.support.damping = {10e3, 10e3, 30e3};
  ring.support.roll_stiffness = .3e6;
  ring.support.height_z = -.085;
  Traffic traffic = wheelset_traffic(0.);
  traffic.loads = {moving_load(-1.7), moving_load(-1.7, 1), moving_load(2.3), moving_load(2.3, 1)};
  traffic.irregularities.push_back({0, 2, dipped_joint(1.3, 1e-3, .5, {.01, 0.})});
  ModelRun run = moving_run(ring, traffic, ring_options(ring, 2, kDt));
  const Poisoned poisoned(run.model());
  LoadedRun beside(poisoned.model);
  CHECK(beside.frames(100) == Status::ok);
  for (int frame = 0; frame < 100; ++frame) run.step();
  CHECK(std::abs(run.body()[3]) > 1e-6);  // it rolls
  CHECK(state_hash(run.model(), run.state) == state_hash(poisoned.model, beside.state));
  // Nor does the model's making: its compliance within a step is that of the bays under traffic.
  const std::vector<double> give =
      StepCompliance(run.model(), run.packed->lines())
          .table(run.packed->load_points()[0], 8, run.model().residual.elements);
  REQUIRE(give.size() == 2 * 9);
  CHECK(*std::min_element(give.begin(), give.end()) > 0.);
  CHECK_THAT(give.front(), Catch::Matchers::WithinRel(give.back(), 1e-9));  // a bay and the next
}

TEST_CASE("a window moves along its track without a jump") {
  // A decay length is 7 characteristic lengths: the motion falls to e^-7 over it. The window cuts
  // e^-21 off and the long track's start has decayed to e^-20; a jump of 1e-6 shows.
  const Track track = endless_track(200, 2), window = window_of(endless_track(80, 2));
  ModelRun far(track, {.loads = {moving_load(30.)}}, {.scheme = generalised_alpha(1e-3, .6)});
  ModelRun near(window, {.loads = {moving_load(0.)}}, window_options(window));
  for (ModelRun* run : {&far, &near}) {
    const Track& own = run == &far ? track : window;
    run->packed->set_start(start_in_equilibrium(own, *run->packed, 0.));
    reset(run->model(), run->state);
  }
  double worst = 0.;
  for (int n = 0; n < 2000; ++n) {
    far.step();
    near.step();
    worst =
        std::max(worst, std::abs(far.outputs.load_deflection[0] - near.outputs.load_deflection[0]));
    CHECK_THAT(near.outputs.load_x[0] + 30.,
               Catch::Matchers::WithinAbs(far.outputs.load_x[0], 1e-12));
  }
  CHECK(worst < 1e-6 * std::abs(far.outputs.load_deflection[0]));
}

TEST_CASE("a track without end continues from its block and from a saved state bit by bit") {
  const Track ring = ring_of(endless_track(24, 2, 2));
  ModelRun run = moving_run(ring, wheelset_traffic(0.), ring_options(ring, 2, kDt));
  check_goes_on(run);
}

TEST_CASE("a track that cannot be without end is refused in one sentence") {
  const Track ring = ring_of(endless_track(24, 2));
  const auto refused = [](const Track& track, const Traffic& traffic, const PackOptions& options,
                          const char* id) {
    CHECK_THROWS_WITH(PackedModel(track, traffic, options), Catch::Contains(id));
  };
  const Traffic one{.loads = {moving_load(0.)}};
  const Track small = ring_of(endless_track(6, 2));
  refused(small, one, ring_options(small, 1), "E-PACK-33");
  const Track narrow = endless_track(12, 2);
  refused(narrow, one, window_options(narrow), "E-PACK-51");
  Traffic two{.loads = {moving_load(0.), moving_load(1.)}};
  two.loads[1].speed = 20.;
  refused(ring, two, ring_options(ring, 1), "E-PACK-31");
  refused(ring, one, window_options(ring), "E-PACK-32");
  Track held = ring;
  held.ends = {RailEnd::pinned, RailEnd::free};
  refused(held, one, ring_options(held, 1), "no ends");
}
