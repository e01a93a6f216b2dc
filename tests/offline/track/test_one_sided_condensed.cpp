// Condensed tracks with one-sided supports against full order: the static start, and runs, with
// pads that press and pads that are open.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "offline/pack/accuracy.h"
#include "support/scene_run.h"

using namespace railstep;

namespace {

const std::string kRail =
    "schema = 1\n"
    "rail = {rectangle={height_m=0.172, width_m=0.07}, young_pa=60e9}\n";
/// A short, stiff rail: under the load the pads at both sides of its neighbours lift.
const std::string kStiffWords =
    kRail +
    "track = {unknowns=\"vertical\", rails=1, bays=5, bay_m=0.6, elements_per_bay=1, "
    "ends=\"pinned\"}\n"
    "support = {at=\"axis\", stiffness_z_n_per_m=2e9, damping_z_n_s_per_m=2e4, unilateral=true}\n"
    "load = [{name=\"l\", rail=\"left\", start_m=0.65, force_z_n=-50e3}]\n"
    "step = {dt_s=1e-3, duration_s=0.05, start=\"equilibrium\"}\n"
    "output = {supports=true}\n";

/// The compression would nearly buckle the rail between its ends; on its seats it is far from that.
const std::string kPressed =
    "schema = 1\n"
    "rail = {rectangle={height_m=0.172, width_m=0.07}, young_pa=60e9, axial_force_n=-200e3}\n"
    "track = {unknowns=\"vertical\", rails=1, bays=5, bay_m=1.066, elements_per_bay=1, "
    "ends=\"pinned\"}\n"
    "support = {at=\"axis\", stiffness_z_n_per_m=1.9e9, damping_z_n_s_per_m=2e4, unilateral=true}\n"
    "vehicle = [{name=\"m\", type=\"mass\", mass_kg=19.6e3, start_m=0.647, "
    "speed_m_per_s=0.0, contact=\"hertz\"}]\n"
    "step = {dt_s=1e-3, duration_s=0.05, start=\"equilibrium\"}\n";

const std::vector<std::string> kKinds = {"modal", "guyan", "irs", "craig-bampton", "krylov"};

Scene with_kind(const std::string& text, const std::string& kind,
                std::vector<std::string> overrides = {}) {
  overrides.push_back("condense.kind=\"" + kind + "\"");
  return scene_of(text, overrides);
}

double largest(const std::vector<double>& values) {
  double most = 0.;
  for (const double each : values) most = std::max(most, std::abs(each));
  return most;
}

/// Largest difference in a column, over its largest value.
double apart(const Traced& a, const Traced& b, const std::string& column) {
  const std::vector<double> left = a[column], right = b[column];
  REQUIRE(left.size() == right.size());
  double most = 0.;
  for (std::size_t i = 0; i < left.size(); ++i) most = std::max(most, std::abs(left[i] - right[i]));
  return most / largest(right);
}

}  // namespace

TEST_CASE("with one-sided pads every condensed start agrees with full order", "[supports]") {
  for (const char* elements : {"1", "2"}) {
    const std::vector<std::string> mesh = {std::string("track.elements_per_bay=") + elements};
    const Traced full(with_kind(kStiffWords, "full", mesh));
    CHECK(full["support_0.force_z_n"][0] == 0.);  // pinned there
    CHECK(full["support_3.force_z_n"][0] == 0.);  // open
    for (const std::string& kind : kKinds) {
      CAPTURE(elements, kind);
      const Traced run(with_kind(kStiffWords, kind, mesh));
      // Modes and seats have the mesh's statics, and pads have only that: the basis rounds.
      for (int support = 0; support < 6; ++support)
        for (const double each : run["support_" + std::to_string(support) + ".force_z_n"])
          CHECK(std::abs(each - full["support_" + std::to_string(support) + ".force_z_n"][0]) <
                1e-8 * 50e3);
      // Tables of 16 places per element hold what the bases leave out. Cubics read them to 2e-4 at
      // most beside a seat of 2e9 N/m (the static error with linear pads is as large).
      CHECK(apart(run, full, "l.deflection_z_m") < 2e-4);
    }
  }
}

TEST_CASE("with one-sided pads the start keeps to the stated static error", "[supports]") {
  for (const char* elements : {"1", "2", "4"}) {
    const std::string mesh = std::string("track.elements_per_bay=") + elements;
    const Traced fine(with_kind(kStiffWords, "full", {"track.elements_per_bay=32"}));
    for (const char* kind : {"full", "modal"}) {
      const Scene scene = with_kind(kStiffWords, kind, {mesh});
      const Built built(scene);
      const double stated = static_error(built.track, *built.packed);
      const double off = apart(Traced(scene), fine, "l.deflection_z_m");
      CAPTURE(elements, kind, off, stated);
      // This is over the largest deflection of any place, 1.3 times that under this load.
      CHECK(off < 1.5 * stated);
      CHECK(stated < 3. * off);
    }
  }
}

TEST_CASE("with one-sided pads a heavy wheel on a compressed rail stands as in full order",
          "[supports]") {
  const Traced full(with_kind(kPressed, "full"));
  CHECK(full["m.wheel_1.rail_z_m"][0] < -2e-3);
  for (const std::string& kind : kKinds) {
    CAPTURE(kind);
    const Traced run(with_kind(kPressed, kind));
    // The tables have the error above, and the wheel stays where it starts.
    CHECK(apart(run, full, "m.wheel_1.rail_z_m") < 1e-4);
    CHECK(apart(run, full, "m.wheel_1.force_z_n") < 1e-8);
  }
}

TEST_CASE("with one-sided pads a passing load moves as in full order on every basis",
          "[supports]") {
  // Pads have 200 MN/m, one with a gap of 0.1 mm; 50 kN pass ten bays at 30 m/s.
  const std::string scene =
      "schema = 1\n"
      "rail = {rectangle={height_m=0.172, width_m=0.07}}\n"
      "track = {unknowns=\"vertical\", rails=1, bays=10, bay_m=0.6, elements_per_bay=2, "
      "ends=\"pinned\"}\n"
      "support = {at=\"axis\", stiffness_z_n_per_m=2e8, damping_z_n_s_per_m=2e4, "
      "unilateral=true}\n"
      "support_change = [{seats=[5], support={gap_m=1e-4}}]\n"
      "load = [{name=\"l\", rail=\"left\", start_m=2.05, speed_m_per_s=30.0, "
      "force_z_n=-50e3}]\n"
      "step = {dt_s=5e-5, frame_s=1e-3, duration_s=0.06, start=\"equilibrium\"}\n"
      "condense = {modes_per_bay=4.0, nodes_per_bay=4, residual_flexibility=true}\n";
  const Traced full(with_kind(scene, "full"));
  for (const std::string& kind : kKinds) {
    CAPTURE(kind);
    CHECK(apart(Traced(with_kind(scene, kind)), full, "l.deflection_z_m") < 2e-3);
  }
}
