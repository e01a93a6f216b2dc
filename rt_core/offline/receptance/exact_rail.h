#pragma once
#include <array>
#include <complex>
#include <vector>

#include "offline/math/complex.h"
#include "offline/receptance/beam_waves.h"
#include "offline/receptance/receptance.h"

namespace railstep {

/// Vertical receptance of rails as exact beams between their seats: no mesh. An independent check
/// of the linear ANCF rail, the answer that Euler-Bernoulli codes give, and that of a track without
/// end. Rails do not roll, forces act on y = 0 and heights in the section are not told apart; pads
/// below the axis hold the rail's rotation by their stiffness along x, against sleepers that stand
/// still in that direction.
class ExactRailReceptance : public Receptance {
 public:
  /// @param endless  the track goes on without end beyond both ends, whatever holds them; it
  ///                 always does beyond non-reflecting ones
  /// Throws Refused on directions other than z, axial force and a reference line off
  /// the centroid; Refused on points off the track.
  ExactRailReceptance(const Track& track, const Transfer& transfer, BeamTheory theory,
                      bool endless = false);
  /// Above 0 Hz. Throws Failed if an endless track lets waves run undamped.
  Eigen::VectorXcd at(double hz) override;

 private:
  /// Rails that move alike, and the sleeper under each.
  struct Part {
    std::array<double, 2> rail_factor;  // weight of the part in left, right
    double sleeper_mass;                // kg under one rail
  };
  /// Stiffness under a rail at one frequency, N/m; without a sleeper the pad's foot stands still.
  struct Seat {
    ComplexNumber pad, sleeper;
    ComplexNumber rotation;  // N m/rad
    bool has_sleeper;
    /// Over the rail's [w, theta].
    Eigen::Matrix2cd on_rail() const;
    /// Displacement of the sleeper per metre of the rail's.
    ComplexNumber follows() const { return pad / (pad + sleeper); }
  };
  void take_places(const Functional& functional);
  Seat seat(const Part& part, double omega) const;
  Eigen::SparseMatrix<ComplexNumber> stiffness(const Eigen::Matrix2cd& seat, double omega) const;
  void add_ends(const Eigen::Matrix2cd& seat, double omega,
                std::vector<Eigen::Triplet<ComplexNumber>>& to) const;
  Eigen::VectorXcd row(const Functional& functional, const Part& part, const Seat& seat) const;
  ComplexNumber held_rail(const Functional& a, const Functional& b, const Part& part,
                          const Seat& seat) const;
  std::size_t node_at(double x) const;

  Track track_;
  Transfer transfer_;
  BendingBeam beam_;
  bool endless_;
  std::vector<double> x_;  // of the nodes: seats and points, m
  std::vector<Part> parts_;
};

/// Dynamic stiffness over [w, theta] of the bays and seats that follow a seat along +x without end,
/// joined in twos until the far end has no effect.
/// @param bay  of the beam between two seats  @param seat  of a seat, over [w, theta]
/// Throws Failed if 2^40 bays are not enough: waves run undamped.
Eigen::Matrix2cd endless_stiffness(const Eigen::Matrix4cd& bay, const Eigen::Matrix2cd& seat);

}  // namespace railstep
