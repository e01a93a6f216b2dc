#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "run/inputs.h"
#include "run/simulation.h"
#include "text/message.h"

namespace railstep {

inline constexpr int kShapes = 4;  // times at which a run keeps the rails' shapes

/// Times of frames that a run keeps, so that its memory does not grow with its length.
inline constexpr std::size_t kMostTimes = std::size_t{1} << 20;

/// A rail's axis at one time, at all nodes of the track.
struct RailSnapshot {
  double time;            // s
  int rail;               // 0 left, 1 right
  double length;          // m
  std::vector<double> z;  // [nodes] displacement by the lines alone, m
};

/// The results of a run of whole frames, and its times.
struct RunRecord {
  Status status = Status::ok;           // of all frames together
  std::int32_t first_bad_unknown = -1;  // -1: all finite
  double constraint_violation = 0.;     // largest, m or rad
  int iterations = 0;                   // largest of a step
  std::set<std::string> redundant;      // joints that redundant rows belong to
  std::vector<double> frame_us;         // wall time of steps alone, us: of each frame_stride-th
  std::int64_t frame_stride = 1;        // 1 up to kMostTimes frames
  double slowest_us = 0.;               // of all frames
  double deepest = 0.;                  // a rail's place under traffic, up, m; never above 0
  std::int64_t allocations = 0;         // calls of new within the frames, see heap_count.h
  std::vector<double> rows;             // the trace, row after row; only when asked for
  std::vector<double> violations;       // [frames + 1] of the constraints; with the rows
  std::vector<RailSnapshot> shapes;     // at kShapes times; only when asked for
};

/// Takes the rows of a trace, one after the other.
using RowSink = std::function<void(std::span<const double>)>;

/// Steps `frames` frames from the state as it stands; stops early when the state is not finite.
/// @param sink      gets a row for the state at the start and one a frame; may be empty
/// @param keep_rows also keep the rows in the record
/// @param after     called after every frame with the number of frames done; may be empty
/// @param inputs    what the frames are given
RunRecord simulate(Simulation& run, std::int64_t frames, const RowSink& sink, bool keep_rows,
                   const std::function<void(std::int64_t)>& after = {},
                   const FrameInputs& inputs = {});

/// Names of the bits that are set, as in the JSON; empty when all is well.
std::vector<std::string> status_names(Status status);
/// The meaning of a status bit and what to do, by its name; with the joints that it is about.
std::string status_sentence(const std::string& name, const RunRecord& record);
/// Says where and when a run stopped being finite, by Outputs::first_bad_unknown:
/// "nonfinite_state: at step ...".
Message nonfinite_error(const Simulation& run, std::int32_t first_bad_unknown);
/// The same in one line, with its id.
std::string nonfinite_sentence(const Simulation& run, std::int32_t first_bad_unknown);
/// The place of an unknown of the state, in words.
std::string unknown_place(const Simulation& run, std::int32_t unknown);

/// Time of the q-th part of the frames (0 to 1), us: the smallest that this part does not exceed.
double quantile(std::vector<double> values, double q);

}  // namespace railstep
