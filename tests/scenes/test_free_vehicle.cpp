// Vehicles that roll freely: forces drive them, creep carries the forces of their wheels, and at a
// standstill it is a spring.
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "offline/contact/hertz.h"
#include "offline/energy/energy_account.h"
#include "support/scene_run.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

// A wheelset that carries a vehicle, with cylinders as wheels and creep without spin.
constexpr double kCarried = 15e3, kAxleSpin = 100., kAxleRadius = .46, kBothCreep = 18e6,
                 kGrip = .3;
constexpr double kFollows = .011;  // in which creep follows
constexpr double kCarriedWeight = kCarried * 9.81;

Scene wheelset(const std::string& forces, const Words& more = {}, double spin = kAxleSpin) {
  Words words = {
      "contact={wheel=\"cone\",rail=\"crown\",normal=\"hertz\",slope=0.0,creep=\"she\","
      "friction=0.3,relaxation_m=0.011,kalker=[9e6,9e6,0.0,0.0]}",
      "vehicle=[{name=\"car\",type=\"rail_vehicle\",drive=\"force\",speed_m_per_s=0.0,"
      "wheelset=[{name=\"axle\",mass_kg=15000.0,inertia_kg_m2=[700.0," +
          std::to_string(spin) +
          ",700.0],radius_m=0.46,place_m=0.0}],element=[{name=\"guide\",type=\"bushing\","
          "between=[\"axle\",\"ground\"],point_m=[0.0,0.0,0.46],stiffness_n_per_m=[0.0,5e5,0.0],"
          "stiffness_n_m_per_rad=[0.0,0.0,5e5]}],force=[" +
          forces + "]}]"};
  words.insert(words.end(), more.begin(), more.end());
  return read_scene(shipped("manchester_straight"), words);
}

std::string force(const std::string& direction, const std::string& table) {
  return "{body=\"axle\",direction=\"" + direction + "\",table=[" + table + "]}";
}

std::string brake(const std::string& table) {
  return "],brake=[{name=\"disc\",wheelset=\"axle\",on=\"ground\",table=[" + table + "]}";
}

/// From the axle to the contact, m.
double lever() {
  const double hertz = hertz_constant(kAxleRadius, .3, 210e9, .3);
  return kAxleRadius - std::pow(.5 * kCarriedWeight / hertz, 2. / 3.);
}

/// Linear creep over the limit at which Shen, Hedrick and Elkins' law has this part of the limit.
double linear_part(double of_limit) {
  double low = 0., high = 3.;
  for (int i = 0; i < 60; ++i) {
    const double u = .5 * (low + high);
    (u - u * u / 3. + u * u * u / 27. < of_limit ? low : high) = u;
  }
  return low;
}

/// The passenger vehicle on rough, rigid rails.
Scene vehicle(const std::string& drive, double speed) {
  return read_scene(shipped("manchester_straight"),
                    {"vehicle[0].drive=\"" + drive + "\"",
                     "vehicle[0].speed_m_per_s=" + std::to_string(speed), "step.duration_s=1.0",
                     "irregularity={spectrum=\"german_low\",geometries=[\"vertical\",\"alignment\","
                     "\"cross_level\"]}"});
}

}  // namespace

TEST_CASE("a wheelset under a moment gains the speed that its creep leaves it", "[free_vehicle]") {
  for (const char* step : {"step.dt_s=1e-3", "step.dt_s=1e-4"}) {
    const Traced run(wheelset(force("pitch", "[0.0,1e4]"), {step, "step.duration_s=5.0"}));
    const double arm = lever(), time = 5.;
    const double rolling = 1e4 * time / (arm * (kCarried + kAxleSpin / (arm * arm)));
    // The rim is faster by the creepage of the force.
    const double limit = kGrip * kCarriedWeight, push = kCarried * rolling / time;
    const double creepage = linear_part(push / limit) * limit / kBothCreep;
    const double expected = rolling * (1. - creepage * (kAxleSpin / (arm * arm)) /
                                                (kCarried + kAxleSpin / (arm * arm)));
    INFO(step);
    CHECK(run["car.speed_m_per_s"].back() == Approx(expected).epsilon(2e-5));
    CHECK(run["car.x_m"].back() == Approx(.5 * expected * time).epsilon(1e-3));
    CHECK_FALSE(has(run.status, Status::full_slip));
  }
}

