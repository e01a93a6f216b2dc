// The moving-load scene at 1 ms: plain Eigen and railstep on the same linear model.
#include <cstdio>
#include <memory>
#include <string>

#include "contest.h"
#include "eigen_peer.h"

namespace railstep {

namespace {

/// @param against  deflections of the same model by railstep, or empty
template <class Run>
Contestant contestant(const std::string& name, const Track& track, const std::shared_ptr<Run>& run,
                      const std::vector<double>* against = nullptr) {
  const PassageReference& reference = reference_for(track.bays, Unknowns::vertical);
  const std::vector<double> z = deflections(*run);
  if (against != nullptr)
    std::fprintf(stderr, "%s, %d elements: %.1e of the peak from railstep on the same model\n",
                 name.c_str(), track.elements(), largest_error(z, *against, 0));
  return {.peer = name,
          .scene = "moving_load",
          .elements = track.elements(),
          .step = kStep,
          .error = largest_error(z, reference.z, kStartUp),
          .error_from_start = largest_error(z, reference.z, 0),
          .reference_error = reference.own_error,
          .unknowns = run->unknowns(),
          .flops = run->flops(),
          .frame = [run] { return run->frame(); }};
}

Contestant by_railstep(const std::string& name, const Track& track,
                       const MovingLoadOptions& options) {
  return contestant(name, track, std::make_shared<MovingLoadRun>(track, options));
}

Contestant by_eigen(const std::string& name, const Track& track, Carried carried,
                    const std::vector<double>* against) {
  return contestant(name, track,
                    std::make_shared<EigenPeer>(linear_track(track, carried, Numbering::least_fill),
                                                passage_steps(track)),
                    against);
}

Contestant by_modes(const Track& track, double per_bay) {
  char name[64];
  std::snprintf(name, sizeof name, "railstep condensed %g modes a bay", per_bay);
  const Reduction lowest{.limit = {static_cast<int>(track.bays * per_bay), 1e9}};
  return by_railstep(name, track, {.reduction = lowest});
}

}  // namespace

std::vector<Contestant> moving_load_contest(int bays) {
  const Track full = moving_load_track(bays, 1, 2, Unknowns::full);
  const Track vertical = moving_load_track(bays, 1, 2, Unknowns::vertical);
  MovingLoadRun same(full, {.residual = false});
  const std::vector<double> z = deflections(same);
  std::vector<Contestant> all;
  all.push_back(by_eigen("Eigen 9 a node whole elements", full, Carried::whole_elements, &z));
  all.push_back(by_eigen("Eigen 9 a node", full, Carried::all, &z));
  all.push_back(by_eigen("Eigen 2 a node", vertical, Carried::all, &z));
  all.push_back(by_railstep("railstep 2 a node no residual", vertical, {.residual = false}));
  all.push_back(by_railstep("railstep 9 a node", full, {}));
  all.push_back(by_railstep("railstep 2 a node", vertical, {}));
  for (const int per_bay : {2, 4, 8})
    all.push_back(by_eigen("Eigen 2 a node " + std::to_string(per_bay) + " elements a bay",
                           moving_load_track(bays, per_bay, 2, Unknowns::vertical), Carried::all,
                           nullptr));
  const Track two_a_bay = moving_load_track(bays, 2, 2, Unknowns::vertical);
  for (const double per_bay : {1., .5, .25}) all.push_back(by_modes(two_a_bay, per_bay));
  return all;
}

}  // namespace railstep
