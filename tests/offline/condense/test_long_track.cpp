#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "online/track/track_sensor.h"
#include "support/block_mutations.h"
#include "support/condensed_tracks.h"
#include "support/fine_track.h"

using namespace railstep;

namespace {

constexpr int kBays = 200;

/// One rail on springs, or on sleepers and ballast.
Track long_track(bool sleepers) {
  Track t = peers_track(1);
  t.bays = kBays;
  if (!sleepers) return t;
  t.support.stiffness = {50e6, 50e6, 200e6};
  t.sleeper = Sleeper{150., 84.5, {20e6, 20e6, 50e6}, {}};
  return t;
}

Functional seat_of(const Track& t, int seat) {
  return {.rail = {{{0, seat * t.bay_length, 0., 0., 2}, 1.}}};
}

double largest(const std::vector<double>& values, std::size_t first, std::size_t last) {
  double most = 0.;
  for (std::size_t i = first; i < last; ++i) most = std::max(most, std::abs(values[i]));
  return most;
}

}  // namespace

TEST_CASE("a functional's table ends where its value is negligible", "[flexibility]") {
  const Track t = long_track(GENERATE(false, true));
  const int seat = GENERATE(0, 3, 90, kBays);
  const std::vector<Line> lines = assemble(t);
  const ResidualFlexibility residual(t, lines, {}, kPoints);
  const LoadPoint load_point{0, kHeadZ};
  const Functional functional = seat_of(t, seat);
  const std::vector<double> whole = residual.from(load_point, functional);
  const auto near = residual.near({load_point}, functional);
  CAPTURE(seat, near.at.first, near.at.last);
  CHECK(near.at.count() > 2);
  CHECK(near.at.count() < kBays / 2);
  const double peak = exact_line(t, lines[0], kPoints)
                          ->from(load_point, functional, kPoints, {0, t.elements()})
                          .lpNorm<Eigen::Infinity>();
  constexpr std::size_t places = kPoints + 1;  // per element
  const std::size_t first = places * static_cast<std::size_t>(near.at.first),
                    last = places * static_cast<std::size_t>(near.at.last);
  REQUIRE(near.value.size() == last - first);
  std::vector<double> difference = near.value;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= whole[first + i];
  CHECK(largest(difference, 0, difference.size()) < 1e-12 * peak);
  CHECK(largest(whole, first, last) > 1e-4 * peak);
  CHECK(largest(whole, 0, first) <= 1.01e-8 * peak);
  CHECK(largest(whole, last, whole.size()) <= 1.01e-8 * peak);
}

TEST_CASE("on a long track pads near a load and far from it move as in statics", "[flexibility]") {
  const Track t = long_track(false);
  const double place = GENERATE(.1, 30.17, 60.4, 119.7);  // m, inside elements
  Traffic traffic;
  traffic.loads = {{.rail = 0, .start = place, .stop = 2. * kBays, .force = -50e3, .z = kHeadZ}};
  for (int seat = 0; seat <= kBays; ++seat)
    traffic.track_sensors.push_back({.displacement = 1., .track = seat_of(t, seat)});
  ModelRun run = in_equilibrium(t, traffic, {generalised_alpha(1e-3, .6), 1, true, kPoints});
  REQUIRE(run.model().track_sensor.elements < run.model().track_sensor.tables * kBays / 2);
  run.step();
  std::vector<double> got(traffic.track_sensors.size());
  read_track_sensors(run.model(), run.state, run.outputs, got.data());
  const Statics fine([&] {
    Track divided = t;
    divided.elements_per_bay = kPoints;
    return divided;
  }());
  const auto moved = fine.solve({{{0, place, 0., kHeadZ, 2}, -50e3}});
  double peak = 0., error = 0.;
  for (int seat = 0; seat <= kBays; ++seat) {
    const double want = exact(fine, seat_of(t, seat), moved);
    peak = std::max(peak, std::abs(want));
    error = std::max(error, std::abs(got[static_cast<std::size_t>(seat)] - want));
  }
  CAPTURE(place, peak, error / peak);
  CHECK(error < 2e-5 * peak);  // cubics read tables of eight intervals per element
}

TEST_CASE("the error of a vertical track's few unknowns does not grow with its length",
          "[flexibility]") {
  // The squeeze under a force lengthens the rail, which must not push springs along it: with one at
  // each node 10 000 bays gave 1.2e-9 less than 40. The ends of the 40 bays matter by 3e-12.
  const auto under_middle = [](int bays) {
    Track t = long_track(false);
    t.unknowns = Unknowns::vertical;
    t.support.stiffness[0] = 0.;  // pads would hold it
    t.support.height_z = -.085;   // and squeeze it over each seat
    t.bays = bays;
    const std::vector<Line> lines = assemble(t);
    const Functional middle{.rail = {{{0, .5 * t.length(), 0., kHeadZ, 2}, 1.}}};
    return exact_line(t, lines[0], kPoints)->flexibility({middle}, middle)[0];
  };
  CHECK_THAT(under_middle(10000), Catch::Matchers::WithinRel(under_middle(40), 1e-11));
}

TEST_CASE("tables beyond the track or inside one another are refused", "[artefact]") {
  const Track t = long_track(false);
  Traffic traffic;
  traffic.loads = {{.rail = 0, .start = 30., .stop = 90., .force = -50e3}};
  for (const int seat : {50, 60})
    traffic.track_sensors.push_back({.displacement = 1., .track = seat_of(t, seat)});
  const PackedModel packed(t, traffic, {generalised_alpha(1e-3, .6), 1, true, kPoints});
  const TrackSensorModel& track_sensor = packed.model().track_sensor;
  REQUIRE(track_sensor.tables == 2);
  const auto status = [&](std::vector<std::int32_t> first, std::vector<std::int32_t> ends) {
    Model model = packed.model();
    model.track_sensor.first = first.data();
    model.track_sensor.ends = ends.data();
    return status_of(to_block(model, ""));
  };
  const std::int32_t a = track_sensor.first[0], b = track_sensor.first[1],
                     middle = track_sensor.ends[1], all = track_sensor.elements;
  CHECK(status({a, b}, {0, middle, all}) == LoadStatus::ok);
  const std::int32_t last = packed.model().elements - (all - middle);
  CHECK(status({a, last}, {0, middle, all}) == LoadStatus::ok);
  const LoadStatus bad = LoadStatus::bad_content;
  CHECK(status({a, last + 1}, {0, middle, all}) == bad);
  CHECK(status({-1, b}, {0, middle, all}) == bad);
  CHECK(status({a, b}, {1, middle, all}) == bad);
  CHECK(status({a, b}, {0, middle, all - 1}) == bad);
  CHECK(status({a, b}, {0, all + 1, all}) == bad);
  CHECK(status({a, b}, {0, -1, all}) == bad);
}
