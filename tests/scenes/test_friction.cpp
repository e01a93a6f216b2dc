// Friction of rails over the place and over the slip.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "support/bad_input.h"
#include "support/block_fields.h"
#include "support/scene_run.h"
#include "support/shipped.h"

using namespace railstep;

namespace {

using Words = std::vector<std::string>;

constexpr double kWeighs = 9.81;  // m/s2

/// A wheelset of 15 t with cylinders as wheels rolls freely at 15 m/s until its brake locks it.
Scene locked(const std::string& friction, const Words& more = {}) {
  Words words = {
      "contact={wheel=\"cone\",rail=\"crown\",normal=\"hertz\",slope=0.0,creep=\"she\"," +
          friction + ",relaxation_m=0.011,kalker=[9e6,9e6,0.0,0.0]}",
      "vehicle=[{name=\"car\",type=\"rail_vehicle\",drive=\"force\",speed_m_per_s=15.0,"
      "wheelset=[{name=\"axle\",mass_kg=15000.0,inertia_kg_m2=[700.0,100.0,700.0],radius_m=0.46,"
      "place_m=0.0}],element=[{name=\"guide\",type=\"bushing\",between=[\"axle\",\"ground\"],"
      "point_m=[0.0,0.0,0.46],stiffness_n_per_m=[0.0,5e5,0.0],"
      "stiffness_n_m_per_rad=[0.0,0.0,5e5]}],brake=[{name=\"disc\",wheelset=\"axle\","
      "on=\"ground\",table=[[0.0,0.0],[0.01,8e4]]}]}]",
      "step.dt_s=0.5e-3", "step.frame_s=1e-3", "step.duration_s=12.0"};
  words.insert(words.end(), more.begin(), more.end());
  return read_scene(shipped("manchester_straight"), words);
}

double balance_error(const Scene& scene) {
  const Simulation made(scene);
  return balance_of(*made.packed(), made.model(), made.model().steps).error;
}

}  // namespace

TEST_CASE("a locked wheelset slides over friction that changes with the place", "[friction]") {
  const Scene scene =
      locked("friction_table=[[15.0,0.3,0.3],[16.0,0.1,0.1],[40.0,0.1,0.1],[42.0,0.2,0.3]]");
  const Traced run(scene);
  const std::vector<double> x = run["car.x_m"], v = run["car.speed_m_per_s"];
  std::size_t first = 0;
  while (x[first] < 10.) ++first;
  // Half the square of the speed falls by what friction takes over the way, the mean of both rails.
  const auto taken = [](double way) {
    const double ramp = std::clamp(way - 15., 0., 1.), slippery = std::clamp(way - 16., 0., 24.),
                 rough = std::clamp(way - 40., 0., 2.), last = std::max(way - 42., 0.);
    return .3 * std::min(way, 15.) + (.3 - .1 * ramp) * ramp + .1 * slippery +
           (.1 + .0375 * rough) * rough + .25 * last;
  };
  int looked = 0;
  for (std::size_t i = first; v[i] > .5; i += 100, ++looked) {
    INFO(x[i] << " m");
    CHECK(.5 * (v[first] * v[first] - v[i] * v[i]) ==
          Approx(kWeighs * (taken(x[i]) - taken(x[first]))).margin(.02));
  }
  CHECK(looked > 40);
  CHECK(x.back() > 42.);
  CHECK(std::fabs(v.back()) < 1e-3);
  CHECK(balance_error(scene) < 1e-4);
}

TEST_CASE("a locked wheelset slides under friction that falls with the slip", "[friction]") {
  constexpr double kKinetic = .4, kHalf = 2., kMost = .3;  // -, m/s, -
  const Scene scene = locked("friction=0.3,kinetic_part=0.4,half_slip_m_per_s=2.0");
  const Traced run(scene);
  const std::vector<double> v = run["car.speed_m_per_s"];
  // The integral of dv / mu(v).
  const auto time = [&](double speed) {
    const double s = speed / kHalf;
    return kHalf / (kMost * kWeighs) *
           (s / kKinetic + (1. - 1. / kKinetic) / kKinetic * std::log1p(kKinetic * s));
  };
  constexpr std::size_t kLocked = 1000;
  int looked = 0;
  for (std::size_t i = kLocked; v[i] > .5; i += 250, ++looked) {
    INFO(v[i] << " m/s");
    CHECK(time(v[kLocked]) - time(v[i]) ==
          Approx(1e-3 * static_cast<double>(i - kLocked)).epsilon(1e-3).margin(1e-4));
  }
  CHECK(looked > 10);
  CHECK(std::fabs(v.back()) < 1e-3);
  CHECK(has(run.status, Status::full_slip));
  CHECK_FALSE(has(run.status, Status::cap_reached));
  CHECK(balance_error(scene) < 1e-4);
}

