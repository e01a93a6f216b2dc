#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "offline/vehicle/kinds.h"
#include "online/track/track_sensor.h"
#include "support/condensed_tracks.h"
#include "support/sections.h"
#include "support/vehicles.h"

using namespace railstep;

namespace {

constexpr int kLadderBays = 24, kSeat = 12;

/// One rail 60E1 on pads, sleepers and ballast.
Track long_rail(int elements_per_bay) {
  Track t = s1_track(kLadderBays, elements_per_bay);
  t.unknowns = Unknowns::vertical;
  t.rails = 1;
  t.support.damping = {0., 0., 20e3};
  t.support.height_z = 0.;
  return t;
}

/// 50 kN at 30 m/s in steady motion, with sensors on the pad and the sleeper of the middle seat.
Traffic passing(const Track& track) {
  const double x = kSeat * track.bay_length;
  const Functional gap{.rail = {{{0, x, 0., 0., 2}, 1.}}, .sleeper = {{0, kSeat, 2, -1.}}};
  return {.loads = {{.start = 3., .speed = 30., .stop = 14.4, .force = -50e3}},
          .track_sensors = {{.displacement = -200e6, .velocity = -20e3, .track = gap},
                            {.displacement = 1., .track = {.sleeper = {{0, kSeat, 2, 1.}}}}}};
}

using Row = std::array<double, 3>;  // deflection under the load, m; pad, N; sleeper, m

/// Every ms from .1 s, when the start is over, to .28 s.
std::vector<Row> rows_of(int elements_per_bay, PackOptions options, int steps_per_frame) {
  const Track track = long_rail(elements_per_bay);
  options.steps_per_frame = steps_per_frame;
  ModelRun run = in_equilibrium(track, passing(track), options);
  std::vector<Row> rows;
  for (int frame = 1; frame <= 280; ++frame) {
    run.step();
    double track_sensor[2];
    read_track_sensors(run.model(), run.state, run.outputs, track_sensor);
    if (frame >= 100)
      rows.push_back({run.outputs.load_deflection[0], track_sensor[0], track_sensor[1]});
  }
  CHECK(run.seen == Status::ok);
  return rows;
}

Row errors(const std::vector<Row>& got, const std::vector<Row>& want) {
  Row worst{}, peak{};
  for (std::size_t i = 0; i < want.size(); ++i)
    for (std::size_t c = 0; c < worst.size(); ++c) {
      worst[c] = std::max(worst[c], std::abs(got[i][c] - want[i][c]));
      peak[c] = std::max(peak[c], std::abs(want[i][c]));
    }
  for (std::size_t c = 0; c < worst.size(); ++c) worst[c] /= peak[c];
  return worst;
}

PackOptions options_of(ReductionKind kind, double per_bay, bool residual) {
  Reduction reduction{.kind = kind,
                      .limit = {static_cast<int>(kLadderBays * per_bay), kUnlimited},
                      .expansion_hz = {20., 84., 356., 1500.}};
  return {.scheme = held_force(2e-4, .6), .residual_flexibility = residual, .reduction = reduction};
}

}  // namespace

TEST_CASE("each rung of the ladder is as accurate as stated", "[ladder]") {
  // Full order of the same elements, with a small step, leaves only the mesh's error.
  const std::vector<Row> want = rows_of(2, full_order(2.5e-5), 40);
  const Row of_reference = errors(rows_of(2, full_order(5e-5), 20), want);
  CAPTURE(of_reference[0], of_reference[1], of_reference[2]);
  CHECK(of_reference[0] < 5e-5);  // twice the step errs three times as much as the reference
  struct Rung {
    const char* name;
    ReductionKind kind;
    double per_bay;
    Row most;     // with residual flexibility
    double bare;  // least error of the deflection without it
  };
  // Deflections: a prototype had 3.6e-4 with two modes per bay and no damper's shape, 6e-5 with
  // complex modes and 2e-5 with Craig and Bampton's, all with six coordinates per bay. It did not
  // have Guyan's, which must stay near the 1e-3 of design section 8. Pads: a difference of
  // displacements 5 times as large, at a seat that the load passes in two frames.
  const Rung rungs[] = {{"modal", ReductionKind::modal, 2., {3.6e-4, 5e-3, 1e-3}, 1e-2},
                        {"guyan", ReductionKind::guyan, 0., {2e-3, 5e-3, 2e-3}, 5e-2},
                        {"irs", ReductionKind::irs, 0., {1e-4, 5e-3, 1e-3}, 1e-2},
                        {"cb", ReductionKind::craig_bampton, 4., {4e-5, 5e-3, 1e-3}, 5e-3},
                        {"krylov", ReductionKind::krylov, 4., {1e-4, 5e-3, 1e-3}, 5e-3},
                        {"complex", ReductionKind::complex_modes, 4., {6e-5, 5e-3, 1e-3}, 5e-3}};
  for (const Rung& rung : rungs) {
    const Row with = errors(rows_of(2, options_of(rung.kind, rung.per_bay, true), 5), want);
    const Row bare = errors(rows_of(2, options_of(rung.kind, rung.per_bay, false), 5), want);
    CAPTURE(std::string(rung.name), with[0], with[1], with[2], bare[0], bare[1], bare[2]);
    for (std::size_t c = 0; c < with.size(); ++c) CHECK(with[c] < rung.most[c]);
    CHECK(bare[0] > rung.bare);
  }
}

