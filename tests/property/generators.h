#pragma once
#include <cstdint>
#include <string>

#include "document.h"
#include "draw.h"

namespace railstep::property {

/// The scene of a seed. What a key needs stands beside it; a few scenes are refused all the same
/// (no equilibrium, a free rigid mode, a rail that buckles).
Document random_track_scene(std::uint64_t seed);
Document random_mechanism_scene(std::uint64_t seed);
Document random_endless_scene(std::uint64_t seed);

/// What stands on the ground: [track], [rail], [support], [sleeper], [ballast].
struct GroundChoice {
  const char* unknowns;
  int rails;
  int bays;
};
void add_ground(Draw& draw, const GroundChoice& choice, Document& scene);
/// Seats that differ, stops and rail joints.
void add_seats_that_differ(Draw& draw, Document& scene);

/// Loads, wheelsets, vehicles, irregularities and sensors on a track, to one step.
/// @param speed  of all of them on a track without end; else each draws its own
void add_traffic(Draw& draw, Document& scene, const double* speed);
void add_condensation(Draw& draw, Document& scene);
/// Time steps, how long and by which scheme. Traffic comes after it.
void add_step(Draw& draw, Document& scene);

/// Length of the track, m; of the ring or window under its traffic, of one without end.
double length_of(const Document& scene);
double duration_of(const Document& scene);
bool moves_sideways(const Document& scene);
bool has_shape(const Document& scene);

}  // namespace railstep::property