TEST_CASE("friction that is the same everywhere is that of its coefficient", "[friction]") {
  const Words contact = {"contact.creep=\"she\"", "step.duration_s=0.2"};
  for (const char* name : {"manchester_straight", "manchester_ring"}) {
    const auto run = [&](const std::string& friction) {
      Words words = contact;
      words.push_back("contact." + friction);
      return Traced(read_scene(shipped(name), words)).rows;
    };
    const std::vector<double> known = run("friction=[0.05,0.06]");
    CHECK(run("friction_table=[[0.0,0.05,0.06]]") == known);
    // Half of the left rail's coefficient that is far away.
    const std::vector<double> half =
        run("friction_table=[[0.0,0.05,0.06],[1e6,0.05,0.06],[1e7,0.1,0.06]]");
    REQUIRE(half.size() == known.size());
    double most = 0.;
    for (std::size_t i = 0; i < known.size(); ++i)
      most = std::max(most, std::fabs(half[i] - known[i]) / (1. + std::fabs(known[i])));
    INFO(name);
    CHECK(most < 1e-9);
  }
}

TEST_CASE("each wheelset meets the friction of its own place", "[friction]") {
  // The first of four wheelsets is 10.78 m ahead of the middle, and meets the change 5 m further
  // on.
  const auto run = [](const char* after) {
    return Traced(read_scene(
        shipped("manchester_ring"),
        {"contact.creep=\"she\"", "step.duration_s=0.2", "vehicle[0].speed_m_per_s=50.0",
         "vehicle[0].start_m=11.4",
         std::string("contact.friction_table=[[27.18,0.05,0.06],[27.1801,") + after + "]]"}));
  };
  const Traced even = run("0.05,0.06"), left = run("0.04,0.06"), right = run("0.05,0.07");
  for (const Traced* changed : {&left, &right}) {
    // A change of the left rail's friction is the first one of the left wheel.
    const char* const side = changed == &left ? "left" : "right";
    const std::string column = std::string("car.leading_1_") + side + ".y_n";
    const std::vector<double> known = even[column], found = (*changed)[column],
                              time = even["time_s"];
    std::size_t first = 0;
    while (first < known.size() && std::fabs(found[first] - known[first]) < 1e-6) ++first;
    INFO(side);
    REQUIRE(first < known.size());
    CHECK(time[first] == Approx(5. / 50.).margin(2e-3));
  }
}

TEST_CASE("a model that has places of friction without their table is refused", "[friction]") {
  const auto block_with = [](const char* friction) {
    return Simulation(read_scene(shipped("manchester_straight"),
                                 {"contact.creep=\"she\"", std::string("contact.") + friction}))
        .block();
  };
  // The count of places is the first word that is 0 in one of them and 1 in the other.
  const Block one = block_with("friction_table=[[0.0,0.3,0.3]]");
  Block none = block_with("friction=0.3");
  std::size_t places = section_at(none, kWords);
  while (word_of(none, places) != 0 || word_of(one, places) != 1) places += 8;
  REQUIRE(status_of(none) == LoadStatus::ok);
  put_word(none, places, 3);
  sign(none);
  CHECK(status_of(none) != LoadStatus::ok);
}

TEST_CASE("friction that cannot be used is refused", "[friction][bad_input]") {
  const BadInput bad("friction");
  const auto refused = [&](const Words& more, const Words& said) {
    std::string words = "run " + shipped("manchester_straight") + " --set 'contact.creep=\"she\"'";
    for (const std::string& each : more) words += " --set 'contact." + each + "'";
    bad.refused(words, said);
  };
  refused({"friction=0.3", "friction_table=[[0.0,0.3,0.3]]"}, {"[contact]", "E-CONTACT-11"});
  refused({"friction_table=[[1.0,0.3,0.3],[0.5,0.3,0.3]]"},
          {"[contact]", "x = 0.5", "E-CONTACT-09"});
  refused({"friction_table=[[1.0,0.3,0.0]]"}, {"[contact]", "coefficient of 0", "E-CONTACT-10"});
  refused({"friction=0.3", "kinetic_part=0.5"}, {"[contact]", "half_slip_m_per_s", "E-KEY-01"});
  refused({"friction=0.3", "half_slip_m_per_s=1.0"}, {"half_slip_m_per_s", "E-CONTACT-12"});
  refused({"friction=0.3", "kinetic_part=1.5", "half_slip_m_per_s=1.0"},
          {"kinetic_part", "E-KEY-05"});
  refused({"friction=0.3", "kinetic_part=0.1", "half_slip_m_per_s=0.001"},
          {"half_slip_m_per_s", "E-PACK-60"});
}