TEST_CASE("a model of any kind starts in its own equilibrium and stays there", "[ladder]") {
  const Track track = long_rail(2);
  Traffic standing = passing(track);
  standing.loads[0].start = 7.3;
  standing.loads[0].speed = 0.;
  for (const ReductionKind kind :
       {ReductionKind::modal, ReductionKind::guyan, ReductionKind::irs,
        ReductionKind::craig_bampton, ReductionKind::krylov, ReductionKind::complex_modes}) {
    ModelRun run = in_equilibrium(track, standing, options_of(kind, 2., true));
    double start[2], end[2];
    run.step();  // a step publishes the load's place
    read_track_sensors(run.model(), run.state, run.outputs, start);
    run.until(.1);
    read_track_sensors(run.model(), run.state, run.outputs, end);
    CAPTURE(static_cast<int>(kind), start[1], end[1]);
    // Sums over some 100 modes round; completeness holds to 1e-9.
    CHECK(std::abs(end[0] - start[0]) < 1e-8 * std::abs(start[0]));
    CHECK(std::abs(end[1] - start[1]) < 1e-8 * std::abs(start[1]));
  }
}

TEST_CASE("a wheel that goes back and forth over borders and bays gains no energy", "[ladder]") {
  Track track = s1_track(6, 1);
  track.unknowns = Unknowns::vertical;
  track.rails = 1;
  track.support.damping = {0., 0., 20e3};
  track.support.height_z = 0.;
  // A wheel of 600 kg under 5 t moves at +-24 m/s in turn: 1.2 m back and forth every .2 s, over
  // three seats and as many borders of elements.
  constexpr int kTrips = 10'000;
  constexpr double kPeriod = .2, kFast = 24.;
  RunningVehicle wheel = running(point_mass(600.), 1.2, 0.);
  wheel.vehicle.bodies[0].carried = 5e3;
  for (int trip = 0; trip < kTrips; ++trip)
    for (const auto& [part, speed] : {std::pair(0., 0.), {.25, kFast}, {.75, -kFast}})
      wheel.speeds.insert(wheel.speeds.end(), {(trip + part) * kPeriod, speed});
  wheel.speeds.insert(wheel.speeds.end(), {kTrips * kPeriod, 0.});
  for (const ReductionKind kind :
       {ReductionKind::modal, ReductionKind::guyan, ReductionKind::irs,
        ReductionKind::craig_bampton, ReductionKind::krylov, ReductionKind::complex_modes}) {
    PackOptions options{.scheme = held_force(1e-3, .6),
                        .steps_per_frame = 200,
                        .reduction = Reduction{
                            .kind = kind, .limit = {6, kUnlimited}, .expansion_hz = {20., 400.}}};
    ModelRun run = in_equilibrium(track, {.vehicles = {wheel}, .head = kHead}, options);
    std::vector<double> peak;
    for (int trip = 0; trip < kTrips; ++trip) {
      run.step();
      peak.push_back(run.outputs.contact_force_peak[0]);
    }
    const double first = *std::max_element(peak.begin() + 100, peak.begin() + 1100),
                 last = *std::max_element(peak.end() - 1000, peak.end());
    CAPTURE(static_cast<int>(kind), first, last);
    CHECK_FALSE(has(run.seen, Status::nonfinite_state));
    CHECK(first > 5600. * 9.81);
    // The motion repeats: it neither grows nor decays.
    CHECK(last < first * (1. + 1e-6));
    CHECK(last > first * (1. - 1e-6));
  }
}
