#pragma once
// A part of a track on its way into lines. Only assemble.cpp, joint.cpp and add_seat.cpp include
// this.
#include <array>
#include <utility>
#include <vector>

#include "offline/track/track.h"

namespace railstep {

/// Relation of a part to the rails: the rails themselves, or the symmetric or antisymmetric mirror
/// coordinate.
enum class Mirror { none, symmetric, antisymmetric };

/// Coefficients over the unknowns of a part.
using Row = std::vector<std::pair<int, double>>;

inline void push(Row& row, int unknown, double coefficient) {
  if (unknown >= 0 && coefficient != 0.) row.emplace_back(unknown, coefficient);
}

/// A part of the track before it is split: numbering and entries.
struct Assembly {
  using Triplets = std::vector<Eigen::Triplet<double>>;

  Mirror mirror;
  std::vector<int> rails;  // whose unknowns it has; the left rail's stand for both in a mirror
  Line line = {};
  int count = 0;
  Triplets mass = {}, damping = {}, stiffness = {};
  Triplets end_damping = {};  // these are in damping too

  /// Energy factor (row u)^2 / 2.
  static void add(Triplets& to, const Row& row, double factor) {
    if (factor == 0.) return;
    for (const auto& [i, a] : row)
      for (const auto& [j, b] : row)
        if (a * b != 0.) to.emplace_back(i, j, factor * a * b);
  }
  /// Entries of 0, which keep unknowns that a one-sided spring couples in one line.
  static void tie(Triplets& to, const Row& row) {
    for (const auto& [i, a] : row)
      for (const auto& [j, b] : row) to.emplace_back(i, j, 0.);
  }
};

/// Numbers the rail's end ahead of a joint at the node, if there is one.
void number_cut(const Track& track, Assembly& part, int rail, int node);

/// The springs of a rail's joints.
void add_joints(const Track& track, Assembly& part, int rail);

/// The springs of the part's rails on a seat, and the sleeper's own mass and ballast.
void add_seat(const Track& track, Assembly& part, int border);

}  // namespace railstep
