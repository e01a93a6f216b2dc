#pragma once
#include <cstdint>
#include <string>

#include "document.h"
#include "draw.h"

namespace railstep::property {

/// The scene of a seed. All keys that a key needs are drawn with it. A few scenes are still refused
/// (no equilibrium, a free rigid mode, a rail that buckles).
Document random_track_scene(std::uint64_t seed);
Document random_mechanism_scene(std::uint64_t seed);
Document random_endless_scene(std::uint64_t seed);

/// Choices for [track], [rail], [support], [sleeper] and [ballast].
struct GroundChoice {
  const char* unknowns;
  int rails;
  int bays;
};
void add_ground(Draw& draw, const GroundChoice& choice, Document& scene);
/// Adds seats that differ, stops and rail joints.
void add_seats_that_differ(Draw& draw, Document& scene);

/// Adds loads, wheelsets, vehicles, irregularities and sensors to a track with a step.
/// @param speed  of all traffic on a track without end; null: each part draws its own
void add_traffic(Draw& draw, Document& scene, const double* speed);
void add_condensation(Draw& draw, Document& scene);
/// Adds the time step, duration and scheme. Traffic is added after it.
void add_step(Draw& draw, Document& scene);

/// Length of the track, m; without end, length of the ring or window under its traffic.
double length_of(const Document& scene);
double duration_of(const Document& scene);
bool moves_sideways(const Document& scene);
bool has_shape(const Document& scene);

}  // namespace railstep::property