TEST_CASE("a wheelset that spins pushes with its friction", "[free_vehicle]") {
  for (const char* step : {"step.dt_s=1e-3", "step.dt_s=1e-4"}) {
    const Traced run(
        wheelset(force("pitch", "[0.0,0.0],[0.001,3e4]"), {step, "step.duration_s=2.0"}));
    INFO(step);
    CHECK(run["car.speed_m_per_s"].back() ==
          Approx(kGrip * kCarriedWeight / kCarried * 2.).epsilon(5e-4));
    CHECK(has(run.status, Status::full_slip));
    CHECK_FALSE(has(run.status, Status::cap_reached));
  }
}

TEST_CASE("a wheelset that does not turn hangs on its contacts, and does not creep",
          "[free_vehicle]") {
  // 3 % of its weight; a moment holds the wheels, whose inertia is beyond measure.
  const double push = .03 * kCarriedWeight;
  const std::string up = "[0.0,0.0],[1.0," + std::to_string(push) + "]",
                    held = "[0.0,0.0],[1.0," + std::to_string(-push * lever()) + "]";
  for (const char* step : {"step.dt_s=1e-3", "step.dt_s=1e-4"}) {
    const Traced run(wheelset(force("x", up) + "," + force("pitch", held),
                              {step, "step.frame_s=0.01", "step.duration_s=10.0"}, 1e9));
    const double limit = kGrip * kCarriedWeight;
    const double hangs = kFollows * linear_part(push / limit) * limit / kBothCreep;
    const std::vector<double> x = run["car.x_m"];
    INFO(step);
    CHECK(x.back() == Approx(hangs).epsilon(1e-3));
    CHECK(std::fabs(x.back() - x[300]) < 1e-9);
    CHECK(std::fabs(run["car.speed_m_per_s"].back()) < 1e-10);
  }
}

TEST_CASE("a vehicle without a drive runs as one with it, and slows down", "[free_vehicle]") {
  const Traced with(vehicle("speed", 60.)), without(vehicle("force", 60.));
  CHECK(relative_difference(without["car.leading_1.y_m"], with["car.leading_1.y_m"]) < 1e-3);
  CHECK(relative_difference(without["car.leading_1_left.q_n"], with["car.leading_1_left.q_n"]) <
        5e-3);
  // On rails that are even its resistance is that of its drive.
  const Words even = {"step.duration_s=2.0"};
  const Traced pushed(read_scene(shipped("manchester_straight"), even));
  Words rolls = even;
  rolls.push_back("vehicle[0].drive=\"force\"");
  const Traced free(read_scene(shipped("manchester_straight"), rolls));
  const double resistance = pushed["car.drive_n"].back();
  // 32 t, two frames of 2615 kg, four wheelsets of 1813 kg that turn.
  const double mass = 32e3 + 2. * 2615. + 4. * (1813. + 112. / (.46 * .46));
  CHECK(resistance > 10.);
  CHECK(free["car.speed_m_per_s"].back() == Approx(60. - 2. * resistance / mass).epsilon(1e-6));
}

TEST_CASE("a vehicle that rolls back is the mirror image of one that rolls ahead",
          "[free_vehicle]") {
  // Its bodies are alike to both sides.
  const auto run = [](const char* speed) {
    return Traced(
        read_scene(shipped("manchester_straight"),
                   {std::string("vehicle[0].speed_m_per_s=") + speed, "vehicle[0].drive=\"force\"",
                    "step.duration_s=0.5",
                    "vehicle[0].force=[{body=\"car\",direction=\"y\",table=[[0.0,2e4]]}]"}));
  };
  const Traced ahead = run("30.0"), back = run("-30.0");
  CHECK(relative_difference(back["car.leading_1.y_m"], ahead["car.trailing_2.y_m"]) < 1e-9);
  CHECK(back["car.speed_m_per_s"].back() == Approx(-ahead["car.speed_m_per_s"].back()));
}

