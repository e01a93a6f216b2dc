#pragma once
#include <Eigen/Core>
#include <complex>
#include <utility>
#include <vector>

namespace railstep {

/// Shapes of a line's coordinates, a matrix S [unknowns][kept]: stored as it is, or for a ring wave
/// by wave, so that memory and work grow with the number of bays and not with its square.
class Shapes {
 public:
  /// The real or the imaginary part of x e^(2 pi i number b / bays) over the bays b.
  struct Wave {
    Eigen::MatrixXcd x;  // [unknowns of a bay][shapes]
    int number;
    bool imaginary;
  };

  Shapes() = default;
  template <typename Derived>
  Shapes(const Eigen::MatrixBase<Derived>& dense) : dense_(dense) {}  // NOLINT: a matrix is one
  /// @param cells  the line's unknowns bay by bay, in one order, [bays][unknowns of a bay]
  Shapes(std::vector<std::vector<int>> cells, std::vector<Wave> waves);

  Eigen::Index rows() const;
  Eigen::Index cols() const;
  /// Row of one unknown, [kept].
  Eigen::VectorXd row(int unknown) const;
  /// S' load, [kept].
  Eigen::VectorXd project(const Eigen::VectorXd& load) const;
  /// S y, [unknowns].
  Eigen::VectorXd displacement(const Eigen::VectorXd& y) const;
  Eigen::MatrixXd dense() const;

 private:
  struct Place {
    int bay, index;  // of a bay, of an unknown in it
  };
  std::complex<double> wave_phase(const Wave& wave, int bay) const;

  Eigen::MatrixXd dense_;  // without waves
  std::vector<std::vector<int>> cells_;
  std::vector<Wave> waves_;
  std::vector<Place> place_;                  // of each unknown
  std::vector<std::complex<double>> around_;  // [bays] e^(2 pi i b / bays)
};

}  // namespace railstep
