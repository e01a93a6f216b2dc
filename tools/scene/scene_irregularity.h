#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "offline/irregularity/generate.h"

namespace railstep {

inline constexpr double kContactPatch = .012;  // m, length over which irregularities are averaged

/// [irregularity]: a track's record, or a signal made of a named spectrum.
struct IrregularityScene {
  std::filesystem::path file;  // empty: generated
  std::string spectrum;
  std::vector<Geometry> geometries;
  GenerateOptions options;  // of a file, its patch alone
};

enum class DefectKind { dipped_joint, corrugation };

/// [[defect]] of one rail or of both.
struct DefectScene {
  DefectKind kind;
  std::array<bool, 2> on;              // left, right
  double at, depth, ramp;              // of a dipped joint, m
  double from, to, length, amplitude;  // of a corrugation, m; its wavelength
  double patch;                        // m
};

enum class TreadKind { fresh_flat, rounded_flat, out_of_round };

/// [[wheelset.tread]]: deviation from round, of one wheel or of both.
struct TreadScene {
  TreadKind kind;
  std::array<bool, 2> on;  // left, right
  double first;            // distance rolled until its middle is below for the first time, m
  double length, depth;    // of a flat, m
  int order;               // of an out-of-round wheel, waves a turn
  double amplitude;        // of it, m
  double patch;            // m
};

/// [[vehicle.tread]]: the same for one wheel of a vehicle.
struct WheelTread {
  std::size_t wheel;  // from 0, the foremost
  TreadScene shape;
  double radius;  // m
};

}  // namespace railstep
