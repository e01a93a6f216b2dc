// Quantities of running behaviour and ride from the rows of a trace.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "answer/assessment.h"
#include "answer/scene_running.h"
#include "answer/track_sections.h"
#include "online/math/pi.h"
#include "support/scene_run.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

const char* const kFloor =
    "sensor=[{name=\"floor\", on=\"vehicle\", vehicle=\"car\", x_m=9.5, z_m=0.5}]";

/// A run whose rows a test states instead of the steps.
struct StatedRun {
  explicit StatedRun(const Scene& own) : scene(own), run(own) {}
  template <typename Value>
  void state(const std::string& column, Value value) {
    const auto& columns = run.columns();
    const auto at = std::find(columns.begin(), columns.end(), column) - columns.begin();
    REQUIRE(at < static_cast<std::ptrdiff_t>(columns.size()));
    for (std::size_t r = 0; r < rows; ++r)
      record.rows[r * columns.size() + static_cast<std::size_t>(at)] =
          value(static_cast<double>(r) * interval);
  }
  void begin(double seconds) {
    interval = run.model().scheme.dt * static_cast<double>(run.model().steps_per_frame);
    rows = static_cast<std::size_t>(std::lround(seconds / interval)) + 1;
    record.rows.assign(rows * run.columns().size(), 0.);
  }
  [[nodiscard]] AssessedVehicle assessed() const { return assess(scene, run, record).at(0); }

  const Scene& scene;
  Simulation run;
  RunRecord record;
  double interval = 0.;
  std::size_t rows = 0;
};

double of(const AssessedSection& section, Assessed quantity) {
  for (const AssessedValue& value : section.values)
    if (value.quantity == quantity) return value.value;
  FAIL("the section lacks " << text_of(quantity).key);
  return 0.;
}

std::vector<SectionKind> kinds_of(const std::vector<TrackSection>& sections) {
  std::vector<SectionKind> kinds(sections.size());
  std::transform(sections.begin(), sections.end(), kinds.begin(),
                 [](const TrackSection& own) { return own.kind; });
  return kinds;
}

double butterworth(double hz, double corner) {
  return 1. / std::sqrt(1. + std::pow(hz / corner, 8));
}

}  // namespace

TEST_CASE("sections follow the design line", "[running_behaviour]") {
  LineShape line;
  CHECK(sections_between(line, 0., 1010.).size() == 4);
  CHECK(sections_between(line, 5., 60.).size() == 1);
  line.curvature = {100., 0., 200., 2e-3, 500., 2e-3, 600., 0.};
  line.cant = {100., 0., 200., .1, 500., .1, 600., 0.};
  const std::vector<TrackSection> sections = sections_between(line, 0., 1100.);
  using enum SectionKind;
  CHECK(kinds_of(sections) ==
        std::vector{straight, transition, curve, curve, curve, transition, straight, straight});
  CHECK(sections[2].from == 200.);
  CHECK(sections[2].to == Approx(300.));
  CHECK(sections[2].radius == Approx(500.));
  CHECK(sections[3].from == sections[2].to);
  CHECK(sections.front().from == 0.);
  CHECK(sections.back().to == 1100.);
  // A curve goes on where a table has a row more; one of another radius is another curve.
  line.curvature = {0., 2e-3, 10., 2e-3, 50., 2e-3};
  line.cant.clear();
  CHECK(sections_between(line, 0., 60.).size() == 1);
  line.curvature = {50., 2e-3, 50.001, 3e-3};
  const std::vector<TrackSection> two = sections_between(line, 0., 100.);
  REQUIRE(two.size() == 2);
  CHECK(two[0].to == Approx(50.).margin(.01));
  // Rows that are close, with and without noise.
  line.curvature.clear();
  for (int i = 0; i <= 2000; ++i) {
    const double x = .25 * i, noise = 3e-6 * std::sin(i * 37.);
    line.curvature.insert(line.curvature.end(), {x, noise + (x < 100.   ? 0.
                                                             : x < 250. ? (x - 100.) / 150. / 3000.
                                                                        : 1. / 3000.)});
  }
  const std::vector<TrackSection> close = sections_between(line, 0., 500.);
  CHECK(kinds_of(close) == std::vector{straight, transition, curve});
  CHECK(close[1].from == Approx(100.).margin(6.));
  CHECK(close[1].to == Approx(250.).margin(6.));
}