TEST_CASE("a wheelset that rolls to a stand and back makes no energy", "[free_vehicle]") {
  // It meets a hill of 3 %.
  const double push = -.03 * kCarriedWeight;
  for (const char* step : {"step.dt_s=1e-3", "step.dt_s=2.5e-4"}) {
    const Scene scene =
        wheelset(force("x", "[0.0,0.0],[0.5,0.0],[0.6," + std::to_string(push) + "]"),
                 {step, "step.duration_s=10.0", "vehicle[0].speed_m_per_s=1.0"});
    const Traced run(scene);
    const std::vector<double> v = run["car.speed_m_per_s"];
    const double mass = kCarried + kAxleSpin / (kAxleRadius * kAxleRadius);
    INFO(step);
    CHECK(v.back() == Approx(1. + push / mass * 9.45).epsilon(1e-3));
    CHECK_FALSE(has(run.status, Status::full_slip));
    const Simulation made(scene);
    CHECK(balance_of(*made.packed(), made.model(), made.model().steps).error < 1e-5);
  }
}

TEST_CASE("a braked wheelset stops, stands on a slope and rolls away", "[free_vehicle]") {
  // From 3 m/s; from 5 s on 3 % of its weight push it; the brake opens at 605 s.
  const double slope = .03 * kCarriedWeight, moment = 8e3,
               mass = kCarried + kAxleSpin / (lever() * lever());
  const Scene scene =
      wheelset(force("x", "[5.0,0.0],[6.0," + std::to_string(slope) + "]") +
                   brake("[0.0,0.0],[0.001,8e3],[605.0,8e3],[605.001,0.0]"),
               {"vehicle[0].speed_m_per_s=3.0", "step.frame_s=0.1", "step.duration_s=610.0"});
  const Traced run(scene);
  const std::vector<double> x = run["car.x_m"], v = run["car.speed_m_per_s"],
                            held = run["car.disc.moment_n_m"];
  const double force_of_brake = moment / lever();
  CHECK(x[49] == Approx(.5 * 9. * mass / force_of_brake).epsilon(2e-3));
  CHECK(std::fabs(v[49]) < 1e-3);
  CHECK(std::fabs(x[6040] - x[200]) < 1e-9);
  CHECK(std::fabs(v[6040]) < 1e-10);
  CHECK(std::fabs(held[6040]) == Approx(slope * lever()).epsilon(1e-6));
  CHECK(v.back() == Approx(slope / mass * 5.).epsilon(1e-3));
  CHECK_FALSE(has(run.status, Status::full_slip));
}

TEST_CASE("a wheelset whose brake is stronger than its friction locks and slides",
          "[free_vehicle]") {
  for (const char* step : {"step.dt_s=1e-3", "step.dt_s=2.5e-4"}) {
    const Scene scene = wheelset(
        brake("[0.0,0.0],[0.01,4e4]"),
        {"vehicle[0].speed_m_per_s=10.0", step, "step.frame_s=1e-3", "step.duration_s=6.0"});
    const Traced run(scene);
    const std::vector<double> v = run["car.speed_m_per_s"];
    INFO(step);
    CHECK(has(run.status, Status::full_slip));
    CHECK_FALSE(has(run.status, Status::cap_reached));
    // It slides for 3.4 s; the wheel locks within 0.1 s.
    CHECK(v[2000] - v[1000] == Approx(-kGrip * 9.81).epsilon(1e-4));
    const std::vector<double> x = run["car.x_m"];
    CHECK(x.back() == Approx(50. / (kGrip * 9.81)).epsilon(3e-3));
    // Springs of brake and contacts let it go back by 1 mm, and creep is not wound up.
    CHECK(largest_of(x) - x.back() < 3e-3);
    CHECK(std::fabs(v.back()) < 1e-3);
    const Simulation made(scene);
    CHECK(balance_of(*made.packed(), made.model(), made.model().steps).error < 1e-4);
  }
}

TEST_CASE("a drive overcomes the brake of its vehicle", "[free_vehicle]") {
  // The moment grows so slowly that nothing swings along the track.
  const Words words = {
      "vehicle[0].brake=[{name=\"disc\",wheelset=\"leading_1\",on=\"bogie_1\",table=[[0.0,0.0],"
      "[5.0,1e3]]}]",
      "step.duration_s=10.0"};
  const Scene scene = read_scene(shipped("manchester_straight"), words);
  const Traced braked(scene), alone(read_scene(shipped("manchester_straight"), {words[1]}));
  const std::vector<double> drive = braked["car.drive_n"];
  const auto later = drive.begin() + 5000;
  const double mean =
      std::accumulate(later, drive.end(), 0.) / static_cast<double>(drive.end() - later);
  CHECK(mean - alone["car.drive_n"].back() == Approx(1e3 / .46).epsilon(5e-3));
  CHECK(braked["car.disc.moment_n_m"].back() == Approx(-1e3));
  const Simulation made(scene);
  CHECK(balance_of(*made.packed(), made.model(), made.model().steps).error < 1e-4);
}

