#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "answer/running_limits.h"
#include "run/simulate.h"

namespace railstep {

/// The running behaviour of the rail vehicles of a run by the quantities of EN 14363 / UIC 518, and
/// the ride by EN 12299 and Sperling's index, from the rows of its trace: docs/outputs.md. Values
/// that are not known are NaN.

/// A quantity over a section of the track: that of the wheel, wheelset or sensor whose value is the
/// largest.
struct AssessedValue {
  Assessed quantity;
  std::string where;    // its name
  double value, limit;  // in the quantity's unit; no limit: NaN
};

/// A value over its limit; by itself if it has none.
double against_limit(const AssessedValue& value);

enum class SectionKind { straight, transition, curve };
/// A part of the way of a vehicle's first body.
struct TrackSection {
  SectionKind kind;
  double from, to;  // m along the track
  double radius;    // m, in its middle, above 0 to the left; 0: straight
};
struct AssessedSection : TrackSection {
  double speed;   // m/s, mean
  double across;  // m/s2, mean acceleration in the track's plane that cant leaves
  std::vector<AssessedValue> values;
};

/// The largest value to expect, by the mean of like sections and the deviation between them.
struct EstimatedValue {
  const char* track;  // which sections
  Assessed quantity;
  int sections;
  double estimate, limit;
};

/// Ride at a sensor on a vehicle, from accelerations along y and z as the body feels them.
struct RideComfort {
  std::string sensor;
  int blocks;                     // of 5 s
  double comfort;                 // N_MV of EN 12299, without accelerations along x
  double weighted_y, weighted_z;  // 95th percentile of the blocks' weighted rms, m/s2
  double index_y, index_z;        // Sperling's W_z of comfort
};

/// Quantities over the way, for plots.
struct AssessedCurve {
  Assessed quantity;
  std::string where;
  std::vector<double> place, value;
};

struct AssessedVehicle {
  std::string name;
  double nadal;  // limit of Y/Q by Nadal of its wheels' flanges; NaN of cones
  std::vector<AssessedSection> sections;
  std::vector<EstimatedValue> estimates;
  std::vector<RideComfort> ride;
  std::vector<AssessedCurve> curves;
};

/// Longest time between two rows, s: a quarter of a wave of 50 Hz.
inline constexpr double kMostRowInterval = 5e-3;
/// Vehicles that go less than 2 m have no sections, and no ride in less than 5 s.
/// @param record  with its rows
std::vector<AssessedVehicle> assess(const Scene& scene, const Simulation& run,
                                    const RunRecord& record);

const char* name_of(SectionKind kind);
nlohmann::ordered_json to_json(const std::vector<AssessedVehicle>& vehicles);

}  // namespace railstep
