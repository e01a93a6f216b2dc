#pragma once
#include <Eigen/SparseCholesky>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "offline/condense/basis.h"
#include "offline/condense/local_inverse.h"
#include "offline/condense/superelement.h"
#include "offline/track/functional.h"

namespace railstep {

/// A point of a rail's section at which a force acts and its displacement along it is read.
struct LoadPoint {
  int rail;           // 0 left (+y), 1 right
  double z;           // of the section's point above the axis, m
  double y = 0.;      // beside it, m
  int direction = 2;  // of the track: 1 y, 2 z
};

/// Row of a load point over the unknowns [r, a, b] of a node under it. @param row  [9] out
void load_row(const Track& track, const LoadPoint& load_point, double* row);

/// Elements of the tables over places: the track's, or on a ring those of one bay, which every
/// other bay repeats.
int tabled_elements(const Track& track);

/// The element that lies `shift` elements on, round a ring; -1: off the rail.
int shifted(const Track& track, int element, int shift);

/// Elements from `first` on, up to `last` without it.
struct Elements {
  int first, last;
  int count() const { return last - first; }
};

/// Static flexibility of one line between the places of load points, `points` intervals per element
/// at equal steps of x, in the line's own coordinates: the caller adds the weights of a load
/// point's rail in the line; those of a functional are included.
class LineFlexibility {
 public:
  /// Displacements of load point b at the places of the elements within a range of an element,
  /// under a unit force of load point a at each place of that element: [places][(2 range + 1) x
  /// (points + 1)], m/N; 0 off the rail.
  using Strip = std::function<Eigen::MatrixXd(int element)>;

  virtual ~LineFlexibility() = default;
  /// G(x, x) from a load point to another of its rail; [tabled elements x (points + 1)], m/N.
  virtual Eigen::VectorXd under(const LoadPoint& load_point, const LoadPoint& other,
                                int points) const = 0;
  virtual Strip between(const LoadPoint& a, const LoadPoint& b, int points, int range) const = 0;
  /// The functional under a unit force of a load point at each place of some elements, of a ring
  /// all; [elements x (points + 1)].
  virtual Eigen::VectorXd from(const LoadPoint& load_point, const Functional& functional,
                               int points, Elements at) const = 0;
  /// Each of `reads` under a unit force spread by `force`, in any directions; m/N. Weights of rails
  /// are included.
  virtual Eigen::VectorXd flexibility(const std::vector<Functional>& reads,
                                      const Functional& force) const = 0;
  /// Whether the line has no free rigid mode, which the queries need.
  virtual bool held() const { return true; }
};

/// The line with every element divided into `parts`, taken at their ends, where the element is
/// exact; with one part it is the line itself. Cost grows with the line's own nodes only. Not safe
/// for several threads at once.
class DividedLine : public LineFlexibility {
 public:
  DividedLine(const Track& track, const Line& line, int parts);

  /// These throw Refused if the line has a free rigid mode.
  Eigen::VectorXd under(const LoadPoint& load_point, const LoadPoint& other,
                        int points) const override;
  Strip between(const LoadPoint& a, const LoadPoint& b, int points, int range) const override;
  Eigen::VectorXd from(const LoadPoint& load_point, const Functional& functional, int points,
                       Elements at) const override;
  Eigen::VectorXd flexibility(const std::vector<Functional>& reads,
                              const Functional& force) const override;
  bool held() const override { return held_; }

 private:
  /// A functional over the line: its part at the elements' end nodes, and its points' own rows.
  struct Spread {
    struct OnElement {
      int rail, element;
      Superelement::Rows rows;
    };
    Eigen::SparseVector<double> load;
    std::vector<OnElement> points;
  };
  Spread spread(const Functional& functional) const;
  const Superelement& element(int rail) const;
  Superelement::Rows load_rows(const LoadPoint& load_point, int points) const;
  Superelement::Rows rail_rows(const Functional::OnRail& point, int element) const;
  void sign(int rail, Eigen::VectorXd& row) const;
  Stretch moved(const Eigen::SparseVector<double>& load, Elements around) const;
  const Eigen::MatrixXd& end_flexibility(int rail, int element) const;
  void factor(const Eigen::SparseMatrix<double>& stiffness);
  void find_spans();
  void refuse_free_modes() const;

