// Seats as long as their pads, and sleepers that pitch on their ballast.
#include <Eigen/Cholesky>
#include <Eigen/SparseLU>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

#include "offline/analysis/statics.h"
#include "offline/element/shape.h"
#include "offline/track/pad.h"
#include "support/rail_at.h"
#include "support/sections.h"

using namespace railstep;
using Catch::Matchers::WithinRel;

namespace {

/// Set S1 of rail-data.md with one rail R60, at mid-bay of the middle bay and over a sleeper.
Track s1(int bays, int elements_per_bay, double pad_length) {
  Track t;
  t.rails = 1;
  t.unknowns = Unknowns::vertical;
  t.section = r60_section();
  t.bays = bays;
  t.elements_per_bay = elements_per_bay;
  t.support.stiffness = {0., 0., 200e6};
  t.support.damping = {0., 0., 20e3};
  t.support.length = pad_length;
  t.sleeper = Sleeper{300., 169., {0., 0., 50e6}, {0., 0., 80e3}, 8., .26};
  return t;
}

/// The same track by samples: `samples` springs along each pad, each on the element's shape
/// functions, on sleepers with height and pitch.
class Sampled {
 public:
  Sampled(const Track& t, int samples) : track_(t) {
    Track bare = t;
    bare.support = {};
    bare.sleeper.reset();
    line_ = assemble(bare)[0];
    const int rail = line_.unknowns();
    K_ = Eigen::MatrixXd::Zero(rail + 2 * (t.bays + 1), rail + 2 * (t.bays + 1));
    K_.topLeftCorner(rail, rail) = Eigen::MatrixXd(line_.stiffness);
    for (int seat = 0; seat <= t.bays; ++seat) {
      const int z = rail + 2 * seat;
      const double from = seat == 0 ? 0. : -.5, to = seat == t.bays ? 0. : .5;
      for (int i = 0; i < samples; ++i) {
        const double offset = t.support.length * (from + (to - from) * (i + .5) / samples);
        Eigen::VectorXd gap = rail_row(seat * t.bay_length + offset);
        gap[z] = -1.;
        gap[z + 1] = offset;  // the sleeper's top sinks ahead as it pitches forward
        K_ += t.support.stiffness[2] / samples * gap * gap.transpose();
      }
      const double k = t.sleeper->ballast_stiffness[2], L = t.sleeper->ballast_length;
      K_(z, z) += k;
      for (int i = 0; i < samples; ++i) {
        const double arm = L * ((i + .5) / samples - .5);
        K_(z + 1, z + 1) += k / samples * arm * arm;
      }
    }
  }
  Eigen::VectorXd rail_row(double x) const {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(K_.rows());
    const Eigen::SparseVector<double> own = point_row(track_, line_, at(x));
    for (Eigen::SparseVector<double>::InnerIterator it(own); it; ++it) row[it.index()] = it.value();
    return row;
  }
  double flexibility(double a, double b) const {
    const Eigen::VectorXd moved = K_.ldlt().solve(rail_row(b));
    return rail_row(a).dot(moved);
  }

 private:
  Track track_;
  Line line_;
  Eigen::MatrixXd K_;
};

/// |w/F| at the place where the force acts, m/N.
double receptance(const Track& track, double x, double hz) {
  using Complex = std::complex<double>;
  const Complex s(0., 2. * M_PI * hz);
  Complex sum = 0.;
  for (const Line& line : assemble(track)) {
    const Eigen::VectorXcd row = Eigen::VectorXd(point_row(track, line, at(x))).cast<Complex>();
    const Eigen::SparseMatrix<Complex> A = line.stiffness.cast<Complex>() +
                                           s * line.damping.cast<Complex>() +
                                           s * s * line.mass.cast<Complex>();
    const Eigen::SparseLU<Eigen::SparseMatrix<Complex>> factor(A);
    const Eigen::VectorXcd moved = factor.solve(row);
    sum += row.cwiseProduct(moved).sum();
  }
  return std::abs(sum);
}

}  // namespace

