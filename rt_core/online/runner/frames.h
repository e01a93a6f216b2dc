#pragma once
#include "online/model/runner_model.h"
#include "online/track/along_line.h"

namespace railstep {

/// How the first body's frame goes along the design line, m, m/s and m/s2.
struct OnLine {
  double place, speed, faster;
};

/// The bodies whose frames follow a design line.
struct LineBodies {
  std::int32_t count;
  const double* centre;  // [count][3] RunnerFrames::centre
  const double* mass;    // [6 count] kg, kg m2
  double gravity;        // m/s2
};

/// @param pose  [6 frames.pairs] out
void find_poses(const DesignLine& line, const OnLine& at, const RunnerFrames& frames,
                double* pose) noexcept;

/// Adds what the elements of all pairs do beyond their linear forces between frames that stand
/// straight behind each other. Here nothing is linearised; an element feels the rates of frames,
/// not those of the bodies in them.
/// @param u      [size] motions; those along x count from the first body's
/// @param force  [size]
void add_pair_forces(const DesignLine& line, const OnLine& at, const RunnerFrames& frames,
                     const double* u, double* force) noexcept;

/// Adds the forces by which frames that accelerate and lean move their bodies.
/// @param span   s, as of frame_motion()
/// @param force  [6 count]
void add_frame_forces(const DesignLine& line, const OnLine& at, const LineBodies& bodies,
                      double span, double* force) noexcept;

/// Adds the gyroscopic moments of a wheelset whose frame rotates. @param force  [6]
/// @param momentum  of its spin, N m s
void add_gyroscopic(const FrameRotation& rotation, double speed, double momentum,
                    double* force) noexcept;

}  // namespace railstep
