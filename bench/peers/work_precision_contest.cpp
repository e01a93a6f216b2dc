// The moving-load scene on one mesh, so errors are only of the time integration: SUNDIALS over its
// tolerance, plain Eigen and railstep over their step.
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <string>

#include "arkode_peer.h"
#include "contest.h"
#include "eigen_peer.h"
#include "ida_peer.h"

namespace railstep {

namespace {

/// The common reference: railstep at 1.25 us on the same mesh, and the change by halving that step.
struct FineStep {
  std::vector<double> z;
  double own_error;
};

FineStep fine_step(const Track& track) {
  const auto at = [&](int steps) {
    MovingLoadRun run(track, {.dt = kStep / steps, .steps_per_frame = steps, .residual = false});
    return deflections(run);
  };
  const std::vector<double> z = at(800);
  return {z, largest_error(at(400), z, kStartUp)};
}

template <class Run>
Contestant contestant(const std::string& name, int elements, double step,
                      const std::shared_ptr<Run>& run, const FineStep& fine) {
  const std::vector<double> z = deflections(*run);
  return {.peer = name,
          .scene = "moving_load_in_time",
          .elements = elements,
          .step = step,
          .error = largest_error(z, fine.z, kStartUp),
          .error_from_start = largest_error(z, fine.z, 0),
          .reference_error = fine.own_error,
          .unknowns = run->unknowns(),
          .flops = std::nan(""),
          .frame = [run] { return run->frame(); },
          .passage = run->frames()};
}

template <class Peer>
void by_tolerance(const char* name, const LinearTrack& track, int passage, int order,
                  std::initializer_list<double> tolerances, const FineStep& fine,
                  std::vector<Contestant>& all) {
  for (const double tolerance : tolerances) {
    char full_name[64];
    std::snprintf(full_name, sizeof full_name, "%s order %d at %g", name, order, tolerance);
    const SundialsSettings settings{.tolerance = tolerance, .order = order};
    all.push_back(contestant(full_name, track.elements, 0.,
                             std::make_shared<Peer>(track, passage, settings), fine));
    std::fprintf(stderr, "%s: %ld steps\n", full_name, [&] {
      Peer peer(track, passage, settings);
      for (int i = 0; i < peer.frames(); ++i) peer.frame();
      return peer.steps();
    }());
  }
}

}  // namespace

std::vector<Contestant> work_precision_contest(int elements) {
  const Track track = moving_load_track(elements, 1, 2, Unknowns::vertical);
  const int passage = passage_steps(track);
  const LinearTrack along_x = linear_track(track, Carried::all, Numbering::along_x);
  const LinearTrack least_fill = linear_track(track, Carried::all, Numbering::least_fill);
  const FineStep fine = fine_step(track);
  std::vector<Contestant> all;
  for (const int steps : {1, 2, 4, 10, 20, 40}) {
    const double dt = kStep / steps;
    all.push_back(contestant("Eigen", elements, dt,
                             std::make_shared<EigenPeer>(least_fill, passage, dt, steps), fine));
    const MovingLoadOptions options{.dt = dt, .steps_per_frame = steps, .residual = false};
    all.push_back(contestant("railstep", elements, dt,
                             std::make_shared<MovingLoadRun>(track, options), fine));
  }
  by_tolerance<ArkodePeer>("ARKODE", along_x, passage, 3, {1e-1, 1e-2, 1e-3, 1e-4}, fine, all);
  by_tolerance<ArkodePeer>("ARKODE", along_x, passage, 4, {1e-2, 1e-3, 1e-4}, fine, all);
  by_tolerance<IdaPeer>("IDA", along_x, passage, 2, {1e-2, 1e-3, 1e-4}, fine, all);
  by_tolerance<IdaPeer>("IDA", along_x, passage, 5, {1e-2, 1e-3}, fine, all);
  return all;
}

}  // namespace railstep
