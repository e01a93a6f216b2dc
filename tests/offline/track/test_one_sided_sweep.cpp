// Random small tracks with one-sided supports: full order, condensed and a refined reference agree
// within the errors that `condense` states, at rest and in runs. To run more of them by hand:
//   RAILSTEP_SEEDS=1000:3000 build/release/tests/test_offline_track "-#" "[#test_one_sided_sweep]"
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "answer/condense_error.h"
#include "offline/analysis/statics.h"
#include "offline/pack/accuracy.h"
#include "run/simulate.h"
#include "support/random_scene.h"

using namespace railstep;

namespace {

constexpr int kFine = 64;  // elements per bay of the reference: loads are at its nodes

/// A scene's track of one rail with a load; which supports are one-sided, and how, is random.
struct OneSidedScene {
  std::uint64_t seed;
  std::string text;
  double force = 0.;  // N, downwards

  explicit OneSidedScene(std::uint64_t s) : seed(s) {
    Draw draw(s);
    const std::array<std::string, 2> ends = {"pinned", "clamped"};
    const std::array<std::string, 5> kinds = {"modal", "guyan", "irs", "craig-bampton", "krylov"};
    const int bays = draw.whole(3, 6);
    const double bay = draw.between(.5, 1.1);
    text = fmt::format(
        "schema = 1\n[track]\nunknowns = \"vertical\"\nrails = 1\nbays = {}\nbay_m = {:.17g}\n"
        "elements_per_bay = {}\nends = [\"{}\", \"{}\"]\n[rail]\nyoung_pa = {:.17g}\n",
        bays, bay, draw.whole(1, 3), draw.one_of(ends), draw.one_of(ends),
        draw.of_any_size(30e9, 210e9));
    if (draw.chance(.3)) text += fmt::format("axial_force_n = {:.17g}\n", draw.between(-6e4, 3e5));
    text += "[rail.rectangle]\nheight_m = 0.172\nwidth_m = 0.07\n";
    const bool sleepers = draw.chance(.4), pads = !sleepers || draw.chance(.5);
    text += fmt::format(
        "[support]\nat = \"axis\"\nstiffness_z_n_per_m = {:.17g}\ndamping_z_n_s_per_m = {:.17g}\n",
        draw.of_any_size(1e7, 5e9), draw.of_any_size(1e3, 1e5));
    if (pads) text += "unilateral = true\n";
    if (sleepers) {
      text += fmt::format(
          "[sleeper]\nmass_kg = {:.17g}\n[ballast]\nstiffness_z_n_per_m = {:.17g}\n"
          "damping_z_n_s_per_m = {:.17g}\n",
          draw.of_any_size(50., 400.), draw.of_any_size(1e7, 1e9), draw.of_any_size(1e3, 1e5));
      if (!pads) text += "unilateral = true\n";
    }
    if (draw.chance(.3))
      text += fmt::format("[[support_change]]\nseats = [{}]\n{}.gap_m = {:.17g}\n",
                          draw.whole(1, bays - 1), pads ? "support" : "ballast",
                          draw.of_any_size(1e-6, 1e-3));
    force = draw.of_any_size(1e3, 2e5);
    // An element of the reference ends there, but the tables have no place there.
    const double at = bay / kFine * (2 * draw.whole(1, bays * kFine / 2 - 10) + 1);
    text += fmt::format(
        "[[load]]\nname = \"load\"\nstart_m = {:.17g}\nforce_z_n = {:.17g}\n"
        "speed_m_per_s = {:.17g}\n",
        at, -force, draw.chance(.5) ? 0. : draw.between(1., 30.));
    text += fmt::format(
        "[step]\ndt_s = {:.17g}\nduration_s = {:.17g}\nstart = \"equilibrium\"\n"
        "[condense]\nkind = \"{}\"\n",
        2e-4, 4e-3, draw.one_of(kinds));
  }
};

/// Largest static deflection under the force over many places of the refined track, m.
double largest_deflection(const Statics& fine, double force) {
  double largest = 0.;
  const int places = 8 * fine.track().bays;
  for (int i = 1; i < places; ++i) {
    const RailPoint at{0, fine.track().length() * i / places, 0., 0., 2};
    largest = std::max(largest, std::abs(fine.at(fine.solve({{at, -force}}), at)));
  }
  return largest;
}

struct Found {
  double full = 0., condensed = 0., fine = 0., largest = 0.;  // deflections at the start, m
  double stated_full = 0., stated = 0.;                       // static errors
};

/// @param file  the scene's file
Found start_of(const OneSidedScene& scene, const std::string& file) {
  Found found;
  const auto deflection = [&](const Scene& read, double& stated) {
    Simulation run(read);
    stated = static_error(run.track(), *run.packed());
    return simulate(run, 0, {}, true).rows[2];
  };
  const Scene own = read_scene(file);
  found.condensed = deflection(own, found.stated);
  found.full = deflection(read_scene(file, {"condense.kind=\"full\""}), found.stated_full);
  const Track track =
      track_of(read_scene(file, {"track.elements_per_bay=" + std::to_string(kFine)}));
  const Statics fine(track);
  const RailPoint at{0, own.loads[0].start, 0., 0., 2};
  found.fine = fine.at(fine.solve({{at, -scene.force}}), at);
  found.largest = std::max(largest_deflection(fine, scene.force), std::abs(found.fine));
  return found;
}

/// Run of a scene, and the same with eight times the elements and steps.
struct Run {
  double off;     // for the condensed run, over the peak
  double stated;  // transient error, twice the error known of both references, and rounding
};

std::vector<double> deflections(const Scene& scene) {
  Simulation run(scene);
  const RunRecord record = simulate(run, run.model().steps / run.model().steps_per_frame, {}, true);
  std::vector<double> values;
  for (std::size_t i = 2; i < record.rows.size(); i += run.columns().size())
    values.push_back(record.rows[i]);
  return values;
}

Run run_of(const std::string& file) {
  const Scene own = read_scene(file);
  const std::string elements = std::to_string(8 * own.track.elements_per_bay);
  const std::vector<double> got = deflections(own),
                            want = deflections(read_scene(
                                file, {"condense.kind=\"full\"", "step.dt_s=2.5e-5",
                                       "step.frame_s=2e-4", "track.elements_per_bay=" + elements}));
  double peak = 0., off = 0.;
  REQUIRE(got.size() == want.size());
  for (std::size_t i = 0; i < want.size(); ++i) {
    peak = std::max(peak, std::abs(want[i]));
    off = std::max(off, std::abs(got[i] - want[i]));
  }
  const TransientError stated = transient_error(own, {});
  return {off / peak, stated.largest + 2. * stated.reference_error + 1e-8};
}

}  // namespace

