// Models with all contacts in use: wheels, hanging sleepers and loads up to their caps. Each step
// is compared with a dense one in long double.
#include <catch2/catch.hpp>

#include "support/flanged.h"
#include "support/full_house.h"

using namespace railstep;

namespace {

/// Largest differences, each over the largest value of its kind.
struct Difference {
  double force = 0., displacement = 0.;
  Status seen = Status::ok;
  int unsolved = 0;  // steps that the reference does not solve
  double peak = 0.;  // N
};

/// Steps both; each step of the reference starts from the run's present state.
Difference compared(const House& house, double dt, int steps) {
  PackOptions options{.scheme = newmark(dt), .residual_flexibility = false};
  ModelRun run(house.track, house.traffic, options);
  const DenseHouse dense(house, run);
  const auto wheels = static_cast<std::size_t>(run.model().vehicle_wheels);
  Difference found;
  double largest = 0., off = 0., moved = 0., moved_off = 0.;
  for (int n = 0; n < steps; ++n) {
    const DenseHouse::Step want = dense.step();
    run.step();
    if (!want.solved) ++found.unsolved;
    for (std::size_t i = 0; i < want.force.size(); ++i) {
      const double got = i < wheels ? run.state.contact_force[i] : run.state.port_force[i - wheels];
      const auto wanted = static_cast<double>(want.force[i]);
      largest = std::max(largest, std::abs(wanted));
      off = std::max(off, std::abs(got - wanted));
    }
    for (std::size_t i = 0; i < dense.unknowns(); ++i) {
      const auto wanted = static_cast<double>(want.y[i]);
      moved = std::max(moved, std::abs(wanted));
      moved_off = std::max(moved_off, std::abs(run.state.u[dense.in_state(i)] - wanted));
    }
  }
  found.force = off / std::max(largest, 1.);
  found.displacement = moved_off / std::max(moved, 1e-9);
  found.peak = largest;
  found.seen = run.seen;
  return found;
}

}  // namespace

TEST_CASE("a model with all contacts in use agrees with a dense solve in long double",
          "[full house]") {
  struct Case {
    int wheels, hanging, loads;
  };
  const Case c =
      GENERATE(Case{0, 0, 32}, Case{32, 0, 0}, Case{0, 32, 32}, Case{16, 32, 8}, Case{17, 32, 0},
               Case{24, 26, 1}, Case{32, 17, 0}, Case{31, 32, 32}, Case{32, 32, 32});
  const double dt = GENERATE(1e-3, 5e-5);
  const House house = full_house(c.wheels, c.hanging, c.loads);
  const Difference found = compared(house, dt, 20);
  CAPTURE(c.wheels, c.hanging, c.loads, dt, found.force, found.displacement, found.peak);
  CHECK(found.unsolved == 0);
  CHECK(!has(found.seen, Status::cap_reached));
  CHECK(!has(found.seen, Status::contact_ill_posed));
  // The contact solve leaves 1e-12 of its depths, and forces rise as d^1.5 at most. The 20 steps of
  // 5e-5 s are off by 2.5e-12: their depths are smallest beside the motion.
  CHECK(found.force < 1e-11);
  CHECK(found.displacement < 1e-13);
}

namespace {

/// Largest difference between the contacts' forces and their laws at the published gaps, the
/// largest force, and which contacts bore a force at some time.
struct HouseLaws {
  double off = 0., largest = 0.;
  std::vector<bool> wheel_bore, flange_bore, port_bore;
};

double hertz_force(double C, double gap) { return gap < 0. ? C * -gap * std::sqrt(-gap) : 0.; }

HouseLaws laws_of(ModelRun& run, int steps) {
  const Model& m = run.model();
  HouseLaws found{0., 0., std::vector<bool>(static_cast<std::size_t>(wheel_count(m))),
                  std::vector<bool>(static_cast<std::size_t>(flange_count(m))),
                  std::vector<bool>(static_cast<std::size_t>(m.fixed.count))};
  const auto note = [&](double force, double want) {
    found.off = std::max(found.off, std::abs(force - want));
    found.largest = std::max(found.largest, want);
    return force > 0.;
  };
  for (int n = 0; n < steps; ++n) {
    run.step();
    for (int i = 0; i < wheel_count(m); ++i) {
      const double C = m.contact[i].law.hertz;
      if (note(run.state.contact_force[i], hertz_force(C, run.outputs.contact_gap[i])))
        found.wheel_bore[static_cast<std::size_t>(i)] = true;
    }
    for (int i = 0; i < flange_count(m); ++i) {
      const ContactId contact = flange_contact(m, i);
      const double depth = std::max(-run.outputs.contact_gap[contact], 0.);
      if (note(run.outputs.contact_force[contact], m.contact[contact].law.stiffness * depth))
        found.flange_bore[static_cast<std::size_t>(i)] = true;
    }
    for (std::int32_t j = 0; j < m.fixed.count; ++j)
      if (run.state.port_force[j] > 0.) found.port_bore[static_cast<std::size_t>(j)] = true;
  }
  return found;
}

bool all_of(const std::vector<bool>& bore) {
  return std::all_of(bore.begin(), bore.end(), [](bool b) { return b; });
}

}  // namespace

TEST_CASE("every contact of a model with all contacts in use follows its law, condensed too",
          "[full house]") {
  const bool modal = GENERATE(false, true);
  const double dt = GENERATE(1e-3, 5e-5);
  House house = full_house(32, 32, 32);
  PackOptions options = options_of(modal, house.track, dt);
  options.residual_flexibility = false;
  ModelRun run(house.track, house.traffic, options);
  const HouseLaws found = laws_of(run, static_cast<int>(std::lround(.04 / dt)));
  CAPTURE(modal, dt, found.off, found.largest);
  CHECK(!has(run.seen, Status::cap_reached));
  CHECK(!has(run.seen, Status::contact_ill_posed));
  CHECK(found.off <= 1e-11 * found.largest);
  CHECK(all_of(found.wheel_bore));
  CHECK(all_of(found.port_bore));
}

TEST_CASE("wheelsets with flanges, bogies and hanging sleepers can use all contacts together",
          "[full house]") {
  const bool modal = GENERATE(false, true);
  const double dt = GENERATE(1e-3, 5e-5);
  House house = full_house(16, 32, 28, Unknowns::full);
  for (int i = 0; i < kMaxWheelsets; ++i) {
    Wheelset w = flanged_wheelset(5e7, 0.);
    w.start = 2.2 + 2. * i;
    w.weight = 5e3;
    w.forces = {{.direction = 1, .table = {0., i % 2 == 0 ? 3e4 : -3e4}}};
    house.traffic.wheelsets.push_back(w);
  }
  house.traffic.head = kFlangedHead;
  PackOptions options = options_of(modal, house.track, dt);
  options.residual_flexibility = false;
  ModelRun run(house.track, house.traffic, options);
  REQUIRE(contact_count(run.model()) == kMaxWheels);
  REQUIRE(run.model().fixed.count == kMaxFixedPorts);
  const HouseLaws found = laws_of(run, static_cast<int>(std::lround(.04 / dt)));
  CAPTURE(modal, dt, found.off, found.largest);
  CHECK(!has(run.seen, Status::contact_ill_posed));
  CHECK(!has(run.seen, Status::cap_reached));
  CHECK(found.off <= 1e-11 * found.largest);
  CHECK(all_of(found.wheel_bore));
  CHECK(std::count(found.flange_bore.begin(), found.flange_bore.end(), true) == kMaxWheelsets);
}