TEST_CASE("the points of a pad sum to one and integrate the squares of shape functions", "[pads]") {
  const Track t = s1(4, 3, 0.);
  for (const double length : {.1, .16, .3, .6})
    for (const int border : {0, 2, 4}) {
      double whole = 0., mean = 0., square = 0., fourth = 0.;
      for (const PadPoint& p : pad_points(t, border, length)) {
        CHECK(std::abs(p.xi) < 1.);
        CHECK_THAT(p.x, WithinRel((p.element + .5 * (p.xi + 1.)) * t.element_length(), 1e-12));
        whole += p.part;
        mean += p.part * p.offset;
        square += p.part * p.offset * p.offset;
        fourth += p.part * p.offset * p.offset * p.offset * p.offset;
      }
      // Under the rail: from -L/2 to L/2, or only the half at an end of the rail.
      const double from = border == 0 ? 0. : -.5 * length, to = border == 4 ? 0. : .5 * length;
      const auto moment = [&](int n) {
        return (std::pow(to, n + 1) - std::pow(from, n + 1)) / ((n + 1) * (to - from));
      };
      CHECK(std::abs(whole - 1.) < 1e-14);
      CHECK(std::abs(mean - moment(1)) < 1e-15);
      CHECK_THAT(square, WithinRel(moment(2), 1e-13));
      CHECK_THAT(fourth, WithinRel(moment(4), 1e-13));
    }
}

TEST_CASE("a long pad agrees with many springs along the rail", "[pads]") {
  // The midpoint rule of n samples misses h^2/24 f'' in each element's piece. With n = 400 this is
  // some 1e-6 of the effect of a pad of 0.16 m, 1e-2.
  for (const int elements_per_bay : {1, 2, 5}) {
    const Track track = s1(4, elements_per_bay, .16);
    const Sampled sampled(track, 400);
    const Statics statics(track);
    for (const double x : {0., 1.2, 1.5})
      CHECK_THAT(statics.flexibility(at(1.2), at(x)), WithinRel(sampled.flexibility(1.2, x), 1e-6));
  }
}

TEST_CASE("a short pad acts at a point, a long one holds the rail's slope", "[pads]") {
  // A load over a reaction that is spread over L bends no more, but shears by up to F L/(8 k G A):
  // 5e-14 of 1e-8 m per N for L = 0.1 mm.
  const auto over_seat = [](double length, double ballast_length) {
    Track track = s1(10, 8, length);
    track.sleeper->ballast_length = ballast_length;
    return Statics(track).flexibility(at(3.), at(3.));
  };
  CHECK_THAT(over_seat(1e-4, .26), WithinRel(over_seat(0., .26), 1e-5));
  // On a sleeper that does not pitch, the pad resists rotation with k L^2/12. On one that does, the
  // rail is freer and its seat softer than a point.
  CHECK(over_seat(.16, 0.) < (1. - 2e-3) * over_seat(0., 0.));
  CHECK(over_seat(.16, .26) > over_seat(.16, 0.));
}

TEST_CASE("stiff pads of 0.16 m change the receptance over them by 2 to 18 % below 500 Hz",
          "[pads]") {
  // A seat as long as its pad was found to have these bounds, for pads of 1.3e9 N/m (rail-data.md,
  // Thompson-type, stiff) on sleepers that do not pitch. From 250 to 350 Hz the change passes
  // through 0.
  Track point = s1(60, 8, 0.), pad = s1(60, 8, .16), fine = s1(60, 16, .16);
  for (Track* track : {&point, &pad, &fine}) {
    track->support.stiffness[2] = 1.3e9;
    track->sleeper->ballast_length = 0.;
  }
  for (const double hz : {50., 100., 200., 400., 450.}) {
    const double with_pad = receptance(pad, 18., hz);
    const double change = std::abs(with_pad / receptance(point, 18., hz) - 1.);
    CAPTURE(hz, change);
    CHECK(change > .02);
    CHECK(change < .18);
    // Eight elements per bay resolve it to a twentieth of the smallest change.
    CHECK_THAT(with_pad, WithinRel(receptance(fine, 18., hz), 1e-3));
  }
  // rail-data.md prints the receptance of point seats to 4 digits and states 1 %.
  const Track printed = s1(60, 4, 0.);
  CHECK_THAT(receptance(printed, 18.3, 200.), WithinRel(2.405e-9, 1e-2));
  CHECK_THAT(receptance(printed, 18., 400.), WithinRel(5.264e-9, 1e-2));
}

TEST_CASE("a sleeper on long pads pitches with its rail", "[pads]") {
  // A load beside a sleeper pitches it; ballast without length holds it upright and is stiffer.
  Track rocks = s1(10, 8, .16), upright = rocks;
  upright.sleeper->ballast_length = 0.;
  const Statics one(rocks), other(upright);
  CHECK(one.flexibility(at(3.15), at(3.15)) > 1.0005 * other.flexibility(at(3.15), at(3.15)));
  const auto u = one.solve({{at(3.15), -100e3}});
  double sum = 0.;
  for (int seat = 0; seat <= 10; ++seat) sum += one.support_force(u, 0, seat);
  CHECK_THAT(sum, WithinRel(100e3, 1e-9));
  CHECK(sleeper_row(rocks, one.lines()[0], 0, 5, 3).dot(u[0]) > 1e-6);  // rad, towards the load
}