TEST_CASE("random tracks with one-sided supports keep to the stated errors", "[supports]") {
  std::uint64_t first = 0, last = 200;
  if (const char* seeds = std::getenv("RAILSTEP_SEEDS")) {
    char* rest = nullptr;
    first = std::strtoull(seeds, &rest, 10);
    last = std::strtoull(rest + 1, nullptr, 10);
  }
  const std::string file =
      (std::filesystem::temp_directory_path() / fmt::format("railstep_sweep_{}.toml", getpid()))
          .string();
  for (std::uint64_t seed = first; seed < last; ++seed) {
    const OneSidedScene scene(seed);
    std::ofstream(file) << scene.text;
    const Found found = start_of(scene, file);
    const auto apart = [&](double a, double b) { return std::abs(a - b) / found.largest; };
    CAPTURE(seed, scene.text, found.full, found.condensed, found.fine, found.largest);
    // Cubics read tables of what a basis leaves out: 2e-5 is the largest error of 200.
    CHECK(apart(found.full, found.condensed) < 1e-4);
    // The statement has 128 places, down to eight per element: between two of them the error may be
    // a little larger.
    CHECK(apart(found.full, found.fine) < 1.05 * found.stated_full);
    CHECK(apart(found.condensed, found.fine) < 1.05 * found.stated);
    const Run run = run_of(file);
    CHECK(run.off < run.stated);
  }
  std::filesystem::remove(file);
}
