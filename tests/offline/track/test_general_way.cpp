// A symmetric track has one solution: in mirror coordinates and as one line of both rails and their
// sleepers.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "offline/analysis/modes.h"
#include "offline/analysis/statics.h"
#include "online/track/track_sensor.h"
#include "support/condensed_tracks.h"
#include "support/fine_track.h"

using namespace railstep;

namespace {

/// Sleepers that move in every direction, pads of two halves off the axis, a seat without ballast
/// and one with a pad ten times as soft, equal on both sides.
Track uneven_sleepers(Unknowns unknowns) {
  Track t = sleeper_track(1);
  t.unknowns = unknowns;
  t.bays = 8;
  t.support.damping = {3e4, 3e4, 3e4};
  t.support.roll_damping = 1e2;
  t.support.half_spread = .05;
  t.sleeper = Sleeper{300., 169., {20e6, 20e6, 50e6}, {3e4, 3e4, 80e3}};
  Seat hanging = t.seat(3), soft = t.seat(5);
  hanging.ballast = {};
  for (Support& pad : soft.pad) pad.stiffness = {5e6, 5e6, 20e6};
  t.changed_seats = {{3, hanging}, {5, soft}};
  return t;
}

/// The same with pads of 0.16 m on sleepers that pitch.
Track with_lengths(Track t) {
  t.bays = 6;
  t.changed_seats.clear();
  t.support.length = .16;
  t.sleeper->pitch_inertia = 8.;
  t.sleeper->ballast_length = .26;
  return t;
}

Track generally(Track t) {
  t.mirror_coordinates = false;
  return t;
}

/// Different loads on both rails, on the head and on the axis; or a wheelset that leans.
Traffic two_loads() {
  Traffic traffic;
  traffic.loads = {{.rail = 0, .start = .7, .speed = 30., .stop = 3.4, .force = -50e3, .z = kHeadZ},
                   {.rail = 1, .start = 1.1, .speed = 30., .stop = 3.4, .force = -20e3}};
  return traffic;
}

Traffic one_wheelset() {
  Wheelset w;
  w.mass = 1200.;
  w.inertia_roll = w.inertia_yaw = 700.;
  w.inertia_spin = 100.;
  w.weight = 100e3;
  w.start = 1.3;
  w.speed = 30.;
  return {.wheelsets = {w}, .head = {.1007375, .3, .038}};
}

/// Sensors on a pad, on sleepers' ends and on railheads of both sides, at rest and in motion.
std::vector<TrackSensor> track_sensors(const Track& track) {
  std::vector<TrackSensor> found;
  for (const int rail : {0, 1}) {
    found.push_back({.displacement = -200e6, .velocity = -3e4, .track = pad_gap(track, rail, 4)});
    for (int d = 0; d < 3; ++d) {
      found.push_back({.displacement = 1., .track = at_point({rail, 2.5, 0., kHeadZ, d})});
      found.push_back({.velocity = 1., .track = {.sleeper = {{rail, 3, d, 1.}}}});
    }
  }
  return found;
}

/// All outputs of the frames, by kind: pad forces, displacements, velocities, deflections, wheel
/// forces, rail heights.
struct Trace {
  std::vector<std::size_t> kind;          // for each column
  std::vector<std::vector<double>> rows;  // frame by frame
};

Trace trace(ModelRun run, int frames) {
  Trace found;
  for (std::int32_t i = 0; i < run.model().track_sensor.count; ++i)
    found.kind.push_back(i % 7 == 0 ? 0 : 1 + static_cast<std::size_t>(i % 7 - 1) % 2);
  for (std::int32_t i = 0; i < run.model().loads; ++i) found.kind.push_back(3);
  for (std::int32_t i = 0; i < 2 * run.model().wheelsets; ++i) {
    found.kind.push_back(4);
    found.kind.push_back(5);
  }
  std::vector<double> values(static_cast<std::size_t>(run.model().track_sensor.count));
  for (int i = 0; i < frames; ++i) {
    run.step();
    read_track_sensors(run.model(), run.state, run.outputs, values.data());
    std::vector<double> row = values;
    for (std::int32_t l = 0; l < run.model().loads; ++l)
      row.push_back(run.outputs.load_deflection[l]);
    for (std::int32_t w = 0; w < 2 * run.model().wheelsets; ++w) {
      row.push_back(run.outputs.contact_force[w]);
      row.push_back(run.outputs.contact_rail_z[w]);
    }
    found.rows.push_back(row);
  }
  CHECK_FALSE(has(run.seen, Status::off_rail));
  return found;
}

/// Largest difference in a column, over the largest value of its kind: lateral motions that cancel
/// in mirror images are the rounding of vertical ones.
double largest_difference(const Trace& a, const Trace& b) {
  std::array<double, 6> peak{}, difference{};
  for (std::size_t i = 0; i < a.rows.size(); ++i)
    for (std::size_t column = 0; column < a.kind.size(); ++column) {
      const std::size_t kind = a.kind[column];
      peak[kind] = std::max(peak[kind], std::abs(a.rows[i][column]));
      difference[kind] =
          std::max(difference[kind], std::abs(a.rows[i][column] - b.rows[i][column]));
    }
  double worst = 0.;
  for (std::size_t kind = 0; kind < peak.size(); ++kind)
    if (peak[kind] > 0.) worst = std::max(worst, difference[kind] / peak[kind]);
  return worst;
}

}  // namespace

