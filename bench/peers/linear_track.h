#pragma once
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "peer_moving_load.h"

namespace railstep {

/// Part of the track that a peer computes: every unknown, with whole assembled blocks of 27 by 27
/// per element; every unknown, with only the nonzeros of the blocks; or, as railstep does, only the
/// unknowns that a vertical load on the axis moves.
enum class Carried { whole_elements, all, moved };

/// Numbering of a peer's unknowns: along x, as assembled, or for the least fill of its factor.
enum class Numbering { along_x, least_fill };

/// The moving-load scene as plain sparse matrices, all rails in one system:
///   M u'' + D u' + K u = f(t).
struct LinearTrack {
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  Matrix mass, damping, stiffness;   // [unknowns][unknowns] symmetric, both triangles
  std::vector<std::vector<int>> rz;  // [rails][nodes] number of r_z
  int elements;
  double element_length;  // m

  int unknowns() const { return static_cast<int>(stiffness.rows()); }

  /// Place of a load at a time, with its quadratic shape functions.
  struct Place {
    std::size_t node;  // first of its element's three
    std::array<double, 3> shape;
  };
  Place place(double time) const {
    const double scaled = load_place(time) / element_length;
    const int e = std::clamp(static_cast<int>(scaled), 0, elements - 1);
    const double xi = 2. * (scaled - e) - 1.;
    return {static_cast<std::size_t>(2 * e),
            {.5 * xi * (xi - 1.), 1. - xi * xi, .5 * xi * (xi + 1.)}};
  }
  /// Adds 50 kN downwards at a place of every rail to f, [unknowns] N.
  template <class Vector>
  void add_loads(const Place& at, Vector&& f) const {
    for (const std::vector<int>& node : rz)
      for (std::size_t i = 0; i < 3; ++i) f[node[at.node + i]] += kLoad * at.shape[i];
  }
  /// Deflection of the first rail at a place, m. @param u  [unknowns] m
  template <class Vector>
  double deflection(const Place& at, const Vector& u) const {
    double sum = 0.;
    for (std::size_t i = 0; i < 3; ++i) sum += at.shape[i] * u[rz[0][at.node + i]];
    return sum;
  }
};

/// Adds entries of 0 between all unknowns of an element.
/// @param number  [nodes][9] of a rail, -1 where not carried
inline void tie_elements(const Line::RailUnknowns& number,
                         std::vector<Eigen::Triplet<double>>& entries) {
  for (std::size_t first = 0; first + 2 < number.size(); first += 2)
    for (std::size_t i = first; i < first + 3; ++i)
      for (std::size_t j = first; j < first + 3; ++j)
        for (const int row : number[i])
          for (const int column : number[j])
            if (row >= 0 && column >= 0) entries.emplace_back(row, column, 0.);
}

/// Renumbers the unknowns for the least fill of a factor.
inline void number_for_least_fill(LinearTrack& track) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(Eigen::SparseMatrix<double>(track.stiffness), inverse);
  const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> to = inverse.inverse();
  for (LinearTrack::Matrix* A : {&track.mass, &track.damping, &track.stiffness}) {
    const LinearTrack::Matrix along_x = *A;
    *A = to * along_x * inverse;
  }
  for (std::vector<int>& node : track.rz)
    for (int& i : node) i = to.indices()[i];
}

/// Assembles the track as railstep does, element by element, and puts its lines one after another.
/// Throws std::invalid_argument if rails are coupled; in this scene they are not.
inline LinearTrack linear_track(const Track& track, Carried carried, Numbering numbering) {
  std::vector<Eigen::Triplet<double>> entries[3];
  LinearTrack made{{}, {}, {}, {}, track.elements(), track.element_length()};
  made.rz.resize(static_cast<std::size_t>(track.rails));
  std::array<Line::RailUnknowns, 2> number;
  for (Line::RailUnknowns& of_rail : number)
    of_rail.assign(static_cast<std::size_t>(track.nodes()), {-1, -1, -1, -1, -1, -1, -1, -1, -1});
  int first = 0;
  for (const Line& line : assemble(track)) {
    const auto rail = static_cast<std::size_t>(line.first_rail());
    if (line.mirrored || line.rail_factor[rail] != 1.)
      throw std::invalid_argument("rails of the moving-load scene share nothing");
    if (carried == Carried::moved && line.unknown(line.first_rail(), 0, 2) < 0) continue;
    for (std::size_t node = 0; node < number[rail].size(); ++node)
      for (std::size_t k = 0; k < 9; ++k)
        if (line.unknown_of[rail][node][k] >= 0)
          number[rail][node][k] = first + line.unknown_of[rail][node][k];
    const Eigen::SparseMatrix<double>* const parts[3] = {&line.mass, &line.damping,
                                                         &line.stiffness};
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < line.unknowns(); ++j)
        for (Eigen::SparseMatrix<double>::InnerIterator it(*parts[k], j); it; ++it)
          if (it.value() != 0.)
            entries[k].emplace_back(first + static_cast<int>(it.row()), first + j, it.value());
    first += line.unknowns();
  }
  for (std::size_t rail = 0; rail < made.rz.size(); ++rail) {
    for (const auto& node : number[rail]) made.rz[rail].push_back(node[2]);
    if (carried == Carried::whole_elements) tie_elements(number[rail], entries[2]);
  }
  LinearTrack::Matrix* const matrices[3] = {&made.mass, &made.damping, &made.stiffness};
  for (int k = 0; k < 3; ++k) {
    matrices[k]->resize(first, first);
    matrices[k]->setFromTriplets(entries[k].begin(), entries[k].end());
  }
  if (numbering == Numbering::least_fill) number_for_least_fill(made);
  return made;
}

}  // namespace railstep
