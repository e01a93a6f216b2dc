#pragma once
#include <Eigen/SparseCholesky>
#include <functional>
#include <vector>

#include "offline/condense/basis.h"
#include "offline/condense/superelement.h"
#include "offline/track/functional.h"

namespace railstep {

/// A vertical force on a rail and the displacement there, on y = 0 of the section.
struct Port {
  int rail;  // 0 left (+y), 1 right
  double z;  // above the axis, m
};

/// Static flexibility of one line between the places of ports, `points` intervals per element at
/// equal steps of x, in the line's own coordinates: the weights of a port's rail in the line are
/// left to the caller, those of a functional are in.
class LineFlexibility {
 public:
  /// Displacements of port b at all places under a unit force of port a at each place of one
  /// element: [places of the element][elements x (points + 1)], m/N.
  using Strip = std::function<Eigen::MatrixXd(int element)>;

  virtual ~LineFlexibility() = default;
  /// G(x, x) from a port to one above or below it; [elements x (points + 1)], m/N.
  virtual Eigen::VectorXd under(double a_z, double b_z, int points) const = 0;
  virtual Strip between(double a_z, double b_z, int points) const = 0;
  /// The functional under a unit force of a port at each place; [elements x (points + 1)].
  virtual Eigen::VectorXd from(double z, const Functional& functional, int points) const = 0;
  /// Each of `reads` under a unit force spread by `force`, whatever their directions; m/N. Weights
  /// of rails are in.
  virtual Eigen::VectorXd flexibility(const std::vector<Functional>& reads,
                                      const Functional& force) const = 0;
};

/// The line with every element divided into `parts`, taken at their ends, where the element is
/// exact; with one part it is the line itself. Cost grows with the line's own nodes only.
class DividedLine : public LineFlexibility {
 public:
  DividedLine(const Track& track, const Line& line, int parts);

  /// These throw std::invalid_argument if the line has a free rigid mode.
  Eigen::VectorXd under(double a_z, double b_z, int points) const override;
  Strip between(double a_z, double b_z, int points) const override;
  Eigen::VectorXd from(double z, const Functional& functional, int points) const override;
  Eigen::VectorXd flexibility(const std::vector<Functional>& reads,
                              const Functional& force) const override;
  /// Whether the line has no free rigid mode.
  bool held() const { return held_; }

 private:
  /// A functional over the line: what reaches the elements' end nodes, and its points' own rows.
  struct Spread {
    struct OnElement {
      int element;
      Superelement::Rows rows;
    };
    Eigen::VectorXd load;  // [unknowns]
    std::vector<OnElement> points;
  };
  Spread spread(const Functional& functional) const;
  Superelement::Rows port_rows(double z, int points) const;
  Superelement::Rows rail_row(const Functional::OnRail& point, int element) const;
  Eigen::MatrixXd end_columns(int element) const;
  void factor(const Eigen::SparseMatrix<double>& stiffness);
  void refuse_free_modes() const;

  const Track& track_;
  const Line& line_;
  Superelement element_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool held_ = false;  // no free rigid mode
};

/// The line in the coordinates of a basis. A port leaves out the section's own strain (b_z at its
/// height), which few coordinates do not carry; functionals are read whole.
class ReducedLine : public LineFlexibility {
 public:
  /// Throws std::invalid_argument if the basis is not one of the line.
  ReducedLine(const Track& track, const Line& line, const Basis& basis);

  Eigen::VectorXd under(double a_z, double b_z, int points) const override;
  Strip between(double a_z, double b_z, int points) const override;
  Eigen::VectorXd from(double z, const Functional& functional, int points) const override;
  Eigen::VectorXd flexibility(const std::vector<Functional>& reads,
                              const Functional& force) const override;

 private:
  /// shapes / omega at a port's places; [elements x (points + 1)][kept]
  Eigen::MatrixXd scaled_shapes(int points) const;

  const Track& track_;
  const Line& line_;
  const Basis& basis_;
};

/// Unknowns of a node that a line carries, from an inner one: ends may hold some of theirs.
std::vector<int> carried_unknowns(const Line& line);

/// Element that holds a place of the rail. Throws std::out_of_range off the rail.
int element_at(const Track& track, double x);

/// Whether unknown k of a node changes sign on that rail: the y components (r_y, a_x, a_z, b_y) of
/// a mirrored right rail.
bool flips_in_mirror(const Line& line, int rail, int k);

/// A functional's sleepers as forces on the line; [unknowns]. Directions in which a sleeper is held
/// add nothing.
Eigen::VectorXd sleeper_load(const Line& line, const Functional& functional);

}  // namespace railstep