TEST_CASE("mirror coordinates and one line have the same static solution", "[supports]") {
  const Unknowns unknowns = GENERATE(Unknowns::full, Unknowns::vertical);
  Track track = uneven_sleepers(unknowns);
  if (GENERATE(false, true)) track = with_lengths(track);
  const Statics mirror(track), general(generally(track));
  CHECK(mirror.lines().size() > general.lines().size());
  const int directions = unknowns == Unknowns::full ? 3 : 1;
  for (int from = 0; from < directions; ++from)
    for (int to = 0; to < directions; ++to)
      for (const int rail : {0, 1}) {
        const RailPoint a{0, 2.5, 0., kHeadZ, 2 - from}, b{rail, 3.1, .02, kFootZ, 2 - to};
        CAPTURE(from, to, rail);
        // One factor has entries of K from 1e5 to 1e11 N/m: 1e6 roundings of 1e-16 each.
        CHECK(std::abs(mirror.flexibility(a, b) - general.flexibility(a, b)) <
              1e-9 * mirror.flexibility(a, a));
      }
}

TEST_CASE("mirror coordinates and one line have the same natural frequencies", "[supports]") {
  const Track track = uneven_sleepers(Unknowns::full);
  std::vector<double> mirrored, whole;
  for (const Line& line : assemble(track))
    for (const double f : modes(line).frequency) mirrored.push_back(f);
  for (const Line& line : assemble(generally(track)))
    for (const double f : modes(line).frequency) whole.push_back(f);
  std::sort(mirrored.begin(), mirrored.end());
  std::sort(whole.begin(), whole.end());
  REQUIRE(mirrored.size() == whole.size());
  // A dense solver is good to 1e-16 of the highest eigenvalue, (38 kHz)^2: 2e-10 of (30 Hz)^2.
  for (std::size_t i = 0; i < whole.size(); ++i)
    CHECK(std::abs(whole[i] - mirrored[i]) < 1e-8 * mirrored[i]);
}

TEST_CASE("mirror coordinates and one line give the same trace", "[supports]") {
  const Unknowns unknowns = GENERATE(Unknowns::full, Unknowns::vertical);
  const bool contact = GENERATE(false, true);
  const bool condensed_lines = GENERATE(false, true);
  Track track = uneven_sleepers(unknowns);
  if (!contact) track = with_lengths(track);
  Traffic traffic = contact ? one_wheelset() : two_loads();
  traffic.track_sensors = track_sensors(track);
  const double dt = contact ? 1e-4 : 1e-3;
  PackOptions options = condensed_lines ? condensed(track, 0., dt) : full_order(dt);
  if (condensed_lines)
    options.reduction = Reduction{.limit = {100000, 1500.}};  // every line up to 1500 Hz
  options.steps_per_frame = contact ? 5 : 1;
  const Trace mirror = trace(in_equilibrium(track, traffic, options), 60);
  const Trace general = trace(in_equilibrium(generally(track), traffic, options), 60);
  CAPTURE(unknowns == Unknowns::full, contact, condensed_lines);
  // The statics has 1e-9, and a penetration of 1e-4 m reacts to rounding in a deflection of 1e-3.
  // Damped modes are complete to 1e-7, and a basis leaves out shapes whose square is 1e-10.
  CHECK(largest_difference(mirror, general) < (condensed_lines ? 1e-6 : 1e-8));
}

TEST_CASE("a wheelset that leans moves the same in mirror coordinates and in one line",
          "[supports]") {
  const Track track = uneven_sleepers(Unknowns::full);
  Traffic traffic = one_wheelset();
  traffic.wheelsets[0].speed = 0.;
  traffic.track_sensors = track_sensors(track);
  const auto leaning = [&](const Track& t) {
    ModelRun run(t, traffic, full_order(5e-5));
    run.state.u[run.model().wheelset[0].first + 3] = 2e-3;  // rad
    run.state.u[run.model().wheelset[0].first + 2] = 1.5e-3;
    return trace(std::move(run), 400);
  };
  CHECK(largest_difference(leaning(track), leaning(generally(track))) < 1e-8);
}
