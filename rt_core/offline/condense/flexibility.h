#pragma once
#include <limits>
#include <memory>
#include <vector>

#include "offline/condense/basis.h"
#include "offline/condense/line_flexibility.h"
#include "offline/track/track.h"

namespace railstep {

/// Residual flexibility between two load points, by element of the first and, within `range`
/// elements of it, of the second.
struct PairTable {
  int points;                 // intervals per element
  int range;                  // elements
  std::vector<double> value;  // [tabled e][e2 - e + range][p][q], m/N; 0 where e2 is off the rail

  /// Value for the first load point at place p of element e and the second at place q of element
  /// e2, both on the rail; 0 beyond the range.
  double at(int e, int p, int e2, int q) const;
};

/// Residual flexibility G_res(a, b) = G_exact(a, b) - G_model(a, b) of a track: the static error of
/// a model of it, between load points and from load points to other functionals.
///
/// Exact is the same track with every element divided into `points` elements, taken at their ends,
/// where the element is exact: each divided element is condensed to its two end nodes, its static
/// shapes and its inner flexibility with the ends held. The model is the track as it stands, or its
/// lines in the coordinates of a basis; there a load point leaves out the section's own strain
/// (a_y, b_z), so that the squeeze of the head is in G_res. G_exact has a slope jump of
/// -1/(k_z G A) at equal places, and so has G_res.
///
/// All queries skip lines that the load point does not move. They throw Refused on a
/// rail that the track does not have, and on a free rigid mode of a line that the load point moves.
class ResidualFlexibility {
 public:
  /// @param lines  of the track, as assemble() gives them
  /// @param bases  one per line, or none for the track as it stands
  /// @param points intervals per element, >= 3; tables are read by cubic interpolation
  /// @param lateral  load points along y are asked for, not vertical ones alone
  /// Throws Refused on fewer points and on bases of other lines.
  ResidualFlexibility(const Track& track, const std::vector<Line>& lines,
                      const std::vector<Basis>& bases, int points, bool lateral = false);
  ~ResidualFlexibility();
  ResidualFlexibility(const ResidualFlexibility&) = delete;
  ResidualFlexibility& operator=(const ResidualFlexibility&) = delete;

  /// G_res(x, x); [tabled elements][points + 1], m/N, at equal steps of x; of a ring
  /// those are one bay's, which all others repeat. On the axis it is never below 0, except by
  /// rounding. Above the axis the element's two Gauss points make the element softer than the rail
  /// to the squeeze of the section, by up to 1e-3 of G_exact at its end nodes. There G_res is below
  /// 0, and nothing is clipped here.
  std::vector<double> under(LoadPoint load_point) const;
  /// From the load point to another of its rail in the same section.
  std::vector<double> under(LoadPoint load_point, LoadPoint other) const;
  /// G_exact(x, x); [tabled elements][points + 1], m/N.
  std::vector<double> exact_under(LoadPoint load_point) const;

  /// G_res between all places of two load points of one or two rails; between(b, a) is its
  /// transpose. `range` is the smallest number of elements beyond which all of it stays below 1e-4
  /// of the largest G_exact(x, x) of the load points. It is not 0 for the track as it stands: an
  /// element reads a force inside it quadratically, and so moves others wrongly (5e-3 of G_exact
  /// next to it with one element of 0.6 m per bay, 1e-3 with two).
  /// @param points intervals per element, a divisor of the constructor's
  /// @param most   range at most, where load points are known to stand no farther apart
  PairTable between(LoadPoint a, LoadPoint b, int points,
                    int most = std::numeric_limits<int>::max()) const;

  /// Static error of the model in the functional under a unit force of the load point at each
  /// place; [elements][points + 1], m/N. Throws Refused if the functional is off the track.
  std::vector<double> from(LoadPoint load_point, const Functional& functional) const;
  /// Velocity of a functional at once under a unit force of the load point, beyond the modes'
  /// rates; [elements][points + 1], m/(N s), 0 except for truncated damped modes.
  std::vector<double> at_once(LoadPoint load_point, const Functional& functional,
                              Elements at) const;
  /// from() for several load points, only for elements where it is not negligible: beyond them it
  /// stays below 1e-8 of the functional's largest value under a force of any of these on the exact
  /// track. For a model in the coordinates of a basis, and for a ring, all elements.
  struct Near {
    Elements at;
    std::vector<double> value;  // [load_points][elements][points + 1]
  };
  Near near(const std::vector<LoadPoint>& load_points, const Functional& functional,
            Elements among = {0, std::numeric_limits<int>::max()}) const;

 private:
  struct Pair;                // exact and model of one line
  struct Sums {               // over the lines that a load point moves
    Eigen::VectorXd missing;  // as from() gives it
    double largest_exact;     // of the exact track
  };
  double weight(const Pair& pair, LoadPoint load_point) const;
  Sums sums(LoadPoint load_point, const Functional& functional, Elements at) const;
  Elements filled(const Sums& sums, Elements at, double nothing) const;
  LineFlexibility::Strip strips(LoadPoint a, LoadPoint b, int points, int range) const;
  double largest_exact(LoadPoint load_point) const;

  Track track_;
  std::vector<Line> lines_;
  std::vector<Basis> bases_;
  int points_;
  std::vector<Pair> pairs_;
};

}  // namespace railstep