TEST_CASE("friction holds the paper's wheelset, which leaves its track without", "[free_vehicle]") {
  const std::string set =
      "vehicle=[{name=\"set\",type=\"rail_vehicle\",drive=\"force\",start_m=3.2,"
      "speed_m_per_s=0.0,wheelset=[{name=\"axle\",mass_kg=100.0,inertia_kg_m2=[8.3,1.1,8.3],"
      "place_m=0.0,radius_m=0.148}],force=[{body=\"axle\",direction=\"y\",table=[[1.0,0.0],"
      "[1.00005,10.0]]}]}]";
  const auto pushed = [&set](const std::string& contact) {
    return Traced(read_scene(shipped("wheelset_on_track"),
                             {"wheelset=[]", "sensor=[]", "step.start=\"equilibrium\"",
                              "contact={" + contact + "}", set}));
  };
  const std::string cylinders = "wheel=\"cone\",slope=0.0,rail=\"crown\",normal=\"hertz\",";
  const Traced held = pushed(cylinders + "creep=\"she\",friction=0.3"),
               free = pushed(cylinders + "creep=\"none\""),
               drawn = pushed(
                   "wheel=\"profile\",wheel_profile=\"../profiles/cone_40.toml\","
                   "rail=\"profile\",rail_profile=\"../profiles/136re.toml\","
                   "inclination=\"1:40\",gauge_m=0.927,back_to_back_m=0.852,"
                   "normal=\"strips\",creep=\"she\",friction=0.3");
  CHECK(free["set.axle.y_m"].back() == Approx(.05).epsilon(1e-3));
  CHECK(held["set.axle.y_m"].back() == Approx(.160e-6).epsilon(.01));
  CHECK(drawn["set.axle.y_m"].back() == Approx(.157e-6).epsilon(.01));
  for (const Traced* run : {&held, &drawn}) {
    const double left = (*run)["set.axle_left.y_n"].back(),
                 right = (*run)["set.axle_right.y_n"].back();
    CHECK(left - right == Approx(10.).epsilon(1e-3));
    CHECK(std::fabs((*run)["set.axle.y_m"].back() - (*run)["set.axle.y_m"][1500]) < 1e-8);
  }
}

TEST_CASE("nothing drives a vehicle that rolls freely without creep, however far",
          "[free_vehicle]") {
  const std::string contact =
      "contact={wheel=\"cone\",slope=0.168206167,rail=\"crown\",normal=\"hertz\",creep=\"none\"}";
  for (const char* start : {"step.start=\"equilibrium\"", "step.start=\"released\""}) {
    const Traced run(
        read_scene(shipped("manchester_straight"),
                   {"vehicle[0].drive=\"force\"", "vehicle[0].speed_m_per_s=100.0", contact,
                    "step.dt_s=2e-4", "step.frame_s=0.1", "step.duration_s=20.0", start}));
    const std::vector<double> v = run["car.speed_m_per_s"];
    INFO(start);
    CHECK(v.front() == 100.);
    CHECK(v.back() == Approx(100.).epsilon(1e-9));
    CHECK(run["car.x_m"].back() == Approx(2000.).epsilon(1e-8));
  }
}

TEST_CASE("a vehicle that starts to roll slowly is in its steady motion", "[free_vehicle]") {
  // Wheels on cones spin on their contacts, which pushes them apart; at 0.4 m/s creep is kept.
  const Traced run(read_scene(
      shipped("manchester_straight"),
      {"vehicle[0].drive=\"force\"", "vehicle[0].speed_m_per_s=0.4", "step.duration_s=0.1"}));
  const std::vector<double> y = run["car.leading_1_left.y_n"];
  CHECK(std::fabs(y.front()) > 100.);
  CHECK(y.back() == Approx(y.front()).epsilon(1e-3));
}