  const Track& track_;
  const Line& line_;
  std::array<std::optional<Superelement>, 2> element_;  // of each rail that the line has
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  std::optional<LocalInverse> local_;      // of a held track with ends
  std::vector<std::pair<int, int>> span_;  // of each element's end unknowns: the first, the last
  bool held_ = false;                      // no free rigid mode
  /// For each rail, made when it is first needed: [tabled elements].
  mutable std::array<std::vector<Eigen::MatrixXd>, 2> end_flexibility_;
};

/// The same for any track, also with long pads, which act on inner nodes: the track with every
/// element divided is assembled. Cost grows with the nodes of the divided track.
class RefinedLine : public LineFlexibility {
 public:
  /// Throws Refused if the divided track has no such line.
  RefinedLine(const Track& track, const Line& line, int parts);

  /// These throw Refused if the line has a free rigid mode.
  Eigen::VectorXd under(const LoadPoint& load_point, const LoadPoint& other,
                        int points) const override;
  Strip between(const LoadPoint& a, const LoadPoint& b, int points, int range) const override;
  Eigen::VectorXd from(const LoadPoint& load_point, const Functional& functional, int points,
                       Elements at) const override;
  Eigen::VectorXd flexibility(const std::vector<Functional>& reads,
                              const Functional& force) const override;
  bool held() const override { return held_; }

 private:
  /// Displacements under a load point at the places of one element of the track; [unknowns][points
  /// + 1]
  Eigen::SparseMatrix<double> columns(const LoadPoint& load_point, int element, int points) const;
  void refuse_free_modes() const;

  const Track& whole_;
  Track track_;  // divided
  int elements_, parts_;
  Line line_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  bool held_ = false;  // no free rigid mode
};

/// The line in the coordinates of a basis. A load point leaves out the section's own strain (a_y,
/// b_z), which a few coordinates do not represent; functionals are read whole.
class ReducedLine : public LineFlexibility {
 public:
  /// Throws Refused if the basis does not fit the line.
  ReducedLine(const Track& track, const Line& line, const Basis& basis);

  Eigen::VectorXd under(const LoadPoint& load_point, const LoadPoint& other,
                        int points) const override;
  Strip between(const LoadPoint& a, const LoadPoint& b, int points, int range) const override;
  Eigen::VectorXd from(const LoadPoint& load_point, const Functional& functional, int points,
                       Elements at) const override;
  Eigen::VectorXd flexibility(const std::vector<Functional>& reads,
                              const Functional& force) const override;
  /// Velocity of the functional at once under a unit force of a load point at each place;
  /// [elements x (points + 1)], of a basis that has such.
  Eigen::VectorXd at_once(const LoadPoint& load_point, const Functional& functional, int points,
                          Elements at) const;

 private:
  template <typename Take>
  void read_load_point(const LoadPoint& load_point, int points, Elements at,
                       const Take& take) const;
  Eigen::VectorXd displacement_at(const LoadPoint& load_point, int points, Elements at,
                                  const Eigen::VectorXd& y) const;
  /// The shapes at a load point's places, on a ring round it; [elements x (points + 1)][kept]
  Eigen::MatrixXd load_shapes(const LoadPoint& load_point, int points, Elements at) const;

  const Track& track_;
  const Line& line_;
  const Basis& basis_;
};

/// Unknowns of a rail's node that a line carries, taken from an inner node because ends may hold
/// some.
std::vector<int> carried_unknowns(const Line& line, int rail);

/// The line of the same track on another mesh or with more unknowns that carries all motions of
/// this one. Throws Refused if there is no such line.
Line matching(const Track& other, const Line& line);

/// The line with the accuracy of that many parts of every element, and with the section's strain if
/// the track's unknowns do not have it; with one part it is the line itself. A pad with a length
/// acts on the inner nodes of elements, which a divided line eliminates.
std::unique_ptr<LineFlexibility> exact_line(const Track& track, const Line& line, int parts);

/// Whether a line does not distinguish two rails: the same rail, or mirror images.
bool same_rail(const Line& line, int a, int b);

/// Element that holds a place of the rail. Throws Refused off the rail.
int element_at(const Track& track, double x);

/// A functional's sleepers as forces on the line; [unknowns]. Directions in which a sleeper is held
/// add nothing.
Eigen::VectorXd sleeper_load(const Track& track, const Line& line, const Functional& functional);

}  // namespace railstep
