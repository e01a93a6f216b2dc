// Random loads on random tracks: full order and every condensed form of full size, against a dense
// trapezoidal rule in long double that only this test has. Mass, damping and stiffness are the
// program's own, and in full order the start too: the test is of the integrator, its solve and the
// condensation. test_differential_element compares the element with a separate one.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "online/step/step.h"
#include "online/track/line.h"
#include "run/simulation.h"
#include "support/dense_newmark.h"

// This file converts doubles to long double on purpose.
#pragma GCC diagnostic ignored "-Wdouble-promotion"

using namespace railstep;

namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Up to three loads that stand or roll, constant or by a table, some with a sine.
/// @param from_zero  each begins at 0 N
RandomScene loaded(std::uint64_t seed, double least_step, double most_step, int steps,
                   bool from_zero) {
  Draw draw(seed);
  RandomScene s = random_track(seed, draw);
  s.bays = std::min(s.bays, s.full ? 2 : 4);
  s.dt = draw.of_any_size(least_step, most_step);
  s.steps = steps;
  s.condense = "residual_flexibility = false\n";
  for (int i = draw.whole(1, 3); i > 0; --i) {
    RandomLoad load;
    load.force = draw.between(-1e5, 1e5);
    send(draw, s, 0., load.start, load.speed);
    if (from_zero || draw.chance(.5)) {
      load.table = {{0., from_zero ? 0. : draw.between(-1., 1.)}};
      for (int at = 0, k = draw.whole(1, 4); k > 0; --k) {
        at += draw.whole(1, std::max(1, steps / 4));
        load.table.emplace_back(at * s.dt, draw.between(-1., 1.));
      }
    }
    if (draw.chance(.4)) {
      load.amplitude = draw.between(-1e5, 1e5);
      load.frequency = draw.of_any_size(.01, .12) / s.dt;
    }
    s.loads.push_back(load);
  }
  return s;
}

/// The same scene, condensed to as many coordinates as there are. Krylov's shapes are complete only
/// with enough expansion points.
RandomScene all_kept(std::uint64_t seed, const std::string& kind) {
  RandomScene s = loaded(seed, 2e-6, 2e-5, 60, true);
  if (s.sleepers && s.sleeper_mass == 0.) s.pad_damper = s.ballast_damper = 0.;
  s.condense += "kind = \"" + kind + "\"\nmodes_per_bay = 1000\n";
  if (kind == "guyan" || kind == "irs")
    s.condense += fmt::format("nodes_per_bay = {}\n", 2 * s.elements);
  if (kind == "krylov")
    s.condense += "expansion_hz = [20, 100, 300, 1e3, 2e3, 4e3, 7e3, 1.2e4, 2e4, 3e4, 5e4, 9e4]\n";
  return s;
}

/// Heights of the rail's nodes in a line and its model: the unknown, and its place in the table.
struct Heights {
  std::vector<std::size_t> unknown;
  std::vector<std::int32_t> place;

  Heights(const Track& track, const Line& line, const LineModel& model) {
    for (int node = 0; node < track.nodes(); ++node) {
      const int at = line.unknown(0, node, 2);
      if (at < 0) continue;
      unknown.push_back(static_cast<std::size_t>(at));
      place.push_back(model.unknown_of[0][table_place(node, 2)]);
    }
  }
};

/// Largest difference over the peak, and the error bound of the comparison itself, over the peak.
struct Judged {
  double error = 0., bound = 0.;
  bool fails() const { return !(error <= bound); }
};

/// Heights of the rail's nodes on one line after every step of a run.
std::vector<Dense> heights(Simulation& run, const LineModel& line, const Heights& of, int steps) {
  std::vector<Dense> all;
  Outputs outputs{};
  for (int n = 0; n < steps; ++n) {
    static_cast<void>(advance_frame(run.model(), run.state, run.workspace, outputs));
    Dense z;
    for (const std::int32_t place : of.place)
      z.push_back(unknown_value(line, place, {run.state.u, {run.state.u, run.state.v}}));
    all.push_back(z);
  }
  return all;
}

long double largest(const std::vector<Dense>& a, const std::vector<Dense>* b = nullptr) {
  long double most = 0.L;
  for (std::size_t n = 0; n < a.size(); ++n)
    for (std::size_t i = 0; i < a[n].size(); ++i) {
      const long double x = std::fabs(a[n][i] - (b == nullptr ? 0.L : (*b)[n][i]));
      if (!(x <= most)) most = x;  // NaN too
    }
  return most;
}

std::vector<Dense> picked(const std::vector<Dense>& u, const Heights& of) {
  std::vector<Dense> z;
  for (const Dense& all : u) {
    z.emplace_back();
    for (const std::size_t i : of.unknown) z.back().push_back(all[i]);
  }
  return z;
}

/// (p b - a) / (p - 1): the limit, if b's error is a p-th of a's.
std::vector<Dense> extrapolated(const std::vector<Dense>& a, const std::vector<Dense>& b, int p) {
  std::vector<Dense> z = b;
  for (std::size_t n = 0; n < z.size(); ++n)
    for (std::size_t i = 0; i < z[n].size(); ++i) z[n][i] += (b[n][i] - a[n][i]) / (p - 1);
  return z;
}

