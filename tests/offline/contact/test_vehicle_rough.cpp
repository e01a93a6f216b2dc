// Vehicles on rough rails: the work of the drive and the balance of energy.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/energy/energy_account.h"
#include "offline/irregularity/defect.h"
#include "online/contact/vehicle_contact.h"
#include "online/track/travel.h"
#include "run/simulate.h"
#include "support/vehicles.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;

namespace {

/// A bogie at 60 m/s over waves of .6 m and .2 mm, at 100 Hz.
struct RoughRun {
  ModelRun run;
  EnergyAccount energy;
  double driven = 0.;  // work of the wheels' forces along the slopes, J

  RoughRun(bool modal, double rho, double dt, WheelContactKind contact = WheelContactKind::hertz,
           bool residual_flexibility = true)
      : run(made(modal, rho, dt, contact, residual_flexibility)),
        energy(*run.packed, run.model(), run.state) {
    const Model& model = run.model();
    while (run.time() < .15 - .5 * dt) {
      const auto before = slopes(), was = forces();
      run.step();
      energy.follow(run.state);
      const auto now = slopes(), force = forces();
      const double way = dt * travelled(model.vehicle[0].travel, run.time()).speed;
      for (std::size_t i = 0; i < 2; ++i)
        driven +=
            .5 * way *
            (modal ? force[i] * (before[i] + now[i]) : was[i] * before[i] + force[i] * now[i]);
    }
  }
  double loss() const { return energy.numerical_loss(); }

 private:
  static ModelRun made(bool modal, double rho, double dt, WheelContactKind contact, bool residual) {
    const Track track = one_rail(30);
    RunningVehicle v = running(bogie(kBogie), 4., 60.);
    v.contact = contact;
    v.stiffness = 1e9;
    v.damping = 1e5;
    PackOptions options = options_of(modal, track, dt, rho);
    options.residual_flexibility = residual;
    return from_rest(
        track, {.vehicles = {v}, .irregularities = {{0, 2, corrugation(2., 16., .6, 2e-4, {.02})}}},
        options);
  }
  /// Slopes of rail and irregularity together, under both wheels in the present state.
  std::array<double, 2> slopes() const {
    const Model& model = run.model();
    const Configuration at{run.state.u, {run.state.u, run.state.v}};
    WheelContact contact[kMaxWheels];
    find_vehicle_contacts(model, run.state.steps, 0., at, contact);
    return {contact[0].slope + slope_under(model, contact[0], at),
            contact[1].slope + slope_under(model, contact[1], at)};
  }
  std::array<double, 2> forces() const {
    return {run.state.contact_force[0], run.state.contact_force[1]};
  }
};

}  // namespace

TEST_CASE("on a rough rail energies balance with the second order of the step",
          "[vehicle][energy]") {
  // Banded lines use any rho_inf; condensed ones take the contact's force at the step's middle.
  struct Case {
    bool modal;
    double rho;
    WheelContactKind contact;
  };
  for (const Case& c : {Case{false, .6, WheelContactKind::hertz},
                        {false, .6, WheelContactKind::linear},
                        {false, 1., WheelContactKind::hertz},
                        {true, 1., WheelContactKind::hertz}}) {
    std::vector<double> error;
    for (const double dt : {1e-4, 5e-5, 2.5e-5})
      error.push_back(RoughRun(c.modal, c.rho, dt, c.contact).energy.balance_error());
    CAPTURE(c.modal, c.rho, static_cast<int>(c.contact), error);
    for (std::size_t i = 0; i < 2; ++i)  // half an order is for higher terms
      CHECK_THAT(std::log2(error[i] / error[i + 1]), WithinAbs(2., .5));
    CHECK(error[2] < 1e-3);
  }
}

TEST_CASE("a contact force later than the step's middle takes energy and adds none",
          "[vehicle][energy]") {
  // With rho_inf = .6 a condensed track takes V'(d) at 5/8 of the step, with the irregularity
  // there. With that of the middle the bogie would gain 6e-4 of the energy turned over.
  for (const double dt : {1e-4, 5e-5}) {
    const RoughRun late(true, .6, dt);
    CAPTURE(dt, late.loss());
    CHECK(late.loss() > 0.);
    CHECK(late.loss() < 2e-4);
  }
}

TEST_CASE("the drive of a vehicle works by the wheels' forces on the slopes", "[vehicle][energy]") {
  // At each border of elements the sum over steps misses part of a step: at most half of its path
  // times the force times the kink under it, F/(k G A). This is without residual flexibility, whose
  // change of place has its own term.
  const double dt = 5e-5, force = 55e3;
  const BeamSection section = one_rail(1).section;
  const double kink = force / (section.shear_factor_z * Material{}.shear_modulus() * section.area);
  const double borders = 2. * .15 * 60. / .3;
  for (const bool modal : {false, true}) {
    const RoughRun rough(modal, 1., dt, WheelContactKind::hertz, false);
    const double work = rough.energy.flow().guides;
    CAPTURE(modal, rough.driven, work);
    CHECK_THAT(rough.driven, WithinAbs(work, borders * .5 * (60. * dt) * force * kink));
    CHECK(work > 100.);
    CHECK(rough.energy.flow().carriers == 0.);
  }
}

TEST_CASE("the energies of the bogie at speed balance on a worn track", "[vehicle][energy]") {
  for (const char* kind : {"full", "modal"})
    for (const char* irregular :
         {"irregularity={spectrum=\"fra_3\"}",
          "defect=[{kind=\"dipped_joint\", at_m=8.0, depth_m=1e-3, ramp_m=0.5}]"}) {
      const Simulation run(
          read_scene(std::string(RAILSTEP_SOURCE) + "/config/scenes/bogie_at_speed.toml",
                     {std::string("condense.kind=\"") + kind + "\"", "step.duration_s=0.05",
                      "track.bays=40", "vehicle[0].start_m=6.0", "sensor=[]", irregular}));
      const EnergyBalance balance = balance_of(*run.packed(), run.model(), 100);
      CAPTURE(kind, irregular, balance.error, balance.numerical_loss);
      CHECK(balance.error < 1e-3);  // the bound of a shipped scene
      CHECK(balance.error > 0.);
    }
}
