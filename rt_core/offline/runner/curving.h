#pragma once
#include "offline/runner/line_shape.h"
#include "offline/runner/suspension.h"
#include "online/runner/frames.h"
#include "online/runner/rolling_contact.h"

namespace railstep {

/// The tables of RunnerFrames. The columns of its matrices are poses.
struct FrameMatrices {
  std::vector<FramePair> pairs;
  std::vector<FrameElement> elements;
  std::vector<double> stiffness, preload;
  /// [of each][6 pairs] displacements of their rows; of force elements with those of their loads.
  Eigen::MatrixXd series, elements_moved, traced_moved, rods;
};
/// An element to the ground goes along with its body, and a brake is not moved.
FrameMatrices frame_matrices(const Runner& runner);
/// Throws Refused if there are more than kMaxFramePairs.
void set_pairs(const std::vector<FramePair>& pairs, RunnerFrames& frames);

/// The longest distance of two bodies that an element joins, m.
double reach_of(const Runner& runner);
/// Centres of the bodies, [3 bodies].
std::vector<double> centres_of(const Runner& runner);

/// The matrices of a vehicle on a design line, as it stands there: with the forces of the frames
/// and of what is between them at rest, and with force elements, dampers in series and rods as the
/// poses move them.
/// @param u  [n] motions, on which the forces depend in second order
RunnerMatrices matrices_on(const DesignLine& line, const OnLine& at, const Runner& runner,
                           const RunnerMatrices& matrices, double gravity,
                           const Eigen::VectorXd& u);

/// RunnerMatrices::turned of a vehicle on a design line, by central differences.
/// @param u  [n] motions
Eigen::MatrixXd turned_stiffness(const DesignLine& line, const OnLine& at, const Runner& runner,
                                 const Eigen::VectorXd& u);

/// Sets the rates of the frames in the rails under each wheelset.
/// @param rails  [wheelsets]; empty: straight and level ones are made
void set_frame_rates(const DesignLine& line, const OnLine& at, const Runner& runner,
                     std::vector<RailsUnder>& rails);

}  // namespace railstep