/// The line of a run that contains the rail's heights.
struct LoadedLine {
  const PackedLine* own = nullptr;
  const LineModel* model = nullptr;
  explicit LoadedLine(const Simulation& run) {
    for (std::size_t l = 0; l < run.packed()->lines().size(); ++l)
      for (int node = 0; node < run.track().nodes(); ++node)
        if (run.packed()->lines()[l].line.unknown(0, node, 2) >= 0) {
          own = &run.packed()->lines()[l];
          model = &run.model().line[l];
        }
    REQUIRE(own != nullptr);
  }
};

/// Full order with the same step.
Judged against_same_step(const RandomScene& scene) {
  Simulation run(read(scene));
  const LoadedLine loaded(run);
  const std::vector<Line> lines = assemble(run.track());
  const Line& line = lines[loaded.own->index];
  const DenseNewmark dense(run.track(), line, scene.loads);
  const Heights of(run.track(), line, *loaded.model);
  DenseNewmark::Motion start = dense.at_rest();
  for (std::size_t i = 0; i < dense.unknowns(); ++i) {
    const auto at = static_cast<std::size_t>(loaded.model->first) + i;
    start.u[i] = run.state.u[at];
    start.v[i] = run.state.v[at];
    start.a[i] = run.state.a[at];
  }
  const auto want = picked(dense.run(start, scene.dt, scene.steps, 1), of);
  const auto got = heights(run, *loaded.model, of, scene.steps);
  const double steps = scene.steps;
  return {static_cast<double>(largest(got, &want) / largest(want)),
          steps * steps * kEps * dense.condition(scene.dt)};
}

/// Condensed, with such small steps that they do not matter.
Judged against_small_steps(const RandomScene& scene) {
  Simulation run(read(scene));
  const LoadedLine loaded(run);
  const std::vector<Line> lines = assemble(run.track());
  const Line& line = lines[loaded.own->index];
  const DenseNewmark dense(run.track(), line, scene.loads);
  const Heights of(run.track(), line, *loaded.model);
  const auto in = [&](int parts) {
    return picked(dense.run(dense.at_rest(), scene.dt, scene.steps, parts), of);
  };
  const auto two = in(2), four = in(4), eight = in(8);
  const auto coarse = extrapolated(two, four, 4), fine = extrapolated(four, eight, 4);
  const auto want = extrapolated(coarse, fine, 16);
  const auto got = heights(run, *loaded.model, of, scene.steps);
  const long double peak = largest(want);
  return {static_cast<double>(largest(got, &want) / peak),
          static_cast<double>(largest(coarse, &fine) / peak) / 15. + 1e-9};
}

}  // namespace

TEST_CASE("full order is the dense trapezoidal rule, but for round-off", "[differential]") {
  // The solve of a step errs by eps times the condition of its scaled matrix. This is twice as
  // large a velocity per step, which may persist over all steps, and so may that of each step.
  double worst = 0., most = 0., loosest = 0.;
  int failed = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    RandomScene scene = loaded(seed, 1e-5, 5e-3, 100, false);
    scene.scheme = "scheme = \"newmark\"\n";
    const Judged found = against_same_step(scene);
    worst = std::max(worst, found.error / found.bound);
    most = std::max(most, found.error);
    loosest = std::max(loosest, found.bound);
    if (!found.fails()) continue;
    report(scene, fmt::format("off by {:.3g}, bound {:.3g}", found.error, found.bound),
           [](const RandomScene& s) { return against_same_step(s).fails(); });
    if (++failed == 3) break;
  }
  CAPTURE(worst, most, loosest);
  CHECK(loosest < 1e-6);
}

TEST_CASE("a complete condensed track is the dense one with exact steps", "[differential]") {
  // Forces are linear over a step on both sides. R1 and R2 are Richardson's values from steps of
  // h/2, h/4 and h/8. R2 errs by a 15th of their difference where the step is small enough, and the
  // extrapolation of both by less. Modes are exact to the eigen solver's 1e-10.
  const std::string kind = GENERATE(as<std::string>(), "modal", "guyan", "irs", "craig-bampton",
                                    "krylov", "complex-modes");
  std::vector<double> bounds;
  double worst = 0., most = 0.;
  int failed = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(kind, seed);
    const RandomScene scene = all_kept(seed, kind);
    const Judged found = against_small_steps(scene);
    bounds.push_back(found.bound);
    worst = std::max(worst, found.error / found.bound);
    most = std::max(most, found.error);
    if (!found.fails()) continue;
    report(scene, fmt::format("off by {:.3g}, bound {:.3g}", found.error, found.bound),
           [](const RandomScene& s) { return against_small_steps(s).fails(); });
    if (++failed == 3) break;
  }
  std::sort(bounds.begin(), bounds.end());
  CAPTURE(kind, worst, most, bounds[bounds.size() / 2], bounds.back());
  // The reference is good enough for a comparison.
  CHECK(bounds[bounds.size() / 2] < 1e-6);
  CHECK(bounds.back() < 1e-4);
}