TEST_CASE("stated waves give the closed forms of filters, windows and percentiles",
          "[running_behaviour]") {
  const Scene scene = read_scene(shipped("manchester_straight"), {kFloor});
  StatedRun stated(scene);
  stated.begin(25.);
  constexpr double kSpeed = 60., kHz = 7.2;  // 100 m are 12 waves, 250 m 30
  const auto wave = [&](double t) { return 10e3 * std::sin(2. * kPi * kHz * t); };
  stated.state("car.leading_1.sum_y_n", wave);
  stated.state("car.trailing_2_left.q_n", [&](double t) { return 60e3 + wave(t); });
  stated.state("floor.ay_m_per_s2", [&](double t) { return 1e-4 * wave(t); });
  stated.state("floor.az_m_per_s2", [&](double t) { return .5e-4 * wave(t); });
  const AssessedVehicle vehicle = stated.assessed();
  REQUIRE(vehicle.sections.size() == 6);
  const AssessedSection& section = vehicle.sections[2];
  CHECK(section.kind == SectionKind::straight);
  CHECK(section.speed == kSpeed);
  CHECK(section.across == 0.);
  const double low = butterworth(kHz, 20.), x = kPi * kHz * 2. / kSpeed;
  // 0.15 % of the time a wave is beyond cos(0.0015 pi) of its height.
  const double reached = std::cos(.0015 * kPi);
  CHECK(of(section, Assessed::sum_y) == Approx(10e3 * low * std::sin(x) / x).epsilon(2e-3));
  CHECK(of(section, Assessed::q) == Approx(60e3 + 10e3 * low * reached).epsilon(2e-4));
  CHECK(of(section, Assessed::unstable_sum_y) ==
        Approx(10e3 / std::sqrt(2.) * butterworth(kHz, kHz + 2.) /
               std::sqrt(1. + std::pow((kHz - 2.) / kHz, 8)))
            .epsilon(2e-3));
  const double band = butterworth(kHz, 10.) / std::sqrt(1. + std::pow(.4 / kHz, 8));
  CHECK(of(section, Assessed::body_y) == Approx(band * reached).epsilon(1e-3));
  CHECK(of(section, Assessed::body_z_rms) == Approx(.5 * band / std::sqrt(2.)).epsilon(2e-3));

  // The other wheels have no load in these rows: all of it is missing.
  CHECK(of(section, Assessed::unloading) == 1.);
  const double load = .5 * (32000. + 2. * 2615. + 4. * 1813.) * 9.81 / 4.;
  const LimitedBy by{kSpeed, load};
  for (const AssessedValue& value : section.values)
    if (value.quantity == Assessed::sum_y)
      CHECK(value.limit == Approx(10e3 + 2. * load / 3.).epsilon(1e-4));
  CHECK(limit_of(Assessed::q, by) == Approx(90e3 + load));
  CHECK(limit_of(Assessed::q, {60., 150e3}) == 180e3);
  CHECK(limit_of(Assessed::q, {40., 150e3}) == 200e3);

  REQUIRE(vehicle.ride.size() == 1);
  const RideComfort& ride = vehicle.ride[0];
  CHECK(ride.blocks == 5);
  const double f2 = kHz * kHz, rest = 1. - .277 * f2, imaginary = 1.563 * kHz - .0368 * kHz * f2;
  const double b =
      std::sqrt((1.911 * f2 + .0625 * f2 * f2) / (rest * rest + imaginary * imaginary));
  CHECK(ride.index_y == Approx(std::pow(100. * .737 * b, .3)).epsilon(2e-3));
  CHECK(ride.index_z == Approx(std::pow(50. * .588 * b, .3)).epsilon(2e-3));
  CHECK(ride.comfort == Approx(6. * std::hypot(ride.weighted_y, ride.weighted_z)));
  // Sections that are alike deviate little.
  for (const EstimatedValue& own : vehicle.estimates)
    if (own.quantity == Assessed::q) {
      CHECK(own.sections == 6);
      CHECK(own.estimate == Approx(60e3 + 10e3 * low).epsilon(2e-2));
    }
}

