#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "../../bench/peers/arkode_peer.h"
#include "../../bench/peers/eigen_peer.h"
#include "../../bench/peers/ida_peer.h"

using namespace railstep;

namespace {

/// Deflections by railstep with the same mesh, scheme and step, m; without residual flexibility,
/// which the peers' plain matrices do not have.
std::vector<double> by_railstep(const Track& track, int steps_per_ms) {
  MovingLoadRun run(
      track, {.dt = kStep / steps_per_ms, .steps_per_frame = steps_per_ms, .residual = false});
  return deflections(run);
}

std::vector<double> by_eigen(const Track& track, Carried carried, Numbering numbering,
                             int steps_per_ms) {
  EigenPeer peer(linear_track(track, carried, numbering), passage_steps(track),
                 kStep / steps_per_ms, steps_per_ms);
  return deflections(peer);
}

template <class Peer>
std::vector<double> by_sundials(const Track& track, const SundialsSettings& settings) {
  Peer peer(linear_track(track, Carried::all, Numbering::along_x), passage_steps(track), settings);
  return deflections(peer);
}

}  // namespace

TEST_CASE("plain Eigen and railstep step the same model", "[peers]") {
  const Unknowns unknowns = GENERATE(Unknowns::vertical, Unknowns::full);
  const int elements_per_bay = GENERATE(1, 2);
  const int steps_per_ms = GENERATE(1, 4);
  const Track track = moving_load_track(16, elements_per_bay, 2, unknowns);
  const std::vector<double> want = by_railstep(track, steps_per_ms);
  for (const Carried carried : {Carried::whole_elements, Carried::all, Carried::moved})
    for (const Numbering numbering : {Numbering::along_x, Numbering::least_fill}) {
      const std::vector<double> z = by_eigen(track, carried, numbering, steps_per_ms);
      // Both solve with the same matrix S in different ways: for displacements by a band, for
      // accelerations by a sparse factor. Scaled to a diagonal of 1 its condition is at most 3e3,
      // which makes 3e-13 of a rounding of 1e-16. Errors of earlier steps are damped.
      CAPTURE(elements_per_bay, steps_per_ms, carried, numbering);
      CHECK(largest_error(z, want, 0) < 1e-12);
    }
}

TEST_CASE("unknowns that a load on the axis does not move stay at rest", "[peers]") {
  // The section is symmetric about its axis, so that bending (odd in z) neither stretches the rail
  // nor squeezes its section (even in z): two of nine unknowns remain.
  const Track full = moving_load_track(4, 1, 2, Unknowns::full);
  const Track vertical = moving_load_track(4, 1, 2, Unknowns::vertical);
  CHECK(linear_track(full, Carried::all, Numbering::along_x).unknowns() == 2 * 9 * full.nodes());
  CHECK(linear_track(full, Carried::moved, Numbering::along_x).unknowns() == 2 * 2 * full.nodes());
  CHECK(linear_track(vertical, Carried::all, Numbering::along_x).unknowns() ==
        2 * 2 * full.nodes());
}

TEST_CASE("SUNDIALS converges to railstep's refined step", "[peers][sundials]") {
  const Track track = moving_load_track(4, 1, 2, Unknowns::vertical);
  const std::vector<double> refined = by_railstep(track, 400), half = by_railstep(track, 200);
  // The sudden load and its kinks at element borders reduce the order, but to no less than one. The
  // change from halving the step therefore bounds the error of the finer run.
  const double own = largest_error(half, refined, 0);
  CAPTURE(own);
  double last = 1.;
  for (const double tolerance : {1e-2, 1e-3, 1e-5}) {
    const auto z = by_sundials<ArkodePeer>(track, {.tolerance = tolerance, .order = 3});
    const double error = largest_error(z, refined, 0);
    CAPTURE(tolerance, error, last);
    CHECK(error < last);
    last = error;
  }
  CHECK(last < 2. * own);
  const auto ida = by_sundials<IdaPeer>(track, {.tolerance = 1e-5, .order = 2});
  // A step's error is at most 1e-5 of 1 mm and of the motion; the track's damping removes what is
  // older than a few milliseconds.
  CHECK(largest_error(ida, refined, 0) < 2. * own);
}