TEST_CASE("a steady curve has the steady values", "[running_behaviour]") {
  const std::string still = "vehicle[0].speed_m_per_s=28.0";
  const Scene scene =
      read_scene(shipped("manchester_curve"), {kFloor, still, "step.duration_s=6.0"});
  Simulation run(scene);
  const RunRecord record = simulate(run, run.model().steps / run.model().steps_per_frame, {}, true);
  const AssessedVehicle vehicle = assess(scene, run, record).at(0);
  REQUIRE(vehicle.sections.size() == 1);
  const AssessedSection& section = vehicle.sections[0];
  CHECK(section.kind == SectionKind::curve);
  CHECK(section.radius == Approx(600.));
  const double roll = -std::asin(.1 / 1.5),
               across = 28. * 28. / 600. * std::cos(roll) + 9.81 * std::sin(roll);
  CHECK(section.across == Approx(across).epsilon(1e-9));
  double y = 0., q = 0., sum = 0., heat = 0.;
  const RunningLoads loads = running_loads(scene);
  for (const WheelLoad& wheel : loads.wheels) {
    y = std::max(y, std::fabs(wheel.y));
    q = std::max(q, wheel.q);
  }
  for (const WheelsetLoad& set : loads.wheelsets) {
    sum = std::max(sum, std::fabs(set.sum_y));
    heat += set.resistance;
  }
  CHECK(of(section, Assessed::y_quasistatic) == Approx(y).epsilon(1e-6));
  CHECK(of(section, Assessed::q_quasistatic) == Approx(q).epsilon(1e-6));
  CHECK(of(section, Assessed::sum_y) == Approx(sum).epsilon(1e-6));
  for (const AssessedValue& value : section.values)  // nothing hunts
    CHECK((value.quantity != Assessed::unstable_sum_y || value.value < 1e-6 * sum));
  CHECK(of(section, Assessed::body_y) < 1e-5);
  // A floor that leans outwards feels its part of gravity besides.
  const auto column = [&](const std::string& name) {
    const auto& all = run.columns();
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), name) - all.begin());
  };
  const std::size_t last = record.rows.size() - run.columns().size();
  const double leans = record.rows[last + column("car.car.roll_rad")];
  CHECK(leans > 1e-3);
  CHECK(of(section, Assessed::body_y_quasistatic) == Approx(across + 9.81 * leans).epsilon(2e-3));
  double all = 0.;
  for (const std::string& name : run.columns())
    if (name.ends_with(".t_gamma_n")) all += record.rows[last + column(name)];
  CHECK(all == Approx(heat).epsilon(1e-6));
}

TEST_CASE("Nadal's limit is that of a flange of 70 degrees", "[running_behaviour]") {
  const Scene scene =
      read_scene(shipped("manchester_s1002"), {"step.duration_s=0.01", "contact.friction=0.4"});
  Simulation run(scene);
  const RunRecord record = simulate(run, 10, {}, true);
  const double flank = std::tan(70. * kPi / 180.);
  const AssessedVehicle vehicle = assess(scene, run, record).at(0);
  CHECK(vehicle.nadal == Approx((flank - .4) / (1. + .4 * flank)).epsilon(1e-3));
  CHECK(vehicle.sections.empty());  // 0.4 m are too short
}

TEST_CASE("a vehicle that goes against the track or stands", "[running_behaviour]") {
  const auto sections = [](const std::string& speed) {
    const Scene scene = read_scene(shipped("manchester_straight"),
                                   {"vehicle[0].speed_m_per_s=" + speed, "step.duration_s=1.0"});
    Simulation run(scene);
    const RunRecord record =
        simulate(run, run.model().steps / run.model().steps_per_frame, {}, true);
    return assess(scene, run, record).at(0).sections;
  };
  CHECK(sections("0.0").empty());
  const std::vector<AssessedSection> back = sections("-20.0");
  REQUIRE(back.size() == 1);
  CHECK(back[0].to - back[0].from == Approx(20.));
  CHECK(back[0].speed == 20.);
}

TEST_CASE("accelerations in a transition do not depend on the frame", "[running_behaviour]") {
  const auto felt = [](const std::string& frame) {
    const Scene scene =
        read_scene(shipped("manchester_curve"),
                   {kFloor, "line.curvature_table=[[60.0,0.0],[110.0,2e-3]]",
                    "line.cant_table=[[60.0,0.0],[110.0,0.1]]", "vehicle[0].speed_m_per_s=25.0",
                    "step.dt_s=5e-4", "step.frame_s=" + frame, "step.duration_s=6.0"});
    Simulation run(scene);
    const RunRecord record =
        simulate(run, run.model().steps / run.model().steps_per_frame, {}, true);
    const AssessedVehicle vehicle = assess(scene, run, record).at(0);
    return std::array{of(vehicle.sections.at(1), Assessed::body_y), vehicle.ride.at(0).comfort};
  };
  const auto each = felt("5e-4"), fourth = felt("2e-3");
  CHECK(fourth[0] == Approx(each[0]).epsilon(.01));
  CHECK(fourth[1] == Approx(each[1]).epsilon(.02));
  CHECK(each[0] < .5);
}
